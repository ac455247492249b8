//! Worlds that end because a state is no longer finite.

use numeric::lanes::{Real, Vector2};

/// Where positions and velocities are finite and not so large that their squares are not.
#[inline(always)]
pub(super) fn is_finite<R: Real>(position: Vector2<R>, velocity: Vector2<R>) -> R::Mask {
    let sum = position + velocity;
    sum.dot(&sum).lt(R::splat(f64::INFINITY))
}

/// Whose state is no longer finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diverged {
    /// A person by number.
    Person(usize),
    /// A robot by number.
    Robot(usize),
}

/// The end of a world whose state is no longer finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Divergence {
    /// When, in s.
    pub time: f64,
    /// Who it is.
    pub agent: Diverged,
}
