//! Many scenarios at once: from arrays, drawn at random, or as a list.

use std::ops::Deref;
use std::slice;
use std::sync::Arc;

use numeric::error::{Result, proceed};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use vff_core::world::arrays::SceneArrays;
use vff_core::world::random_scenes::{random_crowd, random_traffic};
use vff_core::world::scenario::{self, Mover, Rules};

use crate::errors::CoreError;
use crate::parameters::{HolonomicRobot, Scenario, mover_of, outline_of};
use crate::watch::{Report, here};

/// Scenarios that crossed the boundary once.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Scenarios(Arc<Vec<scenario::Scenario>>);

#[pymethods]
impl Scenarios {
    /// Rows of discs that move straight on: start, goal; position, velocity and radius; whether they
    /// are people; robot; rules; seeds.
    #[new]
    fn new(
        ends: (PyReadonlyArray2<'_, f64>, PyReadonlyArray2<'_, f64>),
        obstacles: (
            PyReadonlyArray3<'_, f64>,
            PyReadonlyArray3<'_, f64>,
            PyReadonlyArray2<'_, f64>,
        ),
        person: bool,
        robot: &Bound<'_, PyAny>,
        rules: (f64, f64, f64, f64, f64),
        seed: PyReadonlyArray1<'_, u64>,
    ) -> PyResult<Self> {
        let (control_period, time_limit, arrival_tolerance, heading, rest_time) = rules;
        let arrays = SceneArrays {
            start: ends.0.as_slice()?.as_chunks().0,
            goal: ends.1.as_slice()?.as_chunks().0,
            position: obstacles.0.as_slice()?.as_chunks().0,
            velocity: obstacles.1.as_slice()?.as_chunks().0,
            radius: obstacles.2.as_slice()?,
            person,
            robot: mover_of(robot)?,
            rules: Rules {
                control_period,
                time_limit,
                arrival_tolerance,
                rest_time,
                heading,
            },
            seed: seed.as_slice()?,
        };
        let made = robot.py().detach(|| arrays.scenarios());
        let made = made.map_err(CoreError::from)?;
        let shaped = made.into_iter().map(|scenario| scenario::Scenario {
            footprint: outline_of(robot),
            ..scenario
        });
        Ok(Self(Arc::new(shaped.collect())))
    }

    /// Random traffic of a number of obstacles for each seed.
    #[staticmethod]
    fn random_traffic(
        py: Python<'_>,
        obstacles: usize,
        robot: PyRef<'_, HolonomicRobot>,
        seeds: Vec<u64>,
    ) -> PyResult<Self> {
        let robot = robot.0;
        drawn(py, &seeds, |seed| random_traffic(obstacles, robot, seed))
    }

    /// Random crowd of a number of people for each seed.
    #[staticmethod]
    fn random_crowd(people: usize, robot: &Bound<'_, PyAny>, seeds: Vec<u64>) -> PyResult<Self> {
        let mover: Mover = mover_of(robot)?;
        drawn(robot.py(), &seeds, |seed| random_crowd(people, mover, seed))
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    /// The scenario of a row.
    fn row(&self, index: usize) -> PyResult<Scenario> {
        let found = self.0.get(index).cloned();
        found
            .map(Scenario)
            .ok_or_else(|| PyIndexError::new_err(index))
    }

    /// The scenarios of some rows.
    fn rows(&self, indices: Vec<usize>) -> PyResult<Self> {
        let row = |index: usize| {
            let found = self.0.get(index).cloned();
            found.ok_or_else(|| PyIndexError::new_err(index))
        };
        let rows = indices.into_iter().map(row).collect::<PyResult<_>>()?;
        Ok(Self(Arc::new(rows)))
    }

    /// Every scenario with each of the seeds, those of a scenario together.
    fn reseeded(&self, seeds: Vec<u64>) -> Self {
        let with_all = |scenario: &scenario::Scenario| {
            let scenario = scenario.clone();
            seeds
                .clone()
                .into_iter()
                .map(move |seed| scenario.clone().reseeded(seed))
        };
        Self(Arc::new(self.0.iter().flat_map(with_all).collect()))
    }

    /// Seed of every scenario.
    fn seeds(&self) -> Vec<u64> {
        self.0.iter().map(scenario::Scenario::seed).collect()
    }
}

/// One scenario for each seed; signals are answered in between.
fn drawn(
    py: Python<'_>,
    seeds: &[u64],
    draw: impl Fn(u64) -> Result<scenario::Scenario> + Send + Sync,
) -> PyResult<Scenarios> {
    let made = here(py, Report::none(), |control| {
        let one = |seed: &u64| {
            proceed(&|| control.interrupted())?;
            draw(*seed)
        };
        seeds.iter().map(one).collect::<Result<_>>()
    });
    Ok(Scenarios(Arc::new(made?)))
}

/// Scenarios as a function takes them: those of one object, or a list.
pub enum Scenes {
    /// Shared with the object.
    Kept(Arc<Vec<scenario::Scenario>>),
    /// The only one of a list, where it stands: a copy of a thousand obstacles takes a tenth of a run.
    One(Py<Scenario>),
    /// Copied from a list.
    Listed(Vec<scenario::Scenario>),
}

impl<'a, 'py> FromPyObject<'a, 'py> for Scenes {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(kept) = given.cast::<Scenarios>() {
            return Ok(Self::Kept(Arc::clone(&kept.get().0)));
        }
        let mut listed: Vec<PyRef<'py, Scenario>> = given.extract()?;
        if listed.len() == 1 {
            return Ok(Self::One(listed.remove(0).into()));
        }
        let scenarios = listed.iter().map(|scenario| scenario.0.clone());
        Ok(Self::Listed(scenarios.collect()))
    }
}

impl Deref for Scenes {
    type Target = [scenario::Scenario];

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Kept(scenarios) => scenarios,
            Self::One(scenario) => slice::from_ref(&scenario.get().0),
            Self::Listed(scenarios) => scenarios,
        }
    }
}
