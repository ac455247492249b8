//! A robot with a skirt of sensors that fire in turn, among discs.

use nalgebra::Vector2;

use crate::error::{Failure, Result, positive};
use crate::run::skirt::ring::{PUBLISHED_SENSORS, PUBLISHED_WHEEL_GAP, Ring};
use crate::run::skirt::scene::DiscScene;
use crate::run::skirt::states::{Action, Decider, Policy};
use crate::run::skirt::trigger::{Rule, trigger_distances};
use crate::sensing::sonar::ranging::Normals;
use crate::sensing::sonar::{Beam, Firing, Ranging, SonarArray};
use crate::world::frame::Frame;
use crate::world::shape::PlacedShape;
use numeric::random::Stream;

/// How the skirt senses and decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkirtOptions {
    /// Safe distance `R_S` from the center, in m.
    pub safe_distance: f64,
    /// Triggering distances.
    pub rule: Rule,
    /// What decides between the rows of Table 1.
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
    decider: Decider,
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
        Ok(Self {
            decider: Decider::new(ring.bearings(), &thresholds, is_published, options.policy),
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
    pub fn decider(&self) -> &Decider {
        &self.decider
    }
}

/// How the robot moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// Speed, in m/s.
    pub speed: f64,
    /// Largest acceleration, in m/s^2.
    pub acceleration: f64,
    /// Yaw rate while it stands and turns, in rad/s.
    pub spin_rate: f64,
    /// Length of the run, in s.
    pub duration: f64,
}

impl Travel {
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

/// What a run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
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
    /// What was decided.
    pub action: Action,
}

/// Runs the robot from the origin on a course at an angle in rad until it touches a disc or the
/// time is over; `watch` sees every step.
///
/// # Errors
/// The state became non-finite.
pub fn run(
    skirt: &Skirt,
    motion: &Travel,
    scene: &DiscScene,
    course: f64,
    noise: Stream,
    mut watch: impl FnMut(&Moment<'_>),
) -> Result<Course> {
    let shapes: Vec<PlacedShape> = scene
        .discs
        .iter()
        .zip(&scene.seen)
        .filter(|(_, seen)| **seen)
        .map(|(disc, _)| *disc)
        .collect();
    let mut normals = Normals::new(noise);
    let mut readings = vec![skirt.options.most_range; skirt.ring.bearings().len()];
    let mut robot = Robot::starting(course);
    let mut found = robot.nearest(scene, skirt.ring.chassis_radius());
    let period = skirt.options.firing_period;
    let steps = steps_of(motion.duration, period);
    for step in 0..steps {
        skirt
            .array
            .measure(&robot.pose, &shapes, step, &mut readings, &mut normals);
        let fired = step % readings.len();
        if !readings[fired].is_finite() {
            readings[fired] = skirt.options.most_range;
        }
        let action = skirt.decider.action(&readings);
        robot.advance(action, motion, period);
        let time = (step + 1) as f64 * period;
        watch(&Moment {
            time,
            pose: robot.pose,
            velocity: robot.velocity,
            yaw_rate: robot.yaw_rate,
            readings: &readings,
            action,
        });
        let now = robot.nearest(scene, skirt.ring.chassis_radius());
        if !now.min_clearance.is_finite() {
            return Err(Failure::NonFinite { run: 0, time });
        }
        if now.min_clearance < found.min_clearance {
            found = now;
        }
        if now.min_clearance <= 0.0 {
            found.contact_time = Some(time);
            break;
        }
    }
    Ok(found)
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

struct Robot {
    pose: Frame,
    heading: f64,
    velocity: Vector2<f64>,
    yaw_rate: f64,
    /// Direction of motion in the frame of the body, in rad.
    direction: f64,
    target: Vector2<f64>,
}

impl Robot {
    /// At rest at the origin.
    fn starting(course: f64) -> Self {
        let (sin, cos) = course.sin_cos();
        Self {
            pose: Frame::at([0.0, 0.0], 0.0),
            heading: 0.0,
            velocity: Vector2::zeros(),
            yaw_rate: 0.0,
            direction: course,
            target: Vector2::new(cos, sin),
        }
    }

    /// One period with the acceleration limited; the robot turns only where it spins.
    fn advance(&mut self, action: Action, motion: &Travel, period: f64) {
        let spins = action == Action::Spin;
        self.yaw_rate = if spins { motion.spin_rate } else { 0.0 };
        if spins {
            self.heading += self.yaw_rate * period;
            self.pose = Frame::at(self.pose.position.into(), self.heading);
        }
        if let Action::Move(direction) = action {
            self.direction = direction.angle();
        }
        if action != Action::Keep {
            let (sin, cos) = (self.heading + self.direction).sin_cos();
            self.target = Vector2::new(cos, sin);
        }
        let speed = if spins { 0.0 } else { motion.speed };
        let change = self.target * speed - self.velocity;
        let size = change.dot(&change).sqrt();
        let most = motion.acceleration * period;
        let share = if size > most { most / size } else { 1.0 };
        self.velocity += change * share;
        self.pose.position += self.velocity * period;
    }

    /// Clearance of the nearest disc.
    fn nearest(&self, scene: &DiscScene, chassis_radius: f64) -> Course {
        let mut found = Course {
            min_clearance: f64::INFINITY,
            nearest: 0,
            contact_time: None,
        };
        for (index, disc) in scene.discs.iter().enumerate() {
            let to = disc.center - self.pose.position;
            let clearance = to.dot(&to).sqrt() - disc.shape.inner_radius() - chassis_radius;
            // A state that is no number must not pass for a distance.
            if clearance < found.min_clearance || clearance.is_nan() {
                found.min_clearance = clearance;
                found.nearest = index;
            }
        }
        found
    }
}
