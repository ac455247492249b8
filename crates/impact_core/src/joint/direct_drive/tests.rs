//! The limited joint beside the linear one and beside what can be written down.

use super::*;
use crate::parameters::{FOAM_1, HEAD_APPARATUS};

/// Fourth-order steps of 0.01 time constants over one impact.
const STEPS: f64 = 1e-10;

/// The joint whose linear form is the nominal manipulator: 9.6 kg, 250 N s/m, 20 kN/m.
fn nominal() -> DirectDrive {
    let (lever_arm, torque_constant, viscous_friction) = (0.078, 0.27121, 0.007_994_5);
    let squared_arm: f64 = lever_arm * lever_arm;
    DirectDrive {
        inertia: 9.6 * squared_arm,
        lever_arm,
        torque_constant,
        amplifier_gain: 1.0,
        viscous_friction,
        static_friction: 0.061,
        voltage_limit: 5.0,
        proportional: 20e3 * squared_arm / torque_constant,
        derivative: (250.0 * squared_arm - viscous_friction) / torque_constant,
    }
}

fn foam() -> Foam {
    Foam {
        stiffness: 24.25e3,
        ..FOAM_1
    }
}

fn impact(manipulator_speed: f64) -> DriveImpact {
    DriveImpact {
        closing_speed: 1.25,
        manipulator_speed,
        duration: 0.06,
        step: 1e-4,
    }
}

fn run(drive: DirectDrive, manipulator_speed: f64) -> DriveRun {
    simulate_direct_drive(
        &drive,
        &foam(),
        &HEAD_APPARATUS,
        &impact(manipulator_speed),
        &|| false,
    )
    .unwrap()
}

fn unlimited() -> DirectDrive {
    DirectDrive {
        voltage_limit: f64::INFINITY,
        ..nominal()
    }
}

#[test]
fn without_limit_the_joint_is_the_linear_manipulator() {
    let linear = nominal().linear();
    assert!((linear.mass - 9.6).abs() < 1e-12 && (linear.damping - 250.0).abs() < 1e-10);
    assert!((linear.stiffness - 20e3).abs() < 1e-8);
    // Dry friction is compensated while the joint moves as desired.
    let free = DirectDrive {
        static_friction: 0.0,
        ..unlimited()
    };
    for drive in [unlimited(), free] {
        let run = run(drive, 1.25);
        let last = [
            run.manipulator_position[600],
            run.manipulator_velocity[600],
            run.head_position[600] - foam().thickness,
            run.head_velocity[600],
        ];
        let expected = [
            0.064_148_060_444_069_1,
            1.345_018_422_810_622_8,
            0.058_218_591_148_986_36,
            0.867_762_393_947_603_6,
        ];
        for (found, expected) in last.iter().zip(expected) {
            assert!((found - expected).abs() < STEPS, "{found} {expected}");
        }
        assert!((run.peak_head_acceleration / 9.80665 - 6.567_85).abs() < 5e-6);
        assert!((run.peak_contact_force - 299.120_823).abs() < 5e-7 + 1e-4);
        assert!((run.max_compression - 0.011_975).abs() < 5e-7);
        assert_eq!((run.saturated_from, run.saturated_time), (None, 0.0));
    }
}

#[test]
fn the_linear_joint_would_ask_256_5_newtons() {
    let run = run(unlimited(), 1.25);
    let end = run.impact_duration;
    let near = run.time.iter().position(|time| *time >= end).unwrap();
    let share = (end - run.time[near - 1]) / 1e-4;
    let asked = |k: usize| {
        20e3 * (1.25 * run.time[k] - run.manipulator_position[k])
            + 250.0 * (1.25 - run.manipulator_velocity[k])
    };
    let asked = asked(near - 1) + share * (asked(near) - asked(near - 1));
    assert!((asked - 256.5).abs() < 0.05, "{asked} at {end}");
    let printed = DirectDrive {
        torque_constant: 0.2807,
        ..nominal()
    };
    assert!((5.0 * printed.force_per_volt() - 18.0).abs() < 0.05);
    assert!((5.0 * nominal().force_per_volt() - 17.4).abs() < 0.05);
}

#[test]
fn the_real_joint_saturates_and_hits_softer() {
    let (limited, linear) = (run(nominal(), 1.25), run(unlimited(), 1.25));
    let from = limited.saturated_from.unwrap();
    assert!(from > 0.0 && from < 0.01, "{from}");
    assert!(limited.command.iter().all(|command| command.abs() <= 5.0));
    assert!(
        limited
            .requested_command
            .iter()
            .any(|command| *command > 5.0)
    );
    assert!(limited.peak_head_acceleration < linear.peak_head_acceleration);
    assert!(limited.saturated_time > 0.02);
    // The share of the difference stays small: inertia does the work.
    assert!(limited.peak_head_acceleration > 0.9 * linear.peak_head_acceleration);
}

#[test]
fn momentum_accounts_for_every_force() {
    for speed in [1.25, 0.25, 0.0] {
        let drive = nominal();
        let fine = DriveImpact {
            step: 1e-6,
            ..impact(speed)
        };
        let run =
            simulate_direct_drive(&drive, &foam(), &HEAD_APPARATUS, &fine, &|| false).unwrap();
        let mut impulse = 0.0;
        for k in 1..run.time.len() {
            for k in [k - 1, k] {
                let moving = run.manipulator_velocity[k];
                let pull = drive.force_per_volt() * run.command[k]
                    - drive.viscous_friction / 0.078_f64.powi(2) * moving
                    - run.contact_force[k];
                // A joint at rest is held by whatever friction it takes.
                let dry = 0.061 / 0.078_f64;
                let friction = if moving == 0.0 {
                    pull.clamp(-dry, dry)
                } else {
                    dry * moving.signum()
                };
                impulse += 0.5e-6 * (pull - friction);
            }
        }
        let gained = 9.6 * (run.manipulator_velocity[run.time.len() - 1] - speed);
        // Trapezoid sums across the jumps of dry friction, 1 us wide.
        assert!(
            (impulse - gained).abs() < 1e-5,
            "{speed} {impulse} {gained}"
        );
    }
}

#[test]
fn events_leave_the_order_of_the_steps_as_it_is() {
    let at = |step: f64| {
        let impact = DriveImpact {
            step,
            ..impact(0.25)
        };
        let stiff = Foam {
            stiffness: 60.6e3,
            ..foam()
        };
        let run =
            simulate_direct_drive(&nominal(), &stiff, &HEAD_APPARATUS, &impact, &|| false).unwrap();
        let last = run.time.len() - 1;
        (run.manipulator_position[last], run.head_velocity[last])
    };
    let (coarse, fine) = (at(1e-3), at(1e-5));
    assert!((coarse.0 - fine.0).abs() < 1e-9, "{coarse:?} {fine:?}");
    assert!((coarse.1 - fine.1).abs() < 1e-7, "{coarse:?} {fine:?}");
}

#[test]
fn foam_never_pulls_and_lets_go() {
    let stiff = Foam {
        stiffness: 60.6e3,
        damping: 113.6,
        ..foam()
    };
    let run = simulate_direct_drive(
        &unlimited(),
        &stiff,
        &Head {
            mass: 4.4,
            damping: 46.0,
            stiffness: 3e3,
        },
        &impact(1.25),
        &|| false,
    )
    .unwrap();
    assert!(run.contact_force.iter().all(|force| *force >= 0.0));
    // Release time of the specification's case.
    let released = run
        .contact_force
        .iter()
        .position(|force| *force == 0.0)
        .unwrap();
    assert!((run.time[released] - 0.024_928).abs() <= 1e-4);
}

#[test]
fn a_resting_joint_sticks_until_it_is_pushed_hard_enough() {
    let weak = DirectDrive {
        proportional: 0.0,
        derivative: 0.0,
        static_friction: 1e3,
        ..nominal()
    };
    let run = run(weak, 0.0);
    assert!(
        run.manipulator_position
            .iter()
            .all(|position| *position == 0.0)
    );
}

#[test]
fn bad_joints_are_named() {
    for drive in [
        DirectDrive {
            inertia: 0.0,
            ..nominal()
        },
        DirectDrive {
            voltage_limit: 0.0,
            ..nominal()
        },
        DirectDrive {
            voltage_limit: f64::NAN,
            ..nominal()
        },
    ] {
        let refused =
            simulate_direct_drive(&drive, &foam(), &HEAD_APPARATUS, &impact(1.25), &|| false);
        assert!(refused.unwrap_err().to_string().starts_with("drive."));
    }
    let slow = DriveImpact {
        closing_speed: 0.0,
        ..impact(1.25)
    };
    assert!(simulate_direct_drive(&nominal(), &foam(), &HEAD_APPARATUS, &slow, &|| false).is_err());
}
