//! Convex outline of a robot that turns and drives: distances, swept distances along arcs, the part that advances.
//!
//! Coordinates are those of the body: the origin is the point that drives and turns (the middle of the axle), x ahead.

mod advancing;
mod contact;
mod sweep;
mod swept_points;
#[cfg(test)]
mod tests;

pub use advancing::{BodyMotion, Twist};
pub use contact::{PassingContact, PassingWay, Separation, TOUCH, first_closed, turned};
pub use sweep::Sweep;

use nalgebra::Vector2;

use numeric::error::{Failure, Given, Result};

/// Most corners of an outline.
pub const MOST_CORNERS: usize = 64;

/// A side with its outward normal.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    start: Vector2<f64>,
    /// Unit vector from its start to its end.
    along: Vector2<f64>,
    length: f64,
    /// Unit vector outward.
    normal: Vector2<f64>,
    /// Distance of its line from the origin in m.
    offset: f64,
}

/// A convex polygon around the point that drives and turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Footprint {
    corners: Vec<Vector2<f64>>,
    sides: Vec<Side>,
    /// Lowest and highest corner of a rectangle along the axes.
    upright: Option<[Vector2<f64>; 2]>,
}

/// Twist of a robot over a time: an arc of constant curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Distance driven in m, negative backward.
    pub distance: f64,
    /// Angle turned in rad, positive to the left.
    pub angle: f64,
}

impl Footprint {
    /// Outline of corners in m, in the order of either direction of rotation.
    ///
    /// # Errors
    /// There are fewer than three corners or more than [`MOST_CORNERS`], a coordinate is not finite, two corners are
    /// the same or three on a line, the polygon is not convex or turns around more than once, or the origin is not
    /// inside of it.
    pub fn polygon(corners: &[[f64; 2]]) -> Result<Self> {
        let name = "corners";
        let count = corners.len();
        if !(3..=MOST_CORNERS).contains(&count) {
            let rule = format!("have 3 to {MOST_CORNERS} corners");
            return Err(Failure::invalid(name, rule, Given::Count(count as u64)));
        }
        for (index, axis) in corners.iter().flat_map(|corner| corner.iter()).enumerate() {
            if !axis.is_finite() {
                let at = format!("{name}[{}]", index / 2);
                return Err(Failure::invalid(at, "be finite", Given::Number(*axis)));
            }
        }
        let mut corners: Vec<_> = corners.iter().map(|[x, y]| Vector2::new(*x, *y)).collect();
        let mut area = 0.0;
        for (index, corner) in corners.iter().enumerate() {
            area += corner.perp(&corners[(index + 1) % count]);
        }
        if area < 0.0 {
            corners.reverse();
        }
        let sides: Vec<Side> = (0..count)
            .map(|index| Side::between(corners[index], corners[(index + 1) % count]))
            .collect();
        let mut turned = 0.0;
        for (index, side) in sides.iter().enumerate() {
            let (next, corner) = (&sides[(index + 1) % count], (index + 1) % count);
            let sine = side.along.perp(&next.along);
            let flat = !(side.length > 0.0 && sine > LEAST_SINE);
            if flat {
                let [x, y] = [corners[corner].x, corners[corner].y];
                let rule = "be the corners of a convex polygon in their order, no two the same and no three on a line";
                return Err(Failure::invalid(
                    name,
                    rule,
                    Given::Found(format!("a corner at ({x}, {y})").into()),
                ));
            }
            turned += sine.atan2(side.along.dot(&next.along));
        }
        if turned > 1.5 * std::f64::consts::TAU {
            let rule = "be the corners of a convex polygon in their order";
            return Err(Failure::invalid(
                name,
                rule,
                Given::Found("one that turns around more than once".into()),
            ));
        }
        let least = sides
            .iter()
            .map(|side| side.offset)
            .fold(f64::INFINITY, f64::min);
        if least <= 0.0 {
            let rule = "hold the origin inside, the point that drives and turns";
            return Err(Failure::invalid(
                name,
                rule,
                Given::Found(format!("a side {} m beyond it", -least).into()),
            ));
        }
        let along_axes = sides.iter().all(|side| side.normal.amin() == 0.0);
        let upright = (count == 4 && along_axes).then(|| {
            let opposite = [corners[0], corners[2]];
            [opposite[0].inf(&opposite[1]), opposite[0].sup(&opposite[1])]
        });
        Ok(Self {
            corners,
            sides,
            upright,
        })
    }

    /// Corners in m, counterclockwise.
    #[must_use]
    pub fn corners(&self) -> &[Vector2<f64>] {
        &self.corners
    }

    /// Radius of the circle around the origin that holds the outline, in m.
    #[must_use]
    pub fn outer_radius(&self) -> f64 {
        self.corners.iter().map(Vector2::norm).fold(0.0, f64::max)
    }

    /// Radius of the circle around the origin that the outline holds, in m.
    #[must_use]
    pub fn inner_radius(&self) -> f64 {
        self.sides
            .iter()
            .map(|side| side.offset)
            .fold(f64::INFINITY, f64::min)
    }

    /// Half of the width of the straight lane around the x axis that holds the outline, in m.
    #[must_use]
    pub fn half_width(&self) -> f64 {
        let beside = self.corners.iter().map(|corner| corner.y.abs());
        beside.fold(0.0, f64::max)
    }

    /// Distance of a point in m; inside the outline minus the distance to the nearest side.
    #[must_use]
    pub fn signed_distance(&self, point: Vector2<f64>) -> f64 {
        let most = self.beyond(point);
        if most <= 0.0 {
            return most;
        }
        let beyond = |side: &Side| side.normal.dot(&(point - side.start));
        let outside = self.sides.iter().filter(|side| beyond(side) > 0.0);
        outside
            .map(|side| side.distance(point))
            .fold(f64::INFINITY, f64::min)
    }

    /// How far a point is beyond the side that it is farthest beyond, in m: no more than its signed distance.
    #[inline]
    #[must_use]
    pub fn beyond(&self, point: Vector2<f64>) -> f64 {
        let beyond = |side: &Side| side.normal.dot(&(point - side.start));
        self.sides
            .iter()
            .map(beyond)
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// Distance of a point in m, zero inside.
    fn distance(&self, point: Vector2<f64>) -> f64 {
        self.signed_distance(point).max(0.0)
    }
}

/// Least sine of the angle between two sides: a smaller one is rounding of three corners on a line.
const LEAST_SINE: f64 = 1e-9;

impl Side {
    fn between(start: Vector2<f64>, end: Vector2<f64>) -> Self {
        let way = end - start;
        let length = way.norm();
        let along = way / length;
        let normal = Vector2::new(along.y, -along.x);
        Self {
            start,
            along,
            length,
            normal,
            offset: normal.dot(&start),
        }
    }

    /// Distance of a point from the side in m.
    fn distance(&self, point: Vector2<f64>) -> f64 {
        let way = point - self.start;
        let share = way.dot(&self.along).clamp(0.0, self.length);
        (way - self.along * share).norm()
    }
}
