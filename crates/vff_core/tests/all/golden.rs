//! Force terms in the states of `tests/golden/force_states.json`, which Python reads too, and the
//! published configurations.

use std::path::Path;

use crate::configurations::{crossing, law, limits, obstacles};
use serde_json::Value;
use vff_core::laws::FieldTerms;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::robots::HolonomicRobot;
use vff_core::run::{Options, Outcome, simulate, terms_at};
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::Obstacle;
use vff_core::world::scenario::{Rules, Scenario};

/// Of the norm of a term: some hundred roundings; the file prints 16 digits.
const RELATIVE: f64 = 1e-12;
/// Relative: the figures are printed to 0.01 s.
const TIME: f64 = 0.005;
/// In m: the figures are printed to 0.001 m.
const DISTANCE: f64 = 0.002;

/// Gains of chapter 6 and of the optimum of appendix C.
const NEW: [f64; 4] = [3.0, 20.0, 17.0, 0.25];
const NEW_STAR: [f64; 4] = [4.3, 20.3, 240.7, 0.68];

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn pair(value: &Value) -> [f64; 2] {
    [number(&value[0]), number(&value[1])]
}

fn states() -> Vec<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = std::fs::read_to_string(root.join("tests/golden/force_states.json")).unwrap();
    let file: Value = serde_json::from_str(&text).unwrap();
    file["states"].as_array().unwrap().clone()
}

fn obstacle(entry: &Value) -> Obstacle {
    let limits = limits(
        number(&entry["critical_radius"]),
        number(&entry["active_radius"]),
    );
    let center = pair(&entry["center"]);
    if entry["type"] == "rectangle" {
        let sides = [number(&entry["length"]), number(&entry["width"])];
        return Obstacle::rectangle(center, sides, number(&entry["heading"]), limits).unwrap();
    }
    let (velocity, acceleration) = (pair(&entry["velocity"]), pair(&entry["acceleration"]));
    let motion = Motion::moving(center, velocity, acceleration, None).unwrap();
    Obstacle::disc(0.1, motion, limits).unwrap()
}

/// Every term of a state, with the stabilizing force uncapped.
fn terms(state: &Value) -> FieldTerms {
    let names = [
        "attractive_gain",
        "repulsive_gain",
        "detour_gain",
        "gain_ratio",
    ];
    let law = law(
        names.map(|name| number(&state["gains"][name])),
        Stabilizing::Full,
    );
    let robot = HolonomicRobot {
        mass: number(&state["mass"]),
        ..HolonomicRobot::default()
    };
    let position = pair(&state["position"]);
    let bodies = state["obstacles"].as_array().unwrap();
    let bodies = bodies.iter().map(obstacle).collect();
    let goal = pair(&state["goal"]);
    let scenario = Scenario::new(robot, position, goal, bodies, Rules::default()).unwrap();
    terms_at(&scenario, law, position, pair(&state["velocity"]), 0.0).unwrap()
}

fn assert_vector(actual: [f64; 2], expected: [f64; 2], what: &str) {
    let difference = (actual[0] - expected[0]).hypot(actual[1] - expected[1]);
    let allowed = RELATIVE * expected[0].hypot(expected[1]);
    assert!(
        difference <= allowed,
        "{what}: {actual:?} is not {expected:?}"
    );
}

#[test]
fn force_terms_equal_the_golden_states() {
    let states = states();
    assert_eq!(states.len(), 24);
    for state in &states {
        let name = format!(
            "{}, K1 {}",
            state["name"], state["gains"]["attractive_gain"]
        );
        let terms = terms(state);
        assert_vector(terms.attractive, pair(&state["attractive"]), &name);
        assert_vector(terms.stabilizing, pair(&state["stabilizing_full"]), &name);
        let omega = number(&state["omega"]);
        assert!(
            (terms.omega - omega).abs() <= RELATIVE * omega.abs(),
            "{name}"
        );
        for (index, obstacle) in terms.obstacles.iter().enumerate() {
            assert_vector(obstacle.repulsive, pair(&state["repulsive"][index]), &name);
            assert_vector(obstacle.detour, pair(&state["detour"][index]), &name);
            let region = match state["region"][index].as_str().unwrap() {
                "C1" => "free",
                "C2" => "active",
                _ => "critical",
            };
            assert_eq!(obstacle.region, region, "{name}");
            // No side is given where the obstacle is not active.
            let side = state["side"][index].as_i64().unwrap_or(0);
            assert_eq!(i64::from(obstacle.side), side, "{name}");
        }
    }
}

#[test]
fn commanded_force_is_the_sum_of_the_golden_terms() {
    for state in &states() {
        let parts = |name: &str| -> Vec<[f64; 2]> {
            state[name].as_array().unwrap().iter().map(pair).collect()
        };
        let mut all = vec![pair(&state["attractive"]), pair(&state["stabilizing_full"])];
        all.extend(parts("repulsive"));
        all.extend(parts("detour"));
        let scale: f64 = all.iter().map(|[x, y]| x.hypot(*y)).sum();
        let sum = all
            .iter()
            .fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]]);
        let total = terms(state).total;
        let difference = (total[0] - sum[0]).hypot(total[1] - sum[1]);
        assert!(difference <= RELATIVE * scale, "{}", state["name"]);
    }
}

#[test]
fn configurations_give_their_figures() {
    // Force every 0.06 s and held, semi-implicit Euler with 0.01 s, no stabilizing force.
    for (set, number, time, distances) in [
        (NEW, 1, 6.52, &[0.488][..]),
        (NEW, 2, 8.40, &[0.976]),
        (NEW, 3, 6.01, &[0.515, 0.526]),
        (NEW, 4, 7.97, &[1.100, 0.516, 0.566]),
        (NEW_STAR, 1, 6.02, &[0.551]),
        (NEW_STAR, 2, 6.88, &[0.942]),
        (NEW_STAR, 3, 5.72, &[0.549, 0.550]),
        (NEW_STAR, 4, 7.03, &[0.997, 0.571, 0.450]),
    ] {
        let scenario = crossing(obstacles(number), Rules::default());
        let law = law(set, Stabilizing::Off);
        let (run, _) = simulate(&scenario, law, &Options::default(), &|| false).unwrap();
        assert_eq!(run.outcome, Outcome::Arrived);
        let arrival = run.arrival_time.unwrap();
        assert!(
            (arrival / time - 1.0).abs() <= TIME,
            "c{number}: T {arrival}"
        );
        assert_eq!(run.min_distance.len(), distances.len());
        for (actual, expected) in run.min_distance.iter().zip(distances) {
            assert!(
                (actual - expected).abs() <= DISTANCE,
                "c{number}: d {actual}"
            );
        }
    }
}
