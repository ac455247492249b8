//! A run of the follower that Python steps, or lets run to its end.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::lanes::Vector2;
use vff_core::run::follower::{
    Follower as Robot, FollowerOutcome, FollowerRecord, FollowerScene, FollowerSteps as Steps,
    Leader,
};
use vff_core::world::obstacle::Obstacle;
use vff_core::world::shape::Shape;

use super::{Follower, Mover, VirtualImpedance};
use crate::arrays::Fields;
use crate::errors::CoreError;
use crate::keywords::Keywords;
use crate::reactive::percept_fields;
use crate::run::episode::BUSY;
use crate::run::stepped::Stepped;

/// A run under way.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct FollowerSteps {
    steps: Stepped<Steps>,
    sensors: usize,
    obstacles: usize,
}

#[pymethods]
impl FollowerSteps {
    #[new]
    #[pyo3(signature = (follower, law, obstacles, *, seed, **given))]
    fn new(
        follower: &Follower,
        law: &VirtualImpedance,
        obstacles: Vec<PyRef<'_, Mover>>,
        seed: u64,
        given: Option<Keywords<'_>>,
    ) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let (start, end) = (given.take("leader_start")?, given.take("leader_end")?);
        let leader = Leader::going(start, end, given.take("leader_speed")?);
        let mut leader = leader.map_err(CoreError::from)?;
        let size: Option<[f64; 2]> = given.take("leader_size")?;
        leader.shape = size.map(Shape::upright);
        let obstacles: Vec<Obstacle> = obstacles.iter().map(|mover| mover.0.clone()).collect();
        let count = obstacles.len();
        let scene = FollowerScene {
            leader,
            obstacles,
            duration: given.take("duration")?,
        };
        given.done()?;
        let robot = Robot::new(&follower.with(law)).map_err(CoreError::from)?;
        let steps = Steps::new(&robot, scene, seed).map_err(CoreError::from)?;
        Ok(Self {
            steps: Stepped::new(steps, BUSY),
            sensors: robot.sensors(),
            obstacles: count,
        })
    }

    /// Fields of what the law decides by.
    fn percept<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let steps = self.steps.idle()?;
        percept_fields(py, steps.time(), &steps.percept())
    }

    /// One control period under the law or a force in N.
    #[pyo3(signature = (*, force))]
    fn step(&self, py: Python<'_>, force: Option<[f64; 2]>) -> PyResult<()> {
        self.steps.work(py, |steps, interrupted| {
            steps.period(force.map(Vector2::from), interrupted)
        })
    }

    /// Runs to the end under the law.
    fn run(&self, py: Python<'_>) -> PyResult<()> {
        self.steps.work(py, Steps::run)
    }

    /// Time of the control periods so far in s.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.steps.idle()?.time())
    }

    /// Whether the run has ended.
    #[getter]
    fn finished(&self) -> PyResult<bool> {
        Ok(self.steps.idle()?.finished())
    }

    /// Fields of the run so far.
    fn recorded<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let steps = self.steps.idle()?;
        let (outcome, rows) = steps.recorded();
        let fields = Fields::new(py);
        samples(&fields, rows, self.sensors, self.obstacles)?;
        summary(&fields, &outcome)?;
        Ok(fields.finish())
    }
}

/// Samples of a run.
fn samples(
    fields: &Fields<'_>,
    recording: &FollowerRecord,
    sensors: usize,
    obstacles: usize,
) -> PyResult<()> {
    let count = recording.time.len();
    let flat = |rows: &[Vector2<f64>]| -> Vec<f64> {
        rows.iter().flat_map(|row| [row.x, row.y]).collect()
    };
    let pairs = [
        ("position", &recording.position),
        ("virtual_velocity", &recording.virtual_velocity),
        ("target", &recording.target),
        ("source", &recording.source),
        ("attraction", &recording.attraction),
        ("repulsion", &recording.repulsion),
    ];
    for (name, rows) in pairs {
        fields.array(name, flat(rows), [count, 2])?;
    }
    fields.array("wheel_speed", recording.wheel_speed.concat(), [count, 2])?;
    fields.array("shift", flat(&recording.shifts), [count, obstacles, 2])?;
    fields.vector("time", recording.time.clone())?;
    fields.vector("heading", recording.heading.clone())?;
    fields.array("readings", recording.readings.clone(), [count, sensors])?;
    fields.array("clearance", recording.clearance.clone(), [count, obstacles])
}

/// End of a run.
fn summary(fields: &Fields<'_>, outcome: &FollowerOutcome) -> PyResult<()> {
    let contact = outcome.contact;
    fields.value("contact_obstacle", contact.map(|touch| touch.obstacle))?;
    fields.value("contact_bearing", contact.map(|touch| touch.bearing))?;
    fields.value("end_time", outcome.end_time)?;
    fields.value("source_distance", outcome.source_distance)?;
    fields.value("least_clearance", outcome.least_clearance)?;
    fields.value("path_length", outcome.path_length)?;
    fields.value("turning", outcome.turning)
}
