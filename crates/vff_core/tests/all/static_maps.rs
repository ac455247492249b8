//! Static maps: check values, an index that returns what a search over all returns, walls as
//! polygons and as cells, and what is refused.

use nalgebra::Vector2;
use proptest::prelude::*;
use vff_core::laws::field_d_star::{FieldDStar, FieldDStarPlanner};
use vff_core::laws::tree::{RapidlyExploringRandomTree, TreePlanner};
use vff_core::laws::{Scan, Situation, Stop};
use vff_core::robots::HolonomicRobot;
use vff_core::world::geometry::RobotState;
use vff_core::world::map::{Capsule, GridPlace, MapShapes, StaticMap};
use vff_core::world::scenario::{Rules, Scenario};
use vff_core::world::shape::PlacedShape;

type Point = Vector2<f64>;

/// The shapes of the check values.
fn shapes() -> StaticMap {
    let mut shapes = MapShapes::new();
    let corner = [[0.0, 0.0], [6.0, 0.0], [6.0, 4.0]];
    shapes.polyline(&corner, 0.0).unwrap();
    shapes.polyline(&[[1.0, 3.0], [3.0, 3.0]], 0.0).unwrap();
    let triangle = [[3.5, 1.0], [4.5, 1.0], [4.0, 2.0]];
    shapes.polygon(&triangle).unwrap();
    shapes.disc([1.5, 1.5], 0.3).unwrap();
    shapes.disc([5.0, 3.0], 0.2).unwrap();
    shapes.map()
}

#[test]
fn distance_boundary_points_and_range_are_the_check_values() {
    let map = shapes();
    let place = Point::new(3.315, 0.398);
    assert!((map.clearance(place) - 0.398).abs() < 1e-15);
    let mut points = Vec::new();
    map.boundary_points(place, 2.0, 1.0, &mut points);
    let expected = [[3.315, 0.0], [3.5, 1.0], [1.756_434, 1.344_303]];
    assert_eq!(points.len(), 3);
    for (point, expected) in points.iter().zip(expected) {
        assert!(
            (Point::from(*point) - Point::from(expected)).norm() < 1e-6,
            "{point:?}"
        );
    }
    map.boundary_points(place, 2.0, 0.5, &mut points);
    assert_eq!(points.len(), 2);
    assert_eq!(points, [[3.315, 0.0], [3.5, 1.0]]);
    let bearing = -0.758_425_f64;
    let range = map.ray(place, Point::new(bearing.cos(), bearing.sin()));
    assert!((range - 0.578_674).abs() < 5e-7, "{range}");
}

#[test]
fn distances_are_zero_inside_and_infinite_without_shapes() {
    let map = shapes();
    for inside in [[4.0, 1.5], [1.5, 1.5], [5.1, 3.0]] {
        assert_eq!(map.clearance(inside.into()), 0.0);
        assert_eq!(map.ray(inside.into(), Point::x()), 0.0);
        assert_eq!(
            map.segment_clearance(inside.into(), Point::new(2.0, 0.5)),
            0.0
        );
        assert_eq!(
            map.segment_clearance(Point::new(2.0, 0.5), inside.into()),
            0.0
        );
    }
    let nothing = MapShapes::new().map();
    assert_eq!(nothing.clearance(Point::zeros()), f64::INFINITY);
    assert_eq!(
        nothing.segment_clearance(Point::zeros(), Point::x()),
        f64::INFINITY
    );
    assert_eq!(nothing.ray(Point::zeros(), Point::x()), f64::INFINITY);
    assert_eq!(nothing.nearest(Point::zeros()), None);
    assert_eq!(nothing.bounds(), None);
}

/// The definition: boundary points of segments without an index.
fn boundary_points(capsules: &[Capsule], place: Point, reach: f64, kappa: f64) -> Vec<Point> {
    let mut planes: Vec<(Point, f64)> = Vec::new();
    let mut found = Vec::new();
    while found.len() < 8 {
        let visible = |capsule: &Capsule| {
            if capsule.radius > 0.0 {
                let axis = capsule.at(capsule.share_nearest(place, [0.0, 1.0]));
                let point = capsule.surface(axis, place);
                let hidden = planes
                    .iter()
                    .any(|(normal, offset)| normal.dot(&point) >= *offset);
                return (!hidden).then_some(point);
            }
            let (mut first, mut last) = (0.0_f64, 1.0_f64);
            for (normal, offset) in &planes {
                let (here, there) = (
                    normal.dot(&capsule.from) - offset,
                    normal.dot(&capsule.to) - offset,
                );
                match (here >= 0.0, there >= 0.0) {
                    (true, true) => return None,
                    (true, false) => first = first.max(here / (here - there)),
                    (false, true) => last = last.min(here / (here - there)),
                    (false, false) => {}
                }
            }
            (first <= last).then(|| capsule.at(capsule.share_nearest(place, [first, last])))
        };
        let nearest = capsules.iter().filter_map(visible).reduce(|best, point| {
            if (point - place).norm_squared() < (best - place).norm_squared() {
                point
            } else {
                best
            }
        });
        let Some(point) = nearest.filter(|point| (point - place).norm_squared() <= reach * reach)
        else {
            break;
        };
        // A boundary through the place itself is in no direction.
        if point == place {
            break;
        }
        let to = point - place;
        let normal = to / to.norm();
        planes.push((normal, normal.dot(&place) + kappa * to.norm() - 1e-9));
        found.push(point);
    }
    found
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        -5.0..5.0_f64,
        (-10..10_i32).prop_map(|halves| 0.5 * f64::from(halves))
    ]
}

fn point() -> impl Strategy<Value = [f64; 2]> {
    [coordinate(), coordinate()]
}

fn walls() -> impl Strategy<Value = StaticMap> {
    // More than are kept in mind from one boundary point to the next, too.
    let wall = || (point(), point(), prop_oneof![Just(0.0), 0.0..0.5_f64]);
    let disc = (point(), 0.01..0.8_f64);
    let all = (
        prop_oneof![
            prop::collection::vec(wall(), 0..40),
            prop::collection::vec(wall(), 280..400),
        ],
        prop::collection::vec(disc, 0..10),
    );
    all.prop_map(|(walls, discs)| {
        let mut shapes = MapShapes::new();
        for (from, to, radius) in walls {
            if from != to {
                shapes.polyline(&[from, to], radius).unwrap();
            }
        }
        for (center, radius) in discs {
            shapes.disc(center, radius).unwrap();
        }
        shapes.map()
    })
}

proptest! {
    #[test]
    fn the_index_returns_what_a_search_over_all_returns(
        map in walls(),
        from in point(),
        to in point(),
        bearing in -3.2..3.2_f64,
        reach in 0.1..6.0_f64,
        kappa in prop_oneof![Just(1.0), Just(0.5), 0.05..1.0_f64],
    ) {
        let (from, to) = (Point::from(from), Point::from(to));
        let capsules = map.capsules();
        let least = |distance: &dyn Fn(&Capsule) -> f64| {
            capsules.iter().map(distance).fold(f64::INFINITY, f64::min).max(0.0)
        };
        prop_assert_eq!(map.clearance(from), least(&|capsule| capsule.distance(from)));
        let segment = least(&|capsule| capsule.distance_of_segment(from, to));
        prop_assert_eq!(map.segment_clearance(from, to), segment);
        prop_assert!(map.segment_keeps(from, to, segment.min(1e9)));
        prop_assert!(!segment.is_finite() || !map.segment_keeps(from, to, segment + 1e-9));
        let direction = Point::new(bearing.cos(), bearing.sin());
        prop_assert_eq!(map.ray(from, direction), least(&|capsule| capsule.cast(from, direction)));
        let mut points = Vec::new();
        map.boundary_points(from, reach, kappa, &mut points);
        let expected = boundary_points(capsules, from, reach, kappa);
        prop_assert_eq!(points.len(), expected.len());
        for (point, expected) in points.iter().zip(expected) {
            prop_assert_eq!(Point::from(*point), expected);
        }
    }

    #[test]
    fn cutting_a_wall_into_pieces_changes_no_boundary_point(
        place in point(),
        cuts in prop::collection::vec(0.05..0.95_f64, 1..8),
        kappa in prop_oneof![Just(1.0), Just(0.5)],
    ) {
        let (from, to) = (Point::new(-3.0, 6.0), Point::new(7.0, -4.5));
        let mut shares = cuts.clone();
        shares.extend([0.0, 1.0]);
        shares.sort_by(f64::total_cmp);
        let corners: Vec<[f64; 2]> =
            shares.iter().map(|share| (from + (to - from) * *share).into()).collect();
        let map = |points: &[[f64; 2]]| {
            let mut shapes = MapShapes::new();
            shapes.polyline(points, 0.0).unwrap();
            shapes.polyline(&[[-4.0, -4.0], [4.0, -4.0]], 0.0).unwrap();
            shapes.map()
        };
        let (mut whole, mut cut) = (Vec::new(), Vec::new());
        map(&[from.into(), to.into()]).boundary_points(place.into(), 20.0, kappa, &mut whole);
        map(&corners).boundary_points(place.into(), 20.0, kappa, &mut cut);
        prop_assert_eq!(whole.len(), cut.len());
        for (one, two) in whole.iter().zip(&cut) {
            prop_assert!((Point::from(*one) - Point::from(*two)).norm() < 1e-9);
        }
    }

    #[test]
    fn a_wall_as_polygon_and_as_cells_has_the_same_distances(
        place in point(),
        bearing in -3.2..3.2_f64,
        yaw in prop_oneof![Just(0.0), -3.0..3.0_f64],
    ) {
        // Cells of 0.25 m: an L of 3 x 2 cells without its upper right ones.
        let occupied = [true, true, true, true, false, false];
        let place_of = GridPlace { resolution: 0.25, origin: [0.3, -0.4], yaw };
        let mut cells = MapShapes::new();
        cells.grid(&occupied, 3, place_of, &|| false).unwrap();
        let (sin, cos) = yaw.sin_cos();
        let corner = |x: f64, y: f64| [0.3 + cos * x - sin * y, -0.4 + sin * x + cos * y];
        let corners = [
            corner(0.0, 0.0), corner(0.75, 0.0), corner(0.75, 0.25),
            corner(0.25, 0.25), corner(0.25, 0.5), corner(0.0, 0.5),
        ];
        let mut polygon = MapShapes::new();
        polygon.polygon(&corners).unwrap();
        let (cells, polygon) = (cells.map(), polygon.map());
        prop_assert_eq!(cells.capsules().len(), 6);
        let place = Point::from(place);
        prop_assert!((cells.clearance(place) - polygon.clearance(place)).abs() < 1e-12);
        let direction = Point::new(bearing.cos(), bearing.sin());
        let (one, two) = (cells.ray(place, direction), polygon.ray(place, direction));
        prop_assert!(one == two || (one - two).abs() < 1e-9 * (1.0 + one));
    }
}

#[test]
fn what_is_no_wall_is_refused_with_its_rule() {
    let refused = |shape: &dyn Fn(&mut MapShapes) -> vff_core::error::Result<()>| {
        shape(&mut MapShapes::new()).unwrap_err().to_string()
    };
    let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert!(
        refused(&|map| map.polygon(&bow_tie))
            .contains("neither touches nor crosses itself, got (0.5, 0.5)")
    );
    let folded = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]];
    assert!(refused(&|map| map.polygon(&folded)).contains("neither touches nor crosses"));
    let pinched = [
        [0.0, 0.0],
        [1.0, 1.0],
        [2.0, 0.0],
        [2.0, 2.0],
        [1.0, 1.0],
        [0.0, 2.0],
    ];
    assert!(refused(&|map| map.polygon(&pinched)).contains("points 1 and 4 are the same"));
    let closed = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
    assert!(refused(&|map| map.polygon(&closed)).contains("not repeated at the end"));
    assert!(refused(&|map| map.polygon(&bow_tie[..2])).contains("three points"));
    assert!(refused(&|map| map.polygon(&[[0.0, f64::NAN]; 3])).contains("point 0 must be finite"));
    assert!(refused(&|map| map.polyline(&[[1.0, 2.0]; 5], 0.0)).contains("two different points"));
    assert!(refused(&|map| map.polyline(&bow_tie, -0.1)).contains("radius"));
    assert!(refused(&|map| map.disc([0.0; 2], 0.0)).contains("radius"));
    let grid = |resolution, yaw| GridPlace {
        resolution,
        origin: [0.0; 2],
        yaw,
    };
    assert!(
        refused(&|map| map.grid(&[true; 4], 2, grid(0.0, 0.0), &|| false)).contains("resolution")
    );
    assert!(
        refused(&|map| map.grid(&[true; 4], 2, grid(0.1, f64::NAN), &|| false)).contains("yaw")
    );
    assert!(
        refused(&|map| map.grid(&[true; 4], 3, grid(0.1, 0.0), &|| false)).contains("whole rows")
    );
    assert!(refused(&|map| map.grid(&[], 3, grid(0.1, 0.0), &|| false)).contains("whole rows"));
}

/// A robot at rest at a place, with nobody around.
fn alone(place: [f64; 2]) -> Situation<'static, f64> {
    Situation {
        time: 0.0,
        ages: &[],
        bodies: &[],
        robot: RobotState {
            position: place.into(),
            velocity: Point::zeros(),
        },
        heading: 0.0,
        interval: 0.06,
        scan: Scan::default(),
        stop: Stop::never(),
    }
}

#[test]
fn planners_of_whole_paths_keep_out_of_the_map() {
    let mut shapes = MapShapes::new();
    let trap = [[1.0, 1.5], [3.0, 1.5], [3.0, -1.5], [1.0, -1.5]];
    shapes.polyline(&trap, 0.0).unwrap();
    shapes
        .polygon(&[[3.5, 2.0], [4.5, 2.0], [4.0, 3.0]])
        .unwrap();
    let map = shapes.map();
    let (start, robot, rules) = ([2.0, 0.0], HolonomicRobot::default(), Rules::default());
    let scene = Scenario::new(robot, start, [5.0, 0.0], Vec::new(), rules).unwrap();
    let known = scene.clone().with_map(map.clone());
    let least = |path: &[[f64; 2]]| {
        let leg = |ends: &[[f64; 2]]| map.segment_clearance(ends[0].into(), ends[1].into());
        path.windows(2).map(leg).fold(f64::INFINITY, f64::min)
    };
    let tree =
        |scenario| TreePlanner::new(RapidlyExploringRandomTree::default(), scenario).unwrap();
    let grid = |scenario| FieldDStarPlanner::new(FieldDStar::default(), scenario).unwrap();
    for path in [
        tree(&known).whole_path(&alone(start)),
        grid(&known).whole_path(&alone(start)),
    ] {
        assert_eq!(path.first(), Some(&start));
        assert_eq!(path.last(), Some(&[5.0, 0.0]));
        assert!(least(&path) >= 0.25 - 1e-9, "{}", least(&path));
    }
    // Without the map the straight way leads through a wall.
    assert_eq!(least(&tree(&scene).whole_path(&alone(start))), 0.0);
    assert_eq!(least(&grid(&scene).whole_path(&alone(start))), 0.0);
}

#[test]
fn a_shape_lies_in_the_map_only_as_a_whole() {
    let mut shapes = MapShapes::new();
    shapes
        .polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]])
        .unwrap();
    shapes.polyline(&[[6.0, -1.0], [6.0, 1.0]], 0.0).unwrap();
    shapes.disc([9.0, 0.0], 0.5).unwrap();
    let place = GridPlace {
        resolution: 0.5,
        origin: [12.0, 0.0],
        yaw: 0.0,
    };
    shapes.grid(&[true; 16], 4, place, &|| false).unwrap();
    let map = shapes.map();
    let disc = PlacedShape::disc;
    for (shape, held) in [
        (disc([2.0, 1.0], 1.0), true),
        (disc([2.0, 1.0], 1.01), false),
        // Its center lies on a wall that is much smaller than it.
        (disc([6.0, 0.0], 1.0), false),
        (disc([6.0, 0.0], 0.1), false),
        (disc([9.0, 0.0], 0.5), true),
        (disc([9.1, 0.0], 0.5), false),
        (disc([9.1, 0.0], 0.4), true),
        (disc([13.0, 1.0], 1.0), true),
        (disc([13.0, 1.0], 1.1), false),
        (disc([20.0, 0.0], 0.1), false),
        (PlacedShape::upright([2.0, 1.0], [4.0, 2.0]), true),
        (PlacedShape::upright([2.0, 1.0], [4.0, 2.1]), false),
        (PlacedShape::turned([2.0, 1.0], [3.0, 1.9], 0.6), false),
        (PlacedShape::turned([9.0, 0.0], [0.6, 0.6], 0.6), true),
        (PlacedShape::turned([9.0, 0.0], [0.8, 0.8], 0.6), false),
    ] {
        assert_eq!(map.holds(&shape), held, "{shape:?}");
    }
}
