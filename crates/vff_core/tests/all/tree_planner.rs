//! The planner around the extended random tree: the robot gets through, and can always stop.

use crate::configurations::{crossing, obstacles};
use crate::draws::Draws;
use crate::planning::{body, distance_to_leg, drive, scene, shifted_velocities, situation};
use crate::slalom::{ROUNDING, disc, slalom};
use proptest::prelude::*;
use vff_core::laws::planning::Planner;
use vff_core::laws::planning::path::{PathStatus, length};
use vff_core::laws::tree::{RapidlyExploringRandomTree, TreePlanner};
use vff_core::world::geometry::Body;
use vff_core::world::obstacle::Shape;
use vff_core::world::scenario::Rules;

/// Highest speed of the robot, in m/s.
const SPEED: f64 = 0.7;

fn planner(start: [f64; 2], goal: [f64; 2], seed: u64) -> TreePlanner {
    let scenario = scene(start, goal, 0.2, Vec::new())
        .measured(None, seed)
        .unwrap();
    TreePlanner::new(RapidlyExploringRandomTree::default(), &scenario).unwrap()
}

fn speed([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

#[test]
fn published_obstacles_are_passed_without_contact() {
    for (number, longest) in [(1, 6.5), (2, 9.0), (3, 6.5), (4, 9.0)] {
        for seed in 0..5 {
            let scenario = crossing(obstacles(number), Rules::default())
                .measured(None, seed)
                .unwrap();
            let parameters = RapidlyExploringRandomTree::default();
            let mut planner = TreePlanner::new(parameters, &scenario).unwrap();
            let ride = drive(&scenario, [[3.9, 0.6], [0.0, 0.6]], &mut planner);
            println!("c{number}: {:?} s, {:.3?} m", ride.arrival, ride.distances);
            assert!(!ride.touched, "c{number}, seed {seed}");
            let fast = ride.arrival.is_some_and(|time| time < longest);
            assert!(fast, "c{number}, seed {seed}");
        }
    }
}

#[test]
fn blocked_goal_and_closed_ring_stop_the_robot() {
    let mut planner = planner([4.0, 0.0], [0.0; 2], 0);
    let there = [disc(0.3, [0.1, 0.0], [0.0; 2])];
    let at_start = |bodies: &[Body], planner: &mut TreePlanner| {
        planner.desired_velocity(&situation(bodies, [4.0, 0.0], [0.0; 2]))
    };
    assert_eq!(at_start(&there, &mut planner), [0.0; 2]);
    assert_eq!(planner.status(), PathStatus::GoalBlocked);
    let ring: Vec<_> = (0..24)
        .map(|n| f64::from(n) * std::f64::consts::TAU / 24.0)
        .map(|angle| disc(0.2, [1.5 * angle.cos(), 1.5 * angle.sin()], [0.0; 2]))
        .collect();
    assert_eq!(at_start(&ring, &mut planner), [0.0; 2]);
    assert_eq!(planner.status(), PathStatus::NoPath);
    let free = at_start(&[], &mut planner);
    assert!((free[0] + SPEED).abs() < 1e-12 && free[1].abs() < 1e-12);
    assert_eq!(planner.status(), PathStatus::Found);
}

#[test]
fn robot_within_the_clearance_leaves_by_the_shortest_way() {
    for seed in 0..20 {
        let mut planner = planner([4.0, 0.0], [0.0; 2], seed);
        // 0.1 m within the clearance of 0.65 m.
        let close = [disc(0.4, [2.0, 0.0], [0.0; 2])];
        let place = [2.55, 0.0];
        let path = planner.whole_path(&situation(&close, place, [0.0; 2]));
        assert_eq!(planner.status(), PathStatus::Leaving);
        assert!(path.len() > 3 && path[0] == place);
        assert!(length(&path[..2]) < 0.1 + 0.05 + ROUNDING);
        for leg in path[1..].windows(2) {
            assert!(distance_to_leg([2.0, 0.0], leg[0], leg[1]) >= 0.65 - ROUNDING);
        }
        // One who comes along is let pass on the side that is nearer.
        let coming = [disc(0.4, [2.8, 0.1], [1.0, 0.0])];
        let velocity = planner.desired_velocity(&situation(&coming, [3.7, 0.0], [0.0; 2]));
        assert!(velocity[1] < -0.4, "{velocity:?}");
        // A blocked goal is no reason to stay.
        let both = [close[0], disc(0.3, [0.0; 2], [0.0; 2])];
        let velocity = planner.desired_velocity(&situation(&both, place, [0.0; 2]));
        assert_eq!(planner.status(), PathStatus::GoalBlocked);
        assert!(velocity[0] > 0.3, "{velocity:?}");
    }
}

#[test]
fn way_out_is_not_taken_for_a_path_to_the_goal() {
    let mut planner = planner([4.0, 0.0], [0.0; 2], 0);
    // Within the clearance of one disc while another one is on the goal; then both are gone.
    let both = [
        disc(0.4, [2.0, 0.0], [0.0; 2]),
        disc(0.3, [0.0; 2], [0.0; 2]),
    ];
    let away = planner.desired_velocity(&situation(&both, [2.55, 0.0], [0.0; 2]));
    assert!(away[0] > 0.3, "{away:?}");
    let back = planner.desired_velocity(&situation(&[], [2.55, 0.0], [0.0; 2]));
    assert_eq!(planner.status(), PathStatus::Found);
    assert!((back[0] + SPEED).abs() < 1e-12, "{back:?}");
}

#[test]
fn robot_can_always_stop() {
    let mut draws = Draws::new(5);
    let mut held = 0;
    for seed in 0..300 {
        let mut planner = planner([4.0, 0.0], [0.0; 2], seed);
        let velocity = [draws.between(-0.49, 0.49), draws.between(-0.49, 0.49)];
        let bodies: Vec<_> = (0..3)
            .map(|_| {
                let place = [draws.between(0.5, 3.5), draws.between(-1.0, 1.0)];
                disc(
                    0.3,
                    place,
                    [draws.between(-1.0, 1.0), draws.between(-1.0, 1.0)],
                )
            })
            .collect();
        let robot = [4.0 - draws.between(0.0, 2.0), draws.between(-0.5, 0.5)];
        let gap = |at: [f64; 2], time: f64| {
            let gaps = bodies.iter().map(|body| {
                let [x, y] = [0, 1].map(|i| body.state.position[i] + time * body.state.velocity[i]);
                (x - at[0]).hypot(y - at[1]) - 0.5
            });
            gaps.fold(f64::INFINITY, f64::min)
        };
        if gap(robot, 0.0) < 0.0 {
            continue;
        }
        let wanted = planner.desired_velocity(&situation(&bodies, robot, velocity));
        if wanted == [0.0; 2] {
            continue;
        }
        // 10 m/s^2 for 0.06 s reach any change below 0.6 m/s.
        let change = [wanted[0] - velocity[0], wanted[1] - velocity[1]];
        let share = (0.6 / speed(change)).min(1.0);
        let taken = [0, 1].map(|i| velocity[i] + share * change[i]);
        let stop = speed(taken) / 10.0;
        for n in 0..=200u32 {
            let time = (0.06 + stop) * f64::from(n) / 200.0;
            let braking = (time - 0.06).max(0.0);
            let way = time.min(0.06) + braking - 0.5 * braking * braking / stop.max(1e-12);
            let at = [0, 1].map(|i| robot[i] + way * taken[i]);
            assert!(
                gap(at, time) > -ROUNDING,
                "seed {seed}: {} at {time}",
                gap(at, time)
            );
        }
        held += 1;
    }
    assert!(held > 150, "{held}");
}

#[test]
fn parameters_out_of_range_are_refused() {
    let scenario = scene([4.0, 0.0], [0.0; 2], 0.2, Vec::new());
    let good = RapidlyExploringRandomTree::default();
    for (name, bad) in [
        ("step", RapidlyExploringRandomTree { step: 0.0, ..good }),
        (
            "goal_probability",
            RapidlyExploringRandomTree {
                goal_probability: 1.1,
                ..good
            },
        ),
        (
            "waypoint_probability",
            RapidlyExploringRandomTree {
                waypoint_probability: 0.95,
                ..good
            },
        ),
        (
            "waypoint_probability",
            RapidlyExploringRandomTree {
                waypoint_probability: f64::NAN,
                ..good
            },
        ),
        ("draws", RapidlyExploringRandomTree { draws: 0, ..good }),
        (
            "margin",
            RapidlyExploringRandomTree {
                margin: -0.1,
                ..good
            },
        ),
        (
            "horizon",
            RapidlyExploringRandomTree {
                horizon: f64::INFINITY,
                ..good
            },
        ),
        ("room", RapidlyExploringRandomTree { room: 0.0, ..good }),
        (
            "look_ahead",
            RapidlyExploringRandomTree {
                look_ahead: -1.0,
                ..good
            },
        ),
    ] {
        let error = TreePlanner::new(bad, &scenario).unwrap_err().to_string();
        assert!(error.starts_with(name), "{error}");
    }
    // Nothing remembered and no check of the stopping distance are choices, not errors.
    let plain = RapidlyExploringRandomTree {
        waypoints: 0,
        safety_draws: 0,
        keeps_path: false,
        ..good
    };
    let mut planner = TreePlanner::new(plain, &scenario).unwrap();
    let velocity = planner.desired_velocity(&situation(&slalom(), [4.0, 0.0], [0.0; 2]));
    assert!(speed(velocity) <= SPEED + 1e-12);
}

/// Multiples of 1/64 m, so that a translation rounds nothing.
fn exact(range: std::ops::Range<i32>) -> impl Strategy<Value = f64> {
    range.prop_map(|number| f64::from(number) / 64.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn translation_and_repetition_change_nothing(
        places in proptest::collection::vec((exact(0..256), exact(-100..100), exact(-64..64), exact(-64..64)), 0..5),
        robot in (exact(0..256), exact(-64..64)), shift in (exact(-6400..6400), exact(-6400..6400)),
        seed in any::<u64>(),
    ) {
        let velocities = |shift| shifted_velocities(|start, goal| planner(start, goal, seed), &places, robot, shift);
        let here = velocities([0.0; 2]);
        prop_assert_eq!(here, velocities([0.0; 2]));
        prop_assert_eq!(here, velocities([shift.0, shift.1]));
        for velocity in here {
            prop_assert!(speed(velocity) <= SPEED + 1e-12);
        }
    }

    #[test]
    fn odd_input_does_no_harm(
        numbers in proptest::collection::vec(prop_oneof![
            Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e308), Just(-1e308), Just(0.0), -5.0..5.0f64
        ], 10),
        kind in 0..2usize,
    ) {
        let mut planner = planner([4.0, 0.0], [0.0; 2], 0);
        let shape = if kind == 0 {
            Shape::Disc { radius: 0.3 }
        } else {
            Shape::Rectangle { half_length: 0.5, half_width: 0.2, axis: [0.6, 0.8].into() }
        };
        let n = &numbers;
        let odd = body(shape, [n[0], n[1]], [n[2], n[3]]);
        let calm = disc(0.2, [n[8].clamp(-3.0, 3.0), 0.5], [0.0; 2]);
        for bodies in [vec![odd], vec![calm, odd], vec![], vec![odd, calm, calm]] {
            let velocity = planner.desired_velocity(&situation(&bodies, [n[4], n[5]], [n[6], n[7]]));
            prop_assert!(speed(velocity) <= SPEED + 1e-12);
        }
        let after = planner.desired_velocity(&situation(&[], [4.0, 0.0], [0.0; 2]));
        prop_assert!((after[0] + SPEED).abs() < 1e-12);
    }
}
