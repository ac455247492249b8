//! Metrics of the episodes of `tests/golden/crowd_cases.json`, which Python reads too, and what must not
//! change them: rotations, reflections, shifts, the order of the people, people who are absent.

use nalgebra::{Rotation2, Vector2};
use numeric::error::Failure;
use serde_json::Value;
use vff_core::crowd::metrics::{
    Kind, KnownArrival, MetricRules, ObservedEpisode, Paths, ROBOT_METRICS, RobotMetrics, Whole,
    Without, evaluate, evaluate_world,
};
use vff_core::crowd::neighbors::grid::Period;
use vff_core::crowd::walls::Wall;
use vff_core::world::shape::PlacedShape;

type Point = Vector2<f64>;

/// Relative to 1 or the value, whichever is greater.
const TOLERANCE: f64 = 1e-9;
const TOLERANCE_OF_FORCES: f64 = 1e-8;

/// An episode with its own arrays.
#[derive(Clone)]
struct Case {
    name: String,
    robot: Vec<Point>,
    people: Vec<Point>,
    radii: Vec<f64>,
    groups: Vec<i64>,
    walls: Vec<[Point; 2]>,
    without: Vec<Point>,
    goals: Vec<Point>,
    arrivals: Option<[Vec<KnownArrival>; 2]>,
    rules: MetricRules,
    expected: Value,
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| {
        value
            .as_str()
            .map_or(f64::NAN, |word| word.parse().unwrap())
    })
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().map(number).collect()
}

fn point(value: &Value) -> Point {
    Point::new(number(&value[0]), number(&value[1]))
}

fn points(value: &Value) -> Vec<Point> {
    value.as_array().into_iter().flatten().map(point).collect()
}

fn all_points(value: &Value) -> Vec<Point> {
    let instants = value.as_array().into_iter().flatten();
    instants.flat_map(points).collect()
}

impl Case {
    fn of(case: &Value) -> Self {
        let options = &case["options"];
        let people = case["people"][0].as_array().map_or(0, Vec::len);
        let radius = &options["person_radius"];
        let segment = |wall: &Value| {
            let corners = points(wall);
            [corners[0], corners[1]]
        };
        let given = |name: &str, default: f64| options[name].as_f64().unwrap_or(default);
        Self {
            name: case["name"].as_str().unwrap().into(),
            robot: points(&case["robot"]),
            people: all_points(&case["people"]),
            radii: match radius.as_f64() {
                Some(radius) => vec![radius; people],
                None => numbers(radius),
            },
            groups: options["group"]
                .as_array()
                .into_iter()
                .flatten()
                .map(|group| group.as_i64().unwrap())
                .collect(),
            walls: options["walls"]
                .as_array()
                .into_iter()
                .flatten()
                .map(segment)
                .collect(),
            without: all_points(&options["without"]),
            goals: points(&options["person_goal"]),
            arrivals: None,
            rules: MetricRules {
                step: number(&options["dt"]),
                goal: point(&options["goal"]),
                robot_radius: number(&options["robot_radius"]),
                arrival_tolerance: given("tolerance", 0.3),
                person_tolerance: given("person_tolerance", 0.3),
                max_speed: given("max_speed", 1.0),
                shortest_length: options["shortest_length"].as_f64(),
                period: options["period"]
                    .as_array()
                    .map_or(Period::default(), |period| {
                        Period([number(&period[0]), number(&period[1])])
                    }),
            },
            expected: case["result"].clone(),
        }
    }

    fn metrics(&self) -> Result<RobotMetrics, Failure> {
        let count = self.radii.len();
        let walls: Vec<Wall> = self
            .walls
            .iter()
            .map(|ends| Wall::polyline(ends.map(Into::into).to_vec()).unwrap())
            .collect();
        let without = if self.without.is_empty() {
            None
        } else {
            Some(Without {
                people: Paths::new("people_without", &self.without, count)?,
                goals: &self.goals,
                arrivals: self
                    .arrivals
                    .as_ref()
                    .map(|known| [&known[0][..], &known[1][..]]),
            })
        };
        evaluate(&ObservedEpisode {
            robot: &self.robot,
            people: Paths::new("people", &self.people, count)?,
            radii: &self.radii,
            groups: &self.groups,
            walls: &walls,
            without,
            body: None,
            rules: self.rules,
        })
    }

    /// The same with every position elsewhere.
    fn moved(&self, place: impl Fn(Point) -> Point) -> Self {
        let all = |points: &[Point]| points.iter().map(|point| place(*point)).collect();
        Self {
            robot: all(&self.robot),
            people: all(&self.people),
            walls: self.walls.iter().map(|wall| wall.map(&place)).collect(),
            without: all(&self.without),
            goals: all(&self.goals),
            rules: MetricRules {
                goal: place(self.rules.goal),
                ..self.rules
            },
            ..self.clone()
        }
    }

    /// The same with the people in another order, and one more who is never there.
    fn renumbered(&self) -> Self {
        let count = self.radii.len();
        let absent = Point::repeat(f64::NAN);
        let turn = |points: &[Point]| -> Vec<Point> {
            let rows = points.chunks_exact(count.max(1));
            rows.flat_map(|row| row.iter().rev().copied().chain([absent]))
                .collect()
        };
        let last = |values: &[Point]| values.iter().rev().copied().chain([absent]).collect();
        let mut case = self.clone();
        case.people = match count {
            0 => vec![absent; self.robot.len()],
            _ => turn(&self.people),
        };
        case.without = turn(&self.without);
        case.goals = last(&self.goals);
        case.radii = self.radii.iter().rev().copied().chain([0.3]).collect();
        if !self.groups.is_empty() {
            case.groups = self.groups.iter().rev().copied().chain([7]).collect();
        }
        case
    }
}

fn cases() -> Vec<Case> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = std::fs::read_to_string(root.join("tests/golden/crowd_cases.json")).unwrap();
    let table: Value = serde_json::from_str(&text).unwrap();
    let cases = table["episodes"].as_array().unwrap();
    cases.iter().map(Case::of).collect()
}

fn alike(found: f64, expected: f64, tolerance: f64) -> bool {
    found == expected
        || (found.is_nan() && expected.is_nan())
        || (found - expected).abs() <= tolerance * expected.abs().max(1.0)
}

fn assert_equal(found: &RobotMetrics, expected: &RobotMetrics, tolerance: f64, about: &str) {
    let rows = found.into_array().into_iter().zip(expected.into_array());
    for ((found, expected), metric) in rows.zip(ROBOT_METRICS) {
        let name = metric.name;
        assert!(
            alike(found, expected, tolerance),
            "{about}: {name} {found} {expected}"
        );
    }
}

#[test]
fn metrics_equal_the_golden_episodes() {
    let cases = cases();
    assert_eq!(cases.len(), 12);
    for case in cases {
        let found = case.metrics().unwrap().into_array();
        assert_eq!(
            case.expected.as_object().unwrap().len(),
            ROBOT_METRICS.len()
        );
        for (found, metric) in found.into_iter().zip(ROBOT_METRICS) {
            let value = &case.expected[metric.name];
            let expected = match metric.kind {
                Kind::Flag => f64::from(value.as_bool().unwrap()),
                Kind::Count | Kind::Number => number(value),
            };
            let forces = metric.name.starts_with("force") || metric.name == "social_work";
            let tolerance = if forces {
                TOLERANCE_OF_FORCES
            } else {
                TOLERANCE
            };
            assert!(
                alike(found, expected, tolerance),
                "{}: {} is {found}, expected {expected}",
                case.name,
                metric.name
            );
        }
    }
}

/// Episodes in which nobody touches or faces another exactly, where rounding decides.
fn at_random() -> Vec<Case> {
    let mut cases = cases();
    cases.retain(|case| case.name.starts_with("random"));
    assert_eq!(cases.len(), 3);
    cases
}

#[test]
fn places_directions_and_numbers_do_not_matter() {
    let turn = Rotation2::new(0.7);
    let shift = Point::new(12.3, -4.5);
    for case in at_random() {
        let expected = case.metrics().unwrap();
        let same = |other: Case, what: &str| {
            let about = format!("{} {what}", case.name);
            assert_equal(&other.metrics().unwrap(), &expected, 1e-9, &about);
        };
        same(case.renumbered(), "renumbered");
        same(
            case.moved(|point| Point::new(point.x, -point.y)),
            "mirrored",
        );
        same(case.moved(|point| turn * point), "rotated");
        same(case.moved(|point| point + shift), "moved");
    }
}

#[test]
fn whole_periods_do_not_matter_where_the_world_repeats() {
    for mut case in at_random() {
        case.rules.period = Period([9.0, 11.0]);
        // Where people are without robots, and their goals, are told apart from their images.
        case.without.clear();
        let expected = case.metrics().unwrap();
        let count = case.radii.len();
        let grouped: Vec<bool> = case.groups.iter().map(|group| *group >= 0).collect();
        for (index, place) in case.people.iter_mut().enumerate() {
            let turns = if grouped[index % count] { 1.0 } else { -2.0 };
            *place += Point::new(9.0 * turns, -11.0);
        }
        let found = case.metrics().unwrap();
        assert_equal(&found, &expected, 1e-9, &case.name);
        let near = Case {
            rules: MetricRules {
                period: Period::default(),
                ..case.rules
            },
            ..case.clone()
        };
        let away = near.metrics().unwrap();
        assert!(away.min_clearance > found.min_clearance + 1.0);
    }
}

#[test]
fn one_instant_and_nobody_have_metrics() {
    let mut case = cases().swap_remove(0);
    case.robot.truncate(1);
    let found = case.metrics().unwrap();
    assert!(!found.arrived && found.path_length == 0.0);
    assert_eq!(found.min_clearance, f64::INFINITY);
    assert_eq!(found.longest_without_progress, 0.0);
    assert!(found.mean_speed.is_nan() && found.low_time_to_collision_share.is_nan());
    assert_eq!(found.comfort_share, 1.0);
}

#[test]
fn a_stop_of_five_seconds_is_frozen_and_rounding_of_the_step_does_not_matter() {
    let mut case = cases().swap_remove(0);
    case.rules.step = 0.1;
    case.robot = vec![Point::zeros(); 51];
    assert!(case.metrics().unwrap().frozen);
    case.robot.pop();
    assert!(!case.metrics().unwrap().frozen);
}

#[test]
fn walls_count_inside_discs_and_rectangles_too() {
    let case = cases().swap_remove(0);
    let walls = [Wall::solid(PlacedShape::upright([2.0, 0.0], [1.0, 1.0])).unwrap()];
    let found = evaluate(&ObservedEpisode {
        robot: &case.robot,
        people: Paths::default(),
        radii: &[],
        groups: &[],
        walls: &walls,
        without: None,
        body: None,
        rules: case.rules,
    });
    let found = found.unwrap();
    assert_eq!((found.wall_contacts, found.wall_clearance), (1, -0.8));
    assert!(found.arrived && !found.success && found.spl == 0.0);
}

fn refused(change: impl Fn(&mut Case)) -> String {
    let mut case = cases().swap_remove(6);
    change(&mut case);
    match case.metrics() {
        Err(Failure::InvalidParameter(invalid)) => invalid.name,
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_invalid_value_is_named_with_its_index() {
    assert_eq!(refused(|case| case.rules.step = 0.0), "step");
    assert_eq!(refused(|case| case.rules.goal.x = f64::NAN), "goal");
    assert_eq!(
        refused(|case| case.rules.robot_radius = -1.0),
        "robot_radius"
    );
    assert_eq!(refused(|case| case.rules.period.0[1] = -1.0), "period[1]");
    assert_eq!(refused(|case| case.rules.max_speed = 0.0), "max_speed");
    assert_eq!(refused(|case| case.robot[3].y = f64::NAN), "position[3]");
    assert_eq!(refused(|case| case.robot.clear()), "position");
    assert_eq!(refused(|case| case.people[5].x = f64::NAN), "people[2, 1]");
    assert_eq!(
        refused(|case| case.people[4].y = f64::INFINITY),
        "people[2, 0]"
    );
    assert_eq!(refused(|case| case.radii[1] = 0.0), "person_radius[1]");
    assert_eq!(refused(|case| case.groups = vec![1]), "groups");
    assert_eq!(refused(|case| case.goals.clear()), "person_goals");
    let known = |time: f64, count: usize| {
        let place = Point::zeros();
        vec![KnownArrival { time, place }; count]
    };
    let arrivals = |first: (f64, usize), second: (f64, usize)| {
        refused(move |case| {
            case.arrivals = Some([known(first.0, first.1), known(second.0, second.1)]);
        })
    };
    let count = cases()[6].radii.len();
    assert_eq!(arrivals((1.0, count + 1), (1.0, count)), "person_arrivals");
    assert_eq!(
        arrivals((1.0, count), (-1.0, count)),
        "person_arrivals_without[0]"
    );
    assert_eq!(refused(|case| case.people.truncate(4)), "people");
}

#[test]
fn who_leaves_arrives_where_it_was_last() {
    let mut case = cases().swap_remove(0);
    let absent = Point::repeat(f64::NAN);
    case.rules.step = 0.5;
    case.robot = vec![Point::new(50.0, 0.0); 7];
    case.radii = vec![0.25];
    // 0.5 m a step, gone at the fifth instant and at the third: both had walked into the circle of the goal.
    let walk = |steps: u32| -> Vec<Point> {
        let places =
            (0..7).map(|step| (step < steps).then(|| Point::new(0.5 * f64::from(step), 0.0)));
        places.map(|place| place.unwrap_or(absent)).collect()
    };
    (case.people, case.without) = (walk(5), walk(3));
    case.goals = vec![Point::new(9.0, 0.0)];
    let blind = case.metrics().unwrap();
    assert!(blind.person_delay.is_nan() && blind.person_detour.is_nan());
    let known = |time: f64, x: f64| {
        vec![KnownArrival {
            time,
            place: Point::new(x, 0.0),
        }]
    };
    case.arrivals = Some([known(2.5, 2.5), known(1.5, 1.5)]);
    let found = case.metrics().unwrap();
    assert_eq!((found.person_delay, found.person_detour), (1.0, 1.0));
    assert_eq!(found.people_blocked, 0);
    case.arrivals = Some([known(f64::NAN, f64::NAN), known(1.5, 1.5)]);
    let found = case.metrics().unwrap();
    assert!(found.person_delay.is_nan());
    assert_eq!(found.people_blocked, 1);
}

#[test]
fn a_world_counts_who_left_stands_and_touches() {
    let absent = Point::repeat(f64::NAN);
    // One walks to the goal and leaves, one stands, robots pass through each other.
    let instants = 0..=60;
    let people: Vec<Point> = instants
        .clone()
        .flat_map(|step| {
            let walker = if step <= 20 {
                Point::new(0.1 * f64::from(step), 0.0)
            } else {
                absent
            };
            [walker, Point::new(5.0, 5.0)]
        })
        .collect();
    let robots: Vec<Point> = instants
        .flat_map(|step| {
            let x = 0.1 * f64::from(step);
            [
                Point::new(x, 9.0),
                Point::new(6.0 - x, 9.0),
                Point::new(x, 12.0),
            ]
        })
        .collect();
    let whole = |radii: &[f64]| {
        evaluate_world(&Whole {
            people: Paths::new("people", &people, 2)?,
            goals: &[Point::new(2.0, 0.0), Point::zeros()],
            arrival_times: None,
            robots: Paths::new("robots", &robots, 3)?,
            radii,
            time_limit: 20.0,
            rules: MetricRules {
                step: 0.1,
                ..MetricRules::of_people()
            },
        })
    };
    let found = whole(&[0.3; 3]).unwrap();
    assert!((found.throughput - 1.0 / 6.0).abs() < 1e-12);
    assert_eq!(found.deadlocked_share, 0.5);
    assert!((found.mean_person_speed - 20.0 / 80.0).abs() < 1e-12);
    assert!((found.aggregated_time - 21.7).abs() < 1e-9);
    assert_eq!(found.robot_contacts, 1);
    assert!(whole(&[0.3, -0.3, 0.3]).is_err());
}
