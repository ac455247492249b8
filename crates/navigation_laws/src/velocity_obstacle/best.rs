//! The best velocity so far, and what a line of velocities may still promise.

use super::lines::{Covers, Line, ON_THE_LIMIT, Reachable, VelocityDisc};
use super::{Selection, Situation, Vector, VelocityObstaclePlanner};

/// Numbers of the candidates of a line by itself; its crossings follow.
pub(super) const OWN: usize = 5;

/// A promise is worth this much more than it says, relative to it: well above all roundings.
const SLACK: f64 = 1e-6;

/// A line that anything reachable lies on.
#[derive(Clone, Copy)]
pub(super) struct Promising {
    /// Upper bound of the value of its velocities.
    pub promise: f64,
    /// Its place among the lines.
    pub index: usize,
    /// The line.
    pub line: Line,
    /// Ends of its part that is reachable, generously.
    ends: [Vector; 2],
}

/// Place of a candidate in the order of all: the line, and its number there.
pub(super) type Place = (usize, usize);

/// The best free velocity of those that were offered, in any order: the same as in the order of
/// their places.
pub(super) struct Best<'a> {
    planner: &'a VelocityObstaclePlanner,
    situation: &'a Situation<'a, f64>,
    reachable: Reachable,
    aim: Vector,
    /// Least value by the first number: whatever promises less is skipped.
    least: f64,
    found: Option<((f64, f64), Place, Vector)>,
    /// The cones that may forbid any velocity that may be worth enough, once they have been sorted out.
    near: Option<Vec<usize>>,
    /// The lines on which there may be any.
    lines: Vec<usize>,
}

impl<'a> Best<'a> {
    pub fn new(
        planner: &'a VelocityObstaclePlanner,
        situation: &'a Situation<'a, f64>,
        (reachable, aim): (Reachable, Vector),
    ) -> Self {
        Self {
            planner,
            situation,
            reachable,
            aim,
            least: f64::NEG_INFINITY,
            found: None,
            near: None,
            lines: Vec::new(),
        }
    }

    /// The best velocity and its place.
    pub fn chosen(&self) -> Option<(Place, Vector)> {
        self.found.map(|(_, place, velocity)| (place, velocity))
    }

    /// Takes a velocity if it is reachable, better than the one before, and free. Most are far out
    /// of reach, which their squares tell.
    #[inline]
    pub fn offer(&mut self, place: Place, velocity: Vector) {
        if self.reachable.may_hold(velocity) && self.at_most(velocity) >= self.least {
            self.take(place, velocity);
        }
    }

    /// Takes a velocity that is not far out of reach and may be worth enough.
    #[inline(never)]
    fn take(&mut self, place: Place, velocity: Vector) {
        if !self.reachable.holds(velocity) {
            return;
        }
        let worth = self.planner.worth(self.situation, self.aim, velocity);
        let better = self
            .found
            .is_none_or(|(known, earlier, _)| worth > known || (worth == known && place < earlier));
        if better && self.is_free(velocity) {
            self.found = Some((worth, place, velocity));
            self.least = worth.0;
        }
    }

    fn is_free(&self, velocity: Vector) -> bool {
        let (planner, situation) = (self.planner, self.situation);
        match &self.near {
            None => planner.free(situation, velocity),
            Some(near) => planner.free_of(near.iter().copied(), situation, velocity),
        }
    }

    /// Sorts out the cones that can forbid nothing that may be worth more than what was found, and the
    /// legs on which there is nothing of that kind.
    pub fn narrow(&mut self) {
        let cap = self.cap();
        let Self { near, lines, .. } = self;
        let near = near.insert(Vec::new());
        let mut line = 0;
        for (index, cone) in self.planner.cones.iter().enumerate() {
            let Some(legs) = &cone.legs else {
                near.push(index);
                continue;
            };
            let offset = cap.center - cone.outline.velocity;
            let reach = cap.reach(offset);
            let across = [legs.left, legs.right].map(|leg| leg.perp(&offset));
            // Also where a number is not one.
            if !(across[0] > reach || across[1] < -reach) {
                near.push(index);
            }
            for side in across {
                if !(side > reach || side < -reach) {
                    lines.push(line);
                }
                line += 1;
            }
        }
        lines.extend(line..self.planner.lines.len());
    }

    /// The cones of discs that may forbid whole lines.
    pub fn covers(&self) -> Covers {
        let near = self.near.as_deref();
        let chosen = near.filter(|_| self.planner.settings.selection == Selection::ToGoal);
        Covers::of(&self.planner.cones, chosen.unwrap_or_default())
    }

    /// The smallest disc that is known to hold everything reachable that may be worth enough.
    fn cap(&self) -> VelocityDisc {
        let wide = self.reachable.circles().map(|(center, radius)| {
            let wide = VelocityDisc { center, radius };
            if self.planner.settings.selection != Selection::ToGoal {
                return wide;
            }
            let least = self.least - SLACK * (1.0 + self.least.abs());
            wide.beyond(least, self.aim)
        });
        let [one, other] = wide;
        if one.radius < other.radius {
            one
        } else {
            other
        }
    }

    /// Upper bound of the value of a velocity, without a look at the obstacles.
    #[inline]
    fn at_most(&self, velocity: Vector) -> f64 {
        match self.planner.settings.selection {
            Selection::ToGoal => velocity.dot(&self.aim),
            Selection::Fastest { .. } => self.planner.rank(velocity.dot(&velocity).sqrt()),
            Selection::TimeAndRisk { .. } => -self.planner.time_left(self.situation, velocity),
        }
    }

    /// Lines that anything reachable lies on which may be worth enough, the most promising first.
    pub fn promising(&self, lines: &[Line]) -> Vec<Promising> {
        let promise = |&index: &usize| {
            let line = &lines[index];
            let ends = self.reachable.chord(line)?;
            let promise = self.promise(ends);
            (!self.is_better_than(promise)).then_some(Promising {
                promise,
                index,
                line: *line,
                ends,
            })
        };
        let found: Vec<Promising> = self.lines.iter().filter_map(promise).collect();
        // The lines follow each other by their places, so that equal promises are told apart by the order.
        let mut order: Vec<(f64, usize)> = found
            .iter()
            .enumerate()
            .map(|(place, line)| (line.promise, place))
            .collect();
        order.sort_unstable_by(|one, other| other.0.total_cmp(&one.0).then(one.1.cmp(&other.1)));
        order.into_iter().map(|(_, place)| found[place]).collect()
    }

    /// Upper bound of the value of the velocities between two.
    fn promise(&self, ends: [Vector; 2]) -> f64 {
        let largest = |value: &dyn Fn(Vector) -> f64| value(ends[0]).max(value(ends[1]));
        let exact = match self.planner.settings.selection {
            Selection::ToGoal => largest(&|velocity| velocity.dot(&self.aim)),
            Selection::Fastest { .. } => self.planner.rank(largest(&|velocity| velocity.norm())),
            Selection::TimeAndRisk { .. } => {
                let forward = largest(&|velocity| velocity.dot(&self.aim));
                -self.planner.least_time_left(self.situation, forward)
            }
        };
        exact + SLACK * (1.0 + exact.abs())
    }

    /// Ends of the part of a line that may be worth as much as what was found, generously; `None` where
    /// worth is no component of the velocity.
    pub fn better_part(&self, line: &Promising) -> Option<[Vector; 2]> {
        if self.planner.settings.selection != Selection::ToGoal {
            return None;
        }
        let least = self.least - SLACK * (1.0 + self.least.abs());
        let ends = line.ends;
        let [first, second] = ends.map(|end| end.dot(&self.aim));
        let between = |low: f64, high: f64| (least - low) / (high - low);
        let way = ends[1] - ends[0];
        Some(if first < least && least < second {
            [ends[0] + way * between(first, second), ends[1]]
        } else if second < least && least < first {
            [ends[0], ends[1] - way * between(second, first)]
        } else {
            ends
        })
    }

    /// Whether what was found is worth more than a promise.
    pub fn is_better_than(&self, promise: f64) -> bool {
        self.found.is_some_and(|(known, ..)| known.0 > promise)
    }
}

/// Value of velocities.
impl VelocityObstaclePlanner {
    /// Speeds that differ by roundings have the same rank.
    fn rank(&self, speed: f64) -> f64 {
        (speed / (self.max_speed * ON_THE_LIMIT)).round()
    }

    /// Time to the goal at full speed after a control period at a velocity, in s.
    fn time_left(&self, situation: &Situation<'_, f64>, velocity: Vector) -> f64 {
        let left = self.goal - situation.robot.position - velocity * situation.interval;
        left.dot(&left).sqrt() / self.max_speed
    }

    /// The least such time of all velocities with no larger component toward the goal.
    fn least_time_left(&self, situation: &Situation<'_, f64>, forward: f64) -> f64 {
        let to_goal = self.goal - situation.robot.position;
        let left = to_goal.dot(&to_goal).sqrt() - forward * situation.interval;
        left.max(0.0) / self.max_speed
    }

    /// Preference of a rule: larger is better, then by the second number.
    pub(super) fn worth(
        &self,
        situation: &Situation<'_, f64>,
        aim: Vector,
        velocity: Vector,
    ) -> (f64, f64) {
        let forward = velocity.dot(&aim);
        let speed = velocity.dot(&velocity).sqrt();
        match self.settings.selection {
            Selection::ToGoal => (forward, speed),
            Selection::Fastest { sector } => {
                let within = forward >= speed * (sector.cos() - ON_THE_LIMIT);
                let rank = self.rank(speed);
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
                let time = self.time_left(situation, velocity);
                (-(time + risk / self.time_to_contact(velocity)), forward)
            }
        }
    }
}
