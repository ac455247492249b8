//! One control step of the planners over a grid and with a tree, on the straight way from start to
//! goal: things at rest, a person as well, twelve moving discs, and a goal that is walled in.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use vff_core::lanes::{Planar, Vector2};
use vff_core::laws::field_d_star::{FieldDStar, FieldDStarPlanner};
use vff_core::laws::planning::Planner;
use vff_core::laws::tree::{RapidlyExploringRandomTree, TreePlanner};
use vff_core::laws::{Scan, Situation, Stop};
use vff_core::robots::HolonomicRobot;
use vff_core::world::geometry::{Body, RobotState};
use vff_core::world::motion::BodyState;
use vff_core::world::obstacle::{Regions, Shape};
use vff_core::world::scenario::{Rules, Scenario};

/// Control steps that are looped over: a way of 3 m at 0.7 m/s.
const STEPS: usize = 72;
const PERIOD: f64 = 0.06;

fn body(shape: Shape, position: [f64; 2], velocity: [f64; 2]) -> Body {
    Body {
        shape,
        regions: Regions {
            critical_radius: 0.4,
            active_radius: 0.8,
        },
        state: BodyState {
            position,
            velocity,
            acceleration: [0.0; 2],
            present: true,
        },
    }
}

fn disc(radius: f64, position: [f64; 2], velocity: [f64; 2]) -> Body {
    body(Shape::Disc { radius }, position, velocity)
}

/// What is in the way at a time.
type Scene = fn(f64) -> Vec<Body>;

/// Rectangle and disc of configuration 3.
fn at_rest(_time: f64) -> Vec<Body> {
    let table = Shape::Rectangle {
        half_length: 0.7,
        half_width: 0.3,
        axis: [1.0, 0.0].into(),
    };
    vec![
        body(table, [2.3, 0.0], [0.0; 2]),
        disc(0.1, [2.45, 1.4], [0.0; 2]),
    ]
}

/// The same and a person who crosses at 1 m/s.
fn with_person(time: f64) -> Vec<Body> {
    let mut bodies = at_rest(time);
    bodies.push(disc(0.4, [0.6 + time, 1.3 - 0.2 * time], [1.0, -0.2]));
    bodies
}

/// Twelve discs that cross at 0.3 to 0.8 m/s.
fn crowd(time: f64) -> Vec<Body> {
    (0..12u32)
        .map(|number| {
            let angle = 2.4 * f64::from(number);
            let speed = 0.3 + 0.04 * f64::from(number);
            let velocity = [-speed * angle.cos(), -speed * angle.sin()];
            let far = 3.0 - speed * time;
            let place = [2.0 + far * angle.cos(), 0.6 + far * angle.sin()];
            disc(0.3, place, velocity)
        })
        .collect()
}

/// A ring of discs around the goal.
fn closed(_time: f64) -> Vec<Body> {
    (0..24u32)
        .map(|number| f64::from(number) * std::f64::consts::TAU / 24.0)
        .map(|angle| (angle.cos(), angle.sin()))
        .map(|(x, y)| disc(0.1, [x, 0.6 + y], [0.0; 2]))
        .collect()
}

fn measure<P: Planner>(
    criterion: &mut Criterion,
    name: &str,
    scene: Scene,
    make: impl Fn(&Scenario) -> P,
) {
    let robot = HolonomicRobot::default();
    let ends = ([3.9, 0.6], [0.0, 0.6]);
    let scenario = Scenario::new(robot, ends.0, ends.1, Vec::new(), Rules::default()).unwrap();
    let steps: Vec<_> = (0..STEPS)
        .map(|step| PERIOD * step as f64)
        .map(|time| ([3.9 - 0.7 * time, 0.6], scene(time)))
        .collect();
    let mut planner = make(&scenario);
    let mut step = 0;
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| {
            let (position, bodies) = &steps[step];
            step = (step + 1) % STEPS;
            planner.desired_velocity(black_box(&Situation {
                time: 0.0,
                ages: &[],
                heading: 0.0,
                bodies,
                robot: RobotState {
                    position: Vector2::splat(*position),
                    velocity: Vector2::splat([-0.7, 0.0]),
                },
                interval: PERIOD,
                scan: Scan::default(),
                stop: Stop::never(),
            }))
        });
    });
}

fn planners(criterion: &mut Criterion) {
    let scenes: [(&str, Scene); 4] = [
        ("at_rest", at_rest),
        ("with_person", with_person),
        ("crowd_of_12", crowd),
        ("closed", closed),
    ];
    for (name, scene) in scenes {
        for resolution in [0.1, 0.05] {
            let parameters = FieldDStar {
                resolution,
                ..FieldDStar::default()
            };
            measure(
                criterion,
                &format!("field_d_star/{resolution}/{name}"),
                scene,
                |scenario| FieldDStarPlanner::new(parameters, scenario).unwrap(),
            );
        }
        measure(criterion, &format!("tree/{name}"), scene, |scenario| {
            TreePlanner::new(RapidlyExploringRandomTree::default(), scenario).unwrap()
        });
    }
}

criterion_group!(benches, planners);
criterion_main!(benches);
