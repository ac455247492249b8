//! One evaluation of the force field, three active obstacles: a person, a rectangle and a disc, or
//! three discs.

mod scenes;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use vff_core::lanes::{Lanes, Planar, Real, Vector2};
use vff_core::laws::field::gains::GainLanes;
use vff_core::laws::{ForceFieldLaw, Law, Scan, Situation, Stop};
use vff_core::world::geometry::{Body, RobotState};
use vff_core::world::scenario::Scenario;

fn bodies<R: Real>(scenario: &Scenario) -> Vec<Body<R>> {
    let body = |placed: &vff_core::world::scenario::PlacedObstacle| Body {
        shape: placed.obstacle.shape,
        regions: placed.regions,
        state: placed.obstacle.motion.at(1.0, &mut 0),
    };
    let bodies = scenario.obstacles().iter().map(body);
    bodies.map(|body| body.widened()).collect()
}

fn width<R: Real>(
    criterion: &mut Criterion,
    name: &str,
    (scene, scenario): (&str, &Scenario),
    mode: &str,
) {
    let bodies = bodies(scenario);
    let sets = scenes::sets(16);
    let gains = GainLanes::<R>::gather(sets[0], &sets[1..]);
    let mut law = ForceFieldLaw::<R, false>::new(&scenes::law(mode), gains, scenario);
    // Inside every active region of both scenes and outside every critical one.
    let robot = RobotState {
        position: Vector2::new(R::from_fn(|lane| 2.6 + 0.01 * lane as f64), R::splat(0.75)),
        velocity: Vector2::splat([-0.6, 0.1]),
    };
    let mut group = criterion.benchmark_group(format!("forces/{scene}/{mode}"));
    group.throughput(Throughput::Elements(R::WIDTH as u64));
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            let situation = Situation {
                time: R::zero(),
                ages: &[],
                heading: 0.0,
                bodies: black_box(&bodies),
                robot: black_box(robot),
                interval: 0.06,
                scan: Scan::default(),
                stop: Stop::never(),
            };
            law.command(&situation)
        });
    });
    group.finish();
}

fn forces(criterion: &mut Criterion) {
    for (name, scenario) in [
        ("c4", scenes::configuration_4()),
        ("always_active", scenes::always_active()),
    ] {
        let scene = (name, &scenario);
        for mode in ["off", "capped", "full"] {
            width::<f64>(criterion, "1", scene, mode);
            width::<Lanes<8>>(criterion, "8", scene, mode);
        }
    }
}

criterion_group!(benches, forces);
criterion_main!(benches);
