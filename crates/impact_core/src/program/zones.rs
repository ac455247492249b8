//! Zones of constant speed along a path, as they are typed into a pendant.

use numeric::error::{Failure, Given, Result, at_most, not_negative, positive};

/// Most cells of a path.
pub const MOST_CELLS: usize = 400;

/// A cap that misses a step by less than this share of it reaches it.
const REACHED: f64 = 1e-9;

/// Times that differ by a smaller share are equal.
const EQUAL: f64 = 1e-12;

/// A zone of constant speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zone {
    /// Its cells, without the last one.
    pub cells: [usize; 2],
    /// Its speed (m/s).
    pub speed: f64,
}

/// The zones with the least sum of length over speed: at most `count`, each with the smallest cap of its cells, rounded
/// down to a multiple of `step`. None if a cap is below one step. Of equal sums that of fewer zones.
///
/// # Errors
/// A number is out of range, or there are too many cells.
pub fn fastest_zones(
    lengths: &[f64],
    caps: &[f64],
    count: usize,
    step: f64,
) -> Result<Option<Vec<Zone>>> {
    let cells = at_most("length", lengths.len(), MOST_CELLS)?;
    if cells == 0 || caps.len() != cells {
        let given = Given::Count(caps.len() as u64);
        return Err(Failure::invalid(
            "cap",
            "hold a speed for each cell, of which there is one at least",
            given,
        ));
    }
    if count == 0 {
        return Err(Failure::invalid("count", "be at least 1", Given::Count(0)));
    }
    positive("step", step)?;
    for (cell, (length, cap)) in lengths.iter().zip(caps).enumerate() {
        positive(&format!("length[{cell}]"), *length)?;
        if cap.is_nan() || *cap < 0.0 {
            return Err(Failure::invalid(
                format!("cap[{cell}]"),
                "be at least 0",
                Given::Number(*cap),
            ));
        }
    }
    let speeds: Vec<f64> = caps.iter().map(|cap| typed(*cap, step)).collect();
    if speeds.contains(&0.0) {
        return Ok(None);
    }
    Ok(Some(choose(lengths, &speeds, count.min(cells))))
}

/// A speed rounded down to a multiple of the step (m/s).
#[must_use]
pub fn typed(cap: f64, step: f64) -> f64 {
    (cap / step + REACHED).floor() * step
}

/// Dynamic programming over the last zone.
fn choose(lengths: &[f64], speeds: &[f64], count: usize) -> Vec<Zone> {
    let cells = lengths.len();
    // Least time of the first cells with so many zones, and where the last one starts.
    let mut rows: Vec<Vec<(f64, usize)>> = Vec::with_capacity(count + 1);
    let mut first = vec![(f64::INFINITY, 0); cells + 1];
    first[0].0 = 0.0;
    rows.push(first);
    for zones in 1..=count {
        let before = &rows[zones - 1];
        let mut row = vec![(f64::INFINITY, 0); cells + 1];
        for (end, best) in row.iter_mut().enumerate().skip(zones) {
            let (mut length, mut speed) = (0.0, f64::INFINITY);
            for start in (zones - 1..end).rev() {
                length += lengths[start];
                speed = speeds[start].min(speed);
                let time = before[start].0 + length / speed;
                if time < best.0 {
                    *best = (time, start);
                }
            }
        }
        rows.push(row);
    }
    let mut zones = 1;
    for other in 2..=count {
        if rows[other][cells].0 < rows[zones][cells].0 * (1.0 - EQUAL) {
            zones = other;
        }
    }
    let (mut found, mut end) = (Vec::with_capacity(zones), cells);
    for row in rows[1..=zones].iter().rev() {
        let start = row[end].1;
        let speed = speeds[start..end]
            .iter()
            .fold(f64::INFINITY, |least, speed| least.min(*speed));
        found.push(Zone {
            cells: [start, end],
            speed,
        });
        end = start;
    }
    found.reverse();
    found
}

/// Places where zones between bounds are to begin (m), so that a braking motion has the speed of each at its bound: it
/// may have to brake before a short zone for the next one. A zone that begins where the next one does is passed over.
///
/// # Errors
/// A number is out of range.
pub fn starts(bounds: &[f64], speeds: &[f64], deceleration: f64) -> Result<Vec<f64>> {
    let zones = at_most("speed", speeds.len(), MOST_CELLS)?;
    if bounds.len() != zones + 1 || !bounds.windows(2).all(|pair| pair[0] < pair[1]) {
        let given = Given::Count(bounds.len() as u64);
        return Err(Failure::invalid(
            "bounds",
            "rise, one more than there are zones",
            given,
        ));
    }
    if deceleration.is_nan() || deceleration <= 0.0 {
        return Err(Failure::invalid(
            "deceleration",
            "be positive",
            Given::Number(deceleration),
        ));
    }
    for (zone, speed) in speeds.iter().enumerate() {
        not_negative(&format!("speed[{zone}]"), *speed)?;
    }
    let mut found: Vec<f64> = Vec::with_capacity(zones);
    for (zone, speed) in speeds.iter().enumerate() {
        let mut start = bounds[zone];
        for before in (0..zone).rev() {
            let way = (speeds[before] * speeds[before] - speed * speed) / (2.0 * deceleration);
            start = start.min(bounds[zone] - way);
            if start >= bounds[before] {
                break;
            }
        }
        found.push(start.max(bounds[0]));
    }
    // A zone that starts earlier takes the place of those before it.
    for zone in (1..zones).rev() {
        found[zone - 1] = found[zone - 1].min(found[zone]);
    }
    Ok(found)
}
