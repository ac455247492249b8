//! The one map from core errors to Python exceptions.

use impact_core::error::{self as impact, ImpactError};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use reactive_core::error::{self as reactive, ReactiveError};
use vff_core::error::{Given, NavigationError};

pyo3::import_exception!(hrsafety.errors, InvalidParameterError);
pyo3::import_exception!(hrsafety.errors, SimulationError);

/// A core error on its way to Python.
pub enum CoreError {
    /// From the navigation core.
    Navigation(NavigationError),
    /// From the impact core.
    Impact(ImpactError),
    /// From the reactive core.
    Reactive(ReactiveError),
}

/// Result of a binding function.
pub type CoreResult<T> = Result<T, CoreError>;

impl From<NavigationError> for CoreError {
    fn from(error: NavigationError) -> Self {
        Self::Navigation(error)
    }
}

impl From<ImpactError> for CoreError {
    fn from(error: ImpactError) -> Self {
        Self::Impact(error)
    }
}

impl From<ReactiveError> for CoreError {
    fn from(error: ReactiveError) -> Self {
        Self::Reactive(error)
    }
}

impl From<CoreError> for PyErr {
    fn from(error: CoreError) -> Self {
        match error {
            CoreError::Navigation(error) => navigation_exception(error),
            CoreError::Impact(error) => impact_exception(error),
            CoreError::Reactive(error) => reactive_exception(error),
        }
    }
}

fn navigation_exception(error: NavigationError) -> PyErr {
    match error {
        NavigationError::InvalidParameter {
            name,
            requirement,
            value,
        } => match value {
            Given::Number(number) => InvalidParameterError::new_err((name, requirement, number)),
            Given::Pair([x, y]) => InvalidParameterError::new_err((name, requirement, (x, y))),
            Given::Count(count) => InvalidParameterError::new_err((name, requirement, count)),
            Given::Word(word) => InvalidParameterError::new_err((name, requirement, word)),
        },
        NavigationError::Interrupted => PyKeyboardInterrupt::new_err(()),
        other => SimulationError::new_err(other.to_string()),
    }
}

fn impact_exception(error: ImpactError) -> PyErr {
    match error {
        ImpactError::InvalidParameter {
            name,
            requirement,
            value,
        } => match value {
            impact::Given::Number(number) => {
                InvalidParameterError::new_err((name, requirement, number))
            }
            impact::Given::Count(count) => {
                InvalidParameterError::new_err((name, requirement, count))
            }
            impact::Given::Word(word) => InvalidParameterError::new_err((name, requirement, word)),
        },
        ImpactError::Interrupted => PyKeyboardInterrupt::new_err(()),
        other @ ImpactError::Threads { .. } => SimulationError::new_err(other.to_string()),
    }
}

fn reactive_exception(error: ReactiveError) -> PyErr {
    match error {
        ReactiveError::InvalidParameter {
            name,
            requirement,
            value,
        } => match value {
            reactive::Given::Number(number) => {
                InvalidParameterError::new_err((name, requirement, number))
            }
            reactive::Given::Pair([x, y]) => {
                InvalidParameterError::new_err((name, requirement, (x, y)))
            }
            reactive::Given::Count(count) => {
                InvalidParameterError::new_err((name, requirement, count))
            }
            reactive::Given::Word(word) => {
                InvalidParameterError::new_err((name, requirement, word))
            }
        },
        ReactiveError::Interrupted => PyKeyboardInterrupt::new_err(()),
        other => SimulationError::new_err(other.to_string()),
    }
}
