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

mod plane;
mod steps;
mod top;
mod variable;

use std::cell::Cell;

pub use variable::smooth_power;

use super::curve::{EVALUATIONS, Inside, Step, step};
use super::statics::rest_of;
use super::{Collision, Region};
use crate::covering::{Pad, Shape};
use crate::roots::Peak;
use plane::{Point, Scales};
use steps::{Progress, finer_than_usual};
use variable::Variable;

/// Most evaluations of the forces.
const MOST_EVALUATIONS: usize = 20_000;
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
    pub force: Peak,
    /// Largest pressure at the apex of a curved contact, in Pa; that of a flat one is not looked for.
    pub pressure: Peak,
    /// Evaluations of the forces.
    pub evaluations: usize,
}

struct Loading<'a> {
    collision: &'a Collision<'a>,
    pad: &'a Pad,
    mass: f64,
    scales: Scales,
    curved: bool,
    /// Whether the force beyond a kink of the law grows like a half power.
    half_powers: bool,
    kinks: Vec<f64>,
    /// The next one.
    kink: f64,
    /// Compressions at the ends of the piece of the law.
    piece: [f64; 2],
    /// Compression at rest, which is the size of all.
    size: f64,
    /// Power with which the force rises at the touch.
    exponent: f64,
    /// How the start is integrated over.
    from_touch: Variable,
    /// How the end is integrated over.
    to_turn: Variable,
    /// How much shorter first steps are than at a tolerance of 1e-6.
    finer: f64,
    evaluations: Cell<usize>,
}

impl Loading<'_> {
    fn walk(&self, variable: Variable, from: &Point, length: f64) -> Step {
        // The end of a step is evaluated as well.
        self.evaluations
            .set(self.evaluations.get() + EVALUATIONS + 1);
        let scales = self.scales_of(variable, from);
        let rates = |at: f64, state: [f64; 2]| self.place(variable, at, state).rates;
        step(rates, (from.at, from.state, from.rates), length, scales)
    }

    /// Sizes of the state, for its errors.
    fn scales_of(&self, variable: Variable, from: &Point) -> [f64; 2] {
        let time = self.size / self.collision.closing_speed;
        match variable {
            Variable::Depth { .. } => [1.0, time],
            Variable::Pace { .. } => [from.depth, time],
        }
    }

    /// States within a step from one point to the next.
    fn inside(&self, variable: Variable, taken: &Step, [from, to]: [&Point; 2]) -> Inside {
        self.evaluations
            .set(self.evaluations.get() + Inside::EVALUATIONS);
        let rates = |at: f64, state: [f64; 2]| self.place(variable, at, state).rates;
        Inside::of(rates, from.at, taken, to.rates)
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

    /// At the touch.
    fn touch(&self) -> Progress {
        let variable = self.from_touch;
        Progress::new(variable, self.point(variable, 0.0, [1.0, 0.0]))
    }

    fn travel(&mut self) -> Option<Turn> {
        let mut tops = [Peak::NONE; 2];
        let mut now = self.touch();
        while self.evaluations.get() < MOST_EVALUATIONS {
            self.choose(&mut now);
            let reach = self.reach(&now);
            let taken = self.walk(now.variable, &now.point, reach.length);
            let state = taken.state;
            let growth = match self.judged(&now, &reach, state, taken.error) {
                Ok(growth) => growth,
                Err(factor) => {
                    now.new = false;
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
            let shorter = now.variable.room(next.at) / now.variable.room(now.point.at);
            if next.depth >= self.pad.bound() {
                return None;
            }
            self.offer((now.variable, &taken), [&now.point, &next], &mut tops);
            now.point = next;
            now.length = reach.length * growth * shorter;
            now.new = false;
            match reach.last {
                true if self.deepens(&now) => self.pass_kink(&mut now),
                true => return Some(self.turn(&now.point, tops)),
                false => (),
            }
        }
        None
    }

    fn turn(&self, point: &Point, [force, pressure]: [Peak; 2]) -> Turn {
        Turn {
            compression: point.depth,
            time: point.state[1],
            force,
            pressure,
            evaluations: self.evaluations.get(),
        }
    }

    fn pass_kink(&mut self, now: &mut Progress) {
        now.point.depth = self.kink;
        self.enter(self.kink);
        if self.half_powers {
            self.to_turn = Variable::to_turn(self.pad, now.point.speed);
        }
        let variable = self.variable(&now.point, false);
        *now = Progress::new(variable, self.over(variable, &now.point));
    }
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
    let exponent = first_exponent(pad, collision.region);
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
        half_powers: matches!(pad.covering.shape, Shape::Cylinder { .. }),
        kinks: pad.kinks(),
        kink: f64::INFINITY,
        piece: [0.0; 2],
        size,
        exponent,
        from_touch: Variable::from_touch(size, exponent),
        to_turn: Variable::to_turn(pad, speed),
        finer: finer_than_usual(collision.tolerance),
        evaluations: Cell::new(0),
    };
    loading.enter(0.0);
    loading.travel()
}
