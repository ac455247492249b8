//! The criteria of an impact: one list with names, units and symbols, and the rows made of it.

mod missing;

use std::ops::{Deref, DerefMut};

use crate::error::{Result, finite, positive};
use crate::parameters::{Foam, GRAVITY};

pub use missing::Missing;

/// Widths of the windows of the head injury criteria, in s.
pub const INJURY_WINDOWS: [f64; 2] = [0.015, 0.036];
/// Width of the windows of the 3 ms criteria, in s.
pub const HELD_WINDOW: f64 = 0.003;
/// Default time without release after which an impact counts as lasting, in s.
pub const FREE_HORIZON: f64 = 0.2;
/// Default time over which a constrained impact is evaluated, in s.
pub const CONSTRAINED_HORIZON: f64 = 0.05;

/// Searches along a response.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools)] // each is asked for by itself
pub struct Searches {
    /// Largest acceleration of the head.
    pub acceleration: bool,
    /// Largest contact force.
    pub force: bool,
    /// Largest compression, which the status needs.
    pub compression: bool,
    /// Mean acceleration.
    pub mean: bool,
    /// Windows of the injury criteria.
    pub injury: [bool; 2],
    /// Windows of 3 ms.
    pub held: bool,
    /// Powers.
    pub powers: bool,
}

impl Searches {
    /// All searches.
    pub const ALL: Self = Self {
        acceleration: true,
        force: true,
        compression: true,
        mean: true,
        injury: [true; 2],
        held: true,
        powers: true,
    };

    /// Nothing.
    const NONE: Self = Self {
        acceleration: false,
        force: false,
        compression: false,
        mean: false,
        injury: [false; 2],
        held: false,
        powers: false,
    };

    /// The searches with that of one more criterion.
    #[must_use]
    fn with(mut self, search: Search) -> Self {
        match search {
            Search::Duration => {}
            Search::Acceleration => self.acceleration = true,
            Search::Force => self.force = true,
            Search::Compression => self.compression = true,
            Search::Mean => self.mean = true,
            Search::Injury15 => self.injury[0] = true,
            Search::Injury36 => self.injury[1] = true,
            Search::Held => self.held = true,
            Search::Powers => self.powers = true,
        }
        self
    }

    /// Whether nothing but peaks and the mean is wanted.
    #[must_use]
    pub fn only_peaks(self) -> bool {
        !(self.windows() || self.powers)
    }

    /// Whether any window is wanted.
    #[must_use]
    pub fn windows(self) -> bool {
        self.held || self.injury != [false; 2]
    }
}

/// Quantity from which a criterion follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Search {
    /// The impact period, which is always known.
    Duration,
    /// Largest acceleration.
    Acceleration,
    /// Largest contact force.
    Force,
    /// Largest compression.
    Compression,
    /// Mean acceleration.
    Mean,
    /// Windows up to 15 ms.
    Injury15,
    /// Windows up to 36 ms.
    Injury36,
    /// Windows of 3 ms.
    Held,
    /// Powers.
    Powers,
}

impl Search {
    /// Whether the peaks and the impact period are enough for it.
    const fn is_peak(self) -> bool {
        matches!(
            self,
            Self::Duration | Self::Acceleration | Self::Force | Self::Compression
        )
    }
}

/// Name, label, unit and symbol of a criterion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Criterion {
    /// Its name, in every language and file.
    pub name: &'static str,
    /// Its meaning, in words.
    pub label: &'static str,
    /// Its unit; empty where the source gives numbers without one.
    pub unit: &'static str,
    /// Its symbol in the source; empty without one.
    pub symbol: &'static str,
    /// Whether the peaks alone give it, without the course of the acceleration.
    pub is_peak: bool,
}

macro_rules! criteria {
    ($($field:ident: $label:literal, $unit:literal, $symbol:literal, $search:ident;)*) => {
        /// A value for each criterion: a number, a number for each lane, a column, derivatives.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Loads<T> {
            $(#[doc = concat!("The ", $label, " (", $unit, ").")] pub $field: T,)*
        }

        /// All criteria, in the order of rows.
        pub const CRITERIA: [Criterion; count!($($field)*)] = [$(Criterion {
            name: stringify!($field),
            label: $label,
            unit: $unit,
            symbol: $symbol,
            is_peak: Search::$search.is_peak(),
        },)*];

        impl<T> Loads<T> {
            /// A value of each criterion from what is known about it.
            #[inline(always)]
            #[must_use]
            pub fn of(mut value: impl FnMut(&Criterion) -> T) -> Self {
                let mut known = CRITERIA.iter();
                // The list has one entry for each field.
                let mut next = || value(known.next().unwrap_or(&CRITERIA[0]));
                Self { $($field: next(),)* }
            }

            /// Does something with each value and the other one of the same criterion.
            #[inline(always)]
            pub fn each_with<U>(self, other: Loads<U>, mut work: impl FnMut(T, U)) {
                $(work(self.$field, other.$field);)*
            }

            /// The values in the order of rows.
            #[inline(always)]
            #[must_use]
            pub fn into_array(self) -> [T; CRITERIA.len()] {
                [$(self.$field,)*]
            }

            /// A function of each value.
            #[inline(always)]
            #[must_use]
            pub fn map<U>(self, mut function: impl FnMut(T) -> U) -> Loads<U> {
                Loads { $($field: function(self.$field),)* }
            }

            /// Each value by shared reference.
            #[inline(always)]
            #[must_use]
            pub fn each_ref(&self) -> Loads<&T> {
                Loads { $($field: &self.$field,)* }
            }

            /// Each value by reference.
            #[inline(always)]
            pub fn as_mut(&mut self) -> Loads<&mut T> {
                Loads { $($field: &mut self.$field,)* }
            }
        }

        impl Loads<bool> {
            /// Searches that the criteria that are asked for need.
            #[must_use]
            fn searches(&self) -> Searches {
                let mut needed = Searches::NONE;
                $(if self.$field {
                    needed = needed.with(Search::$search);
                })*
                needed
            }
        }
    };
}

macro_rules! count {
    () => { 0 };
    ($head:ident $($tail:ident)*) => { 1 + count!($($tail)*) };
}

// To add a criterion is to add a line here, with what it follows from; the compiler then asks for it
// wherever loads are computed.
criteria! {
    peak_head_acceleration: "largest acceleration of the head", "m/s^2", "a_h,max", Acceleration;
    peak_head_acceleration_g: "largest acceleration of the head", "g", "a_h,max", Acceleration;
    mean_head_acceleration_g: "mean acceleration of the head over the impact", "g", "", Mean;
    peak_contact_force: "largest contact force", "N", "f_c,max", Force;
    max_compression: "largest compression of the foam", "m", "eps_max", Compression;
    impact_duration: "impact period, to the first zero of the head's acceleration", "s", "", Duration;
    hic15: "head injury criterion, windows up to 15 ms", "", "HIC", Injury15;
    hic36: "head injury criterion, windows up to 36 ms", "", "HIC", Injury36;
    average_3ms_g: "largest mean over 3 ms", "g", "", Held;
    clip_3ms_g: "largest level held for 3 ms", "g", "", Held;
    peak_power_manipulator: "largest power f_c x_r' from the manipulator into the foam", "W", "", Powers;
    peak_power_foam: "largest power f_c eps' of compression", "W", "", Powers;
}

/// Status of a row of metrics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The acceleration of the head came back to zero.
    Released,
    /// No release within the horizon; maxima are over the horizon.
    NoRelease,
    /// Released, but the foam was compressed beyond its linear range.
    BeyondLinearRange,
    /// The head cannot move; maxima are over the horizon.
    Constrained,
    /// The bodies do not close in.
    NoImpact,
    /// A parameter is out of range.
    InvalidParameter,
    /// The fastest root is too fast for the horizon.
    TooStiff,
    /// Released, but the foam was compressed by more than it is thick.
    Bottomed,
}

impl Status {
    /// All of them; the place of one is its code in a batch.
    pub const ALL: [Self; 8] = [
        Self::Released,
        Self::NoRelease,
        Self::BeyondLinearRange,
        Self::Constrained,
        Self::NoImpact,
        Self::InvalidParameter,
        Self::TooStiff,
        Self::Bottomed,
    ];

    /// Status of a released impact from its largest compression, in m, NaN where there is none.
    #[must_use]
    pub fn released(compression: f64, foam: &Foam) -> Self {
        if compression > foam.thickness {
            Self::Bottomed
        } else if compression > foam.linear_range {
            Self::BeyondLinearRange
        } else {
            Self::Released
        }
    }

    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Released => "released",
            Self::NoRelease => "no_release",
            Self::BeyondLinearRange => "beyond_linear_range",
            Self::Constrained => "constrained",
            Self::NoImpact => "no_impact",
            Self::InvalidParameter => "invalid_parameter",
            Self::TooStiff => "too_stiff",
            Self::Bottomed => "bottomed",
        }
    }
}

/// Inputs of metrics beside system and closing speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetricOptions {
    /// Speed of the manipulator `v_r`, in m/s; the closing speed when `None`.
    pub manipulator_speed: Option<f64>,
    /// Time without release after which the search ends, in s; the default of the head when `None`.
    pub horizon: Option<f64>,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
}

impl Default for MetricOptions {
    fn default() -> Self {
        Self {
            manipulator_speed: None,
            horizon: None,
            gravity: GRAVITY,
        }
    }
}

/// Criteria of one impact and what they mean. Numbers that have no meaning are NaN: all of them
/// without an impact, those of the head when it is constrained, those of 3 ms when the impact is
/// shorter. The duration is infinite without a zero of the acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metrics {
    /// The criteria.
    pub loads: Loads<f64>,
    /// Status of the row.
    pub status: Status,
}

impl Metrics {
    /// A row without numbers.
    #[must_use]
    pub fn none(status: Status) -> Self {
        Self {
            loads: Loads::none(),
            status,
        }
    }

    /// Takes what is missing from others.
    pub fn take(&mut self, others: &Self, missing: Missing) {
        let values = others.loads.into_array();
        for (place, (own, value)) in self
            .loads
            .as_mut()
            .into_array()
            .into_iter()
            .zip(values)
            .enumerate()
        {
            if missing.has(place) {
                *own = value;
            }
        }
        if missing.has_status() {
            self.status = others.status;
        }
    }
}

impl Loads<f64> {
    /// No numbers.
    #[must_use]
    pub fn none() -> Self {
        Self::of(|_| f64::NAN)
    }
}

impl Deref for Metrics {
    type Target = Loads<f64>;

    fn deref(&self) -> &Self::Target {
        &self.loads
    }
}

impl DerefMut for Metrics {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.loads
    }
}

impl MetricOptions {
    /// Checks the options.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn check(&self) -> Result<()> {
        positive("gravity", self.gravity)?;
        if let Some(horizon) = self.horizon {
            positive("horizon", horizon)?;
        }
        if let Some(speed) = self.manipulator_speed {
            finite("manipulator_speed", speed)?;
        }
        Ok(())
    }
}
