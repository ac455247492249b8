//! The search of Zeng (2011), C.2, as a whole: grids, then local searches from the best points.

use crate::blocks::Session;
use crate::grid::{GridOptions, Round, grids};
use crate::local::{LocalOptions, LocalSearch, local_searches};
use crate::observe::Observer;
use crate::problem::{Bounds, Candidate, Problem, single_objective};
use crate::search_state::{Fingerprint, SearchState};
use numeric::error::Result;
use numeric::threads::on_threads;

/// Options of the search.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchOptions {
    /// The grids.
    pub grid: GridOptions,
    /// The local searches, if wanted.
    pub local: Option<LocalOptions>,
    /// Number of threads; all cores when `None`.
    pub threads: Option<usize>,
}

/// Result of the search.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// Best point of all; `None` if the search was stopped before the first one.
    pub best: Option<Candidate>,
    /// Rounds of the grid that are complete.
    pub rounds: Vec<Round>,
    /// Local searches, in the order of their starts.
    pub local: Vec<LocalSearch>,
    /// Best grid points over all rounds, in order.
    pub top: Vec<Candidate>,
    /// Evaluations in all.
    pub evaluations: u64,
    /// Failures among them.
    pub failures: u64,
    /// Whether the search was stopped before its end.
    pub interrupted: bool,
}

/// Searches a box: coarse-to-fine grid, then local searches from its best points.
///
/// # Errors
/// An option is out of range, the state belongs to another search, or the problem fails.
pub fn search(
    problem: &dyn Problem,
    bounds: &Bounds,
    options: &SearchOptions,
    observer: &dyn Observer,
    resume: Option<&SearchState>,
) -> Result<Search> {
    single_objective(problem)?;
    bounds.check(problem)?;
    options.grid.check(bounds)?;
    let mut sum = options
        .grid
        .fingerprint(Fingerprint::of_box(problem, bounds));
    if let Some(local) = &options.local {
        local.check()?;
        sum = local.fingerprint(sum);
    }
    let session = Session::new(observer, SearchState::resumed(resume, sum.value())?);
    on_threads(options.threads, || {
        let grids = grids(&session, problem, bounds, &options.grid)?;
        let mut search = Search {
            best: grids.top.first().cloned(),
            rounds: grids.rounds,
            local: Vec::new(),
            top: grids.top,
            evaluations: grids.evaluations,
            failures: grids.failures,
            interrupted: !grids.complete,
        };
        if let (Some(local), true) = (&options.local, grids.complete) {
            let starts = &search.top[..local.starts.min(search.top.len())];
            let done = local_searches(&session, problem, bounds, starts, local)?;
            search.evaluations += done.evaluations;
            search.failures += done.failures;
            search.interrupted = done.interrupted;
            for found in &done.searches {
                let known = search.best.as_ref();
                if known.is_none_or(|best| found.best.score.better(&best.score)) {
                    search.best = Some(found.best.clone());
                }
            }
            search.local = done.searches;
        }
        Ok(search)
    })
}
