//! Effective mass, damping and stiffness at the impact point.

use nalgebra::{Cholesky, Matrix2, Vector2};

use crate::error::{Failure, Given, Result, finite, not_negative, positive};
use crate::parameters::Manipulator;

/// One moving joint that hits at a lever arm (scenarios 1 and 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneJoint {
    /// Inertia about the joint, in kg m^2.
    pub inertia: f64,
    /// Damping of the joint `C_J`, in N m s/rad.
    pub damping: f64,
    /// Stiffness of the joint `K_J`, in N m/rad.
    pub stiffness: f64,
    /// Lever arm `l`, in m.
    pub lever_arm: f64,
}

/// Joints 2 and 3 in a vertical plane (scenario 3), hitting normal to link 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoJoints {
    /// Mass matrix at the elbow angle, in kg m^2.
    pub mass_matrix: [[f64; 2]; 2],
    /// Damping of the joints, in N m s/rad.
    pub damping: [f64; 2],
    /// Stiffness of the joints, in N m/rad.
    pub stiffness: [f64; 2],
    /// Length `a_2` of link 2, in m.
    pub second_link: f64,
    /// Distance `l_3` from joint 3 to the impact point, in m.
    pub lever_arm: f64,
    /// Elbow angle `theta_3`, 0 stretched, in rad.
    pub elbow: f64,
}

/// Two uniform links.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformLinks {
    /// Masses of links 2 and 3, in kg.
    pub mass: [f64; 2],
    /// Lengths `a_2`, `a_3`, in m.
    pub length: [f64; 2],
}

impl OneJoint {
    /// `M_r = m / l^2`, `C_r = C_J / l^2`, `K_r = K_J / l^2`.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn manipulator(&self) -> Result<Manipulator> {
        positive("inertia", self.inertia)?;
        not_negative("damping", self.damping)?;
        not_negative("stiffness", self.stiffness)?;
        positive("lever_arm", self.lever_arm)?;
        let square = self.lever_arm * self.lever_arm;
        Manipulator {
            mass: self.inertia / square,
            damping: self.damping / square,
            stiffness: self.stiffness / square,
        }
        .checked()
    }
}

impl UniformLinks {
    /// Mass matrix at an elbow angle, in rad. Its off-diagonal is
    /// `m_3 a_3^2 / 3 + m_3 a_2 a_3 cos(theta_3) / 2`.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn mass_matrix(&self, elbow: f64) -> Result<[[f64; 2]; 2]> {
        for (name, value) in [
            ("mass", self.mass[0]),
            ("mass", self.mass[1]),
            ("length", self.length[0]),
            ("length", self.length[1]),
        ] {
            positive(name, value)?;
        }
        finite("elbow", elbow)?;
        let [m2, m3] = self.mass;
        let [a2, a3] = self.length;
        let coupling = 0.5 * m3 * a2 * a3 * elbow.cos();
        let outer = m3 * a3 * a3 / 3.0;
        let inner = m2 * a2 * a2 / 3.0 + m3 * a2 * a2 + outer + 2.0 * coupling;
        Ok([[inner, outer + coupling], [outer + coupling, outer]])
    }
}

/// Geometry of the impact point of two joints, on which its speed depends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Length of the second link `a_2`, in m.
    pub second_link: f64,
    /// Distance of the impact point from joint 3 `l_3`, in m.
    pub lever_arm: f64,
    /// Elbow angle `theta_3`, in rad; 0 is stretched.
    pub elbow: f64,
}

impl Reach {
    /// Lever arms of the joints, `J = [a_2 cos(theta_3) + l_3, l_3]`, in m.
    #[must_use]
    pub fn jacobian(&self) -> [f64; 2] {
        [
            self.second_link * self.elbow.cos() + self.lever_arm,
            self.lever_arm,
        ]
    }

    /// Springs or dashpots of the two joints in series at the impact point, (3.4.28) and (3.4.29):
    /// `1 / sum(J_i^2 / c_i)`.
    #[must_use]
    pub fn in_series(&self, coefficients: [f64; 2]) -> f64 {
        let [j1, j2] = self.jacobian();
        1.0 / (j1 * (j1 / coefficients[0]) + j2 * (j2 / coefficients[1]))
    }

    /// Damping of the impact point with the dashpots alone in series, the printed (3.4.29), in
    /// N s/m. [`TwoJoints::manipulator`] has the one that is consistent with the springs; both agree
    /// for equal ratios of damping and stiffness.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn dashpots_in_series(&self, damping: [f64; 2]) -> Result<f64> {
        not_negative("second_link", self.second_link)?;
        positive("lever_arm", self.lever_arm)?;
        finite("elbow", self.elbow)?;
        for each in damping {
            positive("damping", each)?;
        }
        Ok(self.in_series(damping))
    }

    /// Speed `v_r = J theta'` of the impact point for rates of the joints, in rad/s.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn speed(&self, rates: [f64; 2]) -> Result<f64> {
        not_negative("second_link", self.second_link)?;
        positive("lever_arm", self.lever_arm)?;
        finite("elbow", self.elbow)?;
        let [first, second] = self.jacobian();
        Ok(first * finite("rates", rates[0])? + second * finite("rates", rates[1])?)
    }
}

impl TwoJoints {
    /// Geometry of the impact point.
    #[must_use]
    pub fn reach(&self) -> Reach {
        Reach {
            second_link: self.second_link,
            lever_arm: self.lever_arm,
            elbow: self.elbow,
        }
    }

    /// Lever arms of the joints, in m.
    #[must_use]
    pub fn jacobian(&self) -> [f64; 2] {
        self.reach().jacobian()
    }

    /// `M_r = 1 / (J M^-1 J^T)`, `K_r = 1 / (J K^-1 J^T)` and
    /// `C_r = K_r^2 J K^-1 C K^-1 J^T`, the form that the reduction of a joint has.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn manipulator(&self) -> Result<Manipulator> {
        let [[m11, m12], [m21, m22]] = self.mass_matrix;
        for value in [m11, m12, m21, m22] {
            finite("mass_matrix", value)?;
        }
        let factor = Cholesky::new(Matrix2::from(self.mass_matrix)).filter(|_| m12 == m21);
        let Some(factor) = factor else {
            let rule = "be symmetric and positive definite";
            let given = Given::Found(format!("{:?}", self.mass_matrix).into());
            return Err(Failure::invalid("mass_matrix", rule, given));
        };
        for (damping, stiffness) in self.damping.into_iter().zip(self.stiffness) {
            not_negative("damping", damping)?;
            positive("stiffness", stiffness)?;
        }
        positive("second_link", self.second_link)?;
        positive("lever_arm", self.lever_arm)?;
        finite("elbow", self.elbow)?;
        let [j1, j2] = self.jacobian();
        let arms = Vector2::new(j1, j2);
        let mobility = arms.dot(&factor.solve(&arms));
        let [c1, c2] = [j1 / self.stiffness[0], j2 / self.stiffness[1]];
        let stiffness = self.reach().in_series(self.stiffness);
        let damping = c1 * c1 * self.damping[0] + c2 * c2 * self.damping[1];
        Manipulator {
            mass: 1.0 / mobility,
            damping: stiffness * stiffness * damping,
            stiffness,
        }
        .checked()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arm(elbow: f64) -> TwoJoints {
        let links = UniformLinks {
            mass: [17.4, 4.8],
            length: [0.432, 0.433],
        };
        TwoJoints {
            mass_matrix: links.mass_matrix(elbow).unwrap(),
            damping: [40.0, 10.0],
            stiffness: [8000.0, 1500.0],
            second_link: 0.432,
            lever_arm: 0.4,
            elbow,
        }
    }

    #[test]
    fn a_stretched_arm_has_the_stiffness_of_the_source() {
        let arm = arm(0.0);
        let [k2, k3] = arm.stiffness;
        let reach = arm.second_link + arm.lever_arm;
        let expected = k2 * k3 / (reach * reach * k3 + arm.lever_arm.powi(2) * k2);
        let stiffness = arm.manipulator().unwrap().stiffness;
        assert!((stiffness / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn effective_mass_is_least_when_stretched() {
        let stretched = arm(0.0).manipulator().unwrap().mass;
        for elbow in [0.3, 0.8, 1.3] {
            assert!(arm(elbow).manipulator().unwrap().mass > stretched);
        }
    }

    #[test]
    fn equal_time_constants_damp_like_one_joint() {
        let mut arm = arm(0.5);
        arm.damping = arm.stiffness.map(|stiffness| 0.01 * stiffness);
        let manipulator = arm.manipulator().unwrap();
        assert!((manipulator.damping / manipulator.stiffness - 0.01).abs() < 1e-15);
    }

    #[test]
    fn direct_drive_at_its_lever_arm_is_manipulator_one() {
        let joint = OneJoint {
            inertia: 9.6 * 0.078 * 0.078,
            damping: 1.521,
            stiffness: 121.68,
            lever_arm: 0.078,
        };
        let manipulator = joint.manipulator().unwrap();
        assert!((manipulator.mass - 9.6).abs() < 1e-12);
        assert!((manipulator.damping - 250.0).abs() < 1e-10);
        assert!((manipulator.stiffness - 20e3).abs() < 1e-8);
    }

    #[test]
    fn an_indefinite_mass_matrix_is_refused() {
        let mut arm = arm(0.0);
        arm.mass_matrix = [[1.0, 2.0], [2.0, 1.0]];
        assert!(arm.manipulator().is_err());
    }
}
