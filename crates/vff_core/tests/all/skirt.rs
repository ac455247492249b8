//! The avoidance test of the ultrasonic skirt: shares, determinism, symmetry.

use numeric::parallel::Work;
use numeric::random::Stream;
use vff_core::error::Failure;
use vff_core::run::skirt::{
    DiscScene, DiscSceneOptions, EscapeAction, Policy, Ring, Rule, Skirt, SkirtOptions,
    SkirtTravel, TestPlan, TestRow, robot, test_batch,
};
use vff_core::sensing::sonar::ring::PUBLISHED_WHEEL_GAP;
use vff_core::world::shape::PlacedShape;

const OPTIONS: SkirtOptions = SkirtOptions {
    safe_distance: 0.666,
    rule: Rule::Consistent,
    policy: Policy::Nearest,
    beam_width: 40.0 * std::f64::consts::PI / 180.0,
    rays: 13,
    least_range: 0.02,
    most_range: 3.0,
    range_noise: 0.005,
    firing_period: 0.02,
};

const MOTION: SkirtTravel = SkirtTravel {
    speed: 0.3,
    acceleration: 0.6,
    spin_rate: 0.5,
    duration: 12.0,
};

/// Shares may differ from those of another 4,000 tests by this many standard errors of both. The
/// binding is tested with 4,000 tests of every kind.
const STANDARD_ERRORS: f64 = 3.0;

fn skirt(options: SkirtOptions) -> Skirt {
    let bearings = Ring::beside_wheels(9, PUBLISHED_WHEEL_GAP).unwrap();
    Skirt::new(Ring::new(0.33, 0.0, bearings).unwrap(), options).unwrap()
}

fn plan(layouts: usize) -> TestPlan {
    TestPlan {
        layouts,
        repeats: 5,
        scene: DiscSceneOptions::default(),
        motion: MOTION,
        seed: 0,
    }
}

fn work(threads: Option<usize>) -> Work<'static> {
    Work {
        threads,
        interrupted: &|| false,
        progress: &|_| (),
    }
}

/// Completely avoids, collides.
fn shares(rows: &[TestRow], closely: f64) -> [f64; 2] {
    let share = |test: &dyn Fn(f64) -> bool| {
        let met = |row: &&TestRow| test(row.course.min_clearance);
        rows.iter().filter(met).count() as f64 / rows.len() as f64
    };
    [
        share(&|clearance| clearance >= closely),
        share(&|clearance| clearance <= 0.0),
    ]
}

fn agrees(options: SkirtOptions, plan: &TestPlan, closely: f64, expected: [f64; 2]) {
    let rows = test_batch(&skirt(options), plan, work(None)).unwrap();
    for (own, other) in shares(&rows, closely).into_iter().zip(expected) {
        let variance = own * (1.0 - own) / rows.len() as f64 + other * (1.0 - other) / 4000.0;
        let off = (own - other).abs() / variance.sqrt();
        assert!(off < STANDARD_ERRORS, "{own} for {other}: {off}");
    }
}

#[test]
fn shares_agree_with_another_implementation() {
    agrees(OPTIONS, &plan(100), 0.1, [0.966, 0.017]);
    let best = SkirtOptions {
        policy: Policy::BestDirection,
        ..OPTIONS
    };
    agrees(best, &plan(100), 0.1, [0.966, 0.017]);
}

#[test]
fn shares_with_low_obstacles_agree_with_another_implementation() {
    let mut low = plan(25);
    low.scene.unseen_share = 0.05;
    agrees(OPTIONS, &low, 0.2, [0.777, 0.076]);
}

#[test]
fn shares_of_narrow_beams_agree_with_another_implementation() {
    let narrow = SkirtOptions {
        beam_width: 0.5 * OPTIONS.beam_width,
        ..OPTIONS
    };
    agrees(narrow, &plan(25), 0.1, [0.849, 0.092]);
}

#[test]
fn shares_at_higher_speeds_agree_with_another_implementation() {
    for (speed, expected) in [(0.5, [0.284, 0.048]), (0.8, [0.001, 0.991])] {
        let mut fast = plan(25);
        fast.motion.speed = speed;
        agrees(OPTIONS, &fast, 0.1, expected);
    }
}

#[test]
fn shares_among_small_discs_agree_with_another_implementation() {
    let mut small = plan(25);
    small.scene.radius = [0.03, 0.15];
    agrees(OPTIONS, &small, 0.1, [0.879, 0.077]);
}

#[test]
fn the_state_table_alone_collides_in_nine_tests_of_ten() {
    let alone = SkirtOptions {
        policy: Policy::TableOnly,
        ..OPTIONS
    };
    agrees(alone, &plan(10), 0.1, [0.055, 0.90]);
}

#[test]
fn any_number_of_threads_gives_the_same_rows() {
    let skirt = skirt(OPTIONS);
    let one = test_batch(&skirt, &plan(3), work(Some(1))).unwrap();
    for threads in [None, Some(2), Some(5)] {
        assert_eq!(test_batch(&skirt, &plan(3), work(threads)).unwrap(), one);
    }
    let single = plan(3).run(&skirt, 77, &|| false).unwrap();
    assert_eq!(single, one[77]);
}

#[test]
fn a_batch_stops_when_asked() {
    let asked = Work {
        interrupted: &|| true,
        ..work(None)
    };
    let stopped = test_batch(&skirt(OPTIONS), &plan(3), asked);
    assert_eq!(stopped, Err(Failure::Interrupted));
}

fn alone(center: [f64; 2], seen: bool) -> DiscScene {
    DiscScene {
        discs: vec![PlacedShape::disc(center, 0.2)],
        seen: vec![seen],
    }
}

#[test]
fn a_disc_straight_ahead_is_escaped_the_way_the_robot_came() {
    let skirt = skirt(OPTIONS);
    let south = -std::f64::consts::FRAC_PI_2;
    let mut actions = Vec::new();
    let scene = alone([0.0, -1.5], true);
    let noise = Stream::new(0, 1);
    let watch = |now: &robot::Moment<'_>| actions.push(now.action);
    let start = (south, noise);
    let found = robot::run(&skirt, &MOTION, &scene, start, watch, &|| false).unwrap();
    let north = EscapeAction::Move(vff_core::run::skirt::Direction::North);
    assert!(actions.contains(&north));
    assert!(found.contact_time.is_none());
    // Triggered 0.336 m away; a scan takes 0.18 s; braking takes 0.3^2 / (2 0.6) = 0.075 m.
    assert!((0.2..0.336).contains(&found.min_clearance), "{found:?}");
}

#[test]
fn a_disc_below_the_sensors_is_hit() {
    let skirt = skirt(OPTIONS);
    let scene = alone([1.5, 0.0], false);
    let found = robot::run(
        &skirt,
        &MOTION,
        &scene,
        (0.0, Stream::new(0, 1)),
        |_| (),
        &|| false,
    )
    .unwrap();
    let time = found.contact_time.unwrap();
    // 0.97 m at 0.3 m/s, and 0.25 s lost in speeding up.
    assert!((time - (0.97 / 0.3 + 0.25)).abs() < 0.05, "{time}");
}

#[test]
fn a_robot_walled_in_spins_and_stands() {
    let around = |index: usize| {
        let angle = std::f64::consts::TAU * index as f64 / 9.0;
        PlacedShape::disc([0.8 * angle.cos(), 0.8 * angle.sin()], 0.27)
    };
    let scene = DiscScene {
        discs: (0..9).map(around).collect(),
        seen: vec![true; 9],
    };
    let skirt = skirt(OPTIONS);
    let mut last = None;
    let watch = |now: &robot::Moment<'_>| last = Some((now.action, now.yaw_rate));
    let start = (0.0, Stream::new(0, 1));
    robot::run(&skirt, &MOTION, &scene, start, watch, &|| false).unwrap();
    assert_eq!(last, Some((EscapeAction::Spin, 0.5)));
}
