//! Loads of one impact.

use impact_core::criteria;
use impact_core::gradients::{PARAMETER_NAMES, PARAMETERS, gradients};
use impact_core::metrics::{CRITERIA, Criterion, MetricOptions, Metrics};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyString, PyTuple};

use crate::errors::CoreError;
use crate::impact::parameters::{Foam, Manipulator, Target, system};

/// Numbers, status and whether the foam leaves its linear range.
#[pyfunction]
pub fn impact_metrics<'py>(
    py: Python<'py>,
    manipulator: &Manipulator,
    foam: &Foam,
    head: Target,
    closing_speed: f64,
    manipulator_speed: Option<f64>,
    horizon: Option<f64>,
) -> PyResult<Bound<'py, PyTuple>> {
    let options = MetricOptions {
        manipulator_speed,
        horizon,
        ..MetricOptions::default()
    };
    let row = criteria::metrics(&system(manipulator, foam, &head), closing_speed, &options)
        .map_err(CoreError::from)?;
    row_tuple(py, &row, foam.0.linear_range)
}

/// A row in the order of Python's `ImpactMetrics`.
pub fn row_tuple<'py>(
    py: Python<'py>,
    row: &Metrics,
    linear_range: f64,
) -> PyResult<Bound<'py, PyTuple>> {
    let loads = row.loads.into_array();
    let numbers = loads.map(|value| PyFloat::new(py, value).into_any());
    let status = PyString::intern(py, row.status.word()).into_any();
    let beyond = row.max_compression > linear_range;
    let beyond = PyBool::new(py, beyond).to_owned().into_any();
    let mut values = Vec::with_capacity(numbers.len() + 2);
    values.extend(numbers);
    values.extend([status, beyond]);
    PyTuple::new(py, values)
}

/// Facts about a criterion: name, label, unit, symbol, whether peaks alone give it.
type Known = (&'static str, &'static str, &'static str, &'static str, bool);

/// The criteria, in the order of rows.
#[pyfunction]
pub fn impact_criteria() -> Vec<Known> {
    let known = |each: Criterion| (each.name, each.label, each.unit, each.symbol, each.is_peak);
    CRITERIA.map(known).to_vec()
}

/// Names of the columns of the derivatives.
#[pyfunction]
pub fn impact_parameter_names() -> Vec<&'static str> {
    PARAMETER_NAMES.to_vec()
}

/// The row of metrics and the matrix of their derivatives.
#[pyfunction]
#[allow(clippy::type_complexity)] // a pair
pub fn impact_gradients<'py>(
    py: Python<'py>,
    manipulator: &Manipulator,
    foam: &Foam,
    head: Target,
    closing_speed: f64,
    manipulator_speed: Option<f64>,
    horizon: Option<f64>,
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyArray2<f64>>)> {
    let options = MetricOptions {
        manipulator_speed,
        horizon,
        ..MetricOptions::default()
    };
    let system = system(manipulator, foam, &head);
    let found = gradients(&system, closing_speed, &options).map_err(CoreError::from)?;
    let values: Vec<f64> = found.values.into_array().into_iter().flatten().collect();
    let matrix = values
        .into_pyarray(py)
        .reshape([CRITERIA.len(), PARAMETERS])?;
    let row = row_tuple(py, &found.metrics, foam.0.linear_range)?;
    Ok((row, matrix))
}
