//! Metrics of many impacts: lanes side by side, blocks of rows over all cores.

use rayon::prelude::*;

use crate::criteria::{FREE_HORIZON, Impact, MetricOptions, Metrics, Status};
use crate::error::{Given, ImpactError, Result};
use crate::fast::{Group, Workspace};
use crate::parameters::{Foam, GRAVITY, Head, Manipulator, System, Target};
use crate::series::Plant;
use lanes::{Lanes, Mask, Real};

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
                    return Err(ImpactError::invalid("columns", "have one length", given));
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
                thickness: 1.0,
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
    /// Eight.
    Eight,
}

impl Width {
    /// Width by its number of lanes.
    ///
    /// # Errors
    /// There is no such width.
    pub fn of(lanes: usize) -> Result<Self> {
        match lanes {
            1 => Ok(Self::One),
            8 => Ok(Self::Eight),
            other => {
                let given = Given::Count(other as u64);
                Err(ImpactError::invalid("lanes", "be 1 or 8", given))
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
/// NaN with its status.
///
/// # Errors
/// Arrays differ in length, an option is out of range, or the caller asked to stop.
pub fn metrics_batch(
    columns: &Columns<'_>,
    options: &BatchOptions,
    interrupted: Interrupted<'_>,
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
        blocks.into_par_iter().try_for_each(|mut block| {
            if interrupted() {
                return Err(ImpactError::Interrupted);
            }
            if options.width == Some(Width::One) || matches!(columns.head, HeadColumns::Constrained)
            {
                one_by_one(columns, options, &mut block);
            } else {
                let block = &mut block;
                pulp::Arch::new().dispatch(SideBySide {
                    columns,
                    options,
                    block,
                });
            }
            Ok(())
        })
    };
    match options.threads {
        None => work()?,
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| ImpactError::Threads {
                threads,
                reason: error.to_string(),
            })?
            .install(work)?,
    }
    Ok(result)
}

/// Rows of a task side by side, compiled once for each instruction set; the widest one that the
/// processor has is chosen at run time. The arithmetic is the same, bit for bit.
struct SideBySide<'a, 'b> {
    columns: &'a Columns<'a>,
    options: &'a BatchOptions,
    block: &'a mut Block<'b>,
}

impl pulp::NullaryFnOnce for SideBySide<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            columns,
            options,
            block,
        } = self;
        let rows = block.status.len();
        let mut space = Workspace::<Lanes<WIDEST>>::new();
        for place in (0..rows).step_by(WIDEST) {
            let count = WIDEST.min(rows - place);
            let first = block.first + place;
            // Lanes that are left over repeat the last row.
            let row = |lane: usize| first + lane.min(count - 1);
            let found = match options.fields {
                FieldSet::All => side_by_side::<_, true>(columns, options, &mut space, row),
                FieldSet::Peaks => side_by_side::<_, false>(columns, options, &mut space, row),
            };
            for (lane, found) in found.into_iter().enumerate().take(count) {
                let metrics = found.unwrap_or_else(|| alone(columns, options, first + lane));
                block.put(place + lane, &metrics);
            }
        }
    }
}

/// Rows of a task one by one.
fn one_by_one(columns: &Columns<'_>, options: &BatchOptions, block: &mut Block<'_>) {
    let mut space = Workspace::new();
    for place in 0..block.status.len() {
        let row = block.first + place;
        let metrics =
            one(columns, options, &mut space, row).unwrap_or_else(|| alone(columns, options, row));
        block.put(place, &metrics);
    }
}

/// Metrics of one row of the usual shape.
#[inline(never)]
fn one(
    columns: &Columns<'_>,
    options: &BatchOptions,
    space: &mut Workspace<f64>,
    row: usize,
) -> Option<Metrics> {
    let [found, ..] = match options.fields {
        FieldSet::All => side_by_side::<f64, true>(columns, options, space, |_| row),
        FieldSet::Peaks => side_by_side::<f64, false>(columns, options, space, |_| row),
    };
    found
}

/// Metrics of one impact if its response has the usual shape; numbers are in range.
pub(crate) fn usual(
    system: &System,
    closing_speed: f64,
    options: &MetricOptions,
) -> Option<Metrics> {
    let head = match system.head {
        Target::Free(head) => HeadColumns::Free {
            mass: Column::Value(head.mass),
            damping: Column::Value(head.damping),
            stiffness: Column::Value(head.stiffness),
        },
        Target::Constrained => return None,
    };
    let columns = Columns {
        manipulator_mass: Column::Value(system.manipulator.mass),
        manipulator_damping: Column::Value(system.manipulator.damping),
        manipulator_stiffness: Column::Value(system.manipulator.stiffness),
        foam_stiffness: Column::Value(system.foam.stiffness),
        foam_damping: Column::Value(system.foam.damping),
        linear_range: Column::Value(system.foam.linear_range),
        head,
        closing_speed: Column::Value(closing_speed),
        manipulator_speed: options.manipulator_speed.map(Column::Value),
    };
    let options = BatchOptions {
        horizon: options.horizon,
        gravity: options.gravity,
        ..BatchOptions::default()
    };
    one(&columns, &options, &mut Workspace::new(), 0)
}

/// Most lanes of any width.
const WIDEST: usize = 8;

/// Metrics of rows side by side; `None` for those that need the general search.
#[inline(always)]
fn side_by_side<R: Real, const ALL: bool>(
    columns: &Columns<'_>,
    options: &BatchOptions,
    space: &mut Workspace<R>,
    row: impl Fn(usize) -> usize,
) -> [Option<Metrics>; WIDEST] {
    let HeadColumns::Free {
        mass,
        damping,
        stiffness,
    } = columns.head
    else {
        return [None; WIDEST];
    };
    let gather = |column: &Column<'_>| match column {
        Column::Value(value) => R::splat(*value),
        Column::Array(values) => R::from_fn(|lane| values[row(lane)]),
    };
    let zero = R::zero();
    let largest = R::splat(f64::MAX);
    let arm = [
        gather(&columns.manipulator_mass),
        gather(&columns.manipulator_damping),
        gather(&columns.manipulator_stiffness),
    ];
    let head = [gather(&mass), gather(&damping), gather(&stiffness)];
    let foam = [
        gather(&columns.foam_stiffness),
        gather(&columns.foam_damping),
    ];
    let range = gather(&columns.linear_range);
    let closing_speed = gather(&columns.closing_speed);
    let manipulator_speed = columns
        .manipulator_speed
        .as_ref()
        .map_or(closing_speed, gather);
    let mut valid = manipulator_speed.abs().le(largest);
    for value in [arm[0], head[0], range, closing_speed] {
        valid = valid & value.gt(zero) & value.le(largest);
    }
    for value in [arm[1], arm[2], head[1], head[2], foam[0], foam[1]] {
        valid = valid & value.ge(zero) & value.le(largest);
    }
    let over = |[mass, damping, stiffness]: [R; 3]| {
        let inverse = R::splat(1.0) / mass;
        [inverse, damping / mass, stiffness / mass]
    };
    let group = Group {
        plant: Plant {
            manipulator: over(arm),
            head: over(head),
            foam,
        },
        closing_speed,
        manipulator_speed,
        horizon: options.horizon.unwrap_or(FREE_HORIZON),
    };
    let solved = group.solve::<ALL>(space);
    let peaks = solved.peaks();
    let rest = ALL.then(|| solved.rest());
    let mut shaped = valid & peaks.shaped;
    if let Some(rest) = &rest {
        shaped = shaped & rest.accepted;
    }
    let within = peaks.compression.le(range);
    let gravity = options.gravity;
    let scale = gravity * gravity * gravity.sqrt();
    std::array::from_fn(|lane| {
        if lane >= R::WIDTH || !shaped.lane(lane) {
            return None;
        }
        let mut metrics = if peaks.accepted.lane(lane) {
            let status = if within.lane(lane) {
                Status::Released
            } else {
                Status::BeyondLinearRange
            };
            let acceleration = peaks.head_acceleration.lane(lane);
            Metrics {
                peak_head_acceleration: acceleration,
                peak_head_acceleration_g: acceleration / gravity,
                peak_contact_force: peaks.contact_force.lane(lane),
                max_compression: peaks.compression.lane(lane),
                impact_duration: peaks.duration.lane(lane),
                ..Metrics::none(status)
            }
        } else {
            // Only the peaks need the general search.
            let system = columns.system(row(lane));
            let closing_speed = closing_speed.lane(lane);
            let impact = Impact::new(&system, closing_speed, options.horizon).ok()?;
            impact.peaks().metrics(&system, gravity)
        };
        if let Some(rest) = &rest {
            metrics.mean_head_acceleration_g = rest.mean.lane(lane) / gravity;
            metrics.hic15 = rest.injury[0].lane(lane) / scale;
            metrics.hic36 = rest.injury[1].lane(lane) / scale;
            metrics.average_3ms_g = rest.average.lane(lane) / gravity;
            metrics.clip_3ms_g = rest.clip.lane(lane) / gravity;
            metrics.peak_power_manipulator = rest.manipulator_power.lane(lane);
            metrics.peak_power_foam = rest.foam_power.lane(lane);
        }
        Some(metrics)
    })
}

/// One row by itself.
fn alone(columns: &Columns<'_>, options: &BatchOptions, row: usize) -> Metrics {
    let system = columns.system(row);
    let [closing_speed, manipulator_speed] = columns.speeds(row);
    let valid =
        system.checked().is_ok() && closing_speed.is_finite() && manipulator_speed.is_finite();
    if !valid {
        return Metrics::none(Status::InvalidParameter);
    }
    if closing_speed <= 0.0 {
        return Metrics::none(Status::NoImpact);
    }
    let Ok(impact) = Impact::new(&system, closing_speed, options.horizon) else {
        return Metrics::none(Status::InvalidParameter);
    };
    match options.fields {
        FieldSet::All => impact
            .findings(manipulator_speed)
            .metrics(&system, options.gravity),
        FieldSet::Peaks => impact.peaks().metrics(&system, options.gravity),
    }
}
