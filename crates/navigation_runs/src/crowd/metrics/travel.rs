//! The way of the robot: arrival, path, heading, speed, progress.

use numeric::lanes::Vector2;

use super::STANDSTILL;
use super::episode::ObservedEpisode;
use navigation_world::robots::differential::wrapped;

/// The goal has come nearer when its distance has fallen by so much, in m.
const PROGRESS: f64 = 0.1;
/// Longest time without progress of a robot that is not frozen, in s.
const FROZEN: f64 = 5.0;
/// Rounding of sums of steps, in s.
const ROUNDING: f64 = 1e-9;

/// Metrics of the positions of the robot.
pub(super) struct Travel {
    /// The instant `E`.
    pub end: usize,
    pub arrived: bool,
    pub arrival_time: f64,
    pub final_goal_distance: f64,
    pub path_length: f64,
    pub path_length_ratio: f64,
    pub path_irregularity: f64,
    pub heading_change: f64,
    pub mean_speed: f64,
    pub max_speed: f64,
    pub efficacy: f64,
    pub mean_acceleration: f64,
    pub max_acceleration: f64,
    pub mean_jerk: f64,
    pub stalled_time: f64,
    pub longest_without_progress: f64,
    pub frozen: bool,
}

impl Travel {
    pub fn of(episode: &ObservedEpisode<'_>) -> Self {
        let (rules, robot) = (&episode.rules, episode.robot);
        let distance = |place: &Vector2<f64>| (rules.goal - place).norm();
        let found = robot
            .iter()
            .position(|place| distance(place) <= rules.arrival_tolerance);
        let (arrived, end) = (found.is_some(), found.unwrap_or(robot.len() - 1));
        let motion = TravelSums::of(episode, end);
        let longest = longest_without_progress(episode, end, arrived);
        let shortest = rules
            .shortest_length
            .unwrap_or_else(|| (distance(&robot[0]) - rules.arrival_tolerance).max(0.0));
        let longer = shortest.max(motion.length);
        Self {
            end,
            arrived,
            arrival_time: if arrived {
                end as f64 * rules.step
            } else {
                f64::NAN
            },
            final_goal_distance: distance(&robot[end]),
            path_length: motion.length,
            path_length_ratio: match (arrived, longer > 0.0) {
                (false, _) => f64::NAN,
                (true, false) => 1.0,
                (true, true) => shortest / longer,
            },
            path_irregularity: motion.irregularity.value(),
            heading_change: motion.heading_change,
            mean_speed: motion.speed.value(),
            max_speed: motion.speed.greatest(),
            efficacy: motion.toward.value() / rules.max_speed,
            mean_acceleration: motion.acceleration.value(),
            max_acceleration: motion.acceleration.greatest(),
            mean_jerk: motion.jerk.value(),
            stalled_time: f64::from(motion.stalled) * rules.step,
            longest_without_progress: longest,
            frozen: longest >= FROZEN - ROUNDING,
        }
    }
}

/// Longest time since the last mark of the goal distance, in s.
fn longest_without_progress(episode: &ObservedEpisode<'_>, end: usize, arrived: bool) -> f64 {
    let (mut mark, mut since, mut longest) = (f64::INFINITY, 0, 0);
    // The arrival itself is not counted.
    let last = if arrived { end } else { end + 1 };
    for (instant, place) in episode.robot[..last].iter().enumerate() {
        let distance = (episode.rules.goal - place).norm();
        if distance <= mark - PROGRESS {
            (mark, since) = (distance, instant);
        }
        longest = longest.max(instant - since);
    }
    longest as f64 * episode.rules.step
}

/// Mean and greatest of some numbers; NaN of none.
#[derive(Default)]
struct Mean {
    sum: f64,
    most: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.most = if self.count == 0 {
            value
        } else {
            self.most.max(value)
        };
        self.count += 1;
    }

    fn value(&self) -> f64 {
        self.sum / f64::from(self.count)
    }

    fn greatest(&self) -> f64 {
        if self.count == 0 { f64::NAN } else { self.most }
    }
}

/// Sums over the steps up to the end.
#[derive(Default)]
struct TravelSums {
    length: f64,
    speed: Mean,
    toward: Mean,
    irregularity: Mean,
    heading_change: f64,
    acceleration: Mean,
    jerk: Mean,
    stalled: u32,
}

impl TravelSums {
    fn of(episode: &ObservedEpisode<'_>, end: usize) -> Self {
        let (goal, step) = (episode.rules.goal, episode.rules.step);
        let mut motion = Self::default();
        let (mut velocity_before, mut acceleration_before) = (None, None);
        let mut heading_before: Option<f64> = None;
        for pair in episode.robot[..=end].windows(2) {
            let velocity = (pair[1] - pair[0]) / step;
            let (speed, to_goal) = (velocity.norm(), goal - pair[0]);
            motion.speed.add(speed);
            motion.length += speed * step;
            let distance = to_goal.norm();
            let along = velocity.dot(&to_goal);
            motion.toward.add(if distance > 0.0 {
                along / distance
            } else {
                0.0
            });
            if speed >= STANDSTILL {
                let heading = angle(velocity);
                let off = wrapped(heading - angle(to_goal)).abs();
                motion.irregularity.add(off);
                if let Some(before) = heading_before {
                    motion.heading_change += wrapped(heading - before).abs();
                }
                heading_before = Some(heading);
            } else {
                motion.stalled += 1;
            }
            let acceleration =
                velocity_before.map(|before: Vector2<f64>| (velocity - before) / step);
            if let Some(now) = acceleration {
                motion.acceleration.add(now.norm());
                if let Some(before) = acceleration_before {
                    let change: Vector2<f64> = now - before;
                    motion.jerk.add((change / step).norm());
                }
            }
            (velocity_before, acceleration_before) = (Some(velocity), acceleration);
        }
        motion
    }
}

/// Direction of a vector in rad; 0 without one.
fn angle(vector: Vector2<f64>) -> f64 {
    vector.y.atan2(vector.x)
}
