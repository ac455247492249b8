//! Loads of a recorded impact, from signals that are linear between their samples.

use super::{Signal, check_finite, contiguous_level, hic, moving_average};
use crate::error::{Failure, Given, Result, finite, positive, proceed};
use crate::metrics::{HELD_WINDOW, INJURY_WINDOWS, Loads, Metrics, Status};
use crate::parameters::Foam;
use numeric::threads::Interrupted;

/// A recorded impact; signals that were not recorded are `None`.
#[derive(Clone, Copy, Debug)]
pub struct Recording<'a> {
    /// Times of the samples, in s.
    pub time: &'a [f64],
    /// Acceleration of the head, in g.
    pub acceleration_g: &'a [f64],
    /// Contact force, in N.
    pub contact_force: Option<&'a [f64]>,
    /// Compression of the foam, in m.
    pub compression: Option<&'a [f64]>,
    /// Velocity of the manipulator, in m/s.
    pub manipulator_velocity: Option<&'a [f64]>,
    /// First contact, in s; unknown where `None`, then nothing of the record is left out.
    pub start: Option<f64>,
    /// Compression up to which the foam is linear, in m.
    pub linear_range: f64,
    /// Thickness of the foam, in m.
    pub thickness: f64,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
}

/// Loads of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recorded {
    /// Over the impact period.
    pub metrics: Metrics,
    /// Criteria over the record from first contact to its end.
    pub whole: Loads<f64>,
}

/// The part of the record that is evaluated: whole cells between two interpolated ends.
struct Part<'a> {
    time: &'a [f64],
    start: f64,
    end: f64,
}

impl Recording<'_> {
    /// Loads over the impact period around the largest acceleration of the record: from the last
    /// zero before it, or the first contact if that is told and the acceleration is not negative in
    /// between, to the first zero after it; to the end of the record with `no_release` if there is
    /// none. The same criteria over the whole record show what the period leaves out.
    ///
    /// The power of the manipulator is the maximum of the product of two piecewise linear signals,
    /// that of the foam the largest mean over a sampling interval. What was not recorded is NaN.
    ///
    /// # Errors
    /// Bad signals; a start outside the record or at its end.
    pub fn metrics(&self) -> Result<Recorded> {
        self.metrics_until(&|| false)
    }

    /// Interruptible [`Recording::metrics`].
    ///
    /// # Errors
    /// Also that the caller asked to stop.
    pub fn metrics_until(&self, interrupted: Interrupted<'_>) -> Result<Recorded> {
        let signal = Signal::new_until(self.time, self.acceleration_g, interrupted)?;
        self.check()?;
        let record = Part {
            time: self.time,
            start: self.start.unwrap_or(self.time[0]),
            end: self.time[self.time.len() - 1],
        };
        let (start, end) = around_peak(&signal, record.start, self.start.is_some());
        let period = Part {
            time: self.time,
            start,
            end: end.unwrap_or(record.end),
        };
        let mut loads = self.loads(&period, interrupted)?;
        let whole = if period.start <= record.start && period.end >= record.end {
            loads
        } else {
            self.loads(&record, interrupted)?
        };
        loads.impact_duration = end.map_or(f64::INFINITY, |end| end - start);
        let status = match end {
            None => Status::NoRelease,
            Some(_) => Status::released(loads.max_compression, &self.foam()),
        };
        let metrics = Metrics { loads, status };
        Ok(Recorded { metrics, whole })
    }

    /// Every load over a part of the record but the duration.
    fn loads(&self, part: &Part<'_>, interrupted: Interrupted<'_>) -> Result<Loads<f64>> {
        let time = part.times();
        let cut = |values: Option<&[f64]>| values.map(|values| part.cut(values));
        let (force, compression) = (cut(self.contact_force), cut(self.compression));
        let velocity = cut(self.manipulator_velocity);
        let own = part.cut(self.acceleration_g);
        let mut loads = acceleration(&time, &own, self.gravity, interrupted)?;
        proceed(interrupted)?;
        loads.peak_contact_force = force.as_deref().map_or(f64::NAN, largest);
        loads.max_compression = compression.as_deref().map_or(f64::NAN, largest);
        if let Some(force) = &force {
            let power = compression.map(|way| largest_mean_power(&time, force, &way));
            loads.peak_power_foam = power.unwrap_or(f64::NAN);
            let power = velocity.map(|velocity| largest_product(force, &velocity));
            loads.peak_power_manipulator = power.unwrap_or(f64::NAN);
        }
        Ok(loads)
    }

    /// The foam as far as its compression goes.
    fn foam(&self) -> Foam {
        Foam {
            stiffness: 0.0,
            damping: 0.0,
            thickness: self.thickness,
            linear_range: self.linear_range,
        }
    }

    fn check(&self) -> Result<()> {
        for (name, values) in [
            ("contact_force", self.contact_force),
            ("compression", self.compression),
            ("manipulator_velocity", self.manipulator_velocity),
        ] {
            let Some(values) = values else { continue };
            if values.len() != self.time.len() {
                let given = Given::Count(values.len() as u64);
                let rule = "have as many samples as time";
                return Err(Failure::invalid(name, rule, given));
            }
            check_finite(name, values)?;
        }
        positive("gravity", self.gravity)?;
        let Some(start) = self.start else {
            return Ok(());
        };
        finite("start", start)?;
        if start < self.time[0] || start >= self.time[self.time.len() - 1] {
            let given = Given::Number(start);
            let rule = "lie in the record, before its last sample";
            return Err(Failure::invalid("start", rule, given));
        }
        Ok(())
    }
}

/// The criteria that need nothing but the acceleration.
fn acceleration(
    time: &[f64],
    value: &[f64],
    gravity: f64,
    interrupted: Interrupted<'_>,
) -> Result<Loads<f64>> {
    let signal = Signal::new_until(time, value, interrupted)?;
    let integral = signal.integral_until(interrupted)?;
    let peak = largest(value);
    let [short, long] = INJURY_WINDOWS;
    let lasts = signal.span() >= HELD_WINDOW;
    let level = |level: Result<super::Level>| level.map(|level| level.value);
    Ok(Loads {
        peak_head_acceleration: peak * gravity,
        peak_head_acceleration_g: peak,
        mean_head_acceleration_g: integral[integral.len() - 1] / signal.span(),
        hic15: hic(time, value, short, true, interrupted)?.value,
        hic36: hic(time, value, long, true, interrupted)?.value,
        average_3ms_g: if lasts {
            level(moving_average(time, value, HELD_WINDOW, interrupted))?
        } else {
            f64::NAN
        },
        clip_3ms_g: if lasts {
            level(contiguous_level(time, value, HELD_WINDOW, interrupted))?
        } else {
            f64::NAN
        },
        ..Loads::none()
    })
}

/// Start of the positive part around the largest value from `start` on, and its end if the record has it.
///
/// A signal that is never positive has no such part: all of it is returned. A known first contact is the start as long
/// as the signal is not negative between it and the largest value.
fn around_peak(signal: &Signal<'_>, start: f64, known: bool) -> (f64, Option<f64>) {
    let (time, value) = (signal.time, signal.value);
    // The samples after the start, and the value at the start itself.
    let first = time.partition_point(|time| *time <= start);
    let at_start = interpolated(&time[first - 1..=first], &value[first - 1..=first], start);
    let mut peak = None;
    let mut most = at_start.max(0.0);
    for (place, &value) in value.iter().enumerate().skip(first) {
        if value > most {
            (peak, most) = (Some(place), value);
        }
    }
    if most <= 0.0 {
        return (start, None);
    }
    let crossing = |cell: usize| {
        let share = value[cell] / (value[cell] - value[cell + 1]);
        (time[cell] + share * (time[cell + 1] - time[cell])).clamp(time[cell], time[cell + 1])
    };
    let after = peak.unwrap_or(first);
    let begin = match peak {
        None => start,
        Some(peak) => {
            let ended = |value: &f64| if known { *value < 0.0 } else { *value <= 0.0 };
            match value[first..peak].iter().rposition(ended) {
                Some(place) => crossing(first + place),
                // Between the start and the first sample after it.
                None if ended(&at_start) => crossing(first - 1).max(start),
                None => start,
            }
        }
    };
    let fall = value[after..].iter().position(|value| *value <= 0.0);
    let end = fall.map(|place| crossing(after + place - 1));
    (begin, end.filter(|end| *end > begin))
}

fn interpolated(times: &[f64], values: &[f64], at: f64) -> f64 {
    let share = (at - times[0]) / (times[1] - times[0]);
    values[0] + share * (values[1] - values[0])
}

impl Part<'_> {
    /// Places of the samples strictly inside.
    fn inside(&self) -> std::ops::Range<usize> {
        let first = self.time.partition_point(|time| *time <= self.start);
        let last = self.time.partition_point(|time| *time < self.end);
        first..last
    }

    fn times(&self) -> Vec<f64> {
        let inside = self.time[self.inside()].iter().copied();
        std::iter::once(self.start)
            .chain(inside)
            .chain([self.end])
            .collect()
    }

    fn cut(&self, values: &[f64]) -> Vec<f64> {
        let range = self.inside();
        let at = |time: f64, cell: usize| {
            interpolated(&self.time[cell..cell + 2], &values[cell..cell + 2], time)
        };
        let first = at(self.start, range.start - 1);
        let last = at(self.end, range.end - 1);
        let inside = values[range].iter().copied();
        std::iter::once(first).chain(inside).chain([last]).collect()
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// Largest power over a cell, work of the force over the cell's time.
fn largest_mean_power(time: &[f64], force: &[f64], way: &[f64]) -> f64 {
    let forces = force.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let ways = way.windows(2).map(|pair| pair[1] - pair[0]);
    let times = time.windows(2).map(|pair| pair[1] - pair[0]);
    let powers = forces
        .zip(ways)
        .zip(times)
        .map(|((force, way), time)| force * way / time);
    powers.fold(f64::NEG_INFINITY, f64::max)
}

/// Largest product of two signals.
fn largest_product(one: &[f64], other: &[f64]) -> f64 {
    let mut best = f64::NEG_INFINITY;
    for (one, other) in one.windows(2).zip(other.windows(2)) {
        let rises = [one[1] - one[0], other[1] - other[0]];
        let bend = rises[0] * rises[1];
        let turn = -(one[0] * rises[1] + other[0] * rises[0]) / (2.0 * bend);
        best = best.max(one[0] * other[0]).max(one[1] * other[1]);
        if bend < 0.0 && turn > 0.0 && turn < 1.0 {
            best = best.max((one[0] + turn * rises[0]) * (other[0] + turn * rises[1]));
        }
    }
    best
}
