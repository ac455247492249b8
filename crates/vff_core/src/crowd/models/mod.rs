//! The models of people by name.

pub mod collision_free_speed;
pub mod moussaid;
pub mod reciprocal_pairs;
pub mod reciprocal_people;
pub mod social_force_1995;
pub mod social_force_2000;

use crate::arguments::Arguments;
use crate::crowd::models::collision_free_speed::CollisionFreeSpeed;
use crate::crowd::models::moussaid::Moussaid;
use crate::crowd::models::reciprocal_people::ReciprocalPeople;
use crate::crowd::models::social_force_1995::SocialForce1995;
use crate::crowd::models::social_force_2000::SocialForce2000;
use crate::crowd::pedestrian::{Around, Pedestrian, Room, Walker};
use crate::error::{Failure, Given, Result, finite, not_negative, positive};
use crate::lanes::Vector2;

/// A model of people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Model {
    /// Helbing and Molnar (1995).
    SocialForce1995(SocialForce1995),
    /// Helbing, Farkas and Vicsek (2000).
    SocialForce2000(SocialForce2000),
    /// Moussaid et al. (2009, 2010).
    Moussaid(Moussaid),
    /// Tordeux et al. (2016).
    CollisionFreeSpeed(CollisionFreeSpeed),
    /// Van den Berg et al. (2011).
    ReciprocalAvoidance(ReciprocalPeople),
}

/// Names of the models, as [`Model::named`] knows them.
pub const NAMES: [&str; 5] = [
    "social_force_1995",
    "social_force_2000",
    "moussaid",
    "collision_free_speed",
    "reciprocal_avoidance",
];

/// Most neighbors that a person avoids.
const MOST_NEIGHBORS: usize = 1 << 16;

impl Pedestrian for Model {
    #[inline(always)]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector2<f64> {
        match self {
            Self::SocialForce1995(model) => model.decide(own, around, room),
            Self::SocialForce2000(model) => model.decide(own, around, room),
            Self::Moussaid(model) => model.decide(own, around, room),
            Self::CollisionFreeSpeed(model) => model.decide(own, around, room),
            Self::ReciprocalAvoidance(model) => model.decide(own, around, room),
        }
    }
}

impl Model {
    /// Distance in m beyond which nobody acts.
    #[must_use]
    pub fn cutoff(&self) -> f64 {
        match self {
            Self::SocialForce1995(model) => model.cutoff,
            Self::SocialForce2000(model) => model.cutoff,
            Self::Moussaid(model) => model.cutoff,
            Self::CollisionFreeSpeed(model) => model.cutoff,
            Self::ReciprocalAvoidance(model) => model.cutoff,
        }
    }

    /// Largest step in s.
    #[must_use]
    pub fn largest_step(&self) -> f64 {
        match self {
            Self::SocialForce1995(_) => 0.1,
            Self::SocialForce2000(_) => 0.01,
            Self::Moussaid(_) | Self::CollisionFreeSpeed(_) => 0.05,
            Self::ReciprocalAvoidance(_) => 0.25,
        }
    }

    /// Largest speed as a multiple of the desired one, infinite for none.
    #[must_use]
    pub fn cap(&self) -> f64 {
        match self {
            Self::SocialForce1995(_) | Self::Moussaid(_) => 1.3,
            Self::SocialForce2000(_) => f64::INFINITY,
            Self::CollisionFreeSpeed(_) | Self::ReciprocalAvoidance(_) => 1.0,
        }
    }

    /// Whether a decision is an acceleration, not a velocity.
    #[must_use]
    pub fn is_force(&self) -> bool {
        match self {
            Self::SocialForce1995(_) | Self::SocialForce2000(_) | Self::Moussaid(_) => true,
            Self::CollisionFreeSpeed(_) | Self::ReciprocalAvoidance(_) => false,
        }
    }

    /// A model made of its parameters.
    ///
    /// # Errors
    /// There is no such model, or a parameter is out of range.
    pub fn named(name: &str, given: &impl Arguments) -> Result<Self> {
        let above = |name: &str| positive(name, given.number(name)?);
        let least = |name: &str| not_negative(name, given.number(name)?);
        let plain = |name: &str| finite(name, given.number(name)?);
        let cutoff = reach(given.number("cutoff")?)?;
        Ok(match name {
            "social_force_1995" => Self::SocialForce1995(SocialForce1995 {
                relaxation_time: above("relaxation_time")?,
                strength: least("strength")?,
                range: above("range")?,
                step_time: least("step_time")?,
                wall_strength: least("wall_strength")?,
                wall_range: above("wall_range")?,
                view_angle: least("view_angle")?,
                behind: least("behind")?,
                cutoff,
            }),
            "social_force_2000" => Self::SocialForce2000(SocialForce2000 {
                relaxation_time: above("relaxation_time")?,
                mass: above("mass")?,
                strength: least("strength")?,
                range: above("range")?,
                stiffness: least("stiffness")?,
                friction: least("friction")?,
                anisotropy: least("anisotropy")?,
                wall_strength: least("wall_strength")?,
                cutoff,
            }),
            "moussaid" => Self::Moussaid(Moussaid {
                relaxation_time: above("relaxation_time")?,
                strength: least("strength")?,
                gamma: above("gamma")?,
                n: least("n")?,
                n_prime: least("n_prime")?,
                velocity_weight: least("velocity_weight")?,
                side_bias: plain("side_bias")?,
                wall_strength: least("wall_strength")?,
                wall_range: above("wall_range")?,
                gaze: least("gaze")?,
                cohesion: least("cohesion")?,
                separation: least("separation")?,
                view_angle: least("view_angle")?,
                contact_distance: least("contact_distance")?,
                cutoff,
            }),
            "collision_free_speed" => Self::CollisionFreeSpeed(CollisionFreeSpeed {
                time_gap: above("time_gap")?,
                strength: least("strength")?,
                range: above("range")?,
                wall_strength: least("wall_strength")?,
                wall_range: above("wall_range")?,
                cutoff,
            }),
            "reciprocal_avoidance" => Self::ReciprocalAvoidance(ReciprocalPeople {
                horizon: above("horizon")?,
                wall_horizon: above("wall_horizon")?,
                max_neighbors: crate::error::at_most(
                    "max_neighbors",
                    given.count("max_neighbors")?,
                    MOST_NEIGHBORS,
                )?,
                margin: least("margin")?,
                cutoff,
            }),
            other => {
                let rule = format!("be one of {}", NAMES.join(", "));
                return Err(Failure::invalid("model", rule, Given::Word(other.into())));
            }
        })
    }
}

/// A cutoff in m, infinite for none.
fn reach(cutoff: f64) -> Result<f64> {
    if cutoff > 0.0 {
        return Ok(cutoff);
    }
    let rule = "be positive, or None for no cutoff";
    Err(Failure::invalid("cutoff", rule, Given::Number(cutoff)))
}

/// The models that look at pairs, for tests.
#[cfg(test)]
pub(in crate::crowd) fn of_pairs(cutoff: f64, max_neighbors: usize) -> [Model; 3] {
    [
        Model::SocialForce1995(SocialForce1995 {
            relaxation_time: 0.5,
            strength: 2.1,
            range: 0.3,
            step_time: 2.0,
            wall_strength: 10.0,
            wall_range: 0.2,
            view_angle: 1.7,
            behind: 0.5,
            cutoff,
        }),
        Model::Moussaid(Moussaid {
            relaxation_time: 0.54,
            strength: 4.5,
            gamma: 0.35,
            n: 2.0,
            n_prime: 3.0,
            velocity_weight: 2.0,
            side_bias: 0.005,
            wall_strength: 3.0,
            wall_range: 0.1,
            gaze: 4.0,
            cohesion: 3.0,
            separation: 1.0,
            view_angle: 1.5,
            contact_distance: 0.55,
            cutoff,
        }),
        Model::ReciprocalAvoidance(ReciprocalPeople {
            horizon: 5.0,
            wall_horizon: 0.5,
            max_neighbors,
            margin: 0.01,
            cutoff,
        }),
    ]
}
