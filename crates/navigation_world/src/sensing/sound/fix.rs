//! Where the sound is: exact range and bearing from two delays, with their uncertainty.

use super::microphones::MicrophoneArray;

/// How a fix came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixStatus {
    /// Range and bearing are known.
    Fix,
    /// A delay is not a number: nothing was measured.
    NoDelay,
    /// A delay is longer than the way between its microphones.
    TooLong,
    /// The wave front is not curved as that of a source in front would be.
    NoCurvature,
}

impl FixStatus {
    /// Every status, in the order of their codes.
    pub const ALL: [Self; 4] = [Self::Fix, Self::NoDelay, Self::TooLong, Self::NoCurvature];

    /// Word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Fix => "fix",
            Self::NoDelay => "no_delay",
            Self::TooLong => "delay_too_long",
            Self::NoCurvature => "no_curvature",
        }
    }
}

/// Symmetric matrix of two rows: `[[first, mixed], [mixed, second]]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covariance {
    /// Variance of the first quantity.
    pub first: f64,
    /// Covariance.
    pub mixed: f64,
    /// Variance of the second quantity.
    pub second: f64,
}

impl Covariance {
    const UNKNOWN: Self = Self {
        first: f64::NAN,
        mixed: f64::NAN,
        second: f64::NAN,
    };

    /// Covariance of the two delays (s^2) when each of the three arrivals jitters by itself.
    #[must_use]
    pub fn of_arrivals(deviation: f64) -> Self {
        let variance = deviation * deviation;
        Self {
            first: 2.0 * variance,
            mixed: variance,
            second: 2.0 * variance,
        }
    }

    /// Covariance of two linear functions with these gradients.
    fn carried(&self, one: [f64; 2], other: [f64; 2]) -> Self {
        let product = |a: [f64; 2], b: [f64; 2]| {
            a[0] * b[0] * self.first
                + (a[0] * b[1] + a[1] * b[0]) * self.mixed
                + a[1] * b[1] * self.second
        };
        Self {
            first: product(one, one),
            mixed: product(one, other),
            second: product(other, other),
        }
    }
}

/// Range and bearing of a source; NaN unless the status is a fix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fix {
    /// Range from M2, in m.
    pub range: f64,
    /// Bearing, in rad.
    pub bearing: f64,
    /// Covariance of range (m) and bearing (rad), to first order.
    pub covariance: Covariance,
    /// `c (t_1 - 2 t_2 + t_3)`, in m.
    pub curvature: f64,
    /// Status of the localization.
    pub status: FixStatus,
}

impl Fix {
    fn none(status: FixStatus, curvature: f64) -> Self {
        Self {
            range: f64::NAN,
            bearing: f64::NAN,
            covariance: Covariance::UNKNOWN,
            curvature,
            status,
        }
    }
}

/// Range and bearing from the delays of M2 and M3 against M1 (s), and the delays' covariance (s^2).
///
/// Equal areas of the triangles M1 M2 S and M2 M3 S, (8), give `R1^2 + R3^2 = 2 R2^2 + 2 l^2`, and so
/// the corrected (9), `R1 = [2 l^2 + 2 (c dt12)^2 - (c dt13)^2] / [2 c (dt13 - 2 dt12)]`. The bearing
/// is exact too: `sin th = (R1^2 - R3^2) / (4 l R2)` in place of the parallel rays of (10).
#[must_use]
pub fn locate(array: &MicrophoneArray, delays: [f64; 2], delays_covariance: &Covariance) -> Fix {
    let (l, c) = (array.spacing, array.speed_of_sound);
    let [a, b] = delays.map(|delay| c * delay);
    let curvature = b - 2.0 * a;
    if a.is_nan() || b.is_nan() {
        return Fix::none(FixStatus::NoDelay, f64::NAN);
    }
    if a.abs() > l || (b - a).abs() > l || b.abs() > 2.0 * l {
        return Fix::none(FixStatus::TooLong, curvature);
    }
    if curvature <= 0.0 {
        return Fix::none(FixStatus::NoCurvature, curvature);
    }
    let r1 = (2.0 * l * l + 2.0 * a * a - b * b) / (2.0 * curvature);
    let (r2, r3) = (r1 + a, r1 + b);
    let sin = -b * (r1 + r3) / (4.0 * l * r2);
    let bearing = sin.asin();
    if !(r2.is_finite() && r2 > 0.0 && bearing.is_finite()) {
        return Fix::none(FixStatus::NoCurvature, curvature);
    }
    // Derivatives by a and b.
    let d_r1 = [2.0 * r2 / curvature, -r3 / curvature];
    let d_range = [d_r1[0] + 1.0, d_r1[1]];
    let d_side = [-b * d_r1[0] / (2.0 * l), -(b * d_r1[1] + r3) / (2.0 * l)];
    let cos = bearing.cos();
    let d_bearing = [0, 1].map(|i| (d_side[i] - sin * d_range[i]) / (r2 * cos));
    Fix {
        range: r2,
        bearing,
        covariance: delays_covariance.carried(d_range.map(|d| c * d), d_bearing.map(|d| c * d)),
        curvature,
        status: FixStatus::Fix,
    }
}

/// Range from (9) as it is printed, in m: `[l^2 + l c (dt12 + dt13) - c^2 (dt12^2 + dt12 dt13 +
/// dt13^2)] / [2 c (dt12 + dt13)]`. It is wrong, whichever microphone it is taken for; kept to be
/// shown beside the right one.
#[must_use]
pub fn printed_range(array: &MicrophoneArray, delays: [f64; 2]) -> f64 {
    let l = array.spacing;
    let [a, b] = delays.map(|delay| array.speed_of_sound * delay);
    (l * l + l * (a + b) - (a * a + a * b + b * b)) / (2.0 * (a + b))
}
