//! Laws of any kind whose gain sets can be run.

use std::ops::Deref;
use std::sync::Arc;

use crate::run::Interrupted;
use crate::run::lanes::group::{Group, Keep, LaneKernel, RunJob};
use crate::run::lanes::kernel::{LawInLanes, run_lanes};
use crate::run::lanes::scenes::LaneScenes;
use crate::run::options::Options;
use crate::run::outcome::RunSummary;
use crate::run::plan::{RunPlan, key_of};
use crate::run::record::{DescentCounter, Recorder, Trajectory, TrajectoryRecorder};
use crate::run::runs::LaneState;
use crate::run::scene::bodies_at;
use crate::run::walls::Maps;
use navigation_laws::{LaneFamily, Law, LawFamily};
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Result};
use numeric::lanes::Vectors;

/// Fewest runs for which lanes pay.
const FEWEST_IN_LANES: usize = 3;

/// A law of any kind up to its gains.
#[derive(Clone)]
pub struct AnyLaw {
    family: Arc<dyn LawFamily>,
    /// Its kernel, if its runs are made side by side.
    lanes: Option<Arc<dyn LaneKernel>>,
}

impl From<&AnyLaw> for AnyLaw {
    fn from(law: &AnyLaw) -> Self {
        law.clone()
    }
}

impl From<AnyLaw> for Arc<dyn LawFamily> {
    fn from(law: AnyLaw) -> Self {
        law.family
    }
}

impl Deref for AnyLaw {
    type Target = dyn LawFamily;

    fn deref(&self) -> &Self::Target {
        &*self.family
    }
}

impl AnyLaw {
    /// A law whose runs are made one after the other.
    #[must_use]
    pub fn one_by_one<F: LawFamily + 'static>(law: F) -> Self {
        Self {
            family: Arc::new(law),
            lanes: None,
        }
    }

    /// A law whose runs are made side by side, in lanes that are compiled for it.
    #[must_use]
    pub fn side_by_side<F: LaneFamily + 'static>(law: F) -> Self {
        let family = Arc::new(law);
        Self {
            lanes: Some(family.clone()),
            family,
        }
    }

    /// Returns nothing if the law can reach the goal of a scenario.
    ///
    /// # Errors
    /// It keeps to regions, and the goal lies in the active region of an obstacle that stands.
    pub(crate) fn suits(&self, scenario: &Scenario) -> Result<()> {
        if self.takes_any_goal() {
            return Ok(());
        }
        scenario.with_free_goal()
    }

    /// Returns the law if its gains are allowed.
    ///
    /// # Errors
    /// Names the gain that is not.
    pub fn checked(self) -> Result<Self> {
        self.check_gains(&self.gains())?;
        Ok(self)
    }

    /// It at work in a scenario, with its own gains, to be asked once a control period.
    pub(crate) fn with_own_gains(&self, scenario: &Scenario) -> Result<Box<dyn Law<f64>>> {
        self.at_work(&self.gains(), scenario, true)
    }

    /// Its lanes, where the plan and the number of runs of a group ask for them.
    pub(crate) fn lanes_for(
        &self,
        plan: &RunPlan,
        runs: usize,
    ) -> Option<(&dyn LaneKernel, Vectors)> {
        let lanes = self.lanes.as_deref()?;
        Some((lanes, plan.vectors()?)).filter(|_| runs >= FEWEST_IN_LANES)
    }

    /// Makes the runs of a group, and hands every one over.
    pub(crate) fn run(&self, group: &Group<'_>, keep: Keep<'_>) -> Result<()> {
        if (group.interrupted)() {
            return Err(Failure::Interrupted);
        }
        let exact = |job: &RunJob<'_>| job.scenario.measurement.is_none();
        let shortcuts = self.keeps_to_regions() && group.jobs.iter().all(exact);
        let plan = &RunPlan {
            shortcuts: shortcuts && group.plan.shortcuts,
            ..*group.plan
        };
        let lanes = self.lanes_for(plan, group.jobs.len());
        if let (Some((lanes, vectors)), Some(first)) = (lanes, group.jobs.first())
            && group
                .jobs
                .iter()
                .all(|job| lanes.pay(job) && lanes.fit(first, job))
        {
            let led = plan.shortcuts && self.are_alike(group.jobs);
            let group = Group {
                plan,
                led,
                ..*group
            };
            let maps = Maps::of_law(first.scenario, self.map());
            return lanes.run(&group, &maps, vectors, keep);
        }
        let descent = plan.descent && self.lanes.as_ref().is_some_and(|own| own.has_lyapunov());
        for (index, job) in group.jobs.iter().enumerate() {
            let jobs = std::slice::from_ref(job);
            let group = Group {
                jobs,
                plan,
                ..*group
            };
            let done = if descent {
                self.alone(
                    &group,
                    true,
                    DescentCounter::<f64>::default(),
                    (index, keep),
                )
            } else {
                self.alone(&group, false, (), (index, keep))
            };
            done.map_err(|error| error.of_run(|_| index))?;
        }
        Ok(())
    }

    /// Whether runs are in one scenario, with gains that differ only in those that act near obstacles.
    fn are_alike(&self, jobs: &[RunJob<'_>]) -> bool {
        let key = |job: &RunJob<'_>| key_of(self.free_gains(), job.gains);
        jobs.iter()
            .all(|job| std::ptr::eq(job.scenario, jobs[0].scenario) && key(job) == key(&jobs[0]))
    }

    /// Makes the only run of a group.
    fn alone<C: Recorder<f64>>(
        &self,
        group: &Group<'_>,
        record: bool,
        mut recorder: C,
        (index, keep): (usize, Keep<'_>),
    ) -> Result<()> {
        let mut hand_over = |runs: &LaneState<LaneScenes<'_>, f64>, recorder: &mut C| {
            let totals = runs.totals(0, recorder);
            keep(index, &totals, &|obstacle| runs.min_distance(obstacle, 0));
        };
        self.step_alone(group, record, &mut recorder, &mut hand_over)
    }

    fn step_alone<C: Recorder<f64>>(
        &self,
        group: &Group<'_>,
        record: bool,
        recorder: &mut C,
        hand_over: &mut dyn FnMut(&LaneState<LaneScenes<'_>, f64>, &mut C),
    ) -> Result<()> {
        let mut enter =
            |law: &mut Option<Box<dyn Law<f64>>>, _: usize, gains: &[f64], scenario: &Scenario| {
                *law = Some(self.at_work(gains, scenario, record)?);
                Ok(())
            };
        let maps = group.jobs.first();
        let maps = maps.map(|job| Maps::of_law(job.scenario, self.map()));
        let law = LawInLanes {
            enter: &mut enter,
            told_of_all: |_: &(dyn Law<f64> + 'static)| true,
        };
        let maps = maps.unwrap_or_default();
        run_lanes(group, &maps, law, recorder, |_, runs, _, recorder| {
            hand_over(runs, recorder);
        })
    }

    /// One run with its own gains and everything recorded.
    pub(crate) fn record(
        &self,
        scenario: &Scenario,
        options: &Options,
        interrupted: Interrupted<'_>,
    ) -> Result<(RunSummary, Trajectory)> {
        let gains = &self.gains();
        let group = Group {
            jobs: &[RunJob { scenario, gains }],
            plan: &RunPlan::single(*options),
            led: false,
            interrupted,
        };
        let mut recorder = TrajectoryRecorder::keeping(options.kept, scenario);
        let mut summary = None;
        self.step_alone(&group, true, &mut recorder, &mut |runs, recorder| {
            let end = runs.first_end();
            let (position, velocity) = (runs.position, runs.velocity);
            let bodies = bodies_at(scenario, end);
            recorder.end(end, position, velocity, &runs.currents, &bodies);
            summary = Some(runs.summary(0, recorder));
        })?;
        Ok((summary.ok_or(Failure::Interrupted)?, recorder.finish()))
    }
}
