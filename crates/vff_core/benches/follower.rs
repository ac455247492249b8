//! Throughput of runs of the follower on one thread, and of its parts.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use numeric::parallel::Work;
use vff_core::laws::impedance::Form;
use vff_core::run::follower::{
    FollowerOutcome, Layouts, Setting, Settings, run_batch, touching_layouts,
};
use vff_core::sensing::sonar::Beam;
use vff_core::world::frame::Frame;
use vff_core::world::shape::PlacedShape;

const RUNS: usize = 200;

fn one_thread() -> Work<'static> {
    Work {
        threads: Some(1),
        interrupted: &|| false,
        progress: &|_| (),
    }
}

fn settings(setting: Setting, form: Form) -> Settings {
    let mut settings = Settings::default();
    settings.impedance.form = form;
    if setting == Setting::Static {
        settings.impedance.speed_limit = 0.6;
    }
    settings
}

fn runs(criterion: &mut Criterion) {
    let kinds = [
        ("static", Setting::Static),
        ("one_dynamic", Setting::OneDynamic),
        ("two_dynamic", Setting::TwoDynamic),
    ];
    for (kind, setting) in kinds {
        let layouts = Layouts::of(setting);
        let mut group = criterion.benchmark_group(format!("episodes/{kind}"));
        group.throughput(Throughput::Elements(RUNS as u64));
        for (law, form) in [
            ("conventional", Form::Conventional),
            ("active", Form::Active),
        ] {
            let settings = settings(setting, form);
            let seeds = touching_layouts(&settings, &layouts, 0, RUNS, one_thread()).unwrap();
            group.bench_function(law, |bencher| {
                bencher.iter(|| -> Vec<FollowerOutcome> {
                    run_batch(black_box(&settings), &layouts, &seeds, one_thread()).unwrap()
                });
            });
        }
        group.finish();
    }
}

fn beams(criterion: &mut Criterion) {
    let beam = Beam::new(30.0_f64.to_radians(), 13).unwrap();
    let pose = Frame::at([0.2, 0.0], 0.1);
    let shapes = [PlacedShape::upright([2.0, 0.3], [0.8, 0.5])];
    let mut group = criterion.benchmark_group("beam");
    group.bench_function("two rays", |bencher| {
        bencher.iter(|| beam.nearest(black_box(&pose), &shapes, 3.0));
    });
    group.bench_function("every ray", |bencher| {
        bencher.iter(|| {
            let along = beam.every_ray(black_box(&pose), &shapes);
            along.into_iter().fold(f64::INFINITY, f64::min)
        });
    });
    group.finish();
}

criterion_group!(benches, runs, beams);
criterion_main!(benches);
