//! Cameras, estimators and vision: properties.

use proptest::prelude::*;
use vff_core::sensing::camera::distorted_ratio;
use vff_core::sensing::measurement::Distribution;
use vff_core::sensing::vision::Exposure;
use vff_core::sensing::{
    Camera, CameraPose, Estimator, Lens, LinearizedCamera, PARAMETERS, PositionError, Track,
    Vision, VisionSensor,
};

/// A camera 3 m above the floor that looks straight down; x to the right, y down the picture.
fn overhead(radial_distortion: f64) -> Camera {
    let lens = Lens {
        focal_length: 5e-3,
        radial_distortion,
        horizontal_scale: 0.98,
        image_center: [500.0, 400.0],
        pixel_size: [4.65e-6, 5e-6],
        image_size: [1024, 768],
    };
    let rows = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    let pose = CameraPose::from_rows(rows, [-1.0, 0.5, 3.0]);
    Camera::new(lens, pose).expect("a camera")
}

fn vision(estimator: Estimator) -> Vision {
    Vision {
        period: 0.06,
        delay: 0.0,
        error: PositionError::Plane {
            distribution: Distribution::Gaussian,
            scale: 0.0,
        },
        drop_probability: 0.0,
        estimator,
        compensated: false,
    }
}

const KALMAN: Estimator = Estimator::Kalman {
    acceleration_deviation: 2.0,
    position_deviation: 0.01,
    speed_deviation: 1.0,
};
const ALPHA_BETA: Estimator = Estimator::AlphaBeta {
    position_gain: 0.5,
    velocity_gain: 0.2,
};

/// Runs a sensor over a path that is told every 10 ms, up to a time.
fn followed(
    vision: &Vision,
    end: f64,
    path: impl Fn(f64) -> [f64; 2],
) -> (VisionSensor, Vec<Exposure>) {
    let mut sensor = VisionSensor::new(vision, 7, 1).expect("a sensor");
    let mut frames = Vec::new();
    let mut step = 0_u32;
    while f64::from(step) * 0.01 <= end + 1e-12 {
        let time = f64::from(step) * 0.01;
        sensor.sample(time, path(time));
        frames.extend_from_slice(sensor.frames());
        step += 1;
    }
    (sensor, frames)
}

proptest! {
    #[test]
    fn distortion_inverts_to_rounding(q in -0.148_f64..1e4) {
        let ratio = distorted_ratio(q).expect("inside the fold");
        prop_assert!((ratio * (1.0 + q * ratio * ratio) - 1.0).abs() < 4e-15 * (1.0 + q.abs().cbrt()));
    }

    #[test]
    fn reconstruction_returns_the_projected_point(
        x in -0.5_f64..2.5, y in -1.0_f64..2.0, z in 0.0_f64..1.5, k in -2e3_f64..2e4,
    ) {
        let camera = overhead(k);
        if let Some(pixel) = camera.project([x, y, z]) {
            let [a, b, c] = camera.reconstruct(pixel, z).expect("a point");
            prop_assert!((a - x).abs() < 1e-12 && (b - y).abs() < 1e-12 && c == z);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_projection(
        x in 0.0_f64..2.0, y in -0.5_f64..1.5, z in 0.0_f64..1.5, k in -1e3_f64..2e4,
        turn in prop::array::uniform3(-1.0_f64..1.0), small in prop::bool::ANY,
    ) {
        let camera = overhead(k);
        let turn = turn.map(|angle| if small { 1e-3 * angle } else { 0.2 * angle });
        let [w1, w2, w3] = turn;
        let values = [5e-3, k, 0.98, 500.0, 400.0, w1, w2, w3, -1.0, 0.5, 3.0];
        let at = |values: &[f64; PARAMETERS]| {
            LinearizedCamera::new(&camera, values).expect("a camera").at([x, y, z])
        };
        let steps = [1e-8, 1e-1, 1e-6, 1e-3, 1e-3, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6];
        let Some((pixel, rows)) = at(&values) else { return Ok(()); };
        let shown = LinearizedCamera::new(&camera, &values).expect("a camera").camera.project([x, y, z]);
        prop_assert_eq!(shown, Some(pixel));
        for (index, step) in steps.into_iter().enumerate() {
            let (mut more, mut less) = (values, values);
            more[index] += step;
            less[index] -= step;
            let (Some((high, _)), Some((low, _))) = (at(&more), at(&less)) else { return Ok(()); };
            for axis in 0..2 {
                let slope = (high[axis] - low[axis]) / (2.0 * step);
                let exact = rows[axis][index];
                // The second term is the rounding of pixel numbers near 1000.
                prop_assert!((slope - exact).abs() < 1e-5 * exact.abs() + 1e-10 / step,
                    "{index} {axis}: {slope} {exact}");
            }
        }
    }

    #[test]
    fn constant_velocity_is_found_without_noise(
        vx in -2.0_f64..2.0, vy in -2.0_f64..2.0, delay in 0.0_f64..0.3, kind in 0_usize..3,
    ) {
        let estimator = [Estimator::Differences, ALPHA_BETA, KALMAN][kind];
        let vision = Vision { delay, compensated: true, ..vision(estimator) };
        let path = |time: f64| [1.0 + vx * time, -2.0 + vy * time];
        let (sensor, _) = followed(&vision, 6.0, path);
        let known = sensor.estimate(6.0).expect("known");
        let [x, y] = path(6.0);
        // The Kalman filter forgets its start at rest within a second or so.
        prop_assert!((known.velocity[0] - vx).abs() < 1e-9 && (known.velocity[1] - vy).abs() < 1e-9);
        prop_assert!((known.position[0] - x).abs() < 1e-9 && (known.position[1] - y).abs() < 1e-9);
    }

    #[test]
    fn estimates_move_with_the_origin(shift in -50.0_f64..50.0, kind in 0_usize..3) {
        let estimator = [Estimator::Differences, ALPHA_BETA, KALMAN][kind];
        let (mut here, mut there) = (Track::new(estimator), Track::new(estimator));
        for step in 0..40_u32 {
            let time = f64::from(step) * 0.06;
            let place = [(3.0 * time).sin(), time * time];
            let near = here.measure(time, place);
            let far = there.measure(time, [place[0] + shift, place[1] - shift]);
            prop_assert!((far.position[0] - near.position[0] - shift).abs() < 1e-11);
            prop_assert!((far.position[1] - near.position[1] + shift).abs() < 1e-11);
            prop_assert!((far.velocity[0] - near.velocity[0]).abs() < 1e-9);
        }
    }

    #[test]
    fn steady_gains_are_those_of_the_filter(acceleration in 0.05_f64..50.0, position in 1e-3_f64..0.1) {
        let [alpha, beta] = Estimator::steady_gains(acceleration, position, 0.06).expect("gains");
        let mut track = Track::new(Estimator::Kalman {
            acceleration_deviation: acceleration,
            position_deviation: position,
            speed_deviation: 1.0,
        });
        for step in 0..5000_u32 {
            track.measure(f64::from(step) * 0.06, [0.0; 2]);
        }
        let [p, c, _] = track.covariance();
        let noise = position * position;
        // After the correction p = alpha r and c = beta r / T.
        prop_assert!((p / noise - alpha).abs() < 1e-9 * alpha);
        prop_assert!((c * 0.06 / noise - beta).abs() < 1e-9 * beta);
    }
}

#[test]
fn the_fold_of_the_lens_has_no_image() {
    assert_eq!(distorted_ratio(-0.15), None);
    assert_eq!(distorted_ratio(f64::NAN), None);
    let edge = distorted_ratio(-4.0 / 27.0).expect("the edge");
    assert!((edge - 1.5).abs() < 1e-6);
    let camera = overhead(-1e5);
    assert_eq!(camera.project([5.0, 0.0, 0.0]), None);
    assert_eq!(camera.reconstruct([1023.0, 0.0], 0.0), None);
}

#[test]
fn nothing_behind_the_camera_is_seen() {
    let camera = overhead(0.0);
    assert_eq!(camera.project([1.0, 0.5, 3.0]), None);
    assert_eq!(camera.project([1.0, 0.5, 3.5]), None);
    assert_eq!(camera.reconstruct([500.0, 400.0], 3.5), None);
}

#[test]
fn frames_come_late_and_in_order() {
    let late = Vision {
        delay: 0.15,
        ..vision(Estimator::Differences)
    };
    let (sensor, frames) = followed(&late, 1.0, |time| [time, 0.0]);
    assert_eq!(frames.len(), 17);
    let known = sensor.estimate(1.0).expect("known");
    assert!((known.measured_at - 0.84).abs() < 1e-12);
    assert!((known.position[0] - 0.84).abs() < 1e-12);
}

#[test]
fn nothing_is_known_before_the_first_frame_arrives() {
    let late = Vision {
        delay: 0.15,
        ..vision(Estimator::Differences)
    };
    let mut sensor = VisionSensor::new(&late, 0, 0).expect("a sensor");
    sensor.sample(0.0, [1.0, 2.0]);
    sensor.sample(0.14, [1.0, 2.0]);
    assert_eq!(sensor.estimate(0.14), None);
    sensor.sample(0.15, [1.0, 2.0]);
    assert_eq!(
        sensor.estimate(0.15).map(|known| known.position),
        Some([1.0, 2.0])
    );
}

#[test]
fn frames_are_lost_as_often_as_stated_and_errors_stay_with_their_frames() {
    let error = PositionError::Plane {
        distribution: Distribution::Uniform,
        scale: 0.025,
    };
    let whole = Vision {
        error,
        ..vision(KALMAN)
    };
    let torn = Vision {
        drop_probability: 0.3,
        ..whole
    };
    let (_, all) = followed(&whole, 600.0, |_| [0.0; 2]);
    let (_, some) = followed(&torn, 600.0, |_| [0.0; 2]);
    assert_eq!(all.len(), some.len());
    let lost = some.iter().filter(|frame| frame.measured.is_none()).count();
    // 10,001 frames: 3000 with a standard deviation of 46.
    assert!((2770..3230).contains(&lost), "{lost}");
    for (whole, torn) in all.iter().zip(&some) {
        assert!(torn.measured.is_none() || torn.measured == whole.measured);
        assert!(
            whole
                .measured
                .is_some_and(|[x, y]| x.abs() <= 0.025 && y.abs() <= 0.025)
        );
    }
}

#[test]
fn a_patch_out_of_the_picture_is_a_lost_frame() {
    let camera = overhead(1e3);
    let error = PositionError::Patch {
        camera,
        believed: camera,
        height: 0.3,
        deviation: 0.0,
    };
    let patch = Vision {
        error,
        ..vision(Estimator::Differences)
    };
    let (_, inside) = followed(&patch, 0.6, |_| [1.2, 0.4]);
    assert!(inside.iter().all(|frame| {
        frame
            .measured
            .is_some_and(|[x, y]| (x - 1.2).abs() < 1e-12 && (y - 0.4).abs() < 1e-12)
    }));
    let (sensor, outside) = followed(&patch, 0.6, |_| [9.0, 0.4]);
    assert!(outside.iter().all(|frame| frame.measured.is_none()));
    assert_eq!(sensor.estimate(0.6), None);
}

#[test]
fn an_absent_body_is_forgotten_and_its_track_starts_anew() {
    let mut sensor = VisionSensor::new(&vision(Estimator::Differences), 0, 0).expect("a sensor");
    for step in 0..30_u32 {
        let time = f64::from(step) * 0.06;
        if (10..20).contains(&step) {
            sensor.absent(time);
            assert_eq!(sensor.estimate(time), None);
        } else {
            sensor.sample(time, [time, 0.0]);
            assert!(sensor.estimate(time).is_some());
        }
        if step == 20 {
            assert_eq!(
                sensor.estimate(time).map(|known| known.velocity),
                Some([0.0; 2])
            );
        }
    }
}

#[test]
fn out_of_range_values_are_refused() {
    let good = vision(Estimator::Differences);
    let bad = [
        Vision {
            period: 0.0,
            ..good
        },
        Vision {
            delay: -0.1,
            ..good
        },
        Vision {
            delay: f64::NAN,
            ..good
        },
        Vision {
            drop_probability: 1.0,
            ..good
        },
        Vision {
            drop_probability: f64::NAN,
            ..good
        },
        vision(Estimator::AlphaBeta {
            position_gain: 1.1,
            velocity_gain: 0.1,
        }),
        vision(Estimator::AlphaBeta {
            position_gain: 0.5,
            velocity_gain: 3.0,
        }),
        vision(Estimator::AlphaBeta {
            position_gain: f64::NAN,
            velocity_gain: 0.1,
        }),
    ];
    for vision in bad {
        assert!(VisionSensor::new(&vision, 0, 0).is_err(), "{vision:?}");
    }
    let camera = overhead(0.0);
    let mut pose = *camera.pose();
    pose.rotation[(0, 0)] = 1.0 + 1e-6;
    assert!(Camera::new(*camera.lens(), pose).is_err());
    pose.rotation[(0, 0)] = -1.0;
    assert!(Camera::new(*camera.lens(), pose).is_err());
}
