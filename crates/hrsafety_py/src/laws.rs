//! Navigation laws.

use std::sync::Arc;

use numeric::error::{Failure, Given, Result};
use pyo3::prelude::*;
use vff_core::laws;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::laws::field_d_star::FieldDStar;
use vff_core::laws::pairwise::Pairwise;
use vff_core::laws::planning::family::Planned;
use vff_core::laws::reciprocal::ReciprocalAvoidance;
use vff_core::laws::tree::RapidlyExploringRandomTree;
use vff_core::laws::velocity_obstacle::{Selection, VelocityObstacle};
use vff_core::laws::{BorensteinKoren, GeCui, Khatib, KhatibForm, Masoud};
use vff_core::run::AnyLaw;

use vff_core::laws::impedance::attraction::Attraction;
use vff_core::laws::impedance::law::{Form, Impedance};

use crate::errors::{CoreError, CoreResult, InvalidParameterError};
use crate::python_law::PythonLaw;
use crate::reactive::arena::ImpedanceFamily;

/// A law of any kind.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Law {
    /// The law.
    pub any: AnyLaw,
    field: Option<laws::VirtualForceField>,
    /// Whether it runs under the interpreter.
    python: bool,
}

impl Law {
    /// A law whose numbers are allowed.
    fn checked(law: impl Into<AnyLaw>) -> CoreResult<Self> {
        Ok(Self {
            any: law.into().checked()?,
            field: None,
            python: false,
        })
    }

    /// Whether it runs under the interpreter, and so in the thread of its caller.
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
    #[pyo3(signature = (begin, *, velocity))]
    fn python(begin: Py<PyAny>, velocity: bool) -> Self {
        let begin = Arc::new(begin);
        Self {
            any: AnyLaw::one_by_one(PythonLaw { begin, velocity }),
            field: None,
            python: true,
        }
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

    #[staticmethod]
    #[pyo3(signature = (*, attractive_gain, repulsive_gain, detour_gain))]
    fn masoud(attractive_gain: f64, repulsive_gain: f64, detour_gain: f64) -> CoreResult<Self> {
        Self::checked(Pairwise(Masoud {
            attractive: attractive_gain,
            repulsive: repulsive_gain,
            detour: detour_gain,
        }))
    }

    #[staticmethod]
    #[pyo3(signature = (*, attractive_gain, repulsive_gain, gain_ratio))]
    fn ge_cui(attractive_gain: f64, repulsive_gain: f64, gain_ratio: f64) -> CoreResult<Self> {
        Self::checked(Pairwise(GeCui {
            attractive: attractive_gain,
            repulsive: repulsive_gain,
            ratio: gain_ratio,
            // Every scenario brings the one of its robot.
            max_acceleration: f64::NAN,
        }))
    }

    #[staticmethod]
    #[pyo3(signature = (*, attractive_gain, repulsive_gain, gain_ratio, printed))]
    fn khatib(
        attractive_gain: f64,
        repulsive_gain: f64,
        gain_ratio: f64,
        printed: bool,
    ) -> CoreResult<Self> {
        Self::checked(Pairwise(Khatib {
            attractive: attractive_gain,
            repulsive: repulsive_gain,
            ratio: gain_ratio,
            form: if printed {
                KhatibForm::Printed
            } else {
                KhatibForm::Gradient
            },
        }))
    }

    #[staticmethod]
    #[pyo3(signature = (*, attractive_gain, repulsive_gain, attracted_inside))]
    fn borenstein_koren(
        attractive_gain: f64,
        repulsive_gain: f64,
        attracted_inside: bool,
    ) -> CoreResult<Self> {
        Self::checked(Pairwise(BorensteinKoren {
            attractive: attractive_gain,
            repulsive: repulsive_gain,
            attracted_inside,
        }))
    }

    #[staticmethod]
    #[pyo3(signature = (*, margin, horizon, risk_weight, sector, selection))]
    fn velocity_obstacle(
        margin: f64,
        horizon: f64,
        risk_weight: f64,
        sector: f64,
        selection: &str,
    ) -> CoreResult<Self> {
        let risk = risk_weight;
        let selection = match selection {
            "fastest" => Selection::Fastest { sector },
            "time_and_risk" => Selection::TimeAndRisk { risk },
            "to_goal" => Selection::ToGoal,
            other => {
                let rule = "be one of \"fastest\", \"time_and_risk\", \"to_goal\"";
                return Err(Failure::invalid("selection", rule, Given::Word(other.into())).into());
            }
        };
        Self::checked(Planned(VelocityObstacle {
            margin,
            horizon,
            selection,
            ..VelocityObstacle::default()
        }))
    }

    #[staticmethod]
    #[pyo3(signature = (*, horizon, margin, turn, reach, share))]
    fn reciprocal(
        horizon: f64,
        margin: f64,
        turn: f64,
        reach: f64,
        share: f64,
    ) -> CoreResult<Self> {
        Self::checked(Planned(ReciprocalAvoidance {
            horizon,
            share,
            reach,
            margin,
            turn,
        }))
    }

    #[staticmethod]
    #[pyo3(signature = (*, resolution, margin, horizon, room, look_ahead))]
    fn field_d_star(
        resolution: f64,
        margin: f64,
        horizon: f64,
        room: f64,
        look_ahead: f64,
    ) -> CoreResult<Self> {
        Self::checked(Planned(FieldDStar {
            resolution,
            margin,
            horizon,
            room,
            look_ahead,
        }))
    }

    #[staticmethod]
    #[pyo3(signature = (*, step, goal_probability, waypoint_probability, margin, horizon, room,
        look_ahead, waypoints, draws, keeps_path, safety_draws))]
    #[allow(clippy::too_many_arguments)] // keyword-only in Python
    fn random_tree(
        step: f64,
        goal_probability: f64,
        waypoint_probability: f64,
        margin: f64,
        horizon: f64,
        room: f64,
        look_ahead: f64,
        waypoints: usize,
        draws: usize,
        keeps_path: bool,
        safety_draws: usize,
    ) -> CoreResult<Self> {
        Self::checked(Planned(RapidlyExploringRandomTree {
            step,
            goal_probability,
            waypoint_probability,
            waypoints,
            draws,
            keeps_path,
            margin,
            horizon,
            room,
            look_ahead,
            safety_draws,
        }))
    }

    #[staticmethod]
    #[pyo3(signature = (*, attraction_stiffness, attraction_damping, stiffness, damping,
        safe_distance, speed_limit, reach, view, active))]
    #[allow(clippy::too_many_arguments)] // keyword-only in Python
    fn virtual_impedance(
        attraction_stiffness: f64,
        attraction_damping: f64,
        stiffness: f64,
        damping: f64,
        safe_distance: f64,
        speed_limit: f64,
        reach: f64,
        view: f64,
        active: bool,
    ) -> CoreResult<Self> {
        let form = if active {
            Form::Active
        } else {
            Form::Conventional
        };
        let family = ImpedanceFamily {
            impedance: Impedance {
                form,
                stiffness,
                damping,
                safe_distance,
                speed_limit,
                reference_stiffness: std::f64::consts::E * stiffness,
                reference_damping: damping / std::f64::consts::E,
                clamp: true,
            },
            attraction: Attraction {
                stiffness: attraction_stiffness,
                damping: attraction_damping,
                standoff: 0.0,
            },
            reach,
            view,
        };
        Self::checked(AnyLaw::one_by_one(family))
    }
}
