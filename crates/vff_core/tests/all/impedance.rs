//! Laws, collision vectors, and what the printed forms do instead.

use nalgebra::Vector2;
use proptest::prelude::*;
use vff_core::laws::impedance::bank::BankLayout;
use vff_core::laws::impedance::collision::{Pairing, pair_echoes};
use vff_core::laws::impedance::{
    Bank, BankOptions, Form, Impedance, Rate, RateFilter, Rotation, Speed, clamped_foot, foot,
};
use vff_core::world::frame::Frame;

/// Rounding of forces of some 10 N.
const EXACT: f64 = 1e-12;

fn law(form: Form) -> Impedance {
    Impedance {
        form,
        ..Impedance::default()
    }
}

proptest! {
    #[test]
    fn foot_is_perpendicular_and_clamped_foot_is_nearest(
        one in prop::array::uniform2(-2.0_f64..2.0),
        other in prop::array::uniform2(-2.0_f64..2.0),
    ) {
        let (one, other) = (Vector2::from(one), Vector2::from(other));
        let along = other - one;
        prop_assume!(along[0].hypot(along[1]) > 1e-3);
        let on_line = foot(one, other);
        prop_assert!((on_line[0] * along[0] + on_line[1] * along[1]).abs() < 1e-9);
        let nearest = clamped_foot(one, other);
        for share in 0..=100 {
            let t = f64::from(share) / 100.0;
            let point = one + along * t;
            prop_assert!(nearest[0].hypot(nearest[1]) <= point[0].hypot(point[1]) + 1e-12);
        }
        // The corrected components of (14), V the slope of the line.
        if along[0].abs() > 1e-3 && along[1].abs() > 1e-3 {
            let v = along[1] / along[0];
            let x = (v * one[0] - one[1]) / (v + 1.0 / v);
            let y = (one[1] / v - one[0]) / (v + 1.0 / v);
            prop_assert!((x - on_line[0]).abs() < 1e-9 && (y - on_line[1]).abs() < 1e-9);
            // As printed, with + x_i in y_C, the foot is not on the perpendicular.
            let printed = (one[0] + one[1] / v) / (v + 1.0 / v);
            let off = x * along[0] + printed * along[1];
            let expected = 2.0 * one[0] / (v + 1.0 / v) * along[1];
            prop_assert!((off - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn force_points_away_and_turns_with_the_vector(
        x in -2.0_f64..2.0, y in -2.0_f64..2.0, speed in 0.0..0.7, angle in 0.0..6.3,
    ) {
        prop_assume!(f64::hypot(x, y) > 1e-3);
        for form in [Form::Conventional, Form::Active] {
            let prepared = law(form).prepared();
            let force = prepared.force(Vector2::new(x, y), speed);
            prop_assert!(force[0] * x + force[1] * y <= 0.0);
            prop_assert!((force[0] * y - force[1] * x).abs() < EXACT * 100.0);
            let turned = Frame::at([0.0, 0.0], angle);
            let same = prepared.force(turned.outward(Vector2::new(x, y)), speed);
            let expected = turned.outward(force);
            prop_assert!((same[0] - expected[0]).abs() < 1e-10);
            prop_assert!((same[1] - expected[1]).abs() < 1e-10);
        }
    }
}

#[test]
fn a_foot_of_one_point_is_that_point() {
    let at = Vector2::new;
    assert_eq!(foot(at(1.0, 2.0), at(1.0, 2.0)), at(1.0, 2.0));
    assert_eq!(clamped_foot(at(1.0, 2.0), at(1.0, 2.0)), at(1.0, 2.0));
    // Vertical and horizontal lines are as good as any other.
    assert_eq!(foot(at(1.0, -3.0), at(1.0, 5.0)), at(1.0, 0.0));
    assert_eq!(clamped_foot(at(1.0, 2.0), at(1.0, 5.0)), at(1.0, 2.0));
}

#[test]
fn both_laws_agree_at_half_of_their_limits() {
    let (conventional, active) = (
        law(Form::Conventional).prepared(),
        law(Form::Active).prepared(),
    );
    let half = 0.5 * 0.8;
    assert!((conventional.spring(half) - active.spring(half)).abs() < EXACT);
    assert!((active.spring(half) - 40.0 * 0.4).abs() < EXACT);
    assert!((active.damper(half, 0.36) - 10.0 * 0.36).abs() < EXACT);
}

#[test]
fn active_spring_peaks_at_its_scale_and_vanishes_at_contact() {
    let active = law(Form::Active);
    let alpha = active.distance_scale();
    let prepared = active.prepared();
    let peak = active.reference_stiffness * alpha / std::f64::consts::E;
    assert!((prepared.spring(alpha) - peak).abs() < EXACT);
    assert!(prepared.spring(0.99 * alpha) < peak && prepared.spring(1.01 * alpha) < peak);
    assert_eq!(prepared.spring(0.0), 0.0);
    assert!(prepared.spring(3.0) > 0.0);
    let push = active.reference_damping * active.speed_limit;
    assert!((prepared.damper(3.0, 0.0) - push).abs() < EXACT);
}

#[test]
fn printed_damper_pulls_above_its_limit() {
    let printed = Impedance {
        clamp: false,
        ..law(Form::Active)
    };
    let force = printed.prepared().damper(1.0, 1.0);
    assert!((force + 16.6).abs() < 0.05, "{force}");
    assert_eq!(law(Form::Active).prepared().damper(1.0, 1.0), 0.0);
}

#[test]
fn twice_scaled_law_changes_sign_at_the_safe_distance() {
    let prepared = law(Form::ActiveTwiceScaled).prepared();
    assert!(prepared.spring(0.79) > 0.0 && prepared.spring(0.81) < 0.0);
    assert_eq!(prepared.damper(0.5, 0.0), 0.0);
}

#[test]
fn bad_references_are_refused() {
    for (stiffness, damping) in [(40.0, 3.0), (30.0, 3.0), (100.0, 10.0), (100.0, 0.0)] {
        let law = Impedance {
            reference_stiffness: stiffness,
            reference_damping: damping,
            ..Impedance::default()
        };
        assert!(law.checked().is_err(), "{stiffness} {damping}");
    }
}

#[test]
fn echoes_are_paired_from_the_right() {
    let points = [-0.2, 0.0, 0.2].map(|y| Vector2::new(1.0, y));
    let pairing = Pairing::default();
    let cases = |readings: [f64; 3]| {
        pair_echoes(&points, &readings, &pairing).map(|found| found.map(|each| each.case))
    };
    let none = f64::INFINITY;
    assert_eq!(cases([1.0, 1.0, 1.0]), [Some(3), Some(2), None]);
    assert_eq!(cases([none, 1.0, 1.0]), [Some(4), None, None]);
    assert_eq!(cases([1.0, none, 1.0]), [Some(0), None, Some(2)]);
    assert_eq!(cases([none; 3]), [None; 3]);
    // 0.5 m + 0.6 r apart is too far.
    let wide = [-1.2, 0.0, 0.2].map(|y| Vector2::new(1.0, y));
    let found = pair_echoes(&wide, &[1.0; 3], &pairing).map(|each| each.map(|each| each.case));
    assert_eq!(found, [Some(4), Some(0), None]);
}

#[test]
fn rate_is_filtered_skips_jumps_and_starts_anew_with_the_case() {
    let filter = RateFilter::default();
    let timing = (0.025, filter.weight(0.025));
    let mut rate = Rate::default();
    assert_eq!(
        rate.update(&filter, (1, Vector2::new(1.0, 0.0)), timing),
        0.0
    );
    let expected = 0.2 * timing.1;
    let found = rate.update(&filter, (1, Vector2::new(0.995, 0.0)), timing);
    assert!((found - expected).abs() < EXACT);
    // 0.2 m in 25 ms is 8 m/s.
    let skipped = rate.update(&filter, (1, Vector2::new(0.795, 0.0)), timing);
    assert_eq!(skipped, found);
    assert_eq!(
        rate.update(&filter, (3, Vector2::new(0.79, 0.0)), timing),
        0.0
    );
    // What goes away has no closing speed, but a norm.
    let mut norm = Rate::default();
    let unsigned = RateFilter {
        speed: Speed::Norm,
        ..filter
    };
    norm.update(&unsigned, (1, Vector2::new(1.0, 0.0)), timing);
    let away = norm.update(&unsigned, (1, Vector2::new(1.0, 0.01)), timing);
    assert!((away - 0.4 * timing.1).abs() < EXACT);
    let mut closing = Rate::default();
    closing.update(&filter, (1, Vector2::new(1.0, 0.0)), timing);
    assert_eq!(
        closing.update(&filter, (1, Vector2::new(1.01, 0.0)), timing),
        0.0
    );
}

fn force(options: &BankOptions, heading: f64, place: [f64; 2]) -> Vector2<f64> {
    let mount = |side: f64| Frame::at([0.0, 0.15 * side], 0.5 * side);
    let layout = BankLayout {
        mounts: [-1.0, 0.0, 1.0].map(mount),
    };
    let prepared = law(Form::Active).prepared();
    let pose = Frame::at(place, heading);
    let readings = [f64::INFINITY, 0.5, f64::INFINITY];
    Bank::default().force(&layout, &readings, &pose, &prepared, options, (0.025, 0.15))
}

#[test]
fn speed_is_forgotten_when_the_vector_is_lost_for_a_sample() {
    let mount = |side: f64| Frame::at([0.0, 0.15 * side], 0.5 * side);
    let layout = BankLayout {
        mounts: [-1.0, 0.0, 1.0].map(mount),
    };
    let prepared = law(Form::Conventional).prepared();
    let pose = Frame::at([0.0, 0.0], 0.0);
    let none = f64::INFINITY;
    let last = |outlives_gaps: bool| {
        let mut options = BankOptions::default();
        options.rate.outlives_gaps = outlives_gaps;
        let timing = (0.025, options.rate.weight(0.025));
        let mut bank = Bank::default();
        let mut force = Vector2::zeros();
        for reading in [0.6, 0.55, 0.5, none, 0.5] {
            let readings = [none, reading, none];
            force = bank.force(&layout, &readings, &pose, &prepared, &options, timing);
        }
        force[0]
    };
    // K_0 (rho_0 - C) alone after the gap; with a stale speed the damper adds.
    let spring = -prepared.spring(0.5);
    assert!((last(false) - spring).abs() < EXACT);
    assert!(last(true) < spring - 0.1);
    assert!(!BankOptions::default().rate.outlives_gaps);
}

#[test]
fn force_does_not_depend_on_the_origin_and_turns_with_the_heading() {
    let options = BankOptions::default();
    let here = force(&options, 0.3, [0.0, 0.0]);
    assert_eq!(here, force(&options, 0.3, [-10.0, 5.0]));
    let size = here[0].hypot(here[1]);
    // Straight back along the heading.
    assert!((here[0] + size * 0.3_f64.cos()).abs() < EXACT * 100.0);
    assert!((here[1] + size * 0.3_f64.sin()).abs() < EXACT * 100.0);
}

#[test]
fn printed_rotation_pushes_to_the_wrong_side_and_printed_translation_knows_the_origin() {
    let printed = BankOptions {
        rotation: Rotation::Printed,
        ..BankOptions::default()
    };
    let right = force(&BankOptions::default(), 0.3, [0.0, 0.0]);
    let wrong = force(&printed, 0.3, [0.0, 0.0]);
    assert!((right[1] + wrong[1]).abs() < EXACT * 100.0 && right[1] < -1.0);
    let translated = BankOptions {
        translated_by: Some([0.0, 0.0]),
        ..BankOptions::default()
    };
    let one = force(&translated, 0.3, [0.0, 0.0]);
    let other = force(&translated, 0.3, [-10.0, 5.0]);
    assert!((one[0] - other[0]).abs() > 1.0);
}

#[test]
fn ideal_sensing_adds_one_force_for_each_obstacle() {
    let prepared = law(Form::Active).prepared();
    let at = Vector2::new;
    let points = [(at(1.0, 0.0), at(-0.3, 0.2)), (at(0.0, 2.0), at(0.0, 0.5))];
    let sum = prepared.force_of_points(points);
    let first = prepared.force(at(1.0, 0.0), 0.3);
    let second = prepared.force(at(0.0, 2.0), 0.0);
    assert_eq!(sum, first + second);
    assert_eq!(prepared.force_of_points([]), Vector2::zeros());
}
