//! Laws of any kind whose gain sets can be run.

use std::marker::PhantomData;
use std::sync::Arc;

use crate::error::{Failure, Result};
use crate::laws::{BoxedLaw, Command, FieldTerms, Law, LawFamily, Situation};
use crate::run::Interrupted;
use crate::run::lanes::group::{Group, Keep, Known, SceneGroup};
use crate::run::lanes::kernels::{Kernels, One};
use crate::run::options::Options;
use crate::run::outcome::RunSummary;
use crate::run::plan::Plan;
use crate::run::record::{DescentCounter, Recorder, Trajectory, TrajectoryRecorder};
use crate::run::rollout::{Member, run_team};
use crate::run::walls::Maps;
use crate::world::map::StaticMap;
use crate::world::scenario::Scenario;

/// A law of any kind up to its gains.
///
/// The kernels of a law are compiled where it is turned into this, that is in this crate, or for
/// laws of other crates there.
#[derive(Clone)]
pub struct AnyLaw(Arc<dyn ErasedLaw>);

impl From<&AnyLaw> for AnyLaw {
    fn from(law: &AnyLaw) -> Self {
        law.clone()
    }
}

impl AnyLaw {
    /// A law of another crate, whose gain sets run one after the other.
    #[must_use]
    pub fn one_by_one<F: LawFamily + Send + 'static>(law: F) -> Self {
        Self::with_kernels::<_, One>(law)
    }

    pub(crate) fn with_kernels<F: LawFamily + Send + 'static, K: Kernels<F>>(law: F) -> Self {
        Self(Arc::new(Driver::<F, K>(law, PhantomData)))
    }

    pub(crate) fn erased(&self) -> &dyn ErasedLaw {
        &*self.0
    }

    /// Returns nothing if the law can reach the goal of a scenario.
    ///
    /// # Errors
    /// It keeps to regions, and the goal lies in the active region of an obstacle that stands.
    pub(crate) fn suits(&self, scenario: &Scenario) -> Result<()> {
        if self.0.takes_any_goal() {
            return Ok(());
        }
        scenario.with_free_goal()
    }

    /// What it knows to stand, beside the obstacles of a scenario.
    pub(crate) fn map(&self) -> Option<&StaticMap> {
        self.0.map()
    }

    /// Words for the gains, in their order.
    #[must_use]
    pub fn gain_names(&self) -> &'static [&'static str] {
        self.0.gain_names()
    }

    /// The gains, in that order.
    #[must_use]
    pub fn gains(&self) -> Vec<f64> {
        self.0.gains()
    }

    /// Returns the law if its gains are allowed.
    ///
    /// # Errors
    /// Names the gain that is not.
    pub fn checked(self) -> Result<Self> {
        self.0.check_gains(&self.0.gains())?;
        Ok(self)
    }
}

/// A law whose gain sets can be run.
pub(crate) trait ErasedLaw: Send + Sync {
    /// Words for the gains, in their order.
    fn gain_names(&self) -> &'static [&'static str];
    /// Its own gains, in that order.
    fn gains(&self) -> Vec<f64>;
    /// Gains that act on a robot without obstacles, ascending.
    fn free_gains(&self) -> &'static [usize];
    /// Returns the gains if the law allows them.
    fn check_gains(&self, gains: &[f64]) -> Result<()>;
    /// Runs gain sets and hands every run over.
    fn run(&self, group: &Group<'_>, keep: Keep<'_>) -> Result<()>;
    /// Whether it can run scenes side by side, and with how many obstacles each it pays.
    fn takes_scenes(&self) -> bool;
    fn most_obstacles(&self) -> usize;
    /// Runs scenes that agree in robot and rules, and hands every run over.
    fn run_scenes(&self, group: &SceneGroup<'_>, keep: Keep<'_>) -> Result<()>;
    /// Every force term with its own gains; `None` for laws that are no sum of terms.
    fn terms(&self, scenario: &Scenario, situation: &Situation<'_, f64>) -> Option<FieldTerms>;
    /// Whether it chooses a velocity, and so knows no regions.
    fn chooses_velocities(&self) -> bool;
    /// Whether it can reach a goal in the active region of an obstacle that stands.
    fn takes_any_goal(&self) -> bool;
    /// Whether it steers a robot with two wheels by velocities.
    fn steers_by_velocity(&self) -> bool;
    /// What it knows to stand, beside the obstacles of a scenario.
    fn map(&self) -> Option<&StaticMap>;
    /// It at work in a scenario, with its own gains, to be asked once a control period.
    fn steering(&self, scenario: &Scenario) -> Result<BoxedLaw> {
        self.steering_with(&self.gains(), scenario, true)
    }
    /// The same with other gains; `record`: the Lyapunov function is wanted too.
    fn steering_with(&self, gains: &[f64], scenario: &Scenario, record: bool) -> Result<BoxedLaw>;
}

impl dyn ErasedLaw + '_ {
    /// Runs gain sets one after the other. `record`: the Lyapunov function is wanted too.
    fn one_by_one<C: Recorder<f64> + Default>(
        &self,
        group: &Group<'_>,
        record: bool,
        keep: Keep<'_>,
    ) -> Result<()> {
        let known = Known {
            dimension: self.gain_names().len(),
            free_gains: self.free_gains(),
            map: self.map(),
        };
        let mut team = Vec::with_capacity(group.points.len() / known.dimension);
        for gains in group.points.chunks_exact(known.dimension) {
            team.push(Member {
                law: self.steering_with(gains, group.scenario, record)?,
                recorder: C::default(),
            });
        }
        group.run(&mut team, &known, keep)
    }

    /// What it asks for at first, with its own gains.
    pub fn command(
        &self,
        scenario: &Scenario,
        situation: &Situation<'_, f64>,
    ) -> Result<Command<f64>> {
        let mut law = self.steering_with(&self.gains(), scenario, false)?;
        Ok(law.command(situation))
    }

    /// One run with its own gains and everything recorded.
    pub fn record(
        &self,
        scenario: &Scenario,
        options: &Options,
        interrupted: Interrupted<'_>,
    ) -> Result<(RunSummary, Trajectory)> {
        let mut team = [Member {
            law: self.steering(scenario)?,
            recorder: TrajectoryRecorder::keeping(options.kept, scenario),
        }];
        let mut summary = None;
        run_team(
            scenario,
            (&mut team, false),
            (&Plan::single(*options), &Maps::of_law(scenario, self.map())),
            interrupted,
            |_, runs, lane, recorder| summary = Some(runs.summary(lane, recorder)),
        )?;
        let [member] = team;
        let summary = summary.ok_or(Failure::Interrupted)?;
        Ok((summary, member.recorder.finish()))
    }
}

/// A law and the kernels that are compiled for it.
struct Driver<F, K>(F, PhantomData<fn() -> K>);

impl<F: LawFamily + Send, K: Kernels<F>> ErasedLaw for Driver<F, K> {
    fn gain_names(&self) -> &'static [&'static str] {
        self.0.gain_names()
    }

    fn gains(&self) -> Vec<f64> {
        self.0.gains()
    }

    fn free_gains(&self) -> &'static [usize] {
        self.0.free_gains()
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        self.0.check_gains(gains)
    }

    fn run(&self, group: &Group<'_>, keep: Keep<'_>) -> Result<()> {
        if (group.interrupted)() {
            return Err(Failure::Interrupted);
        }
        let exact = group.scenario.measurement.is_none();
        let plan = Plan {
            shortcuts: group.plan.shortcuts && exact && self.0.keeps_to_regions(),
            ..*group.plan
        };
        let group = &Group {
            plan: &plan,
            ..*group
        };
        let erased: &dyn ErasedLaw = self;
        match plan.lanes().filter(|_| K::LANES) {
            Some(lanes) => K::run_lanes(&self.0, group, lanes, keep),
            None if plan.descent && K::LYAPUNOV => {
                erased.one_by_one::<DescentCounter<f64>>(group, true, keep)
            }
            None => erased.one_by_one::<()>(group, false, keep),
        }
    }

    fn takes_scenes(&self) -> bool {
        K::SCENES
    }

    fn most_obstacles(&self) -> usize {
        K::MOST_OBSTACLES
    }

    fn run_scenes(&self, group: &SceneGroup<'_>, keep: Keep<'_>) -> Result<()> {
        if (group.interrupted)() {
            return Err(Failure::Interrupted);
        }
        K::run_scenes(&self.0, group, keep)
    }

    fn terms(&self, scenario: &Scenario, situation: &Situation<'_, f64>) -> Option<FieldTerms> {
        self.0.terms(scenario, situation)
    }

    fn chooses_velocities(&self) -> bool {
        self.0.chooses_velocities()
    }

    fn takes_any_goal(&self) -> bool {
        self.0.takes_any_goal()
    }

    fn steers_by_velocity(&self) -> bool {
        self.0.steers_by_velocity()
    }

    fn map(&self) -> Option<&StaticMap> {
        self.0.map()
    }

    fn steering_with(&self, gains: &[f64], scenario: &Scenario, record: bool) -> Result<BoxedLaw> {
        Ok(if record {
            Box::new(self.0.with_gains::<f64, true>(gains, scenario)?)
        } else {
            Box::new(self.0.with_gains::<f64, false>(gains, scenario)?)
        })
    }
}
