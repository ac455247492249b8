//! Contacts as rows of numbers, for batches, maps and draws.

use std::sync::Arc;

use numeric::threads::{Interrupted, map, on_threads};

use super::{
    Allowed, Contact, Governs, Limits, SpeedStatus, Thickness, ThicknessStatus, least_thickness,
    numeric_speed,
};
use crate::collision::{Body, Collision, Outcome, Region, Status, Stop, Wanted, simulate};
use crate::columns::Column;
use crate::covering::{
    Bottoming, Covering, GibsonAshby, Material, Pad, Rate, Shape, Table, Unloading,
};
use crate::error::{Failure, Given as Shown, Result, positive};

/// Rows of a task; the bits of a row do not depend on it.
const BLOCK: usize = 256;
/// Count of the numbers of a row.
pub const COUNT: usize = 34;

macro_rules! places {
    ($($place:ident = $index:literal: $name:literal, $called:literal;)+) => {
        $(const $place: usize = $index;)+
        // Numbers of a law follow its first one.
        const _: [usize; COUNT] = [$($place),+];
        /// Names of the numbers of a row.
        pub const NAMES: [&str; COUNT] = [$($name),+];
        /// What errors call them.
        const CALLED: [&str; COUNT] = [$($called),+];
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

/// How rows are made into contacts.
#[derive(Clone, Debug)]
pub struct Setup {
    /// What all rows share.
    pub kind: Kind,
    /// Whether numbers of the law differ from row to row.
    pub material_varies: bool,
    /// Relative tolerance of simulations.
    pub tolerance: f64,
}

/// Inputs of rows, and how many there are.
#[derive(Clone, Debug)]
pub struct Given<'a> {
    /// A column for each name.
    pub columns: [Column<'a>; COUNT],
    /// Rows.
    pub rows: usize,
}

impl Given<'_> {
    /// Numbers of a row.
    #[must_use]
    pub fn row(&self, index: usize) -> Row {
        Row(std::array::from_fn(|place| self.columns[place].at(index)))
    }
}

fn given(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

impl Row {
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
            Law::GibsonAshby => Material::GibsonAshby(GibsonAshby {
                modulus: number(0),
                plateau: number(1),
                lock: number(2),
                d: number(3),
                m: number(4),
            }),
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
    /// The law, if all rows share its numbers.
    ///
    /// # Errors
    /// A number of the law is out of its range.
    pub fn fixed_material(&self, row: &Row) -> Result<Option<Material>> {
        match &self.kind.covering {
            Some((law, _)) if !self.material_varies => row.material(law).map(Some),
            _ => Ok(None),
        }
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
                    radii: [number(RADIUS), number(SECOND_RADIUS)],
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
        for place in [ROBOT_MASS, BODY_MASS] {
            if row.0[place] != f64::INFINITY {
                positive(CALLED[place], row.0[place])?;
            }
        }
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

    /// Allowed speed of a row: from the stored energy where that is exact, by simulation elsewhere.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn allowed(&self, row: &Row, fixed: Option<&Material>) -> Result<(Allowed, f64)> {
        let pad = self.pad(row, fixed)?;
        let contact = self.contact(row, pad.as_ref())?;
        let bare = match row.0[FORCE_LIMIT] {
            force if contact.region == Region::Rigid || force.is_nan() => f64::NAN,
            force => {
                let mass = crate::collision::reduced_mass(contact.robot_mass, contact.body_mass);
                (2.0 * contact.region.work(force) / mass).sqrt()
            }
        };
        let closed = contact.closed_form();
        let stored = pad
            .as_ref()
            .is_none_or(|pad| pad.covering.damping == 0.0 && pad.covering.rate.is_none());
        let held = [ROBOT_DAMPING, ROBOT_STIFFNESS, BODY_DAMPING, BODY_STIFFNESS];
        let free = held.iter().all(|place| row.0[*place] == 0.0) && row.0[STOP_TIME].is_nan();
        if (stored && free) || closed.status == SpeedStatus::UnboundedMass {
            return Ok((closed, bare));
        }
        let moving = Row({
            let mut numbers = row.0;
            numbers[CLOSING_SPEED] = 1.0;
            numbers
        });
        let collision = self.collision(&moving, pad.as_ref())?;
        let found = numeric_speed(&collision, &contact.limits, contact.area, closed.speed);
        Ok((found, bare))
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
    pub fn collide(&self, row: &Row, fixed: Option<&Material>, wanted: Wanted) -> Result<Outcome> {
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
        Ok(simulate(&collision, wanted))
    }
}

/// Code of a row that cannot be: after the words of the results, the first number that is refused.
fn invalid(setup: &Setup, failure: &Failure, words: usize) -> u8 {
    let Failure::InvalidParameter { name, .. } = failure else {
        return u8::MAX;
    };
    let law = setup
        .kind
        .covering
        .as_ref()
        .map_or(&[][..], |(law, _)| law.names());
    let of_law = name.strip_prefix("covering.material.").map(|last| {
        let place = law.iter().position(|known| *known == last).unwrap_or(0);
        FIRST_MATERIAL + place
    });
    let place = of_law.or_else(|| CALLED.iter().position(|known| known == name));
    let number = place.unwrap_or(COUNT);
    u8::try_from(words + number).unwrap_or(u8::MAX)
}

/// A row of results: numbers and codes of words.
type Found<const N: usize> = ([f64; N], [u8; 2]);

/// Results of all rows in blocks over the threads.
fn each_row<const N: usize>(
    setup: &Setup,
    given: &Given<'_>,
    words: usize,
    threads: Option<usize>,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
    of: impl Fn(&Row, Option<&Material>) -> Result<Found<N>> + Sync,
) -> Result<Vec<Found<N>>> {
    let refused = |failure: &Failure| ([f64::NAN; N], [invalid(setup, failure, words), 3]);
    let block = |index: usize| -> Result<Vec<Found<N>>> {
        let rows = index * BLOCK..given.rows.min((index + 1) * BLOCK);
        let fixed = if given.rows > 0 {
            setup.fixed_material(&given.row(0))
        } else {
            Ok(None)
        };
        let mut found = Vec::with_capacity(rows.len());
        for row in rows {
            if interrupted() {
                return Err(Failure::Interrupted);
            }
            let result = match &fixed {
                Ok(material) => of(&given.row(row), material.as_ref()),
                Err(failure) => Err(failure.clone()),
            };
            found.push(match result {
                Ok(result) => result,
                Err(failure) => refused(&failure),
            });
        }
        progress(found.len());
        Ok(found)
    };
    let blocks = on_threads(threads, || Ok(map(given.rows.div_ceil(BLOCK), block)))?;
    let mut all = Vec::with_capacity(given.rows);
    for part in blocks {
        all.extend(part?);
    }
    Ok(all)
}

/// Numbers by name, and the codes of statuses and of what governs.
pub struct Columns {
    /// Columns with their names.
    pub numbers: Vec<(&'static str, Vec<f64>)>,
    /// Status of each row.
    pub status: Vec<u8>,
    /// A second word of each row.
    pub word: Vec<u8>,
}

fn turned<const N: usize>(names: [&'static str; N], rows: &[Found<N>]) -> Columns {
    let numbers = names.into_iter().enumerate().map(|(place, name)| {
        let column = rows.iter().map(|(numbers, _)| numbers[place]).collect();
        (name, column)
    });
    Columns {
        numbers: numbers.collect(),
        status: rows.iter().map(|(_, codes)| codes[0]).collect(),
        word: rows.iter().map(|(_, codes)| codes[1]).collect(),
    }
}

/// Place of a word among all, as a code.
fn code<T: PartialEq>(all: &[T], word: &T) -> u8 {
    let place = all.iter().position(|each| each == word).unwrap_or(0);
    u8::try_from(place).unwrap_or(u8::MAX)
}

/// Loads of all rows; a row that cannot be is NaN with its status.
///
/// # Errors
/// The caller asked to stop.
pub fn collide_rows(
    setup: &Setup,
    given: &Given<'_>,
    wanted: Wanted,
    threads: Option<usize>,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Columns> {
    let of = |row: &Row, fixed: Option<&Material>| {
        let found = setup.collide(row, fixed, wanted)?;
        let numbers = [
            found.release_time,
            found.peak_force,
            found.peak_force_time,
            found.peak_total_compression,
            found.peak_body_deflection,
            found.peak_covering_compression,
            found.peak_strain,
            found.peak_pressure,
            found.rebound_speed,
            found.peak_body_acceleration,
            found.body_speed_end,
            found.injury[0],
            found.injury[1],
            found.end_force,
        ];
        Ok((
            numbers,
            [code(&Status::ALL, &found.status), u8::from(found.bottomed)],
        ))
    };
    let rows = each_row(
        setup,
        given,
        Status::ALL.len(),
        threads,
        interrupted,
        progress,
        of,
    )?;
    let names = [
        "release_time",
        "peak_force",
        "peak_force_time",
        "peak_total_compression",
        "peak_body_deflection",
        "peak_covering_compression",
        "peak_strain",
        "peak_pressure",
        "rebound_speed",
        "peak_body_acceleration",
        "body_speed_end",
        "hic15",
        "hic36",
        "end_force",
    ];
    Ok(turned(names, &rows))
}

/// Allowed speeds of all rows.
///
/// # Errors
/// The caller asked to stop.
pub fn speed_rows(
    setup: &Setup,
    given: &Given<'_>,
    threads: Option<usize>,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Columns> {
    let of = |row: &Row, fixed: Option<&Material>| {
        let (found, bare) = setup.allowed(row, fixed)?;
        let [force, pressure, strain] = found.speeds;
        let codes = [
            code(&SpeedStatus::ALL, &found.status),
            code(&Governs::ALL, &found.governs),
        ];
        Ok(([found.speed, force, pressure, strain, bare], codes))
    };
    let rows = each_row(
        setup,
        given,
        SpeedStatus::ALL.len(),
        threads,
        interrupted,
        progress,
        of,
    )?;
    let names = [
        "speed",
        "speed_force",
        "speed_pressure",
        "speed_strain",
        "bare_speed_force",
    ];
    Ok(turned(names, &rows))
}

/// Least thicknesses of all rows at their closing speed.
///
/// # Errors
/// The caller asked to stop.
pub fn thickness_rows(
    setup: &Setup,
    given: &Given<'_>,
    threads: Option<usize>,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Columns> {
    let of = |row: &Row, fixed: Option<&Material>| {
        let found = setup.thickness(row, fixed)?;
        Ok((
            [found.thickness],
            [code(&ThicknessStatus::ALL, &found.status), 0],
        ))
    };
    let rows = each_row(
        setup,
        given,
        ThicknessStatus::ALL.len(),
        threads,
        interrupted,
        progress,
        of,
    )?;
    Ok(turned(["thickness"], &rows))
}
