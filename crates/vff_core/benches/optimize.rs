//! The search over gains of Zeng (2011), C.2, in wall time, with what it finds beside; and whole
//! episodes with all metrics.

mod scenes;

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use vff_core::laws::field::gains::Gains;
use vff_core::robots::HolonomicRobot;
use vff_core::run::metrics::Weights;
use vff_core::run::{BatchOptions, BatchTable, Instructions, Options, Outcome, run_batch};
use vff_core::search::{
    Bounds, GainOptions, GainProblem, GlobalMethod, GlobalOptions, GridOptions, LocalOptions,
    Metric, Objective, Over, Robustness, Search, SearchOptions, evaluate_all, global_search,
    local_search, search,
};
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

/// The gains of the source.
const PUBLISHED: [f64; 4] = [4.3, 20.3, 240.7, 0.68];

/// Mean of H over configurations 1 to 3; force held for 0.06 s, motion steps of 0.01 s.
fn problem() -> GainProblem {
    let scenarios = [1, 2, 3].map(scenes::configuration).to_vec();
    let options = GainOptions {
        run: Options::default(),
        weights: Weights::EQUAL,
        objectives: vec![Objective {
            metric: Metric::Performance,
            over: Over::Mean,
        }],
        constraints: Vec::new(),
        require_arrival: true,
        cap_ratios: true,
        time_limit: Some(10.0),
        seeds: Vec::new(),
        robustness: Robustness::Mean,
        width: None,
        instructions: Instructions::Widest,
    };
    GainProblem::new(scenarios, scenes::law("off"), options).unwrap()
}

fn bounds() -> Bounds {
    Bounds::new(vec![0.0; 4], vec![50.0, 200.0, 500.0, 3.0]).unwrap()
}

/// Four grids of 77,616 points, with or without the 20 local searches; nothing is remembered
/// from an earlier search.
fn appendix_c(local: bool, threads: usize) -> Search {
    let options = SearchOptions {
        grid: GridOptions {
            shape: vec![11, 21, 21, 16],
            refinements: 3,
            survivors: 500,
            keep: 20,
        },
        local: local.then(LocalOptions::default),
        threads: Some(threads),
    };
    search(&problem(), &bounds(), &options, &(), None).unwrap()
}

fn searches(criterion: &mut Criterion) {
    let published = evaluate_all(&problem(), &PUBLISHED, None, &|| false).unwrap();
    println!("published gains: H {:.6}", published.values[0]);
    let mut group = criterion.benchmark_group("appendix_c");
    for (name, local) in [("grids", false), ("whole", true)] {
        for threads in [1, 2] {
            let found = appendix_c(local, threads);
            let best = found.best.unwrap();
            println!(
                "{name}, {threads} threads: H {:.6} at {:?}, {} evaluations, {} failures",
                best.score.value, best.point, found.evaluations, found.failures
            );
            group.bench_function(format!("{name}/{threads}"), |bencher| {
                bencher.iter(|| appendix_c(black_box(local), threads));
            });
        }
    }
    group.finish();
}

fn one_local_search(criterion: &mut Criterion) {
    let problem = problem();
    let start = [vec![10.1, 86.0, 500.0, 0.544]];
    let run = || {
        let options = LocalOptions::default();
        local_search(&problem, &bounds(), &start, &options, Some(1), &(), None).unwrap()
    };
    let found = &run()[0];
    println!(
        "local search: H {:.6} -> {:.6}, {} evaluations",
        found.start.score.value, found.best.score.value, found.evaluations
    );
    criterion.bench_function("local_search", |bencher| bencher.iter(run));
}

fn global_methods(criterion: &mut Criterion) {
    let problem = problem();
    for (name, method) in [
        (
            "differential_evolution",
            GlobalMethod::DifferentialEvolution,
        ),
        ("cma_es", GlobalMethod::CmaEs),
    ] {
        let run = || {
            let options = GlobalOptions {
                method,
                evaluations: 20_000,
                islands: 16,
                seed: 0,
                threads: Some(2),
            };
            global_search(&problem, &bounds(), &options, &(), None).unwrap()
        };
        let best = run().best.unwrap();
        println!("{name}, 20,000 evaluations: H {:.6}", best.score.value);
        criterion.bench_function(&format!("global/{name}"), |bencher| bencher.iter(run));
    }
}

/// Ten meters past three moving obstacles.
fn among_three() -> Scenario {
    let disc = |center, velocity| {
        let motion = Motion::moving(center, velocity, [0.0; 2], None).unwrap();
        let limits = Limits {
            active_radius: Some(1.2),
            critical_radius: Some(0.55),
            max_speed: None,
        };
        Obstacle::disc(0.2, motion, limits).unwrap()
    };
    let obstacles = vec![
        disc([7.0, 1.5], [0.0, -0.3]),
        disc([4.0, -2.5], [0.05, 0.3]),
        disc([0.0, 0.3], [0.4, 0.0]),
    ];
    let rules = Rules {
        time_limit: 30.0,
        ..Rules::default()
    };
    let robot = HolonomicRobot::default();
    Scenario::new(robot, [10.0, 0.0], [0.0, 0.0], obstacles, rules).unwrap()
}

fn episodes(criterion: &mut Criterion) {
    let scenario = [among_three()];
    let sets = scenes::sets(20_000);
    let batch = |threads| -> BatchTable {
        let options = BatchOptions {
            run: Options {
                step: 0.06,
                ..Options::default()
            },
            threads: Some(threads),
            ..scenes::one_thread()
        };
        let law = scenes::law("off");
        run_batch(
            &scenario,
            law,
            &Gains::one_after_another(&sets),
            &options,
            &|| false,
            &|_| (),
        )
        .unwrap()
    };
    let table = batch(1);
    let arrived = table.outcome.iter().filter(|end| **end == Outcome::Arrived);
    let length = table.path_length.iter().sum::<f64>() / table.len() as f64;
    println!(
        "episodes: {} of {} arrived, {length:.2} m on average",
        arrived.count(),
        table.len()
    );
    let mut group = criterion.benchmark_group("episodes");
    group.throughput(Throughput::Elements(table.len() as u64));
    for threads in [1, 2] {
        group.bench_function(format!("three_moving/{threads}"), |bencher| {
            bencher.iter(|| batch(black_box(threads)));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(8));
    targets = searches, one_local_search, global_methods, episodes
}
criterion_main!(benches);
