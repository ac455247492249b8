//! Parameters of models by name.

use navigation_world::arguments::Arguments;
use numeric::error::{Failure, Given, Result};

/// Parameters of models by name, each by its rule.
pub(in crate::crowd) struct Parameters<'a>(pub &'a dyn Arguments);

impl Parameters<'_> {
    /// A positive parameter.
    pub fn positive(&self, name: &str) -> Result<f64> {
        numeric::error::positive(name, self.0.number(name)?)
    }

    /// A parameter that is not negative.
    pub fn not_negative(&self, name: &str) -> Result<f64> {
        numeric::error::not_negative(name, self.0.number(name)?)
    }

    /// A finite parameter.
    pub fn finite(&self, name: &str) -> Result<f64> {
        numeric::error::finite(name, self.0.number(name)?)
    }

    /// Distance in m beyond which nobody acts, infinite for none.
    pub fn cutoff(&self) -> Result<f64> {
        let cutoff = self.0.number("cutoff")?;
        if cutoff > 0.0 {
            return Ok(cutoff);
        }
        let rule = "be positive, or None for no cutoff";
        Err(Failure::invalid("cutoff", rule, Given::Number(cutoff)))
    }
}
