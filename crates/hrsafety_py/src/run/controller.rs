//! A law on a robot, told from Python what is seen.

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::lanes::Vector2;
use vff_core::laws::Stop;
use vff_core::laws::shield::Status;
use vff_core::run::controller::{self, HeldOrder, Observation, Sighting};
use vff_core::world::geometry::RobotState;

use crate::arrays::fields;
use crate::errors::CoreError;
use crate::laws::Law;
use crate::maps::Lidar;
use crate::parameters::Scenario;
use crate::run::stepped::Stepped;

/// Number, position, velocity and instant of somebody who was measured.
type Detection = (usize, [f64; 2], [f64; 2], Option<f64>);

const BUSY: &str = "an update of this controller is under way; update it from one place";

/// A law on a robot.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Controller(Stepped<controller::Controller>);

#[pymethods]
impl Controller {
    #[new]
    fn new(
        scenario: &Scenario,
        law: &Law,
        lidar: Option<PyRef<'_, Lidar>>,
        latency: f64,
    ) -> PyResult<Self> {
        let lidar = lidar.as_ref().map(|lidar| &lidar.0);
        let core = controller::Controller::new(scenario.0.clone(), &law.any, lidar, latency);
        Ok(Self(Stepped::new(core.map_err(CoreError::from)?, BUSY)))
    }

    /// Fields of what the robot is to do; `robot`: position and velocity.
    #[allow(clippy::too_many_arguments)] // each by name in Python's face
    #[pyo3(signature = (time, robot, heading, *, seen, gone, scan))]
    fn update<'py>(
        &self,
        py: Python<'py>,
        time: f64,
        robot: Option<([f64; 2], [f64; 2])>,
        heading: f64,
        seen: Vec<Detection>,
        gone: Vec<usize>,
        scan: Option<PyReadonlyArray1<'py, f64>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let sighting = |(index, position, velocity, time)| Sighting {
            index,
            position,
            velocity,
            time,
        };
        let seen: Vec<Sighting> = seen.into_iter().map(sighting).collect();
        let ranges = scan.as_ref().map(|scan| scan.as_slice()).transpose()?;
        let told = Observation {
            time,
            robot: robot.map(|(position, velocity)| RobotState {
                position: Vector2::from(position),
                velocity: Vector2::from(velocity),
            }),
            heading,
            seen: &seen,
            gone: &gone,
            scan: ranges,
        };
        let order = self.0.work(py, |core, interrupted| {
            core.update(&told, Stop(interrupted))
        })?;
        fields_of(py, &order)
    }

    /// Who was seen in the last update where the law reckoned with nobody.
    fn unexpected(&self) -> PyResult<Vec<usize>> {
        Ok(self.0.idle()?.unexpected())
    }

    /// Who is there, as far as is known, in the order of the obstacles.
    fn present(&self) -> PyResult<Vec<bool>> {
        Ok(self.0.idle()?.present().collect())
    }
}

/// Times since the update in s with the rates between which a plan changes evenly.
fn plan_of(order: &HeldOrder) -> Vec<(f64, [f64; 2])> {
    let rest = order.course.as_ref();
    rest.map_or_else(Vec::new, |(course, since)| course.rest(*since).collect())
}

fn fields_of<'py>(py: Python<'py>, order: &HeldOrder) -> PyResult<Bound<'py, PyDict>> {
    let (before, heading) = order.course.map_or(([0.0; 2], 0.0), |(course, since)| {
        (course.velocity(since).into(), course.heading(since))
    });
    let off = order.off_plan;
    Ok(fields! { py;
        value force = (order.force.x, order.force.y);
        value velocity = (order.velocity.x, order.velocity.y);
        value speed = order.twist.map(|twist| twist.speed);
        value turn_rate = order.twist.map(|twist| twist.turn_rate);
        value before = (before[0], before[1]);
        value heading = heading;
        value plan = plan_of(order);
        value robot_off_plan = off.map(|off| (off.position, off.velocity));
        value status = order.status.map(Status::word);
        value order: taken_over, arrived, clock_set_back, oldest, unknown_beams;
        value timing = order.timing.word();
    })
}
