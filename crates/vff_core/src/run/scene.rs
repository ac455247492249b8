//! Obstacles over time, shared by all robots that are stepped side by side.

use std::ops::Deref;

use crate::run::options::Clock;
use crate::world::geometry::Body;
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Where the obstacles are at the steps of one block.
pub(crate) struct Scene<S> {
    scenario: S,
    cursors: Vec<usize>,
    /// Bodies at the start of the block and after each of its steps.
    pub frames: Vec<Vec<Body>>,
    /// Bodies in the middle of the first step, if an integrator asks for them.
    pub middle: Vec<Body>,
    staged: bool,
}

/// An obstacle at an instant.
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
    pub fn new(scenario: S, steps: usize, staged: bool) -> Self {
        let bodies = bodies_at(&scenario, 0.0);
        Self {
            scenario,
            cursors: vec![0; bodies.len()],
            frames: vec![bodies.clone(); steps + 1],
            middle: bodies,
            staged,
        }
    }

    /// Moves on to the block that begins at a step.
    pub fn advance(&mut self, clock: &Clock, first: usize) {
        for (index, placed) in self.scenario.obstacles.iter().enumerate() {
            if placed.stationary {
                continue;
            }
            let motion = &placed.obstacle.motion;
            let cursor = &mut self.cursors[index];
            for (step, frame) in self.frames.iter_mut().enumerate() {
                frame[index].state = motion.at(clock.time(first + step), cursor);
            }
            if self.staged {
                let half = clock.time(first) + 0.5 * clock.step;
                self.middle[index].state = motion.at(half, cursor);
            }
        }
    }
}
