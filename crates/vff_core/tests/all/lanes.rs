//! Lanes compute what `f64` computes, bit for bit: operation by operation.

use crate::bitwise::computed;
use numeric::angle::unsigned_angle;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use vff_core::lanes::{LaneMask, Lanes, Mask, Number, Planar, Real, Truth, Vector2};

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

/// Numbers of one lane from three inputs: what is computed, what is moved as it is, what is true.
type Answers<R> = (Vec<R>, Vec<R>, Vec<<R as Number>::Mask>);

/// Every operation of [`Real`], [`Mask`] and [`Vector2`], and the angle.
fn operations<R: Real>(a: R, b: R, c: R) -> Answers<R> {
    let (less, at_most) = (a.lt(b), a.le(b));
    let (v, w) = (Vector2::new(a, b), Vector2::new(b, c));
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
        v.dot(&w),
        v.perp(&w),
        (v * c).x,
        (v * c).y,
        (v + w).x,
        (v - w).y,
        unsigned_angle(a, b),
    ];
    let chosen = Vector2::select(less, v, w);
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
        v.left_normal().x,
        v.left_normal().y,
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
