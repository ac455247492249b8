//! Runs of robots as built: one, its score, and many.

use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::as_built::{
    self, AsBuiltTrajectory, Histories, ManyOptions, PoseFusion, SteeringLaw, evaluate_as_built,
    run_many_as_built, simulate_as_built,
};
use vff_core::run::{AnyLaw, Contact, RunSummary};
use vff_core::world::scenario;

use crate::arrays::fields;
use crate::errors::InvalidParameterError;
use crate::keywords::{Keywords, taken};
use crate::laws::Law;
use crate::parameters::Scenario;
use crate::robots::differential::{Tracking, VirtualTorque};
use crate::robots::sensing::Sensor;
use crate::robots::wheels::{OmniKinematics, Slip, WheelDrive};
use crate::run::batch::columns;
use crate::run::{trajectory_fields, weights_of};
use crate::scenes::Scenes;
use crate::watch::{Report, watched_law};

/// How a robot is built.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct AsBuilt(as_built::AsBuilt);

#[pymethods]
impl AsBuilt {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let wheels: Option<Vec<PyRef<'_, WheelDrive>>> = given.take("wheels")?;
        let kinematics: PyRef<'_, OmniKinematics> = given.take("kinematics")?;
        let slip: PyRef<'_, Slip> = given.take("slip")?;
        let tracking: Bound<'_, PyAny> = given.take("tracking")?;
        let sensors: Vec<PyRef<'_, Sensor>> = given.take("sensors")?;
        let steering_law = match tracking.cast::<Tracking>() {
            Ok(law) => SteeringLaw::Following(law.get().0),
            Err(_) => SteeringLaw::Torque(tracking.cast::<VirtualTorque>()?.get().0),
        };
        let fusion = taken!(given: PoseFusion {
            position as position_share, heading as heading_share, mark as mark_distance,
        });
        given.done()?;
        Ok(Self(as_built::AsBuilt {
            wheels: wheels.map(|wheels| wheels.iter().map(|wheel| *wheel.core()).collect()),
            omni: kinematics.0,
            slip: slip.0,
            steering_law,
            sensors: sensors.iter().map(|sensor| sensor.0.clone()).collect(),
            fusion,
            ..as_built::AsBuilt::default()
        }))
    }
}

impl AsBuilt {
    /// It with the options of a run.
    pub fn run(&self, step: f64, stop_on_contact: bool) -> as_built::AsBuilt {
        as_built::AsBuilt {
            step,
            stop_on_contact,
            ..self.0.clone()
        }
    }
}

/// Fields of a run of a robot as built.
pub fn as_built_fields<'py>(
    py: Python<'py>,
    scenario: &scenario::Scenario,
    summary: RunSummary,
    columns: AsBuiltTrajectory,
) -> PyResult<Bound<'py, PyDict>> {
    let (rows, wheels) = (columns.heading.len(), columns.wheels);
    let all = trajectory_fields(py, scenario, summary, columns.motion)?;
    let fields = fields! { py;
        vector columns: heading, energy_used;
        array [rows, wheels] columns: wheel_speed, wheel_current;
        array [rows, 2] columns: reference_position, seen_position;
    };
    all.update(fields.as_mapping())?;
    Ok(all)
}

/// One run: fields of a trajectory.
#[pyfunction]
#[pyo3(signature = (scenario, law, built, *, step, stop_on_contact))]
pub fn as_built_simulate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    law: &Law,
    built: &AsBuilt,
    step: f64,
    stop_on_contact: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let built = built.run(step, stop_on_contact);
    let (summary, columns) = watched_law(py, (law, Some(1)), Report::none(), |control| {
        simulate_as_built(&scenario.0, &law.any, &built, &|| control.interrupted())
    })?;
    as_built_fields(py, &scenario.0, summary, columns)
}

/// Score of a run: its parts, the run and the nominal run.
#[pyfunction]
#[pyo3(signature = (scenario, law, built, weights, *, step))]
pub fn as_built_evaluate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    law: &Law,
    built: &AsBuilt,
    weights: (f64, f64, f64),
    step: f64,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>, Bound<'py, PyDict>)> {
    let built = built.run(step, false);
    let weights = weights_of(weights);
    let (score, run, nominal) = watched_law(py, (law, Some(1)), Report::none(), |control| {
        let interrupted = || control.interrupted();
        evaluate_as_built(&scenario.0, &law.any, &built, weights, &interrupted)
    })?;
    let scores = fields! { py;
        value score: total, arrival_time, avoidance, energy_saving;
    };
    Ok((
        scores,
        as_built_fields(py, &scenario.0, run.0, run.1)?,
        as_built_fields(py, &scenario.0.nominal(), nominal.0, nominal.1)?,
    ))
}

/// Runs of every law in every scenario: columns of a batch, and histories padded with NaN if asked for.
#[pyfunction]
#[pyo3(signature = (scenarios, laws, gains, built, weights, **given))]
pub fn as_built_many<'py>(
    py: Python<'py>,
    scenarios: Scenes,
    laws: Vec<PyRef<'py, Law>>,
    gains: PyReadonlyArray2<'py, f64>,
    built: &AsBuilt,
    weights: (f64, f64, f64),
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let built = built.run(given.take("step")?, given.take("stop_on_contact")?);
    let (histories, threads) = (given.take("histories")?, given.take("threads")?);
    let progress: Option<Py<PyAny>> = given.take("progress")?;
    given.done()?;
    // Laws in Python run in the thread of their caller, and so do all beside them.
    let lead = laws.iter().find(|law| law.is_python()).or(laws.first());
    let lead: &Law = lead.ok_or_else(|| {
        InvalidParameterError::new_err(("laws", "hold at least one law", "an empty list"))
    })?;
    let options = ManyOptions {
        weights: weights_of(weights),
        histories,
        threads: lead.threads(threads),
    };
    let points = gains.as_slice()?.to_vec();
    let driven: Vec<AnyLaw> = laws.iter().map(|law| law.any.clone()).collect();
    let report = Report::new(progress.as_ref(), driven.len() * scenarios.len());
    let runs = watched_law(py, (lead, options.threads), report, |control| {
        let interrupted = || control.interrupted();
        let count = |runs| control.count(runs);
        run_many_as_built(&scenarios, &driven, &built, &options, &interrupted, &count)
    })?;
    let obstacles = runs.table.obstacles;
    let all = columns(py, (&points, gains.shape()[1]), runs.table)?;
    all.update(contact_fields(py, &runs.contact, obstacles)?.as_mapping())?;
    if histories {
        all.update(history_fields(py, &runs.histories, obstacles)?.as_mapping())?;
    }
    Ok(all)
}

/// Time and speed of the first contacts, a row a run; NaN without.
fn contact_fields<'py>(
    py: Python<'py>,
    runs: &[Vec<Option<Contact>>],
    obstacles: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let column = |value: fn(&Contact) -> f64| -> Vec<f64> {
        let mut all = Vec::with_capacity(runs.len() * obstacles);
        for (index, touches) in runs.iter().enumerate() {
            let own = touches.iter();
            all.extend(own.map(|touch| touch.as_ref().map_or(f64::NAN, value)));
            all.resize((index + 1) * obstacles, f64::NAN);
        }
        all
    };
    let (time, speed) = (column(|touch| touch.time), column(|touch| touch.speed));
    Ok(fields! { py;
        array [runs.len(), obstacles] contact_time = time;
        array [runs.len(), obstacles] contact_speed = speed;
    })
}

/// Histories of runs, a row a run, padded with NaN.
fn history_fields<'py>(
    py: Python<'py>,
    runs: &[Histories],
    obstacles: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let count = runs.len();
    let longest = runs.iter().map(|kept| kept.time.len()).max().unwrap_or(0);
    let padded = |width: usize, values: &dyn Fn(&Histories) -> Vec<f64>| -> Vec<f64> {
        let mut all = Vec::with_capacity(count * longest * width);
        for (index, kept) in runs.iter().enumerate() {
            all.extend(values(kept));
            all.resize((index + 1) * longest * width, f64::NAN);
        }
        all
    };
    let position = padded(2, &|kept| kept.position.concat());
    let distance = padded(obstacles, &|kept| widened(kept, obstacles));
    Ok(fields! { py;
        array [count, longest] time = padded(1, &|kept| kept.time.clone());
        array [count, longest, 2] position = position;
        array [count, longest, obstacles] distance = distance;
    })
}

/// Distances with as many columns as the scenario with the most obstacles has.
fn widened(kept: &Histories, obstacles: usize) -> Vec<f64> {
    let own = kept.distance.len() / kept.time.len().max(1);
    if own == obstacles {
        return kept.distance.clone();
    }
    let mut all = Vec::with_capacity(kept.time.len() * obstacles);
    for (row, _) in kept.time.iter().enumerate() {
        all.extend_from_slice(&kept.distance[row * own..(row + 1) * own]);
        all.resize((row + 1) * obstacles, f64::NAN);
    }
    all
}
