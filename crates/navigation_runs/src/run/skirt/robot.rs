//! A robot with a skirt of sensors that fire in turn, among discs.

use std::ops::Deref;
use std::sync::Arc;

use nalgebra::Vector2;

use crate::run::Interrupted;
use crate::run::episode::{Episode, Parts};
use crate::run::options::Clock;
use crate::run::skirt::scene::DiscScene;
use navigation_laws::escape::{Decider, EscapeAction, Policy, Rule, trigger_distances};
use navigation_laws::reflex::{Percept, Reflex};
use navigation_world::robots::drives::{
    Drive, LimitedOmni, Moved, OmniCommand as Order, OmniLimits,
};
use navigation_world::sensing::sonar::ring::{PUBLISHED_SENSORS, PUBLISHED_WHEEL_GAP, Ring};
use navigation_world::sensing::sonar::{Beam, Firing, Ranging, Sonar, SonarArray};
use navigation_world::world::frame::Frame;
use navigation_world::world::shape::{PlacedShape, SLACK};
use numeric::error::{Failure, Result, positive};
use numeric::random::Stream;

/// A robot that passes a disc within a step touches it if they overlap by more, in m.
const PASSED: f64 = 1e-9;

/// How the skirt senses and decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkirtOptions {
    /// Safe distance `R_S` from the center, in m.
    pub safe_distance: f64,
    /// Triggering distances.
    pub rule: Rule,
    /// Rule between the rows of Table 1.
    pub policy: Policy,
    /// Full angle of a beam, in rad.
    pub beam_width: f64,
    /// Rays of a beam.
    pub rays: usize,
    /// Smallest reading, in m; nearer echoes are lost.
    pub least_range: f64,
    /// Largest reading, in m; it is also the reading without echo.
    pub most_range: f64,
    /// Standard deviation of a reading, in m.
    pub range_noise: f64,
    /// Time between two sensors, in s.
    pub firing_period: f64,
}

/// A ring of sensors and its decisions.
#[derive(Clone, Debug, PartialEq)]
pub struct Skirt {
    ring: Ring,
    options: SkirtOptions,
    thresholds: Vec<f64>,
    array: SonarArray,
    decider: Arc<Decider>,
}

impl Skirt {
    /// A skirt on a ring.
    ///
    /// # Errors
    /// An option is out of range.
    pub fn new(ring: Ring, options: SkirtOptions) -> Result<Self> {
        positive("firing_period", options.firing_period)?;
        let thresholds = trigger_distances(&ring, options.safe_distance, options.rule)?;
        let mounts = ring.bearings().iter().map(|bearing| {
            let (sin, cos) = bearing.sin_cos();
            let radius = ring.face_radius();
            Frame::at([radius * cos, radius * sin], *bearing)
        });
        let ranging = Ranging {
            least: options.least_range,
            most: options.most_range,
            noise: options.range_noise,
            ..Ranging::default()
        };
        let beam = Beam::new(options.beam_width, options.rays)?;
        let array = SonarArray::new(mounts.collect(), beam, ranging, Firing::InTurn)?;
        let published = Ring::beside_wheels(PUBLISHED_SENSORS, PUBLISHED_WHEEL_GAP)?;
        let is_published = ring.bearings() == published;
        let policy = options.policy;
        let decider = Decider::new(ring.bearings(), &thresholds, is_published, policy);
        Ok(Self {
            decider: Arc::new(decider),
            ring,
            options,
            thresholds,
            array,
        })
    }

    /// Places of the sensors.
    #[must_use]
    pub fn ring(&self) -> &Ring {
        &self.ring
    }

    /// How the skirt senses and decides.
    #[must_use]
    pub fn options(&self) -> &SkirtOptions {
        &self.options
    }

    /// Triggering distances, in m.
    #[must_use]
    pub fn thresholds(&self) -> &[f64] {
        &self.thresholds
    }

    /// Pattern and action for readings.
    #[must_use]
    pub fn decider(&self) -> &Arc<Decider> {
        &self.decider
    }
}

/// How the robot moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkirtTravel {
    /// Speed, in m/s.
    pub speed: f64,
    /// Largest acceleration, in m/s^2.
    pub acceleration: f64,
    /// Yaw rate while it stands and turns, in rad/s.
    pub spin_rate: f64,
    /// Length of the run, in s.
    pub duration: f64,
}

impl SkirtTravel {
    /// Returns the motion if its values are valid.
    ///
    /// # Errors
    /// A number is not finite and positive.
    pub fn checked(self) -> Result<Self> {
        positive("speed", self.speed)?;
        positive("acceleration", self.acceleration)?;
        positive("spin_rate", self.spin_rate)?;
        positive("duration", self.duration)?;
        Ok(self)
    }
}

/// Result of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkirtResult {
    /// Least distance between the surfaces of robot and discs, in m; not positive after contact.
    pub min_clearance: f64,
    /// Disc that was the nearest then.
    pub nearest: usize,
    /// When the robot touched a disc and the run ended, in s.
    pub contact_time: Option<f64>,
}

/// State of the robot after a sensor has fired and the robot has moved on.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// Time, in s.
    pub time: f64,
    /// Frame; its direction is the east of the body.
    pub pose: Frame,
    /// Velocity, in m/s.
    pub velocity: Vector2<f64>,
    /// Yaw rate, in rad/s.
    pub yaw_rate: f64,
    /// Latest readings, in m.
    pub readings: &'a [f64],
    /// Decision.
    pub action: EscapeAction,
}

/// Receives moments.
pub trait MomentObserver {
    /// Takes the state after a firing period.
    fn moment(&mut self, moment: &Moment<'_>);
}

impl<F: FnMut(&Moment<'_>)> MomentObserver for F {
    #[inline]
    fn moment(&mut self, moment: &Moment<'_>) {
        self(moment);
    }
}

/// Runs the robot from the origin on a course at an angle in rad until it touches a disc or the
/// time is over; `watch` sees every step.
///
/// # Errors
/// The state became non-finite, or the caller asked to stop.
pub fn run(
    skirt: &Skirt,
    motion: &SkirtTravel,
    scene: &DiscScene,
    start: (f64, Stream),
    watch: impl FnMut(&Moment<'_>),
    interrupted: Interrupted<'_>,
) -> Result<SkirtResult> {
    let episode = episode(skirt, &*skirt.decider, motion, scene, start, watch)?;
    Ok(episode.run(interrupted)?.parts.found)
}

/// A run at its start; it refers to law and scene, or shares them.
pub(crate) fn episode<D, S, W>(
    skirt: &Skirt,
    law: D,
    motion: &SkirtTravel,
    scene: S,
    (course, noise): (f64, Stream),
    watch: W,
) -> Result<Episode<SkirtParts<D, S, W>>>
where
    D: Deref<Target = Decider>,
    S: Deref<Target = DiscScene>,
    W: MomentObserver,
{
    let period = skirt.options.firing_period;
    let clock = Clock {
        step: period,
        steps_per_sample: 1,
        steps: steps_of(motion.duration, period),
        interval: period,
    };
    let limits = OmniLimits {
        speed: motion.speed,
        acceleration: motion.acceleration,
        turn_rate: motion.spin_rate,
    };
    let seen = scene.discs.iter().zip(&scene.seen);
    let mut parts = SkirtParts {
        outlines: seen
            .filter(|(_, seen)| **seen)
            .map(|(disc, _)| *disc)
            .collect(),
        scene,
        sonar: Sonar::new(&skirt.array, noise, skirt.options.most_range),
        law,
        action: EscapeAction::Keep,
        drive: LimitedOmni::new(limits, course, period),
        robot: Moved {
            frame: Frame::at([0.0, 0.0], 0.0),
            velocity: Vector2::zeros(),
            speed: 0.0,
            turn_rate: 0.0,
        },
        chassis_radius: skirt.ring.chassis_radius(),
        clearance: 0.0,
        found: SkirtResult {
            min_clearance: f64::INFINITY,
            nearest: 0,
            contact_time: None,
        },
        ended: false,
        watch,
    };
    parts.account(Vector2::zeros());
    Episode::starting(parts, clock)
}

/// Whole steps that fill a duration.
#[must_use]
pub fn steps_of(duration: f64, period: f64) -> usize {
    // A quotient that is whole up to rounding counts as whole.
    let steps = (duration / period - 1e-9).ceil();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // positive, saturates
    let steps = steps as usize;
    steps.max(1)
}

/// Parts of a run within a ring of sensors.
pub(crate) struct SkirtParts<D, S, W> {
    scene: S,
    /// Discs that the sensors can see.
    outlines: Vec<PlacedShape>,
    sonar: Sonar,
    law: D,
    /// Last decision.
    action: EscapeAction,
    drive: LimitedOmni,
    robot: Moved,
    chassis_radius: f64,
    /// Clearance now, in m.
    clearance: f64,
    /// Result so far.
    pub(crate) found: SkirtResult,
    ended: bool,
    pub(crate) watch: W,
}

impl<D, S: Deref<Target = DiscScene>, W> SkirtParts<D, S, W> {
    /// Readings that the law decides by.
    #[inline]
    pub(crate) fn percept(&self) -> Percept<'_> {
        Percept {
            pose: self.robot.frame,
            velocity: self.robot.velocity,
            wanted: self.robot.velocity,
            readings: self.sonar.readings(),
            heard: None,
            bodies: &[],
        }
    }

    /// Accounts for where the robot is, after a straight way from another place.
    #[inline]
    fn account(&mut self, from: Vector2<f64>) {
        let (mut clearance, mut nearest) = (f64::INFINITY, 0);
        for (index, disc) in self.scene.discs.iter().enumerate() {
            let to = disc.center - self.robot.frame.position;
            let (square, radius) = (to.dot(&to), disc.shape.inner_radius());
            let least = (clearance + radius + self.chassis_radius) * SLACK;
            // Who is farther than the nearest so far needs no root.
            if square > least * least && clearance > 0.0 {
                continue;
            }
            let gap = square.sqrt() - radius - self.chassis_radius;
            // A state that is no number must not pass for a distance.
            if gap < clearance || gap.is_nan() {
                (clearance, nearest) = (gap, index);
            }
        }
        let way = self.robot.frame.position - from;
        // No point of the way is farther from its end than its length.
        if clearance > 0.0 && clearance * clearance < way.dot(&way) {
            (clearance, nearest) = self.between(from, (clearance, nearest));
        }
        self.clearance = clearance;
        if clearance < self.found.min_clearance {
            self.found.min_clearance = clearance;
            self.found.nearest = nearest;
        }
    }
}

impl<D, S: Deref<Target = DiscScene>, W> SkirtParts<D, S, W> {
    /// Clearance in m from the disc that is nearest on the straight way from a place, and that disc, if it is touched
    /// there; else those at the end of the way.
    #[cold]
    fn between(&self, from: Vector2<f64>, at_end: (f64, usize)) -> (f64, usize) {
        let discs = self.scene.discs.iter().enumerate();
        let gaps = discs.map(|(index, disc)| {
            let distance = disc.distance_of_segment(from, self.robot.frame.position);
            (distance - self.chassis_radius, index)
        });
        let least = gaps.fold(
            at_end,
            |least, each| if each.0 < least.0 { each } else { least },
        );
        if least.0 < -PASSED { least } else { at_end }
    }
}

/// Order to the drive.
fn order_of(action: EscapeAction) -> Order {
    match action {
        EscapeAction::Keep => Order::Keep,
        EscapeAction::Spin => Order::Turn,
        EscapeAction::Move(direction) => Order::Toward(direction.angle()),
    }
}

impl<D, S, W> Parts for SkirtParts<D, S, W>
where
    D: Deref<Target = Decider>,
    S: Deref<Target = DiscScene>,
    W: MomentObserver,
{
    /// Action in place of the law's decision.
    type Request = Option<EscapeAction>;
    const ATTENTION: usize = 1024;

    #[inline]
    fn ended(&self) -> bool {
        self.ended
    }

    #[inline]
    fn decide(
        &mut self,
        _time: f64,
        request: Option<EscapeAction>,
        _: Interrupted<'_>,
    ) -> Result<bool> {
        self.action = request.unwrap_or_else(|| (&*self.law).answer(&self.percept()));
        self.drive.hold(&order_of(self.action));
        Ok(true)
    }

    #[inline]
    fn travel(&mut self, clock: &Clock, step: usize) {
        let from = self.robot.frame.position;
        self.robot = self.drive.step();
        let time = clock.time(step + 1);
        self.watch.moment(&Moment {
            time,
            pose: self.robot.frame,
            velocity: self.robot.velocity,
            yaw_rate: self.robot.turn_rate,
            readings: self.sonar.readings(),
            action: self.action,
        });
        self.account(from);
        if self.clearance <= 0.0 {
            self.found.contact_time = Some(time);
            self.ended = true;
        }
    }

    /// The discs stand, and no sensor looks between samples.
    fn look_around(&mut self, _clock: &Clock, _step: usize) {}

    #[inline]
    fn check(&self, time: f64) -> Result<()> {
        if self.clearance.is_finite() {
            return Ok(());
        }
        Err(Failure::non_finite(0, time))
    }

    fn time_over(&mut self, _time: f64) {
        self.ended = true;
    }

    #[inline]
    fn sense(&mut self, _clock: &Clock, _step: usize) {
        self.sonar.fire(&self.robot.frame, &self.outlines);
    }
}
