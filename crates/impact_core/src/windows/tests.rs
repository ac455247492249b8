//! The head injury criterion beside all pairs of nodes and beside the other search.

use super::head_injury::criterion;
use crate::criteria::Impact;
use crate::metrics::MetricOptions;
use crate::parameters::{Foam, Head, Manipulator, System, Target};

/// Systems with numbers over many decades; many of them ring.
fn draw(seed: &mut u64) -> (System, f64) {
    let mut within = |low: f64, high: f64| {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let share = (*seed >> 11) as f64 / (1_u64 << 53) as f64;
        low * (high / low).powf(share)
    };
    let system = System {
        manipulator: Manipulator {
            mass: within(0.05, 50.0),
            damping: within(0.1, 600.0),
            stiffness: within(1e3, 1e6),
        },
        foam: Foam {
            stiffness: within(1.0, 1e5),
            damping: within(0.1, 400.0),
            thickness: 0.03,
            linear_range: 0.02,
        },
        head: Target::Free(Head {
            mass: within(2.0, 200.0),
            damping: within(1.0, 200.0),
            stiffness: within(100.0, 1e4),
        }),
    };
    (system, within(0.1, 3.0))
}

#[test]
fn no_pair_of_nodes_is_better() {
    let mut seed = 3;
    for _ in 0..300 {
        let (system, speed) = draw(&mut seed);
        let impact = Impact::new(&system, speed, None).unwrap();
        let nodes: u32 = 1500;
        let step = impact.end() / f64::from(nodes);
        let velocity: Vec<f64> = (0..=nodes)
            .map(|node| impact.motion().head(step * f64::from(node))[0])
            .collect();
        for width in [0.015, 0.036] {
            let found = impact.injury(width);
            let mut best = 0.0_f64;
            for (first, from) in velocity.iter().enumerate() {
                for (steps, to) in velocity[first..].iter().enumerate().skip(1) {
                    let length = step * steps as f64;
                    if length > width {
                        break;
                    }
                    best = best.max((to - from).max(0.0).powi(5) / length.powi(3));
                }
            }
            let best = best.sqrt();
            assert!(
                found.value >= best * (1.0 - 1e-12),
                "{system:?} {speed} {width}: {found:?} {best}"
            );
            assert!(found.end - found.start <= width * (1.0 + 1e-12));
            let rise = impact.motion().head(found.end)[0] - impact.motion().head(found.start)[0];
            let again = criterion(rise, found.end - found.start);
            assert!((again - found.value).abs() <= 1e-11 * found.value);
        }
    }
}

#[test]
fn the_best_window_among_many_humps_is_found() {
    // The window of an independent search over all humps.
    let system = System {
        manipulator: Manipulator {
            mass: 0.063_574_854_160_984_36,
            damping: 0.534_205_074_040_328,
            stiffness: 843_635.518_587_817_2,
        },
        foam: Foam {
            stiffness: 3.278_164_464_732_597,
            damping: 28.675_232_797_161_27,
            thickness: 0.03,
            linear_range: 0.02,
        },
        head: Target::Free(Head {
            mass: 190.668_579_613_070_85,
            damping: 68.900_533_231_368_2,
            stiffness: 451.119_524_015_534_24,
        }),
    };
    let impact = Impact::new(&system, 0.383_244_664_189_429_2, None).unwrap();
    let found = impact.injury(0.015);
    assert!((found.start - 0.839_76e-3).abs() < 1e-8, "{found:?}");
    assert!((found.end - found.start - 0.015).abs() < 1e-15);
}

#[test]
fn the_usual_shape_has_one_best_window() {
    let mut seed = 5;
    let options = MetricOptions::default();
    let scale = options.gravity.powi(2) * options.gravity.sqrt();
    let mut usual = 0;
    for _ in 0..4000 {
        let (system, speed) = draw(&mut seed);
        let (fast, missing) = crate::fast::usual(&system, speed, &options);
        if missing.searches().injury != [false; 2] {
            continue;
        }
        usual += 1;
        let impact = Impact::new(&system, speed, None).unwrap();
        for (value, width) in [(fast.hic15, 0.015), (fast.hic36, 0.036)] {
            let global = impact.injury(width).value / scale;
            assert!(
                (value - global).abs() <= 1e-10 * global,
                "{system:?} {speed} {width}: {value} {global}"
            );
        }
    }
    assert!(usual > 500, "{usual}");
}
