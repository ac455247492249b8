//! Objectives and constraints that are Python callables.

use std::sync::Mutex;

use numeric::error::{Failure, Result};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyList;
use vff_core::run::{AnyLaw, BatchOptions, BatchTable, Outcome, run_batch};
use vff_core::search::{Evaluation, arrival_margin};
use vff_core::world::scenario::Scenario;

use crate::run::batch::columns;

/// A callable that turns the columns of batches, one batch for each seed, into values and margins.
pub struct Scorer {
    /// `(list of columns) -> (values (n, objectives), margins (n, constraints))`; of a scorer that makes its runs
    /// itself `(gain sets (n, gains)) -> (values, margins, failed runs (n,))`.
    pub call: Py<PyAny>,
    /// Whether the callable makes its runs itself.
    pub whole: bool,
    /// Scenarios of each seed.
    pub scenarios: Vec<Vec<Scenario>>,
    /// Law whose gains are replaced.
    pub law: AnyLaw,
    /// How the runs are made.
    pub options: BatchOptions,
    /// Whether the last constraint is that every run arrives without a contact.
    pub requires_arrival: bool,
    /// Error that the callable raised, until it is taken.
    pub raised: Mutex<Option<PyErr>>,
}

impl Scorer {
    /// Runs the gain sets and has them scored; the interpreter is held for the second part only.
    pub fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()> {
        if self.whole {
            return Python::attach(|py| self.ask(py, points, into))
                .map_err(|error| self.keep(error));
        }
        let mut tables = Vec::with_capacity(self.scenarios.len());
        let mut failures = vec![0; into.failed.len()];
        for scenarios in &self.scenarios {
            let table = run_batch(
                scenarios,
                &self.law,
                points,
                &self.options,
                into.stop.0,
                &|_| {},
            )?;
            let runs = table.outcome.chunks_exact(scenarios.len());
            for (count, outcomes) in failures.iter_mut().zip(runs) {
                let failed = |outcome: &&Outcome| **outcome != Outcome::Arrived;
                *count += outcomes.iter().filter(failed).count();
            }
            tables.push(table);
        }
        for (failed, count) in into.failed.iter_mut().zip(&failures) {
            *failed |= *count > 0;
        }
        Python::attach(|py| self.score(py, points, tables, &failures, into))
            .map_err(|error| self.keep(error))
    }

    /// Keeps what the callable raised, and stops the search.
    fn keep(&self, error: PyErr) -> Failure {
        if let Ok(mut slot) = self.raised.lock() {
            slot.get_or_insert(error);
        }
        Failure::Interrupted
    }

    /// Has the callable run and score the gain sets.
    fn ask(&self, py: Python<'_>, points: &[f64], into: &mut Evaluation<'_>) -> PyResult<()> {
        let rows = points.chunks_exact(self.law.gain_names().len());
        let sets: Vec<Vec<f64>> = rows.map(<[f64]>::to_vec).collect();
        let asked = PyArray2::from_vec2(py, &sets)?;
        let (values, margins, failures): (
            PyReadonlyArray2<'_, f64>,
            PyReadonlyArray2<'_, f64>,
            Vec<usize>,
        ) = self.call.bind(py).call1((asked,))?.extract()?;
        fill(into.values, &values);
        fill(into.margins, &margins);
        for (failed, count) in into.failed.iter_mut().zip(failures) {
            *failed |= count > 0;
        }
        Ok(())
    }

    fn score(
        &self,
        py: Python<'_>,
        points: &[f64],
        tables: Vec<BatchTable>,
        failures: &[usize],
        into: &mut Evaluation<'_>,
    ) -> PyResult<()> {
        let dimension = self.law.gain_names().len();
        let list = PyList::empty(py);
        for table in tables {
            list.append(columns(py, (points, dimension), table)?)?;
        }
        let (values, margins): (PyReadonlyArray2<'_, f64>, PyReadonlyArray2<'_, f64>) =
            self.call.bind(py).call1((list,))?.extract()?;
        fill(into.values, &values);
        if !self.requires_arrival {
            fill(into.margins, &margins);
            return Ok(());
        }
        let each = into.margins.len() / failures.len().max(1);
        let rows = into.margins.chunks_exact_mut(each).zip(failures);
        for ((slots, count), called) in rows.zip(margins.as_array().rows()) {
            for (slot, margin) in slots.iter_mut().zip(called) {
                *slot = *margin;
            }
            slots[each - 1] = arrival_margin(*count);
        }
        Ok(())
    }
}

/// Copies an array of any memory order; the caller has checked its shape.
fn fill(target: &mut [f64], source: &PyReadonlyArray2<'_, f64>) {
    for (slot, value) in target.iter_mut().zip(source.as_array().iter()) {
        *slot = *value;
    }
}
