//! Checked parameter objects behind the Python dataclasses.

use impact_core::parameters;
use pyo3::prelude::*;

use crate::keywords::parameter_class;

parameter_class! {
    /// Manipulator at the impact point.
    Manipulator(parameters::Manipulator) { mass, damping, stiffness }
}

parameter_class! {
    /// Head on a neck.
    Head(parameters::Head) { mass, damping, stiffness }
}

parameter_class! {
    /// Foam covering.
    Foam(parameters::Foam) { stiffness, damping, thickness, linear_range }
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
