//! Rigid bodies: mass, center and inertia, checked, moved and put together.

use nalgebra::{Isometry3, Matrix3, SymmetricEigen, Vector3};
use numeric::error::{Given, Result, finite, not_negative};

use crate::error::Failure;

/// By how much of its trace an inertia may miss the triangle inequality.
const TRIANGLE: f64 = 1e-6;

/// A moving body of a radius of gyration below this is hardly what its maker meant (m).
pub const LEAST_GYRATION: f64 = 0.002;

/// A rigid body in some frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// Mass (kg).
    pub mass: f64,
    /// Center of mass (m).
    pub center: Vector3<f64>,
    /// Inertia about the center of mass along the axes of the frame (kg m^2).
    pub inertia: Matrix3<f64>,
}

impl Body {
    /// Returns the body if a rigid body may be so.
    ///
    /// # Errors
    /// Negative mass, numbers that are not finite, an inertia that is not positive semidefinite or
    /// whose principal moments break the triangle inequality.
    pub fn checked(self) -> Result<Self> {
        not_negative("mass", self.mass)?;
        for value in &self.center {
            finite("center", *value)?;
        }
        for value in &self.inertia {
            finite("inertia", *value)?;
        }
        if (self.inertia - self.inertia.transpose()).amax() > 1e-9 * self.inertia.amax() {
            let found = Given::Found("another number across its diagonal".into());
            return Err(Failure::invalid("inertia", "be symmetric", found));
        }
        let [least, middle, largest] = self.principal_moments();
        let trace = least + middle + largest;
        if !(trace.is_finite() && largest.is_finite()) {
            return Err(Failure::invalid(
                "inertia",
                "be finite",
                Given::Number(trace),
            ));
        }
        let slack = TRIANGLE * trace.abs();
        if least < -slack || trace < 0.0 {
            let rule = "be positive semidefinite (least principal moment)";
            return Err(Failure::invalid("inertia", rule, Given::Number(least)));
        }
        if least + middle < largest - slack {
            let rule = format!(
                "have principal moments of which none exceeds the sum of the others ({:.6} kg m^2)",
                least + middle
            );
            return Err(Failure::invalid("inertia", rule, Given::Number(largest)));
        }
        Ok(self)
    }

    /// Principal moments about the center of mass, the least one first (kg m^2).
    #[must_use]
    pub fn principal_moments(&self) -> [f64; 3] {
        let mut found: [f64; 3] = SymmetricEigen::new(self.inertia).eigenvalues.into();
        found.sort_by(f64::total_cmp);
        found
    }

    /// Largest radius of gyration about the center of mass (m); none without a mass.
    #[must_use]
    pub fn gyration(&self) -> Option<f64> {
        let [_, _, largest] = self.principal_moments();
        (self.mass > 0.0).then(|| (largest.max(0.0) / self.mass).sqrt())
    }

    /// The same body in the frame in which its own one stands so.
    #[must_use]
    pub fn placed(&self, frame: &Isometry3<f64>) -> Self {
        let rotation = frame.rotation.to_rotation_matrix();
        let turned = rotation.matrix() * self.inertia * rotation.matrix().transpose();
        Self {
            mass: self.mass,
            center: (frame * nalgebra::Point3::from(self.center)).coords,
            inertia: 0.5 * (turned + turned.transpose()),
        }
    }

    /// Both bodies as one.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let center = if mass > 0.0 {
            (self.center * self.mass + other.center * other.mass) / mass
        } else {
            Vector3::zeros()
        };
        let moved = |body: &Self| {
            let away = body.center - center;
            body.inertia
                + (Matrix3::identity() * away.norm_squared() - away * away.transpose()) * body.mass
        };
        Self {
            mass,
            center,
            inertia: moved(self) + moved(other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Body;
    use nalgebra::{Matrix3, Vector3};

    fn body(moments: [f64; 3]) -> Body {
        Body {
            mass: 1.0,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&moments.into()),
        }
    }

    #[test]
    fn moments_obey_the_triangle_inequality() {
        assert!(body([1.0, 1.0, 2.0]).checked().is_ok());
        assert!(body([1.0, 1.0, 2.0 + 3e-6]).checked().is_ok());
        assert!(body([1.0, 1.0, 2.001]).checked().is_err());
        assert!(body([-0.1, 1.0, 1.0]).checked().is_err());
        assert!(body([0.0, 0.0, 0.0]).checked().is_ok());
        assert!(body([f64::NAN, 1.0, 1.0]).checked().is_err());
        assert!(body([f64::MAX, f64::MAX, f64::MAX]).checked().is_err());
    }

    #[test]
    fn two_points_make_a_dumbbell() {
        let end = |x| Body {
            mass: 2.0,
            center: Vector3::new(x, 0.0, 0.0),
            inertia: Matrix3::zeros(),
        };
        let both = end(1.0).joined(&end(-1.0));
        assert_eq!(both.mass, 4.0);
        assert_eq!(both.center, Vector3::zeros());
        assert_eq!(
            both.inertia,
            Matrix3::from_diagonal(&[0.0, 4.0, 4.0].into())
        );
        assert_eq!(end(1.0).gyration(), Some(0.0));
    }
}
