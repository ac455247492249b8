//! Histories of one impact.

use impact_core::criteria;
use impact_core::joint::drive::{self, DriveSegment, Stop};
use impact_core::metrics::{Loads, MetricOptions, Metrics, Status};
use impact_core::parameters::{GRAVITY, System, Target};
use impact_core::response::{
    Approach, Contact, Equations, Method, Response, ResponsePeaks, SimulationOptions, simulate,
    simulate_until,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::fields;
use crate::errors::{CoreError, CoreResult};
use crate::impact::parameters::{self, Foam, Manipulator, system};
use crate::impact::single::row_tuple;
use crate::keywords::{Keywords, taken};
use crate::watch::{Report, watched};

/// Samples of a response that takes less than a look at signals.
const SHORT: f64 = 1e4;

/// Motion of the manipulator's set-point.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct SetPoint(drive::SetPoint);

#[pymethods]
impl SetPoint {
    #[new]
    #[pyo3(signature = (*, segments, feed_forward))]
    fn new(segments: Vec<(f64, f64)>, feed_forward: bool) -> CoreResult<Self> {
        let segments = segments
            .into_iter()
            .map(|(start, acceleration)| DriveSegment {
                start,
                acceleration,
            })
            .collect();
        let set_point = drive::SetPoint {
            segments,
            feed_forward,
        };
        set_point
            .check()
            .map_err(|error| error.within("segments"))?;
        Ok(Self(set_point))
    }
}

/// Segments of a stop after detection.
#[pyfunction]
#[pyo3(signature = (*, manipulator_speed, detection, rest))]
pub fn stopping_segments(
    manipulator_speed: f64,
    detection: f64,
    rest: f64,
) -> CoreResult<Vec<(f64, f64)>> {
    let stop = Stop {
        manipulator_speed,
        detection,
        rest,
    };
    let set_point = drive::SetPoint::stopping(&stop, false)?;
    Ok(set_point
        .segments
        .iter()
        .map(|segment| (segment.start, segment.acceleration))
        .collect())
}

/// Columns of the response, and the row of its metrics.
#[pyfunction]
#[pyo3(signature = (manipulator, foam, head, **given))]
pub fn impact_simulate<'py>(
    py: Python<'py>,
    manipulator: &Manipulator,
    foam: &Foam,
    head: parameters::Target,
    given: Option<Keywords<'py>>,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyTuple>)> {
    let given = given.unwrap_or_default();
    let system = system(manipulator, foam, &head);
    let approach = taken!(given: Approach { closing_speed, manipulator_speed });
    let options = SimulationOptions {
        duration: given.take("duration")?,
        step: given.take("step")?,
        method: if given.take("runge_kutta")? {
            Method::RungeKutta
        } else {
            Method::Exact
        },
        contact: if given.take("unilateral")? {
            Contact::Unilateral
        } else {
            Contact::Linear
        },
        set_point: given.take::<PyRef<'_, SetPoint>>("set_point")?.0.clone(),
        equations: if given.take("as_printed")? {
            Equations::AsPrinted
        } else {
            Equations::Corrected
        },
    };
    given.done()?;
    let run = run(py, &system, &approach, &options)?;
    let row = metrics(&system, &approach, &options, run.peaks)?;
    let fields = fields! { py;
        vector run: time, contact_force, head_acceleration, head_position, head_velocity,
            manipulator_position, manipulator_velocity, compression;
        vector release_times = run.releases;
        vector touch_times = run.touches;
    };
    Ok((fields, row_tuple(py, &row, foam.0.linear_range)?))
}

/// The response; only long work is worth a thread of its own.
fn run(
    py: Python<'_>,
    system: &System,
    approach: &Approach,
    options: &SimulationOptions,
) -> PyResult<Response> {
    if options.duration <= SHORT * options.step {
        let run = py.detach(|| simulate(system, approach, options));
        return Ok(run.map_err(CoreError::from)?);
    }
    watched(py, Report::none(), |control| {
        simulate_until(system, approach, options, &|| control.interrupted())
    })
}

/// Metrics of a response: all of them at constant speed with the right equations, peaks else.
fn metrics(
    system: &System,
    approach: &Approach,
    options: &SimulationOptions,
    peaks: Option<ResponsePeaks>,
) -> CoreResult<Metrics> {
    if options.set_point.segments.is_empty() && options.equations == Equations::Corrected {
        let settings = MetricOptions {
            manipulator_speed: approach.manipulator_speed,
            ..MetricOptions::default()
        };
        return Ok(criteria::metrics(
            system,
            approach.closing_speed,
            &settings,
        )?);
    }
    let peaks = if peaks.is_some() {
        peaks
    } else {
        let exact = SimulationOptions {
            method: Method::Exact,
            step: options.duration,
            ..options.clone()
        };
        simulate(system, approach, &exact)?.peaks
    };
    let status = match peaks {
        _ if system.head == Target::Constrained => Status::Constrained,
        Some(found) if found.impact_duration.is_infinite() => Status::NoRelease,
        Some(found) => Status::released(found.compression, &system.foam),
        None => Status::Released,
    };
    let loads = peaks.map_or(Loads::none(), |found| Loads {
        peak_head_acceleration: found.head_acceleration,
        peak_head_acceleration_g: found.head_acceleration / GRAVITY,
        peak_contact_force: found.contact_force,
        max_compression: found.compression,
        impact_duration: found.impact_duration,
        ..Loads::none()
    });
    Ok(Metrics { loads, status })
}
