//! Gradients beside differences of the metrics themselves.

use impact_core::criteria::metrics;
use impact_core::gradients::{PARAMETER_NAMES, gradients};
use impact_core::metrics::{CRITERIA, MetricOptions};
use impact_core::parameters::{Foam, Head, Manipulator, System, Target};

/// Relative step of the differences; their error is its fourth power.
const STEP: f64 = 2e-4;
/// Agreement with differences of fourth order, relative to metric over parameter; rounding of
/// metrics that are good to 1e-14 over the step, or the step's fourth power.
const AGREEMENT: f64 = 2e-9;

fn system(p: &[f64; 10]) -> System {
    System {
        manipulator: Manipulator {
            mass: p[0],
            damping: p[1],
            stiffness: p[2],
        },
        foam: Foam {
            stiffness: p[3],
            damping: p[4],
            thickness: 0.0254,
            linear_range: 0.02,
        },
        head: Target::Free(Head {
            mass: p[5],
            damping: p[6],
            stiffness: p[7],
        }),
    }
}

fn at(p: &[f64; 10]) -> [f64; CRITERIA.len()] {
    let options = MetricOptions {
        manipulator_speed: Some(p[9]),
        ..MetricOptions::default()
    };
    let found = metrics(&system(p), p[8], &options).unwrap();
    found.loads.into_array()
}

#[test]
fn gradients_equal_differences() {
    let sets = [
        [9.6, 250.0, 20e3, 24.25e3, 71.9, 4.4, 46.0, 3e3, 1.25, 0.9],
        [
            49.4, 111.0, 14.4e3, 24.3e3, 30.0, 5.3, 130.0, 5e3, 1.25, 1.25,
        ],
        [9.6, 250.0, 20e3, 12.0e3, 150.0, 5.3, 130.0, 5e3, 0.8, 0.5],
        [9.6, 250.0, 20e3, 24.25e3, 300.0, 4.4, 46.0, 3e3, 1.25, 0.9],
    ];
    for p in sets {
        let options = MetricOptions {
            manipulator_speed: Some(p[9]),
            ..MetricOptions::default()
        };
        let exact = gradients(&system(&p), p[8], &options).unwrap();
        let base = exact.metrics.loads.into_array();
        for (j, parameter) in PARAMETER_NAMES.iter().enumerate() {
            let moved = |factor: f64| {
                let mut q = p;
                q[j] += factor * STEP * p[j];
                at(&q)
            };
            let [a, b, c, d] = [moved(-2.0), moved(-1.0), moved(1.0), moved(2.0)];
            let derivatives = exact.values.into_array();
            for (i, metric) in CRITERIA.map(|criterion| criterion.name).iter().enumerate() {
                let difference = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * STEP);
                let error = (difference - derivatives[i][j] * p[j]).abs() / base[i].abs();
                assert!(
                    error < AGREEMENT,
                    "{metric} by {parameter}: {difference} for {} ({error:e})",
                    derivatives[i][j] * p[j]
                );
            }
        }
    }
}
