//! Many runs: every gain set in every scenario.

use numeric::threads::{map, on_threads};

use crate::run::Interrupted;
use crate::run::any_law::AnyLaw;
use crate::run::lanes::group::{Group, RunJob};
use crate::run::metrics::{Weights, score};
use crate::run::nominal::{NominalRuns, Ways};
use crate::run::options::Options;
use crate::run::plan::{Instructions, RunPlan, Width};
use crate::run::table::{BatchTable, Cell};
use crate::run::tasks::MadeRuns;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result};

/// Options of a batch.
#[derive(Clone, Copy, Debug)]
pub struct BatchOptions {
    /// Options of every run.
    pub run: Options,
    /// Weights of the criterion.
    pub weights: Weights,
    /// Count the control periods over which the Lyapunov function does not grow.
    pub descent: bool,
    /// Number of threads; all cores when `None`.
    pub threads: Option<usize>,
    /// Lanes; chosen when `None`.
    pub width: Option<Width>,
    /// Instructions that may be used; never changes a bit of the result.
    pub instructions: Instructions,
}

/// Runs every gain set in every scenario; row `g * scenarios.len() + s`. The gain sets follow each
/// other in `points`, each in the order of the law's names.
///
/// # Errors
/// An argument is out of range, a state became non-finite, or the caller asked to stop.
pub fn run_batch(
    scenarios: &[Scenario],
    law: impl Into<AnyLaw>,
    points: &[f64],
    options: &BatchOptions,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<BatchTable> {
    let law = &law.into();
    check(scenarios, law, points, &options.run)?;
    let batch = Batch {
        scenarios,
        law,
        points,
        options,
        interrupted,
        progress,
    };
    on_threads(options.threads, || batch.run())
}

fn check(scenarios: &[Scenario], law: &AnyLaw, points: &[f64], run: &Options) -> Result<()> {
    let empty = |name: &str, rule| {
        Err(Failure::invalid(
            name,
            rule,
            Given::Found("an empty list".into()),
        ))
    };
    if scenarios.is_empty() {
        return empty("scenarios", "hold at least one scenario");
    }
    if points.is_empty() {
        return empty("gains", "hold at least one gain set");
    }
    let dimension = law.gain_names().len();
    if !points.len().is_multiple_of(dimension) {
        let rule = "hold a whole number of gain sets";
        let given = Given::Count(points.len() as u64);
        return Err(Failure::invalid("gains", rule, given));
    }
    for (index, set) in points.chunks_exact(dimension).enumerate() {
        law.check_gains(set)
            .map_err(|error| error.within(&format!("gains[{index}]")))?;
    }
    for (index, scenario) in scenarios.iter().enumerate() {
        scenario
            .of_point_mass()
            .and_then(|()| law.suits(scenario))
            .and_then(|()| run.clock(scenario))
            .map_err(|error| error.within(&format!("scenarios[{index}]")))?;
    }
    Ok(())
}

struct Batch<'a> {
    scenarios: &'a [Scenario],
    law: &'a AnyLaw,
    /// Gain sets in the order of their names.
    points: &'a [f64],
    options: &'a BatchOptions,
    interrupted: Interrupted<'a>,
    progress: &'a (dyn Fn(usize) + Sync),
}

impl Batch<'_> {
    fn run(&self) -> Result<BatchTable> {
        let (law, count) = (self.law, self.scenarios.len());
        let sets: Vec<&[f64]> = self.points.chunks_exact(law.gain_names().len()).collect();
        let plan = &RunPlan {
            run: self.options.run,
            width: self.options.width.unwrap_or(Width::Sixteen),
            instructions: self.options.instructions,
            descent: self.options.descent,
            shortcuts: false,
        };
        let (interrupted, weights) = (self.interrupted, self.options.weights);
        let ways = Ways::new(self.scenarios);
        let nominal = NominalRuns::new(&ways, law, &sets, plan, interrupted)?;
        // Neighbours share their scenario.
        let jobs = self.scenarios.iter().flat_map(|scenario| {
            let each = sets.iter();
            each.map(move |gains| RunJob { scenario, gains })
        });
        let group = Group {
            jobs: &jobs.collect::<Vec<_>>(),
            plan,
            led: false,
            interrupted,
        };
        let made = MadeRuns::new(law, &group, Cell::unset(), &|run, totals, distances| {
            let (index, set) = (run / sets.len(), run % sets.len());
            let free = nominal.of(ways.of(index), set);
            let own = distances.iter().copied();
            let performance = score(&self.scenarios[index], totals.into(), own, free, weights);
            (self.progress)(1);
            Cell {
                run: *totals,
                performance,
            }
        });
        let row = |run: usize| run % sets.len() * count + run / sets.len();
        let made = made.map_err(|error| error.of_run(row))?;
        // Every column asks for every row.
        let rows = map(sets.len() * count, |row| {
            made.of(row % count * sets.len() + row / count)
        });
        Ok(BatchTable::of_rows(self.scenarios, rows.len(), |row| {
            rows[row]
        }))
    }
}
