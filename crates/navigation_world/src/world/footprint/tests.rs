use nalgebra::Vector2;
use proptest::prelude::*;

use super::{Arc, Footprint, Sweep};
use crate::world::frame::Frame;
use crate::world::map::{Capsule, MapShapes};
use crate::world::shape::PlacedShape;

fn rectangle() -> Footprint {
    let (a, b) = (0.254, 0.215);
    Footprint::polygon(&[[a, b], [-a, b], [-a, -b], [a, -b]]).unwrap()
}

/// Points that turn back on the arc, seen from the body.
fn seen_on_arc(point: Vector2<f64>, arc: Arc, share: f64) -> Vector2<f64> {
    let (distance, angle) = (share * arc.distance, share * arc.angle);
    let way = if arc.angle == 0.0 {
        Vector2::new(distance, 0.0)
    } else {
        let radius = arc.distance / arc.angle;
        Vector2::new(radius * angle.sin(), radius * (1.0 - angle.cos()))
    };
    let (sin, cos) = angle.sin_cos();
    let apart = point - way;
    Vector2::new(cos * apart.x + sin * apart.y, cos * apart.y - sin * apart.x)
}

fn sampled_point(outline: &Footprint, point: Vector2<f64>, arc: Arc) -> f64 {
    let distance = |place: u32| {
        let seen = seen_on_arc(point, arc, f64::from(place) / 4000.0);
        outline.signed_distance(seen).max(0.0)
    };
    (0..=4000).map(distance).fold(f64::INFINITY, f64::min)
}

#[test]
fn swept_distances_are_those_of_the_specification() {
    let outline = rectangle();
    for ([x, y, distance, angle], right) in [
        ([0.5, 0.4, 1.0, 0.0], 0.185),
        ([0.6, 0.6, 1.2, 1.6], 0.0),
        ([0.1, 0.35, 0.0, 1.0], 0.031_227_791),
        ([0.35, 0.1, 0.0, std::f64::consts::PI], 0.031_227_791),
        ([0.9, 0.8, 1.0, 2.0], 0.189_907_310),
        ([0.2, -0.4, 0.3, 2.5], 0.136_729_775),
    ] {
        let found = outline.swept_point(Vector2::new(x, y), Arc { distance, angle });
        assert!((found - right).abs() < 1e-8, "{found} {right}");
    }
    for ([x0, y0, x1, y1, distance, angle], right) in [
        ([0.7, -0.5, 0.7, 0.5, 0.3, 0.3], 0.098_287_481),
        ([1.2, 0.35, 0.1, 0.7, 0.8, 0.3], 0.023_365_074),
    ] {
        let segment = [Vector2::new(x0, y0), Vector2::new(x1, y1)];
        let found = outline.swept_segment(segment, Arc { distance, angle });
        assert!((found - right).abs() < 1e-8, "{found} {right}");
    }
}

#[test]
fn rooms_ahead_are_those_of_the_specification() {
    let outline = rectangle();
    for ([x, y], twist, right) in [
        ([0.1, 0.7], [1.0, 0.0], 0.240_709_368),
        ([0.1, 0.7], [1.0, 1.0], 0.185),
        ([-0.2, 0.7], [1.0, 1.0], 0.272_442_655),
        ([-0.3, -0.6], [0.5, 2.0], 0.087_738_314),
        ([0.6, 0.3], [0.0, 1.0], 0.159_799_088),
    ] {
        let found = outline.distance_from_room_ahead(Vector2::new(x, y), twist, 0.3);
        assert!((found - right).abs() < 1e-8, "{found} {right}");
    }
}

/// A convex polygon with the origin inside: corners on an ellipse, moved a little.
fn outlines() -> impl Strategy<Value = Footprint> {
    let directions = prop::collection::vec(0.05..1.0f64, 3..8);
    (
        directions,
        0.1..1.0f64,
        0.1..1.0f64,
        -0.5..0.5f64,
        -0.5..0.5f64,
    )
        .prop_filter_map("origin inside", |(gaps, width, height, x, y)| {
            let all: f64 = gaps.iter().sum();
            let mut direction = 0.0;
            let corners: Vec<[f64; 2]> = gaps
                .iter()
                .map(|gap| {
                    direction += gap / all * std::f64::consts::TAU;
                    [
                        width * (direction.cos() + x),
                        height * (direction.sin() + y),
                    ]
                })
                .collect();
            Footprint::polygon(&corners).ok()
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn swept_distances_of_points_are_least_along_the_arc(
        outline in outlines(), x in -2.0..2.0f64, y in -2.0..2.0f64, distance in -1.5..1.5f64,
        angle in prop_oneof![Just(0.0), -1e-9..1e-9f64, -1.6..1.6f64, -7.0..7.0f64]
    ) {
        let (point, arc) = (Vector2::new(x, y), Arc { distance, angle });
        let (found, sampled) = (outline.swept_point(point, arc), sampled_point(&outline, point, arc));
        let step = (distance.abs() + angle.abs() * point.norm().max(2.0)) / 4000.0;
        // A turn that counts as straight leaves out what the angle moves the point across.
        let straight = if angle.abs() <= 1e-9 { angle.abs() * (point.norm() + distance.abs()) } else { 0.0 };
        prop_assert!(found <= sampled + 1e-9 + straight && sampled <= found + step, "{} {}", found, sampled);
    }

    #[test]
    fn points_side_by_side_have_the_distances_of_each(
        outline in outlines(), points in prop::collection::vec(prop::array::uniform2(-2.0..2.0f64), 0..20),
        distance in -1.5..1.5f64, angle in prop_oneof![Just(0.0), -7.0..7.0f64]
    ) {
        let arc = Arc { distance, angle };
        let alone: Vec<f64> = points.iter().map(|point| outline.swept_point((*point).into(), arc)).collect();
        prop_assert_eq!(outline.swept_points(&points, arc), alone);
    }

    #[test]
    fn swept_distances_of_segments_are_least_among_their_points(
        outline in outlines(), ends in prop::array::uniform4(-2.0..2.0f64), distance in -1.5..1.5f64,
        angle in prop_oneof![Just(0.0), -3.0..3.0f64]
    ) {
        let arc = Arc { distance, angle };
        let [start, end] = [Vector2::new(ends[0], ends[1]), Vector2::new(ends[2], ends[3])];
        let found = outline.swept_segment([start, end], arc);
        let place = |index: u32| start + (end - start) * (f64::from(index) / 400.0);
        let least = (0..=400).map(|index| outline.swept_point(place(index), arc)).fold(f64::INFINITY, f64::min);
        let step = (end - start).norm() / 400.0;
        prop_assert!(found <= least + 1e-9 && least <= found + step, "{} {}", found, least);
    }

    #[test]
    fn whoever_is_near_a_part_that_moves_outward_is_in_the_room_ahead(
        outline in outlines(), ahead in -1.0..1.0f64, turn in -2.0..2.0f64, side in 0usize..8, share in 0.0..1.0f64,
        reach in 0.0..1.0f64
    ) {
        let count = outline.corners().len();
        let [from, to] = [outline.corners()[side % count], outline.corners()[(side + 1) % count]];
        let place = from + (to - from) * share;
        let along = (to - from).normalize();
        let normal = Vector2::new(along.y, -along.x);
        let moves = Vector2::new(ahead - turn * place.y, turn * place.x).dot(&normal);
        let point = place + normal * (reach * 0.4);
        if moves > 1e-9 {
            prop_assert!(outline.distance_from_room_ahead(point, [ahead, turn], 0.4) <= 1e-9);
        }
    }

    #[test]
    fn outlines_do_not_depend_on_the_order_of_corners(outline in outlines(), x in -2.0..2.0f64, y in -2.0..2.0f64) {
        let corners: Vec<[f64; 2]> = outline.corners().iter().rev().map(|corner| [corner.x, corner.y]).collect();
        let other = Footprint::polygon(&corners).unwrap();
        let point = Vector2::new(x, y);
        prop_assert!((outline.signed_distance(point) - other.signed_distance(point)).abs() < 1e-12);
    }
}

#[test]
fn outlines_that_are_none_are_refused() {
    let square = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    assert!(Footprint::polygon(&square).is_ok());
    for corners in [
        vec![[1.0, 1.0], [-1.0, 1.0]],
        vec![[1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0]],
        vec![
            [1.0, 1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
            [0.0, -1.0],
            [1.0, -1.0],
        ],
        vec![
            [1.0, 1.0],
            [1.0, 1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
            [1.0, -1.0],
        ],
        vec![[3.0, 1.0], [1.0, 1.0], [1.0, -1.0], [3.0, -1.0]],
        vec![[1.0, f64::NAN], [-1.0, 1.0], [-1.0, -1.0]],
        vec![
            [0.0, 1.0],
            [0.6, -0.8],
            [-0.95, 0.3],
            [0.95, 0.3],
            [-0.6, -0.8],
        ],
    ] {
        assert!(Footprint::polygon(&corners).is_err(), "{corners:?}");
    }
}

/// Points of the outline of a convex polygon, as many on each side.
fn contour(corners: &[Vector2<f64>], each: u32) -> Vec<Vector2<f64>> {
    let count = corners.len();
    (0..count)
        .flat_map(|index| {
            let [from, to] = [corners[index], corners[(index + 1) % count]];
            (0..each).map(move |part| from + (to - from) * (f64::from(part) / f64::from(each)))
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn distances_of_shapes_are_least_among_their_points(
        outline in outlines(), place in prop::array::uniform2(-1.5..1.5f64), angle in -4.0..4.0f64,
        center in prop::array::uniform2(-1.5..1.5f64), sides in prop::array::uniform2(0.0..0.8f64), turn in -4.0..4.0f64
    ) {
        let pose = Frame::at(place, angle);
        let disc = PlacedShape::disc(center, 0.5 * sides[0]);
        let found = outline.separation(&pose, &disc);
        let of_center = outline.signed_distance(pose.inward(disc.center - pose.position));
        prop_assert!((found.distance - (of_center - 0.5 * sides[0])).abs() < 1e-12);
        let rectangle = PlacedShape::turned(center, sides, turn);
        let found = outline.separation(&pose, &rectangle);
        let world = |own: &Vector2<f64>| pose.position + pose.outward(*own);
        let own: Vec<_> = outline.corners().iter().map(world).collect();
        let near = contour(&own, 200).iter().map(|point| rectangle.distance(*point)).fold(f64::INFINITY, f64::min);
        let inside = outline.signed_distance(pose.inward(rectangle.center - pose.position)) <= 0.0;
        let least = if inside { 0.0 } else { near };
        prop_assert!((found.distance.max(0.0) - least).abs() < 2e-2, "{} {}", found.distance, least);
        // Moved apart by what they overlap they touch.
        if found.distance < -1e-9 {
            let away = pose.outward(found.outward) * -found.distance;
            let apart = PlacedShape { center: rectangle.center + away, ..rectangle };
            prop_assert!(outline.separation(&pose, &apart).distance.abs() < 1e-9);
        } else {
            let touching = pose.position + pose.outward(found.place + found.outward * found.distance);
            prop_assert!(rectangle.distance(touching) < 1e-9);
        }
    }

    #[test]
    fn a_rectangle_is_as_far_from_the_room_ahead_as_the_nearest_of_its_points(
        outline in outlines(), ahead in -1.0..1.0f64, turn in -2.0..2.0f64, depth in 0.01..0.3f64,
        center in prop::array::uniform2(-1.5..1.5f64), sides in prop::array::uniform2(0.1..1.2f64), angle in -4.0..4.0f64
    ) {
        let rectangle = PlacedShape::turned(center, sides, angle);
        let found = outline.rectangle_from_room_ahead(&rectangle, [ahead, turn], depth);
        let [a, b, c, d] = rectangle.corners();
        let points = contour(&[a, b, d, c], 60);
        let nearest = |distance: &dyn Fn(Vector2<f64>) -> f64| points.iter().map(|point| distance(*point)).fold(f64::INFINITY, f64::min);
        let of_points = nearest(&|point| outline.distance_from_room_ahead(point, [ahead, turn], depth));
        prop_assert!(found <= of_points + 1e-9, "{found} {of_points}");
        // Corners that move outward are discs.
        let corners = outline.corners();
        let of_discs = nearest(&|point| {
            let apart = corners.iter().map(|corner| (point - corner).norm() - depth);
            apart.fold(f64::INFINITY, f64::min).max(0.0)
        });
        let covers = outline.sides.iter().any(|side| {
            let middle = side.normal * (0.5 * (side.offset + depth)) + side.along * (side.start.dot(&side.along) + 0.5 * side.length);
            rectangle.distance(middle) <= 0.05
        });
        prop_assert!(covers || found >= of_points.min(of_discs) - 0.02, "{found} {of_points} {of_discs}");
    }

    #[test]
    fn moved_outlines_stay_off_what_all_their_poses_stay_off(
        outline in outlines(), way in prop::array::uniform2(-0.8..0.8f64), angle in prop_oneof![Just(0.0), -2.0..2.0f64],
        ends in prop::array::uniform4(-2.0..2.0f64)
    ) {
        let sweep = Sweep { way: way.into(), angle };
        let start = Frame::at([0.3, -0.2], 0.7);
        let wall = Capsule::wall([ends[0], ends[1]].into(), [ends[2], ends[3]].into(), 0.05);
        let mut shapes = MapShapes::new();
        prop_assume!(shapes.polyline(&[[ends[0], ends[1]], [ends[2], ends[3]]], 0.05).is_ok());
        let map = shapes.map();
        let least = (0..=400).map(|part| {
            let share = f64::from(part) / 400.0;
            let turned = share * angle;
            let own = if angle == 0.0 {
                sweep.way * share
            } else {
                let center = Vector2::new(-sweep.way.y, sweep.way.x) / angle;
                let (sin, cos) = turned.sin_cos();
                center - Vector2::new(cos * center.x - sin * center.y, sin * center.x + cos * center.y)
            };
            let place = start.position + start.outward(own);
            outline.clearance(&Frame::at(place.into(), 0.7 + turned), &map, 9.0)
        }).fold(f64::INFINITY, f64::min);
        prop_assert!(!outline.keeps_off(&start, sweep, &map, least + 1e-9));
        prop_assert!(least < 1e-2 || outline.keeps_off(&start, sweep, &map, least - 1e-2));
        let at_start = outline.clearance(&start, &map, 9.0);
        let ends = [wall.from, wall.to].map(|end| start.inward(end - start.position));
        prop_assert!((at_start - (outline.distance_from_segment(ends) - 0.05).max(0.0)).abs() < 1e-12);
    }
}
