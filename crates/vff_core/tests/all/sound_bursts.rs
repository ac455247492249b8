//! Samples from bursts and delays from samples: numbers of the specification, limits and refusals.

use std::f64::consts::PI;

use crate::listening::{
    ARRAY, GO_ON, RATE, channels, delays_of, heard_at, noise_burst, options, work,
};
use vff_core::error::Failure;
use vff_core::sensing::sound::burst::{Burst, Signal, Sound, doppler_factor};
use vff_core::sensing::sound::correlation::Method;
use vff_core::sensing::sound::delays::{DelayFinder, DelayOptions};
use vff_core::sensing::sound::recording::{Converter, Hearing, record};
use vff_core::sensing::sound::trials::{Equipment, Repetition, burst_delays};

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
