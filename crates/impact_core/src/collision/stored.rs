//! Collisions of free bodies in which nothing is lost: loads from the stored energy, times by quadrature.
//!
//! At any compression `mu eps'^2/2 = W(D) - W(d)`, with `W` of covering and region together, so the time to the
//! largest one is the integral of `deps/eps'`, and the way back takes as long.

use super::outcome::{Outcome, Status};
use super::statics::rest_of;
use super::{Collision, Region};
use crate::covering::{Pad, Shape};

/// Positive nodes of Kronrod's rule of 15 points on [-1, 1] with their weights, and those of Gauss's rule of 7.
#[rustfmt::skip]
#[allow(clippy::unreadable_literal)] // nodes and weights as tables print them
const NODES: [[f64; 3]; 7] = [
    [0.9914553711208126, 0.022935322010529224, 0.0],
    [0.9491079123427585, 0.06309209262997856, 0.1294849661688697],
    [0.8648644233597691, 0.10479001032225019, 0.0],
    [0.7415311855993945, 0.14065325971552592, 0.27970539148927664],
    [0.5860872354676911, 0.1690047266392679, 0.0],
    [0.4058451513773972, 0.19035057806478542, 0.3818300505051189],
    [0.20778495500789848, 0.20443294007529889, 0.0],
];
#[allow(clippy::unreadable_literal)] // likewise
const MIDDLE: [f64; 2] = [0.20948214108472782, 0.4179591836734694];
/// Halvings of a piece before the motion itself is solved.
const HALVINGS: u32 = 4;
/// Power of the substitution where a covering starts infinitely stiff.
const START: i32 = 4;

/// Integral over an interval, and the error of the smaller rule.
fn kronrod(low: f64, high: f64, function: &impl Fn(f64) -> f64) -> [f64; 2] {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let center = function(middle);
    let [mut fine, mut coarse] = MIDDLE.map(|weight| weight * center);
    for [node, weight, of_gauss] in NODES {
        let both = function(middle - half * node) + function(middle + half * node);
        fine += weight * both;
        coarse += of_gauss * both;
    }
    [half * fine, half * (fine - coarse).abs()]
}

/// Integral to a tolerance; `None` where halving does not reach it.
fn integral(
    [low, high]: [f64; 2],
    (size, tolerance): (f64, f64),
    halvings: u32,
    function: &impl Fn(f64) -> f64,
) -> Option<f64> {
    let [value, error] = kronrod(low, high, function);
    if !value.is_finite() {
        return None;
    }
    // The usual estimate of the larger rule's error from that of the smaller one.
    if (200.0 * error / size).powf(1.5) <= tolerance {
        return Some(value);
    }
    let left = halvings.checked_sub(1)?;
    let middle = 0.5 * (low + high);
    let goal = (size, tolerance);
    Some(
        integral([low, middle], goal, left, function)?
            + integral([middle, high], goal, left, function)?,
    )
}

/// Covering and region as one column that is compressed: the covering, or the region of a bare contact.
struct Column<'a> {
    pad: Option<&'a Pad>,
    region: Region,
}

impl Column<'_> {
    /// Stored work at a compression, and `deps/dd`.
    fn at(&self, compression: f64) -> [f64; 2] {
        let Some(pad) = self.pad else {
            return [self.region.stored(compression), 1.0];
        };
        let [force, slope] = pad.force(compression);
        if self.region == Region::Rigid {
            return [pad.work(compression), 1.0];
        }
        let deflection = self.region.deflection(force);
        let yielding = self.region.force(deflection)[1];
        let work = pad.work(compression) + self.region.stored(deflection);
        let more = if slope == 0.0 { 0.0 } else { slope / yielding };
        [work, 1.0 + more]
    }

    /// Whether the compression starts like a power of the time below 1.
    fn starts_steep(&self) -> bool {
        self.pad
            .is_some_and(|pad| pad.force(0.0)[1].is_infinite() || self.region.force(0.0)[1] == 0.0)
    }

    /// Time to a largest compression.
    fn time(&self, largest: f64, mass: f64, size: f64, tolerance: f64) -> Option<f64> {
        let all = self.at(largest)[0];
        let late = |compression: f64| {
            let [work, rate] = self.at(compression);
            rate / (2.0 * (all - work) / mass).sqrt()
        };
        let mut marks = vec![0.5 * largest];
        if let Some(pad) = self.pad {
            marks.extend(pad.kinks().into_iter().filter(|kink| *kink < largest));
            marks.sort_by(f64::total_cmp);
        }
        marks.push(largest);
        let goal = (size, tolerance);
        let first = marks[0];
        let power = if self.starts_steep() { START } else { 1 };
        let mut time = integral([0.0, 1.0], goal, HALVINGS, &|x| {
            f64::from(power) * first * x.powi(power - 1) * late(first * x.powi(power))
        })?;
        for pair in marks.windows(2) {
            // The speed falls like the square root of what is left.
            let [near, far] = [pair[1], pair[0]].map(|mark| (largest - mark).max(0.0).sqrt());
            if far > near {
                time += integral([near, far], goal, HALVINGS, &|s| {
                    2.0 * s * late(largest - s * s)
                })?;
            }
        }
        Some(time)
    }
}

/// Loads of a collision of free bodies without rate, damper and loss in unloading that ends before its horizon.
#[must_use]
pub fn stored(collision: &Collision<'_>) -> Option<Outcome> {
    let (pad, region) = (collision.pad, collision.region);
    if let Some(Pad { covering, .. }) = pad
        && (covering.damping > 0.0 || !covering.rate.is_none() || covering.unloading.retained < 1.0)
    {
        return None;
    }
    let (mass, speed) = (collision.reduced_mass(), collision.closing_speed);
    let rest = rest_of(pad, region, 0.5 * mass * speed * speed);
    let largest = if pad.is_some() {
        rest.compression
    } else {
        rest.deflection
    };
    let total = rest.compression + rest.deflection;
    let bounded = pad.is_none_or(|pad| largest < pad.bound() * (1.0 - 1e-9));
    if !(largest > 0.0 && total.is_finite() && bounded) {
        return None;
    }
    let column = Column { pad, region };
    let time = column.time(largest, mass, total / speed, collision.tolerance)?;
    if 2.0 * time >= collision.horizon {
        return None;
    }
    let share = 1.0 / collision.body.mass;
    let free = |value: f64| if share > 0.0 { value } else { f64::NAN };
    let mut outcome = Outcome {
        release_time: 2.0 * time,
        peak_force: rest.force,
        peak_force_time: time,
        peak_total_compression: total,
        peak_body_deflection: rest.deflection,
        rebound_speed: speed,
        peak_body_acceleration: free(rest.force * share),
        body_speed_end: free(2.0 * mass * share * speed),
        end_force: 0.0,
        ..Outcome::nothing(Status::Released)
    };
    if let Some(pad) = pad {
        let strain = largest / pad.covering.thickness;
        outcome.peak_covering_compression = largest;
        outcome.peak_strain = strain;
        outcome.bottomed = largest > pad.bottom();
        if let Shape::Flat { area } = pad.covering.shape {
            outcome.peak_pressure = rest.force / area;
            if pad.force(largest)[1] == 0.0 {
                outcome.peak_force_time = f64::NAN;
            }
        } else {
            outcome.peak_pressure = pad.covering.material.stress(strain)[0];
        }
    }
    Some(outcome)
}

#[cfg(test)]
mod tests {
    use super::{MIDDLE, NODES, kronrod};

    #[test]
    fn both_rules_are_exact_for_their_polynomials() {
        let sums = NODES.iter().fold([0.0; 2], |[fine, coarse], [_, a, b]| {
            [fine + 2.0 * a, coarse + 2.0 * b]
        });
        assert!((sums[0] + MIDDLE[0] - 2.0).abs() < 1e-15);
        assert!((sums[1] + MIDDLE[1] - 2.0).abs() < 1e-15);
        let [value, error] = kronrod(0.0, 2.0, &|x| 23.0 * x.powi(22));
        assert!((value / 2.0_f64.powi(23) - 1.0).abs() < 1e-14 && error > 1.0);
        let [value, error] = kronrod(0.0, 2.0, &|x| 14.0 * x.powi(13));
        assert!((value / 2.0_f64.powi(14) - 1.0).abs() < 1e-14 && error < 1e-9);
    }
}
