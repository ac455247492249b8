//! Long columns, in pieces over the threads.

use numeric::error::{Failure, Given};
use numeric::threads::{on_threads, try_each, try_map};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::errors::{CoreError, CoreResult};

/// Rows of a piece; fewer are no work to share.
const PIECE: usize = 1 << 14;

/// Letters that are copied at once, so that they stay near.
const MOST_COPIED: usize = 1 << 11;

/// Threads for some rows.
fn threads_for(rows: usize, threads: Option<usize>) -> Option<usize> {
    if rows <= PIECE { Some(1) } else { threads }
}

/// What pieces of a column give.
fn of_pieces<T: Sync, F: Send>(
    py: Python<'_>,
    (column, threads): (&[T], Option<usize>),
    of: impl Fn(&[T]) -> F + Sync + Send,
) -> CoreResult<Vec<F>> {
    let pieces: Vec<&[T]> = column.chunks(PIECE).collect();
    let found = py.detach(|| {
        let piece = |index: usize| Ok::<_, Failure>(of(pieces[index]));
        on_threads(threads_for(column.len(), threads), || {
            try_map(pieces.len(), piece)
        })
    });
    Ok(found?)
}

/// Which of all codes there are in a column.
#[pyfunction]
pub fn codes_there(
    py: Python<'_>,
    codes: PyReadonlyArray1<'_, u8>,
    threads: Option<usize>,
) -> PyResult<Vec<bool>> {
    let found = of_pieces(py, (codes.as_slice()?, threads), |piece| {
        let mut there = [false; 256];
        for code in piece {
            there[usize::from(*code)] = true;
        }
        there
    })?;
    let mut there = vec![false; 256];
    for piece in found {
        for (all, own) in there.iter_mut().zip(piece) {
            *all |= own;
        }
    }
    Ok(there)
}

/// Smallest and largest positive finite number of a column; infinite and zero if there is none.
#[pyfunction]
pub fn positive_ends(
    py: Python<'_>,
    values: PyReadonlyArray1<'_, f64>,
    threads: Option<usize>,
) -> PyResult<(f64, f64)> {
    let found = of_pieces(py, (values.as_slice()?, threads), ends_of)?;
    let [least, most] = found
        .into_iter()
        .fold(NOTHING, |[least, most], [low, high]| {
            [least.min(low), most.max(high)]
        });
    Ok((least, most))
}

/// Ends of no numbers.
const NOTHING: [f64; 2] = [f64::INFINITY, 0.0];
/// Numbers side by side.
const WIDTH: usize = 8;

/// Smallest and largest positive finite number.
fn ends_of(values: &[f64]) -> [f64; 2] {
    let (mut least, mut most) = ([NOTHING[0]; WIDTH], [NOTHING[1]; WIDTH]);
    let mut look = |lane: usize, value: f64| {
        let known = value > 0.0 && value < f64::INFINITY;
        let [low, high] = if known { [value; 2] } else { NOTHING };
        least[lane] = if low < least[lane] { low } else { least[lane] };
        most[lane] = if high > most[lane] { high } else { most[lane] };
    };
    let (groups, rest) = values.as_chunks::<WIDTH>();
    for group in groups {
        for (lane, value) in group.iter().enumerate() {
            look(lane, *value);
        }
    }
    for value in rest {
        look(0, *value);
    }
    [
        least.into_iter().fold(NOTHING[0], f64::min),
        most.into_iter().fold(NOTHING[1], f64::max),
    ]
}

/// Fills rows of letters with the words at codes; the last word stands for every code beyond it.
#[pyfunction]
pub fn fill_words(
    py: Python<'_>,
    mut letters: PyReadwriteArray2<'_, u32>,
    codes: PyReadonlyArray1<'_, u8>,
    words: PyReadonlyArray2<'_, u32>,
    threads: Option<usize>,
) -> PyResult<()> {
    let ([rows, width], count) = ([letters.shape()[0], letters.shape()[1]], words.shape()[0]);
    let (codes, words) = (codes.as_slice()?, words.as_slice()?);
    if codes.len() != rows || words.len() != count * width || count * width == 0 {
        let given = Given::Count(rows as u64);
        return Err(
            CoreError::from(Failure::invalid("letters", "fit codes and words", given)).into(),
        );
    }
    let pieces = letters.as_slice_mut()?.chunks_mut(PIECE * width);
    let pieces: Vec<_> = pieces.zip(codes.chunks(PIECE)).collect();
    let fill = |(letters, codes): (&mut [u32], &[u8])| {
        let mut left = letters;
        // Words of neighboring rows are mostly the same.
        for run in codes.chunk_by(|one, other| one == other) {
            let place = usize::from(run[0]).min(count - 1) * width;
            let (own, rest) = left.split_at_mut(run.len() * width);
            own[..width].copy_from_slice(&words[place..place + width]);
            // What is filled so far is copied behind itself.
            let (mut filled, most) = (width, (MOST_COPIED / width).max(1) * width);
            while filled < own.len() {
                let more = filled.min(most).min(own.len() - filled);
                own.copy_within(..more, filled);
                filled += more;
            }
            left = rest;
        }
        Ok::<(), Failure>(())
    };
    let found = py.detach(|| on_threads(threads_for(rows, threads), || try_each(pieces, fill)));
    Ok(found.map_err(CoreError::from)?)
}
