//! Random states of a robot among obstacles, and what they look like from another frame.

use std::f64::consts::PI;

use proptest::prelude::*;
use vff_core::laws::VirtualForceField;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::{Cap, Stabilizing};
use vff_core::robots::HolonomicRobot;
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

pub fn plus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

pub fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

pub fn times(factor: f64, a: [f64; 2]) -> [f64; 2] {
    [factor * a[0], factor * a[1]]
}

pub fn length(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

fn polar(radius: f64, angle: f64) -> [f64; 2] {
    [radius * angle.cos(), radius * angle.sin()]
}

/// Another frame: mirrored if `hand` is -1, turned, shifted.
pub struct Frame {
    pub angle: f64,
    pub shift: [f64; 2],
    pub hand: f64,
}

impl Frame {
    /// A direction as it is seen from there.
    pub fn direction(&self, vector: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        let [x, y] = [vector[0], self.hand * vector[1]];
        [cos * x - sin * y, sin * x + cos * y]
    }

    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        plus(self.direction(point), self.shift)
    }
}

/// An obstacle by its numbers, so that it can be moved.
#[derive(Clone, Debug)]
enum Body {
    Disc {
        center: [f64; 2],
        velocity: [f64; 2],
        acceleration: [f64; 2],
        limits: Limits,
    },
    Rectangle {
        center: [f64; 2],
        sides: [f64; 2],
        heading: f64,
        limits: Limits,
    },
    Given(Obstacle),
}

impl Body {
    fn seen_from(&self, frame: &Frame) -> Self {
        let mut body = self.clone();
        match &mut body {
            Self::Disc {
                center,
                velocity,
                acceleration,
                ..
            } => {
                *center = frame.place(*center);
                *velocity = frame.direction(*velocity);
                *acceleration = frame.direction(*acceleration);
            }
            Self::Rectangle {
                center, heading, ..
            } => {
                *center = frame.place(*center);
                *heading = frame.hand * *heading + frame.angle;
            }
            Self::Given(_) => {}
        }
        body
    }

    fn obstacle(&self) -> Obstacle {
        match self {
            Self::Disc {
                center,
                velocity,
                acceleration,
                limits,
            } => {
                let motion = Motion::moving(*center, *velocity, *acceleration, None).unwrap();
                Obstacle::disc(0.1, motion, *limits).unwrap()
            }
            Self::Rectangle {
                center,
                sides,
                heading,
                limits,
            } => Obstacle::rectangle(*center, *sides, *heading, *limits).unwrap(),
            Self::Given(obstacle) => obstacle.clone(),
        }
    }
}

/// A robot in motion, its goal and the obstacles, which are where they say at time 0.
#[derive(Clone, Debug)]
pub struct State {
    pub position: [f64; 2],
    pub velocity: [f64; 2],
    pub time: f64,
    goal: [f64; 2],
    bodies: Vec<Body>,
}

impl State {
    /// A state among given obstacles at time 0.
    pub fn beside(
        position: [f64; 2],
        velocity: [f64; 2],
        goal: [f64; 2],
        obstacles: Vec<Obstacle>,
    ) -> Self {
        Self {
            position,
            velocity,
            time: 0.0,
            goal,
            bodies: obstacles.into_iter().map(Body::Given).collect(),
        }
    }

    /// The state in another frame.
    pub fn seen_from(&self, frame: &Frame) -> Self {
        Self {
            position: frame.place(self.position),
            velocity: frame.direction(self.velocity),
            goal: frame.place(self.goal),
            bodies: self
                .bodies
                .iter()
                .map(|body| body.seen_from(frame))
                .collect(),
            time: self.time,
        }
    }

    /// A robot that starts at the state's position, or nothing if that is not allowed.
    pub fn scenario(&self) -> Option<Scenario> {
        let bodies = self.bodies.iter().map(Body::obstacle).collect();
        let rules = Rules {
            time_limit: 6.0,
            ..Rules::default()
        };
        Scenario::new(
            HolonomicRobot::default(),
            self.position,
            self.goal,
            bodies,
            rules,
        )
        .ok()
        .filter(|scenario| scenario.with_free_goal().is_ok())
    }

    /// Whether a disc lies between robot and goal to 1e-6 rad, where rounding decides the side.
    pub fn is_in_line(&self) -> bool {
        self.bodies.iter().any(|body| match body {
            Body::Disc { center, .. } => {
                let (d, w) = (minus(self.position, *center), minus(self.goal, *center));
                let angle = (d[0] * w[1] - d[1] * w[0]).atan2(d[0] * w[0] + d[1] * w[1]);
                PI - angle.abs() < 1e-6
            }
            _ => false,
        })
    }
}

/// Which obstacles there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Discs at rest, moving and accelerating, and rectangles.
    Any,
    /// Discs only, at least 0.1 m outside their critical regions.
    Discs,
}

fn disc(robot: [f64; 2], least_gap: f64) -> impl Strategy<Value = Body> {
    let radii = (0.35..0.8, 0.5..1.5);
    let place = (0.0..1.2, -PI..PI);
    let motion = (0.0..1.2, -PI..PI, 0.0..1.0, -PI..PI);
    (radii, place, motion, 0..3).prop_map(
        move |((critical, wide), (share, bearing), motion, kind)| {
            let (speed, course, growth, pull) = motion;
            let limits = Limits {
                critical_radius: Some(critical),
                active_radius: Some(critical + wide),
                max_speed: None,
            };
            let distance = critical + least_gap + (wide - least_gap) * share;
            Body::Disc {
                center: plus(robot, polar(distance, bearing)),
                velocity: if kind > 0 {
                    polar(speed, course)
                } else {
                    [0.0; 2]
                },
                acceleration: if kind > 1 {
                    polar(growth, pull)
                } else {
                    [0.0; 2]
                },
                limits,
            }
        },
    )
}

fn rectangle(robot: [f64; 2]) -> impl Strategy<Value = Body> {
    let radii = (0.25..0.5, 0.3..1.0);
    let sides = prop::array::uniform2(0.2..1.5);
    (radii, sides, -PI..PI, 0.005..0.8, -PI..PI).prop_map(
        move |((critical, wide), sides, heading, share, bearing)| {
            let limits = Limits {
                critical_radius: Some(critical),
                active_radius: Some(critical + wide),
                max_speed: None,
            };
            let reach = 0.5 * length(sides);
            Body::Rectangle {
                center: plus(robot, polar(reach + critical + wide * share, bearing)),
                sides,
                heading,
                limits,
            }
        },
    )
}

/// A robot at up to its largest speed, outside every critical region.
pub fn any_state(kind: Kind) -> impl Strategy<Value = State> {
    let robot = prop::array::uniform2(-3.0..3.0);
    (robot, 0.0..0.7, -PI..PI, 1.5..5.0, -PI..PI).prop_flat_map(
        move |(position, speed, course, far, bearing)| {
            let bodies = match kind {
                Kind::Any => {
                    let mixed = prop_oneof![3 => disc(position, 0.005), 1 => rectangle(position)];
                    prop::collection::vec(mixed, 1..4).boxed()
                }
                Kind::Discs => prop::collection::vec(disc(position, 0.1), 1..4).boxed(),
            };
            bodies.prop_map(move |bodies| State {
                position,
                velocity: polar(speed, course),
                // Room to look back from.
                time: if kind == Kind::Discs { 1e-3 } else { 0.0 },
                goal: plus(position, polar(far, bearing)),
                bodies,
            })
        },
    )
}

/// Gains around those of the source, the stabilizing force absent or capped.
pub fn any_law() -> impl Strategy<Value = VirtualForceField> {
    let gains = (1.0..15.0, 1.0..100.0, 1.0..300.0, 0.0..1.0);
    (gains, any::<bool>()).prop_map(|((attractive, repulsive, detour, ratio), pass_behind)| {
        VirtualForceField {
            gains: Gains {
                attractive,
                repulsive,
                detour,
                ratio,
            },
            stabilizing: if pass_behind {
                Stabilizing::Off
            } else {
                Stabilizing::Capped(Cap::Force(10.0))
            },
            rules: SideRules {
                pass_behind,
                hysteresis: f64::INFINITY,
            },
        }
    })
}
