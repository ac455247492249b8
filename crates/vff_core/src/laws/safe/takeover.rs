//! The way out of a local minimum: who comes no nearer for some time drives straight to the goal,
//! shielded, until he does.

use crate::error::{Result, positive};
use crate::lanes::Vector2;

/// When the law is taken over from, and given back to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Takeover {
    /// Progress that counts, as time at the largest speed of the law, in s.
    pub progress: f64,
    /// Longest time without it in s.
    pub window: f64,
}

impl Default for Takeover {
    fn default() -> Self {
        Self {
            progress: 0.6,
            window: 0.7,
        }
    }
}

impl Takeover {
    /// Returns it if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        positive("progress", self.progress)?;
        positive("window", self.window)?;
        Ok(self)
    }
}

/// The watch over progress in one run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    settings: Takeover,
    /// Distance to go at the last progress, in m, and when that was, in s.
    mark: Option<(f64, f64)>,
}

impl Progress {
    pub fn new(settings: Takeover) -> Self {
        Self {
            settings,
            mark: None,
        }
    }

    /// Whether the law is taken over from, with a distance to go in m, at a time in s.
    pub fn stalls(&mut self, to_go: f64, time: f64, max_speed: f64) -> bool {
        let delta = self.settings.progress * max_speed;
        match self.mark {
            Some((mark, since)) if to_go > mark - delta => {
                time - since >= self.settings.window - 1e-9
            }
            _ => {
                self.mark = Some((to_go, time));
                false
            }
        }
    }
}

/// Velocity straight to the goal that can still stop there.
pub(super) fn straight(
    to_goal: Vector2<f64>,
    max_speed: f64,
    max_acceleration: f64,
    period: f64,
) -> Vector2<f64> {
    let distance = to_goal.norm();
    if distance == 0.0 {
        return Vector2::zeros();
    }
    let speed = max_speed
        .min((2.0 * max_acceleration * distance).sqrt())
        .min(distance / period);
    to_goal * (speed / distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_that_stands_is_taken_over_from_until_it_comes_nearer() {
        let mut progress = Progress::new(Takeover::default());
        let at = |step: u32| f64::from(step) * 0.1;
        let stalled: Vec<bool> = (0..10)
            .map(|step| progress.stalls(5.0, at(step), 1.0))
            .collect();
        assert_eq!(stalled.iter().position(|stalled| *stalled), Some(7));
        assert!(progress.stalls(4.41, at(10), 1.0));
        assert!(!progress.stalls(4.39, at(11), 1.0));
    }

    #[test]
    fn the_straight_velocity_stops_at_the_goal() {
        let far = straight(Vector2::new(0.0, 5.0), 1.0, 10.0, 0.1);
        assert_eq!(far, Vector2::new(0.0, 1.0));
        let near = straight(Vector2::new(0.02, 0.0), 1.0, 10.0, 0.1);
        assert!((near.x - 0.2).abs() < 1e-12);
    }
}
