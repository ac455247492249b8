//! Least distance between an outline on an arc and what stands still, in closed form.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;

use super::{Arc, Footprint};

/// Motion over a time with a constant twist, from a pose in whose coordinates it is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Velocity of the origin in coordinates of the body times the duration, in m.
    pub way: Vector2<f64>,
    /// Angle turned in rad, positive to the left.
    pub angle: f64,
}

impl From<Arc> for Sweep {
    fn from(arc: Arc) -> Self {
        Self {
            way: Vector2::new(arc.distance, 0.0),
            angle: arc.angle,
        }
    }
}

impl Sweep {
    /// Center of the turn in coordinates of the body, in m.
    pub(super) fn center(&self) -> Vector2<f64> {
        Vector2::new(-self.way.y, self.way.x) / self.angle
    }
}

/// Angles beyond the end of an arc that count as on it, in rad: a nearest place there is none less near.
const ROUNDING: f64 = 1e-12;

/// A piece of a circle.
struct ArcPiece {
    center: Vector2<f64>,
    radius: f64,
    /// Direction of its start in rad.
    start: f64,
    /// Angle to its end in rad, positive counterclockwise.
    turn: f64,
}

impl ArcPiece {
    fn new(center: Vector2<f64>, start: Vector2<f64>, turn: f64) -> Self {
        let from = start - center;
        Self {
            center,
            radius: from.norm(),
            start: from.y.atan2(from.x),
            turn,
        }
    }

    fn holds(&self, direction: f64) -> bool {
        let ahead = ((direction - self.start) * self.turn.signum()).rem_euclid(TAU);
        ahead <= self.turn.abs() + ROUNDING || ahead >= TAU - ROUNDING
    }

    fn at(&self, direction: f64) -> Vector2<f64> {
        self.center + Vector2::new(direction.cos(), direction.sin()) * self.radius
    }

    fn ends(&self) -> [Vector2<f64>; 2] {
        [self.at(self.start), self.at(self.start + self.turn)]
    }
}

/// Distance of a point from a segment in m.
pub(super) fn from_segment(point: Vector2<f64>, [start, end]: [Vector2<f64>; 2]) -> f64 {
    let (along, way) = (end - start, point - start);
    let squared = along.norm_squared();
    let share = if squared > 0.0 {
        way.dot(&along) / squared
    } else {
        0.0
    };
    (way - along * share.clamp(0.0, 1.0)).norm()
}

/// Distance of two segments in m.
fn between_segments(one: [Vector2<f64>; 2], other: [Vector2<f64>; 2]) -> f64 {
    let side =
        |[start, end]: [Vector2<f64>; 2], point: Vector2<f64>| (end - start).perp(&(point - start));
    let parts = |line: [Vector2<f64>; 2], of: [Vector2<f64>; 2]| {
        side(line, of[0]) * side(line, of[1]) < 0.0
    };
    if parts(one, other) && parts(other, one) {
        return 0.0;
    }
    let ends = one.map(|end| from_segment(end, other));
    let others = other.map(|end| from_segment(end, one));
    ends.into_iter().chain(others).fold(f64::INFINITY, f64::min)
}

impl Footprint {
    /// Least distance in m of a segment from the outline on an arc, from its start in the body frame; zero if the
    /// outline reaches it.
    #[must_use]
    pub fn swept_segment(&self, segment: [Vector2<f64>; 2], motion: impl Into<Sweep>) -> f64 {
        let sweep = motion.into();
        let mut least = self.distance_from_segment(segment);
        for end in segment {
            least = least.min(self.swept_point(end, sweep));
        }
        if least <= 0.0 {
            return 0.0;
        }
        for corner in &self.corners {
            let distance = if sweep.angle == 0.0 {
                between_segments([*corner, corner + sweep.way], segment)
            } else {
                let path = ArcPiece::new(sweep.center(), *corner, sweep.angle);
                between_arc_and_segment(&path, segment)
            };
            least = least.min(distance);
        }
        least
    }

    /// Distance of a segment from the outline in m, zero if they meet.
    pub(super) fn distance_from_segment(&self, segment: [Vector2<f64>; 2]) -> f64 {
        let ends = segment.map(|end| self.distance(end));
        let sides = self.sides.iter().map(|side| {
            let end = side.start + side.along * side.length;
            between_segments([side.start, end], segment)
        });
        ends.into_iter().chain(sides).fold(f64::INFINITY, f64::min)
    }
}

fn between_arc_and_segment(arc: &ArcPiece, segment: [Vector2<f64>; 2]) -> f64 {
    let mut least = f64::INFINITY;
    for end in arc.ends() {
        least = least.min(from_segment(end, segment));
    }
    for end in segment {
        let from = end - arc.center;
        if arc.holds(from.y.atan2(from.x)) {
            least = least.min((arc.radius - from.norm()).abs());
        }
    }
    let [start, end] = segment;
    let length = (end - start).norm();
    if length == 0.0 {
        return least;
    }
    let along = (end - start) / length;
    let normal = Vector2::new(-along.y, along.x);
    let (beyond, across) = (normal.dot(&(start - arc.center)), normal.y.atan2(normal.x));
    for direction in [across, across + PI] {
        if arc.holds(direction) {
            least = least.min(from_segment(arc.at(direction), segment));
        }
    }
    if beyond.abs() <= arc.radius && arc.radius > 0.0 {
        let half = (beyond / arc.radius).acos();
        for direction in [across + half, across - half] {
            let place = (arc.at(direction) - start).dot(&along);
            if arc.holds(direction) && (0.0..=length).contains(&place) {
                return 0.0;
            }
        }
    }
    least
}
