//! Worlds that end because a state is no longer finite.

/// Whose state is no longer finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diverged {
    /// A person by number.
    Person(usize),
    /// A robot by number.
    Robot(usize),
}

/// The end of a world whose state is no longer finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Divergence {
    /// When, in s.
    pub time: f64,
    /// Who it is.
    pub agent: Diverged,
}
