//! Paths of the joints and the fastest motion along them.

use impact_core::program::path::JointPath;
use impact_core::program::retime::{MotionLimits, Reason, Verification, retime};
use impact_core::program::spline;
use numeric::error::{Failure, Given};
use numpy::{
    IntoPyArray, PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyReadonlyArray3, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::contact::ProgramContact;
use super::{signed, unsigned};
use crate::arrays::fields;
use crate::errors::CoreError;
use crate::watch::{Report, spread};

fn path_of(
    s: &PyReadonlyArray1<'_, f64>,
    coefficients: &PyReadonlyArray3<'_, f64>,
) -> PyResult<JointPath> {
    let (nodes, shape) = (s.as_slice()?, coefficients.shape());
    if shape[0] + 1 != nodes.len() || shape[1] != 4 {
        let given =
            Given::Found(format!("the shape ({}, {}, {})", shape[0], shape[1], shape[2]).into());
        let rule = "have the shape (intervals, 4, joints), with one interval less than nodes";
        return Err(CoreError::from(Failure::invalid("coefficients", rule, given)).into());
    }
    let path = JointPath::new(nodes.to_vec(), coefficients.as_slice()?.to_vec(), shape[2]);
    Ok(path.map_err(CoreError::from)?)
}

fn coefficients_of<'py>(py: Python<'py>, path: &JointPath) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let all = path.coefficients().to_vec().into_pyarray(py);
    all.reshape([path.intervals(), 4, path.joints()])
}

/// Coefficients of the spline through rows of values.
#[pyfunction]
pub fn program_spline<'py>(
    py: Python<'py>,
    knots: PyReadonlyArray1<'py, f64>,
    values: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let found = spline::through(knots.as_slice()?, values.as_slice()?, values.shape()[1]);
    coefficients_of(py, &found.map_err(CoreError::from)?)
}

/// Nodes and coefficients.
type PathPieces<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray3<f64>>);

/// A path with every interval cut into equal ones.
#[pyfunction]
pub fn program_refine<'py>(
    py: Python<'py>,
    s: PyReadonlyArray1<'py, f64>,
    coefficients: PyReadonlyArray3<'py, f64>,
    parts: PyReadonlyArray1<'py, i64>,
) -> PyResult<PathPieces<'py>> {
    let parts = unsigned("parts", parts.as_slice()?).map_err(CoreError::from)?;
    let found = path_of(&s, &coefficients)?
        .refined(&parts)
        .map_err(CoreError::from)?;
    let coefficients = coefficients_of(py, &found)?;
    Ok((found.nodes().to_vec().into_pyarray(py), coefficients))
}

/// The fastest motion along a path.
#[pyfunction]
#[pyo3(signature = (
    s, coefficients, *, velocity, acceleration, stops, contact = None, path_speed = None, threads = None
))]
#[allow(clippy::too_many_arguments)] // extracted from Python objects
pub fn program_retime<'py>(
    py: Python<'py>,
    s: PyReadonlyArray1<'py, f64>,
    coefficients: PyReadonlyArray3<'py, f64>,
    velocity: PyReadonlyArray1<'py, f64>,
    acceleration: PyReadonlyArray1<'py, f64>,
    stops: PyReadonlyArray1<'py, i64>,
    contact: Option<Bound<'py, ProgramContact>>,
    path_speed: Option<PyReadonlyArray1<'py, f64>>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let path = path_of(&s, &coefficients)?;
    let stops = unsigned("stops", stops.as_slice()?).map_err(CoreError::from)?;
    let path_speed = path_speed
        .as_ref()
        .map(|speeds| speeds.as_slice())
        .transpose()?;
    let limits = MotionLimits {
        velocity: velocity.as_slice()?,
        acceleration: acceleration.as_slice()?,
        stops: &stops,
        path_speed,
        contact: contact.as_ref().map(|contact| &contact.get().0),
    };
    let found = spread(py, Report::none(), threads, |work| {
        retime(&path, &limits, work)
    })?;
    let share =
        |which: usize| -> Vec<f64> { found.shares.iter().map(|shares| shares[which]).collect() };
    let largest = found
        .shares
        .iter()
        .flatten()
        .fold(0.0_f64, |most, share| most.max(*share));
    let stands = found.squares.windows(2).position(|pair| pair == [0.0; 2]);
    let codes = found.reasons.iter().map(|reason| match reason {
        Reason::Acceleration(joint) => (0_u8, signed(*joint)),
        Reason::Velocity(joint) => (1, signed(*joint)),
        Reason::Contact(limit) => (2, signed(*limit)),
        Reason::PathSpeed => (3, -1),
    });
    let (reason, reason_index): (Vec<u8>, Vec<i64>) = codes.unzip();
    let rows = found.contacts.iter().map(|row| row.map_or(-1, signed));
    let mut rows: Vec<i64> = rows.collect();
    rows.resize(path.intervals(), -1);
    Ok(fields! { py;
        value status = found.status.word();
        value rounds = found.rounds;
        value standstill = if found.status == Verification::Standstill { stands.map_or(-1, signed) } else { -1 };
        value time = found.times.last().copied().unwrap_or(0.0);
        vector acceleration_share = share(0);
        vector velocity_share = share(1);
        vector contact_share = share(2);
        value largest_share = largest;
        vector reason = reason;
        vector reason_index = reason_index;
        vector contact_row = rows;
        vector t = found.times;
        vector x = found.squares;
    })
}
