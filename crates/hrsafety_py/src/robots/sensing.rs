//! Sensing: conversion of arguments and results.

use numeric::error::{Failure, Given};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::sensing::measurement::Distribution;
use vff_core::sensing::{
    self, CameraPose, Estimate, Lens, LinearizedCamera, PARAMETERS, PositionError, SensorOptions,
    Track, VisionSensor,
};

use crate::arrays::Fields;
use crate::errors::{CoreError, CoreResult};
use crate::keywords::{Keywords, taken, word};
use crate::maps::Lidar;
use crate::parameters::Scenario;
use crate::watch::{Control, Report, watched};

type Rows<'py> = PyReadonlyArray2<'py, f64>;
type Samples<'py> = PyReadonlyArray1<'py, f64>;
type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// Samples of a path that take less than a look at signals.
const SHORT: usize = 100_000;

/// Row of a point that has no image, or of a time without an estimate.
const NOTHING: [f64; 2] = [f64::NAN; 2];

/// Camera.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Camera(pub sensing::Camera);

#[pymethods]
impl Camera {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let lens = taken!(given: Lens {
            focal_length, radial_distortion, horizontal_scale, image_center, pixel_size, image_size,
        });
        let pose = CameraPose::from_rows(given.take("rotation")?, given.take("translation")?);
        given.done()?;
        Ok(Self(
            sensing::Camera::new(lens, pose).map_err(CoreError::from)?,
        ))
    }

    /// Where the camera is.
    fn position(&self) -> [f64; 3] {
        self.0.pose().position().into()
    }

    /// Pixels of points; NaN for those without an image.
    fn project<'py>(&self, py: Python<'py>, points: Rows<'py>) -> PyResult<Matrix<'py>> {
        let (points, _) = points.as_slice()?.as_chunks::<3>();
        let pixel = |point: &[f64; 3]| self.0.project(*point).unwrap_or(NOTHING);
        matrix(py, points.iter().flat_map(pixel).collect(), 2)
    }

    /// Whether pixels lie in the picture.
    fn contains(&self, pixels: Rows<'_>) -> PyResult<Vec<bool>> {
        let (pixels, _) = pixels.as_slice()?.as_chunks::<2>();
        Ok(pixels.iter().map(|pixel| self.0.contains(*pixel)).collect())
    }

    /// Points at known heights that pixels show; NaN where there is none.
    fn reconstruct<'py>(
        &self,
        py: Python<'py>,
        pixels: Rows<'py>,
        heights: Samples<'py>,
    ) -> PyResult<Matrix<'py>> {
        let (pixels, _) = pixels.as_slice()?.as_chunks::<2>();
        let point = |(pixel, height): (&[f64; 2], &f64)| {
            let shown = self.0.reconstruct(*pixel, *height);
            shown.unwrap_or([f64::NAN; 3])
        };
        let points = pixels.iter().zip(heights.as_slice()?).flat_map(point);
        matrix(py, points.collect(), 3)
    }

    /// Pixels of points with other parameters than those of this camera, and derivatives.
    fn linearize<'py>(
        &self,
        py: Python<'py>,
        parameters: [f64; PARAMETERS],
        points: Rows<'py>,
    ) -> PyResult<(Matrix<'py>, Matrix<'py>)> {
        let near = LinearizedCamera::new(&self.0, &parameters).map_err(CoreError::from)?;
        let (points, _) = points.as_slice()?.as_chunks::<3>();
        let mut pixels = Vec::with_capacity(2 * points.len());
        let mut slopes = Vec::with_capacity(2 * PARAMETERS * points.len());
        for point in points {
            let nothing = (NOTHING, [[f64::NAN; PARAMETERS]; 2]);
            let (pixel, rows) = near.at(*point).unwrap_or(nothing);
            pixels.extend(pixel);
            slopes.extend(rows.into_iter().flatten());
        }
        Ok((matrix(py, pixels, 2)?, matrix(py, slopes, PARAMETERS)?))
    }

    /// Rotation matrix after the turn among parameters.
    fn turned(&self, parameters: [f64; PARAMETERS]) -> CoreResult<[[f64; 3]; 3]> {
        let near = LinearizedCamera::new(&self.0, &parameters)?;
        Ok(near.camera.pose().rotation_rows())
    }
}

/// Estimator of position and velocity.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Estimator(sensing::Estimator);

#[pymethods]
impl Estimator {
    /// Backward differences.
    #[staticmethod]
    fn differences() -> Self {
        Self(sensing::Estimator::Differences)
    }

    /// Constant gains.
    #[staticmethod]
    #[pyo3(signature = (*, position_gain, velocity_gain))]
    fn alpha_beta(position_gain: f64, velocity_gain: f64) -> CoreResult<Self> {
        let estimator = sensing::Estimator::AlphaBeta {
            position_gain,
            velocity_gain,
        };
        Ok(Self(estimator.checked()?))
    }

    /// Kalman filter.
    #[staticmethod]
    #[pyo3(signature = (*, acceleration_deviation, position_deviation, speed_deviation))]
    fn kalman(
        acceleration_deviation: f64,
        position_deviation: f64,
        speed_deviation: f64,
    ) -> CoreResult<Self> {
        let estimator = sensing::Estimator::Kalman {
            acceleration_deviation,
            position_deviation,
            speed_deviation,
        };
        Ok(Self(estimator.checked()?))
    }

    /// Estimates at measured positions; rows of the covariance are position, both, velocity.
    fn track<'py>(
        &self,
        py: Python<'py>,
        time: Samples<'py>,
        position: Rows<'py>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (positions, _) = position.as_slice()?.as_chunks::<2>();
        let times = time.as_slice()?;
        let mut track = Track::new(self.0);
        let mut estimates = Estimates::with_capacity(times.len());
        let mut covariance = Vec::with_capacity(3 * times.len());
        for (time, position) in times.iter().zip(positions) {
            estimates.push(Some(track.measure(*time, *position)));
            covariance.extend(track.covariance());
        }
        let fields = Fields::new(py);
        fields.array("covariance", covariance, [times.len(), 3])?;
        estimates.into_fields(&fields)?;
        Ok(fields.finish())
    }
}

/// Steady gains of a Kalman filter.
#[pyfunction]
#[pyo3(signature = (*, acceleration_deviation, position_deviation, period))]
pub fn steady_gains(
    acceleration_deviation: f64,
    position_deviation: f64,
    period: f64,
) -> CoreResult<[f64; 2]> {
    Ok(sensing::Estimator::steady_gains(
        acceleration_deviation,
        position_deviation,
        period,
    )?)
}

/// Vision of one body.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Vision(pub sensing::Vision);

#[pymethods]
impl Vision {
    #[new]
    #[pyo3(signature = (*, period, delay, error, drop_probability, estimator, compensated))]
    fn new(
        period: f64,
        delay: f64,
        error: &ErrorSource,
        drop_probability: f64,
        estimator: &Estimator,
        compensated: bool,
    ) -> CoreResult<Self> {
        let vision = sensing::Vision {
            period,
            delay,
            error: error.0,
            drop_probability,
            estimator: estimator.0,
            compensated,
        };
        Ok(Self(vision.checked()?))
    }

    /// Frames of a body on a known path, and what is known at the times of the path.
    fn observe<'py>(
        &self,
        py: Python<'py>,
        time: Samples<'py>,
        position: Rows<'py>,
        seed: u64,
        stream: u64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (positions, _) = position.as_slice()?.as_chunks::<2>();
        let times = time.as_slice()?;
        let work = |control: &Control| observed(&self.0, times, positions, (seed, stream), control);
        let (estimates, exposed, measured) = if times.len() < SHORT {
            work(&Control::default()).map_err(CoreError::from)?
        } else {
            watched(py, Report::none(), work)?
        };
        let fields = Fields::new(py);
        let frames = exposed.len();
        fields.vector("exposed", exposed)?;
        fields.array("measured", measured, [frames, 2])?;
        estimates.into_fields(&fields)?;
        Ok(fields.finish())
    }
}

/// Estimates at the times of a path, times of exposures and measured positions.
fn observed(
    vision: &sensing::Vision,
    times: &[f64],
    positions: &[[f64; 2]],
    (seed, stream): (u64, u64),
    control: &Control,
) -> Result<(Estimates, Vec<f64>, Vec<f64>), Failure> {
    vision.check_frames(times.last().copied().unwrap_or(0.0))?;
    let mut sensor = VisionSensor::new(vision, seed, stream)?;
    let mut estimates = Estimates::with_capacity(times.len());
    let (mut exposed, mut measured) = (Vec::new(), Vec::new());
    for (time, position) in times.iter().zip(positions) {
        sensor.sample(*time, *position);
        for frame in sensor.frames() {
            exposed.push(frame.exposed);
            measured.extend(frame.measured.unwrap_or(NOTHING));
        }
        estimates.push(sensor.estimate(*time));
        if control.interrupted() {
            return Err(Failure::Interrupted);
        }
    }
    Ok((estimates, exposed, measured))
}

/// Sensor of a robot, of any kind.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Sensor(pub SensorOptions);

#[pymethods]
impl Sensor {
    /// Sees the robot.
    #[staticmethod]
    fn robot_camera(vision: &Vision) -> Self {
        Self(SensorOptions::RobotCamera(vision.0))
    }

    /// Sees the obstacles that move.
    #[staticmethod]
    fn obstacle_camera(vision: &Vision) -> Self {
        Self(SensorOptions::ObstacleCamera(vision.0))
    }

    /// A sensor on a robot of the core's list.
    #[staticmethod]
    #[pyo3(signature = (name, **given))]
    fn named(name: &str, given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let sensor = sensing::sensor_named(name, &given).map_err(CoreError::from)?;
        given.done()?;
        Ok(Self(sensor))
    }

    /// A lidar, which holds a map and is no list of numbers.
    #[staticmethod]
    fn lidar(lidar: &Lidar) -> Self {
        Self(SensorOptions::Lidar(lidar.0.clone()))
    }

    /// Critical and active radius of what it reads in a scenario, and the distance from the center of
    /// the robot up to which it reads, in m.
    fn sight(&self, scenario: &Scenario) -> CoreResult<(f64, f64, f64)> {
        let Some((regions, reach)) = self.0.sight(&scenario.0)? else {
            let rule = "be a sensor on a robot, whose readings have regions";
            let given = Given::Found("one without".into());
            return Err(Failure::invalid("sensor", rule, given).into());
        };
        Ok((regions.critical_radius, regions.active_radius, reach))
    }
}

/// Error of measured positions.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct ErrorSource(PositionError);

#[pymethods]
impl ErrorSource {
    /// Added to x and y.
    #[staticmethod]
    #[pyo3(signature = (*, distribution, scale))]
    fn plane(distribution: &Bound<'_, PyAny>, scale: f64) -> PyResult<Self> {
        let kinds = [
            ("uniform", Distribution::Uniform),
            ("gaussian", Distribution::Gaussian),
        ];
        let rule = "be \"uniform\" or \"gaussian\"";
        let distribution = word("distribution", distribution, rule, &kinds)?;
        let error = PositionError::Plane {
            distribution,
            scale,
        };
        error.check().map_err(CoreError::from)?;
        Ok(Self(error))
    }

    /// Centroid of a color patch.
    #[staticmethod]
    #[pyo3(signature = (*, camera, believed, height, centroid_deviation))]
    fn patch(
        camera: &Camera,
        believed: &Camera,
        height: f64,
        centroid_deviation: f64,
    ) -> CoreResult<Self> {
        let error = PositionError::Patch {
            camera: camera.0,
            believed: believed.0,
            height,
            deviation: centroid_deviation,
        };
        error.check()?;
        Ok(Self(error))
    }
}

/// Columns of estimates.
struct Estimates {
    position: Vec<f64>,
    velocity: Vec<f64>,
    measured_at: Vec<f64>,
}

impl Estimates {
    fn with_capacity(length: usize) -> Self {
        Self {
            position: Vec::with_capacity(2 * length),
            velocity: Vec::with_capacity(2 * length),
            measured_at: Vec::with_capacity(length),
        }
    }

    fn push(&mut self, estimate: Option<Estimate>) {
        let estimate = estimate.unwrap_or(Estimate {
            position: NOTHING,
            velocity: NOTHING,
            measured_at: f64::NAN,
        });
        self.position.extend(estimate.position);
        self.velocity.extend(estimate.velocity);
        self.measured_at.push(estimate.measured_at);
    }

    fn into_fields(self, fields: &Fields<'_>) -> PyResult<()> {
        let length = self.measured_at.len();
        fields.array("position", self.position, [length, 2])?;
        fields.array("velocity", self.velocity, [length, 2])?;
        fields.vector("measured_at", self.measured_at)
    }
}

fn matrix(py: Python<'_>, values: Vec<f64>, columns: usize) -> PyResult<Matrix<'_>> {
    let rows = values.len() / columns;
    values.into_pyarray(py).reshape([rows, columns])
}
