//! Conversions between vectors and arrays; results are moved, not copied.

use numpy::{IntoPyArray, PyArrayMethods, PyFixedUnicode, ndarray::IntoDimension};
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

    /// Adds an array stored by rows.
    pub fn array(&self, name: &str, values: Vec<f64>, shape: impl IntoDimension) -> PyResult<()> {
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

/// A dictionary of results. `kind from: a, b;` holds fields of a struct under their own names, `kind a = value;` a
/// value; the kind is `vector`, `array [rows, columns]`, `words`, `value`, `cloned` for vectors that stay where they
/// are, or `each` for a field of every row.
macro_rules! fields {
    ($py:ident; $($entries:tt)*) => {{
        let fields = $crate::arrays::Fields::new($py);
        $crate::arrays::fields!(@ fields; $($entries)*);
        fields.finish()
    }};
    (@ $all:ident;) => {};
    (@ $all:ident; cloned $from:ident: $($name:ident),+; $($rest:tt)*) => {
        $($all.vector(stringify!($name), $from.$name.clone())?;)+
        $crate::arrays::fields!(@ $all; $($rest)*);
    };
    (@ $all:ident; each $from:ident: $($name:ident),+; $($rest:tt)*) => {
        $($all.vector(stringify!($name), $from.iter().map(|row| row.$name).collect())?;)+
        $crate::arrays::fields!(@ $all; $($rest)*);
    };
    (@ $all:ident; array $shape:tt $from:ident: $($name:ident),+; $($rest:tt)*) => {
        $($all.array(stringify!($name), $from.$name, $shape)?;)+
        $crate::arrays::fields!(@ $all; $($rest)*);
    };
    (@ $all:ident; array $shape:tt $name:ident = $value:expr; $($rest:tt)*) => {
        $all.array(stringify!($name), $value, $shape)?;
        $crate::arrays::fields!(@ $all; $($rest)*);
    };
    (@ $all:ident; $kind:ident $from:ident: $($name:ident),+; $($rest:tt)*) => {
        $($all.$kind(stringify!($name), $from.$name)?;)+
        $crate::arrays::fields!(@ $all; $($rest)*);
    };
    (@ $all:ident; $kind:ident $name:ident = $value:expr; $($rest:tt)*) => {
        $all.$kind(stringify!($name), $value)?;
        $crate::arrays::fields!(@ $all; $($rest)*);
    };
}

pub(crate) use fields;
