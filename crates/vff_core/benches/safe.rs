//! Safe navigation: episodes of twelve drifting discs on one thread, and single decisions of shield and
//! yielding among twelve people, and of filters among three.

mod scenes;

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use numeric::random::Stream;
use vff_core::lanes::Vector2;
use vff_core::laws::filters::{
    ApproachMonitor, Barrier, BarrierUnicycle, CollisionCone, Filter, Near, ResponsibilityRule,
    Sighted, VelocityClamp,
};
use vff_core::laws::safe::SafeNavigation;
use vff_core::laws::shield::{Guard, Person, Shield, ShieldLimits, StaticObstacles, Status, View};
use vff_core::laws::yielding::{Outlook, Passerby, Yielder, Yielding};
use vff_core::robots::HolonomicRobot;
use vff_core::run::{AnyLaw, BatchOptions, BatchTable, Options, run_batch};
use vff_core::world::geometry::RobotState;
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::{Limits as Regions, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

/// Episodes of one round.
const EPISODES: usize = 100;

/// Discs of 0.3 m that drift straight on between start and goal, as the protocol S5 has them.
fn drifting(fastest: f64) -> Vec<Scenario> {
    let robot = HolonomicRobot {
        radius: 0.3,
        max_speed: fastest,
        max_acceleration: 10.0,
        ..HolonomicRobot::default()
    };
    let rules = Rules {
        control_period: 0.1,
        time_limit: 15.0,
        rest_time: 15.0,
        arrival_tolerance: 0.3,
        ..Rules::default()
    };
    let mut stream = Stream::new(1, 0);
    let mut scene = || {
        let discs = (0..12).map(|_| {
            let place = [stream.uniform(2.0, 9.0), stream.uniform(-3.0, 3.0)];
            let (speed, course) = (stream.unit(), stream.uniform(-PI, PI));
            let velocity = [speed * course.cos(), speed * course.sin()];
            let motion = Motion::moving(place, velocity, [0.0; 2], None).unwrap();
            Obstacle::disc(0.3, motion, Regions::default()).unwrap()
        });
        let discs = discs.collect();
        Scenario::new(robot, [0.0, 0.0], [10.0, 0.0], discs, rules).unwrap()
    };
    (0..EPISODES).map(|_| scene()).collect()
}

fn field() -> AnyLaw {
    scenes::law("off").into()
}

fn guarded(yields: bool) -> AnyLaw {
    SafeNavigation {
        shield: Some(Shield {
            person_speed: Some(1.0),
            ..Shield::default()
        }),
        yielding: yields.then(Yielding::default),
        takeover: yields,
        preferred_speed: Some(1.0),
        critical_distance: Some(0.02),
        ..SafeNavigation::bare(field())
    }
    .into()
}

fn run(worlds: &[Scenario], law: &AnyLaw) -> BatchTable {
    let options = BatchOptions {
        run: Options {
            stop_on_contact: true,
            ..Options::default()
        },
        ..scenes::one_thread()
    };
    run_batch(worlds, law, &law.gains(), &options, &|| false, &|_| ()).unwrap()
}

fn episodes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("safe/episodes among twelve");
    group.throughput(Throughput::Elements(EPISODES as u64));
    for (name, law, fastest) in [
        ("field", field(), 1.0),
        ("shield", guarded(false), 1.5),
        ("shield and yielding", guarded(true), 1.5),
    ] {
        let worlds = drifting(fastest);
        let table = run(&worlds, &law);
        let bits = |sum: u64, time: &f64| sum.wrapping_mul(31).wrapping_add(time.to_bits());
        let (times, energies) = (table.arrival_time.iter(), table.energy.iter());
        println!("{name}: {:x}", times.chain(energies).fold(0, bits));
        group.bench_function(name, |bencher| {
            bencher.iter(|| run(black_box(&worlds), &law));
        });
    }
    group.finish();
}

const LIMITS: ShieldLimits = ShieldLimits {
    radius: 0.3,
    max_speed: 1.5,
    max_acceleration: 10.0,
    period: 0.1,
};

/// Twelve people around a robot, at a distance in m.
fn ring(distance: f64) -> impl Iterator<Item = Vector2<f64>> {
    (0..12).map(move |index| {
        let angle = f64::from(index) * TAU / 12.0;
        Vector2::new(angle.cos(), angle.sin()) * distance
    })
}

fn robot() -> RobotState<f64> {
    RobotState {
        position: Vector2::zeros(),
        velocity: Vector2::new(0.3, 0.0),
    }
}

fn decisions(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("safe/decision among twelve");
    let guard = Guard::new(Shield::default(), LIMITS).unwrap();
    for (name, distance, speed, status) in [
        ("shield, verified", 6.0, 0.4, Status::Kept),
        ("shield, verified near", 2.0, 0.4, Status::Kept),
        ("shield, searched", 1.2, 1.4, Status::Changed),
        ("shield, nothing but rest", 0.9, 0.4, Status::Changed),
    ] {
        let wanted = Vector2::new(speed, 0.0);
        let people: Vec<Person> = ring(distance)
            .map(|place| Person::disc(place.into(), 0.3))
            .collect();
        let view = View {
            robot: robot(),
            people: &people,
            walls: StaticObstacles::NONE,
            hidden: None,
        };
        let decision = guard.decide(&view, wanted);
        assert_eq!(decision.status, status, "{name}");
        println!("{name}: {:?}", decision.velocity);
        group.bench_function(name, |bencher| {
            bencher.iter(|| guard.decide(black_box(&view), wanted));
        });
    }
    let yielder = Yielder::new(Yielding::default(), LIMITS).unwrap();
    let people: Vec<Passerby> = ring(3.0)
        .map(|offset| Passerby {
            offset,
            velocity: Vector2::new(-0.3 * offset.y, 0.2 * offset.x),
            touch: 0.6,
        })
        .collect();
    let outlook = Outlook {
        robot: robot(),
        wanted: Vector2::new(0.4, 0.0),
        to_goal: Vector2::x(),
        people: &people,
        left_out: false,
        walls: StaticObstacles::NONE,
    };
    group.bench_function("yielding", |bencher| {
        bencher.iter(|| yielder.decide(black_box(&outlook), |_| true));
    });
    group.finish();
}

/// Filters among three people and two walls.
fn filtering(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("safe/filter among three");
    group.throughput(Throughput::Elements(1));
    let people = [
        [1.5, 0.4, -0.8, 0.0],
        [0.9, -1.2, 0.0, 0.9],
        [2.5, 1.0, -0.3, -0.7],
    ]
    .map(|row| Near {
        position: Vector2::new(row[0], row[1]),
        velocity: Vector2::new(row[2], row[3]),
        radius: 0.25,
    });
    let points = [Vector2::new(0.2, 0.8), Vector2::new(0.2, -0.7)];
    let seen = Sighted {
        position: Vector2::zeros(),
        velocity: Vector2::new(0.8, 0.0),
        heading: 0.0,
        radius: 0.25,
        max_speed: 1.0,
        max_acceleration: Some(3.0),
        max_turn_rate: 1.5,
        period: 0.1,
        people: &people,
        points: &points,
    };
    for (name, filter) in [
        (
            "barrier",
            Filter::Barrier(Barrier {
                rate: 1.0,
                margin: 0.0,
            }),
        ),
        (
            "barrier of wheels",
            Filter::BarrierUnicycle(BarrierUnicycle {
                rate: 1.0,
                ahead: 0.1,
                margin: 0.0,
            }),
        ),
        (
            "collision cone",
            Filter::CollisionCone(CollisionCone {
                rate: 1.0,
                margin: 0.0,
            }),
        ),
        (
            "velocity clamp",
            Filter::VelocityClamp(VelocityClamp {
                horizon: 3.0,
                margin: 0.0,
            }),
        ),
        (
            "responsibility rule",
            Filter::ResponsibilityRule(ResponsibilityRule {
                reaction_time: 0.2,
                acceleration: 1.0,
                braking: 2.0,
                person_acceleration: 0.0,
                person_braking: 1.5,
                margin: 0.0,
            }),
        ),
        (
            "approach monitor",
            Filter::ApproachMonitor(ApproachMonitor {
                time_before_collision: 1.2,
                simulation_time_step: 0.1,
                margin: 0.0,
            }),
        ),
    ] {
        let wanted = Vector2::new(1.0, 0.1);
        println!("{name}: {:?}", filter.decide(&seen, wanted, 0.0));
        group.bench_function(name, |bencher| {
            bencher.iter(|| filter.decide(black_box(&seen), black_box(wanted), 0.0));
        });
    }
    group.finish();
}

criterion_group!(benches, episodes, decisions, filtering);
criterion_main!(benches);
