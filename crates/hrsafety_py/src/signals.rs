//! Long work outside the interpreter: signals are answered while it runs.

use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use pyo3::prelude::*;

use crate::errors::SimulationError;

/// Time between two looks at signals and progress.
const LOOK: Duration = Duration::from_millis(50);

/// Works in another thread while this one looks at signals and progress, without the interpreter.
///
/// `look` is called about twenty times a second until it returns an error; `stop` is called then,
/// and the error comes back beside the result.
pub fn attended<T: Send>(
    work: impl FnOnce() -> T + Send,
    mut look: impl FnMut() -> PyResult<()>,
    stop: impl Fn(),
) -> PyResult<(T, Option<PyErr>)> {
    let (mut work, mut result) = (Some(work), None);
    let mut once = || result = work.take().map(|work| work());
    let raised = attend(&mut once, &mut look, &stop)?;
    let result =
        result.ok_or_else(|| SimulationError::new_err("a worker thread ended unexpectedly"))?;
    Ok((result, raised))
}

/// Compiled once, not once for each kind of work: what begins and ends a thread is long.
fn attend(
    work: &mut (dyn FnMut() + Send),
    look: &mut dyn FnMut() -> PyResult<()>,
    stop: &dyn Fn(),
) -> PyResult<Option<PyErr>> {
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        let worker = scope.spawn(move || {
            work();
            // The receiver waits until this has been sent.
            sender.send(()).ok();
        });
        let mut raised = None;
        while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(LOOK) {
            if raised.is_none() {
                raised = look().err();
                if raised.is_some() {
                    stop();
                }
            }
        }
        worker
            .join()
            .map_err(|_| SimulationError::new_err("a worker thread ended unexpectedly"))?;
        Ok(raised)
    })
}
