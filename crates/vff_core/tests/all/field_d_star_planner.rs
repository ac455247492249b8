//! The planner around Field D*: its grid, its costs while the robot discovers the world, and the
//! paths that it drives.

use crate::configurations::{crossing, obstacles};
use crate::draws::Draws;
use crate::planning::{BARN_RADIUS, barn, body, drive, scene, shifted_velocities, situation};
use proptest::prelude::*;
use vff_core::laws::field_d_star::{FieldDStar, FieldDStarPlanner, IncrementalSearch};
use vff_core::laws::planning::Planner;
use vff_core::laws::planning::footprint::Footprint;
use vff_core::laws::planning::grid::{GridFrame, OccupancyGrid};
use vff_core::laws::planning::path::{PathStatus, length, point_ahead};
use vff_core::world::geometry::Body;
use vff_core::world::obstacle::Shape;
use vff_core::world::scenario::Rules;

/// Of a cost of up to a few hundred cells: far above rounding.
const EQUAL: f64 = 1e-9;
/// In m: rounding of positions of up to some ten meters.
const ROUNDING: f64 = 1e-9;

#[test]
fn cells_are_blocked_where_an_obstacle_reaches_in() {
    let mut draws = Draws::new(4);
    for _ in 0..20 {
        let frame = GridFrame::new([1.5, -0.7], 1.0, 0.13).unwrap();
        let shape = if draws.below(2) == 0 {
            Shape::Disc {
                radius: draws.between(0.05, 0.5),
            }
        } else {
            let heading = draws.between(0.0, 3.0);
            Shape::Rectangle {
                half_length: draws.between(0.1, 1.0),
                half_width: draws.between(0.1, 0.5),
                axis: [heading.cos(), heading.sin()].into(),
            }
        };
        let place = [draws.between(-1.0, 2.5), draws.between(-1.7, 1.0)];
        let velocity = [draws.between(-1.0, 1.0), draws.between(-1.0, 1.0)];
        let footprint = Footprint::of(&body(shape, place, velocity), [0.0; 2], 0.2, 0.8).unwrap();
        let mut grid = OccupancyGrid::new(frame);
        grid.update([Some(footprint)].into_iter());
        for row in 0..frame.rows {
            for column in 0..frame.columns {
                let low = [column, row].map(|v| v as f64);
                let at = |x: f64, y: f64| frame.in_meters([low[0] + x, low[1] + y]);
                let sample = |n: u32| f64::from(n) / 24.0;
                let nearest = (0..=24u32)
                    .flat_map(|x| (0..=24u32).map(move |y| (x, y)))
                    .map(|(x, y)| footprint.core_distance(at(sample(x), sample(y))))
                    .fold(f64::INFINITY, f64::min);
                // Samples are at most 0.004 m from the nearest point of the cell.
                if grid.is_blocked([column, row]) {
                    assert!(nearest < footprint.radius + 0.004);
                } else {
                    assert!(nearest >= footprint.radius - ROUNDING);
                }
            }
        }
        // Taking the obstacle away frees everything.
        grid.update([None].into_iter());
        assert!((0..frame.rows).all(|y| (0..frame.columns).all(|x| !grid.is_blocked([x, y]))));
    }
}

/// What a fresh search finds on the grid of a planner.
fn fresh_costs(planner: &FieldDStarPlanner, cell: [usize; 2]) -> [f64; 4] {
    let frame = *planner.grid().frame();
    let mut search = IncrementalSearch::new([frame.columns, frame.rows], frame.goal, cell).unwrap();
    for row in 0..frame.rows {
        for column in 0..frame.columns {
            if planner.grid().is_blocked([column, row]) {
                search.set_cost([column, row], f64::INFINITY).unwrap();
            }
        }
    }
    search.repair();
    search.start_costs()
}

/// Cells of 0.05 m and no margin: gaps between the cylinders are narrow.
fn narrow() -> FieldDStar {
    FieldDStar {
        resolution: 0.05,
        margin: 0.0,
        room: 2.6,
        ..FieldDStar::default()
    }
}

#[test]
fn costs_in_barn_worlds_are_those_of_a_fresh_search_while_the_robot_discovers_them() {
    let Some(worlds) = barn() else { return };
    let mut compared = 0;
    for world in worlds.iter().step_by(30) {
        let scenario = scene(world.start, world.goal, BARN_RADIUS, world.obstacles());
        let mut planner = FieldDStarPlanner::new(narrow(), &scenario).unwrap();
        let mut place = world.start;
        // Drives 0.4 m at a time and sees what is within 2.5 m.
        for _ in 0..12 {
            let seen =
                |center: &&[f64; 2]| (center[0] - place[0]).hypot(center[1] - place[1]) < 2.5;
            let bodies: Vec<_> = world
                .cylinders
                .iter()
                .map(|center| {
                    let mut body = body(world.shape(), *center, [0.0; 2]);
                    body.state.present = seen(&center);
                    body
                })
                .collect();
            let path = planner.whole_path(&situation(&bodies, place, [0.0; 2]));
            let frame = *planner.grid().frame();
            let cell = planner.search().start();
            for (repaired, fresh) in planner
                .search()
                .start_costs()
                .into_iter()
                .zip(fresh_costs(&planner, cell))
            {
                let equal = repaired == fresh || (repaired - fresh).abs() <= EQUAL;
                assert!(equal, "world {}: {repaired} is not {fresh}", world.id);
                compared += 1;
            }
            assert!(frame.columns > 50);
            let Some(next) = point_ahead(&path, 0.4) else {
                break;
            };
            place = next;
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn paths_through_barn_worlds_keep_the_clearance() {
    let Some(worlds) = barn() else { return };
    let (mut found, mut all) = (0, 0);
    for world in worlds.iter().step_by(5) {
        let scenario = scene(world.start, world.goal, BARN_RADIUS, world.obstacles());
        let mut planner = FieldDStarPlanner::new(narrow(), &scenario).unwrap();
        let bodies = world.bodies();
        let path = planner.whole_path(&situation(&bodies, world.start, [0.0; 2]));
        all += 1;
        if planner.status() != PathStatus::Found {
            assert!(path.is_empty());
            continue;
        }
        found += 1;
        assert_eq!((path[0], *path.last().unwrap()), (world.start, world.goal));
        let clearance = world.least_distance(&path);
        assert!(
            clearance >= BARN_RADIUS + world.radius - ROUNDING,
            "world {}: {clearance}",
            world.id
        );
        // Shorter than the reference, which runs along cells of 0.15 m, or around its own gap.
        assert!(
            length(&path) < 1.25 * world.path_length,
            "world {}",
            world.id
        );
    }
    println!("{found} of {all} worlds have a path for a robot of {BARN_RADIUS} m");
    assert!(10 * found >= 9 * all, "{found} of {all}");
}

fn disc(radius: f64, place: [f64; 2], velocity: [f64; 2]) -> Body {
    body(Shape::Disc { radius }, place, velocity)
}

fn planner(start: [f64; 2], goal: [f64; 2]) -> FieldDStarPlanner {
    let scenario = scene(start, goal, 0.2, Vec::new());
    FieldDStarPlanner::new(FieldDStar::default(), &scenario).unwrap()
}

#[test]
fn published_obstacles_are_passed_without_contact() {
    // 3.78 m at 0.7 m/s take 5.4 s; the person of configurations 2 and 4 walks towards the robot.
    for (number, longest) in [(1, 6.0), (2, 8.0), (3, 6.0), (4, 8.0)] {
        let scenario = crossing(obstacles(number), Rules::default());
        let mut planner = FieldDStarPlanner::new(FieldDStar::default(), &scenario).unwrap();
        let ride = drive(&scenario, [[3.9, 0.6], [0.0, 0.6]], &mut planner);
        println!("c{number}: {:?} s, {:.3?} m", ride.arrival, ride.distances);
        assert!(!ride.touched, "c{number}");
        assert!(ride.arrival.is_some_and(|time| time < longest), "c{number}");
    }
}

#[test]
fn blocked_goal_stops_the_robot_until_it_is_free() {
    let mut planner = planner([4.0, 0.0], [0.0, 0.0]);
    let there = [disc(0.3, [0.1, 0.0], [0.0; 2])];
    assert_eq!(
        planner.desired_velocity(&situation(&there, [4.0, 0.0], [0.0; 2])),
        [0.0; 2]
    );
    assert_eq!(planner.status(), PathStatus::GoalBlocked);
    assert!(
        planner
            .whole_path(&situation(&there, [4.0, 0.0], [0.0; 2]))
            .is_empty()
    );
    let away = [disc(0.3, [0.1, 2.0], [0.0; 2])];
    let velocity = planner.desired_velocity(&situation(&away, [4.0, 0.0], [0.0; 2]));
    assert_eq!(planner.status(), PathStatus::Found);
    assert!((velocity[0] + 0.7).abs() < 1e-12 && velocity[1].abs() < 1e-12);
}

#[test]
fn closed_ring_has_no_path() {
    let mut planner = planner([4.0, 0.0], [0.0, 0.0]);
    let ring: Vec<_> = (0..24)
        .map(|n| f64::from(n) * std::f64::consts::TAU / 24.0)
        .map(|angle| disc(0.2, [1.5 * angle.cos(), 1.5 * angle.sin()], [0.0; 2]))
        .collect();
    assert_eq!(
        planner.desired_velocity(&situation(&ring, [4.0, 0.0], [0.0; 2])),
        [0.0; 2]
    );
    assert_eq!(planner.status(), PathStatus::NoPath);
    // Opening it far from the robot makes a path again.
    let open: Vec<_> = ring
        .iter()
        .copied()
        .filter(|body| body.state.position[0] > -1.0)
        .collect();
    assert_ne!(
        planner.desired_velocity(&situation(&open, [4.0, 0.0], [0.0; 2])),
        [0.0; 2]
    );
}

#[test]
fn robot_within_the_clearance_leaves_by_the_shortest_way() {
    let mut planner = planner([4.0, 0.0], [0.0, 0.0]);
    let close = [disc(0.4, [2.0, 0.0], [0.0; 2])];
    let velocity = planner.desired_velocity(&situation(&close, [2.3, 0.3], [0.0; 2]));
    assert_eq!(planner.status(), PathStatus::Leaving);
    assert!(velocity[0] > 0.1 || velocity[1] > 0.1, "{velocity:?}");
    assert!((velocity[0].hypot(velocity[1]) - 0.7).abs() < 1e-12);
    // Also when the goal is blocked, and when the robot is beside the grid.
    let both = [close[0], disc(0.3, [0.0, 0.0], [0.0; 2])];
    assert_ne!(
        planner.desired_velocity(&situation(&both, [2.3, 0.3], [0.0; 2])),
        [0.0; 2]
    );
    assert_eq!(planner.status(), PathStatus::GoalBlocked);
    let back = planner.desired_velocity(&situation(&[], [9.0, 0.0], [0.0; 2]));
    assert_eq!(planner.status(), PathStatus::Leaving);
    assert!((back[0] + 0.7).abs() < 1e-12);
}

#[test]
fn extrapolated_way_is_blocked() {
    let across = [disc(0.4, [2.0, -1.2], [0.0, 1.0])];
    let still = [disc(0.4, [2.0, -1.2], [0.0, 0.0])];
    let mut planner = planner([4.0, 0.0], [0.0, 0.0]);
    let straight = length(&planner.whole_path(&situation(&still, [4.0, 0.0], [0.0; 2])));
    let around = length(&planner.whole_path(&situation(&across, [4.0, 0.0], [0.0; 2])));
    assert!(
        (straight - 4.0).abs() < 1e-9 && around > 4.1,
        "{straight} {around}"
    );
}

#[test]
fn parameters_out_of_range_are_refused() {
    let scenario = scene([4.0, 0.0], [0.0; 2], 0.2, Vec::new());
    let good = FieldDStar::default();
    for (name, bad) in [
        (
            "resolution",
            FieldDStar {
                resolution: 0.0,
                ..good
            },
        ),
        (
            "resolution",
            FieldDStar {
                resolution: 1e-3,
                ..good
            },
        ),
        (
            "resolution",
            FieldDStar {
                resolution: 1e-300,
                ..good
            },
        ),
        (
            "margin",
            FieldDStar {
                margin: -0.1,
                ..good
            },
        ),
        (
            "horizon",
            FieldDStar {
                horizon: f64::NAN,
                ..good
            },
        ),
        (
            "room",
            FieldDStar {
                room: f64::INFINITY,
                ..good
            },
        ),
        (
            "look_ahead",
            FieldDStar {
                look_ahead: 0.0,
                ..good
            },
        ),
    ] {
        let error = FieldDStarPlanner::new(bad, &scenario)
            .unwrap_err()
            .to_string();
        assert!(error.starts_with(name), "{error}");
    }
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
    ) {
        let velocities = |shift| shifted_velocities(planner, &places, robot, shift);
        let here = velocities([0.0; 2]);
        prop_assert_eq!(here, velocities([0.0; 2]));
        prop_assert_eq!(here, velocities([shift.0, shift.1]));
        for [x, y] in here {
            prop_assert!(x.hypot(y) < 1e-12 || (x.hypot(y) - 0.7).abs() < 1e-12);
        }
    }

    #[test]
    fn odd_input_does_no_harm(
        numbers in proptest::collection::vec(prop_oneof![
            Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e308), Just(-1e308), Just(0.0), -5.0..5.0f64
        ], 10),
        kind in 0..2usize,
    ) {
        let mut planner = planner([4.0, 0.0], [0.0, 0.0]);
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
            prop_assert!(velocity[0].hypot(velocity[1]) <= 0.7 + 1e-12);
        }
        let after = planner.desired_velocity(&situation(&[], [4.0, 0.0], [0.0; 2]));
        prop_assert!((after[0] + 0.7).abs() < 1e-12);
    }
}
