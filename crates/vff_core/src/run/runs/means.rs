//! Mean velocities of a robot on its path: they tell of most far obstacles that the robot was nearest to
//! them where it began, or where it ended.

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

/// Mean velocities from the begin of a path to each of its places, and from each place to the end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Means {
    /// Direction of the whole way, of length 1: the boxes stand along it.
    axis: Vector,
    from_begin: Range,
    to_end: Range,
}

impl Means {
    /// Of a path from one place to another, with marks on the way in their order, both ends among them.
    pub fn of(marks: impl Iterator<Item = Mark>, [begin, end]: [Mark; 2]) -> Self {
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
            to_end: Range::EMPTY,
        };
        let mut before = begin;
        for mark in marks {
            means.pass(&before, &mark, [&begin, &end]);
            before = mark;
        }
        means
    }

    /// Takes in everything from one mark to the next one, a single step away where that is at an end: a
    /// mean to a place on the straight way lies between those to the two marks.
    fn pass(&mut self, from: &Mark, to: &Mark, [begin, end]: [&Mark; 2]) {
        let (passed, left) = (from.steps - begin.steps, end.steps - to.steps);
        debug_assert!((passed > 0 && left > 0) || to.steps == from.steps + 1);
        let off = |steps: usize| to.bend / steps.max(1) as f64;
        self.from_begin.hold(self.mean(begin, to), off(passed));
        self.to_end.hold(self.mean(from, end), off(left));
        if passed > 0 {
            self.from_begin.hold(self.mean(begin, from), off(passed));
        }
        if left > 0 {
            self.to_end.hold(self.mean(to, end), off(left));
        }
    }

    /// Mean velocity between two marks, as the boxes stand.
    fn mean(&self, from: &Mark, to: &Mark) -> Vector {
        let way = (to.place - from.place) * (1.0 / (to.steps - from.steps) as f64);
        self.along(way)
    }

    fn along(&self, vector: Vector) -> Vector {
        Vector::new(self.axis.dot(&vector), self.axis.perp(&vector))
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
        let axis = Vector2::<R>::splat(self.axis.into());
        let along = |vector: Vector2<R>| Vector2::new(axis.dot(&vector), axis.perp(&vector));
        let (step, [away, toward]) = (along(step), ends.map(along));
        self.from_begin.goes(away, step, margin) | self.to_end.goes(-toward, step, margin)
    }
}
