//! Python binding: registration. The module is private; `hrsafety.navigation`,
//! `hrsafety.impact` and `hrsafety.reactive` are its faces.

// Whatever comes from Python is converted, or borrowed by a guard that is itself owned.
#![allow(clippy::needless_pass_by_value)]

mod arrays;
mod contact;
mod crowd;
mod errors;
mod gains;
mod impact;
mod keywords;
mod laws;
mod maps;
mod parameters;
mod program;
mod python_law;
mod reactive;
mod robots;
mod run;
mod safe;
mod scenes;
mod signals;
mod twists;
mod unknown;
mod watch;

use pyo3::prelude::*;

/// Native core of hrsafety.
#[pymodule]
mod _hrsafety {
    use super::{PyResult, Python};
    use numpy::{PyArray1, PyArrayMethods};

    /// Imports what arrays need now: an exception in an import later on, such as that of Ctrl-C,
    /// would be a panic.
    #[pymodule_init]
    fn init() -> PyResult<()> {
        Python::attach(|py| {
            PyArray1::<f64>::zeros(py, 0, false)
                .try_readonly()
                .map(|_| ())
        })?;
        Ok(())
    }

    #[pymodule_export]
    const DECIDED_OVERLAP: f64 = vff_core::run::DECIDED_OVERLAP;
    #[pymodule_export]
    const CONTACT_SPEED: f64 = vff_core::run::CONTACT_SPEED;
    #[pymodule_export]
    use crate::contact::arm::{Arm, bare_forces, nearest_inertia, urdf_joint_names};
    #[pymodule_export]
    use crate::contact::separation::{
        StoppingCurve, guard_distance, separation_distances, separation_speeds,
    };
    #[pymodule_export]
    use crate::contact::{
        contact_column, contact_differential_mass, contact_exceedance, contact_holonomic_mass,
        contact_names, contact_rows, contact_simulate, contact_speed, contact_thickness,
        contact_words,
    };
    #[pymodule_export]
    use crate::crowd::gym::{CrowdEnvironments, environment_words};
    #[pymodule_export]
    use crate::crowd::metrics::{
        CrowdEpisode, crowd_metric_names, crowd_metrics, crowd_world_metrics,
    };
    #[pymodule_export]
    use crate::crowd::run::WorldRun;
    #[pymodule_export]
    use crate::crowd::{
        CrowdModel, CrowdPerson, CrowdRobot, CrowdSource, CrowdWall, CrowdWorld,
        crowd_certificates, crowd_circle, crowd_decisions, crowd_simulate,
    };
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
        Joint, dashpots_in_series, effective_one_joint, effective_two_joints, impact_point_speed,
        uniform_links,
    };
    #[pymodule_export]
    use crate::impact::many::{impact_metrics_batch, impact_status_words};
    #[pymodule_export]
    use crate::impact::parameters::{ConstrainedHead, Foam, Head, Manipulator};
    #[pymodule_export]
    use crate::impact::signal::{
        contiguous_level, hic, hic_of_pulse, moving_average, recorded_metrics, signal_shape,
    };
    #[pymodule_export]
    use crate::impact::single::{
        impact_criteria, impact_gradients, impact_metrics, impact_parameter_names,
    };
    #[pymodule_export]
    use crate::laws::Law;
    #[pymodule_export]
    use crate::maps::{Guide, Lidar, Plan, StaticMap, cell_distances, check_takeover};
    #[pymodule_export]
    use crate::parameters::{
        DifferentialDriveRobot, HolonomicRobot, Measurement, Obstacle, Scenario, region_radii,
    };
    #[pymodule_export]
    use crate::program::contact::ProgramContact;
    #[pymodule_export]
    use crate::program::path::{program_refine, program_retime, program_spline};
    #[pymodule_export]
    use crate::program::{program_draws, program_zone_starts, program_zones};
    #[pymodule_export]
    use crate::reactive::follower::echoes::{
        EchoShape, Sonar, cast_rays, sonar_mounts, sonar_readings, speed_of_sound,
    };
    #[pymodule_export]
    use crate::reactive::follower::runs::{
        FollowerLayouts, follower_batch, follower_layout, follower_touching,
    };
    #[pymodule_export]
    use crate::reactive::follower::steps::FollowerSteps;
    #[pymodule_export]
    use crate::reactive::follower::{
        Follower, Mover, VirtualImpedance, attraction_forces, collision_feet, collision_points,
        fix_deviations, impedance_forces, vectors_to_world,
    };
    #[pymodule_export]
    use crate::reactive::localization::bursts::{
        Burst, Converter, burst_trial_delays, doppler_frequency, jittered_sound_delays,
        likeness_curves, record_burst, sound_delays,
    };
    #[pymodule_export]
    use crate::reactive::localization::{
        MicrophoneArray, fix_status_words, locate_sounds, microphone_delays, microphone_elevations,
        parallel_ray_bearings, printed_ranges,
    };
    #[pymodule_export]
    use crate::reactive::skirt::{
        SkirtMotion, SkirtScene, TriOmniKinematics, UltrasonicSkirt, skirt_closing_gap,
        skirt_closing_radius, skirt_directions, skirt_least_sensors, skirt_printed_gaps,
        skirt_safe_distance, skirt_states, skirt_test,
    };
    #[pymodule_export]
    use crate::reactive::skirt_steps::SkirtSteps;
    #[pymodule_export]
    use crate::robots::as_built::{AsBuilt, as_built_evaluate, as_built_many, as_built_simulate};
    #[pymodule_export]
    use crate::robots::differential::{ReferencePath, Tracking, VirtualTorque, track, track_batch};
    #[pymodule_export]
    use crate::robots::footprint::Footprint;
    #[pymodule_export]
    use crate::robots::sensing::{Camera, ErrorSource, Estimator, Sensor, Vision, steady_gains};
    #[pymodule_export]
    use crate::robots::wheels::{
        DifferentialKinematics, OmniKinematics, Slip, WheelDrive, differential_wheels,
        holonomic_wheels, wheel_reference, wheel_response,
    };
    #[pymodule_export]
    use crate::run::batch::simulate_batch;
    #[pymodule_export]
    use crate::run::controller::Controller;
    #[pymodule_export]
    use crate::run::episode::Run;
    #[pymodule_export]
    use crate::run::falsify::Hunt;
    #[pymodule_export]
    use crate::run::{
        evaluate, force_field, force_terms, law_command, lyapunov, run_outcomes, simulate,
    };
    #[pymodule_export]
    use crate::safe::{
        Foresight, SafetyFilter, Shield, Unseen, Yielding, blind_corner_speeds, guarded_law,
        shield_speed_bound,
    };
    #[pymodule_export]
    use crate::scenes::Scenarios;
    #[pymodule_export]
    use crate::twists::choose_twist;
    #[pymodule_export]
    use crate::unknown::{ArcRollouts, ScanController, UnknownMap, exploring_law};
}
