//! Laws by name, from the lists of the laws: what each is made of stands with the law. The engine knows no
//! law by name.

use crate::crowd::SocialForce;
use crate::run::any_law::AnyLaw;
use navigation_laws::VirtualForceField;
use navigation_laws::arc_rollouts::ArcRollouts;
use navigation_laws::local_planning::Steered;
use navigation_laws::pairwise::Pairwise;
use navigation_laws::planning::family::Planned;
use navigation_laws::safe::SafeNavigation;
use navigation_world::arguments::{Arguments, Named};
use numeric::error::{Failure, Given, Result};

impl From<VirtualForceField> for AnyLaw {
    fn from(law: VirtualForceField) -> Self {
        Self::side_by_side(law)
    }
}

impl From<&VirtualForceField> for AnyLaw {
    fn from(law: &VirtualForceField) -> Self {
        (*law).into()
    }
}

impl From<ArcRollouts> for AnyLaw {
    fn from(law: ArcRollouts) -> Self {
        Self::one_by_one(law)
    }
}

impl From<SafeNavigation> for AnyLaw {
    fn from(law: SafeNavigation) -> Self {
        Self::one_by_one(law)
    }
}

/// Makes a law of its arguments.
type Make = fn(&dyn Arguments) -> Result<AnyLaw>;

/// A law that is a family by itself.
type Own<F> = F;

macro_rules! pairwise_by_name {
    ($($module:ident::$law:ident),+ $(,)?) => {
        $(impl From<Pairwise<navigation_laws::$law>> for AnyLaw {
            fn from(law: Pairwise<navigation_laws::$law>) -> Self {
                Self::side_by_side(law)
            }
        })+

        const PAIRWISE: &[(&str, Make)] = &[$(entry::<Pairwise<navigation_laws::$law>>()),+];
    };
}

macro_rules! others_by_name {
    ($($family:ident, $module:ident::$law:ident, $runs:ident;)+) => {
        $(impl From<$family<navigation_laws::$module::$law>> for AnyLaw {
            fn from(law: $family<navigation_laws::$module::$law>) -> Self {
                Self::$runs(law)
            }
        })+

        const OTHERS: &[(&str, Make)] = &[$(entry::<$family<navigation_laws::$module::$law>>()),+];
    };
}

impl From<SocialForce> for AnyLaw {
    fn from(law: SocialForce) -> Self {
        Self::one_by_one(law)
    }
}

/// Laws that need the models of people, which stand above the others.
const OF_PEOPLE: &[(&str, Make)] = &[entry::<SocialForce>()];

navigation_laws::pairwise_laws!(pairwise_by_name);
navigation_laws::other_laws!(others_by_name);

/// A law with its name.
const fn entry<L: Named + Into<AnyLaw>>() -> (&'static str, Make) {
    (L::NAME, |given| L::made_of(given).map(Into::into))
}

/// The laws by name. The virtual force field, whose terms callers look at one by one, is made by
/// [`VirtualForceField::new`].
fn known() -> impl Iterator<Item = &'static (&'static str, Make)> {
    PAIRWISE.iter().chain(OTHERS).chain(OF_PEOPLE)
}

/// The law of a name, whose numbers are allowed.
///
/// # Errors
/// There is no such law, an argument is missing, or a number is not allowed.
pub fn law_named(name: &str, given: &dyn Arguments) -> Result<AnyLaw> {
    let Some((_, make)) = known().find(|(known, _)| *known == name) else {
        let names: Vec<_> = known().map(|(name, _)| *name).collect();
        let rule = format!("be one of {}", names.join(", "));
        let given = Given::Word(name.to_owned());
        return Err(Failure::invalid("law", rule, given));
    };
    make(given)?.checked()
}
