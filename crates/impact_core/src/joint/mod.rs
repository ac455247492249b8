//! A joint with a mechanical and a control compliance in series, and its reduction.

pub mod direct_drive;
pub mod drive;
pub mod effective;
pub mod motion;

use crate::error::{Failure, Given, Result, not_negative, positive};

/// A driven joint: transmission (mechanical) in series with the servo loop (control).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Inertia of what the joint moves, in kg m^2.
    pub inertia: f64,
    /// `K_m`, in N m/rad.
    pub mechanical_stiffness: f64,
    /// `C_m`, in N m s/rad.
    pub mechanical_damping: f64,
    /// `K_c`, in N m/rad.
    pub control_stiffness: f64,
    /// `C_c`, in N m s/rad.
    pub control_damping: f64,
}

impl Joint {
    /// Returns the joint if its values are valid.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        positive("inertia", self.inertia)?;
        positive("mechanical_stiffness", self.mechanical_stiffness)?;
        not_negative("mechanical_damping", self.mechanical_damping)?;
        positive("control_stiffness", self.control_stiffness)?;
        not_negative("control_damping", self.control_damping)?;
        Ok(self)
    }

    /// Reduced stiffness `K_J = K_m K_c / (K_m + K_c)`, in N m/rad.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        let sum = self.mechanical_stiffness + self.control_stiffness;
        self.mechanical_stiffness * (self.control_stiffness / sum)
    }

    /// Reduced damping `C_J = (K_c^2 C_m + K_m^2 C_c) / (K_m + K_c)^2`, in N m s/rad.
    #[must_use]
    pub fn damping(&self) -> f64 {
        let sum = self.mechanical_stiffness + self.control_stiffness;
        let (control, mechanical) = (
            self.control_stiffness / sum,
            self.mechanical_stiffness / sum,
        );
        control * control * self.mechanical_damping + mechanical * mechanical * self.control_damping
    }

    /// Relative error `|exact - reduced| / |exact|` of the reduced joint at an angular frequency,
    /// in rad/s.
    ///
    /// The exact joint is the series of both, `Z_m Z_c / (Z_m + Z_c)` with `Z = K + C s`; it
    /// differs from `K_J + C_J s` by
    /// `-(K_c C_m - K_m C_c)^2 s^2 / {(K_m + K_c)^2 [(K_m + K_c) + (C_m + C_c) s]}`.
    ///
    /// # Errors
    /// The frequency is negative or not finite.
    pub fn model_error(&self, frequency: f64) -> Result<f64> {
        not_negative("frequency", frequency)?;
        let sum = self.mechanical_stiffness + self.control_stiffness;
        let mismatch = (self.control_stiffness * self.mechanical_damping
            - self.mechanical_stiffness * self.control_damping)
            / sum;
        // The factor (K_m + K_c) + (C_m + C_c) s of both cancels in the ratio.
        let error = (mismatch * frequency).powi(2);
        let magnitude = |stiffness: f64, damping: f64| stiffness.hypot(damping * frequency);
        let exact = magnitude(self.mechanical_stiffness, self.mechanical_damping)
            * magnitude(self.control_stiffness, self.control_damping);
        let ratio = error / exact;
        if ratio.is_finite() {
            Ok(ratio)
        } else {
            Err(Failure::invalid(
                "frequency",
                "be within the range of double numbers",
                Given::Number(frequency),
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(mechanical_stiffness: f64, mechanical_damping: f64) -> Joint {
        Joint {
            inertia: 0.1,
            mechanical_stiffness,
            mechanical_damping,
            control_stiffness: 121.68,
            control_damping: 1.521,
        }
    }

    #[test]
    fn errors_of_the_specification() {
        let stiff = joint(1216.8, 0.0).model_error(95.0).unwrap();
        let equal = joint(121.68, 0.0).model_error(95.0).unwrap();
        assert!((stiff - 0.075).abs() < 5e-4, "{stiff}");
        assert!((equal - 0.23).abs() < 5e-3, "{equal}");
    }

    #[test]
    fn equal_time_constants_reduce_exactly() {
        let joint = joint(243.36, 3.042);
        assert_eq!(joint.model_error(95.0).unwrap(), 0.0);
        assert!((joint.damping() / joint.stiffness() - 0.0125).abs() < 1e-15);
    }

    #[test]
    fn error_equals_the_difference_of_complex_impedances() {
        let joint = joint(500.0, 0.7);
        let omega = 60.0;
        let divide = |a: [f64; 2], b: [f64; 2]| {
            let n = b[0] * b[0] + b[1] * b[1];
            [
                (a[0] * b[0] + a[1] * b[1]) / n,
                (a[1] * b[0] - a[0] * b[1]) / n,
            ]
        };
        let times =
            |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
        let m = [joint.mechanical_stiffness, joint.mechanical_damping * omega];
        let c = [joint.control_stiffness, joint.control_damping * omega];
        let exact = divide(times(m, c), [m[0] + c[0], m[1] + c[1]]);
        let reduced = [joint.stiffness(), joint.damping() * omega];
        let error = (exact[0] - reduced[0]).hypot(exact[1] - reduced[1]) / exact[0].hypot(exact[1]);
        assert!((joint.model_error(omega).unwrap() - error).abs() < 1e-12);
    }
}
