//! Keyword arguments of Python, taken by name where a struct of the core is built: the names stand in the core's
//! struct and in Python's class only, their types in the core's only.

use numeric::error::{Failure, Given, Result};
use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::{PyTypeError, PyUnicodeEncodeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::arguments::Arguments;

use crate::errors::CoreError;

/// The keyword arguments of a call.
#[derive(Default)]
pub struct Keywords<'py>(Option<Bound<'py, PyDict>>);

impl<'a, 'py> FromPyObject<'a, 'py> for Keywords<'py> {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        // A copy: what is taken from it may be the caller's.
        Ok(Self(Some(given.cast::<PyDict>()?.copy()?)))
    }
}

impl<'py> Keywords<'py> {
    /// Whether an argument is there that nobody took.
    pub fn holds(&self, name: &str) -> PyResult<bool> {
        self.0
            .as_ref()
            .map_or(Ok(false), |items| items.contains(name))
    }

    /// Takes an argument.
    pub fn take<T: FromPyObjectOwned<'py>>(&self, name: &str) -> PyResult<T> {
        let value = self.given(name)?;
        let extracted = value.extract();
        extracted.map_err(|error: T::Error| named(name, error.into(), value.py()))
    }

    /// Takes a word among a few.
    pub fn word<T: Copy>(
        &self,
        name: &str,
        requirement: &'static str,
        meanings: &[(&str, T)],
    ) -> PyResult<T> {
        word(name, &self.given(name)?, requirement, meanings)
    }

    /// Takes an argument as it is: compiled once, not for each type.
    fn given(&self, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let missing = || PyTypeError::new_err(format!("missing argument '{name}'"));
        let items = self.0.as_ref().ok_or_else(missing)?;
        let value = items.get_item(name)?.ok_or_else(missing)?;
        items.del_item(name)?;
        Ok(value)
    }

    /// Refuses arguments that nobody took.
    pub fn done(&self) -> PyResult<()> {
        match &self.0 {
            Some(items) if !items.is_empty() => {
                let names = items.keys();
                Err(PyTypeError::new_err(format!("unknown arguments {names}")))
            }
            _ => Ok(()),
        }
    }
}

/// The error of a conversion with the name of its argument.
#[cold]
fn named(name: &str, error: PyErr, py: Python<'_>) -> PyErr {
    if error.is_instance_of::<PyTypeError>(py) {
        let words = error.value(py);
        PyTypeError::new_err(format!("argument '{name}': {words}"))
    } else if error.is_instance_of::<PyUnicodeEncodeError>(py) {
        let given = Given::Found("a lone surrogate in it".into());
        CoreError::from(Failure::invalid(name, "be text that UTF-8 can hold", given)).into()
    } else {
        error
    }
}

impl Arguments for Keywords<'_> {
    fn number(&self, name: &str) -> Result<f64> {
        self.take(name)
            .map_err(|error| refused(name, "be a number", &error))
    }

    fn flag(&self, name: &str) -> Result<bool> {
        self.take(name)
            .map_err(|error| refused(name, "be a truth value", &error))
    }

    fn count(&self, name: &str) -> Result<usize> {
        self.take(name)
            .map_err(|error| refused(name, "be a count", &error))
    }

    fn word(&self, name: &str) -> Result<String> {
        self.take(name)
            .map_err(|error| refused(name, "be a word", &error))
    }

    fn places(&self, name: &str) -> Result<Vec<[f64; 3]>> {
        self.take(name)
            .map_err(|error| refused(name, "be a sequence of (x, y, axis)", &error))
    }
}

fn refused(name: &str, rule: &'static str, error: &PyErr) -> Failure {
    Failure::invalid(name, rule, Given::Found(error.to_string().into()))
}

/// The meaning of a word among a few, or an error that shows what was given.
pub fn word<T: Copy>(
    name: &str,
    given: &Bound<'_, PyAny>,
    requirement: &'static str,
    meanings: &[(&str, T)],
) -> PyResult<T> {
    let shown = match given.extract::<String>() {
        Ok(text) => match meanings.iter().find(|(key, _)| *key == text) {
            Some((_, meaning)) => return Ok(*meaning),
            None => Given::Word(text),
        },
        Err(error) if error.is_instance_of::<PyUnicodeEncodeError>(given.py()) => {
            return Err(named(name, error, given.py()));
        }
        Err(_) => Given::Found(given.repr()?.to_string().into()),
    };
    let error = Failure::invalid(name, requirement, shown);
    Err(CoreError::from(error).into())
}

/// A struct of the core from arguments: a field alone is taken by its name, `field as name` by another one,
/// `field = value` is not taken.
macro_rules! taken {
    ($given:ident: $core:ty {
        $($field:ident $(as $name:ident)? $(= $value:expr)?),+ $(, ..$rest:expr)? $(,)?
    }) => {{
        type Core = $core;
        Core {
            $($field: $crate::keywords::taken!(@ $given, $field $(as $name)? $(= $value)?),)+
            $(..$rest)?
        }
    }};
    (@ $given:ident, $field:ident) => { $given.take(stringify!($field))? };
    (@ $given:ident, $field:ident as $name:ident) => { $given.take(stringify!($name))? };
    (@ $given:ident, $field:ident = $value:expr) => { $value };
}

/// A class of a checked value of the core that is made of the arguments of a call.
macro_rules! value_class {
    (
        $(#[$about:meta])*
        $name:ident($core:ty) of $given:ident $value:block
        $($methods:tt)*
    ) => {
        $(#[$about])*
        #[pyclass(frozen, module = "hrsafety._hrsafety")]
        pub struct $name(pub $core);

        #[pymethods]
        impl $name {
            #[new]
            #[pyo3(signature = (**given))]
            fn new(given: Option<$crate::keywords::Keywords<'_>>) -> PyResult<Self> {
                let $given = given.unwrap_or_default();
                let core: $core = $value;
                $given.done()?;
                Ok(Self(core.checked().map_err($crate::errors::CoreError::from)?))
            }

            $($methods)*
        }
    };
}

/// A class of checked parameters: made from keywords, and read back by the same names.
macro_rules! parameter_class {
    (
        $(#[$about:meta])*
        $name:ident($core:ty) { $($field:ident),+ $(,)? }
        $($methods:tt)*
    ) => {
        $crate::keywords::value_class! {
            $(#[$about])*
            $name($core) of given { $crate::keywords::taken!(given: $core { $($field),+ }) }

            $(
                #[getter]
                fn $field<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                    pyo3::IntoPyObjectExt::into_bound_py_any(self.0.$field, py)
                }
            )+

            $($methods)*
        }
    };
}

pub(crate) use {parameter_class, taken, value_class};
