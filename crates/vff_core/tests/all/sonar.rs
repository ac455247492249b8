//! Rays and beams against geometry worked out another way.

use nalgebra::Vector2;
use numeric::random::Stream;
use proptest::prelude::*;
use vff_core::run::follower::Sensors;
use vff_core::sensing::sonar::ranging::Normals;
use vff_core::sensing::sonar::{Beam, Firing, Ranging, SonarArray, speed_of_sound};
use vff_core::world::frame::Frame;
use vff_core::world::shape::{PlacedShape, Shape};

/// Rounding of distances of a few meters.
const EXACT: f64 = 1e-9;
/// Step of the march along a ray, in m.
const MARCH: f64 = 1e-3;

/// Whether a point is in a shape, from its definition; walls have no inside.
fn inside(placed: &PlacedShape, point: Vector2<f64>) -> bool {
    let d = point - placed.center;
    match placed.shape {
        Shape::Rectangle {
            half_length,
            half_width,
            axis,
        } => {
            let along = d.x * axis.x + d.y * axis.y;
            let across = d.y * axis.x - d.x * axis.y;
            half_width > 0.0 && along.abs() <= half_length && across.abs() <= half_width
        }
        Shape::Disc { radius } => d.x.hypot(d.y) <= radius,
    }
}

fn solid() -> impl Strategy<Value = PlacedShape> {
    let place = || (-3.0..3.0, -3.0..3.0);
    prop_oneof![
        (place(), (0.05..1.0, 0.05..1.0), 0.0..6.3)
            .prop_map(|((x, y), (w, h), angle)| PlacedShape::turned([x, y], [w, h], angle)),
        (place(), 0.05..1.0).prop_map(|((x, y), radius)| PlacedShape::disc([x, y], radius)),
    ]
}

fn any_shape() -> impl Strategy<Value = PlacedShape> {
    let wall = (-3.0..3.0, -3.0..3.0, -3.0..3.0, -3.0..3.0)
        .prop_map(|(a, b, c, d)| PlacedShape::wall([a, b], [c, d]));
    prop_oneof![2 => solid(), 1 => wall]
}

proptest! {
    /// Small steps along the ray enter the shape where the ray says, and nowhere before.
    #[test]
    fn ray_meets_a_solid_where_a_march_enters_it(shape in solid(), angle in 0.0..6.3) {
        let pose = Frame::at([0.1, -0.2], angle);
        let distance = shape.cast(pose.position, pose.direction);
        let mut entered = f64::INFINITY;
        for step in 0..6000 {
            let way = MARCH * f64::from(step);
            if inside(&shape, pose.position + pose.direction * way) {
                entered = way;
                break;
            }
        }
        if entered.is_finite() {
            prop_assert!((entered - distance) >= -EXACT && entered - distance <= MARCH + EXACT);
        } else if distance.is_finite() {
            // Shorter than a step inside the shape: only grazed.
            let deep = pose.position + pose.direction * (distance + 2.0 * MARCH);
            prop_assert!(distance > 5.9 || !inside(&shape, deep));
        }
    }

    /// The point at which a ray meets a wall lies on both.
    #[test]
    fn ray_meets_a_wall_on_the_wall(
        start in prop::array::uniform2(-3.0_f64..3.0),
        end in prop::array::uniform2(-3.0_f64..3.0),
        share in 0.01_f64..0.99,
    ) {
        let shape = PlacedShape::wall(start, end);
        let point = [start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])];
        let pose = Frame::at([0.0, 0.0], point[1].atan2(point[0]));
        let across = start[0] * end[1] - start[1] * end[0];
        prop_assume!(across.abs() > 1e-3);
        let distance = shape.cast(pose.position, pose.direction);
        prop_assert!((distance - point[0].hypot(point[1])).abs() < 1e-6);
        prop_assert!(shape.cast(pose.position, -pose.direction) == f64::INFINITY);
    }

    /// The two rays that are cast see what all rays see, bit for bit.
    #[test]
    fn beam_sees_what_all_its_rays_see(
        shapes in prop::collection::vec(any_shape(), 1..4),
        angle in 0.0..6.3,
        width in 0.0..3.1,
        rays in 1_usize..40,
        reach in 0.5..6.0,
    ) {
        let pose = Frame::at([0.0, 0.0], angle);
        let beam = Beam::new(width, rays).unwrap();
        let all = beam.every_ray(&pose, &shapes).into_iter().fold(f64::INFINITY, f64::min);
        let expected = if all <= reach { all } else { f64::INFINITY };
        prop_assert_eq!(beam.nearest(&pose, &shapes, reach), expected);
    }

    /// Nothing of a shape is nearer than its nearest point, and that point is on it.
    #[test]
    fn nearest_point_is_nearest(shape in any_shape(), angle in 0.0..6.3) {
        let pose = Frame::at([0.0, 0.0], angle);
        let to = shape.nearest(pose.position);
        let distance = to.x.hypot(to.y);
        prop_assert!(shape.cast(pose.position, pose.direction) >= distance - EXACT);
        prop_assert!(shape.distance(to) < EXACT);
    }

    /// A shape beyond a line has its nearest points of the other side on the line's far side.
    #[test]
    fn shape_beyond_a_line_is_not_cut_by_it(shape in any_shape(), angle in 0.0..6.3) {
        let pose = Frame::at([0.0, 0.0], angle);
        let normal = pose.outward(Vector2::y());
        if shape.beyond(pose.position, normal) {
            prop_assert!(shape.nearest(pose.position).dot(&normal) > -EXACT);
            prop_assert!(shape.cast(pose.position, pose.direction) == f64::INFINITY);
        }
    }
}

#[test]
fn rays_of_a_beam_are_mirrored_and_hold_the_axis() {
    let beam = Beam::new(30.0_f64.to_radians(), 13).unwrap();
    let rays = beam.rays();
    assert_eq!(rays[6], Vector2::x());
    for (right, left) in rays.iter().zip(rays.iter().rev()) {
        assert_eq!(Vector2::new(right.x, -right.y), *left);
    }
    let outer = rays[0][1].atan2(rays[0][0]).to_degrees();
    assert!((outer + 15.0).abs() < EXACT);
    assert!(Beam::new(4.0, 13).is_err() && Beam::new(0.5, 0).is_err());
}

fn array(firing: Firing, noise: f64) -> SonarArray {
    let mounts = [-1.0, 0.0, 1.0].map(|side| Frame::at([0.2, 0.15 * side], 0.5 * side));
    let ranging = Ranging {
        noise,
        ..Ranging::default()
    };
    let beam = Beam::new(30.0_f64.to_radians(), 13).unwrap();
    SonarArray::new(mounts.to_vec(), beam, ranging, firing).unwrap()
}

fn measured(array: &SonarArray, shapes: &[PlacedShape], steps: usize) -> Vec<Vec<f64>> {
    let mut normals = Normals::new(Stream::new(1, 0));
    let mut readings = vec![7.0; 3];
    let body = Frame::at([0.0, 0.0], 0.0);
    let mut rows = Vec::new();
    for step in 0..steps {
        array.measure(&body, shapes, step, &mut readings, &mut normals);
        rows.push(readings.clone());
    }
    rows
}

#[test]
fn one_sensor_a_step_in_turn() {
    let wall = [PlacedShape::wall([1.2, -9.0], [1.2, 9.0])];
    let rows = measured(&array(Firing::InTurn, 0.0), &wall, 3);
    assert!(rows[0][0] < 2.0 && rows[0][1] == 7.0 && rows[0][2] == 7.0);
    assert!(rows[1][1] == 1.0 && rows[1][2] == 7.0);
    assert!((rows[2][0] - rows[2][2]).abs() < EXACT);
}

#[test]
fn noise_has_its_standard_deviation() {
    let wall = [PlacedShape::wall([1.2, -9.0], [1.2, 9.0])];
    let rows = measured(&array(Firing::Together, 0.005), &wall, 4000);
    let deviations: Vec<f64> = rows.iter().map(|row| row[1] - 1.0).collect();
    let mean = deviations.iter().sum::<f64>() / 4000.0;
    let variance = deviations.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 4000.0;
    // Five standard errors of each.
    assert!(mean.abs() < 4e-4 && (variance.sqrt() - 0.005).abs() < 2.8e-4);
}

#[test]
fn range_limits_and_temperature() {
    let ranging = Ranging::default();
    assert!((speed_of_sound(ranging.assumed_temperature) - 340.0).abs() < EXACT);
    assert_eq!(ranging.reading(0.029), f64::INFINITY);
    assert_eq!(ranging.reading(3.01), f64::INFINITY);
    assert_eq!(ranging.reading(1.5), 1.5);
    let warm = Ranging {
        temperature: 25.0,
        ..ranging
    };
    // Ranges at 25 degrees are 1.9 % longer than a sensor that takes 340 m/s for granted reads.
    assert!((1.5 / warm.reading(1.5) - 346.5 / 340.0).abs() < EXACT);
    assert!((warm.reading(warm.reach()) - 3.0).abs() < EXACT);
    assert!(
        Ranging {
            least: 3.0,
            ..ranging
        }
        .checked()
        .is_err()
    );
}

#[test]
fn a_sensor_hears_its_neighbor_by_cross_talk_only() {
    let disc = [PlacedShape::disc([1.0, 0.0], 0.05)];
    let with = |firing| {
        let mounts = vec![Frame::at([0.0, 0.0], 0.0), Frame::at([0.0, 0.5], 0.0)];
        let beam = Beam::new(std::f64::consts::FRAC_PI_2, 9001).unwrap();
        SonarArray::new(mounts, beam, Ranging::default(), firing).unwrap()
    };
    let body = Frame::at([0.0, 0.0], 0.0);
    let quiet = with(Firing::Together);
    let crossed = with(Firing::TogetherWithCrossTalk);
    // The nearer sensor hears itself first, the other one the echo of the nearer one: half of the
    // shortest way out and back over a point of the disc.
    assert_eq!(crossed.echo(&body, 0, &disc), quiet.echo(&body, 0, &disc));
    let own = 1.25_f64.sqrt() - 0.05;
    assert!((quiet.echo(&body, 1, &disc) - own).abs() < 1e-6);
    let ways = (0..10_000).map(|index| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(index) / 1e4).sin_cos();
        let point = [1.0 + 0.05 * cos, 0.05 * sin];
        0.5 * (point[0].hypot(point[1]) + point[0].hypot(point[1] - 0.5))
    });
    let expected = ways.fold(f64::INFINITY, f64::min);
    let heard = crossed.echo(&body, 1, &disc);
    assert!(heard < own && (heard - expected).abs() < 1e-6, "{heard}");
    // The beams of the follower's sensors touch but do not overlap: nothing is overheard.
    let follower = Sensors::default();
    let [alone, together] = [Firing::Together, Firing::TogetherWithCrossTalk].map(|firing| {
        Sensors {
            firing,
            ..follower.clone()
        }
        .array()
        .unwrap()
    });
    for step in 0..200 {
        let x = 0.5 + 0.01 * f64::from(step);
        let body = Frame::at([0.0, 0.0], 0.02 * f64::from(step));
        let shape = [PlacedShape::upright([x, 0.3], [0.4, 0.4])];
        for sensor in 0..3 {
            let readings = [&alone, &together].map(|array| array.echo(&body, sensor, &shape));
            assert_eq!(readings[0], readings[1]);
        }
    }
}
