//! Loads of many impacts: one crossing of the boundary.

use impact_core::batch::{
    BatchOptions, Column, Columns, FieldSet, HeadColumns, Width, metrics_batch,
};
use impact_core::criteria::Status;
use numeric::error::{Failure, finite};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Fields;
use crate::errors::CoreError;
use crate::watch::{Control, Report, watched};

/// Rows between two looks whether to stop.
const CHECK: usize = 4096;

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

/// Names of the numbers of a row, as the core's errors and as Python's arguments call them.
const NUMBERS: [(&str, &str); 11] = [
    ("manipulator.mass", "invalid_manipulator_mass"),
    ("manipulator.damping", "invalid_manipulator_damping"),
    ("manipulator.stiffness", "invalid_manipulator_stiffness"),
    ("foam.stiffness", "invalid_foam_stiffness"),
    ("foam.damping", "invalid_foam_damping"),
    ("foam.linear_range", "invalid_linear_range"),
    ("head.mass", "invalid_head_mass"),
    ("head.damping", "invalid_head_damping"),
    ("head.stiffness", "invalid_head_stiffness"),
    ("closing_speed", "invalid_closing_speed"),
    ("manipulator_speed", "invalid_manipulator_speed"),
];

/// Words of the codes in a batch: those of the core, then one for each number that may be bad.
#[pyfunction]
pub fn impact_status_words() -> Vec<&'static str> {
    let numbers = NUMBERS.iter().map(|(_, word)| *word);
    Status::ALL
        .map(Status::word)
        .into_iter()
        .chain(numbers)
        .collect()
}

/// Code of a row that cannot be, from the first number that its check refuses.
fn invalid_code(columns: &Columns<'_>, row: usize) -> Option<u8> {
    let [closing_speed, manipulator_speed] = columns.speeds(row);
    let refused = columns
        .system(row)
        .checked()
        .and(finite("closing_speed", closing_speed))
        .and(finite("manipulator_speed", manipulator_speed));
    let Err(Failure::InvalidParameter { name, .. }) = refused else {
        return None;
    };
    let place = NUMBERS.iter().position(|(known, _)| *known == name)?;
    (Status::ALL.len() + place).try_into().ok()
}

/// Says which number is bad in every row that cannot be.
fn name_bad_numbers(
    columns: &Columns<'_>,
    status: &mut [u8],
    control: &Control,
) -> Result<(), Failure> {
    let invalid = Status::ALL
        .iter()
        .position(|each| *each == Status::InvalidParameter);
    for (row, code) in status.iter_mut().enumerate() {
        if row.is_multiple_of(CHECK) && control.interrupted() {
            return Err(Failure::Interrupted);
        }
        if Some(usize::from(*code)) == invalid {
            *code = invalid_code(columns, row).unwrap_or(*code);
        }
    }
    Ok(())
}

/// Columns of metrics, those that were asked for.
#[pyfunction]
#[pyo3(signature = (*, manipulator, foam, head, closing_speed, manipulator_speed, horizon,
    peaks_only, threads, lanes, progress))]
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
    progress: Option<Py<PyAny>>,
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
    let report = Report::new(progress.as_ref(), columns.rows().map_err(CoreError::from)?);
    let rows = watched(py, report, |control| {
        let interrupted = || control.interrupted();
        let count = |rows| control.count(rows);
        let mut found = metrics_batch(&columns, &options, &interrupted, &count)?;
        name_bad_numbers(&columns, &mut found.status, control)?;
        Ok::<_, Failure>(found)
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
