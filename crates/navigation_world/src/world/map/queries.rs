//! Exact distances and rays of a map.

use nalgebra::Vector2;

use crate::world::map::Capsule;
use crate::world::map::StaticMap;
use crate::world::map::boundary::Beyond;
use crate::world::map::index::BoundingBox;
use crate::world::shape::{PlacedShape, Shape};

/// Least overhang in m that lies outside of the map: typed numbers are rounded.
const ROUNDING: f64 = 1e-9;

impl StaticMap {
    /// Distance of a point from the map in m: zero inside, infinite without shapes.
    #[must_use]
    pub fn clearance(&self, point: Vector2<f64>) -> f64 {
        self.clearance_up_to(point, f64::INFINITY)
    }

    /// Clearance of a point in m, where all that is at least `most` m away counts as that far.
    #[must_use]
    pub fn clearance_up_to(&self, point: Vector2<f64>, most: f64) -> f64 {
        if self.inside(point) {
            return 0.0;
        }
        let mut least = most;
        self.parts.index.visit(
            most * most,
            |bounds| Some(bounds.distance_squared(point)),
            |_, capsule, _| {
                least = least.min(capsule.distance(point).max(0.0));
                least * least
            },
        );
        least
    }

    /// Whether a point is inside a filled polygon or an occupied cell.
    pub(crate) fn is_inside(&self, point: Vector2<f64>) -> bool {
        self.inside(point)
    }

    /// Visits all capsules within a reach in m of a place, and perhaps others; a visit returns the reach from then on,
    /// a negative one to end.
    pub(crate) fn visit_near(
        &self,
        place: Vector2<f64>,
        reach: f64,
        mut visit: impl FnMut(&Capsule) -> f64,
    ) {
        let squared = |reach: f64| reach.abs() * reach;
        self.parts.index.visit(
            squared(reach),
            |bounds| Some(bounds.distance_squared(place)),
            |_, capsule, _| squared(visit(capsule)),
        );
    }

    fn inside(&self, point: Vector2<f64>) -> bool {
        self.parts.grids.iter().any(|grid| grid.occupied_at(point))
            || (self.parts.outlines && self.turns_around(point) > 0)
    }

    /// Whether all of a shape lies in the map, so that the map shows whatever it would show. What lies
    /// in several overlapping parts together may count as outside.
    #[must_use]
    pub fn holds(&self, placed: &PlacedShape) -> bool {
        let (corners, radius) = (placed.corners(), placed.shape.inner_radius());
        let smaller = PlacedShape {
            shape: shrunk(placed.shape),
            ..*placed
        };
        let reach = corners.iter().map(|corner| (corner - placed.center).norm());
        let reach = reach.fold(radius, f64::max) + ROUNDING;
        let (mut held, mut cut) = (false, false);
        self.parts.index.visit(
            reach * reach,
            |bounds| Some(bounds.distance_squared(placed.center)),
            |_, capsule, limit| {
                if capsule.radius > 0.0 {
                    let within = |corner| capsule.distance(corner) + radius <= ROUNDING;
                    held |= corners.into_iter().all(within);
                } else {
                    // A boundary inside of the shape: something of the shape may lie beyond it.
                    cut |= smaller.distance_of_segment(capsule.from, capsule.to) == 0.0;
                }
                limit
            },
        );
        held || (!cut && self.inside(placed.center))
    }

    /// How many filled outlines are around a point: their edges run counter-clockwise, so those
    /// that cross a ray to the right go up around it once more than down.
    fn turns_around(&self, point: Vector2<f64>) -> i64 {
        let mut turns = 0;
        let beside = |bounds: &BoundingBox| {
            let level = bounds.lower.y <= point.y && point.y <= bounds.upper.y;
            (level && point.x <= bounds.upper.x).then_some(0.0)
        };
        self.parts.index.visit(0.0, beside, |_, edge, limit| {
            let (below, above) = (edge.from.y <= point.y, edge.to.y <= point.y);
            if edge.filled && below != above {
                let side = (edge.to - edge.from).perp(&(point - edge.from));
                turns += i64::from(below && side > 0.0) - i64::from(above && side < 0.0);
            }
            limit
        });
        turns
    }

    /// Least distance of the points of a segment from the map in m: zero where it meets something,
    /// infinite without shapes.
    #[must_use]
    pub fn segment_clearance(&self, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
        if self.inside(from) {
            return 0.0;
        }
        self.segment_distance(from, to, f64::INFINITY, 0.0)
    }

    /// Whether all points of a segment are at least so far from the map, in m.
    #[must_use]
    pub fn segment_keeps(&self, from: Vector2<f64>, to: Vector2<f64>, least: f64) -> bool {
        !self.inside(from) && self.free_segment_keeps(from, to, least)
    }

    /// Distance along a ray from a point that is known to be outside of everything.
    #[must_use]
    pub fn free_segment_keeps(&self, from: Vector2<f64>, to: Vector2<f64>, least: f64) -> bool {
        self.segment_distance(from, to, least, least) >= least
    }

    /// Least distance of a segment that starts outside of everything, at most `most`; anything below
    /// `enough` may be returned once the distance is known to be below it.
    fn segment_distance(
        &self,
        from: Vector2<f64>,
        to: Vector2<f64>,
        most: f64,
        enough: f64,
    ) -> f64 {
        let around = BoundingBox::of_segment(from, to);
        let along = to - from;
        let length = along.norm();
        let normal = Vector2::new(-along.y, along.x) / length;
        let offset = normal.dot(&from);
        let mut least = most;
        self.parts.index.visit(
            most * most,
            |bounds| {
                let square = around.distance_squared_of(bounds);
                if length == 0.0 {
                    return Some(square);
                }
                // Boxes on one side of the line are no nearer than the line.
                let beside = bounds.least_along(normal) - offset;
                let other = bounds.least_along(-normal) + offset;
                let across = beside.max(other).max(0.0);
                Some(square.max(across * across * (1.0 - 1e-9)))
            },
            |_, capsule, _| {
                least = least.min(capsule.distance_of_segment(from, to).max(0.0));
                if least < enough { -1.0 } else { least * least }
            },
        );
        least
    }

    /// The boundary point nearest to a place, `None` without shapes.
    #[must_use]
    pub fn nearest(&self, place: Vector2<f64>) -> Option<Vector2<f64>> {
        self.nearest_beyond(place, f64::INFINITY, &Beyond::default())
    }

    /// Distance along a ray, a unit vector, in m: zero inside, infinite when nothing is hit.
    #[must_use]
    pub fn ray(&self, from: Vector2<f64>, direction: Vector2<f64>) -> f64 {
        self.ray_up_to(from, direction, f64::INFINITY)
    }

    /// Distance along a ray up to a range in m, beyond which nothing is hit.
    #[must_use]
    pub fn ray_up_to(&self, from: Vector2<f64>, direction: Vector2<f64>, range: f64) -> f64 {
        if self.inside(from) {
            return 0.0;
        }
        let inverse = Vector2::new(1.0 / direction.x, 1.0 / direction.y);
        let mut reached = f64::INFINITY;
        self.parts.index.visit(
            range,
            |bounds| {
                let entered = bounds.entered(from, inverse);
                entered.is_finite().then_some(entered)
            },
            |_, capsule, limit| {
                let distance = capsule.cast(from, direction);
                if distance <= limit {
                    reached = reached.min(distance);
                }
                limit.min(distance)
            },
        );
        reached
    }
}

/// The shape without a rim as wide as rounding.
fn shrunk(shape: Shape) -> Shape {
    let less = |size: f64| (size - ROUNDING).max(0.0);
    match shape {
        Shape::Disc { radius } => Shape::Disc {
            radius: less(radius),
        },
        Shape::Rectangle {
            half_length,
            half_width,
            axis,
        } => Shape::Rectangle {
            half_length: less(half_length),
            half_width: less(half_width),
            axis,
        },
    }
}
