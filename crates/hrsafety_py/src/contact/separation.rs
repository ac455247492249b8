//! Separation distances: conversions only, everything is computed by the core.

use impact_core::separation::{self, Guard, Separation, StoppingTable};
use numeric::error::{Failure, Result};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors::CoreError;

/// Numbers of all rows by the names of Python's arguments.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Rows<'py> {
    human_speed: PyReadonlyArray1<'py, f64>,
    reaction_time: PyReadonlyArray1<'py, f64>,
    intrusion: PyReadonlyArray1<'py, f64>,
    uncertainty: PyReadonlyArray1<'py, f64>,
    target_speed: PyReadonlyArray1<'py, f64>,
}

impl Rows<'_> {
    /// Results of all rows; an error names the row if there are more.
    fn each<T>(
        &self,
        count: usize,
        of: impl Fn(usize, &Separation) -> Result<T>,
    ) -> PyResult<Vec<T>> {
        let (human_speed, reaction_time) =
            (self.human_speed.as_slice()?, self.reaction_time.as_slice()?);
        let (intrusion, uncertainty) = (self.intrusion.as_slice()?, self.uncertainty.as_slice()?);
        let target_speed = self.target_speed.as_slice()?;
        let one = |row: usize| {
            let rules = Separation {
                human_speed: human_speed[row],
                reaction_time: reaction_time[row],
                intrusion: intrusion[row],
                uncertainty: uncertainty[row],
                target_speed: target_speed[row],
            };
            of(row, &rules.checked()?)
        };
        let found: Result<Vec<T>> = (0..count)
            .map(|row| one(row).map_err(|failure| of_row(failure, row, count)))
            .collect();
        Ok(found.map_err(CoreError::from)?)
    }
}

/// Adds the index to the name of the argument where there are several rows.
fn of_row(mut failure: Failure, row: usize, count: usize) -> Failure {
    if let (Failure::InvalidParameter(invalid), true) = (&mut failure, count > 1) {
        invalid.name = format!("{}[{row}]", invalid.name);
    }
    failure
}

/// Distances with a constant deceleration.
#[pyfunction]
pub fn separation_distances<'py>(
    py: Python<'py>,
    robot_speed: PyReadonlyArray1<'py, f64>,
    deceleration: PyReadonlyArray1<'py, f64>,
    rows: Rows<'py>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (speed, deceleration) = (robot_speed.as_slice()?, deceleration.as_slice()?);
    let found = rows.each(speed.len(), |row, rules| {
        rules.distance(speed[row], deceleration[row])
    })?;
    Ok(found.into_pyarray(py))
}

/// Speeds that distances allow with a constant deceleration.
#[pyfunction]
pub fn separation_speeds<'py>(
    py: Python<'py>,
    distance: PyReadonlyArray1<'py, f64>,
    deceleration: PyReadonlyArray1<'py, f64>,
    rows: Rows<'py>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (distance, deceleration) = (distance.as_slice()?, deceleration.as_slice()?);
    let found = rows.each(distance.len(), |row, rules| {
        rules.speed(distance[row], deceleration[row])
    })?;
    Ok(found.into_pyarray(py))
}

/// Measured stops at one load and extension.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct StoppingCurve(separation::StoppingCurve);

#[pymethods]
impl StoppingCurve {
    #[new]
    fn new(
        axes: [Vec<f64>; 3],
        time: PyReadonlyArray1<'_, f64>,
        distance: PyReadonlyArray1<'_, f64>,
        load: f64,
        extension: f64,
    ) -> PyResult<Self> {
        let table = StoppingTable {
            axes,
            time: time.as_slice()?.to_vec(),
            distance: distance.as_slice()?.to_vec(),
        };
        let curve = table.checked().and_then(|table| table.at(load, extension));
        Ok(Self(curve.map_err(CoreError::from)?))
    }

    /// Distances for robots that stop as measured.
    fn distances<'py>(
        &self,
        py: Python<'py>,
        robot_speed: PyReadonlyArray1<'py, f64>,
        rows: Rows<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let speed = robot_speed.as_slice()?;
        let found = rows.each(speed.len(), |row, rules| {
            self.0.separation(rules, speed[row])
        })?;
        Ok(found.into_pyarray(py))
    }

    /// Speeds that distances allow, and whether more might be allowed beyond the table.
    #[allow(clippy::type_complexity)] // a pair
    fn speeds<'py>(
        &self,
        py: Python<'py>,
        distance: PyReadonlyArray1<'py, f64>,
        rows: Rows<'py>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<bool>>)> {
        let given = distance.as_slice()?;
        let found = rows.each(given.len(), |row, rules| self.0.speed(rules, given[row]))?;
        let (speed, beyond): (Vec<f64>, Vec<bool>) = found.into_iter().unzip();
        Ok((speed.into_pyarray(py), beyond.into_pyarray(py)))
    }
}

/// Least distance of a guard, the first result, the speed of approach and the intrusion distance.
#[pyfunction]
pub fn guard_distance(
    stopping_time: f64,
    capability: Option<f64>,
    height: Option<f64>,
) -> PyResult<(f64, f64, f64, f64)> {
    let guard = match (capability, height) {
        (Some(capability), _) => Guard::Curtain(capability),
        (None, Some(height)) => Guard::Floor(height),
        (None, None) => Guard::Body,
    };
    let found = separation::guard_distance(stopping_time, guard).map_err(CoreError::from)?;
    let (distance, first) = (found.distance, found.first);
    Ok((distance, first, found.approach_speed, found.intrusion))
}
