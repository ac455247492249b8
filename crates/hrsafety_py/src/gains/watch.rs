//! A search works in another thread while this one looks at signals, reports progress and saves.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use numeric::error::Result;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use vff_core::search::{Control, Observer, Report, SearchState, Stage};

use crate::errors::CoreError;
use crate::gains::problem::GainProblem;
use crate::signals::attended;

/// Time between two checkpoints.
const SAVE: Duration = Duration::from_secs(5);

/// Where a search is.
type Progress = (String, u64, u64, f64);

/// Python callables that follow a search.
pub struct Followers {
    /// Called with (stage, done, total, best value).
    pub progress: Option<Py<PyAny>>,
    /// Called with the state as bytes.
    pub save: Option<Py<PyAny>>,
}

/// Reports of the observer for the thread that holds the interpreter.
struct Watch {
    latest: Mutex<Option<Progress>>,
    state: Mutex<Option<SearchState>>,
    saved: Mutex<Instant>,
    saving: bool,
    stop: AtomicBool,
}

impl Observer for Watch {
    fn report(&self, report: &Report<'_>, state: &dyn Fn() -> SearchState) -> Control {
        let best = report.best.filter(|best| best.score.feasible());
        let best = best.map_or(f64::NEG_INFINITY, |best| best.score.value);
        if let Ok(mut latest) = self.latest.lock() {
            *latest = Some((stage_word(report.stage), report.done, report.total, best));
        }
        let stop = self.stop.load(Ordering::Relaxed);
        let wanted = self.saving && (stop || report.done == report.total || self.due());
        if wanted && let Ok(mut slot) = self.state.lock() {
            *slot = Some(state());
        }
        if stop {
            Control::Stop
        } else {
            Control::Continue
        }
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

impl Watch {
    fn due(&self) -> bool {
        let Ok(mut saved) = self.saved.lock() else {
            return false;
        };
        let due = saved.elapsed() >= SAVE;
        if due {
            *saved = Instant::now();
        }
        due
    }

    /// Looks at signals, reports progress and saves if there is anything new.
    fn look(&self, followers: &Followers, reported: &mut Option<Progress>) -> PyResult<()> {
        Python::attach(|py| {
            self.save(py, followers)?;
            py.check_signals()?;
            let latest = self.latest.lock().ok().and_then(|latest| latest.clone());
            match (&followers.progress, latest) {
                (Some(report), Some(now)) if Some(&now) != reported.as_ref() => {
                    *reported = Some(now.clone());
                    report.call1(py, now).map(|_| ())
                }
                _ => Ok(()),
            }
        })
    }

    fn save(&self, py: Python<'_>, followers: &Followers) -> PyResult<()> {
        let state = self.state.lock().ok().and_then(|mut state| state.take());
        match (&followers.save, state) {
            (Some(save), Some(state)) => {
                let bytes = PyBytes::new(py, &state.to_bytes());
                save.call1(py, (bytes,)).map(|_| ())
            }
            _ => Ok(()),
        }
    }
}

/// Runs a search to its end, or to the first signal or exception.
///
/// Ctrl-C ends the search and is answered by its result; any other exception is raised.
pub fn follow<T: Send>(
    problem: &GainProblem,
    followers: &Followers,
    search: impl FnOnce(&dyn Observer) -> Result<T> + Send,
) -> PyResult<T> {
    let watch = Watch {
        latest: Mutex::new(None),
        state: Mutex::new(None),
        saved: Mutex::new(Instant::now()),
        saving: followers.save.is_some(),
        stop: AtomicBool::new(false),
    };
    let mut reported = None;
    let (result, raised) = attended(
        || search(&watch),
        || watch.look(followers, &mut reported),
        || watch.stop.store(true, Ordering::Relaxed),
    )?;
    conclude(problem, &watch, followers, result, raised, &mut reported)
}

/// Saves the last state and decides between result and exception.
fn conclude<T>(
    problem: &GainProblem,
    watch: &Watch,
    followers: &Followers,
    result: Result<T>,
    raised: Option<PyErr>,
    reported: &mut Option<Progress>,
) -> PyResult<T> {
    let saved = Python::attach(|py| watch.save(py, followers));
    if let Some(error) = problem.take_raised() {
        return Err(error);
    }
    saved?;
    match raised {
        None => {
            let found = result.map_err(CoreError::from)?;
            match watch.look(followers, reported) {
                Err(error) if !is_interrupt(&error) => Err(error),
                _ => Ok(found),
            }
        }
        Some(error) => match result {
            Ok(found) if is_interrupt(&error) => Ok(found),
            _ => Err(error),
        },
    }
}

fn is_interrupt(error: &PyErr) -> bool {
    Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py))
}

/// The word for a stage.
fn stage_word(stage: Stage) -> String {
    match stage {
        Stage::Grid { round } => format!("grid {}", round + 1),
        Stage::Local => "local".into(),
        Stage::Global => "global".into(),
        Stage::Front { round } => format!("front {}", round + 1),
    }
}
