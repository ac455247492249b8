//! Failures of the cores, with the data needed to act on them.

use std::borrow::Cow;
use std::fmt;

/// A value as it was given, for an error message.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// A number.
    Number(f64),
    /// Two numbers.
    Pair([f64; 2]),
    /// A count or an index.
    Count(u64),
    /// A word that was given.
    Word(String),
    /// A finding in words of ours, shown without quotes.
    Found(Cow<'static, str>),
}

impl fmt::Display for Given {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(formatter, "{value:?}"),
            Self::Pair([x, y]) => write!(formatter, "({x:?}, {y:?})"),
            Self::Count(count) => write!(formatter, "{count}"),
            Self::Word(word) => formatter.write_str(word),
            Self::Found(words) => formatter.write_str(words),
        }
    }
}

/// An argument that breaks a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct InvalidParameter {
    /// Name of the argument.
    pub name: String,
    /// The rule.
    pub requirement: Cow<'static, str>,
    /// The value that was given.
    pub value: Given,
    /// Advice that mends it, if the rule does not say so already.
    pub remedy: Option<String>,
}

impl fmt::Display for InvalidParameter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            requirement,
            value,
            remedy,
        } = self;
        write!(formatter, "{name} must {requirement}, got {value}")?;
        match remedy {
            Some(remedy) => write!(formatter, "; {remedy}"),
            None => Ok(()),
        }
    }
}

/// A run whose state or force is no longer finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NonFinite {
    /// Index of the run.
    pub run: usize,
    /// Time, in s.
    pub time: f64,
}

/// Failure to make a thread pool.
#[derive(Clone, Debug, PartialEq)]
pub struct NoThreads {
    /// Number of threads asked for.
    pub threads: usize,
    /// Reason that the system gave.
    pub reason: String,
}

/// Failure of a core: two words, so that a result with it stays in registers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// An argument breaks a rule.
    #[error("{0}")]
    InvalidParameter(Box<InvalidParameter>),
    /// The state of a run, or the force on it, is no longer finite.
    #[error("the state or the force became non-finite at {} s (run {})", .0.time, .0.run)]
    NonFinite(Box<NonFinite>),
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The thread pool could not be made.
    #[error("no thread pool of {} threads: {}", .0.threads, .0.reason)]
    Threads(Box<NoThreads>),
}

/// Asked now and then whether to stop.
pub type Interrupted<'a> = &'a (dyn Fn() -> bool + Sync);

/// Asks whether to stop: a planner that thinks long looks at it now and then, and what it answers
/// after it was told to stop counts for nothing.
#[derive(Clone, Copy)]
pub struct Stop<'a>(pub &'a (dyn Fn() -> bool + Sync));

impl Stop<'_> {
    /// Nobody asks to stop.
    #[must_use]
    pub fn never() -> Self {
        Self(&|| false)
    }

    /// Whether to stop.
    #[must_use]
    pub fn asked(&self) -> bool {
        (self.0)()
    }
}

impl std::fmt::Debug for Stop<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Stop")
    }
}

/// An error if the caller asked to stop.
///
/// # Errors
/// [`Failure::Interrupted`] if so.
#[inline]
pub fn proceed(interrupted: Interrupted<'_>) -> Result<()> {
    if interrupted() {
        return Err(Failure::Interrupted);
    }
    Ok(())
}

/// Result of the cores.
pub type Result<T> = std::result::Result<T, Failure>;

impl Failure {
    /// An argument breaks a rule.
    pub fn invalid(
        name: impl AsRef<str>,
        requirement: impl Into<Cow<'static, str>>,
        value: Given,
    ) -> Self {
        invalid(name.as_ref(), requirement.into(), value)
    }

    /// The state of a run is no longer finite at a time in s.
    #[cold]
    #[must_use]
    pub fn non_finite(run: usize, time: f64) -> Self {
        Self::NonFinite(Box::new(NonFinite { run, time }))
    }

    /// The error with advice that mends it.
    #[must_use]
    pub fn mended_by(self, advice: impl AsRef<str>) -> Self {
        mended(self, advice.as_ref())
    }

    /// The error with the index of the run among more runs.
    #[must_use]
    pub fn of_run(mut self, index: impl FnOnce(usize) -> usize) -> Self {
        if let Self::NonFinite(lost) = &mut self {
            lost.run = index(lost.run);
        }
        self
    }

    /// The error with the owner of the argument in front of its name.
    #[cold]
    #[must_use]
    pub fn within(mut self, owner: &str) -> Self {
        if let Self::InvalidParameter(invalid) = &mut self {
            invalid.name = format!("{owner}.{}", invalid.name);
        }
        self
    }
}

// What makes errors is compiled once, away from the code that checks.

#[cold]
fn invalid(name: &str, requirement: Cow<'static, str>, value: Given) -> Failure {
    Failure::InvalidParameter(Box::new(InvalidParameter {
        name: name.to_owned(),
        requirement,
        value,
        remedy: None,
    }))
}

#[cold]
fn mended(mut failure: Failure, advice: &str) -> Failure {
    if let Failure::InvalidParameter(invalid) = &mut failure {
        invalid.remedy = Some(advice.to_owned());
    }
    failure
}

/// The error of a number, away from the loops over rows that check them.
#[cold]
fn refused(name: &str, requirement: &'static str, value: f64) -> Failure {
    Failure::invalid(name, requirement, Given::Number(value))
}

/// Returns the number if it is finite.
///
/// # Errors
/// It is not finite.
#[inline]
pub fn finite(name: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(refused(name, "be finite", value))
    }
}

/// Returns the number if it is finite and above zero.
///
/// # Errors
/// It is not finite or not above zero.
#[inline]
pub fn positive(name: &str, value: f64) -> Result<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(refused(name, "be finite and positive", value))
    }
}

/// Returns the number if it is finite and not negative.
///
/// # Errors
/// It is not finite or below zero.
#[inline]
pub fn not_negative(name: &str, value: f64) -> Result<f64> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(refused(name, "be finite and not negative", value))
    }
}

/// Returns the vector if it is finite.
///
/// # Errors
/// A component is not finite.
pub fn finite_pair(name: &str, value: [f64; 2]) -> Result<[f64; 2]> {
    if value.iter().all(|component| component.is_finite()) {
        Ok(value)
    } else {
        Err(Failure::invalid(name, "be finite", Given::Pair(value)))
    }
}

/// Returns a count if it is at most as large as its bound, so that memory is asked for only then.
///
/// # Errors
/// It is larger.
pub fn at_most(name: &str, count: usize, most: usize) -> Result<usize> {
    if count <= most {
        Ok(count)
    } else {
        Err(Failure::invalid(
            name,
            format!("be at most {most}"),
            Given::Count(count as u64),
        ))
    }
}
