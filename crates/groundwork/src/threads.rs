//! Thread pools for batches.

use crate::error::{Failure, Result};

/// Does the work on a number of threads of its own, or on those that are there.
///
/// # Errors
/// The work fails, or there is no such thread pool.
pub fn on_threads<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<T> + Send,
) -> Result<T> {
    match threads {
        None => work(),
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| Failure::Threads {
                threads,
                reason: error.to_string(),
            })?
            .install(work),
    }
}
