//! The row of microphones, and what follows from its geometry alone.

use numeric::error::{Result, positive};

/// Lags that a search looks at beyond the longest possible delay, on either side: a peak must have
/// neighbors for its interpolation, and noise may move it a little out of what geometry allows.
const SPARE_LAGS: usize = 2;

/// Three microphones in a row, evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MicrophoneArray {
    /// Distance of neighbors `l`, in m.
    pub spacing: f64,
    /// Speed of sound `c`, in m/s.
    pub speed_of_sound: f64,
}

/// Two of the three microphones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MicrophonePair {
    /// M1 and M2.
    First,
    /// M2 and M3.
    Second,
    /// M1 and M3.
    Outer,
}

impl MicrophonePair {
    /// Distance of the two in spacings.
    #[must_use]
    pub fn spacings(self) -> f64 {
        match self {
            Self::First | Self::Second => 1.0,
            Self::Outer => 2.0,
        }
    }

    /// Delay of the pair from those of M2 and M3 against M1.
    #[must_use]
    pub fn delay(self, [delay_12, delay_13]: [f64; 2]) -> f64 {
        match self {
            Self::First => delay_12,
            Self::Second => delay_13 - delay_12,
            Self::Outer => delay_13,
        }
    }
}

impl MicrophoneArray {
    /// The array, if its numbers can be.
    ///
    /// # Errors
    /// A number is not finite and positive.
    pub fn checked(self) -> Result<Self> {
        positive("spacing", self.spacing)?;
        positive("speed_of_sound", self.speed_of_sound)?;
        Ok(self)
    }

    /// Distances of M1, M2, M3 from a source at a range from M2 (m) and a bearing (rad), in m.
    #[must_use]
    pub fn distances(&self, range: f64, bearing: f64) -> [f64; 3] {
        let (sin, cos) = bearing.sin_cos();
        let (x, y) = (range * cos, range * sin);
        [-1.0, 0.0, 1.0].map(|place| x.hypot(y - place * self.spacing))
    }

    /// Angles at M1, M2, M3 between the row, towards M3, and a source at a range from M2 (m) and a
    /// bearing (rad), in rad: corrected (9) to (11) of 2017, `asin(h / R_i)` or `pi - asin(h / R_i)`
    /// with the normal distance `h` and the range `R_i` of the microphone. They hold for a source in
    /// front, the bearing below a quarter turn.
    #[must_use]
    pub fn elevations(&self, range: f64, bearing: f64) -> [f64; 3] {
        let normal = range * bearing.cos();
        let side = range * bearing.sin();
        let ranges = self.distances(range, bearing);
        [(-1.0, 0), (0.0, 1), (1.0, 2)].map(|(place, index): (f64, usize)| {
            let angle = (normal / ranges[index]).min(1.0).asin();
            if side >= place * self.spacing {
                angle
            } else {
                std::f64::consts::PI - angle
            }
        })
    }

    /// Delays of M2 and M3 against M1 in s, `dt_1i = t_i - t_1` of (7).
    #[must_use]
    pub fn delays(&self, range: f64, bearing: f64) -> [f64; 2] {
        let [first, second, third] = self.distances(range, bearing);
        [second - first, third - first].map(|difference| difference / self.speed_of_sound)
    }

    /// Bearing of a source that is far away from the delay of one pair (s), corrected (10):
    /// `-asin(c dt / d)` with the distance `d` of the two; NaN if the delay is longer than `d / c`.
    #[must_use]
    pub fn parallel_ray_bearing(&self, pair: MicrophonePair, delay: f64) -> f64 {
        -(self.speed_of_sound * delay / (pair.spacings() * self.spacing)).asin()
    }

    /// Largest lag on either side that M2 and M3 may have against M1, in samples.
    #[must_use]
    pub fn lag_limits(&self, sample_rate: f64) -> [usize; 2] {
        let samples = (self.spacing * sample_rate / self.speed_of_sound).ceil();
        // Saturates for absurd rates; the search then refuses signals that are shorter.
        let limit = (samples as usize).saturating_add(SPARE_LAGS);
        [limit, limit.saturating_mul(2)]
    }
}
