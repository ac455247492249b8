//! Metrics of social navigation, from positions alone: runs, recordings and other programs are scored alike.
//!
//! Velocities, accelerations and jerks are forward differences of the positions. The end `E` is the first
//! instant within the tolerance of the goal, else the last one; what concerns the robot counts up to it.

mod body;
mod contacts;
mod declared;
mod effect;
mod episode;
mod extremes;
mod pressure;
mod proximity;
mod travel;
mod whole;

pub use body::ObservedBody;
pub use declared::{
    DeclaredMetric, Kind, ROBOT_METRICS, RobotMetrics, WORLD_METRICS, WorldMetrics,
};
pub use episode::{KnownArrival, MetricRules, ObservedEpisode, Paths, Without};
pub use extremes::{EXTREMES, Extremes};
pub use whole::{Whole, evaluate_world};

use contacts::Contacts;
use effect::Effect;
use proximity::Proximity;
pub(crate) use proximity::nearest_between;
use travel::Travel;

use numeric::error::Result;

/// Speeds below it are standstill, in m/s.
pub(crate) const STANDSTILL: f64 = 0.05;

/// Metrics of one robot.
///
/// # Errors
/// Names the value of the episode that is out of range.
pub fn evaluate(episode: &ObservedEpisode<'_>) -> Result<RobotMetrics> {
    episode.check()?;
    Ok(evaluate_checked(episode))
}

/// Metrics like [`evaluate`], of an episode that is known to be valid.
#[must_use]
pub fn evaluate_checked(episode: &ObservedEpisode<'_>) -> RobotMetrics {
    evaluate_with_extremes(episode).0
}

/// Metrics with the extremes that tell whether any of them is in doubt.
#[must_use]
pub fn evaluate_with_extremes(episode: &ObservedEpisode<'_>) -> (RobotMetrics, Extremes) {
    let travel = Travel::of(episode);
    let (near, touches) = Proximity::of(episode, travel.end);
    let contacts = Contacts::of(episode, travel.end, &touches);
    let effect = Effect::of(episode);
    let success = travel.arrived && contacts.none();
    let extremes = Extremes::of(episode, near.may_be_passed);
    let metrics = RobotMetrics {
        arrived: travel.arrived,
        arrival_time: travel.arrival_time,
        final_goal_distance: travel.final_goal_distance,
        success,
        path_length: travel.path_length,
        path_length_ratio: travel.path_length_ratio,
        spl: if success {
            travel.path_length_ratio
        } else {
            0.0
        },
        path_irregularity: travel.path_irregularity,
        heading_change: travel.heading_change,
        mean_speed: travel.mean_speed,
        max_speed: travel.max_speed,
        efficacy: travel.efficacy,
        mean_acceleration: travel.mean_acceleration,
        max_acceleration: travel.max_acceleration,
        mean_jerk: travel.mean_jerk,
        stalled_time: travel.stalled_time,
        longest_without_progress: travel.longest_without_progress,
        frozen: travel.frozen,
        min_clearance: near.min_clearance,
        mean_clearance: near.mean_clearance,
        wall_clearance: contacts.wall_clearance,
        intimate_share: near.intimate_share,
        personal_share: near.personal_share,
        social_share: near.social_share,
        comfort_share: near.comfort_share,
        discomfort_time: near.discomfort_time,
        min_time_to_collision: near.min_time_to_collision,
        low_time_to_collision_share: near.low_time_to_collision_share,
        robot_on_person: contacts.robot_on_person,
        person_on_robot: contacts.person_on_robot,
        mutual_contacts: contacts.mutual,
        max_closing_speed: contacts.max_closing_speed,
        wall_contacts: contacts.walls,
        group_intrusion_share: near.group_intrusion_share,
        force_on_people: near.force_on_people,
        force_on_robot: near.force_on_robot,
        social_work: near.force_on_people + near.force_on_robot,
        person_delay: effect.delay,
        person_detour: effect.detour,
        people_blocked: effect.blocked,
        person_deviation: effect.deviation,
    };
    (metrics, extremes)
}
