//! Safe navigation at work on one robot.

use crate::error::Result;
use crate::lanes::Vector2;
use crate::laws::safe::SafeNavigation;
use crate::laws::safe::takeover::{Progress, straight};
use crate::laws::shield::{Decision, Guard, KnownVelocity, Limits, Person, Status, View, Walls};
use crate::laws::yielding::{Outlook, Passerby, Yielder};
use crate::laws::{Command, Situation};
use crate::run::Steering;
use crate::world::geometry::{Body, RobotState};
use crate::world::obstacle::{Regions, Shape};
use crate::world::scenario::{PlacedObstacle, Scenario};
use crate::world::shape::PlacedShape;

/// What the parts did in the last control period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace {
    /// Velocity that the law wanted, within its limit, in m/s.
    pub wanted: Vector2<f64>,
    /// Velocity that is commanded in m/s.
    pub command: Vector2<f64>,
    /// Whether the law was taken over from.
    pub taken_over: bool,
    /// What became of the wanted velocity.
    pub status: Status,
}

/// What is known of an obstacle before the run.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// Regions for the law.
    regions: Regions,
    /// Largest speed that the shield reckons with, in m/s.
    max_speed: f64,
    /// Whether it is a rectangle that stands.
    wall: bool,
    /// Whether it never moves.
    stationary: bool,
    /// Distance of the centers at contact in m.
    touch: f64,
}

/// A law with its parts.
pub struct SafeLaw {
    law: Box<dyn Steering>,
    guard: Option<Guard>,
    yielder: Option<Yielder>,
    progress: Option<Progress>,
    limits: Limits,
    /// Largest speed of the law in m/s.
    preferred: f64,
    mass: f64,
    goal: Vector2<f64>,
    known: Vec<Known>,
    trace: Trace,
    bodies: Vec<Body>,
    people: Vec<Person>,
    passersby: Vec<Passerby>,
    walls: Vec<PlacedShape>,
}

impl SafeLaw {
    /// The law at work in a scenario.
    pub(super) fn new(
        family: &SafeNavigation,
        gains: &[f64],
        scenario: &Scenario,
        record: bool,
    ) -> Result<Self> {
        let inner = family.inner(scenario)?;
        let robot = &scenario.robot;
        let limits = Limits {
            radius: robot.radius,
            max_speed: robot.max_speed,
            max_acceleration: robot.max_acceleration,
            period: scenario.rules.control_period,
        };
        let guard = |shield| Guard::new(shield, limits);
        let yielder = |yielding| Yielder::new(yielding, limits);
        let known = |placed: &PlacedObstacle| Known::of(family, placed);
        let zero = Vector2::zeros();
        Ok(Self {
            law: family.law.driven().steering_with(gains, &inner, record)?,
            guard: family.shield.map(guard).transpose()?,
            yielder: family.yielding.map(yielder).transpose()?,
            progress: family.takeover.map(Progress::new),
            limits,
            preferred: inner.robot.max_speed,
            mass: robot.mass,
            goal: scenario.goal.into(),
            known: inner.obstacles.iter().map(known).collect(),
            trace: Trace {
                wanted: zero,
                command: zero,
                taken_over: false,
                status: Status::Kept,
            },
            bodies: Vec::new(),
            people: Vec::new(),
            passersby: Vec::new(),
            walls: Vec::new(),
        })
    }

    /// What the parts did in the last control period.
    #[must_use]
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Force for the time until the next sample.
    pub(super) fn command(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        self.set_period(situation.interval);
        self.look_around(situation);
        let command = self.law.command(&Situation {
            bodies: &self.bodies,
            ..*situation
        });
        let robot = situation.robot;
        let asked = robot.velocity + command.force * (situation.interval / self.mass);
        let mut wanted = slowed(asked, self.preferred);
        let to_goal = self.goal - robot.position;
        let taken_over = self
            .progress
            .as_mut()
            .is_some_and(|watch| watch.stalls(to_goal.norm(), situation.time, self.preferred));
        if taken_over {
            let period = situation.interval;
            let acceleration = self.limits.max_acceleration;
            wanted = straight(to_goal, self.preferred, acceleration, period);
        }
        let decision = self.decide(&robot, wanted, to_goal);
        self.trace = Trace {
            wanted,
            command: decision.velocity,
            taken_over,
            status: decision.status,
        };
        if decision.status == Status::Kept && wanted == asked {
            return command;
        }
        let change = decision.velocity - robot.velocity;
        Command::plain(change * (self.mass / situation.interval))
    }

    /// Where the force is not held, it acts for a motion step only.
    fn set_period(&mut self, period: f64) {
        self.limits.period = period;
        if let Some(guard) = &mut self.guard {
            guard.limits.period = period;
        }
        if let Some(yielder) = &mut self.yielder {
            yielder.limits.period = period;
        }
    }

    /// Yielding, then the shield.
    fn decide(
        &self,
        robot: &RobotState<f64>,
        wanted: Vector2<f64>,
        to_goal: Vector2<f64>,
    ) -> Decision {
        let walls = Walls {
            shapes: &self.walls,
        };
        let view = View {
            robot: *robot,
            people: &self.people,
            walls,
        };
        let kept = self
            .limits
            .clipped(robot.velocity, self.limits.slowed(wanted));
        if let Some(yielder) = &self.yielder {
            let distance = to_goal.norm();
            let outlook = Outlook {
                robot: *robot,
                wanted,
                to_goal: to_goal / distance.max(f64::MIN_POSITIVE),
                people: &self.passersby,
                walls,
            };
            let guard = self.guard.as_ref();
            let verified =
                |velocity| guard.is_none_or(|guard: &Guard| guard.verified(&view, velocity));
            if let Some(velocity) = yielder.decide(&outlook, verified) {
                let status = if velocity == kept {
                    Status::Kept
                } else {
                    Status::Changed
                };
                return Decision { velocity, status };
            }
        }
        match &self.guard {
            Some(guard) => guard.decide(&view, wanted),
            None => Decision {
                velocity: kept,
                status: Status::Kept,
            },
        }
    }

    /// Brings what the law, the shield and yielding look at to the present.
    fn look_around(&mut self, situation: &Situation<'_, f64>) {
        let robot = situation.robot.position;
        let latency = self.guard.map_or(0.0, |guard| guard.shield.latency);
        self.bodies.clear();
        self.people.clear();
        self.passersby.clear();
        self.walls.clear();
        let reach = self
            .yielder
            .as_ref()
            .map_or(0.0, |yielder| yielder.settings().reach);
        for (body, known) in situation.bodies.iter().zip(&self.known) {
            self.bodies.push(Body {
                regions: known.regions,
                ..*body
            });
            if !body.state.present {
                continue;
            }
            let placed = PlacedShape {
                center: body.state.position.into(),
                shape: body.shape,
            };
            if known.wall {
                self.walls.push(placed);
                continue;
            }
            if let Some(guard) = &self.guard {
                self.people.push(known.person(placed, body, guard));
            }
            let velocity = Vector2::from(body.state.velocity);
            let offset = placed.center - robot + velocity * latency;
            if offset.norm() - known.touch < reach {
                self.passersby.push(Passerby {
                    offset,
                    velocity,
                    touch: known.touch,
                });
            }
        }
    }
}

/// A velocity shortened to a largest speed.
fn slowed(velocity: Vector2<f64>, most: f64) -> Vector2<f64> {
    let speed = velocity.norm();
    if speed > most {
        velocity * (most / speed)
    } else {
        velocity
    }
}

impl Known {
    fn of(family: &SafeNavigation, placed: &PlacedObstacle) -> Self {
        let near = family
            .critical_distance
            .map(|distance| placed.contact_distance + distance);
        let regions = Regions {
            critical_radius: near.map_or(placed.regions.critical_radius, |near| {
                near.min(placed.regions.critical_radius)
            }),
            ..placed.regions
        };
        let rectangle = matches!(placed.obstacle.shape, Shape::Rectangle { .. });
        let bound = family.shield.and_then(|shield| shield.person_speed);
        let scene = placed.speed_bound.unwrap_or(f64::INFINITY);
        // Half the diagonal of a rectangle that moves: yielding knows discs only.
        let around = match placed.obstacle.shape {
            Shape::Disc { .. } => 0.0,
            Shape::Rectangle {
                half_length,
                half_width,
                ..
            } => half_length.hypot(half_width),
        };
        Self {
            regions,
            max_speed: if placed.stationary {
                0.0
            } else {
                bound.unwrap_or(scene)
            },
            wall: rectangle && placed.stationary,
            stationary: placed.stationary,
            touch: placed.contact_distance + around,
        }
    }

    /// What the shield assumes of an obstacle.
    fn person(&self, placed: PlacedShape, body: &Body, guard: &Guard) -> Person {
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
            latency: shield.latency,
            known: shield
                .velocity_bounds
                .filter(|_| !self.stationary)
                .map(known),
        }
    }
}
