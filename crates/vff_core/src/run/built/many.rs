//! The same scenario with many seeds.

use std::sync::Arc;

use crate::error::{Failure, Given, Result};
use crate::lanes::{Planar, Vector2};
use crate::robots::drives::Reading;
use crate::run::Interrupted;
use crate::run::built::Built;
use crate::run::built::history::Listener;
use crate::run::built::run::clock_of;
use crate::run::episode::Episode;
use crate::run::group::AnyLaw;
use crate::run::outcome::RunSummary;
use crate::world::geometry::Body;
use crate::world::scenario::Scenario;
use numeric::threads::{on_threads, try_map};

/// What is kept of a run once every control period, and at its end.
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
    last: Option<(f64, Vector2<f64>, Vec<f64>)>,
}

impl Sampled {
    fn keep(&mut self, (time, position, distances): (f64, Vector2<f64>, Vec<f64>)) {
        self.kept.time.push(time);
        self.kept.position.push(position.lane(0));
        self.kept.distance.extend(distances);
    }

    fn finish(mut self) -> Histories {
        if let Some(last) = self.last.take() {
            self.keep(last);
        }
        self.kept
    }
}

impl Listener for Sampled {
    fn row(&mut self, time: f64, reading: &Reading, _energy: f64, bodies: &[Body]) {
        let position = reading.robot.position;
        let distance = |body: &Body| {
            if body.state.present {
                body.offset(position).distance_squared.sqrt()
            } else {
                f64::NAN
            }
        };
        let row = (time, position, bodies.iter().map(distance).collect());
        if self.next == 0 {
            self.next = self.every;
            self.last = None;
            self.keep(row);
        } else {
            self.last = Some(row);
        }
        self.next -= 1;
    }
}

/// Runs a scenario with each seed; results stand in the order of the seeds.
///
/// # Errors
/// There is no seed, an option is out of range, the law cannot work in the scenario, a state became
/// non-finite, or the caller asked to stop.
pub fn repeat_built(
    scenario: &Scenario,
    law: &AnyLaw,
    built: &Built,
    seeds: &[u64],
    threads: Option<usize>,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<(RunSummary, Histories)>> {
    if seeds.is_empty() {
        let none = Given::Found("an empty list".into());
        let rule = "hold at least one seed";
        return Err(Failure::invalid("seeds", rule, none));
    }
    let every = clock_of(scenario, built)?.steps_per_sample;
    let one = |index: usize| {
        let scenario = Arc::new(scenario.clone().reseeded(seeds[index]));
        let sampled = Sampled {
            kept: Histories::default(),
            every,
            next: 0,
            last: None,
        };
        let (summary, sampled) = Episode::heard(scenario, Some(law), built, |_, _| sampled)
            .and_then(|episode| episode.run(interrupted))
            .map_err(|error| error.of_run(|_| index))?;
        progress(1);
        Ok((summary, sampled.finish()))
    };
    on_threads(threads, || try_map(seeds.len(), one))
}
