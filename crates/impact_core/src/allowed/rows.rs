//! Many contacts at once, for batches and maps.

use numeric::parallel::Work;
use numeric::threads::{on_threads, try_each};

use super::row::{CALLED, COUNT, FIRST_MATERIAL, MASSES, NAMES, OPTIONAL, Row, is_of_law};
use super::setup::{Known, Setup};
use super::{Governs, SpeedStatus, ThicknessStatus};
use crate::collision::{Status, Wanted};
use crate::columns::Column;
use crate::covering::Material;
use crate::error::{Failure, Given as Shown, Result};

/// Rows of a task; the bits of a row do not depend on it.
const BLOCK: usize = 256;

/// Inputs of rows, and how many there are.
#[derive(Clone, Debug)]
pub struct Given<'a> {
    /// A column for each name.
    pub columns: [Column<'a>; COUNT],
    /// Rows.
    pub rows: usize,
}

impl Given<'_> {
    /// Numbers of a row.
    #[must_use]
    pub fn row(&self, index: usize) -> Row {
        Row(std::array::from_fn(|place| self.columns[place].at(index)))
    }

    /// Places of the numbers that have a column.
    fn varying(&self) -> Vec<usize> {
        let columns = self.columns.iter().enumerate();
        columns
            .filter(|(_, column)| matches!(column, Column::Array(_)))
            .map(|(place, _)| place)
            .collect()
    }

    /// Makes a row that of another index; whether something else than masses has changed.
    fn advance(&self, row: &mut Row, varying: &[usize], index: usize) -> bool {
        let mut changed = false;
        for place in varying {
            let value = self.columns[*place].at(index);
            let same = value.to_bits() == row.0[*place].to_bits();
            changed |= !same && !MASSES.contains(place);
            row.0[*place] = value;
        }
        changed
    }

    /// Whether the law of the covering differs from row to row.
    fn varies(&self) -> bool {
        self.varying().into_iter().any(is_of_law)
    }

    /// Refuses a row whose column has no number there: only a number that no row has is not given.
    fn check(&self, index: usize) -> Result<()> {
        for place in OPTIONAL {
            if let Column::Array(values) = self.columns[place]
                && values[index].is_nan()
            {
                let given = Shown::Number(f64::NAN);
                return Err(Failure::invalid(CALLED[place], "be a number", given));
            }
        }
        Ok(())
    }
}

/// Code of an invalid row: after the words of the results, the first number that is refused.
fn invalid(setup: &Setup, failure: &Failure, words: usize) -> u8 {
    let Failure::InvalidParameter { name, .. } = failure else {
        return u8::MAX;
    };
    let law = setup
        .kind
        .covering
        .as_ref()
        .map_or(&[][..], |(law, _)| law.names());
    let of_law = name.strip_prefix("covering.material.").map(|last| {
        let place = law.iter().position(|known| *known == last).unwrap_or(0);
        FIRST_MATERIAL + place
    });
    let known = |names: [&str; COUNT]| names.iter().position(|each| each == name);
    let place = of_law.or_else(|| known(CALLED)).or_else(|| known(NAMES));
    code_of(words + place.unwrap_or(COUNT))
}

fn code_of(place: usize) -> u8 {
    u8::try_from(place).unwrap_or(u8::MAX)
}

/// A row of results: numbers, the place of its status among all, and a second code.
type Found<const N: usize> = ([f64; N], usize, u8);

/// Numbers by name, and the codes of statuses and of what stands beside them.
pub struct Columns {
    /// Columns with their names.
    pub numbers: Vec<(&'static str, Vec<f64>)>,
    /// Status of each row.
    pub status: Vec<u8>,
    /// A second code of each row.
    pub word: Vec<u8>,
}

/// Columns of some rows, to be filled.
struct Piece<'a, const N: usize> {
    first: usize,
    numbers: [&'a mut [f64]; N],
    status: &'a mut [u8],
    word: &'a mut [u8],
}

impl<const N: usize> Piece<'_, N> {
    fn put(&mut self, place: usize, (numbers, status, word): ([f64; N], u8, u8)) {
        for (column, number) in self.numbers.iter_mut().zip(numbers) {
            column[place] = number;
        }
        self.status[place] = status;
        self.word[place] = word;
    }
}

/// Results of all rows in blocks over the threads; `words` statuses come before those of invalid rows, which
/// have `nothing` as their second code.
///
/// What is remembered of a row is there for the next one as long as rows differ in their masses only.
fn each_row<const N: usize, M: Default>(
    (setup, given): (&Setup, &Given<'_>),
    (names, words, nothing): ([&'static str; N], usize, u8),
    work: Work<'_>,
    of: impl Fn(&Row, Option<&Material>, &mut M) -> Result<Found<N>> + Sync,
) -> Result<Columns> {
    let varying = given.varying();
    let fill = |mut piece: Piece<'_, N>| -> Result<()> {
        let fixed = if given.varies() {
            Ok(None)
        } else {
            setup.material(&given.row(0))
        };
        let one = |index: usize, row: &Row, remembered: &mut M| {
            given.check(index)?;
            let material = fixed.as_ref().map_err(Clone::clone)?;
            of(row, material.as_ref(), remembered)
        };
        let (mut row, mut remembered) = (given.row(piece.first), M::default());
        for place in 0..piece.status.len() {
            if (work.interrupted)() {
                return Err(Failure::Interrupted);
            }
            let index = piece.first + place;
            if given.advance(&mut row, &varying, index) {
                remembered = M::default();
            }
            let found = match one(index, &row, &mut remembered) {
                Ok((numbers, status, word)) => (numbers, code_of(status), word),
                Err(failure) => ([f64::NAN; N], invalid(setup, &failure, words), nothing),
            };
            piece.put(place, found);
        }
        (work.progress)(piece.status.len());
        Ok(())
    };
    let mut numbers = names.map(|_| vec![0.0; given.rows]);
    let mut status = vec![0; given.rows];
    let mut word = vec![0; given.rows];
    let mut columns = numbers.each_mut().map(|column| column.chunks_mut(BLOCK));
    let codes = status.chunks_mut(BLOCK).zip(word.chunks_mut(BLOCK));
    let pieces = codes.enumerate().map(|(index, (status, word))| Piece {
        first: index * BLOCK,
        numbers: columns
            .each_mut()
            .map(|pieces| pieces.next().unwrap_or_default()),
        status,
        word,
    });
    let pieces = pieces.collect();
    on_threads(work.threads, || try_each(pieces, fill))?;
    let mut numbers = numbers.into_iter();
    Ok(Columns {
        numbers: names
            .into_iter()
            .map(|name| (name, numbers.next().unwrap_or_default()))
            .collect(),
        status,
        word,
    })
}

/// Place of a word among all.
fn place_of<T: PartialEq>(all: &[T], word: &T) -> usize {
    all.iter().position(|each| each == word).unwrap_or(0)
}

/// Names of the loads of a collision, in the order of `Outcome::loads`.
pub const LOADS: [&str; 14] = [
    "release_time",
    "peak_force",
    "peak_force_time",
    "peak_total_compression",
    "peak_body_deflection",
    "peak_covering_compression",
    "peak_strain",
    "peak_pressure",
    "rebound_speed",
    "peak_body_acceleration",
    "body_speed_end",
    "hic15",
    "hic36",
    "end_force",
];
/// Second code of a collision that reached the backing.
pub const BOTTOMED: u8 = 1;
/// Second code of loads that still rose at the horizon; it is added to the others.
pub const RISING: u8 = 4;

/// Loads of all rows; an invalid row is NaN with its status.
///
/// # Errors
/// The caller asked to stop.
pub fn collide_rows(
    setup: &Setup,
    given: &Given<'_>,
    wanted: Wanted,
    work: Work<'_>,
) -> Result<Columns> {
    let kind = (LOADS, Status::ALL.len(), 0);
    each_row((setup, given), kind, work, |row, fixed, (): &mut ()| {
        let found = setup.collide(row, fixed, wanted, work.interrupted)?;
        let bottomed = BOTTOMED * u8::from(found.bottomed);
        let word = bottomed + RISING * u8::from(found.rising);
        Ok((found.loads(), place_of(&Status::ALL, &found.status), word))
    })
}

/// Allowed speeds of all rows; the second code is the place of what governs.
///
/// # Errors
/// The caller asked to stop.
pub fn speed_rows(setup: &Setup, given: &Given<'_>, work: Work<'_>) -> Result<Columns> {
    let names = [
        "speed",
        "speed_force",
        "speed_pressure",
        "speed_strain",
        "bare_speed_force",
        "covering_compression",
    ];
    let nothing = code_of(place_of(&Governs::ALL, &Governs::Nothing));
    let kind = (names, SpeedStatus::ALL.len(), nothing);
    each_row(
        (setup, given),
        kind,
        work,
        |row, fixed, known: &mut Option<Known>| {
            let (found, bare) = setup.allowed(row, fixed, known, work.interrupted)?;
            let [force, pressure, strain] = found.speeds;
            let governs = code_of(place_of(&Governs::ALL, &found.governs));
            Ok((
                [
                    found.speed,
                    force,
                    pressure,
                    strain,
                    bare,
                    found.compression,
                ],
                place_of(&SpeedStatus::ALL, &found.status),
                governs + RISING * u8::from(found.rising),
            ))
        },
    )
}

/// Least thicknesses of all rows at their closing speed.
///
/// # Errors
/// The caller asked to stop.
pub fn thickness_rows(setup: &Setup, given: &Given<'_>, work: Work<'_>) -> Result<Columns> {
    let kind = (["thickness"], ThicknessStatus::ALL.len(), 0);
    each_row((setup, given), kind, work, |row, fixed, (): &mut ()| {
        let found = setup.thickness(row, fixed)?;
        let status = place_of(&ThicknessStatus::ALL, &found.status);
        Ok(([found.thickness], status, 0))
    })
}
