//! The one map from core errors to Python exceptions.

use numeric::error::{Failure, Given, InvalidParameter};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

pyo3::import_exception!(hrsafety.errors, InvalidParameterError);
pyo3::import_exception!(hrsafety.errors, SimulationError);

/// A core error on its way to Python.
pub struct CoreError(Failure);

/// Result of a binding function.
pub type CoreResult<T> = Result<T, CoreError>;

impl From<Failure> for CoreError {
    fn from(failure: Failure) -> Self {
        Self(failure)
    }
}

impl From<CoreError> for PyErr {
    #[cold]
    fn from(CoreError(failure): CoreError) -> Self {
        match failure {
            Failure::InvalidParameter(refused) => invalid(*refused),
            Failure::Interrupted => PyKeyboardInterrupt::new_err(()),
            Failure::NonFinite(ref lost) => {
                SimulationError::new_err((failure.to_string(), lost.run))
            }
            Failure::Threads(_) => SimulationError::new_err(failure.to_string()),
        }
    }
}

fn invalid(refused: InvalidParameter) -> PyErr {
    let InvalidParameter {
        name,
        requirement,
        value,
        remedy,
    } = refused;
    match Python::attach(|py| shown(py, value)) {
        Ok(value) => InvalidParameterError::new_err((name, requirement, value, remedy)),
        Err(error) => error,
    }
}

/// Given value as Python prints it: words of ours without quotes.
fn shown(py: Python<'_>, value: Given) -> PyResult<Py<PyAny>> {
    match value {
        Given::Number(number) => number.into_py_any(py),
        Given::Pair([x, y]) => (x, y).into_py_any(py),
        Given::Count(count) => count.into_py_any(py),
        Given::Word(word) => word.into_py_any(py),
        Given::Found(words) => {
            let kind = py.import("hrsafety.errors")?.getattr("Shown")?;
            Ok(kind.call1((words.as_ref(),))?.unbind())
        }
    }
}
