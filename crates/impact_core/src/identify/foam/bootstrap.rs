//! Intervals from refits to resampled residuals.

use numeric::random::Stream;

use super::super::least_squares::Minimum;
use super::measured::Tests;
use crate::error::{Failure, Result};
use crate::quantile::quantiles;
use numeric::parallel::Work;

/// Residuals that the bootstrap keeps together: rounding repeats itself while the slide is slow.
const RUN: usize = 8;

impl Tests<'_> {
    /// Percentile intervals of refits to the fitted curves with resampled residuals.
    pub(super) fn bootstrap(&self, found: &Minimum, work: Work<'_>) -> Result<[[f64; 2]; 3]> {
        let repeats = self.settings.bootstrap;
        let mut values = [0, 1, 2].map(|_| Vec::with_capacity(repeats));
        let mut stream = Stream::new(self.settings.seed, 0);
        for repeat in 0..repeats {
            if (work.interrupted)() {
                return Err(Failure::Interrupted);
            }
            stream.set_stream(repeat as u64);
            let refit = self
                .resampled(&found.parameters, &mut stream)
                .minimize(found.parameters.clone())?;
            for (values, value) in values.iter_mut().zip(&refit.parameters) {
                values.push(*value);
            }
            (work.progress)(1);
        }
        let outside = 0.5 * (1.0 - self.settings.confidence);
        let mut intervals = [[0.0; 2]; 3];
        for (interval, values) in intervals.iter_mut().zip(&values) {
            *interval = quantiles(values, [outside, 1.0 - outside], work.interrupted)?;
        }
        Ok(intervals)
    }

    fn resampled(&self, parameters: &[f64], stream: &mut Stream) -> Self {
        let mut index = |count: usize| stream.below(count);
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
            let path = self.path(parameters, drop);
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
