//! Lanes compute what `f64` computes, bit for bit: operation by operation, and whole batches.

mod configurations;

use std::fmt::Debug;

use configurations::{crossing, gains, law, limits, obstacles};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use vff_core::angle::unsigned_angle;
use vff_core::forces::side::SideRules;
use vff_core::forces::stabilizing::{Cap, Stabilizing};
use vff_core::gains::{GainLanes, Gains};
use vff_core::lanes::{LaneMask, Lanes, Mask, Real, Vec2};
use vff_core::laws::VirtualForceField;
use vff_core::measurement::{Distribution, Measurement, Noisy};
use vff_core::metrics::Weights;
use vff_core::motion::Motion;
use vff_core::obstacle::Obstacle;
use vff_core::scenario::{Rules, Scenario};
use vff_core::simulate::{
    BatchOptions, BatchTable, Instructions, Integrator, Options, Outcome, Width, run_batch,
    simulate,
};

const NEW: [f64; 4] = [3.0, 20.0, 17.0, 0.25];

/// Where an operation changes its kind of answer.
const SPECIAL: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.1,
    -3.0,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    f64::MIN_POSITIVE,
    5e-324,
    -5e-324,
    f64::MAX,
    f64::MIN,
    f64::EPSILON,
    1e-300,
];

/// Bits of a computed number; Rust leaves the sign and the payload of a computed NaN open.
fn computed(value: f64) -> u64 {
    if value.is_nan() {
        f64::NAN.to_bits()
    } else {
        value.to_bits()
    }
}

/// Numbers of one lane from three inputs: what is computed, what is moved as it is, what is true.
type Answers<R> = (Vec<R>, Vec<R>, Vec<<R as Real>::Mask>);

/// Every operation of [`Real`], [`Mask`] and [`Vec2`], and the angle.
fn operations<R: Real>(a: R, b: R, c: R) -> Answers<R> {
    let (less, at_most) = (a.lt(b), a.le(b));
    let (v, w) = (Vec2 { x: a, y: b }, Vec2 { x: b, y: c });
    let mut accumulated = a;
    accumulated += b;
    let computed = vec![
        a + b,
        a - b,
        a * b,
        a / b,
        accumulated,
        a.sqrt(),
        a * b + c,
        v.dot(w),
        v.cross(w),
        v.scale(c).x,
        v.scale(c).y,
        (v + w).x,
        (v - w).y,
        unsigned_angle(a, b),
    ];
    let chosen = Vec2::select(less, v, w);
    let moved = vec![
        -a,
        a.abs(),
        a.copysign(b),
        a.min(b),
        a.max(b),
        a.sign(),
        R::select(less, a, b),
        R::select(at_most, c, a),
        chosen.x,
        chosen.y,
        v.perp().x,
        v.perp().y,
        (-v).x,
        R::zero(),
        R::splat(0.1),
    ];
    let truths = vec![
        less,
        at_most,
        a.gt(b),
        a.ge(b),
        less & at_most,
        less | b.le(c),
        !less,
        R::Mask::none(),
        R::Mask::splat(true),
    ];
    (computed, moved, truths)
}

/// Compares every lane with `f64`; lane `k` holds the `k`-th triple.
fn assert_lanes<const N: usize>(triples: &[[f64; 3]]) {
    let input = |which: usize| Lanes::<N>::from_fn(|lane| triples[lane % triples.len()][which]);
    let (numbers, moved, truths) = operations(input(0), input(1), input(2));
    for lane in 0..N {
        let [a, b, c] = triples[lane % triples.len()];
        let single = operations(a, b, c);
        for (k, (many, one)) in numbers.iter().zip(&single.0).enumerate() {
            let (many, one) = (computed(many.lane(lane)), computed(*one));
            assert_eq!(
                many, one,
                "computed {k} of {a:?}, {b:?}, {c:?} in lane {lane}"
            );
        }
        for (k, (many, one)) in moved.iter().zip(&single.1).enumerate() {
            let (many, one) = (many.lane(lane).to_bits(), one.to_bits());
            assert_eq!(many, one, "moved {k} of {a:?}, {b:?}, {c:?} in lane {lane}");
        }
        for (k, (many, one)) in truths.iter().zip(&single.2).enumerate() {
            assert_eq!(
                many.lane(lane),
                *one,
                "truth {k} of {a:?}, {b:?} in lane {lane}"
            );
        }
    }
}

fn assert_widths(triples: &[[f64; 3]]) {
    assert_lanes::<4>(triples);
    assert_lanes::<8>(triples);
    assert_lanes::<16>(triples);
}

#[test]
fn operations_agree_on_special_values() {
    let mut triples = Vec::new();
    for a in SPECIAL {
        for b in SPECIAL {
            triples.extend(SPECIAL.map(|c| [a, b, c]));
        }
    }
    for sixteen in triples.chunks(16) {
        assert_widths(sixteen);
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 500,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn operations_agree_on_any_values(triples in prop::collection::vec(prop::array::uniform3(prop::num::f64::ANY), 16)) {
        assert_widths(&triples);
    }

    #[test]
    fn operations_agree_on_ordinary_values(triples in prop::collection::vec(prop::array::uniform3(-10.0..10.0), 16)) {
        assert_widths(&triples);
    }
}

fn assert_mask<M: Mask>(mask: M, expected: &[bool]) {
    for (lane, truth) in expected.iter().enumerate() {
        assert_eq!(mask.lane(lane), *truth);
    }
    assert_eq!(mask.any(), expected.contains(&true));
}

#[test]
fn masks_know_their_lanes() {
    let odd = Lanes::<4>::from_fn(|lane| [1.0, 2.0, 1.0, 2.0][lane]).gt(Lanes::splat(1.5));
    assert_mask(odd, &[false, true, false, true]);
    assert_mask(odd.without(1), &[false, false, false, true]);
    assert_mask(odd.without(1).without(3), &[false; 4]);
    assert_mask(LaneMask::<4>::splat(true), &[true; 4]);
    assert_mask(true.without(0), &[false]);
}

#[test]
fn replacing_a_lane_leaves_the_others() {
    let before = Lanes::<8>::from_fn(|lane| lane as f64);
    let after = before.replace(3, f64::NAN);
    for lane in (0..8).filter(|lane| *lane != 3) {
        assert_eq!(after.lane(lane), lane as f64);
    }
    assert!(after.lane(3).is_nan());
    assert_eq!(1.0.replace(0, 2.0), 2.0);
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
        let measured = crossing(obstacles(4), rules).measured(noise(noisy, distribution), seed);
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
    let third = 1.0 / 3.0;
    let weights = Weights {
        arrival_time: third,
        avoidance: third,
        energy_saving: third,
    };
    let table = |lanes: usize, threads: usize, instructions: Instructions| {
        let options = BatchOptions {
            run,
            weights,
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
