//! The models of people by name.

pub mod collision_free_speed;
pub mod moussaid;
mod parameters;
pub mod reciprocal_pairs;
pub mod reciprocal_people;
pub mod social_force_1995;
pub mod social_force_2000;

use crate::crowd::agent_lanes::{AgentLanes, Vectors};
use crate::crowd::models::collision_free_speed::CollisionFreeSpeed;
use crate::crowd::models::moussaid::Moussaid;
use crate::crowd::models::reciprocal_people::ReciprocalPeople;
use crate::crowd::models::social_force_1995::SocialForce1995;
use crate::crowd::models::social_force_2000::SocialForce2000;
use crate::crowd::pedestrian::{Around, Pedestrian, PersonDecision, Room, Walker};
use crate::crowd::velocity_programs::LaneRoom;
use navigation_world::arguments::{Arguments, Named};
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Vector2;

/// The enum of all models, each variant with its documentation and type, and what hands on to the model of a variant.
macro_rules! pedestrian_models {
    ($($(#[$documentation:meta])* $variant:ident($model:ident),)*) => {
        /// A model of people.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Model {
            $($(#[$documentation])* $variant($model),)*
        }

        /// Names of the models, as [`Model::named`] knows them.
        pub const NAMES: &[&str] = &[$($model::NAME),*];

        impl Model {
            /// A model made of its parameters.
            ///
            /// # Errors
            /// There is no such model, or a parameter is out of range.
            pub fn named(name: &str, given: &dyn Arguments) -> Result<Self> {
                match name {
                    $($model::NAME => $model::made_of(given).map(Self::$variant),)*
                    other => {
                        let rule = format!("be one of {}", NAMES.join(", "));
                        Err(Failure::invalid("model", rule, Given::Word(other.into())))
                    }
                }
            }

            /// Distance in m beyond which nobody acts.
            #[must_use]
            pub fn cutoff(&self) -> f64 {
                match self { $(Self::$variant(model) => model.cutoff,)* }
            }

            /// Largest step in s.
            #[must_use]
            pub fn largest_step(&self) -> f64 {
                match self { $(Self::$variant(_) => $model::LARGEST_STEP,)* }
            }

            /// Largest speed as a multiple of the desired one, infinite for none.
            #[must_use]
            pub fn cap(&self) -> f64 {
                match self { $(Self::$variant(_) => $model::CAP,)* }
            }

            /// Whether a decision is an acceleration, not a velocity.
            #[must_use]
            pub fn is_force(&self) -> bool {
                match self { $(Self::$variant(_) => $model::IS_FORCE,)* }
            }

            /// Decision of one person: acceleration in m/s^2 of a force model, velocity in m/s of a velocity model.
            #[inline(always)]
            pub fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector2<f64> {
                match self { $(Self::$variant(model) => model.decide(own, around, room),)* }
            }

            /// Decides for everybody at once, if it can: pairs act on each other.
            #[inline(always)]
            pub(in crate::crowd) fn decide_together(
                &self,
                walkers: &[Walker],
                around: &Around<'_>,
                room: &mut Room,
                decisions: &mut [PersonDecision],
            ) -> bool {
                match self { $(Self::$variant(model) => model.decide_together(walkers, around, room, decisions),)* }
            }

            /// Whether people of worlds side by side can decide in lanes.
            pub(in crate::crowd) fn fits_lanes(&self) -> bool {
                match self { $(Self::$variant(_) => $model::LANES,)* }
            }

            /// Decides for the people of worlds side by side, if they fit lanes.
            #[inline(always)]
            pub(in crate::crowd) fn decide_in_lanes(
                &self,
                agents: &AgentLanes,
                room: &mut LaneRoom,
                decisions: &mut Vec<Vectors>,
            ) {
                match self { $(Self::$variant(model) => model.decide_in_lanes(agents, room, decisions),)* }
            }
        }
    };
}

pedestrian_models! {
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
