//! Sets of cells of a grid, a bit for each.

/// A set of cells, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct CellSet {
    columns: usize,
    rows: usize,
    /// Words of a row.
    width: usize,
    words: Vec<u64>,
}

/// Bits of a word.
const BITS: usize = 64;

impl CellSet {
    /// No cell of a grid.
    #[must_use]
    pub fn empty([columns, rows]: [usize; 2]) -> Self {
        let width = columns.div_ceil(BITS);
        Self {
            columns,
            rows,
            width,
            words: vec![0; width * rows],
        }
    }

    /// The cells of a grid for which something holds, by column and row.
    #[must_use]
    pub fn of(size: [usize; 2], mut holds: impl FnMut([usize; 2]) -> bool) -> Self {
        let mut found = Self::empty(size);
        for row in 0..size[1] {
            for column in 0..size[0] {
                if holds([column, row]) {
                    found.insert([column, row]);
                }
            }
        }
        found
    }

    /// Columns and rows of the grid.
    #[inline]
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    #[inline]
    fn place(&self, [column, row]: [usize; 2]) -> (usize, u64) {
        (row * self.width + column / BITS, 1 << (column % BITS))
    }

    /// Whether a cell of the grid is among them.
    #[inline]
    #[must_use]
    pub fn contains(&self, cell: [usize; 2]) -> bool {
        let (word, bit) = self.place(cell);
        self.words[word] & bit != 0
    }

    /// Adds a cell.
    #[inline]
    pub fn insert(&mut self, cell: [usize; 2]) {
        let (word, bit) = self.place(cell);
        self.words[word] |= bit;
    }

    /// Takes a cell out.
    #[inline]
    pub fn remove(&mut self, cell: [usize; 2]) {
        let (word, bit) = self.place(cell);
        self.words[word] &= !bit;
    }

    /// How many they are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.words
            .iter()
            .map(|word| word.count_ones() as usize)
            .sum()
    }

    /// The cells by column and row, row by row.
    pub fn iter(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        (0..self.rows).flat_map(move |row| {
            let words = self.words[row * self.width..][..self.width].iter();
            words.enumerate().flat_map(move |(index, word)| {
                let mut left = *word;
                std::iter::from_fn(move || {
                    let bit = left.trailing_zeros() as usize;
                    left &= left.wrapping_sub(1);
                    (bit < BITS).then_some([index * BITS + bit, row])
                })
            })
        })
    }

    /// Adds all cells of another set of the same grid.
    pub fn unite(&mut self, other: &Self) {
        for (word, more) in self.words.iter_mut().zip(&other.words) {
            *word |= more;
        }
    }

    /// No cell is left.
    pub fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Takes out the cells whose centers are within a radius, in cells, of those of another set of the same grid.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded by the rows
    pub fn remove_around(&mut self, other: &Self, radius: f64) {
        let (width, rows) = (self.width, self.rows);
        let high = radius.clamp(0.0, rows as f64) as usize;
        // Rows so far above or below reach so far to either side.
        let wide = |up: usize| (radius * radius - (up * up) as f64).max(0.0).sqrt() as usize;
        let mut widened = vec![0; width];
        for row in 0..rows {
            widened.copy_from_slice(&other.words[row * width..][..width]);
            if widened.iter().all(|word| *word == 0) {
                continue;
            }
            let mut reached = 0;
            for up in (0..=high).rev() {
                for _ in reached..wide(up) {
                    widen(&mut widened);
                }
                reached = wide(up);
                let near = [row.checked_sub(up), Some(row + up)];
                for near in near.into_iter().flatten().filter(|near| *near < rows) {
                    let words = &mut self.words[near * width..][..width];
                    for (word, taken) in words.iter_mut().zip(&widened) {
                        *word &= !taken;
                    }
                }
            }
        }
    }

    /// Adds the 8 neighbors of all cells that lie in another set of the same grid.
    pub fn spread(&mut self, within: &Self, beside: &mut Vec<u64>) {
        let width = self.width;
        beside.clear();
        for row in self.words.chunks_exact(width) {
            let first = beside.len();
            beside.extend_from_slice(row);
            widen(&mut beside[first..]);
        }
        for row in 0..self.rows {
            let (first, last) = (row.saturating_sub(1), (row + 1).min(self.rows - 1));
            for index in 0..width {
                let near = (first..=last).fold(0, |word, row| word | beside[row * width + index]);
                let place = row * width + index;
                self.words[place] |= near & within.words[place];
            }
        }
    }
}

/// Adds the cells to the left and to the right of those of a row.
fn widen(row: &mut [u64]) {
    let mut before = 0;
    for index in 0..row.len() {
        let word = row[index];
        let after = row.get(index + 1).map_or(0, |next| next << (BITS - 1));
        row[index] = word | (word << 1) | (before >> (BITS - 1)) | (word >> 1) | after;
        before = word;
    }
}
