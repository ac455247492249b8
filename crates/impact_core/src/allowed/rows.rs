//! Many contacts at once, for batches and maps.

use numeric::parallel::Work;

use super::room::{Room, RowColumns};
use super::row::{CALLED, COUNT, FIRST_MATERIAL, MASSES, NAMES, OPTIONAL, Row, is_of_law};
use super::setup::{PreparedContact, Setup};
use super::{Governs, SpeedStatus, ThicknessStatus};
use crate::collision::{CollisionStatus, Outcome, Wanted, simulate_all};
use crate::columns::Column;
use crate::covering::Material;
use crate::error::{Failure, Given as Shown, Result};

/// Collisions whose steps are taken side by side.
const TOGETHER: usize = 64;

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
    let Failure::InvalidParameter(invalid) = failure else {
        return u8::MAX;
    };
    let name = &invalid.name;
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
type ResultRow<const N: usize> = ([f64; N], usize, u8);

/// Inputs of all rows, with their law where it does not differ.
struct RowInputs<'a> {
    setup: &'a Setup,
    given: &'a Given<'a>,
    varying: Vec<usize>,
    fixed: Option<Result<Option<Material>>>,
}

impl<'a> RowInputs<'a> {
    fn new(setup: &'a Setup, given: &'a Given<'a>) -> Self {
        let shared = given.rows > 0 && !given.varies();
        Self {
            varying: given.varying(),
            fixed: shared.then(|| setup.material(&given.row(0))),
            setup,
            given,
        }
    }

    /// The law of a row whose numbers are all there, if rows share it.
    fn law(&self, index: usize) -> Result<Option<&Material>> {
        self.given.check(index)?;
        match &self.fixed {
            Some(Ok(found)) => Ok(found.as_ref()),
            Some(Err(failure)) => Err(failure.clone()),
            None => Ok(None),
        }
    }
}

/// Codes of a kind of results: `words` statuses come before those of invalid rows, which have `nothing` as their second
/// code.
#[derive(Clone, Copy)]
struct Kinds {
    words: usize,
    nothing: u8,
}

impl Kinds {
    /// Numbers and codes of a result.
    fn codes<const N: usize>(
        self,
        setup: &Setup,
        found: Result<ResultRow<N>>,
    ) -> ([f64; N], u8, u8) {
        match found {
            Ok((numbers, status, word)) => (numbers, code_of(status), word),
            Err(failure) => {
                let code = invalid(setup, &failure, self.words);
                ([f64::NAN; N], code, self.nothing)
            }
        }
    }
}

/// Results of all rows in blocks over the threads.
///
/// Values remembered of a row are there for the next one as long as rows differ in their masses only.
fn each_row<const N: usize, M: Default>(
    rows: &RowInputs<'_>,
    (kinds, room): (Kinds, Room<'_>),
    work: Work<'_>,
    of: impl Fn(&Row, Option<&Material>, &mut M) -> Result<ResultRow<N>> + Sync + Send,
) -> Result<()> {
    room.fill(work, |piece: &mut RowColumns<'_, N>| {
        let (mut row, mut remembered) = (rows.given.row(piece.first), M::default());
        for place in 0..piece.status.len() {
            if (work.interrupted)() {
                return Err(Failure::Interrupted);
            }
            let index = piece.first + place;
            if rows.given.advance(&mut row, &rows.varying, index) {
                remembered = M::default();
            }
            let law = rows.law(index);
            let found = law.and_then(|law| of(&row, law, &mut remembered));
            piece.put(place, kinds.codes(rows.setup, found));
        }
        Ok(())
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
/// Names of the numbers of allowed speeds.
pub const SPEEDS: [&str; 6] = [
    "speed",
    "speed_force",
    "speed_pressure",
    "speed_strain",
    "bare_speed_force",
    "covering_compression",
];
/// Name of the number of least thicknesses.
pub const THICKNESSES: [&str; 1] = ["thickness"];
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
    (work, room): (Work<'_>, Room<'_>),
) -> Result<()> {
    let rows = RowInputs::new(setup, given);
    let kinds = Kinds {
        words: CollisionStatus::ALL.len(),
        nothing: 0,
    };
    room.fill(work, |piece: &mut RowColumns<'_, 14>| {
        for first in (0..piece.status.len()).step_by(TOGETHER) {
            let places = first..piece.status.len().min(first + TOGETHER);
            let pads: Vec<_> = places
                .clone()
                .map(|place| {
                    let index = piece.first + place;
                    let row = given.row(index);
                    let pad = setup.pad(&row, rows.law(index)?)?;
                    Ok((row, pad))
                })
                .collect();
            let collisions: Vec<_> = pads
                .iter()
                .map(|found: &Result<_>| {
                    let (row, pad) = found.as_ref().map_err(Clone::clone)?;
                    setup.moving(row, pad.as_ref())
                })
                .collect();
            if (work.interrupted)() {
                return Err(Failure::Interrupted);
            }
            let valid: Vec<_> = collisions
                .iter()
                .filter_map(|of| of.as_ref().ok())
                .collect();
            let mut outcomes = simulate_all(&valid, wanted, work.interrupted).into_iter();
            for (place, collision) in places.zip(&collisions) {
                let found = match collision {
                    Ok(_) => Ok(loads(&outcomes.next().ok_or(Failure::Interrupted)?)),
                    Err(failure) => Err(failure.clone()),
                };
                piece.put(place, kinds.codes(setup, found));
            }
        }
        Ok(())
    })
}

/// Numbers and codes of loads.
fn loads(found: &Outcome) -> ResultRow<14> {
    let bottomed = BOTTOMED * u8::from(found.bottomed);
    let word = bottomed + RISING * u8::from(found.rising);
    (
        found.loads(),
        place_of(&CollisionStatus::ALL, &found.status),
        word,
    )
}

/// Allowed speeds of all rows; the second code is the place of what governs.
///
/// # Errors
/// The caller asked to stop.
pub fn speed_rows(setup: &Setup, given: &Given<'_>, work: Work<'_>, room: Room<'_>) -> Result<()> {
    let nothing = code_of(place_of(&Governs::ALL, &Governs::Nothing));
    let kinds = Kinds {
        words: SpeedStatus::ALL.len(),
        nothing,
    };
    each_row(
        &RowInputs::new(setup, given),
        (kinds, room),
        work,
        |row, fixed, known: &mut Option<PreparedContact>| {
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
pub fn thickness_rows(
    setup: &Setup,
    given: &Given<'_>,
    work: Work<'_>,
    room: Room<'_>,
) -> Result<()> {
    let kinds = Kinds {
        words: ThicknessStatus::ALL.len(),
        nothing: 0,
    };
    let rows = RowInputs::new(setup, given);
    each_row(&rows, (kinds, room), work, |row, fixed, (): &mut ()| {
        let found = setup.thickness(row, fixed)?;
        let status = place_of(&ThicknessStatus::ALL, &found.status);
        Ok(([found.thickness], status, 0))
    })
}
