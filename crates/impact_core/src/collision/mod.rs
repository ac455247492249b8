//! Collision of a robot with a person through a covering.
//!
//! In the frame of the torso; the force `f` is common to covering and region, whose skin has no mass,
//! and `eps = x_r - x_h = d + delta` is what both give way together:
//!
//! ```text
//! M_r x_r'' = -f - C_r (x_r' - x_d') - K_r (x_r - x_d)     x_d = v t until a stop, then to rest
//! M_h x_h'' =  f - C_h x_h' - K_h x_h                      x_h = 0 where the body is clamped
//! f = F(d) R(eps') U(d) = g(eps - d)                       without a damper
//! C_c d' = g(eps - d) - F(d) R U                           with one
//! f = F(eps) R U + C_c eps'                                on a rigid region
//! ```
//!
//! A driven contact pushes at most with a limit, brakes from when the force was noticed on, and continues beyond a
//! release: the drive brings the robot back.

mod curve;
mod events;
mod injury;
mod loading;
mod mechanics;
mod outcome;
#[cfg(test)]
pub(crate) mod reading;
mod region;
mod run;
mod statics;
mod step;
mod stored;
#[cfg(test)]
mod tests;

pub use outcome::{CollisionStatus, MotionSample, Outcome};
pub use region::Region;
pub use run::{INJURY_WINDOWS, Wanted, simulate, simulate_all};
pub use statics::{Rest, rest_of};

use crate::covering::Pad;
use crate::error::{Failure, Given, Result, finite, not_negative, positive};

/// Time after which a collision is left alone by default, in s.
pub const HORIZON: f64 = 0.2;
/// Relative tolerance by default.
pub const TOLERANCE: f64 = 1e-8;
/// Longest horizon, in s.
const LONGEST: f64 = 60.0;
/// Shortest time in which a damper of a covering may relax, in s.
const SHORTEST_RELAXATION: f64 = 1e-6;

/// A body: its mass and what holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportedBody {
    /// Mass, in kg; infinite where it cannot move or yield.
    pub mass: f64,
    /// Damping of its support, in N s/m.
    pub damping: f64,
    /// Stiffness of its support, in N/m.
    pub stiffness: f64,
}

impl SupportedBody {
    /// A body that nothing holds.
    #[must_use]
    pub fn free(mass: f64) -> Self {
        Self {
            mass,
            damping: 0.0,
            stiffness: 0.0,
        }
    }

    fn check(&self, [mass, damping, stiffness]: [&str; 3]) -> Result<()> {
        if self.mass != f64::INFINITY {
            positive(mass, self.mass)?;
        }
        not_negative(damping, self.damping)?;
        not_negative(stiffness, self.stiffness)?;
        Ok(())
    }

    fn is_held(&self) -> bool {
        self.damping > 0.0 || self.stiffness > 0.0
    }
}

/// The robot's set point brakes from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Braking {
    /// Start of braking, in s after the first touch.
    pub time: f64,
    /// Deceleration, in m/s^2.
    pub deceleration: f64,
}

/// Reaction of a drive beside a spring and a damper, and its detection of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driven {
    /// Force at which the robot notices the contact, in N: the time of the stop counts from there.
    pub detection_force: f64,
    /// Largest force of spring and damper of the robot, in N; infinite without one.
    pub push_limit: f64,
}

/// A collision.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision<'a> {
    /// The robot.
    pub robot: SupportedBody,
    /// The body; clamped if its mass is infinite.
    pub body: SupportedBody,
    /// Region of the body that is touched.
    pub region: Region,
    /// The covering; `None`: bare.
    pub pad: Option<&'a Pad>,
    /// Closing speed, in m/s.
    pub closing_speed: f64,
    /// Stop of the set point.
    pub stop: Option<Braking>,
    /// Limits of the drive, of a contact that is followed to the horizon.
    pub driven: Option<Driven>,
    /// Horizon of the simulation, in s.
    pub horizon: f64,
    /// Relative tolerance.
    pub tolerance: f64,
}

impl Collision<'_> {
    /// Reduced mass of both bodies.
    #[must_use]
    pub fn reduced_mass(&self) -> f64 {
        reduced_mass(self.robot.mass, self.body.mass)
    }

    /// Checks what is not the pad's.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn check(&self) -> Result<()> {
        self.robot
            .check(["robot_mass", "robot_damping", "robot_stiffness"])?;
        self.body
            .check(["body_mass", "body_damping", "body_stiffness"])?;
        self.region.checked()?;
        finite("closing_speed", self.closing_speed)?;
        positive("horizon", self.horizon)?;
        if self.horizon > LONGEST {
            let rule = format!("be at most {LONGEST}");
            return Err(Failure::invalid(
                "horizon",
                rule,
                Given::Number(self.horizon),
            ));
        }
        if !(1e-12..=1e-3).contains(&self.tolerance) {
            let rule = "be from 1e-12 to 1e-3";
            return Err(Failure::invalid(
                "tolerance",
                rule,
                Given::Number(self.tolerance),
            ));
        }
        if let Some(stop) = self.stop {
            not_negative("stop.time", stop.time)?;
            positive("stop.deceleration", stop.deceleration)?;
        }
        if let Some(driven) = self.driven {
            not_negative("detection_force", driven.detection_force)?;
            if driven.push_limit != f64::INFINITY {
                positive("push_limit", driven.push_limit)?;
            }
        }
        if self.pad.is_none() && self.region == Region::Rigid {
            let given = Given::Found("none on a rigid region".into());
            let failure = Failure::invalid("covering", "be given, or the region yield", given);
            return Err(failure);
        }
        self.check_damper()
    }

    fn check_damper(&self) -> Result<()> {
        let Some(pad) = self.pad else { return Ok(()) };
        let damping = pad.covering.damping;
        if damping == 0.0 || self.region == Region::Rigid {
            return Ok(());
        }
        let most = pad
            .covering
            .bottoming
            .strain
            .min(pad.covering.material.bound());
        let mut depth = most * pad.covering.thickness;
        let mut force = pad.force(depth)[0];
        if !force.is_finite() {
            depth *= 0.8;
            force = pad.force(depth)[0];
        }
        let region = match self.region {
            Region::Spring { stiffness, .. } => stiffness,
            other => other.force(depth)[1],
        };
        let relaxation = damping / (region + force / depth);
        if relaxation < SHORTEST_RELAXATION {
            let rule = format!(
                "not be too_small: it relaxes in {relaxation:.3e} s, less than {SHORTEST_RELAXATION:?} s"
            );
            return Err(
                Failure::invalid("covering.damping", rule, Given::Number(damping))
                    .mended_by("leave the damper out"),
            );
        }
        Ok(())
    }
}

/// `m_1 m_2/(m_1 + m_2)`; either mass may be infinite.
#[must_use]
pub fn reduced_mass(first: f64, second: f64) -> f64 {
    1.0 / (1.0 / first + 1.0 / second)
}
