//! Loads of one impact.

use impact_core::criteria::{self, MetricOptions, Metrics};
use impact_core::gradients::{METRIC_NAMES, METRICS, PARAMETER_NAMES, PARAMETERS, gradients};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyString, PyTuple};

use crate::errors::CoreError;
use crate::impact::parameters::{Foam, Manipulator, Target, system};

fn numbers(row: &Metrics) -> [f64; 12] {
    [
        row.peak_head_acceleration,
        row.peak_head_acceleration_g,
        row.mean_head_acceleration_g,
        row.peak_contact_force,
        row.max_compression,
        row.impact_duration,
        row.hic15,
        row.hic36,
        row.average_3ms_g,
        row.clip_3ms_g,
        row.peak_power_manipulator,
        row.peak_power_foam,
    ]
}

/// Numbers, status and whether the foam leaves its linear range.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // extracted from a Python object
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
    let values = numbers(row).map(|value| PyFloat::new(py, value).into_any());
    let [a, b, c, d, e, f, g, h, i, j, k, l] = values;
    let status = PyString::intern(py, row.status.word()).into_any();
    let beyond = row.max_compression > linear_range;
    let beyond = PyBool::new(py, beyond).to_owned().into_any();
    PyTuple::new(py, [a, b, c, d, e, f, g, h, i, j, k, l, status, beyond])
}

/// Names of the rows and columns of the derivatives.
#[pyfunction]
pub fn impact_gradient_names() -> (Vec<&'static str>, Vec<&'static str>) {
    (METRIC_NAMES.to_vec(), PARAMETER_NAMES.to_vec())
}

/// The row of metrics and the matrix of their derivatives.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // extracted from a Python object
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
    let values: Vec<f64> = found.values.into_iter().flatten().collect();
    let matrix = values.into_pyarray(py).reshape([METRICS, PARAMETERS])?;
    let row = row_tuple(py, &found.metrics, foam.0.linear_range)?;
    Ok((row, matrix))
}
