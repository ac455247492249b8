//! Rectangles that move: the rates of the nearest point, the ground that they sweep, and what a shield
//! assumes of them, against differences and brute force.

use nalgebra::Vector2;
use proptest::prelude::*;
use vff_core::laws::planning::footprint::Footprint;
use vff_core::laws::shield::{
    BrakingPlan, Guard, Person, Shield, ShieldLimits, StaticObstacles, TrackingError, View,
};
use vff_core::world::geometry::{Approach, Body, RobotState};
use vff_core::world::map::StaticMap;
use vff_core::world::motion::BodyState;
use vff_core::world::obstacle::{PlacedShape, Regions, Shape};

type Vector = Vector2<f64>;

/// Step of the differences in s.
const STEP: f64 = 1e-6;

fn body(sides: [f64; 2], heading: f64, place: Vector, velocity: Vector) -> Body {
    Body {
        shape: Shape::turned(sides, heading),
        regions: Regions {
            critical_radius: 0.1,
            active_radius: 50.0,
        },
        state: BodyState {
            position: place.into(),
            velocity: velocity.into(),
            acceleration: [0.0; 2],
            present: true,
        },
    }
}

fn seen(body: &Body, robot: RobotState<f64>, goal: Vector) -> Approach<f64> {
    Approach::new(body, body.offset(robot.position), true, &robot, goal)
}

/// Everything a time later.
fn later(body: &Body, robot: RobotState<f64>, time: f64) -> (Body, RobotState<f64>) {
    let mut moved = *body;
    for axis in 0..2 {
        moved.state.position[axis] += time * body.state.velocity[axis];
    }
    let position = robot.position + robot.velocity * time;
    (moved, RobotState { position, ..robot })
}

fn pair(most: f64) -> impl Strategy<Value = Vector> {
    (-most..most, -most..most).prop_map(|(x, y)| Vector2::new(x, y))
}

/// Corners of a rectangle, counter-clockwise.
fn corners(body: &Body, way: Vector) -> [Vector; 4] {
    let placed = PlacedShape {
        center: Vector2::from(body.state.position) + way,
        shape: body.shape,
    };
    let [one, two, three, four] = placed.corners();
    [one, two, four, three]
}

/// Distance of a point from a polygon by its sides, 0 inside.
fn from_polygon(corners: &[Vector], point: Vector) -> f64 {
    let sides = (0..corners.len()).map(|side| (corners[side], corners[(side + 1) % corners.len()]));
    let turns: Vec<f64> = sides
        .clone()
        .map(|(a, b)| (b - a).perp(&(point - a)))
        .collect();
    if turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0) {
        return 0.0;
    }
    let from_side = |(a, b): (Vector, Vector)| {
        let along = b - a;
        let share = ((point - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (a + along * share - point).norm()
    };
    sides.map(from_side).fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    /// Distance, bearing and the direction to the goal change at the rates that the laws are told.
    #[test]
    fn rates_are_the_differences_of_what_they_are_rates_of(
        sides in (0.2..2.0f64, 0.2..2.0f64), heading in -3.0..3.0f64, place in pair(1.0),
        own in pair(1.5), position in pair(4.0), velocity in pair(1.5), goal in pair(6.0),
    ) {
        let body = body([sides.0, sides.1], heading, place, own);
        let robot = RobotState { position, velocity };
        let now = seen(&body, robot, goal);
        prop_assume!(now.distance > 0.05 && now.to_goal.norm() > 0.2);
        let [(body_a, robot_a), (body_b, robot_b)] = [-STEP, STEP].map(|time| later(&body, robot, time));
        let (before, after) = (seen(&body_a, robot_a, goal), seen(&body_b, robot_b, goal));
        let rate = (after.distance - before.distance) / (2.0 * STEP);
        prop_assert!((rate - now.range_rate).abs() < 1e-5, "{rate} {}", now.range_rate);
        let turned = |one: Vector, other: Vector| one.perp(&other).atan2(one.dot(&other)) / (2.0 * STEP);
        // A border between face and corner lies within the step: neither side's rate is right there.
        let bearing = turned(before.outward, after.outward);
        let even = (seen(&body_a, robot_a, goal).bearing_rate - after.bearing_rate).abs() < 1e-3;
        prop_assume!(even);
        prop_assert!((bearing - now.bearing_rate).abs() < 1e-4, "{bearing} {}", now.bearing_rate);
        let aim = turned(before.to_goal, after.to_goal);
        prop_assert!((aim - now.goal_bearing_rate).abs() < 1e-4, "{aim} {}", now.goal_bearing_rate);
    }

    /// The ground of a rectangle on its way is the union of where it is.
    #[test]
    fn a_footprint_is_the_ground_that_is_swept(
        sides in (0.2..2.0f64, 0.2..2.0f64), heading in -3.0..3.0f64, place in pair(1.0),
        own in pair(2.0), axis in 0..3usize, point in pair(4.0),
    ) {
        // Along a side too, where corners of the hull fall together.
        let own = [own, Vector2::new(heading.cos(), heading.sin()) * own.x, Vector::zeros()][axis];
        let body = body([sides.0, sides.1], heading, place, own);
        let time = 0.8;
        let footprint = Footprint::of(&body, [0.0; 2], 0.2, time).unwrap();
        let samples = 400;
        let least = (0..=samples)
            .map(|n| from_polygon(&corners(&body, own * (time * f64::from(n) / f64::from(samples))), point))
            .fold(f64::INFINITY, f64::min);
        let found = footprint.core_distance(point.into());
        let coarse = own.norm() * time / f64::from(samples);
        prop_assert!(found <= least + 1e-9 && found >= least - coarse - 1e-9, "{found} {least}");
    }

    /// Whatever a rectangle does within its speed, the robot does not move toward it while they touch.
    #[test]
    fn a_verified_plan_is_passively_safe_from_rectangles(
        sides in (0.2..2.0f64, 0.2..2.0f64), heading in -3.0..3.0f64, place in pair(1.6),
        velocity in pair(0.8), command in pair(0.8), speed in 0.2..2.0f64,
    ) {
        let limits = ShieldLimits { radius: 0.2, max_speed: 1.2, max_acceleration: 3.0, period: 0.1 };
        let guard = Guard::new(Shield::default(), limits).unwrap();
        let robot = RobotState { position: Vector::zeros(), velocity };
        let command = guard.clipped(&robot, command);
        let people = [Person {
            placed: PlacedShape { center: place, shape: Shape::turned([sides.0, sides.1], heading) },
            max_speed: speed,
            ..Person::disc([0.0; 2], 1.0)
        }];
        let view = View { robot, people: &people, walls: StaticObstacles::NONE, hidden: None };
        prop_assume!(guard.verified(&view, command));
        let plan = BrakingPlan::new(&robot, command, &guard.limits, TrackingError::EXACT);
        for step in 0..=60 {
            let time = plan.end() * f64::from(step) / 60.0;
            let at = plan.position(time);
            let moved = plan.position(time + 1e-6) - plan.position(time - 1e-6);
            let velocity = if time < 1e-6 { robot.velocity } else { moved / 2e-6 };
            for course in 0..48 {
                let angle = f64::from(course) * std::f64::consts::TAU / 48.0;
                let way = Vector2::new(angle.cos(), angle.sin()) * (speed * time);
                let to = PlacedShape { center: place + way, ..people[0].placed }.nearest(at);
                prop_assert!(to.norm() > limits.radius || velocity.dot(&to) <= 1e-6, "{time} {angle}");
            }
        }
    }

    /// A map with shapes added is as far away as the nearest of them.
    #[test]
    fn shapes_in_a_map_are_as_far_as_they_are(
        sides in (0.2..2.0f64, 0.2..2.0f64), heading in -3.0..3.0f64, place in pair(2.0), point in pair(4.0),
    ) {
        let rectangle = PlacedShape { center: place, shape: Shape::turned([sides.0, sides.1], heading) };
        let disc = PlacedShape::disc([1.0, -1.0], 0.3);
        let map = StaticMap::default().with_shapes(&[disc, rectangle]);
        let least = disc.distance(point).min(rectangle.distance(point));
        prop_assert!((map.clearance(point) - least).abs() < 1e-12);
    }
}
