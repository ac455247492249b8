//! Localization: conversion of arguments and results. Here microphones and fixes.

pub mod bursts;

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::sensing::sound::batch::{FixColumns, locate_many};
use vff_core::sensing::sound::fix::{self, Covariance, FixStatus};
use vff_core::sensing::sound::microphones::{self, MicrophonePair};

use crate::arrays::{Fields, fields};
use crate::keywords::{parameter_class, word};
use crate::watch::{Report, spread};

type Column<'py> = PyReadonlyArray1<'py, f64>;

parameter_class! {
    /// Row of three microphones.
    MicrophoneArray(microphones::MicrophoneArray) { spacing, speed_of_sound }
}

/// Words of the codes of fixes.
#[pyfunction]
pub fn fix_status_words() -> Vec<&'static str> {
    FixStatus::ALL.map(FixStatus::word).to_vec()
}

/// Exact delays of M2 and M3 against M1.
#[pyfunction]
pub fn microphone_delays<'py>(
    py: Python<'py>,
    array: &MicrophoneArray,
    range: Column<'py>,
    bearing: Column<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let sources = range.as_slice()?.iter().zip(bearing.as_slice()?);
    let pairs = sources.map(|(range, bearing)| array.0.delays(*range, *bearing));
    let (first, second) = pairs.map(|[a, b]| (a, b)).unzip();
    let fields = Fields::new(py);
    fields.vector::<f64>("delay_12", first)?;
    fields.vector::<f64>("delay_13", second)?;
    Ok(fields.finish())
}

/// Bearings by parallel rays from the delays of one pair.
#[pyfunction]
pub fn parallel_ray_bearings<'py>(
    py: Python<'py>,
    array: &MicrophoneArray,
    pair: &Bound<'py, PyAny>,
    delay_12: Column<'py>,
    delay_13: Column<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let pairs = [
        ("12", MicrophonePair::First),
        ("23", MicrophonePair::Second),
        ("13", MicrophonePair::Outer),
    ];
    let pair = word("pair", pair, "be one of \"12\", \"23\", \"13\"", &pairs)?;
    let delays = delay_12.as_slice()?.iter().zip(delay_13.as_slice()?);
    let bearings = delays.map(|(a, b)| array.0.parallel_ray_bearing(pair, pair.delay([*a, *b])));
    let fields = Fields::new(py);
    fields.vector::<f64>("bearing", bearings.collect())?;
    Ok(fields.finish())
}

/// Angles at the three microphones between the row and sources.
#[pyfunction]
pub fn microphone_elevations<'py>(
    py: Python<'py>,
    array: &MicrophoneArray,
    range: Column<'py>,
    bearing: Column<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let both = range.as_slice()?.iter().zip(bearing.as_slice()?);
    let angles: Vec<f64> = both
        .flat_map(|(range, bearing)| array.0.elevations(*range, *bearing))
        .collect();
    let count = angles.len() / 3;
    Ok(fields! { py;
        array [count, 3] elevation = angles;
    })
}

/// Ranges by the printed formula.
#[pyfunction]
pub fn printed_ranges<'py>(
    py: Python<'py>,
    array: &MicrophoneArray,
    delay_12: Column<'py>,
    delay_13: Column<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let delays = delay_12.as_slice()?.iter().zip(delay_13.as_slice()?);
    let ranges = delays.map(|(a, b)| fix::printed_range(&array.0, [*a, *b]));
    let fields = Fields::new(py);
    fields.vector::<f64>("range", ranges.collect())?;
    Ok(fields.finish())
}

/// Fixes from delays; the covariance of the delays is variance, covariance, variance.
#[pyfunction]
#[pyo3(signature = (array, delay_12, delay_13, *, covariance, threads, progress))]
pub fn locate_sounds<'py>(
    py: Python<'py>,
    array: &MicrophoneArray,
    delay_12: Column<'py>,
    delay_13: Column<'py>,
    covariance: [f64; 3],
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (first, second) = (delay_12.as_slice()?, delay_13.as_slice()?);
    let [variance_12, mixed, variance_13] = covariance;
    let covariance = Covariance {
        first: variance_12,
        mixed,
        second: variance_13,
    };
    let report = Report::new(progress.as_ref(), first.len());
    let array = array.0;
    let found = spread(py, report, threads, |work| {
        locate_many(&array, first, second, &covariance, work)
    })?;
    fix_columns(py, found)
}

fn fix_columns(py: Python<'_>, found: FixColumns) -> PyResult<Bound<'_, PyDict>> {
    let rows = found.range.len();
    Ok(fields! { py;
        vector found: range, bearing, curvature;
        array [rows, 2, 2] found: covariance;
        vector status_code = found.status;
    })
}
