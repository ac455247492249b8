//! Speeds at which a contact stays within limits of force, pressure and strain.
//!
//! Without supports, damping and rate everything is stored at the largest compression:
//!
//! ```text
//! mu v^2/2 = W_c(F) + W_b(F)
//! ```
//!
//! so that each limit gives its speed in closed form, for every law and shape. Otherwise collisions are
//! simulated until the loads reach a limit.

mod base;
mod numeric;
mod probability;
mod room;
mod row;
mod rows;
mod setup;
#[cfg(test)]
mod tests;
mod thickness;

pub use base::{Drive, differential_mass, holonomic_mass};
pub use numeric::{SCANNED, numeric_speed};
pub use probability::{
    Distribution, Interval, Probability, clopper_pearson, exceedance, normal_probability,
};
pub use room::Room;
pub use row::{Kind, Law, NAMES, Outline, RegionKind, Row};
pub use rows::{
    BOTTOMED, Given, LOADS, RISING, SPEEDS, THICKNESSES, collide_rows, speed_rows, thickness_rows,
};
pub use setup::Setup;
pub use thickness::{Thickness, ThicknessStatus, least_thickness};

use crate::collision::{Region, reduced_mass};
use crate::covering::{Pad, Shape};
use crate::error::{Failure, Given as Shown, Result, positive};

/// Two speeds as near as this, relatively, are a tie.
const TIE: f64 = 1e-9;

/// Limits of one region and class of contact; what is `None` is not checked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Force, in N.
    pub force: Option<f64>,
    /// Pressure, in Pa.
    pub pressure: Option<f64>,
    /// Strain of the covering.
    pub max_strain: Option<f64>,
}

/// A limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Governs {
    /// Of the force.
    Force,
    /// Of the pressure.
    Pressure,
    /// Of the strain.
    Strain,
    /// None of them is there.
    Nothing,
}

impl Governs {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Force, Self::Pressure, Self::Strain, Self::Nothing];

    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Pressure => "pressure",
            Self::Strain => "strain",
            Self::Nothing => "nothing",
        }
    }
}

/// Method that gave a speed, or why there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpeedStatus {
    /// From the stored energy.
    ClosedForm,
    /// By simulation, where loads cannot fall with the speed, or fell nowhere.
    Monotone,
    /// By simulation: the loads cross their limits more than once; the lowest crossing.
    SeveralCrossings,
    /// No load reaches its limit.
    Unlimited,
    /// The mass against a clamped body is unbounded: no speed is allowed.
    UnboundedMass,
    /// No limit was given.
    NotChecked,
    /// A simulation did not come to its end, so that nothing is known.
    Unfinished,
}

impl SpeedStatus {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::ClosedForm,
        Self::Monotone,
        Self::SeveralCrossings,
        Self::Unlimited,
        Self::UnboundedMass,
        Self::NotChecked,
        Self::Unfinished,
    ];

    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed_form",
            Self::Monotone => "monotone",
            Self::SeveralCrossings => "several_crossings",
            Self::Unlimited => "unlimited_up_to_20",
            Self::UnboundedMass => "unbounded_mass",
            Self::NotChecked => "not_checked",
            Self::Unfinished => "unfinished",
        }
    }
}

/// An allowed closing speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Allowed {
    /// Closing speed, in m/s; NaN where nothing limits it.
    pub speed: f64,
    /// The limit that governs.
    pub governs: Governs,
    /// Speeds at which force, pressure and strain reach their limits; NaN where they do not.
    pub speeds: [f64; 3],
    /// Method that gave the speed, or why there is none.
    pub status: SpeedStatus,
    /// Further crossings, in m/s.
    pub further: Vec<f64>,
    /// Compression of the covering at the speed, in m; NaN if bare, or where nothing limits the speed.
    pub compression: f64,
    /// Whether loads of a simulation still rose at its horizon: beyond it they may exceed their limits.
    pub rising: bool,
}

/// A contact at rest with its limits: masses, covering and region.
#[derive(Clone, Copy, Debug)]
pub struct LimitedContact<'a> {
    /// Mass of the robot, in kg, which may be infinite.
    pub robot_mass: f64,
    /// Mass of the body, in kg; infinite: clamped.
    pub body_mass: f64,
    /// Region of the body.
    pub region: Region,
    /// Covering; `None`: bare.
    pub pad: Option<&'a Pad>,
    /// Contact area of a bare contact, in m^2.
    pub area: Option<f64>,
    /// Limits.
    pub limits: Limits,
}

impl Limits {
    /// Checks the limits, with the largest strain of a covering.
    ///
    /// # Errors
    /// A limit is not positive, or a strain is beyond what the covering can bear.
    pub fn check(&self, pad: Option<&Pad>) -> Result<()> {
        if let Some(force) = self.force {
            positive("limits.force", force)?;
        }
        if let Some(pressure) = self.pressure {
            positive("limits.pressure", pressure)?;
        }
        let Some(pad) = pad else { return Ok(()) };
        let covering = &pad.covering;
        match self.max_strain {
            None if covering.bottoming.stiffness == 0.0 => {
                let given = Shown::Found("none without a backing".into());
                Err(Failure::invalid(
                    "max_strain",
                    "be given where there is no backing",
                    given,
                ))
            }
            None => Ok(()),
            Some(strain) => {
                positive("max_strain", strain)?;
                let bound = covering.material.bound();
                let fine = if covering.material.is_measured() {
                    strain <= bound
                } else {
                    strain < bound
                };
                if fine {
                    if strain > covering.bottoming.strain {
                        // Not checked before: where the law falls, a force would be met twice.
                        let law = covering.material.clone().checked(strain);
                        law.map_err(|failure| failure.within("covering.material"))?;
                    }
                    return Ok(());
                }
                let rule = format!("be within what the law describes, up to {bound}");
                Err(Failure::invalid("max_strain", rule, Shown::Number(strain)))
            }
        }
    }

    /// The largest strain that is allowed on a pad: its onset of bottoming if none is given.
    #[must_use]
    pub fn strain(&self, pad: &Pad) -> f64 {
        let law = &pad.covering;
        let default = if law.bottoming.stiffness > 0.0 {
            law.bottoming.strain.min(law.material.bound())
        } else {
            f64::NAN
        };
        self.max_strain.unwrap_or(default)
    }
}

impl LimitedContact<'_> {
    /// Force and compression at each limit; `None` where it is not there or beyond the data.
    #[must_use]
    pub fn at_limits(&self) -> [Option<(f64, f64)>; 3] {
        let Limits {
            force, pressure, ..
        } = self.limits;
        let Some(pad) = self.pad else {
            let by_pressure = pressure.and_then(|pressure| Some((pressure * self.area?, 0.0)));
            return [force.map(|force| (force, 0.0)), by_pressure, None];
        };
        let thickness = pad.covering.thickness;
        let at = |force: f64| {
            pad.compression_at(force)
                .map(|compression| (force, compression))
        };
        let there = |compression: f64| (pad.force(compression)[0], compression);
        let by_pressure = pressure.and_then(|pressure| match pad.covering.shape {
            Shape::Flat { area } => at(pressure * area),
            Shape::Curved { .. } | Shape::Cylinder { .. } => {
                let found = pad.covering.material.strain_at(pressure);
                let free = found.map(|strain| strain * thickness);
                // Past bottoming the pressure at the apex is not known.
                match free {
                    Some(compression) => Some(there(compression.min(pad.bottom()))),
                    None if pad.bottom() <= pad.bound() => Some(there(pad.bottom())),
                    None => None,
                }
            }
        });
        let strain = self.limits.strain(pad);
        let by_strain = strain.is_finite().then(|| there(strain * thickness));
        [force.and_then(at), by_pressure, by_strain]
    }

    /// Energy that covering and region store.
    #[must_use]
    pub fn energy(&self, force: f64, compression: f64) -> f64 {
        self.pad.map_or(0.0, |pad| pad.work(compression)) + self.region.work(force)
    }

    /// Stored energy and compression at each limit.
    #[must_use]
    pub fn stored(&self) -> Stored {
        let at_limits = self.at_limits();
        Stored {
            energies: at_limits
                .map(|limit| limit.map(|(force, compression)| self.energy(force, compression))),
            compressions: at_limits.map(|limit| self.pad.and(limit).map_or(f64::NAN, |(_, d)| d)),
        }
    }

    /// Allowed closing speed from the stored energy.
    #[must_use]
    pub fn closed_form(&self) -> Allowed {
        self.stored()
            .allowed(reduced_mass(self.robot_mass, self.body_mass))
    }
}

/// Stored energies at the limits of force, pressure and strain, whatever moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// Energies, in J; `None` where a limit is not there or beyond the data.
    energies: [Option<f64>; 3],
    /// Compressions of the covering, in m; NaN without one.
    compressions: [f64; 3],
}

impl Stored {
    /// Allowed closing speed of a reduced mass in kg.
    #[must_use]
    pub fn allowed(&self, mass: f64) -> Allowed {
        let speed = |energy: f64| (2.0 * energy / mass).sqrt();
        let speeds = self.energies.map(|energy| energy.map_or(f64::NAN, speed));
        let status = if mass.is_infinite() {
            SpeedStatus::UnboundedMass
        } else {
            SpeedStatus::ClosedForm
        };
        let mut found = governed(speeds, status);
        let place = Governs::ALL.iter().position(|each| *each == found.governs);
        if mass.is_finite()
            && let Some(compression) = place.and_then(|place| self.compressions.get(place))
        {
            found.compression = *compression;
        }
        found
    }
}

/// The lowest of some speeds; of those that tie the first one governs.
#[must_use]
pub fn governed(speeds: [f64; 3], status: SpeedStatus) -> Allowed {
    let lowest = speeds.into_iter().fold(f64::NAN, f64::min);
    let first = speeds
        .iter()
        .position(|speed| *speed <= lowest * (1.0 + TIE));
    let governs = first.map_or(Governs::Nothing, |index| Governs::ALL[index]);
    Allowed {
        speed: lowest,
        governs,
        speeds,
        status: if first.is_none() {
            SpeedStatus::NotChecked
        } else {
            status
        },
        further: Vec::new(),
        compression: f64::NAN,
        rising: false,
    }
}
