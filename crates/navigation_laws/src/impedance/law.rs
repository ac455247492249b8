//! Repulsive force of a collision vector.

use nalgebra::Vector2;

use numeric::error::{Failure, Given, Result, finite, positive};

/// Which law gives the repulsive force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// No repulsion.
    Off,
    /// (19-a): spring and damper inside the safe distance.
    Conventional,
    /// (20): spring and damper whose coefficients change with distance and speed.
    #[default]
    Active,
    /// (19-b) as printed: the factors of (19-a) stand beside the active coefficients once more.
    ActiveTwiceScaled,
}

/// Numbers of the law; which of them act depends on the form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impedance {
    /// The law.
    pub form: Form,
    /// Spring coefficient `K_0`, in N/m.
    pub stiffness: f64,
    /// Damping coefficient `D_0`, in N s/m.
    pub damping: f64,
    /// Safe distance `rho_0`, in m.
    pub safe_distance: f64,
    /// Largest approach speed `mu_0`, in m/s.
    pub speed_limit: f64,
    /// Reference spring coefficient `k_ref`, above `K_0`, in N/m.
    pub reference_stiffness: f64,
    /// Reference damping coefficient `d_ref`, below `D_0`, in N s/m.
    pub reference_damping: f64,
    /// No damping above the largest approach speed; otherwise the damping term pulls there.
    pub clamp: bool,
}

impl Default for Impedance {
    fn default() -> Self {
        let (stiffness, damping) = (40.0, 10.0);
        Self {
            form: Form::default(),
            stiffness,
            damping,
            safe_distance: 0.8,
            speed_limit: 0.72,
            reference_stiffness: std::f64::consts::E * stiffness,
            reference_damping: damping / std::f64::consts::E,
            clamp: true,
        }
    }
}

impl Impedance {
    /// Returns the numbers if they are valid.
    ///
    /// # Errors
    /// A number is not positive, `k_ref` not above `K_0`, or `d_ref` not below `D_0`.
    pub fn checked(self) -> Result<Self> {
        positive("stiffness", self.stiffness)?;
        positive("damping", self.damping)?;
        positive("safe_distance", self.safe_distance)?;
        positive("speed_limit", self.speed_limit)?;
        finite("reference_stiffness", self.reference_stiffness)?;
        if self.reference_stiffness <= self.stiffness {
            return Err(Failure::invalid(
                "reference_stiffness",
                "be above stiffness",
                Given::Number(self.reference_stiffness),
            ));
        }
        positive("reference_damping", self.reference_damping)?;
        if self.reference_damping >= self.damping {
            return Err(Failure::invalid(
                "reference_damping",
                "be below damping",
                Given::Number(self.reference_damping),
            ));
        }
        Ok(self)
    }

    /// `alpha = rho_0/(2 ln(k_ref/K_0))` in m, (21): the spring force at `rho_0/2` is that of
    /// `K_0`.
    #[must_use]
    pub fn distance_scale(&self) -> f64 {
        self.safe_distance / (2.0 * (self.reference_stiffness / self.stiffness).ln())
    }

    /// `beta = mu_0/(2 ln(D_0/d_ref))` in m/s, (22): the damping force at `mu_0/2` is that of
    /// `D_0`.
    #[must_use]
    pub fn speed_scale(&self) -> f64 {
        self.speed_limit / (2.0 * (self.damping / self.reference_damping).ln())
    }

    /// The law with what does not change computed once.
    #[must_use]
    pub fn prepared(&self) -> Prepared {
        Prepared {
            law: *self,
            alpha: self.distance_scale(),
            beta: self.speed_scale(),
        }
    }
}

/// A law with its two scales.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prepared {
    law: Impedance,
    alpha: f64,
    beta: f64,
}

impl Prepared {
    /// Spring part of the force in N, away from the obstacle, at a distance `||C||` in m.
    #[inline]
    #[must_use]
    pub fn spring(&self, distance: f64) -> f64 {
        let law = &self.law;
        let active = || law.reference_stiffness * (-distance / self.alpha).exp() * distance;
        match law.form {
            Form::Conventional if distance < law.safe_distance => {
                law.stiffness * (law.safe_distance - distance)
            }
            Form::Off | Form::Conventional => 0.0,
            Form::Active => active(),
            Form::ActiveTwiceScaled => active() * (law.safe_distance - distance),
        }
    }

    /// Damping part of the force in N, away from the obstacle, at a speed `||C'||` in m/s.
    #[inline]
    #[must_use]
    pub fn damper(&self, distance: f64, speed: f64) -> f64 {
        let law = &self.law;
        let active = || {
            if law.clamp && speed > law.speed_limit {
                return 0.0;
            }
            law.reference_damping * (speed / self.beta).exp() * (law.speed_limit - speed)
        };
        match law.form {
            Form::Conventional if distance < law.safe_distance => law.damping * speed,
            Form::Off | Form::Conventional => 0.0,
            Form::Active => active(),
            Form::ActiveTwiceScaled => active() * speed,
        }
    }

    /// Force in N on the robot by one collision vector in m, along `u = -C/||C||`; none without a
    /// direction.
    #[inline]
    #[must_use]
    pub fn force(&self, vector: Vector2<f64>, speed: f64) -> Vector2<f64> {
        let distance = vector.dot(&vector).sqrt();
        if distance == 0.0 {
            return Vector2::zeros();
        }
        vector * (-(self.spring(distance) + self.damper(distance, speed)) / distance)
    }

    /// Force in N on a robot that knows the nearest point of every obstacle, `C` in m, and how it
    /// moves relative to the robot, `dC/dt` in m/s: ideal sensing, all forces added.
    #[must_use]
    pub fn force_of_points(
        &self,
        points: impl IntoIterator<Item = (Vector2<f64>, Vector2<f64>)>,
    ) -> Vector2<f64> {
        let mut sum = Vector2::zeros();
        for (vector, change) in points {
            let distance = vector.dot(&vector).sqrt();
            if distance > 0.0 {
                let rate = vector.dot(&change) / distance;
                sum += self.force(vector, (-rate).max(0.0));
            }
        }
        sum
    }
}
