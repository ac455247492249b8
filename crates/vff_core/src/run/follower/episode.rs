//! One run of the follower.

use crate::error::{Failure, Result};
use crate::laws::impedance::bank::{Bank, BankLayout};
use crate::laws::impedance::law::Prepared;
use crate::run::follower::scene::Scene;
use crate::run::follower::settings::{Settings, VelocityRule};
use crate::sensing::sonar::ranging::Normals;
use crate::sensing::sonar::{Pose, Shape, SonarArray};
use numeric::random::Stream;

/// Streams of one seed.
const BURSTS: u64 = 1;
const SONAR: u64 = 2;

/// Sensors of a bank.
const BANK: usize = 3;

/// Steps between two looks whether to stop.
const CHECK: usize = 1024;

/// A touch of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Direction of the nearest point from the front of the robot, counterclockwise, in rad.
    pub bearing: f64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// The touch that ended it.
    pub contact: Option<Contact>,
    /// When it ended, in s.
    pub end_time: f64,
    /// Distance from the source at the end, in m.
    pub source_distance: f64,
    /// Smallest distance between body and obstacles, in m; infinite without obstacles, negative
    /// in a touch.
    pub least_clearance: f64,
    /// Way of the robot, in m.
    pub path_length: f64,
    /// Sum of its turns either way, in rad.
    pub turning: f64,
}

/// Everything at one sample.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// Time, in s.
    pub time: f64,
    /// Robot.
    pub pose: &'a Pose,
    /// Virtual velocity at the end of the step, in m/s.
    pub virtual_velocity: [f64; 2],
    /// Speeds (left, right) of the wheels until the next sample, in m/s.
    pub wheels: [f64; 2],
    /// Where it wants to be, in m.
    pub target: [f64; 2],
    /// Source, in m.
    pub source: [f64; 2],
    /// Attraction, in N.
    pub attraction: [f64; 2],
    /// Repulsion, in N.
    pub repulsion: [f64; 2],
    /// Readings, in m; infinite without echo.
    pub readings: &'a [f64],
    /// Obstacles.
    pub shapes: &'a [Shape],
}

/// Receives samples.
pub trait Observer {
    /// Takes one sample.
    fn sample(&mut self, sample: &Sample<'_>);
}

impl Observer for () {
    #[inline]
    fn sample(&mut self, _sample: &Sample<'_>) {}
}

/// A follower ready to run.
#[derive(Clone, Debug)]
pub struct Follower {
    settings: Settings,
    array: SonarArray,
    layout: BankLayout,
    banks: Vec<Pose>,
    law: Prepared,
    /// Weight of a new sample in the filter of the speed.
    weight: f64,
    /// Steps between two bursts.
    burst: usize,
    /// No sensor can see anything that is farther from the center, in m.
    horizon: f64,
}

/// What changes during a run.
struct State {
    pose: Pose,
    velocity: [f64; 2],
    target: [f64; 2],
    banks: [Bank; 2],
    readings: [f64; 2 * BANK],
    fixes: Normals,
    noise: Normals,
}

/// Obstacles at one time.
struct Surroundings {
    shapes: Vec<Shape>,
    /// Those that a sensor may see.
    near: Vec<Shape>,
    /// Squared distance of the nearest one from the center, in m^2.
    least: f64,
    nearest: usize,
}

impl Follower {
    /// A follower with settings.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn new(settings: &Settings) -> Result<Self> {
        let settings = settings.clone().checked()?;
        let array = settings.sensors.array()?;
        let farthest = |mount: &Pose| mount.position[0].hypot(mount.position[1]);
        let offset = array.mounts().iter().map(farthest).fold(0.0, f64::max);
        let burst = (settings.fixes.interval / settings.step).round().max(1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
        let burst = burst as usize;
        Ok(Self {
            layout: settings.sensors.layout()?,
            banks: settings.sensors.banks(),
            law: settings.impedance.prepared(),
            weight: settings.bank.rate.weight(settings.step),
            burst,
            horizon: array.ranging().reach() + offset,
            array,
            settings,
        })
    }

    /// Its settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Number of its sensors.
    #[must_use]
    pub fn sensors(&self) -> usize {
        self.array.mounts().len()
    }

    /// Runs through a scene until the end or the first touch.
    ///
    /// # Errors
    /// The duration is out of range, the state became non-finite, or the caller asked to stop.
    pub fn run(
        &self,
        scene: &Scene,
        seed: u64,
        observer: &mut impl Observer,
        interrupted: &(dyn Fn() -> bool + Sync),
    ) -> Result<Outcome> {
        let steps = self.settings.steps(scene.duration)?;
        let mut state = State::new(seed);
        let mut around = Surroundings::of(scene);
        let mut outcome = Outcome {
            contact: None,
            end_time: 0.0,
            source_distance: f64::NAN,
            least_clearance: f64::INFINITY,
            path_length: 0.0,
            turning: 0.0,
        };
        for step in 0..=steps {
            if step % CHECK == CHECK - 1 && interrupted() {
                return Err(Failure::Interrupted);
            }
            let time = step as f64 * self.settings.step;
            let source = scene.leader.at(time);
            self.look(&mut around, scene, time, &state.pose);
            outcome.end_time = time;
            outcome.least_clearance = outcome.least_clearance.min(around.least);
            outcome.source_distance = length(minus(source, state.pose.position));
            let radius = self.settings.drive.body_radius;
            let touching = around.least < radius * radius;
            if touching {
                outcome.contact = Some(around.contact(&state.pose));
            }
            let wheels = self.act(&mut state, &around, step, source, observer);
            if touching || step == steps {
                break;
            }
            self.advance(&mut state, wheels, &mut outcome);
            if !(state.pose.position[0] + state.pose.position[1]).is_finite() {
                return Err(Failure::NonFinite { run: 0, time });
            }
        }
        outcome.least_clearance = outcome.least_clearance.sqrt() - self.settings.drive.body_radius;
        Ok(outcome)
    }

    /// Puts the obstacles where they are.
    #[inline]
    fn look(&self, around: &mut Surroundings, scene: &Scene, time: f64, pose: &Pose) {
        around.near.clear();
        around.least = f64::INFINITY;
        for (index, mover) in scene.obstacles.iter().enumerate() {
            let shape = mover.at(time);
            let [x, y] = shape.nearest(pose.position);
            let square = x * x + y * y;
            if square < around.least {
                around.least = square;
                around.nearest = index;
            }
            if square <= self.horizon * self.horizon {
                around.near.push(shape);
            }
            around.shapes[index] = shape;
        }
        if let Some([x, y]) = scene.leader.visible {
            let body = crate::sensing::sonar::Rectangle::upright(
                scene.leader.at(time),
                [2.0 * x, 2.0 * y],
            );
            around.near.push(Shape::Rectangle(body));
        }
    }

    /// Hears, senses, and chooses the speeds of the wheels.
    #[inline]
    fn act(
        &self,
        state: &mut State,
        around: &Surroundings,
        step: usize,
        source: [f64; 2],
        observer: &mut impl Observer,
    ) -> [f64; 2] {
        let settings = &self.settings;
        let pose = state.pose;
        if step.is_multiple_of(self.burst) {
            let offset = pose.inward(minus(source, pose.position));
            let (range, direction) = settings.fixes.fix(offset, &mut state.fixes);
            let advance = settings.attraction.advance(range);
            let [x, y] = pose.outward(direction);
            state.target = [
                pose.position[0] + advance * x,
                pose.position[1] + advance * y,
            ];
        }
        let readings = &mut state.readings[..self.array.mounts().len()];
        self.array
            .measure(&pose, &around.near, step, readings, &mut state.noise);
        let repulsion = self.repulsion(&mut state.banks, &state.readings, &pose);
        let offset = minus(state.target, pose.position);
        let attraction = settings.attraction.force(offset, state.velocity);
        let gain = settings.step / settings.drive.mass;
        let mut velocity = [
            state.velocity[0] + gain * (attraction[0] + repulsion[0]),
            state.velocity[1] + gain * (attraction[1] + repulsion[1]),
        ];
        let speed = length(velocity);
        if speed > settings.drive.wheel_speed {
            velocity = velocity.map(|part| part * (settings.drive.wheel_speed / speed));
        }
        state.velocity = velocity;
        let wheels = settings.drive.wheels(pose.inward(velocity));
        observer.sample(&Sample {
            time: step as f64 * settings.step,
            pose: &pose,
            virtual_velocity: velocity,
            wheels,
            target: state.target,
            source,
            attraction,
            repulsion,
            readings: &state.readings[..self.array.mounts().len()],
            shapes: &around.shapes,
        });
        wheels
    }

    /// Repulsive force of all banks, in N.
    #[inline]
    fn repulsion(
        &self,
        memory: &mut [Bank; 2],
        readings: &[f64; 2 * BANK],
        pose: &Pose,
    ) -> [f64; 2] {
        let mut sum = [0.0, 0.0];
        let timing = (self.settings.step, self.weight);
        for (index, (bank, mounted)) in memory.iter_mut().zip(&self.banks).enumerate() {
            let own: [f64; BANK] = std::array::from_fn(|sensor| readings[BANK * index + sensor]);
            let force = bank.force(
                &self.layout,
                &own,
                &pose.carrying(mounted),
                &self.law,
                &self.settings.bank,
                timing,
            );
            sum = [sum[0] + force[0], sum[1] + force[1]];
        }
        sum
    }

    /// Moves the robot by one step.
    #[inline]
    fn advance(&self, state: &mut State, wheels: [f64; 2], outcome: &mut Outcome) {
        let Settings { drive, step, .. } = &self.settings;
        state.pose = drive.moved(&state.pose, wheels, *step);
        outcome.path_length += 0.5 * (wheels[0] + wheels[1]).abs() * step;
        outcome.turning += ((wheels[1] - wheels[0]) / drive.wheel_base).abs() * step;
        if self.settings.velocity == VelocityRule::Reset {
            let speed = 0.5 * (wheels[0] + wheels[1]);
            state.velocity = state.pose.direction.map(|part| speed * part);
        }
    }
}

impl State {
    fn new(seed: u64) -> Self {
        Self {
            pose: Pose {
                position: [0.0, 0.0],
                direction: [1.0, 0.0],
            },
            velocity: [0.0, 0.0],
            target: [0.0, 0.0],
            banks: [Bank::default(); 2],
            readings: [f64::INFINITY; 2 * BANK],
            fixes: Normals::new(Stream::new(seed, BURSTS)),
            noise: Normals::new(Stream::new(seed, SONAR)),
        }
    }
}

impl Surroundings {
    fn of(scene: &Scene) -> Self {
        Self {
            shapes: scene.obstacles.iter().map(|mover| mover.shape).collect(),
            near: Vec::with_capacity(scene.obstacles.len() + 1),
            least: f64::INFINITY,
            nearest: 0,
        }
    }

    fn contact(&self, pose: &Pose) -> Contact {
        let to = self
            .shapes
            .get(self.nearest)
            .map_or([0.0, 0.0], |shape| shape.nearest(pose.position));
        let [forward, left] = pose.inward(to);
        Contact {
            obstacle: self.nearest,
            bearing: left.atan2(forward),
        }
    }
}

#[inline]
fn minus(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [one[0] - other[0], one[1] - other[1]]
}

#[inline]
fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}
