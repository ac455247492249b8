//! Environments for learners: many worlds of one robot each, stepped side by side.
//!
//! Observations, rewards and the starts of episodes are made here, so that a call steps all of them.

mod block;
mod history;
mod layout;
mod observation;
mod one;
mod row;
mod settings;

pub use layout::{Area, Layout, seed_of};
pub use observation::{BOUND, RANGE};
pub use one::{Environment, Shared, State, Step};
pub use settings::{Action, Autoreset, Axes, EnvironmentSettings, Rewards};

use crate::crowd::environments::block::{BLOCK, BlockStep};
use crate::crowd::environments::row::{METRICS, Row};
use crate::crowd::world::{CrowdWorld, MOST_SIGHTINGS};
use crate::crowd::world_lanes;
use crate::run::Interrupted;
use crate::run::Request;
use numeric::error::{Failure, Given, Result, proceed};
use numeric::threads::{on_threads, team, try_each};

/// Most environments of a set.
pub const MOST_ENVIRONMENTS: usize = 1 << 20;
/// Most people and robots of all environments together: about 1 kB each.
const MOST_AGENTS: usize = 10_000_000;
/// Fewest environments that are worth another thread.
const LEAST_SHARE: usize = 16;

/// Where results are written, a row for each environment.
pub struct Outputs<'a> {
    /// Observations of the robots.
    pub observations: &'a mut [f32],
    /// Last observations of an episode that was followed by another one in the same step.
    pub final_observations: &'a mut [f32],
    /// How many of the people that each can see are there, after the step and at such an end.
    pub seen: &'a mut [[i64; 2]],
    /// Rewards.
    pub rewards: &'a mut [f64],
    /// Codes of [`State`].
    pub states: &'a mut [u8],
    /// Whether an episode has started in this step.
    pub started: &'a mut [bool],
    /// Least gaps within the step, in m.
    pub clearances: &'a mut [f64],
    /// How often people were set back at walls in the episode, that has ended where one has.
    pub wall_rescues: &'a mut [i64],
    /// Metrics of episodes that have ended.
    pub metrics: &'a mut [[f64; METRICS]],
}

/// Environments side by side.
pub struct Environments {
    settings: EnvironmentSettings,
    each: Vec<Environment>,
    threads: Option<usize>,
}

impl Environments {
    /// So many environments at the start of their first episodes; the seeds count up from the first one.
    ///
    /// # Errors
    /// A setting breaks a rule, there is no room for everybody, or the caller asked to stop.
    pub fn new(
        settings: EnvironmentSettings,
        count: usize,
        seed: u64,
        threads: Option<usize>,
        interrupted: Interrupted<'_>,
    ) -> Result<Self> {
        if !(1..=MOST_ENVIRONMENTS).contains(&count) {
            return Err(Failure::invalid(
                "num_envs",
                format!("be from 1 to {MOST_ENVIRONMENTS}"),
                Given::Count(count as u64),
            ));
        }
        let settings = settings.checked()?;
        check_size(&settings.world, count)?;
        let seeds = (0..count as u64).map(|index| seed.wrapping_add(index));
        let each: Result<Vec<Environment>> = seeds
            .map(|seed| {
                proceed(interrupted)?;
                Environment::new(&settings, seed)
            })
            .collect();
        Ok(Self {
            each: each?,
            settings,
            threads,
        })
    }

    /// Settings of all environments.
    #[must_use]
    pub fn settings(&self) -> &EnvironmentSettings {
        &self.settings
    }

    /// One of them.
    #[must_use]
    pub fn environment(&self, index: usize) -> Option<&Environment> {
        self.each.get(index)
    }

    /// Tells another robot of one of them what to do from its next decision on, until it is told something else.
    pub fn ask(&mut self, index: usize, robot: usize, request: Request) {
        if let Some(environment) = self.each.get_mut(index) {
            environment.ask(robot, request);
        }
    }

    /// Starts episodes: of all, or where the mask says so; the first ones of other seeds where there are any.
    ///
    /// # Errors
    /// The caller asked to stop, or there is no room for everybody.
    pub fn reset(
        &mut self,
        seeds: &[Option<u64>],
        mask: &[bool],
        outputs: Outputs<'_>,
        interrupted: Interrupted<'_>,
    ) -> Result<()> {
        let settings = &self.settings;
        let chosen = |index: usize| mask.get(index).copied().unwrap_or(true);
        let seed_of = |index: usize| seeds.get(index).copied().flatten();
        let work = |rows: &mut [(usize, Row<'_>)], shared: &mut Shared| {
            rows.iter_mut().try_for_each(|(index, row)| {
                if chosen(*index) {
                    proceed(interrupted)?;
                    row.environment.reset(settings, seed_of(*index))?;
                    *row.started = true;
                }
                row.show(settings, shared);
                Ok(())
            })
        };
        each_block((settings, self.threads), &mut self.each, outputs, work)
    }

    /// Steps all of them by actions in [-1, 1].
    ///
    /// # Errors
    /// The caller asked to stop, an episode that has ended is stepped, or there is no room for a new one.
    pub fn step(
        &mut self,
        actions: &[[f64; 2]],
        outputs: Outputs<'_>,
        interrupted: Interrupted<'_>,
    ) -> Result<()> {
        let settings = &self.settings;
        if settings.autoreset == Autoreset::Disabled
            && let Some(index) = self.ended()
        {
            let given = Given::Found("one that has ended".into());
            let name = format!("environment[{index}]");
            return Err(Failure::invalid(name, "be under way", given)
                .mended_by("start its next episode by reset first"));
        }
        let step = BlockStep {
            settings,
            model: world_lanes::model_of(&settings.world),
            actions,
            interrupted,
        };
        let work = |rows: &mut [(usize, Row<'_>)], shared: &mut Shared| step.step(rows, shared);
        each_block((settings, self.threads), &mut self.each, outputs, work)
    }

    /// The first environment whose episode has ended.
    #[must_use]
    pub fn ended(&self) -> Option<usize> {
        let mut states = self.each.iter().map(Environment::state);
        states.position(|state| state != State::Running)
    }
}

/// Refuses environments that would not fit into memory.
fn check_size(world: &CrowdWorld, count: usize) -> Result<()> {
    let agents = count.saturating_mul(world.people.len() + world.robots.len());
    let sightings = count.saturating_mul(world.sightings());
    for (found, most, what) in [
        (agents, MOST_AGENTS, "people and robots"),
        (
            sightings,
            MOST_SIGHTINGS,
            "pairs of a robot under a law and somebody it may see",
        ),
    ] {
        if found > most {
            let rule = format!("make at most {most} {what} together");
            let advice = format!("{count} of them make {found}; take fewer or smaller worlds");
            let given = Given::Count(count as u64);
            return Err(Failure::invalid("num_envs", rule, given).mended_by(advice));
        }
    }
    Ok(())
}

/// Does something with some environments at a time and their results, on so many threads.
fn each_block(
    (settings, threads): (&EnvironmentSettings, Option<usize>),
    each: &mut [Environment],
    outputs: Outputs<'_>,
    work: impl Fn(&mut [(usize, Row<'_>)], &mut Shared) -> Result<()> + Sync + Send,
) -> Result<()> {
    let size = settings.size();
    let count = each.len();
    let mut rows = each
        .iter_mut()
        .zip(outputs.observations.chunks_exact_mut(size))
        .zip(outputs.final_observations.chunks_exact_mut(size))
        .zip(outputs.seen.iter_mut().zip(outputs.rewards))
        .zip(outputs.states.iter_mut().zip(outputs.started))
        .zip(outputs.clearances.iter_mut().zip(outputs.wall_rescues))
        .zip(outputs.metrics)
        .map(
            |(
                (
                    ((((environment, observation), last), (seen, reward)), (state, started)),
                    (gap, rescues),
                ),
                row,
            )| Row {
                environment,
                observation,
                final_observation: last,
                seen,
                reward,
                state,
                started,
                clearance: gap,
                wall_rescues: rescues,
                metrics: row,
            },
        )
        .enumerate();
    if threads == Some(1) {
        let (mut shared, mut block) = (Shared::default(), Vec::with_capacity(BLOCK));
        loop {
            block.extend(rows.by_ref().take(BLOCK));
            if block.is_empty() {
                return Ok(());
            }
            work(&mut block, &mut shared)?;
            block.clear();
        }
    }
    on_threads(threads, || {
        let share = count.div_ceil(4 * team()).max(LEAST_SHARE);
        let mut rows: Vec<(usize, Row<'_>)> = rows.collect();
        let shares = rows.chunks_mut(share.next_multiple_of(BLOCK)).collect();
        try_each(shares, |rows: &mut [(usize, Row<'_>)]| {
            let mut shared = Shared::default();
            let mut blocks = rows.chunks_mut(BLOCK);
            blocks.try_for_each(|block| work(block, &mut shared))
        })
    })
}
