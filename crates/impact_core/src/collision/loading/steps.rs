//! Which variable the next step is over, how far it goes, and whether it is good.

use super::Loading;
use super::plane::Point;
use super::variable::{DEPTH, Variable};

/// Share of the kinetic energy at which the variable changes.
const EARLY: f64 = 0.83;
/// Share of the energy that the first step takes, if the law is a power.
const FIRST: f64 = 0.05;
/// Share of the energy below which the compression is a poor variable, unless a kink is near.
const LATE: f64 = 0.1;
/// Share of the present energy that has to be left at a kink, to first order, to go there.
const LEFT: f64 = 0.2;
/// Errors of steps over the tolerance.
const CAUTION: f64 = 0.4;
/// How much less the estimate of the first step, which has no step before it, is trusted.
const DOUBT: f64 = 10.0;
/// Shares of what is left of a variable: the first step towards the turn, and the longest over the compression.
const FIRST_TO_TURN: f64 = 0.3;
const LONGEST: f64 = 0.33;

/// How far the motion is.
pub(super) struct Progress {
    pub(super) variable: Variable,
    pub(super) point: Point,
    /// Length of the next step; infinite if none is known.
    pub(super) length: f64,
    /// Whether a step has met the kink.
    pub(super) to_kink: bool,
}

/// How far the next step goes.
pub(super) struct Reach {
    pub(super) length: f64,
    /// Whether it ends at the kink, or at the turn.
    pub(super) last: bool,
}

impl Loading<'_> {
    /// The variable for the next step.
    fn variable(&self, point: &Point, to_kink: bool) -> Variable {
        let energy = self.energy(point);
        let near = energy + point.fall * (self.kink - point.depth) > LEFT * energy;
        let early = energy > EARLY && point.depth < 0.95 * self.size;
        if !(to_kink || near || early) {
            self.to_turn
        } else if self.piece[0] == 0.0 {
            Variable::from_touch(self.size, self.exponent)
        } else {
            DEPTH
        }
    }

    pub(super) fn reach(&self, now: &Progress) -> Reach {
        let Progress {
            variable,
            point,
            length,
            to_kink,
        } = *now;
        let new = length.is_infinite();
        let (end, most) = match variable {
            Variable::Pace { .. } if new => (1.0, self.finer * FIRST_TO_TURN * (1.0 - point.at)),
            Variable::Pace { .. } => (1.0, f64::INFINITY),
            Variable::Depth { power, .. } => {
                let [end, whole] = [self.kink, self.size].map(|depth| variable.at(depth, 0.0));
                let first = FIRST.powf(1.0 / ((1.0 + self.exponent) * f64::from(power)));
                let most = match point.at {
                    _ if to_kink => f64::INFINITY,
                    0.0 => self.finer * whole * first,
                    at => LONGEST * (whole - at),
                };
                (end, most)
            }
        };
        let left = end - point.at;
        let length = length.min(most.max(1e-3 * left));
        let last = length >= left * (1.0 - 1e-9);
        Reach {
            length: if last { left } else { length },
            last,
        }
    }

    /// Factor for the length of the next step after one that is good, or for another trial of one that is not.
    pub(super) fn judged(
        &self,
        now: &Progress,
        reach: &Reach,
        state: [f64; 2],
        error: f64,
    ) -> Result<f64, f64> {
        let doubt = if now.point.at == 0.0 { DOUBT } else { 1.0 };
        let excess = doubt * error / (CAUTION * self.collision.tolerance);
        if excess.is_nan() || (self.deepens(now) && state[0].is_nan()) {
            return Err(0.5);
        }
        let factor = (0.85 / eighth_root(excess.max(1e-12))).clamp(0.2, 6.0);
        if excess > 1.0 {
            return Err(factor.min(0.9));
        }
        let least = if reach.last {
            0.0
        } else {
            LATE * self.energy(&now.point)
        };
        if self.deepens(now) && state[0] <= least {
            return Err(0.5);
        }
        Ok(factor)
    }

    pub(super) fn deepens(&self, now: &Progress) -> bool {
        now.variable != self.to_turn
    }

    /// Takes the variable for the next step.
    pub(super) fn choose(&mut self, now: &mut Progress) {
        if self.energy(&now.point) < CAUTION * self.collision.tolerance {
            self.forget_kink();
            now.to_kink = false;
        }
        let wanted = self.variable(&now.point, now.to_kink);
        if wanted != now.variable {
            *now = Progress {
                variable: wanted,
                point: self.over(wanted, &now.point),
                length: f64::INFINITY,
                to_kink: now.to_kink,
            };
        }
    }
}

/// How much shorter first steps are than at a tolerance of 1e-6.
pub fn finer_than_usual(tolerance: f64) -> f64 {
    eighth_root(tolerance / 1e-6).min(1.0)
}

fn eighth_root(value: f64) -> f64 {
    value.sqrt().sqrt().sqrt()
}
