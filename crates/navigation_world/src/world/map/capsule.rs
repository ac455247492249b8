//! The parts of a map: segments with a radius.

use nalgebra::Vector2;

use crate::world::shape::cast_on_disc;
use numeric::error::{Result, finite_pair, not_negative};

/// All points within a radius of a segment; a disc is one whose ends are the same point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// First end of the segment, in m.
    pub from: Vector2<f64>,
    /// Second end of the segment, in m.
    pub to: Vector2<f64>,
    /// Radius in m.
    pub radius: f64,
    /// Set for an edge of a filled outline, which lies to its left.
    pub filled: bool,
}

impl Capsule {
    /// A wall between two points in m, with a radius in m.
    #[must_use]
    pub fn wall(from: Vector2<f64>, to: Vector2<f64>, radius: f64) -> Self {
        Self {
            from,
            to,
            radius,
            filled: false,
        }
    }

    /// A filled disc.
    #[must_use]
    pub fn disc(center: Vector2<f64>, radius: f64) -> Self {
        Self::wall(center, center, radius)
    }

    /// Returns the capsule if its numbers are allowed.
    ///
    /// # Errors
    /// An end is not finite, or the radius is negative or not finite.
    pub fn checked(self) -> Result<Self> {
        finite_pair("from", self.from.into())?;
        finite_pair("to", self.to.into())?;
        not_negative("radius", self.radius)?;
        Ok(self)
    }

    /// The point at a share of the segment.
    #[inline]
    #[must_use]
    pub fn at(&self, share: f64) -> Vector2<f64> {
        // The ends themselves, not numbers close to them.
        if share >= 1.0 {
            self.to
        } else {
            self.from + (self.to - self.from) * share
        }
    }

    /// Share of the segment, within `[first, last]`, whose point is nearest to a place.
    #[inline]
    #[must_use]
    pub fn share_nearest(&self, place: Vector2<f64>, [first, last]: [f64; 2]) -> f64 {
        let along = self.to - self.from;
        let square = along.dot(&along);
        if square > 0.0 {
            ((place - self.from).dot(&along) / square)
                .max(first)
                .min(last)
        } else {
            first
        }
    }

    /// Distance of a point from the segment less the radius, in m: negative within the radius.
    #[inline]
    #[must_use]
    pub fn distance(&self, place: Vector2<f64>) -> f64 {
        let axis = self.at(self.share_nearest(place, [0.0, 1.0]));
        (place - axis).norm() - self.radius
    }

    /// The boundary point over a place on the segment that is nearest to a point.
    #[inline]
    #[must_use]
    pub fn surface(&self, axis: Vector2<f64>, place: Vector2<f64>) -> Vector2<f64> {
        if self.radius == 0.0 {
            return axis;
        }
        let outward = place - axis;
        let distance = outward.norm();
        if distance > 0.0 {
            axis + outward * (self.radius / distance)
        } else {
            axis + Vector2::new(self.radius, 0.0)
        }
    }

    /// Distance of a segment from this one less the radius, in m: zero or below where they touch.
    #[must_use]
    pub fn distance_of_segment(&self, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
        let other = Self::wall(from, to, 0.0);
        if self.crosses(&other) {
            return -self.radius;
        }
        let ends = [other.distance(self.from), other.distance(self.to)];
        let least = ends.into_iter().fold(f64::INFINITY, f64::min) - self.radius;
        least.min(self.distance(from)).min(self.distance(to))
    }

    /// Whether the segments have a point in common, ends included.
    #[must_use]
    pub fn crosses(&self, other: &Self) -> bool {
        let side = |of: &Self, point: Vector2<f64>| (of.to - of.from).perp(&(point - of.from));
        let apart = |one: f64, two: f64| (one > 0.0 && two > 0.0) || (one < 0.0 && two < 0.0);
        let (a, b) = (side(self, other.from), side(self, other.to));
        let (c, d) = (side(other, self.from), side(other, self.to));
        if apart(a, b) || apart(c, d) {
            return false;
        }
        if a == 0.0 && b == 0.0 && c == 0.0 && d == 0.0 {
            // On one line: as intervals along both axes.
            return (0..2).all(|axis| {
                let (low, high) = ordered(self.from[axis], self.to[axis]);
                let (least, most) = ordered(other.from[axis], other.to[axis]);
                low <= most && least <= high
            });
        }
        true
    }

    /// Distance along a ray, a unit vector, to the capsule in m: zero inside, infinite when the ray
    /// misses. Rays do not slip between segments that share an end.
    #[must_use]
    pub fn cast(&self, start: Vector2<f64>, direction: Vector2<f64>) -> f64 {
        if self.radius == 0.0 {
            return cast_on_segment(self.from - start, self.to - start, direction);
        }
        if self.distance(start) <= 0.0 {
            return 0.0;
        }
        let ends = [self.from, self.to]
            .map(|end| cast_on_disc(end - start, self.radius, direction))
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let along = self.to - self.from;
        let length = along.norm();
        if length == 0.0 {
            return ends;
        }
        let across = Vector2::new(-along.y, along.x) * (self.radius / length);
        [across, -across].into_iter().fold(ends, |least, side| {
            let (from, to) = (self.from + side - start, self.to + side - start);
            least.min(cast_on_segment(from, to, direction))
        })
    }
}

fn ordered(one: f64, two: f64) -> (f64, f64) {
    (one.min(two), one.max(two))
}

/// Distance along a ray from the origin to a segment.
fn cast_on_segment(from: Vector2<f64>, to: Vector2<f64>, direction: Vector2<f64>) -> f64 {
    // The same numbers for the end that two segments share, so that there is no gap between them.
    let (left, right) = (direction.perp(&from), direction.perp(&to));
    if (left > 0.0 && right > 0.0) || (left < 0.0 && right < 0.0) {
        return f64::INFINITY;
    }
    let (near, far) = (direction.dot(&from), direction.dot(&to));
    let reached = if left == right {
        // Along the ray.
        if near.min(far) <= 0.0 && near.max(far) >= 0.0 {
            0.0
        } else {
            near.min(far)
        }
    } else {
        (near * right - far * left) / (right - left)
    };
    if reached >= 0.0 {
        reached
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall(from: [f64; 2], to: [f64; 2], radius: f64) -> Capsule {
        Capsule::wall(from.into(), to.into(), radius)
    }

    #[test]
    fn a_ray_meets_sides_and_ends_of_a_capsule() {
        let bar = wall([1.0, -1.0], [1.0, 1.0], 0.25);
        let cast = |from: [f64; 2], to: [f64; 2]| bar.cast(from.into(), to.into());
        assert_eq!(cast([0.0, 0.0], [1.0, 0.0]), 0.75);
        assert_eq!(cast([1.0, 3.0], [0.0, -1.0]), 1.75);
        assert_eq!(cast([1.1, 0.5], [1.0, 0.0]), 0.0);
        assert_eq!(cast([0.0, 1.5], [1.0, 0.0]), f64::INFINITY);
        assert_eq!(cast([0.0, 0.0], [-1.0, 0.0]), f64::INFINITY);
    }

    #[test]
    fn segments_that_cross_touch_or_lie_on_one_line() {
        let one = wall([0.0, 0.0], [2.0, 0.0], 0.0);
        for (from, to, expected) in [
            ([1.0, -1.0], [1.0, 1.0], 0.0),
            ([2.0, 0.0], [3.0, 1.0], 0.0),
            ([1.5, 0.0], [4.0, 0.0], 0.0),
            ([3.0, 0.0], [4.0, 0.0], 1.0),
            ([0.0, 1.0], [2.0, 3.0], 1.0),
        ] {
            let distance = one.distance_of_segment(from.into(), to.into());
            assert_eq!(distance, expected, "{from:?} {to:?}");
        }
    }
}
