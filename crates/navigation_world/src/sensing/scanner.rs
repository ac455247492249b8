//! Mounting, beams and ranges with which scans of a lidar are read.

use crate::world::frame::Frame;
use numeric::error::{Failure, Given, Result, finite, not_negative, positive};

/// A lidar on the robot, as who reads its scans knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scanner {
    /// Its pose on the robot.
    pub mounting: Frame,
    /// Angles of its beams from straight ahead of it in rad.
    pub bearings: Vec<f64>,
    /// Least range in m.
    pub range_min: f64,
    /// Largest range in m.
    pub range_max: f64,
}

impl Scanner {
    /// Returns nothing if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(&self) -> Result<()> {
        self.mounting.checked()?;
        if self.bearings.is_empty() {
            return Err(Failure::invalid("beams", "be at least 1", Given::Count(0)));
        }
        for bearing in &self.bearings {
            finite("bearings", *bearing)?;
        }
        not_negative("range_min", self.range_min)?;
        positive("range_max", self.range_max)?;
        if self.range_max <= self.range_min {
            return Err(Failure::invalid(
                "range_max",
                "be above range_min",
                Given::Number(self.range_max),
            ));
        }
        Ok(())
    }
}
