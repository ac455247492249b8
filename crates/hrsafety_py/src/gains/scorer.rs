//! Objectives and constraints that are Python callables.

use std::sync::Mutex;

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyList;
use vff_core::error::{NavigationError, Result};
use vff_core::gains::Gains;
use vff_core::laws::VirtualForceField;
use vff_core::optimize::Evaluation;
use vff_core::scenario::Scenario;
use vff_core::simulate::{BatchOptions, BatchTable, Outcome, run_batch};

use crate::batch::columns;
use crate::parameters::gain_set;

/// A callable that turns the columns of batches, one batch for each seed, into values and margins.
pub struct Scorer {
    /// `(list of columns) -> (values (n, objectives), margins (n, constraints))`.
    pub call: Py<PyAny>,
    /// Scenarios of each seed.
    pub scenarios: Vec<Vec<Scenario>>,
    /// Law whose gains are replaced.
    pub law: VirtualForceField,
    /// How the runs are made.
    pub options: BatchOptions,
    /// What the callable raised, until it is taken.
    pub raised: Mutex<Option<PyErr>>,
}

impl Scorer {
    /// Runs the gain sets and has them scored; the interpreter is held for the second part only.
    pub fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()> {
        let sets: Vec<Gains> = points
            .chunks_exact(4)
            .map(|row| gain_set([row[0], row[1], row[2], row[3]]))
            .collect();
        let mut tables = Vec::with_capacity(self.scenarios.len());
        for scenarios in &self.scenarios {
            let table = run_batch(
                scenarios,
                &self.law,
                &sets,
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
        Python::attach(|py| self.score(py, &sets, tables, into)).map_err(|error| {
            if let Ok(mut slot) = self.raised.lock() {
                slot.get_or_insert(error);
            }
            NavigationError::Interrupted
        })
    }

    fn score(
        &self,
        py: Python<'_>,
        sets: &[Gains],
        tables: Vec<BatchTable>,
        into: &mut Evaluation<'_>,
    ) -> PyResult<()> {
        let list = PyList::empty(py);
        for table in tables {
            list.append(columns(py, sets, table)?)?;
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
