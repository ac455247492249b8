//! One run of the follower.

use std::ops::Deref;
use std::sync::Arc;

use nalgebra::Vector2;

use crate::run::Interrupted;
use crate::run::episode::{Episode, Parts};
use crate::run::follower::sample::{Sample, SampleObserver};
use crate::run::follower::scene::FollowerScene;
use crate::run::follower::settings::Settings;
use crate::run::follower::surroundings::{FollowerObstacles, ObstacleTouch};
use crate::run::options::Clock;
use navigation_laws::impedance::following::{Following, FollowingLaw, RepulsionSource};
use navigation_laws::reflex::{Percept, Reflex};
use navigation_world::robots::drives::{Drive, VirtualVelocity};
use navigation_world::sensing::ObstacleCamera;
use navigation_world::sensing::fixes::Ear;
use navigation_world::sensing::sensor::{Sensor, Truth};
use navigation_world::sensing::sonar::{Sonar, SonarArray};
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::Body;
use navigation_world::world::motion::BodyState;
use navigation_world::world::obstacle::{Obstacle, Regions};
use numeric::error::{Failure, Result};
use numeric::random::Stream;

/// Streams of one seed.
const BURSTS: u64 = 1;
const SONAR: u64 = 2;
/// First stream of the cameras, one for each obstacle.
const CAMERA: u64 = 16;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowerOutcome {
    /// The touch that ended it.
    pub contact: Option<ObstacleTouch>,
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

/// A follower ready to run.
#[derive(Clone, Debug)]
pub struct Follower {
    settings: Settings,
    array: SonarArray,
    law: Arc<FollowingLaw>,
    /// No sensor can see anything that is farther from the center, in m.
    horizon: f64,
}

impl Follower {
    /// A follower with settings.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn new(settings: &Settings) -> Result<Self> {
        let sight = if settings.obstacle_vision.is_some() {
            RepulsionSource::Bodies
        } else {
            RepulsionSource::Echoes
        };
        Self::seeing(settings.clone().checked()?, sight)
    }

    /// A follower without repulsion, and without the sensors that serve it alone.
    ///
    /// # Errors
    /// A number is out of range.
    pub(super) fn unaware(settings: &Settings) -> Result<Self> {
        let settings = settings.clone().checked()?;
        let attracted = Settings {
            obstacle_vision: None,
            ..settings
        };
        Self::seeing(attracted, RepulsionSource::Nothing)
    }

    fn seeing(settings: Settings, sight: RepulsionSource) -> Result<Self> {
        let array = settings.sensors.array()?;
        let farthest = |mount: &Frame| mount.position.x.hypot(mount.position.y);
        let offset = array.mounts().iter().map(farthest).fold(0.0, f64::max);
        let reach = array.ranging().reach();
        let law = FollowingLaw {
            attraction: settings.attraction,
            repulsion: settings.impedance.prepared(),
            sight,
            layout: settings.sensors.layout()?,
            banks: settings.sensors.banks(),
            options: settings.bank,
            timing: (settings.step, settings.bank.rate.weight(settings.step)),
            body_radius: settings.drive.body_radius,
            reach,
        };
        Ok(Self {
            law: Arc::new(law),
            horizon: reach + offset,
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
        interrupted: Interrupted<'_>,
    ) -> Result<FollowerOutcome> {
        let episode = self.episode(&*self.law, scene, seed, observer)?;
        let mut ended = episode.run(interrupted)?;
        // What it would do next stands in the last row.
        let time = ended.stepped();
        ended.parts.decide(time, None, interrupted)?;
        Ok(ended.parts.outcome())
    }

    /// Constants of its law.
    pub(crate) fn law(&self) -> &Arc<FollowingLaw> {
        &self.law
    }

    /// A run at its start; it refers to law and scene, or shares them.
    ///
    /// # Errors
    /// The duration is out of range.
    pub(crate) fn episode<L, S, O>(
        &self,
        law: L,
        scene: S,
        seed: u64,
        observer: O,
    ) -> Result<Episode<FollowerParts<L, S, O>>>
    where
        L: Deref<Target = FollowingLaw>,
        S: Deref<Target = FollowerScene>,
        O: SampleObserver,
    {
        let settings = &self.settings;
        let step = settings.step;
        let clock = Clock {
            step,
            steps_per_sample: 1,
            steps: settings.steps(scene.duration)?,
            interval: step,
        };
        let vision = settings.obstacle_vision.as_ref();
        let camera = vision.map(|vision| {
            let count = scene.obstacles.len();
            ObstacleCamera::of_everything(count, vision, (seed, CAMERA), scene.duration)
        });
        let bodies: Vec<Body> = match vision {
            Some(_) => scene.obstacles.iter().map(body_of).collect(),
            None => Vec::new(),
        };
        let drive = VirtualVelocity::new(settings.drive, settings.velocity, step);
        let parts = FollowerParts {
            place: Place {
                around: FollowerObstacles::of(&scene, settings.drive.body_radius, self.horizon),
                scene,
                bodies: bodies.clone(),
                source: Vector2::zeros(),
                pose: drive.frame(),
                velocity: Vector2::zeros(),
            },
            senses: Senses {
                ear: Ear::new(&settings.fixes, step, Stream::new(seed, BURSTS)),
                sonar: Sonar::new(&self.array, Stream::new(seed, SONAR), f64::INFINITY),
                camera: camera.transpose()?,
                seen: bodies,
            },
            law: Following::new(law),
            drive,
            body_radius: settings.drive.body_radius,
            outcome: FollowerOutcome {
                contact: None,
                end_time: 0.0,
                source_distance: f64::NAN,
                least_clearance: f64::INFINITY,
                path_length: 0.0,
                turning: 0.0,
            },
            ended: false,
            observer,
        };
        Episode::starting(parts, clock)
    }
}

/// An obstacle as a camera shows it to the law; its place is that of the last look.
fn body_of(obstacle: &Obstacle) -> Body {
    Body {
        shape: obstacle.shape,
        // The law of the follower knows no regions.
        regions: Regions {
            critical_radius: 0.0,
            active_radius: 0.0,
        },
        state: BodyState {
            present: true,
            ..obstacle.motion.at(0.0, &mut 0)
        },
    }
}

/// Where the robot is, and what is around it.
struct Place<S> {
    scene: S,
    around: FollowerObstacles,
    /// Obstacles for a camera.
    bodies: Vec<Body>,
    /// Source of the sound in m.
    source: Vector2<f64>,
    pose: Frame,
    /// Velocity over the last step, in m/s.
    velocity: Vector2<f64>,
}

impl<S: Deref<Target = FollowerScene>> Place<S> {
    /// Brings obstacles and source to a time in s, of a run with a least squared distance so far in
    /// m^2.
    #[inline]
    fn look(&mut self, time: f64, least_before: f64) {
        let around = &mut self.around;
        self.source = around.look(&self.scene, time, &self.pose, least_before);
        for (body, shape) in self.bodies.iter_mut().zip(&self.around.shapes) {
            body.state.position = shape.center.into();
        }
    }

    /// Surroundings that are sensed.
    #[inline]
    fn truth(&self, time: f64) -> Truth<'_> {
        Truth {
            bodies: &self.bodies,
            outlines: &self.around.near,
            source: Some(self.source),
            ..Truth::alone(time, &self.pose, self.velocity)
        }
    }
}

/// Sensors of the robot, and what they have told.
struct Senses {
    ear: Ear,
    sonar: Sonar,
    /// It tells of the obstacles in place of the sonar.
    camera: Option<ObstacleCamera>,
    /// Obstacles as the camera knows them.
    seen: Vec<Body>,
}

impl Senses {
    /// Readings where the robot is, for a velocity in m/s that the law wants.
    #[inline]
    fn percept<S>(&self, place: &Place<S>, wanted: Vector2<f64>) -> Percept<'_> {
        Percept {
            pose: place.pose,
            velocity: place.velocity,
            wanted,
            readings: self.sonar.readings(),
            heard: self.ear.heard(),
            bodies: &self.seen,
        }
    }
}

/// Parts of a run of the follower.
pub(crate) struct FollowerParts<L, S, O> {
    place: Place<S>,
    senses: Senses,
    law: Following<L>,
    drive: VirtualVelocity,
    body_radius: f64,
    /// Its least clearance is the squared distance from the center here; the distance from the source
    /// is that of the end alone.
    outcome: FollowerOutcome,
    ended: bool,
    pub(crate) observer: O,
}

impl<L, S, O> FollowerParts<L, S, O> {
    /// How the run ended, or stands.
    pub(crate) fn outcome(&self) -> FollowerOutcome {
        let to_source = self.place.source - self.place.pose.position;
        FollowerOutcome {
            source_distance: to_source.dot(&to_source).sqrt(),
            least_clearance: self.outcome.least_clearance.sqrt() - self.body_radius,
            ..self.outcome
        }
    }

    /// Readings that the law decides by.
    #[inline]
    pub(crate) fn percept(&self) -> Percept<'_> {
        self.senses.percept(&self.place, self.drive.velocity())
    }
}

impl<L, S, O> Parts for FollowerParts<L, S, O>
where
    L: Deref<Target = FollowingLaw>,
    S: Deref<Target = FollowerScene>,
    O: SampleObserver,
{
    /// Force in N on the virtual mass in place of the law's.
    type Request = Option<Vector2<f64>>;
    const ATTENTION: usize = 1024;

    #[inline]
    fn ended(&self) -> bool {
        self.ended
    }

    #[inline]
    fn decide(
        &mut self,
        time: f64,
        request: Option<Vector2<f64>>,
        _: Interrupted<'_>,
    ) -> Result<bool> {
        let (place, senses) = (&self.place, &self.senses);
        // Its filters need every sample, whoever decides.
        let percept = senses.percept(place, self.drive.velocity());
        let forces = self.law.answer(&percept);
        let force = request.unwrap_or(forces.attraction + forces.repulsion);
        self.drive.hold(&force);
        self.observer.sample(&Sample {
            time,
            pose: &place.pose,
            virtual_velocity: self.drive.velocity(),
            wheels: self.drive.wheels(),
            target: self.law.target(),
            source: place.source,
            attraction: forces.attraction,
            repulsion: forces.repulsion,
            readings: senses.sonar.readings(),
            shapes: &place.around.shapes,
        });
        Ok(true)
    }

    #[inline]
    fn travel(&mut self, clock: &Clock, _step: usize) {
        let moved = self.drive.step();
        self.place.pose = moved.frame;
        self.place.velocity = moved.velocity;
        self.outcome.path_length += moved.speed.abs() * clock.step;
        self.outcome.turning += moved.turn_rate.abs() * clock.step;
    }

    #[inline]
    fn look_around(&mut self, clock: &Clock, step: usize) {
        let time = clock.time(step);
        // A touch counts however near the sensors look.
        let touch = self.body_radius * self.body_radius;
        let heeded = self.outcome.least_clearance.max(touch);
        self.place.look(time, heeded);
        let (place, outcome) = (&self.place, &mut self.outcome);
        outcome.end_time = time;
        outcome.least_clearance = outcome.least_clearance.min(place.around.least);
        if place.around.least < touch {
            outcome.contact = Some(place.around.contact(&place.pose));
            self.ended = true;
        }
        if let Some(camera) = &mut self.senses.camera {
            camera.watch(&place.truth(time));
        }
    }

    #[inline]
    fn check(&self, time: f64) -> Result<()> {
        let position = self.place.pose.position;
        if (position.x + position.y).is_finite() {
            return Ok(());
        }
        Err(Failure::non_finite(0, time))
    }

    fn time_over(&mut self, _time: f64) {
        self.ended = true;
    }

    #[inline]
    fn sense(&mut self, clock: &Clock, step: usize) {
        let (place, senses) = (&self.place, &mut self.senses);
        senses.ear.listen(Some(place.source), &place.pose);
        match &mut senses.camera {
            Some(camera) => {
                let truth = place.truth(clock.time(step));
                camera.observe(&truth, &place.pose, &mut senses.seen);
            }
            None if self.law.sight() == RepulsionSource::Nothing => {}
            None => senses.sonar.fire(&place.pose, &place.around.near),
        }
    }
}
