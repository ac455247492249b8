//! Walls among people: polylines, rectangles, discs, by their nearest points.

use crate::crowd::agent::SHORTEST;
use navigation_world::world::map::Capsule;
use navigation_world::world::shape::{PlacedShape, Shape, into_axes, out_of_axes};
use numeric::error::{Failure, Given, Result, finite_pair};
use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// A robot that passes a wall within a step touches it if they overlap by more, in m.
const PASSED: f64 = 1e-9;

/// Nearest point of a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Unit vector away from the wall.
    pub normal: Vector,
    /// Distance in m, negative inside.
    pub distance: f64,
}

/// A wall.
#[derive(Clone, Debug, PartialEq)]
pub enum Wall {
    /// Segments between points in m.
    Polyline(Vec<Vector>),
    /// A disc or a rectangle.
    Solid(PlacedShape),
}

impl Wall {
    /// Segments from point to point.
    ///
    /// # Errors
    /// There are fewer than two points, or one is not finite.
    pub fn polyline(points: Vec<[f64; 2]>) -> Result<Self> {
        if points.len() < 2 {
            let given = Given::Count(points.len() as u64);
            return Err(Failure::invalid("points", "be two points or more", given));
        }
        for (index, point) in points.iter().enumerate() {
            finite_pair(&format!("points[{index}]"), *point)?;
        }
        Ok(Self::Polyline(
            points.into_iter().map(Vector::from).collect(),
        ))
    }

    /// A disc or a rectangle.
    ///
    /// # Errors
    /// A number is not finite or not positive.
    pub fn solid(shape: PlacedShape) -> Result<Self> {
        Ok(Self::Solid(shape.checked()?))
    }

    /// Whether a segment between two places cuts or touches the wall.
    #[must_use]
    pub fn hides(&self, from: Vector, to: Vector) -> bool {
        self.clearance_of_way(from, to) <= 0.0
    }

    /// The points of a polyline, or corners of a box around a solid.
    pub(super) fn corners(&self) -> Vec<Vector> {
        match self {
            Self::Polyline(points) => points.clone(),
            Self::Solid(shape) => {
                let reach = match shape.shape {
                    Shape::Disc { radius } => radius,
                    Shape::Rectangle {
                        half_length,
                        half_width,
                        ..
                    } => half_length.hypot(half_width),
                };
                let corner = Vector::repeat(reach);
                vec![shape.center - corner, shape.center + corner]
            }
        }
    }

    /// The nearest point; of segments at the same distance that of the first. `None` on the wall.
    #[inline]
    #[must_use]
    pub fn nearest(&self, place: Vector) -> Option<NearestPoint> {
        match self {
            Self::Polyline(points) => {
                let mut best = (f64::INFINITY, Vector::zeros());
                for ends in points.windows(2) {
                    let offset = from_segment(ends, place);
                    let squared = offset.dot(&offset);
                    if squared < best.0 {
                        best = (squared, offset);
                    }
                }
                off(best.1)
            }
            Self::Solid(shape) => off_contour(shape, place),
        }
    }

    /// The nearest point of every segment, or of the contour, in order.
    #[inline]
    pub fn each_part(&self, place: Vector, mut see: impl FnMut(NearestPoint)) {
        match self {
            Self::Polyline(points) => points
                .windows(2)
                .filter_map(|ends| off(from_segment(ends, place)))
                .for_each(see),
            Self::Solid(shape) => {
                if let Some(near) = off_contour(shape, place) {
                    see(near);
                }
            }
        }
    }

    /// Distance of a place from the wall in m, negative inside.
    #[must_use]
    pub fn clearance(&self, place: Vector) -> f64 {
        self.nearest(place).map_or(0.0, |near| near.distance)
    }

    /// Least distance of the points of a straight way from the wall in m, zero where it meets it.
    #[must_use]
    pub fn clearance_of_way(&self, from: Vector, to: Vector) -> f64 {
        match self {
            Self::Polyline(points) => points
                .windows(2)
                .map(|ends| Capsule::wall(ends[0], ends[1], 0.0).distance_of_segment(from, to))
                .fold(f64::INFINITY, f64::min),
            Self::Solid(shape) => shape.distance_of_segment(from, to),
        }
    }

    /// Least distance of a robot of a radius in m from the wall on a straight way, in m: at its end, or between if it
    /// touches the wall there and not at the end.
    #[must_use]
    pub fn gap_on_way(&self, from: Vector, to: Vector, radius: f64) -> f64 {
        let gap = self.clearance(to) - radius;
        // No point of the way is farther from its end than its length.
        if gap < 0.0 || gap > (to - from).norm() {
            return gap;
        }
        let passed = self.clearance_of_way(from, to) - radius;
        if passed < -PASSED { passed } else { gap }
    }
}

/// Vector from the nearest point of a segment to a place.
fn from_segment(ends: &[Vector], place: Vector) -> Vector {
    let (from, along) = (ends[0], ends[1] - ends[0]);
    let offset = place - from;
    let squared = along.dot(&along);
    if squared == 0.0 {
        return offset;
    }
    offset - along * (offset.dot(&along) / squared).clamp(0.0, 1.0)
}

fn off(offset: Vector) -> Option<NearestPoint> {
    let distance = offset.norm();
    (distance >= SHORTEST).then(|| NearestPoint {
        normal: offset / distance,
        distance,
    })
}

fn off_contour(shape: &PlacedShape, place: Vector) -> Option<NearestPoint> {
    let near = contour(shape, place);
    (near.distance.abs() >= SHORTEST).then_some(near)
}

/// The nearest point of the contour of a disc or rectangle.
pub(super) fn contour(shape: &PlacedShape, place: Vector) -> NearestPoint {
    let offset = place - shape.center;
    match shape.shape {
        Shape::Disc { radius } => {
            let length = offset.norm();
            let distance = length - radius;
            let normal = if length < SHORTEST {
                Vector::x()
            } else {
                offset / length
            };
            NearestPoint { normal, distance }
        }
        Shape::Rectangle {
            half_length,
            half_width,
            axis,
        } => {
            let local = into_axes(offset, axis);
            let depth = Vector::new(half_length - local.x.abs(), half_width - local.y.abs());
            if (depth.x < 0.0 || depth.y < 0.0)
                && let Some(near) = off(shape.shape.offset(offset))
            {
                return near;
            }
            let least = depth.x.min(depth.y);
            let outward = if depth.x <= depth.y {
                Vector::new(1.0_f64.copysign(local.x), 0.0)
            } else {
                Vector::new(0.0, 1.0_f64.copysign(local.y))
            };
            NearestPoint {
                normal: out_of_axes(outward, axis),
                distance: -least,
            }
        }
    }
}

/// Sum of the pushes of all walls, each through its nearest point.
#[inline]
pub(super) fn pushes(
    walls: &[Wall],
    place: Vector,
    push: impl Fn(&NearestPoint) -> Vector,
) -> Vector {
    let mut sum = Vector::zeros();
    for wall in walls {
        if let Some(near) = wall.nearest(place) {
            sum += push(&near);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_acts_once_and_outward() {
        let corner = Wall::polyline(vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]]).unwrap();
        let near = corner.nearest(Vector::new(1.0, 1.0)).unwrap();
        assert_eq!((near.normal, near.distance), (Vector::new(0.0, 1.0), 1.0));
        assert_eq!(corner.nearest(Vector::new(1.0, 0.0)), None);
        let mut parts = 0;
        corner.each_part(Vector::new(1.0, 1.0), |_| parts += 1);
        assert_eq!(parts, 2);
        let disc = Wall::solid(PlacedShape::disc([1.0, 0.0], 0.5)).unwrap();
        let inside = disc.nearest(Vector::new(1.2, 0.0)).unwrap();
        assert_eq!(inside.normal, Vector::x());
        assert!((inside.distance + 0.3).abs() < 1e-15);
        let block = Wall::solid(PlacedShape::upright([0.0, 0.0], [2.0, 1.0])).unwrap();
        let inside = block.nearest(Vector::new(0.2, -0.4)).unwrap();
        assert_eq!(inside.normal, Vector::new(0.0, -1.0));
        assert!((inside.distance + 0.1).abs() < 1e-15);
        assert!((block.clearance(Vector::new(4.0, 4.5)) - 5.0).abs() < 1e-15);
        assert!(Wall::polyline(vec![[0.0, 0.0]]).is_err());
    }
}
