//! Runs of a robot with ideal wheels that follows a reference.

use super::drive::{DifferentialDrive, DifferentialLimits, Pose, Twist};
use super::reference::{Reference, ReferencePath};
use super::tracker::{Tracker, Tracking};
use numeric::error::{Failure, Given, Interrupted, Result, finite_pair, positive};
use numeric::threads::{map, on_threads};

/// Largest number of motion steps of one run.
const MAX_STEPS: f64 = 1e8;

/// Largest deviation of a period or a duration from a whole number of its parts, relative.
const WHOLE: f64 = 1e-9;

/// Control periods between two looks whether to stop.
const LOOK: usize = 4096;

/// Rows that a history has memory for at once, at most.
const RESERVED: usize = 1 << 16;

/// Pose and motion at the start of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackStart {
    /// Where the robot is.
    pub pose: Pose,
    /// Linear velocity and turn rate.
    pub twist: Twist,
}

/// How a run goes.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackOptions {
    /// Time between two commands in s.
    pub period: f64,
    /// Motion step in s; divides the period.
    pub step: f64,
    /// Duration in s; a whole number of periods.
    pub duration: f64,
    /// Goal in m; without one there is no goal phase.
    pub goal: Option<[f64; 2]>,
}

impl TrackOptions {
    /// Periods of a run and steps of a period.
    fn counts(&self) -> Result<(usize, usize)> {
        let period = positive("control_period", self.period)?;
        let step = positive("step", self.step)?;
        let duration = positive("duration", self.duration)?;
        if let Some(goal) = self.goal {
            finite_pair("goal", goal)?;
        }
        let rule = "divide the control period";
        let steps = whole(period / step, "step", rule, step)?;
        let rule = "be a whole number of control periods";
        let periods = whole(duration / period, "duration", rule, duration)?;
        if duration / step > MAX_STEPS {
            let rule = "be at most 1e8 motion steps";
            let given = Given::Number(duration);
            return Err(Failure::invalid("duration", rule, given));
        }
        Ok((periods, steps))
    }
}

/// A ratio that is a whole number of at least 1, as a count.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a float saturates
fn whole(ratio: f64, name: &str, rule: &'static str, value: f64) -> Result<usize> {
    let count = ratio.round();
    if count < 1.0 || (count - ratio).abs() > WHOLE * ratio {
        return Err(Failure::invalid(name, rule, Given::Number(value)));
    }
    Ok(count as usize)
}

/// History of a run: one row at the start and one for each motion step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrackRun {
    /// Instants in s.
    pub time: Vec<f64>,
    /// Positions in m, x and y in turn.
    pub position: Vec<f64>,
    /// Headings in rad; count whole turns.
    pub heading: Vec<f64>,
    /// Speeds in m/s.
    pub speed: Vec<f64>,
    /// Turn rates in rad/s.
    pub turn_rate: Vec<f64>,
    /// Speeds as commanded, from this row to the next, in m/s.
    pub commanded_speed: Vec<f64>,
    /// Turn rates as commanded, in rad/s.
    pub commanded_turn_rate: Vec<f64>,
    /// Positions of the reference in m, x and y in turn.
    pub reference_position: Vec<f64>,
    /// Velocities of the reference in m/s, x and y in turn.
    pub reference_velocity: Vec<f64>,
    /// Whether the command came from the goal phase.
    pub goal_phase: Vec<bool>,
}

impl TrackRun {
    /// An empty history with memory for a number of rows; a long one takes more as it fills.
    fn of_rows(rows: usize) -> Self {
        let rows = rows.min(RESERVED);
        let one = || Vec::with_capacity(rows);
        let two = || Vec::with_capacity(2 * rows);
        Self {
            time: one(),
            position: two(),
            heading: one(),
            speed: one(),
            turn_rate: one(),
            commanded_speed: one(),
            commanded_turn_rate: one(),
            reference_position: two(),
            reference_velocity: two(),
            goal_phase: Vec::with_capacity(rows),
        }
    }
}

/// Row of a batch. The error is the distance from the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackRow {
    /// Error at the end in m.
    pub final_error: f64,
    /// Largest error in m.
    pub max_error: f64,
    /// Heading at the end in rad; counts whole turns.
    pub final_heading: f64,
    /// Length of the path in m.
    pub path_length: f64,
    /// First recorded instants from which the error stays below each level, in s; NaN if it is
    /// not below at the end.
    pub settling_time: Vec<f64>,
}

/// One instant of a run.
struct Instant<'a> {
    index: usize,
    time: f64,
    drive: &'a DifferentialDrive,
    reference: Reference,
    wish: Twist,
    goal_phase: bool,
}

impl Instant<'_> {
    /// Robot to reference in m.
    fn offset(&self) -> [f64; 2] {
        let [x, y] = self.drive.pose.position;
        [
            self.reference.position[0] - x,
            self.reference.position[1] - y,
        ]
    }

    fn error(&self) -> f64 {
        let [x, y] = self.offset();
        x.hypot(y)
    }

    fn is_finite(&self) -> bool {
        let [x, y] = self.offset();
        (x.abs() + y.abs()).is_finite()
    }
}

/// Reference, tracker and robot of a run.
struct TrackedCourse<'a> {
    tracking: &'a Tracking,
    limits: &'a DifferentialLimits,
    options: &'a TrackOptions,
    periods: usize,
    steps: usize,
    interrupted: Interrupted<'a>,
}

impl<'a> TrackedCourse<'a> {
    fn new(
        (tracking, limits): (&'a Tracking, &'a DifferentialLimits),
        options: &'a TrackOptions,
        interrupted: Interrupted<'a>,
    ) -> Result<Self> {
        tracking.checked()?;
        limits.checked()?;
        let (periods, steps) = options.counts()?;
        Ok(Self {
            tracking,
            limits,
            options,
            periods,
            steps,
            interrupted,
        })
    }

    /// Drives the whole run and shows every instant; the last command is that of the period that
    /// would follow.
    fn drive(
        &self,
        path: &ReferencePath,
        start: &TrackStart,
        mut show: impl FnMut(&Instant<'_>),
    ) -> Result<()> {
        let mut drive = DifferentialDrive::new(self.limits, start.pose, start.twist);
        let mut tracker = Tracker::new(self.tracking, self.limits, self.options.period);
        tracker.permit_goal_phase(self.options.goal.is_some());
        let goal = self.options.goal.unwrap_or_default();
        let mut cursor = 0;
        let mut wish = Twist::default();
        for index in 0..=self.periods * self.steps {
            let time = index as f64 * self.options.step;
            let reference = path.at(time, &mut cursor);
            if index.is_multiple_of(self.steps) {
                if (index / self.steps).is_multiple_of(LOOK) && (self.interrupted)() {
                    return Err(Failure::Interrupted);
                }
                wish = tracker.command(&drive.pose, &reference, goal);
            }
            let instant = Instant {
                index,
                time,
                drive: &drive,
                reference,
                wish,
                goal_phase: tracker.in_goal_phase(),
            };
            if !instant.is_finite() {
                return Err(Failure::non_finite(0, time));
            }
            show(&instant);
            drive.step(wish, self.options.step);
        }
        Ok(())
    }

    fn record(&self, path: &ReferencePath, start: &TrackStart) -> Result<TrackRun> {
        let mut run = TrackRun::of_rows(self.periods * self.steps + 1);
        self.drive(path, start, |instant| {
            let drive = instant.drive;
            run.time.push(instant.time);
            run.position.extend(drive.pose.position);
            run.heading.push(drive.pose.heading);
            run.speed.push(drive.twist.speed);
            run.turn_rate.push(drive.twist.turn_rate);
            run.commanded_speed.push(instant.wish.speed);
            run.commanded_turn_rate.push(instant.wish.turn_rate);
            run.reference_position.extend(instant.reference.position);
            run.reference_velocity.extend(instant.reference.velocity);
            run.goal_phase.push(instant.goal_phase);
        })?;
        Ok(run)
    }

    fn summarize(
        &self,
        path: &ReferencePath,
        start: &TrackStart,
        levels: &[f64],
    ) -> Result<TrackRow> {
        let mut row = TrackRow {
            final_error: 0.0,
            max_error: 0.0,
            final_heading: 0.0,
            path_length: 0.0,
            settling_time: vec![0.0; levels.len()],
        };
        let last = self.periods * self.steps;
        self.drive(path, start, |instant| {
            let error = instant.error();
            row.max_error = row.max_error.max(error);
            for (level, settled) in levels.iter().zip(&mut row.settling_time) {
                if error >= *level {
                    // Not before the next instant, if there is one.
                    *settled = if instant.index < last {
                        (instant.index + 1) as f64 * self.options.step
                    } else {
                        f64::NAN
                    };
                }
            }
            if instant.index > 0 {
                row.path_length += instant.drive.twist.speed.abs() * self.options.step;
            }
            row.final_error = error;
            row.final_heading = instant.drive.pose.heading;
        })?;
        Ok(row)
    }
}

/// Follows a path from one start and records the run.
///
/// # Errors
/// An argument is out of range, the motion became non-finite or the caller asked to stop.
pub fn track(
    path: &ReferencePath,
    (tracking, limits): (&Tracking, &DifferentialLimits),
    start: &TrackStart,
    options: &TrackOptions,
    interrupted: Interrupted<'_>,
) -> Result<TrackRun> {
    let course = TrackedCourse::new((tracking, limits), options, interrupted)?;
    start.pose.checked()?;
    start.twist.checked()?;
    course.record(path, start)
}

/// Follows one path, or one for each start, from many starts over all cores; rows in the order
/// of the starts, with the instants from which the error stays below each of some levels in m.
///
/// # Errors
/// An argument is out of range, a motion became non-finite or the caller asked to stop.
pub fn track_batch(
    paths: &[ReferencePath],
    (tracking, limits): (&Tracking, &DifferentialLimits),
    (starts, levels): (&[TrackStart], &[f64]),
    (options, threads): (&TrackOptions, Option<usize>),
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Vec<TrackRow>> {
    let course = TrackedCourse::new((tracking, limits), options, interrupted)?;
    if paths.len() != 1 && paths.len() != starts.len() {
        let given = Given::Count(paths.len() as u64);
        let rule = "be one, or one for each start";
        return Err(Failure::invalid("reference", rule, given));
    }
    for (index, start) in starts.iter().enumerate() {
        let owner = format!("starts[{index}]");
        let within = |error: Failure| error.within(&owner);
        start.pose.checked().map_err(within)?;
        start.twist.checked().map_err(within)?;
    }
    for (index, level) in levels.iter().enumerate() {
        positive(&format!("levels[{index}]"), *level)?;
    }
    on_threads(threads, || {
        let rows: Vec<Result<TrackRow>> = map(starts.len(), |index| {
            if interrupted() {
                return Err(Failure::Interrupted);
            }
            let path = &paths[if paths.len() == 1 { 0 } else { index }];
            let row = course
                .summarize(path, &starts[index], levels)
                .map_err(|error| error.of_run(|_| index))?;
            progress(1);
            Ok(row)
        });
        // The first error by the order of the starts, whichever came first in time.
        rows.into_iter().collect()
    })
}
