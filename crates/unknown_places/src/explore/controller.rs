//! An explorer on a robot: odometry and scans come from outside, whenever they do, and twists go out.

use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;
use navigation_world::robots::differential::{Integration, Twist};
use navigation_world::sensing::scanner::Scanner;
use navigation_world::world::frame::Frame;
use numeric::error::{Failure, Given, Result, finite, finite_pair, not_negative, positive};

use super::{Decision, Explorer, ExplorerOptions, Robot, Status};
use crate::map::Scan;

/// Poses that are remembered.
const MOST_POSES: usize = 4096;
/// A robot that is farther than this from where its plan has it, in m, did not drive there: its pose jumped.
const JUMP: f64 = 0.05;

/// Bounds of scans and poses within which the robot drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trust {
    /// After so many seconds without a scan the robot stops.
    pub scan_timeout: f64,
    /// Scans that are older than this in s count for nothing.
    pub oldest_scan: f64,
    /// How far in m the robot may be from where its plan has it, until rest: plans keep so much more away.
    pub position_tracking: f64,
    /// How far in rad its heading may be.
    pub heading_tracking: f64,
}

impl Default for Trust {
    fn default() -> Self {
        Self {
            scan_timeout: 0.3,
            oldest_scan: 0.5,
            position_tracking: 0.01,
            heading_tracking: 0.03,
        }
    }
}

/// A scan that was made at an instant.
#[derive(Clone, Copy, Debug)]
pub struct TimedScan<'a> {
    /// Index of the lidar.
    pub lidar: usize,
    /// When it was made in s.
    pub time: f64,
    /// Heading in rad of what carries the lidar, where the robot has another one.
    pub heading: Option<f64>,
    /// Ranges in m.
    pub ranges: &'a [f64],
}

/// Why a robot brakes, or which scans count for nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Doubts {
    /// No lidar told anything for too long.
    pub blind: bool,
    /// The robot is not where its plan has it, by so many m and rad.
    pub off_plan: Option<[f64; 2]>,
    /// It is so far off that its pose must have jumped: all that was seen before was forgotten.
    pub forgotten: bool,
    /// The clock was set back, or stood: the update counted for nothing.
    pub clock: bool,
    /// Scans that were too old, or from an instant at which the pose of the robot is not known.
    pub ignored: usize,
    /// Beams that read nothing at all in the scans that counted.
    pub unknown_beams: usize,
}

/// Command until the next update.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// Twist at the end of the control period.
    pub twist: Twist,
    /// Fate of the commands.
    pub status: Status,
    /// Time to the goal in s, where there is a way.
    pub time_to_go: Option<f64>,
    /// Whether the robot drives without progress somewhere else.
    pub recovering: bool,
    /// Whether the goal is reached.
    pub arrived: bool,
    /// Age of the newest scan in s; infinite before the first one.
    pub scan_age: f64,
    /// Broken assumptions.
    pub doubts: Doubts,
    /// Times from now in s with the twists of the plan, between which they change evenly: what to do without another
    /// update.
    pub plan: Vec<(f64, Twist)>,
}

/// An explorer that is told poses and scans.
#[derive(Clone, Debug)]
pub struct Controller {
    robot: Robot,
    options: ExplorerOptions,
    trust: Trust,
    scanners: Vec<Scanner>,
    beams: Vec<Vec<Vector2<f64>>>,
    goal: [f64; 2],
    tolerance: f64,
    explorer: Explorer,
    /// Poses that were told with their instants in s, headings without jumps.
    poses: VecDeque<(f64, Vector2<f64>, f64)>,
    /// Pose at the last update of a robot that has kept to the plan since it was verified.
    planned: Option<Frame>,
    /// Pose at the last update of one that has kept to it since the last pose was told.
    reckoned: Option<Frame>,
    /// Time of the last update in s.
    updated: Option<f64>,
    newest: Vec<f64>,
    arrived: bool,
}

impl Controller {
    /// A robot at rest that knows nothing.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    pub fn new(
        robot: Robot,
        options: ExplorerOptions,
        trust: Trust,
        scanners: Vec<Scanner>,
        (goal, tolerance): ([f64; 2], f64),
    ) -> Result<Self> {
        positive("scan_timeout", trust.scan_timeout)?;
        positive("oldest_scan", trust.oldest_scan)?;
        not_negative("position_tracking", trust.position_tracking)?;
        not_negative("heading_tracking", trust.heading_tracking)?;
        positive("arrival_tolerance", tolerance)?;
        if scanners.is_empty() {
            return Err(Failure::invalid(
                "lidars",
                "have at least one",
                Given::Count(0),
            ));
        }
        for (index, scanner) in scanners.iter().enumerate() {
            let owner = format!("lidars[{index}]");
            scanner.checked().map_err(|error| error.within(&owner))?;
        }
        let unit = |bearing: &f64| Vector2::new(bearing.cos(), bearing.sin());
        let beams = scanners
            .iter()
            .map(|scanner| scanner.bearings.iter().map(unit).collect())
            .collect();
        let explorer = Explorer::new(&robot, with_margin(&robot, options, trust), goal)?;
        Ok(Self {
            newest: vec![f64::NEG_INFINITY; scanners.len()],
            robot,
            options,
            trust,
            scanners,
            beams,
            goal,
            tolerance,
            explorer,
            poses: VecDeque::new(),
            planned: None,
            reckoned: None,
            updated: None,
            arrived: false,
        })
    }

    /// The explorer.
    #[must_use]
    pub fn explorer(&self) -> &Explorer {
        &self.explorer
    }

    /// Told a pose and scans, decides what to do.
    ///
    /// # Errors
    /// A number is not finite, or a scan is none of its lidar; nothing of the update counts then.
    pub fn update(
        &mut self,
        time: f64,
        pose: Option<([f64; 2], f64)>,
        scans: &[TimedScan<'_>],
    ) -> Result<Order> {
        finite("time", time)?;
        if let Some((position, heading)) = pose {
            finite_pair("position", position)?;
            finite("heading", heading)?;
        }
        for (index, scan) in scans.iter().enumerate() {
            self.check(time, scan)
                .map_err(|error| error.within(&format!("scans[{index}]")))?;
        }
        let mut doubts = Doubts::default();
        if self.updated.is_some_and(|last| time <= last) {
            doubts.clock = true;
            // Which instants scans are from is not known any more: only the plan is left.
            self.start_again();
            return Ok(self.brake(time, doubts));
        }
        self.pass(time);
        let Some((position, heading)) = pose else {
            return Ok(self.brake(time, doubts));
        };
        self.place(time, position.into(), heading, &mut doubts);
        let robot = Frame::at(position, heading);
        for scan in scans {
            self.enter(time, scan, &robot, &mut doubts)?;
        }
        let age = time - self.newest.iter().copied().fold(f64::INFINITY, f64::min);
        doubts.blind = age > self.trust.scan_timeout;
        self.arrived |=
            (Vector2::from(position) - Vector2::from(self.goal)).norm() <= self.tolerance;
        if doubts.blind || doubts.off_plan.is_some() || self.arrived {
            return Ok(self.brake(time, doubts));
        }
        let decision = self.explorer.decide(&robot);
        if decision.status != Status::Braking {
            self.planned = Some(robot);
        }
        Ok(self.order(time, decision, doubts))
    }

    fn check(&self, now: f64, scan: &TimedScan<'_>) -> Result<()> {
        let Some(beams) = self.beams.get(scan.lidar) else {
            let rule = format!("be below {}, the number of lidars", self.beams.len());
            return Err(Failure::invalid(
                "lidar",
                rule,
                Given::Count(scan.lidar as u64),
            ));
        };
        finite("time", scan.time)?;
        if scan.time > now {
            let rule = "be no later than the update";
            return Err(Failure::invalid("time", rule, Given::Number(scan.time)));
        }
        let scanner = &self.scanners[scan.lidar];
        let checked = Scan {
            pose: Frame::at([0.0; 2], 0.0),
            beams,
            ranges: scan.ranges,
            range_min: scanner.range_min,
            range_max: scanner.range_max,
        };
        checked.checked().map(|_| ())
    }

    /// Forgets when and where the robot was.
    fn start_again(&mut self) {
        self.poses.clear();
        (self.planned, self.reckoned, self.updated) = (None, None, None);
        self.newest.fill(f64::NEG_INFINITY);
    }

    /// Moves the robot along its plan until a time in s.
    fn pass(&mut self, time: f64) {
        if let Some(last) = self.updated.replace(time) {
            let elapsed = time - last;
            self.planned = self.planned.map(|pose| self.driven(&pose, elapsed));
            self.reckoned = self.reckoned.map(|pose| self.driven(&pose, elapsed));
            self.explorer.advance(elapsed);
        }
    }

    /// Notes a pose, and whether the robot can have come there by its plan.
    fn place(&mut self, time: f64, position: Vector2<f64>, heading: f64, doubts: &mut Doubts) {
        let robot = Frame::at(position.into(), heading);
        let trust = self.trust;
        let [away, off] = apart(&self.planned.unwrap_or(robot), &robot);
        if away > trust.position_tracking || off > trust.heading_tracking {
            doubts.off_plan = Some([away, off]);
        }
        let [away, off] = apart(&self.reckoned.unwrap_or(robot), &robot);
        let far = JUMP.max(2.0 * trust.position_tracking);
        if away > far || off > JUMP.max(2.0 * trust.heading_tracking) {
            // Whatever was seen was seen from elsewhere.
            doubts.forgotten = true;
            self.explorer.forget();
            self.newest.fill(f64::NEG_INFINITY);
            self.poses.clear();
            self.planned = None;
        }
        // Who rests has come to the end of its plan, wherever that is.
        if self.planned.is_none() || self.explorer.twist() == Twist::default() {
            self.planned = Some(robot);
        }
        self.reckoned = Some(robot);
        let before = self.poses.back().map_or(heading, |(.., angle)| *angle);
        let turn = (heading - before + PI).rem_euclid(TAU) - PI;
        self.poses.push_back((time, position, before + turn));
        while self.poses.len() > 2
            && (self.poses.len() > MOST_POSES || self.poses[1].0 < time - self.trust.oldest_scan)
        {
            self.poses.pop_front();
        }
    }

    /// The pose that the plan leads to from one, after a time in s.
    fn driven(&self, from: &Frame, elapsed: f64) -> Frame {
        let mut pose = *from;
        let pieces = self.explorer.pieces();
        for pair in pieces.windows(2) {
            let ((start, first), (end, last)) = (pair[0], pair[1]);
            let until = end.min(elapsed);
            if until <= start {
                break;
            }
            let share = 0.5 * (until - start) / (end - start);
            let mean = Twist {
                speed: first.speed + share * (last.speed - first.speed),
                turn_rate: first.turn_rate + share * (last.turn_rate - first.turn_rate),
            };
            pose = mean.moved(&pose, until - start, Integration::Arc);
        }
        pose
    }

    fn enter(
        &mut self,
        now: f64,
        scan: &TimedScan<'_>,
        robot: &Frame,
        doubts: &mut Doubts,
    ) -> Result<()> {
        let fresh =
            scan.time > self.newest[scan.lidar] && now - scan.time <= self.trust.oldest_scan;
        let Some(pose) = self.pose_at(scan.time).filter(|_| fresh) else {
            doubts.ignored += 1;
            return Ok(());
        };
        let unknown = scan.ranges.iter().filter(|range| range.is_nan()).count();
        doubts.unknown_beams += unknown;
        if unknown == scan.ranges.len() {
            // Who reads nothing at all sees nothing.
            return Ok(());
        }
        let scanner = &self.scanners[scan.lidar];
        let carrier = scan
            .heading
            .map_or(pose, |heading| Frame::at(pose.position.into(), heading));
        let entered = Scan {
            pose: carrier.carrying(&scanner.mounting),
            beams: &self.beams[scan.lidar],
            ranges: scan.ranges,
            range_min: scanner.range_min,
            range_max: scanner.range_max,
        };
        self.explorer.see(robot, entered)?;
        self.newest[scan.lidar] = scan.time;
        Ok(())
    }

    /// The pose at an instant between two that were told.
    fn pose_at(&self, time: f64) -> Option<Frame> {
        let after = self.poses.partition_point(|(at, ..)| *at < time);
        let (end, place, angle) = *self.poses.get(after)?;
        if end == time {
            return Some(Frame::at(place.into(), angle));
        }
        let (start, from, heading) = *self.poses.get(after.checked_sub(1)?)?;
        let share = (time - start) / (end - start);
        Some(Frame::at(
            (from + (place - from) * share).into(),
            heading + (angle - heading) * share,
        ))
    }

    fn brake(&mut self, time: f64, doubts: Doubts) -> Order {
        let decision = self.explorer.brake();
        self.order(time, decision, doubts)
    }

    fn order(&self, time: f64, decision: Decision, doubts: Doubts) -> Order {
        Order {
            twist: decision.twist,
            status: decision.status,
            time_to_go: decision.time_to_go,
            recovering: decision.recovering,
            arrived: self.arrived,
            scan_age: time - self.newest.iter().copied().fold(f64::INFINITY, f64::min),
            doubts,
            plan: self.explorer.pieces(),
        }
    }

    /// Forgets everything, with another goal.
    ///
    /// # Errors
    /// The goal is not finite.
    pub fn restart(&mut self, goal: [f64; 2]) -> Result<()> {
        self.explorer = Explorer::new(
            &self.robot,
            with_margin(&self.robot, self.options, self.trust),
            goal,
        )?;
        self.goal = goal;
        self.start_again();
        self.arrived = false;
        Ok(())
    }
}

/// Wherever the robot may be off its plan, it keeps so much more away; a heading that is off moves its corners.
fn with_margin(robot: &Robot, options: ExplorerOptions, trust: Trust) -> ExplorerOptions {
    let corners = trust.heading_tracking * robot.footprint.outer_radius();
    ExplorerOptions {
        margin: options.margin + trust.position_tracking + corners,
        ..options
    }
}

/// Distance in m and angle in rad between two poses.
fn apart(one: &Frame, other: &Frame) -> [f64; 2] {
    let turn = (one.angle() - other.angle() + PI).rem_euclid(TAU) - PI;
    [(other.position - one.position).norm(), turn.abs()]
}
