//! Static equilibrium of covering and region at the largest compression.

use super::Region;
use crate::covering::Pad;

/// Covering and region at rest under a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Force, in N.
    pub force: f64,
    /// Compression of the covering, in m.
    pub compression: f64,
    /// Deflection of the region, in m.
    pub deflection: f64,
    /// Stored work, in J.
    pub work: f64,
}

/// Equilibrium at which covering and region store an energy in J; as far as the data reach.
#[must_use]
pub fn rest_of(pad: Option<&Pad>, region: Region, energy: f64) -> Rest {
    let at_force = |force: f64| Rest {
        force,
        compression: 0.0,
        deflection: region.deflection(force),
        work: region.work(force),
    };
    let Some(pad) = pad else {
        // W(F) rises with slope F/g'.
        let force = crate::covering::inverse_of(energy, |force| {
            let rest = at_force(force);
            [rest.work, force / region.force(rest.deflection)[1]]
        });
        return at_force(force);
    };
    let at = |compression: f64| {
        let [stored, force, slope] = pad.work_and_force(compression);
        let deflection = region.deflection(force);
        let work = stored + region.work(force);
        let yielding = region.force(deflection)[1];
        // dW/dd = F + F F'/g'.
        let rise = force * (1.0 + if slope == 0.0 { 0.0 } else { slope / yielding });
        (
            Rest {
                force,
                compression,
                deflection,
                work,
            },
            rise,
        )
    };
    let bound = pad.bound();
    let compression = crate::covering::inverse_within(energy, bound, |compression| {
        let (rest, rise) = at(compression);
        [rest.work, rise]
    });
    at(compression).0
}
