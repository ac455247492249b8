//! Programs of robots: conversions only, everything is computed by the core.

pub(crate) mod contact;
pub(crate) mod path;

use impact_core::program::{draws, zones};
use numeric::error::{Failure, Given};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::fields;
use crate::contact::arm::Arm;
use crate::errors::CoreError;

/// Indices as numpy holds them.
fn signed(index: usize) -> i64 {
    i64::try_from(index).unwrap_or(i64::MAX)
}

/// Indices that numpy holds, none below zero.
fn unsigned(name: &str, values: &[i64]) -> Result<Vec<usize>, Failure> {
    let of = |value: &i64| {
        let refused = |_| Failure::invalid(name, "be at least 0", Given::Number(*value as f64));
        usize::try_from(*value).map_err(refused)
    };
    values.iter().map(of).collect()
}

/// Zones of constant speed with the least time.
#[pyfunction]
#[pyo3(signature = (length, cap, *, count, step))]
pub fn program_zones<'py>(
    py: Python<'py>,
    length: PyReadonlyArray1<'py, f64>,
    cap: PyReadonlyArray1<'py, f64>,
    count: usize,
    step: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let (lengths, caps) = (length.as_slice()?, cap.as_slice()?);
    let found = zones::fastest_zones(lengths, caps, count, step).map_err(CoreError::from)?;
    let Some(found) = found else {
        let below = (0..caps.len()).filter(|cell| zones::typed(caps[*cell], step) == 0.0);
        return Ok(fields! { py;
            value status = "not_permitted";
            vector cells = below.map(signed).collect::<Vec<i64>>();
        });
    };
    let time: f64 = found
        .iter()
        .map(|zone| lengths[zone.cells[0]..zone.cells[1]].iter().sum::<f64>() / zone.speed)
        .sum();
    Ok(fields! { py;
        value status = "found";
        vector first = found.iter().map(|zone| signed(zone.cells[0])).collect::<Vec<i64>>();
        vector last = found.iter().map(|zone| signed(zone.cells[1])).collect::<Vec<i64>>();
        each found: speed;
        value time = time;
    })
}

/// Places where zones are to begin, so that the motion has braked at their bounds.
#[pyfunction]
pub fn program_zone_starts<'py>(
    py: Python<'py>,
    bounds: PyReadonlyArray1<'py, f64>,
    speed: PyReadonlyArray1<'py, f64>,
    deceleration: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let found = zones::starts(bounds.as_slice()?, speed.as_slice()?, deceleration);
    Ok(found.map_err(CoreError::from)?.into_pyarray(py))
}

/// Values and rates of an arm without a program.
#[pyfunction]
pub fn program_draws<'py>(
    py: Python<'py>,
    arm: &Arm,
    velocity: PyReadonlyArray1<'py, f64>,
    count: usize,
    seed: u64,
) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
    let found = draws::draws(&arm.0, velocity.as_slice()?, count, seed).map_err(CoreError::from)?;
    let shape = [count, arm.0.joints.len()];
    let [values, rates] = found;
    Ok([
        values.into_pyarray(py).reshape(shape)?,
        rates.into_pyarray(py).reshape(shape)?,
    ])
}
