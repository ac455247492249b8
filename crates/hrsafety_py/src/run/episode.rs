//! A run that Python steps.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::{Episode, Navigation, Outcome, Request};

use crate::errors::CoreError;
use crate::laws::Law;
use crate::parameters::Scenario;
use crate::robots::as_built::{AsBuilt, as_built_fields};
use crate::run::situation::situation_fields;
use crate::run::stepped::Stepped;
use crate::run::trajectory_fields;

/// Wanted and commanded velocity, whether the law was taken over from, and the status.
type Told = ([f64; 2], [f64; 2], bool, &'static str);

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

    /// Fields of what the controller sees.
    fn situation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        situation_fields(py, &self.0.idle()?.situation())
    }

    /// One control period under the law, a force in N or a velocity in m/s.
    #[pyo3(signature = (*, force, velocity))]
    fn step(
        &self,
        py: Python<'_>,
        force: Option<[f64; 2]>,
        velocity: Option<[f64; 2]>,
    ) -> PyResult<()> {
        let request = match (force, velocity) {
            (Some(force), _) => Request::Force(force),
            (None, Some(velocity)) => Request::Velocity(velocity),
            (None, None) => Request::Law,
        };
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
    #[getter]
    fn trace(&self) -> PyResult<Option<Told>> {
        let trace = self.0.idle()?.trace();
        Ok(trace.map(|trace| {
            let word = trace.status.word();
            (
                trace.wanted.into(),
                trace.command.into(),
                trace.taken_over,
                word,
            )
        }))
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
