//! Conversions between vectors and arrays; results are moved, not copied.

use numpy::{IntoPyArray, PyArrayMethods, PyFixedUnicode};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A dictionary of arrays and numbers.
pub struct Fields<'py>(Bound<'py, PyDict>);

impl<'py> Fields<'py> {
    /// An empty dictionary.
    pub fn new(py: Python<'py>) -> Self {
        Self(PyDict::new(py))
    }

    /// The dictionary.
    pub fn finish(self) -> Bound<'py, PyDict> {
        self.0
    }

    /// Adds a plain value.
    pub fn value(&self, name: &str, value: impl IntoPyObject<'py>) -> PyResult<()> {
        self.put(name, value.into_bound_py_any(self.0.py())?)
    }

    /// Adds a vector of numbers.
    pub fn vector<T: numpy::Element>(&self, name: &str, values: Vec<T>) -> PyResult<()> {
        self.put(name, values.into_pyarray(self.0.py()).into_any())
    }

    /// Adds a matrix stored by rows.
    pub fn matrix(
        &self,
        name: &str,
        values: Vec<f64>,
        rows: usize,
        columns: usize,
    ) -> PyResult<()> {
        let values = values.into_pyarray(self.0.py());
        self.put(name, values.reshape([rows, columns])?.into_any())
    }

    /// Adds an array of three axes stored by rows.
    pub fn cube(&self, name: &str, values: Vec<f64>, shape: [usize; 3]) -> PyResult<()> {
        let values = values.into_pyarray(self.0.py());
        self.put(name, values.reshape(shape)?.into_any())
    }

    /// Adds a vector of words of at most nine ASCII letters.
    pub fn words<'a>(&self, name: &str, words: impl Iterator<Item = &'a str>) -> PyResult<()> {
        self.vector(name, words.map(fixed).collect())
    }

    /// Adds an object: compiled once, not for each type.
    fn put(&self, name: &str, value: Bound<'py, PyAny>) -> PyResult<()> {
        self.0.set_item(name, value)
    }
}

fn fixed(word: &str) -> PyFixedUnicode<9> {
    let mut letters = [0; 9];
    for (letter, character) in letters.iter_mut().zip(word.chars()) {
        *letter = u32::from(character);
    }
    letters.into()
}
