//! Three sensors side by side: from readings to the repulsive force.

use nalgebra::Vector2;

use crate::impedance::collision::{Pairing, collision_point, pair_echoes};
use crate::impedance::law::Prepared;
use crate::impedance::rate::{Rate, RateFilter};
use navigation_world::world::frame::Frame;
use numeric::error::Result;

/// How a collision vector is turned from the robot into the world, (15).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rotation {
    /// By the heading, counterclockwise.
    #[default]
    ByHeading,
    /// By the printed matrix, which turns the other way.
    Printed,
}

impl Rotation {
    /// A vector of the robot in the directions of the world.
    #[inline]
    #[must_use]
    pub fn to_world(self, pose: &Frame, vector: Vector2<f64>) -> Vector2<f64> {
        match self {
            Self::ByHeading => pose.outward(vector),
            Self::Printed => pose.inward(vector),
        }
    }
}

/// How readings become forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BankOptions {
    /// Which echoes belong together.
    pub pairing: Pairing,
    /// Speed of the collision vectors.
    pub rate: RateFilter,
    /// From the robot's axes to the world's.
    pub rotation: Rotation,
    /// Add the position of the sensors to the collision vector, the printed (16), in a world in
    /// which the place that positions are counted from lies here, in m.
    pub translated_by: Option<[f64; 2]>,
}

impl BankOptions {
    /// Returns the options if they are valid.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn checked(self) -> Result<Self> {
        self.pairing.checked()?;
        self.rate.checked()?;
        if let Some(place) = self.translated_by {
            numeric::error::finite_pair("translated_by", place)?;
        }
        Ok(self)
    }
}

/// Memory of three sensors: one speed estimate for the first, second and third collision vector.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bank {
    rates: [Rate; 3],
}

/// Three sensors, right to left, in the axes of their bank: x to the front, origin `P_0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BankLayout {
    /// Sensors relative to `P_0`.
    pub mounts: [Frame; 3],
}

impl BankLayout {
    /// Points of the echoes, `P_i = S_i + r_i (cos, sin)`, (11) and (13).
    #[inline]
    #[must_use]
    pub fn points(&self, readings: &[f64; 3]) -> [Vector2<f64>; 3] {
        std::array::from_fn(|index| collision_point(&self.mounts[index], readings[index]))
    }
}

impl Bank {
    /// Repulsive force in N on the robot in the world's axes. `pose`: origin and front of the
    /// bank; `timing`: step in s, and weight of a new sample in the speed filter.
    #[inline]
    pub fn force(
        &mut self,
        layout: &BankLayout,
        readings: &[f64; 3],
        pose: &Frame,
        law: &Prepared,
        options: &BankOptions,
        timing: (f64, f64),
    ) -> Vector2<f64> {
        let mut sum = Vector2::zeros();
        let points = layout.points(readings);
        let collisions = pair_echoes(&points, readings, &options.pairing);
        for (rate, collision) in self.rates.iter_mut().zip(collisions) {
            let Some(collision) = collision else {
                if !options.rate.outlives_gaps {
                    rate.reset();
                }
                continue;
            };
            let mut vector = options.rotation.to_world(pose, collision.vector);
            if let Some(place) = options.translated_by {
                vector += pose.position + Vector2::from(place);
            }
            let sample = (collision.case, vector);
            let speed = rate.update(&options.rate, sample, timing);
            sum += law.force(vector, speed);
        }
        sum
    }
}
