//! Open-loop tests: one command is held, the encoder is read.

use super::drive::WheelDrive;
use super::dynamics::{HeldStep, WheelState};
use super::follow::LOOK;
use numeric::error::{Failure, Result};

/// One open-loop test from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenLoopTest {
    /// Held command in V.
    pub command: f64,
    /// Angle of the wheel at the start, in rad: where between two counts the test begins.
    pub start_angle: f64,
    /// Number of wheel periods.
    pub periods: usize,
}

/// Angle turned since the start as the encoder reads it, in rad, at the start and after every wheel
/// period.
///
/// # Errors
/// The caller asks to stop.
pub fn open_loop_angles(
    drive: &WheelDrive,
    test: &OpenLoopTest,
    interrupted: &dyn Fn() -> bool,
) -> Result<Vec<f64>> {
    let step = HeldStep::new(&drive.dynamics, drive.period);
    let mut state = WheelState {
        angle: test.start_angle,
        speed: 0.0,
    };
    let zero = drive.read(state.angle);
    let mut angles = Vec::with_capacity(test.periods + 1);
    angles.push(0.0);
    for period in 0..test.periods {
        if period % LOOK == 0 && interrupted() {
            return Err(Failure::Interrupted);
        }
        let wanted = drive.motor.amplifier_gain * test.command;
        state = step.advance(state, drive.motor.limited(wanted, state.speed));
        angles.push(drive.read(state.angle) - zero);
    }
    Ok(angles)
}

#[cfg(test)]
mod tests {
    use super::super::presets::{differential_wheels, holonomic_wheels};
    use super::*;

    fn test(command: f64) -> OpenLoopTest {
        OpenLoopTest {
            command,
            start_angle: 0.0,
            periods: 1000,
        }
    }

    #[test]
    fn a_test_that_is_to_stop_has_no_angles() {
        let drive = holonomic_wheels()[2];
        let found = open_loop_angles(&drive, &test(-0.4), &|| true);
        assert!(matches!(found, Err(Failure::Interrupted)));
    }

    #[test]
    fn angles_are_those_of_the_formula_to_half_a_count() {
        let drive = holonomic_wheels()[2];
        let angles = open_loop_angles(&drive, &test(-0.4), &|| false).unwrap();
        let (decay, slope): (f64, f64) = (0.37, -(155.0 * 0.4 - 28.3));
        for (index, angle) in angles.iter().enumerate() {
            let x = decay * index as f64 * 1e-3;
            let formula = slope * (x + (-x).exp_m1()) / (decay * decay);
            assert!((angle - formula).abs() < 1.58e-4, "{index}");
        }
    }

    #[test]
    fn friction_holds_the_second_wheel_at_a_quarter_volt() {
        let angles = open_loop_angles(&differential_wheels()[1], &test(0.25), &|| false).unwrap();
        assert!(angles.iter().all(|&angle| angle == 0.0));
        let moved = open_loop_angles(&differential_wheels()[1], &test(0.3), &|| false).unwrap();
        assert!(moved[1000] > 1.0);
    }
}
