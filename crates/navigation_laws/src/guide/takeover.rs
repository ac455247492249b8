//! The takeover: a robot that no longer gets nearer goes to its local goal itself.

use nalgebra::Vector2;

use crate::guide::plan::LocalGoal;
use numeric::error::{Result, positive};

/// Rounding of times, in s, and of costs, in m.
const ROUNDING: f64 = 1e-9;

/// When to take over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TakeoverRule {
    /// Progress that counts, `delta`, in m.
    pub progress: f64,
    /// Time without progress until the takeover, in s.
    pub window: f64,
}

impl TakeoverRule {
    /// The rule under a plan.
    #[must_use]
    pub fn with_map() -> Self {
        Self {
            progress: 0.3,
            window: 1.0,
        }
    }

    /// The rule without a map, for a largest speed of the law in m/s.
    #[must_use]
    pub fn without_map(max_speed: f64) -> Self {
        Self {
            progress: 0.6 * max_speed,
            window: 0.7,
        }
    }

    /// Returns the rule if its numbers are allowed.
    ///
    /// # Errors
    /// A number is not positive or not finite.
    pub fn checked(self) -> Result<Self> {
        positive("takeover_progress", self.progress)?;
        positive("takeover_window", self.window)?;
        Ok(self)
    }
}

/// When to take over, as far as it was told; the rest follows from whether there is a map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TakeoverOptions {
    /// Progress that counts, in m.
    pub progress: Option<f64>,
    /// Time without progress until the takeover, in s.
    pub window: Option<f64>,
}

impl TakeoverOptions {
    /// The rule with or without a map, for a largest speed of the law in m/s.
    #[must_use]
    pub fn rule(self, map: bool, max_speed: f64) -> TakeoverRule {
        let usual = if map {
            TakeoverRule::with_map()
        } else {
            TakeoverRule::without_map(max_speed)
        };
        TakeoverRule {
            progress: self.progress.unwrap_or(usual.progress),
            window: self.window.unwrap_or(usual.window),
        }
    }

    /// Returns the options if those that were told are allowed.
    ///
    /// # Errors
    /// A number is not positive or not finite.
    pub fn checked(self) -> Result<Self> {
        self.rule(true, 1.0).checked()?;
        Ok(self)
    }
}

/// Watches the progress of one robot.
///
/// The mark is the cost at the last event; an event is a cost of at most the mark less the
/// progress that counts. Without one for the window the wanted velocity leads to the local goal
/// until the next event. Each event lowers the mark, so there are at most `G_0/delta` of them.
#[derive(Clone, Copy, Debug)]
pub struct Takeover {
    rule: TakeoverRule,
    /// Cost and time of the last event.
    mark: Option<(f64, f64)>,
    target: Option<LocalGoal>,
}

impl Takeover {
    /// Nothing has been seen yet.
    #[must_use]
    pub fn new(rule: TakeoverRule) -> Self {
        Self {
            rule,
            mark: None,
            target: None,
        }
    }

    /// Starts anew, under another plan.
    pub fn restart(&mut self) {
        self.mark = None;
        self.target = None;
    }

    /// Looks at the cost at a time in s, `None` where there is none; returns whether the takeover
    /// is under way.
    pub fn observe(&mut self, time: f64, cost: Option<f64>) -> bool {
        let progress =
            |mark: f64| cost.filter(|cost| *cost <= mark - self.rule.progress + ROUNDING);
        match self.mark {
            None => self.mark = Some((cost.unwrap_or(f64::INFINITY), time)),
            Some((mark, _)) => {
                if let Some(cost) = progress(mark) {
                    self.mark = Some((cost, time));
                }
            }
        }
        let waited = self.mark.map_or(0.0, |(_, since)| time - since);
        let active = waited >= self.rule.window - ROUNDING;
        if !active {
            self.target = None;
        }
        active
    }

    /// Where the takeover leads: its local goal is replaced only by one of a lower cost-to-go, or
    /// when it is no longer seen.
    pub fn target(
        &mut self,
        local: Option<LocalGoal>,
        sees: impl FnOnce(Vector2<f64>) -> bool,
    ) -> Option<LocalGoal> {
        let kept = match (self.target, local) {
            (Some(kept), Some(local)) if local.cost_to_go < kept.cost_to_go => Some(local),
            (Some(kept), Some(local)) => Some(if sees(kept.point) { kept } else { local }),
            (kept, local) => kept.or(local),
        };
        self.target = kept;
        kept
    }
}

impl LocalGoal {
    /// Wanted velocity of a takeover in m/s: the largest speed towards the local goal; towards the
    /// goal itself at most `sqrt(2 a |E|)` and `|E|/T`.
    #[must_use]
    pub fn velocity_from(
        &self,
        position: Vector2<f64>,
        max_speed: f64,
        max_acceleration: f64,
        period: f64,
    ) -> Vector2<f64> {
        let to = self.point - position;
        let distance = to.norm();
        if distance == 0.0 {
            return Vector2::zeros();
        }
        let speed = if self.is_goal {
            let braking = (2.0 * max_acceleration * distance).sqrt();
            max_speed.min(braking).min(distance / period)
        } else {
            max_speed
        };
        to * (speed / distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_progress_for_the_window_takes_over_until_the_next_event() {
        let mut takeover = Takeover::new(TakeoverRule::with_map());
        assert!(!takeover.observe(0.0, Some(5.0)));
        assert!(!takeover.observe(0.9, Some(4.8)));
        assert!(takeover.observe(1.0, Some(4.75)));
        assert!(takeover.observe(1.5, None));
        assert!(!takeover.observe(1.6, Some(4.7)));
        assert!(!takeover.observe(2.5, Some(4.5)));
        assert!(takeover.observe(2.6, Some(4.5)));
    }

    #[test]
    fn what_was_not_told_follows_from_whether_there_is_a_map() {
        let told = TakeoverOptions {
            progress: None,
            window: Some(0.4),
        };
        let numbers = |rule: TakeoverRule| (rule.progress, rule.window);
        assert_eq!(
            numbers(TakeoverOptions::default().rule(true, 1.5)),
            (0.3, 1.0)
        );
        assert_eq!(numbers(told.rule(true, 1.5)), (0.3, 0.4));
        assert_eq!(
            numbers(TakeoverOptions::default().rule(false, 0.5)),
            (0.3, 0.7)
        );
        assert_eq!(numbers(told.rule(false, 0.5)), (0.3, 0.4));
    }

    #[test]
    fn rounding_puts_off_no_event() {
        // A robot at its largest speed covers the progress that counts in a whole number of periods.
        let mut takeover = Takeover::new(TakeoverRule::with_map());
        assert!(!takeover.observe(0.0, Some(5.0)));
        assert!(!takeover.observe(0.9, Some(4.7 + 1e-14)));
        assert!(!takeover.observe(1.8, Some(4.6)));
        assert!(takeover.observe(1.9, Some(4.6)));
    }

    #[test]
    fn the_carrot_of_a_takeover_never_gets_worse_while_it_is_seen() {
        let at = |x: f64, cost_to_go: f64| LocalGoal {
            point: Vector2::new(x, 0.0),
            cost_to_go,
            is_goal: false,
        };
        let mut takeover = Takeover::new(TakeoverRule::with_map());
        let seen = |_| true;
        assert_eq!(
            takeover.target(Some(at(1.0, 3.0)), seen),
            Some(at(1.0, 3.0))
        );
        assert_eq!(
            takeover.target(Some(at(2.0, 3.5)), seen),
            Some(at(1.0, 3.0))
        );
        assert_eq!(takeover.target(None, seen), Some(at(1.0, 3.0)));
        assert_eq!(
            takeover.target(Some(at(2.0, 2.5)), seen),
            Some(at(2.0, 2.5))
        );
        assert_eq!(
            takeover.target(Some(at(4.0, 9.0)), |_| false),
            Some(at(4.0, 9.0))
        );
    }

    #[test]
    fn the_goal_itself_is_reached_slowly_enough_to_stop() {
        let goal = LocalGoal::goal(Vector2::new(0.1, 0.0));
        let speed = |acceleration, period| {
            goal.velocity_from(Vector2::zeros(), 0.7, acceleration, period)
                .x
        };
        assert_eq!(speed(10.0, 0.06), 0.7);
        assert_eq!(speed(0.2, 0.06), 0.2);
        assert_eq!(speed(10.0, 0.2), 0.5);
        let carrot = LocalGoal {
            is_goal: false,
            ..goal
        };
        assert_eq!(carrot.velocity_from(Vector2::zeros(), 0.7, 0.2, 0.2).x, 0.7);
    }
}
