//! Repeated measurements: delays of the same sources with fresh noise each time.

use super::burst::Signal;
use super::delays::{DelayFinder, DelayOptions};
use super::microphones::MicrophoneArray;
use super::recording::{Converter, Hearing, record};
use numeric::error::{Failure, Given, Result, finite, not_negative, positive};
use numeric::parallel::{Work, each_run};
use numeric::random::Stream;

/// Measurements of a task: they share plans and buffers.
const TOGETHER: usize = 8;
/// Measurements of a task that only draws jitter; each task has a stream of its own.
const DRAWN_TOGETHER: usize = 1 << 14;

/// Delays of every source and run, the runs of a source side by side, in s.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrialDelays {
    /// Delays of M2 against M1.
    pub delay_12: Vec<f64>,
    /// Delays of M3 against M1.
    pub delay_13: Vec<f64>,
}

impl TrialDelays {
    fn of(pairs: Vec<[f64; 2]>) -> Self {
        let (delay_12, delay_13) = pairs.into_iter().map(|[a, b]| (a, b)).unzip();
        Self { delay_12, delay_13 }
    }
}

/// Microphones, converter and how delays are found, for all measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equipment {
    /// Microphones.
    pub array: MicrophoneArray,
    /// Converter.
    pub converter: Converter,
    /// How delays are found.
    pub options: DelayOptions,
}

/// How often and with which numbers measurements are repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Repetition {
    /// Measurements of each source.
    pub runs: usize,
    /// Seed of the noise.
    pub seed: u64,
}

impl Repetition {
    fn rows(&self, sources: usize) -> Result<usize> {
        sources.checked_mul(self.runs).ok_or_else(|| {
            let given = Given::Count(self.runs as u64);
            Failure::invalid("runs", "be fewer", given)
        })
    }
}

/// Delays with independent Gaussian jitter (s) on each of the three arrivals.
///
/// # Errors
/// A range is not positive, a bearing not finite, the deviation negative, or the caller asks to stop.
pub fn jittered_delays(
    array: &MicrophoneArray,
    sources: &[[f64; 2]],
    deviation: f64,
    repetition: &Repetition,
    work: Work<'_>,
) -> Result<TrialDelays> {
    array.checked()?;
    not_negative("arrival_deviation", deviation)?;
    for [range, bearing] in sources {
        positive("range", *range)?;
        finite("bearing", *bearing)?;
    }
    let Repetition { runs, seed } = *repetition;
    repetition.rows(sources.len())?;
    let tasks = runs.div_ceil(DRAWN_TOGETHER);
    let silent = Work {
        progress: &|_| (),
        ..work
    };
    let blocks = each_run(sources.len() * tasks, silent, |task| {
        let [range, bearing] = sources[task / tasks];
        let count = (runs - task % tasks * DRAWN_TOGETHER).min(DRAWN_TOGETHER);
        let [a, b] = array.delays(range, bearing);
        let mut stream = Stream::new(seed, task as u64);
        let pairs: Vec<_> = (0..count)
            .map(|_| {
                let ([first, second], [third, _]) = (stream.normals(), stream.normals());
                [
                    a + deviation * (second - first),
                    b + deviation * (third - first),
                ]
            })
            .collect();
        (work.progress)(count);
        Ok(pairs)
    })?;
    Ok(TrialDelays::of(blocks.into_iter().flatten().collect()))
}

/// Delays from full waveforms: the burst is recorded and compared in every run.
///
/// # Errors
/// A number is out of range, or the caller asks to stop.
pub fn burst_delays(
    signal: &Signal,
    equipment: &Equipment,
    hearings: &[Hearing],
    repetition: &Repetition,
    work: Work<'_>,
) -> Result<TrialDelays> {
    let rate = equipment.converter.checked()?.sample_rate;
    let Repetition { runs, seed } = *repetition;
    repetition.rows(hearings.len())?;
    let counts = hearings
        .iter()
        .map(|hearing| hearing.count(signal, &equipment.array, rate))
        .collect::<Result<Vec<_>>>()?;
    let tasks = runs.div_ceil(TOGETHER);
    // Measurements count as progress, not tasks.
    let silent = Work {
        progress: &|_| (),
        ..work
    };
    let blocks = each_run(hearings.len() * tasks, silent, |task| {
        let source = task / tasks;
        let (count, first) = (counts[source], task % tasks * TOGETHER);
        let Equipment {
            array,
            converter,
            options,
        } = equipment;
        let mut finder = DelayFinder::new(array, rate, count, *options)?;
        let mut pairs = Vec::with_capacity(TOGETHER);
        for run in first..runs.min(first + TOGETHER) {
            let noise = (source * runs + run) as u64;
            let heard = record(
                signal,
                array,
                converter,
                &hearings[source],
                seed,
                noise,
                work.interrupted,
            )?;
            let (one, rest) = heard.samples.split_at(count);
            let (two, three) = rest.split_at(count);
            pairs.push(finder.delays([one, two, three], work.interrupted)?.delays);
            (work.progress)(1);
        }
        Ok(pairs)
    })?;
    Ok(TrialDelays::of(blocks.into_iter().flatten().collect()))
}
