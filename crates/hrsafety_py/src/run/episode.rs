//! A run that Python steps.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::laws::trace::{Examined, Trace};
use vff_core::run::{Episode, Navigation, Outcome, Request};

use crate::errors::CoreError;
use crate::laws::Law;
use crate::parameters::Scenario;
use crate::python_law::{PointMass, point_mass};
use crate::robots::as_built::{AsBuilt, as_built_fields};
use crate::run::situation::situation_fields;
use crate::run::stepped::Stepped;
use crate::run::trajectory_fields;
use crate::unknown::{Explored, explored};

/// Wanted and commanded velocity, whether the law was taken over from, and the status.
pub type Told = ([f64; 2], [f64; 2], bool, &'static str);

/// Number of a person, and places in m.
type PersonWay = (usize, Vec<[f64; 2]>);

/// Length of a stage in s, places of the robot at their ends, those of people, and the number of stages.
type Expected = (f64, Vec<[f64; 2]>, Vec<PersonWay>, usize);

/// Margin in m, instants in s and places in m of a plan, how far others can have come at its end, in m, and what
/// foresight expects.
pub type Verified = (f64, Vec<f64>, Vec<[f64; 2]>, Vec<f64>, Option<Expected>);

/// Number of a robot, and a force in N or a velocity in m/s that it is told.
pub type Order = (usize, Option<[f64; 2]>, Option<[f64; 2]>);

/// What was recorded of the parts around a law.
pub fn told(trace: &Trace) -> Told {
    let word = trace.status.word();
    (
        trace.wanted.into(),
        trace.command.into(),
        trace.taken_over,
        word,
    )
}

/// The plan that a shield verified.
pub fn verified(found: Examined) -> Verified {
    let foreseen = found.foreseen.map(|foreseen| {
        let (step, stages) = (foreseen.step, foreseen.stages);
        (step, foreseen.way, foreseen.people, stages)
    });
    (
        found.margin,
        found.time,
        found.position,
        found.reach,
        foreseen,
    )
}

/// A force in N or a velocity in m/s as a request; the law where there is neither.
pub fn request_of(force: Option<[f64; 2]>, velocity: Option<[f64; 2]>) -> Request {
    match (force, velocity) {
        (Some(force), _) => Request::Force(force),
        (None, Some(velocity)) => Request::Velocity(velocity),
        (None, None) => Request::Law,
    }
}

/// Error message of a run that is being stepped.
pub const BUSY: &str = "a step of this run is under way; step it from one place at a time";

/// A run under way.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Run(Stepped<Episode<Navigation>>);

#[pymethods]
impl Run {
    #[new]
    #[pyo3(signature = (scenario, law, built, *, step, stop_on_contact))]
    fn new(
        scenario: &Scenario,
        law: Option<&Law>,
        built: &AsBuilt,
        step: f64,
        stop_on_contact: bool,
    ) -> PyResult<Self> {
        let built = built.run(step, stop_on_contact);
        let scenario = Arc::new(scenario.0.clone());
        let episode = Episode::new(scenario, law.map(|law| &law.any), &built);
        Ok(Self(Stepped::new(episode.map_err(CoreError::from)?, BUSY)))
    }

    // Robots have numbers, as in `WorldRun`; the only one is 0.

    /// The point mass that the law drives.
    fn point_mass(&self, _robot: usize) -> PyResult<PointMass> {
        Ok(point_mass(self.0.idle()?.scenario().point_mass()))
    }

    /// Fields of what the controller sees.
    fn situation<'py>(&self, py: Python<'py>, _robot: usize) -> PyResult<Bound<'py, PyDict>> {
        situation_fields(py, &self.0.idle()?.situation())
    }

    /// One control period under the law, or with a force in N or a velocity in m/s.
    fn step(&self, py: Python<'_>, told: Vec<Order>) -> PyResult<()> {
        let order = told.into_iter().next();
        let request = order.map_or(Request::Law, |(_, force, velocity)| {
            request_of(force, velocity)
        });
        self.0.work(py, |episode, interrupted| {
            episode.period(request, interrupted)
        })
    }

    /// Present time in s, or when the run ended.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.0.idle()?.time())
    }

    /// Wanted and commanded velocity of the last control period, whether the law was taken over from,
    /// and the status, if the law has parts around it.
    fn trace(&self, _robot: usize) -> PyResult<Option<Told>> {
        Ok(self.0.idle()?.trace().as_ref().map(told))
    }

    /// Centers in m of the cells where the law reckons with people whom it does not see, if it does.
    fn unseen_places(&self, _robot: usize) -> PyResult<Option<Vec<[f64; 2]>>> {
        Ok(self.0.idle()?.unseen_places())
    }

    /// What the law knows of the place from scans, with the way from a place on, if it makes its own map.
    fn explored<'py>(
        &self,
        py: Python<'py>,
        _robot: usize,
        place: [f64; 2],
    ) -> PyResult<Option<Explored<'py>>> {
        explored(py, self.0.idle()?.explored(), place)
    }

    /// Plan that the shield verified last, if there is one.
    fn examined(&self, _robot: usize) -> PyResult<Option<Verified>> {
        Ok(self.0.idle()?.examined().map(verified))
    }

    /// Column of each obstacle that the controller sees.
    fn people(&self, _robot: usize) -> PyResult<Vec<Option<usize>>> {
        let seen = self.0.idle()?.situation().bodies.len();
        Ok((0..seen).map(Some).collect())
    }

    /// Whether it has ended.
    #[getter]
    fn finished(&self) -> PyResult<bool> {
        Ok(self.0.idle()?.finished())
    }

    /// Whether the robot decides in the next step.
    fn deciding(&self) -> PyResult<Vec<bool>> {
        Ok(vec![!self.0.idle()?.finished()])
    }

    /// The word for how it ended, if it has.
    #[getter]
    fn outcome(&self) -> PyResult<Option<&'static str>> {
        Ok(self.0.idle()?.outcome().map(Outcome::word))
    }

    /// Fields of the trajectory so far; `motors`: with what motors and controller know.
    #[pyo3(signature = (*, motors))]
    fn recorded<'py>(&self, py: Python<'py>, motors: bool) -> PyResult<Bound<'py, PyDict>> {
        let episode = self.0.idle()?;
        let (summary, columns) = episode.recorded();
        let scenario = episode.scenario();
        let fields = if motors {
            as_built_fields(py, scenario, summary, columns)?
        } else {
            trajectory_fields(py, scenario, summary, columns.motion)?
        };
        if !episode.finished() {
            fields.set_item("outcome", "running")?;
        }
        Ok(fields)
    }
}
