//! First velocities and their prices.

use crate::foresight::program::FARTHEST_MOVE;
use crate::foresight::{Foreseer, Scene};
use crate::shield::braking;
use navigation_world::world::geometry::RobotState;
use numeric::lanes::Vector2;

/// Directions and speeds of the candidates.
const DIRECTIONS: u32 = 36;
const SPEEDS: u32 = 3;

/// Distance of the surface from walls below which nobody goes nearer, in m.
const ROOM: f64 = 0.015;

/// Prices that differ by less are alike, in s.
const ALIKE: f64 = 1e-9;

/// Cells that the first velocity can lead over, with one more.
pub(super) fn cells_of_first_velocity(max_speed: f64, preferred: f64) -> f64 {
    (FARTHEST_MOVE * max_speed / preferred).ceil() + 1.0
}

/// Velocity that the robot takes up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// In m/s.
    pub velocity: Vector2<f64>,
    /// Whether a robot with two wheels drives backwards.
    pub backwards: bool,
}

impl Target {
    /// A velocity that is taken up forwards.
    #[must_use]
    pub fn forwards(velocity: Vector2<f64>) -> Self {
        Self {
            velocity,
            backwards: false,
        }
    }
}

/// Target that was accepted, with the command toward it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcceptedTarget<C> {
    /// Velocity in m/s that the robot takes up.
    pub target: Vector2<f64>,
    /// Command toward it.
    pub command: C,
    /// Whether no cheaper one was refused.
    pub cheapest: bool,
}

/// Way of a robot that takes up a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driven {
    /// Places after the four quarters of a stage, in m.
    pub places: [Vector2<f64>; 4],
    /// Where a robot with two wheels looks at the end.
    pub facing: Option<Facing>,
}

/// Heading of a robot that has to turn before it drives another way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// Direction, of length 1.
    pub ahead: Vector2<f64>,
    /// Price of a turn in s for each rad.
    pub price: f64,
}

impl Facing {
    /// Price of the turn to a direction, in s.
    fn turning(&self, to: Vector2<f64>) -> f64 {
        self.price * self.ahead.perp(&to).atan2(self.ahead.dot(&to)).abs()
    }
}

/// Places after the four quarters of a time in s of a robot that takes up a velocity evenly and keeps it.
#[must_use]
pub fn taken_up(
    robot: &RobotState<f64>,
    velocity: Vector2<f64>,
    acceleration: f64,
    time: f64,
) -> [Vector2<f64>; 4] {
    let change = velocity - robot.velocity;
    let ramp = change.norm() / acceleration;
    std::array::from_fn(|quarter| {
        let time = 0.25 * time * (quarter + 1) as f64;
        if time < ramp {
            return robot.position + (robot.velocity + change * (0.5 * time / ramp)) * time;
        }
        robot.position + robot.velocity * ramp + change * (0.5 * ramp) + velocity * (time - ramp)
    })
}

/// Target with its price.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub target: Target,
    pub price: f64,
}

/// Takes the cheapest candidate out of what is left, of those that are alike the first.
pub(super) fn cheapest(candidates: &mut [Candidate]) -> Option<Target> {
    let least = candidates
        .iter()
        .map(|each| each.price)
        .fold(f64::INFINITY, f64::min);
    let found = candidates
        .iter_mut()
        .find(|each| each.price < least + ALIKE)?;
    if found.price == f64::INFINITY {
        return None;
    }
    found.price = f64::INFINITY;
    Some(found.target)
}

impl Foreseer {
    /// Prices all candidates.
    pub(super) fn price(
        &mut self,
        scene: &Scene<'_>,
        wheels: bool,
        driven: &impl Fn(&Target) -> Driven,
    ) {
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.clear();
        let (before, last) = (scene.robot.velocity, self.last);
        let slower = Target {
            velocity: braking(before, &self.limits),
            ..last
        };
        let first = [last, Target::forwards(Vector2::zeros()), slower];
        candidates.extend(first.map(|target| Candidate { target, price: 0.0 }));
        let ahead = scene.ahead.y.atan2(scene.ahead.x);
        let sides: &[bool] = if wheels { &[false, true] } else { &[false] };
        for backwards in sides {
            for speed in 1..=SPEEDS {
                let length = self.limits.max_speed * f64::from(speed) / f64::from(SPEEDS);
                for direction in 0..DIRECTIONS {
                    let turn = f64::from(direction) * std::f64::consts::TAU / f64::from(DIRECTIONS);
                    let (sin, cos) = (ahead + turn).sin_cos();
                    let velocity = Vector2::new(cos, sin) * length;
                    let target = Target {
                        velocity,
                        backwards: *backwards,
                    };
                    candidates.push(Candidate { target, price: 0.0 });
                }
            }
        }
        let least = self.room + ROOM;
        let fastest = self.limits.max_speed.max(before.norm());
        let near = least + fastest * self.settings.step;
        let room = scene.walls.clearance_up_to(scene.robot.position, near);
        let walls = room < near;
        let met = self.met(scene, fastest);
        for candidate in &mut candidates {
            let driven = driven(&candidate.target);
            let kept = |place: &Vector2<f64>| {
                let clearance = scene.walls.clearance_up_to(*place, least);
                clearance >= least || clearance >= room
            };
            candidate.price = if walls && !driven.places.iter().all(kept) {
                f64::INFINITY
            } else {
                self.price_of(scene, &candidate.target, &driven, &met)
            };
        }
        self.candidates = candidates;
    }

    /// People who can be near the robot within the first stage.
    fn met(&self, scene: &Scene<'_>, fastest: f64) -> Vec<usize> {
        let step = self.settings.step;
        let near = |index: &usize| {
            let person = &self.prediction.people[*index];
            let blur = self.settings.blur(step, person.deviation);
            let most = person.touch + self.settings.felt(blur) + (fastest + person.speed) * step;
            let offset = self.prediction.places(*index)[0] - scene.robot.position;
            offset.norm_squared() < most * most
        };
        (0..self.prediction.people.len()).filter(near).collect()
    }

    fn price_of(&self, scene: &Scene<'_>, target: &Target, driven: &Driven, met: &[usize]) -> f64 {
        let settings = &self.settings;
        let part = 0.25 * settings.step;
        let mut price = 0.0;
        for index in met {
            let person = &self.prediction.people[*index];
            let foreseen = self.prediction.places(*index);
            let others = [
                (foreseen[0] + foreseen[1]) * 0.5,
                foreseen[1],
                (foreseen[1] + foreseen[2]) * 0.5,
                foreseen[2],
            ];
            for (quarter, (place, other)) in driven.places.iter().zip(others).enumerate() {
                let blur = settings.blur((quarter + 1) as f64 * part, person.deviation);
                let gap = (place - other).norm() - person.touch;
                let short = (1.0 - gap / settings.comfort).max(0.0);
                price += part
                    * (settings.risk_weight * settings.risk(gap, blur)
                        + settings.comfort_weight * short * short);
            }
        }
        let change = (target.velocity - self.last.velocity).norm() / self.limits.max_speed;
        let haste = (target.velocity.norm() / self.preferred - 1.0).max(0.0);
        let end = driven.places[3] - scene.robot.position;
        let turning = driven.facing.map_or(0.0, |facing| {
            let onward = self.program.onward(end).unwrap_or_default();
            facing.turning(onward)
        });
        price
            + self.program.cost(end)
            + turning
            + settings.change_weight * change
            + settings.speed_weight * settings.step * haste
            + self
                .impatience
                .price(scene.robot.position + target.velocity * settings.step)
    }
}
