//! Long work of the cores: it is told to stop, and reports how much is done.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use numeric::error::Failure;
use numeric::parallel::{Work, each_run};
use pyo3::prelude::*;

use crate::errors::CoreError;
use crate::laws::Law;
use crate::python_law;
use crate::signals::attended;

/// Time between two looks of work that looks at signals itself.
const LOOK: Duration = Duration::from_millis(50);

/// Most questions whether to stop of which one reads the clock.
const MOST_QUESTIONS: u32 = 64;

/// The clock is read more often when so much time has passed since it was read last.
const LONG: Duration = Duration::from_millis(1);

/// Questions and reports of work while it runs.
#[derive(Default)]
pub struct Control<'a> {
    cancelled: AtomicBool,
    done: AtomicUsize,
    /// Looks from within the work, where no other thread does.
    own: Option<Mutex<Looks<'a>>>,
    /// Questions until the clock is read, and of how many one reads it: a control step of a fast
    /// law takes little longer than that.
    left: AtomicU32,
    stride: AtomicU32,
}

/// Looks at signals and progress from within the work.
struct Looks<'a> {
    report: Report<'a>,
    /// When the clock was read last.
    read: Instant,
    next: Instant,
    reported: Option<usize>,
    raised: Option<PyErr>,
}

impl Control<'_> {
    /// Whether to stop.
    pub fn interrupted(&self) -> bool {
        if self.cancelled.load(Ordering::Relaxed) {
            return true;
        }
        let Some(own) = &self.own else { return false };
        let left = self.left.load(Ordering::Relaxed);
        if left > 0 {
            self.left.store(left - 1, Ordering::Relaxed);
            return false;
        }
        let Ok(mut looks) = own.lock() else {
            return false;
        };
        let now = Instant::now();
        let stride = if now - looks.read < LONG {
            (2 * self.stride.load(Ordering::Relaxed)).clamp(1, MOST_QUESTIONS)
        } else {
            1
        };
        looks.read = now;
        self.stride.store(stride, Ordering::Relaxed);
        self.left.store(stride - 1, Ordering::Relaxed);
        if now < looks.next {
            return false;
        }
        let (report, mut reported) = (looks.report, looks.reported);
        let done = self.done.load(Ordering::Relaxed);
        if let Err(error) = report.look(done, &mut reported) {
            looks.raised = Some(error);
            self.cancelled.store(true, Ordering::Relaxed);
        }
        looks.reported = reported;
        looks.next = Instant::now() + LOOK;
        looks.raised.is_some()
    }

    /// So much more has been done.
    pub fn count(&self, more: usize) {
        self.done.fetch_add(more, Ordering::Relaxed);
    }
}

/// Python callback `(done, total)`.
#[derive(Clone, Copy, Default)]
pub struct Report<'a> {
    call: Option<&'a Py<PyAny>>,
    total: usize,
}

impl<'a> Report<'a> {
    /// A function, if there is one, and how much there is to do.
    pub fn new(call: Option<&'a Py<PyAny>>, total: usize) -> Self {
        Self { call, total }
    }

    /// Nobody is told.
    pub fn none() -> Self {
        Self::default()
    }

    /// Looks at signals and tells what is new.
    fn look(&self, done: usize, reported: &mut Option<usize>) -> PyResult<()> {
        Python::attach(|py| {
            py.check_signals()?;
            match self.call {
                Some(call) if *reported != Some(done) => {
                    *reported = Some(done);
                    call.call1(py, (done, self.total)).map(|_| ())
                }
                _ => Ok(()),
            }
        })
    }
}

/// Works in this thread, which now and then looks at signals and reports progress itself: short
/// work, and work that runs under the interpreter.
pub fn here<T: Send, E: Send>(
    py: Python<'_>,
    report: Report<'_>,
    work: impl FnOnce(&Control<'_>) -> Result<T, E> + Send,
) -> PyResult<T>
where
    CoreError: From<E>,
{
    let now = Instant::now();
    let control = Control {
        own: Some(Mutex::new(Looks {
            report,
            read: now,
            next: now + LOOK,
            reported: None,
            raised: None,
        })),
        ..Control::default()
    };
    let result = py.detach(|| work(&control));
    if let Some(error) = python_law::raised() {
        return Err(error);
    }
    let looks = control.own.and_then(|looks| looks.into_inner().ok());
    let (raised, mut reported) = looks.map_or((None, None), |own| (own.raised, own.reported));
    if let Some(error) = raised {
        return Err(error);
    }
    let found = result.map_err(CoreError::from)?;
    if report.call.is_some() {
        report.look(report.total, &mut reported)?;
    }
    Ok(found)
}

/// Works under a law: in this thread if the law runs under the interpreter or no other thread is
/// asked for, as `watched` otherwise.
pub fn watched_law<T: Send, E: Send>(
    py: Python<'_>,
    (law, threads): (&Law, Option<usize>),
    report: Report<'_>,
    work: impl FnOnce(&Control<'_>) -> Result<T, E> + Send,
) -> PyResult<T>
where
    CoreError: From<E>,
{
    if law.is_python() || threads == Some(1) {
        here(py, report, work)
    } else {
        watched(py, report, work)
    }
}

/// Works in another thread while this one looks at signals and reports progress; the work is told
/// to stop when one of them raises an exception, and what it returns then is dropped.
pub fn watched<T: Send, E: Send>(
    py: Python<'_>,
    report: Report<'_>,
    work: impl FnOnce(&Control<'_>) -> Result<T, E> + Send,
) -> PyResult<T>
where
    CoreError: From<E>,
{
    let control = Control::default();
    let mut reported = None;
    let (result, raised) = py.detach(|| {
        attended(
            || work(&control),
            || report.look(control.done.load(Ordering::Relaxed), &mut reported),
            || control.cancelled.store(true, Ordering::Relaxed),
        )
    })?;
    if let Some(error) = raised {
        return Err(error);
    }
    let found = result.map_err(CoreError::from)?;
    if report.call.is_some() {
        report.look(report.total, &mut reported)?;
    }
    Ok(found)
}

/// Works as `watched` on so many threads.
pub fn spread<T: Send, E: Send>(
    py: Python<'_>,
    report: Report<'_>,
    threads: Option<usize>,
    work: impl FnOnce(Work<'_>) -> Result<T, E> + Send,
) -> PyResult<T>
where
    CoreError: From<E>,
{
    watched(py, report, |control| {
        work(Work {
            threads,
            interrupted: &|| control.interrupted(),
            progress: &|more| control.count(more),
        })
    })
}

/// Work of one item on all cores, as `watched`; results stand in the order of the items.
pub fn watched_each<T: Send>(
    py: Python<'_>,
    items: &[f64],
    work: impl Fn(f64) -> Result<T, Failure> + Sync,
) -> PyResult<Vec<T>> {
    spread(py, Report::none(), None, |batch| {
        each_run(items.len(), batch, |index| work(items[index]))
    })
}
