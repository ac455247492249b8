//! Range and bearing from delays, delays from samples, samples from bursts: numbers of the
//! specification, limits and refusals.

use std::f64::consts::PI;

use reactive_core::error::Failure;
use reactive_core::localization::batch::locate_many;
use reactive_core::localization::burst::{Burst, Signal, Sound, doppler_factor};
use reactive_core::localization::correlation::Method;
use reactive_core::localization::delays::{DelayFinder, DelayOptions};
use reactive_core::localization::fix::{Covariance, FixStatus, locate, printed_range};
use reactive_core::localization::microphones::{MicrophoneArray, Pair};
use reactive_core::localization::recording::{Converter, Hearing, Recording, record};
use reactive_core::localization::trials::{Equipment, Repetition, burst_delays, jittered_delays};
use reactive_core::parallel::Work;

const ARRAY: MicrophoneArray = MicrophoneArray {
    spacing: 0.4,
    speed_of_sound: 340.0,
};
const RATE: f64 = 100e3;
const GO_ON: &(dyn Fn() -> bool + Sync) = &|| false;
const EXACT: f64 = 1e-12; // m and rad, of the issue, up to 4 m and 60 deg
const PRINTED_DIGIT: f64 = 0.05; // deg, half of the last digit of the specification

fn work(threads: Option<usize>, interrupted: &(dyn Fn() -> bool + Sync)) -> Work<'_> {
    Work {
        threads,
        interrupted,
        progress: &|_| (),
    }
}

fn noise_burst(duration: f64) -> Burst {
    Burst {
        sound: Sound::Noise {
            low: 500.0,
            high: 8000.0,
            seed: 1,
        },
        duration,
        level: 0.2,
        ramp: 0.005,
    }
}

fn heard_at(range: f64, bearing: f64) -> Hearing {
    Hearing {
        range,
        bearing,
        observer_speed: 0.0,
        source_speed: 0.0,
        noise: 0.0,
        lead: 0.005,
        samples: None,
    }
}

fn options(method: Method) -> DelayOptions {
    DelayOptions {
        method,
        between_samples: true,
        window: None,
        start: None,
    }
}

fn channels(recording: &Recording) -> [&[f64]; 3] {
    let count = recording.samples.len() / 3;
    let (first, rest) = recording.samples.split_at(count);
    let (second, third) = rest.split_at(count);
    [first, second, third]
}

fn delays_of(recording: &Recording, method: Method) -> [f64; 2] {
    let channels = channels(recording);
    DelayFinder::new(&ARRAY, RATE, channels[0].len(), options(method))
        .unwrap()
        .delays(channels, GO_ON)
        .unwrap()
        .delays
}

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
    let degrees = |range: f64, bearing: f64, pair: Pair| {
        let delays = ARRAY.delays(range, bearing.to_radians());
        ARRAY
            .parallel_ray_bearing(pair, pair.delay(delays))
            .to_degrees()
    };
    for (found, expected) in [
        (degrees(1.0, 0.0, Pair::First), 11.1),
        (degrees(1.0, 30.0, Pair::First), 38.5),
        (degrees(1.0, 30.0, Pair::Second), 18.7),
        (degrees(1.0, 30.0, Pair::Outer), 28.1),
    ] {
        assert!(
            (found - expected).abs() < PRINTED_DIGIT,
            "{found} {expected}"
        );
    }
    // Far away the rays are parallel.
    assert!((degrees(4000.0, 30.0, Pair::First) - 30.0).abs() < 0.01);
    assert!(
        ARRAY
            .parallel_ray_bearing(Pair::First, 0.41 / 340.0)
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

#[test]
fn amplitude_falls_with_distance_and_arrival_with_the_speed_of_sound() {
    let burst = Burst {
        sound: Sound::Sweep {
            low: 500.0,
            high: 8000.0,
        },
        duration: 0.02,
        level: 0.2,
        ramp: 0.0,
    };
    let signal = Signal::new(burst).unwrap();
    let ideal = Converter {
        sample_rate: RATE,
        bits: None,
    };
    let recording = record(&signal, &ARRAY, &ideal, &heard_at(2.0, 0.3), 0, 0, GO_ON).unwrap();
    let distances = ARRAY.distances(2.0, 0.3);
    for (channel, distance) in channels(&recording).into_iter().zip(distances) {
        for (k, sample) in channel.iter().enumerate() {
            // M3 is nearest.
            let time = k as f64 / RATE - 0.005 - (distance - distances[2]) / 340.0;
            // Rounding of the time, 1e-17 s, on a slope of 1e4 per second.
            assert!((sample - signal.at(time) / distance).abs() < 1e-12);
        }
        let energy: f64 = channel.iter().map(|x| x * x).sum();
        let rms = (energy / (0.02 * RATE)).sqrt();
        assert!((rms * distance / 0.2 - 1.0).abs() < 0.02, "{rms}");
    }
}

#[test]
fn noise_has_its_level_and_its_band() {
    let signal = Signal::new(noise_burst(0.2)).unwrap();
    let values: Vec<f64> = (0..20_000)
        .map(|k| signal.at(f64::from(k) / RATE))
        .collect();
    let inner = &values[1000..19_000];
    let rms = (inner.iter().map(|x| x * x).sum::<f64>() / inner.len() as f64).sqrt();
    assert!((rms / 0.2 - 1.0).abs() < 0.05, "{rms}");
    // Power of tones well outside of the band against those inside, by direct sums.
    let power = |frequency: f64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (k, value) in inner.iter().enumerate() {
            let share = k as f64 / inner.len() as f64;
            let angle = 2.0 * PI * frequency * k as f64 / RATE;
            let window = 0.5 - 0.5 * (2.0 * PI * share).cos();
            re += window * value * angle.cos();
            im += window * value * angle.sin();
        }
        re * re + im * im
    };
    let mean = |low: f64| {
        (0..20)
            .map(|k| power(low + 37.0 * f64::from(k)))
            .sum::<f64>()
    };
    let inside = mean(3000.0);
    assert!(mean(12_000.0) < 1e-8 * inside);
    assert!(mean(20_000.0) < 1e-8 * inside);
    assert_eq!(signal.at(-1e-6), 0.0);
    assert_eq!(signal.at(0.2 + 1e-6), 0.0);
}

#[test]
fn converter_rounds_to_its_steps_and_stops_at_its_ends() {
    let burst = Burst {
        level: 2.0,
        ..noise_burst(0.05)
    };
    let signal = Signal::new(burst).unwrap();
    let converter = Converter {
        sample_rate: RATE,
        bits: Some(10),
    };
    let recording = record(
        &signal,
        &ARRAY,
        &converter,
        &heard_at(1.0, 0.0),
        0,
        0,
        GO_ON,
    )
    .unwrap();
    for sample in &recording.samples {
        let level = sample * 512.0;
        assert!((level - level.round()).abs() == 0.0 && (-512.0..=511.0).contains(&level));
    }
    assert!(recording.clipped.iter().all(|count| *count > 100));
}

#[test]
fn motion_changes_the_frequency_as_doppler_says() {
    assert!((doppler_factor(340.0, 2.0, 3.0).unwrap() - 342.0 / 337.0).abs() < 1e-15);
    assert!(doppler_factor(340.0, 0.0, 340.0).is_err());
    assert!(doppler_factor(340.0, f64::NAN, 0.0).is_err());
    // The delays of a burst do not change with the motion that all microphones see alike.
    let signal = Signal::new(noise_burst(0.1)).unwrap();
    let converter = Converter {
        sample_rate: RATE,
        bits: None,
    };
    let moving = Hearing {
        observer_speed: 0.7,
        source_speed: -0.3,
        ..heard_at(2.0, -0.4)
    };
    let expected = ARRAY.delays(2.0, -0.4);
    let recording = record(&signal, &ARRAY, &converter, &moving, 0, 0, GO_ON).unwrap();
    for (found, expected) in delays_of(&recording, Method::CrossCorrelation)
        .iter()
        .zip(expected)
    {
        assert!((found - expected).abs() * RATE < 0.02, "{found} {expected}");
    }
}

#[test]
fn every_estimator_finds_the_delays_of_a_clean_burst() {
    let signal = Signal::new(noise_burst(0.1)).unwrap();
    let converter = Converter {
        sample_rate: RATE,
        bits: Some(10),
    };
    for (range, degrees) in [(1.0, 0.0_f64), (1.0, -60.0), (3.0, 30.0), (4.0, 60.0)] {
        let bearing = degrees.to_radians();
        let recording = record(
            &signal,
            &ARRAY,
            &converter,
            &heard_at(range, bearing),
            0,
            0,
            GO_ON,
        )
        .unwrap();
        let expected = ARRAY.delays(range, bearing);
        for method in [
            Method::MeanSquare,
            Method::CrossCorrelation,
            Method::Phase {
                band: [500.0, 8000.0],
            },
        ] {
            for (found, expected) in delays_of(&recording, method).iter().zip(expected) {
                let off = (found - expected) * RATE;
                assert!(
                    off.abs() < 0.05,
                    "{method:?} {range} {degrees}: {off} samples"
                );
            }
        }
    }
}

#[test]
fn lags_are_searched_as_far_as_the_specification_says() {
    assert_eq!(ARRAY.lag_limits(RATE), [120, 240]);
    let finder = DelayFinder::new(&ARRAY, RATE, 240, options(Method::MeanSquare));
    assert!(finder.is_err());
    let mut finder = DelayFinder::new(&ARRAY, RATE, 300, options(Method::MeanSquare)).unwrap();
    let samples: Vec<f64> = (0..300).map(|k| f64::from(k * k % 17)).collect();
    let curves = finder
        .curves([&samples, &samples, &samples], GO_ON)
        .unwrap();
    assert_eq!(curves.values.map(|values| values.len()), [241, 481]);
}

#[test]
fn silence_has_no_delay_and_odd_samples_are_refused() {
    let mut finder =
        DelayFinder::new(&ARRAY, RATE, 300, options(Method::CrossCorrelation)).unwrap();
    let silent = [0.1; 300];
    let mut loud = [0.0; 300];
    loud[150] = 1.0;
    let found = finder.delays([&loud, &silent, &loud], GO_ON).unwrap();
    assert!(found.delays[0].is_nan() && found.likeness[0].is_nan());
    assert!(found.delays[1].abs() * RATE < 1e-9);
    let mut bad = loud;
    bad[7] = f64::NAN;
    assert!(finder.delays([&loud, &bad, &loud], GO_ON).is_err());
    assert!(finder.delays([&loud[..299], &loud, &loud], GO_ON).is_err());
}

#[test]
fn window_stands_where_the_sound_is() {
    let mut samples = vec![0.0; 5000];
    for (k, sample) in samples.iter_mut().enumerate().skip(3000).take(600) {
        *sample = (k as f64 * 0.7).sin();
    }
    let of_window = |start| DelayOptions {
        window: Some(600),
        start,
        ..options(Method::CrossCorrelation)
    };
    let mut finder = DelayFinder::new(&ARRAY, RATE, 5000, of_window(None)).unwrap();
    let found = finder
        .delays([&samples, &samples, &samples], GO_ON)
        .unwrap();
    assert!(found.start.abs_diff(3000) <= 3, "{}", found.start);
    assert!(DelayFinder::new(&ARRAY, RATE, 5000, of_window(Some(4401))).is_err());
    assert!(DelayFinder::new(&ARRAY, RATE, 500, of_window(None)).is_err());
}

#[test]
fn trials_are_the_same_for_any_number_of_threads() {
    let signal = Signal::new(noise_burst(0.05)).unwrap();
    let equipment = Equipment {
        array: ARRAY,
        converter: Converter {
            sample_rate: RATE,
            bits: Some(10),
        },
        options: options(Method::CrossCorrelation),
    };
    let hearings = [(1.0, 0.1), (3.0, -0.5)].map(|(range, bearing)| Hearing {
        noise: 0.05,
        ..heard_at(range, bearing)
    });
    let of_threads = |threads| {
        let repetition = Repetition { runs: 11, seed: 9 };
        burst_delays(
            &signal,
            &equipment,
            &hearings,
            &repetition,
            work(threads, &|| false),
        )
        .unwrap()
    };
    let one = of_threads(Some(1));
    assert_eq!(one, of_threads(Some(3)));
    assert!(one.delay_12.windows(2).all(|pair| pair[0] != pair[1]));
    let repetition = Repetition { runs: 11, seed: 9 };
    let stopped = burst_delays(
        &signal,
        &equipment,
        &hearings,
        &repetition,
        work(None, &|| true),
    );
    assert_eq!(stopped, Err(Failure::Interrupted));
}

#[test]
fn bursts_that_cannot_be_are_refused() {
    let good = noise_burst(0.1);
    let sound = |low, high| Sound::Noise { low, high, seed: 0 };
    for bad in [
        Burst {
            duration: 0.0,
            ..good
        },
        Burst {
            level: f64::NAN,
            ..good
        },
        Burst {
            ramp: 0.051,
            ..good
        },
        Burst { ramp: -1.0, ..good },
        Burst {
            sound: sound(500.0, 500.0),
            ..good
        },
        Burst {
            sound: sound(-1.0, 500.0),
            ..good
        },
        // No multiple of 10 Hz lies in the band.
        Burst {
            sound: sound(501.0, 502.0),
            ..good
        },
        Burst {
            duration: 1e9,
            ..good
        },
        Burst {
            sound: Sound::Tone {
                frequency: f64::INFINITY,
            },
            ..good
        },
    ] {
        assert!(Signal::new(bad).is_err(), "{bad:?}");
    }
    let converter = |sample_rate, bits| Converter { sample_rate, bits };
    assert!(converter(0.0, None).checked().is_err());
    assert!(converter(1.0, Some(1)).checked().is_err());
    let signal = Signal::new(good).unwrap();
    let too_slow = record(
        &signal,
        &ARRAY,
        &converter(15e3, None),
        &heard_at(1.0, 0.0),
        0,
        0,
        GO_ON,
    );
    assert!(too_slow.is_err());
    let fast = converter(RATE, None);
    for bad in [
        heard_at(0.0, 0.0),
        heard_at(0.4, PI / 2.0 + 1e9),
        Hearing {
            noise: -1.0,
            ..heard_at(1.0, 0.0)
        },
        Hearing {
            lead: -1.0,
            ..heard_at(1.0, 0.0)
        },
        Hearing {
            source_speed: 400.0,
            ..heard_at(1.0, 0.0)
        },
    ] {
        let range_only = bad.bearing > 1e8;
        assert_eq!(
            record(&signal, &ARRAY, &fast, &bad, 0, 0, GO_ON).is_err(),
            !range_only,
            "{bad:?}"
        );
    }
}
