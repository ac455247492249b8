//! Collisions of free bodies without damper: loads from the stored energy, times by quadrature.
//!
//! Where forces do not depend on the rate, `mu eps'^2/2 = W(D) - W(d)` at any compression, with `W` of covering and
//! region together, so the time to the largest one is the integral of `deps/eps'`. That holds on the way back of
//! every covering, with the work that unloading returns, and on the way in of one without rate.

use numeric::lanes::{Lanes, Number, Real, each, vectors};
use pulp::{Simd, WithSimd};

use super::loading::{Turn, first_exponent, smooth_power, turns_of};
use super::outcome::{CollisionStatus, Outcome};
use super::statics::rest_of;
use super::{Collision, Region};
use crate::covering::{Kinks, Pad, Shape, product};
use crate::roots::Peak;

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

/// Shares of the largest compression between which a kink ends the first piece; else half of it does.
const FIRST_MARK: [f64; 2] = [0.01, 0.5];

/// Half of the nodes of a rule and its middle.
type Nodes = Lanes<8>;

/// A function to integrate.
trait Integrand {
    /// Values of the integrand side by side.
    fn at<R: Real>(&self, x: R) -> R;
}

/// Values of an integrand side by side.
struct Values<'a, I>(&'a I, [Nodes; 2]);

impl<I: Integrand> WithSimd for Values<'_, I> {
    type Output = [Nodes; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> [Nodes; 2] {
        let Self(integrand, mut nodes) = self;
        // A loop: the code of an integrand is long.
        for x in &mut nodes {
            *x = integrand.at(*x);
        }
        nodes
    }
}

/// Integral over an interval, and the error of the smaller rule.
fn kronrod(low: f64, high: f64, integrand: &impl Integrand) -> [f64; 2] {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let node = |lane: usize| NODES.get(lane).map_or(0.0, |node| node[0]);
    let away = Nodes::splat(half) * Nodes::from_fn(node);
    let center = Nodes::splat(middle);
    let nodes = [center - away, center + away];
    // Of two lanes: one number by itself takes other functions of the library, with other bits.
    let at = |x: f64| integrand.at(Lanes::<2>::splat(x)).lane(0);
    let plain = |x: Nodes| Nodes::from_fn(|lane| at(x.lane(lane)));
    let [before, beyond] = match vectors() {
        Some(vectors) => Simd::vectorize(vectors, Values(integrand, nodes)),
        None => nodes.map(plain),
    };
    let [mut fine, mut coarse] = MIDDLE.map(|weight| weight * before.lane(NODES.len()));
    for (index, [_, weight, of_gauss]) in NODES.into_iter().enumerate() {
        let both = before.lane(index) + beyond.lane(index);
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
    integrand: &impl Integrand,
) -> Option<f64> {
    let [value, error] = kronrod(low, high, integrand);
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
        integral([low, middle], goal, left, integrand)?
            + integral([middle, high], goal, left, integrand)?,
    )
}

/// Covering and region as one column that is compressed: the covering, or the region of a bare contact.
struct CompressedStack<'a> {
    pad: Option<&'a Pad>,
    region: Region,
    /// Work `w` of the law at the largest strain, where unloading returns less.
    largest_work: Option<f64>,
}

impl CompressedStack<'_> {
    /// Stored work at compressions side by side, and `deps/dd`.
    #[inline(always)]
    fn at<R: Real>(&self, compression: R) -> [R; 2] {
        let one = R::splat(1.0);
        let Some(pad) = self.pad else {
            return [self.region.stored(compression), one];
        };
        if let Some(largest) = self.largest_work {
            return each(compression, |d| self.returned(pad, largest, d));
        }
        if self.region == Region::Rigid {
            return [pad.works(compression), one];
        }
        let [work, force, slope] = pad.work_and_force(compression);
        self.with_region(work, [force, slope])
    }

    /// Work that a flat covering that has not bottomed out returns, and `deps/dd`: `U` is a function of its work
    /// alone, `int s U de = H w + (1-H) w (w/w_max)^s/(s+1)`.
    fn returned(&self, pad: &Pad, largest: f64, compression: f64) -> [f64; 2] {
        let unloading = pad.covering.unloading;
        let strain = compression / pad.covering.thickness;
        let whole = pad.work(compression);
        let [factor, change] = pad.unloading_factor(strain, largest);
        // U = H + (1-H) (w/w_max)^s.
        let more = factor - unloading.retained;
        let work = whole * (unloading.retained + more / (unloading.exponent + 1.0));
        if self.region == Region::Rigid {
            return [work, 1.0];
        }
        let [force, slope] = pad.force(compression);
        let slope = slope * factor + force * change / pad.covering.thickness;
        self.with_region(work, [force * factor, slope])
    }

    #[inline(always)]
    fn with_region<R: Real>(&self, work: R, [force, slope]: [R; 2]) -> [R; 2] {
        let deflection = self.region.deflection(force);
        let yielding = self.region.force(deflection)[1];
        let zero = R::zero();
        let level = slope.le(zero) & slope.ge(zero);
        let more = R::select(level, zero, slope / yielding);
        [work + self.region.stored(deflection), R::splat(1.0) + more]
    }

    /// Power of the substitution in which the compression starts smoothly.
    fn power(&self) -> u32 {
        let exponent = self.pad.map_or(1.0, |pad| first_exponent(pad, self.region));
        smooth_power(exponent).unsigned_abs()
    }

    /// Whether the force of a cylinder beyond a kink of the law grows like a half power.
    fn starts_with_half_power(&self, mark: f64) -> bool {
        self.pad.is_some_and(|pad| {
            let round = matches!(pad.covering.shape, Shape::Cylinder { .. });
            round && pad.kinks().contains(&mark)
        })
    }

    /// Time to a largest compression.
    fn time(&self, largest: f64, mass: f64, size: f64, tolerance: f64) -> Option<f64> {
        let mut marks = self.pad.map_or_else(Kinks::new, Pad::kinks);
        marks.retain(|kink| *kink < largest);
        let early = FIRST_MARK[0] * largest..=FIRST_MARK[1] * largest;
        if !marks.first().is_some_and(|kink| early.contains(kink)) {
            marks.push(0.5 * largest);
            numeric::order::sort_ascending(&mut marks);
        }
        marks.push(largest);
        let goal = (size, tolerance);
        let (first, power) = (marks[0], self.power());
        let start = TimeIntegrand {
            column: self,
            // As every other work, for their difference.
            all: self.at(Lanes::<2>::splat(largest))[0].lane(0),
            mass,
            over: Substitution::Start { first, power },
        };
        let mut time = integral([0.0, 1.0], goal, HALVINGS, &start)?;
        for pair in marks.windows(2) {
            let mut from = pair[0];
            if self.starts_with_half_power(from) {
                from = 0.5 * (pair[0] + pair[1]);
                let beyond = TimeIntegrand {
                    over: Substitution::Beyond(pair[0]),
                    ..start
                };
                time += integral([0.0, (from - pair[0]).sqrt()], goal, HALVINGS, &beyond)?;
            }
            // The speed falls like the square root of what is left.
            let [near, far] = [pair[1], from].map(|mark| (largest - mark).max(0.0).sqrt());
            if far > near {
                let left = TimeIntegrand {
                    over: Substitution::Left(largest),
                    ..start
                };
                time += integral([near, far], goal, HALVINGS, &left)?;
            }
        }
        Some(time)
    }
}

/// Substitution for the compression in an integral.
#[derive(Clone, Copy)]
enum Substitution {
    /// `x` of `d = first x^power`.
    Start { first: f64, power: u32 },
    /// `x` of `d = kink + x^2`.
    Beyond(f64),
    /// `x` of `d = largest - x^2`.
    Left(f64),
}

/// Rate of the time over a variable.
#[derive(Clone, Copy)]
struct TimeIntegrand<'a> {
    column: &'a CompressedStack<'a>,
    /// Work at the largest compression.
    all: f64,
    mass: f64,
    over: Substitution,
}

impl Integrand for TimeIntegrand<'_> {
    #[inline(always)]
    fn at<R: Real>(&self, x: R) -> R {
        let two = R::splat(2.0);
        let (compression, change) = match self.over {
            Substitution::Start { first, power } => {
                let first = R::splat(first);
                let change = R::splat(f64::from(power)) * first * product(x, power - 1);
                (first * product(x, power), change)
            }
            Substitution::Beyond(kink) => (R::splat(kink) + x * x, two * x),
            Substitution::Left(largest) => (R::splat(largest) - x * x, two * x),
        };
        let [work, rate] = self.column.at(compression);
        let speed = (two * (R::splat(self.all) - work) / R::splat(self.mass)).sqrt();
        change * (rate / speed)
    }
}

fn is_rated(pad: Option<&Pad>) -> bool {
    pad.is_some_and(|pad| !pad.covering.rate.is_none())
}

/// Where the compression turns: from the energy, or that of the motion where the rate counts.
fn turned(collision: &Collision<'_>, moved: Option<&Turn>) -> Option<Turn> {
    let (pad, region) = (collision.pad, collision.region);
    if is_rated(pad) {
        return moved.copied();
    }
    let (mass, speed) = (collision.reduced_mass(), collision.closing_speed);
    let rest = rest_of(pad, region, 0.5 * mass * speed * speed);
    let compression = if pad.is_some() {
        rest.compression
    } else {
        rest.deflection
    };
    let total = rest.compression + rest.deflection;
    let bounded = pad.is_none_or(|pad| compression < pad.bound() * (1.0 - 1e-9));
    if !(compression > 0.0 && total.is_finite() && bounded) {
        return None;
    }
    let column = CompressedStack {
        pad,
        region,
        largest_work: None,
    };
    let time = column.time(compression, mass, total / speed, collision.tolerance)?;
    let top = |value: f64| Peak { value, time };
    Some(Turn {
        compression,
        time,
        force: top(rest.force),
        pressure: top(pad.map_or(f64::NAN, |pad| {
            pad.covering
                .material
                .stress(compression / pad.covering.thickness)[0]
        })),
        evaluations: 0,
    })
}

/// Whether loads without supports follow from the stored energy, and the motion up to the turn where the rate counts.
fn is_known(pad: Option<&Pad>) -> bool {
    // What unloading returns has a closed form for a flat covering, as far as its bottom.
    let known = |pad: &Pad| {
        let flat = matches!(pad.covering.shape, Shape::Flat { .. });
        pad.covering.unloading.retained == 1.0 || flat
    };
    pad.is_none_or(|pad| pad.covering.damping == 0.0 && known(pad))
}

/// Turns of those of some collisions of free bodies whose motion up to there is needed for their loads.
#[must_use]
pub fn turns(collisions: &[&Collision<'_>]) -> Vec<Option<Turn>> {
    let wanted = |place: &usize| {
        let pad = collisions[*place].pad;
        is_rated(pad) && is_known(pad)
    };
    let places: Vec<usize> = (0..collisions.len()).filter(wanted).collect();
    let some: Vec<_> = places.iter().map(|place| collisions[*place]).collect();
    let mut found = vec![None; collisions.len()];
    for (place, turn) in places.into_iter().zip(turns_of(&some)) {
        found[place] = turn;
    }
    found
}

/// Loads of a collision of free bodies without damper that ends before its horizon, with its turn if the rate counts.
#[must_use]
pub fn stored(collision: &Collision<'_>, moved: Option<&Turn>) -> Option<Outcome> {
    let (pad, region) = (collision.pad, collision.region);
    if !is_known(pad) {
        return None;
    }
    let lossy = pad.is_some_and(|pad| pad.covering.unloading.retained < 1.0);
    let rated = is_rated(pad);
    let turn = turned(collision, moved)?;
    if lossy && pad.is_some_and(|pad| turn.compression > pad.bottom()) {
        return None;
    }
    let (mass, speed) = (collision.reduced_mass(), collision.closing_speed);
    let at_turn = pad.map_or(turn.force.value, |pad| pad.force(turn.compression)[0]);
    let deflection = region.deflection(at_turn);
    let total = if pad.is_some() {
        turn.compression + deflection
    } else {
        deflection
    };
    let (mut back, mut rebound) = (turn.time, speed);
    if lossy || rated {
        let column = CompressedStack {
            pad,
            region,
            largest_work: pad.filter(|_| lossy).map(|pad| {
                let strain = turn.compression / pad.covering.thickness;
                pad.covering.material.work(strain)
            }),
        };
        let size = total / speed;
        back = column.time(turn.compression, mass, size, collision.tolerance)?;
        rebound = (2.0 * column.at::<f64>(turn.compression)[0] / mass).sqrt();
    }
    let release_time = turn.time + back;
    if release_time >= collision.horizon {
        return None;
    }
    let share = 1.0 / collision.body.mass;
    let free = |value: f64| if share > 0.0 { value } else { f64::NAN };
    let mut outcome = Outcome {
        release_time,
        peak_force: turn.force.value,
        peak_force_time: turn.force.time,
        peak_total_compression: total,
        peak_body_deflection: region.deflection(turn.force.value),
        rebound_speed: rebound,
        peak_body_acceleration: free(turn.force.value * share),
        body_speed_end: free(mass * share * (speed + rebound)),
        end_force: 0.0,
        evaluations: turn.evaluations,
        ..Outcome::nothing(CollisionStatus::Released)
    };
    if let Some(pad) = pad {
        let strain = turn.compression / pad.covering.thickness;
        outcome.peak_covering_compression = turn.compression;
        outcome.peak_strain = strain;
        outcome.bottomed = turn.compression > pad.bottom();
        if let Shape::Flat { area } = pad.covering.shape {
            outcome.peak_pressure = turn.force.value / area;
            if !rated && pad.force(turn.compression)[1] == 0.0 {
                outcome.peak_force_time = f64::NAN;
            }
        } else {
            outcome.peak_pressure = turn.pressure.value;
        }
    }
    Some(outcome)
}

#[cfg(test)]
mod tests {
    use super::{Integrand, MIDDLE, NODES, Real, kronrod, product};

    /// `(n + 1) x^n`.
    struct Monomial(u32);

    impl Integrand for Monomial {
        fn at<R: Real>(&self, x: R) -> R {
            R::splat(f64::from(self.0 + 1)) * product(x, self.0)
        }
    }

    #[test]
    fn both_rules_are_exact_for_their_polynomials() {
        let sums = NODES.iter().fold([0.0; 2], |[fine, coarse], [_, a, b]| {
            [fine + 2.0 * a, coarse + 2.0 * b]
        });
        assert!((sums[0] + MIDDLE[0] - 2.0).abs() < 1e-15);
        assert!((sums[1] + MIDDLE[1] - 2.0).abs() < 1e-15);
        let [value, error] = kronrod(0.0, 2.0, &Monomial(22));
        assert!((value / 2.0_f64.powi(23) - 1.0).abs() < 1e-14 && error > 1.0);
        let [value, error] = kronrod(0.0, 2.0, &Monomial(13));
        assert!((value / 2.0_f64.powi(14) - 1.0).abs() < 1e-14 && error < 1e-9);
    }
}
