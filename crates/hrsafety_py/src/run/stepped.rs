//! Runs that Python steps, from one place at a time.

use std::sync::{Mutex, MutexGuard};

use numeric::error::{Failure, Interrupted};
use pyo3::prelude::*;

use crate::errors::SimulationError;
use crate::watch::{Report, here};

/// A state that one thread at a time works on.
pub struct Stepped<T> {
    state: Mutex<T>,
    /// Error message while another caller steps it.
    busy: &'static str,
}

impl<T: Send> Stepped<T> {
    /// A state, and what is said while somebody is at work on it.
    pub fn new(state: T, busy: &'static str) -> Self {
        Self {
            state: Mutex::new(state),
            busy,
        }
    }

    fn busy(&self) -> PyErr {
        SimulationError::new_err(self.busy)
    }

    /// The state, unless another thread, or a law of its own, is at work on it.
    pub fn idle(&self) -> PyResult<MutexGuard<'_, T>> {
        self.state.try_lock().map_err(|_| self.busy())
    }

    /// Works on the state without the interpreter, and looks at signals now and then.
    pub fn work<R: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut T, Interrupted<'_>) -> Result<R, Failure> + Send,
    ) -> PyResult<R> {
        let found = here(py, Report::none(), |control| {
            let Ok(mut state) = self.state.try_lock() else {
                return Ok(None);
            };
            work(&mut state, &|| control.interrupted()).map(Some)
        })?;
        found.ok_or_else(|| self.busy())
    }
}
