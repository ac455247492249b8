//! Room for columns of results, filled in blocks over the threads.

use numeric::parallel::Work;
use numeric::threads::{on_threads, try_each};

use crate::error::{Failure, Given, Result};

/// Rows of a task; the bits of a row do not depend on it.
const BLOCK: usize = 256;

/// Columns of one length: numbers in the order of their names, and two codes.
pub struct Room<'a> {
    /// Columns of numbers.
    pub numbers: Vec<&'a mut [f64]>,
    /// Status of each row.
    pub status: &'a mut [u8],
    /// A second code of each row.
    pub word: &'a mut [u8],
}

/// Columns of some rows.
pub(super) struct RowColumns<'a, const N: usize> {
    pub(super) first: usize,
    pub(super) numbers: [&'a mut [f64]; N],
    pub(super) status: &'a mut [u8],
    pub(super) word: &'a mut [u8],
}

impl<const N: usize> RowColumns<'_, N> {
    pub(super) fn put(&mut self, place: usize, (numbers, status, word): ([f64; N], u8, u8)) {
        for (column, number) in self.numbers.iter_mut().zip(numbers) {
            column[place] = number;
        }
        self.status[place] = status;
        self.word[place] = word;
    }
}

impl Room<'_> {
    /// Fills pieces of all columns.
    pub(super) fn fill<const N: usize>(
        self,
        work: Work<'_>,
        fill: impl Fn(&mut RowColumns<'_, N>) -> Result<()> + Sync + Send,
    ) -> Result<()> {
        let rows = self.status.len();
        let fits = |column: &&mut [f64]| column.len() == rows;
        if self.numbers.len() != N || self.word.len() != rows || !self.numbers.iter().all(fits) {
            let rule = format!("have {N} columns of one length");
            let given = Given::Count(self.numbers.len() as u64);
            return Err(Failure::invalid("room", rule, given));
        }
        let mut columns = self.numbers.into_iter();
        let mut columns: [_; N] =
            std::array::from_fn(|_| columns.next().unwrap_or_default().chunks_mut(BLOCK));
        let codes = self.status.chunks_mut(BLOCK);
        let pieces =
            codes
                .zip(self.word.chunks_mut(BLOCK))
                .enumerate()
                .map(|(index, (status, word))| RowColumns {
                    first: index * BLOCK,
                    numbers: columns
                        .each_mut()
                        .map(|pieces| pieces.next().unwrap_or_default()),
                    status,
                    word,
                });
        let pieces: Vec<_> = pieces.collect();
        on_threads(work.threads, || {
            try_each(pieces, |mut piece| {
                fill(&mut piece)?;
                (work.progress)(piece.status.len());
                Ok(())
            })
        })
    }
}
