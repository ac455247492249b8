//! Dijkstra's algorithm from the goal.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

use nalgebra::Vector2;

use crate::guide::RobotRoom;
use crate::guide::nodes::Nodes;
use crate::guide::pace::Pace;
use navigation_world::world::map::StaticMap;

/// Within this distance of the surface of the robot the map makes a way dearer, in m.
const NEAR: f64 = 0.3;
/// How much dearer it is at the map.
const DEARER: f64 = 2.0;

/// Clearance of a robot and its margin from a map.
#[derive(Clone, Debug)]
pub(super) struct MapClearance {
    pub map: StaticMap,
    pub robot: RobotRoom,
    /// Least clearance `rho + m_p` of nodes and links, in m.
    pub least: f64,
    /// Whether ways stay where something is known.
    pub within_known: bool,
}

impl MapClearance {
    /// Clearance of a place up to a distance in m, zero where no way leads.
    pub fn clearance(&self, place: Vector2<f64>, far: f64) -> f64 {
        if self.within_known && !self.map.knows(place) {
            0.0
        } else {
            self.map.clearance_up_to(place, far)
        }
    }
}

/// Cost-to-go `G` of every node, infinite where there is no plan, and the next node on the way.
#[derive(Clone, Debug)]
pub(super) struct CostToGo {
    pub cost: Vec<f64>,
    pub next: Vec<u32>,
    /// Clearances in m up to `far`, NaN where not known.
    clearance: Vec<f64>,
    far: f64,
}

/// What a search in a map of fewer shapes found, and a map of the shapes that came to them.
#[derive(Clone, Debug)]
pub(super) struct FoundBefore {
    pub found: Arc<CostToGo>,
    pub added: StaticMap,
}

impl FoundBefore {
    /// The clearance of a node in m up to what the search looked at; `None` where it did not.
    fn clearance(&self, node: usize, place: Vector2<f64>) -> Option<f64> {
        let before = self.found.clearance[node];
        (!before.is_nan()).then(|| self.added.clearance_up_to(place, before))
    }
}

/// A search from the goal's node, which resumes where it stopped.
#[derive(Clone, Debug)]
pub(super) struct GuideSearch {
    room: MapClearance,
    nodes: Nodes,
    /// How many times dearer ways are where people can come from who are not seen, if they are reckoned with.
    pace: Option<Pace>,
    found: CostToGo,
    /// A search in the map without some of its shapes, whose clearances are taken over.
    before: Option<FoundBefore>,
    /// Costs are not negative, so their bits are in the order of the numbers; of equal ones the
    /// node with the lower index comes first.
    queue: BinaryHeap<Reverse<(u64, usize)>>,
}

#[allow(clippy::cast_possible_truncation)] // there are at most 2^24 nodes
fn narrow(node: usize) -> u32 {
    node as u32
}

impl GuideSearch {
    /// From the goal's node, whose own cost is its distance in m.
    pub fn new(
        room: MapClearance,
        pace: Option<Pace>,
        nodes: Nodes,
        (goal, cost_of_goal): (usize, f64),
        before: Option<FoundBefore>,
    ) -> Self {
        let beyond = room.least - room.robot.least + 3.0 * nodes.spacing;
        let far = (room.robot.least + NEAR.max(beyond)).max(room.robot.free());
        let mut found = CostToGo {
            cost: vec![f64::INFINITY; nodes.count()],
            next: vec![0; nodes.count()],
            clearance: vec![f64::NAN; nodes.count()],
            far,
        };
        found.cost[goal] = cost_of_goal;
        found.next[goal] = narrow(goal);
        Self {
            pace,
            before: before.filter(|before| before.found.far == far),
            room,
            nodes,
            found,
            queue: BinaryHeap::from([Reverse((cost_of_goal.to_bits(), goal))]),
        }
    }

    /// Settles so many nodes at most; whether those were all.
    pub fn advance(&mut self, most: usize) -> bool {
        let mut settled = 0;
        while settled < most {
            let Some(Reverse((bits, node))) = self.queue.pop() else {
                return true;
            };
            let cost = f64::from_bits(bits);
            if cost <= self.found.cost[node] {
                settled += 1;
                self.settle(node, cost);
            }
        }
        false
    }

    /// The costs, when all nodes are settled.
    pub fn found(self) -> CostToGo {
        self.found
    }

    /// Tells the neighbors of a node of their way through it.
    #[inline]
    fn settle(&mut self, node: usize, cost: f64) {
        let nodes = self.nodes;
        let (place, clearance) = (nodes.place(node), self.clearance_of(node));
        let weight = self.weight(clearance);
        for (other, link, cells) in nodes.linked(node) {
            let length = cells * nodes.spacing;
            // The weight of the other end is one at least.
            if cost + length * 0.5 * (weight + 1.0) >= self.found.cost[other] {
                continue;
            }
            let there = self.clearance_of(other);
            if there < self.room.least {
                continue;
            }
            let [near, far] = [node, other].map(|end| self.factor(end, link));
            let total = cost + length * 0.5 * (weight * near + self.weight(there) * far);
            if total < self.found.cost[other]
                && self.free_link([place, nodes.place(other)], [clearance, there], length)
            {
                self.found.cost[other] = total;
                self.found.next[other] = narrow(node);
                self.queue.push(Reverse((total.to_bits(), other)));
            }
        }
    }

    /// How many times dearer it is at a node to go against a link.
    fn factor(&self, node: usize, link: usize) -> f64 {
        let pace = self.pace.as_ref();
        pace.map_or(1.0, |pace| pace.factor(&self.nodes, node, link))
    }

    fn clearance_of(&mut self, node: usize) -> f64 {
        let known = &mut self.found.clearance[node];
        if known.is_nan() {
            let place = self.nodes.place(node);
            let before = self.before.as_ref();
            *known = before
                .and_then(|before| before.clearance(node, place))
                .unwrap_or_else(|| self.room.clearance(place, self.found.far));
        }
        *known
    }

    /// `1 + 2 max(0, 1 - (c - rho)/0.3)^2`, and what a narrow place adds.
    fn weight(&self, clearance: f64) -> f64 {
        let robot = &self.room.robot;
        let near = (1.0 - (clearance - robot.least) / NEAR).max(0.0);
        1.0 + DEARER * near * near + robot.narrowness(clearance)
    }

    /// Whether a link between free nodes keeps the least clearance. No point of it is nearer to
    /// the map than half of what both ends have beyond its length.
    fn free_link(
        &self,
        [from, to]: [Vector2<f64>; 2],
        [here, there]: [f64; 2],
        length: f64,
    ) -> bool {
        let least = self.room.least;
        0.5 * (here + there - length) >= least || self.room.map.free_segment_keeps(from, to, least)
    }
}
