//! Best compromises between several objectives: a grid, then ever closer neighbours of the
//! points that no other point beats.

use std::collections::HashSet;

use crate::error::{Failure, Given, Result};
use crate::optimize::blocks::{Parts, Session};
use crate::optimize::grid::{Grid, GridOptions};
use crate::optimize::ledger::SearchState;
use crate::optimize::observe::{Observer, Stage};
use crate::optimize::pareto::non_dominated;
use crate::optimize::problem::{Bounds, Problem};
use crate::optimize::search::fingerprint;
use groundwork::threads::on_threads;

/// Options of a search for the best compromises.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontOptions {
    /// Number of points along each axis of the first grid.
    pub shape: Vec<usize>,
    /// Rounds after it, each with half the distance of neighbours.
    pub refinements: usize,
    /// Number of threads; all cores when `None`.
    pub threads: Option<usize>,
}

/// A round of a search for the best compromises.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontRound {
    /// Distance of neighbours along each axis.
    pub increments: Vec<f64>,
    /// Points evaluated.
    pub evaluations: u64,
    /// Failures among them.
    pub failures: u64,
    /// Points that no other point beats, after this round.
    pub size: usize,
}

/// Best compromises.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Front {
    /// Points, row by row, the best in the first objective first.
    pub points: Vec<f64>,
    /// Their objectives, row by row, all maximized.
    pub values: Vec<f64>,
    /// Evaluations in all.
    pub evaluations: u64,
    /// Failures among them.
    pub failures: u64,
    /// Rounds that are complete.
    pub rounds: Vec<FrontRound>,
    /// Whether the search was stopped before its end.
    pub interrupted: bool,
}

/// Searches a box for the feasible points that no other point beats in every objective.
///
/// # Errors
/// An option is out of range, the state belongs to another search, or the problem fails.
pub fn front_search(
    problem: &dyn Problem,
    bounds: &Bounds,
    options: &FrontOptions,
    observer: &dyn Observer,
    resume: Option<&SearchState>,
) -> Result<Front> {
    bounds.check(problem)?;
    if problem.objectives() < 2 {
        let rule = "be at least two for a set of compromises";
        let given = Given::Count(problem.objectives() as u64);
        return Err(Failure::invalid("objectives", rule, given));
    }
    let grid = GridOptions {
        shape: options.shape.clone(),
        refinements: options.refinements,
        survivors: 1,
        keep: 1,
    };
    grid.check(bounds)?;
    let sum = grid.fingerprint(fingerprint(problem, bounds));
    let session = Session::new(observer, SearchState::resumed(resume, sum.value())?);
    on_threads(options.threads, || {
        rounds(&session, problem, bounds, options)
    })
}

fn rounds(
    session: &Session<'_>,
    problem: &dyn Problem,
    bounds: &Bounds,
    options: &FrontOptions,
) -> Result<Front> {
    let dimension = problem.dimension();
    let grid = Grid::new(bounds, &options.shape, problem.slowest_first());
    let mut increments = grid.increments();
    let mut points = grid.points(0..grid.len());
    let mut seen = HashSet::new();
    let mut front = Front::default();
    for round in 0..=options.refinements {
        if round > 0 {
            for increment in &mut increments {
                *increment *= 0.5;
            }
            points = neighbours(bounds, &front.points, &increments);
        }
        points = unseen(&mut seen, &points, dimension);
        let stage = Stage::Front { round };
        let rows = |range: std::ops::Range<usize>| {
            points[range.start * dimension..range.end * dimension].to_vec()
        };
        let parts = session.evaluate(stage, problem, points.len() / dimension, &rows)?;
        let (evaluations, failures) = take(&mut front, problem, &points, &parts);
        if !parts.complete() {
            front.interrupted = true;
            break;
        }
        front.rounds.push(FrontRound {
            increments: increments.clone(),
            evaluations,
            failures,
            size: front.points.len() / dimension,
        });
    }
    Ok(front)
}

/// Points that were not met before, each once.
fn unseen(seen: &mut HashSet<Vec<u64>>, points: &[f64], dimension: usize) -> Vec<f64> {
    let bits = |point: &[f64]| point.iter().map(|value| value.to_bits()).collect();
    let fresh = points
        .chunks_exact(dimension)
        .filter(|point| seen.insert(bits(point)));
    fresh.flatten().copied().collect()
}

/// Points one increment away along each axis, inside the box.
fn neighbours(bounds: &Bounds, points: &[f64], increments: &[f64]) -> Vec<f64> {
    let dimension = increments.len();
    let mut all = Vec::with_capacity(points.len() * 2 * dimension);
    for point in points.chunks_exact(dimension) {
        for axis in 0..dimension {
            for way in [-increments[axis], increments[axis]] {
                let moved = point[axis] + way;
                let inside = bounds.lower()[axis] <= moved && moved <= bounds.upper()[axis];
                if inside && way != 0.0 {
                    all.extend_from_slice(point);
                    let last = all.len() - dimension + axis;
                    all[last] = moved;
                }
            }
        }
    }
    all
}

/// Takes evaluated points into the front; gives their number and the failures among them.
fn take(front: &mut Front, problem: &dyn Problem, points: &[f64], parts: &Parts) -> (u64, u64) {
    let (dimension, objectives) = (problem.dimension(), problem.objectives());
    let (mut evaluations, mut failures) = (0, 0);
    for (first, part) in parts.blocks() {
        evaluations += part.len() as u64;
        for index in 0..part.len() {
            failures += u64::from(part.failed[index]);
            if part.score(index).feasible() {
                let point = (first + index) * dimension;
                front
                    .points
                    .extend_from_slice(&points[point..point + dimension]);
                let values = index * objectives;
                front
                    .values
                    .extend_from_slice(&part.values[values..values + objectives]);
            }
        }
    }
    front.evaluations += evaluations;
    front.failures += failures;
    let mut kept = non_dominated(&front.values, objectives);
    kept.sort_by(|one, other| {
        let first = |index: &usize| front.values[index * objectives] + 0.0;
        first(other).total_cmp(&first(one)).then(one.cmp(other))
    });
    let rows = |all: &[f64], width: usize| -> Vec<f64> {
        let of = |index: &usize| all[index * width..(index + 1) * width].iter().copied();
        kept.iter().flat_map(of).collect()
    };
    front.points = rows(&front.points, dimension);
    front.values = rows(&front.values, objectives);
    (evaluations, failures)
}
