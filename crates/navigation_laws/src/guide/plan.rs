//! A plan: what the way from a place costs, and the local goal there.

use std::sync::Arc;

use nalgebra::Vector2;
use numeric::order::sort_pairs;

use crate::Stop;
use crate::guide::nodes::Nodes;
use crate::guide::pace::Pace;
use crate::guide::search::{CostToGo, FoundBefore, GuideSearch, MapClearance};
use crate::guide::{Guide, RobotRoom};
use navigation_world::world::map::StaticMap;
use navigation_world::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result};

/// Nodes between two looks at whether to stop.
const BETWEEN_LOOKS: usize = 4096;
/// The goal's node is sought within so many cells.
const GOAL_REACH: i64 = 8;
/// The start node is sought in squares of so many cells, one after the other.
const REACHES: [i64; 4] = [2, 4, 6, 8];
/// Nodes of the largest square.
const MOST_NEAR: usize = 17 * 17;
/// A clearance may be missed by this much, in m.
const SPARE: f64 = 1e-9;
/// A law gets a goal at least this far ahead, in m.
const AHEAD: f64 = 2.0;

/// Cost-to-go of a grid of nodes, for one map, robot radius and goal. A copy costs nothing.
#[derive(Clone, Debug)]
pub struct Plan {
    guide: Guide,
    nodes: Nodes,
    map: StaticMap,
    /// Least clearance `rho + m_p`, in m.
    least: f64,
    goal: Vector2<f64>,
    /// Whether ways are dear where people can come from who are not seen.
    pace: Option<Pace>,
    found: Arc<CostToGo>,
}

/// How a plan looks from a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanView {
    /// Cost at the place, in m.
    pub cost: f64,
    /// The node that the way starts with.
    start: usize,
    /// Clearance that what is seen from the place keeps, in m.
    least: f64,
}

/// Where a law should go for now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalGoal {
    /// The carrot, in m.
    pub point: Vector2<f64>,
    /// Cost-to-go `G` from it, in m.
    pub cost_to_go: f64,
    /// Set where the local goal is the goal itself.
    pub is_goal: bool,
}

impl LocalGoal {
    /// The goal itself.
    #[must_use]
    pub fn goal(point: Vector2<f64>) -> Self {
        Self {
            point,
            cost_to_go: 0.0,
            is_goal: true,
        }
    }

    /// The goal that a law gets at a position: 2 m ahead in the direction of the carrot if that is
    /// nearer, because force laws slow down at their goals.
    #[must_use]
    pub fn for_law(&self, position: Vector2<f64>) -> Vector2<f64> {
        let to = self.point - position;
        let distance = to.norm();
        if self.is_goal || distance >= AHEAD || distance == 0.0 {
            self.point
        } else {
            position + to * (AHEAD / distance)
        }
    }
}

/// A plan that is made a part at a time.
#[derive(Clone, Debug)]
pub(super) struct Planning {
    guide: Guide,
    nodes: Nodes,
    map: StaticMap,
    least: f64,
    goal: Vector2<f64>,
    pace: Option<Pace>,
    search: GuideSearch,
}

impl Planning {
    /// Begins with costs from everywhere to a goal.
    pub fn new(
        guide: Guide,
        nodes: Nodes,
        map: &StaticMap,
        robot: RobotRoom,
        (goal, pace): (Vector2<f64>, Option<Pace>),
        before: Option<FoundBefore>,
    ) -> Result<Self> {
        let least = robot.least + guide.margin;
        let room = MapClearance {
            map: map.clone(),
            robot,
            least,
            within_known: guide.bounds.is_none(),
        };
        let first = goal_node(&nodes, &room, goal)?;
        Ok(Self {
            guide,
            nodes,
            map: map.clone(),
            least,
            goal,
            search: GuideSearch::new(room, pace.clone(), nodes, first, before),
            pace,
        })
    }

    /// Settles so many nodes at most; whether the plan is complete.
    pub fn advance(&mut self, nodes: usize) -> bool {
        self.search.advance(nodes)
    }

    /// The plan, when it is complete.
    pub fn finish(self) -> Plan {
        Plan {
            guide: self.guide,
            nodes: self.nodes,
            map: self.map,
            least: self.least,
            goal: self.goal,
            pace: self.pace,
            found: Arc::new(self.search.found()),
        }
    }
}

impl Plan {
    /// Costs from everywhere to a goal.
    pub(super) fn new(
        guide: Guide,
        nodes: Nodes,
        map: &StaticMap,
        robot: RobotRoom,
        to: (Vector2<f64>, Option<Pace>),
        stop: Stop<'_>,
    ) -> Result<Self> {
        let mut planning = Planning::new(guide, nodes, map, robot, to, None)?;
        while !planning.advance(BETWEEN_LOOKS) {
            if stop.asked() {
                return Err(Failure::Interrupted);
            }
        }
        Ok(planning.finish())
    }

    /// Begins the plan for the same nodes and goal in its map with shapes added to it, after a plan in its map with
    /// some of them and a map of the others.
    pub(super) fn begin_again(
        &self,
        guide: Guide,
        robot: RobotRoom,
        added: &[PlacedShape],
        (before, others): (&Self, StaticMap),
    ) -> Result<Planning> {
        let to = (self.goal, self.pace.clone());
        let before = FoundBefore {
            found: before.found.clone(),
            added: others,
        };
        let map = self.map.with_shapes(added);
        Planning::new(guide, self.nodes, &map, robot, to, Some(before))
    }

    /// Whether it is the other one, or a copy of it.
    pub(super) fn is_copy_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.found, &other.found)
    }

    pub(super) fn node_count(&self) -> usize {
        self.nodes.count()
    }

    /// The goal in m.
    #[must_use]
    pub fn goal(&self) -> Vector2<f64> {
        self.goal
    }

    /// The map that was planned in.
    #[must_use]
    pub fn map(&self) -> &StaticMap {
        &self.map
    }

    /// Whether a robot sees a point from a position: the segment between them keeps the clearance
    /// of the plan, or that of the position where it is smaller.
    #[must_use]
    pub fn sees(&self, position: Vector2<f64>, point: Vector2<f64>) -> bool {
        let least = self.seen_clearance(position);
        self.map.segment_keeps(position, point, least)
    }

    /// Whether a robot sees its straight way to the goal within the look-ahead.
    pub(super) fn sees_ahead(&self, position: Vector2<f64>) -> bool {
        let to = self.goal - position;
        let share = (self.guide.look_ahead / to.norm()).min(1.0);
        self.sees(position, position + to * share)
    }

    fn seen_clearance(&self, position: Vector2<f64>) -> f64 {
        seen_clearance(&self.map, self.least, position)
    }

    /// How the plan looks from a position; `None` if no node with a plan is seen nearby.
    #[must_use]
    pub fn view(&self, position: Vector2<f64>) -> Option<PlanView> {
        self.view_near(position, position)
    }

    /// The same for a robot that was pushed out of the box of the nodes, beside people for example: the way
    /// back leads to nodes at the nearest place of the box.
    #[must_use]
    pub fn view_or_way_back(&self, position: Vector2<f64>) -> Option<PlanView> {
        self.view(position).or_else(|| {
            let nearest = self.nodes.nearest(position);
            let outside = nearest != position;
            outside.then(|| self.view_near(position, nearest)).flatten()
        })
    }

    /// How the plan looks from a position by the nodes around a place.
    fn view_near(&self, position: Vector2<f64>, place: Vector2<f64>) -> Option<PlanView> {
        let least = self.seen_clearance(position);
        let mut near = [(f64::INFINITY, 0_usize); MOST_NEAR];
        for reach in REACHES {
            let mut count = 0;
            for node in self.nodes.square(place, reach) {
                let cost = self.found.cost[node];
                if cost.is_finite() {
                    near[count] = (cost + (self.nodes.place(node) - position).norm(), node);
                    count += 1;
                }
            }
            let near = &mut near[..count];
            sort_pairs(near);
            let mut seen = near.iter().filter(|(_, node)| {
                let place = self.nodes.place(*node);
                self.map.segment_keeps(position, place, least)
            });
            if let Some((cost, start)) = seen.next().copied() {
                return Some(PlanView { cost, start, least });
            }
        }
        None
    }

    /// Cost at a position in m; `None` without a plan there.
    #[must_use]
    pub fn cost(&self, position: Vector2<f64>) -> Option<f64> {
        self.view(position).map(|view| view.cost)
    }

    /// Cost-to-go of any place in m: between the four nodes around it, of those that have a plan; infinite where none
    /// has.
    #[must_use]
    pub fn cost_around(&self, place: Vector2<f64>) -> f64 {
        let (corners, weights) = self.nodes.corners(place);
        let (mut all, mut sum) = (0.0, 0.0);
        for (node, weight) in corners.into_iter().zip(weights) {
            let cost = node.map_or(f64::INFINITY, |node| self.found.cost[node]);
            if cost.is_finite() {
                all += cost * weight;
                sum += weight;
            }
        }
        if sum > 0.0 { all / sum } else { f64::INFINITY }
    }

    /// The carrot at a position; `None` without a plan there.
    #[must_use]
    pub fn carrot(&self, position: Vector2<f64>) -> Option<Vector2<f64>> {
        let view = self.view(position)?;
        Some(self.local_goal(position, &view).point)
    }

    /// The farthest seen node of the path, or the goal at its end, within the look-ahead.
    #[must_use]
    pub fn local_goal(&self, position: Vector2<f64>, view: &PlanView) -> LocalGoal {
        let ahead = self.ahead(position, view);
        let seen = |candidate: &LocalGoal| {
            self.map
                .segment_keeps(position, candidate.point, view.least)
        };
        let farthest = ahead.iter().rev().find(|candidate| seen(candidate));
        farthest
            .copied()
            .unwrap_or_else(|| self.at_node(view.start))
    }

    fn at_node(&self, node: usize) -> LocalGoal {
        LocalGoal {
            point: self.nodes.place(node),
            cost_to_go: self.found.cost[node],
            is_goal: false,
        }
    }

    /// The path from a position within the look-ahead.
    fn ahead(&self, position: Vector2<f64>, view: &PlanView) -> Vec<LocalGoal> {
        let mut ahead = Vec::new();
        let (mut last, mut length) = (position, 0.0);
        for step in self.steps(view) {
            length += (step.point - last).norm();
            if length > self.guide.look_ahead {
                break;
            }
            last = step.point;
            ahead.push(step);
        }
        ahead
    }

    /// The nodes of the path, then the goal.
    fn steps(&self, view: &PlanView) -> impl Iterator<Item = LocalGoal> {
        let mut next = Some(view.start);
        let nodes = std::iter::from_fn(move || {
            let node = next?;
            let after = self.found.next[node] as usize;
            next = (after != node).then_some(after);
            Some(self.at_node(node))
        });
        nodes.chain(std::iter::once(LocalGoal::goal(self.goal)))
    }

    /// The whole path from a position to the goal, in m; empty without a plan there.
    #[must_use]
    pub fn path(&self, position: Vector2<f64>) -> Vec<Vector2<f64>> {
        let Some(view) = self.view(position) else {
            return Vec::new();
        };
        self.way(position, &view).collect()
    }

    /// The way from a position that looks so to the goal, in m.
    pub(super) fn way(
        &self,
        position: Vector2<f64>,
        view: &PlanView,
    ) -> impl Iterator<Item = Vector2<f64>> {
        let steps = self.steps(view).map(|step| step.point);
        std::iter::once(position).chain(steps)
    }
}

/// Clearance that what is seen from a position keeps; from within a wall nothing is seen.
fn seen_clearance(map: &StaticMap, least: f64, position: Vector2<f64>) -> f64 {
    let kept = map.clearance_up_to(position, least) - SPARE;
    if kept > 0.0 { kept } else { f64::INFINITY }
}

/// The nearest free node that sees the goal, and its distance from it.
fn goal_node(nodes: &Nodes, room: &MapClearance, goal: Vector2<f64>) -> Result<(usize, f64)> {
    let (map, least) = (&room.map, room.least);
    let seen = seen_clearance(map, least, goal);
    let near = nodes.square(goal, GOAL_REACH).filter_map(|node| {
        let place = nodes.place(node);
        let free = room.clearance(place, least) >= least;
        (free && map.segment_keeps(goal, place, seen)).then(|| (node, (place - goal).norm()))
    });
    let nearest = near.min_by(|one, two| one.1.total_cmp(&two.1).then(one.0.cmp(&two.0)));
    nearest.ok_or_else(|| {
        let rule = "be seen from a free node of the guide nearby";
        let advice = "a goal farther from the map, or a smaller spacing or margin, has one";
        Failure::invalid("goal", rule, Given::Pair(goal.into())).mended_by(advice)
    })
}
