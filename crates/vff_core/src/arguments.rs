//! What laws and sensors are made of by name: from a caller, a file, or the command line.

use crate::error::Result;

/// Arguments by name.
pub trait Arguments {
    /// A number.
    ///
    /// # Errors
    /// There is none of this name; likewise for the others.
    fn number(&self, name: &str) -> Result<f64>;
    /// A truth value.
    ///
    /// # Errors
    /// As for numbers.
    fn flag(&self, name: &str) -> Result<bool>;
    /// A count.
    ///
    /// # Errors
    /// As for numbers.
    fn count(&self, name: &str) -> Result<usize>;
    /// A word.
    ///
    /// # Errors
    /// As for numbers.
    fn word(&self, name: &str) -> Result<String>;
    /// Places on a robot, x forward and y left in m, with an angle in rad each.
    ///
    /// # Errors
    /// As for numbers.
    fn places(&self, name: &str) -> Result<Vec<[f64; 3]>>;
}

/// What is made of arguments by its name: a law, a sensor.
pub trait Named: Sized {
    /// Its name in files and on the command line.
    const NAME: &'static str;

    /// Makes it of its arguments.
    ///
    /// # Errors
    /// An argument is missing, or a word or a number is not allowed.
    fn made_of(given: &dyn Arguments) -> Result<Self>;
}
