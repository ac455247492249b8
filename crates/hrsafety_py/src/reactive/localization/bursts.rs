//! Bursts, delays from samples, repeated measurements.

use std::sync::OnceLock;

use numeric::error::{Failure, Given};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::sensing::sound::Interrupted;
use vff_core::sensing::sound::burst::{self, Signal, Sound};
use vff_core::sensing::sound::correlation::Method;
use vff_core::sensing::sound::delays::{DelayFinder, DelayOptions};
use vff_core::sensing::sound::recording::{self, Hearing};
use vff_core::sensing::sound::trials::{
    Equipment, Repetition, TrialDelays, burst_delays, jittered_delays,
};

use crate::arrays::fields;
use crate::errors::{CoreError, CoreResult};
use crate::keywords::{Keywords, parameter_class, taken};
use crate::reactive::localization::MicrophoneArray;
use crate::watch::{Report, spread, watched};

/// Method, band in Hz, interpolation, window, start.
type Options = (String, Option<[f64; 2]>, bool, Option<usize>, Option<usize>);

/// A sound of limited length; its waveform is made when it is heard first.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Burst {
    burst: burst::Burst,
    signal: OnceLock<Signal>,
}

#[pymethods]
impl Burst {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let (low, high): (f64, f64) = (given.take("low")?, given.take("high")?);
        let (kind, seed): (String, u64) = (given.take("kind")?, given.take("seed")?);
        let refused = |name, rule: &'static str, value| -> PyErr {
            CoreError::from(Failure::invalid(name, rule, value)).into()
        };
        let sound = match kind.as_str() {
            "noise" => Sound::Noise { low, high, seed },
            "sweep" => Sound::Sweep { low, high },
            "tone" if low == high => Sound::Tone { frequency: low },
            "tone" => return Err(refused("high", "equal low for a tone", Given::Number(high))),
            _ => {
                let rule = "be one of \"noise\", \"sweep\", \"tone\"";
                return Err(refused("kind", rule, Given::Word(kind)));
            }
        };
        let burst = taken!(given: burst::Burst { sound = sound, duration, level, ramp });
        given.done()?;
        Ok(Self {
            burst: burst.checked().map_err(CoreError::from)?,
            signal: OnceLock::new(),
        })
    }
}

impl Burst {
    fn signal(&self) -> CoreResult<&Signal> {
        if let Some(signal) = self.signal.get() {
            return Ok(signal);
        }
        let made = Signal::new(self.burst)?;
        Ok(self.signal.get_or_init(|| made))
    }
}

parameter_class! {
    /// Analog-to-digital converter.
    Converter(recording::Converter) { sample_rate, bits }
}

/// Frequency that is heard by and from something that moves.
#[pyfunction]
#[pyo3(signature = (frequency, *, speed_of_sound, observer_speed, source_speed))]
pub fn doppler_frequency(
    frequency: f64,
    speed_of_sound: f64,
    observer_speed: f64,
    source_speed: f64,
) -> CoreResult<f64> {
    Ok(burst::doppler_frequency(
        frequency,
        speed_of_sound,
        observer_speed,
        source_speed,
    )?)
}

/// Range, bearing, speeds of observer and source, noise, lead, samples.
type Place = (f64, f64, f64, f64, f64, f64, Option<usize>);

fn hearing(place: Place) -> Hearing {
    let (range, bearing, observer_speed, source_speed, noise, lead, samples) = place;
    Hearing {
        range,
        bearing,
        observer_speed,
        source_speed,
        noise,
        lead,
        samples,
    }
}

/// Samples of three microphones that receive a burst.
#[pyfunction]
#[pyo3(signature = (burst, array, converter, place, *, seed, run))]
pub fn record_burst<'py>(
    py: Python<'py>,
    burst: &Burst,
    array: &MicrophoneArray,
    converter: &Converter,
    place: Place,
    seed: u64,
    run: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let (array, converter, place) = (array.0, converter.0, hearing(place));
    let signal = burst.signal()?;
    let heard = watched(py, Report::none(), |control| {
        let interrupted = || control.interrupted();
        recording::record(signal, &array, &converter, &place, seed, run, &interrupted)
    })?;
    let count = heard.samples.len() / 3;
    Ok(fields! { py;
        array [3, count] heard: samples;
        value clipped = heard.clipped.to_vec();
    })
}

fn delay_options(options: Options, sample_rate: f64) -> CoreResult<DelayOptions> {
    let (method, band, between_samples, window, start) = options;
    let method = match method.as_str() {
        "mean_square" => Method::MeanSquare,
        "cross_correlation" => Method::CrossCorrelation,
        "phase" => Method::Phase {
            band: band.unwrap_or([0.0, 0.5 * sample_rate]),
        },
        _ => {
            let rule = "be one of \"mean_square\", \"cross_correlation\", \"phase\"";
            return Err(Failure::invalid("method", rule, Given::Word(method)).into());
        }
    };
    Ok(DelayOptions {
        method,
        between_samples,
        window,
        start,
    })
}

/// Rows of a matrix of three channels.
fn channels<'a>(samples: &'a PyReadonlyArray2<'_, f64>) -> PyResult<[&'a [f64]; 3]> {
    let count = samples.shape()[1];
    let (first, rest) = samples.as_slice()?.split_at(count);
    let (second, third) = rest.split_at(count);
    Ok([first, second, third])
}

/// Runs a finder, which is told whether to stop, on samples.
fn in_samples<T: Send>(
    py: Python<'_>,
    array: &MicrophoneArray,
    samples: &PyReadonlyArray2<'_, f64>,
    sample_rate: f64,
    options: Options,
    find: impl FnOnce(&mut DelayFinder, [&[f64]; 3], Interrupted<'_>) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let channels = channels(samples)?;
    let options = delay_options(options, sample_rate)?;
    let (array, count) = (array.0, channels[0].len());
    watched(py, Report::none(), |control| {
        let mut finder = DelayFinder::new(&array, sample_rate, count, options)?;
        find(&mut finder, channels, &|| control.interrupted())
    })
}

/// Delays of M2 and M3 against M1 from samples.
#[pyfunction]
pub fn sound_delays<'py>(
    py: Python<'py>,
    array: &MicrophoneArray,
    samples: PyReadonlyArray2<'py, f64>,
    sample_rate: f64,
    options: Options,
) -> PyResult<Bound<'py, PyDict>> {
    let found = in_samples(
        py,
        array,
        &samples,
        sample_rate,
        options,
        DelayFinder::delays,
    )?;
    Ok(fields! { py;
        value delays = found.delays.to_vec();
        value lags = found.lags.to_vec();
        value likeness = found.likeness.to_vec();
        value found: start;
    })
}

/// Likeness over lag from samples.
#[pyfunction]
pub fn likeness_curves<'py>(
    py: Python<'py>,
    array: &MicrophoneArray,
    samples: PyReadonlyArray2<'py, f64>,
    sample_rate: f64,
    options: Options,
) -> PyResult<Bound<'py, PyDict>> {
    let found = in_samples(
        py,
        array,
        &samples,
        sample_rate,
        options,
        DelayFinder::curves,
    )?;
    let [first, second] = found.values;
    Ok(fields! { py;
        vector values_12 = first;
        vector values_13 = second;
    })
}

fn trial_columns(py: Python<'_>, found: TrialDelays) -> PyResult<Bound<'_, PyDict>> {
    Ok(fields! { py;
        vector found: delay_12, delay_13;
    })
}

/// Delays with jitter of the arrivals, the runs of a source side by side.
#[pyfunction]
#[pyo3(signature = (array, sources, **given))]
pub fn jittered_sound_delays<'py>(
    py: Python<'py>,
    array: &MicrophoneArray,
    sources: Vec<[f64; 2]>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let array = array.0;
    let arrival_deviation = given.take("arrival_deviation")?;
    let repetition = taken!(given: Repetition { runs, seed });
    let threads: Option<usize> = given.take("threads")?;
    let progress: Option<Py<PyAny>> = given.take("progress")?;
    given.done()?;
    let total = sources.len().saturating_mul(repetition.runs);
    let report = Report::new(progress.as_ref(), total);
    let found = spread(py, report, threads, |work| {
        jittered_delays(&array, &sources, arrival_deviation, &repetition, work)
    })?;
    trial_columns(py, found)
}

/// Delays from full waveforms, the runs of a source side by side.
#[pyfunction]
#[pyo3(signature = (burst, array, converter, places, options, **given))]
pub fn burst_trial_delays<'py>(
    py: Python<'py>,
    burst: &Burst,
    array: &MicrophoneArray,
    converter: &Converter,
    places: Vec<Place>,
    options: Options,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let equipment = Equipment {
        array: array.0,
        converter: converter.0,
        options: delay_options(options, converter.0.sample_rate)?,
    };
    let repetition = taken!(given: Repetition { runs, seed });
    let threads: Option<usize> = given.take("threads")?;
    let progress: Option<Py<PyAny>> = given.take("progress")?;
    given.done()?;
    let signal = burst.signal()?;
    let total = places.len().saturating_mul(repetition.runs);
    let report = Report::new(progress.as_ref(), total);
    let hearings: Vec<Hearing> = places.into_iter().map(hearing).collect();
    let found = spread(py, report, threads, |work| {
        burst_delays(signal, &equipment, &hearings, &repetition, work)
    })?;
    trial_columns(py, found)
}
