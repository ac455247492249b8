//! Velocity obstacles of Fiorini and Shiller (1998): relative velocities that lead to a contact
//! lie between two rays; what is left of the reachable velocities is searched exactly.

use crate::lanes::{Planar, Vector2};
use crate::laws::Situation;
use crate::laws::planning::Planner;
use crate::laws::planning::outline::{Legs, Outline};
use crate::world::scenario::Scenario;

type Vector = Vector2<f64>;

/// A velocity beyond a limit by less than this share of it is on the limit.
const ON_THE_LIMIT: f64 = 1e-9;

/// Instants of a control period at which the way to a new velocity is checked.
const INSTANTS: u32 = 6;

/// Directions that are tried besides the exact ones where nothing is free for ever.
const DIRECTIONS: u32 = 32;

/// Which of the free velocities is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Selection {
    /// Largest component towards the goal (Fiorini and Shiller: to the goal).
    ToGoal,
    /// Largest speed within this angle of the goal's direction in rad, the one nearest to that
    /// direction among equals (Fiorini and Shiller: maximum velocity).
    Fastest {
        /// Half of the admitted sector, in rad.
        sector: f64,
    },
    /// Least sum of the time to the goal and a weight times the inverse of the time to contact
    /// (Large, Laugier and Shiller 2005).
    TimeAndRisk {
        /// Weight of the risk, in s^2.
        risk: f64,
    },
}

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityObstacle {
    /// Rule of selection.
    pub selection: Selection,
    /// Contacts later than this do not count, in s; may be infinite.
    pub horizon: f64,
    /// Distance that is kept between the surfaces, in m.
    pub margin: f64,
    /// Share of a control period's change of velocity by which the robot has moved at its end:
    /// 1/2 for a smooth ramp, `(n + 1)/(2 n)` for `n` semi-implicit Euler steps.
    pub ramp: f64,
}

impl Default for VelocityObstacle {
    fn default() -> Self {
        Self {
            selection: Selection::ToGoal,
            horizon: f64::INFINITY,
            margin: 0.01,
            ramp: 7.0 / 12.0,
        }
    }
}

/// Velocities that one obstacle forbids.
#[derive(Clone, Copy, Debug)]
struct Cone {
    /// As seen where the robot turns into its new velocity.
    outline: Outline,
    /// As seen now.
    now: Outline,
    legs: Option<Legs>,
}

impl Cone {
    fn time_to_contact(&self, velocity: Vector) -> f64 {
        let relative = velocity - self.outline.velocity;
        match self.legs {
            Some(legs) if !legs.hold(relative) => f64::INFINITY,
            _ => self.outline.time_to_contact(relative),
        }
    }
}

/// The planner at work in one scenario.
#[derive(Clone, Debug)]
pub struct VelocityObstaclePlanner {
    settings: VelocityObstacle,
    goal: Vector,
    robot_radius: f64,
    max_speed: f64,
    max_acceleration: f64,
    cones: Vec<Cone>,
    candidates: Vec<Vector>,
}

/// Discs whose common part the robot can reach by the next sample.
#[derive(Clone, Copy, Debug)]
struct Reachable {
    velocity: Vector,
    change: f64,
    max_speed: f64,
}

impl Reachable {
    fn holds(&self, velocity: Vector) -> bool {
        let beyond =
            |vector: Vector, limit: f64| vector.dot(&vector).sqrt() > limit * (1.0 + ON_THE_LIMIT);
        !beyond(velocity, self.max_speed) && !beyond(velocity - self.velocity, self.change)
    }

    fn circles(&self) -> [(Vector, f64); 2] {
        [
            (Vector::zeros(), self.max_speed),
            (self.velocity, self.change),
        ]
    }
}

impl VelocityObstaclePlanner {
    /// The planner for one scenario.
    #[must_use]
    pub fn new(settings: VelocityObstacle, scenario: &Scenario) -> Self {
        let count = scenario.obstacle_count();
        Self {
            settings,
            goal: Vector::splat(scenario.goal),
            robot_radius: scenario.robot.radius,
            max_speed: scenario.robot.max_speed,
            max_acceleration: scenario.robot.max_acceleration,
            cones: Vec::with_capacity(count),
            candidates: Vec::new(),
        }
    }

    /// Whether a velocity is reachable and free of contacts within the horizon.
    #[must_use]
    pub fn is_free(&mut self, situation: &Situation<'_, f64>, velocity: [f64; 2]) -> bool {
        self.look(situation, self.settings.margin);
        let velocity = Vector::splat(velocity);
        self.reachable(situation).holds(velocity) && self.free(situation, velocity)
    }

    /// A free velocity, by the rule of selection.
    #[must_use]
    pub fn best_free(&mut self, situation: &Situation<'_, f64>) -> Option<[f64; 2]> {
        self.look(situation, self.settings.margin);
        self.propose(situation);
        self.select(situation).map(|best| best.lane(0))
    }

    fn reachable(&self, situation: &Situation<'_, f64>) -> Reachable {
        Reachable {
            velocity: situation.robot.velocity,
            change: self.max_acceleration * situation.interval,
            max_speed: self.max_speed,
        }
    }

    fn look(&mut self, situation: &Situation<'_, f64>, margin: f64) {
        let robot = &situation.robot;
        self.cones.clear();
        for body in situation.bodies {
            if !body.state.present {
                continue;
            }
            let now = Outline::new(body, robot.position, self.robot_radius, margin);
            // The robot changes its velocity over a control period: as if it went on at the old
            // one for a part of it and had the new one from there.
            let before = (1.0 - self.settings.ramp) * situation.interval;
            let moved = now.seen_after((robot.velocity - now.velocity) * before);
            let legs = moved.legs();
            self.cones.push(Cone {
                outline: moved,
                now,
                legs,
            });
        }
    }

    fn time_to_contact(&self, velocity: Vector) -> f64 {
        let times = self.cones.iter().map(|cone| cone.time_to_contact(velocity));
        times.fold(f64::INFINITY, f64::min)
    }

    fn free(&self, situation: &Situation<'_, f64>, velocity: Vector) -> bool {
        let late = |cone: &Cone| {
            let time = cone.time_to_contact(velocity);
            time == f64::INFINITY || time > self.settings.horizon
        };
        self.cones.iter().all(late) && !self.touches_on_the_way(situation, velocity)
    }

    /// Whether the way to a new velocity itself touches an obstacle, or comes closer to one whose
    /// margin is broken already.
    fn touches_on_the_way(&self, situation: &Situation<'_, f64>, velocity: Vector) -> bool {
        let robot = &situation.robot;
        let change = velocity - robot.velocity;
        let period = situation.interval;
        let farthest = (self.max_speed + change.dot(&change).sqrt()) * period;
        self.cones.iter().any(|cone| {
            let (point, inside) = cone.now.nearest(Vector::zeros());
            let distance = if inside {
                0.0
            } else {
                point.dot(&point).sqrt()
            };
            let speed = cone.now.velocity.dot(&cone.now.velocity).sqrt();
            if distance - cone.now.radius > farthest + speed * period {
                return false;
            }
            let kept = cone.now.radius.min(distance);
            (1..=INSTANTS).any(|instant| {
                let share = f64::from(instant) / f64::from(INSTANTS);
                let steady = (robot.velocity - cone.now.velocity) * (share * period);
                let bent = 0.5 * share * share + (self.settings.ramp - 0.5) * share;
                let way = steady + change * (bent * period);
                let (point, inside) = cone.now.nearest(way);
                let offset = way - point;
                inside || offset.dot(&offset) < kept * kept
            })
        })
    }

    /// Every velocity at which a rule of selection can have its optimum.
    fn propose(&mut self, situation: &Situation<'_, f64>) {
        let reachable = self.reachable(situation);
        let aim = self.direction_to_goal(situation);
        let mut rays: Vec<(Vector, Vector)> = Vec::with_capacity(2 * self.cones.len() + 3);
        for cone in &self.cones {
            if let Some(legs) = cone.legs {
                rays.push((cone.outline.velocity, legs.left));
                rays.push((cone.outline.velocity, legs.right));
            }
        }
        rays.push((Vector::zeros(), aim));
        if let Selection::Fastest { sector } = self.settings.selection {
            let (sine, cosine) = sector.sin_cos();
            for side in [sine, -sine] {
                rays.push((Vector::zeros(), aim * cosine + aim.left_normal() * side));
            }
        }
        let to_goal = self.goal - situation.robot.position;
        let wanted = aim
            * (self
                .max_speed
                .min(to_goal.dot(&to_goal).sqrt() / situation.interval));
        let candidates = &mut self.candidates;
        candidates.clear();
        candidates.extend([wanted, situation.robot.velocity, Vector::zeros()]);
        for (index, &(from, along)) in rays.iter().enumerate() {
            candidates.push(from + along * (along.dot(&(wanted - from)).max(0.0)));
            for (center, radius) in reachable.circles() {
                candidates.extend(on_circle(from, along, center, radius).into_iter().flatten());
            }
            for &(other, direction) in &rays[..index] {
                let sine = along.perp(&direction);
                if sine != 0.0 {
                    let share = (other - from).perp(&direction) / sine;
                    candidates.push(from + along * share);
                }
            }
        }
        for (center, radius) in reachable.circles() {
            candidates.push(center + aim * radius);
        }
        candidates.extend(where_circles_meet(&reachable).into_iter().flatten());
    }

    fn direction_to_goal(&self, situation: &Situation<'_, f64>) -> Vector {
        let to_goal = self.goal - situation.robot.position;
        let distance = to_goal.dot(&to_goal).sqrt();
        if distance == 0.0 {
            return Vector2::new(1.0, 0.0);
        }
        to_goal * (1.0 / distance)
    }

    /// What a rule prefers: larger is better, then by the second number.
    fn worth(&self, situation: &Situation<'_, f64>, aim: Vector, velocity: Vector) -> (f64, f64) {
        let forward = velocity.dot(&aim);
        let speed = velocity.dot(&velocity).sqrt();
        match self.settings.selection {
            Selection::ToGoal => (forward, speed),
            Selection::Fastest { sector } => {
                let within = forward >= speed * (sector.cos() - ON_THE_LIMIT);
                // Speeds that differ by roundings are equal.
                let rank = (speed / (self.max_speed * ON_THE_LIMIT)).round();
                (
                    if within {
                        rank
                    } else {
                        rank - 2.0 / ON_THE_LIMIT
                    },
                    forward,
                )
            }
            Selection::TimeAndRisk { risk } => {
                let left = self.goal - situation.robot.position - velocity * situation.interval;
                let time = left.dot(&left).sqrt() / self.max_speed;
                (-(time + risk / self.time_to_contact(velocity)), forward)
            }
        }
    }

    fn select(&self, situation: &Situation<'_, f64>) -> Option<Vector> {
        let reachable = self.reachable(situation);
        let aim = self.direction_to_goal(situation);
        let mut best: Option<((f64, f64), Vector)> = None;
        for &velocity in &self.candidates {
            if !reachable.holds(velocity) {
                continue;
            }
            let worth = self.worth(situation, aim, velocity);
            let better = best.is_none_or(|(known, _)| worth > known);
            if better && self.free(situation, velocity) {
                best = Some((worth, velocity));
            }
        }
        best.map(|(_, velocity)| velocity)
    }

    /// The reachable velocity with the latest contact, for want of a free one.
    fn latest_contact(&mut self, situation: &Situation<'_, f64>) -> Vector {
        let reachable = self.reachable(situation);
        for direction in 0..DIRECTIONS {
            let angle = std::f64::consts::TAU * f64::from(direction) / f64::from(DIRECTIONS);
            let (sine, cosine) = angle.sin_cos();
            for (center, radius) in reachable.circles() {
                let outward = Vector2::new(cosine, sine);
                self.candidates.push(center + outward * radius);
            }
        }
        // A robot far above its limits can reach nothing that it may have: it slows down.
        let velocity = situation.robot.velocity;
        let speed = velocity.dot(&velocity).sqrt();
        let slowest = velocity * ((reachable.max_speed / speed).min(1.0));
        let still = Vector2::select(speed > 0.0, slowest, velocity);
        let mut best = (f64::NEG_INFINITY, still);
        for &velocity in &self.candidates {
            if reachable.holds(velocity) {
                let time = self.time_to_contact(velocity);
                if time > best.0 {
                    best = (time, velocity);
                }
            }
        }
        best.1
    }
}

impl Planner for VelocityObstaclePlanner {
    /// A free velocity by the rule of selection; if there is none with the margin, one without
    /// it, and otherwise the velocity with the latest contact.
    fn desired_velocity(&mut self, situation: &Situation<'_, f64>) -> [f64; 2] {
        for margin in [self.settings.margin, 0.0] {
            self.look(situation, margin);
            self.propose(situation);
            if let Some(best) = self.select(situation) {
                return best.lane(0);
            }
        }
        self.latest_contact(situation).lane(0)
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.goal = Vector::splat(goal);
    }
}

/// Where a ray meets a circle.
fn on_circle(from: Vector, along: Vector, center: Vector, radius: f64) -> [Option<Vector>; 2] {
    let offset = from - center;
    let foot = -offset.dot(&along);
    let square = foot * foot + radius * radius - offset.dot(&offset);
    if square < 0.0 {
        return [None, None];
    }
    let half = square.sqrt();
    [foot - half, foot + half].map(|share| (share >= 0.0).then(|| from + along * share))
}

/// Where the circle of the speed meets the circle of the change.
fn where_circles_meet(reachable: &Reachable) -> [Option<Vector>; 2] {
    let center = reachable.velocity;
    let square = center.dot(&center);
    if square == 0.0 {
        return [None, None];
    }
    let (speed, change) = (reachable.max_speed, reachable.change);
    let share = 0.5 * (1.0 + (speed * speed - change * change) / square);
    let across = speed * speed / square - share * share;
    if across < 0.0 {
        return [None, None];
    }
    let half = across.sqrt();
    [half, -half].map(|side| Some(center * share + center.left_normal() * side))
}
