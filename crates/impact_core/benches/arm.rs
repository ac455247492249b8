//! Effective masses of an arm of six axes: one pose after the other, on one core.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use impact_core::arm::{Arm, Broadcast, Options, Places};
use numeric::parallel::Work;

const POSES: usize = 10_000;

/// Six axes with tilted inertias.
fn urdf() -> String {
    let axes = ["0 0 1", "0 1 0", "0 1 0", "0 1 0", "0 0 1", "0 1 0"];
    let part = |(index, axis): (usize, &&str)| {
        let (mass, next) = (8.0 / (1.0 + index as f64), index + 1);
        format!(
            "<link name=\"l{next}\"><inertial><origin xyz=\"0.02 -0.03 0.1\" rpy=\"0.1 0.2 0.3\"/><mass \
             value=\"{mass}\"/><inertia ixx=\"0.04\" ixy=\"0.001\" ixz=\"0\" iyy=\"0.03\" iyz=\"0\" \
             izz=\"0.02\"/></inertial></link><joint name=\"j{next}\" type=\"continuous\"><parent \
             link=\"l{index}\"/><child link=\"l{next}\"/><origin xyz=\"0.05 0.1 0.2\" rpy=\"0 0.1 0\"/><axis \
             xyz=\"{axis}\"/></joint>"
        )
    };
    let parts: String = axes.iter().enumerate().map(part).collect();
    format!("<robot name=\"six\"><link name=\"l0\"/>{parts}</robot>")
}

fn masses(criterion: &mut Criterion) {
    let Ok(arm) = Arm::from_urdf(&urdf(), &Options::default()) else {
        return;
    };
    let values: Vec<f64> = (0..6 * POSES)
        .map(|index| (0.7 * index as f64).sin() * 3.0)
        .collect();
    let (moving, still) = ([1], [0]);
    let shape = [POSES];
    let places = Places {
        link: 6,
        joints: Broadcast {
            rows: &values,
            width: 6,
            strides: &moving,
        },
        points: Broadcast {
            rows: &[0.0, 0.0, 0.1],
            width: 3,
            strides: &still,
        },
        shape: &shape,
        check_limits: true,
    };
    let directions = Broadcast {
        rows: &[0.6, -0.48, 0.64],
        width: 3,
        strides: &still,
    };
    let work = Work {
        threads: Some(1),
        interrupted: &|| false,
        progress: &|_| (),
    };
    let mut group = criterion.benchmark_group("effective_mass");
    group.throughput(Throughput::Elements(POSES as u64));
    group.bench_function("six axes", |bencher| {
        bencher.iter(|| arm.effective_masses(black_box(&places), &directions, work));
    });
    group.finish();
}

criterion_group!(benches, masses);
criterion_main!(benches);
