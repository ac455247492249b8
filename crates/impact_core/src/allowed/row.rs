//! A contact as a row of numbers: their names, and what is made of them.

use std::sync::Arc;

use super::Limits;
use crate::collision::{Region, SupportedBody};
use crate::covering::{GibsonAshby, Material, Table};
use crate::error::{Result, positive};

/// Count of the numbers of a row.
pub const COUNT: usize = 36;

macro_rules! places {
    ($($place:ident = $index:literal: $name:literal, $called:literal;)+) => {
        $(pub(super) const $place: usize = $index;)+
        // Numbers of a law follow its first one.
        const _: [usize; COUNT] = [$($place),+];
        /// Names of the numbers of a row.
        pub const NAMES: [&str; COUNT] = [$($name),+];
        /// Names of the numbers in errors.
        pub(super) const CALLED: [&str; COUNT] = [$($called),+];
    };
}

places! {
    ROBOT_MASS = 0: "robot_mass", "robot_mass";
    ROBOT_DAMPING = 1: "robot_damping", "robot_damping";
    ROBOT_STIFFNESS = 2: "robot_stiffness", "robot_stiffness";
    BODY_MASS = 3: "body_mass", "body_mass";
    BODY_DAMPING = 4: "body_damping", "body_damping";
    BODY_STIFFNESS = 5: "body_stiffness", "body_stiffness";
    CLOSING_SPEED = 6: "closing_speed", "closing_speed";
    REGION_K = 7: "stiffness", "region.k";
    REGION_K3 = 8: "region_cubic", "region.k3";
    REGION_N = 9: "region_exponent", "region.n";
    THICKNESS = 10: "thickness", "covering.thickness";
    AREA = 11: "area", "covering.area";
    RADIUS = 12: "radius", "covering.radius";
    SECOND_RADIUS = 13: "second_radius", "covering.second_radius";
    LENGTH = 14: "length", "covering.length";
    DAMPING = 15: "damping", "covering.damping";
    RATE_BASE = 16: "rate_base", "covering.rate.base";
    RATE_SLOPE = 17: "rate_slope", "covering.rate.slope";
    RATE_REFERENCE = 18: "rate_reference", "covering.rate.reference";
    RETAINED = 19: "unloading_retained", "covering.unloading.retained";
    UNLOADING_EXPONENT = 20: "unloading_exponent", "covering.unloading.exponent";
    BOTTOMING = 21: "bottoming_strain", "covering.bottoming.strain";
    BACKING = 22: "backing_stiffness", "covering.bottoming.stiffness";
    HORIZON = 23: "horizon", "horizon";
    STOP_TIME = 24: "stop_time", "stop.time";
    STOP_DECELERATION = 25: "stop_deceleration", "stop.deceleration";
    DETECTION_FORCE = 26: "detection_force", "detection_force";
    PUSH_LIMIT = 27: "push_limit", "push_limit";
    FORCE_LIMIT = 28: "force_limit", "limits.force";
    PRESSURE_LIMIT = 29: "pressure_limit", "limits.pressure";
    MAX_STRAIN = 30: "max_strain", "max_strain";
    FIRST_MATERIAL = 31: "material_0", "covering.material.0";
    MATERIAL_1 = 32: "material_1", "covering.material.1";
    MATERIAL_2 = 33: "material_2", "covering.material.2";
    MATERIAL_3 = 34: "material_3", "covering.material.3";
    MATERIAL_4 = 35: "material_4", "covering.material.4";
}

/// Law of a covering without its numbers.
#[derive(Clone, Debug)]
pub enum Law {
    /// `modulus`.
    Linear,
    /// `modulus`, `plateau`, `lock`, `D`, `m`.
    GibsonAshby,
    /// `a`, `p`, `b`, `q`.
    Rusch,
    /// `plateau`, `modulus`, `m`, `B`, `n`.
    Avalle,
    /// Measured points.
    Table(Arc<Table>),
}

impl Law {
    /// Names of its numbers.
    #[must_use]
    pub fn names(&self) -> &'static [&'static str] {
        match self {
            Self::Linear => &["modulus"],
            Self::GibsonAshby => &["modulus", "plateau", "lock", "D", "m"],
            Self::Rusch => &["a", "p", "b", "q"],
            Self::Avalle => &["plateau", "modulus", "m", "B", "n"],
            Self::Table(_) => &[],
        }
    }
}

/// Shape of a contact without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// `area`.
    Flat,
    /// `radius`, `second_radius`.
    Curved,
    /// `radius`, `length`.
    Cylinder,
}

/// Law of a region without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionKind {
    /// It does not yield.
    Rigid,
    /// `stiffness`, `region_cubic`.
    Spring,
    /// `stiffness`, `region_exponent`.
    Power,
}

/// Kinds of covering and region, shared by all rows.
#[derive(Clone, Debug)]
pub struct Kind {
    /// Law and shape of the covering; `None`: bare.
    pub covering: Option<(Law, Outline)>,
    /// Region.
    pub region: RegionKind,
}

/// Numbers of a row; NaN where a number is not given.
#[derive(Clone, Copy, Debug)]
pub struct Row(pub [f64; COUNT]);

/// Numbers that may be absent; all others have to be there.
pub(super) const OPTIONAL: [usize; 8] = [
    AREA,
    SECOND_RADIUS,
    STOP_TIME,
    DETECTION_FORCE,
    PUSH_LIMIT,
    FORCE_LIMIT,
    PRESSURE_LIMIT,
    MAX_STRAIN,
];

/// Whether a number decides whether the law of a covering is possible.
pub(super) fn is_of_law(place: usize) -> bool {
    place >= FIRST_MATERIAL || place == BOTTOMING
}

/// Masses, on which energies and compressions at limits do not depend.
pub(super) const MASSES: [usize; 2] = [ROBOT_MASS, BODY_MASS];

pub(super) fn given(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

impl Row {
    pub(super) fn check_masses(&self) -> Result<()> {
        for place in MASSES {
            if self.0[place] != f64::INFINITY {
                positive(CALLED[place], self.0[place])?;
            }
        }
        Ok(())
    }

    pub(super) fn limits(&self) -> Limits {
        Limits {
            force: given(self.0[FORCE_LIMIT]),
            pressure: given(self.0[PRESSURE_LIMIT]),
            max_strain: given(self.0[MAX_STRAIN]),
        }
    }

    pub(super) fn region(&self, kind: RegionKind) -> Result<Region> {
        match kind {
            RegionKind::Rigid => Region::Rigid,
            RegionKind::Spring => Region::Spring {
                stiffness: self.0[REGION_K],
                cubic: self.0[REGION_K3],
            },
            RegionKind::Power => Region::Power {
                stiffness: self.0[REGION_K],
                exponent: self.0[REGION_N],
            },
        }
        .checked()
    }

    pub(super) fn material(&self, law: &Law) -> Result<Material> {
        let number = |place: usize| self.0[FIRST_MATERIAL + place];
        let material = match law {
            Law::Linear => Material::Linear { modulus: number(0) },
            Law::GibsonAshby => Material::GibsonAshby(GibsonAshby::new([
                number(0),
                number(1),
                number(2),
                number(3),
                number(4),
            ])),
            Law::Rusch => Material::Rusch {
                a: number(0),
                p: number(1),
                b: number(2),
                q: number(3),
            },
            Law::Avalle => Material::Avalle {
                plateau: number(0),
                modulus: number(1),
                m: number(2),
                b: number(3),
                n: number(4),
            },
            Law::Table(table) => Material::Table(Arc::clone(table)),
        };
        let until = self.0[BOTTOMING];
        material
            .checked(until)
            .map_err(|failure| failure.within("covering.material"))
    }

    pub(super) fn body(&self, [mass, damping, stiffness]: [usize; 3]) -> SupportedBody {
        SupportedBody {
            mass: self.0[mass],
            damping: self.0[damping],
            stiffness: self.0[stiffness],
        }
    }
}
