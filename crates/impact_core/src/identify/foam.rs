//! Stiffness, damping and friction of a foam rig from static and drop tests together.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::drop_test::{DropContact, DropModel, trajectory};
use super::least_squares::{Minimum, Start, minimize};
use super::line::{CONFIDENCE, fit_static, student_quantile};
use super::{check_confidence, check_samples};
use crate::error::{Given, ImpactError, Result, positive};
use crate::parameters::GRAVITY;
use crate::signal::check_time;

/// Damping ratios from which the search may start.
const FIRST_RATIOS: [f64; 12] = [
    0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13, 0.17, 0.22, 0.3, 0.45, 0.7,
];
/// Deviation of the positions before it is known, in m.
const FIRST_DEVIATION: f64 = 1e-4;
/// Rounds in which the deviation of the positions is estimated anew.
const ROUNDS: usize = 3;
/// Readings whose errors the covariance takes as related: with 4 the intervals of rounded positions
/// and of positions with independent noise both cover the truth in 93 to 97 % of 1500 repeats.
const NEIGHBORS: usize = 4;
/// Residuals that the bootstrap keeps together: rounding repeats itself while the slide is slow.
const RUN: usize = 8;

/// One drop: the slide is released at rest at the first time.
#[derive(Clone, Copy, Debug)]
pub struct Drop<'a> {
    /// Times, in s.
    pub time: &'a [f64],
    /// Positions, in m, up from the undeformed surface of the foam.
    pub position: &'a [f64],
}

/// What is known about the rig, and how intervals are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoamFitSettings {
    /// Moving mass, in kg.
    pub moving_mass: f64,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// When the foam lets go of the slide.
    pub contact: DropContact,
    /// Repeats of the bootstrap; 0 for none.
    pub bootstrap: usize,
    /// Seed of the bootstrap.
    pub seed: u64,
}

impl FoamFitSettings {
    /// Usual settings: standard gravity, 95 %, a foam that cannot pull, no bootstrap.
    #[must_use]
    pub fn new(moving_mass: f64) -> Self {
        Self {
            moving_mass,
            gravity: GRAVITY,
            confidence: CONFIDENCE,
            contact: DropContact::Unilateral,
            bootstrap: 0,
            seed: 0,
        }
    }
}

/// Fitted foam; triples are in the order stiffness, damping ratio, friction.
#[derive(Clone, Debug, PartialEq)]
pub struct FoamFit {
    /// Stiffness `K_c`, in N/m.
    pub stiffness: f64,
    /// Damping ratio on the rig.
    pub damping_ratio: f64,
    /// Friction of the rail, in N.
    pub friction: f64,
    /// Height of release of every drop, in m.
    pub drop_heights: Vec<f64>,
    /// Covariance.
    pub covariance: [[f64; 3]; 3],
    /// Intervals from the covariance and Student's distribution.
    pub interval: [[f64; 2]; 3],
    /// Percentile intervals of the bootstrap.
    pub bootstrap_interval: Option<[[f64; 2]; 3]>,
    /// Standard deviation of the static forces about their line, in N.
    pub force_deviation: f64,
    /// Standard deviation of the positions about the trajectory, in m.
    pub position_deviation: f64,
    /// Measurements less fitted numbers.
    pub degrees_of_freedom: usize,
    /// Steps of the last search.
    pub iterations: usize,
    /// Moving mass of the rig, in kg.
    pub moving_mass: f64,
}

impl FoamFit {
    /// Damping `2 xi sqrt(M K_c)` of the foam under another mass, in N s/m: the ratio is what stays.
    ///
    /// # Errors
    /// A mass that is not positive.
    pub fn damping(&self, mass: f64) -> Result<f64> {
        positive("mass", mass)?;
        Ok(2.0 * self.damping_ratio * (mass * self.stiffness).sqrt())
    }
}

/// Fits stiffness, damping ratio and friction to static forces and to whole drop trajectories.
///
/// Both tests are weighted by their own scatter, which is estimated too. Positions are compared with
/// the solution of the equation of motion, never differentiated. Where a record ends with equal
/// readings the slide rests; those readings say nothing new and are left out.
///
/// # Errors
/// Bad samples; a drop that starts in the foam or never reaches it; measurements that do not
/// determine the three numbers.
pub fn identify_foam(
    static_force: &[f64],
    static_compression: &[f64],
    drops: &[Drop<'_>],
    settings: &FoamFitSettings,
) -> Result<FoamFit> {
    positive("moving_mass", settings.moving_mass)?;
    positive("gravity", settings.gravity)?;
    check_confidence(settings.confidence)?;
    let line = fit_static(static_force, static_compression, false)?;
    positive("slope of static_force", line.slope)?;
    if drops.is_empty() {
        return Err(ImpactError::invalid(
            "drops",
            "hold at least one drop",
            Given::Count(0),
        ));
    }
    let moving = drops.iter().map(moving_part).collect::<Result<Vec<_>>>()?;
    let mut tests = Tests {
        force: static_force.to_vec(),
        compression: static_compression,
        time: moving.iter().map(|drop| drop.time).collect(),
        position: moving.iter().map(|drop| drop.position.to_vec()).collect(),
        settings: *settings,
        force_deviation: line.residual_deviation.max(f64::EPSILON * line.slope),
        position_deviation: FIRST_DEVIATION,
    };
    let first = tests.first_bounce();
    let start = first.minimize(first.start(line.slope))?.parameters;
    let mut found = tests.minimize(start)?;
    for _ in 0..ROUNDS {
        tests.position_deviation = tests.scatter(&found);
        found = tests.minimize(found.parameters)?;
    }
    let covariance = tests.covariance(&found);
    let interval = tests.interval(&found.parameters, &covariance)?;
    let bootstrap_interval = (settings.bootstrap > 0)
        .then(|| tests.bootstrap(&found))
        .transpose()?;
    Ok(FoamFit {
        stiffness: found.parameters[0],
        damping_ratio: found.parameters[1],
        friction: found.parameters[2],
        drop_heights: found.parameters[3..].to_vec(),
        covariance,
        interval,
        bootstrap_interval,
        force_deviation: tests.force_deviation,
        position_deviation: tests.position_deviation,
        degrees_of_freedom: tests.degrees_of_freedom(),
        iterations: found.steps,
        moving_mass: settings.moving_mass,
    })
}

/// A drop without the readings at rest at its end.
fn moving_part<'a>(drop: &Drop<'a>) -> Result<Drop<'a>> {
    check_time("drop_time", drop.time)?;
    let like_time = "have as many values as drop_time, at least 8";
    check_samples(
        "drop_position",
        drop.position,
        drop.time.len(),
        8,
        like_time,
    )?;
    let lowest = drop.position.iter().copied().fold(f64::INFINITY, f64::min);
    if drop.position[0] <= 0.0 || lowest >= 0.0 {
        let value = if drop.position[0] <= 0.0 {
            drop.position[0]
        } else {
            lowest
        };
        return Err(ImpactError::invalid(
            "drop_position",
            "start above the foam and reach into it",
            Given::Number(value),
        ));
    }
    let last = drop.position[drop.position.len() - 1];
    let resting = drop
        .position
        .iter()
        .rev()
        .take_while(|&&y| y == last)
        .count();
    let kept = (drop.position.len() + 1 - resting).max(2);
    Ok(Drop {
        time: &drop.time[..kept],
        position: &drop.position[..kept],
    })
}

/// All measurements with their scatter.
#[derive(Clone)]
struct Tests<'a> {
    force: Vec<f64>,
    compression: &'a [f64],
    time: Vec<&'a [f64]>,
    position: Vec<Vec<f64>>,
    settings: FoamFitSettings,
    force_deviation: f64,
    position_deviation: f64,
}

impl Tests<'_> {
    fn model(&self, parameters: &[f64], drop: usize) -> DropModel {
        DropModel {
            mass: self.settings.moving_mass,
            stiffness: parameters[0],
            damping_ratio: parameters[1],
            friction: parameters[2],
            height: parameters[3 + drop],
            gravity: self.settings.gravity,
            contact: self.settings.contact,
        }
    }

    fn positions(&self) -> usize {
        self.position.iter().map(Vec::len).sum()
    }

    fn degrees_of_freedom(&self) -> usize {
        self.force.len() + self.positions() - 3 - self.position.len()
    }

    fn forces_left(&self, parameters: &[f64]) -> impl Iterator<Item = f64> {
        let pairs = self.force.iter().zip(self.compression);
        pairs.map(move |(force, compression)| force - parameters[0] * compression)
    }

    fn positions_left(&self, parameters: &[f64], drop: usize) -> Vec<f64> {
        let path = trajectory(self.time[drop], &self.model(parameters, drop));
        let pairs = self.position[drop].iter().zip(path);
        pairs.map(|(measured, path)| measured - path).collect()
    }

    fn residuals(&self, parameters: &[f64]) -> Vec<f64> {
        let mut result: Vec<f64> = self
            .forces_left(parameters)
            .map(|left| left / self.force_deviation)
            .collect();
        for drop in 0..self.time.len() {
            let left = self.positions_left(parameters, drop);
            result.extend(left.iter().map(|left| left / self.position_deviation));
        }
        result
    }

    /// Standard deviation of the positions.
    fn scatter(&self, found: &Minimum) -> f64 {
        let squares: f64 = found.residuals[self.force.len()..]
            .iter()
            .map(|left| left * left)
            .sum();
        let fitted = 2 + self.position.len();
        let degrees = self.positions().saturating_sub(fitted).max(1);
        let deviation = self.position_deviation * (squares / degrees as f64).sqrt();
        // Below rounding the weights would mean nothing.
        deviation.max(1e-15)
    }

    /// First guess: friction from the fall, then the damping ratio that fits the first bounce best.
    fn start(&self, stiffness: f64) -> Vec<f64> {
        let weight = self.settings.moving_mass * self.settings.gravity;
        let (mut product, mut square) = (0.0, 0.0);
        for (time, position) in self.time.iter().zip(&self.position) {
            for (now, height) in time.iter().zip(position) {
                if *height <= 0.0 {
                    break;
                }
                let fallen = 0.5 * (now - time[0]).powi(2);
                product += fallen * (position[0] - height);
                square += fallen * fallen;
            }
        }
        let fall = if square > 0.0 {
            product / square
        } else {
            self.settings.gravity
        };
        let friction = (weight - self.settings.moving_mass * fall).clamp(0.0, 0.8 * weight);
        let mut parameters = vec![stiffness, 0.0, friction];
        parameters.extend(self.position.iter().map(|position| position[0]));
        let cost = |ratio: &f64| {
            let mut trial = parameters.clone();
            trial[1] = *ratio;
            self.residuals(&trial)
                .iter()
                .map(|left| left * left)
                .sum::<f64>()
        };
        let best = FIRST_RATIOS
            .iter()
            .min_by(|a, b| cost(a).total_cmp(&cost(b)));
        parameters[1] = best.copied().unwrap_or(FIRST_RATIOS[0]);
        parameters
    }

    /// The same measurements up to the second contact of every drop.
    fn first_bounce(&self) -> Self {
        let mut short = self.clone();
        for (time, position) in short.time.iter_mut().zip(&mut short.position) {
            let contact = position.iter().position(|&y| y < 0.0).unwrap_or(0);
            let above = position[contact..].iter().position(|&y| y > 0.0);
            let left = contact + above.unwrap_or(position.len() - contact);
            let below = position[left..].iter().position(|&y| y < 0.0);
            let again = left + below.unwrap_or(position.len() - left);
            *time = &time[..again];
            position.truncate(again);
        }
        short
    }

    fn minimize(&self, parameters: Vec<f64>) -> Result<Minimum> {
        let weight = self.settings.moving_mass * self.settings.gravity;
        let mut scale = vec![parameters[0], 0.1, 0.1 * weight];
        let mut lower = vec![1e-3 * parameters[0], 1e-4, 0.0];
        scale.extend(&parameters[3..]);
        lower.extend(parameters[3..].iter().map(|height| 0.1 * height));
        let start = Start {
            parameters,
            scale,
            lower,
        };
        minimize(&start, |parameters| self.residuals(parameters)).ok_or_else(|| {
            ImpactError::invalid(
                "drop_position",
                "determine stiffness, damping and friction",
                Given::Count(self.positions() as u64),
            )
        })
    }

    /// Covariance of stiffness, damping ratio and friction.
    ///
    /// Rounded readings of a smooth path have errors that are related from reading to reading, which
    /// the inverse of the normal matrix alone does not know. Between it stands the scatter of the
    /// gradient, with the products of neighboring readings (Newey and West, 1987).
    fn covariance(&self, found: &Minimum) -> [[f64; 3]; 3] {
        // How far one residual moves each parameter.
        let influence = [0, 1, 2].map(|parameter| {
            let mut moved = vec![0.0; found.residuals.len()];
            for (share, row) in found.inverse[parameter].iter().zip(&found.jacobian) {
                for (moved, slope) in moved.iter_mut().zip(row) {
                    *moved += share * slope;
                }
            }
            moved
        });
        let (forces, mut first) = (self.force.len(), self.force.len());
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut covariance = [0, 1, 2].map(|row| {
            [0, 1, 2].map(|column| dot(&influence[row][..forces], &influence[column][..forces]))
        });
        let moved = influence.map(|influence| {
            let pairs = influence.iter().zip(&found.residuals);
            pairs.map(|(share, left)| share * left).collect::<Vec<_>>()
        });
        for position in &self.position {
            let last = first + position.len();
            for (row, covariance) in covariance.iter_mut().enumerate() {
                for (column, covariance) in covariance.iter_mut().enumerate() {
                    let (row, column) = (&moved[row][first..last], &moved[column][first..last]);
                    *covariance += dot(row, column);
                    for apart in 1..NEIGHBORS.min(position.len()) {
                        let weight = 1.0 - apart as f64 / NEIGHBORS as f64;
                        let products = dot(row, &column[apart..]) + dot(&row[apart..], column);
                        *covariance += weight * products;
                    }
                }
            }
            first = last;
        }
        covariance
    }

    fn interval(&self, parameters: &[f64], covariance: &[[f64; 3]; 3]) -> Result<[[f64; 2]; 3]> {
        let quantile = student_quantile(self.settings.confidence, self.degrees_of_freedom())?;
        Ok([0, 1, 2].map(|k| {
            let half = quantile * covariance[k][k].sqrt();
            [parameters[k] - half, parameters[k] + half]
        }))
    }

    /// Percentile intervals of refits to the fitted curves with resampled residuals.
    fn bootstrap(&self, found: &Minimum) -> Result<[[f64; 2]; 3]> {
        let repeats = self.settings.bootstrap;
        let mut values = [0, 1, 2].map(|_| Vec::with_capacity(repeats));
        let mut generator = ChaCha8Rng::seed_from_u64(self.settings.seed);
        for repeat in 0..repeats {
            generator.set_stream(repeat as u64);
            let refit = self
                .resampled(&found.parameters, &mut generator)
                .minimize(found.parameters.clone())?;
            for (values, value) in values.iter_mut().zip(&refit.parameters) {
                values.push(*value);
            }
        }
        let outside = 0.5 * (1.0 - self.settings.confidence);
        Ok(values.map(|mut values| {
            values.sort_by(f64::total_cmp);
            [outside, 1.0 - outside].map(|share| percentile(&values, share))
        }))
    }

    fn resampled(&self, parameters: &[f64], generator: &mut ChaCha8Rng) -> Self {
        let mut index = |count: usize| {
            let wide = u128::from(generator.next_u64()) * count as u128;
            usize::try_from(wide >> 64).unwrap_or(0)
        };
        let mut result = self.clone();
        let left: Vec<f64> = self.forces_left(parameters).collect();
        let grown = (left.len() as f64 / (left.len() - 1) as f64).sqrt();
        for (force, compression) in result.force.iter_mut().zip(self.compression) {
            *force = parameters[0] * compression + grown * left[index(left.len())];
        }
        let (measured, fitted) = (self.positions() as f64, (2 + self.position.len()) as f64);
        let grown = (measured / (measured - fitted).max(1.0)).sqrt();
        for (drop, position) in result.position.iter_mut().enumerate() {
            let left = self.positions_left(parameters, drop);
            let path = trajectory(self.time[drop], &self.model(parameters, drop));
            for (run, positions) in position.chunks_mut(RUN).enumerate() {
                let from = index(left.len());
                for (k, position) in positions.iter_mut().enumerate() {
                    *position = path[RUN * run + k] + grown * left[(from + k) % left.len()];
                }
            }
        }
        result
    }
}

/// Value below which a share of the sorted values lies, linear between them.
fn percentile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let below = place.floor() as usize;
    let above = sorted[(below + 1).min(sorted.len() - 1)];
    sorted[below] + (place - below as f64) * (above - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::drop_trajectory;

    const TRUTH: [f64; 3] = [24_250.0, 0.112, 2.0];

    struct Bench {
        force: Vec<f64>,
        compression: Vec<f64>,
        time: Vec<f64>,
        position: Vec<f64>,
    }

    fn uniform(generator: &mut ChaCha8Rng) -> f64 {
        (generator.next_u64() as f64 + 0.5) / 2.0_f64.powi(64)
    }

    fn normal(generator: &mut ChaCha8Rng) -> f64 {
        let radius = (-2.0 * uniform(generator).ln()).sqrt();
        radius * (2.0 * std::f64::consts::PI * uniform(generator)).cos()
    }

    fn round(value: f64) -> f64 {
        (value / 1e-4).round() * 1e-4
    }

    /// The rig of the source: 12 static forces with 1 N noise, one drop from 30 to 60 mm at 1 kHz,
    /// positions with 0.1 mm resolution.
    fn measured(seed: u64, contact: DropContact) -> Bench {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let model = DropModel {
            mass: 1.54,
            stiffness: TRUTH[0],
            damping_ratio: TRUTH[1],
            friction: TRUTH[2],
            height: 0.03 + 0.03 * uniform(&mut generator),
            gravity: GRAVITY,
            contact,
        };
        let time: Vec<f64> = (0..500).map(|k| f64::from(k) * 1e-3).collect();
        let path = drop_trajectory(&time, &model).unwrap();
        let mut force = Vec::new();
        let mut compression = Vec::new();
        for k in 1..=12 {
            let depth = 0.4e-3 * f64::from(k) + 1e-4 * uniform(&mut generator);
            force.push(TRUTH[0] * depth + normal(&mut generator));
            compression.push(round(depth));
        }
        Bench {
            force,
            compression,
            time,
            position: path.into_iter().map(round).collect(),
        }
    }

    fn fit(bench: &Bench, settings: &FoamFitSettings) -> FoamFit {
        let drop = Drop {
            time: &bench.time,
            position: &bench.position,
        };
        identify_foam(&bench.force, &bench.compression, &[drop], settings).unwrap()
    }

    #[test]
    fn exact_measurements_give_the_truth() {
        let mut bench = measured(3, DropContact::Unilateral);
        let model = DropModel {
            mass: 1.54,
            stiffness: TRUTH[0],
            damping_ratio: TRUTH[1],
            friction: TRUTH[2],
            height: 0.05,
            gravity: GRAVITY,
            contact: DropContact::Unilateral,
        };
        bench.position = drop_trajectory(&bench.time, &model).unwrap();
        bench.force = bench
            .compression
            .iter()
            .map(|depth| TRUTH[0] * depth)
            .collect();
        let found = fit(&bench, &FoamFitSettings::new(1.54));
        for (found, truth) in [found.stiffness, found.damping_ratio, found.friction]
            .iter()
            .zip(TRUTH)
        {
            assert!((found / truth - 1.0).abs() < 1e-7, "{found} {truth}");
        }
        assert!((found.drop_heights[0] - 0.05).abs() < 1e-10);
        assert!(
            (found.damping(4.4).unwrap() / (0.224 * (4.4 * TRUTH[0]).sqrt()) - 1.0).abs() < 1e-7
        );
    }

    #[test]
    fn intervals_cover_the_truth_in_90_to_99_percent() {
        for contact in [DropContact::Unilateral, DropContact::Attached] {
            let mut covered = [0; 3];
            let mut off = [0.0_f64; 3];
            let settings = FoamFitSettings {
                contact,
                ..FoamFitSettings::new(1.54)
            };
            for seed in 0..200 {
                let found = fit(&measured(seed, contact), &settings);
                let values = [found.stiffness, found.damping_ratio, found.friction];
                for k in 0..3 {
                    covered[k] += u32::from(
                        found.interval[k][0] <= TRUTH[k] && TRUTH[k] <= found.interval[k][1],
                    );
                    off[k] += (values[k] / TRUTH[k] - 1.0) / 200.0;
                }
            }
            for (covered, off) in covered.iter().zip(off) {
                assert!((180..=198).contains(covered), "{contact:?} {covered}");
                assert!(off.abs() < 3e-3, "{contact:?} {off}");
            }
        }
    }
}
