//! Motions against closed forms, and what holds on any path.

use numeric::error::Failure;
use numeric::parallel::Work;
use proptest::prelude::*;

use super::{WORK, close, limits, path_of, straight, time};
use crate::program::path::JointPath;
use crate::program::retime::{MotionLimits, Reason, Retimed, Verification, retime};
use crate::program::spline;

#[test]
fn straight_moves_are_trapezoids() {
    let path = straight(&[1.0], 4000);
    let found = retime(&path, &limits(&[0.5], &[2.0]), WORK).unwrap();
    close(&found, 2.25);
    assert_eq!(found.reasons[2000], Reason::Velocity(0));
    assert_eq!(found.reasons[10], Reason::Acceleration(0));
    close(
        &retime(&straight(&[0.1], 4000), &limits(&[1.0], &[1.0]), WORK).unwrap(),
        0.4_f64.sqrt(),
    );
    let both = straight(&[1.0, 0.5], 4000);
    let found = retime(&both, &limits(&[0.5, 0.5], &[2.0, 0.4]), WORK).unwrap();
    close(&found, 2.625);
    assert_eq!(found.reasons[10], Reason::Acceleration(1));
}

#[test]
fn without_a_limit_of_acceleration_velocities_govern() {
    let path = straight(&[1.0], 1000);
    let found = retime(&path, &limits(&[0.5], &[f64::INFINITY]), WORK).unwrap();
    assert!((time(&found) / 2.0 - 1.0).abs() < 3e-3);
    assert_eq!(found.shares[0][0], 0.0);
}

#[test]
fn a_slow_zone_is_entered_and_left_at_its_speed() {
    let path = straight(&[1.0], 4000);
    let zone = |index: usize| {
        if (1600..2400).contains(&index) {
            0.2
        } else {
            f64::INFINITY
        }
    };
    let speeds: Vec<f64> = (0..4000).map(zone).collect();
    let slow = MotionLimits {
        path_speed: Some(&speeds),
        ..limits(&[0.5], &[2.0])
    };
    let found = retime(&path, &slow, WORK).unwrap();
    close(&found, 2.94);
    assert_eq!(found.reasons[2000], Reason::PathSpeed);
    let stands: Vec<f64> = speeds
        .iter()
        .map(|speed| if *speed < 1.0 { 0.0 } else { *speed })
        .collect();
    let found = retime(
        &path,
        &MotionLimits {
            path_speed: Some(&stands),
            ..slow
        },
        WORK,
    )
    .unwrap();
    assert_eq!(found.status, Verification::Standstill);
    assert_eq!(time(&found), f64::INFINITY);
}

#[test]
fn a_corner_is_refused_without_a_stop() {
    let row = |from: [f64; 2], by: [f64; 2]| [from, by, [0.0; 2], [0.0; 2]].concat();
    let coefficients = [row([0.0; 2], [1.0, 0.0]), row([1.0, 0.0], [0.0, 1.0])].concat();
    let path = JointPath::new(vec![0.0, 1.0, 1.6], coefficients, 2).unwrap();
    let path = path.refined(&[1000, 600]).unwrap();
    let (velocity, acceleration) = ([1.0; 2], [2.0; 2]);
    let open = limits(&velocity, &acceleration);
    let refused = retime(&path, &open, WORK).unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("jump of the tangent at node 1000")
    );
    close(
        &retime(
            &path,
            &MotionLimits {
                stops: &[1000],
                ..open
            },
            WORK,
        )
        .unwrap(),
        2.6,
    );
    for stops in [&[0][..], &[1], &[1000, 1001], &[1599], &[1600]] {
        let refused = retime(&path, &MotionLimits { stops, ..open }, WORK).unwrap_err();
        assert!(
            refused.to_string().contains("stops must"),
            "{stops:?}: {refused}"
        );
    }
}

#[test]
fn a_request_to_stop_is_heard() {
    let asked = Work {
        interrupted: &|| true,
        ..WORK
    };
    let found = retime(&straight(&[1.0], 100), &limits(&[1.0], &[1.0]), asked);
    assert_eq!(found.unwrap_err(), Failure::Interrupted);
}

#[test]
fn splines_reproduce_cubics() {
    let cubic = |s: f64| 0.3 + s * (-1.2 + s * (0.7 + 0.4 * s));
    let knots = [0.0, 0.3, 0.45, 1.1, 1.5];
    let values: Vec<f64> = knots.iter().map(|knot| cubic(*knot)).collect();
    for count in [4, 5] {
        let path = spline::through(&knots[..count], &values[..count], 1).unwrap();
        for (row, knot) in path.coefficients().chunks(4).zip(knots) {
            let expected = [
                cubic(knot),
                -1.2 + knot * (1.4 + 1.2 * knot),
                0.7 + 1.2 * knot,
                0.4,
            ];
            for (found, expected) in row.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12);
            }
        }
    }
    let parabola = spline::through(&[0.0, 0.3, 1.0], &[0.0, 0.09, 1.0], 1).unwrap();
    assert!((parabola.coefficients()[2] - 1.0).abs() < 1e-12);
}

/// The path backwards.
fn reversed(path: &JointPath) -> JointPath {
    let total = path.nodes()[path.intervals()];
    let nodes = path.nodes().iter().rev().map(|node| total - node).collect();
    let mut coefficients = Vec::new();
    for index in (0..path.intervals()).rev() {
        let piece = path.piece(index);
        let of = |joint: usize| {
            let ([q0, q1, q2, q3], h) = (piece.powers(joint), piece.length);
            let end = q0 + h * (q1 + h * (q2 + h * q3));
            [
                end,
                -(q1 + h * (2.0 * q2 + 3.0 * h * q3)),
                q2 + 3.0 * h * q3,
                -q3,
            ]
        };
        for power in 0..4 {
            coefficients.extend((0..path.joints()).map(|joint| of(joint)[power]));
        }
    }
    JointPath::new(nodes, coefficients, path.joints()).unwrap()
}

/// Largest shares of velocity and acceleration at places between the nodes, in the time of the motion.
fn measured(path: &JointPath, found: &Retimed, velocity: &[f64], acceleration: &[f64]) -> [f64; 2] {
    let mut most = [0.0_f64; 2];
    for index in 0..path.intervals() {
        let piece = path.piece(index);
        let [from, to] = [found.squares[index].sqrt(), found.squares[index + 1].sqrt()];
        let (time, change) = (
            2.0 * piece.length / (from + to),
            0.5 * (to * to - from * from) / piece.length,
        );
        for place in 0..16 {
            let moment = time * (f64::from(place) + 0.5) / 16.0;
            let (way, speed) = (
                moment * (from + 0.5 * change * moment),
                from + change * moment,
            );
            for joint in 0..path.joints() {
                let [_, q1, q2, q3] = piece.powers(joint);
                let rate = q1 + way * (2.0 * q2 + 3.0 * way * q3);
                let bend = 2.0 * q2 + 6.0 * way * q3;
                most[0] = most[0].max((rate * speed).abs() / velocity[joint]);
                most[1] =
                    most[1].max((rate * change + bend * speed * speed).abs() / acceleration[joint]);
            }
        }
    }
    most
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn motions_keep_their_limits_between_the_nodes(
        values in prop::collection::vec(-1.5..1.5, 36),
        acceleration in prop::collection::vec(0.5..20.0, 6),
        parts in 3_usize..80,
    ) {
        let velocity = [2.0, 2.0, 2.5, 3.0, 3.0, 3.0];
        let path = path_of(&values, 6, parts);
        let found = retime(&path, &limits(&velocity, &acceleration), WORK).unwrap();
        prop_assert_eq!(found.status, Verification::Verified);
        let most = measured(&path, &found, &velocity, &acceleration);
        prop_assert!(most.iter().all(|share| *share <= 1.0 + 1e-6), "{:?}", most);
        prop_assert!(found.shares.iter().flatten().all(|share| *share <= 1.0 + 1e-6));
        // There and back take the same time, and more intervals do not make it slower.
        let back = retime(&reversed(&path), &limits(&velocity, &acceleration), WORK).unwrap();
        prop_assert!((time(&back) / time(&found) - 1.0).abs() < 1e-4);
        // Some limit is used on most intervals, unless they are long.
        let used = found.shares.iter().filter(|shares| shares.iter().any(|share| *share > 0.9)).count();
        prop_assert!(3 * used > path.intervals());
    }

    #[test]
    fn time_goes_with_the_root_of_the_acceleration(
        values in prop::collection::vec(-1.5..1.5, 15),
        factor in 0.1..10.0,
    ) {
        let path = path_of(&values, 3, 60);
        let free = [1e6; 3];
        let once = retime(&path, &limits(&free, &[2.0; 3]), WORK).unwrap();
        let scaled = [2.0 * factor; 3];
        let other = retime(&path, &limits(&free, &scaled), WORK).unwrap();
        prop_assert!((time(&other) * f64::sqrt(factor) / time(&once) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn twice_the_intervals_take_about_the_same_time(values in prop::collection::vec(-1.5..1.5, 18)) {
        let (velocity, acceleration) = ([2.0; 3], [5.0; 3]);
        let of = |parts| retime(&path_of(&values, 3, parts), &limits(&velocity, &acceleration), WORK).unwrap();
        prop_assert!((time(&of(400)) / time(&of(800)) - 1.0).abs() < 5e-3);
    }
}
