//! What velocities are worth by the rule of selection.

use super::lines::ON_THE_LIMIT;
use super::{Selection, Situation, Vector, VelocityObstaclePlanner};

impl VelocityObstaclePlanner {
    /// Speeds that differ by roundings have the same rank.
    pub(super) fn rank(&self, speed: f64) -> f64 {
        (speed / (self.max_speed * ON_THE_LIMIT)).round()
    }

    /// Time to the goal at full speed after a control period at a velocity, in s.
    pub(super) fn time_left(&self, situation: &Situation<'_, f64>, velocity: Vector) -> f64 {
        let left = self.goal - situation.robot.position - velocity * situation.interval;
        left.dot(&left).sqrt() / self.max_speed
    }

    /// The least such time of all velocities with no larger component toward the goal.
    pub(super) fn least_time_left(&self, situation: &Situation<'_, f64>, forward: f64) -> f64 {
        let to_goal = self.goal - situation.robot.position;
        let left = to_goal.dot(&to_goal).sqrt() - forward * situation.interval;
        left.max(0.0) / self.max_speed
    }

    /// What a rule prefers: larger is better, then by the second number.
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
