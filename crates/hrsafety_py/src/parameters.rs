//! Checked parameter objects behind the Python dataclasses.

use std::sync::Arc;

use numeric::error::Failure;
use pyo3::prelude::*;
use vff_core::robots::{self, DifferentialWheels, Wheels};
use vff_core::sensing::measurement;
use vff_core::sensing::measurement::{Distribution, Noisy};
use vff_core::world::footprint;
use vff_core::world::motion::{Motion, Segment};
use vff_core::world::obstacle::{self, Limits};
use vff_core::world::region::{self, Sensing};
use vff_core::world::scenario::{self, Mover, Rules};

use crate::errors::CoreError;
use crate::keywords::{Keywords, taken, word};
use crate::robots::footprint::Footprint;

/// A class of robots: their numbers, and their outline if they are no discs.
macro_rules! robot_class {
    ($(#[$about:meta])* $name:ident($core:ty) of $given:ident $value:block) => {
        $(#[$about])*
        #[pyclass(frozen, module = "hrsafety._hrsafety")]
        pub struct $name(pub $core, pub Outline);

        #[pymethods]
        impl $name {
            #[new]
            #[pyo3(signature = (footprint = None, **given))]
            fn new(
                footprint: Option<PyRef<'_, Footprint>>,
                given: Option<Keywords<'_>>,
            ) -> PyResult<Self> {
                let $given = given.unwrap_or_default();
                let core: $core = $value;
                $given.done()?;
                let outline = footprint.map(|footprint| Arc::new(footprint.0.clone()));
                Ok(Self(core.checked().map_err(CoreError::from)?, outline))
            }
        }
    };
}

/// Outline of a robot that is no disc.
pub type Outline = Option<Arc<footprint::Footprint>>;

robot_class! {
    /// Holonomic robot.
    HolonomicRobot(robots::HolonomicRobot) of given {
        let wheels = taken!(given: Wheels {
            radius as wheel_radius, resistance as winding_resistance, inertia as wheel_inertia,
            viscous_friction as wheel_viscous_friction, static_friction as wheel_static_friction,
        });
        taken!(given: robots::HolonomicRobot {
            mass, radius, max_speed, max_acceleration, max_deceleration, wheels = wheels,
        })
    }
}

robot_class! {
    /// Differential-drive robot.
    DifferentialDriveRobot(robots::DifferentialDriveRobot) of given {
        let wheels = taken!(given: DifferentialWheels {
            radius as wheel_radius, span as wheel_span, resistance as winding_resistance,
            inertia as wheel_inertia, viscous_friction as wheel_viscous_friction,
            static_friction as wheel_static_friction,
        });
        taken!(given: robots::DifferentialDriveRobot {
            mass, radius, max_speed, max_acceleration, max_deceleration, max_angular_acceleration,
            max_turn_rate, max_turn_acceleration, reference_speed_share, wheels = wheels,
        })
    }
}

/// A pair of numbers.
type Place = (f64, f64);

/// Obstacle.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Obstacle(obstacle::Obstacle);

impl Obstacle {
    /// The obstacle of the core.
    pub fn core(&self) -> &obstacle::Obstacle {
        &self.0
    }
}

/// Radii and speed that every obstacle may have.
fn limits_of(given: &Keywords<'_>) -> PyResult<Limits> {
    Ok(taken!(given: Limits { active_radius, critical_radius, max_speed }))
}

impl Obstacle {
    /// Disc that moves, or a rectangle where no radius is given.
    fn moved(
        given: &Keywords<'_>,
        motion: impl FnOnce() -> Result<Motion, Failure>,
    ) -> PyResult<Self> {
        let limits = limits_of(given)?;
        if given.holds("radius")? {
            let radius = given.take("radius")?;
            given.done()?;
            let disc = motion().and_then(|motion| obstacle::Obstacle::disc(radius, motion, limits));
            return Ok(Self(disc.map_err(CoreError::from)?));
        }
        let sides = [given.take("length")?, given.take("width")?];
        let heading = given.take("heading")?;
        given.done()?;
        let moving = |motion| obstacle::Obstacle::moving_rectangle(sides, heading, motion, limits);
        let rectangle = motion().and_then(moving);
        Ok(Self(rectangle.map_err(CoreError::from)?))
    }
}

#[pymethods]
impl Obstacle {
    /// Disc at rest.
    #[staticmethod]
    #[pyo3(signature = (**given))]
    fn disc(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let (center, radius) = (given.take("center")?, given.take("radius")?);
        let limits = limits_of(&given)?;
        given.done()?;
        let disc = obstacle::Obstacle::disc_at_rest(center, radius, limits);
        Ok(Self(disc.map_err(CoreError::from)?))
    }

    /// Rectangle at rest.
    #[staticmethod]
    #[pyo3(signature = (**given))]
    fn rectangle(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let size = [given.take("length")?, given.take("width")?];
        let (center, heading) = (given.take("center")?, given.take("heading")?);
        let limits = limits_of(&given)?;
        given.done()?;
        let rectangle = obstacle::Obstacle::rectangle(center, size, heading, limits);
        Ok(Self(rectangle.map_err(CoreError::from)?))
    }

    /// Disc with constant acceleration or a sudden stop; positional, since a study makes millions.
    #[staticmethod]
    fn moving(
        motion: (Place, Place, Place),
        stop: Option<Place>,
        radius: f64,
        limits: (Option<f64>, Option<f64>, Option<f64>),
    ) -> Result<Self, CoreError> {
        let (active_radius, critical_radius, max_speed) = limits;
        let limits = Limits {
            active_radius,
            critical_radius,
            max_speed,
        };
        let (start, velocity, acceleration) = motion;
        let [start, velocity, acceleration] = [start, velocity, acceleration].map(<[f64; 2]>::from);
        let motion = Motion::moving(start, velocity, acceleration, stop.map(<[f64; 2]>::from));
        let disc = motion.and_then(|motion| obstacle::Obstacle::disc(radius, motion, limits));
        Ok(Self(disc?))
    }

    /// The obstacle with the critical and the active radius that a scenario has found.
    fn sized(&self, critical_radius: f64, active_radius: f64) -> Self {
        let mut sized = self.0.clone();
        sized.limits.critical_radius = Some(critical_radius);
        sized.limits.active_radius = Some(active_radius);
        Self(sized)
    }

    /// Rectangle with constant acceleration or a sudden stop.
    #[staticmethod]
    #[pyo3(signature = (**given))]
    fn moving_rectangle(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let (start, velocity) = (given.take("start")?, given.take("velocity")?);
        let (acceleration, stop) = (given.take("acceleration")?, given.take("stop")?);
        Self::moved(&given, || {
            Motion::moving(start, velocity, acceleration, stop)
        })
    }

    /// Disc or rectangle with piecewise constant acceleration.
    #[staticmethod]
    #[pyo3(signature = (**given))]
    fn piecewise(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let start = given.take("start")?;
        let segments: Vec<(f64, [f64; 2], [f64; 2])> = given.take("segments")?;
        let segments: Vec<Segment> = segments
            .into_iter()
            .map(|(duration, velocity, acceleration)| Segment {
                duration,
                velocity,
                acceleration,
            })
            .collect();
        Self::moved(&given, || Motion::piecewise(start, &segments))
    }

    /// Disc or rectangle that follows a recording.
    #[staticmethod]
    #[pyo3(signature = (**given))]
    fn recorded(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let time: Vec<f64> = given.take("time")?;
        let position: Vec<[f64; 2]> = given.take("position")?;
        Self::moved(&given, || Motion::recorded(&time, &position))
    }
}

impl Measurement {
    /// The measurement of the core.
    pub fn core(&self) -> measurement::Measurement {
        self.0
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
        Ok(Self(built.map_err(CoreError::from)?))
    }

    /// Largest distance of a measured position from the one that is measured, in m.
    fn error_bound(&self) -> f64 {
        self.0.error_bound()
    }
}

/// Scenario.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Scenario(pub scenario::Scenario);

#[pymethods]
impl Scenario {
    /// Robot, start and goal, obstacles, rules of the run, measurement and seed; positional, since a
    /// study makes millions.
    #[new]
    fn new(
        robot: &Bound<'_, PyAny>,
        ends: (Place, Place),
        obstacles: Vec<PyRef<'_, Obstacle>>,
        rules: (f64, f64, f64, f64, f64),
        noise: (Option<PyRef<'_, Measurement>>, u64),
    ) -> PyResult<Self> {
        let obstacles = obstacles.iter();
        let obstacles = obstacles.map(|obstacle| obstacle.0.clone()).collect();
        let (control_period, time_limit, arrival_tolerance, heading, rest_time) = rules;
        let rules = Rules {
            control_period,
            time_limit,
            arrival_tolerance,
            rest_time,
            heading,
        };
        let (measurement, seed) = noise;
        let measurement = measurement.map(|measurement| measurement.0);
        let ends = [ends.0.into(), ends.1.into()];
        let body = (mover_of(robot)?, outline_of(robot));
        let scenario = scenario::Scenario::shaped(body, ends, obstacles, rules, measurement);
        Ok(Self(scenario.map_err(CoreError::from)?.reseeded(seed)))
    }

    /// Critical and active radius of every obstacle.
    fn regions(&self) -> Vec<(f64, f64)> {
        let radii = |placed: &scenario::PlacedObstacle| {
            let regions = placed.regions;
            (regions.critical_radius, regions.active_radius)
        };
        self.0.obstacles().iter().map(radii).collect()
    }

    /// Copy of the scenario with another seed.
    fn reseeded(&self, seed: u64) -> Self {
        Self(self.0.clone().reseeded(seed))
    }
}

/// A robot of either kind.
pub fn mover_of(robot: &Bound<'_, PyAny>) -> PyResult<Mover> {
    Ok(match robot.cast::<HolonomicRobot>() {
        Ok(robot) => Mover::Holonomic(robot.get().0),
        Err(_) => Mover::Differential(robot.cast::<DifferentialDriveRobot>()?.get().0),
    })
}

/// Outline of a robot of either kind that is no disc.
pub fn outline_of(robot: &Bound<'_, PyAny>) -> Outline {
    let holonomic = robot.cast::<HolonomicRobot>();
    let differential = robot.cast::<DifferentialDriveRobot>();
    let of_either = holonomic.map(|robot| robot.get().1.clone()).ok();
    of_either
        .or_else(|| differential.map(|robot| robot.get().1.clone()).ok())
        .flatten()
}

/// Critical and active radius of an obstacle for a robot.
#[pyfunction]
#[pyo3(signature = (robot, obstacle, control_period, faced_side, latency, position_error, measurement))]
pub fn region_radii(
    robot: &Bound<'_, PyAny>,
    obstacle: &Obstacle,
    control_period: f64,
    faced_side: Option<f64>,
    latency: Option<f64>,
    position_error: Option<f64>,
    measurement: Option<PyRef<'_, Measurement>>,
) -> PyResult<(f64, f64)> {
    let limits = match mover_of(robot)? {
        Mover::Holonomic(robot) => robot.limits(),
        Mover::Differential(robot) => robot.limits(),
    };
    let sensing = Sensing {
        measurement: measurement.map(|measurement| measurement.0),
        latency,
        position_error,
    };
    let regions = region::radii(&limits, &obstacle.0, control_period, faced_side, &sensing)
        .map_err(CoreError::from)?;
    Ok((regions.critical_radius, regions.active_radius))
}
