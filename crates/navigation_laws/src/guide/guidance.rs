//! The guide at work for one robot: it plans again around who stands.

use nalgebra::Vector2;

use crate::guide::plan::Planning;
use crate::guide::{Guide, LocalGoal, Plan, PlanView, RobotRoom, Standing};
use navigation_world::world::shape::PlacedShape;

/// Most nodes that a plan made again settles in one look: an update of a robot takes no longer, and a
/// run and a robot take the plan at the same look, however fast they are.
const NODES_OF_A_LOOK: usize = 2000;

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
    planning: Option<Planning>,
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
            standing: Standing::default(),
            changed: false,
        }
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
        let complete = self
            .planning
            .take_if(|planning| planning.advance(NODES_OF_A_LOOK));
        let Some(planning) = complete else {
            return false;
        };
        let (had, plan) = (self.around.is_some(), planning.finish());
        self.around = plan.view_or_way_back(position).is_some().then_some(plan);
        had || self.around.is_some()
    }

    /// Begins a plan around those who stand; `None` where somebody stands on the goal.
    fn begin(&self, people: impl Iterator<Item = Option<PlacedShape>>) -> Option<Planning> {
        let people: Vec<Option<PlacedShape>> = people.collect();
        let standing = self.standing.places().filter_map(|(index, center)| {
            let placed = people.get(index).copied()??;
            Some(PlacedShape { center, ..placed })
        });
        let shapes: Vec<PlacedShape> = standing.collect();
        let map = self.alone.map().with_shapes(&shapes);
        self.alone.begin_again(self.guide, &map, self.robot).ok()
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
