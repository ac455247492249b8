//! Chance that a speed is not allowed where inputs are uncertain.

use numeric::parallel::Work;
use numeric::random::Stream;
use numeric::threads::{map, on_threads};

use super::Governs;
use super::row::{Row, is_of_law};
use super::setup::Setup;
use crate::error::{Failure, Given, Result, at_most, finite, positive};
use crate::quantile::quantiles;

/// Draws of one stream.
const BLOCK: usize = 1024;
/// Most draws.
pub const MOST_DRAWS: usize = 100_000_000;
/// Chance of a normal number below zero that is still borne where it has to be positive.
const BORNE: f64 = 1e-6;

/// Distribution of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// Mean and standard deviation.
    Normal([f64; 2]),
    /// Median and standard deviation of the logarithm.
    LogNormal([f64; 2]),
    /// Both ends.
    Uniform([f64; 2]),
    /// Both ends and the most likely value between them.
    Triangular([f64; 3]),
}

impl Distribution {
    /// The distribution of a positive quantity, if it is one.
    ///
    /// # Errors
    /// A number is out of its range, or values that are not positive are too likely.
    pub fn checked(self, name: &str) -> Result<Self> {
        match self {
            Self::Normal([mean, deviation]) => {
                finite(name, mean)?;
                positive(name, deviation)?;
                let below = normal_probability(-mean / deviation);
                if below > BORNE {
                    let rule = format!(
                        "be positive but for a chance of {BORNE:?}; with this mean and deviation the chance is"
                    );
                    return Err(Failure::invalid(name, rule, Given::Number(below))
                        .mended_by("a lognormal distribution is positive"));
                }
            }
            Self::LogNormal([median, deviation]) => {
                positive(name, median)?;
                positive(name, deviation)?;
            }
            Self::Uniform([low, high]) => {
                positive(name, low)?;
                rising(name, low, high)?;
            }
            Self::Triangular([low, likely, high]) => {
                positive(name, low)?;
                rising(name, low, high)?;
                if !(likely >= low && likely <= high) {
                    let rule = format!("have its most likely value from {low} to {high}");
                    return Err(Failure::invalid(name, rule, Given::Number(likely)));
                }
            }
        }
        Ok(self)
    }

    fn draw(&self, stream: &mut Stream, spare: &mut Option<f64>) -> f64 {
        let mut normal = || {
            spare.take().unwrap_or_else(|| {
                let [first, second] = stream.normals();
                *spare = Some(second);
                first
            })
        };
        match *self {
            Self::Normal([mean, deviation]) => loop {
                // Fewer than one in a million are not positive, and are drawn again.
                let drawn = mean + deviation * normal();
                if drawn > 0.0 {
                    break drawn;
                }
            },
            Self::LogNormal([median, deviation]) => median * (deviation * normal()).exp(),
            Self::Uniform([low, high]) => stream.uniform(low, high),
            Self::Triangular([low, likely, high]) => {
                let (u, width) = (stream.unit(), high - low);
                if u * width < likely - low {
                    low + (u * width * (likely - low)).sqrt()
                } else {
                    high - ((1.0 - u) * width * (high - likely)).sqrt()
                }
            }
        }
    }
}

fn rising(name: &str, low: f64, high: f64) -> Result<()> {
    if finite(name, high)? > low {
        return Ok(());
    }
    let rule = format!("have its upper end above {low}");
    Err(Failure::invalid(name, rule, Given::Number(high)))
}

/// `Phi(x)` of the standard normal distribution.
#[must_use]
pub fn normal_probability(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

/// An interval of a chance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Probability that a speed is not allowed, from random draws of the inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Probability {
    /// Share of draws in which the speed is not allowed.
    pub probability: f64,
    /// 95 % interval of Clopper and Pearson.
    pub interval: Interval,
    /// Allowed speeds that 5, 50 and 95 % of the draws stay below, in m/s.
    pub quantiles: [f64; 3],
    /// Draws in which it is not allowed.
    pub exceeded: usize,
    /// Draws.
    pub draws: usize,
}

/// Without a limit every speed would count as allowed.
fn nothing_checked() -> Failure {
    let given = Given::Found("none that is checked".into());
    Failure::invalid("limits", "name a limit to keep", given)
        .mended_by("a pressure is checked with the area of the contact")
}

/// Chance that a speed is not allowed. A block of draws has a stream of its own, so that no number of
/// threads changes a bit.
///
/// # Errors
/// A draw is out of range, no limit is checked, there are too many draws, or the caller asked to stop.
pub fn exceedance(
    setup: &Setup,
    row: &Row,
    inputs: &[(usize, Distribution)],
    speed: f64,
    (draws, seed): (usize, u64),
    work: Work<'_>,
) -> Result<Probability> {
    at_most("draws", draws, MOST_DRAWS)?;
    let block = |index: usize| -> Result<Vec<f64>> {
        if (work.interrupted)() {
            return Err(Failure::Interrupted);
        }
        let count = BLOCK.min(draws - index * BLOCK);
        let mut stream = Stream::new(seed, index as u64);
        let mut spare = None;
        let mut row = *row;
        let fixed = if inputs.iter().any(|(place, _)| is_of_law(*place)) {
            None
        } else {
            setup.material(&row)?
        };
        let speeds = (0..count)
            .map(|_| {
                for (place, distribution) in inputs {
                    row.0[*place] = distribution.draw(&mut stream, &mut spare);
                }
                let found = setup.closed_form(&row, fixed.as_ref())?;
                if found.governs == Governs::Nothing {
                    return Err(nothing_checked());
                }
                Ok(found.speed)
            })
            .collect();
        (work.progress)(count);
        speeds
    };
    let mut speeds: Vec<f64> = Vec::with_capacity(draws);
    for part in on_threads(work.threads, || Ok(map(draws.div_ceil(BLOCK), block)))? {
        speeds.extend(part?);
    }
    let exceeded = speeds.iter().filter(|allowed| **allowed < speed).count();
    let quantiles = quantiles(&speeds, [0.05, 0.5, 0.95], work.interrupted)?;
    Ok(Probability {
        probability: exceeded as f64 / draws as f64,
        interval: clopper_pearson(exceeded, draws),
        quantiles,
        exceeded,
        draws,
    })
}

/// 95 % interval of a share after Clopper and Pearson (1934).
#[must_use]
pub fn clopper_pearson(count: usize, of: usize) -> Interval {
    let (hits, misses) = (count as f64, (of - count) as f64);
    Interval {
        low: if count == 0 {
            0.0
        } else {
            beta_quantile(0.025, hits, misses + 1.0)
        },
        high: if count == of {
            1.0
        } else {
            beta_quantile(0.975, hits + 1.0, misses)
        },
    }
}

fn beta_quantile(share: f64, a: f64, b: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for _ in 0..2000 {
        // Small shares need small steps.
        let middle = if low > 0.0 && high < 0.5 {
            (low * high).sqrt()
        } else {
            0.5 * (low + high)
        };
        if middle <= low || middle >= high {
            break;
        }
        if incomplete_beta(middle, a, b) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Regularized incomplete beta function by its continued fraction (Lentz).
fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(1.0 - x, b, a);
    }
    let scale =
        libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b) + a * x.ln() + b * (-x).ln_1p();
    let guard = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / guard(1.0 - (a + b) * x / (a + 1.0));
    let mut sum = d;
    for index in 1..100_000 {
        let m = f64::from(index);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / guard(1.0 + even * d);
        c = guard(1.0 + even / c);
        sum *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / guard(1.0 + odd * d);
        c = guard(1.0 + odd / c);
        let change = d * c;
        sum *= change;
        if (change - 1.0).abs() < 1e-15 {
            break;
        }
    }
    (scale.exp() * sum / a).min(1.0)
}
