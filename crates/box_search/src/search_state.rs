//! State of a search: enough to resume it without computing anything again.

use std::collections::BTreeMap;

use crate::evaluated::Evaluated;
use crate::problem::{Bounds, Problem};
use crate::stage::Stage;
use numeric::error::{Failure, Given, Result};

/// First bytes of a stored state: a name and the version of its form.
const MAGIC: &[u8; 8] = b"vffgain1";

/// Values of every piece of work that is done, by stage and index.
///
/// A search that is given this finds the values here instead of computing them, so that it takes
/// the same way as without interruption.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SearchState {
    /// Of the problem's sizes, the bounds and the options.
    fingerprint: u64,
    pieces: BTreeMap<(Stage, usize), Evaluated>,
}

/// FNV-1a over numbers and counts, for a fingerprint and for a check sum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fingerprint(u64);

impl Fingerprint {
    /// Sizes of a problem and its box.
    pub(crate) fn of_box(problem: &dyn Problem, bounds: &Bounds) -> Self {
        Self::new()
            .count(problem.dimension())
            .count(problem.objectives())
            .count(problem.constraints())
            .count(problem.block())
            .numbers(bounds.lower())
            .numbers(bounds.upper())
    }

    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
        self
    }

    pub fn count(self, count: usize) -> Self {
        self.bytes(&(count as u64).to_le_bytes())
    }

    pub fn numbers(self, numbers: &[f64]) -> Self {
        let with = |sum: Self, number: &f64| sum.bytes(&number.to_bits().to_le_bytes());
        numbers.iter().fold(self.count(numbers.len()), with)
    }

    pub fn value(self) -> u64 {
        self.0
    }
}

impl SearchState {
    /// Nothing done yet.
    pub(crate) fn new(fingerprint: u64) -> Self {
        Self {
            fingerprint,
            pieces: BTreeMap::new(),
        }
    }

    /// The state to resume from.
    ///
    /// # Errors
    /// It belongs to another search.
    pub(crate) fn resumed(resume: Option<&Self>, fingerprint: u64) -> Result<Self> {
        match resume {
            None => Ok(Self::new(fingerprint)),
            Some(state) if state.fingerprint == fingerprint => Ok(state.clone()),
            Some(_) => Err(refused(
                "belong to a search with the same bounds and options",
            )),
        }
    }

    pub(crate) fn piece(&self, stage: Stage, index: usize) -> Option<&Evaluated> {
        self.pieces.get(&(stage, index))
    }

    pub(crate) fn insert(&mut self, stage: Stage, index: usize, piece: Evaluated) {
        self.pieces.insert((stage, index), piece);
    }

    /// The values of a piece that grows.
    pub(crate) fn growing(&mut self, stage: Stage, index: usize) -> &mut Evaluated {
        self.pieces.entry((stage, index)).or_default()
    }

    /// The state in a form of its own, with a check sum.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        push_word(&mut bytes, self.fingerprint);
        push_word(&mut bytes, self.pieces.len() as u64);
        for ((stage, index), piece) in &self.pieces {
            let (kind, round) = code(*stage);
            push_word(&mut bytes, kind);
            push_word(&mut bytes, round as u64);
            push_word(&mut bytes, *index as u64);
            for numbers in [&piece.values, &piece.margins] {
                push_word(&mut bytes, numbers.len() as u64);
                for number in numbers {
                    push_word(&mut bytes, number.to_bits());
                }
            }
            push_word(&mut bytes, piece.failed.len() as u64);
            bytes.extend(piece.failed.iter().map(|failed| u8::from(*failed)));
        }
        let sum = Fingerprint::new().bytes(&bytes).value();
        push_word(&mut bytes, sum);
        bytes
    }

    /// A stored state.
    ///
    /// # Errors
    /// The bytes are not a state, are cut off, or were changed.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let damaged = || refused("be a whole, unchanged state of a search");
        let (body, sum) = bytes.split_last_chunk::<8>().ok_or_else(damaged)?;
        let mut reader = Reader(body.strip_prefix(MAGIC).ok_or_else(damaged)?);
        if u64::from_le_bytes(*sum) != Fingerprint::new().bytes(body).value() {
            return Err(damaged());
        }
        reader.state().ok_or_else(damaged)
    }
}

fn refused(requirement: &'static str) -> Failure {
    let given = Given::Found("another one".into());
    Failure::invalid("checkpoint", requirement, given)
}

fn code(stage: Stage) -> (u64, usize) {
    match stage {
        Stage::Grid { round } => (0, round),
        Stage::Local => (1, 0),
        Stage::Global => (2, 0),
        Stage::Front { round } => (3, round),
    }
}

fn push_word(bytes: &mut Vec<u8>, word: u64) {
    bytes.extend(word.to_le_bytes());
}

/// Takes a stored state apart; `None` when it is cut off.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn word(&mut self) -> Option<u64> {
        let (word, rest) = self.0.split_first_chunk::<8>()?;
        self.0 = rest;
        Some(u64::from_le_bytes(*word))
    }

    fn count(&mut self) -> Option<usize> {
        usize::try_from(self.word()?).ok()
    }

    fn take(&mut self, count: usize) -> Option<&[u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn numbers(&mut self) -> Option<Vec<f64>> {
        let count = self.count()?;
        let bytes = self.take(count.checked_mul(8)?)?;
        let (words, _) = bytes.as_chunks::<8>();
        let number = |word: &[u8; 8]| f64::from_bits(u64::from_le_bytes(*word));
        Some(words.iter().map(number).collect())
    }

    fn piece(&mut self) -> Option<((Stage, usize), Evaluated)> {
        let (kind, round) = (self.word()?, self.count()?);
        let stage = match kind {
            0 => Stage::Grid { round },
            1 => Stage::Local,
            2 => Stage::Global,
            3 => Stage::Front { round },
            _ => return None,
        };
        let index = self.count()?;
        let (values, margins) = (self.numbers()?, self.numbers()?);
        let count = self.count()?;
        let failed = self.take(count)?.iter().map(|byte| *byte != 0).collect();
        let piece = Evaluated {
            values,
            margins,
            failed,
        };
        Some(((stage, index), piece))
    }

    fn state(&mut self) -> Option<SearchState> {
        let fingerprint = self.word()?;
        let count = self.word()?;
        let pieces = (0..count)
            .map(|_| self.piece())
            .collect::<Option<BTreeMap<_, _>>>()?;
        self.0.is_empty().then_some(SearchState {
            fingerprint,
            pieces,
        })
    }
}
