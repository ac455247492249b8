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

mod beside;
mod plane;
mod steps;
mod top;
mod variable;

use std::cell::Cell;

pub use variable::smooth_power;

use super::curve::{CurveStep, EVALUATIONS, Inside, Steps};
use super::statics::rest_of;
use super::{Collision, Region};
use crate::covering::{Kinks, Pad, Powers, Shape};
use crate::roots::Peak;
use beside::{StepRequest, most, take, take_few};
use plane::{Point, Scales};
use steps::{Progress, StepLength, finer_than_usual};
use variable::Variable;

/// Most evaluations of the forces.
const MOST_EVALUATIONS: usize = 20_000;
/// Shortest step over its variable.
const SHORTEST: f64 = 1e-13;
/// Relative distance of a side of a kink from it.
const SIDE: f64 = 4.0 * f64::EPSILON;

/// Turn of the compression, and the peaks up to it.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// `d`, in m.
    pub compression: f64,
    /// Time, in s.
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
    /// The force as a sum of powers, if it is one.
    powers: Option<Powers>,
    /// Whether the force beyond a kink of the law grows like a half power.
    half_powers: bool,
    kinks: Kinks,
    /// Compression at the next kink.
    kink: f64,
    /// Compressions at the ends of the piece of the law.
    piece: [f64; 2],
    /// Compression at rest, which is the size of all.
    size: f64,
    /// Power with which the force rises at the touch.
    exponent: f64,
    /// Variable of integration from the touch on.
    from_touch: Variable,
    /// Variable of integration towards the turn.
    to_turn: Variable,
    /// How much shorter first steps are than at a tolerance of 1e-6.
    finer: f64,
    evaluations: Cell<usize>,
}

impl Loading<'_> {
    /// A step to ask for.
    fn asked(&self, variable: Variable, from: &Point, length: f64) -> StepRequest {
        // The end of a step is evaluated as well.
        self.evaluations
            .set(self.evaluations.get() + EVALUATIONS + 1);
        StepRequest {
            variable,
            at: from.at,
            state: from.state,
            rates: from.rates,
            length,
            scales: self.scales_of(variable, from),
            exponents: self.powers.map(|powers| powers.exponents),
        }
    }

    fn walk(&self, variable: Variable, from: &Point, length: f64) -> CurveStep {
        let mut taken = Steps::none();
        take(&[(self, self.asked(variable, from, length))], &mut taken);
        taken.lane(0)
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
    fn inside(&self, variable: Variable, taken: &CurveStep, [from, to]: [&Point; 2]) -> Inside {
        self.evaluations
            .set(self.evaluations.get() + Inside::EVALUATIONS);
        let rates = |at: f64, state: [f64; 2]| self.place(variable, at, state).rates;
        Inside::of(rates, from.at, taken, to.rates)
    }

    /// Point of the plane over another variable.
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

/// Loading of a collision up to the turn.
struct LoadingPath<'a> {
    loading: Loading<'a>,
    now: Progress,
    tops: [Peak; 2],
    reach: StepLength,
    /// Whether no step is left to take.
    ended: bool,
    turn: Option<Turn>,
}

impl<'a> LoadingPath<'a> {
    /// At the touch.
    fn new(loading: Loading<'a>) -> Self {
        let variable = loading.from_touch;
        Self {
            now: Progress::new(variable, loading.point(variable, 0.0, [1.0, 0.0])),
            tops: [Peak::NONE; 2],
            reach: StepLength::NONE,
            ended: false,
            turn: None,
            loading,
        }
    }

    /// The next step.
    fn ask(&mut self) -> Option<StepRequest> {
        self.ended |= self.loading.evaluations.get() >= MOST_EVALUATIONS;
        if self.ended {
            return None;
        }
        self.loading.choose(&mut self.now);
        self.reach = self.loading.reach(&self.now);
        let Progress {
            variable, point, ..
        } = &self.now;
        Some(self.loading.asked(*variable, point, self.reach.length))
    }

    /// Goes on after a step that was asked for, which ends at a state with an error.
    fn go_on(&mut self, (state, error): ([f64; 2], f64), step: &dyn Fn() -> CurveStep) {
        let (loading, now, reach) = (&mut self.loading, &mut self.now, &self.reach);
        let growth = match loading.judged(now, reach, state, error) {
            Ok(growth) => growth,
            Err(factor) => {
                now.new = false;
                now.length = reach.length * factor;
                self.ended = now.length <= SHORTEST * (now.point.at + now.length);
                return;
            }
        };
        if !loading.deepens(now) && state[0] > loading.kink {
            // The step is taken once more, over the compression and up to the kink.
            now.to_kink = true;
            return;
        }
        let next = loading.point(now.variable, now.point.at + reach.length, state);
        let shorter = now.variable.room(next.at) / now.variable.room(now.point.at);
        if next.depth >= loading.pad.bound() {
            self.ended = true;
            return;
        }
        loading.offer((now.variable, step), [&now.point, &next], &mut self.tops);
        now.point = next;
        now.length = reach.length * growth * shorter;
        now.new = false;
        match reach.last {
            true if loading.deepens(now) => loading.pass_kink(now),
            true => {
                self.turn = Some(loading.turn(&now.point, self.tops));
                self.ended = true;
            }
            false => (),
        }
    }

    /// Takes all its steps.
    fn travel_alone(&mut self) {
        let mut taken = Steps::none();
        while let Some(step) = self.ask() {
            take_few(&[(&self.loading, step)], &mut taken);
            self.go_on(taken.end(0), &|| taken.lane(0));
        }
    }
}

/// Takes steps of all of them until each has ended.
fn travel(ways: &mut [LoadingPath<'_>]) {
    if let [alone] = ways {
        return alone.travel_alone();
    }
    let mut taken = Steps::none();
    loop {
        let asked = ways.iter_mut().enumerate();
        let mut asked: Vec<(usize, StepRequest)> = asked
            .filter_map(|(place, way)| Some((place, way.ask()?)))
            .collect();
        if asked.is_empty() {
            return;
        }
        while let Some((_, first)) = asked.first() {
            let first = *first;
            let (alike, others): (Vec<_>, _) = asked
                .into_iter()
                .partition(|(_, step)| step.is_like(&first));
            for group in alike.chunks(most()) {
                let steps: Vec<_> = group
                    .iter()
                    .map(|(place, step)| (&ways[*place].loading, *step))
                    .collect();
                take(&steps, &mut taken);
                for (lane, (place, _)) in group.iter().enumerate() {
                    ways[*place].go_on(taken.end(lane), &|| taken.lane(lane));
                }
            }
            asked = others;
        }
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

/// Turns of collisions of free bodies without damper, and the peaks before them; `None` where the steps do not get there.
#[must_use]
pub fn turns_of(collisions: &[&Collision<'_>]) -> Vec<Option<Turn>> {
    let mut found = vec![None; collisions.len()];
    let starts = collisions.iter().enumerate();
    let (places, mut ways): (Vec<usize>, Vec<_>) = starts
        .filter_map(|(place, collision)| Some((place, LoadingPath::new(start(collision)?))))
        .unzip();
    travel(&mut ways);
    for (place, way) in places.into_iter().zip(ways) {
        found[place] = way.turn;
    }
    found
}

fn start<'a>(collision: &'a Collision<'a>) -> Option<Loading<'a>> {
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
        powers: pad.powers(),
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
    Some(loading)
}
