//! The decisions of robots side by side, each in a scene of its own: half-planes in lanes, and a program
//! for each robot whose wanted velocity one of them forbids.

use super::{ReciprocalPlanner, avoiding, pass_disc};
use crate::Situation;
use crate::planning::ScenePlanner;
use crate::planning::half_planes::{HalfPlane, not_faster};
use crate::planning::outline::Outline;
use navigation_world::world::geometry::{Body, at_rest};
use numeric::lanes::{Mask, Planar, Real, Truth, Vector2};

/// A disc as the robots see it.
struct DiscPlane<R: Real> {
    /// Lanes in which it is looked at, and in which it is a boundary point.
    looked_at: R::Mask,
    points: R::Mask,
    /// Distance of the surfaces less the margin, in m.
    gap: R,
    plane: HalfPlane<R>,
}

impl<R: Real> DiscPlane<R> {
    /// `None` where no robot looks at it.
    #[inline(always)]
    fn new(
        planner: &ReciprocalPlanner,
        body: &Body<R>,
        situation: &Situation<'_, R>,
    ) -> Option<Self> {
        let (robot, settings) = (&situation.robot, &planner.settings);
        let radius = body.shape.inner_radius();
        let touch = planner.touch(radius);
        let to: Vector2<R> = Vector2::from(body.state.position) - robot.position;
        let squared = to.dot(&to);
        let gap = squared.sqrt() - touch;
        let looked_at = body.state.present & gap.lt(R::splat(settings.reach));
        if !looked_at.any() {
            return None;
        }
        let relative = robot.velocity - Vector2::from(body.state.velocity);
        let (direction, change) = pass_disc((to, touch), relative, settings.horizon);
        let point = robot.velocity + change * R::splat(settings.share);
        let mut seen = Self {
            looked_at,
            points: looked_at & radius.le(R::zero()) & at_rest(body.state.velocity),
            gap,
            plane: HalfPlane { point, direction },
        };
        let touched = looked_at & !(touch * touch).lt(squared);
        if touched.any() {
            seen.leave(touched, planner, (to, touch, body), situation);
        }
        if seen.points.any() {
            let plane = planner.off_boundary(to);
            let own = &mut seen.plane;
            own.point = Planar::<R>::select(seen.points, plane.point, own.point);
            own.direction = Planar::<R>::select(seen.points, plane.direction, own.direction);
        }
        Some(seen)
    }

    /// Where robots touch it.
    #[cold]
    #[inline(never)]
    fn leave(
        &mut self,
        touched: R::Mask,
        planner: &ReciprocalPlanner,
        (to, touch, body): (Vector2<R>, R, &Body<R>),
        situation: &Situation<'_, R>,
    ) {
        let settings = &planner.settings;
        for lane in (0..R::WIDTH).filter(|lane| touched.lane(*lane)) {
            let velocity = body.state.velocity.map(|axis| axis.lane(lane));
            let outline = Outline::disc(to.lane(lane).into(), touch.lane(lane), velocity.into());
            let plane = avoiding(
                &outline,
                situation.robot.velocity.lane(lane).into(),
                settings.horizon,
                situation.interval,
                settings.share,
            );
            self.plane.point.set_lane(lane, plane.point.into());
            self.plane.direction.set_lane(lane, plane.direction.into());
        }
    }

    /// Its half-plane in one lane.
    fn plane_of(&self, lane: usize) -> HalfPlane {
        HalfPlane {
            point: self.plane.point.lane(lane).into(),
            direction: self.plane.direction.lane(lane).into(),
        }
    }
}

impl ReciprocalPlanner {
    /// The permitted velocity of one lane.
    fn permitted<R: Real>(
        &mut self,
        seen: &[DiscPlane<R>],
        lane: usize,
        wanted: Vector2<f64>,
    ) -> Vector2<f64> {
        self.neighbors.clear();
        for (index, seen) in seen.iter().enumerate() {
            if seen.looked_at.lane(lane) {
                let soft = !seen.points.lane(lane);
                self.neighbors
                    .push((Self::order(seen.gap.lane(lane), soft), index));
            }
        }
        self.solve(wanted, |_, index| seen[index].plane_of(lane))
    }
}

impl ScenePlanner for ReciprocalPlanner {
    #[inline(always)]
    fn desired_velocities<R: Real>(
        planners: &mut [Self],
        situation: &Situation<'_, R>,
    ) -> Vector2<R> {
        let goal = Vector2::new(
            R::from_fn(|lane| planners[lane].goal.x),
            R::from_fn(|lane| planners[lane].goal.y),
        );
        let first = &planners[0];
        let wanted = first.wanted(goal - situation.robot.position, situation.interval);
        let mut chosen = not_faster(wanted, first.max_speed);
        let mut forbidden = R::Mask::none();
        let mut seen = Vec::with_capacity(situation.bodies.len());
        for body in situation.bodies {
            if let Some(own) = DiscPlane::new(first, body, situation) {
                let violated = own.plane.violation(chosen).gt(R::zero());
                forbidden = forbidden | (violated & own.looked_at);
                seen.push(own);
            }
        }
        let mut left = forbidden.bits();
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let permitted = planners[lane].permitted(&seen, lane, wanted.lane(lane).into());
            chosen.set_lane(lane, permitted.into());
        }
        chosen
    }
}
