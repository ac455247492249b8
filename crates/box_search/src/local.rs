//! Constrained local searches from several starts, C.2, step 8.

use crate::ask_tell::Asker;
use crate::blocks::Session;
use crate::evaluated::Evaluated;
use crate::observe::Observer;
use crate::problem::{Bounds, Candidate, Problem, Score, single_objective};
use crate::search_state::{Fingerprint, SearchState};
use crate::solvers::{Found, Halt, Oracle, cobyla, mads};
use crate::stage::Stage;
use numeric::error::{Failure, Given, Result, Stop};
use numeric::threads::on_threads;

/// Local method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LocalMethod {
    /// Linear models on a simplex in a trust region that shrinks (Powell 1994).
    #[default]
    Cobyla,
    /// Polls on a mesh that becomes finer, with a progressive barrier (Audet and Dennis 2009).
    Mads,
}

/// Options of local searches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalOptions {
    /// Number of starts: the best points of the grid.
    pub starts: usize,
    /// Method.
    pub method: LocalMethod,
    /// Most evaluations of one search.
    pub evaluations: u64,
    /// First radius of the search, in shares of the sides of the box.
    pub radius: f64,
    /// Radius at which it has converged, in shares of the sides of the box.
    pub tolerance: f64,
}

impl Default for LocalOptions {
    /// Twenty starts, as in the source.
    fn default() -> Self {
        Self {
            starts: 20,
            method: LocalMethod::Cobyla,
            evaluations: 400,
            radius: 0.05,
            tolerance: 1e-5,
        }
    }
}

impl LocalOptions {
    pub(crate) fn check(&self) -> Result<()> {
        let refuse =
            |name: &str, rule, value| Err(Failure::invalid(name, rule, Given::Number(value)));
        if self.evaluations == 0 {
            return refuse("evaluations", "be at least one", 0.0);
        }
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return refuse("tolerance", "lie between 0 and 1", self.tolerance);
        }
        if !(self.radius > self.tolerance && self.radius <= 0.5) {
            let rule = "be larger than the tolerance and at most 0.5";
            return refuse("radius", rule, self.radius);
        }
        Ok(())
    }

    /// Runs the method, and again from its best point as long as that helps: linear models end
    /// early at kinks and in bent valleys. Whether it converged.
    fn descend(&self, oracle: &Oracle<'_>, bounds: &Bounds, mut start: Vec<f64>) -> bool {
        let radii = [self.radius, self.tolerance];
        let mut before: Option<Score> = None;
        loop {
            let converged = match self.method {
                LocalMethod::Cobyla => cobyla(oracle, &start, radii),
                LocalMethod::Mads => mads(oracle, &start, radii),
            };
            let Some(best) = oracle.best().filter(|_| converged && oracle.open()) else {
                return converged;
            };
            let worthwhile = before.is_none_or(|known| {
                let more = best.score.value - known.value;
                best.score.violation < known.violation
                    || more > self.tolerance * known.value.abs().max(self.tolerance)
            });
            if !worthwhile {
                return converged;
            }
            start = bounds.share(&best.point);
            before = Some(best.score);
        }
    }

    pub(crate) fn fingerprint(&self, sum: Fingerprint) -> Fingerprint {
        sum.count(self.starts)
            .count(usize::from(self.method == LocalMethod::Mads))
            .numbers(&[self.evaluations as f64, self.radius, self.tolerance])
    }
}

/// How a local search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalStatus {
    /// Its radius fell below the tolerance.
    Converged,
    /// Its evaluations were used up.
    BudgetSpent,
    /// The search was stopped.
    Interrupted,
    /// The method gave up.
    Failed,
}

impl LocalStatus {
    /// Its word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::BudgetSpent => "budget_spent",
            Self::Interrupted => "interrupted",
            Self::Failed => "failed",
        }
    }
}

/// A local search.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalSearch {
    /// Where it began.
    pub start: Candidate,
    /// Best point that it found, at worst its start.
    pub best: Candidate,
    /// Number of evaluations.
    pub evaluations: u64,
    /// Reason of the end.
    pub status: LocalStatus,
}

/// Local searches that are done or were stopped.
pub(crate) struct LocalSearches {
    pub searches: Vec<LocalSearch>,
    pub evaluations: u64,
    pub failures: u64,
    pub interrupted: bool,
}

/// Local searches from points of a box, side by side.
///
/// # Errors
/// An option is out of range, a start lies outside the box, the state belongs to another search,
/// or the problem fails.
pub fn local_search(
    problem: &dyn Problem,
    bounds: &Bounds,
    starts: &[Vec<f64>],
    options: &LocalOptions,
    threads: Option<usize>,
    observer: &dyn Observer,
    resume: Option<&SearchState>,
) -> Result<Vec<LocalSearch>> {
    single_objective(problem)?;
    bounds.check(problem)?;
    options.check()?;
    let mut sum = options.fingerprint(Fingerprint::of_box(problem, bounds));
    for (index, start) in starts.iter().enumerate() {
        if !bounds.contains(start) {
            let name = format!("starts[{index}]");
            let rule = "lie inside the bounds";
            let outside = Given::Found("a point outside".into());
            return Err(Failure::invalid(name, rule, outside));
        }
        sum = sum.numbers(start);
    }
    let session = Session::new(observer, SearchState::resumed(resume, sum.value())?);
    on_threads(threads, || {
        let scored = Evaluated::of(problem, &starts.concat(), Stop(&|| session.stopped()))?;
        let starts: Vec<Candidate> = starts
            .iter()
            .enumerate()
            .map(|(index, point)| Candidate {
                point: point.clone(),
                score: scored.score(index),
            })
            .collect();
        Ok(local_searches(&session, problem, bounds, &starts, options)?.searches)
    })
}

/// Local searches of a session; their points are evaluated side by side.
pub(crate) fn local_searches(
    session: &Session<'_>,
    problem: &dyn Problem,
    bounds: &Bounds,
    starts: &[Candidate],
    options: &LocalOptions,
) -> Result<LocalSearches> {
    let solver = |who: usize, asker: &mut Asker| {
        let start = bounds.share(&starts[who].point);
        let oracle = Oracle::new(bounds, problem.constraints(), options.evaluations, asker);
        let converged = options.descend(&oracle, bounds, start);
        let found = oracle.finish();
        if found.halted != Some(Halt::Stopped) {
            session.report(Stage::Local, 1, starts.len() as u64);
        }
        (found, converged)
    };
    let found = session.solve(
        Stage::Local,
        problem,
        starts.len(),
        starts.len() as u64,
        &solver,
    )?;
    let mut all = LocalSearches {
        searches: Vec::with_capacity(starts.len()),
        evaluations: 0,
        failures: 0,
        interrupted: false,
    };
    for (start, found) in starts.iter().zip(found) {
        let (found, converged) = found.unwrap_or_default();
        let search = concluded(start, found, converged, &mut all);
        all.interrupted |= search.status == LocalStatus::Interrupted;
        all.searches.push(search);
    }
    Ok(all)
}

fn concluded(
    start: &Candidate,
    found: Found,
    converged: bool,
    all: &mut LocalSearches,
) -> LocalSearch {
    all.evaluations += found.evaluations;
    all.failures += found.failures;
    let status = match found.halted {
        Some(Halt::Stopped) => LocalStatus::Interrupted,
        Some(Halt::Budget) => LocalStatus::BudgetSpent,
        None if converged => LocalStatus::Converged,
        None => LocalStatus::Failed,
    };
    let better = found.best.filter(|best| best.score.better(&start.score));
    LocalSearch {
        start: start.clone(),
        best: better.unwrap_or_else(|| start.clone()),
        evaluations: found.evaluations,
        status,
    }
}
