//! Mean velocities of a robot on its path: they tell of most far obstacles that the robot was nearest to
//! them where it began, soon after that, or where it ended.

use crate::lanes::{Planar, Real, Vector2};

type Vector = Vector2<f64>;

/// A box that holds mean velocities, in m for each motion step.
#[derive(Clone, Copy, Debug)]
struct Range {
    low: Vector,
    high: Vector,
}

impl Range {
    const EMPTY: Self = Self {
        low: Vector::new(f64::INFINITY, f64::INFINITY),
        high: Vector::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// Takes in a velocity and all that differ from it by no more than given.
    fn hold(&mut self, mean: Vector, off: f64) {
        for axis in 0..2 {
            self.low[axis] = self.low[axis].min(mean[axis] - off);
            self.high[axis] = self.high[axis].max(mean[axis] + off);
        }
    }

    /// Takes in the means from a mark to all places between two that are not before it: a mean to a place on the
    /// straight way lies between those to the two, and what is off that way counts by the steps to it.
    fn hold_from(
        &mut self,
        base: &Mark,
        between: [&Mark; 2],
        means: impl Fn(&Mark, &Mark) -> Vector,
    ) {
        let [from, to] = between;
        let passed = from.steps - base.steps;
        let off = to.bend / passed.max(1) as f64;
        self.hold(means(base, to), off);
        if passed > 0 {
            self.hold(means(base, from), off);
        }
    }

    /// The same from the places to a mark that is not before them.
    fn hold_to(&mut self, between: [&Mark; 2], end: &Mark, means: impl Fn(&Mark, &Mark) -> Vector) {
        let [from, to] = between;
        let left = end.steps - to.steps;
        let off = to.bend / left.max(1) as f64;
        self.hold(means(from, end), off);
        if left > 0 {
            self.hold(means(to, end), off);
        }
    }

    /// Whether all of them, less another velocity, go along a direction by more than a share of its length.
    #[inline(always)]
    fn goes<R: Real>(&self, along: Vector2<R>, less: Vector2<R>, share: R) -> R::Mask {
        let least = |axis: usize| {
            let [low, high] = [self.low[axis], self.high[axis]].map(R::splat);
            let end = R::select(along[axis].lt(R::zero()), high, low);
            along[axis] * (end - less[axis])
        };
        (share * (along.x.abs() + along.y.abs())).lt(least(0) + least(1))
    }
}

/// A place on the way, after a number of steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    pub steps: usize,
    pub place: Vector,
    /// Most by which the robot was off the straight way at constant speed from the mark before, in m.
    pub bend: f64,
}

/// Mean velocities from the begin of a path, and from a place soon after it, to each later place, and from each
/// place to the end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Means {
    /// Direction of the whole way, of length 1: the boxes stand along it.
    axis: Vector,
    from_begin: Range,
    from_head: Range,
    to_end: Range,
}

impl Means {
    /// Of a path from one place to another, with marks on the way in their order; begin and end are marks, and so
    /// is the end of the head.
    pub fn of(marks: impl Iterator<Item = Mark>, [begin, head, end]: [Mark; 3]) -> Self {
        let way = end.place - begin.place;
        let length = way.norm();
        let axis = if length > 0.0 {
            way * (1.0 / length)
        } else {
            Vector::new(1.0, 0.0)
        };
        let mut means = Self {
            axis,
            from_begin: Range::EMPTY,
            from_head: Range::EMPTY,
            to_end: Range::EMPTY,
        };
        let mean = |from: &Mark, to: &Mark| {
            let way = (to.place - from.place) * (1.0 / (to.steps - from.steps) as f64);
            Vector::new(axis.dot(&way), axis.perp(&way))
        };
        let mut before = begin;
        for mark in marks {
            let between = [&before, &mark];
            means.from_begin.hold_from(&begin, between, mean);
            if before.steps >= head.steps {
                means.from_head.hold_from(&head, between, mean);
            }
            means.to_end.hold_to(between, &end, mean);
            before = mark;
        }
        means
    }

    /// A vector as the boxes stand.
    #[inline(always)]
    fn along<R: Real>(&self, vector: Vector2<R>) -> Vector2<R> {
        let axis = Vector2::<R>::splat(self.axis.into());
        Vector2::new(axis.dot(&vector), axis.perp(&vector))
    }

    /// Of which obstacles all places on the way are farther than one of the ends is, by more than a
    /// margin in m: they are seen from the ends as given, and move by a way in each step.
    #[inline(always)]
    pub fn nearest_at_an_end<R: Real>(
        &self,
        ends: [Vector2<R>; 2],
        step: Vector2<R>,
        margin: R,
    ) -> R::Mask {
        let (step, [away, toward]) = (self.along(step), ends.map(|end| self.along(end)));
        self.from_begin.goes(away, step, margin) | self.to_end.goes(-toward, step, margin)
    }

    /// The same of which all places behind the head are farther than its end is, from which they are seen as given.
    #[inline(always)]
    pub fn nearest_in_the_head<R: Real>(
        &self,
        seen: Vector2<R>,
        step: Vector2<R>,
        margin: R,
    ) -> R::Mask {
        let (step, away) = (self.along(step), self.along(seen));
        self.from_head.goes(away, step, margin)
    }
}
