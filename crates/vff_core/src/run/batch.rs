//! Many runs: gain sets side by side in lanes, lane groups and scenarios over all cores.

use numeric::threads::{on_threads, try_each};

use crate::error::{Failure, Given, Result};
use crate::run::Interrupted;
use crate::run::any_law::AnyLaw;
use crate::run::lanes::group::Group;
use crate::run::metrics::{Weights, score};
use crate::run::nominal::{NominalRuns, Ways};
use crate::run::options::Options;
use crate::run::plan::{Instructions, Plan, Width};
use crate::run::scene_batch::SceneBatch;
use crate::run::table::{BatchTable, Cell, Strip};
use crate::world::scenario::Scenario;

/// Gain sets that fill the lanes by themselves.
const FULL_LANES: usize = 8;

/// Scenes from which on lanes pay.
const FEWEST_SCENES: usize = 4;

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
        law.erased()
            .check_gains(set)
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
        let law = self.law.erased();
        let sets = self.points.len() / law.gain_names().len();
        let width = self.options.width.unwrap_or_else(|| Width::for_sets(sets));
        let plan = Plan {
            run: self.options.run,
            width,
            instructions: self.options.instructions,
            descent: self.options.descent,
            shortcuts: false,
        };
        let count = self.scenarios.len();
        let ways = Ways::new(self.scenarios);
        if self.scenes_suit(sets) {
            let scenes = SceneBatch {
                scenarios: self.scenarios,
                law,
                plan: &plan,
                weights: self.options.weights,
                interrupted: self.interrupted,
                progress: self.progress,
            };
            return scenes.run(self.points, &ways);
        }
        let nominal = NominalRuns::new(&ways, law, self.points, &plan, self.interrupted)?;
        let room = |scenario: &Scenario| Strip::new(sets, scenario.obstacle_count());
        let mut strips: Vec<Strip> = self.scenarios.iter().map(room).collect();
        try_each(tasks(&mut strips, plan.team(sets * count)), |task| {
            self.work(task, &plan, (&ways, &nominal))
        })?;
        Ok(BatchTable::gather(self.scenarios, &strips))
    }

    /// Whether scenes fill the lanes better than gain sets do.
    fn scenes_suit(&self, sets: usize) -> bool {
        let options = &self.options;
        let held = !options.run.is_staged();
        let asked = options.width.is_none_or(|width| width != Width::One);
        let many = sets < FULL_LANES && self.scenarios.len() >= FEWEST_SCENES;
        let law = self.law.erased();
        let most = law.most_obstacles();
        let small = || {
            self.scenarios
                .iter()
                .all(|own| own.obstacle_count() <= most)
        };
        law.takes_scenes() && held && asked && many && !options.descent && small()
    }

    fn work(
        &self,
        task: Task<'_>,
        plan: &Plan,
        (ways, nominal): (&Ways, &NominalRuns),
    ) -> Result<()> {
        let Task {
            scenario: index,
            first,
            cells,
            distances,
        } = task;
        let scenario = &self.scenarios[index];
        let obstacles = scenario.obstacle_count();
        let way = ways.of(index);
        let law = self.law.erased();
        let dimension = law.gain_names().len();
        let group = Group {
            scenario,
            points: &self.points[first * dimension..(first + cells.len()) * dimension],
            plan,
            interrupted: self.interrupted,
        };
        law.run(&group, &mut |set, run, distance| {
            let own = &mut distances[set * obstacles..(set + 1) * obstacles];
            for (obstacle, slot) in own.iter_mut().enumerate() {
                *slot = distance(obstacle);
            }
            let free = nominal.of(way, first + set);
            let own = own.iter().copied();
            let weights = self.options.weights;
            let performance = score(scenario, run.into(), own, free, weights);
            cells[set] = Cell {
                run: *run,
                performance,
            };
        })
        .map_err(|error| error.of_run(|run| (first + run) * self.scenarios.len() + index))?;
        (self.progress)(cells.len());
        Ok(())
    }
}

/// Runs of some gain sets in one scenario.
struct Task<'a> {
    scenario: usize,
    first: usize,
    cells: &'a mut [Cell],
    distances: &'a mut [f64],
}

/// Work of a batch; gain sets vary fastest, so that neighbouring tasks share a scenario.
fn tasks(strips: &mut [Strip], team: usize) -> Vec<Task<'_>> {
    let mut tasks = Vec::new();
    for (scenario, strip) in strips.iter_mut().enumerate() {
        let obstacles = strip.distances.len() / strip.cells.len();
        let mut distances = strip.distances.as_mut_slice();
        for (index, cells) in strip.cells.chunks_mut(team).enumerate() {
            let (own, rest) = distances.split_at_mut(cells.len() * obstacles);
            distances = rest;
            tasks.push(Task {
                scenario,
                first: index * team,
                cells,
                distances: own,
            });
        }
    }
    tasks
}
