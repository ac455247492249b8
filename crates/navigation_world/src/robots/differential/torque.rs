//! Virtual torque: a law that brings its own steering drives without a reference robot.

use super::drive::{DifferentialLimits, Pose, Twist, wrapped};
use crate::robots::DifferentialDriveRobot;
use numeric::error::{Result, finite_pair, not_negative, positive};

/// Turns the robot toward the force, (2.2.7) of Zeng (2011): `M_phi = K_BT Y`, `Y` the angle from
/// the heading to the force `F_V`, wrapped.
///
/// The torque turns a disc of the inertia `J = m rho^2/2` against a damping torque `c omega`, and
/// the force along the heading moves it: `J domega/dt = M_phi - c omega`, `m dv/dt = F_V . h`. The
/// source names neither inertia nor damping; without damping the heading oscillates for ever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualTorque {
    /// `K_BT` in N m/rad.
    pub torque_gain: f64,
    /// Damping ratio `c / (2 sqrt(J K_BT))`, dimensionless.
    pub damping_ratio: f64,
    /// Whether the force may drive the robot backward.
    pub backward: bool,
}

impl Default for VirtualTorque {
    /// For the robot of Zeng (2011), chapter 7, at 6 rad/s, the heading gain of
    /// [`FullSpeed`](super::FullSpeed): 2.664 N m/rad.
    fn default() -> Self {
        Self::tuned(&DifferentialDriveRobot::default(), 6.0)
    }
}

impl VirtualTorque {
    /// The gain that gives a robot the angular frequency `frequency` in rad/s, critically damped:
    /// `K_BT = J frequency^2`.
    #[must_use]
    pub fn tuned(robot: &DifferentialDriveRobot, frequency: f64) -> Self {
        Self {
            torque_gain: inertia(robot) * frequency * frequency,
            damping_ratio: 1.0,
            backward: false,
        }
    }

    /// Passes values that are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        positive("torque_gain", self.torque_gain)?;
        not_negative("damping_ratio", self.damping_ratio)?;
        Ok(self)
    }

    /// `M_phi` in N m at a heading; 0 for no force.
    #[must_use]
    pub fn torque(&self, heading: f64, force: [f64; 2]) -> f64 {
        if force == [0.0; 2] {
            return 0.0;
        }
        self.torque_gain * wrapped(force[1].atan2(force[0]) - heading)
    }
}

/// Moment of inertia of the disc that models the robot, `m rho^2/2`, in kg m^2.
fn inertia(robot: &DifferentialDriveRobot) -> f64 {
    0.5 * robot.mass * robot.radius * robot.radius
}

/// A virtual torque at work on a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueSteering {
    law: VirtualTorque,
    limits: DifferentialLimits,
    mass: f64,
    inertia: f64,
    /// Damping `c` in N m s/rad.
    damping: f64,
    /// Control period in s.
    period: f64,
}

impl TorqueSteering {
    /// Steering of a robot with limits, called every `period` s. Values are taken as checked.
    #[must_use]
    pub fn new(
        law: &VirtualTorque,
        robot: &DifferentialDriveRobot,
        limits: &DifferentialLimits,
        period: f64,
    ) -> Self {
        let inertia = inertia(robot);
        Self {
            law: *law,
            limits: *limits,
            mass: robot.mass,
            inertia,
            damping: 2.0 * law.damping_ratio * (inertia * law.torque_gain).sqrt(),
            period,
        }
    }

    /// Speed and turn rate to ask for until the next call, from a force in N.
    ///
    /// Over one period the force is held and the damping torque taken at the end,
    /// `omega' = (J omega + T M_phi)/(J + T c)`, which is stable for any damping.
    #[must_use]
    pub fn command(&self, pose: &Pose, twist: Twist, force: [f64; 2]) -> Twist {
        let (sin, cos) = pose.heading.sin_cos();
        let along = force[0] * cos + force[1] * sin;
        let speed = twist.speed + self.period * along / self.mass;
        let torque = self.law.torque(pose.heading, force);
        let turn_rate = (self.inertia * twist.turn_rate + self.period * torque)
            / (self.inertia + self.period * self.damping);
        self.limits.within(Twist {
            speed: if self.law.backward {
                speed
            } else {
                speed.max(0.0)
            },
            turn_rate,
        })
    }

    /// Command for a force that comes from elsewhere.
    ///
    /// # Errors
    /// The force is not finite.
    pub fn checked_command(&self, pose: &Pose, twist: Twist, force: [f64; 2]) -> Result<Twist> {
        finite_pair("force", force)?;
        Ok(self.command(&pose.checked()?, twist.checked()?, force))
    }
}
