//! Inputs of a controller, and its orders.

use navigation_laws::shield::{Course, Deviation, Status};
use navigation_world::robots::differential::Twist;
use navigation_world::world::geometry::RobotState;
use numeric::lanes::Vector2;

/// Where somebody was measured to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Which obstacle of the scenario.
    pub index: usize,
    /// Center in m.
    pub position: [f64; 2],
    /// Velocity in m/s.
    pub velocity: [f64; 2],
    /// When, in s; `None` where only the update that tells of it is known.
    pub time: Option<f64>,
}

/// Input of a controller at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// When, in s.
    pub time: f64,
    /// The robot, `None` where it is not known.
    pub robot: Option<RobotState<f64>>,
    /// Its heading in rad.
    pub heading: f64,
    /// Whom a sensor has measured.
    pub seen: &'a [Sighting],
    /// Who is known to have left.
    pub gone: &'a [usize],
    /// Ranges of the beams of the lidar in m, NaN where nothing is known, if it has scanned.
    pub scan: Option<&'a [f64]>,
}

/// Result of an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timing {
    /// It came in time.
    Regular,
    /// It came later than a period after the last one: the robot has to have braked until then.
    Late,
    /// It is not later than the last one, or the robot was measured to be farther on in its plan than the time tells,
    /// and counts for nothing: the plan runs on to its end.
    OutOfOrder,
    /// The place of the robot is not known: it brakes.
    Lost,
}

impl Timing {
    /// Its word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Regular => "regular",
            Self::Late => "late",
            Self::OutOfOrder => "out_of_order",
            Self::Lost => "lost",
        }
    }
}

/// Order to a robot until the next update.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldOrder {
    /// Force in N.
    pub force: Vector2<f64>,
    /// Velocity at the next sample in m/s.
    pub velocity: Vector2<f64>,
    /// Order for two wheels.
    pub twist: Option<Twist>,
    /// The plan that the robot executes, and its time at the update, in s.
    pub course: Option<(Course, f64)>,
    /// How far the robot was measured to be from the plan before, if that refutes what the shield assumes.
    pub off_plan: Option<Deviation>,
    /// Decision of the shield, if there is one.
    pub status: Option<Status>,
    /// Whether the law was taken over from.
    pub taken_over: bool,
    /// Result of the update.
    pub timing: Timing,
    /// Whether the robot is within the arrival tolerance of the goal.
    pub arrived: bool,
    /// By how much the clock was seen to be set back at least, in s.
    pub clock_set_back: Option<f64>,
    /// Age of the oldest measurement that counts, in s; infinite where it is not known.
    pub oldest: f64,
    /// Beams of the last scan that read nothing at all.
    pub unknown_beams: usize,
}
