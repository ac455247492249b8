//! The one map from core errors to Python exceptions.

use std::borrow::Cow;

use numeric::error::{Failure, Given};
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
    fn from(CoreError(failure): CoreError) -> Self {
        match failure {
            Failure::InvalidParameter {
                name,
                requirement,
                value,
                remedy,
            } => match value {
                Given::Number(number) => {
                    InvalidParameterError::new_err((name, requirement, number, remedy))
                }
                Given::Pair([x, y]) => {
                    InvalidParameterError::new_err((name, requirement, (x, y), remedy))
                }
                Given::Count(count) => {
                    InvalidParameterError::new_err((name, requirement, count, remedy))
                }
                Given::Word(word) => {
                    InvalidParameterError::new_err((name, requirement, word, remedy))
                }
                Given::Found(words) => found(name, requirement, &words, remedy),
            },
            Failure::Interrupted => PyKeyboardInterrupt::new_err(()),
            Failure::NonFinite { run, .. } => SimulationError::new_err((failure.to_string(), run)),
            Failure::Threads { .. } => SimulationError::new_err(failure.to_string()),
        }
    }
}

/// An error whose value are words of ours, which Python prints without quotes.
fn found(
    name: String,
    requirement: Cow<'static, str>,
    words: &str,
    remedy: Option<String>,
) -> PyErr {
    Python::attach(|py| {
        let shown = py
            .import("hrsafety.errors")
            .and_then(|errors| errors.getattr("Shown"))
            .and_then(|kind| kind.call1((words,)));
        match shown {
            Ok(shown) => {
                InvalidParameterError::new_err((name, requirement, shown.unbind(), remedy))
            }
            Err(error) => error,
        }
    })
}
