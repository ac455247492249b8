//! The one list of laws, each with the widths that its kernels are compiled for.

use crate::laws::field_d_star::FieldDStar;
use crate::laws::pairwise::Pairwise;
use crate::laws::planning::family::Planned;
use crate::laws::reciprocal::ReciprocalAvoidance;
use crate::laws::tree::RapidlyExploringRandomTree;
use crate::laws::velocity_obstacle::VelocityObstacle;
use crate::laws::{BorensteinKoren, GeCui, Khatib, Masoud, VirtualForceField};
use crate::run::AnyLaw;
use crate::run::group::{EveryWidth, One, OneAndEight};

impl From<VirtualForceField> for AnyLaw {
    fn from(law: VirtualForceField) -> Self {
        Self::driven_by::<_, EveryWidth>(law)
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
                Self::driven_by::<_, $kernels>(law)
            }
        })+
    };
}
any_law!(OneAndEight: Pairwise<Masoud>, Pairwise<GeCui>, Pairwise<Khatib>, Pairwise<BorensteinKoren>);
any_law!(One: Planned<VelocityObstacle>, Planned<ReciprocalAvoidance>);
any_law!(One: Planned<RapidlyExploringRandomTree>, Planned<FieldDStar>);
