//! Cost of the head injury criterion of 2000 samples at 10 kHz.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use impact_core::signal::{contiguous_level, hic, moving_average};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const SAMPLES: u32 = 2000;

fn signals() -> Vec<(&'static str, Vec<f64>)> {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let mut noise = move || generator.next_u64() as f64 / 2.0_f64.powi(63) - 1.0;
    let pulse = |k: u32, width: f64| {
        let share = (f64::from(k) * 1e-4 - 0.04) / width;
        if (0.0..1.0).contains(&share) {
            (std::f64::consts::PI * share).sin()
        } else {
            0.0
        }
    };
    vec![
        (
            "half_sine_12_ms",
            (0..SAMPLES).map(|k| 80.0 * pulse(k, 0.012)).collect(),
        ),
        (
            "half_sine_100_ms",
            (0..SAMPLES).map(|k| 80.0 * pulse(k, 0.1)).collect(),
        ),
        (
            "pulse_with_ringing_and_noise",
            (0..SAMPLES)
                .map(|k| {
                    let ringing = (f64::from(k) * 0.4).sin() * pulse(k, 0.1) * 8.0;
                    80.0 * pulse(k, 0.02) + ringing + 1.5 * noise()
                })
                .collect(),
        ),
        ("constant", vec![10.0; SAMPLES as usize]),
    ]
}

fn criteria(criterion: &mut Criterion) {
    let time: Vec<f64> = (0..SAMPLES).map(|k| f64::from(k) * 1e-4).collect();
    let mut generator = ChaCha8Rng::seed_from_u64(2);
    let noise: Vec<f64> = (0..SAMPLES)
        .map(|_| generator.next_u64() as f64 / 2.0_f64.powi(63) - 1.0)
        .collect();
    let mut signals = signals();
    signals.push(("white_noise", noise));
    for (name, signal) in &signals {
        criterion.bench_function(&format!("hic15/{name}"), |bencher| {
            bencher.iter(|| hic(black_box(&time), black_box(signal), 0.015, false, &|| false));
        });
    }
    let pulse = &signals[2].1;
    criterion.bench_function("hic36/pulse_with_ringing_and_noise", |bencher| {
        bencher.iter(|| hic(black_box(&time), black_box(pulse), 0.036, false, &|| false));
    });
    criterion.bench_function("hic15_free_ends/pulse_with_ringing_and_noise", |bencher| {
        bencher.iter(|| hic(black_box(&time), black_box(pulse), 0.015, true, &|| false));
    });
    criterion.bench_function("average_3ms/pulse_with_ringing_and_noise", |bencher| {
        bencher.iter(|| moving_average(black_box(&time), black_box(pulse), 0.003, &|| false));
    });
    criterion.bench_function("clip_3ms/pulse_with_ringing_and_noise", |bencher| {
        bencher.iter(|| contiguous_level(black_box(&time), black_box(pulse), 0.003, &|| false));
    });
}

criterion_group!(benches, criteria);
criterion_main!(benches);
