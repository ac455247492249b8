//! Metrics of many impacts: lanes side by side, blocks of rows over all cores.

mod kernel;

use std::ops::Deref;

use numeric::threads::{Interrupted, on_threads, try_each};

use crate::columns::Columns;
use crate::error::{Failure, Given, Result};
use crate::metrics::{Criterion, Loads, MetricOptions, Metrics, Missing, Status};
use crate::parameters::GRAVITY;

/// Rows of a task; the bits of a row do not depend on it.
const BLOCK: usize = 1024;

/// Criteria that a batch computes, besides the status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldSet(Loads<bool>);

impl FieldSet {
    /// All of them.
    #[must_use]
    pub fn all() -> Self {
        Self::of(|_| true)
    }

    /// Peaks of acceleration, force and compression, and the impact duration.
    #[must_use]
    pub fn peaks() -> Self {
        Self::of(|criterion| criterion.is_peak)
    }

    /// Criteria that a function chooses.
    #[must_use]
    pub fn of(asked: impl FnMut(&Criterion) -> bool) -> Self {
        Self(Loads::of(asked))
    }

    /// Missing metrics of a row before any is computed.
    fn missing(&self) -> Missing {
        Missing::of(self.0)
    }
}

/// How many impacts are solved side by side, and in which vectors. A processor that has no instructions for
/// eight solves one after the other: another copy of the kernel for processors that are rare would be
/// as long as this one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One.
    One,
    /// Eight in vectors of four numbers.
    Four,
    /// Eight in vectors of eight numbers, if the processor has them, else as [`Width::Four`].
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
            4 => Ok(Self::Four),
            // Sixteen are two times eight: more than eight would not stay in registers.
            8 | 16 => Ok(Self::Eight),
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
            fields: FieldSet::all(),
        }
    }
}

/// Metrics of every row; criteria that were not asked for are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MetricColumns {
    /// Number of rows.
    pub rows: usize,
    /// A column for each criterion.
    pub loads: Loads<Vec<f64>>,
    /// Place of the status in [`Status::ALL`].
    pub status: Vec<u8>,
}

/// The part of the columns that one task fills.
struct RowBlock<'a> {
    first: usize,
    loads: Loads<&'a mut [f64]>,
    status: &'a mut [u8],
}

impl Deref for MetricColumns {
    type Target = Loads<Vec<f64>>;

    fn deref(&self) -> &Self::Target {
        &self.loads
    }
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
    /// Room for rows. The threads that work here share it out: to clear it takes a part of the time.
    fn sized(rows: usize, fields: FieldSet) -> Result<Self> {
        let mut room = Self {
            rows,
            loads: Loads::of(|_| Vec::new()),
            status: vec![0; rows],
        };
        let columns = room.loads.as_mut().into_array();
        let asked = columns.into_iter().zip(fields.0.into_array());
        let asked = asked.filter_map(|(column, asked)| asked.then_some(column));
        try_each(asked.collect(), |column| {
            *column = vec![0.0; rows];
            Ok(())
        })?;
        Ok(room)
    }

    fn blocks(&mut self) -> Vec<RowBlock<'_>> {
        let mut loads = self.loads.as_mut().map(|column| column.chunks_mut(BLOCK));
        self.status
            .chunks_mut(BLOCK)
            .enumerate()
            .map(|(index, status)| RowBlock {
                first: index * BLOCK,
                loads: loads
                    .as_mut()
                    .map(|pieces| pieces.next().unwrap_or_default()),
                status,
            })
            .collect()
    }
}

impl RowBlock<'_> {
    /// Keeps of some metrics what the row at a place misses.
    fn put(&mut self, place: usize, metrics: &Metrics, missing: Missing) {
        let columns = self.loads.as_mut().into_array();
        let values = metrics.loads.into_array();
        for (criterion, (column, value)) in columns.into_iter().zip(values).enumerate() {
            if missing.has(criterion)
                && let Some(cell) = column.get_mut(place)
            {
                *cell = value;
            }
        }
        if missing.has_status() {
            self.status[place] = code(metrics.status);
        }
    }
}

/// Metrics of every row. A row whose parameters are out of range, or that never closes in, is
/// NaN with its status. `progress` is called as rows are done.
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
    let work = || {
        let mut result = MetricColumns::sized(rows, options.fields)?;
        try_each(result.blocks(), |mut block| {
            if interrupted() {
                return Err(Failure::Interrupted);
            }
            kernel::fill(columns, options, &mut block);
            progress(block.status.len());
            Ok(())
        })?;
        Ok(result)
    };
    on_threads(options.threads, work)
}
