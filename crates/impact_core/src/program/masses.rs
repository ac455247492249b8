//! The mass that a point brings along in a motion of its arm, without a direction in which it is unbounded.
//!
//! With the velocity `v = J dq`, its direction `u` and the mobility `L = J M^-1 J^T` three masses stand one below the
//! other: `1/(u^T L u)` where the normal of the contact is along the motion, `u^T L^+ u` where it is the worst one,
//! which maximizes `(v^T n)^2/(n^T L n)`, and `dq^T M dq/|v|^2` with all kinetic energy.

use nalgebra::{Matrix3, Vector3};

use crate::arm::pose::Pose;

/// A speed below this share of what rounding errors belong to is zero.
const STANDING: f64 = 1e-12;

/// A direction of motion that is shorter than this share of the longest one is rounding error.
const LOST: f64 = 1e-9;

/// A point in a motion of its arm.
#[derive(Clone, Copy, Debug)]
pub struct PointMotion {
    /// Velocity (m/s), zero where nothing but rounding error moves the point.
    pub velocity: Vector3<f64>,
    /// Its length.
    pub speed: f64,
    /// Effective mass with the normal along the motion (kg). Masses are NaN where the point stands still.
    pub along_motion: f64,
    /// Effective mass with the worst normal (kg).
    pub worst_normal: f64,
    /// Mass that holds all kinetic energy of the arm at the speed of the point (kg).
    pub energy: f64,
    mobility: Matrix3<f64>,
}

impl PointMotion {
    /// The motion of a point of a link; `weights` are those of the rates.
    #[must_use]
    pub fn of<const N: usize>(
        pose: &Pose<'_, N>,
        (link, point): (usize, &Vector3<f64>),
        rates: &[f64],
        weights: &[f64; N],
    ) -> Self {
        let (velocity, scale) = pose.velocity_and_scale(link, point, rates);
        let speed = velocity.norm();
        if speed <= STANDING * scale {
            return Self {
                velocity: Vector3::zeros(),
                speed: 0.0,
                along_motion: f64::NAN,
                worst_normal: f64::NAN,
                energy: f64::NAN,
                mobility: Matrix3::zeros(),
            };
        }
        let levers = pose.levers(link, point);
        let unit = velocity / speed;
        let mut mobility = Matrix3::zeros();
        for lever in &levers {
            mobility += lever * lever.transpose();
        }
        let scaled = weights.map(|weight| weight / speed);
        let energy: f64 = scaled.iter().map(|weight| weight * weight).sum();
        // Each is below the next one but for rounding errors.
        let worst_normal = held(&levers, &scaled).min(energy);
        let along_motion = unit.dot(&(mobility * unit)).recip().min(worst_normal);
        Self {
            velocity,
            speed,
            along_motion,
            worst_normal,
            energy,
            mobility,
        }
    }

    /// Reduced mass of the point and a body with the normal along the motion (kg); an infinite body is clamped.
    #[must_use]
    pub fn reduced_along(&self, body_mass: f64) -> f64 {
        (self.along_motion.recip() + body_mass.recip()).recip()
    }

    /// Reduced mass with the worst normal (kg): `u^T (L + I/m)^-1 u`.
    #[must_use]
    pub fn reduced_worst(&self, body_mass: f64) -> f64 {
        if body_mass == f64::INFINITY || self.speed == 0.0 {
            return self.worst_normal;
        }
        let unit = self.velocity / self.speed;
        let both = self.mobility + Matrix3::identity() * body_mass.recip();
        let found = both
            .cholesky()
            .map_or(self.worst_normal, |root| unit.dot(&root.solve(&unit)));
        found.min(self.worst_normal)
    }
}

/// Squared part of a motion that acts on the point: `|P w|^2` with the projection `P` on the space of the rows of
/// `A`, which is `v^T (A A^T)^+ v` without the square of small numbers. The rows are made perpendicular, the longest
/// one first.
fn held<const N: usize>(levers: &[Vector3<f64>; N], weights: &[f64; N]) -> f64 {
    let mut rows: [[f64; N]; 3] = std::array::from_fn(|axis| levers.map(|lever| lever[axis]));
    let dot = |one: &[f64; N], other: &[f64; N]| -> f64 {
        one.iter().zip(other).map(|(a, b)| a * b).sum()
    };
    let (mut found, mut longest) = (0.0, 0.0_f64);
    for done in 0..3 {
        let mut norm = 0.0;
        for row in done..3 {
            let square = dot(&rows[row], &rows[row]);
            if square > norm {
                norm = square;
                rows.swap(done, row);
            }
        }
        let norm = norm.sqrt();
        longest = longest.max(norm);
        if norm <= LOST * longest {
            break;
        }
        let unit = rows[done].map(|value| value / norm);
        let part = dot(&unit, weights);
        found += part * part;
        for row in &mut rows[done + 1..] {
            let share = dot(row, &unit);
            for (value, along) in row.iter_mut().zip(&unit) {
                *value -= share * along;
            }
        }
    }
    found
}
