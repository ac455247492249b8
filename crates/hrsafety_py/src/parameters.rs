//! Checked parameter objects behind the Python dataclasses.

use numeric::error::{Failure, Given};
use pyo3::prelude::*;
use vff_core::robots::{self, DifferentialWheels, Wheels};
use vff_core::sensing::measurement;
use vff_core::sensing::measurement::{Distribution, Noisy};
use vff_core::world::motion::{Motion, Segment};
use vff_core::world::obstacle::{self, Limits};
use vff_core::world::region::{self, Sensing};
use vff_core::world::scenario::{self, Rules};

use crate::errors::CoreResult;

/// Holonomic robot.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct HolonomicRobot(pub robots::HolonomicRobot);

#[pymethods]
impl HolonomicRobot {
    #[new]
    #[pyo3(signature = (*, mass, radius, max_speed, max_acceleration, wheel_radius, winding_resistance,
        wheel_inertia, wheel_viscous_friction, wheel_static_friction))]
    #[allow(clippy::too_many_arguments)] // keyword-only in Python
    fn new(
        mass: f64,
        radius: f64,
        max_speed: f64,
        max_acceleration: f64,
        wheel_radius: f64,
        winding_resistance: f64,
        wheel_inertia: [f64; 3],
        wheel_viscous_friction: [f64; 3],
        wheel_static_friction: [f64; 3],
    ) -> CoreResult<Self> {
        let wheels = Wheels {
            radius: wheel_radius,
            resistance: winding_resistance,
            inertia: wheel_inertia,
            viscous_friction: wheel_viscous_friction,
            static_friction: wheel_static_friction,
        };
        let robot = robots::HolonomicRobot {
            mass,
            radius,
            max_speed,
            max_acceleration,
            wheels,
        };
        Ok(Self(robot.checked()?))
    }
}

/// Differential-drive robot.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct DifferentialDriveRobot(pub robots::DifferentialDriveRobot);

#[pymethods]
impl DifferentialDriveRobot {
    #[new]
    #[pyo3(signature = (*, mass, radius, max_speed, max_acceleration, max_angular_acceleration,
        reference_speed_share, wheel_radius, wheel_span, winding_resistance, wheel_inertia,
        wheel_viscous_friction, wheel_static_friction))]
    #[allow(clippy::too_many_arguments)] // keyword-only in Python
    fn new(
        mass: f64,
        radius: f64,
        max_speed: f64,
        max_acceleration: f64,
        max_angular_acceleration: f64,
        reference_speed_share: f64,
        wheel_radius: f64,
        wheel_span: f64,
        winding_resistance: f64,
        wheel_inertia: [f64; 2],
        wheel_viscous_friction: [f64; 2],
        wheel_static_friction: [f64; 2],
    ) -> CoreResult<Self> {
        let wheels = DifferentialWheels {
            radius: wheel_radius,
            span: wheel_span,
            resistance: winding_resistance,
            inertia: wheel_inertia,
            viscous_friction: wheel_viscous_friction,
            static_friction: wheel_static_friction,
        };
        let robot = robots::DifferentialDriveRobot {
            mass,
            radius,
            max_speed,
            max_acceleration,
            max_angular_acceleration,
            reference_speed_share,
            wheels,
        };
        Ok(Self(robot.checked()?))
    }
}

/// Obstacle.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Obstacle(obstacle::Obstacle);

#[pymethods]
impl Obstacle {
    /// Disc at rest.
    #[staticmethod]
    #[pyo3(signature = (*, center, radius, active_radius, critical_radius, max_speed))]
    fn disc(
        center: [f64; 2],
        radius: f64,
        active_radius: Option<f64>,
        critical_radius: Option<f64>,
        max_speed: Option<f64>,
    ) -> CoreResult<Self> {
        let limits = Limits {
            active_radius,
            critical_radius,
            max_speed,
        };
        Ok(Self(obstacle::Obstacle::disc_at_rest(
            center, radius, limits,
        )?))
    }

    /// Rectangle at rest.
    #[staticmethod]
    #[pyo3(signature = (*, center, length, width, heading, active_radius, critical_radius, max_speed))]
    fn rectangle(
        center: [f64; 2],
        length: f64,
        width: f64,
        heading: f64,
        active_radius: Option<f64>,
        critical_radius: Option<f64>,
        max_speed: Option<f64>,
    ) -> CoreResult<Self> {
        let limits = Limits {
            active_radius,
            critical_radius,
            max_speed,
        };
        Ok(Self(obstacle::Obstacle::rectangle(
            center,
            [length, width],
            heading,
            limits,
        )?))
    }

    /// Disc with constant acceleration or a sudden stop.
    #[staticmethod]
    #[pyo3(signature = (*, start, velocity, acceleration, stop, radius, active_radius, critical_radius, max_speed))]
    #[allow(clippy::too_many_arguments)] // keyword-only in Python
    fn moving(
        start: [f64; 2],
        velocity: [f64; 2],
        acceleration: [f64; 2],
        stop: Option<[f64; 2]>,
        radius: f64,
        active_radius: Option<f64>,
        critical_radius: Option<f64>,
        max_speed: Option<f64>,
    ) -> CoreResult<Self> {
        let motion = Motion::moving(start, velocity, acceleration, stop)?;
        let limits = Limits {
            active_radius,
            critical_radius,
            max_speed,
        };
        Ok(Self(obstacle::Obstacle::disc(radius, motion, limits)?))
    }

    /// Disc with piecewise constant acceleration.
    #[staticmethod]
    #[pyo3(signature = (*, start, segments, radius, active_radius, critical_radius, max_speed))]
    fn piecewise(
        start: [f64; 2],
        segments: Vec<(f64, [f64; 2], [f64; 2])>,
        radius: f64,
        active_radius: Option<f64>,
        critical_radius: Option<f64>,
        max_speed: Option<f64>,
    ) -> CoreResult<Self> {
        let segments: Vec<Segment> = segments
            .into_iter()
            .map(|(duration, velocity, acceleration)| Segment {
                duration,
                velocity,
                acceleration,
            })
            .collect();
        let limits = Limits {
            active_radius,
            critical_radius,
            max_speed,
        };
        let motion = Motion::piecewise(start, &segments)?;
        Ok(Self(obstacle::Obstacle::disc(radius, motion, limits)?))
    }

    /// Disc that follows a recording.
    #[staticmethod]
    #[pyo3(signature = (*, time, position, radius, active_radius, critical_radius, max_speed))]
    #[allow(clippy::needless_pass_by_value)] // converted from Python, so owned
    fn recorded(
        time: Vec<f64>,
        position: Vec<[f64; 2]>,
        radius: f64,
        active_radius: Option<f64>,
        critical_radius: Option<f64>,
        max_speed: Option<f64>,
    ) -> CoreResult<Self> {
        let limits = Limits {
            active_radius,
            critical_radius,
            max_speed,
        };
        let motion = Motion::recorded(&time, &position)?;
        Ok(Self(obstacle::Obstacle::disc(radius, motion, limits)?))
    }
}

/// Measurement error.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Measurement(measurement::Measurement);

#[pymethods]
impl Measurement {
    #[new]
    #[pyo3(signature = (*, scale, distribution, of, latency))]
    fn new(
        scale: f64,
        distribution: &Bound<'_, PyAny>,
        of: &Bound<'_, PyAny>,
        latency: f64,
    ) -> PyResult<Self> {
        let kinds = [
            ("uniform", Distribution::Uniform),
            ("gaussian", Distribution::Gaussian),
        ];
        let rule = "be \"uniform\" or \"gaussian\"";
        let distribution = word("distribution", distribution, rule, &kinds)?;
        let bodies = [
            ("obstacles", Noisy::Obstacles),
            ("robot", Noisy::Robot),
            ("both", Noisy::Both),
        ];
        let noisy = word("of", of, "be \"obstacles\", \"robot\" or \"both\"", &bodies)?;
        let built = measurement::Measurement::new(scale, distribution, noisy)
            .and_then(|measurement| measurement.late(latency));
        Ok(Self(built.map_err(crate::errors::CoreError::from)?))
    }
}

/// The meaning of a word among a few, or an error that shows what was given.
pub fn word<T: Copy>(
    name: &str,
    given: &Bound<'_, PyAny>,
    requirement: &'static str,
    meanings: &[(&str, T)],
) -> PyResult<T> {
    let shown = match given.extract::<String>() {
        Ok(text) => match meanings.iter().find(|(key, _)| *key == text) {
            Some((_, meaning)) => return Ok(*meaning),
            None => Given::Word(text),
        },
        Err(_) => Given::Found(given.repr()?.to_string().into()),
    };
    let error = Failure::invalid(name, requirement, shown);
    Err(crate::errors::CoreError::from(error).into())
}

/// Scenario.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Scenario(pub scenario::Scenario);

#[pymethods]
impl Scenario {
    #[new]
    #[pyo3(signature = (*, robot, start, goal, obstacles, control_period, time_limit,
        arrival_tolerance, heading, rest_time, measurement, seed))]
    #[allow(clippy::too_many_arguments)] // keyword-only in Python
    #[allow(clippy::needless_pass_by_value)] // references to Python objects
    fn new(
        robot: &Bound<'_, PyAny>,
        start: [f64; 2],
        goal: [f64; 2],
        obstacles: Vec<PyRef<'_, Obstacle>>,
        control_period: f64,
        time_limit: f64,
        arrival_tolerance: f64,
        heading: f64,
        rest_time: f64,
        measurement: Option<PyRef<'_, Measurement>>,
        seed: u64,
    ) -> PyResult<Self> {
        let obstacles = obstacles
            .iter()
            .map(|obstacle| obstacle.0.clone())
            .collect();
        let rules = Rules {
            control_period,
            time_limit,
            arrival_tolerance,
            rest_time,
            heading,
        };
        let scenario = if let Ok(robot) = robot.cast::<HolonomicRobot>() {
            scenario::Scenario::new(robot.get().0, start, goal, obstacles, rules)
        } else {
            let robot = robot.cast::<DifferentialDriveRobot>()?.get().0;
            scenario::Scenario::for_differential(robot, start, goal, obstacles, rules)
        };
        let scenario = scenario.map_err(crate::errors::CoreError::from)?;
        let measurement = measurement.map(|measurement| measurement.0);
        let measured = scenario.measured(measurement, seed);
        Ok(Self(measured.map_err(crate::errors::CoreError::from)?))
    }

    /// Mass, radius, largest speed and acceleration of the point mass that a law drives.
    fn point_mass(&self) -> (f64, f64, f64, f64) {
        crate::python_law::point_mass(&self.0)
    }
}

/// Critical and active radius of an obstacle for a robot.
#[pyfunction]
#[pyo3(signature = (robot, obstacle, control_period, faced_side, latency, position_error, measurement))]
#[allow(clippy::needless_pass_by_value)] // references to Python objects
pub fn region_radii(
    robot: &Bound<'_, PyAny>,
    obstacle: &Obstacle,
    control_period: f64,
    faced_side: Option<f64>,
    latency: Option<f64>,
    position_error: Option<f64>,
    measurement: Option<PyRef<'_, Measurement>>,
) -> PyResult<(f64, f64)> {
    let limits = match robot.cast::<HolonomicRobot>() {
        Ok(robot) => robot.get().0.limits(),
        Err(_) => robot.cast::<DifferentialDriveRobot>()?.get().0.limits(),
    };
    let sensing = Sensing {
        measurement: measurement.map(|measurement| measurement.0),
        latency,
        position_error,
    };
    let regions = region::radii(&limits, &obstacle.0, control_period, faced_side, &sensing)
        .map_err(crate::errors::CoreError::from)?;
    Ok((regions.critical_radius, regions.active_radius))
}
