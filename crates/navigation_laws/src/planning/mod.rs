//! Planners of the first category: they choose a velocity from where everything is and how it
//! moves now, as if it went on like that.

pub mod family;
pub mod footprint;
pub mod grid;
pub mod half_planes;
pub mod outline;
pub mod path;

use crate::Situation;
use navigation_world::world::scenario::PlacedObstacle;
use numeric::lanes::{Real, Vector2};

/// A planner at work in one scenario; it owns its state between control steps.
pub trait Planner: Send + 'static {
    /// Velocity in m/s that the robot should have at the next sample. A planner that finds no
    /// way asks for standstill, unless its own documentation says more.
    fn desired_velocity(&mut self, situation: &Situation<'_, f64>) -> [f64; 2];

    /// Distance `d` from an obstacle in m beyond which it changes no velocity; infinite where there is
    /// none, and for planners that remember obstacles by their places in the list.
    fn felt_within(&self, _obstacle: &PlacedObstacle) -> f64 {
        f64::INFINITY
    }

    /// Heads for another goal from now on, in m; planners of a whole way keep theirs.
    fn aim(&mut self, _goal: [f64; 2]) {}

    /// Whether [`Self::aim`] changes where it heads.
    fn can_aim(&self) -> bool {
        true
    }
}

/// A planner that decides for robots side by side, each in a scene of its own.
pub trait ScenePlanner: Planner + Sized {
    /// Vectors of [`Planner::desired_velocity`] of the planner of every lane, bit for bit; all of them have
    /// the same numbers.
    fn desired_velocities<R: Real>(
        planners: &mut [Self],
        situation: &Situation<'_, R>,
    ) -> Vector2<R>;
}
