//! Many runs over all cores: those that may be side by side share a task.

use std::collections::BTreeMap;

use numeric::threads::{team, try_map};

use crate::run::any_law::AnyLaw;
use crate::run::lanes::group::{Group, RunJob};
use crate::run::outcome::RunTotals;
use crate::run::plan::{Key, MAX_GAINS};
use numeric::error::Result;

/// Most runs of a task in lanes, of one thread alone and of several, and the least number of tasks of each
/// of these.
const MOST_ALONE: usize = 4096;
const MOST_OF_TASK: usize = 512;
const TASKS_OF_THREAD: usize = 4;

/// Least runs of a task in lanes: with fewer the lanes run dry.
const FEWEST_OF_TASK: usize = 32;

/// Most runs of a task one after the other.
const MOST_IN_TURN: usize = 16;

/// Results of many runs.
pub(crate) struct MadeRuns<T> {
    done: Vec<Done<T>>,
    /// Task of each run, and its number there.
    places: Vec<(usize, usize)>,
}

/// Results of the runs of a task in its order, and their distances to the obstacles.
struct Done<T> {
    kept: Vec<T>,
    distances: Vec<f64>,
    /// Where the distances of each run begin.
    begins: Vec<usize>,
}

impl<T: Copy + Send + Sync> MadeRuns<T> {
    /// Makes the runs of a group; `keep` is told of each by its number, with its least distances to the obstacles.
    ///
    /// # Errors
    /// The law cannot work in a scenario, the state of a run became non-finite, or the caller asked to stop.
    pub fn new(
        law: &AnyLaw,
        group: &Group<'_>,
        unset: T,
        keep: &(dyn Fn(usize, &RunTotals, &[f64]) -> T + Sync),
    ) -> Result<Self> {
        let tasks = tasks(law, group);
        let done = try_map(tasks.len(), |task| {
            let task = &tasks[task];
            let jobs: Vec<RunJob<'_>> = task.iter().map(|index| group.jobs[*index]).collect();
            let mut done = Done::room_for(&jobs, unset);
            let own = Group {
                jobs: &jobs,
                ..*group
            };
            law.run(&own, &mut |run, totals, distance| {
                let own = &mut done.distances[done.begins[run]..done.begins[run + 1]];
                for (obstacle, slot) in own.iter_mut().enumerate() {
                    *slot = distance(obstacle);
                }
                done.kept[run] = keep(task[run], totals, own);
            })
            .map_err(|error| error.of_run(|run| task[run]))?;
            Ok(done)
        })?;
        let mut places = vec![(0, 0); group.jobs.len()];
        for (index, task) in tasks.iter().enumerate() {
            for (run, job) in task.iter().enumerate() {
                places[*job] = (index, run);
            }
        }
        Ok(Self { done, places })
    }

    /// Result of a run, and its least distances to the obstacles.
    pub fn of(&self, run: usize) -> (&T, &[f64]) {
        let (task, place) = self.places[run];
        let done = &self.done[task];
        let own = done.begins[place]..done.begins[place + 1];
        (&done.kept[place], &done.distances[own])
    }
}

impl<T: Copy> Done<T> {
    fn room_for(jobs: &[RunJob<'_>], unset: T) -> Self {
        let mut begins = Vec::with_capacity(jobs.len() + 1);
        begins.push(0);
        let mut end = 0;
        for job in jobs {
            end += job.scenario.obstacle_count();
            begins.push(end);
        }
        Self {
            kept: vec![unset; jobs.len()],
            distances: vec![f64::NAN; end],
            begins,
        }
    }
}

/// Runs of each task, by their numbers: those that fit side by side, and the others.
fn tasks(law: &AnyLaw, group: &Group<'_>) -> Vec<Vec<usize>> {
    let jobs = group.jobs;
    let (mut alike, mut others) = (Vec::<Vec<usize>>::new(), Vec::new());
    let lanes = law
        .lanes_for(group.plan, jobs.len())
        .map(|(lanes, _)| lanes);
    // Only runs of the same gains may have to be told apart by their scenes.
    let mut known: BTreeMap<Option<Key>, Vec<usize>> = BTreeMap::new();
    for (index, job) in jobs.iter().enumerate() {
        let Some(lanes) = lanes.filter(|lanes| lanes.pay(job)) else {
            others.push(index);
            continue;
        };
        let key = (!lanes.mixes_gains()).then(|| bits_of(job.gains));
        let known = known.entry(key).or_default();
        let fits = |group: &&usize| lanes.fit(&jobs[alike[**group][0]], job);
        if let Some(group) = known.iter().rev().find(fits) {
            alike[*group].push(index);
        } else {
            known.push(alike.len());
            alike.push(vec![index]);
        }
    }
    let threads = team();
    let share = jobs.len() / (TASKS_OF_THREAD * threads);
    let size = match threads {
        1 => MOST_ALONE,
        _ => share.clamp(FEWEST_OF_TASK, MOST_OF_TASK),
    };
    let in_turn = others.chunks(share.clamp(1, MOST_IN_TURN));
    let side_by_side = alike.iter().flat_map(|runs| runs.chunks(size));
    side_by_side.chain(in_turn).map(<[usize]>::to_vec).collect()
}

fn bits_of(gains: &[f64]) -> Key {
    let mut key = [0; MAX_GAINS];
    for (slot, gain) in key.iter_mut().zip(gains) {
        *slot = gain.to_bits();
    }
    key
}
