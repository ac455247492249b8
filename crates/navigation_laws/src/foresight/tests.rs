//! Cases that a prototype computed, and limits of the parts.

use super::*;
use crate::shield::{Guard, Person, Shield, TrackingError, Verifier, View};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    let all = value.as_array().unwrap().iter();
    all.map(|each| each.as_f64().unwrap()).collect()
}

fn pair(value: &Value) -> Vector2<f64> {
    let pair = numbers(value);
    Vector2::new(pair[0], pair[1])
}

/// Places after the four quarters of a stage of a robot that takes up a velocity and keeps it.
fn driven(robot: &RobotState<f64>, target: &Target, limits: &ShieldLimits, step: f64) -> Driven {
    Driven {
        places: taken_up(robot, target.velocity, limits.max_acceleration, step),
        headings: [0.0; 4],
        turn_price: None,
    }
}

#[test]
fn decisions_are_those_of_the_prototype() {
    let text = include_str!("../../../../tests/golden/foresight_cases.json");
    let cases: Value = serde_json::from_str(text).unwrap();
    for (index, case) in cases["cases"].as_array().unwrap().iter().enumerate() {
        let number = |name: &str| case[name].as_f64().unwrap();
        let of_robot = |name: &str| case["robot"][name].as_f64().unwrap();
        let limits = ShieldLimits {
            radius: of_robot("radius"),
            max_speed: of_robot("max_speed"),
            max_acceleration: of_robot("max_acceleration"),
            period: of_robot("control_period"),
        };
        let shield = Shield {
            person_speed: Some(number("person_speed")),
            latency: number("latency"),
            position_error: number("position_error"),
            margin: number("margin"),
            position_tracking: 0.0,
            velocity_tracking: TrackingError::EXACT,
            ..Shield::default()
        };
        let guard = Guard::new(shield, limits).unwrap();
        let goal = pair(&case["goal"]);
        let settings = Foresight::default();
        let mut foreseer =
            Foreseer::new(settings, limits, limits.max_speed, limits.radius).unwrap();
        for (number_of_step, step) in case["steps"].as_array().unwrap().iter().enumerate() {
            let robot = RobotState {
                position: pair(&step["position"]),
                velocity: pair(&step["velocity"]),
            };
            let (mut seen, mut people) = (Vec::new(), Vec::new());
            for (who, person) in step["people"].as_array().unwrap().iter().enumerate() {
                let person = numbers(person);
                let position = Vector2::new(person[0], person[1]);
                seen.push(Sighting {
                    who,
                    position,
                    velocity: Vector2::new(person[2], person[3]),
                    age: shield.latency,
                    instant: number_of_step as f64 * limits.period,
                    touch: limits.radius + person[4],
                });
                people.push(Person {
                    position_error: shield.position_error,
                    max_speed: number("person_speed"),
                    latency: shield.latency,
                    ..Person::disc(position.into(), person[4])
                });
            }
            let scene = Scene {
                robot,
                goal,
                ahead: goal - robot.position,
                people: &seen,
                position_error: shield.position_error,
                walls: StaticObstacles::NONE,
                outline: None,
                plan: None,
            };
            let view = View {
                robot,
                people: &people,
                walls: StaticObstacles::NONE,
                hidden: None,
            };
            let mut verifier = Verifier::new(&guard, view);
            let take = |target: &Target| {
                let command = guard.clipped(&robot, target.velocity);
                verifier.admits(command).then_some(command)
            };
            let driven = |target: &Target| driven(&robot, target, &limits, settings.step);
            let found = foreseer.decide(&scene, false, driven, take).unwrap();
            let (command, target) = (found.command, found.target);
            let off = [(command, "command"), (target, "target")]
                .map(|(found, name)| (found - pair(&step[name])).norm());
            let off = off[0].max(off[1]);
            assert!(off < 1e-9, "case {index}: {command} {target}");
        }
    }
}

const LIMITS: ShieldLimits = ShieldLimits {
    radius: 0.3,
    max_speed: 1.5,
    max_acceleration: 10.0,
    period: 0.1,
};

fn sighting(position: [f64; 2], velocity: [f64; 2], instant: f64) -> Sighting {
    Sighting {
        who: 0,
        position: position.into(),
        velocity: velocity.into(),
        instant,
        age: 0.0,
        touch: 0.6,
    }
}

fn scene<'a>(people: &'a [Sighting], walls: StaticObstacles<'a>, position_error: f64) -> Scene<'a> {
    Scene {
        robot: RobotState {
            position: Vector2::zeros(),
            velocity: Vector2::zeros(),
        },
        goal: Vector2::new(8.0, 0.0),
        ahead: Vector2::new(8.0, 0.0),
        people,
        position_error,
        walls,
        outline: None,
        plan: None,
    }
}

/// A number of the settings.
type Field = fn(&mut Foresight) -> &mut f64;

#[test]
fn numbers_that_are_not_allowed_are_named() {
    let fields: [(&str, Field); 5] = [
        ("step", |settings| &mut settings.step),
        ("clearance", |settings| &mut settings.clearance),
        ("risk_weight", |settings| &mut settings.risk_weight),
        ("comfort", |settings| &mut settings.comfort),
        ("acceleration", |settings| &mut settings.acceleration),
    ];
    for (name, field) in fields {
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let mut settings = Foresight::default();
            *field(&mut settings) = bad;
            let told = settings.checked().unwrap_err().to_string();
            assert!(told.contains(name), "{told}");
        }
    }
    for stages in [0, 1, MOST_STAGES + 1] {
        let settings = Foresight {
            stages,
            ..Foresight::default()
        };
        assert!(settings.checked().is_err());
    }
    assert!(Foreseer::new(Foresight::default(), LIMITS, 1e-3, LIMITS.radius).is_err());
}

#[test]
fn somebody_whose_velocity_nobody_measured_is_estimated_from_places() {
    for error in [0.0, 0.0354] {
        let mut estimates = Estimates::default();
        for sample in 0..20 {
            let time = 0.1 * f64::from(sample);
            let seen = [sighting([3.0 - 0.8 * time, 1.0], [f64::NAN; 2], time)];
            estimates.observe(&scene(&seen, StaticObstacles::NONE, error), 1.0, 0.1);
        }
        let seen = sighting([0.0; 2], [0.0; 2], 2.0);
        let found = estimates.of(&seen).unwrap();
        assert!((found.velocity - Vector2::new(-0.8, 0.0)).norm() < 0.02);
        estimates.observe(&scene(&[], StaticObstacles::NONE, error), 1.0, 0.1);
        assert!(estimates.of(&seen).is_none());
    }
}

#[test]
fn people_slide_along_walls() {
    use navigation_world::world::shape::PlacedShape;
    let wall = [PlacedShape::turned([3.0, 1.5], [6.0, 0.2], 0.0)];
    let walls = StaticObstacles {
        shapes: &wall,
        map: None,
    };
    let seen = [sighting([1.0, 0.5], [0.8, 0.6], 0.0)];
    let mut estimates = Estimates::default();
    estimates.observe(&scene(&seen, walls, 0.0), 1.0, 0.1);
    let mut prediction = Prediction::default();
    let settings = Foresight::default();
    prediction.foresee(&settings, seen.iter(), &estimates, walls, 0.3);
    let last = prediction.places(0)[2 * settings.stages];
    assert!(
        (last.x - (1.0 + 0.8 * 4.8)).abs() < 1e-9 && last.y < 1.3,
        "{last}"
    );
}

/// Cost at a node by trying all ways.
fn cost(
    node: [i32; 2],
    stage: usize,
    spacing: f64,
    step: f64,
    risk: &dyn Fn([i32; 2], usize) -> f64,
) -> f64 {
    let place = Vector2::new(f64::from(node[0]), f64::from(node[1])) * spacing;
    if stage == 3 {
        return (Vector2::new(8.0, 0.0) - place).norm() + risk(node, stage);
    }
    let mut least = f64::INFINITY;
    for x in -2..=2 {
        for y in -2..=2_i32 {
            if x * x + y * y <= 5 {
                least = least.min(cost(
                    [node[0] + x, node[1] + y],
                    stage + 1,
                    spacing,
                    step,
                    risk,
                ));
            }
        }
    }
    step + risk(node, stage) + least
}

#[test]
fn costs_are_those_of_all_ways() {
    let settings = Foresight {
        stages: 3,
        ..Foresight::default()
    };
    let seen = [sighting([1.0, 0.2], [-0.8, 0.1], 0.0)];
    let scene = scene(&seen, StaticObstacles::NONE, 0.0);
    let mut foreseer = Foreseer::new(settings, LIMITS, 1.0, LIMITS.radius).unwrap();
    let driven = |target: &Target| driven(&scene.robot, target, &LIMITS, settings.step);
    foreseer.decide(&scene, false, driven, |_| Some(()));
    let (spacing, step) = (settings.step / 2.24, settings.step);
    let risk = |node: [i32; 2], stage: usize| {
        let place = Vector2::new(f64::from(node[0]), f64::from(node[1])) * spacing;
        let time = stage as f64 * step;
        // The person walks straight on; the last stage looks back only.
        let ends = [
            time - 0.25 * step,
            time + if stage == 3 { 0.0 } else { 0.25 * step },
        ];
        let at = |time: f64| seen[0].position + seen[0].velocity * time;
        let [from, to] = ends.map(at);
        let way = to - from;
        let share = ((place - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        let gap = (place - from - way * share).norm() - 0.6;
        let blur = (0.05 + 0.1 * time).min(0.4);
        let part = ((0.08 + blur - gap) / (2.0 * blur)).clamp(0.0, 1.0);
        let short = (1.0 - gap.max(0.0) / 0.4).max(0.0);
        40.0 * step * part * part * (3.0 - 2.0 * part) + 0.6 * step * short * short
    };
    for node in [[0, 0], [2, 1], [-1, 3], [4, 0], [3, -2]] {
        let place = Vector2::new(f64::from(node[0]), f64::from(node[1])) * spacing;
        // Not on the node itself, whose cell rounding decides.
        let found = foreseer.program.cost(place + Vector2::repeat(1e-9));
        let expected = cost(node, 1, spacing, step, &risk);
        assert!(
            (found - expected).abs() < 1e-6,
            "{node:?}: {found} {expected}"
        );
    }
}
