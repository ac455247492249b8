//! Convex sets of velocities, and what the cone of a disc leaves of them.

use super::Vector;
use super::cones::{Cone, ConeBase};
use super::lines::Cap;
use crate::lanes::{Real, Vector2};

/// How far within a cone a velocity is at least that counts as forbidden, relative to 1 m/s and the magnitudes:
/// well above all roundings.
const WITHIN: f64 = 2e-6;

/// Room for roundings around a set, relative: well above all roundings.
const BESIDE: f64 = 1e-7;

/// Most corners of a set.
const CORNERS: usize = 10;

/// Mark of an edge that lies on no line.
pub(super) const NO_LINE: usize = usize::MAX;

/// A convex set of velocities.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    corners: [Vector; CORNERS],
    /// Lines on which the edges lie that begin at the corners.
    lines: [usize; CORNERS],
    count: usize,
}

impl Part {
    /// Corners counter-clockwise, with edges on no line.
    pub fn quadrangle(corners: [Vector; 4]) -> Self {
        let mut part = Self {
            corners: [Vector::zeros(); CORNERS],
            lines: [NO_LINE; CORNERS],
            count: 4,
        };
        part.corners[..4].copy_from_slice(&corners);
        part
    }

    /// Its corners, counter-clockwise; none where it is empty.
    pub fn corners(&self) -> &[Vector] {
        &self.corners[..self.count]
    }

    /// Lines on which the edges lie that meet in a corner.
    pub fn lines_at(&self, corner: usize) -> [usize; 2] {
        let before = if corner == 0 { self.count } else { corner } - 1;
        [self.lines[before], self.lines[corner]]
    }

    /// The largest component along a direction, and its corner.
    pub fn top(&self, along: Vector) -> (f64, usize) {
        let mut top = (f64::NEG_INFINITY, 0);
        for (index, corner) in self.corners().iter().enumerate() {
            let value = corner.dot(&along);
            if value > top.0 {
                top = (value, index);
            }
        }
        top
    }

    /// The part of it whose component along a direction is at least a value, cut along a line; all of it where
    /// that has too many corners.
    pub fn beyond(&self, along: Vector, least: f64, line: usize) -> Self {
        let mut above = [0.0; CORNERS];
        let (mut some, mut all) = (false, true);
        for (above, corner) in above.iter_mut().zip(self.corners()) {
            *above = corner.dot(&along) - least;
            some |= *above >= 0.0;
            all &= *above >= 0.0;
        }
        if all || !some {
            let count = if all { self.count } else { 0 };
            return Self { count, ..*self };
        }
        let mut cut = Self { count: 0, ..*self };
        for index in 0..self.count {
            let next = if index + 1 < self.count { index + 1 } else { 0 };
            let (here, there) = (above[index] >= 0.0, above[next] >= 0.0);
            if here && !cut.push(self.corners[index], self.lines[index]) {
                return *self;
            }
            if here != there {
                let share = above[index] / (above[index] - above[next]);
                let way = self.corners[next] - self.corners[index];
                let along = if here { line } else { self.lines[index] };
                if !cut.push(self.corners[index] + way * share, along) {
                    return *self;
                }
            }
        }
        cut
    }

    /// The part of it that is in another one, or more where that has too many corners.
    pub fn within(mut self, other: &Self) -> Self {
        let corners = other.corners();
        for (index, corner) in corners.iter().enumerate() {
            let edge = corners[(index + 1) % corners.len()] - corner;
            let inward = Vector::new(-edge.y, edge.x);
            self = self.beyond(inward, inward.dot(corner), NO_LINE);
        }
        self
    }

    /// Appends a corner, if there is room for it.
    fn push(&mut self, corner: Vector, line: usize) -> bool {
        let room = self.count < CORNERS;
        if room {
            self.corners[self.count] = corner;
            self.lines[self.count] = line;
            self.count += 1;
        }
        room
    }

    /// A disc around it.
    pub fn cap(&self) -> Cap {
        let sum = self
            .corners()
            .iter()
            .fold(Vector::zeros(), |sum, corner| sum + corner);
        let center = sum * (1.0 / self.count as f64);
        let squares = self
            .corners()
            .iter()
            .map(|corner| (corner - center).norm_squared());
        let radius = squares.fold(0.0, f64::max).sqrt() * (1.0 + BESIDE);
        Cap { center, radius }
    }
}

/// Directions in which the left and the right leg of a disc are left behind, and how far along them a velocity up to a
/// size is forbidden for certain; and how far within the cone that is.
#[inline(always)]
pub(super) fn beyond_legs<R: Real>(
    [left, right]: [Vector2<R>; 2],
    tip: Vector2<R>,
    size: R,
) -> ([(Vector2<R>, R); 2], R) {
    let within = (R::splat(1.0) + tip.x.abs() + tip.y.abs() + size) * R::splat(WITHIN);
    let inward = [
        Vector2::new(left.y, -left.x),
        Vector2::new(-right.y, right.x),
    ];
    let least = |inward: &Vector2<R>| inward.dot(&tip) + within;
    let [one, other] = inward;
    ([(one, least(&one)), (other, least(&other))], within)
}

/// Velocities that the cone of a disc forbids for certain, those beyond two lines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Forbidden {
    /// Directions in which the lines are left behind, what is beyond them, and their places.
    sides: [(Vector, f64, usize); 2],
    /// By how much more a velocity is beyond the lines where cuts along them take it away whatever the roundings.
    room: f64,
}

impl Forbidden {
    /// Of velocities up to a size; `None` where nothing is certain.
    pub fn of(cone: &Cone, index: usize, size: f64) -> Option<Self> {
        if matches!(cone.base, ConeBase::Edges(_)) {
            return None;
        }
        let (legs, tip) = (cone.legs?, cone.tip);
        let (beyond, room) = beyond_legs([legs.left, legs.right], tip, size);
        let side = |number: usize| {
            let (inward, least) = beyond[number];
            (inward, least, 2 * index + number)
        };
        Some(Self {
            sides: [side(0), side(1)],
            room,
        })
    }

    /// Whether a velocity is among them and not close to the others.
    pub fn holds(&self, velocity: Vector) -> bool {
        let beyond =
            |(inward, least, _): &(Vector, f64, usize)| inward.dot(&velocity) > *least + self.room;
        self.sides.iter().all(beyond)
    }

    /// What is left of a part.
    pub fn taken_from(&self, part: &Part) -> [Part; 2] {
        let [
            (left, left_least, left_line),
            (right, right_least, right_line),
        ] = self.sides;
        let beside = part.beyond(-left, -left_least, left_line);
        let behind = part.beyond(left, left_least, left_line);
        [beside, behind.beyond(-right, -right_least, right_line)]
    }
}
