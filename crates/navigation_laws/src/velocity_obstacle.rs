//! Velocity obstacles of Fiorini and Shiller (1998): relative velocities that lead to a contact
//! lie between two rays; what is left of the reachable velocities is searched exactly.

mod best;
mod free;
mod lines;
#[cfg(test)]
mod tests;

use std::cell::Cell;

use best::{Best, Place, Promising};
use lines::{Covers, Line, Reachable, where_circles_meet};

use crate::Situation;
use crate::planning::Planner;
use crate::planning::outline::{Legs, Outline};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::{Planar, Vector2};

type Vector = Vector2<f64>;

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

impl Named for VelocityObstacle {
    const NAME: &'static str = "velocity_obstacle";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Ok(Self {
            margin: given.number("margin")?,
            horizon: given.number("horizon")?,
            selection: Selection::made_of(given)?,
            ..Self::default()
        })
    }
}

impl Selection {
    /// How to select among the velocities, by its word.
    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let (sector, risk) = (given.number("sector")?, given.number("risk_weight")?);
        let word = given.word("selection")?;
        match word.as_str() {
            "fastest" => Ok(Self::Fastest { sector }),
            "time_and_risk" => Ok(Self::TimeAndRisk { risk }),
            "to_goal" => Ok(Self::ToGoal),
            _ => {
                let rule = "be one of \"fastest\", \"time_and_risk\", \"to_goal\"";
                Err(Failure::invalid("selection", rule, Given::Word(word)))
            }
        }
    }
}

/// Velocities that one obstacle forbids.
#[derive(Clone, Copy, Debug)]
struct Cone {
    /// Outline seen from where the robot turns into its new velocity.
    outline: Outline,
    legs: Option<Legs>,
}

/// The planner at work in one scenario.
#[derive(Clone, Debug)]
pub struct VelocityObstaclePlanner {
    settings: VelocityObstacle,
    goal: Vector,
    robot_radius: f64,
    max_speed: f64,
    /// Acceleration in m/s^2 that the robot has in every direction.
    max_acceleration: f64,
    cones: Vec<Cone>,
    /// Present outlines of the obstacles that the way to a new velocity may touch.
    close: Vec<Outline>,
    lines: Vec<Line>,
    /// Place of the last velocity that was chosen.
    chosen: Place,
    /// The cone that forbade the last velocity.
    blocking: Cell<usize>,
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
            max_acceleration: scenario.robot.guaranteed_acceleration(),
            cones: Vec::with_capacity(count),
            close: Vec::new(),
            lines: Vec::new(),
            chosen: (0, 0),
            blocking: Cell::new(0),
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
        let farthest = self.farthest(situation);
        self.cones.clear();
        self.close.clear();
        for body in situation.bodies {
            if !body.state.present {
                continue;
            }
            let now = Outline::new(body, robot.position, self.robot_radius, margin);
            // The robot changes its velocity over a control period: as if it went on at the old
            // one for a part of it and had the new one from there.
            let before = (1.0 - self.settings.ramp) * situation.interval;
            let outline = now.seen_after((robot.velocity - now.velocity) * before);
            if !free::is_far(&now, farthest, situation.interval) {
                self.close.push(now);
            }
            let legs = outline.legs();
            self.cones.push(Cone { outline, legs });
        }
    }

    /// Draws every line on which a rule of selection can have its optimum.
    fn draw_lines(&mut self, aim: Vector) {
        let lines = &mut self.lines;
        lines.clear();
        for cone in &self.cones {
            if let Some(legs) = cone.legs {
                let from = cone.outline.velocity;
                lines.extend([legs.left, legs.right].map(|along| Line { from, along }));
            }
        }
        let mut ahead = |along| {
            let from = Vector::zeros();
            lines.push(Line { from, along });
        };
        ahead(aim);
        if let Selection::Fastest { sector } = self.settings.selection {
            let (sine, cosine) = sector.sin_cos();
            for side in [sine, -sine] {
                ahead(aim * cosine + aim.left_normal() * side);
            }
        }
    }

    /// The velocity that reaches the goal soonest, if nothing is in between.
    fn wanted(&self, situation: &Situation<'_, f64>, aim: Vector) -> Vector {
        let to_goal = self.goal - situation.robot.position;
        let soonest = to_goal.dot(&to_goal).sqrt() / situation.interval;
        aim * self.max_speed.min(soonest)
    }

    /// Velocities that may be the best without being on a line: what is wanted, what is driven, rest.
    fn first_candidates(&self, situation: &Situation<'_, f64>, aim: Vector) -> [Vector; 3] {
        let wanted = self.wanted(situation, aim);
        [wanted, situation.robot.velocity, Vector::zeros()]
    }

    /// The farthest reachable velocities toward the goal, and where both limits meet.
    fn last_candidates(reachable: &Reachable, aim: Vector) -> impl Iterator<Item = Vector> {
        let farthest = reachable
            .circles()
            .map(|(center, radius)| center + aim * radius);
        let meet = where_circles_meet(reachable).into_iter().flatten();
        farthest.into_iter().chain(meet)
    }

    /// Every velocity at which a rule of selection can have its optimum.
    fn candidates(&self, situation: &Situation<'_, f64>) -> Vec<Vector> {
        let reachable = self.reachable(situation);
        let aim = self.direction_to_goal(situation);
        let wanted = self.wanted(situation, aim);
        let mut found = self.first_candidates(situation, aim).to_vec();
        for (index, line) in self.lines.iter().enumerate() {
            if reachable.chord(line).is_none() {
                continue;
            }
            found.extend(line.own(wanted, &reachable).into_iter().flatten());
            let crossings = self.lines[..index].iter();
            found.extend(crossings.filter_map(|other| line.crossing(other)));
        }
        found.extend(Self::last_candidates(&reachable, aim));
        found
    }

    fn direction_to_goal(&self, situation: &Situation<'_, f64>) -> Vector {
        let to_goal = self.goal - situation.robot.position;
        let distance = to_goal.dot(&to_goal).sqrt();
        if distance == 0.0 {
            return Vector2::new(1.0, 0.0);
        }
        to_goal * (1.0 / distance)
    }

    /// The best free velocity by the rule, the first one among equals in the order of
    /// [`Self::candidates`]. Lines come by what they promise: those that promise less than what is
    /// found, and their crossings, are not looked at, nor are those that one obstacle forbids as far as
    /// they promise more.
    fn select(&mut self, situation: &Situation<'_, f64>) -> Option<Vector> {
        let reachable = self.reachable(situation);
        let aim = self.direction_to_goal(situation);
        self.draw_lines(aim);
        let wanted = self.wanted(situation, aim);
        let mut best = Best::new(self, situation, (reachable, aim));
        for (number, velocity) in self
            .first_candidates(situation, aim)
            .into_iter()
            .enumerate()
        {
            best.offer((0, number), velocity);
        }
        let last = Self::last_candidates(&reachable, aim).enumerate();
        for (number, velocity) in last {
            best.offer((usize::MAX, number), velocity);
        }
        // The lines that gave the best velocity a control period ago mostly do so again.
        if let Some(velocity) = self.candidate(self.chosen, wanted, &reachable) {
            best.offer(self.chosen, velocity);
        }
        best.narrow();
        let mut covers = best.covers();
        let mut open: Vec<Promising> = Vec::new();
        for line in &best.promising(&self.lines) {
            if best.is_better_than(line.promise) {
                break;
            }
            if self.is_covered(&best, &mut covers, line) {
                continue;
            }
            let own = line.line.own(wanted, &reachable);
            for (number, velocity) in own.into_iter().enumerate() {
                if let Some(velocity) = velocity {
                    best.offer((1 + line.index, number), velocity);
                }
            }
            for other in &open {
                let (later, earlier) = if line.index > other.index {
                    (line, other)
                } else {
                    (other, line)
                };
                if let Some(velocity) = later.line.crossing(&earlier.line) {
                    best.offer((1 + later.index, best::OWN + earlier.index), velocity);
                }
            }
            open.push(*line);
        }
        let (place, velocity) = best.chosen()?;
        self.chosen = place;
        Some(velocity)
    }

    /// The velocity at a place, if that is on a line.
    fn candidate(
        &self,
        (line, number): Place,
        wanted: Vector,
        reachable: &Reachable,
    ) -> Option<Vector> {
        let line = self.lines.get(line.checked_sub(1)?)?;
        match number.checked_sub(best::OWN) {
            None => line.own(wanted, reachable)[number],
            Some(other) => line.crossing(self.lines.get(other)?),
        }
    }

    /// Whether one obstacle forbids all velocities of a line that may be better than the best one.
    fn is_covered(&self, best: &Best<'_>, covers: &mut Covers, line: &Promising) -> bool {
        let horizon = self.settings.horizon;
        let part = best.better_part(line);
        part.is_some_and(|ends| covers.cover(&self.cones, ends, horizon))
    }

    /// The reachable velocity with the latest contact, for want of a free one.
    fn latest_contact(&self, situation: &Situation<'_, f64>) -> Vector {
        let reachable = self.reachable(situation);
        let mut candidates = self.candidates(situation);
        for direction in 0..DIRECTIONS {
            let angle = std::f64::consts::TAU * f64::from(direction) / f64::from(DIRECTIONS);
            let (sine, cosine) = angle.sin_cos();
            for (center, radius) in reachable.circles() {
                let outward = Vector2::new(cosine, sine);
                candidates.push(center + outward * radius);
            }
        }
        // A robot far above its limits can reach nothing that it may have: it slows down.
        let velocity = situation.robot.velocity;
        let speed = velocity.dot(&velocity).sqrt();
        let slowest = velocity * ((reachable.max_speed / speed).min(1.0));
        let still = Vector2::select(speed > 0.0, slowest, velocity);
        let mut best = (f64::NEG_INFINITY, still);
        for velocity in candidates {
            if !reachable.holds(velocity) {
                continue;
            }
            // One contact that is not later than the latest known one is enough.
            let mut time = f64::INFINITY;
            for cone in &self.cones {
                time = time.min(cone.time_to_contact(velocity));
                if time <= best.0 {
                    break;
                }
            }
            if time > best.0 {
                best = (time, velocity);
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
