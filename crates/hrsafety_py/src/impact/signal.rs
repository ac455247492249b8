//! Injury criteria of sampled signals.

use impact_core::parameters::GRAVITY;
use impact_core::signal::{self, Recording};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::errors::CoreError;
use crate::impact::single::row_tuple;

type Samples<'py> = PyReadonlyArray1<'py, f64>;
/// Value, start, end.
type Window = (f64, f64, f64);

/// Head injury criterion of a signal: value, start, end.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // the borrow of an array is an owned guard
pub fn hic(
    time: Samples<'_>,
    acceleration_g: Samples<'_>,
    window: f64,
    interpolate: bool,
) -> PyResult<Window> {
    let found = signal::hic(
        time.as_slice()?,
        acceleration_g.as_slice()?,
        window,
        interpolate,
    )
    .map_err(CoreError::from)?;
    Ok((found.value, found.start, found.end))
}

/// Largest moving average of a signal: value, start, end.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // the borrow of an array is an owned guard
pub fn moving_average(
    time: Samples<'_>,
    acceleration_g: Samples<'_>,
    width: f64,
) -> PyResult<Window> {
    let found = signal::moving_average(time.as_slice()?, acceleration_g.as_slice()?, width)
        .map_err(CoreError::from)?;
    Ok((found.value, found.start, found.end))
}

/// Level that a signal exceeds without a break: value, start, end.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // the borrow of an array is an owned guard
pub fn contiguous_level(
    time: Samples<'_>,
    acceleration_g: Samples<'_>,
    width: f64,
) -> PyResult<Window> {
    let found = signal::contiguous_level(time.as_slice()?, acceleration_g.as_slice()?, width)
        .map_err(CoreError::from)?;
    Ok((found.value, found.start, found.end))
}

/// Head injury criterion of a half sine.
#[pyfunction]
pub fn hic_half_sine(peak_g: f64, duration: f64, window: f64) -> PyResult<f64> {
    Ok(signal::hic_half_sine(peak_g, duration, window).map_err(CoreError::from)?)
}

/// Head injury criterion of a square pulse.
#[pyfunction]
pub fn hic_square(peak_g: f64, duration: f64, window: f64) -> PyResult<f64> {
    Ok(signal::hic_square(peak_g, duration, window).map_err(CoreError::from)?)
}

/// Head injury criterion of a triangle.
#[pyfunction]
pub fn hic_triangle(peak_g: f64, duration: f64, window: f64) -> PyResult<f64> {
    Ok(signal::hic_triangle(peak_g, duration, window).map_err(CoreError::from)?)
}

fn slice<'a>(samples: Option<&'a Samples<'_>>) -> PyResult<Option<&'a [f64]>> {
    Ok(samples.map(|samples| samples.as_slice()).transpose()?)
}

/// Numbers, status and whether the foam leaves its linear range, of a recorded impact.
#[pyfunction]
#[pyo3(signature = (time, acceleration_g, *, contact_force, compression, manipulator_velocity,
    start, linear_range))]
#[allow(clippy::too_many_arguments)] // keyword-only in Python
#[allow(clippy::needless_pass_by_value)] // the borrow of an array is an owned guard
pub fn recorded_metrics<'py>(
    py: Python<'py>,
    time: Samples<'py>,
    acceleration_g: Samples<'py>,
    contact_force: Option<Samples<'py>>,
    compression: Option<Samples<'py>>,
    manipulator_velocity: Option<Samples<'py>>,
    start: Option<f64>,
    linear_range: f64,
) -> PyResult<Bound<'py, PyTuple>> {
    let time = time.as_slice()?;
    let recording = Recording {
        time,
        acceleration_g: acceleration_g.as_slice()?,
        contact_force: slice(contact_force.as_ref())?,
        compression: slice(compression.as_ref())?,
        manipulator_velocity: slice(manipulator_velocity.as_ref())?,
        start: start.or(time.first().copied()).unwrap_or(f64::NAN),
        linear_range,
        gravity: GRAVITY,
    };
    let row = recording.metrics().map_err(CoreError::from)?;
    row_tuple(py, &row, linear_range)
}
