//! Random numbers: one seed, one stream a purpose, the same numbers everywhere.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// Stream of a seed; streams of one seed do not overlap.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self(generator)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Goes to the start of another stream of the seed.
    pub fn set_stream(&mut self, stream: u64) {
        self.0.set_stream(stream);
    }

    /// Uniform among `0..count`, 0 of none.
    pub fn below(&mut self, count: usize) -> usize {
        let wide = u128::from(self.bits()) * count as u128;
        usize::try_from(wide >> 64).unwrap_or(0)
    }

    /// Uniform in [0, 1) with 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Radius and direction (cos, sin) of two independent standard normal numbers, Box and
    /// Muller (1958).
    pub fn normal_vector(&mut self) -> (f64, [f64; 2]) {
        // 1 - unit() is never 0.
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * self.unit()).sin_cos();
        (radius, [cos, sin])
    }

    /// Two independent standard normal numbers.
    pub fn normals(&mut self) -> [f64; 2] {
        let (radius, direction) = self.normal_vector();
        direction.map(|part| radius * part)
    }
}
