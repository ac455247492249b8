//! Best compromises between several objectives: a grid, then ever closer neighbours of the
//! points that no other point beats.

use std::collections::HashSet;
use std::sync::Mutex;

use crate::archive::Archive;
use crate::blocks::Session;
use crate::evaluated::Evaluated;
use crate::grid::{GridOptions, RegularGrid};
use crate::observe::Observer;
use crate::problem::{Bounds, Problem};
use crate::search_state::{Fingerprint, SearchState};
use crate::stage::Stage;
use numeric::error::{Failure, Given, Result};
use numeric::threads::on_threads;

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
    let sum = grid.fingerprint(Fingerprint::of_box(problem, bounds));
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
    let mut grid = RegularGrid::new(bounds, &options.shape, problem.slowest_first());
    let mut increments = grid.increments();
    let mut visited = VisitedPoints::of(&mut grid);
    let mut front = Front::default();
    let mut archive = Archive::new(dimension, problem.objectives());
    for round in 0..=options.refinements {
        let stage = Stage::Front { round };
        let fresh = if round == 0 {
            None
        } else {
            for increment in &mut increments {
                *increment *= 0.5;
            }
            let near = neighbours(bounds, &front.points, &increments);
            let Some(fresh) = visited.unvisited(&near, dimension, session) else {
                front.interrupted = true;
                break;
            };
            Some(fresh)
        };
        let count = fresh.as_ref().map_or(grid.len(), |it| it.len() / dimension);
        let rows = |range: std::ops::Range<usize>| match &fresh {
            None => grid.points(range),
            Some(points) => points[range.start * dimension..range.end * dimension].to_vec(),
        };
        let taken = Mutex::new(archive.renewed());
        let take = |first: usize, points: &[f64], part: &Evaluated| {
            let best = Archive::best_of(first, points, part, problem);
            // A thread that panics while it holds the lock ends the whole search.
            if let Ok(mut taken) = taken.lock() {
                taken.merge(best, part);
            }
        };
        let complete = session.evaluate(stage, problem, count, &rows, &take)?;
        archive = taken.into_inner().map_err(|_| Failure::Interrupted)?;
        archive.number_from(count);
        front.evaluations += archive.evaluations;
        front.failures += archive.failures;
        (front.points, front.values) = archive.rows();
        if !complete {
            front.interrupted = true;
            break;
        }
        front.rounds.push(FrontRound {
            increments: increments.clone(),
            evaluations: archive.evaluations,
            failures: archive.failures,
            size: front.points.len() / dimension,
        });
    }
    Ok(front)
}

/// Points that are handled between two looks at whether to stop.
const POINTS_PER_LOOK: usize = 4096;

/// Points that were met: all of the grid, known by the values along its axes, and those after it.
///
/// Millions of grid points are not stored one by one: to fill such a set, to let it grow and to
/// free it takes longer than an answer to a signal may.
struct VisitedPoints {
    axes: Vec<HashSet<u64>>,
    points: HashSet<Vec<u64>>,
}

impl VisitedPoints {
    /// All points of a grid, of which equal ones are taken out first.
    fn of(grid: &mut RegularGrid) -> Self {
        for axis in &mut grid.axes {
            // They rise: equal ones stand side by side.
            axis.dedup_by_key(|value| value.to_bits());
        }
        let bits = |axis: &Vec<f64>| axis.iter().map(|value| value.to_bits()).collect();
        Self {
            axes: grid.axes.iter().map(bits).collect(),
            points: HashSet::new(),
        }
    }

    /// Points that were not met before, each once; none when stopped meanwhile.
    fn unvisited(
        &mut self,
        points: &[f64],
        dimension: usize,
        session: &Session<'_>,
    ) -> Option<Vec<f64>> {
        let mut fresh = Vec::new();
        for part in points.chunks(POINTS_PER_LOOK * dimension) {
            if session.stopped() {
                return None;
            }
            for point in part.chunks_exact(dimension) {
                let bits: Vec<u64> = point.iter().map(|value| value.to_bits()).collect();
                let on_grid = bits
                    .iter()
                    .zip(&self.axes)
                    .all(|(bit, axis)| axis.contains(bit));
                if !on_grid && self.points.insert(bits) {
                    fresh.extend_from_slice(point);
                }
            }
        }
        Some(fresh)
    }
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
