//! Navigation laws.

use std::sync::Arc;

use numeric::error::Result;
use pyo3::prelude::*;
use vff_core::laws;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::run::{AnyLaw, law_named};

use crate::errors::{CoreError, InvalidParameterError};
use crate::keywords::{Keywords, word};
use crate::python_law::{Answer, PythonLaw};

/// A law of any kind.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Law {
    /// The law.
    pub any: AnyLaw,
    field: Option<laws::VirtualForceField>,
    /// True for a law that runs under the interpreter.
    python: bool,
}

impl Law {
    /// A law whose numbers are allowed, made of all that was given.
    fn made(given: &Keywords<'_>, law: impl Into<AnyLaw>) -> PyResult<Self> {
        given.done()?;
        Self::of(law)
    }

    /// A law whose numbers are allowed.
    pub fn of(law: impl Into<AnyLaw>) -> PyResult<Self> {
        Ok(Self {
            any: law.into().checked().map_err(CoreError::from)?,
            field: None,
            python: false,
        })
    }

    /// A law around this one.
    pub fn within(&self, any: AnyLaw) -> Self {
        Self {
            any,
            field: None,
            python: self.python,
        }
    }

    /// True for a law that runs under the interpreter, and so in the thread of its caller.
    pub fn is_python(&self) -> bool {
        self.python
    }

    /// Threads for runs of the law: one for a law in Python.
    pub fn threads(&self, asked: Option<usize>) -> Option<usize> {
        if self.python { Some(1) } else { asked }
    }

    /// The virtual force field, whose terms are known one by one.
    pub fn field(&self) -> PyResult<&laws::VirtualForceField> {
        self.field.as_ref().ok_or_else(|| {
            let rule = "be a VirtualForceField";
            InvalidParameterError::new_err(("law", rule, self.any.gain_names().to_vec()))
        })
    }
}

#[pymethods]
impl Law {
    /// A law in Python: `begin(robot, start, goal, seed)` returns what is called with the fields of
    /// every situation.
    #[staticmethod]
    #[pyo3(signature = (begin, *, answer))]
    fn python(begin: Py<PyAny>, answer: &Bound<'_, PyAny>) -> PyResult<Self> {
        let begin = Arc::new(begin);
        let answers = [
            ("force", Answer::Force),
            ("velocity", Answer::Velocity),
            ("twist", Answer::Twist),
        ];
        let answer = word("answer", answer, "be force, velocity or twist", &answers)?;
        Ok(Self {
            any: AnyLaw::one_by_one(PythonLaw { begin, answer }),
            field: None,
            python: true,
        })
    }

    #[staticmethod]
    #[pyo3(signature = (*, gains, stabilizing, stabilizing_force_cap, stabilizing_momentum_cap,
        pass_behind, side_hysteresis))]
    fn virtual_force_field(
        gains: [f64; 4],
        stabilizing: &Bound<'_, PyAny>,
        stabilizing_force_cap: Option<f64>,
        stabilizing_momentum_cap: Option<f64>,
        pass_behind: bool,
        side_hysteresis: f64,
    ) -> PyResult<Self> {
        let mode = stabilizing
            .extract::<String>()
            .or_else(|_| stabilizing.repr().map(|shown| shown.to_string()))?;
        let build = || -> Result<_> {
            let stabilizing =
                Stabilizing::named(&mode, stabilizing_force_cap, stabilizing_momentum_cap)?;
            let rules = SideRules {
                pass_behind,
                hysteresis: side_hysteresis,
            };
            laws::VirtualForceField::new(Gains::of(gains), stabilizing, rules)
        };
        let field = build().map_err(CoreError::from)?;
        Ok(Self {
            any: field.into(),
            field: Some(field),
            python: false,
        })
    }

    /// Names of its gains, as the core calls them.
    #[getter]
    fn gain_names(&self) -> Vec<&'static str> {
        self.any.gain_names().to_vec()
    }

    /// Its gains, in that order.
    #[getter]
    fn gains(&self) -> Vec<f64> {
        self.any.gains()
    }

    /// A law of the core's registry.
    #[staticmethod]
    #[pyo3(signature = (name, **given))]
    fn named(name: &str, given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let law = law_named(name, &given).map_err(CoreError::from)?;
        Self::made(&given, law)
    }
}
