//! Obstacles over time, shared by all robots that are stepped side by side.

use std::ops::Deref;

use crate::lanes::{Real, Wide};
use crate::run::options::Clock;
use crate::world::geometry::Body;
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Where robots side by side run.
pub(crate) trait World<R: Real>: Clone {
    /// Numbers that the robots share, or that each of them has for itself.
    type Number: Wide<R>;
    /// A scenario with the robot, the start and the rules of all lanes.
    fn common(&self) -> &Scenario;
    /// The scenario of a lane.
    fn of_lane(&self, lane: usize) -> &Scenario;
    /// Distance `d` at which the robot touches each of so many obstacles, in m.
    fn reaches(&self, count: usize) -> Vec<Self::Number>;
    /// Largest speed of each obstacle in m/s, infinite if there is none.
    fn speed_bounds(&self, count: usize) -> Vec<Self::Number>;
    /// Instant from which no obstacle moves any more, in s; infinite if there is none.
    fn stands_from(&self) -> f64;
}

impl<S: Deref<Target = Scenario> + Clone, R: Real> World<R> for S {
    type Number = f64;

    fn common(&self) -> &Scenario {
        self
    }

    fn of_lane(&self, _lane: usize) -> &Scenario {
        self
    }

    fn reaches(&self, _count: usize) -> Vec<f64> {
        self.obstacles
            .iter()
            .map(|placed| placed.contact_distance)
            .collect()
    }

    fn speed_bounds(&self, _count: usize) -> Vec<f64> {
        self.obstacles.iter().map(PlacedObstacle::fastest).collect()
    }

    fn stands_from(&self) -> f64 {
        Scenario::stands_from(self)
    }
}

/// Where the obstacles are at the steps of one block.
pub(crate) struct Scene<S> {
    scenario: S,
    /// The obstacles that it has, in their order, with the cursors of their motions.
    pub told: Vec<usize>,
    cursors: Vec<usize>,
    /// Bodies at the start of the block and after each of its steps.
    pub frames: Vec<Vec<Body>>,
    /// Bodies in the middle of the first step, if an integrator asks for them.
    pub middle: Vec<Body>,
    staged: bool,
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
    pub fn new(scenario: S, steps: usize, staged: bool) -> Self {
        let bodies = bodies_at(&scenario, 0.0);
        Self::of(scenario, bodies, (steps, staged))
    }

    /// With the first obstacles as they are at the start.
    pub fn of(scenario: S, bodies: Vec<Body>, (steps, staged): (usize, bool)) -> Self {
        Self {
            scenario,
            told: (0..bodies.len()).collect(),
            cursors: vec![0; bodies.len()],
            frames: vec![bodies.clone(); steps + 1],
            middle: bodies,
            staged,
            shown: None,
        }
    }

    /// Takes an obstacle in, as it is at the start of the block.
    pub fn insert(&mut self, slot: usize, index: usize, body: &Body) {
        self.told.insert(slot, index);
        self.cursors.insert(slot, 0);
        self.shown = None;
        for frame in &mut self.frames {
            frame.insert(slot, *body);
        }
    }

    /// Forgets an obstacle.
    pub fn remove(&mut self, slot: usize) {
        self.told.remove(slot);
        self.cursors.remove(slot);
        for frame in &mut self.frames {
            frame.remove(slot);
        }
    }

    /// Moves on to the block that begins at a step.
    pub fn advance(&mut self, clock: &Clock, first: usize) {
        let steps = self.frames.len() - 1;
        if self.shown == Some(first) {
            self.frames.swap(0, steps);
        } else {
            self.begin(clock, first);
        }
        self.complete(clock, first, |_| true);
        self.shown = Some(first + steps);
    }

    /// Moves on to the first instant of the block that begins at a step.
    pub fn begin(&mut self, clock: &Clock, first: usize) {
        self.shown = None;
        let frame = &mut self.frames[0];
        for (slot, index) in self.told.iter().enumerate() {
            let placed = &self.scenario.obstacles[*index];
            if !placed.stationary {
                let cursor = &mut self.cursors[slot];
                frame[slot].state = placed.obstacle.motion.at(clock.time(first), cursor);
            }
        }
    }

    /// All later instants of a block that has begun, of the obstacles that are looked at.
    pub fn complete(&mut self, clock: &Clock, first: usize, looked_at: impl Fn(usize) -> bool) {
        for (slot, index) in self.told.iter().enumerate() {
            let placed = &self.scenario.obstacles[*index];
            if placed.stationary || !looked_at(slot) {
                continue;
            }
            let motion = &placed.obstacle.motion;
            let cursor = &mut self.cursors[slot];
            for (step, frame) in self.frames.iter_mut().enumerate().skip(1) {
                frame[slot].state = motion.at(clock.time(first + step), cursor);
            }
            if self.staged {
                let half = clock.time(first) + 0.5 * clock.step;
                self.middle[slot].state = motion.at(half, cursor);
            }
        }
    }
}
