//! Shapes and sonar: conversion of arguments and results.

use numeric::error::finite_pair;
use numeric::random::Stream;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::follower::Sensors;
use vff_core::sensing::sonar::ranging::Normals;
use vff_core::sensing::sonar::{self, Firing, Ranging};
use vff_core::world::frame::Frame;
use vff_core::world::shape::PlacedShape;

use super::{Column, Rows, pairs};
use crate::arrays::fields;
use crate::errors::{CoreError, CoreResult};
use crate::keywords::{Keywords, taken};

/// Stream of a seed for readings outside a run.
const READINGS: u64 = 3;

/// Shape that echoes.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct EchoShape(pub PlacedShape);

#[pymethods]
impl EchoShape {
    #[staticmethod]
    #[pyo3(signature = (*, center, size, angle))]
    fn rectangle(center: [f64; 2], size: [f64; 2], angle: f64) -> CoreResult<Self> {
        Ok(Self(PlacedShape::rectangle(center, size, angle)?))
    }

    #[staticmethod]
    #[pyo3(signature = (*, center, radius))]
    fn disc(center: [f64; 2], radius: f64) -> CoreResult<Self> {
        Ok(Self(PlacedShape::disc(center, radius).checked()?))
    }

    #[staticmethod]
    #[pyo3(signature = (*, start, end))]
    fn wall(start: [f64; 2], end: [f64; 2]) -> CoreResult<Self> {
        finite_pair("start", start)?;
        finite_pair("end", end)?;
        Ok(Self(PlacedShape::wall(start, end).checked()?))
    }
}

/// Shapes of a list.
fn shapes_of(shapes: &[PyRef<'_, EchoShape>]) -> Vec<PlacedShape> {
    shapes.iter().map(|shape| shape.0).collect()
}

/// Ultrasonic sensors of the follower.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Sonar(pub Sensors);

#[pymethods]
impl Sonar {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let ranging = taken!(given: Ranging {
            least as least_range, most as most_range, noise as range_noise, temperature,
            assumed_temperature,
        });
        let sensors = taken!(given: Sensors {
            forward, spacing, fan, beam_width, rays, ranging = ranging,
            firing = Firing::named(&given.take::<String>("firing")?).map_err(CoreError::from)?,
            rear,
        });
        given.done()?;
        sensors.array().map_err(CoreError::from)?;
        Ok(Self(sensors))
    }
}

/// Positions (m) and axes (rad) of the sensors on the robot.
#[pyfunction]
pub fn sonar_mounts<'py>(py: Python<'py>, sonar: &Sonar) -> PyResult<Bound<'py, PyDict>> {
    let array = sonar.0.array().map_err(CoreError::from)?;
    let mounts = array.mounts();
    let places = mounts
        .iter()
        .flat_map(|mount| [mount.position.x, mount.position.y])
        .collect();
    Ok(fields! { py;
        array [mounts.len(), 2] position = places;
        vector axis = mounts.iter().map(Frame::angle).collect();
    })
}

/// Readings (m) of all sensors at poses (x, y, heading), one after the other.
#[pyfunction]
#[pyo3(signature = (sonar, shapes, poses, *, seed, noise))]
pub fn sonar_readings<'py>(
    py: Python<'py>,
    sonar: &Sonar,
    shapes: Vec<PyRef<'py, EchoShape>>,
    poses: Rows<'py>,
    seed: u64,
    noise: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let mut sensors = sonar.0.clone();
    if !noise {
        sensors.ranging.noise = 0.0;
    }
    let array = sensors.array().map_err(CoreError::from)?;
    let shapes = shapes_of(&shapes);
    let count = array.mounts().len();
    let mut normals = Normals::new(Stream::new(seed, READINGS));
    let mut readings = vec![f64::INFINITY; count];
    let mut rows = Vec::new();
    for (step, pose) in poses.as_slice()?.chunks_exact(3).enumerate() {
        let body = Frame::at([pose[0], pose[1]], pose[2]);
        array.measure(&body, &shapes, step, &mut readings, &mut normals);
        rows.extend_from_slice(&readings);
    }
    let samples = rows.len() / count;
    Ok(fields! { py;
        array [samples, count] readings = rows;
    })
}

/// Distances (m) along rays to the first shape; infinite without one.
#[pyfunction]
pub fn cast_rays<'py>(
    py: Python<'py>,
    shapes: Vec<PyRef<'py, EchoShape>>,
    origins: Rows<'py>,
    angles: Column<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let shapes = shapes_of(&shapes);
    let rays = pairs(origins.as_slice()?).zip(angles.as_slice()?);
    let distance = rays.map(|(origin, angle)| {
        let direction = Frame::at(origin.into(), *angle).direction;
        let along = shapes.iter().map(|shape| shape.cast(origin, direction));
        along.fold(f64::INFINITY, f64::min)
    });
    Ok(fields! { py;
        vector distance = distance.collect();
    })
}

/// Speed of sound in m/s at a temperature in degrees Celsius.
#[pyfunction]
pub fn speed_of_sound(temperature: f64) -> f64 {
    sonar::speed_of_sound(temperature)
}
