//! Exact small programs in the plane: the nearest point to a wanted one within half-planes and discs.
//!
//! The nearest point is the wanted one, its foot on an edge, or a corner. Where nothing is permitted, the soft
//! half-planes give way alike by the least `t`; the point at which that is reached is a corner of the program in
//! `(u, t)`. Only those half-planes take part that were found violated, so that many of them cost little.

use numeric::lanes::{Planar, Vector2};

type Vector = Vector2<f64>;

/// By how much rounding may violate a rule at a corner.
const ROUNDING: f64 = 1e-10;
/// A least violation of no more than this is none.
const NONE: f64 = 1e-9;

/// Points with `n.u >= b`, `n` of length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearBound {
    /// Inward normal.
    pub normal: Vector,
    /// Least component along it.
    pub least: f64,
}

impl LinearBound {
    /// The edge of a normal of any length but zero; `None` where that forbids nothing.
    #[must_use]
    pub fn normalized(normal: Vector, least: f64) -> Option<Self> {
        let length = normal.norm();
        (length > 0.0).then(|| Self {
            normal: normal / length,
            least: least / length,
        })
    }

    fn violation(&self, point: Vector) -> f64 {
        self.least - self.normal.dot(&point)
    }

    fn foot(&self, point: Vector) -> Vector {
        point + self.normal * self.violation(point)
    }
}

/// Points within a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its center.
    pub center: Vector,
    /// Its radius.
    pub radius: f64,
}

/// Limits that never give way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hard {
    /// Half-planes.
    pub edges: Vec<LinearBound>,
    /// Discs.
    pub discs: Vec<Disc>,
}

/// Answer of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// The nearest permitted point.
    Nearest(Vector),
    /// Nothing is permitted: the point at which the largest violation is least, and that.
    Least(Vector, f64),
    /// The limits themselves have no point in common.
    Apart,
}

impl Hard {
    fn permits(&self, point: Vector) -> bool {
        self.edges
            .iter()
            .all(|edge| edge.violation(point) <= ROUNDING)
            && self
                .discs
                .iter()
                .all(|disc| (point - disc.center).norm() <= disc.radius + ROUNDING)
    }

    /// Corners of the limits.
    fn corners(&self, keep: &mut Vec<Vector>) {
        for (index, edge) in self.edges.iter().enumerate() {
            self.edges[..index]
                .iter()
                .for_each(|other| keep.extend(meet(edge, other)));
            self.discs.iter().for_each(|disc| on_disc(edge, disc, keep));
        }
        for (index, disc) in self.discs.iter().enumerate() {
            self.discs[..index]
                .iter()
                .for_each(|other| both(disc, other, keep));
        }
    }

    /// Points of a line on the limits.
    fn on_line(&self, line: &LinearBound, keep: &mut Vec<Vector>) {
        self.edges
            .iter()
            .for_each(|edge| keep.extend(meet(edge, line)));
        self.discs.iter().for_each(|disc| on_disc(line, disc, keep));
    }

    /// The nearest points of each limit, and the points of each disc farthest along some normals.
    fn feet(&self, wanted: Vector, soft: &[LinearBound], keep: &mut Vec<Vector>) {
        keep.push(wanted);
        keep.extend(self.edges.iter().map(|edge| edge.foot(wanted)));
        for disc in &self.discs {
            let way = wanted - disc.center;
            let length = way.norm();
            if length > 0.0 {
                keep.push(disc.center + way * (disc.radius / length));
            }
            keep.extend(
                soft.iter()
                    .map(|edge| disc.center + edge.normal * disc.radius),
            );
        }
    }
}

/// Where two lines cross.
fn meet(one: &LinearBound, other: &LinearBound) -> Option<Vector> {
    let sine = one.normal.perp(&other.normal);
    if sine.abs() < 1e-14 {
        return None;
    }
    let (a, b) = (one.normal, other.normal);
    Some(Vector::new(
        (one.least * b.y - other.least * a.y) / sine,
        (other.least * a.x - one.least * b.x) / sine,
    ))
}

/// Where a line crosses a circle.
fn on_disc(line: &LinearBound, disc: &Disc, keep: &mut Vec<Vector>) {
    let foot = line.foot(disc.center);
    let square = disc.radius * disc.radius - (foot - disc.center).norm_squared();
    if square >= 0.0 {
        let along = line.normal.left_normal() * square.sqrt();
        keep.extend([foot + along, foot - along]);
    }
}

/// Where two circles cross.
fn both(one: &Disc, other: &Disc, keep: &mut Vec<Vector>) {
    let way = other.center - one.center;
    let square = way.norm_squared();
    if square == 0.0 {
        return;
    }
    let least = 0.5 * (square + one.radius * one.radius - other.radius * other.radius);
    if let Some(line) = LinearBound::normalized(way, way.dot(&one.center) + least) {
        on_disc(&line, one, keep);
    }
}

/// The first of the points that are nearest to a wanted one.
fn nearest(points: impl Iterator<Item = Vector>, wanted: Vector) -> Option<Vector> {
    points.fold(None, |best: Option<Vector>, point| match best {
        Some(best) if (best - wanted).norm_squared() <= (point - wanted).norm_squared() => {
            Some(best)
        }
        _ => Some(point),
    })
}

/// Solves the program of soft half-planes and limits.
#[must_use]
pub fn solve(soft: &[LinearBound], hard: &Hard, wanted: Vector) -> Answer {
    if hard.permits(wanted) && soft.iter().all(|edge| edge.violation(wanted) <= 0.0) {
        return Answer::Nearest(wanted);
    }
    let mut taken: Vec<LinearBound> = Vec::new();
    loop {
        let Some(point) = within(&taken, hard, wanted) else {
            return if taken.is_empty() {
                Answer::Apart
            } else {
                least_violation(soft, hard, wanted)
            };
        };
        match most_violated(soft, point, ROUNDING, &taken) {
            Some(edge) => taken.push(edge),
            None => return Answer::Nearest(point),
        }
    }
}

/// The half-plane that is violated most, if it is by more than a bound and not yet taken.
fn most_violated(
    soft: &[LinearBound],
    point: Vector,
    bound: f64,
    taken: &[LinearBound],
) -> Option<LinearBound> {
    let mut worst = (bound, None);
    for edge in soft {
        let violation = edge.violation(point);
        if violation > worst.0 && !taken.contains(edge) {
            worst = (violation, Some(*edge));
        }
    }
    worst.1
}

/// The nearest point permitted by some half-planes and the limits.
fn within(soft: &[LinearBound], hard: &Hard, wanted: Vector) -> Option<Vector> {
    let mut points = Vec::new();
    hard.feet(wanted, &[], &mut points);
    hard.corners(&mut points);
    for (index, edge) in soft.iter().enumerate() {
        points.push(edge.foot(wanted));
        hard.on_line(edge, &mut points);
        soft[..index]
            .iter()
            .for_each(|other| points.extend(meet(edge, other)));
    }
    let permitted = |point: &Vector| {
        hard.permits(*point) && soft.iter().all(|edge| edge.violation(*point) <= ROUNDING)
    };
    nearest(points.into_iter().filter(permitted), wanted)
}

/// The point at which the largest violation of the half-planes is least.
fn least_violation(soft: &[LinearBound], hard: &Hard, wanted: Vector) -> Answer {
    let mut taken: Vec<LinearBound> = soft.iter().take(1).copied().collect();
    loop {
        let Some((point, violation)) = least_of(&taken, hard, wanted) else {
            return Answer::Apart;
        };
        match most_violated(soft, point, violation + ROUNDING, &taken) {
            Some(edge) => taken.push(edge),
            None if violation <= NONE => return Answer::Nearest(point),
            None => return Answer::Least(point, violation),
        }
    }
}

/// Least violation of a few half-planes, by all corners of the program in `(u, t)`.
fn least_of(soft: &[LinearBound], hard: &Hard, wanted: Vector) -> Option<(Vector, f64)> {
    let mut points = Vec::new();
    hard.feet(wanted, soft, &mut points);
    points.extend(soft.iter().map(|edge| edge.foot(wanted)));
    hard.corners(&mut points);
    let mut equal: Vec<LinearBound> = Vec::new();
    for (index, one) in soft.iter().enumerate() {
        for other in &soft[..index] {
            equal.extend(LinearBound::normalized(
                one.normal - other.normal,
                one.least - other.least,
            ));
        }
    }
    for (index, line) in equal.iter().enumerate() {
        points.push(line.foot(wanted));
        hard.on_line(line, &mut points);
        equal[..index]
            .iter()
            .for_each(|other| points.extend(meet(line, other)));
    }
    let largest = |point: Vector| {
        let violations = soft.iter().map(|edge| edge.violation(point));
        violations.fold(0.0, f64::max)
    };
    points.retain(|point| hard.permits(*point));
    let least = points
        .iter()
        .map(|point| largest(*point))
        .fold(f64::INFINITY, f64::min);
    let attaining = points
        .iter()
        .copied()
        .filter(|point| largest(*point) <= least + 1e-12);
    nearest(attaining, wanted).map(|point| (point, least))
}
