//! Features of a sampled signal that tell how it was measured: rest before its peak, width of the peak, flat tops.

use std::ops::Range;

use super::tops::{FLAT, ROUNDING, flat_top, noisy_flat_top};
use super::{CHECK, check_finite};
use crate::error::{Result, proceed};
use numeric::threads::Interrupted;

/// Samples from which a rest is told, at least, if the peak leaves no time for a longer one.
const SHORTEST_REST: usize = 5;
/// The slope of a rest counts from so many times its standard error on.
const SLOPE_ERRORS: f64 = 8.0;
/// Time at the end of a record over which its level is looked at, in s.
const END: f64 = 0.05;
/// Root mean square about the level at the end, as a share of the largest absolute value, at most.
const END_NOISE: f64 = 0.01;
/// Samples of that level, at least.
const END_SAMPLES: usize = 20;
/// A signal is looked at for straight lines where it is above this share of its largest value.
const PULSE: f64 = 0.05;
/// Slopes that differ by less than this share of the largest value per step are equal.
const EQUAL_SLOPES: f64 = 1e-6;
/// Ends of straight lines of one length, at least: a triangle has three.
const FEWEST_ENDS: usize = 4;
/// Samples for each straight line, at least.
const SAMPLES_OF_LINE: usize = 3;

/// Features of a signal. Peak and width are those of the largest value; a signal that is negative
/// throughout has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseShape {
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
    /// Time during which the signal is above half of its largest value around it, in s; NaN unless
    /// the largest value is positive.
    pub width: f64,
    /// Longest sampling step within that time, in s; NaN likewise.
    pub step: f64,
    /// Longest sampling step, in s.
    pub longest_step: f64,
    /// Level at rest: the median of the quietest samples before the signal last rises through half of
    /// its largest absolute value; NaN if there are none.
    pub rest: f64,
    /// Root mean square about that level.
    pub noise: f64,
    /// Number of samples from which level and noise are found.
    pub rest_samples: usize,
    /// That level at the peak, along the slope of these samples where noise alone does not make it; else the same.
    pub level: f64,
    /// Median of the end of the record if it is after the push and quiet; else NaN.
    pub after: f64,
    /// Length of the straight lines, all of one length, of which the push is made, in s; else 0.
    pub straight: f64,
    /// Equal neighboring samples at the largest value, 0 if they are no flat top.
    pub flat: usize,
}

/// Features of a signal whose times rise; the rest is looked for over `rest` seconds.
///
/// # Errors
/// Samples that are not finite; the caller asked to stop.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded by the number of samples
pub fn shape_until(
    time: &[f64],
    value: &[f64],
    rest: f64,
    interrupted: Interrupted<'_>,
) -> Result<PulseShape> {
    let mut found = PulseShape {
        least: f64::INFINITY,
        most: f64::NEG_INFINITY,
        width: f64::NAN,
        step: f64::NAN,
        longest_step: 0.0,
        rest: f64::NAN,
        noise: f64::NAN,
        rest_samples: 0,
        level: f64::NAN,
        after: f64::NAN,
        straight: 0.0,
        flat: 0,
    };
    let (mut lowest, mut highest) = (0, 0);
    for start in (0..value.len()).step_by(CHECK) {
        proceed(interrupted)?;
        let part = &value[start..value.len().min(start + CHECK)];
        check_finite("signal", part)?;
        for (place, &value) in part.iter().enumerate() {
            if value < found.least {
                (found.least, lowest) = (value, start + place);
            }
            if value > found.most {
                (found.most, highest) = (value, start + place);
            }
        }
        let cells = &time[start..time.len().min(start + CHECK + 1)];
        let steps = cells.windows(2).map(|pair| pair[1] - pair[0]);
        found.longest_step = steps.fold(found.longest_step, f64::max);
    }
    if found.most > 0.0 {
        (found.width, found.step) = half_width(time, value, highest, interrupted)?;
        found.straight = straight_lines(time, value, highest, interrupted)?;
    }
    let (peak, sign) = if -found.least > found.most {
        (lowest, -1.0)
    } else {
        (highest, 1.0)
    };
    let quiet = quiet_part(time, value, peak, sign, rest, interrupted)?;
    if !quiet.is_empty() {
        (found.rest, found.noise) = level_of(&value[quiet.clone()]);
        found.rest_samples = quiet.len();
        let (times, values) = (&time[quiet.clone()], &value[quiet]);
        let slope = slope_of(times, values);
        found.level =
            found.rest + slope * (time[peak] - f64::midpoint(times[0], times[times.len() - 1]));
    }
    if found.most > 0.0 {
        found.flat = flat_top(value, found.most, interrupted)?;
        if found.flat == 0 {
            found.flat = noisy_flat_top(value, found.most, found.noise, interrupted)?;
        }
    }
    found.after = level_at_end(time, value, peak, sign);
    Ok(found)
}

/// The quietest samples before the signal last rises through half of its largest absolute value; none if there are none.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded by the number of samples
fn quiet_part(
    time: &[f64],
    value: &[f64],
    peak: usize,
    sign: f64,
    rest: f64,
    interrupted: Interrupted<'_>,
) -> Result<Range<usize>> {
    let half = 0.5 * sign * value[peak];
    // The push itself is no rest, however slowly it rises: it begins at the last zero before the peak, or, of
    // signals that are never zero, at half of the peak at the latest.
    let last =
        |level: f64, end: usize| value[..end].iter().rposition(|value| sign * value <= level);
    let rising = last(half, peak).map_or(0, |place| place + 1);
    let mean_step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let wanted = (rest / mean_step).round().max(SHORTEST_REST as f64);
    let Some(zero) = last(0.0, rising) else {
        return if wanted <= rising as f64 {
            quietest(&value[..rising], wanted as usize, interrupted)
        } else {
            Ok(0..0)
        };
    };
    let before = |from: usize| {
        let there = zero + 1 - from;
        let samples = if wanted > there as f64 {
            // The quieter half of what there is.
            there.div_ceil(2).max(SHORTEST_REST).min(there)
        } else {
            wanted as usize
        };
        let found = quietest(&value[from..=zero], samples, interrupted)?;
        Ok(from + found.start..from + found.end)
    };
    // Equal samples before a jump to another level were put before the record.
    let padded = value[..=zero]
        .iter()
        .take_while(|next| (**next - value[0]).abs() <= ROUNDING * half.abs())
        .count();
    if padded >= SHORTEST_REST && zero + 1 >= padded + FLAT {
        let recorded = before(padded)?;
        let (level, _) = level_of(&value[recorded.clone()]);
        let (jump, away) = (value[padded] - value[0], level - value[0]);
        // Away from the peak: towards it rises the push itself.
        if sign * away < 0.0 && jump / away >= 0.5 {
            return Ok(recorded);
        }
    }
    before(0)
}

/// Median of samples and the root mean square about it.
fn level_of(value: &[f64]) -> (f64, f64) {
    let mut sorted = value.to_vec();
    let middle = sorted.len() / 2;
    let (_, median, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
    let median = *median;
    let squares: f64 = value.iter().map(|value| (value - median).powi(2)).sum();
    (median, (squares / value.len() as f64).sqrt())
}

/// Slope of samples, 0 where noise alone may make it.
fn slope_of(time: &[f64], value: &[f64]) -> f64 {
    let samples = time.len() as f64;
    if time.len() < SHORTEST_REST {
        return 0.0;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / samples;
    let (center, level) = (mean(time), mean(value));
    let pairs = || {
        time.iter()
            .zip(value)
            .map(|(time, value)| (time - center, value - level))
    };
    let spread: f64 = pairs().map(|(time, _)| time * time).sum();
    let slope = pairs().map(|(time, value)| time * value).sum::<f64>() / spread;
    let left: f64 = pairs()
        .map(|(time, value)| (value - slope * time).powi(2))
        .sum();
    let error = (left / ((samples - 2.0) * spread)).sqrt();
    if slope.abs() > SLOPE_ERRORS * error {
        slope
    } else {
        0.0
    }
}

/// Median of the end of a record, if that is after the push and quiet; else NaN.
fn level_at_end(time: &[f64], value: &[f64], peak: usize, sign: f64) -> f64 {
    let from = time.partition_point(|now| *now < time[time.len() - 1] - END);
    let height = sign * value[peak];
    let fallen = value[peak..]
        .iter()
        .position(|value| sign * value <= 0.5 * height);
    let after_push = fallen.is_some_and(|place| peak + place < from);
    if !after_push || value.len() < from + END_SAMPLES {
        return f64::NAN;
    }
    let (level, noise) = level_of(&value[from..]);
    if noise <= END_NOISE * height {
        level
    } else {
        f64::NAN
    }
}

/// Length of the straight lines, all of one length, of which the push around a peak is made, in s; 0 if it is not.
fn straight_lines(
    time: &[f64],
    value: &[f64],
    peak: usize,
    interrupted: Interrupted<'_>,
) -> Result<f64> {
    let least = PULSE * value[peak];
    let (mut first, mut last) = (peak, peak);
    while first > 0 && value[first] > least {
        first -= 1;
    }
    while last + 1 < value.len() && value[last] > least {
        last += 1;
    }
    let slope = |cell: usize| (value[cell + 1] - value[cell]) / (time[cell + 1] - time[cell]);
    // Two samples next to each other at which the slope changes are one end of a line that lies between them.
    let (mut ends, mut single): (Vec<f64>, _) = (Vec::new(), None);
    for place in first.max(1)..last {
        if place % CHECK == 0 {
            proceed(interrupted)?;
        }
        let longer = (time[place + 1] - time[place]).max(time[place] - time[place - 1]);
        if (slope(place) - slope(place - 1)).abs() * longer <= EQUAL_SLOPES * value[peak] {
            continue;
        }
        match ends.last_mut() {
            Some(end) if single == Some(place - 1) => {
                *end = f64::midpoint(*end, time[place]);
                single = None;
            }
            _ => {
                ends.push(time[place]);
                single = Some(place);
            }
        }
        // Not even the fewest samples for each line are left.
        if ends.len() > FEWEST_ENDS && SAMPLES_OF_LINE * ends.len() > last - first {
            return Ok(0.0);
        }
    }
    if ends.len() < FEWEST_ENDS || SAMPLES_OF_LINE * ends.len() > last - first {
        return Ok(0.0);
    }
    let lengths = || ends.windows(2).map(|pair| pair[1] - pair[0]);
    let (shortest, longest) = lengths().fold((f64::INFINITY, 0.0_f64), |(low, high), length| {
        (low.min(length), high.max(length))
    });
    let step = (time[last] - time[first]) / (last - first) as f64;
    Ok(if longest - shortest <= 1.5 * step {
        longest
    } else {
        0.0
    })
}

/// Time above half of the peak, with straight lines between samples, and the longest step in it.
fn half_width(
    time: &[f64],
    value: &[f64],
    peak: usize,
    interrupted: Interrupted<'_>,
) -> Result<(f64, f64)> {
    let half = 0.5 * value[peak];
    let crossing = |above: usize, below: usize| {
        let share = (value[above] - half) / (value[above] - value[below]);
        time[above] + share * (time[below] - time[above])
    };
    let mut step = 0.0_f64;
    let (mut first, mut begin) = (peak, time[0]);
    while first > 0 {
        if first % CHECK == 0 {
            proceed(interrupted)?;
        }
        step = step.max(time[first] - time[first - 1]);
        if value[first - 1] <= half {
            begin = crossing(first, first - 1);
            break;
        }
        first -= 1;
    }
    let (mut last, mut end) = (peak, time[time.len() - 1]);
    while last + 1 < value.len() {
        if last % CHECK == 0 {
            proceed(interrupted)?;
        }
        step = step.max(time[last + 1] - time[last]);
        if value[last + 1] <= half {
            end = crossing(last, last + 1);
            break;
        }
        last += 1;
    }
    Ok((end - begin, step))
}

/// The samples next to each other that vary least; the first of several.
fn quietest(value: &[f64], samples: usize, interrupted: Interrupted<'_>) -> Result<Range<usize>> {
    // About the first sample, so that a large offset costs no digits.
    let about = value.first().copied().unwrap_or(0.0);
    let (mut sum, mut squares) = (0.0, 0.0);
    let mut best = (f64::INFINITY, 0..samples);
    for (place, &next) in value.iter().enumerate() {
        if place % CHECK == 0 {
            proceed(interrupted)?;
        }
        let next = next - about;
        sum += next;
        squares += next * next;
        if place >= samples {
            let gone = value[place - samples] - about;
            sum -= gone;
            squares -= gone * gone;
        }
        if place + 1 >= samples {
            let spread = squares - sum * sum / samples as f64;
            if spread < best.0 {
                best = (spread, place + 1 - samples..place + 1);
            }
        }
    }
    Ok(best.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(value: &[f64]) -> PulseShape {
        let time: Vec<f64> = (0..value.len()).map(|index| 1e-3 * index as f64).collect();
        shape_until(&time, value, 0.01, &|| false).unwrap()
    }

    #[test]
    fn the_rest_is_the_quietest_part_before_the_peak() {
        let mut value = vec![-5.0; 30];
        value.splice(0..10, (0..10).map(|index| -5.0 + f64::from(index % 3)));
        value.extend([20.0, 50.0, 20.0, -5.0]);
        let found = shape(&value);
        assert_eq!(
            (found.rest, found.noise, found.rest_samples),
            (-5.0, 0.0, 10)
        );
        assert_eq!((found.least, found.most, found.flat), (-5.0, 50.0, 0));
    }

    #[test]
    fn a_short_record_rests_until_it_rises_through_zero() {
        let found = shape(&[-5.0, -5.0, -4.0, 10.0, 40.0, 10.0]);
        assert_eq!((found.rest, found.rest_samples), (-5.0, 3));
        let found = shape(&[-5.0, -5.0, -5.0, -5.0, -5.0, -5.0, -3.0, 10.0, 40.0, 10.0]);
        assert_eq!(
            (found.rest, found.noise, found.rest_samples),
            (-5.0, 0.0, 5)
        );
        let found = shape(&[5.0, 5.0, -4.0, -10.0, -40.0, 10.0]);
        assert_eq!((found.rest, found.rest_samples), (5.0, 2));
        assert!(shape(&[2.0, 10.0, 40.0, 10.0]).rest.is_nan());
    }

    #[test]
    fn width_is_taken_at_half_of_the_peak() {
        let found = shape(&[0.0, 40.0, 0.0, 0.0]);
        assert!((found.width - 1e-3).abs() < 1e-15 && (found.step - 1e-3).abs() < 1e-15);
        assert!(shape(&[-1.0, -2.0]).width.is_nan());
    }

    #[test]
    fn a_flat_top_is_no_rounded_one() {
        let clipped: Vec<f64> = (0..40)
            .map(|index| (60.0 * (f64::from(index) * 0.08).sin()).min(40.0))
            .collect();
        assert!(shape(&clipped).flat > 10);
        let rounded: Vec<f64> = (0..400)
            .map(|index| (60.0 * (f64::from(index) * 0.008).sin()).round())
            .collect();
        assert_eq!(shape(&rounded).flat, 0);
        // The ends of a record are none. A rectangle is one: no head is that fast.
        assert_eq!(shape(&[40.0, 40.0, 40.0, 20.0, 19.0]).flat, 0);
        assert_eq!(shape(&[0.0, 40.0, 40.0, 40.0, 0.0]).flat, 3);
    }
    #[test]
    fn a_flat_top_with_noise_is_one() {
        let noise = |index: u32| 0.2 * f64::from((index * 7919) % 13) / 13.0 - 0.1;
        let record = |top: f64| -> Vec<f64> {
            let pulse = |index: u32| 60.0 * (f64::from(index.saturating_sub(50)) * 0.02).sin();
            let value = |index| {
                if index < 207 {
                    pulse(index).max(0.0).min(top)
                } else {
                    0.0
                }
            };
            (0..300).map(|index| value(index) + noise(index)).collect()
        };
        assert!(shape(&record(50.0)).flat > 30);
        assert_eq!(shape(&record(100.0)).flat, 0);
    }

    #[test]
    fn a_slope_of_the_rest_is_followed_to_the_peak() {
        let mut value: Vec<f64> = (0..20).map(|index| -0.1 * f64::from(index)).collect();
        value.extend([10.0, 40.0, 10.0, -2.0]);
        let found = shape(&value);
        assert_eq!(found.rest_samples, 10);
        assert!((found.level - -2.1).abs() < 0.1, "{}", found.level);
        let flat = shape(&[0.0, -0.1, 0.1, 0.0, -0.1, 0.1, 40.0, 0.0]);
        assert_eq!(flat.level.to_bits(), flat.rest.to_bits());
    }

    #[test]
    fn zeros_put_before_a_record_are_no_rest() {
        let mut value = vec![0.0; 30];
        value.extend([-5.0, -5.1, -4.9, -5.0, -5.1, -4.9, 20.0, 50.0, 20.0, -5.0]);
        assert!((shape(&value).rest - -5.0).abs() < 0.2);
    }

    #[test]
    fn straight_lines_between_samples_are_told_from_samples() {
        let coarse = [0.0, 0.0, 30.0, 55.0, 40.0, 10.0, 0.0, 0.0];
        let fine: Vec<f64> = (0..70_u32)
            .map(|index| {
                let (cell, share) = ((index / 10) as usize, f64::from(index % 10) / 10.0);
                coarse[cell] + share * (coarse[cell + 1] - coarse[cell])
            })
            .collect();
        assert!((shape(&fine).straight - 0.01).abs() < 1e-12);
        let smooth: Vec<f64> = (0..70)
            .map(|index| 9.0 * (f64::from(index) * 0.045).sin())
            .collect();
        assert_eq!(shape(&smooth).straight, 0.0);
        assert_eq!(shape(&coarse).straight, 0.0);
    }

    #[test]
    fn the_level_at_the_end_is_told_if_it_is_quiet() {
        let mut value = vec![0.0; 20];
        value.extend([20.0, 50.0, 20.0]);
        value.extend([-5.0; 60]);
        assert_eq!(shape(&value).after, -5.0);
        value.extend([-5.0, 5.0].repeat(30));
        assert!(shape(&value).after.is_nan());
    }
}
