//! Thread pools for batches: the one place where work is spread over threads.
//!
//! Pools are kept between batches, and belong to the process that made them. The child of a fork
//! inherits the memory of its parent's pools but none of their threads, so that it would wait for
//! them forever; it leaves them alone and makes its own.

use std::cell::Cell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::error::{Failure, Given, NoThreads, Result};

/// Whether the caller asks to stop.
pub type Interrupted<'a> = &'a (dyn Fn() -> bool + Sync);

/// Most threads of a pool.
pub const MOST_THREADS: usize = 1024;

/// Most pools that are kept while no batch uses them.
const MOST_IDLE: usize = 4;

/// Pools that no batch uses now. It is never waited for: a fork may happen while it is locked.
static IDLE: Mutex<Vec<Team>> = Mutex::new(Vec::new());

thread_local! {
    /// Whether the work of this thread is to stay on it.
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// A pool with what it may be used for.
struct Team {
    /// The process that its threads belong to.
    process: u32,
    /// Number of threads asked for; all cores when `None`.
    threads: Option<usize>,
    pool: rayon::ThreadPool,
}

/// A pool in use by one batch; it becomes idle at the end, also if the batch panics.
///
/// No two batches share a pool: work of one may wait for another, as when an objective is a
/// callable that runs a batch of its own.
struct Leased(Option<Team>);

impl Leased {
    fn take(threads: Option<usize>) -> Result<Self> {
        let process = std::process::id();
        let idle = IDLE.try_lock().ok().and_then(|mut idle| {
            // Dropping a pool waits for its threads, and those of another process are not here.
            let (own, others) = idle.drain(..).partition(|team| team.process == process);
            *idle = own;
            others.into_iter().for_each(std::mem::forget);
            let found = idle.iter().position(|team| team.threads == threads)?;
            Some(idle.remove(found))
        });
        let team = match idle {
            Some(team) => team,
            None => Team {
                process,
                threads,
                pool: pool(threads)?,
            },
        };
        Ok(Self(Some(team)))
    }
}

impl Drop for Leased {
    fn drop(&mut self) {
        let Some(team) = self.0.take() else { return };
        if team.process != std::process::id() {
            std::mem::forget(team);
        } else if let Ok(mut idle) = IDLE.try_lock() {
            if idle.len() == MOST_IDLE {
                idle.remove(0);
            }
            idle.push(team);
        }
    }
}

fn pool(threads: Option<usize>) -> Result<rayon::ThreadPool> {
    let count = threads.unwrap_or(0);
    rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .build()
        .map_err(|error| {
            Failure::Threads(Box::new(NoThreads {
                threads: count,
                reason: error.to_string(),
            }))
        })
}

/// Restores what was before when dropped, also if the work panics.
struct Alone {
    before: bool,
}

impl Alone {
    fn begin() -> Self {
        let before = ALONE.replace(true);
        Self { before }
    }
}

impl Drop for Alone {
    fn drop(&mut self) {
        ALONE.set(self.before);
    }
}

/// Whether work is spread over threads here.
fn spread() -> bool {
    !ALONE.get() && rayon::current_thread_index().is_some()
}

/// Number of threads that share the work here.
#[must_use]
pub fn team() -> usize {
    if spread() {
        rayon::current_num_threads()
    } else {
        1
    }
}

/// Does the work on a number of threads; on all cores, or on those that already do the work of
/// which this is a part, when `None`. One thread is the calling one, without a pool.
///
/// # Errors
/// The work fails, or there is no such thread pool.
pub fn on_threads<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<T> + Send,
) -> Result<T> {
    let (mut work, mut result) = (Some(work), None);
    carry_out(threads, &mut || result = work.take().map(|work| work()))?;
    result.unwrap_or(Err(Failure::Interrupted))
}

/// Compiled once, not once for each batch, as are [`install`] and [`spread_out`]: what a pool does with
/// work is long.
fn carry_out(threads: Option<usize>, work: &mut (dyn FnMut() + Send)) -> Result<()> {
    match threads {
        Some(0) => {
            let rule = format!("be from 1 to {MOST_THREADS}");
            return Err(Failure::invalid("threads", rule, Given::Count(0)));
        }
        Some(1) => {
            let _alone = Alone::begin();
            work();
        }
        Some(count) => {
            crate::error::at_most("threads", count, MOST_THREADS)?;
            install(&Leased::take(threads)?, work);
        }
        None if ALONE.get() || spread() => work(),
        None => install(&Leased::take(None)?, work),
    }
    Ok(())
}

/// Does work on the threads of a pool.
fn install(leased: &Leased, work: &mut (dyn FnMut() + Send)) {
    if let Some(team) = &leased.0 {
        team.pool.install(work);
    }
}

/// Does `work(0)`, `work(1)`, ... on the threads that share the work here.
fn spread_out(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(work);
}

/// Values of `of(0)`, `of(1)`, ... in this order.
pub fn map<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    if spread() {
        map_spread_out(count, &of)
    } else {
        (0..count).map(of).collect()
    }
}

/// Compiled once for each kind of value, as [`spread_out`] is.
fn map_spread_out<T: Send>(count: usize, of: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    (0..count).into_par_iter().map(of).collect()
}

/// Values of `of(0)`, `of(1)`, ... in this order, or one of the errors.
///
/// # Errors
/// A value could not be had; which of several errors it is depends on the threads.
pub fn try_map<T: Send, E: Send>(
    count: usize,
    of: impl Fn(usize) -> std::result::Result<T, E> + Sync + Send,
) -> std::result::Result<Vec<T>, E> {
    if !spread() {
        return (0..count).map(of).collect();
    }
    let failed = AtomicBool::new(false);
    let found: Vec<Mutex<Option<_>>> = (0..count).map(|_| Mutex::new(None)).collect();
    spread_out(count, &|index| {
        if failed.load(Ordering::Relaxed) {
            return;
        }
        let value = of(index);
        if value.is_err() {
            failed.store(true, Ordering::Relaxed);
        }
        // Nobody else takes this lock: a thread that panics ends the whole batch.
        if let Ok(mut place) = found[index].lock() {
            *place = Some(value);
        }
    });
    // After a failure some values are missing, behind an error or before it; the error is returned.
    let values = found
        .into_iter()
        .filter_map(|place| place.into_inner().ok().flatten());
    values.collect()
}

/// Does something with each of some items.
///
/// # Errors
/// One of the items failed; which of several errors it is depends on the threads.
pub fn try_each<I: Send, E: Send>(
    items: Vec<I>,
    work: impl Fn(I) -> std::result::Result<(), E> + Sync + Send,
) -> std::result::Result<(), E> {
    if !spread() {
        return items.into_iter().try_for_each(work);
    }
    let items: Vec<Mutex<Option<I>>> = items
        .into_iter()
        .map(|item| Mutex::new(Some(item)))
        .collect();
    try_map(items.len(), |index| {
        let item = items[index].lock().ok().and_then(|mut place| place.take());
        item.map_or(Ok(()), &work)
    })
    .map(drop)
}

/// Does something with each whole piece of a slice, and its index.
pub fn each_piece<T: Send>(
    slice: &mut [T],
    length: usize,
    work: impl Fn(usize, &mut [T]) + Sync + Send,
) {
    if spread() {
        each_piece_spread_out(slice, length, &work);
    } else {
        for (index, piece) in slice.chunks_exact_mut(length).enumerate() {
            work(index, piece);
        }
    }
}

/// Compiled once for each kind of value, as [`spread_out`] is.
fn each_piece_spread_out<T: Send>(
    slice: &mut [T],
    length: usize,
    work: &(dyn Fn(usize, &mut [T]) + Sync),
) {
    let pieces = slice.par_chunks_exact_mut(length).enumerate();
    pieces.for_each(|(index, piece)| work(index, piece));
}

#[cfg(test)]
mod tests {
    use super::{MOST_THREADS, map, on_threads, team, try_each, try_map};

    #[test]
    fn one_thread_is_the_calling_one() {
        let caller = std::thread::current().id();
        let found = on_threads(Some(1), || {
            let inner = on_threads(None, || Ok(map(100, |_| std::thread::current().id())))?;
            Ok((team(), inner))
        });
        let (size, met) = found.unwrap_or_default();
        assert_eq!(size, 1);
        assert!(met.len() == 100 && met.iter().all(|id| *id == caller));
    }

    #[test]
    fn a_part_of_the_work_stays_on_its_threads() {
        let inner = on_threads(Some(3), || on_threads(None, || Ok(team())));
        assert_eq!(inner, Ok(3));
        let other = on_threads(Some(3), || on_threads(Some(1), || Ok(team())));
        assert_eq!(other, Ok(1));
        let more = on_threads(Some(1), || on_threads(Some(2), || Ok(team())));
        assert_eq!(more, Ok(2));
    }

    #[test]
    fn nested_batches_on_as_many_threads_do_not_wait_for_each_other() {
        let nested = on_threads(Some(2), || {
            try_map(8, |_| {
                // As a callable does: the batch inside begins on a thread of its own.
                std::thread::scope(|scope| {
                    let inner = scope.spawn(|| on_threads(Some(2), || Ok(map(8, |value| value))));
                    inner.join().unwrap_or(Ok(Vec::new()))
                })
            })
        });
        assert_eq!(nested, Ok(vec![(0..8).collect::<Vec<_>>(); 8]));
    }

    #[test]
    fn counts_beyond_the_bounds_are_refused() {
        for count in [0, MOST_THREADS + 1, usize::MAX] {
            assert!(on_threads(Some(count), || Ok(())).is_err());
        }
    }

    #[test]
    fn an_error_ends_the_work() {
        for threads in [1, 3] {
            let work = || {
                Ok(try_each((0..100).collect(), |item| {
                    if item == 7 { Err(item) } else { Ok(()) }
                }))
            };
            assert_eq!(on_threads(Some(threads), work), Ok(Err(7)));
        }
    }
}
