//! Arguments of laws and sensors by name: from a caller, a file, or the command line.

use numeric::error::Result;

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
    /// The argument is missing, or is of another kind.
    fn flag(&self, name: &str) -> Result<bool>;
    /// A count.
    ///
    /// # Errors
    /// The argument is missing, or is of another kind.
    fn count(&self, name: &str) -> Result<usize>;
    /// A word.
    ///
    /// # Errors
    /// The argument is missing, or is of another kind.
    fn word(&self, name: &str) -> Result<String>;
    /// Places on a robot, x forward and y left in m, with an angle in rad each.
    ///
    /// # Errors
    /// The argument is missing, or is of another kind.
    fn places(&self, name: &str) -> Result<Vec<[f64; 3]>>;
}

/// Class that is made of arguments by its name: a law, a sensor.
pub trait Named: Sized {
    /// Its name in files and on the command line.
    const NAME: &'static str;

    /// Makes it of its arguments.
    ///
    /// # Errors
    /// An argument is missing, or a word or a number is not allowed.
    fn made_of(given: &dyn Arguments) -> Result<Self>;
}
