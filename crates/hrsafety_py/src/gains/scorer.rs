//! Objectives and constraints that are Python callables.

use std::sync::Mutex;

use groundwork::error::{Failure, Result};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyList;
use vff_core::optimize::Evaluation;
use vff_core::scenario::Scenario;
use vff_core::simulate::{AnyLaw, BatchOptions, BatchTable, Outcome, run_batch};

use crate::batch::columns;

/// A callable that turns the columns of batches, one batch for each seed, into values and margins.
pub struct Scorer {
    /// `(list of columns) -> (values (n, objectives), margins (n, constraints))`.
    pub call: Py<PyAny>,
    /// Scenarios of each seed.
    pub scenarios: Vec<Vec<Scenario>>,
    /// Law whose gains are replaced.
    pub law: AnyLaw,
    /// How the runs are made.
    pub options: BatchOptions,
    /// What the callable raised, until it is taken.
    pub raised: Mutex<Option<PyErr>>,
}

impl Scorer {
    /// Runs the gain sets and has them scored; the interpreter is held for the second part only.
    pub fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()> {
        let mut tables = Vec::with_capacity(self.scenarios.len());
        for scenarios in &self.scenarios {
            let table = run_batch(
                scenarios,
                &self.law,
                points,
                &self.options,
                &|| false,
                &|_| {},
            )?;
            let runs = table.outcome.chunks_exact(scenarios.len());
            for (failed, outcomes) in into.failed.iter_mut().zip(runs) {
                *failed |= outcomes.iter().any(|outcome| *outcome != Outcome::Arrived);
            }
            tables.push(table);
        }
        Python::attach(|py| self.score(py, points, tables, into)).map_err(|error| {
            if let Ok(mut slot) = self.raised.lock() {
                slot.get_or_insert(error);
            }
            Failure::Interrupted
        })
    }

    fn score(
        &self,
        py: Python<'_>,
        points: &[f64],
        tables: Vec<BatchTable>,
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
        fill(into.margins, &margins);
        Ok(())
    }
}

/// Copies an array of any memory order; the caller has checked its shape.
fn fill(target: &mut [f64], source: &PyReadonlyArray2<'_, f64>) {
    for (slot, value) in target.iter_mut().zip(source.as_array().iter()) {
        *slot = *value;
    }
}
