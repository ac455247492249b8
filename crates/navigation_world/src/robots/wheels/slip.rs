//! How the ground speed of a wheel differs from the speed of its rim.

use numeric::error::{Failure, Given, Result, positive};

/// Slip of a wheel: a share of the rim speed that is always lost, and grip that limits how fast the
/// ground speed can change.
///
/// The ground speed follows `(1 - creep) r theta'`, and changes by at most `grip` per second: a
/// wheel that accelerates or brakes harder spins or locks. The source gives no slip. A wheel
/// coefficient mu allows about 9.81 mu m/s^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    /// Share of the rim speed that is lost; negative for a wheel that is larger than assumed.
    pub creep: f64,
    /// Largest acceleration that the ground gives, in m/s^2; infinite for no limit.
    pub grip: f64,
}

impl Default for Slip {
    /// No slip.
    fn default() -> Self {
        Self {
            creep: 0.0,
            grip: f64::INFINITY,
        }
    }
}

impl Slip {
    /// Returns the slip if the creep lies between -1 and 1 and the grip is positive; it may be infinite.
    ///
    /// # Errors
    /// Names the value that is out of range.
    pub fn checked(self) -> Result<Self> {
        if !(self.creep > -1.0 && self.creep < 1.0) {
            return Err(Failure::invalid(
                "creep",
                "be above -1 and below 1",
                Given::Number(self.creep),
            ));
        }
        if self.grip != f64::INFINITY {
            positive("grip", self.grip)?;
        }
        Ok(self)
    }

    /// Ground speed in m/s after a period in s, from the rim speed at its end `r theta'` and the
    /// ground speed at its start, both in m/s.
    #[must_use]
    pub fn ground_speed(&self, rim_speed: f64, ground_speed_before: f64, period: f64) -> f64 {
        let rolling = (1.0 - self.creep) * rim_speed;
        let most = self.grip * period;
        if (rolling - ground_speed_before).abs() <= most {
            return rolling;
        }
        ground_speed_before + most.copysign(rolling - ground_speed_before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_slip_is_the_rim_speed() {
        let rolling = Slip::default().checked().unwrap();
        assert_eq!(rolling.ground_speed(0.31, -4.0, 1e-3), 0.31);
    }

    #[test]
    fn grip_limits_the_change_and_creep_the_speed() {
        let ice = Slip {
            creep: 0.02,
            grip: 2.0,
        };
        assert_eq!(ice.ground_speed(0.7, 0.0, 0.01), 0.02);
        assert_eq!(ice.ground_speed(-0.7, 0.0, 0.01), -0.02);
        assert_eq!(ice.ground_speed(0.5, 0.48, 0.01), 0.49);
        let mut speed = 0.0;
        for _ in 0..1000 {
            speed = ice.ground_speed(0.7, speed, 0.01);
        }
        assert_eq!(speed, 0.98 * 0.7);
    }

    #[test]
    fn values_out_of_range_are_named() {
        let slip = Slip::default();
        assert!(Slip { creep: 1.0, ..slip }.checked().is_err());
        assert!(
            Slip {
                creep: f64::NAN,
                ..slip
            }
            .checked()
            .is_err()
        );
        assert!(Slip { grip: 0.0, ..slip }.checked().is_err());
    }
}
