//! Lines of velocities on which a rule of selection can have its optimum: legs of cones and
//! directions to the goal, with what is reachable on each.

use crate::lanes::{Mask, Planar, Real, Vector2};

type Vector = Vector2<f64>;

/// A velocity beyond a limit by less than this share of it is on the limit.
pub(super) const ON_THE_LIMIT: f64 = 1e-9;

/// A square this many times that of a limit is beyond the limit whatever the roundings.
const FAR_BEYOND: f64 = 1.0 + 1e-8;

/// The same where a line that nothing reachable lies on is left out: well above all roundings.
pub(super) const BESIDE: f64 = 1e-7;

/// Discs whose common part the robot can reach by the next sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reachable {
    pub velocity: Vector,
    pub change: f64,
    pub max_speed: f64,
}

impl Reachable {
    pub fn holds(&self, velocity: Vector) -> bool {
        // Nothing that is not a number.
        let within =
            |vector: Vector, limit: f64| vector.dot(&vector).sqrt() <= limit * (1.0 + ON_THE_LIMIT);
        within(velocity, self.max_speed) && within(velocity - self.velocity, self.change)
    }

    pub fn circles(&self) -> [(Vector, f64); 2] {
        [
            (Vector::zeros(), self.max_speed),
            (self.velocity, self.change),
        ]
    }

    /// Whether it is not far beyond what is reachable.
    #[inline]
    pub fn may_hold(&self, velocity: Vector) -> bool {
        let near = |vector: Vector, limit: f64| vector.dot(&vector) <= limit * limit * FAR_BEYOND;
        near(velocity, self.max_speed) & near(velocity - self.velocity, self.change)
    }

    /// Ends of the part of a whole line that is reachable, generously; `None` without one.
    pub fn chord(&self, line: &Line) -> Option<[Vector; 2]> {
        let (some, ends) = self.chords((line.from, line.along), f64::NEG_INFINITY);
        some.then_some(ends)
    }

    /// The same for lines side by side, each along a direction of length 1 from so far ahead of a velocity on:
    /// which of them have such a part, and its ends.
    #[inline(always)]
    pub fn chords<R: Real>(
        &self,
        (from, along): (Vector2<R>, Vector2<R>),
        begin: f64,
    ) -> (R::Mask, [Vector2<R>; 2]) {
        let (mut low, mut high) = (R::splat(begin), R::splat(f64::INFINITY));
        let mut beside = R::Mask::none();
        let circles = self.circles();
        for (center, radius) in &circles {
            let offset = from - Vector2::splat([center.x, center.y]);
            let foot = -offset.dot(&along);
            let across = offset.perp(&along);
            let wide = R::splat(radius * (1.0 + BESIDE) + BESIDE);
            let square = wide * wide - across * across;
            // A line where a number is not one is kept.
            beside = beside | square.lt(R::zero());
            let half = square.sqrt();
            (low, high) = ((foot - half).max(low), (foot + half).min(high));
        }
        let ends = [from + along * low, from + along * high];
        (!beside & low.le(high), ends)
    }
}

/// A disc of velocities.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cap {
    pub center: Vector,
    pub radius: f64,
}

impl Cap {
    /// A disc around the part of it whose component along a direction is at least a value.
    pub fn beyond(self, least: f64, along: Vector) -> Self {
        let away = least - self.center.dot(&along);
        // Also where a number is not one.
        if !(away > 0.0 && away < f64::INFINITY) {
            return self;
        }
        let square = self.radius * self.radius * FAR_BEYOND - away * away;
        Self {
            center: self.center + along * away,
            radius: square.max(0.0).sqrt(),
        }
    }

    /// Whether a velocity is in it, generously.
    #[inline]
    pub fn may_hold(&self, velocity: Vector) -> bool {
        let offset = velocity - self.center;
        let wide = self.radius * (1.0 + 0.5 * BESIDE) + 0.5 * BESIDE;
        offset.dot(&offset) <= wide * wide
    }

    /// How far its center is from lines through some velocities where it is beside them whatever the roundings.
    #[inline(always)]
    pub fn reach<R: Real>(&self, from: Vector2<R>) -> R {
        let offset = Vector2::splat([self.center.x, self.center.y]) - from;
        let size = R::splat(1.0) + offset.x.abs() + offset.y.abs();
        R::splat(self.radius * (1.0 + BESIDE)) + size * R::splat(BESIDE)
    }
}

/// Velocities from a point on along a direction of length 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub from: Vector,
    pub along: Vector,
}

impl Line {
    /// Its velocities that by themselves may be the best: nearest to a wanted one, and on the
    /// circles that bound what is reachable.
    pub fn own(&self, wanted: Vector, reachable: &Reachable) -> [Option<Vector>; 5] {
        let Self { from, along } = *self;
        let nearest = from + along * (along.dot(&(wanted - from)).max(0.0));
        let [slow, near] = reachable.circles();
        let [a, b] = self.on_circle(slow);
        let [c, d] = self.on_circle(near);
        [Some(nearest), a, b, c, d]
    }

    /// Where it meets a circle.
    fn on_circle(&self, (center, radius): (Vector, f64)) -> [Option<Vector>; 2] {
        let Self { from, along } = *self;
        let offset = from - center;
        let foot = -offset.dot(&along);
        let square = foot * foot + radius * radius - offset.dot(&offset);
        if square < 0.0 {
            return [None, None];
        }
        let half = square.sqrt();
        [foot - half, foot + half].map(|share| (share >= 0.0).then(|| from + along * share))
    }

    /// Whether a velocity on it is not behind the point that it begins at, up to roundings.
    #[inline]
    pub fn is_ahead(&self, velocity: Vector) -> bool {
        (velocity - self.from).dot(&self.along) >= -ON_THE_LIMIT
    }

    /// Where it crosses the whole line of another one.
    #[inline]
    pub fn crossing(&self, other: &Self) -> Option<Vector> {
        let sine = self.along.perp(&other.along);
        if sine == 0.0 {
            return None;
        }
        let share = (other.from - self.from).perp(&other.along) / sine;
        Some(self.from + self.along * share)
    }
}

/// Where the circle of the speed meets the circle of the change.
pub(super) fn where_circles_meet(reachable: &Reachable) -> [Option<Vector>; 2] {
    let center = reachable.velocity;
    let square = center.dot(&center);
    if square == 0.0 {
        return [None, None];
    }
    let (speed, change) = (reachable.max_speed, reachable.change);
    let share = 0.5 * (1.0 + (speed * speed - change * change) / square);
    let across = speed * speed / square - share * share;
    // The square of a speed of less than 1e-150 m/s is nearly nothing, and what is divided by it no number.
    if !(0.0..f64::INFINITY).contains(&across) {
        return [None, None];
    }
    let half = across.sqrt();
    [half, -half].map(|side| Some(center * share + center.left_normal() * side))
}
