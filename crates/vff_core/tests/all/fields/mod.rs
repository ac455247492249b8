//! The field of the sources with usual gains.

use vff_core::laws::VirtualForceField;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::Stabilizing;

/// With a side that is kept beyond an angle in rad.
pub fn field(stabilizing: Stabilizing, hysteresis: f64) -> VirtualForceField {
    let gains = Gains::of([3.0, 20.0, 17.0, 0.25]);
    let rules = SideRules {
        pass_behind: hysteresis > 1.0,
        hysteresis,
    };
    VirtualForceField::new(gains, stabilizing, rules).unwrap()
}
