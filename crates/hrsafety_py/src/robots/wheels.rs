//! Wheels: conversion of arguments and results.

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::robots::wheels::{
    self, Encoder, Feedback, Motor, OpenLoopTest, WheelController, WheelDynamics, WheelState,
    WheelWish,
};

use crate::arrays::{Fields, fields};
use crate::errors::CoreError;
use crate::keywords::{parameter_class, taken, value_class};
use crate::watch::{Report, watched};

type Column<'py> = PyReadonlyArray1<'py, f64>;
type Rows<'py> = PyReadonlyArray2<'py, f64>;
type Samples<'py> = Bound<'py, PyArray1<f64>>;

impl WheelDrive {
    /// The checked drive.
    pub fn core(&self) -> &wheels::WheelDrive {
        &self.0
    }
}

fn feedback_word(feedback: Feedback) -> (&'static str, [f64; 2]) {
    match feedback {
        Feedback::Differences => ("differences", [-10.0, -10.0]),
        Feedback::Observer { poles } => ("observer", poles),
        Feedback::ObservedSpeed { poles } => ("observed_speed", poles),
    }
}

value_class! {
    /// One wheel with its motor, encoder and controller.
    WheelDrive(wheels::WheelDrive) of given {
        let [inertia, viscous_friction, static_friction] = given.take("model")?;
        let model = WheelDynamics {
            inertia,
            viscous_friction,
            static_friction,
        };
        let encoder = |counts: Option<f64>| {
            let gear_ratio = given.take("gear_ratio")?;
            PyResult::Ok(counts.map(|counts| Encoder { counts, gear_ratio }))
        };
        let poles = given.take("observer_poles")?;
        let kinds = [
            ("differences", Feedback::Differences),
            ("observer", Feedback::Observer { poles }),
            ("observed_speed", Feedback::ObservedSpeed { poles }),
        ];
        let rule = "be one of \"observer\", \"observed_speed\", \"differences\"";
        wheels::WheelDrive {
            dynamics: taken!(given: WheelDynamics { inertia, viscous_friction, static_friction }),
            motor: taken!(given: Motor {
                amplifier_gain, resistance as winding_resistance, back_emf, current_limit,
                supply_voltage,
            }),
            encoder: encoder(given.take("encoder_counts")?)?,
            controller: taken!(given: WheelController {
                proportional as proportional_gain, derivative as derivative_gain, model = model,
                feedback = given.word("feedback", rule, &kinds)?,
            }),
            period: given.take("period")?,
        }
    }

    /// Encoder readings of an open-loop test.
    #[pyo3(signature = (*, command, start_angle, periods))]
    fn open_loop_angles<'py>(
        &self,
        py: Python<'py>,
        command: f64,
        start_angle: f64,
        periods: usize,
    ) -> PyResult<Samples<'py>> {
        let test = OpenLoopTest {
            command,
            start_angle,
            periods,
        };
        let angles = watched(py, Report::none(), |control| {
            wheels::open_loop_angles(&self.0, &test, &|| control.interrupted())
        })?;
        Ok(angles.into_pyarray(py))
    }

    /// Histories of the wheel after a wanted motion, one row per wheel period.
    #[pyo3(signature = (*, angle, speed, acceleration, start_angle, start_speed))]
    fn follow<'py>(
        &self,
        py: Python<'py>,
        angle: Column<'py>,
        speed: Column<'py>,
        acceleration: Column<'py>,
        start_angle: f64,
        start_speed: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (angle, speed) = (angle.as_slice()?, speed.as_slice()?);
        let acceleration = acceleration.as_slice()?;
        let start = WheelState {
            angle: start_angle,
            speed: start_speed,
        };
        let count = angle.len().min(speed.len()).min(acceleration.len());
        let run = watched(py, Report::none(), |control| {
            let wishes = (0..count).map(|index| WheelWish {
                angle: angle[index],
                speed: speed[index],
                acceleration: acceleration[index],
            });
            wheels::follow(&self.0, start, wishes, &|| control.interrupted())
        })?;
        Ok(fields! { py;
            vector run: angle, speed, read_angle, known_angle, known_speed, current, voltage,
                ideal_current;
            value run: energy, ideal_energy;
        })
    }
}

/// Arguments of the wheels of the holonomic robot of the source.
#[pyfunction]
pub fn holonomic_wheels(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let drives = wheels::holonomic_wheels();
    drives.iter().map(|drive| preset(py, drive)).collect()
}

/// Arguments of the wheels of the differential-drive robot of the source, the right one first.
#[pyfunction]
pub fn differential_wheels(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let drives = wheels::differential_wheels();
    drives.iter().map(|drive| preset(py, drive)).collect()
}

fn preset<'py>(py: Python<'py>, drive: &wheels::WheelDrive) -> PyResult<Bound<'py, PyDict>> {
    let fields = Fields::new(py);
    let (dynamics, motor, controller) = (&drive.dynamics, &drive.motor, &drive.controller);
    fields.value("inertia", dynamics.inertia)?;
    fields.value("viscous_friction", dynamics.viscous_friction)?;
    fields.value("static_friction", dynamics.static_friction)?;
    let model = &controller.model;
    let model = (model.inertia, model.viscous_friction, model.static_friction);
    fields.value("model", model)?;
    fields.value("proportional_gain", controller.proportional)?;
    fields.value("derivative_gain", controller.derivative)?;
    let (word, [first, second]) = feedback_word(controller.feedback);
    fields.value("feedback", word)?;
    fields.value("observer_poles", (first, second))?;
    if let Some(encoder) = drive.encoder {
        fields.value("encoder_counts", encoder.counts)?;
        fields.value("gear_ratio", encoder.gear_ratio)?;
    }
    fields.value("amplifier_gain", motor.amplifier_gain)?;
    fields.value("winding_resistance", motor.resistance)?;
    fields.value("back_emf", motor.back_emf)?;
    fields.value("current_limit", motor.current_limit)?;
    fields.value("supply_voltage", motor.supply_voltage)?;
    fields.value("period", drive.period)?;
    Ok(fields.finish())
}

/// Heading 0 for every row.
fn headings(rows: &Rows<'_>) -> Vec<f64> {
    vec![0.0; rows.as_array().nrows()]
}

/// Applies a map to every row, with the heading of the row.
fn each_row<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    rows: &Rows<'py>,
    headings: &[f64],
    map: impl Fn([f64; N], f64) -> [f64; M],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (whole, _) = rows.as_slice()?.as_chunks::<N>();
    let mapped = whole
        .iter()
        .zip(headings)
        .flat_map(|(row, heading)| map(*row, *heading));
    let count = whole.len().min(headings.len());
    mapped
        .collect::<Vec<f64>>()
        .into_pyarray(py)
        .reshape([count, M])
}

parameter_class! {
    /// Three omni-wheels.
    OmniKinematics(wheels::OmniKinematics) { wheel_radius, center_distance }

    /// Wheel speeds from velocities and turn rates in the world.
    fn wheel_speeds<'py>(
        &self,
        py: Python<'py>,
        velocity: Rows<'py>,
        heading: Column<'py>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        each_row(py, &velocity, heading.as_slice()?, |row, heading| {
            self.0.wheel_speeds_in_world(row, heading)
        })
    }

    /// Velocities and turn rates in the world from wheel speeds.
    fn body_velocity<'py>(
        &self,
        py: Python<'py>,
        speeds: Rows<'py>,
        heading: Column<'py>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        each_row(py, &speeds, heading.as_slice()?, |row, heading| {
            self.0.world_velocity(row, heading)
        })
    }
}

parameter_class! {
    /// Two driven wheels on one axis.
    DifferentialKinematics(wheels::DifferentialKinematics) { wheel_radius, span }

    /// Wheel speeds from speeds and turn rates.
    fn wheel_speeds<'py>(
        &self,
        py: Python<'py>,
        motion: Rows<'py>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let straight = headings(&motion);
        each_row(py, &motion, &straight, |row, _| self.0.wheel_speeds(row))
    }

    /// Speeds and turn rates from wheel speeds.
    fn body_velocity<'py>(
        &self,
        py: Python<'py>,
        speeds: Rows<'py>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let straight = headings(&speeds);
        each_row(py, &speeds, &straight, |row, _| self.0.body_velocity(row))
    }

    /// Velocities and turn rates in the world from wheel speeds.
    fn world_velocity<'py>(
        &self,
        py: Python<'py>,
        speeds: Rows<'py>,
        heading: Column<'py>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        each_row(py, &speeds, heading.as_slice()?, |row, heading| {
            self.0.world_velocity(row, heading)
        })
    }
}

parameter_class! {
    /// Slip of a wheel.
    Slip(wheels::Slip) { creep, grip }

    /// Ground speed after every period.
    #[pyo3(signature = (rim_speed, *, start, period))]
    fn ground_speeds<'py>(
        &self,
        py: Python<'py>,
        rim_speed: Column<'py>,
        start: f64,
        period: f64,
    ) -> PyResult<Samples<'py>> {
        let mut speed = start;
        let speeds = rim_speed.as_slice()?.iter().map(|&rim| {
            speed = self.0.ground_speed(rim, speed, period);
            speed
        });
        Ok(speeds.collect::<Vec<f64>>().into_pyarray(py))
    }
}

/// Wanted angle and acceleration from wanted speeds, one for each wheel period.
#[pyfunction]
pub fn wheel_reference<'py>(
    py: Python<'py>,
    speed: Column<'py>,
    period: f64,
) -> PyResult<(Samples<'py>, Samples<'py>)> {
    let mut reference = wheels::WheelReference::new(period);
    let (angle, acceleration): (Vec<f64>, Vec<f64>) = speed
        .as_slice()?
        .iter()
        .map(|&speed| {
            let wish = reference.next(speed);
            (wish.angle, wish.acceleration)
        })
        .unzip();
    let angle = angle.into_pyarray(py);
    Ok((angle, acceleration.into_pyarray(py)))
}

/// Angles of a wheel that starts at rest under a held current.
#[pyfunction]
#[pyo3(signature = (time, *, dynamics, current))]
pub fn wheel_response<'py>(
    py: Python<'py>,
    time: Column<'py>,
    dynamics: [f64; 3],
    current: f64,
) -> PyResult<Samples<'py>> {
    let [inertia, viscous_friction, static_friction] = dynamics;
    let wheel = WheelDynamics {
        inertia,
        viscous_friction,
        static_friction,
    };
    let wheel = wheel.checked().map_err(CoreError::from)?;
    let rest = WheelState::default();
    let angles = time.as_slice()?.iter();
    let angles = angles.map(|&time| wheel.advance(rest, current, time).angle);
    Ok(angles.collect::<Vec<f64>>().into_pyarray(py))
}
