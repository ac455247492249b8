//! The one map from core errors to Python exceptions.

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use vff_core::error::{Given, NavigationError};

pyo3::import_exception!(hrsafety.errors, InvalidParameterError);
pyo3::import_exception!(hrsafety.errors, SimulationError);

/// A core error on its way to Python.
pub struct CoreError(NavigationError);

/// Result of a binding function.
pub type CoreResult<T> = Result<T, CoreError>;

impl From<NavigationError> for CoreError {
    fn from(error: NavigationError) -> Self {
        Self(error)
    }
}

impl From<CoreError> for PyErr {
    fn from(CoreError(error): CoreError) -> Self {
        match error {
            NavigationError::InvalidParameter {
                name,
                requirement,
                value,
            } => match value {
                Given::Number(number) => {
                    InvalidParameterError::new_err((name, requirement, number))
                }
                Given::Pair([x, y]) => InvalidParameterError::new_err((name, requirement, (x, y))),
                Given::Count(count) => InvalidParameterError::new_err((name, requirement, count)),
                Given::Word(word) => InvalidParameterError::new_err((name, requirement, word)),
            },
            NavigationError::Interrupted => PyKeyboardInterrupt::new_err(()),
            other => SimulationError::new_err(other.to_string()),
        }
    }
}
