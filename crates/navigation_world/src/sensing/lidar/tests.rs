//! Ranges, boundary points, and what a scan makes of people.

use super::*;
use crate::robots::HolonomicRobot;
use crate::world::map::MapShapes;
use crate::world::scenario::Rules;

fn room() -> StaticMap {
    let mut shapes = MapShapes::new();
    let corners = [
        [-2.0, -1.0],
        [2.0, -1.0],
        [2.0, 1.0],
        [-2.0, 1.0],
        [-2.0, -1.0],
    ];
    shapes.polyline(&corners, 0.0).unwrap();
    shapes.map()
}

fn scan(lidar: &Lidar, pose: &Frame, shapes: &[PlacedShape]) -> Vec<f64> {
    let mut ranges = Vec::new();
    let mut noise = ScanNoise::new(1, 2);
    lidar.scan(pose, shapes, &mut noise, &mut ranges);
    ranges
}

#[test]
fn four_beams_of_a_turn_look_along_the_axes() {
    let lidar = Lidar {
        map: room(),
        beams: 4,
        range_max: 1.5,
        ..Lidar::default()
    };
    let ranges = scan(&lidar, &Frame::at([0.0, 0.0], 0.0), &[]);
    // Behind, right, ahead, left; the ends of the room are out of range.
    assert_eq!(ranges.len(), 4);
    for (range, expected) in ranges.iter().zip([1.5, 1.0, 1.5, 1.0]) {
        assert!((range - expected).abs() < 1e-12);
    }
    let turned = scan(
        &lidar,
        &Frame::at([0.0, 0.5], std::f64::consts::FRAC_PI_2),
        &[],
    );
    for (range, expected) in turned.iter().zip([1.5, 1.5, 0.5, 1.5]) {
        assert!((range - expected).abs() < 1e-12);
    }
}

#[test]
fn what_reads_zero_stays_in_the_direction_of_its_beam() {
    let lidar = Lidar {
        beams: 4,
        ..Lidar::default()
    };
    let (pose, mut points, mut seen) = (Frame::at([3.0, 4.0], 0.0), Vec::new(), Vec::new());
    lidar.points(&pose, &[10.0, 10.0, 0.0, 10.0], &mut points);
    boundary_points_of(&points, pose.position, 1.0, 0.5, &mut seen);
    assert_eq!(seen.len(), 1);
    assert!(seen[0][0] > 3.0 && seen[0][0] < 3.0 + 1e-6);
}

#[test]
fn people_hide_walls_and_the_inside_reads_zero() {
    let narrow = Lidar {
        map: room(),
        beams: 3,
        field_of_view: 1.0,
        range_min: 0.2,
        ..Lidar::default()
    };
    let person = [PlacedShape::disc([1.0, 0.0], 0.3)];
    let ranges = scan(&narrow, &Frame::at([0.0, 0.0], 0.0), &person);
    assert!((ranges[1] - 0.7).abs() < 1e-12);
    assert!((ranges[0] - 1.0 / 0.5_f64.sin()).abs() < 1e-12);
    assert_eq!(ranges[0], ranges[2]);
    let inside = scan(&narrow, &Frame::at([0.9, 0.0], 0.0), &person);
    assert_eq!(inside, [0.0; 3]);
    let near = scan(&narrow, &Frame::at([0.6, 0.0], 0.0), &person);
    assert_eq!(near[1], 0.0);
}

#[test]
fn points_of_a_dense_scan_are_boundary_points_of_the_map() {
    let lidar = Lidar {
        map: room(),
        beams: 3600,
        ..Lidar::default()
    };
    let pose = Frame::at([1.3, 0.4], 0.3);
    let ranges = scan(&lidar, &pose, &[]);
    let (mut points, mut seen, mut exact) = (Vec::new(), Vec::new(), Vec::new());
    lidar.points(&pose, &ranges, &mut points);
    boundary_points_of(&points, pose.position, 2.0, 0.5, &mut seen);
    lidar
        .map
        .boundary_points(pose.position, 2.0, 0.5, &mut exact);
    assert_eq!(seen.len(), exact.len());
    for (seen, exact) in seen.iter().zip(&exact) {
        assert!((Vector2::from(*seen) - Vector2::from(*exact)).norm() < 5e-3);
    }
}

#[test]
fn a_reading_of_zero_hides_no_other_point() {
    let place = Vector2::new(1.0, 0.0);
    let points = [place, Vector2::new(1.5, 0.0)];
    let mut seen = Vec::new();
    boundary_points_of(&points, place, 1.0, 0.5, &mut seen);
    assert_eq!(seen, [[1.5, 0.0]]);
    boundary_points_of(&points[..1], place, 1.0, 0.5, &mut seen);
    assert!(seen.is_empty());
}

#[test]
fn noise_has_its_deviation_and_other_beams_read_as_before() {
    let lidar = Lidar {
        map: room(),
        beams: 2000,
        range_max: 1.8,
        range_noise: 0.02,
        ..Lidar::default()
    };
    let exact = Lidar {
        range_noise: 0.0,
        ..lidar.clone()
    };
    let pose = Frame::at([0.0, 0.0], 0.0);
    let pairs = scan(&lidar, &pose, &[])
        .into_iter()
        .zip(scan(&exact, &pose, &[]));
    let (mut squares, mut hits) = (0.0, 0.0);
    for (noisy, exact) in pairs {
        if exact < 1.7 {
            squares += (noisy - exact).powi(2);
            hits += 1.0;
        } else if exact == 1.8 {
            assert_eq!(noisy, 1.8);
        }
    }
    let deviation = f64::sqrt(squares / hits);
    assert!(
        hits > 500.0 && (deviation - 0.02).abs() < 0.002,
        "{deviation}"
    );
}

#[test]
fn numbers_out_of_range_are_refused() {
    for (lidar, name) in [
        (
            Lidar {
                beams: 0,
                ..Lidar::default()
            },
            "beams",
        ),
        (
            Lidar {
                beams: MOST_BEAMS + 1,
                ..Lidar::default()
            },
            "beams",
        ),
        (
            Lidar {
                field_of_view: 7.0,
                ..Lidar::default()
            },
            "field_of_view",
        ),
        (
            Lidar {
                range_min: 20.0,
                ..Lidar::default()
            },
            "range_max",
        ),
        (
            Lidar {
                kappa: 0.0,
                ..Lidar::default()
            },
            "kappa",
        ),
        (
            Lidar {
                kappa: f64::NAN,
                ..Lidar::default()
            },
            "kappa",
        ),
        (
            Lidar {
                range_noise: -1.0,
                ..Lidar::default()
            },
            "range_noise",
        ),
    ] {
        let message = lidar.checked().unwrap_err().to_string();
        assert!(message.starts_with(name), "{message}");
    }
}

#[test]
fn a_rectangle_is_gone_only_where_beams_would_have_hit_it() {
    let options = Lidar {
        beams: 91,
        field_of_view: std::f64::consts::FRAC_PI_2,
        range_max: 20.0,
        ..Lidar::default()
    };
    let pose = Frame::at([0.0, 0.0], 0.0);
    let mut scans = Scans::new(&empty_floor(), &options, 0).unwrap();
    scans
        .read(&[f64::INFINITY; 91], 0.0, &pose, &mut [])
        .unwrap();
    // Along the left edge of the view, and all of it beyond: only the disc around it is in view.
    let gate =
        |center: [f64; 2]| PlacedShape::turned(center, [4.0, 0.1], std::f64::consts::FRAC_PI_4);
    assert!(!scans.saw_empty(&pose, &gate([3.0, 3.5])));
    assert!(scans.saw_empty(&pose, &gate([3.5, 0.5])));
    assert!(!scans.saw_empty(&pose, &gate([19.0, 0.5])));
}

fn empty_floor() -> Scenario {
    let (robot, rules) = (HolonomicRobot::default(), Rules::default());
    Scenario::new(robot, [0.0; 2], [9.0, 0.0], Vec::new(), rules).unwrap()
}

#[test]
fn a_lidar_sees_from_where_it_is_mounted() {
    let mounted = Lidar {
        map: room(),
        beams: 3,
        field_of_view: std::f64::consts::PI,
        angle_min: Some(0.0),
        mounting: Frame::at([0.5, 0.25], -std::f64::consts::FRAC_PI_2),
        ..Lidar::default()
    };
    // The robot looks along y: the lidar is at (-0.25, 0.5) and its first beam looks along x.
    let pose = Frame::at([0.0, 0.0], std::f64::consts::FRAC_PI_2);
    let ranges = scan(&mounted, &pose, &[]);
    for (range, expected) in ranges.iter().zip([2.25, 0.5, 1.75]) {
        assert!((range - expected).abs() < 1e-12, "{ranges:?}");
    }
    let mut points = Vec::new();
    mounted.points(&pose, &ranges, &mut points);
    for (point, expected) in points.iter().zip([[2.0, 0.5], [-0.25, 1.0], [-2.0, 0.5]]) {
        assert!((point - Vector2::from(expected)).norm() < 1e-12);
        let beam = mounted.beam_toward(&pose, *point).unwrap();
        assert!((points[beam] - point).norm() < 1e-12);
    }
    assert_eq!(mounted.beam_toward(&pose, Vector2::new(-0.25, -1.0)), None);
}

#[test]
fn as_many_beams_drop_out_as_are_to_and_the_others_read_as_before() {
    let whole = Lidar {
        map: room(),
        beams: 10_000,
        range_noise: 0.01,
        ..Lidar::default()
    };
    let pose = Frame::at([0.0, 0.0], 0.0);
    let exact = Lidar {
        range_noise: 0.0,
        ..whole.clone()
    };
    let dropped = Lidar {
        dropout: 0.2,
        ..exact.clone()
    };
    let (all, left) = (scan(&exact, &pose, &[]), scan(&dropped, &pose, &[]));
    let lost = left.iter().filter(|range| range.is_nan()).count();
    assert!((1_800..2_200).contains(&lost), "{lost}");
    for (range, before) in left.iter().zip(&all) {
        assert!(range.is_nan() || range == before);
    }
    for dropout in [-0.1, 1.1, f64::NAN] {
        let refused = Lidar {
            dropout,
            ..Lidar::default()
        };
        assert!(refused.checked().is_err());
    }
}
