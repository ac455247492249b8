//! Throughput of runs in force evaluations: one thread, the batch path, energy and distances
//! included.

mod scenes;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use vff_core::laws::VirtualForceField;
use vff_core::laws::field::gains::Gains;
use vff_core::run::{BatchOptions, BatchTable, Options, Width, run_batch, simulate};
use vff_core::world::scenario::Scenario;

fn batch(scenario: &Scenario, law: &VirtualForceField, width: Width) -> BatchTable {
    let options = BatchOptions {
        width: Some(width),
        ..scenes::one_thread()
    };
    let scenarios = std::slice::from_ref(scenario);
    run_batch(
        scenarios,
        law,
        &Gains::one_after_another(&scenes::sets(512)),
        &options,
        &|| false,
        &|_| (),
    )
    .unwrap()
}

fn rollouts(criterion: &mut Criterion) {
    let widths = [
        ("1", Width::One),
        ("4", Width::Four),
        ("8", Width::Eight),
        ("16", Width::Sixteen),
    ];
    for (scene, scenario) in [
        ("c4", scenes::configuration_4()),
        ("always_active", scenes::always_active()),
    ] {
        for mode in ["off", "capped", "full"] {
            let law = scenes::law(mode);
            let mut group = criterion.benchmark_group(format!("batch/{scene}/{mode}"));
            for (name, width) in widths {
                let table = batch(&scenario, &law, width);
                let evaluations: i64 = table.force_evaluations.iter().sum();
                group.throughput(Throughput::Elements(evaluations.unsigned_abs()));
                group.bench_function(name, |bencher| {
                    bencher.iter(|| batch(black_box(&scenario), &law, width));
                });
            }
            group.finish();
        }
    }
    let scenario = scenes::configuration_4();
    let law = scenes::law("off");
    criterion.bench_function("one_recorded_run/c4", |bencher| {
        bencher.iter(|| simulate(black_box(&scenario), law, &Options::default(), &|| false));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = rollouts
}
criterion_main!(benches);
