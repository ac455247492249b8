//! Runs of robots as built: one, its score, and the same with many seeds.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::built::{
    Built, BuiltTrajectory, Histories, PoseFusion, Steered, evaluate_built, repeat_built,
    simulate_built,
};
use vff_core::run::{Contact, RunSummary};
use vff_core::world::scenario;

use crate::arrays::Fields;
use crate::differential::{Tracking, VirtualTorque};
use crate::laws::Law;
use crate::parameters::Scenario;
use crate::run::{outcome_word, trajectory_fields, weights_of};
use crate::sensing::Vision;
use crate::watch::{Report, watched_law};
use crate::wheels::{OmniKinematics, Slip, WheelDrive};

/// How a robot is built.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct AsBuilt(Built);

#[pymethods]
impl AsBuilt {
    #[new]
    #[pyo3(signature = (*, wheels, kinematics, slip, tracking, robot_vision, obstacle_vision,
        position_share, heading_share, mark_distance))]
    #[allow(clippy::too_many_arguments)] // keyword-only in Python
    #[allow(clippy::needless_pass_by_value)] // references to Python objects
    fn new(
        wheels: Option<Vec<PyRef<'_, WheelDrive>>>,
        kinematics: PyRef<'_, OmniKinematics>,
        slip: PyRef<'_, Slip>,
        tracking: &Bound<'_, PyAny>,
        robot_vision: Option<PyRef<'_, Vision>>,
        obstacle_vision: Option<PyRef<'_, Vision>>,
        position_share: f64,
        heading_share: f64,
        mark_distance: f64,
    ) -> PyResult<Self> {
        let steered = match tracking.cast::<Tracking>() {
            Ok(law) => Steered::Following(law.get().0),
            Err(_) => Steered::Torque(tracking.cast::<VirtualTorque>()?.get().0),
        };
        Ok(Self(Built {
            wheels: wheels.map(|wheels| wheels.iter().map(|wheel| *wheel.core()).collect()),
            omni: kinematics.0,
            slip: slip.0,
            steered,
            robot_vision: robot_vision.map(|vision| vision.0),
            obstacle_vision: obstacle_vision.map(|vision| vision.0),
            fusion: PoseFusion {
                position: position_share,
                heading: heading_share,
                mark: mark_distance,
            },
            ..Built::default()
        }))
    }
}

impl AsBuilt {
    /// It with the options of a run.
    pub fn run(&self, step: f64, stop_on_contact: bool) -> Built {
        Built {
            step,
            stop_on_contact,
            ..self.0.clone()
        }
    }
}

/// Fields of a run of a robot as built.
pub fn built_fields<'py>(
    py: Python<'py>,
    scenario: &scenario::Scenario,
    summary: RunSummary,
    columns: BuiltTrajectory,
) -> PyResult<Bound<'py, PyDict>> {
    let (rows, wheels) = (columns.heading.len(), columns.wheels);
    let all = trajectory_fields(py, scenario, summary, columns.motion)?;
    let fields = Fields::new(py);
    fields.vector("heading", columns.heading)?;
    fields.matrix("wheel_speed", columns.wheel_speed, rows, wheels)?;
    fields.matrix("wheel_current", columns.wheel_current, rows, wheels)?;
    fields.vector("energy_used", columns.energy_used)?;
    fields.matrix("reference_position", columns.reference_position, rows, 2)?;
    fields.matrix("seen_position", columns.seen_position, rows, 2)?;
    all.update(fields.finish().as_mapping())?;
    Ok(all)
}

/// One run: fields of a trajectory.
#[pyfunction]
#[pyo3(signature = (scenario, law, built, *, step, stop_on_contact))]
pub fn built_simulate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    law: &Law,
    built: &AsBuilt,
    step: f64,
    stop_on_contact: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let built = built.run(step, stop_on_contact);
    let (summary, columns) = watched_law(py, law, Report::none(), |control| {
        simulate_built(&scenario.0, &law.any, &built, &|| control.interrupted())
    })?;
    built_fields(py, &scenario.0, summary, columns)
}

/// Score of a run: its parts, the run and the nominal run.
#[pyfunction]
#[pyo3(signature = (scenario, law, built, weights, *, step))]
pub fn built_evaluate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    law: &Law,
    built: &AsBuilt,
    weights: (f64, f64, f64),
    step: f64,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>, Bound<'py, PyDict>)> {
    let built = built.run(step, false);
    let weights = weights_of(weights);
    let (score, run, nominal) = watched_law(py, law, Report::none(), |control| {
        let interrupted = || control.interrupted();
        evaluate_built(&scenario.0, &law.any, &built, weights, &interrupted)
    })?;
    let scores = Fields::new(py);
    scores.value("total", score.total)?;
    scores.value("arrival_time", score.arrival_time)?;
    scores.value("avoidance", score.avoidance)?;
    scores.value("energy_saving", score.energy_saving)?;
    Ok((
        scores.finish(),
        built_fields(py, &scenario.0, run.0, run.1)?,
        built_fields(py, &scenario.0.nominal(), nominal.0, nominal.1)?,
    ))
}

/// The same scenario with many seeds: a row for each, histories padded with NaN.
#[pyfunction]
#[pyo3(signature = (scenario, law, built, seeds, *, step, stop_on_contact, threads, progress))]
#[allow(clippy::too_many_arguments)] // keyword-only in Python
#[allow(clippy::needless_pass_by_value)] // converted from Python, so owned
pub fn built_repeat<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    law: &Law,
    built: &AsBuilt,
    seeds: Vec<u64>,
    step: f64,
    stop_on_contact: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let built = built.run(step, stop_on_contact);
    let report = Report::new(progress.as_ref(), seeds.len());
    let threads = law.threads(threads);
    let runs = watched_law(py, law, report, |control| {
        let interrupted = || control.interrupted();
        let count = |runs| control.count(runs);
        repeat_built(
            &scenario.0,
            &law.any,
            &built,
            &seeds,
            threads,
            &interrupted,
            &count,
        )
    })?;
    repeated_fields(py, scenario.0.obstacle_count(), &runs)
}

/// Columns of repeated runs.
fn repeated_fields<'py>(
    py: Python<'py>,
    obstacles: usize,
    runs: &[(RunSummary, Histories)],
) -> PyResult<Bound<'py, PyDict>> {
    let count = runs.len();
    let longest = runs.iter().map(|(_, kept)| kept.time.len()).max();
    let longest = longest.unwrap_or(0);
    let column = |value: &dyn Fn(&RunSummary) -> f64| -> Vec<f64> {
        runs.iter().map(|(summary, _)| value(summary)).collect()
    };
    let contact = |value: fn(&Contact) -> f64| -> Vec<f64> {
        let touches = runs.iter().flat_map(|(summary, _)| &summary.contact);
        touches
            .map(|touch| touch.as_ref().map_or(f64::NAN, value))
            .collect()
    };
    let fields = Fields::new(py);
    fields.words(
        "outcome",
        runs.iter()
            .map(|(summary, _)| outcome_word(summary.outcome)),
    )?;
    fields.vector("end_time", column(&|run| run.end_time))?;
    fields.vector(
        "arrival_time",
        column(&|run| run.arrival_time.unwrap_or(f64::NAN)),
    )?;
    fields.vector("energy", column(&|run| run.energy))?;
    fields.vector("path_length", column(&|run| run.path_length))?;
    let least = runs.iter().flat_map(|(run, _)| run.min_distance.clone());
    fields.matrix("min_distance", least.collect(), count, obstacles)?;
    fields.matrix(
        "contact_time",
        contact(|touch| touch.time),
        count,
        obstacles,
    )?;
    fields.matrix(
        "contact_speed",
        contact(|touch| touch.speed),
        count,
        obstacles,
    )?;
    let padded = |width: usize, values: &dyn Fn(&Histories) -> Vec<f64>| -> Vec<f64> {
        let mut all = Vec::with_capacity(count * longest * width);
        for (index, (_, kept)) in runs.iter().enumerate() {
            all.extend(values(kept));
            all.resize((index + 1) * longest * width, f64::NAN);
        }
        all
    };
    fields.matrix("time", padded(1, &|kept| kept.time.clone()), count, longest)?;
    fields.cube(
        "position",
        padded(2, &|kept| kept.position.concat()),
        [count, longest, 2],
    )?;
    fields.cube(
        "distance",
        padded(obstacles, &|kept| kept.distance.clone()),
        [count, longest, obstacles],
    )?;
    Ok(fields.finish())
}
