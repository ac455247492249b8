//! Arms: conversions only, everything is computed by the core.

use impact_core::arm::batch::PointState;
use impact_core::arm::body::Body;
use impact_core::arm::mobility::Extremes;
use impact_core::arm::sources::Base;
use impact_core::arm::{self, Broadcast, JointKind, Options, Places};
use impact_core::bare;
use nalgebra::{Matrix3, Vector3};
use numeric::error::Result;
use numeric::parallel::Work;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Fields;
use crate::errors::CoreError;
use crate::keywords::{Keywords, taken};
use crate::watch::{Control, Report, here, watched};

/// Results that are computed in the calling thread.
const FEW: usize = 1000;

/// An arm on a base that stands still.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Arm(pub(crate) arm::Arm);

/// Link, mass, center and inertia by rows.
type Load = (String, f64, [f64; 3], [[f64; 3]; 3]);

/// A base that rolls: whether to its left, too, mass, inertia, axle, heading.
type Rolling = (bool, f64, Option<f64>, [f64; 2], f64);

#[pymethods]
impl Arm {
    #[new]
    #[pyo3(signature = (urdf, **given))]
    fn new(urdf: &str, given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let payloads: Vec<Load> = given.take("payloads")?;
        let base: Option<Rolling> = given.take("base")?;
        let payload = |(link, mass, center, rows): Load| arm::Payload {
            link,
            body: Body {
                mass,
                center: Vector3::from(center),
                inertia: Matrix3::from_fn(|row, column| rows[row][column]),
            },
        };
        let base = base.map(|(omni, mass, inertia, axle, heading)| Base {
            omni,
            mass,
            inertia,
            axle,
            heading,
        });
        let options = taken!(given: Options {
            payloads = payloads.into_iter().map(payload).collect(), base = base, armature, locked, repair_inertia,
            link_masses, scaled_to,
        });
        given.done()?;
        let arm = arm::Arm::from_urdf(urdf, &options).map_err(CoreError::from)?;
        Ok(Self(arm))
    }

    /// Properties of the arm that need no pose.
    fn facts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (arm, fields) = (&self.0, Fields::new(py));
        let kind = |kind| match kind {
            JointKind::Turning => "turning",
            JointKind::Sliding => "sliding",
        };
        let joints = || arm.joints.iter();
        fields.value("name", &arm.name)?;
        let names: Vec<&str> = joints().map(|joint| joint.name.as_str()).collect();
        fields.value("joint_names", names)?;
        let kinds: Vec<&str> = joints().map(|joint| kind(joint.kind)).collect();
        fields.value("joint_kinds", kinds)?;
        fields.vector("lower", joints().map(|joint| joint.limits[0]).collect())?;
        fields.vector("upper", joints().map(|joint| joint.limits[1]).collect())?;
        let free: Vec<bool> = joints().map(|joint| joint.column.is_some()).collect();
        fields.value("free", free)?;
        let links: Vec<&str> = arm.links.iter().map(|link| link.name.as_str()).collect();
        fields.value("link_names", links)?;
        let parents: Vec<Option<usize>> = arm.links.iter().map(|link| link.parent).collect();
        fields.value("parents", parents)?;
        let moved: Vec<bool> = arm
            .links
            .iter()
            .map(|link| link.segment.is_some())
            .collect();
        fields.value("moved", moved)?;
        let segments: Vec<Option<usize>> = arm.links.iter().map(|link| link.segment).collect();
        fields.value("segments", segments)?;
        let carriers: Vec<Option<usize>> = arm.segments.iter().map(|each| each.parent).collect();
        fields.value("segment_parents", carriers)?;
        fields.vector(
            "link_masses",
            arm.links.iter().map(|link| link.mass).collect(),
        )?;
        let centers = arm.links.iter().map(|link| link.off_center);
        fields.vector("link_off_centers", centers.collect())?;
        let moments = arm.links.iter().flat_map(|link| link.moments);
        fields.array("link_moments", moments.collect(), [arm.links.len(), 3])?;
        let sizes = || {
            let all = arm.links.iter();
            all.map(|link| {
                link.size
                    .map_or([f64::NAN; 2], |size| [size.volume, size.diagonal])
            })
        };
        fields.vector("link_volumes", sizes().map(|size| size[0]).collect())?;
        fields.vector("link_diagonals", sizes().map(|size| size[1]).collect())?;
        let whole: Vec<bool> = arm
            .links
            .iter()
            .map(|link| link.size.is_some_and(|size| size.whole))
            .collect();
        fields.value("link_whole", whole)?;
        fields.value(
            "chained",
            arm.segments.iter().any(|each| each.parent.is_some()),
        )?;
        fields.vector("largest_own", arm.survey.largest_own.clone())?;
        fields.value("reach", arm.survey.reach)?;
        fields.value("massless_joints", &arm.survey.massless)?;
        fields.value("wheels", &arm.survey.wheels)?;
        fields.value("floors", &arm.survey.floors)?;
        let projected: Vec<(&str, f64, [f64; 2])> = arm
            .projected
            .iter()
            .map(|each| (each.link.as_str(), each.violation, each.traces))
            .collect();
        fields.value("projected", projected)?;
        fields.value("not_used", &arm.not_used)?;
        fields.value("passed_over", &arm.passed_over)?;
        fields.value("turned", &arm.turned)?;
        fields.value("total_mass", arm.total_mass)?;
        fields.value("moving_mass", arm.moving_mass)?;
        fields.value("payload_mass", arm.payload_mass)?;
        fields.value("iso_mass", arm.iso_mass())?;
        fields.value("suspicious_links", &arm.suspicious)?;
        fields.value("links_without_mass", &arm.without_mass)?;
        fields.value("has_armature", arm.has_armature)?;
        Ok(fields.finish())
    }

    /// Effective masses along directions.
    fn effective_mass<'py>(
        &self,
        py: Python<'py>,
        given: PointArguments<'py>,
        directions: RowAxes<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let directions = directions.broadcast(3)?;
        let found = given.compute(py, &self.0, |places, work| {
            self.0.effective_masses(places, &directions, work)
        })?;
        Ok(found.into_pyarray(py))
    }

    /// Positions, mobilities, heaviest and lightest directions of points.
    fn point_states<'py>(
        &self,
        py: Python<'py>,
        given: PointArguments<'py>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let found = given.compute(py, &self.0, |places, work| {
            self.0.point_states(places, work)
        })?;
        let (fields, count) = (Fields::new(py), found.len());
        let vectors = |of: fn(&PointState) -> Vector3<f64>| -> Vec<f64> {
            found
                .iter()
                .flat_map(|state| <[f64; 3]>::from(of(state)))
                .collect()
        };
        let masses = |of: fn(&Extremes) -> f64| -> Vec<f64> {
            found.iter().map(|state| of(&state.extremes)).collect()
        };
        fields.array("position", vectors(|state| state.position), [count, 3])?;
        let mobility = found
            .iter()
            .flat_map(|state| state.mobility.0.iter().copied());
        fields.array("mobility", mobility.collect(), [count, 3, 3])?;
        fields.vector("worst_mass", masses(|extremes| extremes.worst_mass))?;
        fields.vector("least_mass", masses(|extremes| extremes.least_mass))?;
        let worst = vectors(|state| state.extremes.worst_direction);
        fields.array("worst_direction", worst, [count, 3])?;
        let least = vectors(|state| state.extremes.least_direction);
        fields.array("least_direction", least, [count, 3])?;
        Ok(fields.finish())
    }

    /// Lower triangles of mass matrices, and weights, of the free joints in each pose.
    fn dynamics<'py>(
        &self,
        py: Python<'py>,
        given: PointArguments<'py>,
        gravity: f64,
    ) -> PyResult<[Bound<'py, PyArray1<f64>>; 2]> {
        let found = given.compute(py, &self.0, |places, work| {
            self.0.dynamics(places, gravity, work)
        })?;
        Ok([0, 1].map(|part| {
            let numbers: Vec<f64> = found
                .iter()
                .flat_map(|row| row[part].iter().copied())
                .collect();
            numbers.into_pyarray(py)
        }))
    }

    /// Velocities of points for rates of all joints.
    fn velocities<'py>(
        &self,
        py: Python<'py>,
        given: PointArguments<'py>,
        rates: RowAxes<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let rates = rates.broadcast(self.0.joints.len())?;
        let found = given.compute(py, &self.0, |places, work| {
            self.0.velocities(places, &rates, work)
        })?;
        let numbers: Vec<f64> = found.into_iter().flat_map(<[f64; 3]>::from).collect();
        Ok(numbers.into_pyarray(py))
    }
}

/// Numbers by rows, and how many rows apart neighbors along each axis of the result are.
#[derive(FromPyObject)]
pub struct RowAxes<'py>(PyReadonlyArray1<'py, f64>, Vec<usize>);

impl RowAxes<'_> {
    fn broadcast(&self, width: usize) -> PyResult<Broadcast<'_>> {
        Ok(Broadcast {
            rows: self.0.as_slice()?,
            width,
            strides: &self.1,
        })
    }
}

/// Arguments of all functions of points.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct PointArguments<'py> {
    link: String,
    joints: RowAxes<'py>,
    points: RowAxes<'py>,
    shape: Vec<usize>,
    check_limits: bool,
    threads: Option<usize>,
}

impl PointArguments<'_> {
    /// Computes without the interpreter, which is asked for Ctrl-C meanwhile.
    fn compute<T: Send>(
        &self,
        py: Python<'_>,
        arm: &arm::Arm,
        of: impl FnOnce(&Places<'_>, Work<'_>) -> Result<T> + Send,
    ) -> PyResult<T> {
        let places = Places {
            link: arm.link(&self.link).map_err(CoreError::from)?,
            joints: self.joints.broadcast(arm.joints.len())?,
            points: self.points.broadcast(3)?,
            shape: &self.shape,
            check_limits: self.check_limits,
        };
        let threads = self.threads;
        let count: usize = self.shape.iter().product();
        let run = |control: &Control<'_>| {
            let work = Work {
                threads,
                interrupted: &|| control.interrupted(),
                progress: &|done| control.count(done),
            };
            of(&places, work)
        };
        // A few poses take less time than a thread.
        if count <= FEW {
            here(py, Report::none(), run)
        } else {
            watched(py, Report::none(), run)
        }
    }
}

/// Names of the joints of a URDF that take values.
#[pyfunction]
pub fn urdf_joint_names(urdf: &str) -> PyResult<Vec<String>> {
    Ok(arm::build::joint_names(urdf).map_err(CoreError::from)?)
}

/// The nearest inertia that a rigid body can have, and by how much of its trace a given one misses that.
#[pyfunction]
pub fn nearest_inertia(inertia: [[f64; 3]; 3]) -> PyResult<([[f64; 3]; 3], f64)> {
    let body = Body {
        inertia: Matrix3::from_fn(|row, column| inertia[row][column]),
        ..Body::default()
    };
    let body = body.finite().map_err(CoreError::from)?;
    let violation = body.violation();
    let found = if violation > arm::body::ROUNDING {
        body.nearest().inertia
    } else {
        body.inertia
    };
    let rows = std::array::from_fn(|row| std::array::from_fn(|column| found[(row, column)]));
    Ok((rows, violation))
}

/// Contact forces of closing speeds on a linear region without a covering.
#[pyfunction]
pub fn bare_forces<'py>(
    py: Python<'py>,
    closing_speed: PyReadonlyArray1<'py, f64>,
    robot_mass: PyReadonlyArray1<'py, f64>,
    body_mass: f64,
    stiffness: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let pairs = closing_speed.as_slice()?.iter().zip(robot_mass.as_slice()?);
    let forces: Vec<f64> = pairs
        .map(|(speed, mass)| {
            bare::peak_force(*speed, bare::reduced_mass(*mass, body_mass), stiffness)
        })
        .collect();
    Ok(forces.into_pyarray(py))
}
