//! Python binding: registration. The module is private; `hrsafety.navigation` and
//! `hrsafety.impact` are its faces.

mod arrays;
mod batch;
mod errors;
mod gains;
mod impact;
mod laws;
mod parameters;
mod run;
mod signals;
mod watch;

use pyo3::prelude::*;

/// Native core of hrsafety.
#[pymodule]
mod _hrsafety {
    use super::{Bound, PyModule, PyResult};
    use numpy::{PyArray1, PyArrayMethods};

    /// Imports what arrays need now: an exception in an import later on, such as that of Ctrl-C,
    /// would be a panic.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        PyArray1::<f64>::zeros(module.py(), 0, false).try_readonly()?;
        Ok(())
    }

    #[pymodule_export]
    use crate::batch::simulate_batch;
    #[pymodule_export]
    use crate::gains::problem::GainProblem;
    #[pymodule_export]
    use crate::gains::searches::{
        front_hypervolume, gain_front, search_gains, search_gains_globally,
    };
    #[pymodule_export]
    use crate::impact::cylinder::CylinderController;
    #[pymodule_export]
    use crate::impact::design::{foam_boundary, foam_fastest, foam_ratios};
    #[pymodule_export]
    use crate::impact::direct_drive::{DirectDrive, simulate_direct_drive};
    #[pymodule_export]
    use crate::impact::history::{SetPoint, impact_simulate, stopping_segments};
    #[pymodule_export]
    use crate::impact::identify::{
        drop_trajectory, fit_open_loop, fit_static, identify_direct_drive, identify_foam, pd_gains,
        tube_inertia,
    };
    #[pymodule_export]
    use crate::impact::joints::{
        Joint, effective_one_joint, effective_two_joints, impact_point_speed, uniform_links,
    };
    #[pymodule_export]
    use crate::impact::many::{impact_metrics_batch, impact_status_words};
    #[pymodule_export]
    use crate::impact::parameters::{ConstrainedHead, Foam, Head, Manipulator};
    #[pymodule_export]
    use crate::impact::signal::{
        contiguous_level, hic, hic_half_sine, hic_square, hic_triangle, moving_average,
        recorded_metrics,
    };
    #[pymodule_export]
    use crate::impact::single::{impact_gradient_names, impact_gradients, impact_metrics};
    #[pymodule_export]
    use crate::laws::Law;
    #[pymodule_export]
    use crate::parameters::{
        DifferentialDriveRobot, HolonomicRobot, Measurement, Obstacle, Scenario, region_radii,
    };
    #[pymodule_export]
    use crate::run::{evaluate, force_field, force_terms, law_command, lyapunov, simulate};
}
