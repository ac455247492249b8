//! Decisions of the filters in the states of `tests/golden/filter_cases.json`, which Python reads too.

use serde_json::Value;

use super::*;

/// Largest deviation; some slacks of the unicycle's cases lie 1e-9 below the exact ones.
const TOLERANCE: f64 = 1e-9;
const UNICYCLE: f64 = 2e-9;

fn number(value: &Value, name: &str) -> Option<f64> {
    value.get(name).and_then(Value::as_f64)
}

fn vector(value: &Value) -> Vector {
    Vector::new(value[0].as_f64().unwrap(), value[1].as_f64().unwrap())
}

fn filter(kind: &str, given: &Value) -> Filter {
    let of = |name: &str, usual: f64| number(given, name).unwrap_or(usual);
    let margin = of("margin", 0.0);
    match kind {
        "cbf" => Filter::Barrier(Barrier {
            rate: of("rate", 1.0),
            margin,
        }),
        "cbf_unicycle" => Filter::BarrierUnicycle(BarrierUnicycle {
            rate: of("rate", 1.0),
            ahead: of("ahead", 0.1),
            margin,
        }),
        "collision_cone" => Filter::CollisionCone(CollisionCone {
            rate: of("rate", 1.0),
            margin,
        }),
        "vo_clamp" => Filter::VelocityClamp(VelocityClamp {
            horizon: of("tau", 3.0),
            margin,
        }),
        "rss" => Filter::ResponsibilityRule(ResponsibilityRule {
            reaction_time: 0.2,
            acceleration: 1.0,
            braking: 2.0,
            person_acceleration: 0.0,
            person_braking: 1.5,
            margin,
        }),
        "approach" => Filter::ApproachMonitor(ApproachMonitor {
            time_before_collision: of("time_before_collision", 1.2),
            simulation_time_step: of("simulation_time_step", 0.1),
            margin,
        }),
        _ => panic!("no filter {kind}"),
    }
}

#[test]
fn filters_decide_as_the_cases_have_it() {
    let text = include_str!("../../../../tests/golden/filter_cases.json");
    let kinds: Value = serde_json::from_str(text).unwrap();
    for (kind, cases) in kinds.as_object().unwrap() {
        for (index, case) in cases.as_array().unwrap().iter().enumerate() {
            compare(kind, index, case);
        }
    }
}

fn compare(kind: &str, index: usize, case: &Value) {
    let (state, expected) = (&case["state"], &case["expected"]);
    let rows = state["people"].as_array().unwrap().iter();
    let people: Vec<Near> = rows
        .map(|row| Near {
            position: vector(row),
            velocity: Vector::new(row[2].as_f64().unwrap(), row[3].as_f64().unwrap()),
            radius: row[4].as_f64().unwrap(),
        })
        .collect();
    let points: Vec<Vector> = state.get("points").map_or_else(Vec::new, |points| {
        points.as_array().unwrap().iter().map(vector).collect()
    });
    let heading = number(state, "heading").unwrap();
    let seen = Sighted {
        position: vector(&state["p"]),
        velocity: state.get("V").map_or_else(Vector::zeros, vector),
        heading,
        radius: number(state, "radius").unwrap(),
        max_speed: number(state, "vmax").unwrap(),
        max_acceleration: number(state, "amax"),
        max_turn_rate: number(state, "wmax").unwrap(),
        period: number(state, "T").unwrap(),
        people: &people,
        points: &points,
    };
    let (wanted, turn_rate) = match state.get("command") {
        Some(command) => {
            let (sin, cos) = heading.sin_cos();
            let own = vector(command);
            let world = Vector::new(cos * own.x - sin * own.y, sin * own.x + cos * own.y);
            (world, command[2].as_f64().unwrap())
        }
        None => (vector(&state["wanted"]), 0.0),
    };
    let rule = filter(kind, &case["parameters"]);
    let found = rule.decide(&seen, wanted, turn_rate);
    let about = format!("{kind} {index}: {found:?}, expected {expected}");
    let tolerance = if kind == "cbf_unicycle" {
        UNICYCLE
    } else {
        TOLERANCE
    };
    let near = |one: f64, other: f64| (one - other).abs() <= tolerance;
    if let Some(share) = number(expected, "share") {
        assert!(near(found.share, share), "{about}");
    }
    if kind == "approach" {
        return;
    }
    assert_eq!(found.status.word(), expected["status"], "{about}");
    let velocity = expected.get("u").map_or_else(
        || {
            Vector::new(
                number(expected, "v").unwrap(),
                number(expected, "w").unwrap(),
            )
        },
        vector,
    );
    let off = found.velocity - velocity;
    assert!(near(off.x, 0.0) && near(off.y, 0.0), "{about}");
    assert!(
        near(found.slack, number(expected, "slack").unwrap_or(0.0)),
        "{about}"
    );
    if let (Filter::ResponsibilityRule(rule), Some(distances)) = (rule, expected.get("distances")) {
        for (distance, expected) in rule
            .distances(&seen)
            .iter()
            .zip(distances.as_array().unwrap())
        {
            assert!(near(*distance, expected.as_f64().unwrap()), "{about}");
        }
    }
}

#[test]
fn degenerate_states_are_defined() {
    let people = [Near {
        position: Vector::zeros(),
        velocity: Vector::zeros(),
        radius: 0.25,
    }];
    let seen = Sighted {
        position: Vector::zeros(),
        velocity: Vector::new(2.0, 0.0),
        heading: 0.0,
        radius: 0.25,
        max_speed: 1.0,
        max_acceleration: Some(3.0),
        max_turn_rate: 1.5,
        period: 0.1,
        people: &people,
        points: &[],
    };
    for kind in [
        "cbf",
        "cbf_unicycle",
        "collision_cone",
        "vo_clamp",
        "rss",
        "approach",
    ] {
        let rule = filter(kind, &Value::Object(serde_json::Map::default()));
        for people in [&people[..], &[]] {
            let found = rule.decide(&Sighted { people, ..seen }, Vector::new(1.0, 0.0), 0.0);
            assert!(found.velocity.norm().is_finite(), "{kind}: {found:?}");
        }
    }
    // Limits of speed and of its change that have nothing in common: it brakes.
    let braked = filter("cbf", &Value::Null).decide(&seen, Vector::new(1.0, 0.0), 0.0);
    assert_eq!(braked.status, FilterStatus::Infeasible);
    assert!((braked.velocity - Vector::new(1.7, 0.0)).norm() < 1e-12 && braked.slack.is_nan());
}
