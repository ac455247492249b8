//! The half of a disc that lies ahead of a robot: where nobody may be while it moves.

use crate::lanes::Vector2;

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
}
