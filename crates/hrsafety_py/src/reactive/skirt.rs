//! Skirt: conversion of arguments and results.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, ToPyArray};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::laws::escape::states::TABLE_1;
use vff_core::robots::wheels::TriOmni;
use vff_core::run::skirt::{
    Direction, DiscSceneOptions, EscapeAction, Policy, Ring, Rule, Skirt, SkirtOptions,
    SkirtTravel, TestPlan, normal_distances, test_batch,
};
use vff_core::sensing::sonar::ring::{
    Circumference, closing_gap, least_sensors, safe_distance as meeting_distance,
};

use crate::arrays::fields;
use crate::errors::{CoreError, CoreResult};
use crate::keywords::{Keywords, parameter_class, taken, word};
use crate::watch::{Report, spread};

/// Word of an action.
pub fn action_word(action: EscapeAction) -> &'static str {
    match action {
        EscapeAction::Keep => "keep",
        EscapeAction::Spin => "spin",
        EscapeAction::Move(direction) => direction.word(),
    }
}

/// Words and angles in rad of the motion directions.
#[pyfunction]
pub fn skirt_directions() -> Vec<(&'static str, f64)> {
    let entry = |direction: Direction| (direction.word(), direction.angle());
    Direction::ALL.into_iter().map(entry).collect()
}

/// Rows of the state table: sensors that see an obstacle, and the action.
#[pyfunction]
pub fn skirt_states() -> Vec<(Vec<usize>, &'static str)> {
    let row =
        |(sensors, action): &(&[usize], EscapeAction)| (sensors.to_vec(), action_word(*action));
    TABLE_1.iter().map(row).collect()
}

/// Gap between sensors of a ring that closes, in rad.
#[pyfunction]
#[pyo3(signature = (*, sensors, wheel_gap))]
pub fn skirt_closing_gap(sensors: usize, wheel_gap: f64) -> CoreResult<f64> {
    Ok(closing_gap(sensors, wheel_gap)?)
}

/// Lengths of the printed equations, the radius of the chassis if it is known.
fn circumference(given: &Keywords<'_>, chassis_radius: Option<f64>) -> PyResult<Circumference> {
    let sensor_radius = given.take("sensor_radius")?;
    let lengths = taken!(given: Circumference {
        chassis_radius = chassis_radius.unwrap_or(sensor_radius), sensor_radius = sensor_radius,
        wheel_sensor_radius, sensor_length, correction,
    });
    given.done()?;
    Ok(lengths.checked().map_err(CoreError::from)?)
}

/// Gaps by the printed (3) and (5) in rad, and the factor with which (3) closes the ring.
#[pyfunction]
#[pyo3(signature = (*, sensors, wheel_gap, **lengths))]
pub fn skirt_printed_gaps(
    sensors: usize,
    wheel_gap: f64,
    lengths: Option<Keywords<'_>>,
) -> PyResult<(f64, f64, f64)> {
    let lengths = lengths.unwrap_or_default();
    let radius = lengths.take("chassis_radius")?;
    let lengths = circumference(&lengths, Some(radius))?;
    let gap = lengths.printed_gap(sensors, wheel_gap);
    let closed = lengths.printed_gap_closed(sensors);
    let correction = lengths.closing_correction(sensors, wheel_gap);
    let found = gap.and_then(|gap| Ok((gap, closed?, correction?)));
    Ok(found.map_err(CoreError::from)?)
}

/// Radius of the chassis that the printed (1) closes, in m.
#[pyfunction]
#[pyo3(signature = (*, sensors, wheel_gap, gap, **lengths))]
pub fn skirt_closing_radius(
    sensors: usize,
    wheel_gap: f64,
    gap: f64,
    lengths: Option<Keywords<'_>>,
) -> PyResult<f64> {
    // The radius of the chassis is what is asked for.
    let lengths = circumference(&lengths.unwrap_or_default(), None)?;
    let radius = lengths.closing_radius(sensors, wheel_gap, gap);
    Ok(radius.map_err(CoreError::from)?)
}

/// Least number of sensors by (6), and the next multiple of three.
#[pyfunction]
#[pyo3(signature = (*, wheel_sensor_radius, sensor_radius))]
pub fn skirt_least_sensors(wheel_sensor_radius: f64, sensor_radius: f64) -> CoreResult<(f64, f64)> {
    let [least, multiple] = least_sensors(wheel_sensor_radius, sensor_radius)?;
    Ok((least, multiple))
}

/// Distance from the center at which the beams beside a gap in rad meet, in m.
#[pyfunction]
#[pyo3(signature = (*, sensor_radius, gap))]
pub fn skirt_safe_distance(sensor_radius: f64, gap: f64) -> f64 {
    meeting_distance(sensor_radius, gap)
}

/// Velocities and yaw rates.
type Movement<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

parameter_class! {
    /// Platform with three omni-wheels.
    TriOmniKinematics(TriOmni) { wheel_radius, wheel_width, chassis_radius }

    /// Wheel speeds of velocities and yaw rates, row by row.
    fn wheel_speeds<'py>(
        &self,
        py: Python<'py>,
        velocity: PyReadonlyArray2<'py, f64>,
        yaw_rate: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = velocity.as_slice()?.chunks_exact(2);
        let speeds: Vec<f64> = rows
            .zip(yaw_rate.as_slice()?)
            .flat_map(|(row, rate)| self.0.wheel_speeds([row[0], row[1]], *rate))
            .collect();
        let count = speeds.len() / 3;
        speeds.to_pyarray(py).reshape([count, 3])
    }

    /// Velocities and yaw rates of wheel speeds, row by row.
    fn body_velocity<'py>(
        &self,
        py: Python<'py>,
        wheel_speeds: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Movement<'py>> {
        let (mut velocity, mut yaw_rate) = (Vec::new(), Vec::new());
        for row in wheel_speeds.as_slice()?.chunks_exact(3) {
            let (linear, rate) = self.0.body_velocity([row[0], row[1], row[2]]);
            velocity.extend(linear);
            yaw_rate.push(rate);
        }
        let velocity = velocity.to_pyarray(py).reshape([yaw_rate.len(), 2])?;
        Ok((velocity, yaw_rate.to_pyarray(py)))
    }
}

/// Places of the sensors around the chassis.
fn ring_of(given: &Keywords<'_>) -> PyResult<Ring> {
    let (sensors, wheel_gap) = (given.take("sensors")?, given.take("wheel_gap")?);
    let layouts = [("wheels", true), ("even", false)];
    let bearings = if given.word("layout", "be \"wheels\" or \"even\"", &layouts)? {
        Ring::beside_wheels(sensors, wheel_gap)
    } else {
        Ring::even(sensors)
    };
    let (radius, inset) = (given.take("chassis_radius")?, given.take("sensor_inset")?);
    let ring = bearings.and_then(|bearings| Ring::new(radius, inset, bearings));
    Ok(ring.map_err(CoreError::from)?)
}

/// Ring of sensors with its decisions.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct UltrasonicSkirt(pub Skirt);

#[pymethods]
impl UltrasonicSkirt {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let ring = ring_of(&given)?;
        let policies = [
            ("nearest", Policy::Nearest),
            ("best_direction", Policy::BestDirection),
            ("table_only", Policy::TableOnly),
        ];
        let policy = "be \"nearest\", \"best_direction\" or \"table_only\"";
        let safe_distance: Option<f64> = given.take("safe_distance")?;
        let options = taken!(given: SkirtOptions {
            safe_distance = safe_distance.unwrap_or_else(|| ring.safe_distance()),
            rule = given.word("triggering", RULE, &RULES)?,
            policy = given.word("policy", policy, &policies)?, beam_width, rays, least_range,
            most_range, range_noise, firing_period,
        });
        given.done()?;
        Ok(Self(Skirt::new(ring, options).map_err(CoreError::from)?))
    }

    /// Bearings of the sensors, in rad.
    fn bearings(&self) -> Vec<f64> {
        self.0.ring().bearings().to_vec()
    }

    /// Gaps between sensors counterclockwise, in rad.
    fn gaps(&self) -> Vec<f64> {
        self.0.ring().gaps()
    }

    /// Triggering distances, in m.
    fn trigger_distances(&self) -> Vec<f64> {
        self.0.thresholds().to_vec()
    }

    /// Distance from the center at which the beams beside the largest gap meet, in m.
    fn meeting_distance(&self) -> f64 {
        self.0.ring().safe_distance()
    }

    /// Normal distances d1 to d8 and their limits, in m.
    fn normal_distances<'py>(
        &self,
        py: Python<'py>,
        readings: PyReadonlyArray1<'py, f64>,
        safe_distance: f64,
        triggering: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rule = word("triggering", triggering, RULE, &RULES)?;
        let rows = normal_distances(self.0.ring(), safe_distance, readings.as_slice()?, rule);
        let rows = rows.map_err(CoreError::from)?;
        rows.concat().to_pyarray(py).reshape([rows.len(), 2])
    }

    /// Bits of the sensors that are triggered.
    fn pattern(&self, readings: PyReadonlyArray1<'_, f64>) -> PyResult<u64> {
        Ok(self.0.decider().pattern(readings.as_slice()?))
    }

    /// Action of the robot for its readings.
    fn action(&self, readings: PyReadonlyArray1<'_, f64>) -> PyResult<&'static str> {
        Ok(action_word(self.0.decider().action(readings.as_slice()?)))
    }
}

/// When a sensor is triggered.
const RULES: [(&str, Rule); 2] = [("consistent", Rule::Consistent), ("printed", Rule::Printed)];
const RULE: &str = "be \"consistent\" or \"printed\"";

/// How discs are laid out.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct SkirtScene(pub DiscSceneOptions);

#[pymethods]
impl SkirtScene {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let options = taken!(given: DiscSceneOptions {
            radius as disc_radius, obstacles, course_distance, course_offset, half_size,
            start_clearance, spacing, unseen_share,
        });
        given.done()?;
        // With a robot of no size: that of the test is checked there.
        Ok(Self(options.checked(0.0).map_err(CoreError::from)?))
    }
}

parameter_class! {
    /// How the robot moves.
    SkirtMotion(SkirtTravel) { speed, acceleration, spin_rate, duration }
}

/// Rows of the avoidance test.
#[pyfunction]
#[pyo3(signature = (skirt, scene, motion, **given))]
pub fn skirt_test<'py>(
    py: Python<'py>,
    skirt: &UltrasonicSkirt,
    scene: &SkirtScene,
    motion: &SkirtMotion,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let (threads, progress): (Option<usize>, Option<Py<PyAny>>) =
        (given.take("threads")?, given.take("progress")?);
    let plan = taken!(given: TestPlan {
        scene = scene.0, motion = motion.0, layouts, repeats, seed,
    });
    given.done()?;
    let plan = plan.checked(&skirt.0).map_err(CoreError::from)?;
    let report = Report::new(progress.as_ref(), plan.runs());
    let rows = spread(py, report, threads, |work| {
        test_batch(&skirt.0, &plan, work)
    })?;
    let directions = (0..rows.len()).map(|index| plan.direction(index).word());
    let clearances = rows.iter().map(|row| row.course.min_clearance).collect();
    let times = rows
        .iter()
        .map(|row| row.course.contact_time.unwrap_or(f64::NAN));
    Ok(fields! { py;
        words direction = directions;
        vector min_clearance = clearances;
        vector contact_time = times.collect();
        each rows: nearest_seen;
    })
}
