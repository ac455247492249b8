//! What the parts around a law did.

use crate::lanes::Vector2;
use crate::laws::shield::Status;

/// What the parts did in the last control period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace {
    /// Velocity that the law wanted, or the takeover, within its limit, in m/s.
    pub wanted: Vector2<f64>,
    /// Velocity that is commanded in m/s.
    pub command: Vector2<f64>,
    /// Whether the law was taken over from.
    pub taken_over: bool,
    /// What became of the wanted velocity.
    pub status: Status,
}
