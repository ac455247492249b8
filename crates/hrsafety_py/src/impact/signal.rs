//! Injury criteria of sampled signals.

use impact_core::metrics::INJURY_WINDOWS;
use impact_core::parameters::GRAVITY;
use impact_core::signal::{self, Recording};
use numeric::error::Failure;
use numeric::threads::Interrupted;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::errors::CoreError;
use crate::impact::single::row_tuple;
use crate::keywords::{Keywords, word};
use crate::watch::{Report, watched};

/// Samples whose work ends within a tenth of the time that Ctrl-C may take.
const SHORT: usize = 1_000_000;

type Samples<'py> = PyReadonlyArray1<'py, f64>;
/// Criterion from peak (g), duration and longest window (s).
type ClosedForm = fn(f64, f64, f64) -> Result<f64, Failure>;
/// Value, start, end.
type Window = (f64, f64, f64);

/// Work on samples that ends soon after Ctrl-C; only long work is worth a thread of its own.
fn stopped<T: Send>(
    py: Python<'_>,
    samples: usize,
    work: impl FnOnce(Interrupted<'_>) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    if samples <= SHORT {
        return Ok(py.detach(|| work(&|| false)).map_err(CoreError::from)?);
    }
    watched(py, Report::none(), |control| {
        work(&|| control.interrupted())
    })
}

/// Head injury criterion of a signal: value, start, end.
#[pyfunction]
pub fn hic(
    py: Python<'_>,
    time: Samples<'_>,
    acceleration_g: Samples<'_>,
    window: f64,
    interpolate: bool,
) -> PyResult<Window> {
    let (time, signal) = (time.as_slice()?, acceleration_g.as_slice()?);
    let found = stopped(py, time.len(), |interrupted| {
        let found = signal::hic(time, signal, window, interpolate, interrupted)?;
        // With free ends the signal is what its straight lines say, however far apart the samples.
        if !interpolate {
            signal::check_step(time, window, interrupted)?;
        }
        Ok(found)
    })?;
    Ok((found.value, found.start, found.end))
}

/// Features of a signal in the order in which Python takes them.
type Features = (
    f64,
    f64,
    f64,
    f64,
    f64,
    f64,
    f64,
    usize,
    usize,
    f64,
    (f64, f64, f64),
);

/// Features of a signal, see `signal::PulseShape`, with the rest looked for over `rest` seconds, and the
/// area of the push around a window.
#[pyfunction]
pub fn signal_shape(
    py: Python<'_>,
    time: Samples<'_>,
    values: Samples<'_>,
    rest: f64,
    window: (f64, f64),
) -> PyResult<Features> {
    let (time, signal) = (time.as_slice()?, values.as_slice()?);
    let (found, area) = stopped(py, time.len(), |interrupted| {
        let found = signal::shape_until(time, signal, rest, interrupted)?;
        Ok((found, signal::push_around(time, signal, window.0, window.1)))
    })?;
    Ok((
        found.least,
        found.most,
        found.width,
        found.step,
        found.longest_step,
        found.rest,
        found.noise,
        found.rest_samples,
        found.flat,
        area,
        (found.level, found.after, found.straight),
    ))
}

/// Largest moving average of a signal: value, start, end.
#[pyfunction]
pub fn moving_average(
    py: Python<'_>,
    time: Samples<'_>,
    acceleration_g: Samples<'_>,
    width: f64,
) -> PyResult<Window> {
    let (time, signal) = (time.as_slice()?, acceleration_g.as_slice()?);
    let found = stopped(py, time.len(), |interrupted| {
        signal::moving_average(time, signal, width, interrupted)
    })?;
    Ok((found.value, found.start, found.end))
}

/// Level that a signal exceeds without a break: value, start, end.
#[pyfunction]
pub fn contiguous_level(
    py: Python<'_>,
    time: Samples<'_>,
    acceleration_g: Samples<'_>,
    width: f64,
) -> PyResult<Window> {
    let (time, signal) = (time.as_slice()?, acceleration_g.as_slice()?);
    let found = stopped(py, time.len(), |interrupted| {
        signal::contiguous_level(time, signal, width, interrupted)
    })?;
    Ok((found.value, found.start, found.end))
}

/// Head injury criterion of a pulse of a known shape.
#[pyfunction]
pub fn hic_of_pulse(
    shape: &Bound<'_, PyAny>,
    peak_g: f64,
    duration: f64,
    window: f64,
) -> PyResult<f64> {
    let kinds: [(&str, ClosedForm); 3] = [
        ("half_sine", signal::hic_half_sine),
        ("square", signal::hic_square),
        ("triangle", signal::hic_triangle),
    ];
    let rule = "be one of \"half_sine\", \"square\", \"triangle\"";
    let of = word("shape", shape, rule, &kinds)?;
    Ok(of(peak_g, duration, window).map_err(CoreError::from)?)
}

fn slice<'a>(samples: Option<&'a Samples<'_>>) -> PyResult<Option<&'a [f64]>> {
    Ok(samples.map(|samples| samples.as_slice()).transpose()?)
}

/// Numbers, status and whether the foam leaves its linear range, of a recorded impact, and the
/// numbers over the whole record.
#[pyfunction]
#[pyo3(signature = (time, acceleration_g, **given))]
pub fn recorded_metrics<'py>(
    py: Python<'py>,
    time: Samples<'py>,
    acceleration_g: Samples<'py>,
    given: Option<Keywords<'py>>,
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyTuple>)> {
    let given = given.unwrap_or_default();
    let signal = |name| given.take::<Option<Samples<'py>>>(name);
    let (contact_force, compression) = (signal("contact_force")?, signal("compression")?);
    let manipulator_velocity = signal("manipulator_velocity")?;
    let time = time.as_slice()?;
    let recording = Recording {
        time,
        acceleration_g: acceleration_g.as_slice()?,
        contact_force: slice(contact_force.as_ref())?,
        compression: slice(compression.as_ref())?,
        manipulator_velocity: slice(manipulator_velocity.as_ref())?,
        start: given.take("start")?,
        linear_range: given.take("linear_range")?,
        thickness: given.take("thickness")?,
        gravity: GRAVITY,
    };
    given.done()?;
    let found = stopped(py, time.len(), |interrupted| {
        let found = recording.metrics_until(interrupted)?;
        signal::check_step(time, INJURY_WINDOWS[0], interrupted)?;
        Ok(found)
    })?;
    let row = row_tuple(py, &found.metrics, recording.linear_range)?;
    Ok((row, PyTuple::new(py, found.whole.into_array())?))
}
