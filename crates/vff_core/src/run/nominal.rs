//! Runs without obstacles: they depend on few of the gains, and on the way.

use std::collections::HashMap;

use numeric::threads::try_map;

use crate::error::Result;
use crate::run::Interrupted;
use crate::run::any_law::ErasedLaw;
use crate::run::lanes::group::Group;
use crate::run::metrics::Nominal;
use crate::run::outcome::RunTotals;
use crate::run::plan::{Key, Plan, key_of};
use crate::world::scenario::Scenario;

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

/// Runs of some gain sets, all different, along one way.
pub(crate) fn nominal_runs(
    way: &Scenario,
    law: &dyn ErasedLaw,
    points: &[f64],
    plan: &Plan,
    interrupted: Interrupted<'_>,
) -> Result<Vec<Nominal>> {
    let mut runs = Vec::with_capacity(points.len() / law.gain_names().len());
    let group = Group {
        scenario: way,
        points,
        plan,
        interrupted,
    };
    let mut keep = |_: usize, run: &RunTotals, _: &dyn Fn(usize) -> f64| {
        runs.push(Nominal {
            arrival_time: run.arrival_time,
            energy: run.energy,
        });
    };
    law.run(&group, &mut keep)?;
    Ok(runs)
}

/// Runs without obstacles of many gain sets.
pub(crate) struct NominalRuns {
    /// Index of the run of each gain set.
    of: Vec<usize>,
    /// Runs along each way.
    runs: Vec<Vec<Nominal>>,
}

impl NominalRuns {
    /// Errors carry the index of the run, the scenarios fastest.
    pub fn new(
        ways: &Ways,
        law: &dyn ErasedLaw,
        points: &[f64],
        plan: &Plan,
        interrupted: Interrupted<'_>,
    ) -> Result<Self> {
        let dimension = law.gain_names().len();
        let mut known: HashMap<Key, usize> = HashMap::new();
        let (mut first, mut sets) = (Vec::new(), Vec::new());
        let mut last = None;
        let index_of = |(index, set): (usize, &[f64])| {
            let key = key_of(law.free_gains(), set);
            // Neighbours mostly share the run.
            if let Some((_, run)) = last.filter(|(other, _)| *other == key) {
                return run;
            }
            let run = *known.entry(key).or_insert_with(|| {
                first.push(index);
                sets.extend_from_slice(set);
                first.len() - 1
            });
            last = Some((key, run));
            run
        };
        let of = points
            .chunks_exact(dimension)
            .enumerate()
            .map(index_of)
            .collect();
        let plan = Plan {
            descent: false,
            shortcuts: false,
            width: super::Width::for_sets(first.len()),
            ..*plan
        };
        let team = plan.team(0);
        let along = |(index, way): (usize, &Scenario)| -> Result<Vec<Nominal>> {
            let chunks: Vec<&[f64]> = sets.chunks(team * dimension).collect();
            let parts = try_map(chunks.len(), |part| {
                nominal_runs(way, law, chunks[part], &plan, interrupted).map_err(|error| {
                    error.of_run(|run| ways.run_of(index, first[part * team + run]))
                })
            })?;
            Ok(parts.concat())
        };
        let each = ways.scenarios.iter().enumerate();
        let runs = each.map(along).collect::<Result<_>>()?;
        Ok(Self { of, runs })
    }

    /// Run of a gain set along a way.
    pub fn of(&self, way: usize, set: usize) -> Nominal {
        self.runs[way][self.of[set]]
    }
}
