//! Outcome of a collision.

/// End of a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CollisionStatus {
    /// The bodies parted.
    Released,
    /// They touched until the horizon.
    Horizon,
    /// They do not close in.
    NoImpact,
    /// The measured points of the law do not reach as far as the covering was compressed.
    BeyondData,
    /// Too many steps, or too short ones.
    Unfinished,
}

impl CollisionStatus {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Released,
        Self::Horizon,
        Self::NoImpact,
        Self::BeyondData,
        Self::Unfinished,
    ];

    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Released => "released",
            Self::Horizon => "horizon",
            Self::NoImpact => "no_impact",
            Self::BeyondData => "beyond_data",
            Self::Unfinished => "unfinished",
        }
    }
}

/// The motion at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionSample {
    /// Time, in s.
    pub time: f64,
    /// `eps`, in m.
    pub total_compression: f64,
    /// `eps'`, in m/s.
    pub closing_speed: f64,
    /// `d`, in m.
    pub covering_compression: f64,
    /// `delta`, in m.
    pub body_deflection: f64,
    /// `f`, in N.
    pub force: f64,
    /// `x_h'`, in m/s.
    pub body_speed: f64,
    /// `x_h''`, in m/s^2.
    pub body_acceleration: f64,
    /// `x_h'''`, in m/s^3.
    pub body_jerk: f64,
    /// Pressure at the apex of a curved contact, in Pa.
    pub apex_pressure: f64,
}

/// Loads of a collision; what does not exist is NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Way in which the collision ended.
    pub status: CollisionStatus,
    /// Time of the end, in s.
    pub release_time: f64,
    /// Largest force, in N.
    pub peak_force: f64,
    /// Time of the largest force, in s; NaN on a plateau.
    pub peak_force_time: f64,
    /// Largest `eps`, in m.
    pub peak_total_compression: f64,
    /// Largest `delta`, in m.
    pub peak_body_deflection: f64,
    /// Largest `d`, in m; NaN if bare.
    pub peak_covering_compression: f64,
    /// Largest strain; NaN if bare.
    pub peak_strain: f64,
    /// Largest pressure, in Pa; NaN if bare.
    pub peak_pressure: f64,
    /// `x_h' - x_r'` at release, in m/s; NaN without one.
    pub rebound_speed: f64,
    /// Largest acceleration of the body, in m/s^2; NaN if clamped.
    pub peak_body_acceleration: f64,
    /// Speed of the body at the end, in m/s; NaN if clamped.
    pub body_speed_end: f64,
    /// Head injury criterion in windows of 15 ms and of 36 ms; NaN if not asked for.
    pub injury: [f64; 2],
    /// Force at the end, in N.
    pub end_force: f64,
    /// Whether the backing was reached.
    pub bottomed: bool,
    /// Whether a load was largest at the horizon: its peak may come after it.
    pub rising: bool,
    /// The motion, if it was asked for.
    pub nodes: Vec<MotionSample>,
    /// Evaluations of the forces.
    pub evaluations: usize,
}

impl Outcome {
    /// Nothing happened, or nothing is known.
    #[must_use]
    pub fn nothing(status: CollisionStatus) -> Self {
        Self {
            status,
            release_time: f64::NAN,
            peak_force: f64::NAN,
            peak_force_time: f64::NAN,
            peak_total_compression: f64::NAN,
            peak_body_deflection: f64::NAN,
            peak_covering_compression: f64::NAN,
            peak_strain: f64::NAN,
            peak_pressure: f64::NAN,
            rebound_speed: f64::NAN,
            peak_body_acceleration: f64::NAN,
            body_speed_end: f64::NAN,
            injury: [f64::NAN; 2],
            end_force: f64::NAN,
            bottomed: false,
            rising: false,
            nodes: Vec::new(),
            evaluations: 0,
        }
    }

    /// Loads in the order of `allowed::LOADS`.
    #[must_use]
    pub fn loads(&self) -> [f64; 14] {
        [
            self.release_time,
            self.peak_force,
            self.peak_force_time,
            self.peak_total_compression,
            self.peak_body_deflection,
            self.peak_covering_compression,
            self.peak_strain,
            self.peak_pressure,
            self.rebound_speed,
            self.peak_body_acceleration,
            self.body_speed_end,
            self.injury[0],
            self.injury[1],
            self.end_force,
        ]
    }
}
