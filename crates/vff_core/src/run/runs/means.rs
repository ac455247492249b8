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

/// The means between a mark and places that are taken in one after the other.
struct Between {
    base: Mark,
    axis: Vector,
    range: Range,
    /// The last mark, and what is off the straight way to it.
    last: Mark,
    off: f64,
}

impl Between {
    fn from(base: Mark, axis: Vector, first: Mark) -> Self {
        Self {
            base,
            axis,
            range: Range::EMPTY,
            last: first,
            off: 0.0,
        }
    }

    /// Takes in all places up to the next mark, which lie on one side of the base: a mean to a place on the straight
    /// way lies between those to the two, and what is off that way counts by the steps to it.
    fn take(&mut self, next: Mark) {
        let steps = [self.last, next].map(|mark| mark.steps.abs_diff(self.base.steps));
        let passed = next.steps - self.last.steps;
        debug_assert!(passed > 0 && steps[0].abs_diff(steps[1]) == passed);
        let off = next.bend / steps[0].min(steps[1]).max(1) as f64;
        self.hold_last(off.max(self.off));
        (self.last, self.off) = (next, off);
    }

    fn hold_last(&mut self, off: f64) {
        let steps = self.last.steps as f64 - self.base.steps as f64;
        if steps != 0.0 {
            let way = self.last.place - self.base.place;
            self.range.hold(along(self.axis, way * (1.0 / steps)), off);
        }
    }

    fn all(mut self) -> Range {
        self.hold_last(self.off);
        self.range
    }
}

/// A vector as boxes along an axis of length 1 stand.
#[inline(always)]
fn along<R: Real>(axis: Vector, vector: Vector2<R>) -> Vector2<R> {
    let axis = Vector2::<R>::splat(axis.into());
    Vector2::new(axis.dot(&vector), axis.perp(&vector))
}

/// A place on the way, after a number of steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    pub steps: usize,
    pub place: Vector,
    /// Most by which the robot was off the straight way at constant speed from the mark before, in m.
    pub bend: f64,
}

/// Mean velocities from the start of a path, and from a place soon after it, to each later place, and from each
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
        let mut from_begin = Between::from(begin, axis, begin);
        let mut from_head = Between::from(head, axis, head);
        let mut to_end = Between::from(end, axis, begin);
        for mark in marks {
            from_begin.take(mark);
            if mark.steps > head.steps {
                from_head.take(mark);
            }
            to_end.take(mark);
        }
        Self {
            axis,
            from_begin: from_begin.all(),
            from_head: from_head.all(),
            to_end: to_end.all(),
        }
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
        let [step, away, toward] = [step, ends[0], ends[1]].map(|vector| along(self.axis, vector));
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
        let [step, away] = [step, seen].map(|vector| along(self.axis, vector));
        self.from_head.goes(away, step, margin)
    }
}
