//! One run, and the field at given states.

pub(crate) mod batch;
pub(crate) mod controller;
pub(crate) mod episode;
pub(crate) mod falsify;
pub(crate) mod situation;
pub(crate) mod stepped;

use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::laws::FieldTerms;
use vff_core::run::metrics::{self, Weights};
use vff_core::run::{
    Contact, Integrator, Kept, Options, Outcome, RunSummary, Trajectory, command_at,
    simulate as run_once, terms_at,
};

use crate::arrays::{Fields, fields};
use crate::errors::{CoreError, InvalidParameterError};
use crate::keywords::{Keywords, word};
use crate::laws::Law;
use crate::parameters::Scenario;
use crate::python_law::raised;
use crate::watch::{Report, here};

/// Words for how a run can end, and what they say.
#[pyfunction]
pub fn run_outcomes() -> Vec<(&'static str, &'static str)> {
    let words = Outcome::ALL.into_iter().map(Outcome::words);
    words.map(|[word, meaning]| (word, meaning)).collect()
}

/// Options of a run from their Python form.
pub fn run_options(
    integrator: &Bound<'_, PyAny>,
    step: f64,
    hold: bool,
    stop_on_contact: bool,
) -> PyResult<Options> {
    let kinds = [
        ("semi_implicit_euler", Integrator::SemiImplicitEuler),
        ("rk4", Integrator::Rk4),
    ];
    let rule = "be \"semi_implicit_euler\" or \"rk4\"";
    let integrator = word("integrator", integrator, rule, &kinds)?;
    Ok(Options {
        integrator,
        step,
        hold,
        stop_on_contact,
        kept: Kept::default(),
    })
}

/// Runs with the interpreter released; signals are looked at now and then.
fn run(
    py: Python<'_>,
    scenario: &vff_core::world::scenario::Scenario,
    law: &Law,
    options: &Options,
) -> PyResult<(RunSummary, Trajectory)> {
    here(py, Report::none(), |control| {
        run_once(scenario, &law.any, options, &|| control.interrupted())
    })
}

/// Fields of a trajectory.
pub fn trajectory_fields<'py>(
    py: Python<'py>,
    scenario: &vff_core::world::scenario::Scenario,
    summary: RunSummary,
    columns: Trajectory,
) -> PyResult<Bound<'py, PyDict>> {
    let fields = Fields::new(py);
    let (rows, obstacles) = (columns.time.len(), scenario.obstacle_count());
    let rules_heading = scenario.heading();
    fields.vector("time", columns.time)?;
    fields.array("position", columns.position, [rows, 2])?;
    fields.array("velocity", columns.velocity, [rows, 2])?;
    fields.vector("heading", vec![rules_heading; rows])?;
    let matrix = |name: &str, values: Vec<f64>, width: usize| {
        if values.len() == rows * width {
            fields.array(name, values, [rows, width])?;
        }
        Ok::<_, PyErr>(())
    };
    matrix("force", columns.force, 2)?;
    matrix("stabilizing", columns.stabilizing, 2)?;
    matrix("wheel_current", columns.wheel_current, 3)?;
    matrix("distance", columns.distance, obstacles)?;
    if columns.lyapunov.len() == rows {
        fields.vector("lyapunov", columns.lyapunov)?;
    }
    if columns.obstacle_position.len() == 2 * rows * obstacles {
        let shape = [rows, obstacles, 2];
        fields.array("obstacle_position", columns.obstacle_position, shape)?;
    }
    fields.value("outcome", summary.outcome.word())?;
    fields.value("arrival_time", summary.arrival_time.unwrap_or(f64::NAN))?;
    fields.value("energy", summary.energy)?;
    fields.value("path_length", summary.path_length)?;
    fields.vector("min_clearance", metrics::clearances(scenario, &summary))?;
    let contact = |value: fn(&Contact) -> f64| -> Vec<f64> {
        summary
            .contact
            .iter()
            .map(|touch| touch.as_ref().map_or(f64::NAN, value))
            .collect()
    };
    fields.vector("contact_time", contact(|touch| touch.time))?;
    fields.vector("contact_speed", contact(|touch| touch.speed))?;
    let flags = |flag: fn(&Contact) -> bool| -> Vec<bool> {
        let of = |touch: &Option<Contact>| touch.as_ref().is_some_and(flag);
        summary.contact.iter().map(of).collect()
    };
    fields.vector("contact_toward", flags(|touch| touch.toward))?;
    fields.vector("contact_at_fault", flags(|touch| touch.at_fault))?;
    fields.vector("contact_apart", summary.apart.clone())?;
    let wall = |value: fn(&Contact) -> f64| summary.map_contact.as_ref().map_or(f64::NAN, value);
    fields.value("map_contact_time", wall(|touch| touch.time))?;
    fields.value("map_contact_speed", wall(|touch| touch.speed))?;
    fields.value("map_clearance", summary.map_clearance)?;
    fields.vector("min_distance", summary.min_distance)?;
    Ok(fields.finish())
}

/// One run: fields of a trajectory, those that are kept.
#[pyfunction]
#[pyo3(signature = (scenario, law, **given))]
pub fn simulate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    law: &Law,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let integrator: Bound<'py, PyAny> = given.take("integrator")?;
    let (step, hold) = (given.take("step")?, given.take("hold")?);
    let mut options = run_options(&integrator, step, hold, given.take("stop_on_contact")?)?;
    let names: Vec<String> = given.take("record")?;
    options.kept = Kept::new(given.take("every")?, &names).map_err(CoreError::from)?;
    given.done()?;
    let (summary, columns) = run(py, &scenario.0, law, &options)?;
    trajectory_fields(py, &scenario.0, summary, columns)
}

/// Score of a run: its parts, the run and the nominal run.
#[pyfunction]
pub fn evaluate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    law: &Law,
    weights: (f64, f64, f64),
    integrator: &Bound<'py, PyAny>,
    step: f64,
    hold: bool,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>, Bound<'py, PyDict>)> {
    let options = run_options(integrator, step, hold, false)?;
    let nominal_scenario = scenario.0.nominal();
    let (summary, columns) = run(py, &scenario.0, law, &options)?;
    let (nominal, nominal_columns) = run(py, &nominal_scenario, law, &options)?;
    let score = metrics::performance(&scenario.0, &summary, &nominal, weights_of(weights));
    let scores = fields! { py;
        value score: total, arrival_time, avoidance, energy_saving;
    };
    Ok((
        scores,
        trajectory_fields(py, &scenario.0, summary, columns)?,
        trajectory_fields(py, &nominal_scenario, nominal, nominal_columns)?,
    ))
}

/// Weights of time, distance and energy.
pub fn weights_of((arrival_time, avoidance, energy_saving): (f64, f64, f64)) -> Weights {
    Weights {
        arrival_time,
        avoidance,
        energy_saving,
    }
}

fn terms(
    scenario: &Scenario,
    law: &Law,
    position: [f64; 2],
    velocity: [f64; 2],
    time: f64,
) -> PyResult<FieldTerms> {
    let terms = terms_at(&scenario.0, law.field()?, position, velocity, time);
    Ok(terms.map_err(CoreError::from)?)
}

/// Force that a law asks for at one state.
#[pyfunction]
pub fn law_command(
    law: &Law,
    scenario: &Scenario,
    position: [f64; 2],
    velocity: [f64; 2],
    time: f64,
) -> PyResult<[f64; 2]> {
    let force = command_at(&scenario.0, &law.any, position, velocity, time);
    match raised() {
        Some(error) => Err(error),
        None => Ok(force.map_err(CoreError::from)?),
    }
}

/// Every force term at one state.
#[pyfunction]
pub fn force_terms<'py>(
    py: Python<'py>,
    law: &Law,
    scenario: &Scenario,
    position: [f64; 2],
    velocity: [f64; 2],
    time: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let terms = terms_at(&scenario.0, &law.any, position, velocity, time);
    let terms = terms.map_err(CoreError::from)?;
    let count = terms.obstacles.len();
    let repulsive = terms
        .obstacles
        .iter()
        .flat_map(|obstacle| obstacle.repulsive)
        .collect();
    let detour = terms
        .obstacles
        .iter()
        .flat_map(|obstacle| obstacle.detour)
        .collect();
    let side: Vec<i64> = terms
        .obstacles
        .iter()
        .map(|obstacle| obstacle.side.into())
        .collect();
    Ok(fields! { py;
        vector attractive = terms.attractive.to_vec();
        array [count, 2] repulsive = repulsive;
        array [count, 2] detour = detour;
        vector stabilizing = terms.stabilizing.to_vec();
        vector total = terms.total.to_vec();
        words region = terms.obstacles.iter().map(|obstacle| obstacle.region);
        vector side = side;
        value terms: omega;
    })
}

/// Forces and Lyapunov function at many states.
#[pyfunction]
pub fn force_field<'py>(
    py: Python<'py>,
    law: &Law,
    scenario: &Scenario,
    position: PyReadonlyArray2<'py, f64>,
    velocity: PyReadonlyArray2<'py, f64>,
    time: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let rows = position.shape()[0];
    let (places, speeds) = (position.as_slice()?, velocity.as_slice()?);
    let names = ["attractive", "repulsive", "detour", "stabilizing", "total"];
    let mut columns = names.map(|_| Vec::with_capacity(2 * rows));
    let mut potential = Vec::with_capacity(rows);
    for (place, speed) in places.chunks_exact(2).zip(speeds.chunks_exact(2)) {
        let terms = terms(
            scenario,
            law,
            [place[0], place[1]],
            [speed[0], speed[1]],
            time,
        )?;
        let undefined = terms.lyapunov.is_none();
        let sum = |part: fn(&vff_core::laws::ObstacleTerms) -> [f64; 2]| {
            terms
                .obstacles
                .iter()
                .map(part)
                .fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
        };
        let parts = [
            terms.attractive,
            sum(|obstacle| obstacle.repulsive),
            sum(|obstacle| obstacle.detour),
            terms.stabilizing,
        ];
        for (column, part) in columns.iter_mut().zip(parts) {
            column.extend(if undefined { [f64::NAN; 2] } else { part });
        }
        columns[4].extend(terms.total);
        potential.push(terms.lyapunov.map_or(f64::NAN, |(value, _)| value));
    }
    let fields = Fields::new(py);
    for (name, column) in names.into_iter().zip(columns) {
        fields.array(name, column, [rows, 2])?;
    }
    fields.vector("potential", potential)?;
    Ok(fields.finish())
}

/// Lyapunov function, its derivative and Omega at one state.
#[pyfunction]
pub fn lyapunov(
    law: &Law,
    scenario: &Scenario,
    position: [f64; 2],
    velocity: [f64; 2],
    time: f64,
) -> PyResult<(f64, f64, f64)> {
    let terms = terms(scenario, law, position, velocity, time)?;
    let Some((value, derivative)) = terms.lyapunov else {
        let rule = "lie outside every critical region";
        return Err(InvalidParameterError::new_err((
            "position",
            rule,
            (position[0], position[1]),
        )));
    };
    Ok((value, derivative, terms.omega))
}
