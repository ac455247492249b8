//! Metrics of many impacts: lanes side by side, blocks of rows over all cores.

mod kernel;

pub(crate) use kernel::usual;

use numeric::threads::{on_threads, try_each};

use crate::criteria::{MetricOptions, Metrics, Status};
use crate::error::{Failure, Given, Result};
use crate::parameters::{Foam, GRAVITY, Head, Manipulator, System, Target};

/// Rows of a task; the bits of a row do not depend on it.
const BLOCK: usize = 1024;

/// One input of every row.
#[derive(Clone, Copy, Debug)]
pub enum Column<'a> {
    /// The same number in every row.
    Value(f64),
    /// A number for each row.
    Array(&'a [f64]),
}

impl Column<'_> {
    /// Number of a row.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, row: usize) -> f64 {
        match self {
            Self::Value(value) => *value,
            Self::Array(values) => values[row],
        }
    }
}

/// Heads of every row.
#[derive(Clone, Copy, Debug)]
pub enum HeadColumns<'a> {
    /// Heads that can move.
    Free {
        /// `M_h`, in kg.
        mass: Column<'a>,
        /// `C_h`, in N s/m.
        damping: Column<'a>,
        /// `K_h`, in N/m.
        stiffness: Column<'a>,
    },
    /// Heads against a wall.
    Constrained,
}

/// Inputs of a batch; arrays are of one length.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a> {
    /// `M_r`, in kg.
    pub manipulator_mass: Column<'a>,
    /// `C_r`, in N s/m.
    pub manipulator_damping: Column<'a>,
    /// `K_r`, in N/m.
    pub manipulator_stiffness: Column<'a>,
    /// `K_c`, in N/m.
    pub foam_stiffness: Column<'a>,
    /// `C_c`, in N s/m.
    pub foam_damping: Column<'a>,
    /// `lambda`, in m.
    pub linear_range: Column<'a>,
    /// The heads.
    pub head: HeadColumns<'a>,
    /// `v_c`, in m/s.
    pub closing_speed: Column<'a>,
    /// `v_r`, in m/s; the closing speed when `None`.
    pub manipulator_speed: Option<Column<'a>>,
}

impl<'a> Columns<'a> {
    fn all(&self) -> impl Iterator<Item = Column<'a>> {
        let head = match self.head {
            HeadColumns::Free {
                mass,
                damping,
                stiffness,
            } => vec![mass, damping, stiffness],
            HeadColumns::Constrained => Vec::new(),
        };
        [
            self.manipulator_mass,
            self.manipulator_damping,
            self.manipulator_stiffness,
            self.foam_stiffness,
            self.foam_damping,
            self.linear_range,
            self.closing_speed,
        ]
        .into_iter()
        .chain(head)
        .chain(self.manipulator_speed)
    }

    /// Number of rows; 1 without an array.
    ///
    /// # Errors
    /// Two arrays have different lengths.
    pub fn rows(&self) -> Result<usize> {
        let mut rows = None;
        for column in self.all() {
            if let Column::Array(values) = column {
                if rows.is_some_and(|rows| rows != values.len()) {
                    let given = Given::Count(values.len() as u64);
                    return Err(Failure::invalid("columns", "have one length", given));
                }
                rows = Some(values.len());
            }
        }
        Ok(rows.unwrap_or(1))
    }

    /// System of a row.
    #[must_use]
    pub fn system(&self, row: usize) -> System {
        System {
            manipulator: Manipulator {
                mass: self.manipulator_mass.at(row),
                damping: self.manipulator_damping.at(row),
                stiffness: self.manipulator_stiffness.at(row),
            },
            foam: Foam {
                stiffness: self.foam_stiffness.at(row),
                damping: self.foam_damping.at(row),
                // Rows have none; whoever knows it tells crushed foams from the compression.
                thickness: f64::MAX,
                linear_range: self.linear_range.at(row),
            },
            head: match self.head {
                HeadColumns::Free {
                    mass,
                    damping,
                    stiffness,
                } => Target::Free(Head {
                    mass: mass.at(row),
                    damping: damping.at(row),
                    stiffness: stiffness.at(row),
                }),
                HeadColumns::Constrained => Target::Constrained,
            },
        }
    }

    /// Closing speed and speed of the manipulator of a row.
    #[must_use]
    pub fn speeds(&self, row: usize) -> [f64; 2] {
        let closing = self.closing_speed.at(row);
        let manipulator = self
            .manipulator_speed
            .map_or(closing, |column| column.at(row));
        [closing, manipulator]
    }
}

/// Which fields a batch fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldSet {
    /// All of them.
    All,
    /// Peaks of acceleration, force and compression, impact duration and status.
    Peaks,
}

/// Number of impacts side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One.
    One,
    /// Four.
    Four,
    /// Eight.
    Eight,
    /// Sixteen.
    Sixteen,
}

impl Width {
    /// Width by its number of lanes.
    ///
    /// # Errors
    /// There is no such width.
    pub fn of(lanes: usize) -> Result<Self> {
        match lanes {
            1 => Ok(Self::One),
            4 => Ok(Self::Four),
            8 => Ok(Self::Eight),
            16 => Ok(Self::Sixteen),
            other => {
                let given = Given::Count(other as u64);
                Err(Failure::invalid("lanes", "be 1, 4, 8 or 16", given))
            }
        }
    }
}

/// Options of a batch.
#[derive(Clone, Copy, Debug)]
pub struct BatchOptions {
    /// Time without release after which a search ends, in s; the default of the head when `None`.
    pub horizon: Option<f64>,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
    /// Number of threads; all cores when `None`.
    pub threads: Option<usize>,
    /// Lanes; chosen when `None`.
    pub width: Option<Width>,
    /// Fields to fill.
    pub fields: FieldSet,
}

impl Default for BatchOptions {
    fn default() -> Self {
        Self {
            horizon: None,
            gravity: GRAVITY,
            threads: None,
            width: None,
            fields: FieldSet::All,
        }
    }
}

/// Whether the caller asks to stop.
pub type Interrupted<'a> = &'a (dyn Fn() -> bool + Sync);

macro_rules! metric_columns {
    ($($field:ident: $doc:literal,)*) => {
        /// Metrics of every row; fields that were not asked for are empty.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct MetricColumns {
            /// Number of rows.
            pub rows: usize,
            $(#[doc = $doc] pub $field: Vec<f64>,)*
            /// Place of the status in [`Status::ALL`].
            pub status: Vec<u8>,
        }

        /// The part of the columns that one task fills.
        struct Block<'a> {
            first: usize,
            $($field: &'a mut [f64],)*
            status: &'a mut [u8],
        }

        impl MetricColumns {
            fn blocks(&mut self) -> Vec<Block<'_>> {
                $(let mut $field = self.$field.chunks_mut(BLOCK);)*
                self.status
                    .chunks_mut(BLOCK)
                    .enumerate()
                    .map(|(index, status)| Block {
                        first: index * BLOCK,
                        $($field: $field.next().unwrap_or_default(),)*
                        status,
                    })
                    .collect()
            }
        }

        impl Block<'_> {
            fn put(&mut self, place: usize, metrics: &Metrics) {
                $(if let Some(cell) = self.$field.get_mut(place) {
                    *cell = metrics.$field;
                })*
                self.status[place] = code(metrics.status);
            }
        }
    };
}
metric_columns! {
    peak_head_acceleration: "Largest acceleration of the head, in m/s^2.",
    peak_head_acceleration_g: "The same in g.",
    mean_head_acceleration_g: "Mean acceleration over the impact, in g.",
    peak_contact_force: "Largest contact force, in N.",
    max_compression: "Largest compression of the foam, in m.",
    impact_duration: "Time to the first zero of the acceleration, in s.",
    hic15: "Head injury criterion, windows up to 15 ms.",
    hic36: "Head injury criterion, windows up to 36 ms.",
    average_3ms_g: "Largest mean over 3 ms, in g.",
    clip_3ms_g: "Largest level held for 3 ms, in g.",
    peak_power_manipulator: "Largest power from the manipulator, in W.",
    peak_power_foam: "Largest power of compression, in W.",
}

/// Code of a status.
fn code(status: Status) -> u8 {
    match status {
        Status::Released => 0,
        Status::NoRelease => 1,
        Status::BeyondLinearRange => 2,
        Status::Constrained => 3,
        Status::NoImpact => 4,
        Status::InvalidParameter => 5,
        Status::TooStiff => 6,
        Status::Bottomed => 7,
    }
}

impl MetricColumns {
    fn sized(rows: usize, fields: FieldSet) -> Self {
        let column = || vec![0.0; rows];
        let other = || match fields {
            FieldSet::All => vec![0.0; rows],
            FieldSet::Peaks => Vec::new(),
        };
        Self {
            rows,
            peak_head_acceleration: column(),
            peak_head_acceleration_g: column(),
            mean_head_acceleration_g: other(),
            peak_contact_force: column(),
            max_compression: column(),
            impact_duration: column(),
            hic15: other(),
            hic36: other(),
            average_3ms_g: other(),
            clip_3ms_g: other(),
            peak_power_manipulator: other(),
            peak_power_foam: other(),
            status: vec![0; rows],
        }
    }
}

/// Metrics of every row. A row whose parameters are out of range, or that never closes in, is
/// NaN with its status. `progress` hears of rows as they are done.
///
/// # Errors
/// Arrays differ in length, an option is out of range, or the caller asked to stop.
pub fn metrics_batch(
    columns: &Columns<'_>,
    options: &BatchOptions,
    interrupted: Interrupted<'_>,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<MetricColumns> {
    let rows = columns.rows()?;
    MetricOptions {
        manipulator_speed: None,
        horizon: options.horizon,
        gravity: options.gravity,
    }
    .check()?;
    let mut result = MetricColumns::sized(rows, options.fields);
    let blocks = result.blocks();
    let work = || {
        try_each(blocks, |mut block| {
            if interrupted() {
                return Err(Failure::Interrupted);
            }
            kernel::fill(columns, options, &mut block);
            progress(block.status.len());
            Ok(())
        })
    };
    on_threads(options.threads, work)?;
    Ok(result)
}
