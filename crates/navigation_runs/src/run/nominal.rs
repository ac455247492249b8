//! Runs without obstacles: they depend on few of the gains, and on the way.

use std::collections::HashMap;

use crate::run::Interrupted;
use crate::run::any_law::AnyLaw;
use crate::run::lanes::group::{Group, RunJob};
use crate::run::metrics::Nominal;
use crate::run::plan::{Key, RunPlan, key_of};
use crate::run::tasks::MadeRuns;
use navigation_world::world::scenario::Scenario;
use numeric::error::Result;

/// Distinct ways of some scenarios.
pub(crate) struct Ways {
    /// Scenarios without obstacles.
    pub scenarios: Vec<Scenario>,
    /// Way of each scenario.
    of: Vec<usize>,
}

impl Ways {
    pub fn new(scenarios: &[Scenario]) -> Self {
        let mut ways: Vec<Scenario> = Vec::new();
        let mut known: HashMap<[u64; 4], Vec<usize>> = HashMap::new();
        let mut last = 0;
        let way_of = |scenario: &Scenario| {
            // Neighbors mostly share the way.
            if ways.get(last).is_some_and(|way| way.same_way(scenario)) {
                return last;
            }
            let [from, to] = [scenario.start, scenario.goal].map(|end| end.map(f64::to_bits));
            let alike = known.entry([from[0], from[1], to[0], to[1]]).or_default();
            let found = alike.iter().find(|way| ways[**way].same_way(scenario));
            last = found.copied().unwrap_or_else(|| {
                ways.push(scenario.nominal());
                alike.push(ways.len() - 1);
                ways.len() - 1
            });
            last
        };
        let of = scenarios.iter().map(way_of).collect();
        Self {
            scenarios: ways,
            of,
        }
    }

    /// Way of a scenario.
    pub fn of(&self, scenario: usize) -> usize {
        self.of[scenario]
    }

    /// Index of the run that an error of a nominal run is told of: the first scenario with its way.
    pub fn run_of(&self, way: usize, set: usize) -> usize {
        let first = self.of.iter().position(|of| *of == way);
        set * self.of.len() + first.unwrap_or(0)
    }
}

/// Runs without obstacles of many gain sets, which many of them share.
pub(crate) struct NominalRuns {
    /// Number of the first gain set with the run of each.
    of: Vec<usize>,
    ways: usize,
    runs: MadeRuns<Nominal>,
}

impl NominalRuns {
    /// Errors carry the index of the run, the scenarios fastest.
    pub fn new(
        ways: &Ways,
        law: &AnyLaw,
        sets: &[&[f64]],
        plan: &RunPlan,
        interrupted: Interrupted<'_>,
    ) -> Result<Self> {
        let mut known: HashMap<Key, usize> = HashMap::new();
        let mut first = Vec::new();
        let mut last = None;
        let index_of = |(index, set): (usize, &&[f64])| {
            let key = key_of(law.free_gains(), set);
            // Neighbours mostly share the run.
            if let Some((_, run)) = last.filter(|(other, _)| *other == key) {
                return run;
            }
            let run = *known.entry(key).or_insert_with(|| {
                first.push(index);
                first.len() - 1
            });
            last = Some((key, run));
            run
        };
        let of = sets.iter().enumerate().map(index_of).collect();
        let jobs = first.iter().flat_map(|set| {
            let along = ways.scenarios.iter();
            along.map(|scenario| RunJob {
                scenario,
                gains: sets[*set],
            })
        });
        let jobs: Vec<RunJob<'_>> = jobs.collect();
        let plan = RunPlan {
            descent: false,
            ..*plan
        };
        let group = Group {
            jobs: &jobs,
            plan: &plan,
            led: false,
            interrupted,
        };
        let count = ways.scenarios.len();
        let runs = MadeRuns::new(law, &group, Nominal::UNSET, &|_, run, _| Nominal::of(run));
        let row = |run: usize| ways.run_of(run % count, first[run / count]);
        Ok(Self {
            of,
            ways: count,
            runs: runs.map_err(|error| error.of_run(row))?,
        })
    }

    /// Run of a gain set along a way.
    pub fn of(&self, way: usize, set: usize) -> Nominal {
        *self.runs.of(self.of[set] * self.ways + way).0
    }
}
