//! Least thickness of a covering for a wanted speed.

use super::LimitedContact;
use crate::covering::{Pad, Shape};

/// Range of thicknesses to search, in m.
const RANGE: [f64; 2] = [1e-4, 1.0];
/// Number of thicknesses, where a thicker covering may be slower.
const LOOKS: usize = 97;

/// Result of the search for a least thickness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThicknessStatus {
    /// The least thickness.
    Found,
    /// A covering of 0.1 mm keeps all limits.
    BareIsEnough,
    /// Not even 1 m suffices.
    NoneUpTo1M,
}

impl ThicknessStatus {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Found, Self::BareIsEnough, Self::NoneUpTo1M];

    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::BareIsEnough => "bare_is_enough",
            Self::NoneUpTo1M => "none_up_to_1_m",
        }
    }
}

/// A thickness and the result of its search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thickness {
    /// Thickness, in m; 0 if bare is enough, NaN if none is found.
    pub thickness: f64,
    /// Result of the search.
    pub status: ThicknessStatus,
}

/// Least thickness of the contact's covering at which a speed is allowed.
#[must_use]
pub fn least_thickness(contact: &LimitedContact<'_>, pad: &Pad, speed: f64) -> Thickness {
    let allows = |thickness: f64| {
        let other = pad.of_thickness(thickness);
        let covered = LimitedContact {
            pad: Some(&other),
            ..*contact
        };
        // Where nothing limits the speed every speed is allowed.
        let found = covered.closed_form().speed;
        found.is_nan() || found >= speed
    };
    let none = Thickness {
        thickness: f64::NAN,
        status: ThicknessStatus::NoneUpTo1M,
    };
    if allows(RANGE[0]) {
        return Thickness {
            thickness: 0.0,
            status: ThicknessStatus::BareIsEnough,
        };
    }
    let found = |thickness: f64| Thickness {
        thickness,
        status: ThicknessStatus::Found,
    };
    if let Shape::Flat { area } = pad.covering.shape
        && let Some(thickness) = flat(contact, pad, area, speed)
    {
        return if thickness <= RANGE[1] {
            found(thickness)
        } else {
            none
        };
    }
    let ratio = (RANGE[1] / RANGE[0]).ln() / (LOOKS - 1) as f64;
    let at = |index: usize| RANGE[0] * (ratio * index as f64).exp();
    let Some(first) = (1..LOOKS).find(|index| allows(at(*index))) else {
        return none;
    };
    let (mut low, mut high) = (at(first - 1), at(first));
    while high - low > 4.0 * f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if allows(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    found(high)
}

/// `T = (mu v^2/2 - W_b(F))/(A w(e))` of a flat covering whose strain stays below its bottoming.
fn flat(contact: &LimitedContact<'_>, pad: &Pad, area: f64, speed: f64) -> Option<f64> {
    let covering = &pad.covering;
    let most = contact.limits.strain(pad);
    if covering.bottoming.stiffness > 0.0 && most > covering.bottoming.strain {
        return None;
    }
    let limits = [
        contact.limits.force,
        contact.limits.pressure.map(|pressure| pressure * area),
    ];
    let strain = limits
        .into_iter()
        .flatten()
        .filter_map(|force| covering.material.strain_at(force / area))
        .fold(most, f64::min);
    let force = area * covering.material.stress(strain)[0];
    let mass = crate::collision::reduced_mass(contact.robot_mass, contact.body_mass);
    let left = 0.5 * mass * speed * speed - contact.region.work(force);
    Some(left / (area * covering.material.work(strain)))
}
