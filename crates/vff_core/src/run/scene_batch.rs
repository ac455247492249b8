//! Many scenes for few gain sets: scenes side by side in lanes, tasks of many scenes over all cores.

use numeric::threads::{map, team, try_map};

use crate::error::Result;
use crate::run::Interrupted;
use crate::run::any_law::ErasedLaw;
use crate::run::lanes::group::{Group, Keep, SceneGroup};
use crate::run::lanes::scenes::{agree, fits};
use crate::run::metrics::{Nominal, Weights, score};
use crate::run::nominal::Ways;
use crate::run::plan::{Plan, Width};
use crate::run::table::{BatchTable, Cell};
use crate::world::scenario::Scenario;

/// Most scenes of a task, of one thread alone and of several, and the least number of tasks of each
/// of these.
const MOST_ALONE: usize = 4096;
const MOST_OF_TASK: usize = 512;
const TASKS_OF_THREAD: usize = 4;

/// Least scenes of a task in lanes: with fewer the lanes run dry.
const FEWEST_OF_TASK: usize = 32;

/// Scenes of a batch.
pub(crate) struct SceneBatch<'a> {
    pub scenarios: &'a [Scenario],
    pub law: &'a dyn ErasedLaw,
    pub plan: &'a Plan,
    pub weights: Weights,
    pub interrupted: Interrupted<'a>,
    pub progress: &'a (dyn Fn(usize) + Sync),
}

/// Scenes that are run together, by their indices: side by side, or one after the other.
struct Task {
    scenes: Vec<usize>,
    side_by_side: bool,
}

/// Runs of a task in its order: cells, and the distances to the obstacles of each.
struct Done {
    cells: Vec<Cell>,
    distances: Vec<f64>,
    /// Where the distances of each run begin.
    begins: Vec<usize>,
}

impl SceneBatch<'_> {
    /// Runs every gain set in every scene; rows as in the batch of gain sets.
    pub fn run(&self, points: &[f64], ways: &Ways) -> Result<BatchTable> {
        let dimension = self.law.gain_names().len();
        let count = self.scenarios.len();
        let tasks = tasks(self.scenarios);
        let free = tasks_of(&ways.scenarios, |_| true);
        let mut all: Vec<Vec<Done>> = Vec::new();
        for (set, gains) in points.chunks_exact(dimension).enumerate() {
            let row = |scene: usize| set * count + scene;
            let nominal = self.nominal(gains, &ways.scenarios, &free);
            let nominal = nominal.map_err(|error| error.of_run(|way| ways.run_of(way, set)))?;
            let done = try_map(tasks.len(), |task| {
                let task = &tasks[task];
                let free = |scene: usize| nominal[ways.of(scene)];
                let done = self.work(gains, task, &free);
                done.map_err(|error| error.of_run(|run| row(task.scenes[run])))
            });
            all.push(done?);
        }
        let places = places(count, &tasks);
        let place = |row: usize| {
            let (task, run) = places[row % count];
            let done = &all[row / count][task];
            let own = done.begins[run]..done.begins[run + 1];
            (&done.cells[run], &done.distances[own])
        };
        // Every column asks for every row.
        let rows = map(points.len() / dimension * count, place);
        Ok(BatchTable::of_rows(self.scenarios, rows.len(), |row| {
            rows[row]
        }))
    }

    /// Runs without obstacles along every way, which errors count.
    fn nominal(&self, gains: &[f64], ways: &[Scenario], tasks: &[Task]) -> Result<Vec<Nominal>> {
        let parts = try_map(tasks.len(), |task| {
            let task = &tasks[task];
            let mut found = vec![None; task.scenes.len()];
            self.each(gains, (ways, task), &mut |run, totals, _| {
                found[run] = Some(Nominal {
                    arrival_time: totals.arrival_time,
                    energy: totals.energy,
                });
            })
            .map_err(|error| error.of_run(|run| task.scenes[run]))?;
            Ok(found)
        })?;
        let unset = Nominal {
            arrival_time: f64::NAN,
            energy: f64::NAN,
        };
        let mut all = vec![unset; ways.len()];
        for (task, found) in tasks.iter().zip(parts) {
            for (way, nominal) in task.scenes.iter().zip(found) {
                all[*way] = nominal.unwrap_or(unset);
            }
        }
        Ok(all)
    }

    fn work(&self, gains: &[f64], task: &Task, free: &dyn Fn(usize) -> Nominal) -> Result<Done> {
        let mut done = Done::room_for(task, self.scenarios);
        self.each(
            gains,
            (self.scenarios, task),
            &mut |run, totals, distance| {
                let scene = task.scenes[run];
                let begin = done.begins[run];
                let own = &mut done.distances[begin..done.begins[run + 1]];
                for (obstacle, slot) in own.iter_mut().enumerate() {
                    *slot = distance(obstacle);
                }
                let own = own.iter().copied();
                let scenario = &self.scenarios[scene];
                let performance = score(scenario, totals.into(), own, free(scene), self.weights);
                done.cells[run] = Cell {
                    run: *totals,
                    performance,
                };
                (self.progress)(1);
            },
        )?;
        Ok(done)
    }

    /// Hands over every run of a task, by its number there.
    fn each(
        &self,
        gains: &[f64],
        (scenarios, task): (&[Scenario], &Task),
        keep: Keep<'_>,
    ) -> Result<()> {
        let vectors = self.plan.instructions.vectors();
        if let Some(vectors) = vectors.filter(|_| task.side_by_side) {
            let scenes: Vec<&Scenario> =
                task.scenes.iter().map(|scene| &scenarios[*scene]).collect();
            let group = SceneGroup {
                scenes: &scenes,
                gains,
                plan: self.plan,
                vectors,
                interrupted: self.interrupted,
            };
            return self.law.run_scenes(&group, keep);
        }
        let plan = Plan {
            width: Width::One,
            ..*self.plan
        };
        for (run, scene) in task.scenes.iter().enumerate() {
            let group = Group {
                scenario: &scenarios[*scene],
                points: gains,
                plan: &plan,
                interrupted: self.interrupted,
            };
            self.law
                .run(&group, &mut |_, totals, distance| {
                    keep(run, totals, distance);
                })
                .map_err(|error| error.of_run(|_| run))?;
        }
        Ok(())
    }
}

impl Done {
    fn room_for(task: &Task, scenarios: &[Scenario]) -> Self {
        let mut begins = Vec::with_capacity(task.scenes.len() + 1);
        begins.push(0);
        let mut end = 0;
        for scene in &task.scenes {
            end += scenarios[*scene].obstacle_count();
            begins.push(end);
        }
        Self {
            cells: vec![Cell::unset(); task.scenes.len()],
            distances: vec![f64::NAN; end],
            begins,
        }
    }
}

/// Work of a batch of scenes.
fn tasks(scenarios: &[Scenario]) -> Vec<Task> {
    tasks_of(scenarios, fits)
}

/// Scenes that fit into lanes beside each other, and the others.
fn tasks_of(scenarios: &[Scenario], fits: impl Fn(&Scenario) -> bool) -> Vec<Task> {
    let mut alike: Vec<Vec<usize>> = Vec::new();
    let mut others = Vec::new();
    for (index, scenario) in scenarios.iter().enumerate() {
        if !fits(scenario) {
            others.push(index);
            continue;
        }
        let known = alike
            .iter_mut()
            .find(|known| agree(&scenarios[known[0]], scenario));
        match known {
            Some(known) => known.push(index),
            None => alike.push(vec![index]),
        }
    }
    let size = size_of_task(scenarios.len(), team());
    let mut tasks = Vec::new();
    for (scenes, side_by_side) in alike
        .iter()
        .map(|scenes| (scenes, true))
        .chain([(&others, false)])
    {
        tasks.extend(scenes.chunks(size).map(|part| Task {
            scenes: part.to_vec(),
            side_by_side,
        }));
    }
    tasks
}

/// Scenes of a task: at its end lanes run dry, so that one thread has few of them.
fn size_of_task(scenes: usize, threads: usize) -> usize {
    if threads == 1 {
        return MOST_ALONE;
    }
    let share = scenes / (TASKS_OF_THREAD * threads);
    share.clamp(FEWEST_OF_TASK, MOST_OF_TASK)
}

/// Task of each scene, and its number there.
fn places(count: usize, tasks: &[Task]) -> Vec<(usize, usize)> {
    let mut places = vec![(0, 0); count];
    for (index, task) in tasks.iter().enumerate() {
        for (run, scene) in task.scenes.iter().enumerate() {
            places[*scene] = (index, run);
        }
    }
    places
}
