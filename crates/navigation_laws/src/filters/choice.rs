//! Any of the filters, by its name, and what it makes of a wanted velocity.

use crate::filters::{
    ApproachMonitor, Barrier, BarrierUnicycle, CollisionCone, FilterStatus, Filtered,
    ResponsibilityRule, Sighted, VelocityClamp,
};
use navigation_world::arguments::Arguments;
use numeric::error::{Failure, Given, Result, not_negative, positive};
use numeric::lanes::Vector2;

/// Most poses that a monitor looks at.
const MOST_POSES: f64 = 1e5;

/// A filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// Control barrier function of velocities.
    Barrier(Barrier),
    /// That of a point ahead of two wheels.
    BarrierUnicycle(BarrierUnicycle),
    /// That of the collision cone.
    CollisionCone(CollisionCone),
    /// Share of the velocity that velocity obstacles allow.
    VelocityClamp(VelocityClamp),
    /// Responsibility-sensitive safety.
    ResponsibilityRule(ResponsibilityRule),
    /// Approach action of a collision monitor.
    ApproachMonitor(ApproachMonitor),
}

impl Filter {
    /// The filter of a name.
    ///
    /// # Errors
    /// There is no such filter, or an argument is missing or out of range.
    pub fn named(name: &str, given: &dyn Arguments) -> Result<Self> {
        let number = |name: &str| given.number(name);
        let more = |name: &str| number(name).and_then(|value| positive(name, value));
        let margin = number("margin").and_then(|value| not_negative("margin", value))?;
        Ok(match name {
            "barrier" => Self::Barrier(Barrier {
                rate: more("rate")?,
                margin,
            }),
            "barrier_unicycle" => Self::BarrierUnicycle(BarrierUnicycle {
                rate: more("rate")?,
                ahead: more("ahead")?,
                margin,
            }),
            "collision_cone" => Self::CollisionCone(CollisionCone {
                rate: more("rate")?,
                margin,
            }),
            "velocity_clamp" => Self::VelocityClamp(VelocityClamp {
                horizon: more("horizon")?,
                margin,
            }),
            "responsibility_rule" => Self::ResponsibilityRule(ResponsibilityRule {
                reaction_time: number("reaction_time")
                    .and_then(|value| not_negative("reaction_time", value))?,
                acceleration: number("acceleration")
                    .and_then(|value| not_negative("acceleration", value))?,
                braking: more("braking")?,
                person_acceleration: number("person_acceleration")
                    .and_then(|value| not_negative("person_acceleration", value))?,
                person_braking: more("person_braking")?,
                margin,
            }),
            "approach_monitor" => {
                let monitor = ApproachMonitor {
                    time_before_collision: more("time_before_collision")?,
                    simulation_time_step: more("simulation_time_step")?,
                    margin,
                };
                if monitor.time_before_collision > MOST_POSES * monitor.simulation_time_step {
                    let rule = "be at least 1e-5 of time_before_collision";
                    let given = Given::Number(monitor.simulation_time_step);
                    return Err(Failure::invalid("simulation_time_step", rule, given));
                }
                Self::ApproachMonitor(monitor)
            }
            _ => {
                let rule = "be the name of a filter";
                return Err(Failure::invalid(
                    "filter",
                    rule,
                    Given::Word(name.to_owned()),
                ));
            }
        })
    }

    /// True for robots with two wheels; the others are for those that move in any direction.
    #[must_use]
    pub fn is_for_wheels(&self) -> bool {
        matches!(self, Self::BarrierUnicycle(_))
    }

    /// Distance in m ahead of the robot of the place from which its rule looks at walls; `None` if it does not.
    #[must_use]
    pub fn looks_at_walls_from(&self) -> Option<f64> {
        match self {
            Self::Barrier(_) => Some(0.0),
            Self::BarrierUnicycle(rule) => Some(rule.ahead),
            Self::CollisionCone(_)
            | Self::VelocityClamp(_)
            | Self::ResponsibilityRule(_)
            | Self::ApproachMonitor(_) => None,
        }
    }

    /// Filtered velocity for a wanted one in m/s; of two wheels that is speed in m/s and turn rate in rad/s. A monitor
    /// looks at the turn rate in rad/s beside the velocity.
    #[must_use]
    pub fn decide(&self, seen: &Sighted<'_>, wanted: Vector2<f64>, turn_rate: f64) -> Filtered {
        match self {
            Self::Barrier(rule) => rule.filter(seen, wanted),
            Self::BarrierUnicycle(rule) => rule.filter(seen, [wanted.x, wanted.y]),
            Self::CollisionCone(rule) => rule.filter(seen, wanted),
            Self::VelocityClamp(rule) => rule.filter(seen, wanted).0,
            Self::ResponsibilityRule(rule) => rule.filter(seen, wanted),
            Self::ApproachMonitor(rule) => {
                let (share, _) = rule.share(seen, wanted, turn_rate);
                let status = if share < 1.0 {
                    FilterStatus::Changed
                } else {
                    FilterStatus::Kept
                };
                Filtered {
                    velocity: wanted * share,
                    status,
                    slack: 0.0,
                    share,
                }
            }
        }
    }
}
