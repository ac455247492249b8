//! Effective mass of a point in any direction, from its mobility.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// A direction whose mobility is below this share of the largest one is unbounded: `J^T u = 0`, so
/// that no motion of the joints moves the point along it.
const UNBOUNDED: f64 = 1e-9;

/// Mobility `L = J M^-1 J^T` of a point (1/kg).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mobility(pub Matrix3<f64>);

/// The heaviest and the lightest direction of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest effective mass (kg), infinite where it is unbounded.
    pub worst_mass: f64,
    /// Unit vector along it, its largest component positive.
    pub worst_direction: Vector3<f64>,
    /// Least effective mass (kg).
    pub least_mass: f64,
    /// Unit vector along it, its largest component positive.
    pub least_direction: Vector3<f64>,
}

impl Mobility {
    /// Effective mass along a unit vector (kg), infinite where it is unbounded.
    #[must_use]
    pub fn effective_mass(&self, along: &Vector3<f64>) -> f64 {
        let mobility = along.dot(&(self.0 * along));
        // The largest eigenvalue lies between a third of the trace and the trace: most directions
        // need no eigenvalues.
        let trace = self.0.trace();
        if mobility > UNBOUNDED * trace {
            return mobility.recip();
        }
        if mobility > UNBOUNDED * self.largest() {
            mobility.recip()
        } else {
            f64::INFINITY
        }
    }

    fn largest(&self) -> f64 {
        self.0.symmetric_eigenvalues().max()
    }

    /// The heaviest and the lightest direction.
    #[must_use]
    pub fn extremes(&self) -> Extremes {
        let found = SymmetricEigen::new(self.0);
        let (least, largest) = (found.eigenvalues.imin(), found.eigenvalues.imax());
        let mass = |index: usize| {
            let value = found.eigenvalues[index];
            if value > UNBOUNDED * found.eigenvalues[largest] {
                value.recip()
            } else {
                f64::INFINITY
            }
        };
        let direction = |index: usize| {
            let vector: Vector3<f64> = found.eigenvectors.column(index).into();
            // A direction and its opposite are the same axis: one of them is chosen.
            vector * vector[vector.iamax()].signum()
        };
        Extremes {
            worst_mass: mass(least),
            worst_direction: direction(least),
            least_mass: mass(largest),
            least_direction: direction(largest),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Mobility;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn a_free_particle_weighs_the_same_everywhere() {
        let particle = Mobility(Matrix3::identity() / 5.0);
        let along = Vector3::new(0.6, -0.48, 0.64);
        assert!((particle.effective_mass(&along) - 5.0).abs() < 1e-14);
        assert!((particle.extremes().worst_mass - 5.0).abs() < 1e-14);
    }

    #[test]
    fn directions_without_motion_are_unbounded() {
        let planar = Mobility(Matrix3::from_diagonal(&[1.0, 0.5, 1e-17].into()));
        assert_eq!(planar.effective_mass(&Vector3::z()), f64::INFINITY);
        assert_eq!(planar.extremes().worst_mass, f64::INFINITY);
        assert_eq!(planar.extremes().worst_direction, Vector3::z());
        assert_eq!(planar.extremes().least_mass, 1.0);
        let fixed = Mobility::default();
        assert_eq!(fixed.effective_mass(&Vector3::x()), f64::INFINITY);
        assert_eq!(fixed.extremes().least_mass, f64::INFINITY);
    }

    #[test]
    fn the_bound_is_a_share_of_the_largest_mobility() {
        // Trace 3, largest 1: 2e-9 is below the trace's share and above the eigenvalue's.
        let of = |least: f64| {
            let matrix = Matrix3::from_diagonal(&[1.0, 1.0, least].into());
            Mobility(matrix).effective_mass(&Vector3::z())
        };
        assert_eq!(of(1.5e-9), 1.0 / 1.5e-9);
        assert_eq!(of(0.9e-9), f64::INFINITY);
    }
}
