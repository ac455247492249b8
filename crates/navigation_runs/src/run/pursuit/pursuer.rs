//! Somebody who sees the robot and wants it to do wrong.

use std::f64::consts::TAU;

use nalgebra::Vector2;
use numeric::random::Stream;

use navigation_world::world::geometry::RobotState;

/// Time for which somebody keeps a direction, in s.
const LEG: f64 = 0.35;

/// Directions of a plan.
pub const LEGS: usize = 8;

/// Numbers that a search chooses: start along and across the way, directions of the legs, share of
/// pursuit, lead.
pub const NUMBERS: usize = 4 + LEGS;

/// Farthest start from the way of the robot, in m.
const ASIDE: f64 = 4.0;

/// Longest time by which a pursuer is ahead of the robot, in s.
const LONGEST_LEAD: f64 = 1.5;

/// Behavior of the pursuer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Tactic {
    /// Another direction for every leg.
    Legs([f64; LEGS]),
    /// Goes around the robot on a circle, then dashes at it.
    Circling {
        radius: f64,
        side: f64,
        until: f64,
        lead: f64,
    },
    /// Goes to where the robot will be.
    Pursuit { lead: f64 },
    /// Dashes at the robot and turns away, leg by leg.
    Feints { lead: f64, turn: f64 },
    /// A mixture of legs and pursuit.
    Mixture {
        legs: [f64; LEGS],
        share: f64,
        lead: f64,
    },
}

/// Somebody with a largest speed who sees the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pursuer {
    /// Where he starts, in m.
    pub start: [f64; 2],
    /// Largest speed in m/s.
    pub max_speed: f64,
    tactic: Tactic,
}

fn unit(angle: f64) -> Vector2<f64> {
    let (sin, cos) = angle.sin_cos();
    Vector2::new(cos, sin)
}

/// Direction with length 1, or none.
fn direction(vector: Vector2<f64>) -> Vector2<f64> {
    vector.try_normalize(1e-12).unwrap_or_else(Vector2::zeros)
}

/// A place beside the way from start to goal, by its share along and across, each from 0 to 1, at
/// least `free` m from the start.
fn beside([start, goal]: [[f64; 2]; 2], [along, across]: [f64; 2], free: f64) -> [f64; 2] {
    let (start, goal) = (Vector2::from(start), Vector2::from(goal));
    let way = goal - start;
    let left = direction(Vector2::new(-way.y, way.x));
    let place = start + way * along + left * (ASIDE * (2.0 * across - 1.0));
    let from = place - start;
    if from.norm() >= free {
        return place.into();
    }
    let aside = direction(if from.norm() > 0.0 { from } else { way });
    (start + aside * free).into()
}

impl Pursuer {
    /// One of a kind drawn from a seed, who starts at least `free` m from the robot.
    #[must_use]
    pub fn random(seed: u64, index: u64, ends: [[f64; 2]; 2], free: f64, max_speed: f64) -> Self {
        let mut stream = Stream::new(seed, index);
        let start = beside(ends, [stream.unit(), stream.unit()], free);
        let lead = stream.uniform(0.0, LONGEST_LEAD);
        let tactic = match stream.below(4) {
            0 => Tactic::Legs(std::array::from_fn(|_| stream.uniform(0.0, TAU))),
            1 => Tactic::Circling {
                radius: free + stream.uniform(0.0, 1.5),
                side: if stream.unit() < 0.5 { -1.0 } else { 1.0 },
                until: stream.uniform(0.5, 6.0),
                lead,
            },
            2 => Tactic::Pursuit { lead },
            _ => Tactic::Feints {
                lead,
                turn: stream.uniform(0.0, TAU),
            },
        };
        Self {
            start,
            max_speed,
            tactic,
        }
    }

    /// One who stands, for all that he does by himself.
    #[must_use]
    pub fn standing(start: [f64; 2]) -> Self {
        Self {
            start,
            max_speed: 0.0,
            tactic: Tactic::Pursuit { lead: 0.0 },
        }
    }

    /// The one of [`NUMBERS`] numbers from 0 to 1.
    #[must_use]
    pub fn planned(numbers: &[f64; NUMBERS], ends: [[f64; 2]; 2], free: f64, speed: f64) -> Self {
        let [along, across, share, lead, legs @ ..] = numbers;
        Self {
            start: beside(ends, [*along, *across], free),
            max_speed: speed,
            tactic: Tactic::Mixture {
                legs: legs.map(|leg| leg * TAU),
                share: *share,
                lead: lead * LONGEST_LEAD,
            },
        }
    }

    /// His velocity in m/s at a time in s, never faster than he can.
    #[must_use]
    pub fn velocity(&self, time: f64, own: Vector2<f64>, robot: &RobotState<f64>) -> Vector2<f64> {
        let leg = leg_at(time);
        let toward = |lead: f64| direction(robot.position + robot.velocity * lead - own);
        let way = match &self.tactic {
            Tactic::Legs(legs) => unit(legs[leg % LEGS]),
            Tactic::Circling {
                radius,
                side,
                until,
                lead,
            } => {
                if time >= *until {
                    toward(*lead)
                } else {
                    let to = robot.position - own;
                    let around = direction(Vector2::new(-to.y, to.x)) * *side;
                    direction(around + direction(to) * (to.norm() - radius))
                }
            }
            Tactic::Pursuit { lead } => toward(*lead),
            Tactic::Feints { lead, turn } => {
                // Two legs at the robot, one somewhere else.
                if leg % 3 == 2 {
                    unit(turn + leg as f64)
                } else {
                    toward(*lead)
                }
            }
            Tactic::Mixture { legs, share, lead } => {
                direction(unit(legs[leg % LEGS]) * (1.0 - share) + toward(*lead) * *share)
            }
        };
        way * self.max_speed
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a small whole number
fn leg_at(time: f64) -> usize {
    (time / LEG).floor() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_is_faster_than_he_can_and_starts_free() {
        let ends = [[0.0, 0.0], [8.0, 1.0]];
        for index in 0..400 {
            let pursuer = Pursuer::random(3, index, ends, 1.3, 1.6);
            let start = Vector2::from(pursuer.start);
            assert!(start.norm() >= 1.3 - 1e-12);
            for step in 0..40 {
                let robot = RobotState {
                    position: Vector2::new(0.1 * f64::from(step), 0.0),
                    velocity: Vector2::new(0.7, 0.1),
                };
                let velocity = pursuer.velocity(0.1 * f64::from(step), start, &robot);
                assert!(velocity.norm() <= 1.6 * (1.0 + 1e-12));
            }
        }
    }
}
