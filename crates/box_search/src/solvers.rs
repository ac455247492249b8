//! The optimizers of the library `basin` at work on a problem whose values come from elsewhere.
//!
//! They see the box as a unit cube, so that one radius suits every coordinate.

use std::cell::RefCell;

use basin::{
    BoundedCmaEs, BoxBounds, Cobyla, ConstraintDescription, ConstraintSet, ConstraintSolveError,
    Constraints, CostFunction, De, DenseMatrix, Executor, Mads, NoBounds, NoLinearConstraints,
    NoNonlinearBlock, NonlinearBlock, NonlinearBlocks, NonlinearInequalityValues,
    PopulationProgress, SelectedState,
};

use crate::ask_tell::Asker;
use crate::evaluated::Evaluated;
use crate::problem::{Bounds, Candidate, Score};

/// Why a solver gets no more values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Halt {
    /// Its evaluations are used up.
    Budget,
    /// The search was stopped.
    Stopped,
}

/// Problem as a solver sees it, and its best points.
pub(crate) struct Oracle<'a> {
    bounds: &'a Bounds,
    constraints: usize,
    budget: u64,
    inner: RefCell<Inner<'a>>,
}

struct Inner<'a> {
    asker: &'a mut Asker,
    found: Found,
    /// Last point in shares of the sides, and its values: cost and constraints are asked apart.
    last: Option<(Vec<f64>, Evaluated)>,
    /// Replacement of a value or margin that is not finite, for a method with models.
    floor: Option<Evaluated>,
}

/// Best points of a solver.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    pub best: Option<Candidate>,
    pub evaluations: u64,
    pub failures: u64,
    /// Evaluations at which the best feasible point became better, and its value.
    pub history: Vec<(u64, f64)>,
    pub halted: Option<Halt>,
}

impl<'a> Oracle<'a> {
    pub fn new(bounds: &'a Bounds, constraints: usize, budget: u64, asker: &'a mut Asker) -> Self {
        let inner = Inner {
            asker,
            found: Found::default(),
            last: None,
            floor: None,
        };
        Self {
            bounds,
            constraints,
            budget,
            inner: RefCell::new(inner),
        }
    }

    /// Best point so far.
    pub fn best(&self) -> Option<Candidate> {
        self.inner.borrow().found.best.clone()
    }

    /// Whether more values can be had.
    pub fn open(&self) -> bool {
        let found = &self.inner.borrow().found;
        found.halted.is_none() && found.evaluations < self.budget
    }

    pub fn finish(self) -> Found {
        self.inner.into_inner().found
    }

    /// Values at a point in shares of the sides, brought into the box.
    fn values(&self, share: &[f64]) -> Result<Evaluated, Halt> {
        let inner = &mut *self.inner.borrow_mut();
        if let Some((_, values)) = inner.last.as_ref().filter(|(last, _)| last == share) {
            return Ok(values.clone());
        }
        let found = &mut inner.found;
        if found.evaluations >= self.budget {
            found.halted = Some(Halt::Budget);
            return Err(Halt::Budget);
        }
        let point = self.bounds.at(share);
        let Some(values) = inner.asker.ask(point.clone()) else {
            found.halted = Some(Halt::Stopped);
            return Err(Halt::Stopped);
        };
        found.evaluations += 1;
        found.failures += u64::from(values.failed[0]);
        let score = values.score(0);
        let known = found.best.as_ref();
        if known.is_none_or(|best| score.better(&best.score)) {
            found.best = Some(Candidate { point, score });
            if score.feasible() {
                found.history.push((found.evaluations, score.value));
            }
        }
        inner.last = Some((share.to_vec(), values.clone()));
        inner.floor.get_or_insert_with(|| values.clone());
        Ok(values)
    }

    /// A value for a method with models: what is not finite is as much below the first value as
    /// that is large, but at least by one.
    fn modeled(&self, value: f64, first: impl Fn(&Evaluated) -> f64) -> f64 {
        if value.is_finite() {
            return value;
        }
        let inner = self.inner.borrow();
        let first = inner.floor.as_ref().map_or(0.0, first);
        let first = if first.is_finite() { first } else { 0.0 };
        let away = first.abs().max(1.0);
        if value == f64::INFINITY {
            first + away
        } else {
            first - away
        }
    }
}

/// The problem for local methods: the sides of the box and the constraints as inequalities.
///
/// A coordinate that starts in the upper half is counted from above, so that the first steps of a
/// method, which are positive, lead into the box; beyond its sides nothing can be learned.
struct Local<'a, 'b> {
    oracle: &'a Oracle<'b>,
    mirrored: Vec<bool>,
}

impl<'a, 'b> Local<'a, 'b> {
    /// The problem as seen from a start, and the start as the method sees it.
    fn from(oracle: &'a Oracle<'b>, start: &[f64]) -> (Self, Vec<f64>) {
        let mirrored = start.iter().map(|share| *share > 0.5).collect();
        let local = Self { oracle, mirrored };
        let seen = local.turned(start);
        (local, seen)
    }

    /// Shares of the sides from those that the method sees, and the other way round.
    fn turned(&self, share: &[f64]) -> Vec<f64> {
        let turn = |(share, mirrored): (&f64, &bool)| if *mirrored { 1.0 - share } else { *share };
        share.iter().zip(&self.mirrored).map(turn).collect()
    }
}

impl CostFunction for Local<'_, '_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Halt;

    fn cost(&self, share: &Vec<f64>) -> Result<f64, Halt> {
        let values = self.oracle.values(&self.turned(share))?;
        Ok(-self
            .oracle
            .modeled(values.values[0], |first| first.values[0]))
    }
}

type Inequalities =
    ConstraintSet<NoBounds, NoLinearConstraints, NonlinearBlocks<NoNonlinearBlock, NonlinearBlock>>;

impl Constraints for Local<'_, '_> {
    type Set = Inequalities;

    fn constraints(&self) -> <Inequalities as ConstraintDescription>::Borrowed<'_> {
        let count = 2 * self.oracle.bounds.dimension() + self.oracle.constraints;
        ConstraintSet::new().with_nonlinear_inequalities(count)
    }
}

impl NonlinearInequalityValues for Local<'_, '_> {
    type Param = Vec<f64>;
    type Values = Vec<f64>;
    type Error = Halt;

    fn nonlinear_inequalities(
        &self,
        share: &Vec<f64>,
    ) -> Result<Vec<f64>, ConstraintSolveError<Halt>> {
        let values = self.oracle.values(&self.turned(share))?;
        let sides = share.iter().flat_map(|share| [-share, share - 1.0]);
        let margins = values.margins.iter().enumerate();
        let others = margins
            .map(|(index, margin)| -self.oracle.modeled(*margin, |first| first.margins[index]));
        Ok(sides.chain(others).collect())
    }
}

/// COBYLA from a point, with the radii of its trust region in shares of the sides.
pub(crate) fn cobyla(oracle: &Oracle<'_>, start: &[f64], radii: [f64; 2]) -> bool {
    let (problem, start) = Local::from(oracle, start);
    let solver = Cobyla::new()
        .with_initial_radius(radii[0])
        .with_final_radius(radii[1]);
    Executor::new(problem, solver, SelectedState::new(start))
        .run()
        .is_ok()
}

/// `OrthoMADS` with a progressive barrier, with the sizes of its poll in shares of the sides.
pub(crate) fn mads(oracle: &Oracle<'_>, start: &[f64], sizes: [f64; 2]) -> bool {
    let (problem, start) = Local::from(oracle, start);
    let solver = Mads::new()
        .with_initial_poll_size(sizes[0])
        .with_minimum_poll_size(sizes[1])
        .constrained();
    Executor::new(problem, solver, SelectedState::new(start))
        .run()
        .is_ok()
}

/// The problem for populations, which only compare: feasible points by their value, below 1, and
/// infeasible ones by their violation, above.
struct RankedProblem<'a, 'b> {
    oracle: &'a Oracle<'b>,
    sides: [Vec<f64>; 2],
}

impl<'a, 'b> RankedProblem<'a, 'b> {
    fn new(oracle: &'a Oracle<'b>) -> Self {
        let dimension = oracle.bounds.dimension();
        Self {
            oracle,
            sides: [vec![0.0; dimension], vec![1.0; dimension]],
        }
    }
}

fn rank(score: &Score) -> f64 {
    let bounded = |number: f64| {
        if number.is_finite() {
            number / (1.0 + number.abs())
        } else {
            number.signum()
        }
    };
    if score.feasible() {
        -bounded(score.value)
    } else {
        1.0 + bounded(score.violation)
    }
}

impl CostFunction for RankedProblem<'_, '_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Halt;

    fn cost(&self, share: &Vec<f64>) -> Result<f64, Halt> {
        Ok(rank(&self.oracle.values(share)?.score(0)))
    }
}

impl Constraints for RankedProblem<'_, '_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        let [lower, upper] = &self.sides;
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(lower), Some(upper)))
    }
}

/// Differential evolution until the oracle halts.
pub(crate) fn differential_evolution(oracle: &Oracle<'_>, seed: u64) {
    let population = PopulationProgress::<Vec<f64>, f64>::empty();
    // It has no end of its own: the oracle's halt comes back as an error.
    Executor::new(RankedProblem::new(oracle), De::new(seed), population)
        .run()
        .ok();
}

/// CMA-ES until the oracle halts or the distribution collapses.
pub(crate) fn cma_es(oracle: &Oracle<'_>, start: Vec<f64>, seed: u64, spread: f64, collapse: f64) {
    let solver = BoundedCmaEs::<Vec<f64>, DenseMatrix<f64>, f64>::new(seed, spread)
        .with_absolute_distribution_size_tolerance(collapse);
    let population = PopulationProgress::from_point(start);
    Executor::new(RankedProblem::new(oracle), solver, population)
        .run()
        .ok();
}
