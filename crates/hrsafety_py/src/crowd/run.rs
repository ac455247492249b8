//! A world that Python steps.

use std::sync::Arc;

use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::crowd::Simulation;
use vff_core::crowd::robots::CrowdRobot;
use vff_core::run::Request;
use vff_core::world::scenario::Mover;

use crate::crowd::{CrowdWorld, fields_of};
use crate::errors::{CoreError, CoreResult};
use crate::python_law::{PointMass, point_mass};
use crate::run::episode::{BUSY, Order, Told, Verified, request_of, told, verified};
use crate::run::situation::situation_fields;
use crate::run::stepped::Stepped;
use crate::unknown::{Explored, explored};

/// A world under way.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct WorldRun(Stepped<Simulation>);

fn robot_of(world: &Simulation, index: usize) -> PyResult<&CrowdRobot> {
    let robot = world.robots().get(index);
    robot.ok_or_else(|| PyIndexError::new_err("the world has no such robot"))
}

#[pymethods]
impl WorldRun {
    #[new]
    fn new(world: &CrowdWorld) -> CoreResult<Self> {
        let simulation = Simulation::observed(Arc::clone(&world.core))?;
        Ok(Self(Stepped::new(simulation, BUSY)))
    }

    /// The point mass that the law of a robot drives.
    fn point_mass(&self, robot: usize) -> PyResult<PointMass> {
        let world = self.0.idle()?;
        robot_of(&world, robot)?;
        let point = match &world.world().robots[robot].mover {
            Mover::Holonomic(robot) => *robot,
            Mover::Differential(robot) => robot.reference(),
        };
        Ok(point_mass(&point))
    }

    /// Fields of what the controller of a robot sees.
    fn situation<'py>(&self, py: Python<'py>, robot: usize) -> PyResult<Bound<'py, PyDict>> {
        let mut world = self.0.idle()?;
        robot_of(&world, robot)?;
        let seen = world.observe(robot).map_err(CoreError::from)?;
        seen.map_or_else(|| Ok(PyDict::new(py)), |seen| situation_fields(py, &seen))
    }

    /// To the next control period; robots that are told a force in N or a velocity in m/s are not under their laws.
    fn step(&self, py: Python<'_>, told: Vec<Order>) -> PyResult<()> {
        self.0.work(py, |world, interrupted| {
            for robot in 0..world.robots().len() {
                world.ask(robot, Request::Law);
            }
            for (robot, force, velocity) in told {
                world.ask(robot, request_of(force, velocity));
            }
            world.period(interrupted)
        })
    }

    /// Present time in s.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.0.idle()?.time())
    }

    /// Whether it has ended.
    #[getter]
    fn finished(&self) -> PyResult<bool> {
        Ok(self.0.idle()?.finished())
    }

    /// Which robots decide in the next step.
    fn deciding(&self) -> PyResult<Vec<bool>> {
        Ok(self.0.idle()?.deciding())
    }

    /// Record of the parts around the law of a robot, if there are any.
    fn trace(&self, robot: usize) -> PyResult<Option<Told>> {
        let world = self.0.idle()?;
        Ok(robot_of(&world, robot)?.trace().as_ref().map(told))
    }

    /// Centers in m of the cells where the law of a robot reckons with people whom it does not see, if it does.
    fn unseen_places(&self, robot: usize) -> PyResult<Option<Vec<[f64; 2]>>> {
        let world = self.0.idle()?;
        Ok(robot_of(&world, robot)?.unseen_places())
    }

    /// What the law of a robot knows of the place from scans, with the way from a place on, if it makes its own map.
    fn explored<'py>(
        &self,
        py: Python<'py>,
        robot: usize,
        place: [f64; 2],
    ) -> PyResult<Option<Explored<'py>>> {
        let world = self.0.idle()?;
        explored(py, robot_of(&world, robot)?.explored(), place)
    }

    /// Number of the person whom each obstacle that a robot sees is, if it is one; none where sensors tell of them.
    fn people(&self, robot: usize) -> PyResult<Vec<Option<usize>>> {
        let world = self.0.idle()?;
        Ok(robot_of(&world, robot)?.people_seen())
    }

    /// Plan that the shield of a robot verified last, if there is one.
    fn examined(&self, robot: usize) -> PyResult<Option<Verified>> {
        let world = self.0.idle()?;
        Ok(robot_of(&world, robot)?.examined().map(verified))
    }

    /// Fields of what was recorded so far.
    fn recorded<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let world = self.0.idle()?;
        fields_of(py, &world, world.recorded().cloned().unwrap_or_default())
    }
}
