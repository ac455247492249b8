//! What a sampled signal says about its own measurement: rest before its peak, width of the peak, flat tops.

use std::ops::Range;

use super::{CHECK, check_finite};
use crate::error::{Result, proceed};
use numeric::threads::Interrupted;

/// Samples from which a rest is told, at least, if the peak leaves no time for a longer one.
const SHORTEST_REST: usize = 5;
/// Equal neighboring samples that make a flat top.
const FLAT: usize = 3;
/// Digits below a top within which its levels are counted.
const FARTHEST: f64 = 200.0;
/// Digits of the smallest difference between levels, at most.
const MOST_DIGITS: u8 = 5;
/// Samples on either side of a flat top from which the smallest step is found.
const NEIGHBORS: usize = 2048;
/// Share of the largest value by which equal samples may differ.
const ROUNDING: f64 = 1e-12;

/// Features of a signal. Peak and width are those of the largest value; a signal that is negative
/// throughout has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
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
    /// Samples from which both are told.
    pub rest_samples: usize,
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
) -> Result<Shape> {
    let mut found = Shape {
        least: f64::INFINITY,
        most: f64::NEG_INFINITY,
        width: f64::NAN,
        step: f64::NAN,
        longest_step: 0.0,
        rest: f64::NAN,
        noise: f64::NAN,
        rest_samples: 0,
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
        found.flat = flat_top(value, found.most, interrupted)?;
    }
    let (peak, sign) = if -found.least > found.most {
        (lowest, -1.0)
    } else {
        (highest, 1.0)
    };
    let half = 0.5 * sign * value[peak];
    // The push itself is no rest, however slowly it rises: it begins at the last zero before the peak, or, of
    // signals that are never zero, at half of the peak at the latest.
    let last =
        |level: f64, end: usize| value[..end].iter().rposition(|value| sign * value <= level);
    let rising = last(half, peak).map_or(0, |place| place + 1);
    let mean_step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let wanted = (rest / mean_step).round().max(SHORTEST_REST as f64);
    let quiet = match last(0.0, rising) {
        Some(zero) if wanted > (zero + 1) as f64 => {
            // The quieter half of what there is.
            let samples = zero.div_ceil(2).max(SHORTEST_REST).min(zero + 1);
            quietest(&value[..=zero], samples, interrupted)?
        }
        Some(zero) => quietest(&value[..=zero], wanted as usize, interrupted)?,
        None if wanted <= rising as f64 => {
            quietest(&value[..rising], wanted as usize, interrupted)?
        }
        None => 0..0,
    };
    let mut rested = value[quiet].to_vec();
    if !rested.is_empty() {
        let middle = rested.len() / 2;
        let (_, median, _) = rested.select_nth_unstable_by(middle, f64::total_cmp);
        found.rest = *median;
        let squares: f64 = rested
            .iter()
            .map(|value| (value - found.rest).powi(2))
            .sum();
        found.noise = (squares / rested.len() as f64).sqrt();
        found.rest_samples = rested.len();
    }
    Ok(found)
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

/// Samples of the longest flat top at the largest value, entered and left inside the record.
fn flat_top(value: &[f64], most: f64, interrupted: Interrupted<'_>) -> Result<usize> {
    let level = most * (1.0 - ROUNDING);
    let (mut longest, mut begun) = (0..0, None);
    for start in (0..value.len()).step_by(CHECK) {
        proceed(interrupted)?;
        let part = &value[start..value.len().min(start + CHECK)];
        for (place, &value) in part.iter().enumerate() {
            if value >= level {
                begun.get_or_insert(start + place);
            } else if let Some(first) = begun.take() {
                let run: Range<usize> = first..start + place;
                if first > 0 && run.len() > longest.len() {
                    longest = run;
                }
            }
        }
    }
    if longest.len() < FLAT {
        return Ok(0);
    }
    // Levels below the top, each once.
    let around = longest.start.saturating_sub(NEIGHBORS)..value.len().min(longest.end + NEIGHBORS);
    let mut below: Vec<f64> = value[around].iter().map(|value| most - value).collect();
    below.sort_unstable_by(f64::total_cmp);
    below.dedup_by(|next, kept| *next - *kept <= ROUNDING * most);
    let smallest = below.windows(2).map(|pair| pair[1] - pair[0]);
    let smallest = smallest.fold(f64::INFINITY, f64::min);
    // A smooth top that is rounded to a digit is a parabola, which hides less than a digit in these samples.
    let length = longest.len();
    let samples = length as f64;
    let hidden = 4.0 * samples * (2.0 * samples + 1.0) / (samples - 1.0).powi(2) + 1.0;
    let [left, right] = [
        longest.start.saturating_sub(length),
        (longest.end + length - 1).min(value.len() - 1),
    ];
    let fall = most - value[left].max(value[right]);
    // Where no two levels are one digit apart the smallest difference is some digits.
    let digit = (1..=MOST_DIGITS)
        .map(|digits| smallest / f64::from(digits))
        .find(|digit| multiples(&below[1..], *digit));
    let jumps = digit.is_none_or(|digit| fall >= hidden * digit);
    Ok(if jumps && fall > hidden * ROUNDING * most {
        length
    } else {
        0
    })
}

/// Whether rising numbers are multiples of a digit, as far as that can be told.
fn multiples(numbers: &[f64], smallest: f64) -> bool {
    let (mut digit, mut whole, mut all) = (smallest, 0, 0);
    for &number in numbers
        .iter()
        .take_while(|number| **number < FARTHEST * smallest)
    {
        let nearest = (number / digit).round();
        all += 1;
        if (number / digit - nearest).abs() < 0.05 && nearest > 0.0 {
            whole += 1;
            digit = number / nearest;
        }
    }
    10 * whole >= 9 * all
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

    fn shape(value: &[f64]) -> Shape {
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
        // Neither at the ends of a record, nor a rectangle, whose two values have but one step.
        assert_eq!(shape(&[40.0, 40.0, 40.0, 20.0, 19.0]).flat, 0);
        assert_eq!(shape(&[0.0, 40.0, 40.0, 40.0, 0.0]).flat, 0);
    }
}
