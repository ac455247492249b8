//! Choice of the variable and the length of the next step, and the test of its error.

use super::Loading;
use super::plane::Point;
use super::variable::{DEPTH, Variable};

/// Share of the kinetic energy at which the variable changes.
const EARLY: f64 = 0.83;
/// Share of the energy that the first step takes, if the law is a power.
const FIRST: f64 = 0.03;
/// Share of the energy below which the compression is a poor variable, unless a kink is near.
const LATE: f64 = 0.1;
/// Share of the present energy that has to be left at a kink, to first order, to go there.
const LEFT: f64 = 0.2;
/// Share of the energy, over the tolerance, with which no kink is looked for: on a plateau little carries far.
const UNFELT: f64 = 0.01;
/// Errors of steps over the tolerance.
const CAUTION: f64 = 0.7;
/// How much less the estimate of the first step, which has no step before it, is trusted.
const DOUBT: f64 = 10.0;
/// How much of the length of a step over one variable is trusted over the next one.
const MOVED: f64 = 0.8;
/// How much longer a step may be that ends at the kink or at the turn, so that no short one follows.
const STRETCH: f64 = 1.1;
/// Shares of what is left of a variable: the first step towards the turn, and the longest over the compression.
const FIRST_TO_TURN: f64 = 0.3;
const LONGEST: f64 = 0.36;

/// Progress of the motion.
pub(super) struct Progress {
    pub(super) variable: Variable,
    pub(super) point: Point,
    /// Length of the next step; infinite if none is known.
    pub(super) length: f64,
    /// Whether no step over the variable was tried yet.
    pub(super) new: bool,
    /// Whether a step has met the kink.
    pub(super) to_kink: bool,
}

impl Progress {
    /// At a point from which no step was tried yet.
    pub(super) fn new(variable: Variable, point: Point) -> Self {
        Self {
            variable,
            point,
            length: f64::INFINITY,
            new: true,
            to_kink: false,
        }
    }
}

/// Length of the next step.
pub(super) struct StepLength {
    pub(super) length: f64,
    /// Whether the step ends at the kink, or at the turn.
    pub(super) last: bool,
}

impl StepLength {
    /// None yet.
    pub(super) const NONE: Self = Self {
        length: 0.0,
        last: false,
    };
}

impl Loading<'_> {
    /// The variable for the next step.
    pub(super) fn variable(&self, point: &Point, to_kink: bool) -> Variable {
        let energy = self.energy(point);
        let near = energy + point.fall * (self.kink - point.depth) > LEFT * energy;
        let early = energy > EARLY && point.depth < 0.95 * self.size;
        if !(to_kink || near || early) {
            self.to_turn
        } else if self.piece[0] == 0.0 {
            self.from_touch
        } else if self.half_powers {
            Variable::from_half_power(self.piece[0], self.size)
        } else {
            DEPTH
        }
    }

    pub(super) fn reach(&self, now: &Progress) -> StepLength {
        let Progress {
            variable,
            point,
            length,
            new,
            to_kink,
            ..
        } = *now;
        let (end, most) = match variable {
            Variable::Pace { .. } if new => (1.0, self.finer * FIRST_TO_TURN * (1.0 - point.at)),
            Variable::Pace { .. } => (1.0, f64::INFINITY),
            Variable::Depth { power, .. } => {
                let [end, whole] = [self.kink, self.size].map(|depth| variable.at(depth, 0.0));
                let first = || FIRST.powf(1.0 / ((1.0 + self.exponent) * f64::from(power)));
                let most = match point.at {
                    _ if to_kink => f64::INFINITY,
                    0.0 => self.finer * whole * first(),
                    at => LONGEST * (whole - at),
                };
                (end, most)
            }
        };
        let left = end - point.at;
        let length = length.min(most.max(1e-3 * left));
        let last = STRETCH * length >= left;
        StepLength {
            length: if last { left } else { length },
            last,
        }
    }

    /// Factor for the length of the next step after one that is good, or for another trial of one that is not.
    pub(super) fn judged(
        &self,
        now: &Progress,
        reach: &StepLength,
        state: [f64; 2],
        error: f64,
    ) -> Result<f64, f64> {
        let doubt = if now.point.at == 0.0 { DOUBT } else { 1.0 };
        // An error of the energy moves the turn the farther the less of it is left; NaN if there is none.
        let left = if self.deepens(now) {
            state[0].sqrt()
        } else {
            1.0
        };
        let excess = doubt * error / (left * CAUTION * self.collision.tolerance);
        if excess.is_nan() {
            return Err(0.5);
        }
        if excess > 1.0 {
            return Err(longer(excess).min(0.9));
        }
        let least = if reach.last {
            0.0
        } else {
            LATE * self.energy(&now.point)
        };
        if self.deepens(now) && state[0] <= least {
            return Err(0.5);
        }
        Ok(longer(excess))
    }

    pub(super) fn deepens(&self, now: &Progress) -> bool {
        now.variable != self.to_turn
    }

    /// Takes the variable for the next step.
    pub(super) fn choose(&mut self, now: &mut Progress) {
        if self.energy(&now.point) < UNFELT * self.collision.tolerance {
            self.forget_kink();
            now.to_kink = false;
        }
        let wanted = self.variable(&now.point, now.to_kink);
        if wanted != now.variable {
            let point = self.over(wanted, &now.point);
            let change = now.variable.deepening(&now.point) / wanted.deepening(&point);
            *now = Progress {
                length: MOVED * change * now.length,
                to_kink: now.to_kink,
                ..Progress::new(wanted, point)
            };
        }
    }
}

/// How much shorter first steps are than at a tolerance of 1e-6.
pub fn finer_than_usual(tolerance: f64) -> f64 {
    eighth_root(tolerance / 1e-6).min(1.0)
}

/// Factor for the length of a step from its error over what is allowed.
fn longer(excess: f64) -> f64 {
    (0.85 / eighth_root(excess.max(1e-12))).clamp(0.2, 6.0)
}

fn eighth_root(value: f64) -> f64 {
    value.sqrt().sqrt().sqrt()
}
