//! Somebody at an instant, a person or a robot.

use numeric::lanes::Vector2;

/// Nothing has a direction if it is shorter than this.
pub const SHORTEST: f64 = 1e-9;

/// Robots come after all people where numbers decide.
pub const FIRST_ROBOT: u32 = 1 << 31;

/// Somebody at an instant, as others see them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agent {
    /// Position in m.
    pub position: Vector2<f64>,
    /// Velocity in m/s.
    pub velocity: Vector2<f64>,
    /// Where a person wants to go, where a robot moves: of length 1, or zero.
    pub direction: Vector2<f64>,
    /// Radius in m.
    pub radius: f64,
    /// Number of a person; that of a robot is above [`FIRST_ROBOT`].
    pub number: u32,
}

/// A vector of length 1, or zero for one without a direction.
#[inline]
#[must_use]
pub fn direction_of(vector: Vector2<f64>) -> Vector2<f64> {
    let length = vector.norm();
    if length < SHORTEST {
        return Vector2::zeros();
    }
    vector / length
}
