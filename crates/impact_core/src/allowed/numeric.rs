//! Allowed speeds by simulation.

use std::cell::Cell;

use numeric::threads::Interrupted;

use super::{Allowed, Governs, Limits, SpeedStatus};
use crate::collision::{
    Collision, CollisionStatus, Outcome, Region, SupportedBody, Wanted, rest_of, simulate,
};
use crate::covering::Shape;

/// Range of speeds to search where loads might fall with the speed, in m/s.
pub const SCANNED: [f64; 2] = [1e-3, 20.0];
/// Number of such speeds.
const SCANS: usize = 48;
/// Loads that the energy bounds below this share of their limits need no simulation.
const WELL_INSIDE: f64 = 0.99;
/// First step from a crossing into the limits, as a share of the way to what is known to be within.
const FIRST_STEP: f64 = 1e-12;
/// Lowest speed that is looked for, in m/s.
const LOWEST: f64 = 1e-12;

/// Loads over their limits.
fn shares(
    collision: &Collision<'_>,
    (limits, area): (&Limits, Option<f64>),
    outcome: &Outcome,
) -> [f64; 3] {
    match outcome.status {
        // More than the covering's law describes.
        CollisionStatus::BeyondData => return [f64::NAN, f64::NAN, f64::INFINITY],
        CollisionStatus::Unfinished => return [f64::NAN; 3],
        _ => (),
    }
    let over = |load: f64, limit: Option<f64>| limit.map_or(f64::NAN, |limit| load / limit);
    let pressure = match (collision.pad, area) {
        (None, Some(area)) => outcome.peak_force / area,
        (None, None) => f64::NAN,
        _ => outcome.peak_pressure,
    };
    let strain = collision.pad.map(|pad| limits.strain(pad));
    [
        over(outcome.peak_force, limits.force),
        over(pressure, limits.pressure),
        over(
            outcome.peak_strain,
            strain.filter(|strain| strain.is_finite()),
        ),
    ]
}

/// Largest loads over their limits that the kinetic energy allows, where nothing pushes: neither covering nor
/// region can store more, whatever damper and rate take.
fn bounds(
    collision: &Collision<'_>,
    (limits, area): (&Limits, Option<f64>),
    speed: f64,
) -> Option<[f64; 3]> {
    let pad = collision.pad?;
    if is_held(collision) || collision.region == Region::Rigid {
        return None;
    }
    let energy = 0.5 * collision.reduced_mass() * speed * speed;
    let force = rest_of(None, collision.region, energy).force;
    let depth = rest_of(Some(pad), Region::Rigid, energy).compression;
    let strain = depth / pad.covering.thickness;
    let factor = pad.rate_factor(speed, strain)[0].max(pad.rate_factor(speed, 0.0)[0]);
    let pressure = match (pad.covering.shape, area) {
        (Shape::Flat { area }, _) => force / area,
        _ => factor * pad.covering.material.stress(strain)[0],
    };
    let over = |load: f64, limit: Option<f64>| limit.map_or(0.0, |limit| load / limit);
    let most = limits.strain(pad);
    Some([
        over(force, limits.force),
        over(pressure, limits.pressure),
        over(strain, Some(most).filter(|most| most.is_finite())),
    ])
}

/// Whether a support or the stop of the set point pushes.
fn is_held(collision: &Collision<'_>) -> bool {
    let held = |body: &SupportedBody| body.damping > 0.0 || body.stiffness > 0.0;
    held(&collision.robot) || held(&collision.body) || collision.stop.is_some()
}

/// The largest of some shares.
fn worst(shares: [f64; 3]) -> f64 {
    shares.into_iter().fold(f64::NAN, f64::max)
}

/// Whether loads cannot fall with the speed: no supports, no stop, and no damper between two springs.
fn is_monotone(collision: &Collision<'_>) -> bool {
    let damped = collision.pad.is_some_and(|pad| pad.covering.damping > 0.0);
    let inner = damped && collision.region != Region::Rigid;
    !is_held(collision) && !inner
}

/// Allowed speed by simulation: the lowest speed at which a load reaches its limit.
///
/// `guess` is a speed of the right size.
#[must_use]
pub fn numeric_speed(
    collision: &Collision<'_>,
    limited: (&Limits, Option<f64>),
    guess: f64,
    interrupted: Interrupted<'_>,
) -> Allowed {
    let (limits, area) = limited;
    let (unfinished, rising) = (Cell::new(false), Cell::new(false));
    let collide = |speed: f64| {
        let moving = Collision {
            closing_speed: speed,
            ..collision.clone()
        };
        simulate(&moving, Wanted::default(), interrupted)
    };
    let of = |speed: f64| {
        if let Some(bounds) = bounds(collision, limited, speed)
            && worst(bounds) < WELL_INSIDE
        {
            return bounds;
        }
        let outcome = collide(speed);
        let found = shares(collision, limited, &outcome);
        unfinished.set(unfinished.get() || worst(found).is_nan());
        // Loads above their limits at the horizon are above them whatever comes later.
        let doubted = outcome.rising && worst(found) <= 1.0 + super::TIE;
        rising.set(rising.get() || doubted);
        found
    };
    let mut found = Allowed {
        speed: f64::NAN,
        governs: Governs::Nothing,
        speeds: [f64::NAN; 3],
        status: SpeedStatus::Monotone,
        further: Vec::new(),
        compression: f64::NAN,
        rising: false,
    };
    let strained = collision
        .pad
        .is_some_and(|pad| limits.strain(pad).is_finite());
    let pressed = limits.pressure.is_some() && (collision.pad.is_some() || area.is_some());
    if limits.force.is_none() && !pressed && !strained {
        found.status = SpeedStatus::NotChecked;
        return found;
    }
    let crossings = if is_monotone(collision) {
        bracket(&of, guess)
            .map(|ends| refined(&of, ends))
            .into_iter()
            .collect()
    } else {
        scanned(&of)
    };
    found.rising = rising.get();
    if unfinished.get() {
        found.status = SpeedStatus::Unfinished;
        return found;
    }
    let Some((first, rest)) = crossings.split_first() else {
        found.status = SpeedStatus::Unlimited;
        return found;
    };
    let at = of(*first);
    let most = worst(at);
    let place = at
        .iter()
        .position(|share| *share >= most * (1.0 - super::TIE));
    found.governs = place.map_or(Governs::Nothing, |index| Governs::ALL[index]);
    found.speed = *first;
    if let Some(index) = place {
        found.speeds[index] = *first;
    }
    found.compression = collide(*first).peak_covering_compression;
    found.further = rest.to_vec();
    if !rest.is_empty() {
        found.status = SpeedStatus::SeveralCrossings;
    }
    found
}

/// Speeds around the one at which rising loads reach their limit.
fn bracket(of: &impl Fn(f64) -> [f64; 3], guess: f64) -> Option<[f64; 2]> {
    let inside = |speed: f64| worst(of(speed)) <= 1.0;
    let start = if guess.is_finite() {
        guess.clamp(SCANNED[0], SCANNED[1])
    } else {
        1.0
    };
    let (mut low, mut high) = (start, start);
    if inside(start) {
        while high < SCANNED[1] {
            (low, high) = (high, (1.25 * high).min(SCANNED[1]));
            if !inside(high) {
                return Some([low, high]);
            }
        }
        return None;
    }
    while low > LOWEST {
        (low, high) = (0.8 * low, low);
        if inside(low) {
            return Some([low, high]);
        }
    }
    Some([low, high])
}

/// Every speed of the scan at which the loads cross their limits, the lowest first.
fn scanned(of: &impl Fn(f64) -> [f64; 3]) -> Vec<f64> {
    let ratio = (SCANNED[1] / SCANNED[0]).ln() / (SCANS - 1) as f64;
    let speeds: Vec<f64> = (0..SCANS)
        .map(|index| SCANNED[0] * (ratio * index as f64).exp())
        .collect();
    let values: Vec<f64> = speeds.iter().map(|speed| worst(of(*speed))).collect();
    let mut found = Vec::new();
    if values[0] > 1.0
        && let Some(ends) = bracket(of, speeds[0])
    {
        found.push(refined(of, ends));
    }
    for (pair, ends) in values.windows(2).zip(speeds.windows(2)) {
        if (pair[0] > 1.0) != (pair[1] > 1.0) {
            found.push(refined(of, [ends[0], ends[1]]));
        }
    }
    found
}

/// Where the largest share is 1, by secants on logarithms, in which it is nearly a line: a speed at which it
/// is at most 1, if it is so at one of the ends.
fn refined(of: &impl Fn(f64) -> [f64; 3], ends: [f64; 2]) -> f64 {
    let value = |speed: f64| worst(of(speed)).ln();
    let [mut low, mut high] = ends.map(f64::ln);
    let (mut at_low, mut at_high) = (value(ends[0]), value(ends[1]));
    // The innermost speeds within the limits and beyond them.
    let mut inside = if at_low <= 0.0 { ends[0] } else { ends[1] };
    let mut found = inside;
    let mut side = 0;
    for _ in 0..100 {
        let width = high - low;
        let line = if at_high.is_finite() && at_low.is_finite() {
            low + width * at_low / (at_low - at_high)
        } else {
            0.5 * (low + high)
        };
        let x = if line > low.min(high) && line < low.max(high) {
            line
        } else {
            0.5 * (low + high)
        };
        found = x.exp();
        let now = value(found);
        if now <= 0.0 {
            inside = found;
        }
        if now.abs() < 1e-13 || width.abs() < 1e-13 {
            break;
        }
        // The end that stays twice loses half of its weight (Illinois).
        if (now > 0.0) == (at_high > 0.0) {
            (high, at_high) = (x, now);
            if side == 1 {
                at_low *= 0.5;
            }
            side = 1;
        } else {
            (low, at_low) = (x, now);
            if side == -1 {
                at_high *= 0.5;
            }
            side = -1;
        }
    }
    within(of, found, inside)
}

/// The speed, or one next to it on the way to a speed that is within the limits, at which all loads are:
/// a crossing is found to rounding only, and where a load jumps it is found on either side.
fn within(of: &impl Fn(f64) -> [f64; 3], found: f64, inside: f64) -> f64 {
    let mut share = FIRST_STEP;
    let mut speed = found;
    while worst(of(speed)) > 1.0 && share < 1.0 {
        speed = found + (inside - found) * share;
        share *= 4.0;
    }
    if worst(of(speed)) > 1.0 {
        inside
    } else {
        speed
    }
}

#[cfg(test)]
mod tests {
    use super::{refined, worst};

    #[test]
    fn a_speed_is_never_beyond_a_limit() {
        for part in 0..200 {
            let place = 0.2 + 1e-3 * f64::from(part);
            let smooth = |speed: f64| [(speed / place).powf(1.7), f64::NAN, 0.3 * speed];
            // A load that jumps past its limit, and one that does not reach it before.
            let jump = |speed: f64| {
                let share = if speed < place { 0.8 } else { 1.2 };
                [f64::NAN, share * speed / place, f64::NAN]
            };
            let far = |speed: f64| [if speed < place { 1e-9 } else { 1e9 }; 3];
            for load in [&smooth as &dyn Fn(f64) -> [f64; 3], &jump, &far] {
                let found = refined(&load, [0.1, 2.0]);
                assert!(worst(load(found)) <= 1.0, "{found} {place}");
                assert!((found / place - 1.0).abs() < 1e-11, "{found} {place}");
            }
        }
    }
}
