//! The way around who stands, for a robot without a map: only where it is stuck behind them.

use nalgebra::Vector2;

use crate::guide::standing::{MOVED, WINDOW};
use crate::guide::{Guidance, LocalGoal, Takeover, TakeoverRule};

/// Watches whether a robot without a map needs a way around others.
///
/// It stands as people do if it has not come nearer to its goal by 0.1 m in 2 s. If somebody who stands is
/// then on the straight way within the look-ahead, the plan leads around them until the whole straight way
/// is free. Until then, and wherever the law finds its way by itself, nothing changes.
#[derive(Clone, Copy, Debug)]
pub struct Detour {
    watch: Takeover,
    under_way: bool,
}

impl Default for Detour {
    fn default() -> Self {
        let rule = TakeoverRule {
            progress: MOVED,
            window: WINDOW,
        };
        Self {
            watch: Takeover::new(rule),
            under_way: false,
        }
    }
}

impl Detour {
    /// Looks at a robot at a time in s; the local goal of the way around, `None` where the law has the goal itself.
    pub fn observe(
        &mut self,
        time: f64,
        position: Vector2<f64>,
        guidance: &Guidance,
    ) -> Option<LocalGoal> {
        let plan = guidance.plan();
        let stuck = self
            .watch
            .observe(time, Some((plan.goal() - position).norm()));
        let needed = self.under_way || stuck && !plan.sees_ahead(position);
        let way = (needed && guidance.leads_around() && !plan.sees(position, plan.goal()))
            .then(|| guidance.local_goal(position))
            .flatten();
        if self.under_way && way.is_none() {
            self.watch.restart();
        }
        self.under_way = way.is_some();
        way.map(|(_, local)| local)
    }
}
