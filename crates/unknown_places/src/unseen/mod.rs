//! Where people can be whom nobody has seen: what scans leave open, and when somebody from there can be anywhere else.
//!
//! A person is a core of a radius `r_k` that never overlaps a wall and ends every beam that meets it. The belief is a
//! set of cells of a side `h`; at every update the center of everybody who is not tracked is within
//! `eta`, less than `h (1 + 1/sqrt 2)`, of the center of one of them.

mod arrivals;
mod belief;
mod cells;
mod ground;
mod sensing;

pub use arrivals::Arrivals;
pub use belief::Belief;
pub use cells::CellSet;
pub use ground::{Ground, MOST_CELLS};
pub use sensing::Sensing;

use numeric::error::{Failure, Given, Result, not_negative, positive};
use std::f64::consts::SQRT_2;

/// Assumptions about people who are not seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unseen {
    /// Radius `r` of a person in m.
    pub person_radius: f64,
    /// Radius `r_k` in m of the core of a person, which never overlaps a wall and ends every beam that meets it.
    pub person_core: f64,
    /// Side `h` of the cells in m.
    pub cell: f64,
    /// Speed in m/s up to which plans reckon with those only who are seen; 0: never.
    pub creep_speed: f64,
    /// Time between the instants at which a plan is looked at, in s.
    pub sampling: f64,
    /// Largest error of the pose of a scan, in m.
    pub pose_error: f64,
    /// Largest error of its heading in rad: beams count as far as it does not lead them astray.
    pub heading_error: f64,
    /// Largest error of a range in m: beams count so much less far.
    pub range_error: f64,
    /// Scans, where they are those of the known map.
    pub sensing: Sensing,
}

impl Default for Unseen {
    fn default() -> Self {
        Self {
            person_radius: 0.4,
            person_core: 0.15,
            cell: 0.05,
            creep_speed: 0.0,
            sampling: 0.0125,
            pose_error: 0.005,
            heading_error: 0.0,
            range_error: 0.0,
            sensing: Sensing::default(),
        }
    }
}

impl Unseen {
    /// Returns the assumptions if they are allowed.
    ///
    /// # Errors
    /// Names the number that is not: cells must be so small that a beam through a cell cannot pass by a core in it.
    pub fn checked(self) -> Result<Self> {
        positive("person_radius", self.person_radius)?;
        positive("person_core", self.person_core)?;
        positive("cell", self.cell)?;
        not_negative("creep_speed", self.creep_speed)?;
        positive("sampling", self.sampling)?;
        not_negative("pose_error", self.pose_error)?;
        not_negative("heading_error", self.heading_error)?;
        not_negative("range_error", self.range_error)?;
        self.sensing.checked()?;
        if self.person_core > self.person_radius {
            let rule = format!("be at most person_radius, {} m", self.person_radius);
            let given = Given::Number(self.person_core);
            return Err(Failure::invalid("person_core", rule, given));
        }
        if self.slack() < 0.0 {
            let most = (self.person_core - self.pose_error) / (1.0 + SQRT_2);
            let rule = format!(
                "be at most (person_core - pose_error)/(1 + sqrt 2), {most:.4} m: a beam through a larger cell can pass \
                 by somebody in it"
            );
            let given = Given::Number(self.cell);
            let advice =
                "smaller cells need more time; a person is a larger core where beams look lower";
            return Err(Failure::invalid("cell", rule, given).mended_by(advice));
        }
        Ok(self)
    }

    /// How far a beam may be from where it is taken to be, and still be ended by a core in a cell of it, in m.
    #[must_use]
    pub fn slack(&self) -> f64 {
        self.person_core - self.cell * (1.0 + SQRT_2) - self.pose_error
    }

    /// Range in m up to which beams count.
    #[must_use]
    pub fn trusted_range(&self) -> f64 {
        let astray = if self.heading_error > 0.0 {
            self.slack() / self.heading_error
        } else {
            f64::INFINITY
        };
        astray.min(self.sensing.range)
    }

    /// Distance in m from a beam within which nobody's center is: the core would have ended the beam.
    #[must_use]
    pub fn kept_by_beams(&self) -> f64 {
        self.person_core - self.pose_error - self.heading_error * self.trusted_range()
    }
}

#[cfg(test)]
mod tests;
