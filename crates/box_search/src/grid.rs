//! Coarse-to-fine grid: the best points of one grid span the next, Zeng (2011), C.2, steps 1-6.

use std::cmp::Ordering;
use std::sync::Mutex;

use crate::blocks::Session;
use crate::evaluated::Evaluated;
use crate::problem::{Bounds, Candidate, Problem, Score};
use crate::search_state::Fingerprint;
use crate::stage::Stage;
use numeric::error::{Failure, Given, Result};

/// Options of a coarse-to-fine grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridOptions {
    /// Number of points along each axis, in every round.
    pub shape: Vec<usize>,
    /// Number of rounds after the first one.
    pub refinements: usize,
    /// Number of best points that span the next round.
    pub survivors: usize,
    /// Number of best points that are kept over all rounds.
    pub keep: usize,
}

/// A round of a coarse-to-fine grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Round {
    /// Coordinates of the grid along each axis.
    pub axes: Vec<Vec<f64>>,
    /// Distance of neighbours along each axis.
    pub increments: Vec<f64>,
    /// Points evaluated.
    pub evaluations: u64,
    /// Failures among them.
    pub failures: u64,
    /// Best point.
    pub best: Candidate,
    /// Least coordinates of the survivors.
    pub survivor_low: Vec<f64>,
    /// Largest coordinates of the survivors.
    pub survivor_high: Vec<f64>,
    /// Score of the last survivor.
    pub worst_survivor: Score,
}

/// Result of the grids.
pub(crate) struct Grids {
    pub rounds: Vec<Round>,
    /// Best points over all rounds.
    pub top: Vec<Candidate>,
    pub evaluations: u64,
    pub failures: u64,
    /// Whether the last round is complete.
    pub complete: bool,
}

impl GridOptions {
    pub(crate) fn check(&self, bounds: &Bounds) -> Result<()> {
        let refuse = |name: &str, rule, count: usize| {
            Err(Failure::invalid(name, rule, Given::Count(count as u64)))
        };
        if self.shape.len() != bounds.dimension() {
            let rule = "have a number of points for every axis";
            return refuse("grid", rule, self.shape.len());
        }
        if self.shape.contains(&0) {
            return refuse("grid", "have at least one point along every axis", 0);
        }
        let points = self.shape.iter().try_fold(1, |points: usize, side| {
            points
                .checked_mul(*side)
                .filter(|points| *points <= MOST_POINTS)
        });
        if points.is_none() {
            return refuse("grid", "have at most 1e8 points", usize::MAX);
        }
        if self.survivors == 0 {
            return refuse("survivors", "be at least one", 0);
        }
        if self.keep == 0 {
            return refuse("keep", "be at least one", 0);
        }
        Ok(())
    }

    pub(crate) fn fingerprint(&self, sum: Fingerprint) -> Fingerprint {
        let shape = self.shape.iter().fold(sum, |sum, side| sum.count(*side));
        shape.count(self.survivors)
    }
}

/// Most points of one grid: their values must fit into memory.
const MOST_POINTS: usize = 100_000_000;

/// A regular grid of a box. Points are numbered with the first axis slowest.
pub(crate) struct RegularGrid {
    pub axes: Vec<Vec<f64>>,
    /// Axes from slowest to fastest in which the points are visited.
    visit: Vec<usize>,
}

impl RegularGrid {
    pub fn new(bounds: &Bounds, shape: &[usize], visit: Vec<usize>) -> Self {
        let sides = bounds.lower().iter().zip(bounds.upper()).zip(shape);
        let axes = sides.map(|((low, high), count)| spaced(*low, *high, *count));
        Self {
            axes: axes.collect(),
            visit,
        }
    }

    pub fn len(&self) -> usize {
        self.axes.iter().map(Vec::len).product()
    }

    pub fn increments(&self) -> Vec<f64> {
        let step = |axis: &Vec<f64>| match axis.as_slice() {
            [first, .., last] => (last - first) / (axis.len() - 1) as f64,
            _ => 0.0,
        };
        self.axes.iter().map(step).collect()
    }

    /// The point at a position of the visit, and its number.
    fn visited(&self, position: usize, point: &mut [f64]) -> usize {
        let mut rest = position;
        let mut places = vec![0; self.axes.len()];
        for axis in self.visit.iter().rev() {
            let count = self.axes[*axis].len();
            places[*axis] = rest % count;
            rest /= count;
        }
        let number =
            |number: usize, (axis, place): (&Vec<f64>, &usize)| number * axis.len() + place;
        for ((slot, axis), place) in point.iter_mut().zip(&self.axes).zip(&places) {
            *slot = axis[*place];
        }
        self.axes.iter().zip(&places).fold(0, number)
    }

    /// Points at some positions of the visit, row by row.
    pub fn points(&self, positions: std::ops::Range<usize>) -> Vec<f64> {
        let dimension = self.axes.len();
        let mut points = vec![0.0; positions.len() * dimension];
        for (position, point) in positions.zip(points.chunks_exact_mut(dimension)) {
            self.visited(position, point);
        }
        points
    }

    /// The point with a number.
    pub fn point(&self, number: usize) -> Vec<f64> {
        let mut rest = number;
        let mut point: Vec<f64> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            point.push(axis[rest % axis.len()]);
            rest /= axis.len();
        }
        point.reverse();
        point
    }

    /// Number of the point at a position of the visit.
    fn number(&self, position: usize) -> usize {
        self.visited(position, &mut vec![0.0; self.axes.len()])
    }
}

/// Evenly spaced numbers with both ends; the middle alone, also where both ends are one.
fn spaced(low: f64, high: f64, count: usize) -> Vec<f64> {
    if count == 1 || low == high {
        return vec![0.5 * (low + high)];
    }
    let step = (high - low) / (count - 1) as f64;
    let at = |index: usize| {
        if index + 1 == count {
            high
        } else {
            low + index as f64 * step
        }
    };
    (0..count).map(at).collect()
}

/// Rounds of grids over ever smaller boxes.
pub(crate) fn grids(
    session: &Session<'_>,
    problem: &dyn Problem,
    bounds: &Bounds,
    options: &GridOptions,
) -> Result<Grids> {
    let mut result = Grids {
        rounds: Vec::new(),
        top: Vec::new(),
        evaluations: 0,
        failures: 0,
        complete: true,
    };
    let mut range = bounds.clone();
    for round in 0..=options.refinements {
        let grid = RegularGrid::new(&range, &options.shape, problem.slowest_first());
        let stage = Stage::Grid { round };
        let points = |positions| grid.points(positions);
        let ranking = GridRanking::new(options.survivors.max(options.keep));
        let take = |first: usize, _: &[f64], part: &Evaluated| ranking.take(&grid, first, part);
        result.complete = session.evaluate(stage, problem, grid.len(), &points, &take)?;
        let ranked = ranking.finish();
        result.evaluations += ranked.evaluations;
        result.failures += ranked.failures;
        merge(&mut result.top, &grid, &ranked.best, options.keep);
        if !result.complete {
            break;
        }
        let summary = summary(&grid, &ranked, options.survivors);
        range = next_range(bounds, &summary)?;
        result.rounds.push(summary);
    }
    Ok(result)
}

/// The best points of a round and how many there were, gathered while they are evaluated: nothing
/// is left to do after a stop.
struct GridRanking {
    keep: usize,
    ranked: Mutex<Ranked>,
}

#[derive(Default)]
struct Ranked {
    /// Scores with the numbers of their points, best first.
    best: Vec<(Score, usize)>,
    evaluations: u64,
    failures: u64,
}

impl GridRanking {
    fn new(keep: usize) -> Self {
        let ranked = Mutex::default();
        Self { keep, ranked }
    }

    /// Takes the values of a block.
    fn take(&self, grid: &RegularGrid, first: usize, part: &Evaluated) {
        let score = |index| (part.score(index), grid.number(first + index));
        let mut own: Vec<(Score, usize)> = (0..part.len()).map(score).collect();
        let failures = own.iter().filter(|(score, _)| score.failed).count() as u64;
        best_in_front(&mut own, self.keep);
        own.truncate(self.keep);
        // A thread that panics while it holds the lock ends the whole search.
        let Ok(mut ranked) = self.ranked.lock() else {
            return;
        };
        ranked.evaluations += part.len() as u64;
        ranked.failures += failures;
        if ranked.best.len() == self.keep
            && let Some(worst) = ranked.best.last()
        {
            own.retain(|one| order(one, worst).is_lt());
        }
        if !own.is_empty() {
            ranked.best.append(&mut own);
            best_in_front(&mut ranked.best, self.keep);
            ranked.best.truncate(self.keep);
        }
    }

    fn finish(self) -> Ranked {
        self.ranked.into_inner().unwrap_or_default()
    }
}

/// Better scores first; points of the same score by their number.
fn order(one: &(Score, usize), other: &(Score, usize)) -> Ordering {
    one.0.order(&other.0).then(one.1.cmp(&other.1))
}

/// Brings the best points to the front, in order.
fn best_in_front(scores: &mut [(Score, usize)], count: usize) {
    let count = count.min(scores.len());
    if count < scores.len() {
        scores.select_nth_unstable_by(count, order);
    }
    scores[..count].sort_unstable_by(order);
}

/// Takes the best points of a round into the best of all; of equal ones the earlier stays ahead,
/// and a point that is met again is not taken twice.
fn merge(top: &mut Vec<Candidate>, grid: &RegularGrid, best: &[(Score, usize)], keep: usize) {
    for (score, number) in best.iter().take(keep) {
        let point = grid.point(*number);
        if top.iter().any(|known| known.point == point) {
            continue;
        }
        let place = top.partition_point(|known| !score.better(&known.score));
        top.insert(
            place,
            Candidate {
                point,
                score: *score,
            },
        );
    }
    top.truncate(keep);
}

fn summary(grid: &RegularGrid, ranked: &Ranked, survivors: usize) -> Round {
    let survivors = &ranked.best[..survivors.min(ranked.best.len())];
    let (first, last) = (survivors[0], survivors[survivors.len() - 1]);
    let mut low = grid.point(first.1);
    let mut high = low.clone();
    for (_, number) in survivors {
        for (axis, value) in grid.point(*number).into_iter().enumerate() {
            low[axis] = value.min(low[axis]);
            high[axis] = value.max(high[axis]);
        }
    }
    Round {
        axes: grid.axes.clone(),
        increments: grid.increments(),
        evaluations: ranked.evaluations,
        failures: ranked.failures,
        best: Candidate {
            point: grid.point(first.1),
            score: first.0,
        },
        survivor_low: low,
        survivor_high: high,
        worst_survivor: last.0,
    }
}

/// The box of the survivors. An axis on which they all agree keeps half an increment to either
/// side, as far as the bounds go, or its next grid would be one point.
fn next_range(bounds: &Bounds, round: &Round) -> Result<Bounds> {
    let (mut low, mut high) = (round.survivor_low.clone(), round.survivor_high.clone());
    for (axis, increment) in round.increments.iter().enumerate() {
        if low[axis] == high[axis] {
            low[axis] = (low[axis] - 0.5 * increment).max(bounds.lower()[axis]);
            high[axis] = (high[axis] + 0.5 * increment).min(bounds.upper()[axis]);
        }
    }
    Bounds::new(low, high)
}
