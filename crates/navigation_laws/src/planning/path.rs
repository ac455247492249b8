//! From a path to a desired velocity.

/// Result of planning at one control step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PathStatus {
    /// Nothing was planned yet, or the state of the robot is not finite.
    #[default]
    Unplanned,
    /// A path to the goal was found.
    Found,
    /// The robot is within the clearance of an obstacle and leaves it first.
    Leaving,
    /// The goal is within the clearance of an obstacle.
    GoalBlocked,
    /// There is no path, or none was found with the effort allowed.
    NoPath,
}

/// Distance of two points in m.
pub(crate) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Length of a path in m.
#[must_use]
pub fn length(path: &[[f64; 2]]) -> f64 {
    path.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
}

/// Point at a distance along a path, its end when the path is shorter, `None` without a path.
#[must_use]
pub fn point_ahead(path: &[[f64; 2]], ahead: f64) -> Option<[f64; 2]> {
    let mut left = ahead;
    for pair in path.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let step = distance(from, to);
        if step >= left && step > 0.0 {
            let part = left / step;
            return Some([
                from[0] + part * (to[0] - from[0]),
                from[1] + part * (to[1] - from[1]),
            ]);
        }
        left -= step;
    }
    path.last().copied()
}

/// Velocity of a given speed from one point towards another; zero where they coincide.
#[must_use]
pub fn velocity_towards(from: [f64; 2], to: [f64; 2], speed: f64) -> [f64; 2] {
    let way = distance(from, to);
    if way > 0.0 {
        [
            (to[0] - from[0]) / way * speed,
            (to[1] - from[1]) / way * speed,
        ]
    } else {
        [0.0; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn point_ahead_follows_corners_and_ends_at_the_end() {
        let path = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]];
        assert_eq!(point_ahead(&path, 0.25), Some([0.25, 0.0]));
        assert_eq!(point_ahead(&path, 1.5), Some([1.0, 0.5]));
        assert_eq!(point_ahead(&path, 9.0), Some([1.0, 2.0]));
        assert_eq!(point_ahead(&[], 1.0), None);
        assert_eq!(length(&path), 3.0);
        assert_eq!(velocity_towards([1.0; 2], [1.0; 2], 0.7), [0.0; 2]);
    }
}
