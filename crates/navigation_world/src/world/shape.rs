//! Shapes of everything that stands or moves: nearest point, distance, ray.

use nalgebra::Vector2;

use crate::world::frame::Frame;
use numeric::error::{Result, finite, finite_pair, not_negative, positive};
use numeric::lanes::{Planar, Real};

/// More than what rounding adds to a distance, as a share.
pub const SLACK: f64 = 1.0 + 1e-9;

/// A convex outline around a center.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<B: Real = f64> {
    /// A disc.
    Disc {
        /// Radius in m.
        radius: B,
    },
    /// A rectangle; one without width is a straight wall.
    Rectangle {
        /// Half the side along the heading, in m.
        half_length: B,
        /// Half the side across the heading, in m.
        half_width: B,
        /// Unit vector of the heading.
        axis: Vector2<B>,
    },
}

impl Shape {
    /// A rectangle with its sides (length, width) in m along x and y.
    #[must_use]
    pub fn upright([length, width]: [f64; 2]) -> Self {
        Self::Rectangle {
            half_length: 0.5 * length,
            half_width: 0.5 * width,
            axis: Vector2::x(),
        }
    }

    /// A rectangle with its length along a heading in rad.
    #[must_use]
    pub fn turned([length, width]: [f64; 2], heading: f64) -> Self {
        let (sin, cos) = heading.sin_cos();
        Self::Rectangle {
            half_length: 0.5 * length,
            half_width: 0.5 * width,
            axis: Vector2::new(cos, sin),
        }
    }

    /// Distance of the farthest point from the center, in m.
    #[must_use]
    pub fn extent(&self) -> f64 {
        match *self {
            Self::Disc { radius } => radius,
            Self::Rectangle {
                half_length,
                half_width,
                axis,
            } => half_length.hypot(half_width) * axis.norm(),
        }
    }

    /// The outline in every lane.
    #[must_use]
    pub fn widened<B: Real>(&self) -> Shape<B> {
        match *self {
            Self::Disc { radius } => Shape::Disc {
                radius: B::splat(radius),
            },
            Self::Rectangle {
                half_length,
                half_width,
                axis,
            } => Shape::Rectangle {
                half_length: B::splat(half_length),
                half_width: B::splat(half_width),
                axis: Vector2::splat(axis.into()),
            },
        }
    }
}

impl<B: Real> Shape<B> {
    /// Gives one lane another outline, and every lane if that is of another kind.
    pub fn set_lane(&mut self, lane: usize, outline: &Shape) {
        match (self, outline) {
            (Self::Disc { radius }, Shape::Disc { radius: own }) => radius.set(lane, *own),
            (
                Self::Rectangle {
                    half_length,
                    half_width,
                    axis,
                },
                Shape::Rectangle {
                    half_length: length,
                    half_width: width,
                    axis: own,
                },
            ) => {
                half_length.set(lane, *length);
                half_width.set(lane, *width);
                axis.set_lane(lane, (*own).into());
            }
            (other, outline) => *other = outline.widened(),
        }
    }

    /// Part of the distance `d` that lies inside the obstacle (`rho_obs`), in m: `d` is measured
    /// from the center of a disc and from the contour of a rectangle.
    #[inline(always)]
    #[must_use]
    pub fn inner_radius(&self) -> B {
        match self {
            Self::Disc { radius } => *radius,
            Self::Rectangle { .. } => B::zero(),
        }
    }

    /// `D`, whose length is `d`: from the center of a disc or the nearest point of a rectangle, to
    /// a place that is given from the center; zero inside a rectangle.
    #[inline(always)]
    #[must_use]
    pub fn offset(&self, from_center: Vector2<B>) -> Vector2<B> {
        match *self {
            Self::Disc { .. } => from_center,
            Self::Rectangle {
                half_length,
                half_width,
                axis,
            } => {
                let local = into_axes(from_center, axis);
                let beyond = Vector2::new(
                    local.x - clamped(local.x, half_length),
                    local.y - clamped(local.y, half_width),
                );
                out_of_axes(beyond, axis)
            }
        }
    }
}

#[inline(always)]
fn clamped<R: Real>(value: R, limit: R) -> R {
    value.max(-limit).min(limit)
}

/// Components of a vector along and to the left of an axis.
#[inline(always)]
pub fn into_axes<R: Real>(vector: Vector2<R>, axis: Vector2<R>) -> Vector2<R> {
    Vector2::new(axis.dot(&vector), axis.perp(&vector))
}

/// The vector with components along and to the left of an axis.
#[inline(always)]
pub fn out_of_axes<R: Real>(vector: Vector2<R>, axis: Vector2<R>) -> Vector2<R> {
    axis * vector.x + axis.left_normal() * vector.y
}

/// A shape at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedShape {
    /// Center, in m.
    pub center: Vector2<f64>,
    /// Outline around it.
    pub shape: Shape,
}

impl PlacedShape {
    /// A disc of a radius in m.
    #[must_use]
    pub fn disc(center: [f64; 2], radius: f64) -> Self {
        Self {
            center: center.into(),
            shape: Shape::Disc { radius },
        }
    }

    /// A rectangle with its sides (length, width) in m along x and y.
    #[must_use]
    pub fn upright(center: [f64; 2], sides: [f64; 2]) -> Self {
        Self {
            center: center.into(),
            shape: Shape::upright(sides),
        }
    }

    /// A rectangle with its length along a heading in rad.
    #[must_use]
    pub fn turned(center: [f64; 2], sides: [f64; 2], heading: f64) -> Self {
        Self {
            center: center.into(),
            shape: Shape::turned(sides, heading),
        }
    }

    /// A straight wall without thickness between two points in m: a rectangle without width.
    #[must_use]
    pub fn wall(start: [f64; 2], end: [f64; 2]) -> Self {
        let (start, end) = (Vector2::from(start), Vector2::from(end));
        let along = end - start;
        let length = along.norm();
        Self {
            center: start + along * 0.5,
            shape: Shape::Rectangle {
                half_length: 0.5 * length,
                half_width: 0.0,
                axis: if length > 0.0 {
                    along / length
                } else {
                    Vector2::x()
                },
            },
        }
    }

    /// A rectangle as [`Self::turned`], exactly upright for a heading of zero.
    ///
    /// # Errors
    /// A number is not finite, or a side is not positive.
    pub fn rectangle(center: [f64; 2], sides: [f64; 2], heading: f64) -> Result<Self> {
        positive("size[0]", sides[0])?;
        positive("size[1]", sides[1])?;
        finite("angle", heading)?;
        Self::turned(center, sides, heading).checked()
    }

    /// Returns the shape if its numbers are finite and its radius is positive; a rectangle may be a
    /// wall without width.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        finite_pair("center", self.center.into())?;
        match self.shape {
            Shape::Disc { radius } => {
                positive("radius", radius)?;
            }
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => {
                not_negative("length", half_length)?;
                not_negative("width", half_width)?;
                finite_pair("axis", axis.into())?;
                positive("length of axis", axis.norm())?;
            }
        }
        Ok(self)
    }

    /// The shape in the coordinates of a frame.
    #[must_use]
    pub fn seen_from(&self, frame: &Frame) -> Self {
        Self {
            center: frame.inward(self.center - frame.position),
            shape: match self.shape {
                Shape::Disc { radius } => Shape::Disc { radius },
                Shape::Rectangle {
                    half_length,
                    half_width,
                    axis,
                } => Shape::Rectangle {
                    half_length,
                    half_width,
                    axis: frame.inward(axis),
                },
            },
        }
    }

    /// Vector from a point to the nearest point of the shape, zero inside.
    #[inline]
    #[must_use]
    pub fn nearest(&self, from: Vector2<f64>) -> Vector2<f64> {
        match self.shape {
            Shape::Disc { radius } => {
                let to = self.center - from;
                let distance = to.dot(&to).sqrt();
                if distance <= radius {
                    return Vector2::zeros();
                }
                to * ((distance - radius) / distance)
            }
            Shape::Rectangle { .. } => -self.shape.offset(from - self.center),
        }
    }

    /// Whether this is a disc beyond a reach in m from a point, by more than rounding; without a root. No
    /// rectangle is said to be.
    #[inline]
    pub(crate) fn out_of_reach(&self, from: Vector2<f64>, reach: f64) -> bool {
        let Shape::Disc { radius } = self.shape else {
            return false;
        };
        let (to, within) = (self.center - from, SLACK * (reach + radius));
        to.dot(&to) > within * within
    }

    /// Distance of a point from the surface, zero inside, in m.
    #[must_use]
    pub fn distance(&self, from: Vector2<f64>) -> f64 {
        let to = self.nearest(from);
        to.dot(&to).sqrt()
    }

    /// Distance of a segment from the surface, zero where they meet, in m.
    #[must_use]
    pub fn distance_of_segment(&self, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
        match self.shape {
            Shape::Disc { radius } => (from_segment(self.center, from, to) - radius).max(0.0),
            Shape::Rectangle { .. } => {
                let way = to - from;
                let length = way.norm();
                if length > 0.0 && self.cast(from, way / length) <= length {
                    return 0.0;
                }
                let corners = self.corners().map(|corner| from_segment(corner, from, to));
                let ends = [self.distance(from), self.distance(to)];
                corners
                    .into_iter()
                    .chain(ends)
                    .fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Corners of a rectangle in m; those of a disc are all its center.
    #[must_use]
    pub fn corners(&self) -> [Vector2<f64>; 4] {
        let (half, axis) = match self.shape {
            Shape::Disc { .. } => (Vector2::zeros(), Vector2::x()),
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => (Vector2::new(half_length, half_width), axis),
        };
        [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[along, across]| {
            self.center + out_of_axes(Vector2::new(along * half.x, across * half.y), axis)
        })
    }

    /// Whether all of the shape lies beyond the line through a point, on the side of its normal.
    #[inline]
    #[must_use]
    pub fn beyond(&self, from: Vector2<f64>, normal: Vector2<f64>) -> bool {
        let along = (self.center - from).dot(&normal);
        match self.shape {
            Shape::Disc { radius } => along > radius,
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => {
                let local = into_axes(normal, axis);
                along > local.x.abs() * half_length + local.y.abs() * half_width
            }
        }
    }

    /// Distance from a point to the shape along a unit vector, in m: zero inside, infinite when
    /// the ray misses.
    #[inline]
    #[must_use]
    pub fn cast(&self, from: Vector2<f64>, direction: Vector2<f64>) -> f64 {
        match self.shape {
            Shape::Disc { radius } => cast_on_disc(self.center - from, radius, direction),
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => cast_on_rectangle(
                into_axes(from - self.center, axis),
                into_axes(direction, axis),
                Vector2::new(half_length, half_width),
            ),
        }
    }
}

/// Distance of a point from a segment.
fn from_segment(point: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    let along = to - from;
    let square = along.dot(&along);
    let share = if square > 0.0 {
        ((point - from).dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (from + along * share - point).norm()
}

/// Distance along a ray to a disc at an offset from its start.
#[inline]
#[must_use]
pub fn cast_on_disc(to: Vector2<f64>, radius: f64, direction: Vector2<f64>) -> f64 {
    let outside = to.dot(&to) - radius * radius;
    if outside <= 0.0 {
        return 0.0;
    }
    let along = to.dot(&direction);
    // From the distance of the center to the ray: along^2 - |to|^2 would cancel.
    let across = to.perp(&direction);
    let square = radius * radius - across * across;
    if along <= 0.0 || square < 0.0 {
        return f64::INFINITY;
    }
    // The nearer root as a quotient, exact when the ray starts close to the disc.
    outside / (along + square.sqrt())
}

/// Distance along a ray in the axes of a rectangle: the later of the two entries, unless an exit
/// comes before it.
#[inline]
fn cast_on_rectangle(from: Vector2<f64>, direction: Vector2<f64>, half: Vector2<f64>) -> f64 {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for axis in 0..2 {
        if direction[axis] == 0.0 {
            if from[axis].abs() > half[axis] {
                return f64::INFINITY;
            }
            continue;
        }
        let inverse = 1.0 / direction[axis];
        let one = (-half[axis] - from[axis]) * inverse;
        let other = (half[axis] - from[axis]) * inverse;
        enter = enter.max(one.min(other));
        leave = leave.min(one.max(other));
    }
    if enter <= leave { enter } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_is_met_from_both_sides_and_along_itself() {
        let wall = PlacedShape::wall([1.0, -1.0], [1.0, 3.0])
            .checked()
            .unwrap();
        let (left, right) = (Vector2::zeros(), Vector2::new(4.0, 0.0));
        assert_eq!(wall.cast(left, Vector2::x()), 1.0);
        assert_eq!(wall.cast(right, -Vector2::x()), 3.0);
        assert_eq!(wall.cast(left, -Vector2::x()), f64::INFINITY);
        let below = Vector2::new(1.0, -3.0);
        assert_eq!(wall.cast(below, Vector2::y()), 2.0);
        assert_eq!(wall.distance(Vector2::new(4.0, 7.0)), 5.0);
        let point = PlacedShape::wall([1.0, 2.0], [1.0, 2.0]).checked().unwrap();
        assert_eq!(point.distance(Vector2::new(1.0, 0.0)), 2.0);
    }

    #[test]
    fn the_offset_of_the_laws_is_the_nearest_point_of_the_sensors() {
        let table = PlacedShape::turned([0.4, -0.2], [1.2, 0.3], 0.7);
        for place in [[2.0, 1.0], [-1.0, 0.3], [0.5, -3.0]] {
            let place = Vector2::from(place);
            let offset = table.shape.offset(place - table.center);
            assert_eq!(offset, -table.nearest(place));
            assert!((table.distance(place) - offset.norm()).abs() < 1e-15);
        }
    }

    #[test]
    fn sizes_out_of_range_are_refused() {
        assert!(PlacedShape::disc([0.0; 2], 0.0).checked().is_err());
        assert!(PlacedShape::disc([f64::NAN, 0.0], 1.0).checked().is_err());
        assert!(
            PlacedShape::upright([0.0; 2], [1.0, f64::NAN])
                .checked()
                .is_err()
        );
    }
}
