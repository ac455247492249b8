//! Plans of a robot with two wheels: a ramp within a period, then braking on the curve of the command.

use crate::shield::TrackingError;
use crate::shield::half_disc::Look;
use crate::shield::hidden::{Hidden, HiddenInstant};
use crate::shield::person::Person;
use crate::shield::walls::{ROUNDING, StaticObstacles};
use navigation_world::robots::differential::{DifferentialLimits, Twist};
use numeric::lanes::Vector2;

/// Slower than this is at rest and looks nowhere, in m/s.
pub(super) const STILL: f64 = 1e-9;

/// Parts of a control period, and of a braking, between which a plan is looked at.
const PARTS: usize = 8;

/// Rounding of a number of periods.
const PERIOD_ROUNDING: f64 = 1e-9;

/// A robot with two wheels at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwistState {
    /// Position in m.
    pub position: Vector2<f64>,
    /// Heading in rad.
    pub heading: f64,
    /// Speed and turn rate.
    pub twist: Twist,
}

/// A point of a plan.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanPoint {
    time: f64,
    pub(super) position: Vector2<f64>,
    heading: f64,
}

/// Which way the half disc looks over a part of the plan: the union of two, or all around.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ahead {
    Union([Vector2<f64>; 2]),
    Around,
}

/// Ramp of speed and turn rate within a period, then both fall together to rest on the curve of the
/// command.
#[derive(Clone, Copy, Debug)]
pub(super) struct TwistPlan {
    pub(super) ramp: [PlanPoint; PARTS + 1],
    braking: [PlanPoint; PARTS + 1],
    /// Largest speed of the center in m/s.
    pub(super) speed: f64,
    /// Largest difference between the velocities of plan and robot, in m/s.
    deviation: f64,
    /// Of ramp and braking, for each part.
    ahead: [[Ahead; PARTS]; 2],
}

pub(super) fn unit(angle: f64) -> Vector2<f64> {
    let (sin, cos) = angle.sin_cos();
    Vector2::new(cos, sin)
}

/// Nodes of a part in which the twist changes evenly.
fn nodes(first: PlanPoint, duration: f64, from: Twist, to: Twist) -> [PlanPoint; PARTS + 1] {
    let mut nodes = [first; PARTS + 1];
    let part = duration / PARTS as f64;
    for index in 0..PARTS {
        let share = (index as f64 + 0.5) / PARTS as f64;
        let mean = Twist {
            speed: from.speed + (to.speed - from.speed) * share,
            turn_rate: from.turn_rate + (to.turn_rate - from.turn_rate) * share,
        };
        let PlanPoint {
            time,
            position,
            heading,
        } = nodes[index];
        let half = 0.5 * mean.turn_rate * part;
        nodes[index + 1] = PlanPoint {
            time: time + part,
            position: position + unit(heading + half) * (mean.speed * part),
            heading: heading + 2.0 * half,
        };
    }
    nodes
}

/// Outermost headings of a part in which the twist changes evenly: its ends, and where it turns back.
fn swept(nodes: &[PlanPoint; PARTS + 1], from: Twist, to: Twist) -> [f64; 2] {
    let (first, last) = (nodes[0], nodes[PARTS]);
    let ends = [first.heading, last.heading];
    if from.turn_rate * to.turn_rate >= 0.0 {
        return ends;
    }
    let share = from.turn_rate / (from.turn_rate - to.turn_rate);
    let apex = first.heading + 0.5 * from.turn_rate * share * (last.time - first.time);
    let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    [low.min(apex), high.max(apex)]
}

impl Ahead {
    /// Between two headings, at speeds of one sign or none, and within an angle of a sine beyond them; a half
    /// turn or more looks all around.
    fn over(headings: [f64; 2], speeds: [f64; 2], sine: f64) -> Self {
        if sine >= 1.0 {
            return Self::Around;
        }
        let beyond = sine.asin();
        let from = headings[0].min(headings[1]) - beyond;
        let to = headings[0].max(headings[1]) + beyond;
        let [first, last] = speeds;
        let backwards = first < -STILL || last < -STILL;
        let forwards = first > STILL || last > STILL;
        if (backwards && forwards) || to - from >= std::f64::consts::PI {
            return Self::Around;
        }
        let sign = if backwards { -1.0 } else { 1.0 };
        Self::Union([unit(from) * sign, unit(to) * sign])
    }

    /// How far ahead an offset lies, in m.
    fn along(&self, offset: Vector2<f64>) -> f64 {
        match self {
            Self::Union(looks) => looks[0].dot(&offset).max(looks[1].dot(&offset)),
            Self::Around => f64::INFINITY,
        }
    }

    fn clearance(&self, person: &Person, place: Vector2<f64>, radius: f64, time: f64) -> f64 {
        let [one, other] = match self {
            Self::Union(both) => *both,
            // Two opposite half discs are the disc.
            Self::Around => [Vector2::x(), -Vector2::x()],
        };
        let toward = |ahead: Vector2<f64>| {
            let look = Look::within(ahead, 0.0);
            person.clearance(place, radius, &look, time)
        };
        toward(one).min(toward(other))
    }
}

impl TwistPlan {
    pub(super) fn new(
        state: &TwistState,
        command: Twist,
        limits: &TwistLimits,
        tracking: TrackingError,
    ) -> Self {
        let first = PlanPoint {
            time: 0.0,
            position: state.position,
            heading: state.heading,
        };
        let ramp = nodes(first, limits.period, state.twist, command);
        let braking = limits.braking_periods(command) * limits.period;
        let braking = nodes(ramp[PARTS], braking, command, Twist::default());
        let speeds = [state.twist.speed, command.speed];
        let slowest = if speeds[0] * speeds[1] > 0.0 {
            speeds[0].abs().min(speeds[1].abs())
        } else {
            0.0
        };
        let ramped = swept(&ramp, state.twist, command);
        let ramped = Ahead::over(ramped, speeds, tracking.sine(slowest));
        let braked = swept(&braking, command, Twist::default());
        let braked = |speed: f64| Ahead::over(braked, [command.speed; 2], tracking.sine(speed));
        let parts = if tracking.absolute == 0.0 {
            [braked(1.0); PARTS]
        } else {
            let left = |part: usize| 1.0 - (part + 1) as f64 / PARTS as f64;
            std::array::from_fn(|part| braked(command.speed.abs() * left(part)))
        };
        let speed = speeds[0].abs().max(speeds[1].abs());
        Self {
            ahead: [[ramped; PARTS], parts],
            ramp,
            braking,
            speed,
            deviation: tracking.velocity(speed),
        }
    }

    fn parts(&self) -> [(&[PlanPoint; PARTS + 1], &[Ahead; PARTS]); 2] {
        [
            (&self.ramp, &self.ahead[0]),
            (&self.braking, &self.ahead[1]),
        ]
    }

    /// Whether nobody can be ahead at any time; `grown`: what is added to the radius at the end.
    pub(super) fn avoids(&self, person: &Person, radius: f64, grown: f64) -> bool {
        if self.speed < STILL {
            return true;
        }
        let radius = radius + person.radius();
        let end = self.braking[PARTS].time;
        let rate = self.speed + self.deviation + person.rate(end);
        for (nodes, looks) in self.parts() {
            let at = |ahead: &Ahead, node: &PlanPoint| {
                ahead.clearance(person, node.position, radius, node.time)
            };
            let (mut look, mut before) = (&looks[0], at(&looks[0], &nodes[0]));
            for (pair, ahead) in nodes.windows(2).zip(looks) {
                if ahead != look {
                    (look, before) = (ahead, at(ahead, &pair[0]));
                }
                let after = at(ahead, &pair[1]);
                // The least that a function of this rate can be between two values.
                if 0.5 * (before + after - rate * (pair[1].time - pair[0].time)) <= 0.0 {
                    return false;
                }
                before = after;
            }
        }
        let last = &self.braking[PARTS];
        let ahead = &self.ahead[1][PARTS - 1];
        grown == 0.0 || ahead.clearance(person, last.position, radius + grown, end) > 0.0
    }

    /// Whether nobody who is not seen can be ahead at any time of the plan, of a robot of a radius in m.
    pub(super) fn avoids_hidden(&self, hidden: &Hidden<'_>, radius: f64) -> bool {
        if self.speed < STILL || hidden.lets_creep(self.speed) {
            return true;
        }
        let end = self.braking[PARTS].time;
        self.parts().into_iter().all(|(nodes, looks)| {
            let half = 0.5 * (nodes[1].time - nodes[0].time);
            nodes.iter().enumerate().all(|(index, node)| {
                let at = HiddenInstant {
                    time: node.time,
                    half,
                    position: node.position,
                    way: half * (self.speed + self.deviation),
                    radius: radius + if node.time == end { hidden.grown } else { 0.0 },
                };
                // What a look sees, the next one sees, too.
                let ahead = &looks[index.min(PARTS - 1)];
                hidden.is_clear(&at, |offset| ahead.along(offset))
            })
        })
    }

    /// Whether the whole way keeps `least` m from walls, with the sagitta of each part to spare. Where the robot
    /// starts nearer, no node comes nearer: the arc between two is off its chord by the sagitta, which must not touch.
    pub(super) fn keeps(&self, walls: &StaticObstacles<'_>, touching: f64, least: f64) -> bool {
        let pairs = || {
            let parts = self.parts().into_iter();
            parts.flat_map(|(nodes, _)| nodes.windows(2)).map(|pair| {
                let way = (pair[1].position - pair[0].position).norm();
                let turn = (pair[1].heading - pair[0].heading).abs();
                (pair, way * turn / 8.0)
            })
        };
        let deepest = pairs().map(|(_, sagitta)| sagitta).fold(0.0, f64::max);
        let start = walls.clearance_up_to(self.ramp[0].position, least + deepest) - ROUNDING;
        pairs().all(|(pair, sagitta)| {
            let off_margin = least + sagitta;
            let kept = if start < touching + sagitta {
                start + sagitta
            } else {
                off_margin.min(start)
            };
            walls.segment_keeps(pair[0].position, pair[1].position, kept)
        })
    }
}

/// Limits of a robot with two wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwistLimits {
    /// Radius in m, with the margin and the tracking of the shield.
    pub radius: f64,
    /// Limits of speed and turn rate.
    pub drive: DifferentialLimits,
    /// Control period in s.
    pub period: f64,
}

impl TwistLimits {
    pub(crate) fn braking_periods(&self, twist: Twist) -> f64 {
        let slow = twist.speed.abs() / (self.drive.max_deceleration * self.period);
        let straight = twist.turn_rate.abs() / (self.drive.max_angular_acceleration * self.period);
        (slow.max(straight) - PERIOD_ROUNDING).ceil().max(0.0)
    }

    /// The twist after one period of braking.
    pub(crate) fn braking(&self, twist: Twist) -> Twist {
        let periods = self.braking_periods(twist);
        let share = if periods <= 1.0 {
            0.0
        } else {
            (periods - 1.0) / periods
        };
        Twist {
            speed: twist.speed * share,
            turn_rate: twist.turn_rate * share,
        }
    }
}
