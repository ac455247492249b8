//! Meetings with people who keep their velocities, and who cannot be met.

use numeric::lanes::{Real, Vector2};

/// Somebody who is given way to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passerby {
    /// Position relative to the robot when the command takes effect, in m.
    pub offset: Vector2<f64>,
    /// Velocity in m/s.
    pub velocity: Vector2<f64>,
    /// Distance of the centers at contact, in m.
    pub touch: f64,
}

impl Passerby {
    /// Takes the place of who is not there.
    pub(super) const NOBODY: Self = Self {
        offset: Vector2::new(0.0, 0.0),
        velocity: Vector2::new(0.0, 0.0),
        touch: 0.0,
    };

    /// Least distance in m, over the time up to a horizon in s, between the surface and the ground that
    /// a robot of some speed in m/s can have reached; a bound from below.
    pub(super) fn gap_to(&self, speed: f64, horizon: f64) -> f64 {
        // |o + w t| - v t falls at most as fast as |w| + v, and is convex: least at an end or where
        // the slope is zero.
        let at = |time: f64| (self.offset + self.velocity * time).norm() - speed * time;
        let own = self.velocity.norm_squared();
        let least = if own > speed * speed {
            let closest = -self.offset.dot(&self.velocity) / own;
            let across = self.offset.perp(&self.velocity).abs() / own.sqrt();
            // sqrt(a^2 + w^2 s^2) - v (s + c) is least where w^2 s = v sqrt(a^2 + w^2 s^2).
            let later = speed * across / (own * (own - speed * speed)).sqrt();
            at((closest + later).clamp(0.0, horizon))
        } else {
            f64::INFINITY
        };
        least.min(at(0.0)).min(at(horizon)) - self.touch
    }

    /// A bound from below of the distance in m, for some time in s, between the surface and a robot of
    /// some speed in m/s on any course.
    pub(super) fn gap_within(&self, speed: f64, time: f64) -> f64 {
        self.offset.norm() - self.touch - (self.velocity.norm() + speed) * time
    }
}

/// People who have a part in prices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crowd<'a> {
    /// First those who can be met while a velocity is taken up.
    pub people: &'a [Passerby],
    /// How many these are.
    pub early: usize,
    /// Whether somebody who cannot be met has been left out.
    pub left_out: bool,
}

/// Least clearance of several people, from the squares of their distances.
///
/// One root for all who touch at the same distance: roots and differences are rounded alike for all of
/// them and do not change their order.
pub(super) struct NearestConflict<R> {
    clearance: R,
    square: R,
    touch: Option<f64>,
}

impl<R: Real> NearestConflict<R> {
    /// Of nobody.
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            clearance: R::splat(f64::INFINITY),
            square: R::splat(f64::INFINITY),
            touch: None,
        }
    }

    /// Adds somebody by the square of a distance.
    #[inline(always)]
    pub(super) fn add(&mut self, square: R, touch: f64) {
        if self.touch != Some(touch) {
            self.clearance = self.clearance();
            self.square = R::splat(f64::INFINITY);
            self.touch = Some(touch);
        }
        self.square = self.square.min(square);
    }

    /// The least clearance in m.
    #[inline(always)]
    pub(super) fn clearance(&self) -> R {
        match self.touch {
            Some(touch) => self.clearance.min(self.square.sqrt() - R::splat(touch)),
            None => self.clearance,
        }
    }
}

/// First meeting and least clearance of velocities side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conflict<R> {
    /// When surfaces come nearer than `y`, in s; the horizon if never.
    pub time: R,
    /// Least clearance within the horizon in m.
    pub clearance: R,
}

impl<R: Real> Conflict<R> {
    /// Nobody is met within a horizon in s.
    pub(super) fn never(horizon: f64) -> Self {
        Self {
            time: R::splat(horizon),
            clearance: R::splat(f64::INFINITY),
        }
    }
}

/// A stretch of constant relative velocity.
pub(super) struct Stretch<R> {
    pub from: Vector2<R>,
    pub velocity: Vector2<R>,
    pub duration: R,
}

impl<R: Real> Stretch<R> {
    /// Time to come within a distance while closing, or to touch, the duration if neither; and the
    /// least square of the distance.
    #[inline(always)]
    pub(super) fn meet(&self, near: f64, touch: f64) -> (R, R) {
        let zero = R::zero();
        let square = self.from.dot(&self.from);
        let closing = self.from.dot(&self.velocity);
        let rate = self.velocity.dot(&self.velocity);
        let outside = square - R::splat(near * near);
        let root = (closing * closing - rate * outside).max(zero).sqrt();
        // The nearer root as a quotient, exact where the two are close.
        let entry = outside / (root - closing);
        let meets = closing.lt(zero) & (rate * outside).le(closing * closing);
        let inside = outside.le(zero) & closing.lt(zero);
        let inside = inside | square.lt(R::splat(touch * touch));
        let entry = R::select(meets, entry.min(self.duration), self.duration);
        let time = R::select(inside, zero, entry);
        let nearest = R::select(closing.lt(zero), -closing / rate, zero).min(self.duration);
        let least = square + (closing * R::splat(2.0) + rate * nearest) * nearest;
        (time, least.max(zero))
    }
}
