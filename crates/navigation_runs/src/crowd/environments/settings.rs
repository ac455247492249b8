//! Settings of environments: inputs, observations, rewards.

use crate::crowd::environments::layout::Layout;
use crate::crowd::world::CrowdWorld;
use numeric::error::{Failure, Given, Result, at_most, finite, positive};

/// Most people and lidar rays of an observation.
const MOST_SEEN: usize = 10_000;

/// How an action drives the robot; its numbers are shares of the greatest values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// A velocity, shortened to the greatest speed.
    Velocity,
    /// An acceleration.
    Acceleration,
    /// A speed, backward below 0, and a turn rate.
    Unicycle,
}

/// Axes of the vectors of an observation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// Axes of the world.
    World,
    /// The x axis points from the robot to its goal.
    Goal,
}

/// Start of the next episode after the end of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// The next step starts the next episode, whatever the action.
    NextStep,
    /// Within the step that ends the last one.
    SameStep,
    /// The caller starts it.
    Disabled,
}

/// Rewards beside those of arrival and contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rewards {
    /// For each meter that the goal comes nearer.
    pub progress: f64,
    /// For each step.
    pub step: f64,
}

/// Settings of all environments of a set.
#[derive(Clone)]
pub struct EnvironmentSettings {
    /// The world of an episode, one of whose robots, the first, is driven.
    pub world: CrowdWorld,
    /// Differences between episodes.
    pub layout: Layout,
    /// Meaning of an action.
    pub action: Action,
    /// Greatest acceleration, in m/s^2.
    pub max_acceleration: f64,
    /// Greatest turn rate, in rad/s.
    pub max_turn_rate: f64,
    /// How many people it sees.
    pub people: usize,
    /// Number of lidar rays.
    pub rays: usize,
    /// Axes of what it sees.
    pub axes: Axes,
    /// Weights of the reward.
    pub rewards: Rewards,
    /// Start of the next episode.
    pub autoreset: Autoreset,
    /// Whether positions are kept to score each episode at its end.
    pub metrics: bool,
}

impl EnvironmentSettings {
    /// Returns the settings if they obey their rules.
    ///
    /// # Errors
    /// Names the argument that does not.
    pub fn checked(self) -> Result<Self> {
        let mut world = self.world.checked()?;
        let Some(driven) = world.robots.first_mut() else {
            let given = Given::Found("none".into());
            return Err(Failure::invalid(
                "world.robots",
                "hold a robot to drive",
                given,
            ));
        };
        // Its wheels take up actions, and do not follow the point mass of a law.
        driven.law = None;
        positive("max_acceleration", self.max_acceleration)?;
        positive("max_turn_rate", self.max_turn_rate)?;
        at_most("people", self.people, MOST_SEEN)?;
        at_most("lidar", self.rays, MOST_SEEN)?;
        finite("progress", self.rewards.progress)?;
        finite("step_reward", self.rewards.step)?;
        Ok(Self { world, ..self })
    }

    /// Numbers of the robot itself: goal, velocity, greatest speed, share of the time.
    pub const OWN: usize = 6;
    /// Numbers of a person: position, velocity, gap.
    pub const PERSON: usize = 5;

    /// Numbers of an observation.
    #[must_use]
    pub fn size(&self) -> usize {
        Self::OWN + Self::PERSON * self.people + self.rays
    }
}
