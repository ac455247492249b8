//! Closed loop of a robot in a place that it does not know: what is there, what it measures, and whether it touches.

use nalgebra::Vector2;
use navigation_world::robots::differential::{Integration, Twist};
use navigation_world::sensing::lidar::{Lidar, ScanNoise};
use navigation_world::world::footprint::{Arc, Footprint};
use navigation_world::world::frame::Frame;
use navigation_world::world::map::StaticMap;
use numeric::error::{
    Failure, Given, Result, at_most, finite, finite_pair, not_negative, positive,
};
use numeric::random::Stream;

use crate::explore::{Decision, Explorer, ExplorerOptions, Robot, Status};
use crate::map::Scan;

/// Samples of a control period at which contact and arrival are looked for: every 2.5 ms of 50 ms.
const SAMPLES: usize = 20;
/// An episode is timed from where the robot leaves this distance from its start, in m.
const LEFT: f64 = 0.1;
/// Most control periods of an episode.
const MOST_PERIODS: f64 = 1e6;
/// Streams of noise, and of the signs of the drift.
const NOISE: u64 = 1;
const DRIFT: u64 = 2;

/// An episode.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The robot.
    pub robot: Robot,
    /// Options of map, guide and rollouts.
    pub options: ExplorerOptions,
    /// Map of the place.
    pub place: StaticMap,
    /// Where it starts in m and rad, at rest.
    pub start: [f64; 2],
    /// In rad.
    pub heading: f64,
    /// In m.
    pub goal: [f64; 2],
    /// Distance of the goal at which it has arrived in m.
    pub tolerance: f64,
    /// Longest episode in s.
    pub time_limit: f64,
    /// Its lidar, whatever map it has.
    pub lidar: Lidar,
    /// Share by which lengths of the odometry are wrong.
    pub length_drift: f64,
    /// Angle by which its heading is wrong in rad/m.
    pub heading_drift: f64,
    /// Control periods by which scans are late.
    pub late: usize,
    /// Seed of noise, drift and recoveries.
    pub seed: u64,
}

/// How an episode ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// At the goal.
    Arrived,
    /// In contact.
    Collided,
    /// After the longest time.
    TimedOut,
}

/// Outcome of an episode.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// End of the episode.
    pub ended: Ended,
    /// Time from leaving the circle around the start to the end in s.
    pub time: f64,
    /// When it ended in s.
    pub end_time: f64,
    /// Least distance of the outline from what is there in m.
    pub clearance: f64,
    /// Length driven in m.
    pub path: f64,
    /// How often the robot made no progress.
    pub recoveries: u64,
    /// Control periods in which nothing was verified.
    pub braking: usize,
    /// True poses at the starts of control periods: x, y in m and heading in rad.
    pub poses: Vec<[f64; 3]>,
}

/// An instant of an episode that is watched.
#[derive(Clone, Copy, Debug)]
pub enum Moment<'a> {
    /// A scan was made, and nothing done with it.
    Scanned,
    /// The robot has decided.
    Decided {
        /// Explorer at the instant.
        explorer: &'a Explorer,
        /// Decision of the explorer.
        decision: &'a Decision,
        /// Where it takes itself to be.
        pose: &'a Frame,
    },
}

/// Where the robot takes itself to be, beside where it is.
struct Odometry {
    pose: Frame,
    angle: f64,
    length: f64,
    turn: f64,
}

impl Odometry {
    /// Goes on by a piece of an arc, whose length and turn are measured wrongly.
    fn measure(&mut self, distance: f64, angle: f64) {
        let wrong = angle + self.turn * distance.abs();
        let twist = Twist {
            speed: distance * self.length,
            turn_rate: wrong,
        };
        let moved = twist.moved(&self.pose, 1.0, Integration::Arc);
        self.angle += wrong;
        self.pose = Frame::at(moved.position.into(), self.angle);
    }
}

/// Where the robot is, and where it takes itself to be.
struct Truth {
    pose: Frame,
    angle: f64,
    path: f64,
    odometry: Odometry,
}

impl Truth {
    /// Drives through a sample of a period in which one twist becomes another.
    fn drive(&mut self, from: Twist, to: Twist, sample: usize, period: f64) {
        let share = (sample as f64 + 0.5) / SAMPLES as f64;
        let duration = period / SAMPLES as f64;
        let now = Twist {
            speed: from.speed + share * (to.speed - from.speed),
            turn_rate: from.turn_rate + share * (to.turn_rate - from.turn_rate),
        };
        let moved = now.moved(&self.pose, duration, Integration::Arc);
        self.angle += now.turn_rate * duration;
        self.pose = Frame::at(moved.position.into(), self.angle);
        self.path += now.speed.abs() * duration;
        self.odometry
            .measure(now.speed * duration, now.turn_rate * duration);
    }
}

impl Trial {
    /// Returns the episode if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(&self) -> Result<()> {
        finite_pair("start", self.start)?;
        finite_pair("goal", self.goal)?;
        finite("heading", self.heading)?;
        positive("arrival_tolerance", self.tolerance)?;
        positive("time_limit", self.time_limit)?;
        not_negative("length_drift", self.length_drift)?;
        not_negative("heading_drift", self.heading_drift)?;
        at_most("late", self.late, 100)?;
        if self.time_limit / self.robot.period > MOST_PERIODS {
            let rule = format!("be at most {MOST_PERIODS} control periods");
            return Err(Failure::invalid(
                "time_limit",
                rule,
                Given::Number(self.time_limit),
            ));
        }
        if self.distance(&Frame::at(self.start, self.heading), f64::INFINITY) <= 0.0 {
            return Err(Failure::invalid(
                "start",
                "be apart from what is there",
                Given::Pair(self.start),
            ));
        }
        Ok(())
    }

    /// Distance of the outline at a pose from what is there in m, up to a largest one.
    fn distance(&self, pose: &Frame, most: f64) -> f64 {
        let footprint = &self.robot.footprint;
        let outer = footprint.outer_radius();
        let mut least = most;
        for capsule in self.place.capsules() {
            if capsule.distance(pose.position) < outer + least {
                least =
                    least.min(apart(footprint, pose, capsule.from, capsule.to) - capsule.radius);
            }
        }
        least
    }

    /// Runs the episode; `watch` is told of its instants.
    ///
    /// # Errors
    /// A number is not allowed.
    pub fn run(&self, watch: &mut dyn FnMut(Moment<'_>)) -> Result<Outcome> {
        self.checked()?;
        let lidar = Lidar {
            map: self.place.clone(),
            ..self.lidar.clone()
        }
        .checked()
        .map_err(|error| error.within("lidar"))?;
        let mut explorer = Explorer::new(&self.robot, self.options, self.goal)?;
        let beams: Vec<Vector2<f64>> = (0..lidar.beams)
            .map(|beam| {
                let (sin, cos) = lidar.bearing(beam).sin_cos();
                Vector2::new(cos, sin)
            })
            .collect();
        let mut noise = ScanNoise::new(self.seed, NOISE);
        let mut signs = Stream::new(self.seed, DRIFT);
        let mut sign = || if signs.bits() & 1 == 0 { 1.0 } else { -1.0 };
        let odometry = Odometry {
            pose: Frame::at(self.start, self.heading),
            angle: self.heading,
            length: 1.0 + self.length_drift * sign(),
            turn: self.heading_drift * sign(),
        };
        let mut truth = Truth {
            pose: odometry.pose,
            angle: self.heading,
            path: 0.0,
            odometry,
        };
        let mut twist = Twist::default();
        let mut scans: std::collections::VecDeque<(Frame, Vec<f64>)> =
            std::collections::VecDeque::new();
        let mut outcome = Outcome {
            ended: Ended::TimedOut,
            time: f64::NAN,
            end_time: 0.0,
            clearance: self.distance(&truth.pose, f64::INFINITY),
            path: 0.0,
            recoveries: 0,
            braking: 0,
            poses: Vec::new(),
        };
        let (period, goal, start) = (
            self.robot.period,
            Vector2::from(self.goal),
            Vector2::from(self.start),
        );
        let mut left = None;
        let periods = (self.time_limit / period).round() as usize;
        'episode: for at in 0..periods {
            outcome
                .poses
                .push([truth.pose.position.x, truth.pose.position.y, truth.angle]);
            let mut ranges = Vec::with_capacity(lidar.beams);
            lidar.scan(&truth.pose, &[], &mut noise, &mut ranges);
            scans.push_back((truth.odometry.pose, ranges));
            watch(Moment::Scanned);
            if scans.len() > self.late
                && let Some((pose, ranges)) = scans.pop_front()
            {
                let scan = Scan {
                    pose: pose.carrying(&lidar.mounting),
                    beams: &beams,
                    ranges: &ranges,
                    range_min: lidar.range_min,
                    range_max: lidar.range_max,
                };
                explorer.see(&truth.odometry.pose, scan)?;
            }
            let decision = explorer.decide(&truth.odometry.pose);
            watch(Moment::Decided {
                explorer: &explorer,
                decision: &decision,
                pose: &truth.odometry.pose,
            });
            outcome.braking += usize::from(decision.status == Status::Braking);
            let wanted = decision.twist;
            for sample in 0..SAMPLES {
                truth.drive(twist, wanted, sample, period);
                outcome.end_time = (at as f64 + (sample + 1) as f64 / SAMPLES as f64) * period;
                if left.is_none() && (truth.pose.position - start).norm() > LEFT {
                    left = Some(outcome.end_time);
                }
                outcome.clearance = self.distance(&truth.pose, outcome.clearance);
                if outcome.clearance <= 0.0 {
                    outcome.ended = Ended::Collided;
                    break 'episode;
                }
                if (truth.pose.position - goal).norm() <= self.tolerance {
                    outcome.ended = Ended::Arrived;
                    break 'episode;
                }
            }
            twist = wanted;
        }
        outcome.path = truth.path;
        outcome.recoveries = explorer.recoveries();
        outcome.time = outcome.end_time - left.unwrap_or(0.0);
        Ok(outcome)
    }
}

/// Distance of a segment from the outline at a pose in m.
fn apart(footprint: &Footprint, pose: &Frame, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    let seen = |place: Vector2<f64>| pose.inward(place - pose.position);
    if from == to {
        return footprint.signed_distance(seen(from));
    }
    footprint.swept_segment(
        [seen(from), seen(to)],
        Arc {
            distance: 0.0,
            angle: 0.0,
        },
    )
}
