//! Joints and the effective manipulator that they make.

use impact_core::joint;
use impact_core::joint::effective::{OneJoint, Reach, TwoJoints, UniformLinks};
use impact_core::parameters::Manipulator;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors::{CoreError, CoreResult};
use crate::keywords::{Keywords, parameter_class, taken};

parameter_class! {
    /// Elastic joint under control.
    Joint(joint::Joint) {
        inertia, mechanical_stiffness, mechanical_damping, control_stiffness, control_damping,
    }

    /// Reduced stiffness.
    #[getter]
    fn stiffness(&self) -> f64 {
        self.0.stiffness()
    }

    /// Reduced damping.
    #[getter]
    fn damping(&self) -> f64 {
        self.0.damping()
    }

    /// Error of the reduced joint at frequencies.
    fn model_error<'py>(
        &self,
        py: Python<'py>,
        omega: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let errors: Result<Vec<f64>, _> = omega
            .as_slice()?
            .iter()
            .map(|frequency| self.0.model_error(*frequency))
            .collect();
        Ok(errors.map_err(CoreError::from)?.into_pyarray(py))
    }
}

fn triple(manipulator: Manipulator) -> (f64, f64, f64) {
    (manipulator.mass, manipulator.damping, manipulator.stiffness)
}

/// Effective mass, damping and stiffness of one joint.
#[pyfunction]
#[pyo3(signature = (**given))]
pub fn effective_one_joint(given: Option<Keywords<'_>>) -> PyResult<(f64, f64, f64)> {
    let given = given.unwrap_or_default();
    let joint = taken!(given: OneJoint { inertia, damping, stiffness, lever_arm });
    given.done()?;
    Ok(triple(joint.manipulator().map_err(CoreError::from)?))
}

/// Effective mass, damping and stiffness of two joints.
#[pyfunction]
#[pyo3(signature = (**given))]
pub fn effective_two_joints(given: Option<Keywords<'_>>) -> PyResult<(f64, f64, f64)> {
    let given = given.unwrap_or_default();
    let joints =
        taken!(given: TwoJoints { mass_matrix, damping, stiffness, second_link, lever_arm, elbow });
    given.done()?;
    Ok(triple(joints.manipulator().map_err(CoreError::from)?))
}

/// Speed of the impact point of two joints.
#[pyfunction]
#[pyo3(signature = (rates, *, second_link, lever_arm, elbow))]
pub fn impact_point_speed(
    rates: [f64; 2],
    second_link: f64,
    lever_arm: f64,
    elbow: f64,
) -> CoreResult<f64> {
    let reach = Reach {
        second_link,
        lever_arm,
        elbow,
    };
    Ok(reach.speed(rates)?)
}

/// Damping of two joints with their dashpots in series.
#[pyfunction]
#[pyo3(signature = (damping, *, second_link, lever_arm, elbow))]
pub fn dashpots_in_series(
    damping: [f64; 2],
    second_link: f64,
    lever_arm: f64,
    elbow: f64,
) -> CoreResult<f64> {
    let reach = Reach {
        second_link,
        lever_arm,
        elbow,
    };
    Ok(reach.dashpots_in_series(damping)?)
}

/// Mass matrix of two uniform links.
#[pyfunction]
#[pyo3(signature = (*, mass, length, elbow))]
pub fn uniform_links(mass: [f64; 2], length: [f64; 2], elbow: f64) -> CoreResult<[[f64; 2]; 2]> {
    Ok(UniformLinks { mass, length }.mass_matrix(elbow)?)
}
