//! Rigid bodies: mass, center and inertia, checked, moved and put together.

use nalgebra::{Isometry3, Matrix3, SymmetricEigen, Vector3};
use numeric::error::{Given, Result, finite, not_negative};

use crate::error::Failure;

/// By how much of its trace an inertia may miss what a rigid body has, and count as right: half of what its largest
/// principal moment may exceed the sum of the others by.
pub const ROUNDING: f64 = 0.5e-6;

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
    /// Refused by `finite`, an inertia that is not positive semidefinite, or principal moments that
    /// break the triangle inequality.
    pub fn checked(self) -> Result<Self> {
        let body = self.finite()?;
        if body.violation() > ROUNDING {
            return Err(body.no_rigid_body());
        }
        Ok(body)
    }

    /// Returns the body if its numbers are finite, its mass is not negative and its inertia is symmetric.
    ///
    /// # Errors
    /// They are not.
    pub fn finite(self) -> Result<Self> {
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
        Ok(self)
    }

    /// The error about an inertia that no rigid body has.
    #[must_use]
    pub fn no_rigid_body(&self) -> Failure {
        let [least, middle, largest] = self.principal_moments();
        if least < -2.0 * ROUNDING * (least + middle + largest).abs() {
            let rule = "be positive semidefinite (least principal moment)";
            return Failure::invalid("inertia", rule, Given::Number(least));
        }
        let rule = format!(
            "have principal moments of which none exceeds the sum of the others ({:.6} kg m^2)",
            least + middle
        );
        Failure::invalid("inertia", rule, Given::Number(largest))
    }

    /// By how much of its trace the inertia `I` misses that of a rigid body: minus the least
    /// eigenvalue of `S = tr(I)/2 - I`, the second moments of its mass, over `tr I`; 0 for an
    /// inertia that a body can have, infinite without a positive trace.
    #[must_use]
    pub fn violation(&self) -> f64 {
        let [least, middle, largest] = self.principal_moments();
        let trace = least + middle + largest;
        let second = 0.5 * trace - largest;
        // Rounding of an inertia of zero is no violation: 1 um^2 of the mass.
        if second >= -1e-12 * self.mass {
            0.0
        } else if trace > 0.0 {
            -second / trace
        } else {
            f64::INFINITY
        }
    }

    /// The body with the nearest inertia that a rigid body can have: eigenvalues of
    /// `S = tr(I)/2 - I` below 0 become 0, and `I' = tr(S') - S'`. It is nearest in the Frobenius
    /// norm of `S`, and `I' - I` is positive semidefinite: no effective mass becomes less.
    #[must_use]
    pub fn nearest(&self) -> Self {
        let unit = Matrix3::identity();
        let mut found = SymmetricEigen::new(unit * (0.5 * self.inertia.trace()) - self.inertia);
        if found.eigenvalues.min() >= 0.0 {
            return *self;
        }
        found.eigenvalues.apply(|value| *value = value.max(0.0));
        let second = found.recompose();
        let inertia = unit * second.trace() - second;
        Self {
            inertia: 0.5 * (inertia + inertia.transpose()),
            ..*self
        }
    }

    /// Principal moments about the center of mass, the least one first (kg m^2).
    #[must_use]
    pub fn principal_moments(&self) -> [f64; 3] {
        let mut found: [f64; 3] = SymmetricEigen::new(self.inertia).eigenvalues.into();
        numeric::order::sort_ascending(&mut found);
        found
    }

    /// Largest radius of gyration about the center of mass (m); none without a mass.
    #[must_use]
    pub fn gyration(&self) -> Option<f64> {
        let [_, _, largest] = self.principal_moments();
        (self.mass > 0.0).then(|| (largest.max(0.0) / self.mass).sqrt())
    }

    /// Body of the same shape and another mass.
    #[must_use]
    pub fn weighing(&self, mass: f64) -> Self {
        Self {
            mass,
            inertia: self.inertia * (mass / self.mass),
            ..*self
        }
    }

    /// The body in outer coordinates, in which `frame` is the pose of its own frame.
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

/// A symmetric matrix, such as an inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Symmetric {
    xx: f64,
    xy: f64,
    xz: f64,
    yy: f64,
    yz: f64,
    zz: f64,
}

impl Symmetric {
    /// The symmetric part of a matrix.
    #[must_use]
    pub fn of(matrix: &Matrix3<f64>) -> Self {
        let even = 0.5 * (matrix + matrix.transpose());
        Self {
            xx: even.m11,
            xy: even.m12,
            xz: even.m13,
            yy: even.m22,
            yz: even.m23,
            zz: even.m33,
        }
    }

    /// Change of an inertia when the mass is moved by `away` from the origin it was about:
    /// `2 (h.r) 1 - h r^T - r h^T` with the first moment `h` about the middle of both origins.
    #[must_use]
    pub fn moved(middle: &Vector3<f64>, away: &Vector3<f64>) -> Self {
        let (h, r) = (middle, away);
        let (x, y, z) = (h.x * r.x, h.y * r.y, h.z * r.z);
        Self {
            xx: 2.0 * (y + z),
            xy: -(h.x * r.y + h.y * r.x),
            xz: -(h.x * r.z + h.z * r.x),
            yy: 2.0 * (x + z),
            yz: -(h.y * r.z + h.z * r.y),
            zz: 2.0 * (x + y),
        }
    }

    /// Inertia along turned axes: `R I R^T`.
    #[inline]
    #[must_use]
    pub fn turned(&self, rotation: &Matrix3<f64>) -> Self {
        let row = |index: usize| -> Vector3<f64> { rotation.row(index).transpose() };
        let (x, y, z) = (row(0), row(1), row(2));
        let (along_x, along_y) = (self.times(&x), self.times(&y));
        Self {
            xx: x.dot(&along_x),
            xy: y.dot(&along_x),
            xz: z.dot(&along_x),
            yy: y.dot(&along_y),
            yz: z.dot(&along_y),
            zz: z.dot(&self.times(&z)),
        }
    }

    /// The matrix times a vector.
    #[inline]
    #[must_use]
    pub fn times(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        let v = vector;
        Vector3::new(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }

    /// Sum of the diagonal.
    #[must_use]
    pub fn trace(&self) -> f64 {
        self.xx + self.yy + self.zz
    }

    /// Adds another matrix.
    #[inline]
    pub fn add(&mut self, other: &Self) {
        self.xx += other.xx;
        self.xy += other.xy;
        self.xz += other.xz;
        self.yy += other.yy;
        self.yz += other.yz;
        self.zz += other.zz;
    }
}

#[cfg(test)]
mod tests {
    use super::{Body, Symmetric};
    use nalgebra::{Matrix3, SymmetricEigen, Vector3};

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
    fn the_nearest_inertia_of_a_body_is_larger_and_stays() {
        for moments in [
            [0.01, 0.01, 0.0202],
            [0.1, 0.1, 0.6],
            [-0.01, 0.02, 0.02],
            [-1.0, -2.0, -3.0],
        ] {
            let given = body(moments);
            let nearest = given.nearest();
            assert!(given.violation() > 0.0 && nearest.checked().is_ok());
            let grown = SymmetricEigen::new(nearest.inertia - given.inertia).eigenvalues;
            assert!(grown.min() >= -1e-15);
            assert!((nearest.nearest().inertia - nearest.inertia).amax() <= 1e-16);
        }
        assert_eq!(body([1.0, 1.0, 2.0]).nearest(), body([1.0, 1.0, 2.0]));
        let nearest = body([0.1, 0.1, 0.6]).nearest().inertia;
        assert!((nearest - Matrix3::from_diagonal(&[0.3, 0.3, 0.6].into())).amax() < 1e-15);
        assert!((body([0.1, 0.1, 0.6]).violation() - 0.25).abs() < 1e-15);
        assert_eq!(body([-1.0, -2.0, -3.0]).violation(), f64::INFINITY);
    }

    #[test]
    fn symmetric_matrices_are_matrices() {
        let matrix = Matrix3::new(2.0, 0.3, -0.4, 0.3, 1.5, 0.2, -0.4, 0.2, 3.0);
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1);
        let expected = turn.matrix() * matrix * turn.matrix().transpose();
        let along = Vector3::new(0.2, 0.5, -0.9);
        let turned = Symmetric::of(&matrix).turned(turn.matrix());
        assert!((turned.times(&along) - expected * along).amax() < 1e-15);
        assert!((turned.trace() - 6.5).abs() < 1e-14);
        // A point mass at h, seen from r before it: its first moment about the middle is h + r/2.
        let (h, r) = (Vector3::new(0.1, 0.2, 0.3), Vector3::new(-0.4, 0.5, 0.6));
        let about = |p: Vector3<f64>| Matrix3::identity() * p.norm_squared() - p * p.transpose();
        let moved = Symmetric::moved(&(h + 0.5 * r), &r);
        let difference = about(h + r) - about(h);
        assert!((moved.times(&along) - difference * along).amax() < 1e-15);
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
