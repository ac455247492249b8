//! Velocity obstacles of Fiorini and Shiller (1998): relative velocities that lead to a contact
//! lie between two rays; what is left of the reachable velocities is searched exactly.

mod best;
mod candidates;
mod cones;
mod cover;
mod free;
mod lines;
mod parts;
mod remaining;
mod sweep;
#[cfg(test)]
pub(crate) mod tests;
mod view;
mod worth;

use std::cell::Cell;

use best::{Best, Place, Room};
use cones::{Cone, ConeBase, LegGroup};
use lines::{Line, Reachable};
use view::View;

use crate::arguments::{Arguments, Named};
use crate::error::{Failure, Given, Result};
use crate::lanes::{Planar, Vector2};
use crate::laws::Situation;
use crate::laws::outlook::Attention;
use crate::laws::planning::Planner;
use crate::laws::planning::outline::Outline;
use crate::world::geometry::Body;
use crate::world::obstacle::Shape;
use crate::world::scenario::Scenario;

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
    legs: Vec<LegGroup>,
    /// Outlines that are no discs.
    edged: Vec<Outline>,
    /// As they are seen now, those that are so near that the way to a new velocity may touch them.
    close: Vec<Outline>,
    /// Lines from standstill, which follow the two of each cone.
    ahead: Vec<Line>,
    /// Place of the last velocity that was chosen.
    chosen: Place,
    /// The cone that forbade the last velocity.
    blocking: Cell<usize>,
    /// For decisions with the margin, and without it: what forbids something differs.
    rooms: [Option<Box<Room>>; 2],
    /// What it is told of.
    view: View,
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
            legs: Vec::new(),
            edged: Vec::new(),
            close: Vec::new(),
            ahead: Vec::new(),
            chosen: (0, 0),
            blocking: Cell::new(0),
            rooms: Default::default(),
            view: View::default(),
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
        self.select(0, situation).map(|best| best.lane(0))
    }

    fn reachable(&self, situation: &Situation<'_, f64>) -> Reachable {
        Reachable {
            velocity: situation.robot.velocity,
            change: self.max_acceleration * situation.interval,
            max_speed: self.max_speed,
        }
    }

    fn look(&mut self, situation: &Situation<'_, f64>, margin: f64) {
        let farthest = self.farthest(situation);
        self.cones.clear();
        self.edged.clear();
        self.close.clear();
        // The robot changes its velocity over a control period: as if it went on at the old
        // one for a part of it and had the new one from there.
        let before = (1.0 - self.settings.ramp) * situation.interval;
        for body in situation.bodies {
            if body.state.present {
                self.look_at(body, situation, (margin, farthest, before));
            }
        }
        cones::draw_legs(&mut self.cones, &mut self.legs);
    }

    #[inline]
    fn look_at(
        &mut self,
        body: &Body,
        situation: &Situation<'_, f64>,
        (margin, farthest, before): (f64, f64, f64),
    ) {
        let robot = &situation.robot;
        let tip = Vector::splat(body.state.velocity);
        let way = (robot.velocity - tip) * before;
        let Shape::Disc { radius } = body.shape else {
            let now = Outline::new(body, robot.position, self.robot_radius, margin);
            let later = now.seen_after(way);
            self.close.push(now);
            self.cones.push(Cone {
                tip,
                legs: later.legs(),
                base: ConeBase::Edges(self.edged.len()),
            });
            return self.edged.push(later);
        };
        let center = Vector::splat(body.state.position) - robot.position;
        let radius = (self.robot_radius + margin) + radius;
        if !free::is_far((center, radius), tip, (farthest, situation.interval)) {
            self.close.push(Outline::disc(center, radius, tip));
        }
        self.cones.push(Cone {
            tip,
            legs: None,
            base: ConeBase::Disc(center - way, radius),
        });
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
    fn select(&mut self, pass: usize, situation: &Situation<'_, f64>) -> Option<Vector> {
        let reachable = self.reachable(situation);
        let aim = self.direction_to_goal(situation);
        self.draw_lines(aim);
        let wanted = self.wanted(situation, aim);
        let mut room = self.rooms[pass].take().unwrap_or_default();
        let mut remaining = std::mem::take(&mut room.remaining);
        let mut best = Best::new(self, situation, (reachable, aim), room);
        for (number, velocity) in self
            .first_candidates(situation, aim)
            .into_iter()
            .enumerate()
        {
            best.offer((0, number), velocity);
        }
        let last = Self::last_candidates(&reachable, aim).enumerate();
        // What is wanted mostly is one of them, and has been offered.
        for (number, velocity) in last.filter(|(_, velocity)| *velocity != wanted) {
            best.offer((usize::MAX, number), velocity);
        }
        // The lines that gave the best velocity a control period ago mostly do so again.
        if let Some(velocity) = self.candidate(self.chosen, wanted, &reachable) {
            best.offer(self.chosen, velocity);
        }
        let wide = [best.cap()];
        best.narrow_down(&wide, &mut remaining, wanted);
        best.look_along_lines(wanted);
        let cap = best.cap();
        let told = self.view.holds(&cap, &reachable);
        let (chosen, mut room) = best.ended();
        room.remaining = remaining;
        self.rooms[pass] = Some(room);
        self.view.note(cap, told);
        let (place, velocity) = chosen.filter(|_| told)?;
        self.chosen = place;
        Some(velocity)
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
            // One contact that is not later than the latest known one is enough, and what forbids a velocity mostly
            // forbids its neighbors.
            let mut time = f64::INFINITY;
            for index in std::iter::once(self.blocking.get()).chain(0..self.cones.len()) {
                let cone = self.cones.get(index);
                let Some(cone) = cone.filter(|cone| !cone.is_beside(velocity)) else {
                    continue;
                };
                time = time.min(cone.time_to_contact(velocity, &self.edged));
                if time <= best.0 {
                    self.blocking.set(index);
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
        self.view.begin();
        for (pass, margin) in [self.settings.margin, 0.0].into_iter().enumerate() {
            self.look(situation, margin);
            if self.takes_whole_lines() && self.view.lacks_those_behind() {
                return [0.0; 2];
            }
            if let Some(best) = self.select(pass, situation) {
                return best.lane(0);
            }
            if self.overlooks() {
                return [0.0; 2];
            }
        }
        // Where nothing is free, all crossings are tried.
        if self.view.lacks_those_behind() {
            return [0.0; 2];
        }
        self.latest_contact(situation).lane(0)
    }

    fn attention(&mut self, situation: &Situation<'_, f64>) -> Attention {
        self.look_out(situation)
    }

    fn overlooks(&self) -> bool {
        self.view.misses()
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.goal = Vector::splat(goal);
    }
}
