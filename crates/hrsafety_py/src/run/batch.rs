//! Batches: one crossing of the boundary, interpreter released, Ctrl-C answered.

use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::{BatchOptions, BatchTable, Instructions, Outcome, Width, run_batch};

use crate::arrays::Fields;
use crate::errors::CoreError;
use crate::keywords::Keywords;
use crate::laws::Law;
use crate::run::{run_options, weights_of};
use crate::scenes::Scenes;
use crate::watch::{Report, watched_law};

/// Summary columns of every gain set in every scenario.
#[pyfunction]
#[pyo3(signature = (scenarios, law, gains, weights, **given))]
pub fn simulate_batch<'py>(
    py: Python<'py>,
    scenarios: Scenes,
    law: &Law,
    gains: PyReadonlyArray2<'py, f64>,
    weights: (f64, f64, f64),
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let lanes: Option<usize> = given.take("lanes")?;
    let integrator: Bound<'py, PyAny> = given.take("integrator")?;
    let (step, hold) = (given.take("step")?, given.take("hold")?);
    let options = BatchOptions {
        run: run_options(&integrator, step, hold, given.take("stop_on_contact")?)?,
        weights: weights_of(weights),
        descent: given.take("descent")?,
        threads: law.threads(given.take("threads")?),
        width: lanes.map(Width::of).transpose().map_err(CoreError::from)?,
        instructions: Instructions::Widest,
    };
    let progress: Option<Py<PyAny>> = given.take("progress")?;
    given.done()?;
    let (count, dimension) = (gains.shape()[0], gains.shape()[1]);
    let points = gains.as_slice()?.to_vec();
    let report = Report::new(progress.as_ref(), count * scenarios.len());
    let table = watched_law(py, (law, options.threads), report, |control| {
        let interrupted = || control.interrupted();
        let count = |runs| control.count(runs);
        run_batch(
            &scenarios,
            &law.any,
            &points,
            &options,
            &interrupted,
            &count,
        )
    })?;
    columns(py, (&points, dimension), table)
}

/// Columns of a batch of gain sets, which follow each other with so many gains each.
pub fn columns<'py>(
    py: Python<'py>,
    sets: (&[f64], usize),
    table: BatchTable,
) -> PyResult<Bound<'py, PyDict>> {
    let fields = Fields::new(py);
    let (rows, obstacles) = (table.len(), table.obstacles);
    index_columns(&fields, sets, rows)?;
    fields.words("outcome", table.outcome.into_iter().map(Outcome::word))?;
    fields.vector("end_time", table.end_time)?;
    fields.vector("arrival_time", table.arrival_time)?;
    fields.vector("energy", table.energy)?;
    fields.vector("path_length", table.path_length)?;
    fields.array("min_distance", table.min_distance, [rows, obstacles])?;
    fields.vector("min_clearance", table.min_clearance)?;
    fields.vector("entered_active", table.entered_active)?;
    fields.vector("contacts_moving", table.contacts_moving)?;
    fields.vector("contacts_toward", table.contacts_toward)?;
    fields.vector("contacts_away", table.contacts_away)?;
    fields.vector("contacts_standing", table.contacts_standing)?;
    fields.vector("contacts_at_fault", table.contacts_at_fault)?;
    fields.vector("contacts_apart", table.contacts_apart)?;
    fields.vector("wall_contacts", table.wall_contacts)?;
    fields.vector("performance_total", table.performance_total)?;
    fields.vector("performance_arrival_time", table.performance_arrival_time)?;
    fields.vector("performance_avoidance", table.performance_avoidance)?;
    fields.vector("performance_energy_saving", table.performance_energy_saving)?;
    fields.vector("descent_share", table.descent_share)?;
    fields.vector("force_evaluations", table.force_evaluations)?;
    Ok(fields.finish())
}

/// Which gains and which scenario; the scenarios vary fastest.
fn index_columns(
    fields: &Fields<'_>,
    (points, dimension): (&[f64], usize),
    rows: usize,
) -> PyResult<()> {
    let sets: Vec<&[f64]> = points.chunks_exact(dimension).collect();
    let scenarios = rows / sets.len().max(1);
    let indices = || (0..rows).map(|row| (row / scenarios, row % scenarios));
    let gains = indices()
        .flat_map(|(set, _)| sets[set].iter().copied())
        .collect();
    let of_gains = indices().map(|(set, _)| signed(set)).collect();
    fields.vector("gain_index", of_gains)?;
    let of_scenarios = indices().map(|(_, index)| signed(index)).collect();
    fields.vector("scenario_index", of_scenarios)?;
    fields.array("gains", gains, [rows, dimension])
}

/// A count as Python's integer type of arrays.
fn signed(count: usize) -> i64 {
    count.try_into().unwrap_or(i64::MAX)
}
