//! Growing a tree of collision-free edges from the robot to the goal, and shortening its path.

use numeric::random::Stream;

use super::buckets::Buckets;
use crate::Stop;
use crate::planning::footprint::Footprint;
use crate::planning::path::distance;

/// Draws between two looks at whether to stop.
pub(super) const DRAWS_PER_LOOK: usize = 256;

/// Steps shorter than this share of the step length add nothing.
const LEAST_STEP: f64 = 1e-6;

/// Stream of the generator, apart from those of the measurement errors.
const STREAM: u64 = u64::MAX;

/// Random numbers of one planner.
#[derive(Clone, Debug)]
pub struct Chance(Stream);

impl Chance {
    /// Numbers of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(Stream::new(seed, STREAM))
    }

    /// Uniform in [0, 1) with 53 bits.
    pub fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// Uniform in a box.
    pub fn point(&mut self, low: [f64; 2], high: [f64; 2]) -> [f64; 2] {
        let (x, y) = (self.unit(), self.unit());
        [
            low[0] + x * (high[0] - low[0]),
            low[1] + y * (high[1] - low[1]),
        ]
    }

    /// A number below a count.
    pub fn below(&mut self, count: usize) -> usize {
        crate::planning::grid::whole(self.unit() * count as f64, count.saturating_sub(1))
    }
}

/// How a tree grows.
#[derive(Clone, Copy, Debug)]
pub struct Growth {
    /// Corner of the box that points are drawn from, in m.
    pub low: [f64; 2],
    /// Opposite corner in m.
    pub high: [f64; 2],
    /// Length of an edge in m.
    pub step: f64,
    /// Probability of growing towards the goal.
    pub goal_probability: f64,
    /// Probability of growing towards a remembered point.
    pub waypoint_probability: f64,
    /// Number of points that are drawn.
    pub draws: usize,
    /// Number of points that are remembered.
    pub waypoints: usize,
}

/// A tree that is grown anew for every plan, and the points of earlier paths, Bruce and Veloso
/// (2002). Positions are relative to the goal, which is the origin.
#[derive(Clone, Debug)]
pub struct Tree {
    growth: Growth,
    chance: Chance,
    nodes: Buckets,
    parents: Vec<usize>,
    waypoints: Vec<[f64; 2]>,
}

impl Tree {
    /// An empty tree.
    #[must_use]
    pub fn new(growth: Growth, seed: u64) -> Self {
        Self {
            growth,
            chance: Chance::new(seed),
            nodes: Buckets::new(growth.low, growth.high, growth.step),
            parents: Vec::with_capacity(growth.draws + 1),
            waypoints: Vec::with_capacity(growth.waypoints),
        }
    }

    /// Nodes in the order in which they were added; the first one is the root.
    #[must_use]
    pub fn nodes(&self) -> &[[f64; 2]] {
        self.nodes.points()
    }

    /// Parent of each node; the root is its own.
    #[must_use]
    pub fn parents(&self) -> &[usize] {
        &self.parents
    }

    /// How the tree grows.
    #[must_use]
    pub fn growth(&self) -> &Growth {
        &self.growth
    }

    /// Random numbers of this tree.
    pub fn chance(&mut self) -> &mut Chance {
        &mut self.chance
    }

    /// Grows a tree from a point until an edge reaches the goal, and writes the path there;
    /// `false` if the draws do not suffice, or when told to stop.
    pub fn grow(
        &mut self,
        from: [f64; 2],
        footprints: &[Footprint],
        path: &mut Vec<[f64; 2]>,
        stop: Stop<'_>,
    ) -> bool {
        path.clear();
        self.nodes.clear();
        self.parents.clear();
        self.nodes.push(from);
        self.parents.push(0);
        if from == [0.0; 2] || is_free([from, [0.0; 2]], footprints) {
            // What any tree's path would be shortened to.
            path.extend([from, [0.0; 2]]);
            self.remember(path);
            return true;
        }
        for draw in 1..=self.growth.draws {
            if draw % DRAWS_PER_LOOK == 0 && stop.asked() {
                return false;
            }
            let target = self.target();
            let Some(node) = self.extend(target, footprints) else {
                continue;
            };
            let reached = self.nodes.points()[node];
            let near = distance(reached, [0.0; 2]) <= self.growth.step;
            if near && is_free([reached, [0.0; 2]], footprints) {
                self.trace(node, path);
                self.remember(path);
                return true;
            }
        }
        false
    }

    /// Where to grow to: the goal, a remembered point, or anywhere.
    fn target(&mut self) -> [f64; 2] {
        let choice = self.chance.unit();
        let growth = self.growth;
        if choice < growth.goal_probability {
            return [0.0; 2];
        }
        let remembered = choice < growth.goal_probability + growth.waypoint_probability;
        if remembered && !self.waypoints.is_empty() {
            return self.waypoints[self.chance.below(self.waypoints.len())];
        }
        self.chance.point(growth.low, growth.high)
    }

    /// One step from the nearest node towards a target; the new node if the edge is free.
    fn extend(&mut self, target: [f64; 2], footprints: &[Footprint]) -> Option<usize> {
        let parent = self.nodes.nearest(target)?;
        let from = self.nodes.points()[parent];
        let away = distance(from, target);
        let step = self.growth.step;
        if away <= LEAST_STEP * step {
            return None;
        }
        let share = (step / away).min(1.0);
        let to = [
            from[0] + share * (target[0] - from[0]),
            from[1] + share * (target[1] - from[1]),
        ];
        if !is_free([from, to], footprints) {
            return None;
        }
        self.nodes.push(to);
        self.parents.push(parent);
        Some(self.parents.len() - 1)
    }

    /// Path from the root over a node to the goal.
    fn trace(&self, mut node: usize, path: &mut Vec<[f64; 2]>) {
        path.push([0.0; 2]);
        loop {
            path.push(self.nodes.points()[node]);
            if node == 0 {
                break;
            }
            node = self.parents[node];
        }
        path.reverse();
        path.dedup();
    }

    /// Remembers the points of a path, each in a random place once the memory is full.
    fn remember(&mut self, path: &[[f64; 2]]) {
        for &point in path.iter().skip(1) {
            if self.waypoints.len() < self.growth.waypoints {
                self.waypoints.push(point);
            } else if !self.waypoints.is_empty() {
                let place = self.chance.below(self.waypoints.len());
                self.waypoints[place] = point;
            }
        }
    }
}

/// Whether a segment keeps out of every footprint.
#[must_use]
pub fn is_free(segment: [[f64; 2]; 2], footprints: &[Footprint]) -> bool {
    !footprints.iter().any(|footprint| footprint.meets(segment))
}

/// Replaces legs of a path by straight ones: from each point on to the last one that can be seen.
pub fn shorten(path: &mut Vec<[f64; 2]>, footprints: &[Footprint]) {
    let mut kept = 0;
    let mut at = 0;
    while at + 1 < path.len() {
        let from = path[at];
        let seen = (at + 2..path.len())
            .rev()
            .find(|&other| is_free([from, path[other]], footprints));
        at = seen.unwrap_or(at + 1);
        kept += 1;
        path[kept] = path[at];
    }
    path.truncate(kept + 1);
}
