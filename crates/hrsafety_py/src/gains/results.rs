//! Results of searches, as dictionaries of arrays.

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use vff_core::search::{Candidate, Front, GlobalSearch, LocalSearch, Round, Search};

use crate::arrays::{Fields, fields};

/// A grid search with its local searches.
pub fn search_fields(py: Python<'_>, found: Search) -> PyResult<Bound<'_, PyDict>> {
    let fields = Fields::new(py);
    fields.value("best", best_fields(py, found.best.as_ref())?)?;
    let rounds = found
        .rounds
        .into_iter()
        .map(|round| round_fields(py, round));
    fields.value("rounds", list(py, rounds)?)?;
    let local = found.local.iter().map(|local| local_fields(py, local));
    fields.value("local", list(py, local)?)?;
    candidates(&fields, &found.top)?;
    fields.value("evaluations", found.evaluations)?;
    fields.value("failures", found.failures)?;
    fields.value("interrupted", found.interrupted)?;
    Ok(fields.finish())
}

/// A global search.
pub fn global_fields<'py>(py: Python<'py>, found: &GlobalSearch) -> PyResult<Bound<'py, PyDict>> {
    let history = found
        .history
        .iter()
        .flat_map(|(evaluations, best)| [*evaluations as f64, *best])
        .collect();
    Ok(fields! { py;
        value best = best_fields(py, found.best.as_ref())?;
        array [found.history.len(), 2] history = history;
        value found: evaluations, failures, interrupted;
    })
}

/// A front.
pub fn front_fields(
    py: Python<'_>,
    found: Front,
    dimension: usize,
    objectives: usize,
) -> PyResult<Bound<'_, PyDict>> {
    let rows = found.points.len() / dimension;
    Ok(fields! { py;
        array [rows, dimension] found: points;
        array [rows, objectives] found: values;
        value found: evaluations, failures, interrupted;
    })
}

fn list<'py>(
    py: Python<'py>,
    entries: impl Iterator<Item = PyResult<Bound<'py, PyDict>>>,
) -> PyResult<Bound<'py, PyList>> {
    PyList::new(py, entries.collect::<PyResult<Vec<_>>>()?)
}

/// The best point; without one the search was interrupted before anything was evaluated.
fn best_fields<'py>(py: Python<'py>, best: Option<&Candidate>) -> PyResult<Bound<'py, PyDict>> {
    let found = best.ok_or_else(|| PyKeyboardInterrupt::new_err(()))?;
    Ok(fields! { py;
        vector gains = found.point.clone();
        value value = found.score.value;
        value violation = found.score.violation;
        value failed = found.score.failed;
    })
}

fn candidates(fields: &Fields<'_>, found: &[Candidate]) -> PyResult<()> {
    let points = found.iter().flat_map(|entry| entry.point.iter().copied());
    let dimension = found.first().map_or(0, |entry| entry.point.len());
    fields.array("top", points.collect(), [found.len(), dimension])?;
    let values = found.iter().map(|entry| entry.score.value);
    fields.vector("top_values", values.collect())?;
    let missed = found.iter().map(|entry| entry.score.violation);
    fields.vector("top_violation", missed.collect())
}

fn round_fields(py: Python<'_>, round: Round) -> PyResult<Bound<'_, PyDict>> {
    let fields = Fields::new(py);
    let axes = PyList::empty(py);
    for axis in round.axes {
        axes.append(numpy::PyArray1::from_vec(py, axis))?;
    }
    fields.value("axes", axes)?;
    fields.vector("increments", round.increments)?;
    fields.value("evaluations", round.evaluations)?;
    fields.value("failures", round.failures)?;
    fields.value("best_value", round.best.score.value)?;
    fields.value("violation", round.best.score.violation)?;
    fields.vector("best_gains", round.best.point)?;
    fields.vector("survivor_low", round.survivor_low)?;
    fields.vector("survivor_high", round.survivor_high)?;
    fields.value("worst_survivor", round.worst_survivor.value)?;
    Ok(fields.finish())
}

fn local_fields<'py>(py: Python<'py>, local: &LocalSearch) -> PyResult<Bound<'py, PyDict>> {
    Ok(fields! { py;
        vector start = local.start.point.clone();
        value start_value = local.start.score.value;
        vector gains = local.best.point.clone();
        value value = local.best.score.value;
        value violation = local.best.score.violation;
        value local: evaluations;
        value status = local.status.word();
    })
}
