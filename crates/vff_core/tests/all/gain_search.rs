//! The search over gains on a small grid, and the problem that it is.

use crate::configurations::{crossing, law, obstacles};
use crate::functions::grid;
use vff_core::error::Failure;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::run::metrics::Weights;
use vff_core::run::{BatchOptions, Instructions, Options, Outcome, Width, run_batch};
use vff_core::search::{
    Bounds, FEASIBILITY, GainOptions, GainProblem, Limit, LocalOptions, Metric, MetricConstraint,
    Objective, Over, Problem, Robustness, Search, SearchOptions, arrival_margin, evaluate_all,
    search,
};
use vff_core::sensing::measurement::{Distribution, Measurement, Noisy};
use vff_core::world::scenario::{Rules, Scenario};

/// The optimum of appendix C of the source.
const PUBLISHED: [f64; 4] = [4.3, 20.3, 240.7, 0.68];

/// Configurations with a time limit and a coarse motion step, so that an unoptimized build is
/// quick.
fn scenarios(numbers: &[usize]) -> Vec<Scenario> {
    let rules = Rules {
        time_limit: 10.0,
        ..Rules::default()
    };
    let of = |number: &usize| crossing(obstacles(*number), rules);
    numbers.iter().map(of).collect()
}

fn mean_performance() -> GainOptions {
    GainOptions {
        run: Options {
            step: 0.06,
            ..Options::default()
        },
        weights: Weights::EQUAL,
        objectives: vec![Objective {
            metric: Metric::Performance,
            over: Over::Mean,
        }],
        constraints: Vec::new(),
        require_arrival: false,
        cap_ratios: false,
        time_limit: None,
        seeds: Vec::new(),
        robustness: Robustness::Mean,
        width: None,
        instructions: Instructions::Widest,
    }
}

fn gain_problem(numbers: &[usize], options: GainOptions) -> GainProblem {
    let law = law(PUBLISHED, Stabilizing::Off);
    GainProblem::new(scenarios(numbers), law, options).unwrap()
}

/// The box of the source.
fn source_box() -> Bounds {
    Bounds::new(vec![0.0; 4], vec![50.0, 200.0, 500.0, 3.0]).unwrap()
}

/// A coarse version of the source's first grid; the free gains vary slowest.
fn coarse_points() -> Vec<f64> {
    let mut points = Vec::new();
    for attractive in [0.0, 2.0, 5.0, 10.0, 50.0] {
        for ratio in [0.0, 0.2, 0.6, 3.0] {
            for repulsive in [0.0, 20.0, 80.0, 200.0] {
                for detour in [0.0, 25.0, 50.0, 100.0, 175.0, 250.0, 350.0, 425.0, 500.0] {
                    points.extend([attractive, repulsive, detour, ratio]);
                }
            }
        }
    }
    points
}

#[test]
fn shortcuts_change_no_score() {
    let numbers = [1, 2, 3];
    let points = coarse_points();
    let problem = gain_problem(&numbers, mean_performance());
    let found = evaluate_all(&problem, &points, Some(2), &|| false).unwrap();
    let sets: Vec<Gains> = points
        .as_chunks::<4>()
        .0
        .iter()
        .map(|set| Gains::of(*set))
        .collect();
    let options = BatchOptions {
        run: Options {
            stop_on_contact: true,
            ..mean_performance().run
        },
        weights: Weights::EQUAL,
        descent: false,
        threads: Some(2),
        width: None,
        instructions: Instructions::Widest,
    };
    let law = law(PUBLISHED, Stabilizing::Off);
    let all = scenarios(&numbers);
    let table = run_batch(
        &all,
        law,
        &Gains::one_after_another(&sets),
        &options,
        &|| false,
        &|_| (),
    )
    .unwrap();
    let mut failures = 0;
    for (set, value) in found.values.iter().enumerate() {
        let rows = 3 * set..3 * set + 3;
        let mean = table.performance_total[rows.clone()].iter().sum::<f64>() / 3.0;
        assert_eq!(value.to_bits(), mean.to_bits(), "{:?}", sets[set]);
        let failed = table.outcome[rows]
            .iter()
            .any(|end| *end != Outcome::Arrived);
        assert_eq!(found.failed[set], failed, "{:?}", sets[set]);
        failures += u32::from(failed);
    }
    assert!((50..600).contains(&failures), "{failures}");
}

#[test]
fn neither_threads_nor_lanes_change_a_bit_of_the_search() {
    let options = |threads| SearchOptions {
        local: Some(LocalOptions {
            starts: 3,
            evaluations: 25,
            ..LocalOptions::default()
        }),
        threads: Some(threads),
        ..grid(&[3, 3, 4, 3], 1, 12)
    };
    let run = |width, instructions, threads| -> Search {
        let problem = gain_problem(
            &[1, 2],
            GainOptions {
                width,
                instructions,
                ..mean_performance()
            },
        );
        search(&problem, &source_box(), &options(threads), &(), None).unwrap()
    };
    let first = run(Some(Width::One), Instructions::Baseline, 1);
    assert_eq!(
        first.evaluations - 216,
        first.local.iter().map(|one| one.evaluations).sum::<u64>()
    );
    for (width, instructions, threads) in [
        (None, Instructions::Widest, 2),
        (Some(Width::Four), Instructions::Baseline, 2),
        (Some(Width::Eight), Instructions::Widest, 1),
        (Some(Width::Sixteen), Instructions::Baseline, 2),
    ] {
        assert_eq!(run(width, instructions, threads), first);
    }
}

#[test]
fn the_search_beats_the_published_gains() {
    let problem = gain_problem(&[1, 2, 3], mean_performance());
    let value = |set: &[f64]| {
        let found = evaluate_all(&problem, set, None, &|| false).unwrap();
        found.values[0]
    };
    let options = SearchOptions {
        local: Some(LocalOptions {
            starts: 2,
            evaluations: 60,
            ..LocalOptions::default()
        }),
        ..grid(&[4, 4, 5, 4], 2, 30)
    };
    let found = search(&problem, &source_box(), &options, &(), None).unwrap();
    let best = found.best.unwrap();
    // The full grid gains 0.009; this one must come near.
    assert!(best.score.value > value(&PUBLISHED) + 0.006, "{best:?}");
    assert_eq!(best.score.value, value(&best.point));
    assert!(best.score.value >= found.top[0].score.value);
    for local in &found.local {
        assert!(!local.start.score.better(&local.best.score));
    }
}

#[test]
fn a_clearance_that_is_asked_for_is_active_at_the_optimum() {
    // The optimum for time alone passes the disc nearer than this.
    let least = 0.33;
    let clearance = |constraints: Vec<MetricConstraint>, metric, over| {
        gain_problem(
            &[1],
            GainOptions {
                objectives: vec![Objective { metric, over }],
                constraints,
                ..mean_performance()
            },
        )
    };
    let asked = MetricConstraint {
        metric: Metric::MinClearance,
        limit: Limit::AtLeast(least),
        scenario: Some(0),
    };
    let time = |constraints| clearance(constraints, Metric::ArrivalTime, Over::Scenario(0));
    let options = SearchOptions {
        local: Some(LocalOptions {
            starts: 4,
            evaluations: 150,
            ..LocalOptions::default()
        }),
        ..grid(&[5, 5, 6, 5], 2, 40)
    };
    let bounds = source_box();
    let free = search(&time(vec![]), &bounds, &options, &(), None).unwrap();
    let kept = search(&time(vec![asked]), &bounds, &options, &(), None).unwrap();
    let (free, kept) = (free.best.unwrap(), kept.best.unwrap());
    let measured = |set: &[f64]| {
        let problem = clearance(vec![], Metric::MinClearance, Over::Worst);
        evaluate_all(&problem, set, None, &|| false).unwrap().values[0]
    };
    assert!(measured(&free.point) < least - 0.01);
    assert!(kept.score.feasible() && measured(&kept.point) >= least - FEASIBILITY);
    assert!(
        measured(&kept.point) < least + 5e-3,
        "{}",
        measured(&kept.point)
    );
    assert!(kept.score.value < free.score.value);
}

#[test]
fn order_and_company_change_no_value() {
    let problem = || gain_problem(&[1, 2], mean_performance());
    let shuffled: Vec<f64> = (0..60)
        .flat_map(|k: u32| {
            let part = |count: u32| f64::from(k * 7 % count);
            [
                part(5) * 2.5,
                part(3) * 40.0,
                part(4) * 120.0,
                part(2) * 0.5,
            ]
        })
        .collect();
    let together = evaluate_all(&problem(), &shuffled, Some(2), &|| false).unwrap();
    let remembering = problem();
    for (index, set) in shuffled.chunks_exact(4).enumerate() {
        for problem in [&problem(), &remembering] {
            let alone = evaluate_all(problem, set, None, &|| false).unwrap();
            assert_eq!(alone.values[0].to_bits(), together.values[index].to_bits());
            assert_eq!(alone.failed[0], together.failed[index]);
        }
    }
}

#[test]
fn objectives_are_put_together_as_they_say() {
    let objectives = [Over::Mean, Over::Worst, Over::Scenario(1)].map(|over| Objective {
        metric: Metric::ArrivalTime,
        over,
    });
    let energy = Objective {
        metric: Metric::Energy,
        over: Over::Scenario(0),
    };
    let problem = gain_problem(
        &[1, 2],
        GainOptions {
            objectives: [&objectives[..], &[energy]].concat(),
            constraints: vec![MetricConstraint {
                metric: Metric::ArrivalTime,
                limit: Limit::AtMost(7.0),
                scenario: None,
            }],
            ..mean_performance()
        },
    );
    assert_eq!((problem.episodes_per_point(), problem.objectives()), (2, 4));
    let points = [PUBLISHED, [0.0, 20.0, 20.0, 0.5]].concat();
    let found = evaluate_all(&problem, &points, None, &|| false).unwrap();
    let law = law(PUBLISHED, Stabilizing::Off);
    let options = BatchOptions {
        run: mean_performance().run,
        weights: Weights::EQUAL,
        descent: false,
        threads: None,
        width: None,
        instructions: Instructions::Widest,
    };
    let all = scenarios(&[1, 2]);
    let table = run_batch(
        &all,
        law,
        &law.gains.in_order(),
        &options,
        &|| false,
        &|_| (),
    )
    .unwrap();
    let [first, second] = [table.arrival_time[0], table.arrival_time[1]];
    let slower = first.max(second);
    let expected = [-(first + second) / 2.0, -slower, -second, -table.energy[0]];
    assert_eq!(found.values[..4], expected);
    assert_eq!(found.margins[0], 7.0 - slower);
    // A robot without attraction never arrives.
    assert!(
        found.values[4..]
            .iter()
            .all(|value| *value == f64::NEG_INFINITY)
    );
    assert!(found.margins[1].is_nan());
    assert_eq!(found.failed, [false, true]);
}

#[test]
fn arrival_is_one_more_constraint_that_counts_runs() {
    let problem = gain_problem(
        &[1, 2, 3],
        GainOptions {
            constraints: vec![MetricConstraint {
                metric: Metric::ArrivalTime,
                limit: Limit::AtMost(9.0),
                scenario: Some(0),
            }],
            require_arrival: true,
            ..mean_performance()
        },
    );
    assert_eq!(problem.constraints(), 2);
    let points = [PUBLISHED, [0.0, 20.0, 20.0, 0.5]].concat();
    let found = evaluate_all(&problem, &points, None, &|| false).unwrap();
    assert_eq!(found.failed, [false, true]);
    // The last margin of each: all arrive, and none of three.
    assert_eq!([found.margins[1], found.margins[3]], [1.0, -3.0]);
    assert_eq!(arrival_margin(0), 1.0);
}

#[test]
fn seeds_are_put_together_with_their_standard_error() {
    let noise = Measurement::new(0.01, Distribution::Uniform, Noisy::Obstacles).unwrap();
    let noisy: Vec<Scenario> = scenarios(&[2, 4])
        .into_iter()
        .map(|scenario| scenario.measured(Some(noise), 0).unwrap())
        .collect();
    let value = |seeds: Vec<u64>, robustness| {
        let options = GainOptions {
            seeds,
            robustness,
            ..mean_performance()
        };
        let law = law(PUBLISHED, Stabilizing::Off);
        let problem = GainProblem::new(noisy.clone(), law, options).unwrap();
        evaluate_all(&problem, &PUBLISHED, None, &|| false)
            .unwrap()
            .values[0]
    };
    let single: Vec<f64> = (1..=4)
        .map(|seed| value(vec![seed], Robustness::Mean))
        .collect();
    let mean = single.iter().sum::<f64>() / 4.0;
    let together = value(vec![1, 2, 3, 4], Robustness::Mean);
    assert!((together - mean).abs() < 1e-15);
    assert!(single.iter().any(|own| *own != mean));
    let lower = value(vec![1, 2, 3, 4], Robustness::LowerBound { factor: 1.0 });
    let twice = value(vec![1, 2, 3, 4], Robustness::LowerBound { factor: 2.0 });
    assert!(lower < together);
    assert!(((together - twice) / (together - lower) - 2.0).abs() < 1e-9);
}

#[test]
fn gain_options_out_of_range_are_refused() {
    let make = |numbers: &[usize], options: GainOptions| {
        let law = law(PUBLISHED, Stabilizing::Off);
        GainProblem::new(scenarios(numbers), law, options)
    };
    let objective = |metric, over| GainOptions {
        objectives: vec![Objective { metric, over }],
        ..mean_performance()
    };
    assert!(make(&[], mean_performance()).is_err());
    assert!(make(&[1], objective(Metric::Energy, Over::Scenario(1))).is_err());
    let none = GainOptions {
        objectives: vec![],
        ..mean_performance()
    };
    assert!(make(&[1], none).is_err());
    let limit = GainOptions {
        time_limit: Some(0.0),
        ..mean_performance()
    };
    assert!(make(&[1], limit).is_err());
    let open = crossing(vec![], Rules::default());
    let law = law(PUBLISHED, Stabilizing::Off);
    let clear = objective(Metric::MinClearance, Over::Mean);
    assert!(GainProblem::new(vec![open], law, clear).is_err());
    let problem = make(&[1], mean_performance()).unwrap();
    let bad = evaluate_all(&problem, &[1.0, -1.0, 1.0, 1.0], None, &|| false);
    assert!(matches!(bad, Err(Failure::InvalidParameter(_))));
    let stopped = evaluate_all(&problem, &PUBLISHED, None, &|| true);
    assert_eq!(stopped, Err(Failure::Interrupted));
    for metric in Metric::ALL {
        assert_eq!(Metric::of(metric.word()).unwrap(), metric);
    }
    assert!(Metric::of("speed").is_err());
}
