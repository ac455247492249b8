//! The criterion beside all windows, one by one, and beside formulas.

use super::*;
use crate::signal::{hic_half_sine, hic_square, hic_triangle};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Against all windows, one by one: rounding of the integrals only.
const BRUTE_FORCE: f64 = 1e-12;
/// Against formulas, with the interpolating form.
const FORMULA: f64 = 1e-9;

fn all_sample_windows(time: &[f64], value: &[f64], window: f64) -> f64 {
    let mut best = 0.0_f64;
    for start in 0..time.len() {
        let mut integral = 0.0;
        for end in start + 1..time.len() {
            let length = time[end] - time[start];
            if length > window * (1.0 + WINDOW_SLACK) {
                break;
            }
            integral += 0.5 * (value[end] + value[end - 1]) * (time[end] - time[end - 1]);
            if integral > 0.0 {
                best = best.max(length * (integral / length).powf(2.5));
            }
        }
    }
    best
}

fn all_cells(time: &[f64], value: &[f64], window: f64) -> f64 {
    let peak = value.iter().copied().fold(0.0, f64::max);
    let scaled: Vec<f64> = value.iter().map(|value| value / peak).collect();
    let signal = Signal {
        time,
        value: &scaled,
    };
    let cells = Cells::new_until(signal, &signal.integral(), window, &|| false).unwrap();
    let mut best = Best::NONE;
    for left in 0..time.len() - 1 {
        for right in left..time.len() - 1 {
            cells.visit(left, right, &mut best);
        }
    }
    best.squared.sqrt() * peak.powf(2.5)
}

/// Windows whose ends lie anywhere on a grid that is finer than the samples.
fn fine_grid(time: &[f64], value: &[f64], window: f64, parts: usize) -> f64 {
    let mut fine_time = vec![time[0]];
    let mut fine_value = vec![value[0]];
    for k in 1..time.len() {
        for part in 1..=parts {
            let share = part as f64 / parts as f64;
            fine_time.push(time[k - 1] + share * (time[k] - time[k - 1]));
            fine_value.push(value[k - 1] + share * (value[k] - value[k - 1]));
        }
    }
    all_sample_windows(&fine_time, &fine_value, window)
}

fn close(value: f64, expected: f64, tolerance: f64) -> bool {
    (value - expected).abs() <= tolerance * expected.abs()
}

fn any_signal() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    let step = prop_oneof![Just(1e-4), 1e-5..2e-3];
    let shape = prop_oneof![
        Just((0.0, 1.0)),
        Just((1.0, 0.0)),
        Just((1.0, 0.2)),
        Just((1.0, 0.01)),
    ];
    (2_usize..180, shape, 0.001..0.05).prop_flat_map(move |(samples, (pulse, noise), width)| {
        let steps = proptest::collection::vec(step.clone(), samples);
        let values = proptest::collection::vec(-1.0..1.0_f64, samples);
        (steps, values, 0.0..0.05_f64, -20.0..20.0_f64).prop_map(
            move |(steps, values, center, offset)| {
                let mut now = offset;
                let time: Vec<f64> = steps
                    .iter()
                    .map(|step| {
                        now += step;
                        now
                    })
                    .collect();
                let value = time
                    .iter()
                    .zip(&values)
                    .map(|(time, value)| {
                        let place: f64 = (time - offset - center) / width;
                        80.0 * (pulse * (-place * place).exp() + noise * value)
                    })
                    .collect();
                (time, value)
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn samples_equal_brute_force((time, value) in any_signal(), window in prop_oneof![Just(0.015), Just(0.036), 0.0005..0.1]) {
        let found = hic(&time, &value, window, false, &|| false).unwrap();
        let expected = all_sample_windows(&time, &value, window);
        prop_assert!(close(found.value, expected, BRUTE_FORCE), "{} {}", found.value, expected);
    }

    #[test]
    fn free_ends_equal_all_cells((time, value) in any_signal(), window in prop_oneof![Just(0.015), Just(0.036), 0.0005..0.1]) {
        prop_assume!(value.iter().any(|&value| value > 0.0));
        let found = hic(&time, &value, window, true, &|| false).unwrap();
        let expected = all_cells(&time, &value, window);
        prop_assert!(close(found.value, expected, BRUTE_FORCE), "{} {}", found.value, expected);
        let rounding = 4.0 * f64::EPSILON * time[0].abs().max(found.end.abs());
        prop_assert!(found.end - found.start <= window + rounding);
    }

    #[test]
    fn nothing_on_a_fine_grid_beats_free_ends((time, value) in any_signal(), window in 0.0005..0.1) {
        let (time, value) = (&time[..time.len().min(40)], &value[..time.len().min(40)]);
        let found = hic(time, value, window, true, &|| false).unwrap().value;
        let grid = fine_grid(time, value, window, 24);
        prop_assert!(grid <= found * (1.0 + 1e-8) , "{found} {grid}");
    }

    #[test]
    fn the_window_gives_the_value((time, value) in any_signal()) {
        let found = hic(&time, &value, 0.015, false, &|| false).unwrap();
        if found.value > 0.0 {
            let start = time.iter().position(|&time| time == found.start).unwrap();
            let end = time.iter().position(|&time| time == found.end).unwrap();
            let again = all_sample_windows(&time[start..=end], &value[start..=end], 1.0);
            prop_assert!(close(again, found.value, BRUTE_FORCE));
        }
    }
}

fn pulse(samples: usize, duration: f64, shape: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let time: Vec<f64> = (0..samples)
        .map(|k| duration * k as f64 / (samples - 1) as f64)
        .collect();
    let value = time.iter().map(|time| shape(time / duration)).collect();
    (time, value)
}

#[test]
fn half_sine_of_5_ms_and_100_g_is_207_3() {
    let (time, value) = pulse(2001, 0.005, |share| {
        100.0 * (std::f64::consts::PI * share).sin()
    });
    for interpolate in [false, true] {
        let found = hic(&time, &value, 0.015, interpolate, &|| false).unwrap();
        assert!((found.value - 207.3).abs() < 0.05, "{found:?}");
    }
}

#[test]
fn half_sines_reach_the_formula() {
    for window in [0.015, 0.036, 0.002] {
        // Chords of the sine are low by (pi / n)^2 / 12.
        let (time, value) = pulse(100_001, 0.02, |share| {
            100.0 * (std::f64::consts::PI * share).sin()
        });
        let found = hic(&time, &value, window, true, &|| false).unwrap().value;
        let expected = hic_half_sine(100.0, 0.02, window).unwrap();
        assert!(
            close(found, expected, FORMULA),
            "{window} {}",
            found / expected - 1.0
        );
    }
}

#[test]
fn triangles_and_squares_are_exact() {
    for window in [0.015, 0.036, 0.004] {
        for peak in [0.5, 0.2, 0.9] {
            let (time, value) = ([0.0, 0.02 * peak, 0.02], [0.0, 50.0, 0.0]);
            let found = hic(&time, &value, window, true, &|| false).unwrap().value;
            let expected = hic_triangle(50.0, 0.02, window).unwrap();
            assert!(
                close(found, expected, 1e-13),
                "{window} {}",
                found / expected - 1.0
            );
        }
        for samples in [2, 3, 64, 4001] {
            let (time, value) = pulse(samples, 0.02, |_| 50.0);
            let found = hic(&time, &value, window, true, &|| false).unwrap().value;
            let expected = hic_square(50.0, 0.02, window).unwrap();
            assert!(
                close(found, expected, 1e-13),
                "{window} {samples} {}",
                found / expected - 1.0
            );
        }
    }
}

#[test]
fn negative_signals_count_0() {
    let (time, value) = pulse(100, 0.02, |share| -1.0 - share);
    for interpolate in [false, true] {
        let found = hic(&time, &value, 0.015, interpolate, &|| false).unwrap();
        assert_eq!((found.value, found.start, found.end), (0.0, 0.0, 0.0));
    }
}

#[test]
fn times_may_be_rounded() {
    let time: Vec<f64> = (0..2001).map(|k| 3.0 + f64::from(k) * 1e-4).collect();
    let value = vec![10.0; 2001];
    let found = hic(&time, &value, 0.015, false, &|| false).unwrap();
    assert!(close(found.value, 0.015 * 10.0_f64.powf(2.5), 1e-9));
}

#[test]
fn huge_and_tiny_signals_keep_their_digits() {
    let (time, value) = pulse(301, 0.03, |share| (9.0 * share).sin());
    let plain = hic(&time, &value, 0.015, true, &|| false).unwrap().value;
    for factor in [1e-90_f64, 1e90] {
        let scaled: Vec<f64> = value.iter().map(|value| value * factor).collect();
        let found = hic(&time, &scaled, 0.015, true, &|| false).unwrap().value;
        assert!(close(found, plain * factor.powf(2.5), 1e-12));
    }
}

#[test]
fn bad_signals_are_named() {
    let good = [0.0, 1.0, 2.0];
    assert!(hic(&good[..1], &good[..1], 0.015, false, &|| false).is_err());
    assert!(hic(&good, &good[..2], 0.015, false, &|| false).is_err());
    assert!(hic(&[0.0, 2.0, 1.0], &good, 0.015, false, &|| false).is_err());
    assert!(hic(&[0.0, 1.0, 1.0], &good, 0.015, false, &|| false).is_err());
    assert!(hic(&good, &[0.0, f64::NAN, 1.0], 0.015, false, &|| false).is_err());
    assert!(hic(&[0.0, 1.0, f64::INFINITY], &good, 0.015, false, &|| false).is_err());
    assert!(hic(&good, &good, 0.0, false, &|| false).is_err());
    assert!(hic(&good, &good, f64::NAN, true, &|| false).is_err());
}
