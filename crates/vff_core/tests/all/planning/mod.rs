//! What the tests of the planners share: scenes, runs, and the worlds of the BARN data set.

use std::path::{Path, PathBuf};

use serde_json::Value;
use vff_core::lanes::{Planar, Vector2};
use vff_core::laws::planning::Planner;
use vff_core::laws::{Scan, Situation, Stop};
use vff_core::robots::HolonomicRobot;
use vff_core::world::geometry::{Body, RobotState};
use vff_core::world::motion::BodyState;
use vff_core::world::obstacle::{Limits, Obstacle, Regions, Shape};
use vff_core::world::scenario::{Rules, Scenario};

/// Half the width of the robot that the worlds are made for, in m.
pub const BARN_RADIUS: f64 = 0.165;

/// A body in the scene.
pub fn body(shape: Shape, position: [f64; 2], velocity: [f64; 2]) -> Body {
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

/// What a planner is told.
pub fn situation(bodies: &[Body], position: [f64; 2], velocity: [f64; 2]) -> Situation<'_, f64> {
    Situation {
        time: 0.0,
        ages: &[],
        heading: 0.0,
        bodies,
        robot: RobotState {
            position: Vector2::splat(position),
            velocity: Vector2::splat(velocity),
        },
        interval: 0.06,
        scan: Scan::default(),
        stop: Stop::never(),
    }
}

/// Velocities that a planner, made for a start and a goal, wants at three instants among discs with
/// places and velocities, everything shifted by as much.
pub fn shifted_velocities<P: Planner>(
    planner: impl Fn([f64; 2], [f64; 2]) -> P,
    discs: &[(f64, f64, f64, f64)],
    robot: (f64, f64),
    shift: [f64; 2],
) -> [[f64; 2]; 3] {
    let moved = |place: [f64; 2]| [place[0] + shift[0], place[1] + shift[1]];
    let mut planner = planner(moved([4.0, 0.0]), moved([0.0; 2]));
    [0.0, 0.0625, 0.125].map(|time| {
        let bodies: Vec<_> = discs
            .iter()
            .map(|&(x, y, u, v)| {
                let place = moved([x + u * time, y + v * time]);
                body(Shape::Disc { radius: 0.25 }, place, [u, v])
            })
            .collect();
        let place = moved([robot.0 - time, robot.1]);
        planner.desired_velocity(&situation(&bodies, place, [-0.5, 0.0]))
    })
}

/// A scenario of a robot of a radius.
pub fn scene(start: [f64; 2], goal: [f64; 2], radius: f64, obstacles: Vec<Obstacle>) -> Scenario {
    let robot = HolonomicRobot {
        radius,
        ..HolonomicRobot::default()
    };
    Scenario::new(robot, start, goal, obstacles, Rules::default()).unwrap()
}

/// What came of a ride.
pub struct Ride {
    /// When the robot was first within 0.12 m of the goal, in s.
    pub arrival: Option<f64>,
    pub touched: bool,
    /// Least distance of each obstacle's center or contour.
    pub distances: Vec<f64>,
}

/// Drives a scenario with a planner: a velocity every 0.06 s, steps of 0.01 s, the limits of the
/// robot, 60 s at most.
pub fn drive(scenario: &Scenario, ends: [[f64; 2]; 2], planner: &mut impl Planner) -> Ride {
    let robot = HolonomicRobot::default();
    let mut place = Vector2::<f64>::splat(ends[0]);
    let mut velocity = Vector2::zeros();
    let mut ride = Ride {
        arrival: None,
        touched: false,
        distances: vec![f64::INFINITY; scenario.obstacle_count()],
    };
    let mut force = Vector2::zeros();
    for step in 0..6_000u32 {
        let time = 0.01 * f64::from(step);
        let bodies = scenario.obstacles().iter().map(|placed| Body {
            shape: placed.obstacle.shape,
            regions: placed.regions,
            state: placed.obstacle.motion.at(time, &mut 0),
        });
        let bodies: Vec<_> = bodies.collect();
        for (index, placed) in scenario.obstacles().iter().enumerate() {
            let center = bodies[index].state.position;
            let distance = placed.obstacle.distance(center, [place.x, place.y]);
            ride.distances[index] = ride.distances[index].min(distance);
            ride.touched |= distance <= placed.contact_distance;
        }
        if (place.x - ends[1][0]).hypot(place.y - ends[1][1]) <= 0.12 {
            ride.arrival = Some(time);
            break;
        }
        if step % 6 == 0 {
            let known = situation(&bodies, [place.x, place.y], [velocity.x, velocity.y]);
            let wanted = Vector2::splat(planner.desired_velocity(&known));
            force = (wanted - velocity) * (robot.mass / 0.06);
        }
        velocity += robot.acceleration(force) * 0.01;
        velocity = robot.limited_velocity(velocity).0;
        place += velocity * 0.01;
    }
    ride
}

/// A field of cylinders.
pub struct World {
    pub id: u64,
    pub start: [f64; 2],
    pub goal: [f64; 2],
    pub cylinders: Vec<[f64; 2]>,
    pub radius: f64,
    pub path_length: f64,
}

impl World {
    pub fn shape(&self) -> Shape {
        Shape::Disc {
            radius: self.radius,
        }
    }

    pub fn bodies(&self) -> Vec<Body> {
        let place = |center: &[f64; 2]| body(self.shape(), *center, [0.0; 2]);
        self.cylinders.iter().map(place).collect()
    }

    pub fn obstacles(&self) -> Vec<Obstacle> {
        let limits = Limits {
            critical_radius: Some(0.3),
            active_radius: Some(0.4),
            max_speed: None,
        };
        let place =
            |center: &[f64; 2]| Obstacle::disc_at_rest(*center, self.radius, limits).unwrap();
        self.cylinders.iter().map(place).collect()
    }

    /// Least distance of a path from the center of a cylinder.
    pub fn least_distance(&self, path: &[[f64; 2]]) -> f64 {
        let legs = path.windows(2);
        legs.flat_map(|leg| {
            let centers = self.cylinders.iter();
            centers.map(|center| distance_to_leg(*center, leg[0], leg[1]))
        })
        .fold(f64::INFINITY, f64::min)
    }
}

/// Distance of a point from a segment.
pub fn distance_to_leg(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let (along, offset) = (
        [to[0] - from[0], to[1] - from[1]],
        [point[0] - from[0], point[1] - from[1]],
    );
    let square = along[0].powi(2) + along[1].powi(2);
    let share = (along[0] * offset[0] + along[1] * offset[1]) / square.max(f64::MIN_POSITIVE);
    let share = share.clamp(0.0, 1.0);
    (offset[0] - share * along[0]).hypot(offset[1] - share * along[1])
}

fn shared() -> PathBuf {
    let beside = || {
        let repository = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(3);
        repository.unwrap().join("shared")
    };
    std::env::var_os("HRSAFETY_SHARED").map_or_else(beside, PathBuf::from)
}

fn pair(value: &Value) -> [f64; 2] {
    [0, 1].map(|i| value[i].as_f64().unwrap())
}

/// The worlds, or `None` where the data are absent.
pub fn barn() -> Option<Vec<World>> {
    let path = shared().join("data/barn/barn_even.json");
    let Ok(text) = std::fs::read_to_string(&path) else {
        println!("skipped: the BARN worlds are absent; HRSAFETY_SHARED names their folder");
        return None;
    };
    let file: Value = serde_json::from_str(&text).unwrap();
    let world = |entry: &Value| World {
        id: entry["id"].as_u64().unwrap(),
        start: pair(&file["start_pose"]),
        goal: pair(&file["goal"]),
        cylinders: entry["cyl_mm"]
            .as_array()
            .unwrap()
            .iter()
            .map(|center| pair(center).map(|millimeters| 1e-3 * millimeters))
            .collect(),
        radius: file["cylinder_radius_m"].as_f64().unwrap(),
        path_length: entry["path_length_m"].as_f64().unwrap(),
    };
    Some(
        file["worlds"]
            .as_array()
            .unwrap()
            .iter()
            .map(world)
            .collect(),
    )
}
