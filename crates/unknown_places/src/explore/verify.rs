//! Whether a robot with two wheels that takes a twist, and brakes then, touches nothing that it knows.

use nalgebra::Vector2;
use navigation_world::robots::differential::Twist;
use navigation_world::world::footprint::{Arc, Footprint};

/// Arcs of a ramp.
const QUARTERS: usize = 4;
/// Rounding of distances in m.
const ROUNDING: f64 = 1e-9;
/// Samples of an arc along which what is inside of the outline may not come deeper, and by how much in m.
const SAMPLES: u32 = 8;
const DEEPER: f64 = 1e-6;
/// Distance in m that is looked at beyond what a plan can touch.
const BEYOND: f64 = 0.05;

/// A robot with two wheels, and what its plans keep to.
#[derive(Clone, Debug, PartialEq)]
pub struct Chassis {
    /// Outline around the middle of the axle.
    pub footprint: Footprint,
    /// Change of speed in m/s^2 that it is sure of, faster or slower.
    pub acceleration: f64,
    /// Change of its turn rate in rad/s^2.
    pub turn_acceleration: f64,
    /// Control period in s.
    pub period: f64,
    /// Distance from everything known in m.
    pub margin: f64,
}

/// A disc in the frame of the robot at the start of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// Middle in m.
    pub place: Vector2<f64>,
    /// Radius in m.
    pub radius: f64,
    /// Distance of the middle from that of the axle in m.
    away: f64,
    /// Signed distance of the surfaces in m.
    present: f64,
}

impl Obstacle {
    /// Signed distance of the surfaces in m, at the start of the plan.
    #[must_use]
    pub fn present(&self) -> f64 {
        self.present
    }
}

/// A piece of a plan: an arc from a pose in the frame at its start.
#[derive(Clone, Copy, Debug)]
struct Piece {
    place: Vector2<f64>,
    /// Cosine and sine of the heading.
    heading: Vector2<f64>,
    arc: Arc,
    /// How far the outline may be from it in m.
    deviation: f64,
}

impl Piece {
    /// A point as it is seen from a pose on the arc, at a share of its length.
    fn seen(&self, point: Vector2<f64>, share: f64) -> Vector2<f64> {
        let apart = point - self.place;
        let seen = Vector2::new(self.heading.dot(&apart), self.heading.perp(&apart));
        if share == 0.0 {
            return seen;
        }
        let (way, turn) = moved(self.arc.distance * share, self.arc.angle * share);
        let left = seen - way;
        Vector2::new(turn.dot(&left), turn.perp(&left))
    }
}

/// Way in the frame at the start of an arc, and the direction at its end.
pub(super) fn moved(distance: f64, angle: f64) -> (Vector2<f64>, Vector2<f64>) {
    let half = 0.5 * angle;
    let (sin, cos) = half.sin_cos();
    let chord = if half == 0.0 {
        distance
    } else {
        distance * sin / half
    };
    let turn = Vector2::new(cos * cos - sin * sin, 2.0 * sin * cos);
    (Vector2::new(cos, sin) * chord, turn)
}

impl Chassis {
    /// Control periods in which a twist is braked to rest.
    #[must_use]
    pub fn periods_to_rest(&self, twist: Twist) -> u32 {
        let periods = |rate: f64, change: f64| {
            (rate.abs() / (change * self.period) - ROUNDING)
                .ceil()
                .max(0.0)
        };
        periods(twist.speed, self.acceleration)
            .max(periods(twist.turn_rate, self.turn_acceleration)) as u32
    }

    /// How far the middle of the axle can come in m, from a twist on, in a period and until rest.
    #[must_use]
    pub fn travel(&self, from: Twist) -> f64 {
        let most = from.speed.abs() + self.acceleration * self.period;
        let turning = from.turn_rate.abs() + self.turn_acceleration * self.period;
        let rest = self.periods_to_rest(Twist {
            speed: most,
            turn_rate: turning,
        });
        self.period * most * (1.0 + 0.5 * f64::from(rest))
    }

    /// How far from the middle of the axle anything is looked at in m, for a way that is driven until rest.
    #[must_use]
    pub fn sight(&self, travel: f64) -> f64 {
        self.footprint.outer_radius() + travel + self.margin + BEYOND
    }

    /// A disc in the frame of the robot.
    #[must_use]
    pub fn obstacle(&self, place: Vector2<f64>, radius: f64) -> Obstacle {
        let present = self.footprint.signed_distance(place) - radius;
        Obstacle {
            place,
            radius,
            away: place.norm(),
            present,
        }
    }

    /// The plan that takes one twist for another in a period, and brakes.
    fn plan(&self, from: Twist, to: Twist) -> [Piece; QUARTERS + 1] {
        let change = Twist {
            speed: to.speed - from.speed,
            turn_rate: to.turn_rate - from.turn_rate,
        };
        let outer = self.footprint.outer_radius();
        let deviation = (change.speed.abs() + outer * change.turn_rate.abs()) * self.period / 128.0;
        let arc = |quarter: usize| {
            if quarter == QUARTERS {
                let half = 0.5 * self.period * f64::from(self.periods_to_rest(to));
                return Arc {
                    distance: to.speed * half,
                    angle: to.turn_rate * half,
                };
            }
            let (share, time) = (
                (quarter as f64 + 0.5) / QUARTERS as f64,
                self.period / QUARTERS as f64,
            );
            Arc {
                distance: (from.speed + share * change.speed) * time,
                angle: (from.turn_rate + share * change.turn_rate) * time,
            }
        };
        let (mut place, mut heading) = (Vector2::zeros(), Vector2::new(1.0, 0.0));
        std::array::from_fn(|quarter| {
            let piece = Piece {
                place,
                heading,
                arc: arc(quarter),
                deviation: if quarter == QUARTERS { 0.0 } else { deviation },
            };
            let (way, turn) = moved(piece.arc.distance, piece.arc.angle);
            let rotated = |vector: Vector2<f64>| {
                Vector2::new(
                    heading.x * vector.x - heading.y * vector.y,
                    heading.y * vector.x + heading.x * vector.y,
                )
            };
            place += rotated(way);
            heading = rotated(turn);
            piece
        })
    }

    /// Whether taking one twist for another, and braking then, keeps the margin from everything, or comes no nearer to
    /// what is nearer already; otherwise the first obstacle that it comes too near to.
    ///
    /// # Errors
    /// Index of that obstacle.
    pub fn verify(&self, from: Twist, to: Twist, obstacles: &[Obstacle]) -> Result<(), usize> {
        let plan = self.plan(from, to);
        let outer = self.footprint.outer_radius();
        let travel: f64 = plan.iter().map(|piece| piece.arc.distance.abs()).sum();
        for (index, obstacle) in obstacles.iter().enumerate() {
            if obstacle.away > outer + travel + self.margin + obstacle.radius + BEYOND {
                continue;
            }
            let kept = if obstacle.present < 0.0 {
                self.comes_no_deeper(&plan, obstacle)
            } else {
                plan.iter()
                    .all(|piece| self.keeps_off(piece, obstacle, outer))
            };
            if !kept {
                return Err(index);
            }
        }
        Ok(())
    }

    fn keeps_off(&self, piece: &Piece, obstacle: &Obstacle, outer: f64) -> bool {
        let extra = if obstacle.present >= self.margin {
            piece.deviation
        } else {
            0.0
        };
        let least = self.margin.min(obstacle.present) - ROUNDING + extra + obstacle.radius;
        let seen = piece.seen(obstacle.place, 0.0);
        let reach = outer + piece.arc.distance.abs() + least;
        seen.norm_squared() > reach * reach || self.footprint.swept_point(seen, piece.arc) >= least
    }

    fn comes_no_deeper(&self, plan: &[Piece], obstacle: &Obstacle) -> bool {
        let mut before = obstacle.present;
        plan.iter().all(|piece| {
            (1..=SAMPLES).all(|sample| {
                let seen = piece.seen(obstacle.place, f64::from(sample) / f64::from(SAMPLES));
                let now = self.footprint.signed_distance(seen) - obstacle.radius;
                let kept = now >= before.min(0.0) - DEEPER;
                before = before.max(now);
                kept
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_are_verified_as_in_the_checked_cases() {
        let text = include_str!("plan_cases.json");
        let cases: serde_json::Value = serde_json::from_str(text).unwrap();
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        let constants = &cases["plan_constants"];
        let (a, b) = (
            number(&constants["half_length"]),
            number(&constants["half_width"]),
        );
        let chassis = |margin: f64| Chassis {
            footprint: Footprint::polygon(&[[a, b], [-a, b], [-a, -b], [a, -b]]).unwrap(),
            acceleration: number(&constants["a_max"]),
            turn_acceleration: number(&constants["alpha_max"]),
            period: number(&constants["T"]),
            margin,
        };
        let mut seen = 0;
        for (list, words) in [
            ("plans", vec![("verified", 0.02)]),
            (
                "plans_margin",
                vec![("verified_at_0_02", 0.02), ("verified_at_0_03", 0.03)],
            ),
        ] {
            for case in cases[list].as_array().unwrap() {
                for (word, margin) in &words {
                    let chassis = chassis(*margin);
                    let points = case["points"].as_array().unwrap();
                    let obstacles: Vec<Obstacle> = points
                        .iter()
                        .map(|point| {
                            chassis.obstacle(
                                Vector2::new(number(&point[0]), number(&point[1])),
                                number(&point[2]),
                            )
                        })
                        .collect();
                    let twist = |speed: &str, turn: &str| Twist {
                        speed: number(&case[speed]),
                        turn_rate: number(&case[turn]),
                    };
                    let found = chassis
                        .verify(twist("v", "w"), twist("v1", "w1"), &obstacles)
                        .is_ok();
                    assert_eq!(
                        found,
                        case[*word].as_bool().unwrap(),
                        "{list} {case} {margin}"
                    );
                    seen += 1;
                }
            }
        }
        assert_eq!(seen, 50);
    }
}
