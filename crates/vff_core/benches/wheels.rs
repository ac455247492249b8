//! Time of one wheel period: the real time that it simulates is a millisecond.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use vff_core::robots::wheels::{
    Feedback, OmniKinematics, WheelLoop, WheelReference, WheelWish, holonomic_wheels,
};

/// Wheel periods in one measurement: a second.
const PERIODS: u64 = 1000;

fn sine() -> Vec<WheelWish> {
    let mut reference = WheelReference::new(1e-3);
    let speeds = (0..2 * PERIODS).map(|index| 1e-3 * std::f64::consts::PI * index as f64);
    speeds.map(|phase| reference.next(phase.sin())).collect()
}

fn wheel_loops(criterion: &mut Criterion) {
    let wishes = sine();
    let mut group = criterion.benchmark_group("one second of a wheel at 1 ms");
    group.throughput(Throughput::Elements(PERIODS));
    let poles = [-10.0, -10.0];
    for (name, feedback) in [
        ("observer", Feedback::Observer { poles }),
        ("differences", Feedback::Differences),
    ] {
        let mut drive = holonomic_wheels()[0];
        drive.controller.feedback = feedback;
        group.bench_function(name, |bencher| {
            let (mut wheel, mut next) = (WheelLoop::new(&drive), 0);
            bencher.iter(|| {
                let mut energy = 0.0;
                for _ in 0..PERIODS {
                    energy += wheel.step(black_box(&wishes[next])).energy;
                    next = (next + 1) % wishes.len();
                }
                energy
            });
        });
    }
    group.finish();
}

fn robots(criterion: &mut Criterion) {
    let kinematics = OmniKinematics::default();
    let drives = holonomic_wheels();
    criterion.bench_function(
        "one second of three wheels with kinematics at 1 ms",
        |bencher| {
            bencher.iter(|| {
                let mut wheels = drives.map(|drive| WheelLoop::new(&drive));
                let mut references = drives.map(|drive| WheelReference::new(drive.period));
                let mut covered = 0.0;
                for index in 0..PERIODS {
                    let speed = 1e-3 * index as f64;
                    let wanted =
                        kinematics.wheel_speeds(black_box([0.5 * speed, 0.2 * speed, 0.1]));
                    let mut turning = [0.0; 3];
                    for wheel in 0..3 {
                        let wish = references[wheel].next(wanted[wheel]);
                        turning[wheel] = wheels[wheel].step(&wish).speed;
                    }
                    covered += 1e-3 * kinematics.body_velocity(turning)[0];
                }
                covered
            });
        },
    );
}

criterion_group!(benches, wheel_loops, robots);
criterion_main!(benches);
