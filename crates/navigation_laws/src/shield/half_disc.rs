//! The half of a disc that lies ahead of a robot: where nobody may be while it moves.

use numeric::lanes::Vector2;

/// Distance of a point from the half disc `{x: |x| <= radius, x.ahead >= 0}` of a robot at the
/// origin, in m; zero inside. `ahead` has length 1.
#[inline(always)]
#[must_use]
pub fn half_disc_distance(point: Vector2<f64>, radius: f64, ahead: Vector2<f64>) -> f64 {
    let along = point.dot(&ahead);
    let across = point.perp(&ahead).abs();
    if along >= 0.0 {
        ((along * along + across * across).sqrt() - radius).max(0.0)
    } else if across <= radius {
        -along
    } else {
        let beside = across - radius;
        (along * along + beside * beside).sqrt()
    }
}

/// Directions within an angle of one: the half disc ahead is the union of those of all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    ahead: Vector2<f64>,
    sin: f64,
    cos: f64,
}

impl Look {
    /// Along a direction of length 1, within the angle of a sine; from 1 on the whole disc.
    #[inline]
    #[must_use]
    pub fn within(ahead: Vector2<f64>, sine: f64) -> Self {
        let sin = sine.min(1.0);
        Self {
            ahead,
            sin,
            cos: (1.0 - sin * sin).sqrt(),
        }
    }

    /// Within another angle.
    pub(super) fn widened(&self, sine: f64) -> Self {
        Self::within(self.ahead, sine)
    }

    /// The direction of the half disc that holds all of the union on the side of a point: what the other
    /// ones have there, it has too.
    #[inline(always)]
    pub(super) fn toward(&self, point: Vector2<f64>) -> Vector2<f64> {
        if self.sin == 0.0 {
            return self.ahead;
        }
        let sin = self.sin.copysign(self.ahead.perp(&point));
        let (x, y) = (self.ahead.x, self.ahead.y);
        Vector2::new(x * self.cos - y * sin, y * self.cos + x * sin)
    }

    /// The two outermost directions.
    pub(super) fn ends(&self) -> [Vector2<f64>; 2] {
        let (x, y) = (self.ahead.x, self.ahead.y);
        [self.sin, -self.sin]
            .map(|sin| Vector2::new(x * self.cos - y * sin, y * self.cos + x * sin))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_ahead_beside_and_behind() {
        let ahead = Vector2::new(0.0, 1.0);
        let distance = |x, y| half_disc_distance(Vector2::new(x, y), 0.5, ahead);
        assert_eq!(distance(0.1, 0.2), 0.0);
        assert_eq!(distance(0.0, 2.0), 1.5);
        assert_eq!(distance(0.3, -0.2), 0.2);
        assert_eq!(distance(3.5, -4.0), 5.0);
    }

    #[test]
    fn no_sample_of_the_half_disc_is_nearer() {
        let ahead = Vector2::new(0.6, -0.8);
        for place in [[1.3, 0.4], [-0.7, 0.9], [-0.2, -0.1], [0.2, 1.6]] {
            let point = Vector2::from(place);
            let mut least = f64::INFINITY;
            for ring in 0..=200 {
                for turn in 0..720 {
                    let angle = f64::from(turn) * std::f64::consts::TAU / 720.0;
                    let sample =
                        Vector2::new(angle.cos(), angle.sin()) * (0.5 * f64::from(ring) / 200.0);
                    if sample.dot(&ahead) >= 0.0 {
                        least = least.min((sample - point).norm());
                    }
                }
            }
            let exact = half_disc_distance(point, 0.5, ahead);
            assert!(exact <= least + 1e-12 && least < exact + 5e-3);
        }
    }

    #[test]
    fn the_half_disc_toward_a_point_is_the_nearest_of_all_within_the_angle() {
        for sine in [0.0, 0.02, 0.4, 0.9, 1.0, 7.0] {
            let look = Look::within(Vector2::new(0.6, -0.8), sine);
            let most = sine.min(1.0).asin();
            for place in [
                [1.3, 0.4],
                [-0.7, 0.9],
                [-0.2, -0.1],
                [0.2, 1.6],
                [-0.45, 0.65],
            ] {
                let point = Vector2::from(place);
                let least = (-50..=50)
                    .map(|part| {
                        let (sin, cos) = (most * f64::from(part) / 50.0).sin_cos();
                        let ahead = Vector2::new(0.6 * cos + 0.8 * sin, 0.6 * sin - 0.8 * cos);
                        half_disc_distance(point, 0.5, ahead)
                    })
                    .fold(f64::INFINITY, f64::min);
                let found = half_disc_distance(point, 0.5, look.toward(point));
                assert!(found <= least + 1e-12, "{sine} {place:?}: {found} {least}");
                assert!(sine < 1.0 || (found - (point.norm() - 0.5).max(0.0)).abs() < 1e-12);
            }
        }
    }
}
