//! Tracking laws of the two-wheel robot: convergence, determinism, limits, virtual torque.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::draws::Draws;
use proptest::prelude::*;
use vff_core::error::Failure;
use vff_core::robots::DifferentialDriveRobot;
use vff_core::robots::differential::{
    DifferentialDrive, DifferentialLimits, ExponentialGoal, FullSpeed, Nonlinear, Pose, Reference,
    ReferencePath, TorqueSteering, TrackOptions, TrackRow, TrackStart, Tracker, Tracking, Twist,
    VirtualTorque, track, track_batch,
};
use vff_core::world::motion::Motion;

const STARTS: usize = 200;
const LEVELS: [f64; 2] = [0.1, 0.001];
/// Largest error of a converged run, in m: rounding ends near 1e-12.
const CONVERGED: f64 = 1e-6;

fn starts(seed: u64, reach: f64) -> Vec<TrackStart> {
    let mut draws = Draws::new(seed);
    (0..STARTS)
        .map(|_| TrackStart {
            pose: Pose {
                position: [draws.between(-reach, reach), draws.between(-reach, reach)],
                heading: draws.between(-PI, PI),
            },
            twist: Twist {
                speed: draws.between(-0.7, 0.7),
                turn_rate: draws.between(-5.0, 5.0),
            },
        })
        .collect()
}

fn lines(seed: u64, low: f64, high: f64) -> Vec<ReferencePath> {
    let mut draws = Draws::new(seed);
    (0..STARTS)
        .map(|_| {
            let (speed, angle) = (0.7 * draws.between(low, high), draws.between(-PI, PI));
            let velocity = [speed * angle.cos(), speed * angle.sin()];
            ReferencePath::Pieces(Motion::moving([0.0; 2], velocity, [0.0; 2], None).unwrap())
        })
        .collect()
}

fn options(period: f64, duration: f64) -> TrackOptions {
    TrackOptions {
        period,
        step: 0.01,
        duration,
        goal: Some([0.0; 2]),
    }
}

fn run(
    paths: &[ReferencePath],
    tracking: Tracking,
    starts: &[TrackStart],
    (options, threads): (&TrackOptions, Option<usize>),
) -> Vec<TrackRow> {
    let limits = DifferentialLimits::default();
    track_batch(
        paths,
        (&tracking, &limits),
        (starts, &LEVELS),
        (options, threads),
        &|| false,
        &|_| {},
    )
    .unwrap()
}

#[test]
fn random_starts_converge_below_nine_tenths_of_the_speed() {
    for (tracking, low, duration) in [
        (Tracking::default(), 0.0, 75.0),
        (Tracking::Nonlinear(Nonlinear::default()), 0.3, 75.0),
    ] {
        for period in [0.06, 0.01] {
            let paths = lines(1, low, 0.9);
            let rows = run(
                &paths,
                tracking,
                &starts(2, 2.0),
                (&options(period, duration), None),
            );
            for row in rows {
                assert!(row.final_error < CONVERGED);
                assert!(row.settling_time[0] < row.settling_time[1]);
            }
        }
    }
}

#[test]
fn goal_phase_arrives_with_its_heading() {
    let still = [ReferencePath::Pieces(Motion::at_rest([0.0; 2]))];
    let law = ExponentialGoal {
        goal_heading: Some(1.0),
        ..ExponentialGoal::default()
    };
    let tracking = Tracking::ExponentialGoal(law);
    for row in run(
        &still,
        tracking,
        &starts(3, 5.0),
        (&options(0.06, 30.0), None),
    ) {
        assert!(row.final_error <= law.rest_radius);
        let turns = (row.final_heading - 1.0) / (2.0 * PI);
        assert!((turns - turns.round()).abs() < 1e-6);
    }
}

#[test]
fn the_goal_phase_ends_where_it_is_not_permitted() {
    let tracking = Tracking::ExponentialGoal(ExponentialGoal::default());
    let mut tracker = Tracker::new(&tracking, &DifferentialLimits::default(), 0.06);
    let reference = Reference::at_rest([0.0, 1.0]);
    let pose = Pose {
        position: [0.3, 0.0],
        heading: PI,
    };
    let toward_goal = tracker.command(&pose, &reference, [0.0; 2]);
    assert!(tracker.in_goal_phase() && toward_goal.turn_rate == 0.0);
    tracker.permit_goal_phase(false);
    let toward_reference = tracker.command(&pose, &reference, [0.0; 2]);
    assert!(!tracker.in_goal_phase() && toward_reference.turn_rate < 0.0);
    // Beyond the radius of capture it begins only after it was left; it ends at twice the radius.
    tracker.permit_goal_phase(true);
    tracker.command(&pose, &reference, [0.0; 2]);
    let at = |x: f64| Pose {
        position: [x, 0.0],
        heading: PI,
    };
    tracker.command(&at(0.9), &reference, [0.0; 2]);
    assert!(tracker.in_goal_phase());
    tracker.command(&at(1.1), &reference, [0.0; 2]);
    assert!(!tracker.in_goal_phase());
    tracker.command(&at(0.9), &reference, [0.0; 2]);
    assert!(!tracker.in_goal_phase());
}

#[test]
fn threads_change_no_bit_and_every_run_is_counted() {
    let paths = lines(4, 0.0, 1.0);
    let starts = starts(5, 3.0);
    let options = options(0.06, 6.0);
    let one = run(&paths, Tracking::default(), &starts, (&options, Some(1)));
    let three = run(&paths, Tracking::default(), &starts, (&options, Some(3)));
    for (first, second) in one.iter().zip(&three) {
        assert_eq!(first.final_error.to_bits(), second.final_error.to_bits());
        assert_eq!(
            first.final_heading.to_bits(),
            second.final_heading.to_bits()
        );
    }
    let limits = DifferentialLimits::default();
    let law = (&Tracking::default(), &limits);
    let any = Draws::new(6).below(STARTS);
    let recorded = track(&paths[any], law, &starts[any], &options, &|| false).unwrap();
    assert_eq!(
        recorded.heading.last().unwrap().to_bits(),
        one[any].final_heading.to_bits()
    );
    let counted = AtomicUsize::new(0);
    track_batch(
        &paths,
        law,
        (&starts, &LEVELS),
        (&options, None),
        &|| false,
        &|runs| {
            counted.fetch_add(runs, Ordering::Relaxed);
        },
    )
    .unwrap();
    assert_eq!(counted.into_inner(), STARTS);
    let stopped = track(&paths[0], law, &starts[0], &options, &|| true);
    assert_eq!(stopped.unwrap_err(), Failure::Interrupted);
}

#[test]
fn arguments_out_of_range_are_named() {
    let limits = DifferentialLimits::default();
    let path = ReferencePath::circle([0.0; 2], 1.0, 0.5, 0.0).unwrap();
    let named = |tracking: Tracking, start: TrackStart, options: TrackOptions| {
        let error = track(&path, (&tracking, &limits), &start, &options, &|| false).unwrap_err();
        match error {
            Failure::InvalidParameter(invalid) => invalid.name,
            other => panic!("{other}"),
        }
    };
    let law = Tracking::default();
    let start = TrackStart::default();
    let good = options(0.06, 6.0);
    let change = |edit: fn(&mut TrackOptions)| {
        let mut changed = good.clone();
        edit(&mut changed);
        changed
    };
    assert_eq!(
        named(law, start, change(|o| o.period = 0.0)),
        "control_period"
    );
    assert_eq!(named(law, start, change(|o| o.step = 0.04)), "step");
    assert_eq!(named(law, start, change(|o| o.duration = 0.1)), "duration");
    assert_eq!(named(law, start, change(|o| o.duration = 6e8)), "duration");
    assert_eq!(
        named(law, start, change(|o| o.goal = Some([f64::NAN, 0.0]))),
        "goal"
    );
    let mut lost = start;
    lost.pose.heading = f64::INFINITY;
    assert_eq!(named(law, lost, good.clone()), "heading");
    let flat = Tracking::FullSpeed(FullSpeed {
        heading_gain: -1.0,
        ..FullSpeed::default()
    });
    assert_eq!(named(flat, start, good.clone()), "heading_gain");
    let free = Tracking::Nonlinear(Nonlinear {
        damping_ratio: 0.0,
        ..Nonlinear::default()
    });
    assert_eq!(named(free, start, good), "damping_ratio");
}

/// Headings of a robot that a constant force along x turns, from 1 rad, every 0.01 s.
fn turned_by_torque(damping_ratio: f64) -> Vec<f64> {
    let robot = DifferentialDriveRobot::default();
    let limits = DifferentialLimits {
        max_turn_rate: 100.0,
        ..DifferentialLimits::from(&robot)
    };
    let law = VirtualTorque {
        damping_ratio,
        ..VirtualTorque::default()
    };
    let steering = TorqueSteering::new(&law, &robot, &limits, 0.01);
    let pose = Pose {
        position: [0.0; 2],
        heading: 1.0,
    };
    let mut drive = DifferentialDrive::new(&limits, pose, Twist::default());
    (0..500)
        .map(|_| {
            let wish = steering.command(&drive.pose, drive.twist, [2.0, 0.0]);
            drive.step(wish, 0.01);
            drive.pose.heading
        })
        .collect()
}

#[test]
fn virtual_torque_oscillates_without_damping_and_creeps_with_it() {
    let free = turned_by_torque(0.0);
    let highest = free[300..].iter().copied().fold(0.0, f64::max);
    assert!(highest > 0.9);
    // 6 rad/s: about 4.8 periods in 5 s, so 9 or 10 sign changes.
    let crossings = free
        .windows(2)
        .filter(|pair| pair[0] * pair[1] < 0.0)
        .count();
    assert!((9..=10).contains(&crossings));
    let damped = turned_by_torque(1.0);
    // Critically damped: (1 + 6 t) exp(-6 t) rad, up to the period of 0.01 s.
    for (index, heading) in damped.iter().enumerate() {
        let time = (index + 1) as f64 * 0.01;
        assert!((heading - (1.0 + 6.0 * time) * (-6.0 * time).exp()).abs() < 0.03);
    }
}

#[test]
fn virtual_torque_drives_by_the_force_along_the_heading() {
    let robot = DifferentialDriveRobot::default();
    let limits = DifferentialLimits::from(&robot);
    let forward = VirtualTorque::default();
    let steering = TorqueSteering::new(&forward, &robot, &limits, 0.06);
    let pose = Pose::default();
    let across = steering.command(&pose, Twist::default(), [0.0, 3.7]);
    assert_eq!(across.speed, 0.0);
    assert!(across.turn_rate > 0.0);
    let ahead = steering.command(&pose, Twist::default(), [3.7, 0.0]);
    assert!((ahead.speed - 0.06).abs() < 1e-15 && ahead.turn_rate == 0.0);
    assert_eq!(
        steering.command(&pose, Twist::default(), [-3.7, 0.0]).speed,
        0.0
    );
    let both = VirtualTorque {
        backward: true,
        ..forward
    };
    let steering = TorqueSteering::new(&both, &robot, &limits, 0.06);
    let behind = steering.command(&pose, Twist::default(), [-3.7, 0.0]);
    assert!((behind.speed + 0.06).abs() < 1e-15);
    assert_eq!(forward.torque(0.3, [0.0, 0.0]), 0.0);
    assert!((forward.torque(0.3, [0.0, 1.0]) - 2.664 * (0.5 * PI - 0.3)).abs() < 1e-12);
}

proptest! {
    #[test]
    fn every_command_is_within_the_limits(
        place in prop::array::uniform2(-5.0..5.0f64),
        heading in -10.0..10.0f64,
        target in prop::array::uniform2(-5.0..5.0f64),
        velocity in prop::array::uniform2(-0.7..0.7f64),
        acceleration in prop::array::uniform2(-10.0..10.0f64),
        capture_radius in 0.1..20.0f64,
    ) {
        let limits = DifferentialLimits::default();
        let reference = Reference { position: target, velocity, acceleration };
        let pose = Pose { position: place, heading };
        let parking = ExponentialGoal { capture_radius, goal_heading: Some(0.5), ..ExponentialGoal::default() };
        for tracking in [
            Tracking::default(),
            Tracking::Nonlinear(Nonlinear::default()),
            Tracking::ExponentialGoal(parking),
        ] {
            let mut tracker = Tracker::new(&tracking, &limits, 0.06);
            let wish = tracker.command(&pose, &reference, [0.1, -0.2]);
            prop_assert!(wish.speed.abs() <= limits.max_speed);
            prop_assert!(wish.turn_rate.abs() <= limits.max_turn_rate * (1.0 + 1e-15));
            if !matches!(tracking, Tracking::Nonlinear(_)) {
                prop_assert!(wish.speed >= 0.0);
            }
        }
    }

    #[test]
    fn an_arc_is_the_sum_of_its_parts(
        speed in -1.0..1.0f64,
        turn_rate in -10.0..10.0f64,
        share in 0.0..1.0f64,
    ) {
        let twist = Twist { speed, turn_rate };
        let start = Pose { position: [0.3, -0.7], heading: 0.4 };
        let whole = start.after(twist, 0.5);
        let parts = start.after(twist, 0.5 * share).after(twist, 0.5 * (1.0 - share));
        for axis in 0..2 {
            prop_assert!((whole.position[axis] - parts.position[axis]).abs() < 1e-15);
        }
        prop_assert!((whole.heading - parts.heading).abs() < 1e-14);
    }
}
