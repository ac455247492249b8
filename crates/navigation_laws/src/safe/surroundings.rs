//! Surroundings of the robot in the terms of the law, of the shield and of yielding.

use crate::Situation;
use crate::filters::{Filter, Near};
use crate::foresight::Sighting;
use crate::safe::boundary::boundary_obstacle;
use crate::safe::settings::SafeNavigation;
use crate::shield::{Guard, KnownVelocity, Person, StaticObstacles};
use crate::yielding::{Passerby, Yielder};
use navigation_world::world::geometry::Body;
use navigation_world::world::map::{MOST_POINTS, StaticMap};
use navigation_world::world::motion::BodyState;
use navigation_world::world::obstacle::{Regions, Shape};
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use navigation_world::world::shape::PlacedShape;
use numeric::lanes::Vector2;

/// Distance within which boundary points are shown to filters and to laws that choose velocities, in m.
const REACH: f64 = 5.0;

/// How an obstacle is dealt with.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ObstacleKind {
    /// Somebody, or something that moves.
    Person,
    /// A rectangle that stands.
    Wall,
    /// It stands, and all of it lies in the map, which shows it.
    Mapped,
}

/// Properties of an obstacle that are known before the run.
#[derive(Clone, Copy, Debug)]
struct KnownObstacle {
    kind: ObstacleKind,
    /// Regions for the law.
    regions: Regions,
    /// Largest speed that the shield reckons with, in m/s.
    max_speed: f64,
    /// Set for an obstacle that never moves.
    stationary: bool,
    /// Distance of the centers at contact in m.
    touch: f64,
}

/// Everything around the robot.
pub(super) struct Surroundings {
    known: Vec<KnownObstacle>,
    map: Option<StaticMap>,
    /// Share by which boundary points hide others, and how far they are looked for, in m.
    hiding: (f64, f64),
    /// Regions of a boundary point.
    boundary: Regions,
    points: Vec<[f64; 2]>,
    /// For the law: obstacles with its regions, then boundary points.
    pub bodies: Vec<Body>,
    /// For the shield.
    pub people: Vec<Person>,
    /// For the filter, if there is one: people, and the nearest points of what stands.
    pub near: Vec<Near>,
    pub nearest_points: Vec<Vector2<f64>>,
    filter: Option<Filter>,
    /// For yielding.
    pub passersby: Vec<Passerby>,
    /// For foresight.
    pub sightings: Vec<Sighting>,
    shapes: Vec<PlacedShape>,
}

impl Surroundings {
    /// Of a scenario as the law within knows it.
    pub fn new(family: &SafeNavigation, inner: &Scenario) -> Self {
        let map = family.map.clone();
        let people = inner.obstacles.len() - if map.is_some() { MOST_POINTS } else { 0 };
        let known = inner.obstacles[..people].iter();
        let boundary = boundary_obstacle(inner.robot.radius).regions;
        Self {
            known: known
                .map(|placed| KnownObstacle::of(family, placed))
                .collect(),
            map,
            hiding: if family.law.chooses_velocities() {
                (1.0, REACH)
            } else {
                (0.5, boundary.active_radius)
            },
            boundary,
            points: Vec::new(),
            bodies: Vec::new(),
            people: Vec::new(),
            near: Vec::new(),
            nearest_points: Vec::new(),
            filter: family.filter,
            passersby: Vec::new(),
            sightings: Vec::new(),
            shapes: Vec::new(),
        }
    }

    /// Static obstacles.
    pub fn walls(&self) -> StaticObstacles<'_> {
        StaticObstacles {
            shapes: &self.shapes,
            map: self.map.as_ref(),
        }
    }

    /// Whoever and whatever may stand, by outlines; `None` for what the map shows already.
    pub fn standing<'a>(
        &'a self,
        bodies: &'a [Body],
    ) -> impl Iterator<Item = Option<PlacedShape>> + Clone + 'a {
        bodies.iter().zip(&self.known).map(|(body, known)| {
            let counts = body.state.present && known.kind != ObstacleKind::Mapped;
            counts.then(|| PlacedShape {
                center: body.state.position.into(),
                shape: body.shape,
            })
        })
    }

    /// How far each obstacle can have come by a time in s from where it was measured, in m; 0 for what stands.
    pub fn reaches(&self, time: f64) -> Vec<f64> {
        let mut people = self.people.iter();
        let known = self.bodies.iter().zip(&self.known);
        let reach = known.map(|(body, known)| {
            let counts = body.state.present && known.kind == ObstacleKind::Person;
            let person = if counts { people.next() } else { None };
            let moving = person.filter(|person| person.max_speed > 0.0);
            moving.map_or(0.0, |person| person.reach(time))
        });
        reach.collect()
    }

    /// Brings everything to the present.
    pub fn look(
        &mut self,
        situation: &Situation<'_, f64>,
        guard: Option<&Guard>,
        yielder: Option<&Yielder>,
    ) {
        let robot = situation.robot.position;
        let looks_from = self.filter.and_then(|filter| filter.looks_at_walls_from());
        let looks_from = looks_from.map(|ahead| {
            let (sin, cos) = situation.heading.sin_cos();
            robot + Vector2::new(cos, sin) * ahead
        });
        let latency = guard.map_or(0.0, |guard| guard.shield.latency);
        let reach = yielder.map(|yielder| yielder.settings().reach);
        self.bodies.clear();
        self.people.clear();
        self.near.clear();
        self.nearest_points.clear();
        self.passersby.clear();
        self.sightings.clear();
        self.shapes.clear();
        let ages = situation.ages.iter().copied().chain(std::iter::repeat(0.0));
        let told = situation.bodies.iter().zip(&self.known).zip(ages);
        for (who, ((body, known), age)) in told.enumerate() {
            let present = body.state.present && known.kind != ObstacleKind::Mapped;
            self.bodies.push(Body {
                regions: known.regions,
                state: BodyState {
                    present,
                    ..body.state
                },
                ..*body
            });
            if !present {
                continue;
            }
            let placed = PlacedShape {
                center: body.state.position.into(),
                shape: body.shape,
            };
            if known.kind == ObstacleKind::Wall {
                if let Some(place) = looks_from {
                    let away = placed.shape.offset(place - placed.center);
                    self.nearest_points.push(place - away);
                }
                self.shapes.push(placed);
                continue;
            }
            if self.filter.is_some() {
                self.near.push(Near {
                    position: placed.center,
                    velocity: body.state.velocity.into(),
                    radius: match body.shape {
                        Shape::Disc { radius } => radius,
                        Shape::Rectangle {
                            half_length,
                            half_width,
                            ..
                        } => half_length.hypot(half_width),
                    },
                });
            }
            if let Some(guard) = guard {
                self.people.push(known.person(placed, body, guard, age));
            }
            let velocity = Vector2::from(body.state.velocity);
            self.sightings.push(Sighting {
                who,
                position: placed.center,
                velocity,
                instant: situation.time - age,
                age: latency.max(age),
                touch: known.touch,
            });
            let offset = placed.center - robot + velocity * latency.max(age);
            if reach.is_some_and(|reach| offset.norm() - known.touch < reach) {
                self.passersby.push(Passerby {
                    offset,
                    velocity,
                    touch: known.touch,
                });
            }
        }
        self.show_boundary(robot);
        if let Some((place, map)) = looks_from.zip(self.map.as_ref()) {
            map.boundary_points(place, REACH, 1.0, &mut self.points);
            let known = self.points.iter().map(|point| Vector2::from(*point));
            self.nearest_points.extend(known);
        }
    }

    /// Boundary points of the map as bodies for the law; the others of them are absent.
    fn show_boundary(&mut self, robot: Vector2<f64>) {
        let Some(map) = &self.map else {
            return;
        };
        let (kappa, reach) = self.hiding;
        map.boundary_points(robot, reach, kappa, &mut self.points);
        let present = self.points.iter().map(|point| (*point, true));
        let absent = std::iter::repeat(([0.0; 2], false));
        for (position, present) in present.chain(absent).take(MOST_POINTS) {
            self.bodies.push(Body {
                shape: Shape::Disc { radius: 0.0 },
                regions: self.boundary,
                state: BodyState {
                    position,
                    velocity: [0.0; 2],
                    acceleration: [0.0; 2],
                    present,
                },
            });
        }
    }
}

impl KnownObstacle {
    fn of(family: &SafeNavigation, placed: &PlacedObstacle) -> Self {
        let near = family
            .critical_distance
            .map(|distance| placed.contact_distance + distance);
        let own = placed.regions.critical_radius;
        let regions = Regions {
            critical_radius: near.map_or(own, |near| near.min(own)),
            ..placed.regions
        };
        let bound = family.shield.and_then(|shield| shield.person_speed);
        let scene = placed.fastest();
        // Half the diagonal of a rectangle that moves: yielding knows discs only.
        let (rectangle, around) = match placed.obstacle.shape {
            Shape::Disc { .. } => (false, 0.0),
            Shape::Rectangle {
                half_length,
                half_width,
                ..
            } => (true, half_length.hypot(half_width)),
        };
        let place = PlacedShape {
            center: placed.obstacle.motion.at(0.0, &mut 0).position.into(),
            shape: placed.obstacle.shape,
        };
        let mapped = |map: &StaticMap| map.holds(&place);
        let kind = if placed.stationary && family.map.as_ref().is_some_and(mapped) {
            ObstacleKind::Mapped
        } else if placed.stationary && rectangle {
            ObstacleKind::Wall
        } else {
            ObstacleKind::Person
        };
        Self {
            kind,
            regions,
            max_speed: if placed.stationary {
                0.0
            } else {
                bound.unwrap_or(scene)
            },
            stationary: placed.stationary,
            touch: placed.contact_distance + around,
        }
    }

    /// Person that the shield assumes for an obstacle that was measured `age` seconds ago: the older the measurement,
    /// the larger its reach.
    fn person(&self, placed: PlacedShape, body: &Body, guard: &Guard, age: f64) -> Person {
        let shield = &guard.shield;
        let velocity = Vector2::from(body.state.velocity);
        let known = |[error, acceleration]: [f64; 2]| KnownVelocity {
            velocity,
            error,
            acceleration,
        };
        // What never moves is known exactly, as sensors have it.
        Person {
            placed,
            position_error: if self.stationary {
                0.0
            } else {
                shield.position_error
            },
            max_speed: self.max_speed,
            latency: shield.latency.max(age),
            known: shield
                .velocity_bounds
                .filter(|_| !self.stationary)
                .map(known),
        }
    }
}
