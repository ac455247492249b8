//! Quantiles of many numbers, which may be given up on the way.

use numeric::threads::Interrupted;

use crate::error::{Failure, Result};

/// Numbers between two questions whether to stop.
const PIECE: usize = 1 << 18;
/// Upper bits by which numbers are counted: sign, exponent and four bits of the fraction.
const BITS: u32 = 16;

/// Values that shares of some numbers stay below, between neighbors by a line.
///
/// # Errors
/// The caller asked to stop.
pub fn quantiles<const N: usize>(
    values: &[f64],
    shares: [f64; N],
    interrupted: Interrupted<'_>,
) -> Result<[f64; N]> {
    let counts = counted(values, interrupted)?;
    let mut found = shares;
    for share in &mut found {
        *share = quantile((values, &counts), *share, interrupted)?;
    }
    Ok(found)
}

fn quantile(
    (values, counts): (&[f64], &[usize]),
    share: f64,
    interrupted: Interrupted<'_>,
) -> Result<f64> {
    let place = share * (values.len() - 1) as f64;
    // Within the length.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let index = place.floor() as usize;
    let at = ranked(values, counts, index, interrupted)?;
    let next = match index + 1 {
        above if above < values.len() => ranked(values, counts, above, interrupted)?,
        _ => at,
    };
    Ok(if next.is_finite() {
        at + (place - index as f64) * (next - at)
    } else {
        at
    })
}

/// Bits that rise with the number.
fn rising(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 0 {
        bits | (1 << 63)
    } else {
        !bits
    }
}

/// The class that a number is counted in.
#[allow(clippy::cast_possible_truncation)] // of 16 bits
fn class(value: f64) -> usize {
    (rising(value) >> (64 - BITS)) as usize
}

/// Count of numbers in each class.
fn counted(values: &[f64], interrupted: Interrupted<'_>) -> Result<Vec<usize>> {
    let mut counts = vec![0; 1 << BITS];
    for piece in values.chunks(PIECE) {
        if interrupted() {
            return Err(Failure::Interrupted);
        }
        for value in piece {
            counts[class(*value)] += 1;
        }
    }
    Ok(counts)
}

/// The number that so many are below, in their order.
fn ranked(
    values: &[f64],
    counts: &[usize],
    rank: usize,
    interrupted: Interrupted<'_>,
) -> Result<f64> {
    let (mut wanted, mut within) = (0, rank);
    while within >= counts[wanted] {
        within -= counts[wanted];
        wanted += 1;
    }
    let mut found = Vec::with_capacity(counts[wanted]);
    for piece in values.chunks(PIECE) {
        if interrupted() {
            return Err(Failure::Interrupted);
        }
        found.extend(piece.iter().filter(|value| class(**value) == wanted));
    }
    // Numbers that are all the same, as of a speed that no draw changes, need no order.
    let (least, most) = found
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |ends, value| {
            (ends.0.min(*value), ends.1.max(*value))
        });
    if least == most {
        return Ok(least);
    }
    Ok(*found.select_nth_unstable_by(within, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use numeric::random::Stream;

    use super::quantiles;
    use crate::error::Failure;

    #[test]
    fn quantiles_are_those_of_the_sorted_numbers() {
        let mut stream = Stream::new(5, 0);
        for count in [1, 2, 3, 1000, 300_000] {
            for kind in 0..4 {
                let mut values: Vec<f64> = (0..count)
                    .map(|_| match kind {
                        0 => stream.uniform(-1.0, 1.0),
                        1 => stream.uniform(1.0, 1.001),
                        2 => stream.below(3) as f64,
                        _ => 0.25,
                    })
                    .collect();
                let shares = [0.0, 0.05, 0.5, 0.95, 1.0];
                let found = quantiles(&values, shares, &|| false).unwrap();
                numeric::order::sort_ascending(&mut values);
                for (share, found) in shares.into_iter().zip(found) {
                    let place = share * f64::from(count - 1);
                    // Of an index.
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                    let index = place as usize;
                    let next = values[(index + 1).min(values.len() - 1)];
                    assert_eq!(
                        found,
                        values[index] + place.fract() * (next - values[index])
                    );
                }
            }
        }
    }

    #[test]
    fn speeds_without_end_are_quantiles_too() {
        let values = [0.5, f64::INFINITY, 0.25, f64::INFINITY];
        let found = quantiles(&values, [1.0 / 3.0, 0.5, 1.0], &|| false).unwrap();
        assert_eq!(found, [0.5, 0.5, f64::INFINITY]);
    }

    #[test]
    fn quantiles_are_given_up_when_asked() {
        let found = quantiles(&[1.0], [0.5], &|| true);
        assert_eq!(found, Err(Failure::Interrupted));
    }
}
