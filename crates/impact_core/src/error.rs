//! Errors, with the data needed to act on them.

use std::fmt;

/// A value as it was given, for an error message.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// A number.
    Number(f64),
    /// A count or an index.
    Count(u64),
    /// A word.
    Word(String),
}

impl fmt::Display for Given {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(formatter, "{value:?}"),
            Self::Count(count) => write!(formatter, "{count}"),
            Self::Word(word) => formatter.write_str(word),
        }
    }
}

/// What can go wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ImpactError {
    /// An argument breaks a rule.
    #[error("{name} must {requirement}, got {value}")]
    InvalidParameter {
        /// Name of the argument.
        name: String,
        /// The rule.
        requirement: &'static str,
        /// What was given.
        value: Given,
    },
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The thread pool could not be made.
    #[error("no thread pool of {threads} threads: {reason}")]
    Threads {
        /// Number of threads asked for.
        threads: usize,
        /// What the system said.
        reason: String,
    },
}

/// Result of this crate.
pub type Result<T> = std::result::Result<T, ImpactError>;

impl ImpactError {
    /// An argument breaks a rule.
    pub fn invalid(name: impl Into<String>, requirement: &'static str, value: Given) -> Self {
        Self::InvalidParameter {
            name: name.into(),
            requirement,
            value,
        }
    }

    /// The same error with the owner of the argument in front of its name.
    #[must_use]
    pub fn within(self, owner: &str) -> Self {
        match self {
            Self::InvalidParameter {
                name,
                requirement,
                value,
            } => Self::InvalidParameter {
                name: format!("{owner}.{name}"),
                requirement,
                value,
            },
            other => other,
        }
    }
}

/// Passes a finite number.
///
/// # Errors
/// It is not finite.
pub fn finite(name: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ImpactError::invalid(
            name,
            "be finite",
            Given::Number(value),
        ))
    }
}

/// Passes a finite number above zero.
///
/// # Errors
/// It is not finite or not above zero.
pub fn positive(name: &str, value: f64) -> Result<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(ImpactError::invalid(
            name,
            "be finite and positive",
            Given::Number(value),
        ))
    }
}

/// Passes a finite number that is not negative.
///
/// # Errors
/// It is not finite or below zero.
pub fn not_negative(name: &str, value: f64) -> Result<f64> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(ImpactError::invalid(
            name,
            "be finite and not negative",
            Given::Number(value),
        ))
    }
}
