//! The part of an outline that moves outward, and the room ahead of it.

use nalgebra::Vector2;

use super::{Footprint, Side};
use crate::world::shape::{PlacedShape, Shape};

/// Twist of a robot at an instant: velocity ahead in m/s and turn rate in rad/s, positive to the left.
pub type Twist = [f64; 2];

/// Motion of a body at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMotion {
    /// Velocity of the origin in coordinates of the body, in m/s.
    pub velocity: Vector2<f64>,
    /// Turn rate in rad/s, positive to the left.
    pub turn_rate: f64,
}

impl BodyMotion {
    /// At rest.
    pub const REST: Self = Self {
        velocity: Vector2::new(0.0, 0.0),
        turn_rate: 0.0,
    };

    /// Velocity of a point of the body, in its coordinates, in m/s.
    #[inline]
    #[must_use]
    pub fn at(&self, point: Vector2<f64>) -> Vector2<f64> {
        self.velocity + Vector2::new(-point.y, point.x) * self.turn_rate
    }
}

impl From<Twist> for BodyMotion {
    fn from([ahead, turn_rate]: Twist) -> Self {
        Self {
            velocity: Vector2::new(ahead, 0.0),
            turn_rate,
        }
    }
}

impl Footprint {
    /// Distance in m of a point from the room ahead of the outline: all places at most `depth` in m outward of a point of
    /// the outline that moves outward, and from there inward to the middle; infinite at rest.
    #[must_use]
    pub fn distance_from_room_ahead(
        &self,
        point: Vector2<f64>,
        motion: impl Into<BodyMotion>,
        depth: f64,
    ) -> f64 {
        let motion = &motion.into();
        let strips = self
            .sides
            .iter()
            .map(|side| side.distance_from_strip(point, motion, depth));
        let count = self.sides.len();
        let sectors = (0..count).map(|index| {
            let normals = [
                self.sides[index].normal,
                self.sides[(index + 1) % count].normal,
            ];
            from_sector(
                point - self.corners[(index + 1) % count],
                motion.at(self.corners[(index + 1) % count]),
                normals,
                depth,
            )
        });
        strips.chain(sectors).fold(f64::INFINITY, f64::min)
    }

    /// Lower bound in m of the distance of a rectangle, in coordinates of the body, from the same room; infinite at rest.
    /// Sectors count as whole discs around their corners.
    #[must_use]
    pub fn rectangle_from_room_ahead(
        &self,
        rectangle: &PlacedShape,
        motion: impl Into<BodyMotion>,
        depth: f64,
    ) -> f64 {
        let motion = &motion.into();
        let [a, b, c, d] = rectangle.corners();
        let edges = [[a, b], [b, d], [d, c], [c, a]];
        let from = |room: &PlacedShape| {
            if rectangle.distance(room.center) <= 0.0 {
                return 0.0;
            }
            let edges = edges.map(|[start, end]| room.distance_of_segment(start, end));
            edges.into_iter().fold(f64::INFINITY, f64::min)
        };
        let strips = self
            .sides
            .iter()
            .filter_map(|side| side.strip(motion, depth));
        let count = self.sides.len();
        let sectors = (0..count).filter_map(|index| {
            let corner = self.corners[(index + 1) % count];
            let normals = [index, (index + 1) % count].map(|side| self.sides[side].normal);
            let outward = normals.map(|normal| motion.at(corner).dot(&normal) > 0.0);
            outward
                .contains(&true)
                .then(|| PlacedShape::disc(corner.into(), depth))
        });
        strips
            .chain(sectors)
            .map(|room| from(&room))
            .fold(f64::INFINITY, f64::min)
    }
}

impl Side {
    /// Ends of the part of the side that moves outward, in m from its start.
    fn outward(&self, motion: &BodyMotion) -> Option<[f64; 2]> {
        let outward = |share: f64| motion.at(self.start + self.along * share).dot(&self.normal);
        let (first, last) = (outward(0.0), outward(self.length));
        let zero = self.length * first / (first - last);
        match (first > 0.0, last > 0.0) {
            (true, true) => Some([0.0, self.length]),
            (true, false) => Some([0.0, zero]),
            (false, true) => Some([zero, self.length]),
            (false, false) => None,
        }
    }

    /// The strip ahead of the part of the side that moves outward.
    fn strip(&self, motion: &BodyMotion, depth: f64) -> Option<PlacedShape> {
        let [from, to] = self.outward(motion)?;
        let half = 0.5 * (self.offset + depth);
        let middle = self.start.dot(&self.along) + 0.5 * (from + to);
        Some(PlacedShape {
            center: self.along * middle + self.normal * half,
            shape: Shape::Rectangle {
                half_length: 0.5 * (to - from),
                half_width: half,
                axis: self.along,
            },
        })
    }

    /// Distance of a point in m from the strip ahead of the part of the side that moves outward.
    fn distance_from_strip(&self, point: Vector2<f64>, motion: &BodyMotion, depth: f64) -> f64 {
        let Some([from, to]) = self.outward(motion) else {
            return f64::INFINITY;
        };
        let start = self.start.dot(&self.along);
        let (along, beyond) = (point.dot(&self.along) - start, point.dot(&self.normal));
        let apart = [
            along - along.clamp(from, to),
            beyond - beyond.clamp(0.0, self.offset + depth),
        ];
        apart[0].hypot(apart[1])
    }
}

/// Distance in m of a point, given from a corner, from the sector of those directions between the normals of its sides
/// in which the corner moves.
fn from_sector(
    point: Vector2<f64>,
    velocity: Vector2<f64>,
    [first, last]: [Vector2<f64>; 2],
    depth: f64,
) -> f64 {
    // A direction across the velocity, in which the corner moves neither out nor in, may lie between the normals.
    let (from, to) = match (velocity.dot(&first) > 0.0, velocity.dot(&last) > 0.0) {
        (true, true) => (first, last),
        (true, false) => (first, across(velocity, 1.0)),
        (false, true) => (across(velocity, -1.0), last),
        (false, false) => return f64::INFINITY,
    };
    if inside(point, from, to) {
        return (point.norm() - depth).max(0.0);
    }
    let ray = |end: Vector2<f64>| (point - end * point.dot(&end).clamp(0.0, depth)).norm();
    ray(from).min(ray(to))
}

/// Unit vector a quarter turn to the left (1) or right (-1) of a velocity.
fn across(velocity: Vector2<f64>, side: f64) -> Vector2<f64> {
    Vector2::new(-velocity.y, velocity.x) * (side / velocity.norm())
}

/// Whether a direction lies between two others less than half a turn apart, counterclockwise.
fn inside(direction: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>) -> bool {
    from.perp(&direction) >= 0.0 && direction.perp(&to) >= 0.0
}
