//! Range and bearing from delays: numbers of the specification, limits and refusals.

use crate::listening::{ARRAY, GO_ON, RATE, work};
use vff_core::error::Failure;
use vff_core::sensing::sound::batch::locate_many;
use vff_core::sensing::sound::fix::{Covariance, FixStatus, locate, printed_range};
use vff_core::sensing::sound::microphones::{MicrophoneArray, MicrophonePair};
use vff_core::sensing::sound::trials::{Repetition, jittered_delays};

/// Most error of a fix from exact delays, in m and in rad, up to 4 m and 60 deg: rounding only.
const EXACT: f64 = 1e-12;
const PRINTED_DIGIT: f64 = 0.05; // deg, half of the last digit of the specification

#[test]
fn fixes_are_exact_up_to_four_meters_and_sixty_degrees() {
    for row in 1..=80 {
        let range = 0.05 * f64::from(row);
        for degrees in -60..=60 {
            let bearing = f64::from(degrees).to_radians();
            // A source nearer than about a spacing still has one solution.
            let fix = locate(
                &ARRAY,
                ARRAY.delays(range, bearing),
                &Covariance::of_arrivals(0.0),
            );
            assert_eq!(fix.status, FixStatus::Fix);
            assert!(
                (fix.range - range).abs() <= EXACT,
                "{range} {degrees}: {}",
                fix.range
            );
            assert!(
                (fix.bearing - bearing).abs() <= EXACT,
                "{range} {degrees}: {}",
                fix.bearing
            );
        }
    }
}

#[test]
fn range_agrees_with_the_formula_of_the_three_arrivals() {
    // D = [2 l^2 - c^2 (t1^2 - 2 t2^2 + t3^2)] / [2 c (t1 - 2 t2 + t3)], R_i = D + c t_i, for
    // arrivals counted from any instant.
    for offset in [0.0, 1e-4, -2e-3] {
        let arrivals = ARRAY.distances(2.5, 0.4).map(|d| d / 340.0 + offset);
        let [t1, t2, t3] = arrivals.map(|t| 340.0 * t);
        let common =
            (2.0 * 0.16 - (t1 * t1 - 2.0 * t2 * t2 + t3 * t3)) / (2.0 * (t1 - 2.0 * t2 + t3));
        let delays = [arrivals[1] - arrivals[0], arrivals[2] - arrivals[0]];
        let fix = locate(&ARRAY, delays, &Covariance::of_arrivals(0.0));
        assert!((fix.range - (common + t2)).abs() < 1e-11);
        // The formula gives the offset that all ranges share, not the distance from the row.
        let normal = 2.5 * 0.4_f64.cos();
        assert!((common - normal).abs() > 0.01);
    }
}

#[test]
fn printed_formula_gives_no_range_of_any_microphone() {
    let mut errors: Vec<f64> = Vec::new();
    for range in [1.0, 2.0, 3.0, 4.0] {
        for degrees in [-50.0_f64, -20.0, 10.0, 40.0] {
            let bearing = degrees.to_radians();
            let printed = printed_range(&ARRAY, ARRAY.delays(range, bearing));
            let [r1, r2, r3] = ARRAY.distances(range, bearing);
            let normal = range * bearing.cos();
            let nearest = [r1, r2, r3, normal]
                .map(|target| (printed / target - 1.0).abs())
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            errors.push(nearest);
        }
    }
    errors.sort_by(f64::total_cmp);
    assert!(
        errors[errors.len() / 2] > 0.1,
        "median {}",
        errors[errors.len() / 2]
    );
}

#[test]
fn parallel_rays_are_biased_as_the_specification_says() {
    let degrees = |range: f64, bearing: f64, pair: MicrophonePair| {
        let delays = ARRAY.delays(range, bearing.to_radians());
        ARRAY
            .parallel_ray_bearing(pair, pair.delay(delays))
            .to_degrees()
    };
    for (found, expected) in [
        (degrees(1.0, 0.0, MicrophonePair::First), 11.1),
        (degrees(1.0, 30.0, MicrophonePair::First), 38.5),
        (degrees(1.0, 30.0, MicrophonePair::Second), 18.7),
        (degrees(1.0, 30.0, MicrophonePair::Outer), 28.1),
    ] {
        assert!(
            (found - expected).abs() < PRINTED_DIGIT,
            "{found} {expected}"
        );
    }
    // Far away the rays are parallel.
    assert!((degrees(4000.0, 30.0, MicrophonePair::First) - 30.0).abs() < 0.01);
    assert!(
        ARRAY
            .parallel_ray_bearing(MicrophonePair::First, 0.41 / 340.0)
            .is_nan()
    );
}

#[test]
fn there_is_no_fix_without_curvature_or_with_delays_that_cannot_be() {
    let none = Covariance::of_arrivals(1e-6);
    for (delays, status) in [
        ([0.0, 0.0], FixStatus::NoCurvature),
        ([1e-4, 1e-4], FixStatus::NoCurvature),
        ([f64::NAN, 0.0], FixStatus::NoDelay),
        ([0.0, f64::NAN], FixStatus::NoDelay),
        ([0.41 / 340.0, 0.5 / 340.0], FixStatus::TooLong),
        ([-0.1 / 340.0, 0.31 / 340.0], FixStatus::TooLong),
        ([0.39 / 340.0, 0.81 / 340.0], FixStatus::TooLong),
        ([f64::INFINITY, 0.0], FixStatus::TooLong),
    ] {
        let fix = locate(&ARRAY, delays, &none);
        assert_eq!(fix.status, status, "{delays:?}");
        let numbers = [
            fix.range,
            fix.bearing,
            fix.covariance.first,
            fix.covariance.second,
        ];
        assert!(numbers.iter().all(|number| number.is_nan()));
    }
    // A source on M2 has no bearing.
    let round = MicrophoneArray {
        spacing: 0.5,
        speed_of_sound: 1.0,
    };
    assert_eq!(
        locate(&round, [-0.5, 0.0], &none).status,
        FixStatus::NoCurvature
    );
}

#[test]
fn covariance_is_that_of_differences() {
    // Central differences of range and bearing by the three arrivals, 1e-9 s apart.
    let (range, bearing, step) = (3.0, 0.5, 1e-9);
    let arrivals = ARRAY.distances(range, bearing).map(|d| d / 340.0);
    let at = |arrivals: [f64; 3]| {
        let delays = [arrivals[1] - arrivals[0], arrivals[2] - arrivals[0]];
        let fix = locate(&ARRAY, delays, &Covariance::of_arrivals(0.0));
        [fix.range, fix.bearing]
    };
    let (mut first, mut mixed, mut second) = (0.0, 0.0, 0.0);
    for i in 0..3 {
        let moved = |by: f64| {
            let mut all = arrivals;
            all[i] += by;
            at(all)
        };
        let (up, down) = (moved(step), moved(-step));
        let [r, b] = [0, 1].map(|k| (up[k] - down[k]) / (2.0 * step));
        first += r * r;
        mixed += r * b;
        second += b * b;
    }
    let deviation = 2.5e-6;
    let fix = locate(
        &ARRAY,
        ARRAY.delays(range, bearing),
        &Covariance::of_arrivals(deviation),
    );
    let square = deviation * deviation;
    for (found, expected) in [
        (fix.covariance.first, first * square),
        (fix.covariance.mixed, mixed * square),
        (fix.covariance.second, second * square),
    ] {
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    }
}

#[test]
fn first_order_deviation_of_range_is_that_of_the_specification() {
    // The specification has D^2 / (l^2 cos^2 th) c, the leading term in l / D: 3 % at 3 m.
    for (degrees, expected) in [(0.0_f64, 0.117), (30.0, 0.156), (60.0, 0.468)] {
        let delays = ARRAY.delays(3.0, degrees.to_radians());
        let fix = locate(&ARRAY, delays, &Covariance::of_arrivals(0.25 / RATE));
        let deviation = fix.covariance.first.sqrt();
        assert!(
            (deviation / expected - 1.0).abs() < 0.03,
            "{degrees}: {deviation}"
        );
    }
}

#[test]
fn jitter_scatters_range_as_the_specification_says() {
    let sources = [0.0_f64, 30.0, 60.0].map(|degrees| [3.0, degrees.to_radians()]);
    let repetition = Repetition {
        runs: 20_000,
        seed: 5,
    };
    let found = jittered_delays(
        &ARRAY,
        &sources,
        0.25 / RATE,
        &repetition,
        work(None, GO_ON),
    )
    .unwrap();
    for (source, expected) in [0.120, 0.159, 0.518].into_iter().enumerate() {
        let rows = source * 20_000..(source + 1) * 20_000;
        let ranges: Vec<f64> = rows
            .map(|row| [found.delay_12[row], found.delay_13[row]])
            .map(|delays| locate(&ARRAY, delays, &Covariance::of_arrivals(0.0)).range)
            .filter(|range| range.is_finite())
            .collect();
        let mean = ranges.iter().sum::<f64>() / ranges.len() as f64;
        let square = ranges.iter().map(|r| (r - mean) * (r - mean)).sum::<f64>();
        let deviation = (square / (ranges.len() as f64 - 1.0)).sqrt();
        // 0.5 % of sampling, and more for the long tail at 60 deg.
        assert!(
            (deviation / expected - 1.0).abs() < 0.03,
            "{deviation} {expected}"
        );
    }
}

#[test]
fn batch_is_the_single_fixes_for_any_number_of_threads() {
    let sources: Vec<[f64; 2]> = (0..10_000)
        .map(|k| {
            [
                0.5 + 1e-3 * f64::from(k),
                f64::from(k % 121 - 60).to_radians(),
            ]
        })
        .collect();
    let repetition = Repetition { runs: 1, seed: 3 };
    let delays = jittered_delays(&ARRAY, &sources, 2.5e-6, &repetition, work(None, GO_ON)).unwrap();
    let covariance = Covariance::of_arrivals(2.5e-6);
    let of_threads = |threads| {
        let (a, b) = (&delays.delay_12, &delays.delay_13);
        locate_many(&ARRAY, a, b, &covariance, work(threads, &|| false)).unwrap()
    };
    let table = of_threads(None);
    for (row, (a, b)) in delays.delay_12.iter().zip(&delays.delay_13).enumerate() {
        let fix = locate(&ARRAY, [*a, *b], &covariance);
        assert_eq!(fix.range.to_bits(), table.range[row].to_bits());
        assert_eq!(fix.bearing.to_bits(), table.bearing[row].to_bits());
        assert_eq!(fix.status, FixStatus::ALL[usize::from(table.status[row])]);
    }
    for threads in [1, 3] {
        let other = of_threads(Some(threads));
        let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(x, y)| x.to_bits() == y.to_bits());
        assert!(same(&other.range, &table.range) && same(&other.bearing, &table.bearing));
        assert_eq!(other.status, table.status);
    }
    let (a, b) = (&delays.delay_12, &delays.delay_13);
    let stopped = locate_many(&ARRAY, a, b, &covariance, work(None, &|| true));
    assert_eq!(stopped, Err(Failure::Interrupted));
}
