//! Points of an arm with the limits of their contacts.

use impact_core::program::contact::{ContactNormal, MassRule, PathContact, PointLimit, SpeedTable};
use impact_core::program::masses::PointMotion;
use impact_core::program::rows::Waypoints;
use nalgebra::Vector3;
use numeric::error::{Failure, Given};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{signed, unsigned};
use crate::arrays::{Fields, fields};
use crate::contact::arm::Arm;
use crate::errors::{CoreError, CoreResult};
use crate::keywords::Keywords;
use crate::watch::{Report, spread};

/// Points of an arm with the limits of their contacts.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct ProgramContact(pub(super) PathContact);

/// Columns of the limits.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct LimitColumns<'py> {
    point: PyReadonlyArray1<'py, i64>,
    energy: PyReadonlyArray1<'py, f64>,
    body_mass: PyReadonlyArray1<'py, f64>,
    human_speed: PyReadonlyArray1<'py, f64>,
    speed: PyReadonlyArray1<'py, f64>,
    table: PyReadonlyArray1<'py, i64>,
    first: PyReadonlyArray1<'py, f64>,
    last: PyReadonlyArray1<'py, f64>,
}

impl LimitColumns<'_> {
    fn limits(&self) -> PyResult<Vec<PointLimit>> {
        let points =
            unsigned("limits['point']", self.point.as_slice()?).map_err(CoreError::from)?;
        let numbers = [
            &self.energy,
            &self.body_mass,
            &self.human_speed,
            &self.speed,
            &self.first,
            &self.last,
        ];
        let numbers = numbers.map(|column| column.as_slice());
        let [energy, body_mass, human_speed, speed, first, last] = numbers;
        let [energy, body_mass, human_speed, speed, first, last] =
            [energy?, body_mass?, human_speed?, speed?, first?, last?];
        let tables = self.table.as_slice()?;
        let columns = [energy, body_mass, human_speed, speed, first, last];
        if tables.len() != points.len() || columns.iter().any(|column| column.len() != points.len())
        {
            let found = Given::Found("columns of different lengths".into());
            let failure = Failure::invalid("limits", "have a number for each row", found);
            return Err(CoreError::from(failure).into());
        }
        let limit = |(row, point): (usize, &usize)| PointLimit {
            point: *point,
            energy: energy[row],
            body_mass: body_mass[row],
            human_speed: human_speed[row],
            speed: speed[row],
            table: usize::try_from(tables[row]).ok(),
            range: [first[row], last[row]],
        };
        Ok(points.iter().enumerate().map(limit).collect())
    }
}

/// Words and numbers of the rule of masses.
fn rule_of(
    rule: &str,
    direction: &str,
    iso_mass: f64,
) -> CoreResult<(MassRule, ContactNormal, f64)> {
    let unknown = |name: &str, word: &str| {
        CoreError::from(Failure::invalid(
            name,
            "be a known word",
            Given::Word(word.to_owned()),
        ))
    };
    let rule = match rule {
        "larger" => MassRule::Larger,
        "iso" => MassRule::Iso,
        "directional" => MassRule::Directional,
        other => return Err(unknown("rule", other)),
    };
    let normal = match direction {
        "motion" => ContactNormal::Motion,
        "worst" => ContactNormal::Worst,
        other => return Err(unknown("direction", other)),
    };
    Ok((rule, normal, iso_mass))
}

#[pymethods]
impl ProgramContact {
    #[new]
    #[pyo3(signature = (arm, **given))]
    fn new(arm: &Arm, given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let links: Vec<String> = given.take("links")?;
        let points: PyReadonlyArray2<'_, f64> = given.take("points")?;
        let limits: LimitColumns<'_> = given.take("limits")?;
        let tables: Vec<(Vec<f64>, Vec<f64>)> = given.take("tables")?;
        let (rule, direction): (String, String) = (given.take("rule")?, given.take("direction")?);
        let rule = rule_of(&rule, &direction, given.take("iso_mass")?)?;
        given.done()?;
        let places = points.as_slice()?;
        if points.shape() != [links.len(), 3] {
            let given = Given::Count(links.len() as u64);
            let failure =
                Failure::invalid("links", "have one for each point of three numbers", given);
            return Err(CoreError::from(failure).into());
        }
        let placed = links.iter().zip(places.chunks_exact(3));
        let points = placed
            .map(|(link, place)| Ok((arm.0.link(link)?, Vector3::from_column_slice(place))))
            .collect::<Result<Vec<_>, Failure>>();
        let points = points.map_err(CoreError::from)?;
        let tables = tables
            .into_iter()
            .map(|(masses, speeds)| SpeedTable::new(masses, speeds));
        let tables = tables
            .collect::<Result<Vec<_>, Failure>>()
            .map_err(CoreError::from)?;
        let contact = PathContact::new(arm.0.clone(), points, limits.limits()?, tables, rule);
        Ok(Self(contact.map_err(CoreError::from)?))
    }

    /// Velocities and masses of all points at waypoints.
    #[pyo3(signature = (joints, rates, *, body_masses, check_limits = true, threads = None))]
    #[allow(clippy::too_many_arguments)] // extracted from Python objects
    fn masses<'py>(
        &self,
        py: Python<'py>,
        joints: PyReadonlyArray2<'py, f64>,
        rates: PyReadonlyArray2<'py, f64>,
        body_masses: PyReadonlyArray1<'py, f64>,
        check_limits: bool,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let bodies = body_masses.as_slice()?;
        if let Some(wrong) = bodies.iter().find(|mass| mass.is_nan() || **mass <= 0.0) {
            let failure = Failure::invalid("body_masses", "be positive", Given::Number(*wrong));
            return Err(CoreError::from(failure).into());
        }
        let places = vec![0.0; joints.shape()[0]];
        let waypoints = Waypoints {
            joints: joints.as_slice()?,
            rates: rates.as_slice()?,
            places: &places,
            check_limits,
        };
        let found = spread(py, Report::none(), threads, |work| {
            self.0.motions(&waypoints, work)
        })?;
        let fields = Fields::new(py);
        let shape = [places.len(), self.0.points.len()];
        let velocity = found
            .iter()
            .flat_map(|motion| <[f64; 3]>::from(motion.velocity));
        fields.array("velocity", velocity.collect(), [shape[0], shape[1], 3])?;
        let column = |name: &str, of: fn(&PointMotion) -> f64| {
            fields.array(name, found.iter().map(of).collect(), shape)
        };
        column("speed", |motion| motion.speed)?;
        column("mass_along_motion", |motion| motion.along_motion)?;
        column("mass_worst_normal", |motion| motion.worst_normal)?;
        column("mass_energy", |motion| motion.energy)?;
        let reduced = |name: &str, of: fn(&PointMotion, f64) -> f64| {
            let all = found
                .iter()
                .flat_map(|motion| bodies.iter().map(move |body| of(motion, *body)));
            fields.array(name, all.collect(), [shape[0], shape[1], bodies.len()])
        };
        reduced("reduced_along_motion", PointMotion::reduced_along)?;
        reduced("reduced_worst_normal", PointMotion::reduced_worst)?;
        Ok(fields.finish())
    }

    /// Allowed speeds of all points at waypoints.
    #[pyo3(signature = (joints, rates, place, *, every = false, check_limits = true, threads = None))]
    #[allow(clippy::too_many_arguments)] // extracted from Python objects
    fn allowed<'py>(
        &self,
        py: Python<'py>,
        joints: PyReadonlyArray2<'py, f64>,
        rates: PyReadonlyArray2<'py, f64>,
        place: PyReadonlyArray1<'py, f64>,
        every: bool,
        check_limits: bool,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let waypoints = Waypoints {
            joints: joints.as_slice()?,
            rates: rates.as_slice()?,
            places: place.as_slice()?,
            check_limits,
        };
        let found = spread(py, Report::none(), threads, |work| {
            self.0.allowed(&waypoints, every, work)
        })?;
        let count = waypoints.places.len();
        let shape = [count, self.0.points.len()];
        let pairs = found.speed.iter().zip(&found.lowest);
        let scale = pairs.map(|(speed, lowest)| if speed > lowest { lowest / speed } else { 1.0 });
        let governs = found.governs.iter().map(|row| row.map_or(-1, signed));
        let governs = numpy::PyArray1::from_vec(py, governs.collect::<Vec<i64>>());
        let answer = fields! { py;
            array shape scale = scale.collect();
            array shape found: speed, lowest;
            value governs = numpy::PyArrayMethods::reshape(&governs, shape)?;
        };
        if every {
            answer.set_item("allowed", {
                let all = numpy::PyArray1::from_vec(py, found.every);
                numpy::PyArrayMethods::reshape(&all, [count, self.0.limits.len()])?
            })?;
        }
        Ok(answer)
    }
}
