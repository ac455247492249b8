//! Long work outside the interpreter: signals are answered while it runs.

use std::num::NonZero;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use impact_core::error::ImpactError;
use pyo3::prelude::*;

use crate::errors::{CoreError, SimulationError};

/// Time between two looks at signals.
const LOOK: Duration = Duration::from_millis(50);

/// Works in another thread while this one looks at signals; the work is told to stop when one
/// raises an exception, and what it returns then is dropped.
pub fn watched<T: Send, E: Send>(
    py: Python<'_>,
    work: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> Result<T, E> + Send,
) -> PyResult<T>
where
    CoreError: From<E>,
{
    let cancelled = AtomicBool::new(false);
    let cancelled = &cancelled;
    py.detach(|| {
        let (sender, receiver) = mpsc::channel();
        std::thread::scope(|scope| {
            let worker = scope.spawn(move || {
                let result = work(&|| cancelled.load(Ordering::Relaxed));
                // The receiver waits until this has been sent.
                sender.send(()).ok();
                result
            });
            let mut raised = None;
            while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(LOOK) {
                if raised.is_none() {
                    #[allow(clippy::redundant_closure_for_method_calls)] // lifetimes differ
                    let looked = Python::attach(|py| py.check_signals());
                    raised = looked.err();
                    cancelled.store(raised.is_some(), Ordering::Relaxed);
                }
            }
            let result = worker
                .join()
                .map_err(|_| SimulationError::new_err("a worker thread ended unexpectedly"))?;
            match raised {
                Some(error) => Err(error),
                None => Ok(result.map_err(CoreError::from)?),
            }
        })
    })
}

/// Work of one item on all cores, as `watched`; results stand in the order of the items.
pub fn watched_each<T: Send>(
    py: Python<'_>,
    items: &[f64],
    work: impl Fn(f64) -> Result<T, ImpactError> + Sync,
) -> PyResult<Vec<T>> {
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let next = AtomicUsize::new(0);
    watched(py, |interrupted| {
        let share = || -> Result<Vec<(usize, T)>, ImpactError> {
            let mut done = Vec::new();
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(item) = items.get(index) else {
                    return Ok(done);
                };
                if interrupted() {
                    return Err(ImpactError::Interrupted);
                }
                done.push((index, work(*item)?));
            }
        };
        let shares = std::thread::scope(|scope| {
            let workers: Vec<_> = (1..cores.min(items.len()))
                .map(|_| scope.spawn(share))
                .collect();
            let own = share();
            let others = workers
                .into_iter()
                .map(|worker| worker.join().unwrap_or(Err(ImpactError::Interrupted)));
            others.chain([own]).collect::<Result<Vec<_>, _>>()
        })?;
        let mut all: Vec<_> = shares.into_iter().flatten().collect();
        all.sort_by_key(|(index, _)| *index);
        Ok::<_, ImpactError>(all.into_iter().map(|(_, found)| found).collect())
    })
}
