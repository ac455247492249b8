//! Extended random tree: nodes and paths are free, found and repeatable.

use crate::draws::Draws;
use crate::planning::{BARN_RADIUS, barn, body, distance_to_leg, scene, situation};
use crate::slalom::{ROUNDING, slalom};
use proptest::prelude::*;
use vff_core::lanes::{Planar, Vector2};
use vff_core::laws::Stop;
use vff_core::laws::planning::footprint::Footprint;
use vff_core::laws::planning::outline::Outline;
use vff_core::laws::planning::path::{PathStatus, length};
use vff_core::laws::tree::buckets::Buckets;
use vff_core::laws::tree::growth::{Growth, Tree};
use vff_core::laws::tree::{RapidlyExploringRandomTree, TreePlanner};
use vff_core::world::obstacle::Shape;

/// Points drawn for one tree in a BARN world: an upper bound of its nodes.
const BARN_DRAWS: usize = 2_000;
/// The same between rows of discs, whose gaps leave 0.4 m to the robot's center.
const SLALOM_DRAWS: usize = 4_000;

/// The planner of a robot that starts before the rows of discs.
fn slalom_planner(waypoint_probability: f64, seed: u64) -> TreePlanner {
    let scenario = scene([6.0, 0.0], [0.0; 2], 0.2, Vec::new())
        .measured(None, seed)
        .unwrap();
    let parameters = RapidlyExploringRandomTree {
        draws: SLALOM_DRAWS,
        waypoint_probability,
        ..RapidlyExploringRandomTree::default()
    };
    TreePlanner::new(parameters, &scenario).unwrap()
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
            let axis = [heading.cos(), heading.sin()].into();
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
                let outline = Outline::new(&moving, Vector2::zeros(), 0.0, 0.0);
                let (nearest, inside) = outline.nearest(Vector2::splat(point));
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
            let scenario = scenario.clone().measured(None, seed).unwrap();
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
    assert!(!Tree::new(growth, 0).grow([4.0, 0.0], &[wall], &mut path, Stop::never()));
    assert!(path.is_empty());
}
