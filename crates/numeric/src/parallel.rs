//! Many runs over all cores: results by index, the same for any number of threads.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::threads::{on_threads, team, try_map};

use crate::error::{Failure, Result};

/// Most runs that a thread does before it takes others.
const MOST_IN_BLOCK: usize = 64;

/// Blocks for each thread, so that all end at about the same time.
const BLOCKS_OF_THREAD: usize = 16;

/// Threads of a batch, and its interruption and progress.
#[derive(Clone, Copy)]
pub struct Work<'a> {
    /// Number of threads; all cores when `None`.
    pub threads: Option<usize>,
    /// Whether to stop; asked before every run.
    pub interrupted: &'a (dyn Fn() -> bool + Sync),
    /// Hears how many more runs are done.
    pub progress: &'a (dyn Fn(usize) + Sync),
}

/// Results of `run(0)`, `run(1)`, ... in this order.
///
/// # Errors
/// A run failed (the first of them by index), the caller asked to stop, or there is no thread pool.
pub fn each_run<T: Send>(
    count: usize,
    work: Work<'_>,
    run: impl Fn(usize) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    results_of(count, work, &run)
}

/// Compiled once for each kind of result, not once for each kind of run.
fn results_of<T: Send>(
    count: usize,
    work: Work<'_>,
    run: &(dyn Fn(usize) -> Result<T> + Sync),
) -> Result<Vec<T>> {
    on_threads(work.threads, || {
        let share = count / (BLOCKS_OF_THREAD * team());
        let size = share.clamp(1, MOST_IN_BLOCK);
        let found: Vec<Mutex<Vec<T>>> = (0..count.div_ceil(size))
            .map(|_| Mutex::default())
            .collect();
        each_block((count, size), work, &|block, each| {
            let mut results = Vec::with_capacity(size);
            each(&mut |index| {
                results.push(run(index)?);
                Ok(())
            })?;
            *found[block].lock().unwrap_or_else(PoisonError::into_inner) = results;
            Ok(())
        })?;
        let found = found.into_iter().map(Mutex::into_inner);
        // Nothing is lost, whatever a thread did while it held the lock.
        Ok(found
            .flat_map(|results| results.unwrap_or_else(PoisonError::into_inner))
            .collect())
    })
}

/// Does a run by its index.
type Run<'a> = &'a mut dyn FnMut(usize) -> Result<()>;

/// Does each run of a block.
type Each<'a> = &'a dyn Fn(Run<'_>) -> Result<()>;

/// Does the runs of every block of a size.
fn each_block(
    (count, size): (usize, usize),
    work: Work<'_>,
    runs_of: &(dyn Fn(usize, Each<'_>) -> Result<()> + Sync),
) -> Result<()> {
    let failure = First::new();
    let block = |block: usize| {
        let runs = block * size..count.min((block + 1) * size);
        runs_of(block, &|run| {
            for index in runs.clone() {
                if (work.interrupted)() {
                    return Err(Failure::Interrupted);
                }
                // Runs before a failure continue: which one is met first depends on the threads.
                if failure.before(index) {
                    break;
                }
                if let Err(error) = run(index) {
                    failure.add(index, error);
                }
                (work.progress)(1);
            }
            Ok(())
        })
    };
    try_map(count.div_ceil(size), block)?;
    failure.or(())
}

/// The failure of the first run by index.
struct First {
    index: AtomicUsize,
    error: Mutex<Option<Failure>>,
}

impl First {
    fn new() -> Self {
        Self {
            index: AtomicUsize::new(usize::MAX),
            error: Mutex::new(None),
        }
    }

    /// Whether a run before this one failed.
    fn before(&self, index: usize) -> bool {
        self.index.load(Ordering::Relaxed) < index
    }

    fn add(&self, index: usize, error: Failure) {
        // A thread that panics while it holds the lock ends the whole batch.
        if let Ok(mut kept) = self.error.lock()
            && index < self.index.load(Ordering::Relaxed)
        {
            self.index.store(index, Ordering::Relaxed);
            *kept = Some(error.of_run(|_| index));
        }
    }

    fn or<T>(self, results: T) -> Result<T> {
        match self.error.into_inner() {
            Ok(Some(error)) => Err(error),
            _ => Ok(results),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Work, each_run};
    use crate::error::Failure;

    fn work(threads: Option<usize>) -> Work<'static> {
        Work {
            threads,
            interrupted: &|| false,
            progress: &|_| (),
        }
    }

    #[test]
    fn results_stand_in_order_for_any_number_of_threads() {
        for threads in [None, Some(1), Some(3)] {
            let found = each_run(100, work(threads), |index| Ok(index * index));
            let expected: Vec<usize> = (0..100).map(|index| index * index).collect();
            assert_eq!(found, Ok(expected));
        }
    }

    #[test]
    fn a_request_to_stop_ends_the_batch() {
        let asked = Work {
            interrupted: &|| true,
            ..work(None)
        };
        assert_eq!(each_run(10, asked, Ok), Err(Failure::Interrupted));
    }

    #[test]
    fn an_error_names_its_run() {
        let failing = |index| {
            if index >= 7 {
                Err(Failure::non_finite(0, 0.5))
            } else {
                Ok(index)
            }
        };
        for count in [10, 5000] {
            let found = each_run(count, work(Some(2)), failing);
            assert_eq!(found, Err(Failure::non_finite(7, 0.5)));
        }
    }
}
