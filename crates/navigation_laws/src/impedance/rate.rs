//! Speed of a collision vector from its samples.

use nalgebra::Vector2;

use numeric::error::{Result, not_negative, positive};

/// Which speed stands for `||dC/dt||`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Speed {
    /// `max(0, -d||C||/dt)`: only what comes nearer.
    #[default]
    Closing,
    /// Norm of the change of the vector in the world, without sign.
    Norm,
}

/// First-order filter of the change of a collision vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateFilter {
    /// Quantity that is filtered.
    pub speed: Speed,
    /// Time constant, in s; no filter at zero.
    pub time_constant: f64,
    /// Faster changes between two samples are left out, in m/s.
    pub largest: f64,
    /// Whether the estimate outlives samples without an echo. It starts anew when the case of the
    /// collision vector changes and, by default, when the vector is lost for a sample: what was
    /// measured before the gap may be the speed of another part of the scene.
    pub outlives_gaps: bool,
}

impl Default for RateFilter {
    fn default() -> Self {
        Self {
            speed: Speed::default(),
            time_constant: 0.15,
            largest: 4.0,
            outlives_gaps: false,
        }
    }
}

impl RateFilter {
    /// Returns the numbers if they are valid.
    ///
    /// # Errors
    /// The time constant is negative or the largest change not positive.
    pub fn checked(self) -> Result<Self> {
        not_negative("filter_time", self.time_constant)?;
        if self.largest != f64::INFINITY {
            positive("largest_rate", self.largest)?;
        }
        Ok(self)
    }

    /// Share of a new sample after a step in s: `1 - exp(-step/time constant)`.
    #[must_use]
    pub fn weight(&self, step: f64) -> f64 {
        if self.time_constant == 0.0 {
            1.0
        } else {
            -(-step / self.time_constant).exp_m1()
        }
    }
}

/// Speed estimate of one collision vector; starts anew when its case changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rate {
    case: Option<usize>,
    last: Option<Vector2<f64>>,
    filtered: Vector2<f64>,
}

impl Rate {
    /// Forgets everything.
    #[inline]
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Takes the vector (in the world's directions, m) of a new sample and its case, and gives the
    /// speed in m/s; zero at the first one.
    #[inline]
    pub fn update(
        &mut self,
        filter: &RateFilter,
        (case, vector): (usize, Vector2<f64>),
        (step, weight): (f64, f64),
    ) -> f64 {
        let length = |vector: Vector2<f64>| vector.dot(&vector).sqrt();
        if self.case != Some(case) {
            self.reset();
            self.case = Some(case);
        }
        // The distance alone is kept for the closing speed.
        let sample = match filter.speed {
            Speed::Closing => Vector2::new(length(vector), 0.0),
            Speed::Norm => vector,
        };
        if let Some(last) = self.last {
            let raw = (sample - last) / step;
            if raw.dot(&raw) <= filter.largest * filter.largest {
                self.filtered += (raw - self.filtered) * weight;
            }
        }
        self.last = Some(sample);
        match filter.speed {
            Speed::Closing => (-self.filtered.x).max(0.0),
            Speed::Norm => length(self.filtered),
        }
    }
}
