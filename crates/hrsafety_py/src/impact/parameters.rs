//! Checked parameter objects behind the Python dataclasses.

use impact_core::parameters;
use pyo3::prelude::*;

use crate::errors::CoreResult;

/// Manipulator at the impact point.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Manipulator(pub parameters::Manipulator);

#[pymethods]
impl Manipulator {
    #[new]
    #[pyo3(signature = (*, mass, damping, stiffness))]
    fn new(mass: f64, damping: f64, stiffness: f64) -> CoreResult<Self> {
        let manipulator = parameters::Manipulator {
            mass,
            damping,
            stiffness,
        };
        Ok(Self(manipulator.checked()?))
    }
}

/// Head on a neck.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Head(pub parameters::Head);

#[pymethods]
impl Head {
    #[new]
    #[pyo3(signature = (*, mass, damping, stiffness))]
    fn new(mass: f64, damping: f64, stiffness: f64) -> CoreResult<Self> {
        let head = parameters::Head {
            mass,
            damping,
            stiffness,
        };
        Ok(Self(head.checked()?))
    }
}

/// Head that cannot move.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct ConstrainedHead;

#[pymethods]
impl ConstrainedHead {
    #[new]
    fn new() -> Self {
        Self
    }
}

/// Foam covering.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Foam(pub parameters::Foam);

#[pymethods]
impl Foam {
    #[new]
    #[pyo3(signature = (*, stiffness, damping, thickness, linear_range))]
    fn new(stiffness: f64, damping: f64, thickness: f64, linear_range: f64) -> CoreResult<Self> {
        let foam = parameters::Foam {
            stiffness,
            damping,
            thickness,
            linear_range,
        };
        Ok(Self(foam.checked()?))
    }
}

/// A head of either kind, borrowed from its Python object.
pub struct Target(pub parameters::Target);

impl<'a, 'py> FromPyObject<'a, 'py> for Target {
    type Error = PyErr;

    fn extract(head: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(head) = head.cast::<Head>() {
            return Ok(Self(parameters::Target::Free(head.get().0)));
        }
        head.cast::<ConstrainedHead>()?;
        Ok(Self(parameters::Target::Constrained))
    }
}

/// Manipulator, foam and head together.
pub fn system(manipulator: &Manipulator, foam: &Foam, head: &Target) -> parameters::System {
    parameters::System {
        manipulator: manipulator.0,
        foam: foam.0,
        head: head.0,
    }
}
