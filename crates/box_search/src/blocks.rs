//! Evaluating many points: blocks over all threads, found in the search state or computed.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::ask_tell::{Asker, answer_together};
use crate::evaluated::Evaluated;
use crate::observe::{Control, Observer, Report};
use crate::problem::{Candidate, Problem, Score};
use crate::search_state::SearchState;
use crate::stage::Stage;
use numeric::error::{Failure, Result, Stop};
use numeric::threads::{on_threads, team, try_map};

/// Blocks that a list of points is cut into at least, so that threads share the work evenly.
const LEAST_BLOCKS: usize = 64;

/// Fewest points of a block.
const LEAST_BLOCK: usize = 16;

/// Points of several solvers are cut into multiples of this.
const FEW_LANES: usize = 4;

/// Consumer of the values of a block: the position of its first point, its points, and their
/// values. Called from any thread, in any order.
pub(crate) type Take<'a> = &'a (dyn Fn(usize, &[f64], &Evaluated) + Sync);

/// A search at work: who watches it, and what is done.
pub(crate) struct Session<'a> {
    observer: &'a dyn Observer,
    stopped: AtomicBool,
    progress: Mutex<Progress>,
}

struct Progress {
    state: SearchState,
    best: Option<Candidate>,
    done: u64,
}

impl<'a> Session<'a> {
    pub fn new(observer: &'a dyn Observer, state: SearchState) -> Self {
        let progress = Progress {
            state,
            best: None,
            done: 0,
        };
        Self {
            observer,
            stopped: AtomicBool::new(false),
            progress: Mutex::new(progress),
        }
    }

    /// Whether the observer has asked to stop.
    pub fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed) || self.observer.stopped()
    }

    /// Begins a stage.
    pub fn begin(&self) {
        self.with(|progress| progress.done = 0);
    }

    /// A piece that is already in the search state.
    pub fn known(&self, stage: Stage, index: usize) -> Option<Evaluated> {
        self.with(|progress| progress.state.piece(stage, index).cloned())
            .flatten()
    }

    /// Does something with the search state.
    pub fn record(&self, change: impl FnOnce(&mut SearchState)) {
        self.with(|progress| change(&mut progress.state));
    }

    /// Notes a candidate for the best point.
    pub fn offer(&self, point: &[f64], score: Score) {
        self.with(|progress| {
            let known = progress.best.as_ref();
            if known.is_none_or(|best| score.better(&best.score)) {
                let point = point.to_vec();
                progress.best = Some(Candidate { point, score });
            }
        });
    }

    /// Tells the observer that more is done.
    pub fn report(&self, stage: Stage, more: u64, total: u64) {
        let control = self.with(|progress| {
            progress.done += more;
            let report = Report {
                stage,
                done: progress.done,
                total,
                best: progress.best.as_ref(),
            };
            let state = &progress.state;
            self.observer.report(&report, &|| state.clone())
        });
        if control != Some(Control::Continue) {
            self.stopped.store(true, Ordering::Relaxed);
        }
    }

    /// `None` when an observer has panicked; the search then stops.
    fn with<T>(&self, work: impl FnOnce(&mut Progress) -> T) -> Option<T> {
        self.progress.lock().ok().map(|mut guard| work(&mut guard))
    }

    /// Evaluates points that come in blocks; `points` gives those of a range of positions, `take`
    /// gets their values. Whether all blocks were evaluated: after a stop some are missing.
    pub fn evaluate(
        &self,
        stage: Stage,
        problem: &dyn Problem,
        count: usize,
        points: &(dyn Fn(std::ops::Range<usize>) -> Vec<f64> + Sync),
        take: Take<'_>,
    ) -> Result<bool> {
        self.begin();
        let block = block_of(problem, count);
        let done = try_map(count.div_ceil(block), |index| {
            let range = index * block..count.min((index + 1) * block);
            let (first, size) = (range.start, range.len());
            let known = self.known(stage, index).filter(|known| known.len() == size);
            if known.is_none() && self.stopped() {
                return Ok(false);
            }
            let points = points(range);
            let fresh = known.is_none();
            let found =
                known.map_or_else(|| self.values(problem, &points), |known| Ok(Some(known)));
            let Some(evaluated) = found? else {
                return Ok(false);
            };
            if problem.objectives() == 1 {
                self.offer_best(problem.dimension(), &points, &evaluated);
            }
            take(first, &points, &evaluated);
            if fresh {
                self.record(|state| state.insert(stage, index, evaluated));
            }
            self.report(stage, size as u64, count as u64);
            Ok(true)
        })?;
        let complete = done.into_iter().all(|done| done);
        if !complete {
            // The observer is told after the last block, so that it can keep the state.
            self.report(stage, 0, count as u64);
        }
        Ok(complete)
    }

    /// Values of points that a problem computes; none when stopped meanwhile.
    fn values(&self, problem: &dyn Problem, points: &[f64]) -> Result<Option<Evaluated>> {
        match Evaluated::of(problem, points, Stop(&|| self.stopped())) {
            Err(Failure::Interrupted) if self.stopped() => Ok(None),
            found => found.map(Some),
        }
    }

    /// Runs a number of solvers that ask for one point at a time, and evaluates their points side
    /// by side; in all there are `total` evaluations, or searches in the local stage. What they
    /// were answered before an interruption comes from the search state.
    ///
    /// The observer is called whenever all solvers have asked. Local searches count when they are done, by
    /// themselves; of the others every evaluation counts, `total` in all.
    pub fn solve<T: Send>(
        &self,
        stage: Stage,
        problem: &dyn Problem,
        count: usize,
        total: u64,
        solver: &(impl Fn(usize, &mut Asker) -> T + Sync),
    ) -> Result<Vec<Option<T>>> {
        self.begin();
        let known = (0..count).map(|who| self.known(stage, who).unwrap_or_default());
        let known: Vec<Evaluated> = known.collect();
        let counted = |points: usize| match stage {
            Stage::Local => 0,
            _ => points as u64,
        };
        self.report(
            stage,
            counted(known.iter().map(Evaluated::len).sum()),
            total,
        );
        let mut failure = None;
        let results = answer_together(known, solver, |asked| {
            if self.stopped() {
                return None;
            }
            match self.answer(stage, problem, asked) {
                Ok(answers) => {
                    self.report(stage, counted(asked.len()), total);
                    Some(answers)
                }
                Err(error) => {
                    if !(error == Failure::Interrupted && self.stopped()) {
                        failure = Some(error);
                    }
                    None
                }
            }
        });
        if self.stopped() {
            self.report(stage, 0, total);
        }
        failure.map_or(Ok(results), Err)
    }

    /// Values of the points of several solvers, in parts of a few lanes over all threads.
    fn answer(
        &self,
        stage: Stage,
        problem: &dyn Problem,
        asked: &[(usize, Vec<f64>)],
    ) -> Result<Vec<Evaluated>> {
        let even = asked.len().div_ceil(2 * team());
        let part = even.next_multiple_of(FEW_LANES).min(problem.block());
        let chunks: Vec<_> = asked.chunks(part).collect();
        let parts = try_map(chunks.len(), |index| {
            let points = chunks[index].iter().flat_map(|(_, point)| point);
            let points: Vec<f64> = points.copied().collect();
            Evaluated::of(problem, &points, Stop(&|| self.stopped()))
        })?;
        let answers: Vec<Evaluated> = parts
            .iter()
            .flat_map(|part| (0..part.len()).map(|index| part.single(index)))
            .collect();
        for ((who, point), answer) in asked.iter().zip(&answers) {
            self.record(|state| state.growing(stage, *who).extend(answer));
            self.offer(point, answer.score(0));
        }
        Ok(answers)
    }

    /// Notes the best of some points.
    fn offer_best(&self, dimension: usize, points: &[f64], evaluated: &Evaluated) {
        let scores = (0..evaluated.len()).map(|index| (index, evaluated.score(index)));
        if let Some((index, score)) = scores.min_by(|(_, one), (_, other)| one.order(other)) {
            self.offer(&points[index * dimension..(index + 1) * dimension], score);
        }
    }
}

/// Points of a block: as many as the problem likes, but not so many that threads stand idle.
fn block_of(problem: &dyn Problem, count: usize) -> usize {
    let even = count.div_ceil(LEAST_BLOCKS).next_multiple_of(LEAST_BLOCK);
    even.min(problem.block()).max(1)
}

/// Values of any list of points, row by row.
///
/// # Errors
/// The problem fails, the caller asked to stop, or the threads could not be made.
pub fn evaluate_all(
    problem: &dyn Problem,
    points: &[f64],
    threads: Option<usize>,
    interrupted: &(dyn Fn() -> bool + Sync),
) -> Result<Evaluated> {
    let dimension = problem.dimension();
    let block = block_of(problem, points.len() / dimension);
    on_threads(threads, || {
        let chunks: Vec<&[f64]> = points.chunks(block * dimension).collect();
        let parts = try_map(chunks.len(), |index| {
            if interrupted() {
                return Err(Failure::Interrupted);
            }
            Evaluated::of(problem, chunks[index], Stop(interrupted))
        })?;
        let mut all = Evaluated::default();
        for part in &parts {
            all.extend(part);
        }
        Ok(all)
    })
}
