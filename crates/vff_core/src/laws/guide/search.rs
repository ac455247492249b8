//! Dijkstra's algorithm from the goal.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use nalgebra::Vector2;

use crate::error::{Failure, Result};
use crate::laws::Stop;
use crate::laws::guide::nodes::Nodes;
use crate::world::map::StaticMap;

/// Within this distance of the surface of the robot the map makes a way dearer, in m.
const NEAR: f64 = 0.3;
/// How much dearer it is at the map.
const DEARER: f64 = 2.0;
/// Nodes between two looks at whether to stop.
const BETWEEN_LOOKS: usize = 4096;

/// What keeps a robot and its margin away from a map.
pub(super) struct Room<'a> {
    pub map: &'a StaticMap,
    pub robot_radius: f64,
    /// Least clearance `rho + m_p` of nodes and links, in m.
    pub least: f64,
}

/// Cost-to-go `G` of every node, infinite where there is no plan, and the next node on the way.
#[derive(Clone, Debug)]
pub(super) struct CostToGo {
    pub cost: Vec<f64>,
    pub next: Vec<u32>,
}

/// The nodes while they are looked at.
struct Search<'a> {
    room: Room<'a>,
    nodes: Nodes,
    /// Clearances up to `far`, NaN where not yet known.
    clearance: Vec<f64>,
    far: f64,
}

/// Costs from the goal's node, whose own cost is its distance in m.
pub(super) fn cost_to_go(
    room: Room<'_>,
    nodes: Nodes,
    (goal, cost_of_goal): (usize, f64),
    stop: Stop<'_>,
) -> Result<CostToGo> {
    let far = room.robot_radius + NEAR.max(room.least - room.robot_radius + 3.0 * nodes.spacing);
    let mut search = Search {
        clearance: vec![f64::NAN; nodes.count()],
        far,
        room,
        nodes,
    };
    let mut found = CostToGo {
        cost: vec![f64::INFINITY; nodes.count()],
        next: vec![0; nodes.count()],
    };
    // Costs are not negative, so their bits are in the order of the numbers; of equal ones the
    // node with the lower index comes first.
    let mut queue = BinaryHeap::new();
    found.cost[goal] = cost_of_goal;
    found.next[goal] = narrow(goal);
    queue.push(Reverse((cost_of_goal.to_bits(), goal)));
    let mut settled = 0;
    while let Some(Reverse((bits, node))) = queue.pop() {
        let cost = f64::from_bits(bits);
        if cost > found.cost[node] {
            continue;
        }
        settled += 1;
        if settled % BETWEEN_LOOKS == 0 && stop.asked() {
            return Err(Failure::Interrupted);
        }
        let (place, clearance) = (nodes.place(node), search.clearance_of(node));
        let weight = search.weight(clearance);
        for (other, cells) in nodes.linked(node) {
            let length = cells * nodes.spacing;
            // The weight of the other end is one at least.
            if cost + length * 0.5 * (weight + 1.0) >= found.cost[other] {
                continue;
            }
            let there = search.clearance_of(other);
            let total = cost + length * 0.5 * (weight + search.weight(there));
            if there >= search.room.least
                && total < found.cost[other]
                && search.free_link([place, nodes.place(other)], [clearance, there], length)
            {
                found.cost[other] = total;
                found.next[other] = narrow(node);
                queue.push(Reverse((total.to_bits(), other)));
            }
        }
    }
    Ok(found)
}

#[allow(clippy::cast_possible_truncation)] // there are at most 2^24 nodes
fn narrow(node: usize) -> u32 {
    node as u32
}

impl Search<'_> {
    fn clearance_of(&mut self, node: usize) -> f64 {
        let known = &mut self.clearance[node];
        if known.is_nan() {
            *known = self
                .room
                .map
                .clearance_up_to(self.nodes.place(node), self.far);
        }
        *known
    }

    /// `1 + 2 max(0, 1 - (c - rho)/0.3)^2`.
    fn weight(&self, clearance: f64) -> f64 {
        let near = (1.0 - (clearance - self.room.robot_radius) / NEAR).max(0.0);
        1.0 + DEARER * near * near
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
