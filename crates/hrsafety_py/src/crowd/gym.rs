//! Environments for learners: all of them are stepped by one call, into arrays of the caller.

use numeric::error::Failure;
use numpy::{
    PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use vff_core::crowd::environments::{
    Action, Area, Autoreset, Axes, BOUND, EnvironmentSettings, Environments, Layout, Outputs,
    RANGE, Rewards, State,
};
use vff_core::crowd::metrics::ROBOT_METRICS;
use vff_core::crowd::robots::CrowdRobot;
use vff_core::robots::differential::Twist;
use vff_core::run::Request;

use crate::crowd::CrowdWorld;
use crate::errors::CoreError;
use crate::keywords::{Keywords, taken};
use crate::run::episode::request_of;
use crate::run::stepped::Stepped;
use crate::watch::{Report, here, watched};

/// Agents that are stepped without a look at signals: a tenth of a second at most.
const UNWATCHED: usize = 50_000;

/// Positions of a robot, the people, the other robots with their radii, for pictures.
type Places = (([f64; 2], f64), Vec<([f64; 2], f64)>, Vec<([f64; 2], f64)>);

/// Words for the states of an episode, the bound of observations and the range of the lidar.
#[pyfunction]
pub fn environment_words() -> (Vec<&'static str>, f64, f64) {
    (
        State::ALL.iter().map(|state| state.word()).collect(),
        BOUND,
        RANGE,
    )
}

/// Arrays that results are written to.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Arrays<'py> {
    observations: PyReadwriteArray2<'py, f32>,
    final_observations: PyReadwriteArray2<'py, f32>,
    seen: PyReadwriteArray2<'py, i64>,
    rewards: PyReadwriteArray1<'py, f64>,
    states: PyReadwriteArray1<'py, u8>,
    started: PyReadwriteArray1<'py, bool>,
    clearances: PyReadwriteArray1<'py, f64>,
    wall_rescues: PyReadwriteArray1<'py, i64>,
    metrics: PyReadwriteArray2<'py, f64>,
}

impl Arrays<'_> {
    fn outputs(&mut self) -> PyResult<Outputs<'_>> {
        Ok(Outputs {
            observations: self.observations.as_slice_mut()?,
            final_observations: self.final_observations.as_slice_mut()?,
            seen: self.seen.as_slice_mut()?.as_chunks_mut().0,
            rewards: self.rewards.as_slice_mut()?,
            states: self.states.as_slice_mut()?,
            started: self.started.as_slice_mut()?,
            clearances: self.clearances.as_slice_mut()?,
            wall_rescues: self.wall_rescues.as_slice_mut()?,
            metrics: self
                .metrics
                .as_slice_mut()?
                .as_chunks_mut::<{ ROBOT_METRICS.len() }>()
                .0,
        })
    }
}

fn settings_of(world: &CrowdWorld, given: &Keywords<'_>) -> PyResult<EnvironmentSettings> {
    let actions = [
        ("velocity", Action::Velocity),
        ("acceleration", Action::Acceleration),
        ("unicycle", Action::Unicycle),
    ];
    let axes = [("world", Axes::World), ("goal", Axes::Goal)];
    let modes = [
        ("NextStep", Autoreset::NextStep),
        ("SameStep", Autoreset::SameStep),
        ("Disabled", Autoreset::Disabled),
    ];
    let area: Option<([f64; 2], [f64; 2], bool)> = given.take("area")?;
    let circle: bool = given.take("circle")?;
    let layout = match (circle, area) {
        (true, _) => Layout::Circle,
        (false, Some((low, high, level))) => Layout::Area(Area { low, high, level }),
        (false, None) => Layout::Fixed,
    };
    let of_actions = "be \"velocity\", \"acceleration\" or \"unicycle\"";
    let of_modes = "be \"NextStep\", \"SameStep\" or \"Disabled\"";
    Ok(taken!(given: EnvironmentSettings {
        world = world.core().clone(), layout = layout,
        action = given.word("action", of_actions, &actions)?, max_acceleration,
        max_turn_rate, people, rays as lidar,
        axes = given.word("frame", "be \"world\" or \"goal\"", &axes)?,
        rewards = taken!(given: Rewards { progress, step as step_reward }),
        autoreset = given.word("autoreset_mode", of_modes, &modes)?,
        metrics,
    }))
}

const BUSY: &str = "a step of these environments is under way; step them from one place at a time";

/// Environments side by side.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct CrowdEnvironments {
    all: Stepped<Environments>,
    /// Whether a step is short.
    short: bool,
}

impl CrowdEnvironments {
    /// Works without the interpreter; long work looks at signals.
    fn work(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Environments, &(dyn Fn() -> bool + Sync)) -> Result<(), Failure> + Send,
    ) -> PyResult<()> {
        let mut guard = self.all.idle()?;
        let all: &mut Environments = &mut guard;
        if self.short {
            return Ok(py
                .detach(|| work(all, &|| false))
                .map_err(CoreError::from)?);
        }
        watched(py, Report::none(), |control| {
            work(all, &|| control.interrupted())
        })
    }
}

#[pymethods]
impl CrowdEnvironments {
    #[new]
    #[pyo3(signature = (world, count, seed, threads, **given))]
    fn new(
        py: Python<'_>,
        world: &CrowdWorld,
        count: usize,
        seed: u64,
        threads: Option<usize>,
        given: Option<Keywords<'_>>,
    ) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let settings = settings_of(world, &given)?;
        given.done()?;
        let agents = world.core().people.len() + world.core().robots.len();
        let all = here(py, Report::none(), |control| {
            Environments::new(settings, count, seed, threads, &|| control.interrupted())
        });
        Ok(Self {
            all: Stepped::new(all?, BUSY),
            short: count.saturating_mul(agents) <= UNWATCHED,
        })
    }

    /// Numbers of an observation.
    fn size(&self) -> PyResult<usize> {
        Ok(self.all.idle()?.settings().size())
    }

    /// Starts episodes, where the mask says so if there is one.
    fn reset(
        &self,
        py: Python<'_>,
        seeds: Vec<Option<u64>>,
        mask: PyReadonlyArray1<'_, bool>,
        mut arrays: Arrays<'_>,
    ) -> PyResult<()> {
        let (mask, outputs) = (mask.as_slice()?, arrays.outputs()?);
        self.work(py, |all, interrupted| {
            all.reset(&seeds, mask, outputs, interrupted)
        })
    }

    /// Steps all of them.
    fn step(
        &self,
        py: Python<'_>,
        actions: PyReadonlyArray2<'_, f64>,
        mut arrays: Arrays<'_>,
    ) -> PyResult<()> {
        debug_assert_eq!(actions.shape()[1], 2);
        let (actions, outputs) = (actions.as_slice()?.as_chunks::<2>().0, arrays.outputs()?);
        self.work(py, |all, interrupted| {
            all.step(actions, outputs, interrupted)
        })
    }

    /// Tells another robot of one of them a force in N, a velocity in m/s or a twist, until it is told something else.
    #[pyo3(signature = (index, robot, force, velocity, twist))]
    fn ask(
        &self,
        index: usize,
        robot: usize,
        force: Option<[f64; 2]>,
        velocity: Option<[f64; 2]>,
        twist: Option<[f64; 2]>,
    ) -> PyResult<()> {
        let request = match twist {
            Some([speed, turn_rate]) => Request::Twist(Twist { speed, turn_rate }),
            None => request_of(force, velocity),
        };
        self.all.idle()?.ask(index, robot, request);
        Ok(())
    }

    /// Headings of the robots of one of them in rad.
    fn headings(&self, index: usize) -> PyResult<Option<Vec<f64>>> {
        let all = self.all.idle()?;
        Ok(all.environment(index).map(|environment| {
            let robots = environment.simulation().robots().iter();
            robots.map(CrowdRobot::heading).collect()
        }))
    }

    /// Where everybody is in one of them.
    fn places(&self, index: usize) -> PyResult<Option<Places>> {
        let all = self.all.idle()?;
        let places = all.environment(index).map(|environment| {
            let simulation = environment.simulation();
            let mut robots = simulation
                .robots()
                .iter()
                .map(|robot| (robot.state().position.into(), robot.radius()));
            let people = simulation.people().iter();
            let people = people.filter(|person| person.is_present());
            let own = robots.next().unwrap_or_default();
            (
                own,
                people
                    .map(|person| (person.position.into(), person.radius))
                    .collect(),
                robots.collect(),
            )
        });
        Ok(places)
    }
}
