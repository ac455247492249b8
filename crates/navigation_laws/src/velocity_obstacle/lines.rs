//! Lines of velocities on which a rule of selection can have its optimum: legs of cones and directions to the
//! goal, their reachable parts, and the parts of them that one obstacle forbids.

use super::{Cone, Vector};
use numeric::lanes::Planar;

/// A velocity beyond a limit by less than this share of it is on the limit.
pub(super) const ON_THE_LIMIT: f64 = 1e-9;

/// A square this many times that of a limit is beyond the limit whatever the roundings.
const FAR_BEYOND: f64 = 1.0 + 1e-8;

/// Tolerance with which a line that nothing reachable lies on is left out: well above all roundings.
const BESIDE: f64 = 1e-7;

/// Discs whose common part the robot can reach by the next sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reachable {
    pub velocity: Vector,
    pub change: f64,
    pub max_speed: f64,
}

impl Reachable {
    pub fn holds(&self, velocity: Vector) -> bool {
        // Nothing that is not a number.
        let within =
            |vector: Vector, limit: f64| vector.dot(&vector).sqrt() <= limit * (1.0 + ON_THE_LIMIT);
        within(velocity, self.max_speed) && within(velocity - self.velocity, self.change)
    }

    pub fn circles(&self) -> [(Vector, f64); 2] {
        [
            (Vector::zeros(), self.max_speed),
            (self.velocity, self.change),
        ]
    }

    /// True for velocities not far beyond the reachable ones.
    #[inline]
    pub fn may_hold(&self, velocity: Vector) -> bool {
        let near = |vector: Vector, limit: f64| vector.dot(&vector) <= limit * limit * FAR_BEYOND;
        near(velocity, self.max_speed) & near(velocity - self.velocity, self.change)
    }

    /// Ends of the part of a line that is reachable, generously; `None` without one.
    pub fn chord(&self, line: &Line) -> Option<[Vector; 2]> {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for (center, radius) in self.circles() {
            let offset = line.from - center;
            let foot = -offset.dot(&line.along);
            let across = offset.perp(&line.along);
            let wide = radius * (1.0 + BESIDE) + BESIDE;
            let square = wide * wide - across * across;
            // Also where a number is not one: such a line is kept.
            if square < 0.0 {
                return None;
            }
            let half = square.sqrt();
            (low, high) = (low.max(foot - half), high.min(foot + half));
        }
        let at = |share: f64| line.from + line.along * share;
        (low <= high).then(|| [at(low), at(high)])
    }
}

/// A disc of velocities.
#[derive(Clone, Copy, Debug)]
pub(super) struct VelocityDisc {
    pub center: Vector,
    pub radius: f64,
}

impl VelocityDisc {
    /// A disc around the part of it whose component along a direction is at least a value.
    pub fn beyond(self, least: f64, along: Vector) -> Self {
        let away = least - self.center.dot(&along);
        // Also where a number is not one.
        if !(away > 0.0 && away < f64::INFINITY) {
            return self;
        }
        let square = self.radius * self.radius * FAR_BEYOND - away * away;
        Self {
            center: self.center + along * away,
            radius: square.max(0.0).sqrt(),
        }
    }

    /// How far its center, given from a point of a line, is from that where it is beside it whatever the
    /// roundings.
    #[inline]
    pub fn reach(&self, offset: Vector) -> f64 {
        let room = BESIDE * (1.0 + offset.x.abs() + offset.y.abs());
        self.radius * (1.0 + BESIDE) + room
    }
}

/// Velocities from a point on along a direction of length 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub from: Vector,
    pub along: Vector,
}

impl Line {
    /// Its velocities that by themselves may be the best: nearest to a wanted one, and on the
    /// circles that bound what is reachable.
    pub fn own(&self, wanted: Vector, reachable: &Reachable) -> [Option<Vector>; 5] {
        let Self { from, along } = *self;
        let nearest = from + along * (along.dot(&(wanted - from)).max(0.0));
        let [slow, near] = reachable.circles();
        let [a, b] = self.on_circle(slow);
        let [c, d] = self.on_circle(near);
        [Some(nearest), a, b, c, d]
    }

    /// Where it meets a circle.
    fn on_circle(&self, (center, radius): (Vector, f64)) -> [Option<Vector>; 2] {
        let Self { from, along } = *self;
        let offset = from - center;
        let foot = -offset.dot(&along);
        let square = foot * foot + radius * radius - offset.dot(&offset);
        if square < 0.0 {
            return [None, None];
        }
        let half = square.sqrt();
        [foot - half, foot + half].map(|share| (share >= 0.0).then(|| from + along * share))
    }

    /// Where it crosses the whole line of another one.
    #[inline]
    pub fn crossing(&self, other: &Self) -> Option<Vector> {
        let sine = self.along.perp(&other.along);
        if sine == 0.0 {
            return None;
        }
        let share = (other.from - self.from).perp(&other.along) / sine;
        Some(self.from + self.along * share)
    }
}

/// Where the circle of the speed meets the circle of the change.
pub(super) fn where_circles_meet(reachable: &Reachable) -> [Option<Vector>; 2] {
    let center = reachable.velocity;
    let square = center.dot(&center);
    if square == 0.0 {
        return [None, None];
    }
    let (speed, change) = (reachable.max_speed, reachable.change);
    let share = 0.5 * (1.0 + (speed * speed - change * change) / square);
    let across = speed * speed / square - share * share;
    // The square of a speed of less than 1e-150 m/s is nearly nothing, and what is divided by it no number.
    if !(0.0..f64::INFINITY).contains(&across) {
        return [None, None];
    }
    let half = across.sqrt();
    [half, -half].map(|side| Some(center * share + center.left_normal() * side))
}

/// How far within a cone a velocity is at least, relative to 1 m/s and the magnitudes: well above all
/// roundings.
const WITHIN: f64 = 1e-6;

/// Share of the horizon within which the contact is at least.
const SOON: f64 = 0.9;

/// Most discs that are looked at: the nearest ones have the widest cones, and others mostly forbid no
/// whole line.
const MOST: usize = 24;

/// The cone of a disc.
#[derive(Clone, Copy, Debug)]
struct Cover {
    left: Vector,
    right: Vector,
    /// How far its tip is beside lines through zero along its legs, and 1 m/s more than the magnitude of
    /// that.
    beside: [f64; 2],
    size: f64,
    /// Its place among all cones.
    index: usize,
}

/// Cones of the nearest discs that are not touched.
#[derive(Clone, Debug, Default)]
pub(super) struct Covers {
    discs: Vec<Cover>,
}

impl Covers {
    /// Of some cones.
    pub fn of(cones: &[Cone], chosen: &[usize]) -> Self {
        let distance = |index: &usize| {
            let center = cones[*index].outline.center()?;
            Some((center.dot(&center), *index))
        };
        let mut discs: Vec<(f64, usize)> = chosen.iter().filter_map(distance).collect();
        if discs.len() > MOST {
            discs.select_nth_unstable_by(MOST, |one, other| one.0.total_cmp(&other.0));
            discs.truncate(MOST);
        }
        let cover = |&(_, index): &(f64, usize)| Cover::of(&cones[index], index);
        Self {
            discs: discs.iter().filter_map(cover).collect(),
        }
    }

    /// Whether one of the discs forbids everything between two velocities, and what is as near to that
    /// as roundings are: what a disc forbids is convex.
    pub fn cover(&mut self, cones: &[Cone], ends: [Vector; 2], horizon: f64) -> bool {
        let size = ends.map(|end| end.x.abs() + end.y.abs());
        let size = size[0].max(size[1]);
        let forbids = |disc: &Cover| {
            disc.holds(ends, size)
                && (horizon == f64::INFINITY || {
                    let soon =
                        |end: &Vector| cones[disc.index].time_to_contact(*end) <= SOON * horizon;
                    ends.iter().all(soon)
                })
        };
        let Some(found) = self.discs.iter().position(forbids) else {
            return false;
        };
        // It mostly forbids the next line, too.
        self.discs.swap(0, found);
        true
    }
}

impl Cover {
    fn of(cone: &Cone, index: usize) -> Option<Self> {
        let (legs, tip) = (cone.legs?, cone.outline.velocity);
        Some(Self {
            left: legs.left,
            right: legs.right,
            beside: [legs.left.perp(&tip), legs.right.perp(&tip)],
            size: 1.0 + tip.x.abs() + tip.y.abs(),
            index,
        })
    }

    /// Without a branch for each end, which nothing foretells.
    #[inline]
    fn holds(&self, [first, second]: [Vector; 2], size: f64) -> bool {
        let within = WITHIN * (self.size + size);
        let [left, right] = self.beside;
        let (left, right) = (left - within, right + within);
        (self.left.perp(&first) < left)
            & (self.left.perp(&second) < left)
            & (self.right.perp(&first) > right)
            & (self.right.perp(&second) > right)
    }
}
