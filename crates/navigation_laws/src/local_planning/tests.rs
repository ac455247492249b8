//! Twists in the situations of `tests/golden/law_cases.json`, and what holds in any situation.

use serde_json::Value;

use super::*;
use crate::dwb::{DWB, DwbPlanner};
use crate::dynamic_window::DynamicWindow;
use crate::filters::Near;
use crate::path_integral::{PathIntegral, PathIntegralPlanner};
use crate::pure_pursuit::RegulatedPurePursuit;
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result};

/// Largest deviation.
const TOLERANCE: f64 = 1e-9;

/// Parameters of a case, and defaults.
struct Case<'a>(&'a Value, &'a [(&'a str, Value)]);

impl Case<'_> {
    fn value(&self, name: &str) -> Result<&Value> {
        let known = self.0.get(name);
        let usual = self.1.iter().find(|(own, _)| *own == name);
        known
            .or(usual.map(|(_, value)| value))
            .ok_or_else(|| Failure::invalid(name, "be given", Given::Word(String::new())))
    }
}

impl Arguments for Case<'_> {
    fn number(&self, name: &str) -> Result<f64> {
        Ok(self.value(name)?.as_f64().unwrap())
    }
    fn flag(&self, name: &str) -> Result<bool> {
        Ok(self.value(name)?.as_bool().unwrap())
    }
    fn count(&self, name: &str) -> Result<usize> {
        Ok(usize::try_from(self.value(name)?.as_u64().unwrap()).unwrap())
    }
    fn word(&self, name: &str) -> Result<String> {
        Ok(self.value(name)?.as_str().unwrap().into())
    }
    fn places(&self, _name: &str) -> Result<Vec<[f64; 3]>> {
        Ok(Vec::new())
    }
}

fn defaults(kind: &str) -> Value {
    let text = match kind {
        "dwa" => {
            r#"{"heading": 2, "dist": 0.2, "velocity": 0.2, "acceleration": 1, "braking": 1,
            "turn_acceleration": 3, "turn_braking": 3, "max_turn_rate": 1.5}"#
        }
        "dwb" => {
            r#"{"min_vel_x": 0, "max_vel_x": 0.26, "min_vel_y": 0, "max_vel_y": 0, "max_vel_theta": 1,
            "min_speed_xy": 0, "max_speed_xy": 0.26, "min_speed_theta": 0, "acc_lim_x": 2.5, "acc_lim_y": 0,
            "acc_lim_theta": 3.2, "decel_lim_x": -2.5, "decel_lim_y": 0, "decel_lim_theta": -3.2, "sim_time": 1.7,
            "linear_granularity": 0.05, "angular_granularity": 0.025, "obstacle_scale": 0.02, "path_dist_scale": 32,
            "goal_dist_scale": 24, "path_align_scale": 32, "goal_align_scale": 24, "forward_point_distance": 0.1,
            "cost_scaling_factor": 3, "inflation_radius": 0.55, "vx_samples": 20, "vy_samples": 5,
            "vtheta_samples": 20}"#
        }
        "rpp" => {
            r#"{"desired_linear_vel": 0.5, "lookahead_dist": 0.6, "min_lookahead_dist": 0.3,
            "max_lookahead_dist": 0.9, "lookahead_time": 1.5, "curvature_lookahead_dist": 0.6,
            "rotate_to_heading_angular_vel": 1.8, "rotate_to_heading_min_angle": 0.785, "max_angular_accel": 3.2,
            "min_approach_linear_velocity": 0.05, "approach_velocity_scaling_dist": 0.6,
            "regulated_linear_scaling_min_radius": 0.9, "regulated_linear_scaling_min_speed": 0.25,
            "cost_scaling_dist": 0.6, "cost_scaling_gain": 1, "inflation_radius": 0.55,
            "max_allowed_time_to_collision_up_to_carrot": 1, "use_velocity_scaled_lookahead_dist": false,
            "use_fixed_curvature_lookahead": false, "use_regulated_linear_velocity_scaling": true,
            "use_cost_regulated_linear_velocity_scaling": true, "use_rotate_to_heading": true,
            "use_collision_detection": true, "allow_reversing": false}"#
        }
        "mppi" => {
            r#"{"vx_min": -0.35, "vx_max": 0.5, "vy_max": 0, "wz_max": 1.9, "ax_max": 3, "ay_max": 3, "az_max": 3.5,
            "vx_std": 0.2, "vy_std": 0.2, "wz_std": 0.4, "model_dt": 0.1, "temperature": 0.3, "gamma": 0.015,
            "cost_weight": 3.81, "goal_weight": 5, "path_align_weight": 10, "path_follow_weight": 5,
            "path_angle_weight": 2.2, "prefer_forward_weight": 5, "cost_scaling_factor": 3,
            "inflation_radius": 0.55, "batch_size": 256, "time_steps": 28}"#
        }
        other => panic!("no law {other}"),
    };
    let mut found: Value = serde_json::from_str(text).unwrap();
    found["prediction"] = "static".into();
    found
}

fn law<L: Named>(kind: &str, given: &Value) -> Result<L> {
    let usual = defaults(kind);
    let usual: Vec<(&str, Value)> = usual
        .as_object()
        .unwrap()
        .iter()
        .map(|(name, value)| (name.as_str(), value.clone()))
        .collect();
    L::made_of(&Case(given, &usual))
}

fn numbers_of(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|each| each.as_f64().unwrap())
        .collect()
}

fn vector(value: &Value) -> Vector {
    let numbers = numbers_of(value);
    Vector::new(numbers[0], numbers[1])
}

/// A situation in the terms of the laws.
struct MirroredPlace {
    pose: Pose,
    twist: [f64; 3],
    goal: Vector,
    way: Way,
    people: Vec<Near>,
    shapes: Vec<MovingShape>,
    radius: f64,
    period: f64,
}

impl MirroredPlace {
    fn of(given: &Value) -> Self {
        let [pose, twist] = ["pose", "twist"].map(|name| numbers_of(&given[name]));
        let rows = |name: &str| given[name].as_array().unwrap().iter();
        Self {
            pose: Pose {
                position: Vector::new(pose[0], pose[1]),
                heading: pose[2],
            },
            twist: [twist[0], twist[1], twist[2]],
            goal: vector(&given["goal"]),
            way: Way::new(rows("path").map(vector)).unwrap(),
            people: rows("people")
                .map(|row| {
                    let row = numbers_of(row);
                    Near {
                        position: Vector::new(row[0], row[1]),
                        velocity: Vector::new(row[2], row[3]),
                        radius: row[4],
                    }
                })
                .collect(),
            shapes: rows("walls")
                .map(|ends| MovingShape {
                    placed: PlacedShape::wall(vector(&ends[0]).into(), vector(&ends[1]).into()),
                    velocity: Vector::zeros(),
                })
                .collect(),
            radius: given["radius"].as_f64().unwrap(),
            period: given["period"].as_f64().unwrap(),
        }
    }

    fn choose(&self, planner: &mut impl TwistPlanner) -> TwistChoice {
        let gaps = Gaps {
            radius: self.radius,
            people: &self.people,
            walls: Walls {
                shapes: &self.shapes,
                map: None,
            },
        };
        planner.choose(&LocalView {
            pose: self.pose,
            twist: self.twist,
            local_goal: self.goal,
            way: &self.way,
            period: self.period,
            max_speed: 1.0,
            gaps: &gaps,
        })
    }
}

fn cases() -> Value {
    serde_json::from_str(include_str!("../../../../tests/golden/law_cases.json")).unwrap()
}

/// A control `[vx, omega, vy]` in the order of the axes.
fn control(row: &Value) -> [f64; 3] {
    let row = numbers_of(row);
    [row[0], row[2], row[1]]
}

fn choose(kind: &str, case: &Value) -> (TwistChoice, Vec<[f64; 3]>) {
    let place = MirroredPlace::of(&case["situation"]);
    let given = &case["parameters"];
    let alone = |choice| (choice, Vec::new());
    match kind {
        "dwa" => alone(place.choose(&mut law::<DynamicWindow>(kind, given).unwrap())),
        "dwb" => alone(place.choose(&mut DwbPlanner::new(law::<DWB>(kind, given).unwrap()))),
        "rpp" => alone(place.choose(&mut law::<RegulatedPurePursuit>(kind, given).unwrap())),
        "mppi" => {
            let seed = u32::try_from(case["seed"].as_u64().unwrap()).unwrap();
            let call = u32::try_from(case["call"].as_u64().unwrap()).unwrap();
            let mut planner =
                PathIntegralPlanner::new(law::<PathIntegral>(kind, given).unwrap(), seed);
            let plan = case["plan"].as_array().into_iter().flatten().map(control);
            planner.resume(&plan.collect::<Vec<_>>(), call);
            let choice = place.choose(&mut planner);
            (choice, planner.planned().to_vec())
        }
        other => panic!("no law {other}"),
    }
}

fn near(found: f64, expected: &Value) -> bool {
    expected
        .as_f64()
        .is_none_or(|expected| (found - expected).abs() <= TOLERANCE)
}

#[test]
fn laws_choose_as_the_cases_have_it() {
    for kind in ["dwa", "dwb", "rpp", "mppi"] {
        for (index, case) in cases()["laws"][kind].as_array().unwrap().iter().enumerate() {
            let (choice, decided) = choose(kind, case);
            let expected = &case["expected"];
            for (axis, name) in ["v", "vy", "w"].into_iter().enumerate() {
                assert!(
                    near(choice.twist[axis], &expected[name]),
                    "{kind} {index}: {choice:?}, {expected}"
                );
            }
            if let Some(score) = choice.score {
                assert!(
                    (score - expected["score"].as_f64().unwrap()).abs() <= TOLERANCE,
                    "{kind} {index}"
                );
            }
            if let Some(mode) = expected["mode"].as_str() {
                assert_eq!(choice.mode.word(), mode, "{kind} {index}");
            }
            if let Some(blocked) = expected["blocked"].as_bool() {
                assert_eq!(choice.mode == Mode::Blocked, blocked, "{kind} {index}");
            }
            let second = expected.get("second").map(control);
            for (one, two) in decided
                .get(1)
                .zip(second)
                .into_iter()
                .flat_map(|(found, second)| found.iter().copied().zip(second).collect::<Vec<_>>())
            {
                assert!(
                    (one - two).abs() <= TOLERANCE,
                    "{kind} {index}: {decided:?}"
                );
            }
        }
    }
}
