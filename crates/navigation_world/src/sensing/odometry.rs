//! Odometry that drifts: a robot that reckons where it is from the way of its wheels.

use crate::arguments::{Arguments, Named};
use crate::robots::differential::Pose;
use crate::sensing::sensor::{Located, RobotSensor, Sensor, Truth};
use crate::world::frame::Frame;
use crate::world::geometry::RobotState;
use crate::world::obstacle::Regions;
use crate::world::scenario::Scenario;
use nalgebra::Vector2;
use numeric::error::{Result, not_negative};
use numeric::random::Stream;
use std::f64::consts::{PI, TAU};

/// Streams of the signs of drift, counted up from here.
const DRIFT_STREAM: u64 = (1 << 60) + (1 << 59);

/// Errors of an odometry, whose signs are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Odometry {
    /// Share by which lengths are wrong.
    pub length_error: f64,
    /// Angle by which the heading goes wrong in rad/m.
    pub heading_error: f64,
}

impl Named for Odometry {
    const NAME: &'static str = "odometry";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let number = |name: &str| not_negative(name, given.number(name)?);
        Ok(Self {
            length_error: number("length_error")?,
            heading_error: number("heading_error")?,
        })
    }
}

impl RobotSensor for Odometry {
    fn at_work(&self, scenario: &Scenario, index: u64) -> Result<Box<dyn Sensor>> {
        let mut signs = Stream::new(scenario.seed, DRIFT_STREAM + index);
        let mut sign = || if signs.bits() & 1 == 0 { 1.0 } else { -1.0 };
        Ok(Box::new(Reckoning {
            scale: 1.0 + self.length_error * sign(),
            turn: self.heading_error * sign(),
            poses: None,
        }))
    }

    fn sight(&self, _scenario: &Scenario) -> Result<Option<(Regions, f64)>> {
        Ok(None)
    }
}

/// An odometry at work.
struct Reckoning {
    scale: f64,
    turn: f64,
    /// Last pose of the robot, and the one that it took itself to have; headings do not jump at a whole turn.
    poses: Option<[Pose; 2]>,
}

impl Reckoning {
    /// Follows the robot to its present pose; returns that and the one that it takes itself to have.
    fn follow(&mut self, truth: &Truth<'_>) -> [Pose; 2] {
        let frame = truth.frame();
        let now = Pose {
            position: frame.position.into(),
            heading: frame.angle(),
        };
        let [before, known] = self.poses.unwrap_or([now; 2]);
        let turned = (now.heading - before.heading + PI).rem_euclid(TAU) - PI;
        let way = frame.position - Vector2::from(before.position);
        // In the frame of the mean heading the way along an arc is its chord.
        let seen = Frame::at([0.0; 2], before.heading + 0.5 * turned).inward(way) * self.scale;
        let wrong = turned + self.turn * way.norm();
        let mean = Frame::at([0.0; 2], known.heading + 0.5 * wrong);
        let known = Pose {
            position: (Vector2::from(known.position) + mean.outward(seen)).into(),
            heading: known.heading + wrong,
        };
        self.poses = Some([now, known]);
        [now, known]
    }
}

impl Sensor for Reckoning {
    fn watch(&mut self, truth: &Truth<'_>) {
        self.follow(truth);
    }

    fn locate(&mut self, truth: &Truth<'_>) -> Option<Located> {
        let [now, known] = self.follow(truth);
        let [own, taken] = [now, known].map(|pose| Frame::at([0.0; 2], pose.heading));
        let velocity: Vector2<f64> = taken.outward(own.inward(truth.robot.velocity)) * self.scale;
        Some(Located {
            robot: RobotState {
                position: known.position.into(),
                velocity,
            },
            heading: Some(known.heading),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::lanes::Vector2;

    /// Poses along a circle of radius 2 m, counterclockwise from the origin.
    fn on_circle(angle: f64) -> Truth<'static> {
        let (sin, cos) = angle.sin_cos();
        let robot = RobotState {
            position: Vector2::new(2.0 * sin, 2.0 * (1.0 - cos)),
            velocity: Vector2::new(cos, sin),
        };
        Truth::among(angle, robot, angle, &[])
    }

    #[test]
    fn exact_odometry_follows_a_robot_over_whole_turns_and_a_wrong_one_a_larger_circle() {
        for (scale, turn) in [(1.0, 0.0), (1.01, 0.0), (1.0, 0.002)] {
            let mut odometry = Reckoning {
                scale,
                turn,
                poses: None,
            };
            let mut found = None;
            for step in 0..=1000 {
                let truth = on_circle(f64::from(step) * 0.01);
                odometry.watch(&truth);
                found = odometry.locate(&truth);
            }
            let found = found.unwrap();
            // A turn of 10 rad on a circle of 2 m is a way of 20 m.
            let angle = 10.0 + 20.0 * turn;
            assert!((found.heading.unwrap() - angle).abs() < 2e-6, "{turn}");
            let radius = 2.0 * scale * 10.0 / angle;
            let (sin, cos) = angle.sin_cos();
            let place = Vector2::new(radius * sin, radius * (1.0 - cos));
            assert!(
                (found.robot.position - place).norm() < 1e-4,
                "{scale} {turn}"
            );
            let velocity = Vector2::new(cos, sin) * scale;
            assert!((found.robot.velocity - velocity).norm() < 1e-5);
        }
    }
}
