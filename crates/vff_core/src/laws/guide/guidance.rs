//! The guide at work for one robot: it plans again around who stands.

use nalgebra::Vector2;

use crate::error::{Failure, Result};
use crate::laws::Stop;
use crate::laws::guide::{Guide, LocalGoal, Plan, Standing, View};
use crate::world::shape::PlacedShape;

/// Plans of one run.
#[derive(Clone, Debug)]
pub struct Guidance {
    guide: Guide,
    robot_radius: f64,
    /// The plan without people.
    alone: Plan,
    /// The plan around those who stand, if somebody does and there is one.
    around: Option<Plan>,
    standing: Standing,
}

impl Guidance {
    /// Under a plan that was made by a guide for a robot of a radius in m.
    #[must_use]
    pub fn new(guide: Guide, robot_radius: f64, plan: Plan) -> Self {
        Self {
            guide,
            robot_radius,
            alone: plan,
            around: None,
            standing: Standing::default(),
        }
    }

    /// The plan in use.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        self.around.as_ref().unwrap_or(&self.alone)
    }

    /// Looks at people, given by their outlines, `None` for who is away, and plans again
    /// when others stand than before; without a plan around them that without them is used. Returns
    /// whether there is another plan.
    ///
    /// # Errors
    /// The caller asked to stop.
    #[allow(clippy::needless_pass_by_value)] // an iterator over what the caller has
    pub fn observe(
        &mut self,
        time: f64,
        position: Vector2<f64>,
        people: impl Iterator<Item = Option<PlacedShape>> + Clone,
        stop: Stop<'_>,
    ) -> Result<bool> {
        let places = people
            .clone()
            .map(|person| person.map(|placed| placed.center));
        if !self.standing.observe(time, places) {
            return Ok(false);
        }
        let mut shapes = Vec::new();
        for (index, center) in self.standing.places() {
            if let Some(Some(placed)) = people.clone().nth(index) {
                shapes.push(PlacedShape { center, ..placed });
            }
        }
        let had = self.around.is_some();
        self.around = self.plan_around(&shapes, position, stop)?;
        Ok(had || self.around.is_some())
    }

    fn plan_around(
        &self,
        shapes: &[PlacedShape],
        position: Vector2<f64>,
        stop: Stop<'_>,
    ) -> Result<Option<Plan>> {
        if shapes.is_empty() {
            return Ok(None);
        }
        let map = self.alone.map().with_shapes(shapes);
        match self.alone.again(self.guide, &map, self.robot_radius, stop) {
            Ok(plan) => Ok(plan.view(position).is_some().then_some(plan)),
            Err(Failure::Interrupted) => Err(Failure::Interrupted),
            // Somebody stands on the goal.
            Err(_) => Ok(None),
        }
    }

    /// Cost at a position and the local goal there; `None` without a plan there.
    #[must_use]
    pub fn local_goal(&self, position: Vector2<f64>) -> Option<(View, LocalGoal)> {
        let plan = self.plan();
        let view = plan.view(position)?;
        Some((view, plan.local_goal(position, &view)))
    }
}
