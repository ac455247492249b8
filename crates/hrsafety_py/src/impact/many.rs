//! Loads of many impacts: one crossing of the boundary.

use impact_core::batch::{BatchOptions, FieldSet, Width, metrics_batch};
use impact_core::columns::{Column, Columns, HeadColumns};
use impact_core::metrics::{CRITERIA, Status};
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
    pub fn column(&self) -> PyResult<Column<'_>> {
        Ok(match self {
            Self::Same(value) => Column::Value(*value),
            Self::Each(values) => Column::Array(values.as_slice()?),
        })
    }
}

/// Numbers of all rows by the names of Python's arguments; a constrained head has none.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Given<'py> {
    manipulator_mass: Numbers<'py>,
    manipulator_damping: Numbers<'py>,
    manipulator_stiffness: Numbers<'py>,
    foam_stiffness: Numbers<'py>,
    foam_damping: Numbers<'py>,
    linear_range: Numbers<'py>,
    #[pyo3(default)]
    head_mass: Option<Numbers<'py>>,
    #[pyo3(default)]
    head_damping: Option<Numbers<'py>>,
    #[pyo3(default)]
    head_stiffness: Option<Numbers<'py>>,
    closing_speed: Numbers<'py>,
    #[pyo3(default)]
    manipulator_speed: Option<Numbers<'py>>,
}

impl Given<'_> {
    fn columns(&self) -> PyResult<Columns<'_>> {
        let head = match (&self.head_mass, &self.head_damping, &self.head_stiffness) {
            (Some(mass), Some(damping), Some(stiffness)) => HeadColumns::Free {
                mass: mass.column()?,
                damping: damping.column()?,
                stiffness: stiffness.column()?,
            },
            _ => HeadColumns::Constrained,
        };
        let own_speed = self.manipulator_speed.as_ref().map(Numbers::column);
        Ok(Columns {
            manipulator_mass: self.manipulator_mass.column()?,
            manipulator_damping: self.manipulator_damping.column()?,
            manipulator_stiffness: self.manipulator_stiffness.column()?,
            foam_stiffness: self.foam_stiffness.column()?,
            foam_damping: self.foam_damping.column()?,
            linear_range: self.linear_range.column()?,
            head,
            closing_speed: self.closing_speed.column()?,
            manipulator_speed: own_speed.transpose()?,
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
    let Err(Failure::InvalidParameter(invalid)) = refused else {
        return None;
    };
    let place = NUMBERS
        .iter()
        .position(|(known, _)| *known == invalid.name)?;
    (Status::ALL.len() + place).try_into().ok()
}

/// Says which number is bad in every invalid row.
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

/// Columns of metrics, those that are asked for by their names.
#[pyfunction]
#[pyo3(signature = (given, *, horizon, outputs, threads, lanes, progress))]
pub fn impact_metrics_batch<'py>(
    py: Python<'py>,
    given: Given<'py>,
    horizon: Option<f64>,
    outputs: Vec<String>,
    threads: Option<usize>,
    lanes: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let columns = given.columns()?;
    let options = BatchOptions {
        horizon,
        threads,
        width: lanes.map(Width::of).transpose().map_err(CoreError::from)?,
        fields: FieldSet::of(|criterion| outputs.iter().any(|name| name == criterion.name)),
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
    for (criterion, values) in CRITERIA.iter().zip(rows.loads.into_array()) {
        if values.len() == rows.status.len() {
            fields.vector(criterion.name, values)?;
        }
    }
    fields.vector("status_code", rows.status)?;
    Ok(fields.finish())
}
