use serde_json::Value;

use super::reading::{collision, pad};
use super::run::moved;
use super::stored::{stored, turns};
use super::{
    Collision, CollisionStatus, Outcome, Region, SupportedBody, Wanted, rest_of, simulate,
};
use crate::covering::{Bottoming, Covering, GibsonAshby, Material, Pad, Rate, Shape, Unloading};

fn cases() -> Value {
    serde_json::from_str(include_str!("../../../../tests/golden/contact_cases.json")).unwrap()
}

const GRAVITY: f64 = 9.80665;

fn stored_alone(collision: &Collision<'_>) -> Option<Outcome> {
    stored(collision, turns(&[collision])[0].as_ref())
}

/// Value of a load by its name in the cases, and its relative tolerance.
fn found(name: &str, outcome: &Outcome) -> Option<(f64, f64)> {
    let numbers = [
        ("release_time", outcome.release_time, 1e-6),
        ("peak_force", outcome.peak_force, 1e-7),
        ("peak_force_time", outcome.peak_force_time, 1e-6),
        (
            "peak_total_compression",
            outcome.peak_total_compression,
            1e-7,
        ),
        ("peak_body_deflection", outcome.peak_body_deflection, 1e-7),
        (
            "peak_covering_compression",
            outcome.peak_covering_compression,
            1e-7,
        ),
        ("peak_strain", outcome.peak_strain, 1e-7),
        ("peak_pressure", outcome.peak_pressure, 1e-7),
        ("rebound_speed", outcome.rebound_speed, 1e-7),
        (
            "peak_body_acceleration_g",
            outcome.peak_body_acceleration / GRAVITY,
            1e-7,
        ),
        ("body_speed_end", outcome.body_speed_end, 1e-7),
        ("hic15", outcome.injury[0], 1e-6),
        ("hic36", outcome.injury[1], 1e-6),
    ];
    let (_, number, tolerance) = numbers.into_iter().find(|(known, ..)| *known == name)?;
    Some((number, tolerance))
}

#[test]
fn golden_impacts_to_their_tolerance() {
    let mut missed = Vec::new();
    for case in cases()["impacts"].as_array().unwrap() {
        let input = &case["input"];
        let pad = (!input["covering"].is_null()).then(|| pad(&input["covering"]).unwrap());
        let collision = collision(input, pad.as_ref(), 1e-10);
        collision.check().unwrap();
        let wanted = Wanted {
            injury: Some(GRAVITY),
            ..Wanted::default()
        };
        let outcome = simulate(&collision, wanted, &|| false);
        let expected = case["output"].as_object().unwrap();
        let mut compared = 0;
        for (name, value) in expected {
            let Some((number, tolerance)) = found(name, &outcome) else {
                continue;
            };
            compared += 1;
            let ok = match value.as_f64() {
                None => number.is_nan(),
                Some(value) => (number - value).abs() <= tolerance * value.abs(),
            };
            if !ok {
                missed.push(format!(
                    "{} {name}: {number} instead of {value}",
                    case["name"]
                ));
            }
        }
        let end = expected["end_force"].as_f64().unwrap();
        let words =
            outcome.status.word() == expected["status"] && outcome.bottomed == expected["bottomed"];
        if compared < 6 || !words || (outcome.end_force - end).abs() > 1e-7 * outcome.peak_force {
            missed.push(format!("{}: {outcome:?}", case["name"]));
        }
        if std::env::var("SHOW").is_ok() {
            eprintln!("{} {}", case["name"], outcome.evaluations);
        }
    }
    assert!(
        missed.is_empty(),
        "{} missed\n{}",
        missed.len(),
        missed.join("\n")
    );
}

#[test]
fn no_closing_speed_is_no_impact() {
    let cases = cases();
    let input = &cases["impacts"][4]["input"];
    let mut collision = collision(input, None, 1e-8);
    collision.closing_speed = 0.0;
    assert_eq!(
        simulate(&collision, Wanted::default(), &|| false).status,
        CollisionStatus::NoImpact
    );
}

/// A heavy robot on a soft region: a quarter of the period takes half a second.
fn slow(horizon: f64) -> Collision<'static> {
    Collision {
        robot: SupportedBody::free(100.0),
        body: SupportedBody::free(f64::INFINITY),
        region: Region::Spring {
            stiffness: 1e3,
            cubic: 0.0,
        },
        pad: None,
        closing_speed: 0.5,
        stop: None,
        driven: None,
        horizon,
        tolerance: 1e-8,
    }
}

#[test]
fn loads_that_rise_at_the_horizon_say_so() {
    let whole = 0.5 * (100.0_f64 * 1e3).sqrt();
    let short = simulate(&slow(0.2), Wanted::default(), &|| false);
    assert_eq!(short.status, CollisionStatus::Horizon);
    assert!(short.rising && short.peak_force < 0.6 * whole);
    let past_the_peak = simulate(&slow(0.6), Wanted::default(), &|| false);
    assert_eq!(past_the_peak.status, CollisionStatus::Horizon);
    assert!(!past_the_peak.rising && (past_the_peak.peak_force / whole - 1.0).abs() < 1e-6);
    let long = simulate(&slow(2.0), Wanted::default(), &|| false);
    assert!(!long.rising && long.status == CollisionStatus::Released);
}

#[test]
fn an_interrupted_collision_is_unfinished() {
    let moving = Wanted {
        nodes: true,
        ..Wanted::default()
    };
    let found = simulate(&slow(2.0), moving, &|| true);
    assert_eq!(found.status, CollisionStatus::Unfinished);
    assert!(found.peak_force.is_nan() && found.evaluations <= 1);
}

/// Coverings of every law and shape.
fn coverings() -> Vec<Covering> {
    let laws = [
        Material::Linear { modulus: 2e5 },
        Material::GibsonAshby(GibsonAshby::new([3e5, 15e3, 0.9, 2.3, 1.0])),
        Material::Rusch {
            a: 18e3,
            p: 0.5,
            b: 190e3,
            q: 5.0,
        },
        Material::Avalle {
            plateau: 22e3,
            modulus: 3e5,
            m: 0.0,
            b: 9e3,
            n: 2.0,
        },
    ];
    let shapes = [
        Shape::Flat { area: 4e-3 },
        Shape::Curved {
            radii: [0.08, 0.05],
        },
        Shape::Cylinder {
            radius: 0.04,
            length: 0.1,
        },
    ];
    let of = |material: &Material, shape| Covering {
        material: material.clone(),
        thickness: 0.02,
        shape,
        damping: 0.0,
        rate: Rate {
            base: 0.0,
            slope: 0.0,
            reference: 1.0,
        },
        unloading: Unloading {
            retained: 1.0,
            exponent: 1.0,
        },
        bottoming: Bottoming {
            strain: 0.8,
            stiffness: 1e7,
        },
    };
    laws.iter()
        .flat_map(|law| shapes.map(|shape| of(law, shape)))
        .collect()
}

/// A rigid region, and one of each law that yields.
const REGIONS: [Region; 4] = [
    Region::Rigid,
    Region::Spring {
        stiffness: 25e3,
        cubic: 0.0,
    },
    Region::Spring {
        stiffness: 25e3,
        cubic: 1e8,
    },
    Region::Power {
        stiffness: 1e6,
        exponent: 1.5,
    },
];

/// A collision of free bodies.
fn free(pad: &Pad, region: Region, closing_speed: f64) -> Collision<'_> {
    Collision {
        robot: SupportedBody::free(8.0),
        body: SupportedBody::free(40.0),
        region,
        pad: Some(pad),
        closing_speed,
        stop: None,
        driven: None,
        horizon: 2.0,
        tolerance: 1e-10,
    }
}

#[test]
fn loads_from_stored_energy_are_those_of_the_motion() {
    let moving = Wanted {
        nodes: true,
        ..Wanted::default()
    };
    let (mut exact, mut all) = (0, 0);
    for covering in coverings() {
        let pad = covering.prepared().unwrap();
        for region in REGIONS {
            for closing_speed in [0.05, 0.4, 1.5] {
                let collision = free(&pad, region, closing_speed);
                all += 1;
                if stored_alone(&collision).is_none() {
                    continue;
                }
                exact += 1;
                let found = simulate(&collision, moving, &|| false);
                let last = found.nodes.last().unwrap();
                let peak = |of: fn(&super::MotionSample) -> f64| {
                    found.nodes.iter().map(of).fold(0.0, f64::max)
                };
                for (name, value, solved) in [
                    ("release", found.release_time, last.time),
                    ("force", found.peak_force, peak(|node| node.force)),
                    (
                        "compression",
                        found.peak_covering_compression,
                        peak(|node| node.covering_compression),
                    ),
                    ("rebound", found.rebound_speed, -last.closing_speed),
                ] {
                    let error = (value / solved - 1.0).abs();
                    let what = (name, region, closing_speed, &pad.covering.material);
                    assert!(error < 2e-7, "{what:?}: {value} {solved}");
                }
            }
        }
    }
    assert!(2 * exact > all, "{exact} of {all}");
}

/// Loads that both ways to solve a collision give, by name.
fn loads_of(outcome: &Outcome) -> [(&'static str, f64); 8] {
    [
        ("release", outcome.release_time),
        ("force", outcome.peak_force),
        ("total", outcome.peak_total_compression),
        ("deflection", outcome.peak_body_deflection),
        ("compression", outcome.peak_covering_compression),
        ("pressure", outcome.peak_pressure),
        ("rebound", outcome.rebound_speed),
        ("end", outcome.body_speed_end),
    ]
}

#[test]
fn loads_with_rate_and_loss_are_those_of_the_motion_in_time() {
    let behaviors = [
        ([0.05, 0.02, 0.1], [1.0, 1.0]),
        ([0.3, 0.1, 10.0], [0.5, 1.5]),
        ([0.0, 0.0, 1.0], [0.4, 2.0]),
        ([0.0, 0.4, 0.01], [1.0, 1.0]),
    ];
    let (mut exact, mut all) = (0, 0);
    for covering in coverings() {
        for (rate, unloading) in behaviors {
            let covering = Covering {
                rate: Rate {
                    base: rate[0],
                    slope: rate[1],
                    reference: rate[2],
                },
                unloading: Unloading {
                    retained: unloading[0],
                    exponent: unloading[1],
                },
                ..covering.clone()
            };
            let pad = covering.prepared().unwrap();
            for region in REGIONS {
                for closing_speed in [0.05, 0.4, 1.5] {
                    let collision = free(&pad, region, closing_speed);
                    all += 1;
                    let Some(found) = stored_alone(&collision) else {
                        continue;
                    };
                    exact += 1;
                    let solved = moved(&collision, Wanted::default(), &|| false);
                    let what = (region, closing_speed, &pad.covering);
                    assert_eq!(found.bottomed, solved.bottomed, "{what:?}");
                    for ((name, value), (_, other)) in
                        loads_of(&found).into_iter().zip(loads_of(&solved))
                    {
                        let error = (value - other).abs();
                        let close = error <= 2e-7 * other.abs();
                        assert!(close, "{name}: {value} {other} {what:?}");
                    }
                }
            }
        }
    }
    assert!(2 * exact > all, "{exact} of {all}");
}

const RATE: Rate = Rate {
    base: 0.05,
    slope: 0.02,
    reference: 0.1,
};

/// The force falls at the end of the plateau, where it turns like a half power, and rises once more within a step.
#[test]
fn a_second_rise_beyond_a_half_power_is_found() {
    let pad = Covering {
        material: Material::GibsonAshby(GibsonAshby::new([3e5, 15e3, 0.9, 2.3, 1.0])),
        thickness: 0.02,
        shape: Shape::Cylinder {
            radius: 0.05,
            length: 0.1,
        },
        damping: 0.0,
        rate: RATE,
        unloading: Unloading::default(),
        bottoming: Bottoming::default(),
    }
    .prepared()
    .unwrap();
    let peak = |speed: f64, tolerance: f64| {
        let collision = Collision {
            tolerance,
            ..free(&pad, Region::Rigid, speed)
        };
        stored_alone(&collision).unwrap().peak_force
    };
    for index in 0..=20 {
        let speed = 0.505 + 5e-4 * f64::from(index);
        let error = peak(speed, 1e-6) / peak(speed, 1e-12) - 1.0;
        assert!(error.abs() < 1e-6, "{speed} {error:e}");
    }
}

#[test]
fn loads_with_rate_converge_with_the_tolerance() {
    let pads: Vec<_> = coverings()
        .into_iter()
        .map(|covering| {
            let rate = RATE;
            Covering { rate, ..covering }.prepared().unwrap()
        })
        .collect();
    for pad in &pads {
        for region in &REGIONS[..2] {
            let of = |tolerance| {
                let collision = Collision {
                    tolerance,
                    ..free(pad, *region, 0.4)
                };
                stored_alone(&collision).unwrap_or_else(|| panic!("{tolerance:e} {collision:?}"))
            };
            let best = of(1e-12);
            for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
                for ((name, value), (_, exact)) in
                    loads_of(&of(tolerance)).into_iter().zip(loads_of(&best))
                {
                    let error = (value - exact).abs() / exact.abs().max(1e-300);
                    let close = error <= 3.0 * tolerance || value == exact;
                    assert!(close, "{name} {tolerance:e}: {error:e} {:?}", pad.covering);
                }
            }
        }
    }
}

#[test]
fn a_region_that_starts_infinitely_stiff_yields() {
    let flat = coverings()[0].clone();
    let curved = Covering {
        shape: Shape::Curved { radii: [0.08; 2] },
        ..flat.clone()
    };
    // Under the second one it yields by less than the last digit of the compression at first.
    for (covering, stiffness, exponent) in [(flat, 1e4, 0.8), (curved, 1e5, 0.5)] {
        let pad = covering.prepared().unwrap();
        let region = Region::Power {
            stiffness,
            exponent,
        };
        let collision = free(&pad, region, 0.4);
        let solved = moved(&collision, Wanted::default(), &|| false);
        let energy = 0.5 * collision.reduced_mass() * 0.16;
        let rest = rest_of(Some(&pad), collision.region, energy);
        for (value, exact) in [
            (solved.peak_force, rest.force),
            (solved.peak_covering_compression, rest.compression),
            (solved.peak_body_deflection, rest.deflection),
            (solved.rebound_speed, 0.4),
        ] {
            assert!((value / exact - 1.0).abs() < 1e-6, "{value} {exact}");
        }
    }
}

#[test]
fn a_force_that_starts_infinitely_steep_and_falls_has_a_peak() {
    // The damper brakes at once, while the force of a power law rises with an infinite slope.
    let mut covering = coverings()[6].clone();
    covering.damping = 3e4;
    let pad = covering.prepared().unwrap();
    let collision = free(&pad, Region::Rigid, 0.3);
    let found = moved(&collision, Wanted::default(), &|| false);
    assert_eq!(found.status, CollisionStatus::Released);
    assert!(found.peak_force >= 9e3 && found.peak_force < 9.01e3);
}

#[test]
fn a_drive_that_rests_has_pressed_its_hardest_before_it_is_left_alone() {
    let moving = Wanted {
        nodes: true,
        ..Wanted::default()
    };
    let pads: Vec<Pad> = coverings()
        .into_iter()
        .map(|covering| covering.prepared().unwrap())
        .collect();
    let bare = std::iter::once(None);
    let (mut fewer, mut all) = (0, 0);
    for pad in bare.chain(pads.iter().map(Some)) {
        for (region, share) in REGIONS[1..].iter().zip([0.02, 0.5, 20.0]).cycle().take(6) {
            for (closing_speed, detection_force) in [(0.03, 2.0), (0.12, 8.0), (0.3, 0.0)] {
                let mut collision = Collision {
                    region: *region,
                    pad,
                    closing_speed,
                    ..slow(4.0)
                };
                collision.robot.mass = 9.0;
                collision.robot.stiffness = 20e3 * share;
                collision.stop = Some(super::Braking {
                    time: 0.02,
                    deceleration: 4.0,
                });
                collision.driven = Some(super::Driven {
                    detection_force,
                    push_limit: f64::INFINITY,
                });
                let whole = simulate(&collision, moving, &|| false);
                let found = simulate(&collision, Wanted::default(), &|| false);
                assert!(!found.rising || whole.rising);
                assert_eq!(found.status, whole.status);
                if found.status != CollisionStatus::Horizon {
                    continue;
                }
                all += 1;
                fewer += usize::from(2 * found.evaluations < whole.evaluations);
                for ((name, value), (_, expected)) in
                    loads_of(&found).into_iter().zip(loads_of(&whole))
                {
                    let peak = !["release", "rebound", "end"].contains(&name);
                    let off = (value / expected - 1.0).abs();
                    assert!(
                        !peak || value.is_nan() || off < 1e-5,
                        "{name} {off:e} {collision:?}"
                    );
                }
            }
        }
    }
    assert!(3 * fewer > all, "{fewer} of {all}");
}
