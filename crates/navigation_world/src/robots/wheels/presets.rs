//! The wheels of both robots of Zeng (2011).
//!
//! Given there: motion (D.2.6, E.2.6), gains and feed-forward (Tables D.2, E.2), encoder, gear,
//! amplifier, observer poles. Chosen here: the control period; the motor's winding resistance,
//! torque constant (60.3 mN m/A) and nominal voltage as supply, of the motor that the source names
//! (RE 40, 148877); the current limit, of an analog command of 10 V at 1 A/V.

use super::controller::{Feedback, WheelController};
use super::drive::{Encoder, Motor, WheelDrive};
use super::dynamics::WheelDynamics;

/// Three wheels of the holonomic robot: (D.2.6) and Table D.2.
#[must_use]
pub fn holonomic_wheels() -> [WheelDrive; 3] {
    [
        drive([137.0, 0.26, 25.7], [37.0, 1.1], [0.0073, 0.0019, 0.188]),
        drive([136.0, 0.27, 30.2], [34.0, 1.1], [0.0074, 0.0020, 0.223]),
        drive([155.0, 0.37, 28.3], [35.0, 1.1], [0.0065, 0.0024, 0.183]),
    ]
}

/// Right and left wheel of the differential-drive robot: (E.2.6) and Table E.2.
#[must_use]
pub fn differential_wheels() -> [WheelDrive; 2] {
    [
        drive([128.0, 0.41, 22.9], [34.0, 1.0], [0.0079, 0.0032, 0.18]),
        drive([175.0, 0.52, 49.3], [35.0, 1.0], [0.0057, 0.0030, 0.28]),
    ]
}

fn drive(
    [gain, decay, friction]: [f64; 3],
    [proportional, derivative]: [f64; 2],
    [inertia, viscous_friction, static_friction]: [f64; 3],
) -> WheelDrive {
    WheelDrive {
        dynamics: WheelDynamics::from_accelerations(gain, decay, friction),
        motor: Motor {
            amplifier_gain: 1.0,
            resistance: 1.16,
            back_emf: 0.603,
            current_limit: 10.0,
            supply_voltage: 48.0,
        },
        encoder: Some(Encoder {
            counts: 2000.0,
            gear_ratio: 10.0,
        }),
        controller: WheelController {
            proportional,
            derivative,
            model: WheelDynamics {
                inertia,
                viscous_friction,
                static_friction,
            },
            feedback: Feedback::Observer {
                poles: [-10.0, -10.0],
            },
        },
        period: 1e-3,
    }
}
