//! Least distances between an outline on an arc and points, several points side by side.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Vector2;
use numeric::lanes::{Number, OnEight, Truth, on_eight};
use pulp::{Simd, WithSimd};

use super::{Footprint, Side, Sweep};

/// Points side by side.
const WIDTH: usize = 8;
/// Sine of an angle beyond the end of an arc that counts as on it.
const ROUNDING: f64 = 1e-15;
/// Whoever turns by no more than this in rad drives straight: no place of the outline is farther off than nanometres.
const STRAIGHT: f64 = 1e-9;
/// Factor on the reach of an outline within which an arc may meet it.
const ROUNDED: f64 = 1.0 + 1e-9;

/// Coordinates of points side by side.
type Points<R> = [R; 2];

impl Footprint {
    /// Least distance in m of a point from the outline on an arc, from its start in the body frame; zero if the outline
    /// reaches it.
    #[must_use]
    pub fn swept_point(&self, point: Vector2<f64>, motion: impl Into<Sweep>) -> f64 {
        let motion = PointsMotion::of(motion.into(), self);
        motion.distances(self, motion.corners_away(self), point.into())
    }

    /// Least distances in m of points, each as [`Self::swept_point`].
    #[must_use]
    pub fn swept_points(&self, points: &[[f64; 2]], motion: impl Into<Sweep>) -> Vec<f64> {
        let mut found = vec![0.0; points.len()];
        let motion = PointsMotion::of(motion.into(), self);
        let away: Vec<f64> = motion.corners_away(self).collect();
        let work = Several {
            footprint: self,
            motion,
            away: &away,
            points,
            found: &mut found,
        };
        if let Err(work) = on_eight(true, work) {
            for (found, point) in work.found.iter_mut().zip(points) {
                *found = motion.distances(self, away.iter().copied(), *point);
            }
        }
        found
    }
}

/// Many points against one sweep.
struct Several<'a> {
    footprint: &'a Footprint,
    motion: PointsMotion,
    /// Distances of the corners from the center of the turn in m.
    away: &'a [f64],
    points: &'a [[f64; 2]],
    found: &'a mut [f64],
}

impl OnEight for Several<'_> {
    type Output = ();

    #[inline(always)]
    fn on_eight<S: Simd, R: Number>(self, simd: S, zero: R) {
        simd.vectorize(SideBySide {
            several: self,
            zero,
        });
    }
}

struct SideBySide<'a, R> {
    several: Several<'a>,
    zero: R,
}

impl<R: Number> WithSimd for SideBySide<'_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (several, zero) = (self.several, self.zero);
        let parts = several.points.chunks(WIDTH);
        for (part, found) in parts.zip(several.found.chunks_mut(WIDTH)) {
            let (mut x, mut y) = ([0.0; WIDTH], [0.0; WIDTH]);
            for (lane, point) in part.iter().enumerate() {
                [x[lane], y[lane]] = *point;
            }
            let points = [
                zero.like_each(|lane| x[lane]),
                zero.like_each(|lane| y[lane]),
            ];
            let away = several.away.iter().copied();
            let distances = several.motion.distances(several.footprint, away, points);
            distances.write(found);
        }
    }
}

/// A sweep as it is seen by points: they move back.
#[derive(Clone, Copy)]
enum PointsMotion {
    /// Along a vector in m.
    Straight(Vector2<f64>),
    /// Around a center.
    Turn {
        center: Vector2<f64>,
        /// Way of the outline in m, and cosine and sine of the angle by which points turn.
        way: Vector2<f64>,
        turn: Vector2<f64>,
        /// +1 where points move to the left around the center.
        side: f64,
        /// Size of the angle in rad.
        size: f64,
        /// Distance in m of the farthest corner from the origin of the body.
        reach: f64,
    },
}

impl PointsMotion {
    fn of(sweep: Sweep, footprint: &Footprint) -> Self {
        if sweep.angle.abs() <= STRAIGHT {
            return Self::Straight(-sweep.way);
        }
        let half = 0.5 * sweep.angle;
        let (sin, cos) = half.sin_cos();
        let along = sweep.way * (sin / half);
        Self::Turn {
            center: sweep.center(),
            way: Vector2::new(cos * along.x - sin * along.y, sin * along.x + cos * along.y),
            turn: Vector2::new(cos * cos - sin * sin, -2.0 * sin * cos),
            side: -sweep.angle.signum(),
            size: sweep.angle.abs(),
            reach: footprint
                .corners
                .iter()
                .map(Vector2::norm_squared)
                .fold(0.0, f64::max)
                .sqrt(),
        }
    }

    /// Distances of the corners of an outline from the center of the turn in m.
    fn corners_away(self, footprint: &Footprint) -> impl Iterator<Item = f64> {
        let center = match self {
            Self::Straight(_) => None,
            Self::Turn { center, .. } => Some(center),
        };
        let corners = footprint.corners.iter();
        corners.filter_map(move |corner| center.map(|center| (corner - center).norm()))
    }

    #[inline(always)]
    fn distances<R: Number>(
        &self,
        footprint: &Footprint,
        away: impl Iterator<Item = f64>,
        points: Points<R>,
    ) -> R {
        let (center, way, turn, side, size, reach) = match *self {
            Self::Straight(way) => return straight(footprint, points, way),
            Self::Turn {
                center,
                way,
                turn,
                side,
                size,
                reach,
            } => (center, way, turn, side, size, reach),
        };
        let start = [points[0] - center.x, points[1] - center.y];
        let left = [points[0] - way.x, points[1] - way.y];
        let last = [
            left[0] * turn.x - left[1] * turn.y,
            left[1] * turn.x + left[0] * turn.y,
        ];
        let arc = Around {
            start,
            end: [last[0] - center.x, last[1] - center.y],
            radius: square(start).sqrt(),
            side,
            size,
        };
        let ends = squared(footprint, points)
            .min(squared(footprint, last))
            .sqrt();
        let near = ends.like(ROUNDED * reach * reach * ROUNDED);
        let ends_near = square(points).le(near) | square(last).le(near);
        let least = arc.touching(footprint, away, points, center, ends);
        if !arc.reaches(center, reach, ends_near).any() {
            return least;
        }
        arc.crossing(footprint, points, center, least)
    }
}

/// Arcs of points around a center, seen from it.
struct Around<R> {
    start: Points<R>,
    end: Points<R>,
    radius: R,
    side: f64,
    size: f64,
}

impl<R: Number> Around<R> {
    /// Whether directions, as long as given, lie on the arcs.
    #[inline(always)]
    fn holds(&self, way: Points<R>, length: R) -> R::Mask {
        let zero = self.radius.like(0.0);
        if self.size >= TAU {
            return zero.truth(true);
        }
        let start = [self.start[0] * self.side, self.start[1] * self.side];
        let end = [self.end[0] * self.side, self.end[1] * self.side];
        let after = start[0] * way[1] - start[1] * way[0];
        let before = way[0] * end[1] - way[1] * end[0];
        let least = -(self.radius * length * ROUNDING);
        let (after, before) = (after.ge(least), before.ge(least));
        if self.size > PI {
            return after | before;
        }
        if self.size > FRAC_PI_2 {
            return after & before;
        }
        let ahead = (self.start[0] * way[0] + self.start[1] * way[1]).ge(zero);
        after & before & ahead
    }

    /// Mask of arcs that come as near to the origin of the body as its farthest corner, given that of their ends.
    #[inline(always)]
    fn reaches(&self, center: Vector2<f64>, reach: f64, ends: R::Mask) -> R::Mask {
        let away = center.norm();
        // Radii of slight turns are large, and their difference is rounded.
        let within = self.radius * (4.0 * ROUNDING) + reach * ROUNDED;
        let between = (self.radius - away).abs().le(within);
        let origin = [self.radius.like(-center.x), self.radius.like(-center.y)];
        between & (ends | self.holds(origin, self.radius.like(away)))
    }

    /// Distances at which corners and sides are passed, or those of the ends where these are less.
    ///
    /// Differences of radii are those of their squares by their sum: radii of slight turns are large.
    #[inline(always)]
    fn touching(
        &self,
        footprint: &Footprint,
        away: impl Iterator<Item = f64>,
        points: Points<R>,
        center: Vector2<f64>,
        ends: R,
    ) -> R {
        let (zero, radius, mut least) = (self.radius.like(0.0), self.radius, ends);
        for (corner, away) in footprint.corners.iter().zip(away) {
            let (from, away) = (corner - center, zero.like(away));
            let apart = [points[0] - corner.x, points[1] - corner.y];
            let squares = apart[0] * (self.start[0] + from.x) + apart[1] * (self.start[1] + from.y);
            let nearer = squares.abs() / (radius + away);
            let held = self.holds([zero.like(from.x), zero.like(from.y)], away);
            // Both may be the center.
            least = R::select(held & nearer.lt(least), nearer, least);
        }
        for side in &footprint.sides {
            let (beyond, place) = seen(side, center);
            // The circle comes nearest to the line in the direction against the normal.
            if beyond < 0.0 && (0.0..=side.length).contains(&place) {
                let inward = [zero.like(-side.normal.x), zero.like(-side.normal.y)];
                let away = -self.left(side, points, beyond) / (radius + zero.like(-beyond));
                let nearer = self.holds(inward, zero.like(1.0)) & away.ge(zero) & away.lt(least);
                least = R::select(nearer, away, least);
            }
        }
        least
    }

    /// Zero where arcs cross the outline from outside, what is given elsewhere.
    #[inline(always)]
    fn crossing(
        &self,
        footprint: &Footprint,
        points: Points<R>,
        center: Vector2<f64>,
        mut least: R,
    ) -> R {
        let (zero, radius) = (self.radius.like(0.0), self.radius);
        for side in &footprint.sides {
            let ((beyond, place), (normal, along)) =
                (seen(side, center), (side.normal, side.along));
            let left = self.left(side, points, beyond);
            let half = left.max(zero).sqrt();
            let foot = [zero.like(normal.x * beyond), zero.like(normal.y * beyond)];
            // Whoever is outside at the start and comes in crosses a side inward: at one of its two places.
            let half = half * (-self.side * along.perp(&normal)).signum();
            let at = half + place;
            let crossing = [half * along.x + foot[0], half * along.y + foot[1]];
            let within = zero.le(at) & at.le(zero.like(side.length));
            let meets = left.ge(zero) & within & self.holds(crossing, radius);
            least = R::select(meets, zero, least);
        }
        least
    }

    /// Square of the radius less that of the distance of the line of a side from the center.
    #[inline(always)]
    fn left(&self, side: &Side, points: Points<R>, beyond: f64) -> R {
        let (normal, along) = (side.normal, side.along);
        let across = self.start[0] * along.x + self.start[1] * along.y;
        let outside = self.start[0] * normal.x + self.start[1] * normal.y;
        let apart = (points[0] - side.start.x) * normal.x + (points[1] - side.start.y) * normal.y;
        across * across + apart * (outside + beyond)
    }
}

/// Distance of the line of a side from a center along its normal, and place of its foot along the side, in m.
#[inline(always)]
fn seen(side: &Side, center: Vector2<f64>) -> (f64, f64) {
    let from = side.start - center;
    (side.normal.dot(&from), -side.along.dot(&from))
}

#[inline(always)]
fn square<R: Number>(way: Points<R>) -> R {
    way[0] * way[0] + way[1] * way[1]
}

/// Squares of the distances of points from the outline, zero inside.
#[inline(always)]
fn squared<R: Number>(footprint: &Footprint, points: Points<R>) -> R {
    let zero = points[0].like(0.0);
    if let Some([low, high]) = footprint.upright {
        // Written out: closures would not be compiled for the vectors of their caller.
        let beyond = [
            (zero.like(low.x) - points[0])
                .max(points[0] - high.x)
                .max(zero),
            (zero.like(low.y) - points[1])
                .max(points[1] - high.y)
                .max(zero),
        ];
        return square(beyond);
    }
    let (mut most, mut least) = (zero.like(f64::NEG_INFINITY), zero.like(f64::INFINITY));
    for side in &footprint.sides {
        let way = [points[0] - side.start.x, points[1] - side.start.y];
        most = most.max(way[0] * side.normal.x + way[1] * side.normal.y);
        let share = way[0] * side.along.x + way[1] * side.along.y;
        let share = share.max(zero).min(zero.like(side.length));
        let left = [way[0] - share * side.along.x, way[1] - share * side.along.y];
        least = least.min(left[0] * left[0] + left[1] * left[1]);
    }
    R::select(most.le(zero), zero, least)
}

/// Distances of the outline from points that move along a vector.
#[inline(always)]
fn straight<R: Number>(footprint: &Footprint, points: Points<R>, way: Vector2<f64>) -> R {
    let zero = points[0].like(0.0);
    let last = [points[0] + way.x, points[1] + way.y];
    let mut least = squared(footprint, points)
        .min(squared(footprint, last))
        .sqrt();
    let length = way.norm();
    if length == 0.0 {
        return least;
    }
    let along = way / length;
    for corner in &footprint.corners {
        let from = [
            zero.like(corner.x) - points[0],
            zero.like(corner.y) - points[1],
        ];
        let share = from[0] * along.x + from[1] * along.y;
        let away = (from[0] * along.y - from[1] * along.x).abs();
        let nearer = zero.le(share) & share.le(zero.like(length)) & away.lt(least);
        least = R::select(nearer, away, least);
    }
    // The way is cut by the line of each side; what is left of it lies within the outline.
    let (mut enters, mut leaves, mut meets) = (zero, zero.like(length), zero.truth(true));
    for side in &footprint.sides {
        let (normal, rate) = (side.normal, side.normal.dot(&along));
        let outside = points[0] * normal.x + points[1] * normal.y - side.offset;
        if rate == 0.0 {
            meets = meets & outside.le(zero);
        } else if rate > 0.0 {
            leaves = leaves.min(-outside * (1.0 / rate));
        } else {
            enters = enters.max(-outside * (1.0 / rate));
        }
    }
    R::select(meets & enters.le(leaves), zero, least)
}
