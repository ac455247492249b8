//! Extended random tree: paths are free, found and repeatable, and the robot can always stop.

#[allow(dead_code, reason = "only the scenes are needed")]
mod configurations;
#[allow(
    dead_code,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts are small, and not all draws are needed"
)]
mod draws;
mod planning;

use configurations::{crossing, obstacles};
use draws::Draws;
use planning::{BARN_RADIUS, barn, body, distance_to_leg, drive, scene, situation};
use proptest::prelude::*;
use vff_core::forces::geometry::Body;
use vff_core::lanes::Vec2;
use vff_core::obstacle::Shape;
use vff_core::planners::Planner;
use vff_core::planners::footprint::Footprint;
use vff_core::planners::outline::Outline;
use vff_core::planners::path::{PathStatus, length};
use vff_core::planners::tree::buckets::Buckets;
use vff_core::planners::tree::growth::{Growth, Tree};
use vff_core::planners::tree::{RapidlyExploringRandomTree, TreePlanner};
use vff_core::scenario::Rules;

/// In m: rounding of positions of up to some ten meters.
const ROUNDING: f64 = 1e-9;
/// Points drawn for one tree in a BARN world: an upper bound of its nodes.
const BARN_DRAWS: usize = 2_000;
/// The same between rows of discs, whose gaps leave 0.4 m to the robot's center.
const SLALOM_DRAWS: usize = 4_000;
const SPEED: f64 = 0.7;

fn disc(radius: f64, place: [f64; 2], velocity: [f64; 2]) -> Body {
    body(Shape::Disc { radius }, place, velocity)
}

fn planner(start: [f64; 2], goal: [f64; 2], seed: u64) -> TreePlanner {
    let scenario = scene(start, goal, 0.2, Vec::new()).measured(None, seed);
    TreePlanner::new(RapidlyExploringRandomTree::default(), &scenario).unwrap()
}

fn speed([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// The planner of a robot that starts before the rows of discs.
fn slalom_planner(waypoint_probability: f64, seed: u64) -> TreePlanner {
    let scenario = scene([6.0, 0.0], [0.0; 2], 0.2, Vec::new()).measured(None, seed);
    let parameters = RapidlyExploringRandomTree {
        draws: SLALOM_DRAWS,
        waypoint_probability,
        ..RapidlyExploringRandomTree::default()
    };
    TreePlanner::new(parameters, &scenario).unwrap()
}

/// Rows of discs with gaps, on the way from `[6, 0]` to the origin.
fn slalom() -> Vec<Body> {
    let row = |x: f64, gap: f64| {
        let places = (-7..=7).map(|n| f64::from(n) * 0.4);
        places
            .filter(move |y| (y - gap).abs() > 0.5)
            .map(move |y| disc(0.15, [x, y], [0.0; 2]))
    };
    row(1.5, 1.0)
        .chain(row(3.0, -1.0))
        .chain(row(4.5, 1.0))
        .collect()
}

#[test]
fn nearest_node_is_that_of_a_plain_search() {
    let mut draws = Draws::new(1);
    for round in 0..40 {
        let side = draws.between(0.01, 2.0);
        let mut buckets = Buckets::new([-3.0, -1.0], [2.0, 4.0], side);
        assert_eq!(buckets.nearest([0.0; 2]), None);
        for _ in 0..2 {
            buckets.clear();
            for count in 0..200 {
                // Some lie outside the box.
                let point = [draws.between(-5.0, 3.0), draws.between(-2.0, 6.0)];
                buckets.push(point);
                let place = [draws.between(-6.0, 5.0), draws.between(-4.0, 8.0)];
                let away = |[x, y]: [f64; 2]| {
                    let (dx, dy) = (x - place[0], y - place[1]);
                    dx * dx + dy * dy
                };
                let found = buckets.points()[buckets.nearest(place).unwrap()];
                let least = buckets
                    .points()
                    .iter()
                    .map(|p| away(*p))
                    .fold(f64::INFINITY, f64::min);
                assert_eq!(away(found), least, "round {round}, {count}");
            }
        }
    }
}

proptest! {
    #[test]
    fn distance_of_a_segment_is_the_least_of_its_points(
        place in (-1.0..1.0f64, -1.0..1.0f64), half in (0.1..1.0f64, 0.1..1.0f64), heading in 0.0..3.1f64,
        velocity in (-2.0..2.0f64, -2.0..2.0f64), kind in 0..3usize,
        ends in ((-2.0..2.0f64, -2.0..2.0f64), (-2.0..2.0f64, -2.0..2.0f64)),
    ) {
        let shape = if kind == 2 {
            let axis = [heading.cos(), heading.sin()];
            Shape::Rectangle { half_length: half.0, half_width: half.1, axis }
        } else {
            Shape::Disc { radius: half.0 }
        };
        let center = [place.0, place.1];
        let moving = body(shape, center, [velocity.0, velocity.1]);
        let time = if kind == 1 { 0.7 } else { 0.0 };
        let footprint = Footprint::of(&moving, [0.0; 2], 0.2, time).unwrap();
        let (from, to) = ([ends.0.0, ends.0.1], [ends.1.0, ends.1.1]);
        let at = |share: f64| [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
        let samples = (0..=2000u32).map(|n| f64::from(n) / 2000.0);
        let own = |point: [f64; 2]| match kind {
            0 => (point[0] - center[0]).hypot(point[1] - center[1]),
            1 => distance_to_leg(point, center, [center[0] + 0.7 * velocity.0, center[1] + 0.7 * velocity.1]),
            _ => {
                // The distance of the outline that other planners use.
                let outline = Outline::new(&moving, Vec2::zero(), 0.0, 0.0);
                let (nearest, inside) = outline.nearest(Vec2::splat(point));
                if inside { 0.0 } else { (nearest.x - point[0]).hypot(nearest.y - point[1]) }
            }
        };
        let least = samples.map(|share| own(at(share))).fold(f64::INFINITY, f64::min);
        let distance = footprint.core_distance_to_segment([from, to]);
        // Samples are at most 0.0015 m from the nearest point.
        prop_assert!(distance <= least + ROUNDING && distance >= least - 0.0015, "{distance} {least}");
        prop_assert!((footprint.core_distance(from) - own(from)).abs() < ROUNDING);
    }
}

#[test]
fn edges_and_paths_are_free_and_no_longer_than_a_step() {
    let bodies = slalom();
    let mut shortest = f64::INFINITY;
    for seed in 0..20 {
        let mut planner = slalom_planner(0.6, seed);
        let path = planner.whole_path(&situation(&bodies, [6.0, 0.0], [0.0; 2]));
        assert_eq!(planner.status(), PathStatus::Found, "seed {seed}");
        assert_eq!((path[0], *path.last().unwrap()), ([6.0, 0.0], [0.0; 2]));
        let clear = |from, to| {
            let gaps = bodies
                .iter()
                .map(|body| distance_to_leg(body.state.position, from, to));
            gaps.fold(f64::INFINITY, f64::min)
        };
        for leg in path.windows(2) {
            assert!(clear(leg[0], leg[1]) >= 0.15 + 0.25 - ROUNDING);
        }
        shortest = shortest.min(length(&path));
        let (nodes, parents) = (planner.tree().nodes(), planner.tree().parents());
        assert!(nodes.len() == parents.len() && nodes.len() <= SLALOM_DRAWS + 1);
        for (number, &parent) in parents.iter().enumerate().skip(1) {
            assert!(parent < number);
            let (from, to) = (nodes[parent], nodes[number]);
            assert!(length(&[from, to]) <= 0.2 + ROUNDING);
            assert!(clear(from, to) >= 0.15 + 0.25 - ROUNDING);
        }
    }
    // The straight way is 6 m; the gaps alternate by 2 m.
    assert!(shortest > 7.0 && shortest < 9.5, "{shortest}");
}

#[test]
fn barn_worlds_are_solved_within_the_draws() {
    let Some(worlds) = barn() else { return };
    let (mut found, mut all, mut nodes) = (0, 0, Vec::new());
    for world in worlds.iter().step_by(3) {
        let scenario = scene(world.start, world.goal, BARN_RADIUS, world.obstacles());
        let parameters = RapidlyExploringRandomTree {
            draws: BARN_DRAWS,
            margin: 0.0,
            ..RapidlyExploringRandomTree::default()
        };
        for seed in 0..2 {
            let scenario = scenario.clone().measured(None, seed);
            let mut planner = TreePlanner::new(parameters, &scenario).unwrap();
            let bodies = world.bodies();
            let path = planner.whole_path(&situation(&bodies, world.start, [0.0; 2]));
            all += 1;
            if planner.status() != PathStatus::Found {
                assert!(path.is_empty());
                continue;
            }
            found += 1;
            nodes.push(planner.tree().nodes().len());
            let clearance = world.least_distance(&path);
            let needed = BARN_RADIUS + world.radius - ROUNDING;
            assert!(clearance >= needed, "world {}: {clearance}", world.id);
        }
    }
    nodes.sort_unstable();
    println!(
        "{found} of {all} within {BARN_DRAWS} draws, {} nodes at the median",
        nodes[nodes.len() / 2]
    );
    assert!(100 * found >= 95 * all, "{found} of {all}");
}

#[test]
fn remembered_points_save_nodes() {
    let bodies = slalom();
    let spent = |waypoint_probability: f64| {
        let mut nodes = 0;
        for seed in 0..20 {
            let mut planner = slalom_planner(waypoint_probability, seed);
            for step in 0..4 {
                let place = [6.0 - 0.05 * f64::from(step), 0.0];
                planner.whole_path(&situation(&bodies, place, [0.0; 2]));
                nodes += planner.tree().nodes().len() * usize::from(step > 0);
            }
        }
        nodes
    };
    let (with, without) = (spent(0.6), spent(0.0));
    println!("{with} nodes with remembered points, {without} without");
    assert!(4 * with < 3 * without, "{with} {without}");
}

#[test]
fn published_obstacles_are_passed_without_contact() {
    for (number, longest) in [(1, 6.5), (2, 9.0), (3, 6.5), (4, 9.0)] {
        for seed in 0..5 {
            let scenario = crossing(obstacles(number), Rules::default()).measured(None, seed);
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

#[test]
fn seed_decides() {
    let bodies = slalom();
    let paths = |seed| {
        let mut planner = slalom_planner(0.6, seed);
        [6.0, 5.96].map(|x| planner.whole_path(&situation(&bodies, [x, 0.0], [0.0; 2])))
    };
    assert_eq!(paths(7), paths(7));
    assert_ne!(paths(7), paths(8));
}

#[test]
fn tree_without_luck_says_so() {
    let growth = Growth {
        low: [-1.0; 2],
        high: [5.0, 1.0],
        step: 0.2,
        goal_probability: 0.1,
        waypoint_probability: 0.0,
        draws: 3,
        waypoints: 10,
    };
    let wall = Footprint::swept_disc([2.0, -0.5], [2.0, 0.5], 0.3);
    let mut path = vec![[9.0; 2]];
    assert!(!Tree::new(growth, 0).grow([4.0, 0.0], &[wall], &mut path));
    assert!(path.is_empty());
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
        let velocities = |shift: [f64; 2]| {
            let moved = |place: [f64; 2]| [place[0] + shift[0], place[1] + shift[1]];
            let mut planner = planner(moved([4.0, 0.0]), moved([0.0; 2]), seed);
            [0.0, 0.0625, 0.125].map(|time| {
                let bodies: Vec<_> = places
                    .iter()
                    .map(|&(x, y, u, v)| disc(0.25, moved([x + u * time, y + v * time]), [u, v]))
                    .collect();
                let place = moved([robot.0 - time, robot.1]);
                planner.desired_velocity(&situation(&bodies, place, [-0.5, 0.0]))
            })
        };
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
            Shape::Rectangle { half_length: 0.5, half_width: 0.2, axis: [0.6, 0.8] }
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
