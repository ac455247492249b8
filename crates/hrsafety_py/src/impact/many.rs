//! Loads of many impacts: one crossing of the boundary.

use impact_core::batch::{
    BatchOptions, Column, Columns, FieldSet, HeadColumns, Width, metrics_batch,
};
use impact_core::criteria::Status;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Fields;
use crate::errors::CoreError;
use crate::impact::watch::watched;

/// One number for all rows, or one for each.
#[derive(FromPyObject)]
pub enum Numbers<'py> {
    Same(f64),
    Each(PyReadonlyArray1<'py, f64>),
}

impl Numbers<'_> {
    fn column(&self) -> PyResult<Column<'_>> {
        Ok(match self {
            Self::Same(value) => Column::Value(*value),
            Self::Each(values) => Column::Array(values.as_slice()?),
        })
    }
}

/// Words of the codes in a batch.
#[pyfunction]
pub fn impact_status_words() -> Vec<&'static str> {
    Status::ALL.map(Status::word).to_vec()
}

/// Columns of metrics, those that were asked for.
#[pyfunction]
#[pyo3(signature = (*, manipulator, foam, head, closing_speed, manipulator_speed, horizon,
    peaks_only, threads, lanes))]
#[allow(clippy::too_many_arguments)] // keyword-only in Python
#[allow(clippy::needless_pass_by_value)] // extracted from Python objects
pub fn impact_metrics_batch<'py>(
    py: Python<'py>,
    manipulator: [Numbers<'py>; 3],
    foam: [Numbers<'py>; 3],
    head: Option<[Numbers<'py>; 3]>,
    closing_speed: Numbers<'py>,
    manipulator_speed: Option<Numbers<'py>>,
    horizon: Option<f64>,
    peaks_only: bool,
    threads: Option<usize>,
    lanes: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let columns = Columns {
        manipulator_mass: manipulator[0].column()?,
        manipulator_damping: manipulator[1].column()?,
        manipulator_stiffness: manipulator[2].column()?,
        foam_stiffness: foam[0].column()?,
        foam_damping: foam[1].column()?,
        linear_range: foam[2].column()?,
        head: match &head {
            None => HeadColumns::Constrained,
            Some([mass, damping, stiffness]) => HeadColumns::Free {
                mass: mass.column()?,
                damping: damping.column()?,
                stiffness: stiffness.column()?,
            },
        },
        closing_speed: closing_speed.column()?,
        manipulator_speed: manipulator_speed
            .as_ref()
            .map(Numbers::column)
            .transpose()?,
    };
    let options = BatchOptions {
        horizon,
        threads,
        width: lanes.map(Width::of).transpose().map_err(CoreError::from)?,
        fields: if peaks_only {
            FieldSet::Peaks
        } else {
            FieldSet::All
        },
        ..BatchOptions::default()
    };
    let rows = watched(py, |interrupted| {
        metrics_batch(&columns, &options, interrupted)
    })?;
    let fields = Fields::new(py);
    let named = [
        ("peak_head_acceleration", rows.peak_head_acceleration),
        ("peak_head_acceleration_g", rows.peak_head_acceleration_g),
        ("mean_head_acceleration_g", rows.mean_head_acceleration_g),
        ("peak_contact_force", rows.peak_contact_force),
        ("max_compression", rows.max_compression),
        ("impact_duration", rows.impact_duration),
        ("hic15", rows.hic15),
        ("hic36", rows.hic36),
        ("average_3ms_g", rows.average_3ms_g),
        ("clip_3ms_g", rows.clip_3ms_g),
        ("peak_power_manipulator", rows.peak_power_manipulator),
        ("peak_power_foam", rows.peak_power_foam),
    ];
    for (name, values) in named {
        if values.len() == rows.status.len() {
            fields.vector(name, values)?;
        }
    }
    fields.vector("status_code", rows.status)?;
    Ok(fields.finish())
}
