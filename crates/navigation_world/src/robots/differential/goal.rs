//! Exponential convergence to a goal, with or without a heading there.

use super::drive::{DifferentialLimits, Pose, Twist, sine_ratio, wrapped};
use super::full_speed::FullSpeed;
use numeric::error::{Result, finite, not_negative, positive};

/// A reference is tracked far from the goal; near it a law in polar coordinates takes over.
///
/// With the distance `rho` to the goal at the bearing `delta`, `alpha = delta - phi` and, if the
/// robot is to look along `psi` in the end, `theta = delta - psi`, both wrapped:
///
/// `v = K_rho rho max(cos alpha, 0)`, at most the speed limit, `r = v/rho`,
/// `omega = K_alpha alpha + r sin alpha + K_theta r theta sin(alpha)/alpha`.
///
/// `(alpha^2 + K_theta theta^2)/2` then falls as `-K_alpha alpha^2`, for any speed limit; both
/// parts are scaled together where the turn rate is limited, so that the path stays the same.
/// After Aicardi, Casalino, Bicchi and Balestrino (1995), here without driving backward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExponentialGoal {
    /// How the reference is tracked before.
    pub approach: FullSpeed,
    /// `K_rho` in 1/s: rate at which the distance falls.
    pub distance_gain: f64,
    /// `K_alpha` in 1/s.
    pub bearing_gain: f64,
    /// `K_theta`, dimensionless.
    pub orientation_gain: f64,
    /// `psi` in rad; any if there is none.
    pub goal_heading: Option<f64>,
    /// Distance from the goal at which the law takes over, in m; it lets go at twice of it. May
    /// be infinite.
    pub capture_radius: f64,
    /// Distance at which the robot stands, in m: the bearing of a nearer goal is rounding.
    pub rest_radius: f64,
}

impl Default for ExponentialGoal {
    fn default() -> Self {
        Self {
            approach: FullSpeed::default(),
            distance_gain: 1.5,
            bearing_gain: 4.0,
            orientation_gain: 1.5,
            goal_heading: None,
            capture_radius: 0.5,
            rest_radius: 1e-6,
        }
    }
}

impl ExponentialGoal {
    /// Passes gains and radii that are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        self.approach.checked()?;
        positive("distance_gain", self.distance_gain)?;
        positive("bearing_gain", self.bearing_gain)?;
        not_negative("orientation_gain", self.orientation_gain)?;
        self.goal_heading
            .map_or(Ok(0.0), |heading| finite("goal_heading", heading))?;
        if self.capture_radius != f64::INFINITY {
            positive("capture_radius", self.capture_radius)?;
        }
        positive("rest_radius", self.rest_radius)?;
        Ok(self)
    }

    /// Speed and turn rate toward the goal.
    #[must_use]
    pub fn twist(&self, pose: &Pose, goal: [f64; 2], limits: &DifferentialLimits) -> Twist {
        let offset = [goal[0] - pose.position[0], goal[1] - pose.position[1]];
        let distance = offset[0].hypot(offset[1]);
        if distance <= self.rest_radius {
            let left = self
                .goal_heading
                .map_or(0.0, |heading| heading - pose.heading);
            return limits.within(Twist {
                speed: 0.0,
                turn_rate: self.bearing_gain * wrapped(left),
            });
        }
        let bearing = offset[1].atan2(offset[0]);
        let ahead = wrapped(bearing - pose.heading);
        let cos = ahead.cos().max(0.0);
        let speed = (self.distance_gain * distance * cos).min(limits.max_speed);
        let rate = speed / distance;
        let orientation = self
            .goal_heading
            .map_or(0.0, |heading| wrapped(bearing - heading));
        limits.scaled(Twist {
            speed,
            turn_rate: self.bearing_gain * ahead
                + rate * ahead.sin()
                + self.orientation_gain * rate * orientation * sine_ratio(ahead),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stands_at_the_goal_and_still_turns_to_its_heading() {
        let limits = DifferentialLimits::default();
        let law = ExponentialGoal {
            goal_heading: Some(1.0),
            ..ExponentialGoal::default()
        };
        let pose = Pose {
            position: [2.0, 3.0],
            heading: 0.5,
        };
        let twist = law.twist(&pose, [2.0, 3.0], &limits);
        assert_eq!((twist.speed, twist.turn_rate), (0.0, 2.0));
        let free = ExponentialGoal::default();
        assert_eq!(free.twist(&pose, [2.0, 3.0], &limits), Twist::default());
    }

    #[test]
    fn bearing_falls_by_its_gain_alone() {
        // Without a wanted heading d alpha/dt = r sin alpha - omega = -K_alpha alpha.
        let limits = DifferentialLimits {
            max_turn_rate: 100.0,
            ..DifferentialLimits::default()
        };
        let law = ExponentialGoal::default();
        for heading in [-3.0, -1.0, 0.2, 1.4, 3.1] {
            let pose = Pose {
                position: [0.0; 2],
                heading,
            };
            let twist = law.twist(&pose, [0.3, 0.0], &limits);
            let ahead = -heading;
            let change = twist.speed / 0.3 * ahead.sin() - twist.turn_rate;
            assert!((change + 4.0 * ahead).abs() < 1e-14);
            assert!(twist.speed >= 0.0);
        }
    }
}
