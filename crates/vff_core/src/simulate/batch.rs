//! Many runs: gain sets side by side in lanes, lane groups and scenarios over all cores.

use std::collections::HashMap;
use std::marker::PhantomData;

use rayon::prelude::*;

use crate::error::{Given, NavigationError, Result};
use crate::gains::{GainLanes, Gains};
use crate::lanes::{Lanes, Real};
use crate::laws::{ForceFieldLaw, VirtualForceField};
use crate::metrics::{Performance, Weights, performance};
use crate::scenario::Scenario;
use crate::simulate::Interrupted;
use crate::simulate::options::Options;
use crate::simulate::outcome::RunSummary;
use crate::simulate::record::{DescentCounter, Recorder};
use crate::simulate::rollout::{Member, run_team};

/// Number of gain sets that are stepped side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One.
    One,
    /// Four.
    Four,
    /// Eight.
    Eight,
    /// Sixteen.
    Sixteen,
}

impl Width {
    /// Width by its number of lanes.
    ///
    /// # Errors
    /// There is no such width.
    pub fn of(lanes: usize) -> Result<Self> {
        match lanes {
            1 => Ok(Self::One),
            4 => Ok(Self::Four),
            8 => Ok(Self::Eight),
            16 => Ok(Self::Sixteen),
            other => {
                let given = Given::Count(other as u64);
                Err(NavigationError::invalid("lanes", "be 1, 4, 8 or 16", given))
            }
        }
    }

    /// Width that suits a number of gain sets.
    #[must_use]
    pub fn for_sets(count: usize) -> Self {
        match count {
            0 | 1 => Self::One,
            2..=4 => Self::Four,
            5..=8 => Self::Eight,
            _ => Self::Sixteen,
        }
    }

    fn lanes(self) -> usize {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }
}

/// Which instructions of the processor a batch may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instructions {
    /// The widest vectors that the processor has.
    #[default]
    Widest,
    /// Those that every processor of its family has.
    Baseline,
}

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

/// A run of a batch with its score.
#[derive(Clone, Debug, PartialEq)]
pub struct ScoredRun {
    /// What is left of the run.
    pub run: RunSummary,
    /// Its score.
    pub performance: Performance,
}

/// Runs every gain set in every scenario; row `g * scenarios.len() + s`.
///
/// # Errors
/// An argument is out of range, a state became non-finite, or the caller asked to stop.
pub fn run_batch(
    scenarios: &[Scenario],
    law: &VirtualForceField,
    gains: &[Gains],
    options: &BatchOptions,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<ScoredRun>> {
    check(scenarios, gains, &options.run)?;
    let work = || run_all(scenarios, law, gains, options, interrupted, progress);
    match options.threads {
        None => work(),
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| NavigationError::Threads {
                threads,
                reason: error.to_string(),
            })?
            .install(work),
    }
}

fn check(scenarios: &[Scenario], gains: &[Gains], run: &Options) -> Result<()> {
    let empty = |name: &str, rule| {
        Err(NavigationError::invalid(
            name,
            rule,
            Given::Word("an empty list".into()),
        ))
    };
    if scenarios.is_empty() {
        return empty("scenarios", "hold at least one scenario");
    }
    if gains.is_empty() {
        return empty("gains", "hold at least one gain set");
    }
    for (index, set) in gains.iter().enumerate() {
        set.checked()
            .map_err(|error| error.within(&format!("gains[{index}]")))?;
    }
    for (index, scenario) in scenarios.iter().enumerate() {
        run.clock(scenario)
            .map_err(|error| error.within(&format!("scenarios[{index}]")))?;
    }
    Ok(())
}

fn run_all(
    scenarios: &[Scenario],
    law: &VirtualForceField,
    gains: &[Gains],
    options: &BatchOptions,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<ScoredRun>> {
    let width = options
        .width
        .unwrap_or_else(|| Width::for_sets(gains.len()));
    let nominal = NominalRuns::new(scenarios, law, gains, options, interrupted)?;
    let lanes = width.lanes();
    let groups = gains.len().div_ceil(lanes);
    // Groups vary fastest, so that neighbouring tasks share a scenario.
    let tasks: Vec<Vec<RunSummary>> = (0..groups * scenarios.len())
        .into_par_iter()
        .map(|task| {
            let (scenario, group) = (task / groups, task % groups);
            let sets = &gains[group * lanes..gains.len().min((group + 1) * lanes)];
            let runs = run_group(width, &scenarios[scenario], law, sets, options, interrupted)
                .map_err(|error| {
                    error.of_run(|run| (group * lanes + run) * scenarios.len() + scenario)
                })?;
            progress(sets.len());
            Ok(runs)
        })
        .collect::<Result<_>>()?;
    let mut tasks: Vec<_> = tasks.into_iter().map(Vec::into_iter).collect();
    let mut rows = Vec::with_capacity(gains.len() * scenarios.len());
    for (set, gain) in gains.iter().enumerate() {
        for (index, scenario) in scenarios.iter().enumerate() {
            let Some(run) = tasks[index * groups + set / lanes].next() else {
                continue;
            };
            let free = nominal.of(index, gain);
            let performance = performance(scenario, &run, free, options.weights);
            rows.push(ScoredRun { run, performance });
        }
    }
    Ok(rows)
}

/// Gain sets of one task through one scenario.
fn run_group(
    width: Width,
    scenario: &Scenario,
    law: &VirtualForceField,
    sets: &[Gains],
    options: &BatchOptions,
    interrupted: Interrupted<'_>,
) -> Result<Vec<RunSummary>> {
    if interrupted() {
        return Err(NavigationError::Interrupted);
    }
    let job = GroupJob {
        scenario,
        law,
        sets,
        options,
        interrupted,
        kind: PhantomData,
    };
    // One job for each kind of run: in one body an unoptimized build would need more stack than
    // a thread has.
    let mut runs = match (width, options.descent) {
        (Width::One, false) => job.dispatch::<f64, (), false>(),
        (Width::One, true) => job.dispatch::<f64, DescentCounter<f64>, true>(),
        (Width::Four, false) => job.dispatch::<Lanes<4>, (), false>(),
        // Sixteen lanes are two groups of eight in step, which share the obstacles' motion.
        (Width::Eight | Width::Sixteen, false) => job.dispatch::<Lanes<8>, (), false>(),
        (_, true) => job.dispatch::<Lanes<8>, DescentCounter<Lanes<8>>, true>(),
    }?;
    runs.truncate(sets.len());
    Ok(runs)
}

/// A task that is compiled once for each instruction set; the widest one that the processor has
/// is chosen at run time. The arithmetic is the same, bit for bit.
struct GroupJob<'a, K = ()> {
    scenario: &'a Scenario,
    law: &'a VirtualForceField,
    sets: &'a [Gains],
    options: &'a BatchOptions,
    interrupted: Interrupted<'a>,
    kind: PhantomData<K>,
}

/// Width, recorder, and whether the Lyapunov function is wanted.
struct Kind<R, C, const RECORD: bool>(PhantomData<(R, C)>);

impl<'a> GroupJob<'a> {
    fn dispatch<R: Real, C: Recorder<R> + Default, const RECORD: bool>(
        self,
    ) -> Result<Vec<RunSummary>> {
        let processor = match self.options.instructions {
            Instructions::Widest => pulp::Arch::new(),
            Instructions::Baseline => pulp::Arch::Scalar,
        };
        processor.dispatch(GroupJob::<'a, Kind<R, C, RECORD>> {
            scenario: self.scenario,
            law: self.law,
            sets: self.sets,
            options: self.options,
            interrupted: self.interrupted,
            kind: PhantomData,
        })
    }
}

impl<R: Real, C: Recorder<R> + Default, const RECORD: bool> pulp::NullaryFnOnce
    for GroupJob<'_, Kind<R, C, RECORD>>
{
    type Output = Result<Vec<RunSummary>>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let lanes = self
            .sets
            .chunks(R::WIDTH)
            .filter_map(<[Gains]>::split_first);
        let mut team: Vec<_> = lanes
            .map(|(first, rest)| {
                let gains = GainLanes::<R>::gather(*first, rest);
                let law = ForceFieldLaw::<R, RECORD>::new(self.law, gains, self.scenario);
                Member {
                    law,
                    recorder: C::default(),
                }
            })
            .collect();
        run_team(
            self.scenario,
            &mut team,
            &self.options.run,
            self.interrupted,
        )
    }
}

/// Runs without obstacles: they depend on `K_1` and `b` only, and on the way.
struct NominalRuns {
    /// Way of each scenario.
    way: Vec<usize>,
    runs: HashMap<(usize, u64, u64), RunSummary>,
}

impl NominalRuns {
    fn new(
        scenarios: &[Scenario],
        law: &VirtualForceField,
        gains: &[Gains],
        options: &BatchOptions,
        interrupted: Interrupted<'_>,
    ) -> Result<Self> {
        let mut ways: Vec<Scenario> = Vec::new();
        let mut way = Vec::with_capacity(scenarios.len());
        for scenario in scenarios {
            let nominal = scenario.nominal();
            let known = ways.iter().position(|other| *other == nominal);
            way.push(known.unwrap_or_else(|| {
                ways.push(nominal);
                ways.len() - 1
            }));
        }
        let mut sets: Vec<Gains> = gains.to_vec();
        let key = |set: &Gains| (set.attractive.to_bits(), set.ratio.to_bits());
        sets.sort_by_key(key);
        sets.dedup_by_key(|set| key(set));
        let width = Width::for_sets(sets.len());
        let free = BatchOptions {
            descent: false,
            ..*options
        };
        let groups: Vec<(usize, &[Gains])> = (0..ways.len())
            .flat_map(|index| sets.chunks(width.lanes()).map(move |chunk| (index, chunk)))
            .collect();
        let runs: Vec<Vec<RunSummary>> = groups
            .par_iter()
            .map(|(index, chunk)| {
                let row = |run: usize| {
                    let same = |set: &Gains| chunk.get(run).is_some_and(|own| key(own) == key(set));
                    let set = gains.iter().position(same).unwrap_or(0);
                    let scenario = way.iter().position(|known| known == index).unwrap_or(0);
                    set * scenarios.len() + scenario
                };
                run_group(width, &ways[*index], law, chunk, &free, interrupted)
                    .map_err(|error| error.of_run(row))
            })
            .collect::<Result<_>>()?;
        let runs = groups
            .iter()
            .zip(runs)
            .flat_map(|((index, chunk), runs)| {
                chunk.iter().zip(runs).map(|(set, run)| {
                    ((*index, set.attractive.to_bits(), set.ratio.to_bits()), run)
                })
            })
            .collect();
        Ok(Self { way, runs })
    }

    fn of(&self, scenario: usize, set: &Gains) -> &RunSummary {
        &self.runs[&(
            self.way[scenario],
            set.attractive.to_bits(),
            set.ratio.to_bits(),
        )]
    }
}
