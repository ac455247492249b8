//! Whole batches in lanes have the rows of runs in `f64`, bit for bit.

use std::fmt::Debug;

use crate::bitwise::computed;
use crate::configurations::{crossing, gains, law, limits, obstacles};
use vff_core::lanes::{Lanes, Number};
use vff_core::laws::VirtualForceField;
use vff_core::laws::field::gains::{GainLanes, Gains};
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::{Cap, Stabilizing};
use vff_core::run::metrics::Weights;
use vff_core::run::{
    BatchOptions, BatchTable, Instructions, Integrator, Options, Outcome, Width, run_batch,
    simulate,
};
use vff_core::sensing::measurement::{Distribution, Measurement, Noisy};
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::Obstacle;
use vff_core::world::scenario::{Rules, Scenario};

const NEW: [f64; 4] = [3.0, 20.0, 17.0, 0.25];

/// The sets of the source, extreme ones, and ordinary ones; their number fits no width.
fn gain_sets() -> Vec<Gains> {
    [
        [3.0, 20.0, 17.0, 0.25],
        [4.3, 20.3, 240.7, 0.68],
        [0.0, 0.0, 0.0, 0.0],
        [3.0, 20.0, 17.0, 0.0],
        [3.0, 0.0, 0.0, 0.25],
        [1e-3, 1e-3, 1e-3, 1e-3],
        [1e3, 1e3, 1e4, 5.0],
        [3.0, 20.0, 1e5, 0.25],
        [0.5, 1e4, 17.0, 2.0],
        [50.0, 0.1, 0.1, 0.01],
        [1e100, 1e-100, 1e100, 1e-100],
        [5.0, 40.0, 60.0, 0.4],
        [2.0, 90.0, 300.0, 0.9],
        [8.0, 5.0, 2.0, 0.1],
        [3.0, 21.0, 18.0, 0.25],
        [3.0, 22.0, 19.0, 0.25],
        [3.0, 23.0, 20.0, 0.25],
        [3.0, 24.0, 21.0, 0.25],
        [3.0, 25.0, 22.0, 0.25],
    ]
    .map(gains)
    .to_vec()
}

#[test]
fn last_gains_fill_the_lanes_that_are_left_over() {
    let sets = gain_sets();
    let lanes = GainLanes::<Lanes<4>>::gather(sets[0], &sets[1..3]);
    for (lane, set) in [0, 1, 2, 2].into_iter().enumerate() {
        assert_eq!(lanes.attractive.lane(lane), sets[set].attractive);
        assert_eq!(lanes.ratio.lane(lane), sets[set].ratio);
    }
}

/// Configurations, exact ties, noise, and somebody who comes and goes.
fn scenarios() -> Vec<Scenario> {
    let rules = Rules {
        time_limit: 9.0,
        rest_time: 1.5,
        heading: 0.3,
        ..Rules::default()
    };
    let noise = |noisy, distribution| Some(Measurement::new(0.01, distribution, noisy).unwrap());
    let disc = |center, radii: [f64; 2]| {
        Obstacle::disc_at_rest(center, 0.1, limits(radii[0], radii[1])).unwrap()
    };
    // Robot, obstacles and goal in line: alone, with one aside that decides, and as a rectangle.
    let alone = vec![disc([2.0, 0.6], [0.4, 0.9])];
    let aside = vec![
        disc([2.4, 0.6], [0.4, 0.9]),
        disc([1.6, 0.6], [0.4, 0.9]),
        disc([2.6, 1.5], [0.3, 1.2]),
    ];
    let wall = vec![Obstacle::rectangle([2.0, 0.6], [0.4, 0.8], 0.0, limits(0.4, 0.9)).unwrap()];
    let times = [1.0, 2.5, 4.0];
    let passer = Motion::recorded(&times, &[[2.0, 2.0], [2.1, 0.5], [2.0, -1.0]]).unwrap();
    let passing = vec![Obstacle::disc(0.4, passer, limits(0.8, 2.1)).unwrap()];
    let mut all: Vec<Scenario> = (1..=4)
        .map(|number| crossing(obstacles(number), rules))
        .collect();
    all.extend([alone, aside, wall, passing].map(|obstacles| crossing(obstacles, rules)));
    for (seed, noisy, distribution) in [
        (3, Noisy::Obstacles, Distribution::Uniform),
        (4, Noisy::Robot, Distribution::Gaussian),
        (5, Noisy::Both, Distribution::Uniform),
    ] {
        let measured = crossing(obstacles(4), rules)
            .measured(noise(noisy, distribution), seed)
            .unwrap();
        all.push(measured);
    }
    all
}

/// Every number of every row as bits, every word as text.
fn bits(table: &BatchTable) -> Vec<(String, Vec<u64>)> {
    let row = |row: usize| {
        let words = format!(
            "{:?} {} {:?}",
            table.outcome[row],
            table.force_evaluations[row],
            [
                table.entered_active[row],
                table.contacts_moving[row],
                table.contacts_standing[row]
            ]
        );
        let columns = [
            &table.end_time,
            &table.arrival_time,
            &table.energy,
            &table.path_length,
            &table.descent_share,
            &table.min_clearance,
            &table.performance_total,
            &table.performance_arrival_time,
            &table.performance_avoidance,
            &table.performance_energy_saving,
        ];
        let mut numbers = columns.map(|column| column[row]).to_vec();
        let own = row * table.obstacles..(row + 1) * table.obstacles;
        numbers.extend(&table.min_distance[own]);
        (words, numbers.into_iter().map(computed).collect())
    };
    (0..table.len()).map(row).collect()
}

fn assert_same_in_every_width(
    law: &VirtualForceField,
    scenarios: &[Scenario],
    sets: &[Gains],
    run: Options,
    descent: bool,
) -> Vec<(String, Vec<u64>)> {
    let table = |lanes: usize, threads: usize, instructions: Instructions| {
        let options = BatchOptions {
            run,
            weights: Weights::EQUAL,
            descent,
            threads: Some(threads),
            width: Some(Width::of(lanes).unwrap()),
            instructions,
        };
        bits(
            &run_batch(
                scenarios,
                law,
                &Gains::one_after_another(sets),
                &options,
                &|| false,
                &|_| (),
            )
            .unwrap(),
        )
    };
    let first = table(1, 1, Instructions::Baseline);
    assert_eq!(first.len(), sets.len() * scenarios.len());
    let (baseline, widest) = (Instructions::Baseline, Instructions::Widest);
    for (lanes, threads, instructions) in [
        (1, 2, widest),
        (4, 1, baseline),
        (4, 2, widest),
        (8, 1, widest),
        (8, 2, baseline),
        (16, 1, baseline),
        (16, 2, widest),
    ] {
        let rows = table(lanes, threads, instructions);
        for (row, (many, one)) in rows.iter().zip(&first).enumerate() {
            let place = (row / scenarios.len(), row % scenarios.len());
            assert_eq!(
                many, one,
                "{lanes} lanes, {threads} threads, {instructions:?}: set, scenario {place:?}"
            );
        }
    }
    first
}

/// At least one row ended with this word.
fn assert_seen(rows: &[(String, Vec<u64>)], word: impl Debug) {
    let word = format!("{word:?}");
    assert!(
        rows.iter().any(|(words, _)| words.starts_with(&word)),
        "{word}"
    );
}

/// Two motion steps in a control period.
fn coarse() -> Options {
    Options {
        step: 0.03,
        ..Options::default()
    }
}

#[test]
fn neither_width_nor_threads_change_a_bit_of_many_groups() {
    use Outcome::{Arrived, Collided, Stopped, TimedOut};
    let law = law(NEW, Stabilizing::Off);
    let (scenarios, sets) = (scenarios(), gain_sets());
    let some = [&scenarios[2..4], &scenarios[5..6]].concat();
    let rows = assert_same_in_every_width(&law, &some, &sets, coarse(), false);
    for outcome in [Arrived, Collided, Stopped, TimedOut] {
        assert_seen(&rows, outcome);
    }
}

#[test]
fn neither_width_nor_threads_change_a_bit_of_any_mode() {
    for stabilizing in [
        Stabilizing::Off,
        Stabilizing::Capped(Cap::Force(10.0)),
        Stabilizing::Capped(Cap::Momentum(0.1)),
        Stabilizing::Full,
    ] {
        let law = law(NEW, stabilizing);
        assert_same_in_every_width(&law, &scenarios(), &gain_sets()[..5], coarse(), false);
    }
}

#[test]
fn neither_width_nor_threads_change_a_bit_with_other_side_rules() {
    for (pass_behind, hysteresis) in [(true, 3.0), (false, 2.0), (false, f64::INFINITY)] {
        let law = VirtualForceField {
            rules: SideRules {
                pass_behind,
                hysteresis,
            },
            ..law(NEW, Stabilizing::Off)
        };
        assert_same_in_every_width(&law, &scenarios(), &gain_sets()[..3], coarse(), false);
    }
}

#[test]
fn neither_width_nor_threads_change_a_bit_of_the_descent() {
    let law = law(NEW, Stabilizing::Full);
    let rows = assert_same_in_every_width(&law, &scenarios(), &gain_sets()[..5], coarse(), true);
    let share = |(_, numbers): &(String, Vec<u64>)| f64::from_bits(numbers[4]);
    assert!(rows.iter().any(|row| (0.5..1.0).contains(&share(row))));
}

#[test]
fn neither_width_nor_threads_change_a_bit_of_any_integrator() {
    let law = law(NEW, Stabilizing::Off);
    // A measurement needs the force to be held.
    let exact = &scenarios()[2..6];
    for (integrator, hold, stop_on_contact) in [
        (Integrator::Rk4, true, false),
        (Integrator::Rk4, false, false),
        (Integrator::SemiImplicitEuler, false, true),
        (Integrator::SemiImplicitEuler, true, true),
    ] {
        let options = Options {
            integrator,
            step: 0.03,
            hold,
            stop_on_contact,
            ..Options::default()
        };
        assert_same_in_every_width(&law, exact, &gain_sets()[..5], options, false);
    }
}

#[test]
fn a_large_batch_has_the_rows_of_single_runs() {
    let run = coarse();
    let scenarios = &scenarios()[..2];
    let sets: Vec<Gains> = (0..2100)
        .map(|k| gains([3.0, 20.0 + 0.02 * f64::from(k % 150), 17.0, 0.25]))
        .collect();
    let options = BatchOptions {
        run,
        weights: Weights {
            arrival_time: 0.5,
            avoidance: 0.3,
            energy_saving: 0.2,
        },
        descent: false,
        threads: Some(2),
        width: None,
        instructions: Instructions::Widest,
    };
    let law = law(NEW, Stabilizing::Off);
    let table = run_batch(
        scenarios,
        law,
        &Gains::one_after_another(&sets),
        &options,
        &|| false,
        &|_| (),
    )
    .unwrap();
    assert_eq!((table.len(), table.is_empty()), (4200, false));
    for set in [0, 63, 64, 149, 150, 2099] {
        for (index, scenario) in scenarios.iter().enumerate() {
            let row = set * scenarios.len() + index;
            let one = VirtualForceField {
                gains: sets[set],
                ..law
            };
            let (summary, _) = simulate(scenario, one, &run, &|| false).unwrap();
            assert_eq!(table.outcome[row], summary.outcome);
            assert_eq!(
                table.arrival_time[row],
                summary.arrival_time.unwrap_or(f64::NAN)
            );
            assert_eq!(table.energy[row], summary.energy);
            assert_eq!(table.min_distance[row], summary.min_distance[0]);
        }
    }
}
