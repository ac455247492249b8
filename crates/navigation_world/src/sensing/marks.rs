//! Two marks on a robot, whose places tell where it is and where it looks: Zeng (2011), 7.3.1.

use crate::sensing::sensor::Truth;
use numeric::lanes::Vector2;

/// Stream of the noise of the second mark; obstacles count up from 1, and a camera takes the highest
/// bit for its lost frames.
pub(crate) const MARK_STREAM: u64 = 1 << 62;

/// Where the second mark is, at a distance in m ahead of the center.
pub(crate) fn second(truth: &Truth<'_>, distance: f64) -> Vector2<f64> {
    truth.robot.position + truth.heading.direction() * distance
}

/// Heading in rad from the measured places of both marks, (7.3.1).
pub(crate) fn heading(position: Vector2<f64>, mark: Vector2<f64>) -> f64 {
    let ahead = mark - position;
    ahead.y.atan2(ahead.x)
}
