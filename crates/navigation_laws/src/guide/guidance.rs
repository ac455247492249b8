//! The guide at work for one robot: it plans again around who stands.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::Vector2;

use crate::guide::plan::Planning;
use crate::guide::{Guide, LocalGoal, Plan, PlanView, RobotRoom, Standing};
use navigation_world::world::map::StaticMap;
use navigation_world::world::shape::PlacedShape;

/// Most nodes that a plan made again settles in one look: an update of a robot takes no longer, and a
/// run and a robot take the plan at the same look, however fast they are.
const NODES_OF_A_LOOK: usize = 2000;

/// Most nodes of all plans around people that are kept, 20 bytes each; beyond them those go that were asked for longest
/// ago.
const MOST_NODES_KEPT: usize = 4_000_000;

/// A plan around people who stand.
#[derive(Clone, Debug)]
struct PlanAround {
    /// The plan without people.
    alone: Plan,
    standing: Vec<PlacedShape>,
    /// Looks that it takes to make it.
    looks: usize,
    plan: Plan,
}

/// Plans around people who stand, shared by runs: a run takes one at the look at which it would have made it.
#[derive(Clone, Debug, Default)]
pub struct PlansAround(Arc<Mutex<VecDeque<PlanAround>>>);

impl PlansAround {
    fn find(&self, alone: &Plan, standing: &[PlacedShape]) -> Option<PlanAround> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |each: &PlanAround| each.alone.is_copy_of(alone) && each.standing == standing;
        let found = kept.iter().position(same).and_then(|at| kept.remove(at))?;
        kept.push_back(found.clone());
        Some(found)
    }

    /// The plan around most of those who stand, and a map of the others.
    fn before(&self, alone: &Plan, standing: &[PlacedShape]) -> (Plan, StaticMap) {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let some = |each: &&PlanAround| {
            each.alone.is_copy_of(alone) && each.standing.iter().all(|one| standing.contains(one))
        };
        let most = kept
            .iter()
            .filter(some)
            .max_by_key(|each| each.standing.len());
        let (plan, around) = most.map_or((alone, &[][..]), |each| (&each.plan, &each.standing));
        let others = standing.iter().filter(|one| !around.contains(one)).copied();
        let others: Vec<PlacedShape> = others.collect();
        (plan.clone(), StaticMap::default().with_shapes(&others))
    }

    fn keep(&self, made: PlanAround) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.push_back(made);
        let mut nodes: usize = kept.iter().map(|each| each.plan.node_count()).sum();
        while nodes > MOST_NODES_KEPT
            && let Some(oldest) = kept.pop_front()
        {
            nodes -= oldest.plan.node_count();
        }
    }
}

/// How a plan around people is come by.
#[derive(Clone, Debug)]
enum Source {
    Made(Planning),
    Kept(PlanAround),
}

/// A plan around people that is not in use yet.
#[derive(Clone, Debug)]
struct PendingPlan {
    standing: Vec<PlacedShape>,
    /// Looks since it was begun.
    looks: usize,
    source: Source,
}

impl PendingPlan {
    /// Works on it for one look; whether it is complete.
    fn advance(&mut self) -> bool {
        self.looks += 1;
        match &mut self.source {
            Source::Made(planning) => planning.advance(NODES_OF_A_LOOK),
            Source::Kept(kept) => self.looks >= kept.looks,
        }
    }

    /// The plan, when it is complete.
    fn finish(self, alone: &Plan, plans: &PlansAround) -> Plan {
        match self.source {
            Source::Kept(kept) => kept.plan,
            Source::Made(planning) => {
                let plan = planning.finish();
                plans.keep(PlanAround {
                    alone: alone.clone(),
                    standing: self.standing,
                    looks: self.looks,
                    plan: plan.clone(),
                });
                plan
            }
        }
    }
}

/// Plans of one run.
#[derive(Clone, Debug)]
pub struct Guidance {
    guide: Guide,
    robot: RobotRoom,
    /// The plan without people.
    alone: Plan,
    /// The plan around those who stand, if somebody does and there is one.
    around: Option<Plan>,
    /// The plan around those who stand now, while it is made.
    planning: Option<PendingPlan>,
    plans: PlansAround,
    standing: Standing,
    /// Whether others stand than the last plan was begun for.
    changed: bool,
}

impl Guidance {
    /// Under a plan that was made by a guide for a robot.
    #[must_use]
    pub fn new(guide: Guide, robot: impl Into<RobotRoom>, plan: Plan) -> Self {
        Self {
            guide,
            robot: robot.into(),
            alone: plan,
            around: None,
            planning: None,
            plans: PlansAround::default(),
            standing: Standing::default(),
            changed: false,
        }
    }

    /// It, with plans around people that other runs share.
    #[must_use]
    pub fn sharing(self, plans: PlansAround) -> Self {
        Self { plans, ..self }
    }

    /// The plan in use.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        self.around.as_ref().unwrap_or(&self.alone)
    }

    /// Whether the plan in use leads around somebody who stands.
    #[must_use]
    pub fn leads_around(&self) -> bool {
        self.around.is_some()
    }

    /// Looks at people, given by their outlines, `None` for who is away. When others stand than before, a
    /// plan around them is made, by a bounded number of nodes in each look, and taken when it is
    /// complete; without a plan around them that without them is used. Returns whether there is
    /// another plan.
    pub fn observe(
        &mut self,
        time: f64,
        position: Vector2<f64>,
        people: impl Iterator<Item = Option<PlacedShape>> + Clone,
    ) -> bool {
        let places = people
            .clone()
            .map(|person| person.map(|placed| placed.center));
        self.changed |= self.standing.observe(time, places);
        if self.changed && self.standing.places().next().is_none() {
            (self.changed, self.planning) = (false, None);
            return self.around.take().is_some();
        }
        // A plan under way is completed first, else people who come and go would keep it from ever
        // being complete.
        if self.changed && self.planning.is_none() {
            self.changed = false;
            self.planning = self.begin(people);
            if self.planning.is_none() {
                return self.around.take().is_some();
            }
        }
        let Some(planning) = self.planning.take_if(PendingPlan::advance) else {
            return false;
        };
        let plan = planning.finish(&self.alone, &self.plans);
        let had = self.around.is_some();
        self.around = plan.view_or_way_back(position).is_some().then_some(plan);
        had || self.around.is_some()
    }

    /// Begins a plan around those who stand; `None` where somebody stands on the goal.
    fn begin(&self, people: impl Iterator<Item = Option<PlacedShape>>) -> Option<PendingPlan> {
        let people: Vec<Option<PlacedShape>> = people.collect();
        let standing = self.standing.places().filter_map(|(index, center)| {
            let placed = people.get(index).copied()??;
            Some(PlacedShape { center, ..placed })
        });
        let standing: Vec<PlacedShape> = standing.collect();
        let source = if let Some(kept) = self.plans.find(&self.alone, &standing) {
            Source::Kept(kept)
        } else {
            let (before, others) = self.plans.before(&self.alone, &standing);
            let after = (&before, others);
            let begun = self
                .alone
                .begin_again(self.guide, self.robot, &standing, after);
            Source::Made(begun.ok()?)
        };
        Some(PendingPlan {
            standing,
            looks: 0,
            source,
        })
    }

    /// Cost at a position and the local goal there, outside of the box of the nodes on the way back into it;
    /// `None` without a plan there.
    #[must_use]
    pub fn local_goal(&self, position: Vector2<f64>) -> Option<(PlanView, LocalGoal)> {
        let plan = self.plan();
        let view = plan.view_or_way_back(position)?;
        Some((view, plan.local_goal(position, &view)))
    }

    /// Replaces a way by the whole one of the plan in use from a position to the goal, in m; empty without one.
    pub fn lead(&self, position: Vector2<f64>, way: &mut Vec<Vector2<f64>>) {
        way.clear();
        let plan = self.plan();
        if let Some(view) = plan.view_or_way_back(position) {
            way.extend(plan.way(position, &view));
        }
    }
}
