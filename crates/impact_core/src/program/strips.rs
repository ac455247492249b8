//! Limits of acceleration on one interval of a path, exact between its nodes.
//!
//! With `x = (ds/dt)^2` and a constant `u = x'/2` the acceleration `q' u + q'' (x + 2 u sigma)` on a cubic piece is
//! quadratic in `sigma`: it keeps its limit if its three Bernstein coefficients `p u + r x` do. Each of them holds `u`
//! in a strip over `x`.

use super::path::CubicPiece;

/// `slope x - room <= u <= slope x + room`.
#[derive(Clone, Copy, Debug)]
struct Strip {
    slope: f64,
    room: f64,
}

/// Strips of all joints with a limit.
#[derive(Clone, Debug, Default)]
pub struct Strips {
    all: Vec<Strip>,
    /// Largest `x` by coefficients without `u`.
    most: f64,
    length: f64,
}

/// A bound of `u` over `x`.
#[derive(Clone, Copy)]
struct StripBound {
    slope: f64,
    offset: f64,
}

impl StripBound {
    fn at(self, x: f64) -> f64 {
        self.slope * x + self.offset
    }
}

/// Factors `p` of `u` and `r` of `x` in the Bernstein coefficients of the acceleration of a joint.
#[must_use]
pub fn coefficients(piece: &CubicPiece<'_>, joint: usize) -> [[f64; 2]; 3] {
    let ([_, q1, q2, q3], h) = (piece.powers(joint), piece.length);
    let (start, end) = (2.0 * q2, 2.0 * q2 + 6.0 * h * q3);
    let rate = q1 + h * (2.0 * q2 + 3.0 * h * q3);
    [
        [q1, start],
        [q1 + 1.5 * h * start, start + 3.0 * h * q3],
        [rate + 2.0 * h * end, end],
    ]
}

impl Strips {
    /// Takes the strips of another interval; `reversed` ones are those of the motion from its end to its start.
    pub fn read(&mut self, piece: &CubicPiece<'_>, acceleration: &[f64], reversed: bool) {
        self.all.clear();
        self.most = f64::INFINITY;
        self.length = piece.length;
        for (joint, limit) in acceleration.iter().enumerate() {
            if *limit == f64::INFINITY {
                continue;
            }
            for [p, r] in coefficients(piece, joint) {
                let p = if reversed {
                    2.0 * self.length * r - p
                } else {
                    p
                };
                let (slope, room) = (-r / p, limit / p.abs());
                if slope.is_finite() && room.is_finite() {
                    self.all.push(Strip { slope, room });
                } else if r != 0.0 {
                    self.most = self.most.min(limit / r.abs());
                }
            }
        }
    }

    /// Least upper bound at `x`, where `x` at the end of the interval is `next` at most.
    fn upper(&self, x: f64, next: f64) -> StripBound {
        let step = 0.5 / self.length;
        let end = StripBound {
            slope: -step,
            offset: next * step,
        };
        let bounds = self.all.iter().map(|strip| StripBound {
            slope: strip.slope,
            offset: strip.room,
        });
        bounds.fold(end, |least, other| {
            if other.at(x) < least.at(x) {
                other
            } else {
                least
            }
        })
    }

    /// Largest lower bound at `x`, where `x` at the end of the interval is not below 0.
    fn lower(&self, x: f64) -> StripBound {
        let end = StripBound {
            slope: -0.5 / self.length,
            offset: 0.0,
        };
        let bounds = self.all.iter().map(|strip| StripBound {
            slope: strip.slope,
            offset: -strip.room,
        });
        bounds.fold(end, |most, other| {
            if other.at(x) > most.at(x) {
                other
            } else {
                most
            }
        })
    }

    /// Largest `x` at the start, up to `top`, from which `next` at the end is not exceeded.
    ///
    /// The gap between the bounds is concave in `x` and not below zero at 0: a step of Newton from a place without a
    /// gap never passes below its root. It goes to where the two bounds meet, without a difference of large numbers.
    #[must_use]
    pub fn largest(&self, top: f64, next: f64) -> f64 {
        let mut x = top.min(self.most);
        while x > 0.0 {
            let (upper, lower) = (self.upper(x, next), self.lower(x));
            if upper.at(x) >= lower.at(x) {
                break;
            }
            let meet = (upper.offset - lower.offset) / (lower.slope - upper.slope);
            // Not where rounding leaves nothing to gain.
            if meet.is_nan() || meet >= x {
                break;
            }
            x = meet.max(0.0);
        }
        x
    }

    /// Largest `x` at the end, up to `next`, from an admissible `x` at the start.
    #[must_use]
    pub fn onward(&self, x: f64, next: f64) -> f64 {
        let reached = x + 2.0 * self.length * self.upper(x, next).at(x);
        reached.clamp(0.0, next)
    }
}
