//! Obstacles over time, as an episode that is stepped from outside sees them.

use std::ops::Deref;

use crate::run::options::Clock;
use navigation_world::world::geometry::Body;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};

/// Scenarios of robots side by side.
pub(crate) trait World: Clone {
    /// A scenario with the robot and the rules of all lanes.
    fn common(&self) -> &Scenario;
    /// The scenario of a lane.
    fn of_lane(&self, lane: usize) -> &Scenario;
}

impl<S: Deref<Target = Scenario> + Clone> World for S {
    fn common(&self) -> &Scenario {
        self
    }

    fn of_lane(&self, _lane: usize) -> &Scenario {
        self
    }
}

/// Obstacles at the start and at the end of a motion step.
pub(crate) struct Scene<S> {
    scenario: S,
    /// Cursors of their motions.
    cursors: Vec<usize>,
    pub frames: [Vec<Body>; 2],
    /// The step whose instant the last frame shows, if it shows one.
    shown: Option<usize>,
}

/// An obstacle at an instant.
#[inline]
pub(crate) fn body_at(placed: &PlacedObstacle, time: f64, cursor: &mut usize) -> Body {
    let state = placed.obstacle.motion.at(time, cursor);
    Body {
        shape: placed.obstacle.shape,
        regions: placed.regions,
        state,
    }
}

/// The obstacles at an instant that is looked at only once.
pub(crate) fn bodies_at(scenario: &Scenario, time: f64) -> Vec<Body> {
    let obstacles = scenario.obstacles.iter();
    obstacles
        .map(|placed| body_at(placed, time, &mut 0))
        .collect()
}

impl<S: Deref<Target = Scenario>> Scene<S> {
    /// Obstacles at the start.
    pub fn new(scenario: S) -> Self {
        let bodies = bodies_at(&scenario, 0.0);
        Self {
            scenario,
            cursors: vec![0; bodies.len()],
            frames: [bodies.clone(), bodies],
            shown: None,
        }
    }

    /// Moves on to a motion step.
    pub fn advance(&mut self, clock: &Clock, step: usize) {
        if self.shown == Some(step) {
            self.frames.swap(0, 1);
        } else {
            self.show(clock.time(step), 0);
        }
        self.show(clock.time(step + 1), 1);
        self.shown = Some(step + 1);
    }

    fn show(&mut self, time: f64, frame: usize) {
        let bodies = self.frames[frame].iter_mut().zip(&mut self.cursors);
        for ((body, cursor), placed) in bodies.zip(&self.scenario.obstacles) {
            if !placed.stationary {
                body.state = placed.obstacle.motion.at(time, cursor);
            }
        }
    }
}
