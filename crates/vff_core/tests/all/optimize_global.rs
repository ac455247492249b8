//! Global searches, and compromises of several objectives, on functions with known answers.

use std::sync::atomic::Ordering;

use crate::functions::{Bowls, Function, global, rippled, unit_box};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use vff_core::search::{
    FrontOptions, GlobalMethod, GlobalOptions, front_search, global_search, hypervolume,
    non_dominated,
};

// --- global -----------------------------------------------------------------------------------

#[test]
fn global_methods_find_the_best_of_many_optima() {
    // The best feasible point along the first axis by brute force.
    let least = |value: f64, limit: f64| {
        (0..=1_000_000)
            .map(|k| f64::from(k) * 1e-6 * limit)
            .map(|v| -rippled(&[v, 0.7, 0.7]).0)
            .fold(value, f64::min)
    };
    let expected = -least(f64::INFINITY, 0.65);
    for method in [GlobalMethod::DifferentialEvolution, GlobalMethod::CmaEs] {
        let problem = Function::new(3, 1, rippled);
        let one = global_search(&problem, &unit_box(3), &global(method, 1), &(), None).unwrap();
        assert_eq!(one.evaluations, 24_001);
        assert_eq!(problem.calls.load(Ordering::Relaxed), 24_001);
        let best = one.best.clone().unwrap();
        assert!(
            best.score.feasible() && (best.score.value - expected).abs() < 1e-5,
            "{best:?}"
        );
        let two = global_search(&problem, &unit_box(3), &global(method, 2), &(), None).unwrap();
        assert_eq!(one, two);
        assert!(
            one.history
                .windows(2)
                .all(|pair| pair[0].1 < pair[1].1 && pair[0].0 < pair[1].0)
        );
        let other = GlobalOptions {
            seed: 6,
            ..global(method, 2)
        };
        assert_ne!(
            one,
            global_search(&problem, &unit_box(3), &other, &(), None).unwrap()
        );
    }
}

#[test]
fn islands_out_of_range_are_refused() {
    let problem = Function::new(3, 1, rippled);
    for (islands, evaluations) in [(0, 10), (300, 1000), (8, 7)] {
        let bad = GlobalOptions {
            islands,
            evaluations,
            ..global(GlobalMethod::CmaEs, 1)
        };
        assert!(global_search(&problem, &unit_box(3), &bad, &(), None).is_err());
    }
}

// --- compromises ------------------------------------------------------------------------------

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn the_front_is_the_one_of_brute_force(
        objectives in 1_usize..5,
        numbers in prop::collection::vec(0_i8..6, 4..200),
        holes in prop::collection::vec(0_usize..200, 0..6),
    ) {
        let mut values: Vec<f64> = numbers.iter().map(|value| f64::from(*value)).collect();
        for hole in holes {
            if let Some(value) = values.get_mut(hole) {
                *value = if hole % 2 == 0 { f64::NAN } else { f64::NEG_INFINITY };
            }
        }
        let rows: Vec<&[f64]> = values.chunks_exact(objectives).collect();
        let whole = &values[..rows.len() * objectives];
        let sound = |row: &[f64]| row.iter().all(|value| *value > f64::NEG_INFINITY);
        let beats = |one: &[f64], other: &[f64]| {
            one.iter().zip(other).all(|(a, b)| a >= b) && one != other
        };
        let expected: Vec<usize> = (0..rows.len())
            .filter(|own| {
                sound(rows[*own])
                    && !rows.iter().any(|row| sound(row) && beats(row, rows[*own]))
                    && !rows[..*own].contains(&rows[*own])
            })
            .collect();
        prop_assert_eq!(non_dominated(whole, objectives), expected);
    }

    #[test]
    fn the_hypervolume_is_the_count_of_unit_cells(
        objectives in 1_usize..4,
        numbers in prop::collection::vec(0_u8..6, 3..45),
    ) {
        let values: Vec<f64> = numbers.iter().map(|value| f64::from(*value)).collect();
        let rows: Vec<&[f64]> = values.chunks_exact(objectives).collect();
        let cells = 6_usize.pow(u32::try_from(objectives).unwrap());
        let inside = |cell: &usize| {
            let corner: Vec<f64> = (0..objectives)
                .map(|axis| (cell / 6_usize.pow(u32::try_from(axis).unwrap()) % 6) as f64 + 1.0)
                .collect();
            rows.iter().any(|row| row.iter().zip(&corner).all(|(value, edge)| value >= edge))
        };
        let expected = (0..cells).filter(inside).count() as f64;
        let whole = &values[..rows.len() * objectives];
        let volume = hypervolume(whole, objectives, &vec![0.0; objectives]);
        prop_assert!((volume - expected).abs() < 1e-9, "{} {}", volume, expected);
    }
}

#[test]
fn refinement_closes_in_on_the_compromises() {
    let run = |refinements| {
        let options = FrontOptions {
            shape: vec![6, 6],
            refinements,
            threads: Some(2),
        };
        front_search(&Bowls, &unit_box(2), &options, &(), None).unwrap()
    };
    let (coarse, fine) = (run(0), run(5));
    assert_eq!(coarse.evaluations, 36);
    assert_eq!(fine.rounds.len(), 6);
    let volume = |values: &[f64]| hypervolume(values, 2, &[-0.36, -0.36]);
    // The area above sqrt(-f1) + sqrt(-f2) = 0.6 within the reference: 0.36^2 - 0.6^4/6.
    let exact = 0.36 * 0.36 - 0.6_f64.powi(4) / 6.0;
    assert!(volume(&coarse.values) < 0.95 * exact);
    assert!((volume(&fine.values) / exact - 1.0).abs() < 0.01);
    for point in fine.points.chunks_exact(2) {
        assert!((point[1] - 0.5).abs() < 0.02 && (0.19..=0.81).contains(&point[0]));
    }
    assert!(
        fine.values
            .chunks_exact(2)
            .is_sorted_by(|one, next| one[0] >= next[0])
    );
}
