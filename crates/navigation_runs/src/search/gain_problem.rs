//! The gains of a law as a problem: scenarios, runs, objectives, constraints.

use std::collections::HashMap;
use std::sync::Mutex;

use crate::run::lanes::group::Keep;
use crate::run::metrics::{Nominal, score};
use crate::run::{AnyLaw, Group, Key, RunJob, RunPlan, Ways, Width, key_of, min_clearance};
use crate::search::gain_objective::{
    Judged, Metric, MetricConstraint, Objective, Over, arrival_margin,
};
use crate::search::gain_options::GainOptions;
use box_search::{Evaluation, Problem};
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Result, Stop};

/// Motion steps of one call of [`Problem::evaluate`] if no run ends early: some milliseconds, so
/// that a search can be stopped and watched.
const STEPS_PER_BLOCK: usize = 1_536_000;

/// Runs of one such call at most.
const RUNS_PER_BLOCK: usize = 1536;

/// Gain sets in a row that share their run without obstacles, from which on teams keep to them.
const MANY_NEIGHBOURS: usize = 32;

/// Runs without obstacles that are remembered before they are forgotten.
const REMEMBERED: usize = 65_536;

/// Gains of a law, to be chosen for some scenarios.
pub struct GainProblem {
    /// Scenarios with their seeds, the seeds fastest.
    scenarios: Vec<Scenario>,
    /// Runs of one scenario: its seeds.
    repeats: usize,
    /// Motion steps of the longest possible run.
    longest: usize,
    ways: Ways,
    law: AnyLaw,
    options: GainOptions,
    /// Whether a run is settled once the run without obstacles has failed.
    skips: bool,
    nominal: Mutex<HashMap<(usize, Key), Nominal>>,
}

impl GainProblem {
    /// The problem for a law whose gains are searched and whose other options are kept.
    ///
    /// # Errors
    /// There is no scenario or no objective, an objective or a constraint names a scenario that is
    /// not there or a metric that it does not have, or an option is out of range.
    pub fn new(
        scenarios: Vec<Scenario>,
        law: impl Into<AnyLaw>,
        options: GainOptions,
    ) -> Result<Self> {
        Self::of(scenarios, law.into(), options)
    }

    fn of(scenarios: Vec<Scenario>, law: AnyLaw, mut options: GainOptions) -> Result<Self> {
        options.check(&scenarios)?;
        options.run.stop_on_contact = true;
        let repeats = options.seeds.len().max(1);
        let limit = options.time_limit.unwrap_or(f64::INFINITY);
        let mut all = Vec::with_capacity(scenarios.len() * repeats);
        let mut longest = 1;
        for (index, mut scenario) in scenarios.into_iter().enumerate() {
            scenario.rules.time_limit = scenario.rules.time_limit.min(limit);
            let clock = scenario
                .of_point_mass()
                .and_then(|()| law.suits(&scenario))
                .and_then(|()| options.run.clock(&scenario))
                .map_err(|error| error.within(&format!("scenarios[{index}]")))?;
            longest = longest.max(clock.steps);
            if options.seeds.is_empty() {
                all.push(scenario);
                continue;
            }
            let seeded = options.seeds.iter().map(|seed| Scenario {
                seed: *seed,
                ..scenario.clone()
            });
            all.extend(seeded);
        }
        let scores_failures = |objective: &Objective| objective.metric.scores_failures();
        Ok(Self {
            ways: Ways::new(&all),
            scenarios: all,
            repeats,
            longest,
            law,
            skips: options.constraints.is_empty()
                && options.objectives.iter().all(scores_failures)
                && options
                    .objectives
                    .iter()
                    .all(|objective| objective.metric != Metric::AvoidancePerformance),
            options,
            nominal: Mutex::new(HashMap::new()),
        })
    }

    /// Runs that a point takes, without those that need no obstacles.
    #[must_use]
    pub fn episodes_per_point(&self) -> usize {
        self.scenarios.len()
    }

    /// Runs of gain sets in a scenario, as [`AnyLaw::run`] hands them over.
    fn run(
        &self,
        scenario: &Scenario,
        (points, shortcuts): (&[f64], bool),
        stop: Stop<'_>,
        keep: Keep<'_>,
    ) -> Result<()> {
        let plan = RunPlan {
            run: self.options.run,
            width: self.options.width.unwrap_or(Width::Sixteen),
            instructions: self.options.instructions,
            descent: false,
            shortcuts,
        };
        let sets = points.chunks_exact(self.dimension());
        let group = Group {
            jobs: &sets
                .map(|gains| RunJob { scenario, gains })
                .collect::<Vec<_>>(),
            plan: &plan,
            led: false,
            interrupted: stop.0,
        };
        self.law.run(&group, keep)
    }

    /// Runs without obstacles of some points along a way: remembered, or made side by side.
    fn nominal(&self, way: usize, points: &[f64], stop: Stop<'_>) -> Result<Vec<Nominal>> {
        let dimension = self.dimension();
        let key = |set: &[f64]| (way, key_of(self.law.free_gains(), set));
        let known = self.remembered(points, &key)?;
        let mut missing: Vec<(usize, Key)> = Vec::new();
        let mut sets = Vec::new();
        for (set, run) in points.chunks_exact(dimension).zip(&known) {
            // Neighbours mostly share the run.
            if run.is_none() && missing.last() != Some(&key(set)) {
                missing.push(key(set));
                sets.extend_from_slice(set);
            }
        }
        let mut fresh = vec![Nominal::UNSET; missing.len()];
        let way = &self.ways.scenarios[way];
        self.run(way, (&sets, false), stop, &mut |set, run, _| {
            fresh[set] = Nominal::of(run);
        })?;
        let mut made = missing.iter().zip(&fresh);
        let mut last: Option<(&(usize, Key), &Nominal)> = None;
        let mut runs = Vec::with_capacity(known.len());
        for (set, run) in points.chunks_exact(dimension).zip(known) {
            if run.is_none() && last.is_none_or(|(own, _)| *own != key(set)) {
                last = made.next();
            }
            runs.extend(run.or(last.map(|(_, run)| *run)));
        }
        let mut known = self.nominal.lock().map_err(|_| lost())?;
        if known.len() > REMEMBERED {
            known.clear();
        }
        known.extend(missing.iter().copied().zip(fresh.iter().copied()));
        Ok(runs)
    }

    /// Runs without obstacles that were made before.
    fn remembered(
        &self,
        points: &[f64],
        key: &dyn Fn(&[f64]) -> (usize, Key),
    ) -> Result<Vec<Option<Nominal>>> {
        let known = self.nominal.lock().map_err(|_| lost())?;
        let sets = points.chunks_exact(self.dimension());
        Ok(sets.map(|set| known.get(&key(set)).copied()).collect())
    }

    /// Judges the runs of all points in a scenario: `judged[point * scenarios + scenario]`.
    fn judge(
        &self,
        index: usize,
        points: &[f64],
        free: &[Nominal],
        judged: &mut [Judged],
        stop: Stop<'_>,
    ) -> Result<()> {
        let (dimension, count) = (self.dimension(), self.scenarios.len());
        let scenario = &self.scenarios[index];
        let settled = |run: &Nominal| self.skips && run.arrival_time.is_nan();
        let live: Vec<usize> = (0..free.len())
            .filter(|set| !settled(&free[*set]))
            .collect();
        let gathered: Vec<f64>;
        let sets = if live.len() == free.len() {
            points
        } else {
            let of = |set: &usize| &points[set * dimension..(set + 1) * dimension];
            gathered = live.iter().flat_map(of).copied().collect();
            &gathered
        };
        let mut distances = vec![0.0; scenario.obstacle_count()];
        let mut first = 0;
        for sets in teams(sets, dimension, self.law.free_gains()) {
            self.run(scenario, (sets, true), stop, &mut |set, run, distance| {
                let set = live[first + set];
                for (obstacle, slot) in distances.iter_mut().enumerate() {
                    *slot = distance(obstacle);
                }
                let own = distances.iter().copied();
                let weights = self.options.weights;
                let mut performance = score(scenario, run.into(), own, free[set], weights);
                if self.options.cap_ratios {
                    performance = performance.with_capped_ratios(weights);
                }
                let clearance = min_clearance(scenario, &distances);
                judged[set * count + index] = Judged::new(run, performance, clearance);
            })?;
            first += sets.len() / dimension;
        }
        Ok(())
    }

    /// Value of an objective from the runs of a point: with each seed over the scenarios, then over
    /// the seeds.
    fn objective(&self, objective: &Objective, runs: &[Judged]) -> f64 {
        let count = (runs.len() / self.repeats) as f64;
        let of_seed = |seed: usize| {
            let mut values = runs[seed..]
                .iter()
                .step_by(self.repeats)
                .map(|run| run.value(objective.metric));
            match objective.over {
                Over::Mean => values.sum::<f64>() / count,
                Over::Worst => values.fold(f64::INFINITY, f64::min),
                Over::Scenario(index) => values.nth(index).unwrap_or(f64::NEG_INFINITY),
            }
        };
        let seeds = (0..self.repeats).map(of_seed);
        self.options.robustness.combine(seeds)
    }

    /// Margin of a constraint: the worst of its runs, NaN if one of them does not have the metric.
    fn margin(&self, constraint: &MetricConstraint, runs: &[Judged]) -> f64 {
        let runs = match constraint.scenario {
            None => runs,
            Some(index) => &runs[index * self.repeats..(index + 1) * self.repeats],
        };
        let margins = runs
            .iter()
            .map(|run| constraint.margin(run.metric(constraint.metric)));
        margins.fold(f64::INFINITY, |worst, margin| {
            if margin.is_nan() || margin < worst {
                margin
            } else {
                worst
            }
        })
    }
}

impl Problem for GainProblem {
    fn dimension(&self) -> usize {
        self.law.gain_names().len()
    }

    fn objectives(&self) -> usize {
        self.options.objectives.len()
    }

    fn constraints(&self) -> usize {
        self.options.constraints.len() + usize::from(self.options.require_arrival)
    }

    fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()> {
        for set in points.chunks_exact(self.dimension()) {
            self.law.check_gains(set)?;
        }
        let count = self.scenarios.len();
        let mut judged = vec![Judged::hopeless(); into.failed.len() * count];
        let mut free: Vec<Vec<Nominal>> = Vec::with_capacity(self.ways.scenarios.len());
        for way in 0..self.ways.scenarios.len() {
            free.push(self.nominal(way, points, into.stop)?);
        }
        for index in 0..count {
            let free = &free[self.ways.of(index)];
            self.judge(index, points, free, &mut judged, into.stop)?;
        }
        let (objectives, constraints) = (&self.options.objectives, &self.options.constraints);
        let margins_each = self.constraints();
        for (point, runs) in judged.chunks_exact(count).enumerate() {
            let failures = runs.iter().filter(|run| run.failed).count();
            into.failed[point] = failures > 0;
            let values = &mut into.values[point * objectives.len()..];
            for (slot, objective) in values.iter_mut().zip(objectives) {
                *slot = self.objective(objective, runs);
            }
            let margins = &mut into.margins[point * margins_each..(point + 1) * margins_each];
            for (slot, constraint) in margins.iter_mut().zip(constraints) {
                *slot = self.margin(constraint, runs);
            }
            if self.options.require_arrival {
                margins[constraints.len()] = arrival_margin(failures);
            }
        }
        Ok(())
    }

    /// The gains that act without obstacles slowest: neighbours then share those runs, and the
    /// lanes of a group behave alike.
    fn slowest_first(&self) -> Vec<usize> {
        let free = self.law.free_gains();
        let others = (0..self.dimension()).filter(|axis| !free.contains(axis));
        free.iter().copied().chain(others).collect()
    }

    fn block(&self) -> usize {
        let runs = (STEPS_PER_BLOCK / self.longest).min(RUNS_PER_BLOCK);
        let points = runs / self.scenarios.len();
        points.clamp(16, 512).next_multiple_of(16)
    }
}

/// Another thread has panicked.
fn lost() -> Failure {
    Failure::Interrupted
}

/// Cuts gain sets into teams; where many neighbours share the gains that act without obstacles, a
/// team does not reach beyond them.
fn teams<'a>(points: &'a [f64], dimension: usize, free_gains: &[usize]) -> Vec<&'a [f64]> {
    let sets = || points.chunks_exact(dimension);
    let differ = |(one, next)| key_of(free_gains, one) != key_of(free_gains, next);
    let changes = sets().zip(sets().skip(1)).enumerate();
    let changes = changes.filter(|(_, pair)| differ(*pair));
    let mut ends: Vec<usize> = changes.map(|(index, _)| (index + 1) * dimension).collect();
    if ends.len() * MANY_NEIGHBOURS * dimension > points.len() {
        return vec![points];
    }
    ends.push(points.len());
    let begins = std::iter::once(0).chain(ends.iter().copied());
    begins
        .zip(&ends)
        .map(|(begin, end)| &points[begin..*end])
        .collect()
}
