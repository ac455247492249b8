//! Loading of a covering with rate between free bodies, from the touch to the turn.
//!
//! With `f = F(d) R(eps', d)` and `eps = d + delta(f)` the motion `mu eps'' = -f` is a curve in the plane
//! of `d` and `eps'` whatever the time is,
//!
//! ```text
//! deps'/dd = -f (1 + delta' f_d)/(mu eps' + f delta' f_v),  dt = -mu deps'/f
//! ```
//!
//! and on it `d` rises while `eps'` falls to zero. Each of them is a variable to integrate over: `d` at first,
//! with `(eps'/v)^2`, and up to kinks of the law, so that steps end there without a search; then `eps'`, so that the
//! last one ends at the turn.

mod top;
mod variable;

use std::cell::Cell;

pub use top::Top;
pub use variable::smooth_power;

use super::curve::{EVALUATIONS, step};
use super::statics::rest_of;
use super::{Collision, Region};
use crate::covering::{Pad, Shape};
use top::NO_TOP;
use variable::{DEPTH, Variable, deepened, slowed};

/// Most evaluations of the forces.
const MOST_EVALUATIONS: usize = 20_000;
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
/// Shortest step over its variable.
const SHORTEST: f64 = 1e-13;
/// How far a side of a kink is from it, relatively.
const SIDE: f64 = 4.0 * f64::EPSILON;

/// Where the compression turns, and what peaked before.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// `d`, in m.
    pub compression: f64,
    /// When, in s.
    pub time: f64,
    /// Largest force, in N.
    pub force: Top,
    /// Largest pressure at the apex of a curved contact, in Pa; that of a flat one is not looked for.
    pub pressure: Top,
    /// Evaluations of the forces.
    pub evaluations: usize,
}

/// Forces at a place of the plane.
#[derive(Clone, Copy)]
struct Forces {
    force: f64,
    over_depth: f64,
    over_speed: f64,
    /// `1 + delta' f_d`.
    share: f64,
    /// `mu eps' + f delta' f_v`.
    inertia: f64,
}

/// A place of the plane, seen over a variable.
#[derive(Clone, Copy)]
struct Place {
    depth: f64,
    speed: f64,
    /// Rates of both.
    change: [f64; 2],
    /// Rates of the state.
    rates: [f64; 2],
    forces: Forces,
}

/// Reciprocals of sizes.
#[derive(Clone, Copy)]
struct Scales {
    /// `1/T`.
    per_thickness: f64,
    /// `1/(T e0)`.
    per_unit: f64,
    /// `1/v^2`.
    per_energy: f64,
    /// `1/k` of a linear region.
    yielding: f64,
}

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
struct Point {
    at: f64,
    state: [f64; 2],
    rates: [f64; 2],
    /// `d`.
    depth: f64,
    /// `eps'`.
    speed: f64,
    /// Rate of `(eps'/v)^2` over `d`.
    fall: f64,
    /// Force and apex pressure with their rates over the variable.
    loads: [[f64; 2]; 2],
}

struct Loading<'a> {
    collision: &'a Collision<'a>,
    pad: &'a Pad,
    mass: f64,
    scales: Scales,
    curved: bool,
    kinks: Vec<f64>,
    /// The next one.
    kink: f64,
    /// Compressions at the ends of the piece of the law.
    piece: [f64; 2],
    /// Compression at rest, which is the size of all.
    size: f64,
    /// Power with which the force rises at the touch.
    exponent: f64,
    /// How the end is integrated over.
    to_turn: Variable,
    /// How much shorter first steps are than at a tolerance of 1e-6.
    finer: f64,
    evaluations: Cell<usize>,
}

/// How far the motion is.
struct Progress {
    variable: Variable,
    point: Point,
    /// Length of the next step; infinite if none is known.
    length: f64,
    /// Whether a step has met the kink.
    to_kink: bool,
}

/// How far the next step goes.
struct Reach {
    length: f64,
    /// Whether it ends at the kink, or at the turn.
    last: bool,
}

impl Loading<'_> {
    #[inline]
    fn forces(&self, depth: f64, speed: f64) -> Forces {
        // A kink belongs to the piece that is passed.
        let inside = depth.max(self.piece[0]).min(self.piece[1]);
        let Scales {
            per_thickness,
            per_unit,
            ..
        } = self.scales;
        let [at_rest, slope] = self.pad.force_by(inside, per_thickness);
        let rate = self.pad.covering.rate;
        let inner = 1.0 + speed * per_unit;
        let exponent = rate.base + rate.slope * (inside * per_thickness);
        let logarithm = inner.ln();
        let factor = (exponent * logarithm).exp();
        let force = at_rest * factor;
        let over_depth = factor * (slope + at_rest * rate.slope * logarithm * per_thickness);
        let over_speed = force * exponent * per_unit / inner;
        let inertia = self.mass * speed;
        let yielding = match self.collision.region {
            Region::Rigid => {
                return Forces {
                    force,
                    over_depth,
                    over_speed,
                    share: 1.0,
                    inertia,
                };
            }
            Region::Spring { cubic: 0.0, .. } => self.scales.yielding,
            other => 1.0 / other.force(other.deflection(force))[1],
        };
        Forces {
            force,
            over_depth,
            over_speed,
            share: 1.0 + yielding * over_depth,
            inertia: inertia + force * yielding * over_speed,
        }
    }

    /// Place of the plane, its change over a variable, the forces there and the rates of the state.
    #[inline]
    fn place(&self, variable: Variable, at: f64, state: [f64; 2]) -> Place {
        match variable {
            Variable::Depth { first, power } => {
                let [depth, change] = deepened(first, power, at);
                let speed = self.collision.closing_speed * state[0].sqrt();
                let forces = self.forces(depth, speed);
                let ratio = change * forces.share / forces.inertia;
                let slower = ratio * forces.force;
                let lost = -2.0 * self.scales.per_energy * speed * slower;
                Place {
                    depth,
                    speed,
                    change: [change, -slower],
                    rates: [lost, self.mass * ratio],
                    forces,
                }
            }
            Variable::Pace {
                unit,
                doublings,
                range,
            } => {
                let [speed, change] = slowed([unit, range], doublings, at);
                let forces = self.forces(state[0], speed);
                let ratio = -change / forces.force;
                let deeper = ratio * forces.inertia / forces.share;
                Place {
                    depth: state[0],
                    speed,
                    change: [deeper, change],
                    rates: [deeper, ratio * self.mass],
                    forces,
                }
            }
        }
    }

    fn point(&self, variable: Variable, at: f64, state: [f64; 2]) -> Point {
        let Place {
            depth,
            speed,
            change,
            rates,
            forces,
        } = self.place(variable, at, state);
        let rate = forces.over_depth * change[0] + forces.over_speed * change[1];
        let mut loads = [[forces.force, rate], [0.0; 2]];
        if self.curved {
            loads[1] = self.pressure(depth, speed, change);
        }
        let slower = speed * forces.force * forces.share / forces.inertia;
        Point {
            at,
            state,
            rates,
            depth,
            speed,
            fall: -2.0 * self.scales.per_energy * slower,
            loads,
        }
    }

    /// Pressure at the apex and its rate.
    fn pressure(&self, depth: f64, speed: f64, change: [f64; 2]) -> [f64; 2] {
        let thickness = self.pad.covering.thickness;
        let strain = depth.max(self.piece[0]).min(self.piece[1]) / thickness;
        let [stress, slope] = self.pad.covering.material.stress(strain);
        let [factor, over_speed, over_strain] = self.pad.rate_factor(speed, strain);
        let over_depth = (slope * factor + stress * over_strain) / thickness;
        [
            stress * factor,
            over_depth * change[0] + stress * over_speed * change[1],
        ]
    }

    fn walk(&self, variable: Variable, from: &Point, length: f64) -> ([f64; 2], f64) {
        // The end of a step is evaluated as well.
        self.evaluations
            .set(self.evaluations.get() + EVALUATIONS + 1);
        let time = self.size / self.collision.closing_speed;
        let scales = match variable {
            Variable::Depth { .. } => [1.0, time],
            Variable::Pace { .. } => [from.depth, time],
        };
        let rates = |at: f64, state: [f64; 2]| self.place(variable, at, state).rates;
        step(rates, (from.at, from.state, from.rates), length, scales)
    }

    /// The same place of the plane over a variable.
    fn over(&self, variable: Variable, point: &Point) -> Point {
        let at = variable.at(point.depth, point.speed);
        let first = match variable {
            Variable::Depth { .. } => self.energy(point),
            Variable::Pace { .. } => point.depth,
        };
        self.point(variable, at, [first, point.state[1]])
    }

    /// Share of the kinetic energy that is left.
    fn energy(&self, point: &Point) -> f64 {
        (point.speed / self.collision.closing_speed).powi(2)
    }

    /// Enters the piece of the law beyond a compression.
    fn enter(&mut self, from: f64) {
        let beyond = from * (1.0 + 4.0 * SIDE);
        let next = self.kinks.iter().find(|kink| **kink > beyond);
        self.kink = next.copied().unwrap_or(f64::INFINITY);
        self.piece = [from * (1.0 + SIDE), self.kink * (1.0 - SIDE)];
    }

    /// Leaves out a kink that the motion hardly reaches.
    fn forget_kink(&mut self) {
        self.kink = f64::INFINITY;
        self.piece[1] = f64::INFINITY;
    }

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

    fn reach(&self, now: &Progress) -> Reach {
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
    fn judged(
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

    fn deepens(&self, now: &Progress) -> bool {
        now.variable != self.to_turn
    }

    /// Takes the variable for the next step.
    fn choose(&mut self, now: &mut Progress) {
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

    fn travel(&mut self) -> Option<Turn> {
        let [mut force, mut pressure] = [NO_TOP; 2];
        let variable = Variable::from_touch(self.size, self.exponent);
        let mut now = Progress {
            variable,
            point: self.point(variable, 0.0, [1.0, 0.0]),
            length: f64::INFINITY,
            to_kink: false,
        };
        while self.evaluations.get() < MOST_EVALUATIONS {
            self.choose(&mut now);
            let reach = self.reach(&now);
            let (state, error) = self.walk(now.variable, &now.point, reach.length);
            let growth = match self.judged(&now, &reach, state, error) {
                Ok(growth) => growth,
                Err(factor) => {
                    now.length = reach.length * factor;
                    if now.length <= SHORTEST * (now.point.at + now.length) {
                        return None;
                    }
                    continue;
                }
            };
            if !self.deepens(&now) && state[0] > self.kink {
                // The step is taken once more, over the compression and up to the kink.
                now.to_kink = true;
                continue;
            }
            let next = self.point(now.variable, now.point.at + reach.length, state);
            if next.depth >= self.pad.bound() {
                return None;
            }
            self.offer(now.variable, [&now.point, &next], 0, &mut force);
            if self.curved {
                self.offer(now.variable, [&now.point, &next], 1, &mut pressure);
            }
            now.point = next;
            now.length = reach.length * growth;
            if !reach.last {
                continue;
            }
            if !self.deepens(&now) {
                return Some(Turn {
                    compression: next.depth,
                    time: next.state[1],
                    force,
                    pressure,
                    evaluations: self.evaluations.get(),
                });
            }
            self.pass_kink(&mut now);
        }
        None
    }

    fn pass_kink(&mut self, now: &mut Progress) {
        now.point.depth = self.kink;
        self.enter(self.kink);
        *now = Progress {
            variable: DEPTH,
            point: self.over(DEPTH, &now.point),
            length: f64::INFINITY,
            to_kink: false,
        };
    }
}

fn eighth_root(value: f64) -> f64 {
    value.sqrt().sqrt().sqrt()
}

/// Power with which the force of covering and region rises at the touch.
#[must_use]
pub fn first_exponent(pad: &Pad, region: Region) -> f64 {
    let bend = match region {
        Region::Power { exponent, .. } => exponent.max(1.0),
        Region::Rigid | Region::Spring { .. } => 1.0,
    };
    pad.first_exponent() / bend
}

/// The turn of a collision of free bodies without damper, and the peaks before it; `None` where the steps do not
/// get there.
#[must_use]
pub fn turn_of(collision: &Collision<'_>) -> Option<Turn> {
    let pad = collision.pad?;
    let (mass, speed) = (collision.reduced_mass(), collision.closing_speed);
    let energy = 0.5 * mass * speed * speed;
    let size = rest_of(Some(pad), collision.region, energy).compression;
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let mut loading = Loading {
        collision,
        pad,
        mass,
        scales: Scales {
            per_thickness: 1.0 / pad.covering.thickness,
            per_unit: 1.0 / (pad.covering.thickness * pad.covering.rate.reference),
            per_energy: 1.0 / (speed * speed),
            yielding: match collision.region {
                Region::Spring { stiffness, .. } => 1.0 / stiffness,
                Region::Rigid | Region::Power { .. } => 0.0,
            },
        },
        curved: !matches!(pad.covering.shape, Shape::Flat { .. }),
        kinks: pad.kinks(),
        kink: f64::INFINITY,
        piece: [0.0; 2],
        size,
        exponent: first_exponent(pad, collision.region),
        to_turn: Variable::to_turn(pad, speed),
        finer: eighth_root(collision.tolerance / 1e-6).min(1.0),
        evaluations: Cell::new(0),
    };
    loading.enter(0.0);
    loading.travel()
}
