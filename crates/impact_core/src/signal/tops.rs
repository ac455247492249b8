//! Flat tops of sampled signals: saturated channels, with and without noise.

use std::ops::Range;

use super::CHECK;
use crate::error::{Result, proceed};
use numeric::threads::Interrupted;

/// Equal neighboring samples that make a flat top.
pub(super) const FLAT: usize = 3;
/// Digits below a top within which its levels are counted.
const FARTHEST: f64 = 200.0;
/// Digits of the smallest difference between levels, at most.
const MOST_DIGITS: u8 = 5;
/// Samples on either side of a flat top from which the smallest step is found.
const NEIGHBORS: usize = 2048;
/// A digit of more than this share of the largest value rounds too much to tell a smooth top from a flat one.
const COARSE_DIGIT: f64 = 0.02;
/// Samples of a top that is flat but for noise stay within one of so many times the noise.
const NOISE_BANDS: [f64; 3] = [5.0, 7.0, 10.0];
/// That band is at most this share of the largest value.
const WIDEST_BAND: f64 = 0.1;
/// Half of its length beyond such a top a signal has fallen by so many times what a parabola falls there, at least.
const NOISY_FALL: f64 = 1.2;
/// Share of the largest value by which equal samples may differ.
pub(super) const ROUNDING: f64 = 1e-12;

/// Samples of the longest flat top at the largest value, entered and left inside the record.
pub(super) fn flat_top(value: &[f64], most: f64, interrupted: Interrupted<'_>) -> Result<usize> {
    let longest = longest_above(value, most * (1.0 - ROUNDING), interrupted)?;
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
    let jumps = digit.is_none_or(|digit| fall >= hidden * digit || digit > COARSE_DIGIT * most);
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

/// Samples of the longest top that is flat but for noise, entered and left inside the record by steep slopes; else 0.
pub(super) fn noisy_flat_top(
    value: &[f64],
    most: f64,
    noise: f64,
    interrupted: Interrupted<'_>,
) -> Result<usize> {
    for bands in NOISE_BANDS {
        let band = bands * noise;
        if !(band > 0.0 && band <= WIDEST_BAND * most) {
            break;
        }
        let top = longest_above(value, most - band, interrupted)?;
        let beyond = top.len().div_ceil(2);
        if top.len() < FLAT || top.start < beyond || top.end + beyond > value.len() {
            continue;
        }
        let half = 0.5 * (top.len() - 1) as f64;
        let parabola = (1.0 + beyond as f64 / half).powi(2) * band;
        let fall = most - value[top.start - beyond].max(value[top.end + beyond - 1]);
        if fall >= NOISY_FALL * parabola {
            return Ok(top.len());
        }
    }
    Ok(0)
}

/// The longest run of samples of at least a level that is entered and left inside the record.
fn longest_above(value: &[f64], level: f64, interrupted: Interrupted<'_>) -> Result<Range<usize>> {
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
    Ok(longest)
}
