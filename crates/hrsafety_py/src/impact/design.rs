//! Boundaries of foam stiffness and what follows from them.

use impact_core::foam_design::{
    DesignProblem, FoamBoundary, Quantity, Requirement, stiffness_lower, stiffness_upper,
};
use numeric::error::{Failure, Result};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arrays::fields;
use crate::errors::CoreError;
use crate::impact::parameters::{Foam, Manipulator, Target};
use crate::watch::watched_each;

/// Quantities in the order of Python's limits.
const QUANTITIES: [Quantity; 6] = [
    Quantity::HeadAcceleration,
    Quantity::ContactForce,
    Quantity::Injury15,
    Quantity::Injury36,
    Quantity::Compression,
    Quantity::ContactCompression,
];

fn requirements(given: Vec<(String, f64, Target)>) -> PyResult<Vec<Requirement>> {
    given
        .into_iter()
        .map(|(word, limit, head)| {
            let known = QUANTITIES.into_iter().find(|known| known.word() == word);
            let quantity = known.ok_or_else(|| {
                let given = numeric::error::Given::Word(word);
                CoreError::from(Failure::invalid("limits", "have known names", given))
            })?;
            Ok(Requirement {
                quantity,
                limit,
                head: head.0,
            })
        })
        .collect()
}

fn design_problem(
    manipulator: &Manipulator,
    closing_speed: f64,
    horizon: Option<f64>,
) -> DesignProblem {
    DesignProblem {
        horizon,
        ..DesignProblem::new(manipulator.0, closing_speed)
    }
}

/// Upper or lower boundary at each damping.
#[pyfunction]
#[pyo3(signature = (manipulator, limits, damping, *, closing_speed, horizon, upper))]
pub fn foam_boundary<'py>(
    py: Python<'py>,
    manipulator: &Manipulator,
    limits: Vec<(String, f64, Target)>,
    damping: PyReadonlyArray1<'py, f64>,
    closing_speed: f64,
    horizon: Option<f64>,
    upper: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let limits = requirements(limits)?;
    let problem = design_problem(manipulator, closing_speed, horizon);
    let find = |damping: f64| -> Result<FoamBoundary> {
        if upper {
            stiffness_upper(&problem, &limits, damping)
        } else {
            stiffness_lower(&problem, &limits, damping)
        }
    };
    let found = watched_each(py, damping.as_slice()?, find)?;
    let stiffness = found.iter().map(|boundary| boundary.stiffness).collect();
    let words: Vec<&str> = found.iter().map(|each| each.status.word()).collect();
    let binding: Vec<&str> = found
        .iter()
        .map(|each| {
            let mut all = each.crossings.iter();
            let chosen = all.find(|crossing| crossing.stiffness == each.stiffness);
            chosen.map_or("", |crossing| crossing.quantity.word())
        })
        .collect();
    let places = found.iter().map(|each| {
        let places: Vec<f64> = each.crossings.iter().map(|each| each.stiffness).collect();
        places.into_pyarray(py)
    });
    let kinds: Vec<Vec<&str>> = found
        .iter()
        .map(|each| {
            each.crossings
                .iter()
                .map(|each| each.status.word())
                .collect()
        })
        .collect();
    Ok(fields! { py;
        vector stiffness = stiffness;
        value status = words;
        value limited_by = binding;
        value crossings = PyList::new(py, places)?.to_tuple();
        value crossing_status = kinds;
        each found: holds_below, holds_above;
    })
}

/// Ratio of each quantity to its limit for a foam.
#[pyfunction]
#[pyo3(signature = (manipulator, limits, foam, *, closing_speed, horizon))]
pub fn foam_ratios(
    manipulator: &Manipulator,
    limits: Vec<(String, f64, Target)>,
    foam: &Foam,
    closing_speed: f64,
    horizon: Option<f64>,
) -> PyResult<Vec<f64>> {
    let limits = requirements(limits)?;
    let problem = design_problem(manipulator, closing_speed, horizon);
    Ok(problem.ratios(&limits, &foam.0).map_err(CoreError::from)?)
}

/// Largest closing speed at each damping, and the stiffness that allows it.
#[pyfunction]
#[pyo3(signature = (manipulator, limits, damping, *, closing_speed, horizon))]
pub fn foam_fastest<'py>(
    py: Python<'py>,
    manipulator: &Manipulator,
    limits: Vec<(String, f64, Target)>,
    damping: PyReadonlyArray1<'py, f64>,
    closing_speed: f64,
    horizon: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let limits = requirements(limits)?;
    let problem = design_problem(manipulator, closing_speed, horizon);
    let find = |damping: f64| problem.fastest(&limits, damping);
    let found = watched_each(py, damping.as_slice()?, find)?;
    Ok(fields! { py; each found: closing_speed, stiffness; })
}
