//! Python binding: registration. The module is private; `hrsafety.navigation` is its face.

mod arrays;
mod batch;
mod errors;
mod parameters;
mod run;

use pyo3::prelude::*;

/// Native core of hrsafety.
#[pymodule]
mod _hrsafety {
    #[pymodule_export]
    use crate::batch::simulate_batch;
    #[pymodule_export]
    use crate::parameters::{
        DifferentialDriveRobot, HolonomicRobot, Measurement, Obstacle, Scenario, VirtualForceField,
        region_radii,
    };
    #[pymodule_export]
    use crate::run::{evaluate, force_field, force_terms, lyapunov, simulate};
}
