//! Shield, yielding and foresight, and the law that holds them.

use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use vff_core::lanes::Vector2;
use vff_core::laws::filters;
use vff_core::laws::foresight;
use vff_core::laws::guide::TakeoverOptions;
use vff_core::laws::safe::{Plans, SafeNavigation};
use vff_core::laws::shield::{
    self, BlindCorner, CornerEdge, Friendly, Guard, KnownVelocity, Person, ShieldLimits,
    StaticObstacles, TrackingError, View,
};
use vff_core::laws::yielding;
use vff_core::unknown::unseen;
use vff_core::world::geometry::RobotState;

use crate::errors::CoreError;
use crate::keywords::{Keywords, parameter_class, taken, value_class};
use crate::laws::Law;
use crate::maps::{Guide, StaticMap};

parameter_class! {
    /// How a robot gives way.
    Yielding(yielding::Yielding) {
        clearance, horizon, time_weight, distance_weight, comfort, goal_weight, reach,
    }
}

parameter_class! {
    /// How a robot looks ahead.
    Foresight(foresight::Foresight) {
        stages, step, clearance, risk_weight, comfort, comfort_weight, change_weight, speed_weight, spread,
        acceleration,
    }
}

/// A filter in the place of a shield.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct SafetyFilter(filters::Filter);

/// Position, velocity and heading of a robot.
type PosedState = ([f64; 2], [f64; 2], f64);

/// Radius, largest speed, largest acceleration, largest turn rate, control period of a robot.
type FilterLimits = (f64, f64, Option<f64>, f64, f64);

#[pymethods]
impl SafetyFilter {
    #[new]
    #[pyo3(signature = (name, **given))]
    fn new(name: &str, given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let filter = filters::Filter::named(name, &given).map_err(CoreError::from)?;
        given.done()?;
        Ok(Self(filter))
    }

    /// Velocity, status, slack and share for a wanted velocity, among people (position, radius, velocity) and points that
    /// stand.
    fn decide(
        &self,
        limits: FilterLimits,
        state: PosedState,
        asked: ([f64; 2], f64),
        people: Vec<PersonState>,
        points: Vec<[f64; 2]>,
    ) -> ([f64; 2], &'static str, [f64; 2]) {
        let near = |(position, radius, velocity): PersonState| filters::Near {
            position: position.into(),
            velocity: velocity.into(),
            radius,
        };
        let people: Vec<_> = people.into_iter().map(near).collect();
        let points: Vec<_> = points.into_iter().map(Vector2::from).collect();
        let (radius, max_speed, max_acceleration, max_turn_rate, period) = limits;
        let seen = filters::Sighted {
            position: state.0.into(),
            velocity: state.1.into(),
            heading: state.2,
            radius,
            max_speed,
            max_acceleration,
            max_turn_rate,
            period,
            people: &people,
            points: &points,
        };
        let found = self.0.decide(&seen, asked.0.into(), asked.1);
        (
            found.velocity.into(),
            found.status.word(),
            [found.slack, found.share],
        )
    }
}

/// Radius, largest speed, largest acceleration and control period of a robot.
type RobotLimits = (f64, f64, f64, f64);

/// Position and velocity of a robot.
type MotionState = ([f64; 2], [f64; 2]);

/// Center, radius and velocity of a person; the velocity is NaN where it is not known.
type PersonState = ([f64; 2], f64, [f64; 2]);

value_class! {
    /// Assumptions about people who are not seen.
    Unseen(unseen::Unseen) of given {
        taken!(given: unseen::Unseen {
            person_radius, person_core, cell, creep_speed, sampling, pose_error, heading_error, range_error,
            sensing = taken!(given: unseen::Sensing { beams, range, field_of_view }),
        })
    }
}

value_class! {
    /// Assumptions of the shield.
    Shield(shield::Shield) of given {
        let bounds: (Option<f64>, Option<f64>) = (
            given.take("velocity_error")?,
            given.take("person_acceleration")?,
        );
        let friendly: (Option<f64>, Option<f64>) = (
            given.take("reaction_time")?,
            given.take("person_deceleration")?,
        );
        let friendly = friendly.0.zip(friendly.1);
        let (absolute, relative) = given.take("velocity_tracking")?;
        let unseen: Option<PyRef<'_, Unseen>> = given.take("unseen")?;
        taken!(given: shield::Shield {
            person_speed, latency, position_error,
            velocity_bounds = bounds.0.zip(bounds.1).map(|(error, most)| [error, most]), margin,
            position_tracking, velocity_tracking = TrackingError { absolute, relative }, wall_margin,
            friendly = friendly.map(|(reaction_time, deceleration)| Friendly {
                reaction_time,
                deceleration,
            }),
            unseen = unseen.map(|unseen| unseen.0),
        })
    }

    /// Velocity that is commanded, the status, and the gap of the wanted and of the commanded one.
    fn decide(
        &self,
        limits: RobotLimits,
        state: MotionState,
        wanted: [f64; 2],
        people: Vec<PersonState>,
    ) -> PyResult<([f64; 2], &'static str, [f64; 2])> {
        let guard = self.guard(limits)?;
        let people: Vec<Person> = people.into_iter().map(|each| self.person(each)).collect();
        let view = seen(state, &people);
        let clipped = guard.clipped(&view.robot, wanted.into());
        let decision = guard.decide(&view, wanted.into());
        let gaps = [clipped, decision.velocity].map(|velocity| guard.gap(&view, velocity));
        let velocity: [f64; 2] = decision.velocity.into();
        Ok((velocity, decision.status.word(), gaps))
    }
}

/// View of a robot in the open.
fn seen((position, velocity): MotionState, people: &[Person]) -> View<'_> {
    View {
        robot: RobotState {
            position: position.into(),
            velocity: velocity.into(),
        },
        people,
        walls: StaticObstacles::NONE,
        hidden: None,
    }
}

impl Shield {
    /// The shield of a robot.
    fn guard(&self, (radius, max_speed, max_acceleration, period): RobotLimits) -> PyResult<Guard> {
        let limits = ShieldLimits {
            radius,
            max_speed,
            max_acceleration,
            period,
        };
        Ok(Guard::new(self.0, limits).map_err(CoreError::from)?)
    }

    fn person(&self, (center, radius, velocity): PersonState) -> Person {
        let known = |[error, acceleration]: [f64; 2]| KnownVelocity {
            velocity: Vector2::from(velocity),
            error,
            acceleration,
        };
        let bounds = self.0.velocity_bounds;
        Person {
            position_error: self.0.position_error,
            max_speed: self.0.person_speed.unwrap_or(f64::INFINITY),
            latency: self.0.latency,
            known: bounds.filter(|_| !velocity[0].is_nan()).map(known),
            ..Person::disc(center, radius)
        }
    }
}

/// Largest speed at an angle to a person, NaN where there is no limit.
#[pyfunction]
pub fn shield_speed_bound(gap: f64, angle: f64, deceleration: f64, person_speed: f64) -> f64 {
    shield::speed_bound(gap, angle, deceleration, person_speed).unwrap_or(f64::NAN)
}

/// Largest speeds past corners behind which a person may be, for places (distance, offset) of an edge: of the near one,
/// of the far one, and wherever the far one is.
#[pyfunction]
#[pyo3(signature = (places, **given))]
pub fn blind_corner_speeds<'py>(
    py: Python<'py>,
    places: PyReadonlyArray2<'_, f64>,
    given: Option<Keywords<'_>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let given = given.unwrap_or_default();
    let corner = taken!(given: BlindCorner {
        robot_radius, person_radius, person_core, margin, wall_thickness, person_speed, latency, control_period,
        deceleration, max_speed,
    });
    given.done()?;
    let corner = corner.checked().map_err(CoreError::from)?;
    let places = places.as_slice()?.as_chunks::<2>().0;
    let found: Vec<f64> = places
        .iter()
        .flat_map(|[distance, offset]| {
            let of = |edge| corner.speed(corner.hidden(edge, *distance, *offset));
            [
                of(CornerEdge::Near),
                of(CornerEdge::Far),
                corner.passing_speed(*offset),
            ]
        })
        .collect();
    found.into_pyarray(py).reshape([places.len(), 3])
}

/// A law with its parts.
#[pyfunction]
#[pyo3(signature = (law, **given))]
pub fn guarded_law(law: &Law, given: Option<Keywords<'_>>) -> PyResult<Law> {
    let given = given.unwrap_or_default();
    let shield: Option<PyRef<'_, Shield>> = given.take("shield")?;
    let filter: Option<PyRef<'_, SafetyFilter>> = given.take("filter")?;
    let yielding: Option<PyRef<'_, Yielding>> = given.take("yielding")?;
    let foresight: Option<PyRef<'_, Foresight>> = given.take("foresight")?;
    let map: Option<PyRef<'_, StaticMap>> = given.take("map")?;
    let guide: Option<PyRef<'_, Guide>> = given.take("guide")?;
    let (progress, window) = given.take("takeover_rule")?;
    // Who reckons with people whom he does not see plans ways of his own.
    let unseen = shield
        .as_ref()
        .is_some_and(|shield| shield.0.unseen.is_some());
    let shared = map.as_ref().filter(|_| !unseen);
    let family = taken!(given: SafeNavigation {
        plans = shared.map_or_else(Plans::default, |map| map.1.clone()),
        map = map.map(|map| map.0.clone()), guide = guide.map(|guide| guide.0),
        rule = TakeoverOptions { progress, window }, shield = shield.map(|shield| shield.0),
        filter = filter.map(|filter| filter.0), yielding = yielding.map(|yielding| yielding.0),
        foresight = foresight.map(|foresight| foresight.0), takeover, preferred_speed,
        critical_distance, ..SafeNavigation::bare(law.any.clone()),
    });
    given.done()?;
    let family = family.checked().map_err(CoreError::from)?;
    Ok(law.within(family.into()))
}
