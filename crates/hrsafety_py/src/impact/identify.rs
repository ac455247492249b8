//! Identification of foam and direct-drive joint.

use impact_core::identify::{
    self, DriveConstants, Drop, DropContact, DropModel, FoamFitSettings, Tube,
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Fields, fields};
use crate::errors::CoreError;
use crate::keywords::{Keywords, taken};
use crate::watch::{Report, here, spread, watched};

type Samples<'py> = PyReadonlyArray1<'py, f64>;

fn contact(attached: bool) -> DropContact {
    if attached {
        DropContact::Attached
    } else {
        DropContact::Unilateral
    }
}

fn rows<const N: usize, const M: usize>(matrix: &[[f64; M]; N]) -> Vec<f64> {
    matrix.iter().flatten().copied().collect()
}

/// Stiffness, damping ratio and friction from static and drop tests.
#[pyfunction]
#[pyo3(signature = (static_force, static_compression, drops, **given))]
pub fn identify_foam<'py>(
    py: Python<'py>,
    static_force: Samples<'py>,
    static_compression: Samples<'py>,
    drops: Vec<(Samples<'py>, Samples<'py>)>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let settings = taken!(given: FoamFitSettings {
        moving_mass, gravity, confidence, contact = contact(given.take("attached")?), bootstrap,
        seed,
    });
    let progress: Option<Py<PyAny>> = given.take("progress")?;
    given.done()?;
    let mut signals = Vec::with_capacity(drops.len());
    for (time, position) in &drops {
        signals.push(Drop {
            time: time.as_slice()?,
            position: position.as_slice()?,
        });
    }
    let (force, compression) = (static_force.as_slice()?, static_compression.as_slice()?);
    // A fit without resampling has nothing to count.
    let told = progress.as_ref().filter(|_| settings.bootstrap > 0);
    let report = Report::new(told, settings.bootstrap);
    let fit = spread(py, report, Some(1), |work| {
        identify::identify_foam(force, compression, &signals, &settings, work)
    })?;
    let fields = Fields::new(py);
    fields.value("stiffness", fit.stiffness)?;
    fields.value("damping_ratio", fit.damping_ratio)?;
    fields.value("friction", fit.friction)?;
    fields.array("covariance", rows(&fit.covariance), [3, 3])?;
    fields.array("interval", rows(&fit.interval), [3, 2])?;
    match fit.bootstrap_interval {
        Some(interval) => fields.array("bootstrap_interval", rows(&interval), [3, 2])?,
        None => fields.value("bootstrap_interval", py.None())?,
    }
    fields.vector("drop_heights", fit.drop_heights)?;
    fields.value("force_deviation", fit.force_deviation)?;
    fields.value("position_deviation", fit.position_deviation)?;
    fields.value("degrees_of_freedom", fit.degrees_of_freedom)?;
    fields.value("iterations", fit.iterations)?;
    Ok(fields.finish())
}

/// Stiffness of a foam from a static test.
#[pyfunction]
pub fn fit_static<'py>(
    py: Python<'py>,
    static_force: Samples<'py>,
    static_compression: Samples<'py>,
    intercept: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let (force, compression) = (static_force.as_slice()?, static_compression.as_slice()?);
    let line = identify::fit_static(force, compression, intercept).map_err(CoreError::from)?;
    let interval = rows(&[line.slope_interval, line.intercept_interval]);
    Ok(fields! { py;
        value stiffness = line.slope;
        value force_offset = line.intercept;
        array [2, 2] covariance = rows(&line.covariance);
        array [2, 2] interval = interval;
        value force_deviation = line.residual_deviation;
        value line: degrees_of_freedom;
    })
}

/// Height of a mass that is dropped on foam.
#[pyfunction]
#[pyo3(signature = (time, **given))]
pub fn drop_trajectory<'py>(
    py: Python<'py>,
    time: Samples<'py>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let given = given.unwrap_or_default();
    let model = taken!(given: DropModel {
        mass, stiffness, damping_ratio, friction, height, gravity,
        contact = contact(given.take("attached")?),
    });
    given.done()?;
    let time = time.as_slice()?;
    // How many events there are is known only afterwards: work of any length looks at signals.
    let heights = here(py, Report::none(), |control| {
        identify::drop_trajectory(time, &model, &|| control.interrupted())
    })?;
    Ok(heights.into_pyarray(py))
}

/// Acceleration and decay of an open-loop test.
#[pyfunction]
pub fn fit_open_loop<'py>(
    py: Python<'py>,
    time: Samples<'py>,
    angle: Samples<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let (time, angle) = (time.as_slice()?, angle.as_slice()?);
    let fit = watched(py, Report::none(), |control| {
        identify::fit_open_loop(time, angle, &|| control.interrupted())
    })?;
    Ok(fields! { py;
        value fit: acceleration, decay, residual_deviation;
        array [2, 2] covariance = rows(&fit.covariance);
        array [2, 2] interval = rows(&fit.interval);
    })
}

/// Constants of a direct-drive joint from open-loop tests.
#[pyfunction]
pub fn identify_direct_drive<'py>(
    py: Python<'py>,
    voltage: Samples<'py>,
    acceleration: Samples<'py>,
    decay: Samples<'py>,
    inertia: f64,
    amplifier_gain: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let fit = identify::identify_direct_drive(
        voltage.as_slice()?,
        acceleration.as_slice()?,
        decay.as_slice()?,
        inertia,
        amplifier_gain,
    )
    .map_err(CoreError::from)?;
    Ok(fields! { py;
        value fit: command_gain, friction_offset, decay, torque_constant, viscous_friction,
            static_friction;
        array [2, 2] covariance = rows(&fit.covariance);
        array [2, 2] interval = rows(&fit.interval);
        vector decay_interval = fit.decay_interval.to_vec();
    })
}

/// Proportional and derivative gain for a wanted stiffness and damping.
#[pyfunction]
#[pyo3(signature = (**given))]
pub fn pd_gains(given: Option<Keywords<'_>>) -> PyResult<(f64, f64)> {
    let given = given.unwrap_or_default();
    let [stiffness, damping] = [given.take("stiffness")?, given.take("damping")?];
    let constants = taken!(given: DriveConstants { lever_arm, torque_constant, viscous_friction, amplifier_gain });
    given.done()?;
    let gains = identify::pd_gains(stiffness, damping, &constants).map_err(CoreError::from)?;
    Ok((gains.proportional, gains.derivative))
}

/// Mass and inertia of a rectangular tube.
#[pyfunction]
#[pyo3(signature = (**given))]
pub fn tube_inertia(given: Option<Keywords<'_>>) -> PyResult<(f64, f64)> {
    let given = given.unwrap_or_default();
    let tube = taken!(given: Tube { density, length, width, height, wall });
    given.done()?;
    let found = identify::tube_inertia(&tube).map_err(CoreError::from)?;
    Ok((found.mass, found.inertia))
}
