//! Decisions of the five pedestrian models in the states of `tests/golden/crowd_cases.json`, which Python reads too.

use std::path::Path;

use nalgebra::Vector2;
use serde_json::Value;
use vff_core::arguments::Arguments;
use vff_core::crowd::Model;
use vff_core::crowd::agent::{Agent, FIRST_ROBOT, direction_of};
use vff_core::crowd::neighbors::grid::Period;
use vff_core::crowd::pedestrian::{Groupings, Walker};
use vff_core::crowd::snapshot::{CrowdSetting, Models, Snapshot};
use vff_core::crowd::walls::Wall;
use vff_core::error::{Failure, Given, Result};

/// Of the largest component of a state.
const RELATIVE: f64 = 1e-10;

/// Defaults of a model with what a state changes.
struct Parameters<'a> {
    defaults: &'a Value,
    changed: &'a Value,
    cutoff: f64,
}

impl Parameters<'_> {
    fn find(&self, name: &str) -> Option<f64> {
        let value = |from: &Value| from.get(name).and_then(Value::as_f64);
        match name {
            "cutoff" => Some(self.cutoff),
            "margin" => Some(0.0),
            _ => value(self.changed).or_else(|| value(self.defaults)),
        }
    }
}

impl Arguments for Parameters<'_> {
    fn number(&self, name: &str) -> Result<f64> {
        let missing = || Failure::invalid(name, "be given", Given::Found("nothing".into()));
        self.find(name).ok_or_else(missing)
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn count(&self, name: &str) -> Result<usize> {
        self.number(name).map(|value| value as usize)
    }

    fn flag(&self, _: &str) -> Result<bool> {
        unreachable!()
    }

    fn word(&self, _: &str) -> Result<String> {
        unreachable!()
    }

    fn places(&self, _: &str) -> Result<Vec<[f64; 3]>> {
        unreachable!()
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn vector(value: &Value) -> Vector2<f64> {
    Vector2::new(number(&value[0]), number(&value[1]))
}

/// Everybody of a state, and whether it is a robot.
fn walkers_of(state: &Value) -> Vec<(Walker, bool)> {
    let count = state["position"].as_array().unwrap().len();
    let of = |index: u32| {
        let place = index as usize;
        let (position, velocity) = (
            vector(&state["position"][place]),
            vector(&state["velocity"][place]),
        );
        let goal = state
            .get("goal")
            .map_or(position, |goals| vector(&goals[place]));
        let robot = state
            .get("robot")
            .is_some_and(|robots| robots[place].as_bool().unwrap());
        let heading = state
            .get("heading")
            .map_or(Vector2::x(), |all| vector(&all[place]));
        let awareness = state
            .get("awareness")
            .map_or(1.0, |all| number(&all[place]));
        let to_go = (goal - position).norm();
        let direction = if robot { velocity } else { goal - position };
        let walker = Walker {
            agent: Agent {
                position,
                velocity,
                direction: direction_of(direction),
                radius: number(&state["radius"][place]),
                number: if robot { FIRST_ROBOT + index } else { index },
            },
            desired_speed: number(&state["desired_speed"][place]),
            to_go,
            decides: true,
            stays: to_go == 0.0,
            heading,
            awareness,
        };
        (walker, robot)
    };
    (0..u32::try_from(count).unwrap()).map(of).collect()
}

fn walls_of(state: &Value) -> Vec<Wall> {
    let Some(walls) = state.get("walls") else {
        return Vec::new();
    };
    let points = |wall: &Value| {
        let points = wall.as_array().unwrap().iter();
        Wall::polyline(points.map(|point| vector(point).into()).collect()).unwrap()
    };
    walls.as_array().unwrap().iter().map(points).collect()
}

/// Decisions of a state, cell by cell or by all pairs.
fn decided(case: &Value, defaults: &Value, all_pairs: bool) -> Vec<Vector2<f64>> {
    let name = case["model"].as_str().unwrap();
    let cutoff = case["cutoff"].as_f64().unwrap_or(f64::INFINITY);
    let given = Parameters {
        defaults: &defaults[name],
        changed: &case["params"],
        cutoff,
    };
    let name = if name == "orca" {
        "reciprocal_avoidance"
    } else {
        name
    };
    let model = Model::named(name, &given).unwrap();
    let state = &case["state"];
    let all = walkers_of(state);
    let period = state
        .get("period")
        .map_or([0.0; 2], |period| vector(period).into());
    let of: Vec<Option<u32>> = state.get("group").map_or_else(Vec::new, |all| {
        let all = all.as_array().unwrap().iter();
        all.map(|one| u32::try_from(one.as_i64().unwrap()).ok())
            .collect()
    });
    let agents: Vec<Agent> = all.iter().map(|(walker, _)| walker.agent).collect();
    let groups = Groupings {
        agents: &agents,
        of: &of,
        period: Period(period),
    };
    let people = all
        .iter()
        .map(|(walker, robot)| (!robot).then_some(*walker));
    let people: Vec<_> = people.collect();
    let robots = all.iter().filter(|(_, robot)| *robot);
    let robots: Vec<_> = robots.map(|(walker, _)| walker.agent).collect();
    let setting = CrowdSetting {
        walls: &walls_of(state),
        company: &groups,
        period: Period(period),
        reach: if all_pairs { f64::INFINITY } else { cutoff },
        step: 0.25,
    };
    let mut decisions = Vec::new();
    let mut snapshot = Snapshot::default();
    let models = Models::Shared(&model);
    let everybody = (people.len(), |number: usize| people[number]);
    snapshot.decide(&setting, everybody, &robots, models, &mut decisions);
    decisions.iter().map(|decision| decision.order).collect()
}

#[test]
fn every_state_gives_the_decisions_of_the_file() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = std::fs::read_to_string(root.join("tests/golden/crowd_cases.json")).unwrap();
    let file: Value = serde_json::from_str(&text).unwrap();
    let states = file["states"].as_array().unwrap();
    assert_eq!(states.len(), 61);
    let mut wrong = Vec::new();
    for case in states {
        let decisions = decided(case, &file["defaults"], false);
        let expected = case["result"].as_array().unwrap();
        let found = expected.iter().zip(&decisions);
        let found: Vec<_> = found.filter(|(value, _)| !value.is_null()).collect();
        let scale = found
            .iter()
            .map(|(value, _)| vector(value).amax())
            .fold(1e-3, f64::max);
        let deviation = found
            .iter()
            .map(|(value, decision)| (vector(value) - *decision).amax());
        let deviation = deviation.fold(0.0, f64::max) / scale;
        if deviation.is_nan() || deviation > RELATIVE {
            wrong.push(format!("{} {}: {deviation:e}", case["model"], case["name"]));
        }
    }
    assert!(wrong.is_empty(), "{} wrong: {wrong:#?}", wrong.len());
}
