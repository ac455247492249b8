//! The one list of laws: the name of each, the arguments it is made of, and the widths that its
//! kernels are compiled for. The engine knows no law by name.

use crate::arguments::Arguments;
use crate::error::{Failure, Given, Result};
use crate::laws::field_d_star::FieldDStar;
use crate::laws::impedance::{Attraction, Form, Impedance, ImpedanceFamily};
use crate::laws::pairwise::Pairwise;
use crate::laws::planning::family::Planned;
use crate::laws::reciprocal::ReciprocalAvoidance;
use crate::laws::safe::SafeNavigation;
use crate::laws::tree::RapidlyExploringRandomTree;
use crate::laws::velocity_obstacle::{Selection, VelocityObstacle};
use crate::laws::{BorensteinKoren, GeCui, Khatib, KhatibForm, Masoud, VirtualForceField};
use crate::run::AnyLaw;
use crate::run::lanes::kernels::{EveryWidth, One, OneAndEight, OneAndScenes};

impl From<VirtualForceField> for AnyLaw {
    fn from(law: VirtualForceField) -> Self {
        Self::with_kernels::<_, EveryWidth>(law)
    }
}

impl From<&VirtualForceField> for AnyLaw {
    fn from(law: &VirtualForceField) -> Self {
        (*law).into()
    }
}

macro_rules! any_law {
    ($kernels:ty: $($law:ty),+) => {
        $(impl From<$law> for AnyLaw {
            fn from(law: $law) -> Self {
                Self::with_kernels::<_, $kernels>(law)
            }
        })+
    };
}
any_law!(OneAndEight: Pairwise<Masoud>, Pairwise<GeCui>, Pairwise<Khatib>, Pairwise<BorensteinKoren>);
any_law!(OneAndScenes: Planned<ReciprocalAvoidance>);
any_law!(One: Planned<VelocityObstacle>, Planned<RapidlyExploringRandomTree>);
any_law!(One: Planned<FieldDStar>, ImpedanceFamily);
any_law!(One: SafeNavigation);

/// Makes a law of its arguments.
type Make = fn(&dyn Arguments) -> Result<AnyLaw>;

/// The laws by name. The virtual force field, whose terms callers look at one by one, is made by
/// [`VirtualForceField::new`].
const LAWS: [(&str, Make); 9] = [
    ("masoud", |given| {
        let law = Masoud {
            attractive: given.number("attractive_gain")?,
            repulsive: given.number("repulsive_gain")?,
            detour: given.number("detour_gain")?,
        };
        Ok(Pairwise(law).into())
    }),
    ("ge_cui", |given| {
        let law = GeCui {
            attractive: given.number("attractive_gain")?,
            repulsive: given.number("repulsive_gain")?,
            ratio: given.number("gain_ratio")?,
            // Every scenario brings the one of its robot.
            max_acceleration: f64::NAN,
        };
        Ok(Pairwise(law).into())
    }),
    ("khatib", |given| {
        let law = Khatib {
            attractive: given.number("attractive_gain")?,
            repulsive: given.number("repulsive_gain")?,
            ratio: given.number("gain_ratio")?,
            form: if given.flag("printed")? {
                KhatibForm::Printed
            } else {
                KhatibForm::Gradient
            },
        };
        Ok(Pairwise(law).into())
    }),
    ("borenstein_koren", |given| {
        let law = BorensteinKoren {
            attractive: given.number("attractive_gain")?,
            repulsive: given.number("repulsive_gain")?,
            attracted_inside: given.flag("attracted_inside")?,
        };
        Ok(Pairwise(law).into())
    }),
    ("virtual_impedance", |given| {
        let (stiffness, damping) = (given.number("stiffness")?, given.number("damping")?);
        let impedance = Impedance {
            form: if given.flag("active")? {
                Form::Active
            } else {
                Form::Conventional
            },
            stiffness,
            damping,
            safe_distance: given.number("safe_distance")?,
            speed_limit: given.number("speed_limit")?,
            reference_stiffness: std::f64::consts::E * stiffness,
            reference_damping: damping / std::f64::consts::E,
            clamp: true,
        };
        let attraction = Attraction {
            stiffness: given.number("attraction_stiffness")?,
            damping: given.number("attraction_damping")?,
            standoff: 0.0,
        };
        let law = ImpedanceFamily {
            impedance,
            attraction,
            reach: given.number("reach")?,
            view: given.number("view")?,
        };
        Ok(law.into())
    }),
    ("velocity_obstacle", |given| {
        let law = VelocityObstacle {
            margin: given.number("margin")?,
            horizon: given.number("horizon")?,
            selection: selection(given)?,
            ..VelocityObstacle::default()
        };
        Ok(Planned(law).into())
    }),
    ("optimal_reciprocal_collision_avoidance", |given| {
        let law = ReciprocalAvoidance {
            horizon: given.number("horizon")?,
            share: given.number("share")?,
            reach: given.number("reach")?,
            margin: given.number("margin")?,
            turn: given.number("turn")?,
        };
        Ok(Planned(law).into())
    }),
    ("field_d_star", |given| {
        let law = FieldDStar {
            resolution: given.number("resolution")?,
            margin: given.number("margin")?,
            horizon: given.number("horizon")?,
            room: given.number("room")?,
            look_ahead: given.number("look_ahead")?,
        };
        Ok(Planned(law).into())
    }),
    ("rapidly_exploring_random_tree", |given| {
        let law = RapidlyExploringRandomTree {
            step: given.number("step")?,
            goal_probability: given.number("goal_probability")?,
            waypoint_probability: given.number("waypoint_probability")?,
            waypoints: given.count("waypoints")?,
            draws: given.count("draws")?,
            keeps_path: given.flag("keeps_path")?,
            margin: given.number("margin")?,
            horizon: given.number("horizon")?,
            room: given.number("room")?,
            look_ahead: given.number("look_ahead")?,
            safety_draws: given.count("safety_draws")?,
        };
        Ok(Planned(law).into())
    }),
];

/// How the velocity obstacle selects among its velocities.
fn selection(given: &dyn Arguments) -> Result<Selection> {
    let (sector, risk) = (given.number("sector")?, given.number("risk_weight")?);
    let word = given.word("selection")?;
    match word.as_str() {
        "fastest" => Ok(Selection::Fastest { sector }),
        "time_and_risk" => Ok(Selection::TimeAndRisk { risk }),
        "to_goal" => Ok(Selection::ToGoal),
        _ => {
            let rule = "be one of \"fastest\", \"time_and_risk\", \"to_goal\"";
            Err(Failure::invalid("selection", rule, Given::Word(word)))
        }
    }
}

/// The law of a name, whose numbers are allowed.
///
/// # Errors
/// There is no such law, an argument is missing, or a number is not allowed.
pub fn law_named(name: &str, given: &dyn Arguments) -> Result<AnyLaw> {
    let known = LAWS.iter().find(|(known, _)| *known == name);
    let Some((_, make)) = known else {
        let names = LAWS.map(|(name, _)| name).join(", ");
        let given = Given::Word(name.to_owned());
        return Err(Failure::invalid("law", format!("be one of {names}"), given));
    };
    make(given)?.checked()
}
