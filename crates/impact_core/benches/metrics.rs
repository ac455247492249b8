//! Metrics of one impact.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use impact_core::batch::{BatchOptions, FieldSet, Width, metrics_batch};
use impact_core::columns::{Column, Columns, HeadColumns};
use impact_core::criteria::metrics;
use impact_core::metrics::MetricOptions;
use impact_core::parameters::{FOAM_1, HEAD_APPARATUS, MANIPULATOR_1, System, Target};
use std::hint::black_box;

fn one_impact(criterion: &mut Criterion) {
    let system = System {
        manipulator: MANIPULATOR_1,
        foam: FOAM_1,
        head: Target::Free(HEAD_APPARATUS),
    };
    let options = MetricOptions::default();
    criterion.bench_function("metrics", |bencher| {
        bencher.iter(|| metrics(black_box(&system), black_box(1.25), &options));
    });
}

/// Rows of the batches.
const ROWS: usize = 65_536;

fn many_impacts(criterion: &mut Criterion) {
    let spread = |low: f64, high: f64, period: usize| -> Vec<f64> {
        (0..ROWS)
            .map(|row| low + (high - low) * (row % period) as f64 / period as f64)
            .collect()
    };
    let stiffness = spread(10e3, 60e3, 256);
    let damping: Vec<f64> = (0..ROWS)
        .map(|row| 200.0 * (row / 256) as f64 / 256.0)
        .collect();
    let columns = Columns {
        manipulator_mass: Column::Value(9.6),
        manipulator_damping: Column::Value(250.0),
        manipulator_stiffness: Column::Value(20e3),
        foam_stiffness: Column::Array(&stiffness),
        foam_damping: Column::Array(&damping),
        linear_range: Column::Value(0.02),
        head: HeadColumns::Free {
            mass: Column::Value(4.4),
            damping: Column::Value(46.0),
            stiffness: Column::Value(3e3),
        },
        closing_speed: Column::Value(1.25),
        manipulator_speed: None,
    };
    let mut group = criterion.benchmark_group("batch");
    group
        .throughput(Throughput::Elements(ROWS as u64))
        .sample_size(20);
    for (name, fields) in [("all", FieldSet::all()), ("peaks", FieldSet::peaks())] {
        for width in [Width::One, Width::Four, Width::Eight] {
            let options = BatchOptions {
                threads: Some(1),
                width: Some(width),
                fields,
                ..BatchOptions::default()
            };
            group.bench_function(format!("{name}/{width:?}"), |bencher| {
                bencher.iter(|| metrics_batch(&columns, &options, &|| false, &|_| ()));
            });
        }
    }
}

criterion_group!(benches, one_impact, many_impacts);
criterion_main!(benches);
