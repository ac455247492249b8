//! What holds for every source and every sound: mirror symmetry, shifts, units.

use numeric::random::Stream;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use vff_core::sensing::sound::correlation::Method;
use vff_core::sensing::sound::delays::{DelayFinder, DelayOptions};
use vff_core::sensing::sound::fix::{Covariance, FixStatus, locate};
use vff_core::sensing::sound::microphones::MicrophoneArray;

const RATE: f64 = 100e3;
const METHODS: [Method; 3] = [
    Method::MeanSquare,
    Method::CrossCorrelation,
    Method::Phase {
        band: [0.0, 0.5 * RATE],
    },
];

fn cases(cases: u32) -> ProptestConfig {
    // The same cases every time: a test says the same of the same code.
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(20_190),
        ..ProptestConfig::default()
    }
}

fn array(spacing: f64, speed_of_sound: f64) -> MicrophoneArray {
    MicrophoneArray {
        spacing,
        speed_of_sound,
    }
}

/// White noise of so many samples.
fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut stream = Stream::new(seed, 0);
    (0..count).map(|_| stream.normals()[0]).collect()
}

fn lags(channels: [&[f64]; 3], method: Method) -> ([i64; 2], [f64; 2]) {
    let options = DelayOptions {
        method,
        between_samples: true,
        window: None,
        start: None,
    };
    let mut finder =
        DelayFinder::new(&array(0.4, 340.0), RATE, channels[0].len(), options).unwrap();
    let found = finder.delays(channels, &|| false).unwrap();
    (found.lags, found.delays)
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn source_is_found_again(range in 0.05..20.0_f64, bearing in -1.4..1.4_f64, spacing in 0.1..1.0_f64, c in 300.0..1500.0_f64) {
        let row = array(spacing, c);
        let fix = locate(&row, row.delays(range, bearing), &Covariance::of_arrivals(0.0));
        prop_assert_eq!(fix.status, FixStatus::Fix);
        // Rounding of the distances, some 2e-16 (R + l), enlarged as jitter is.
        let gain = (range / (spacing * bearing.cos())).powi(2).max(1.0);
        let rounding = 2e-15 * (range + spacing) * (1.0 + gain);
        prop_assert!((fix.range - range).abs() <= rounding);
        prop_assert!((fix.bearing - bearing).abs() <= rounding / range.min(1.0) / bearing.cos());
    }

    #[test]
    fn mirrored_source_has_the_mirrored_fix(range in 0.2..6.0_f64, bearing in -1.2..1.2_f64, jitter in -2e-6..2e-6_f64) {
        let row = array(0.4, 340.0);
        let [a, b] = row.delays(range, bearing);
        let (a, b) = (a + jitter, b - jitter);
        let one = locate(&row, [a, b], &Covariance::of_arrivals(1e-6));
        // M1 and M3 change places: dt_32 and dt_31.
        let other = locate(&row, [a - b, -b], &Covariance::of_arrivals(1e-6));
        prop_assume!(one.status == FixStatus::Fix);
        let near = |x: f64, y: f64| (x - y).abs() <= 1e-9 * x.abs().max(1e-3);
        prop_assert!(near(one.range, other.range));
        prop_assert!(near(one.bearing, -other.bearing));
        prop_assert!(near(one.covariance.first, other.covariance.first));
        prop_assert!(near(one.covariance.mixed, -other.covariance.mixed));
        prop_assert!(near(one.covariance.second, other.covariance.second));
    }

    #[test]
    fn only_the_product_of_speed_and_delay_counts(range in 0.2..6.0_f64, bearing in -1.2..1.2_f64, factor in 0.25..4.0_f64) {
        let (slow, fast) = (array(0.4, 340.0), array(0.4, 340.0 * factor));
        let delays = slow.delays(range, bearing);
        let one = locate(&slow, delays, &Covariance::of_arrivals(1e-6));
        let shorter = delays.map(|delay| delay / factor);
        let other = locate(&fast, shorter, &Covariance::of_arrivals(1e-6 / factor));
        prop_assert!((one.range - other.range).abs() <= 1e-10 * one.range);
        prop_assert!((one.bearing - other.bearing).abs() <= 1e-10);
        prop_assert!((one.covariance.first / other.covariance.first - 1.0).abs() <= 1e-9);
    }

    #[test]
    fn a_larger_row_is_the_same_picture(range in 0.2..6.0_f64, bearing in -1.2..1.2_f64, factor in 0.25..4.0_f64) {
        let (small, large) = (array(0.4, 340.0), array(0.4 * factor, 340.0));
        let delays = small.delays(range, bearing);
        let one = locate(&small, delays, &Covariance::of_arrivals(1e-6));
        let longer = delays.map(|delay| delay * factor);
        let other = locate(&large, longer, &Covariance::of_arrivals(1e-6 * factor));
        prop_assert!((one.range * factor - other.range).abs() <= 1e-10 * other.range);
        prop_assert!((one.bearing - other.bearing).abs() <= 1e-10);
        prop_assert!((one.covariance.second / other.covariance.second - 1.0).abs() <= 1e-9);
    }

    #[test]
    fn no_delay_is_ever_clamped(a in -3e-3..3e-3_f64, b in -5e-3..5e-3_f64) {
        let fix = locate(&array(0.4, 340.0), [a, b], &Covariance::of_arrivals(1e-6));
        let found = fix.status == FixStatus::Fix;
        prop_assert_eq!(found, fix.range.is_finite());
        prop_assert_eq!(found, fix.bearing.is_finite());
        if found {
            prop_assert!(fix.range > 0.0 && fix.bearing.abs() <= std::f64::consts::FRAC_PI_2);
            // The fix explains the delays that it was made from.
            let back = array(0.4, 340.0).delays(fix.range, fix.bearing);
            let far = fix.range.max(1.0);
            prop_assert!((back[0] - a).abs() <= 1e-14 * far && (back[1] - b).abs() <= 1e-14 * far);
        }
    }
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn shifted_copies_have_their_shift(seed in 0..1000_u64, second in 0..110_usize, third in 0..220_usize, left in any::<bool>()) {
        let sound = noise(1600, seed);
        let cut = |shift: usize| &sound[300 - shift..1500 - shift];
        // Later by `shift` samples, or earlier when M1 is the late one.
        let (channels, sign) = if left {
            ([cut(0), cut(second), cut(third)], 1)
        } else {
            let early = |shift: usize| &sound[100 + shift..1300 + shift];
            ([early(0), early(second), early(third)], -1)
        };
        for method in METHODS {
            let (found, _) = lags(channels, method);
            let expected = [second, third].map(|shift| sign * i64::try_from(shift).unwrap());
            prop_assert_eq!(found, expected, "{:?}", method);
        }
    }

    #[test]
    fn gain_offset_and_a_common_shift_change_nothing(seed in 0..1000_u64, shift in 1..100_usize, gain in 0.01..100.0_f64, offset in -5.0..5.0_f64) {
        let sound = noise(3000, seed);
        let at = |begin: usize| [&sound[begin + 40..begin + 1240], &sound[begin..begin + 1200], &sound[begin + 90..begin + 1290]];
        for method in METHODS {
            let (base, _) = lags(at(200), method);
            let (moved, _) = lags(at(200 + shift), method);
            prop_assert_eq!(base, moved);
            let changed = at(200).map(|channel| channel.iter().map(|x| gain * x + offset).collect::<Vec<_>>());
            let [a, b, c] = &changed;
            let (louder, delays) = lags([a, b, c], method);
            prop_assert_eq!(base, louder);
            let (_, before) = lags(at(200), method);
            prop_assert!(delays.iter().zip(before).all(|(x, y)| (x - y).abs() * RATE < 1e-6));
        }
    }
}
