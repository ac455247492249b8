//! Two-wheel robot that follows a reference.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::robots::differential::{
    self, DifferentialLimits, ErrorFrame, ExponentialGoal, FullSpeed, Nonlinear, Pose,
    ReferenceTurn, TorqueSteering, TrackOptions, TrackRow, TrackRun, TrackStart, Twist,
};
use vff_core::world::motion::Motion;

use crate::arrays::fields;
use crate::errors::{CoreError, CoreResult};
use crate::keywords::{Keywords, parameter_class, taken};
use crate::parameters::DifferentialDriveRobot;
use crate::watch::{Report, watched};

/// Tracking law.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Tracking(pub differential::Tracking);

#[pymethods]
impl Tracking {
    /// Up to the full speed.
    #[staticmethod]
    #[pyo3(signature = (**given))]
    fn full_speed(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let law = taken!(given: FullSpeed { position_gain, heading_gain });
        given.done()?;
        Self::checked(differential::Tracking::FullSpeed(law))
    }

    /// The law of the source.
    #[staticmethod]
    #[pyo3(signature = (**given))]
    fn nonlinear(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let frames = [("robot", ErrorFrame::Robot), ("world", ErrorFrame::World)];
        let turns = [
            ("derivative", ReferenceTurn::Derivative),
            ("printed", ReferenceTurn::HeadingErrorPerPeriod),
        ];
        let turn = "be \"derivative\" or \"printed\"";
        let law = taken!(given: Nonlinear {
            damping_ratio, gain,
            frame = given.word("error_frame", "be \"robot\" or \"world\"", &frames)?,
            turn = given.word("reference_turn", turn, &turns)?,
        });
        given.done()?;
        Self::checked(differential::Tracking::Nonlinear(law))
    }

    /// Exponentially to the goal near it.
    #[staticmethod]
    #[pyo3(signature = (**given))]
    fn exponential(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let law = taken!(given: ExponentialGoal {
            approach = taken!(given: FullSpeed { position_gain, heading_gain }), distance_gain,
            bearing_gain, orientation_gain, goal_heading, capture_radius, rest_radius,
        });
        given.done()?;
        Self::checked(differential::Tracking::ExponentialGoal(law))
    }
}

impl Tracking {
    /// A law whose numbers are allowed.
    fn checked(law: differential::Tracking) -> PyResult<Self> {
        Ok(Self(law.checked().map_err(CoreError::from)?))
    }
}

parameter_class! {
    /// Torque that turns the robot toward the force.
    VirtualTorque(differential::VirtualTorque) { torque_gain, damping_ratio, backward }

    /// Gain that gives a robot an angular frequency.
    #[staticmethod]
    fn gain_for(robot: &DifferentialDriveRobot, frequency: f64) -> CoreResult<f64> {
        let law = differential::VirtualTorque::tuned(&robot.0, frequency);
        Ok(law.checked()?.torque_gain)
    }

    /// Torque at a heading.
    fn torque(&self, heading: f64, force: [f64; 2]) -> f64 {
        self.0.torque(heading, force)
    }

    /// Speed and turn rate to ask for.
    #[pyo3(signature = (robot, *, force, heading, speed, turn_rate, control_period))]
    fn command(
        &self,
        robot: &DifferentialDriveRobot,
        force: [f64; 2],
        heading: f64,
        speed: f64,
        turn_rate: f64,
        control_period: f64,
    ) -> CoreResult<(f64, f64)> {
        let limits = DifferentialLimits::from(&robot.0);
        let pose = Pose {
            position: [0.0; 2],
            heading,
        };
        let twist = Twist { speed, turn_rate };
        let steering = TorqueSteering::new(&self.0, &robot.0, &limits, control_period);
        let wish = steering.checked_command(&pose, twist, force)?;
        Ok((wish.speed, wish.turn_rate))
    }
}

/// Path of a reference.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct ReferencePath(pub differential::ReferencePath);

#[pymethods]
impl ReferencePath {
    /// Constant velocity.
    #[staticmethod]
    #[pyo3(signature = (*, start, velocity))]
    fn line(start: [f64; 2], velocity: [f64; 2]) -> CoreResult<Self> {
        let motion = Motion::moving(start, velocity, [0.0; 2], None)?;
        Ok(Self(differential::ReferencePath::Pieces(motion)))
    }

    /// Circle at constant speed.
    #[staticmethod]
    #[pyo3(signature = (*, center, radius, speed, start_angle))]
    fn circle(center: [f64; 2], radius: f64, speed: f64, start_angle: f64) -> CoreResult<Self> {
        Ok(Self(differential::ReferencePath::circle(
            center,
            radius,
            speed,
            start_angle,
        )?))
    }

    /// Cubic between samples.
    #[staticmethod]
    #[pyo3(signature = (*, time, position, velocity))]
    fn samples(
        time: PyReadonlyArray1<'_, f64>,
        position: PyReadonlyArray2<'_, f64>,
        velocity: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Self> {
        let path = differential::ReferencePath::samples(
            time.as_slice()?.to_vec(),
            position.as_slice()?.as_chunks().0.to_vec(),
            velocity.as_slice()?.as_chunks().0.to_vec(),
        );
        Ok(Self(path.map_err(CoreError::from)?))
    }

    /// Positions, velocities and accelerations at instants.
    fn at<'py>(
        &self,
        py: Python<'py>,
        time: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let instants = time.as_slice()?;
        let mut cursor = 0;
        let states: Vec<_> = instants
            .iter()
            .map(|instant| self.0.at(*instant, &mut cursor))
            .collect();
        let count = states.len();
        let position = states.iter().flat_map(|state| state.position).collect();
        let velocity = states.iter().flat_map(|state| state.velocity).collect();
        let acceleration = states.iter().flat_map(|state| state.acceleration).collect();
        Ok(fields! { py;
            array [count, 2] position = position;
            array [count, 2] velocity = velocity;
            array [count, 2] acceleration = acceleration;
        })
    }
}

/// A start from x, y, heading, speed and turn rate.
fn start_of(numbers: &[f64; 5]) -> TrackStart {
    let [x, y, heading, speed, turn_rate] = *numbers;
    TrackStart {
        pose: Pose {
            position: [x, y],
            heading,
        },
        twist: Twist { speed, turn_rate },
    }
}

fn options_of(given: &Keywords<'_>) -> PyResult<TrackOptions> {
    Ok(taken!(given: TrackOptions { period as control_period, step, duration, goal }))
}

/// History of one run.
#[pyfunction]
#[pyo3(signature = (reference, tracking, robot, **given))]
pub fn track<'py>(
    py: Python<'py>,
    reference: &ReferencePath,
    tracking: &Tracking,
    robot: &DifferentialDriveRobot,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let start: [f64; 5] = given.take("start")?;
    let options = options_of(&given)?;
    given.done()?;
    let limits = DifferentialLimits::from(&robot.0);
    let (path, law, start) = (&reference.0, &tracking.0, start_of(&start));
    let run = watched(py, Report::none(), |control| {
        let interrupted = || control.interrupted();
        differential::track(path, (law, &limits), &start, &options, &interrupted)
    })?;
    history(py, run)
}

fn history(py: Python<'_>, run: TrackRun) -> PyResult<Bound<'_, PyDict>> {
    let rows = run.time.len();
    Ok(fields! { py;
        vector run: time, heading, speed, turn_rate, commanded_speed, commanded_turn_rate,
            goal_phase;
        array [rows, 2] run: position, reference_position, reference_velocity;
    })
}

/// Summary columns of many runs.
#[pyfunction]
#[pyo3(signature = (references, tracking, robot, **given))]
pub fn track_batch<'py>(
    py: Python<'py>,
    references: Vec<PyRef<'py, ReferencePath>>,
    tracking: &Tracking,
    robot: &DifferentialDriveRobot,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let starts: PyReadonlyArray2<'py, f64> = given.take("starts")?;
    let levels: Vec<f64> = given.take("levels")?;
    let options = options_of(&given)?;
    let threads: Option<usize> = given.take("threads")?;
    let progress: Option<Py<PyAny>> = given.take("progress")?;
    given.done()?;
    let limits = DifferentialLimits::from(&robot.0);
    let paths: Vec<_> = references.iter().map(|path| path.0.clone()).collect();
    let starts: Vec<_> = starts
        .as_slice()?
        .as_chunks()
        .0
        .iter()
        .map(start_of)
        .collect();
    let law = &tracking.0;
    let report = Report::new(progress.as_ref(), starts.len());
    let rows = watched(py, report, |control| {
        differential::track_batch(
            &paths,
            (law, &limits),
            (&starts, &levels),
            (&options, threads),
            &|| control.interrupted(),
            &|runs| control.count(runs),
        )
    })?;
    summary(py, &rows, levels.len())
}

fn summary<'py>(py: Python<'py>, rows: &[TrackRow], levels: usize) -> PyResult<Bound<'py, PyDict>> {
    let settling = rows
        .iter()
        .flat_map(|row| row.settling_time.clone())
        .collect();
    Ok(fields! { py;
        each rows: final_error, max_error, final_heading, path_length;
        array [rows.len(), levels] settling_time = settling;
    })
}
