//! Injury criteria of sampled signals.

use impact_core::signal;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::errors::CoreError;

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
