//! The rules of the filters.

use crate::filters::program::{Answer, Disc, Hard, LinearBound, solve};
use crate::filters::{FilterStatus, Filtered, Near, Sighted};
use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// A result this near to what was asked for is it, in m/s.
const SAME: f64 = 1e-9;
/// Distances may be missed by this much, in m.
const SPARE: f64 = 1e-9;

/// Distance of a person from a place in m, and direction from the person to it: along x where they are one.
fn apart(place: Vector, person: &Near) -> (f64, Vector) {
    let way = place - person.position;
    let distance = way.norm();
    let normal = if distance > 0.0 {
        way / distance
    } else {
        Vector::x()
    };
    (distance, normal)
}

/// A velocity shortened to a largest speed.
fn at_most(velocity: Vector, most: f64) -> Vector {
    let speed = velocity.norm();
    if speed > most {
        velocity * (most / speed)
    } else {
        velocity
    }
}

impl Sighted<'_> {
    /// The velocity after a period of full braking.
    fn braked(&self) -> Vector {
        let change = self.max_acceleration.unwrap_or(f64::INFINITY) * self.period;
        let speed = self.velocity.norm();
        if speed > change {
            self.velocity * (1.0 - change / speed)
        } else {
            Vector::zeros()
        }
    }

    fn filtered(&self, answer: Answer, wanted: Vector) -> Filtered {
        let (velocity, slack) = match answer {
            Answer::Nearest(velocity) => {
                let kept = (velocity - wanted).norm() <= SAME;
                let status = if kept {
                    FilterStatus::Kept
                } else {
                    FilterStatus::Changed
                };
                return Filtered {
                    velocity,
                    status,
                    slack: 0.0,
                    share: 1.0,
                };
            }
            Answer::Least(velocity, slack) => (velocity, slack),
            Answer::Apart => (self.braked(), f64::NAN),
        };
        Filtered {
            velocity,
            status: FilterStatus::Infeasible,
            slack,
            share: 1.0,
        }
    }
}

/// Control barrier function of a point that moves at any velocity: `h = (d^2 - R^2)/2` falls at most by `rate h`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrier {
    /// Rate in 1/s.
    pub rate: f64,
    /// Distance that is kept between the surfaces, in m.
    pub margin: f64,
}

impl Barrier {
    /// Half-planes of velocities of a place in m, for a body of a radius in m around it.
    fn edges(self, seen: &Sighted<'_>, place: Vector, radius: f64) -> Vec<LinearBound> {
        let people = seen.people.iter().map(|person| {
            let (distance, normal) = apart(place, person);
            let touch = radius + person.radius + self.margin;
            let square = distance * distance - touch * touch;
            let allowed = self.rate * square / (2.0 * distance.max(f64::MIN_POSITIVE));
            LinearBound {
                normal,
                least: normal.dot(&person.velocity) - allowed,
            }
        });
        let points = seen.points.iter().map(|point| {
            let at = Near {
                position: *point,
                velocity: Vector::zeros(),
                radius: 0.0,
            };
            let (distance, normal) = apart(place, &at);
            LinearBound {
                normal,
                least: -self.rate * (distance - radius - self.margin),
            }
        });
        people.chain(points).collect()
    }

    /// The permitted velocity nearest to a wanted one.
    #[must_use]
    pub fn filter(self, seen: &Sighted<'_>, wanted: Vector) -> Filtered {
        let speed = Disc {
            center: Vector::zeros(),
            radius: seen.max_speed,
        };
        let change = seen.max_acceleration.map(|most| Disc {
            center: seen.velocity,
            radius: most * seen.period,
        });
        let hard = Hard {
            edges: Vec::new(),
            discs: std::iter::once(speed).chain(change).collect(),
        };
        let edges = self.edges(seen, seen.position, seen.radius);
        seen.filtered(solve(&edges, &hard, wanted), wanted)
    }
}

/// [`Barrier`] of a point ahead of the axle of a robot with two wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarrierUnicycle {
    /// Rate in 1/s.
    pub rate: f64,
    /// Distance `l` of the point in m.
    pub ahead: f64,
    /// Distance that is kept between the surfaces, in m.
    pub margin: f64,
}

impl BarrierUnicycle {
    /// The permitted `(v, omega)` nearest to a wanted one, by the velocity of the point, as a vector in m/s and rad/s.
    #[must_use]
    pub fn filter(self, seen: &Sighted<'_>, [speed, turn_rate]: [f64; 2]) -> Filtered {
        let (sin, cos) = seen.heading.sin_cos();
        let along = Vector::new(cos, sin);
        let across = Vector::new(-sin, cos);
        let ahead = self.ahead;
        let barrier = Barrier {
            rate: self.rate,
            margin: self.margin,
        };
        let mut edges = barrier.edges(seen, seen.position + along * ahead, seen.radius + ahead);
        for edge in &mut edges {
            edge.normal = Vector::new(edge.normal.dot(&along), edge.normal.dot(&across));
        }
        let limit = |normal: Vector, most: f64| LinearBound {
            normal,
            least: -most,
        };
        let turn = ahead * seen.max_turn_rate;
        let hard = Hard {
            edges: vec![
                limit(Vector::x(), seen.max_speed),
                limit(-Vector::x(), seen.max_speed),
                limit(Vector::y(), turn),
                limit(-Vector::y(), turn),
            ],
            discs: Vec::new(),
        };
        let wanted = Vector::new(speed, ahead * turn_rate);
        let mut found = seen.filtered(solve(&edges, &hard, wanted), wanted);
        found.velocity.y /= ahead;
        found
    }
}

/// Control barrier function of the cone of relative velocities that lead to a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionCone {
    /// Rate in 1/s.
    pub rate: f64,
    /// Distance that is kept between the surfaces, in m.
    pub margin: f64,
}

impl CollisionCone {
    /// The velocity after a period with the permitted acceleration nearest to the wanted one.
    #[must_use]
    pub fn filter(self, seen: &Sighted<'_>, wanted: Vector) -> Filtered {
        let mut edges = Vec::with_capacity(seen.people.len());
        for person in seen.people {
            let way = person.position - seen.position;
            let touch = seen.radius + person.radius + self.margin;
            let square = way.norm_squared() - touch * touch;
            if square <= 0.0 {
                return Filtered {
                    velocity: seen.braked(),
                    status: FilterStatus::Touching,
                    slack: 0.0,
                    share: 1.0,
                };
            }
            let relative = person.velocity - seen.velocity;
            let (speed, leg) = (relative.norm(), square.sqrt());
            if speed < 1e-9 {
                continue;
            }
            let closing = way.dot(&relative);
            let value = closing + speed * leg;
            let normal = -(way + relative * (leg / speed));
            let least = -(speed * speed + speed * closing / leg + self.rate * value);
            edges.extend(LinearBound::normalized(normal, least));
        }
        let asked = (wanted - seen.velocity) / seen.period;
        let hard = Hard {
            edges: Vec::new(),
            discs: Vec::from_iter(seen.max_acceleration.map(|most| Disc {
                center: Vector::zeros(),
                radius: most,
            })),
        };
        let found = seen.filtered(solve(&edges, &hard, asked), asked);
        let velocity = seen.velocity + found.velocity * seen.period;
        Filtered {
            velocity: at_most(velocity, seen.max_speed),
            ..found
        }
    }
}

/// The largest share of the wanted velocity with which nobody who walks straight on is touched within a horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityClamp {
    /// Horizon in s.
    pub horizon: f64,
    /// Distance that is kept between the surfaces, in m.
    pub margin: f64,
}

impl VelocityClamp {
    fn is_safe(self, seen: &Sighted<'_>, velocity: Vector) -> bool {
        seen.people.iter().all(|person| {
            let way = person.position - seen.position;
            let relative = person.velocity - velocity;
            let square = relative.norm_squared();
            let time = if square > 0.0 {
                (-way.dot(&relative) / square).clamp(0.0, self.horizon)
            } else {
                0.0
            };
            (way + relative * time).norm() >= seen.radius + person.radius + self.margin - SPARE
        })
    }

    /// The clamped velocity, and its share.
    #[must_use]
    pub fn filter(self, seen: &Sighted<'_>, wanted: Vector) -> (Filtered, f64) {
        let full = at_most(wanted, seen.max_speed);
        let mut shares = vec![1.0, 0.0];
        for person in seen.people {
            let way = person.position - seen.position;
            let touch = seen.radius + person.radius + self.margin;
            let end = way + person.velocity * self.horizon;
            let step = full * self.horizon;
            let at_end = [
                step.norm_squared(),
                -2.0 * end.dot(&step),
                end.norm_squared() - touch * touch,
            ];
            let square = way.norm_squared() - touch * touch;
            let (own, theirs) = (way.dot(&full), way.dot(&person.velocity));
            let passing = [
                own * own - square * full.norm_squared(),
                -2.0 * (own * theirs - square * full.dot(&person.velocity)),
                theirs * theirs - square * person.velocity.norm_squared(),
            ];
            shares.extend([at_end, passing].into_iter().flat_map(roots));
        }
        shares.retain(|share| (0.0..=1.0).contains(share));
        shares.sort_by(|one, two| two.total_cmp(one));
        let safe = shares
            .into_iter()
            .find(|share| self.is_safe(seen, full * *share));
        let (share, status) = match safe {
            None => (0.0, FilterStatus::Stopped),
            Some(1.0) => (1.0, FilterStatus::Kept),
            Some(share) => (share, FilterStatus::Changed),
        };
        let filtered = Filtered {
            velocity: full * share,
            status,
            slack: 0.0,
            share,
        };
        (filtered, share)
    }
}

/// Real roots of `a s^2 + b s + c`.
fn roots([a, b, c]: [f64; 3]) -> impl Iterator<Item = f64> {
    let square = b * b - 4.0 * a * c;
    let found = if square < 0.0 {
        [f64::NAN; 2]
    } else {
        let sum = -0.5 * (b + square.sqrt().copysign(b));
        [sum / a, c / sum]
    };
    found.into_iter().filter(|root| root.is_finite())
}

/// Responsibility-sensitive safety for opposite directions, on the line of the centers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponsibilityRule {
    /// Reaction time in s.
    pub reaction_time: f64,
    /// Largest acceleration of the robot within it, and its braking, in m/s^2.
    pub acceleration: f64,
    /// In m/s^2.
    pub braking: f64,
    /// Largest acceleration of a person in m/s^2.
    pub person_acceleration: f64,
    /// In m/s^2.
    pub person_braking: f64,
    /// Distance that is kept between the surfaces, in m.
    pub margin: f64,
}

impl ResponsibilityRule {
    /// Distance in m that the rule asks for at approaching speeds in m/s.
    fn distance(&self, own: f64, theirs: f64) -> f64 {
        let time = self.reaction_time;
        let part = |speed: f64, acceleration: f64, braking: f64| {
            let later = speed + time * acceleration;
            0.5 * (speed + later) * time + later * later / (2.0 * braking)
        };
        part(own, self.acceleration, self.braking)
            + part(theirs, self.person_acceleration, self.person_braking)
    }

    /// Distances that the rule asks for of each person, in m.
    #[must_use]
    pub fn distances(&self, seen: &Sighted<'_>) -> Vec<f64> {
        let of = |person: &Near| {
            let (_, normal) = apart(seen.position, person);
            let own = (-seen.velocity.dot(&normal)).max(0.0);
            self.distance(own, person.velocity.dot(&normal).max(0.0))
        };
        seen.people.iter().map(of).collect()
    }

    /// The permitted velocity nearest to a wanted one.
    #[must_use]
    pub fn filter(&self, seen: &Sighted<'_>, wanted: Vector) -> Filtered {
        let mut edges = Vec::new();
        for (person, asked) in seen.people.iter().zip(self.distances(seen)) {
            let (distance, normal) = apart(seen.position, person);
            if distance - seen.radius - person.radius - self.margin < asked {
                let own = (-seen.velocity.dot(&normal)).max(0.0);
                let most = (own - self.braking * seen.period).max(0.0);
                edges.push(LinearBound {
                    normal,
                    least: -most,
                });
            }
        }
        let hard = Hard {
            edges: Vec::new(),
            discs: vec![Disc {
                center: Vector::zeros(),
                radius: seen.max_speed,
            }],
        };
        seen.filtered(solve(&edges, &hard, wanted), wanted)
    }
}

/// The approach action of a collision monitor: people stand, and the command is scaled by the time to a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ApproachMonitor {
    /// Time before a contact from which on the robot slows down, in s.
    pub time_before_collision: f64,
    /// Time between two poses in s.
    pub simulation_time_step: f64,
    /// Distance that is kept between the surfaces, in m.
    pub margin: f64,
}

impl ApproachMonitor {
    /// Share of a command, a velocity in m/s and a turn rate in rad/s, and the time of the first contact in s.
    #[must_use]
    pub fn share(
        &self,
        seen: &Sighted<'_>,
        mut velocity: Vector,
        turn_rate: f64,
    ) -> (f64, Option<f64>) {
        let (sin, cos) = (turn_rate * self.simulation_time_step).sin_cos();
        let mut place = seen.position;
        let mut step = 0_u32;
        loop {
            let time = f64::from(step) * self.simulation_time_step;
            if time > self.time_before_collision + SPARE {
                return (1.0, None);
            }
            place += velocity * self.simulation_time_step;
            velocity = Vector::new(
                cos * velocity.x - sin * velocity.y,
                sin * velocity.x + cos * velocity.y,
            );
            let touched = seen.people.iter().any(|person| {
                (place - person.position).norm() <= seen.radius + person.radius + self.margin
            });
            if touched {
                return (time / self.time_before_collision, Some(time));
            }
            step += 1;
        }
    }
}
