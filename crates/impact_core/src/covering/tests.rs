use std::sync::Arc;

use proptest::prelude::*;
use serde_json::Value;

use super::{Bottoming, Covering, GibsonAshby, Material, Pad, Rate, Shape, Table, Unloading};

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or(f64::NAN)
}

fn pad(material: Material, shape: Shape) -> Pad {
    let covering = Covering {
        material,
        thickness: 0.02,
        shape,
        damping: 0.0,
        rate: Rate::default(),
        unloading: Unloading::default(),
        bottoming: Bottoming {
            strain: 0.8,
            stiffness: 1e6,
        },
    };
    covering.prepared().unwrap()
}

fn laws() -> Vec<Material> {
    let gibson = |m| Material::GibsonAshby(GibsonAshby::new([3e5, 15e3, 0.9, 2.3, m]));
    let strain = vec![0.0, 0.05, 0.1, 0.3, 0.5, 0.85];
    let stress = vec![0.0, 6e3, 9e3, 9e3, 16e3, 160e3];
    vec![
        Material::Linear { modulus: 2e5 },
        gibson(1.0),
        gibson(1.0004),
        gibson(1.5),
        gibson(2.0),
        Material::Rusch {
            a: 1.5e4,
            p: 0.4,
            b: 2e5,
            q: 4.3,
        },
        Material::Avalle {
            plateau: 2e4,
            modulus: 3e5,
            m: 0.0,
            b: 9e3,
            n: 2.006,
        },
        Material::Avalle {
            plateau: 2e4,
            modulus: 3e5,
            m: 0.5,
            b: 9e4,
            n: 1.5,
        },
        Material::Table(Arc::new(Table::new(strain, stress).unwrap())),
    ]
}

const SHAPES: [Shape; 3] = [
    Shape::Flat { area: 4e-3 },
    Shape::Curved {
        radii: [0.08, 0.05],
    },
    Shape::Cylinder {
        radius: 0.06,
        length: 0.1,
    },
];

/// Sum by the trapezoid rule over ever finer pieces is far too slow; Simpson's rule between kinks suffices.
fn integral(function: impl Fn(f64) -> f64, ends: &[f64]) -> f64 {
    let piece = |from: f64, to: f64| {
        // y^4 at the lower end smooths powers there.
        let pieces = 4000;
        let at = |index: usize| {
            let y = index as f64 / pieces as f64;
            4.0 * y.powi(3) * function(from + (to - from) * y.powi(4))
        };
        let inner: f64 = (1..pieces)
            .map(|index| {
                if index % 2 == 1 {
                    4.0 * at(index)
                } else {
                    2.0 * at(index)
                }
            })
            .sum();
        (to - from) * (at(0) + inner + at(pieces)) / (3.0 * pieces as f64)
    };
    ends.windows(2).map(|pair| piece(pair[0], pair[1])).sum()
}

#[test]
fn works_are_integrals_of_forces_and_forces_sums_over_columns() {
    for law in laws() {
        for shape in SHAPES {
            let pad = pad(law.clone(), shape);
            for strain in [0.03, 0.2, 0.55, 0.78, 0.83] {
                let compression = strain * 0.02;
                let mut ends = vec![0.0];
                ends.extend(pad.kinks().into_iter().filter(|kink| *kink < compression));
                ends.push(compression);
                let expected = integral(|d| pad.force(d)[0], &ends);
                let found = pad.work(compression);
                assert!(
                    (found / expected - 1.0).abs() < 1e-9,
                    "{law:?} {shape:?} {strain}: {found} {expected}"
                );
                let backing = 1e6 * (compression - 0.016).max(0.0);
                let columns = match shape {
                    Shape::Flat { area } => area * law.stress(strain)[0],
                    // Rings of the paraboloid have equal areas per depth.
                    Shape::Curved { radii } => {
                        let scale = 2.0 * std::f64::consts::PI * (radii[0] * radii[1]).sqrt();
                        scale * integral(|d| law.stress(d / 0.02)[0], &ends)
                    }
                    // s^2 = d - t: ds = dt/(2 s); u = s itself keeps the sum finite.
                    Shape::Cylinder { radius, length } => {
                        let mut roots: Vec<f64> =
                            ends.iter().map(|end| (compression - end).sqrt()).collect();
                        roots.reverse();
                        // Powers begin at the far end of s.
                        let last = *roots.last().unwrap();
                        let turned: Vec<f64> = roots.iter().rev().map(|s| last - s).collect();
                        let column = |t: f64| {
                            let s = last - t;
                            law.stress((compression - s * s).max(0.0) / 0.02)[0]
                        };
                        2.0 * length * (2.0 * radius).sqrt() * integral(column, &turned)
                    }
                };
                let found = pad.force(compression)[0];
                assert!(
                    (found / (columns + backing) - 1.0).abs() < 1e-9,
                    "{law:?} {shape:?} {strain}: {found} {columns}"
                );
            }
        }
    }
}

#[test]
fn slopes_are_those_of_the_forces() {
    for law in laws() {
        for shape in SHAPES {
            let pad = pad(law.clone(), shape);
            for strain in [0.03, 0.21, 0.57, 0.78, 0.83] {
                let (d, h) = (strain * 0.02, 1e-8);
                let expected = (pad.force(d + h)[0] - pad.force(d - h)[0]) / (2.0 * h);
                let found = pad.force(d)[1];
                let scale = pad.force(d)[0] / d;
                assert!(
                    (found - expected).abs() < 1e-5 * scale.max(found),
                    "{law:?} {shape:?} {strain}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn compressions_at_a_force_undo_it() {
    for law in laws() {
        for shape in SHAPES {
            let pad = pad(law.clone(), shape);
            for strain in [0.002, 0.04, 0.55, 0.78, 0.83] {
                let force = pad.force(strain * 0.02)[0];
                let found = pad.compression_at(force).unwrap();
                let back = pad.force(found)[0];
                assert!(
                    (back / force - 1.0).abs() < 1e-12,
                    "{law:?} {shape:?} {strain}: {back} {force}"
                );
                assert!(found >= strain * 0.02 * (1.0 - 1e-12));
            }
        }
    }
}

#[test]
fn a_plateau_gives_its_far_end() {
    let pad = pad(laws()[1].clone(), SHAPES[0]);
    let end = 0.9 * (1.0 - 1.0 / 2.3) * 0.02;
    assert!((pad.compression_at(4e-3 * 15e3).unwrap() / end - 1.0).abs() < 1e-14);
    let table = self::pad(laws()[8].clone(), SHAPES[0]);
    assert!((table.compression_at(4e-3 * 9e3).unwrap() / 0.006 - 1.0).abs() < 1e-14);
    assert_eq!(table.compression_at(1e9), None);
}

#[test]
fn refusals_name_the_number() {
    let refused = |material: Material| {
        let pad = pad(laws()[0].clone(), SHAPES[0]);
        let covering = Covering {
            material,
            ..pad.covering
        };
        covering.prepared().unwrap_err().to_string()
    };
    let gibson = |modulus, plateau, d| {
        Material::GibsonAshby(GibsonAshby::new([modulus, plateau, 0.9, d, 1.0]))
    };
    for (material, words) in [
        (
            Material::Linear { modulus: 0.0 },
            "material.modulus must be finite and positive, got 0.0",
        ),
        (
            gibson(1e4, 9e3, 2.3),
            "material.plateau must give a strain of yield",
        ),
        (gibson(1e4, 1e3, 1.0), "material.D must be above 1, got 1.0"),
        (
            Material::Rusch {
                a: 1.0,
                p: 1.2,
                b: 1.0,
                q: 2.0,
            },
            "material.p must be above 0 and at most 1, got 1.2",
        ),
        (
            Material::Rusch {
                a: 0.0,
                p: 1.0,
                b: 0.0,
                q: 2.0,
            },
            "material.b must not be 0",
        ),
        (
            Material::Rusch {
                a: 1.0,
                p: 1.0,
                b: 1.0,
                q: 1.0,
            },
            "material.q must be above 1, got 1.0",
        ),
        (
            Material::Avalle {
                plateau: 2e4,
                modulus: 3e5,
                m: 4.0,
                b: 0.0,
                n: 2.0,
            },
            "material.law must give a stress that falls nowhere",
        ),
    ] {
        let found = refused(material);
        assert!(found.starts_with(words), "{found}");
    }
    for (strain, stress, words) in [
        (vec![0.0, 0.1], vec![1.0, 2.0], "stress[0] must be 0"),
        (
            vec![0.0, 0.1, 0.1],
            vec![0.0, 2.0, 3.0],
            "strain[2] must be finite and above",
        ),
        (
            vec![0.0, 0.1, 0.2],
            vec![0.0, 2.0, 1.0],
            "stress[2] must be finite and at least",
        ),
        (
            vec![0.0],
            vec![0.0],
            "strain must have at least 2 points, got 1",
        ),
    ] {
        let found = Table::new(strain, stress).unwrap_err().to_string();
        assert!(found.starts_with(words), "{found}");
    }
}

#[test]
fn numbers_of_the_columns_agree() {
    let text = include_str!("../../../../tests/golden/contact_cases.json");
    let cases: Value = serde_json::from_str(text).unwrap();
    for case in cases["winkler"].as_array().unwrap() {
        let pad = super::super::collision::reading::pad(&case["input"]["covering"]).unwrap();
        let d = number(&case["input"], "compression");
        let close = |found: f64, name: &str| {
            let expected = number(case, name);
            assert!(
                (found / expected - 1.0).abs() < 2e-12,
                "{case}: {name} {found}"
            );
        };
        close(pad.force(d)[0], "force");
        close(pad.work(d), "energy");
        let strain = d / pad.covering.thickness;
        close(pad.covering.material.stress(strain)[0], "peak_pressure");
        if let Some([width, _]) = pad.covering.shape.half_widths(d) {
            close(width, "half_width");
        }
    }
}

proptest! {
    #[test]
    fn force_rises_with_compression(law in 0..9_usize, shape in 0..3_usize, d in 1e-6..0.0168_f64, more in 1e-6..1e-4_f64) {
        let pad = pad(laws()[law].clone(), SHAPES[shape]);
        prop_assert!(pad.force(d + more)[0] >= pad.force(d)[0]);
    }
}
