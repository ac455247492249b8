//! A contact as a row of numbers: their names, and what is made of them.

use std::sync::Arc;

use numeric::threads::Interrupted;

use super::{
    Allowed, Contact, Limits, SpeedStatus, Stored, Thickness, least_thickness, numeric_speed,
};
use crate::collision::{Body, Collision, Outcome, Region, Stop, Wanted, simulate};
use crate::covering::{
    Bottoming, Covering, GibsonAshby, Material, Pad, Rate, Shape, Table, Unloading,
};
use crate::error::{Failure, Given as Shown, Result, positive};

/// Count of the numbers of a row.
pub const COUNT: usize = 34;

macro_rules! places {
    ($($place:ident = $index:literal: $name:literal, $called:literal;)+) => {
        $(pub(super) const $place: usize = $index;)+
        // Numbers of a law follow its first one.
        const _: [usize; COUNT] = [$($place),+];
        /// Names of the numbers of a row.
        pub const NAMES: [&str; COUNT] = [$($name),+];
        /// What errors call them.
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
    FORCE_LIMIT = 26: "force_limit", "limits.force";
    PRESSURE_LIMIT = 27: "pressure_limit", "limits.pressure";
    MAX_STRAIN = 28: "max_strain", "max_strain";
    FIRST_MATERIAL = 29: "material_0", "covering.material.0";
    MATERIAL_1 = 30: "material_1", "covering.material.1";
    MATERIAL_2 = 31: "material_2", "covering.material.2";
    MATERIAL_3 = 32: "material_3", "covering.material.3";
    MATERIAL_4 = 33: "material_4", "covering.material.4";
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

/// What all rows share.
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
pub(super) const OPTIONAL: [usize; 6] = [
    AREA,
    SECOND_RADIUS,
    STOP_TIME,
    FORCE_LIMIT,
    PRESSURE_LIMIT,
    MAX_STRAIN,
];

/// Whether a number decides whether the law of a covering is possible.
pub(super) fn is_of_law(place: usize) -> bool {
    place >= FIRST_MATERIAL || place == BOTTOMING
}

/// What energies and compressions at limits do not depend on.
pub(super) const MASSES: [usize; 2] = [ROBOT_MASS, BODY_MASS];

/// What is known of rows that differ in their masses only.
#[derive(Clone, Debug)]
pub struct Known {
    pad: Option<Pad>,
    /// Energy of the bare region at the force limit in J, NaN without one.
    bare_energy: f64,
    stored: Stored,
    /// Whether the stored energy is all there is.
    at_rest: bool,
    area: Option<f64>,
    limits: Limits,
}

/// How rows are made into contacts.
#[derive(Clone, Debug)]
pub struct Setup {
    /// What all rows share.
    pub kind: Kind,
    /// Relative tolerance of simulations.
    pub tolerance: f64,
}

fn given(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

impl Row {
    fn check_masses(&self) -> Result<()> {
        for place in MASSES {
            if self.0[place] != f64::INFINITY {
                positive(CALLED[place], self.0[place])?;
            }
        }
        Ok(())
    }

    fn limits(&self) -> Limits {
        Limits {
            force: given(self.0[FORCE_LIMIT]),
            pressure: given(self.0[PRESSURE_LIMIT]),
            max_strain: given(self.0[MAX_STRAIN]),
        }
    }

    fn region(&self, kind: RegionKind) -> Result<Region> {
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

    fn material(&self, law: &Law) -> Result<Material> {
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

    fn body(&self, [mass, damping, stiffness]: [usize; 3]) -> Body {
        Body {
            mass: self.0[mass],
            damping: self.0[damping],
            stiffness: self.0[stiffness],
        }
    }
}

impl Setup {
    /// The law of a row, for rows that share its numbers.
    ///
    /// # Errors
    /// A number of the law is out of its range.
    pub fn material(&self, row: &Row) -> Result<Option<Material>> {
        let law = self.kind.covering.as_ref();
        law.map(|(law, _)| row.material(law)).transpose()
    }

    /// The covering of a row.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn pad(&self, row: &Row, fixed: Option<&Material>) -> Result<Option<Pad>> {
        let Some((law, outline)) = &self.kind.covering else {
            return Ok(None);
        };
        let number = |place: usize| row.0[place];
        let covering = Covering {
            material: match fixed {
                Some(material) => material.clone(),
                None => row.material(law)?,
            },
            thickness: number(THICKNESS),
            shape: match outline {
                Outline::Flat => Shape::Flat { area: number(AREA) },
                Outline::Curved => Shape::Curved {
                    radii: [
                        number(RADIUS),
                        given(number(SECOND_RADIUS)).unwrap_or(number(RADIUS)),
                    ],
                },
                Outline::Cylinder => Shape::Cylinder {
                    radius: number(RADIUS),
                    length: number(LENGTH),
                },
            },
            damping: number(DAMPING),
            rate: Rate {
                base: number(RATE_BASE),
                slope: number(RATE_SLOPE),
                reference: number(RATE_REFERENCE),
            },
            unloading: Unloading {
                retained: number(RETAINED),
                exponent: number(UNLOADING_EXPONENT),
            },
            bottoming: Bottoming {
                strain: number(BOTTOMING),
                stiffness: number(BACKING),
            },
        };
        covering
            .check_numbers()
            .map_err(|failure| failure.within("covering"))?;
        Ok(Some(Pad::new(covering)))
    }

    /// The collision of a row.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn collision<'a>(&self, row: &Row, pad: Option<&'a Pad>) -> Result<Collision<'a>> {
        let stop = given(row.0[STOP_TIME]).map(|time| Stop {
            time,
            deceleration: row.0[STOP_DECELERATION],
        });
        let collision = Collision {
            robot: row.body([ROBOT_MASS, ROBOT_DAMPING, ROBOT_STIFFNESS]),
            body: row.body([BODY_MASS, BODY_DAMPING, BODY_STIFFNESS]),
            region: row.region(self.kind.region)?,
            pad,
            closing_speed: row.0[CLOSING_SPEED],
            stop,
            horizon: row.0[HORIZON],
            tolerance: self.tolerance,
        };
        collision.check()?;
        Ok(collision)
    }

    /// The contact of a row at rest.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn contact<'a>(&self, row: &Row, pad: Option<&'a Pad>) -> Result<Contact<'a>> {
        row.check_masses()?;
        let region = row.region(self.kind.region)?;
        if pad.is_none() && region == Region::Rigid {
            let given = Shown::Found("none on a rigid region".into());
            return Err(Failure::invalid(
                "covering",
                "be given, or the region yield",
                given,
            ));
        }
        let area = given(row.0[AREA]).filter(|_| pad.is_none());
        if let Some(area) = area {
            positive("area", area)?;
        }
        let limits = row.limits();
        limits.check(pad)?;
        Ok(Contact {
            robot_mass: row.0[ROBOT_MASS],
            body_mass: row.0[BODY_MASS],
            region,
            pad,
            area,
            limits,
        })
    }

    /// Allowed speed of a row from the stored energy.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn closed_form(&self, row: &Row, fixed: Option<&Material>) -> Result<Allowed> {
        let pad = self.pad(row, fixed)?;
        Ok(self.contact(row, pad.as_ref())?.closed_form())
    }

    /// Allowed speed of a row: from the stored energy where that is exact, by simulation elsewhere; and that
    /// at the force limit without the covering. What was known of a row that differs in its masses
    /// only is used again.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn allowed(
        &self,
        row: &Row,
        fixed: Option<&Material>,
        known: &mut Option<Known>,
        interrupted: Interrupted<'_>,
    ) -> Result<(Allowed, f64)> {
        let known = match known {
            Some(known) => {
                row.check_masses()?;
                known
            }
            None => known.insert(self.known(row, fixed)?),
        };
        let mass = crate::collision::reduced_mass(row.0[ROBOT_MASS], row.0[BODY_MASS]);
        let bare = (2.0 * known.bare_energy / mass).sqrt();
        let closed = known.stored.allowed(mass);
        if known.at_rest || closed.status == SpeedStatus::UnboundedMass {
            return Ok((closed, bare));
        }
        let moving = Row({
            let mut numbers = row.0;
            numbers[CLOSING_SPEED] = 1.0;
            numbers
        });
        let collision = self.collision(&moving, known.pad.as_ref())?;
        let limited = (&known.limits, known.area);
        let found = numeric_speed(&collision, limited, closed.speed, interrupted);
        Ok((found, bare))
    }

    /// What does not depend on the masses of a row.
    fn known(&self, row: &Row, fixed: Option<&Material>) -> Result<Known> {
        let pad = self.pad(row, fixed)?;
        let contact = self.contact(row, pad.as_ref())?;
        let bare_energy = match row.0[FORCE_LIMIT] {
            force if contact.region == Region::Rigid || force.is_nan() => f64::NAN,
            force => contact.region.work(force),
        };
        let elastic = pad
            .as_ref()
            .is_none_or(|pad| pad.covering.damping == 0.0 && pad.covering.rate.is_none());
        let held = [ROBOT_DAMPING, ROBOT_STIFFNESS, BODY_DAMPING, BODY_STIFFNESS];
        let free = held.iter().all(|place| row.0[*place] == 0.0) && row.0[STOP_TIME].is_nan();
        Ok(Known {
            bare_energy,
            stored: contact.stored(),
            at_rest: elastic && free,
            area: contact.area,
            limits: contact.limits,
            pad,
        })
    }

    /// Least thickness for the closing speed of a row.
    ///
    /// # Errors
    /// A number is out of its range, there is no covering, or it has a damper or a rate.
    pub fn thickness(&self, row: &Row, fixed: Option<&Material>) -> Result<Thickness> {
        let missing = || {
            let given = Shown::Found("none".into());
            Failure::invalid("covering", "be given", given)
        };
        let pad = self.pad(row, fixed)?.ok_or_else(missing)?;
        if pad.covering.damping > 0.0 || !pad.covering.rate.is_none() {
            let rule = "have neither damping nor rate: a least thickness is from stored energy";
            return Err(Failure::invalid(
                "covering",
                rule,
                Shown::Number(pad.covering.damping),
            ));
        }
        let speed = positive("closing_speed", row.0[CLOSING_SPEED])?;
        let contact = self.contact(row, Some(&pad))?;
        Ok(least_thickness(&contact, &pad, speed))
    }

    /// Loads of a row.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn collide(
        &self,
        row: &Row,
        fixed: Option<&Material>,
        wanted: Wanted,
        interrupted: Interrupted<'_>,
    ) -> Result<Outcome> {
        let pad = self.pad(row, fixed)?;
        let collision = self.collision(row, pad.as_ref())?;
        if collision.reduced_mass().is_infinite() {
            let rule = "be finite against a clamped body";
            return Err(Failure::invalid(
                "robot_mass",
                rule,
                Shown::Number(f64::INFINITY),
            ));
        }
        Ok(simulate(&collision, wanted, interrupted))
    }
}
