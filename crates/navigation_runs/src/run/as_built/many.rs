//! Many runs: laws in scenarios, over all cores.

use std::sync::Arc;

use crate::run::Interrupted;
use crate::run::any_law::AnyLaw;
use crate::run::as_built::AsBuilt;
use crate::run::as_built::history::{Listener, distance_of};
use crate::run::as_built::run::clock_of;
use crate::run::episode::Episode;
use crate::run::metrics::{Nominal, Weights, score};
use crate::run::nominal::Ways;
use crate::run::outcome::{Contact, RunSummary};
use crate::run::table::{BatchTable, Cell};
use navigation_world::robots::drives::Reading;
use navigation_world::world::footprint::Footprint;
use navigation_world::world::geometry::Body;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Planar;
use numeric::threads::{on_threads, try_map};

/// Records of a run once every control period, and at its end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Histories {
    /// Instants in s.
    pub time: Vec<f64>,
    /// Positions of the robot in m.
    pub position: Vec<[f64; 2]>,
    /// Distances `d` to the obstacles in m, obstacles fastest; NaN while absent.
    pub distance: Vec<f64>,
}

/// Keeps the row of every control period, and the last one.
struct Sampled {
    kept: Histories,
    every: usize,
    next: usize,
    outline: Option<(Arc<Footprint>, f64)>,
}

impl Sampled {
    fn keep(&mut self, time: f64, reading: &Reading, bodies: &[Body]) {
        let position = reading.robot.position;
        let distance = |body: &Body| {
            if let Some((outline, radius)) = &self.outline {
                return distance_of(outline, *radius, reading, body);
            }
            if body.state.present {
                body.offset(position).distance_squared.sqrt()
            } else {
                f64::NAN
            }
        };
        self.kept.time.push(time);
        self.kept.position.push(position.lane(0));
        self.kept.distance.extend(bodies.iter().map(distance));
    }
}

/// Keeps nothing.
struct NoListener;

impl Listener for NoListener {}

impl Listener for Sampled {
    fn row(&mut self, time: f64, reading: &Reading, _energy: f64, bodies: &[Body]) {
        if self.next == 0 {
            self.next = self.every;
            self.keep(time, reading, bodies);
        }
        self.next -= 1;
    }

    fn end(&mut self, time: f64, reading: &Reading, _energy: f64, bodies: &[Body]) {
        self.keep(time, reading, bodies);
    }
}

/// Options of many runs, beside those of [`AsBuilt`].
#[derive(Clone, Copy, Debug)]
pub struct ManyOptions {
    /// Weights of the criterion.
    pub weights: Weights,
    /// Keep what happened once every control period.
    pub histories: bool,
    /// Number of threads; all cores when `None`.
    pub threads: Option<usize>,
}

/// Many runs; row `l * scenarios + s` is law `l` in scenario `s`.
#[derive(Clone, Debug, PartialEq)]
pub struct ManyRuns {
    /// Columns of the runs.
    pub table: BatchTable,
    /// First contacts of each run with its obstacles.
    pub contact: Vec<Vec<Option<Contact>>>,
    /// Histories of each run; empty unless asked for.
    pub histories: Vec<Histories>,
}

/// Runs robots as built in every scenario under every law, and scores each run against the run of
/// its law without obstacles and without errors of measurement.
///
/// # Errors
/// There is no scenario or no law, an option is out of range, a law cannot work in a scenario, a state
/// became non-finite, or the caller asked to stop.
pub fn run_many_as_built(
    scenarios: &[Scenario],
    laws: &[AnyLaw],
    built: &AsBuilt,
    options: &ManyOptions,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<ManyRuns> {
    check(scenarios, laws, built)?;
    let many = Many {
        scenarios,
        laws,
        built,
        options,
        interrupted,
    };
    on_threads(options.threads, || many.run(progress))
}

fn check(scenarios: &[Scenario], laws: &[AnyLaw], built: &AsBuilt) -> Result<()> {
    let empty = || Given::Found("an empty list".into());
    if scenarios.is_empty() {
        let rule = "hold at least one scenario";
        return Err(Failure::invalid("scenarios", rule, empty()));
    }
    if laws.is_empty() {
        return Err(Failure::invalid("laws", "hold at least one law", empty()));
    }
    for (index, scenario) in scenarios.iter().enumerate() {
        built
            .suiting(scenario)
            .and_then(|built| clock_of(scenario, built))
            .and_then(|_| laws.iter().try_for_each(|law| law.suits(scenario)))
            .map_err(|error| error.within(&format!("scenarios[{index}]")))?;
    }
    Ok(())
}

struct Many<'a> {
    scenarios: &'a [Scenario],
    laws: &'a [AnyLaw],
    built: &'a AsBuilt,
    options: &'a ManyOptions,
    interrupted: Interrupted<'a>,
}

impl Many<'_> {
    fn run(&self, progress: &(dyn Fn(usize) + Sync)) -> Result<ManyRuns> {
        let (count, ways) = (self.scenarios.len(), Ways::new(self.scenarios));
        let along = ways.scenarios.len();
        let nominal = try_map(self.laws.len() * along, |index| {
            let (way, law) = (&ways.scenarios[index % along], index / along);
            let ideal = self.built.seeing_all(&self.laws[law]);
            self.one(way, law, &ideal, NoListener)
                .map(|(run, _)| Nominal::of(&run.totals()))
                .map_err(|error| error.of_run(|_| ways.run_of(index % along, index / along)))
        })?;
        let runs = try_map(self.laws.len() * count, |row| {
            let kept = self
                .kept(&self.scenarios[row % count], row / count)
                .map_err(|error| error.of_run(|_| row))?;
            progress(1);
            Ok(kept)
        })?;
        let free = |row: usize| nominal[row / count * along + ways.of(row % count)];
        Ok(self.gathered(runs, &free))
    }

    fn kept(&self, scenario: &Scenario, law: usize) -> Result<(RunSummary, Histories)> {
        if !self.options.histories {
            let (summary, _) = self.one(scenario, law, self.built, NoListener)?;
            return Ok((summary, Histories::default()));
        }
        let sampled = Sampled {
            kept: Histories::default(),
            every: clock_of(scenario, self.built)?.steps_per_sample,
            next: 0,
            outline: scenario
                .footprint
                .clone()
                .map(|footprint| (footprint, scenario.robot.radius)),
        };
        let (summary, sampled) = self.one(scenario, law, self.built, sampled)?;
        Ok((summary, sampled.kept))
    }

    fn one<L: Listener>(
        &self,
        scenario: &Scenario,
        law: usize,
        built: &AsBuilt,
        listener: L,
    ) -> Result<(RunSummary, L)> {
        let scenario = Arc::new(scenario.clone());
        Episode::with_listener(scenario, Some(&self.laws[law]), built, |_, _| listener)?
            .completed(self.interrupted)
    }

    fn gathered(
        &self,
        runs: Vec<(RunSummary, Histories)>,
        free: &dyn Fn(usize) -> Nominal,
    ) -> ManyRuns {
        let count = self.scenarios.len();
        let (mut cells, mut distances) = (Vec::new(), Vec::new());
        let (mut contact, mut histories) = (Vec::new(), Vec::new());
        for (row, (summary, history)) in runs.into_iter().enumerate() {
            let (scenario, totals) = (&self.scenarios[row % count], summary.totals());
            let (own, weights) = (summary.min_distance.iter().copied(), self.options.weights);
            cells.push(Cell {
                run: totals,
                performance: score(scenario, (&totals).into(), own, free(row), weights),
            });
            distances.push(summary.min_distance);
            contact.push(summary.contact);
            if self.options.histories {
                histories.push(history);
            }
        }
        ManyRuns {
            table: BatchTable::of_rows(self.scenarios, cells.len(), |row| {
                (&cells[row], &distances[row][..])
            }),
            contact,
            histories,
        }
    }
}
