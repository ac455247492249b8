//! The tracking laws behind one interface.

use super::drive::{DifferentialLimits, Pose, Twist};
use super::full_speed::{FullSpeed, STANDSTILL};
use super::goal::ExponentialGoal;
use super::nonlinear::Nonlinear;
use super::reference::Reference;
use numeric::error::Result;

/// A captured robot is let go at this multiple of the capture radius.
const RELEASE: f64 = 2.0;

/// How a two-wheel robot follows a reference robot that moves in any direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tracking {
    /// Along the sum of reference velocity and position error; up to the full speed.
    FullSpeed(FullSpeed),
    /// The law of the source, corrected, or as printed.
    Nonlinear(Nonlinear),
    /// Full speed like `FullSpeed`; near the goal exponentially to it, whatever the reference does there.
    ExponentialGoal(ExponentialGoal),
}

impl Default for Tracking {
    fn default() -> Self {
        Self::FullSpeed(FullSpeed::default())
    }
}

impl Tracking {
    /// Returns the law if its numbers are in range.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        match self {
            Self::FullSpeed(law) => law.checked().map(Self::FullSpeed),
            Self::Nonlinear(law) => law.checked().map(Self::Nonlinear),
            Self::ExponentialGoal(law) => law.checked().map(Self::ExponentialGoal),
        }
    }
}

/// A tracking law at work: it remembers the direction of the reference and the goal phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Tracker {
    tracking: Tracking,
    limits: DifferentialLimits,
    /// Control period in s.
    period: f64,
    /// Last direction of a reference that moved, in rad.
    direction: Option<f64>,
    captured: bool,
    may_capture: bool,
}

impl Tracker {
    /// Tracker for a robot with limits, called every `period` s. Values are taken as checked.
    #[must_use]
    pub fn new(tracking: &Tracking, limits: &DifferentialLimits, period: f64) -> Self {
        Self {
            tracking: *tracking,
            limits: *limits,
            period,
            direction: None,
            captured: false,
            may_capture: true,
        }
    }

    /// Whether the goal phase may begin or continue; say no while the robot is in the active region
    /// of an obstacle, for the goal phase knows none.
    pub fn permit_goal_phase(&mut self, permitted: bool) {
        self.may_capture = permitted;
    }

    /// Whether the last command was one of the goal phase.
    #[must_use]
    pub fn in_goal_phase(&self) -> bool {
        self.captured
    }

    /// Speed and turn rate to ask for until the next call, within the limits of both.
    pub fn command(&mut self, pose: &Pose, reference: &Reference, goal: [f64; 2]) -> Twist {
        match self.tracking {
            Tracking::FullSpeed(law) => {
                law.twist(pose, reference, self.turn_rate(reference), &self.limits)
            }
            Tracking::Nonlinear(law) => {
                let turn = self.turn_rate(reference);
                if reference.speed() > STANDSTILL {
                    let [x, y] = reference.velocity;
                    self.direction = Some(y.atan2(x));
                }
                let direction = self.direction.unwrap_or(pose.heading);
                let motion = (direction, turn);
                law.twist(pose, reference, motion, &self.limits, self.period)
            }
            Tracking::ExponentialGoal(law) => {
                self.captured = self.captures(&law, pose, goal);
                if self.captured {
                    law.twist(pose, goal, &self.limits)
                } else {
                    let turn = self.turn_rate(reference);
                    law.approach.twist(pose, reference, turn, &self.limits)
                }
            }
        }
    }

    fn captures(&self, law: &ExponentialGoal, pose: &Pose, goal: [f64; 2]) -> bool {
        let distance = (goal[0] - pose.position[0]).hypot(goal[1] - pose.position[1]);
        let radius = if self.captured {
            RELEASE * law.capture_radius
        } else {
            law.capture_radius
        };
        self.may_capture && distance <= radius
    }

    /// `d phi_d/dt` as far as the robot can turn, 0 while the reference stands, in rad/s.
    fn turn_rate(&self, reference: &Reference) -> f64 {
        let limit = self.limits.max_turn_rate;
        reference
            .turn_rate()
            .map_or(0.0, |turn| turn.clamp(-limit, limit))
    }
}
