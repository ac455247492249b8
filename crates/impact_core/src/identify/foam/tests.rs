//! Fits of synthetic tests.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::*;
use crate::identify::{DropModel, drop_trajectory};

const TRUTH: [f64; 3] = [24_250.0, 0.112, 2.0];

struct Bench {
    force: Vec<f64>,
    compression: Vec<f64>,
    time: Vec<f64>,
    position: Vec<f64>,
}

fn uniform(generator: &mut ChaCha8Rng) -> f64 {
    (generator.next_u64() as f64 + 0.5) / 2.0_f64.powi(64)
}

fn normal(generator: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * uniform(generator).ln()).sqrt();
    radius * (2.0 * std::f64::consts::PI * uniform(generator)).cos()
}

fn round(value: f64) -> f64 {
    (value / 1e-4).round() * 1e-4
}

/// The rig of the source: 12 static forces with 1 N noise, one drop from 30 to 60 mm at 1 kHz,
/// positions with 0.1 mm resolution.
fn measured(seed: u64, contact: DropContact) -> Bench {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let model = DropModel {
        mass: 1.54,
        stiffness: TRUTH[0],
        damping_ratio: TRUTH[1],
        friction: TRUTH[2],
        height: 0.03 + 0.03 * uniform(&mut generator),
        gravity: GRAVITY,
        contact,
    };
    let time: Vec<f64> = (0..500).map(|k| f64::from(k) * 1e-3).collect();
    let path = drop_trajectory(&time, &model, &|| false).unwrap();
    let mut force = Vec::new();
    let mut compression = Vec::new();
    for k in 1..=12 {
        let depth = 0.4e-3 * f64::from(k) + 1e-4 * uniform(&mut generator);
        force.push(TRUTH[0] * depth + normal(&mut generator));
        compression.push(round(depth));
    }
    Bench {
        force,
        compression,
        time,
        position: path.into_iter().map(round).collect(),
    }
}

fn fit(bench: &Bench, settings: &FoamFitSettings) -> FoamFit {
    let drop = Drop {
        time: &bench.time,
        position: &bench.position,
    };
    let work = Work {
        threads: Some(1),
        interrupted: &|| false,
        progress: &|_| (),
    };
    identify_foam(&bench.force, &bench.compression, &[drop], settings, work).unwrap()
}

#[test]
fn exact_measurements_give_the_truth() {
    let mut bench = measured(3, DropContact::Unilateral);
    let model = DropModel {
        mass: 1.54,
        stiffness: TRUTH[0],
        damping_ratio: TRUTH[1],
        friction: TRUTH[2],
        height: 0.05,
        gravity: GRAVITY,
        contact: DropContact::Unilateral,
    };
    bench.position = drop_trajectory(&bench.time, &model, &|| false).unwrap();
    bench.force = bench
        .compression
        .iter()
        .map(|depth| TRUTH[0] * depth)
        .collect();
    let found = fit(&bench, &FoamFitSettings::new(1.54));
    for (found, truth) in [found.stiffness, found.damping_ratio, found.friction]
        .iter()
        .zip(TRUTH)
    {
        assert!((found / truth - 1.0).abs() < 1e-7, "{found} {truth}");
    }
    assert!((found.drop_heights[0] - 0.05).abs() < 1e-10);
    assert!((found.damping(4.4).unwrap() / (0.224 * (4.4 * TRUTH[0]).sqrt()) - 1.0).abs() < 1e-7);
}

#[test]
fn intervals_cover_the_truth_in_90_to_99_percent() {
    for contact in [DropContact::Unilateral, DropContact::Attached] {
        let mut covered = [0; 3];
        let mut off = [0.0_f64; 3];
        let settings = FoamFitSettings {
            contact,
            ..FoamFitSettings::new(1.54)
        };
        for seed in 0..200 {
            let found = fit(&measured(seed, contact), &settings);
            let values = [found.stiffness, found.damping_ratio, found.friction];
            for k in 0..3 {
                covered[k] +=
                    u32::from(found.interval[k][0] <= TRUTH[k] && TRUTH[k] <= found.interval[k][1]);
                off[k] += (values[k] / TRUTH[k] - 1.0) / 200.0;
            }
        }
        for (covered, off) in covered.iter().zip(off) {
            assert!((180..=198).contains(covered), "{contact:?} {covered}");
            assert!(off.abs() < 3e-3, "{contact:?} {off}");
        }
    }
}
