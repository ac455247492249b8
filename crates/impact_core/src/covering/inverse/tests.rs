use std::cell::Cell;

use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::RngSeed;

use super::{between, beyond, largest};

/// A law that becomes `steeper` at a kink, with its slope.
fn kinked(kink: f64, power: f64, steeper: f64) -> impl Fn(f64) -> [f64; 2] {
    move |x: f64| {
        let own = [x.powf(power), power * x.powf(power - 1.0)];
        let past = (x - kink).max(0.0);
        let extra = if past > 0.0 { steeper } else { 0.0 };
        [own[0] + extra * past, own[1] + extra]
    }
}

#[test]
fn kinks_do_not_keep_the_solution_from_being_found() {
    for power in [0.5, 1.0, 1.5, 3.0] {
        for steeper in [1.0, 1e2, 1e4, 1e8] {
            for past in [-1e-3, -1e-9, 0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.1] {
                let function = kinked(0.8, power, steeper);
                let target = function(0.8 + past)[0];
                for found in [
                    largest(target, 1.0, &function),
                    largest(target, f64::INFINITY, &function),
                    between(target, 0.1, 1.0, &function),
                ] {
                    let error = function(found)[0] / target - 1.0;
                    // As far as an argument with rounding reaches.
                    let room = 4.0 * f64::EPSILON * (1.0 + steeper / target);
                    assert!(error.abs() <= room, "{power} {steeper} {past}: {error}");
                }
            }
        }
    }
}

/// A piece of a law that is steeper, which makes two kinks.
#[derive(Clone, Debug)]
struct Bend {
    start: f64,
    slope: f64,
}

impl Bend {
    fn end(&self) -> f64 {
        1.05 * self.start
    }
}

/// A law from a start, flat before it: powers, kinks upwards and downwards, a pole at 1.
#[derive(Clone, Debug)]
struct PiecewiseLaw {
    start: f64,
    terms: Vec<[f64; 2]>,
    kinks: Vec<Bend>,
    pole: Option<[f64; 2]>,
    /// Whether the slope at a kink is infinite.
    steep: bool,
}

impl PiecewiseLaw {
    fn at(&self, x: f64) -> [f64; 2] {
        let [mut value, mut slope] = [0.0; 2];
        let past = (x - self.start).max(0.0);
        for [factor, power] in &self.terms {
            let own = factor * past.powf(*power);
            value += own;
            slope += if past > 0.0 { power * own / past } else { 0.0 };
        }
        for bend in &self.kinks {
            value += bend.slope * (x.min(bend.end()) - bend.start).max(0.0);
            if self.steep && x == bend.start {
                slope = f64::INFINITY;
            } else if x > bend.start && x < bend.end() {
                slope += bend.slope;
            }
        }
        if let Some([size, power]) = self.pole {
            let more = (-power * (-x).ln_1p()).exp_m1();
            value += size * more;
            slope += size * power * (1.0 + more) / (1.0 - x);
        }
        [value, slope]
    }

    fn last_kink(&self) -> f64 {
        self.kinks.iter().map(Bend::end).fold(self.start, f64::max)
    }
}

fn law() -> impl Strategy<Value = PiecewiseLaw> {
    let of = |low: f64, high: f64| (low..high).prop_map(f64::exp2);
    let bend = (0.01..0.99_f64, of(-20.0, 40.0));
    let bend = bend.prop_map(|(start, slope)| Bend { start, slope });
    let pair = |first, last| (first, last).prop_map(|(first, last)| [first, last]);
    (
        prop_oneof![Just(0.0), 0.0..0.9_f64, of(-60.0, 0.0)],
        proptest::collection::vec(pair(of(-20.0, 20.0), of(-3.0, 5.0)), 0..3),
        proptest::collection::vec(bend, 0..4),
        proptest::option::of(pair(of(-30.0, 10.0), of(-2.0, 3.0))),
        any::<bool>(),
    )
        .prop_map(|(start, terms, kinks, pole, steep)| PiecewiseLaw {
            start,
            terms,
            kinks,
            pole,
            steep,
        })
}

/// A law with a place in (0, 1): a share of the way to the bound, beside a kink, or beside the bound.
fn placed() -> impl Strategy<Value = (PiecewiseLaw, f64)> {
    let near = (-15.0..0.0_f64, any::<bool>()).prop_map(|(power, above)| {
        let size = 10_f64.powf(power);
        if above { size } else { -size }
    });
    let draws = (law(), 0.01..0.99_f64, near, any::<Index>());
    draws.prop_map(|(law, share, near, chosen)| {
        let ends = law.kinks.iter().flat_map(|bend| [bend.start, bend.end()]);
        let mut places: Vec<f64> = ends.map(|kink| kink * (1.0 + near)).collect();
        places.retain(|place| *place < 1.0);
        places.extend([share, share * near.abs(), 1.0 - share * near.abs()]);
        let place = places[chosen.index(places.len())];
        (law, place)
    })
}

/// Whether the value at an argument is the target, as far as rounding of both reaches.
fn solves(law: &PiecewiseLaw, found: f64, target: f64) -> bool {
    let [aside, room] = [8.0, 64.0].map(|count| count * f64::EPSILON);
    let below = law.at(found * (1.0 - aside))[0];
    let above = law.at((found * (1.0 + aside)).min(1.0_f64.next_down()))[0];
    (law.at(found)[0] - target).abs() <= above - below + room * target
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 20_000,
        max_global_rejects: 20_000,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn values_of_solutions_are_their_targets((law, place) in placed()) {
        let [target, slope] = law.at(place);
        prop_assume!(target > 0.0 && target.is_finite());
        let asked = Cell::new(0);
        let function = |x| {
            asked.set(asked.get() + 1);
            law.at(x)
        };
        let half = 0.5 * place;
        let mut found = vec![largest(target, 1.0, function), between(target, half, 1.0, function)];
        // Where the law does not rise any more, no argument is the largest one.
        if law.pole.is_none() && slope > 0.0 && !law.terms.is_empty() {
            found.push(largest(target, f64::INFINITY, function));
        }
        let [at_half, slope] = law.at(half);
        if at_half > 0.0 && slope > 0.0 {
            let until = (law.last_kink(), 1.0);
            found.push(beyond(target, (half, at_half, slope), until, function));
        }
        prop_assert!(asked.get() < 120 * found.len(), "{} {target:e}", asked.get());
        for found in found {
            prop_assert!(solves(&law, found, target), "{found:e} {place:e} {target:e}");
        }
    }
}

#[test]
fn a_step_over_a_kink_is_not_the_last_one() {
    let (kink, steep, more) = (0.5, 1e6, 1e-4);
    // Just below the kink, and a last piece whose line leads to just beyond it.
    let target = 4.01 - 2e-10 * steep;
    let last = (4.01 + more * steep - target) / (more - 3e-10);
    let pieces = [(0.1, 1.0, 0.1), (0.2, 1.01, 10.0), (kink, 4.01, steep)];
    let end = (kink + more, 4.01 + more * steep, last);
    let law = |x: f64| {
        let mut pieces = pieces.into_iter().chain([end]);
        let (from, value, slope) = pieces.rfind(|(from, ..)| *from <= x).unwrap();
        [value + slope * (x - from), slope]
    };
    let found = beyond(target, pieces[0], (end.0, f64::INFINITY), law);
    let error = law(found)[0] / target - 1.0;
    assert!(error.abs() <= 8.0 * f64::EPSILON, "{error:e}");
}

#[test]
fn a_law_that_stays_below_the_target_gives_the_bound() {
    let saturated = |x: f64| if x < 1.0 { [x, 1.0] } else { [1.0, 0.0] };
    assert_eq!(largest(2.0, f64::INFINITY, saturated), f64::INFINITY);
    assert_eq!(largest(2.0, 3.0, saturated), 3.0_f64.next_down());
}
