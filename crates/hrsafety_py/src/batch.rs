//! Batches: one crossing of the boundary, interpreter released, Ctrl-C answered.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::error::{NavigationError, Result};
use vff_core::gains::Gains;
use vff_core::laws;
use vff_core::metrics::clearances;
use vff_core::scenario;
use vff_core::simulate::{BatchOptions, CONTACT_SPEED, Instructions, ScoredRun, Width, run_batch};

use crate::arrays::Fields;
use crate::errors::{CoreError, SimulationError};
use crate::parameters::{Scenario, VirtualForceField, gain_set};
use crate::run::{outcome_word, run_options, weights_of};

/// Time between two looks at signals and progress.
const LOOK: Duration = Duration::from_millis(50);

/// Summary columns of every gain set in every scenario.
#[pyfunction]
#[pyo3(signature = (scenarios, law, gains, weights, *, integrator, step, hold, stop_on_contact,
    descent, threads, lanes, progress))]
#[allow(clippy::too_many_arguments)] // keyword-only in Python
#[allow(clippy::fn_params_excessive_bools)] // keyword-only in Python
#[allow(clippy::needless_pass_by_value)] // references to Python objects
pub fn simulate_batch<'py>(
    py: Python<'py>,
    scenarios: Vec<PyRef<'py, Scenario>>,
    law: &VirtualForceField,
    gains: PyReadonlyArray2<'py, f64>,
    weights: (f64, f64, f64),
    integrator: &Bound<'py, PyAny>,
    step: f64,
    hold: bool,
    stop_on_contact: bool,
    descent: bool,
    threads: Option<usize>,
    lanes: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let width = lanes.map(Width::of).transpose().map_err(CoreError::from)?;
    let options = BatchOptions {
        run: run_options(integrator, step, hold, stop_on_contact)?,
        weights: weights_of(weights),
        descent,
        threads,
        width,
        instructions: Instructions::Widest,
    };
    let sets: Vec<Gains> = gains
        .as_slice()?
        .chunks_exact(gains.shape()[1])
        .map(|row| gain_set([row[0], row[1], row[2], row[3]]))
        .collect();
    let scenarios: Vec<scenario::Scenario> = scenarios
        .iter()
        .map(|scenario| scenario.0.clone())
        .collect();
    let job = Job {
        scenarios: &scenarios,
        law: &law.0,
        sets: &sets,
        options: &options,
    };
    let rows = py.detach(|| job.run(progress.as_ref()))?;
    columns(py, &scenarios, &sets, &rows)
}

struct Job<'a> {
    scenarios: &'a [scenario::Scenario],
    law: &'a laws::VirtualForceField,
    sets: &'a [Gains],
    options: &'a BatchOptions,
}

impl Job<'_> {
    /// Works in another thread while this one looks at signals and reports progress.
    fn run(&self, progress: Option<&Py<PyAny>>) -> PyResult<Vec<ScoredRun>> {
        let cancelled = AtomicBool::new(false);
        let done = AtomicUsize::new(0);
        let total = self.sets.len() * self.scenarios.len();
        let (sender, receiver) = mpsc::channel();
        std::thread::scope(|scope| {
            let worker = scope.spawn(|| {
                let interrupted = || cancelled.load(Ordering::Relaxed);
                let count = |runs| {
                    done.fetch_add(runs, Ordering::Relaxed);
                };
                let result: Result<Vec<ScoredRun>> = run_batch(
                    self.scenarios,
                    self.law,
                    self.sets,
                    self.options,
                    &interrupted,
                    &count,
                );
                // The receiver waits until this has been sent.
                sender.send(()).ok();
                result
            });
            let mut raised = None;
            let mut reported = usize::MAX;
            loop {
                match receiver.recv_timeout(LOOK) {
                    Err(RecvTimeoutError::Timeout) if raised.is_none() => {
                        let now = done.load(Ordering::Relaxed);
                        if let Err(error) = look(progress, now, total, &mut reported) {
                            cancelled.store(true, Ordering::Relaxed);
                            raised = Some(error);
                        }
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Ok(()) | Err(RecvTimeoutError::Disconnected) => break,
                }
            }
            let result = worker
                .join()
                .map_err(|_| SimulationError::new_err("a worker thread ended unexpectedly"))?;
            if let Some(error) = raised {
                return Err(error);
            }
            let rows = result.map_err(|error: NavigationError| CoreError::from(error))?;
            look(progress, total, total, &mut reported)?;
            Ok(rows)
        })
    }
}

/// Looks at signals and reports progress if there is any.
fn look(
    progress: Option<&Py<PyAny>>,
    done: usize,
    total: usize,
    reported: &mut usize,
) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        match progress {
            Some(report) if done != *reported => {
                *reported = done;
                report.call1(py, (done, total)).map(|_| ())
            }
            _ => Ok(()),
        }
    })
}

fn columns<'py>(
    py: Python<'py>,
    scenarios: &[scenario::Scenario],
    sets: &[Gains],
    rows: &[ScoredRun],
) -> PyResult<Bound<'py, PyDict>> {
    let fields = Fields::new(py);
    index_columns(&fields, scenarios.len(), sets, rows.len())?;
    run_columns(&fields, rows)?;
    distance_columns(&fields, scenarios, rows)?;
    score_columns(&fields, rows)?;
    Ok(fields.finish())
}

/// Which gains and which scenario; the scenarios vary fastest.
fn index_columns(
    fields: &Fields<'_>,
    scenarios: usize,
    sets: &[Gains],
    rows: usize,
) -> PyResult<()> {
    let indices = || (0..rows).map(|row| (row / scenarios, row % scenarios));
    let gains = indices()
        .flat_map(|(set, _)| {
            let Gains {
                attractive,
                repulsive,
                detour,
                ratio,
            } = sets[set];
            [attractive, repulsive, detour, ratio]
        })
        .collect();
    let of_gains = indices().map(|(set, _)| signed(set)).collect();
    fields.vector("gain_index", of_gains)?;
    let of_scenarios = indices().map(|(_, index)| signed(index)).collect();
    fields.vector("scenario_index", of_scenarios)?;
    fields.matrix("gains", gains, rows, 4)
}

/// How the runs ended and what they took.
fn run_columns(fields: &Fields<'_>, rows: &[ScoredRun]) -> PyResult<()> {
    let of = |value: fn(&ScoredRun) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    let outcomes = rows.iter().map(|row| outcome_word(row.run.outcome));
    fields.words("outcome", outcomes)?;
    fields.vector("end_time", of(|row| row.run.end_time))?;
    let arrival_time = of(|row| row.run.arrival_time.unwrap_or(f64::NAN));
    fields.vector("arrival_time", arrival_time)?;
    fields.vector("energy", of(|row| row.run.energy))?;
    fields.vector("path_length", of(|row| row.run.path_length))?;
    fields.vector("descent_share", of(|row| row.run.descent_share))?;
    let evaluations = rows
        .iter()
        .map(|row| row.run.force_evaluations.cast_signed())
        .collect();
    fields.vector("force_evaluations", evaluations)
}

/// How near the runs came to the obstacles.
fn distance_columns(
    fields: &Fields<'_>,
    scenarios: &[scenario::Scenario],
    rows: &[ScoredRun],
) -> PyResult<()> {
    let count = |scenario: &scenario::Scenario| scenario.obstacle_count();
    let widest = scenarios.iter().map(count).max().unwrap_or(0);
    let mut distances = Vec::with_capacity(rows.len() * widest);
    let mut least = Vec::with_capacity(rows.len());
    let mut entered = Vec::with_capacity(rows.len());
    for (row, scenario) in rows.iter().zip(scenarios.iter().cycle()) {
        let own = &row.run.min_distance;
        distances.extend(own);
        distances.resize(distances.len() + widest - own.len(), f64::NAN);
        let clearances = clearances(scenario, &row.run).into_iter();
        least.push(clearances.fold(f64::INFINITY, f64::min));
        let inside = own
            .iter()
            .zip(scenario.obstacles())
            .filter(|(distance, placed)| **distance < placed.regions.active_radius);
        entered.push(signed(inside.count()));
    }
    fields.matrix("min_distance", distances, rows.len(), widest)?;
    fields.vector("min_clearance", least)?;
    fields.vector("entered_active", entered)?;
    fields.vector("contacts_moving", contacts(rows, true))?;
    fields.vector("contacts_standing", contacts(rows, false))
}

/// Number of obstacles that each robot touched while it moved, or while it stood.
fn contacts(rows: &[ScoredRun], moving: bool) -> Vec<i64> {
    let count = |row: &ScoredRun| {
        let touches = row.run.contact.iter().flatten();
        let kind = touches.filter(|touch| (touch.speed > CONTACT_SPEED) == moving);
        signed(kind.count())
    };
    rows.iter().map(count).collect()
}

/// The scores.
fn score_columns(fields: &Fields<'_>, rows: &[ScoredRun]) -> PyResult<()> {
    let of = |value: fn(&ScoredRun) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    fields.vector("performance_total", of(|row| row.performance.total))?;
    let arrival_time = of(|row| row.performance.arrival_time);
    fields.vector("performance_arrival_time", arrival_time)?;
    fields.vector("performance_avoidance", of(|row| row.performance.avoidance))?;
    let energy_saving = of(|row| row.performance.energy_saving);
    fields.vector("performance_energy_saving", energy_saving)
}

/// A count as Python's integer type of arrays.
fn signed(count: usize) -> i64 {
    count.try_into().unwrap_or(i64::MAX)
}
