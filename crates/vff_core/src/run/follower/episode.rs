//! One run of the follower.

use nalgebra::Vector2;

use crate::error::{Failure, Result};
use crate::laws::impedance::bank::{Bank, BankLayout};
use crate::laws::impedance::law::Prepared;
use crate::run::follower::scene::FollowerScene;
use crate::run::follower::settings::{Settings, VelocityRule};
use crate::run::follower::surroundings::{Surroundings, Touch};
use crate::sensing::sonar::SonarArray;
use crate::sensing::sonar::ranging::Normals;
use crate::sensing::{Vision, VisionSensor};
use crate::world::frame::Frame;
use crate::world::shape::PlacedShape;
use numeric::random::Stream;

/// Streams of one seed.
const BURSTS: u64 = 1;
const SONAR: u64 = 2;
/// First stream of the cameras, one for each obstacle.
const CAMERA: u64 = 16;

/// Sensors of a bank.
const BANK: usize = 3;

/// Distance of surfaces that touch or overlap, in m: the force needs a direction.
const TOUCHING: f64 = 1e-9;

/// Steps between two looks whether to stop.
const CHECK: usize = 1024;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowerOutcome {
    /// The touch that ended it.
    pub contact: Option<Touch>,
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
    pub pose: &'a Frame,
    /// Virtual velocity at the end of the step, in m/s.
    pub virtual_velocity: Vector2<f64>,
    /// Speeds (left, right) of the wheels until the next sample, in m/s.
    pub wheels: [f64; 2],
    /// Where it wants to be, in m.
    pub target: Vector2<f64>,
    /// Source, in m.
    pub source: Vector2<f64>,
    /// Attraction, in N.
    pub attraction: Vector2<f64>,
    /// Repulsion, in N.
    pub repulsion: Vector2<f64>,
    /// Readings, in m; infinite without echo.
    pub readings: &'a [f64],
    /// Obstacles.
    pub shapes: &'a [PlacedShape],
}

/// Receives samples.
pub trait SampleObserver {
    /// Takes one sample.
    fn sample(&mut self, sample: &Sample<'_>);
}

impl SampleObserver for () {
    #[inline]
    fn sample(&mut self, _sample: &Sample<'_>) {}
}

/// A follower ready to run.
#[derive(Clone, Debug)]
pub struct Follower {
    settings: Settings,
    array: SonarArray,
    layout: BankLayout,
    banks: Vec<Frame>,
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
    pose: Frame,
    velocity: Vector2<f64>,
    /// Velocity of the robot over the last step, in m/s.
    driven: Vector2<f64>,
    target: Vector2<f64>,
    banks: [Bank; 2],
    /// Positions of the obstacles as a camera knows them.
    cameras: Vec<VisionSensor>,
    readings: [f64; 2 * BANK],
    fixes: Normals,
    noise: Normals,
}

impl Follower {
    /// A follower with settings.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn new(settings: &Settings) -> Result<Self> {
        let settings = settings.clone().checked()?;
        let array = settings.sensors.array()?;
        let farthest = |mount: &Frame| mount.position.x.hypot(mount.position.y);
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
        scene: &FollowerScene,
        seed: u64,
        observer: &mut impl SampleObserver,
        interrupted: &(dyn Fn() -> bool + Sync),
    ) -> Result<FollowerOutcome> {
        let steps = self.settings.steps(scene.duration)?;
        let mut state = State::new(self.settings.obstacle_vision.as_ref(), scene, seed)?;
        let mut around = Surroundings::of(scene, self.horizon);
        let mut outcome = FollowerOutcome {
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
            let source = around.look(scene, time, &state.pose);
            outcome.end_time = time;
            outcome.least_clearance = outcome.least_clearance.min(around.least);
            outcome.source_distance = length(source - state.pose.position);
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
            if !(state.pose.position.x + state.pose.position.y).is_finite() {
                return Err(Failure::NonFinite { run: 0, time });
            }
        }
        outcome.least_clearance = outcome.least_clearance.sqrt() - self.settings.drive.body_radius;
        Ok(outcome)
    }

    /// Locates the source, senses, and chooses the speeds of the wheels.
    #[inline]
    fn act(
        &self,
        state: &mut State,
        around: &Surroundings,
        step: usize,
        source: Vector2<f64>,
        observer: &mut impl SampleObserver,
    ) -> [f64; 2] {
        let settings = &self.settings;
        let pose = state.pose;
        if step.is_multiple_of(self.burst) {
            let offset = pose.inward(source - pose.position);
            let (range, direction) = settings.fixes.fix(offset, &mut state.fixes);
            let advance = settings.attraction.advance(range);
            state.target = pose.position + pose.outward(direction) * advance;
        }
        let repulsion = if settings.obstacle_vision.is_some() {
            self.repulsion_seen(state, around, step as f64 * settings.step)
        } else {
            let readings = &mut state.readings[..self.array.mounts().len()];
            self.array
                .measure(&pose, &around.near, step, readings, &mut state.noise);
            self.repulsion(&mut state.banks, &state.readings, &pose)
        };
        let offset = state.target - pose.position;
        let attraction = settings.attraction.force(offset, state.velocity);
        let gain = settings.step / settings.drive.mass;
        let mut velocity = state.velocity + (attraction + repulsion) * gain;
        let speed = length(velocity);
        if speed > settings.drive.wheel_speed {
            velocity *= settings.drive.wheel_speed / speed;
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

    /// Repulsive force of the obstacles as a camera knows them, in N: from the surface of the body
    /// to the nearest point of each within the reach of the sonar.
    fn repulsion_seen(&self, state: &mut State, around: &Surroundings, time: f64) -> Vector2<f64> {
        let (robot, driven) = (state.pose.position, state.driven);
        let radius = self.settings.drive.body_radius;
        let reach = self.array.ranging().reach();
        let cameras = state.cameras.iter_mut().zip(&around.shapes);
        self.law
            .force_of_points(cameras.filter_map(|(camera, actual)| {
                camera.sample(time, actual.center.into());
                let found = camera.estimate(time)?;
                let known = PlacedShape {
                    center: found.position.into(),
                    shape: actual.shape,
                };
                let to = known.nearest(robot);
                let distance = length(to);
                let gap = (distance - radius).max(TOUCHING);
                (distance > 0.0 && gap <= reach).then(|| {
                    (
                        to * (gap / distance),
                        Vector2::from(found.velocity) - driven,
                    )
                })
            }))
    }

    /// Repulsive force of all banks, in N.
    #[inline]
    fn repulsion(
        &self,
        memory: &mut [Bank; 2],
        readings: &[f64; 2 * BANK],
        pose: &Frame,
    ) -> Vector2<f64> {
        let mut sum = Vector2::zeros();
        let timing = (self.settings.step, self.weight);
        for (index, (bank, mounted)) in memory.iter_mut().zip(&self.banks).enumerate() {
            let own: [f64; BANK] = std::array::from_fn(|sensor| readings[BANK * index + sensor]);
            sum += bank.force(
                &self.layout,
                &own,
                &pose.carrying(mounted),
                &self.law,
                &self.settings.bank,
                timing,
            );
        }
        sum
    }

    /// Moves the robot by one step.
    #[inline]
    fn advance(&self, state: &mut State, wheels: [f64; 2], outcome: &mut FollowerOutcome) {
        let Settings { drive, step, .. } = &self.settings;
        let twist = drive.twist(wheels);
        state.pose = twist.moved(&state.pose, *step, drive.integration);
        state.driven = state.pose.direction * twist.speed;
        outcome.path_length += twist.speed.abs() * step;
        outcome.turning += twist.turn_rate.abs() * step;
        if self.settings.velocity == VelocityRule::Reset {
            state.velocity = state.driven;
        }
    }
}

impl State {
    fn new(vision: Option<&Vision>, scene: &FollowerScene, seed: u64) -> Result<Self> {
        let mut cameras = Vec::new();
        if let Some(vision) = vision {
            vision.check_frames(scene.duration)?;
            for (stream, _) in (CAMERA..).zip(&scene.obstacles) {
                cameras.push(VisionSensor::new(vision, seed, stream)?);
            }
        }
        Ok(Self {
            pose: Frame {
                position: Vector2::zeros(),
                direction: Vector2::x(),
            },
            velocity: Vector2::zeros(),
            driven: Vector2::zeros(),
            target: Vector2::zeros(),
            banks: [Bank::default(); 2],
            cameras,
            readings: [f64::INFINITY; 2 * BANK],
            fixes: Normals::new(Stream::new(seed, BURSTS)),
            noise: Normals::new(Stream::new(seed, SONAR)),
        })
    }
}

#[inline]
fn length(vector: Vector2<f64>) -> f64 {
    vector.dot(&vector).sqrt()
}
