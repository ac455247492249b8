//! The shield of a robot with an outline: it turns with the heading, and who is touched is judged by the point that
//! touches.
//!
//! Passive safety: when robot and person touch, the touching point of the robot does not move toward the person. So
//! nobody may be in the room ahead of those parts of the outline that move outward. Velocities of the points of a body
//! are linear in its twist: in the ramp that room lies in the union of those of both twists at the same pose, and in
//! braking it is fixed in the body. Turning in place is no rest: corners move.

mod plan;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::shield::person::Person;
use crate::shield::walls::{ROUNDING, StaticObstacles};
use crate::shield::{Shield, TwistState};
use navigation_world::robots::differential::Twist;
use navigation_world::world::footprint::{BodyMotion, Footprint};
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::RobotState;
use navigation_world::world::shape::{PlacedShape, Shape};
use numeric::lanes::Vector2;
use plan::{BodyPlan, rays};

/// The outline of a robot under a shield.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineGuard {
    /// Assumptions of the shield.
    pub shield: Shield,
    /// Outline of the robot in coordinates of its body.
    pub outline: Arc<Footprint>,
    /// Whether the robot has two wheels: it moves along its heading only, and does not slip sideways.
    pub wheels: bool,
}

/// A robot with an outline that takes up a motion in a period and then brakes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyCommand {
    /// Position in m.
    pub position: Vector2<f64>,
    /// Heading in rad.
    pub heading: f64,
    /// Present motion.
    pub before: BodyMotion,
    /// Motion at the end of the period.
    pub after: BodyMotion,
    /// Control period in s.
    pub period: f64,
    /// Time from then to rest in s: both parts of the motion fall together.
    pub braking: f64,
}

impl BodyCommand {
    /// Of a robot with two wheels, that brakes for a time in s.
    #[must_use]
    pub fn of_twist(robot: &TwistState, command: Twist, [period, braking]: [f64; 2]) -> Self {
        let motion = |twist: Twist| BodyMotion::from([twist.speed, twist.turn_rate]);
        Self {
            position: robot.position,
            heading: robot.heading,
            before: motion(robot.twist),
            after: motion(command),
            period,
            braking,
        }
    }

    /// Of a robot that keeps its heading in rad, that brakes for a time in s.
    #[must_use]
    pub fn of_velocity(
        robot: &RobotState<f64>,
        heading: f64,
        command: Vector2<f64>,
        [period, braking]: [f64; 2],
    ) -> Self {
        let frame = Frame::at([0.0; 2], heading);
        let motion = |velocity: Vector2<f64>| BodyMotion {
            velocity: frame.inward(velocity),
            turn_rate: 0.0,
        };
        Self {
            position: robot.position,
            heading,
            before: motion(robot.velocity),
            after: motion(command),
            period,
            braking,
        }
    }
}

impl OutlineGuard {
    /// The shield of a robot that was measured to be off its plan: it may be as far off again.
    #[must_use]
    pub fn doubled(&self) -> Self {
        Self {
            shield: self.shield.doubled(),
            ..self.clone()
        }
    }

    /// Whether a command is verified: behind all people and off all walls.
    #[must_use]
    pub fn verified(
        &self,
        command: &BodyCommand,
        people: &[Person],
        walls: &StaticObstacles<'_>,
    ) -> bool {
        let Some(plan) = BodyPlan::new(self, command) else {
            return true;
        };
        people.iter().all(|person| self.avoids(&plan, person)) && self.off_walls(&plan, walls)
    }

    /// Whether nobody can be in the room ahead at any time of a plan.
    fn avoids(&self, plan: &BodyPlan, person: &Person) -> bool {
        let extent = person.placed.shape.extent();
        let depth = match person.placed.shape {
            Shape::Disc { .. } => self.shield.around() + extent,
            // A rectangle can touch where its center is not ahead: none of its points may be there.
            Shape::Rectangle { .. } => self.shield.around(),
        };
        let grown = self.shield.grown(person);
        let around = self.outline.outer_radius() + depth;
        let end = plan.end();
        let offset = (person.placed.center - plan.start().position).norm();
        let near = self.outline.outer_radius() + self.shield.around() + extent;
        if offset - near - grown - plan.way() - person.reach(end) > 0.0 {
            return true;
        }
        let rate = plan.rate(around) + person.rate(end);
        if rate == f64::INFINITY {
            // He can be anywhere at once.
            return false;
        }
        for part in plan.parts() {
            let ahead = |instant: usize, depth: f64| {
                let at = &part.instants[instant];
                let distance = |way: Vector2<f64>| {
                    let placed = PlacedShape {
                        center: person.placed.center + way,
                        ..person.placed
                    };
                    let (own, outline) = (placed.seen_from(&at.frame), &self.outline);
                    let rooms = part.motions.iter().map(|motion| match own.shape {
                        Shape::Disc { .. } => {
                            outline.distance_from_room_ahead(own.center, *motion, depth)
                        }
                        Shape::Rectangle { .. } => {
                            outline.rectangle_from_room_ahead(&own, *motion, depth)
                        }
                    });
                    rooms.fold(f64::INFINITY, f64::min)
                };
                person.beyond(at.time, distance)
            };
            let mut before = ahead(0, depth);
            if before.is_nan() || before <= 0.0 {
                return false;
            }
            for instant in 1..part.instants.len() {
                let after = ahead(instant, depth);
                let passed = part.instants[instant].time - part.instants[instant - 1].time;
                // The least that a function of this rate can be between two values.
                let least = 0.5 * (before + after - rate * passed);
                if least.is_nan() || least <= 0.0 {
                    return false;
                }
                before = after;
            }
            let last = part.instants.len() - 1;
            if part.ends && grown > 0.0 && ahead(last, depth + grown) <= 0.0 {
                return false;
            }
        }
        true
    }

    /// Distance in m that the outline keeps from walls.
    fn kept(&self) -> f64 {
        self.shield.wall_margin + self.shield.position_tracking
    }

    /// Distance of the outline at a pose from everything that stands, up to what it keeps, in m.
    pub(crate) fn wall_clearance(&self, pose: &Frame, walls: &StaticObstacles<'_>) -> f64 {
        walls.clearance_of(&self.outline, pose, self.kept())
    }

    /// Whether the outline keeps the margin from everything that stands, or its present distance where that is less.
    fn off_walls(&self, plan: &BodyPlan, walls: &StaticObstacles<'_>) -> bool {
        if walls.is_empty() {
            return true;
        }
        let kept = self.kept();
        let deviation = plan.deviation(self.outline.outer_radius());
        let present = walls.clearance_of(&self.outline, plan.start(), kept + deviation);
        if present <= 0.0 {
            // What touches already may be moved deeper by any motion.
            return false;
        }
        plan.sweeps().iter().all(|(pose, sweep, ramps)| {
            let most = if *ramps { kept + deviation } else { kept };
            let least = present.min(most) - ROUNDING;
            walls.sweep_keeps(&self.outline, pose, *sweep, least)
        })
    }

    /// Motions between which the robot moves when it is to have one: all others are sums of them.
    fn motions(&self, motion: &BodyMotion) -> Vec<BodyMotion> {
        let radius = self.outline.outer_radius();
        rays(motion, self.shield.velocity_tracking, self.wheels, radius)
    }
}
