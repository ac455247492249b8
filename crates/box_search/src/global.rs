//! Global methods with a budget of evaluations: islands that do not know of each other, stepped
//! together so that their points share vector lanes and threads.

use numeric::order::sort_indices;
use numeric::random::Stream;

use crate::ask_tell::Asker;
use crate::blocks::Session;
use crate::observe::Observer;
use crate::problem::{Bounds, Candidate, Problem, single_objective};
use crate::search_state::{Fingerprint, SearchState};
use crate::solvers::{Found, Halt, Oracle, cma_es, differential_evolution};
use crate::stage::Stage;
use numeric::error::{Failure, Given, Result};
use numeric::threads::on_threads;

/// First standard deviation of CMA-ES in shares of the sides of the box.
const SPREAD: f64 = 0.3;

/// Standard deviation in shares of the sides at which CMA-ES starts again elsewhere.
const COLLAPSE: f64 = 1e-5;

/// Global method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlobalMethod {
    /// Differential evolution (Storn and Price 1997).
    #[default]
    DifferentialEvolution,
    /// Evolution strategy with covariance matrix adaptation (Hansen 2016), restarted.
    CmaEs,
}

/// Options of a global search.
#[derive(Clone, Debug, PartialEq)]
pub struct GlobalOptions {
    /// Method.
    pub method: GlobalMethod,
    /// Evaluations in all.
    pub evaluations: u64,
    /// Number of islands that share them.
    pub islands: usize,
    /// Seed; the stream of random numbers is the island.
    pub seed: u64,
    /// Number of threads; all cores when `None`.
    pub threads: Option<usize>,
}

/// Result of a global search.
#[derive(Clone, Debug, PartialEq)]
pub struct GlobalSearch {
    /// Best point; `None` if the search was stopped before the first one.
    pub best: Option<Candidate>,
    /// Best point of each island that has one.
    pub islands: Vec<Candidate>,
    /// Evaluations in all.
    pub evaluations: u64,
    /// Failures among them.
    pub failures: u64,
    /// Evaluations in all, counted as if the islands took turns, at which the best feasible point
    /// became better, and its value.
    pub history: Vec<(u64, f64)>,
    /// Whether the search was stopped before its end.
    pub interrupted: bool,
}

/// Searches a box by a global method.
///
/// # Errors
/// An option is out of range, the state belongs to another search, or the problem fails.
pub fn global_search(
    problem: &dyn Problem,
    bounds: &Bounds,
    options: &GlobalOptions,
    observer: &dyn Observer,
    resume: Option<&SearchState>,
) -> Result<GlobalSearch> {
    single_objective(problem)?;
    bounds.check(problem)?;
    let islands = options.islands;
    if islands == 0 || islands > MOST_ISLANDS {
        let rule = "be from 1 to 256";
        let given = Given::Count(islands as u64);
        return Err(Failure::invalid("islands", rule, given));
    }
    if options.evaluations < islands as u64 {
        let rule = "be at least one for each island";
        let given = Given::Count(options.evaluations);
        return Err(Failure::invalid("evaluations", rule, given));
    }
    let sum = options.fingerprint(Fingerprint::of_box(problem, bounds));
    let session = Session::new(observer, SearchState::resumed(resume, sum.value())?);
    let solver = |island: usize, asker: &mut Asker| {
        let budget = options.budget(island);
        let oracle = Oracle::new(bounds, problem.constraints(), budget, asker);
        options.explore(&oracle, island as u64, bounds.dimension());
        oracle.finish()
    };
    on_threads(options.threads, || {
        let found = session.solve(
            Stage::Global,
            problem,
            islands,
            options.evaluations,
            &solver,
        )?;
        Ok(joined(found.into_iter().flatten().collect()))
    })
}

/// Islands are threads that mostly wait.
const MOST_ISLANDS: usize = 256;

impl GlobalOptions {
    /// Evaluations of an island.
    fn budget(&self, island: usize) -> u64 {
        let islands = self.islands as u64;
        self.evaluations / islands + u64::from((island as u64) < self.evaluations % islands)
    }

    /// Spends the budget of an island.
    fn explore(&self, oracle: &Oracle<'_>, island: u64, dimension: usize) {
        let mut stream = Stream::new(self.seed, island);
        match self.method {
            GlobalMethod::DifferentialEvolution => {
                differential_evolution(oracle, stream.bits());
            }
            GlobalMethod::CmaEs => {
                while oracle.open() {
                    let start = (0..dimension).map(|_| stream.unit()).collect();
                    cma_es(oracle, start, stream.bits(), SPREAD, COLLAPSE);
                }
            }
        }
    }

    fn fingerprint(&self, sum: Fingerprint) -> Fingerprint {
        sum.count(usize::from(self.method == GlobalMethod::CmaEs))
            .count(self.islands)
            .bytes(&self.evaluations.to_le_bytes())
            .bytes(&self.seed.to_le_bytes())
    }
}

/// Islands together.
fn joined(islands: Vec<Found>) -> GlobalSearch {
    let count = islands.len() as u64;
    let mut steps: Vec<(u64, f64)> = Vec::new();
    let mut search = GlobalSearch {
        best: None,
        islands: Vec::new(),
        evaluations: 0,
        failures: 0,
        history: Vec::new(),
        interrupted: false,
    };
    for (island, found) in (1..).zip(islands) {
        search.evaluations += found.evaluations;
        search.failures += found.failures;
        search.interrupted |= found.halted == Some(Halt::Stopped);
        let turn = |(own, value): &(u64, f64)| ((own - 1) * count + island, *value);
        steps.extend(found.history.iter().map(turn));
        let Some(own) = found.best else { continue };
        let known = search.best.as_ref();
        if known.is_none_or(|best| own.score.better(&best.score)) {
            search.best = Some(own.clone());
        }
        search.islands.push(own);
    }
    let mut order: Vec<usize> = (0..steps.len()).collect();
    sort_indices(&mut order, &mut |a, b| {
        steps[*a].0.cmp(&steps[*b].0).then(a.cmp(b))
    });
    for index in order {
        let (evaluations, value) = steps[index];
        if search.history.last().is_none_or(|last| value > last.1) {
            search.history.push((evaluations, value));
        }
    }
    search
}
