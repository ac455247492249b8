//! Half-planes without outlines, for robots in lanes: discs, boundary points, the way to the goal.

use super::ReciprocalPlanner;
use crate::planning::half_planes::HalfPlane;
use crate::planning::outline::Legs;
use numeric::lanes::{Planar, Real, Truth, Vector2};

/// [`super::pass`] for a disc that is not touched, by its center and radius: an outline without edges,
/// with the same arithmetic.
#[inline(always)]
pub(super) fn pass_disc<R: Real>(
    (center, radius): (Vector2<R>, R),
    relative: Vector2<R>,
    horizon: f64,
) -> (Vector2<R>, Vector2<R>) {
    let legs = Legs::of_disc(center, radius);
    let share = R::splat(1.0 / horizon);
    let way = relative - center * share;
    let length = way.length();
    let normal = way * (R::splat(1.0) / length);
    let (left_normal, right_normal) = (legs.left.left_normal(), -legs.right.left_normal());
    let zero = R::zero();
    let between = left_normal.perp(&normal).gt(zero) & normal.perp(&right_normal).gt(zero);
    // Without a length there is no number to compare.
    let ahead = between & length.gt(zero);
    let leg = nearer_leg(&legs, relative);
    if !ahead.any() {
        return leg;
    }
    let front = front(normal, radius * share - length);
    (
        Planar::<R>::select(ahead, front.0, leg.0),
        Planar::<R>::select(ahead, front.1, leg.1),
    )
}

/// To the leg that is less deep.
#[inline(always)]
pub(super) fn nearer_leg<R: Real>(
    legs: &Legs<R>,
    relative: Vector2<R>,
) -> (Vector2<R>, Vector2<R>) {
    let left_depth = -legs.left.perp(&relative);
    let right_depth = legs.right.perp(&relative);
    let left = left_depth.lt(right_depth);
    let direction = <Vector2<R> as Planar<R>>::select(left, legs.left, -legs.right);
    let change = direction * relative.dot(&direction) - relative;
    (direction, change)
}

/// Direction of the line and change of velocity at a rounded front.
#[inline(always)]
pub(super) fn front<R: Real>(normal: Vector2<R>, change: R) -> (Vector2<R>, Vector2<R>) {
    (-normal.left_normal(), normal * change)
}

impl ReciprocalPlanner {
    /// Distance of the centers in m at which the robot is as near to a disc as it may be.
    #[inline(always)]
    pub(super) fn touch<R: Real>(&self, radius: R) -> R {
        R::splat(self.robot_radius + self.settings.margin) + radius
    }

    /// Velocity straight to the goal, slightly turned, that does not overshoot it.
    #[inline(always)]
    pub(super) fn wanted<R: Real>(&self, to_goal: Vector2<R>, interval: f64) -> Vector2<R> {
        let distance = to_goal.length();
        let speed = (distance / R::splat(interval)).min(R::splat(self.max_speed));
        let straight = to_goal * (speed / distance);
        let turned =
            straight * R::splat(self.turn.x) + straight.left_normal() * R::splat(self.turn.y);
        let there = distance.le(R::zero());
        Planar::<R>::select(there, Vector2::zeros(), turned)
    }

    /// `v.n <= (d - rho - margin)/tau` for a boundary point in direction `n` at distance `d`.
    #[inline(always)]
    pub(super) fn off_boundary<R: Real>(&self, to: Vector2<R>) -> HalfPlane<R> {
        let distance = to.length();
        let normal = to * (R::splat(1.0) / distance.max(R::splat(f64::MIN_POSITIVE)));
        let room = distance - R::splat(self.robot_radius) - R::splat(self.settings.margin);
        HalfPlane {
            point: normal * (room / R::splat(self.settings.horizon)),
            direction: normal.left_normal(),
        }
    }
}
