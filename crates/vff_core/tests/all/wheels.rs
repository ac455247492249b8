//! Wheels: kinematics invert, friction is exact, controllers follow, the period that they need.

use crate::draws::Draws;
use proptest::prelude::*;
use vff_core::error::Failure;
use vff_core::robots::wheels::{
    DifferentialKinematics, Feedback, OmniKinematics, WheelDrive, WheelDynamics, WheelHistory,
    WheelState, WheelWish, differential_wheels, follow, holonomic_wheels,
};

/// Rounding of two maps, relative to the largest component.
const INVERSE: f64 = 1e-14;

fn all_wheels() -> Vec<WheelDrive> {
    let mut wheels = holonomic_wheels().to_vec();
    wheels.extend(differential_wheels());
    wheels
}

fn norm(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

fn apart(one: &[f64], other: &[f64]) -> f64 {
    let differences: Vec<f64> = one.iter().zip(other).map(|(a, b)| a - b).collect();
    norm(&differences)
}

proptest! {
    #[test]
    fn omni_kinematics_invert(
        forward in -2.0..2.0f64, left in -2.0..2.0f64, turn in -9.0..9.0f64,
        heading in -4.0..4.0f64, wheel_radius in 0.01..0.2f64, center_distance in 0.05..0.5f64,
    ) {
        let robot = OmniKinematics { wheel_radius, center_distance };
        // Turning is compared as the rim speed that it needs.
        let rim = |[x, y, turn]: [f64; 3]| [x, y, turn * center_distance];
        let velocity = [forward, left, turn];
        let back = robot.body_velocity(robot.wheel_speeds(velocity));
        prop_assert!(apart(&rim(back), &rim(velocity)) <= INVERSE * norm(&rim(velocity)));
        let speeds = robot.wheel_speeds_in_world(velocity, heading);
        let back = robot.world_velocity(speeds, heading);
        prop_assert!(apart(&rim(back), &rim(velocity)) <= INVERSE * norm(&rim(velocity)));
        let again = robot.wheel_speeds_in_world(back, heading);
        prop_assert!(apart(&again, &speeds) <= INVERSE * norm(&speeds));
    }

    #[test]
    fn differential_kinematics_invert(
        speed in -2.0..2.0f64, turn in -9.0..9.0f64, heading in -4.0..4.0f64,
        wheel_radius in 0.01..0.2f64, span in 0.05..1.0f64,
    ) {
        let robot = DifferentialKinematics { wheel_radius, span };
        let rim = |[speed, turn]: [f64; 2]| [speed, 0.5 * turn * span];
        let motion = [speed, turn];
        let speeds = robot.wheel_speeds(motion);
        let back = robot.body_velocity(speeds);
        prop_assert!(apart(&rim(back), &rim(motion)) <= INVERSE * norm(&rim(motion)));
        let world = robot.world_velocity(speeds, heading);
        let again = robot.wheel_speeds_in_world(world, heading);
        prop_assert!(apart(&again, &speeds) <= INVERSE * norm(&speeds));
        let sideways = DifferentialKinematics::sideways(world, heading);
        prop_assert!(sideways.abs() <= INVERSE * (speed.abs() + 1e-9));
    }

    #[test]
    fn a_held_step_is_the_sum_of_its_parts(
        speed in -30.0..30.0f64, current in -0.6..0.6f64, share in 0.0..1.0f64,
        decay in 0.0..2.0f64, friction in 0.0..60.0f64,
    ) {
        let wheel = WheelDynamics::from_accelerations(137.0, decay, friction);
        let start = WheelState { angle: 0.4, speed };
        let whole = wheel.advance(start, current, 2.0);
        let part = wheel.advance(start, current, 2.0 * share);
        let both = wheel.advance(part, current, 2.0 * (1.0 - share));
        let scale = 1.0 + whole.angle.abs() + whole.speed.abs();
        prop_assert!((whole.angle - both.angle).abs() < 1e-11 * scale);
        prop_assert!((whole.speed - both.speed).abs() < 1e-11 * scale);
    }

    #[test]
    fn friction_takes_energy(
        speed in -30.0..30.0f64, decay in 0.0..2.0f64, friction in 0.0..60.0f64,
        time in 0.0..3.0f64,
    ) {
        let wheel = WheelDynamics::from_accelerations(137.0, decay, friction);
        let end = wheel.advance(WheelState { angle: 0.0, speed }, 0.0, time);
        prop_assert!(end.speed * speed >= 0.0 && end.speed.abs() <= speed.abs());
        // What the friction takes is at least the dry friction over the way.
        let lost = 0.5 * (speed * speed - end.speed * end.speed);
        prop_assert!(lost >= friction * end.angle.abs() - 1e-9);
    }

    #[test]
    fn forward_and_backward_are_alike(speed in -30.0..30.0f64, current in -0.6..0.6f64) {
        let wheel = holonomic_wheels()[0].dynamics;
        let one = wheel.advance(WheelState { angle: 0.0, speed }, current, 0.3);
        let other = wheel.advance(WheelState { angle: 0.0, speed: -speed }, -current, 0.3);
        prop_assert!(one.angle == -other.angle && one.speed == -other.speed);
    }
}

/// Half a second in steps of a microsecond, with a friction that never reverses the speed.
fn small_steps(wheel: &WheelDynamics, state: WheelState, current: f64) -> WheelState {
    let (gain, decay) = (wheel.gain(), wheel.decay());
    let (friction, step) = (wheel.static_friction / wheel.inertia, 1e-6);
    let mut state = state;
    for _ in 0..500_000 {
        let pushed = state.speed + step * (gain * current - decay * state.speed);
        let before = state.speed;
        state.speed = if pushed.abs() <= step * friction {
            0.0
        } else {
            pushed - (step * friction).copysign(pushed)
        };
        state.angle += 0.5 * step * (before + state.speed);
    }
    state
}

#[test]
fn friction_agrees_with_small_steps() {
    let mut draws = Draws::new(11);
    for _ in 0..60 {
        let wheel = WheelDynamics::from_accelerations(137.0, 0.3, draws.between(5.0, 60.0));
        let start = WheelState {
            angle: 0.0,
            speed: draws.between(-12.0, 12.0),
        };
        let current = draws.between(-0.6, 0.6);
        let exact = wheel.advance(start, current, 0.5);
        let near = small_steps(&wheel, start, current);
        assert!(
            (exact.angle - near.angle).abs() < 2e-4,
            "{exact:?} {near:?}"
        );
        assert!(
            (exact.speed - near.speed).abs() < 2e-4,
            "{exact:?} {near:?}"
        );
    }
}

/// A sine of the speed of 1 rad/s and 0.5 Hz for 8 s.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most 8000 periods
fn sine(period: f64) -> impl ExactSizeIterator<Item = WheelWish> {
    let rate = std::f64::consts::PI;
    (0..(8.0 / period).round() as usize).map(move |index| {
        let (sin, cos) = (rate * period * index as f64).sin_cos();
        WheelWish {
            angle: (1.0 - cos) / rate,
            speed: sin,
            acceleration: rate * cos,
        }
    })
}

fn run(drive: &WheelDrive) -> WheelHistory {
    let start = WheelState::default();
    follow(drive, start, sine(drive.period), &|| false).unwrap()
}

fn rms(drive: &WheelDrive) -> f64 {
    let history = run(drive);
    let squares: f64 = sine(drive.period)
        .zip(&history.angle)
        .map(|(wish, angle)| (wish.angle - angle).powi(2))
        .sum();
    (squares / history.angle.len() as f64).sqrt()
}

const POLES: [f64; 2] = [-10.0, -10.0];
const FEEDBACKS: [Feedback; 3] = [
    Feedback::Observer { poles: POLES },
    Feedback::ObservedSpeed { poles: POLES },
    Feedback::Differences,
];

fn with(wheel: &WheelDrive, feedback: Feedback, period: f64) -> WheelDrive {
    let mut drive = *wheel;
    drive.controller.feedback = feedback;
    drive.period = period;
    drive
}

#[test]
fn wheels_follow_a_sine_as_well_as_their_feedback_allows() {
    // rms error of the angle in mrad, measured: observer, observed speed, differences.
    let measured = [
        [0.762, 0.292, 0.051],
        [1.802, 0.726, 0.059],
        [0.924, 0.369, 0.056],
        [1.884, 0.714, 0.059],
        [3.943, 1.452, 0.068],
    ];
    for (wheel, row) in all_wheels().iter().zip(measured) {
        for (feedback, expected) in FEEDBACKS.into_iter().zip(row) {
            let found = 1e3 * rms(&with(wheel, feedback, 1e-3));
            assert!(
                (found / expected - 1.0).abs() < 0.05,
                "{feedback:?} {found}"
            );
        }
    }
}

#[test]
fn quantisation_hides_behind_the_observer_and_shakes_the_current_without_it() {
    for wheel in all_wheels() {
        let shake = |drive: &WheelDrive| {
            let current = run(drive).current;
            current
                .windows(2)
                .map(|two| (two[1] - two[0]).abs())
                .sum::<f64>()
        };
        let loss = |feedback, encoder| {
            let mut drive = with(&wheel, feedback, 1e-3);
            drive.encoder = encoder;
            (run(&drive).energy, shake(&drive))
        };
        let [observer, _, differences] = FEEDBACKS;
        let (smooth, little) = loss(observer, wheel.encoder);
        let (exact, _) = loss(observer, None);
        assert!((smooth / exact - 1.0).abs() < 1e-3);
        let (rough, much) = loss(differences, wheel.encoder);
        let (exact, _) = loss(differences, None);
        assert!(
            rough > 1.2 * exact && much > 20.0 * little,
            "{rough} {exact} {much} {little}"
        );
    }
}

/// Whether a wheel without friction, encoder and limits is stable under its gains: Jury's criterion
/// for the map of one held period.
fn stable(wheel: &WheelDrive, period: f64) -> bool {
    let free = WheelDynamics {
        static_friction: 0.0,
        ..wheel.dynamics
    };
    let gains = wheel.controller;
    let column = |angle: f64, speed: f64| {
        let command = -gains.proportional * angle - gains.derivative * speed;
        free.advance(WheelState { angle, speed }, command, period)
    };
    let (first, second) = (column(1.0, 0.0), column(0.0, 1.0));
    let trace = first.angle + second.speed;
    let determinant = first.angle * second.speed - first.speed * second.angle;
    determinant.abs() < 1.0 && trace.abs() < 1.0 + determinant
}

#[test]
fn ten_milliseconds_are_short_enough_and_twenty_are_not() {
    for wheel in all_wheels() {
        for period in [1e-3, 2e-3, 5e-3, 1e-2] {
            assert!(stable(&wheel, period));
            for feedback in FEEDBACKS {
                let error = rms(&with(&wheel, feedback, period));
                assert!(error < 5e-3, "{period} {feedback:?} {error}");
            }
        }
        assert!(!stable(&wheel, 2e-2));
        for feedback in FEEDBACKS {
            let error = rms(&with(&wheel, feedback, 2e-2));
            assert!(error > 0.1, "{feedback:?} {error}");
        }
    }
}

#[test]
fn the_loss_is_close_to_the_ideal_one_when_the_wheel_follows() {
    for wheel in all_wheels() {
        let history = run(&wheel);
        assert!((history.energy / history.ideal_energy - 1.0).abs() < 0.015);
        let squares: f64 = history
            .current
            .iter()
            .map(|current| current * current)
            .sum();
        let loss = wheel.motor.resistance * squares * wheel.period;
        assert!((loss / history.energy - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_weak_supply_limits_the_speed() {
    let mut drive = holonomic_wheels()[0];
    drive.motor.supply_voltage = 6.0;
    let wishes = (0..4000).map(|index| WheelWish {
        angle: 28.0 * 1e-3 * f64::from(index),
        speed: 28.0,
        acceleration: 0.0,
    });
    let history = follow(&drive, WheelState::default(), wishes, &|| false).unwrap();
    let last = history.speed[3999];
    // Where the supply balances induced voltage and friction: 6 V = k_e w + R (B/K w + tau/K).
    let motion = drive.dynamics;
    let (ohm, induced) = (drive.motor.resistance, drive.motor.back_emf);
    let top = (6.0 - ohm * motion.static_friction) / (induced + ohm * motion.viscous_friction);
    assert!((last / top - 1.0).abs() < 1e-3, "{last} {top}");
    assert!(norm(&history.voltage) < 6.0 + 1e-9);
    let most = drive.motor.current_limit;
    assert!(history.current.iter().all(|current| current.abs() <= most));
}

#[test]
fn a_caller_can_stop_it_and_runs_repeat() {
    let drive = holonomic_wheels()[1];
    let stopped = follow(&drive, WheelState::default(), sine(1e-3), &|| true);
    assert_eq!(stopped, Err(Failure::Interrupted));
    assert_eq!(run(&drive), run(&drive));
    let beyond = WheelWish {
        angle: 1e308,
        speed: -1.75e308,
        acceleration: 0.0,
    };
    let start = WheelState::default();
    let lost = follow(&drive, start, vec![beyond; 3].into_iter(), &|| false);
    assert_eq!(lost, Err(Failure::non_finite(0, 0.0)));
}
