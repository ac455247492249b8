//! Simulated time per second of computing, one thread: robots as built, wheels every millisecond.

mod scenes;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use vff_core::robots::wheels::{differential_wheels, holonomic_wheels};
use vff_core::robots::{DifferentialDriveRobot, HolonomicRobot};
use vff_core::run::AnyLaw;
use vff_core::run::as_built::{AsBuilt, simulate_as_built};
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

const START: [f64; 2] = [3.99, 0.6];
const GOAL: [f64; 2] = [0.0, 0.6];

fn disc() -> Vec<Obstacle> {
    let limits = Limits {
        critical_radius: Some(0.4),
        active_radius: Some(0.65),
        max_speed: None,
    };
    vec![Obstacle::disc_at_rest([2.16, 0.6], 0.1, limits).unwrap()]
}

/// Throughput in milliseconds of simulated time: 1 M elements/s is 1000 times real time.
fn runs(criterion: &mut Criterion) {
    let rules = Rules {
        heading: std::f64::consts::PI,
        ..Rules::default()
    };
    let omni = Scenario::new(HolonomicRobot::default(), START, GOAL, disc(), rules).unwrap();
    let two = DifferentialDriveRobot::default();
    let two = Scenario::for_differential(two, START, GOAL, disc(), rules).unwrap();
    let law: AnyLaw = scenes::law("off").into();
    let mut group = criterion.benchmark_group("built");
    for (name, scenario, wheels) in [
        ("point mass", &omni, None),
        ("omni-wheels", &omni, Some(holonomic_wheels().to_vec())),
        ("two ideal wheels", &two, None),
        ("two wheels", &two, Some(differential_wheels().to_vec())),
    ] {
        let built = AsBuilt {
            wheels,
            ..AsBuilt::default()
        };
        let run = || simulate_as_built(scenario, &law, &built, &|| false);
        let milliseconds = (1000.0 * run().unwrap().0.end_time).round();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some thousands
        group.throughput(Throughput::Elements(milliseconds as u64));
        group.bench_function(name, |bencher| bencher.iter(|| black_box(run().unwrap())));
    }
    group.finish();
}

criterion_group!(benches, runs);
criterion_main!(benches);
