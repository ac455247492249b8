//! A robot that knows a place from the scans of its lidars alone, as a law.

use crate::shield::{Deviation, Status};
use crate::trace::Trace;
use crate::{Command, Law, LawFamily, Situation, force_toward};
use navigation_world::robots::differential::Twist;
use navigation_world::robots::drives::velocity_of;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Vector2;
use unknown_places::explore::{
    self, Controller, Explorer, ExplorerOptions, Robot, TimedScan, Trust,
};
use unknown_places::guide::GuideOptions;

/// Share of the arrival tolerance within which the robot takes itself to be at the goal: its odometry may be wrong.
const AT_GOAL: f64 = 0.25;

/// Map, guide, rollouts and verified plans of a robot in a place that it has never seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcRollouts(pub ExplorerOptions);

impl ArcRollouts {
    fn tuned(&self, numbers: &[f64]) -> Result<ExplorerOptions> {
        let mut options = self.0;
        let GuideOptions {
            clearance,
            narrow_weight,
            near_weight,
            near_distance,
            unknown_weight,
            beyond,
        } = &mut options.guide;
        let places = [
            &mut options.margin,
            clearance,
            narrow_weight,
            near_weight,
            near_distance,
            unknown_weight,
            beyond,
        ];
        for (place, number) in places.into_iter().zip(numbers) {
            *place = *number;
        }
        options.checked()
    }
}

impl LawFamily for ArcRollouts {
    fn gain_names(&self) -> &'static [&'static str] {
        &[
            "margin",
            "clearance",
            "narrow_weight",
            "near_weight",
            "near_distance",
            "unknown_weight",
            "beyond",
        ]
    }

    fn gains(&self) -> Vec<f64> {
        let guide = self.0.guide;
        vec![
            self.0.margin,
            guide.clearance,
            guide.narrow_weight,
            guide.near_weight,
            guide.near_distance,
            guide.unknown_weight,
            guide.beyond,
        ]
    }

    fn free_gains(&self) -> &'static [usize] {
        &[0, 1, 2, 3, 4, 5, 6]
    }

    fn chooses_velocities(&self) -> bool {
        true
    }

    fn steers_by_velocity(&self) -> bool {
        true
    }

    fn maps_its_scans(&self) -> bool {
        true
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        self.tuned(gains).map(|_| ())
    }

    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        _record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        if scenario.lidars.is_empty() {
            let rule = "hold a Lidar for ArcRollouts, which know a place from scans alone";
            return Err(
                Failure::invalid("sensors", rule, Given::Found("no lidar".into()))
                    .mended_by(
                        "run it on AsBuilt(sensors=[Lidar(map=...)]), or on a robot of your own by ScanController",
                    ),
            );
        }
        let options = ExplorerOptions {
            seed: self.0.seed ^ scenario.seed,
            ..self.tuned(gains)?
        };
        let (rules, outline) = (&scenario.rules, scenario.footprint.as_deref());
        let period = rules.control_period;
        let robot = match (&scenario.differential, outline) {
            (Some(wheels), _) => Robot::of(wheels, outline, period)?,
            (None, None) => Robot::on_course(&scenario.robot, period)?,
            (None, Some(_)) => {
                let rule = "be a disc or have two wheels under ArcRollouts, which turn the outline along the way";
                let given = Given::Found("a HolonomicRobot with a footprint".into());
                return Err(Failure::invalid("robot", rule, given).mended_by(
                    "give a DifferentialDriveRobot, or a radius in place of the footprint",
                ));
            }
        };
        let to_goal = Vector2::from(scenario.goal) - Vector2::from(scenario.start);
        let course = scenario.differential.is_none().then(|| DrivenDirection {
            heading: to_goal.y.atan2(to_goal.x),
            turn_rate: 0.0,
        });
        let scanners = scenario.lidars.to_vec();
        let goal = (scenario.goal, AT_GOAL * rules.arrival_tolerance);
        Ok(Box::new(Exploring {
            controller: Controller::new(robot, options, Trust::default(), scanners, goal)?,
            mass: scenario.robot.mass,
            course,
            twist: None,
            trace: None,
        }))
    }
}

/// Direction in which a disc drives that moves in any direction, and how it turns.
#[derive(Clone, Copy, Debug)]
struct DrivenDirection {
    /// In rad.
    heading: f64,
    /// In rad/s.
    turn_rate: f64,
}

/// The law at work on one robot.
struct Exploring {
    controller: Controller,
    mass: f64,
    /// Where a robot without wheels drives, whatever it looks at.
    course: Option<DrivenDirection>,
    twist: Option<Twist>,
    trace: Option<Trace>,
}

impl Law<f64> for Exploring {
    fn thinks(&self) -> bool {
        true
    }

    fn command(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        let scans = situation.scan.lidars.scans().enumerate();
        let told: Vec<TimedScan<'_>> = scans
            .filter(|(_, scan)| !scan.ranges.is_empty())
            .map(|(lidar, scan)| TimedScan {
                lidar,
                time: scan.time,
                heading: self.course.map(|_| situation.heading),
                ranges: scan.ranges,
            })
            .collect();
        let (robot, interval) = (situation.robot, situation.interval);
        let heading = self
            .course
            .map_or(situation.heading, |course| course.heading);
        let pose = (robot.position.into(), heading);
        let Ok(order) = self.controller.update(situation.time, Some(pose), &told) else {
            // Poses and ranges that are not finite.
            return Command::plain(Vector2::new(f64::NAN, f64::NAN));
        };
        let command = if let Some(course) = &mut self.course {
            // The turn rate becomes the commanded one evenly.
            course.heading += 0.5 * (course.turn_rate + order.twist.turn_rate) * interval;
            course.turn_rate = order.twist.turn_rate;
            let (sin, cos) = course.heading.sin_cos();
            Vector2::new(cos, sin) * order.twist.speed
        } else {
            self.twist = Some(order.twist);
            velocity_of(order.twist, heading, interval)
        };
        self.trace = Some(Trace {
            wanted: command,
            command,
            taken_over: order.recovering,
            status: match order.status {
                explore::Status::Kept => Status::Kept,
                explore::Status::Changed => Status::Changed,
                explore::Status::Braking => Status::Braking,
            },
            course: None,
            off_plan: order.doubts.off_plan.map(|[position, _]| Deviation {
                position,
                velocity: 0.0,
            }),
            shield: None,
        });
        Command::plain(force_toward(command, situation, self.mass))
    }

    fn can_aim(&self) -> bool {
        false
    }

    fn twist(&self) -> Option<Twist> {
        self.twist
    }

    fn explored(&self) -> Option<&Explorer> {
        Some(self.controller.explorer())
    }

    fn trace(&self) -> Option<Trace> {
        self.trace
    }
}
