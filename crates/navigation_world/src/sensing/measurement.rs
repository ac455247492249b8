//! Error and age of measured positions.

use numeric::random::Stream;

use numeric::error::{Failure, Given, Result, not_negative};

/// A Gaussian error is drawn again beyond this many standard deviations.
const GAUSSIAN_BOUND: f64 = 8.0;

/// Longest latency in s: it bounds the memory of past positions.
const MAX_LATENCY: f64 = 60.0;

/// Kind of measurement error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Uniform in x and y each.
    Uniform,
    /// Normal in x and y each.
    Gaussian,
}

/// Positions that are measured with an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noisy {
    /// Positions of moving obstacles.
    Obstacles,
    /// Position of the robot.
    Robot,
    /// Both.
    Both,
}

/// Error and age of the measured positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Half width or standard deviation in m.
    scale: f64,
    distribution: Distribution,
    noisy: Noisy,
    /// Age of the positions in s.
    latency: f64,
}

impl Measurement {
    /// A measurement error.
    ///
    /// # Errors
    /// The scale is negative or not finite.
    pub fn new(scale: f64, distribution: Distribution, noisy: Noisy) -> Result<Self> {
        Ok(Self {
            scale: not_negative("scale", scale)?,
            distribution,
            noisy,
            latency: 0.0,
        })
    }

    /// Measurement of the positions of some time ago.
    ///
    /// # Errors
    /// The latency is negative, not finite or above a minute.
    pub fn late(self, latency: f64) -> Result<Self> {
        if not_negative("latency", latency)? > MAX_LATENCY {
            let rule = format!("be at most {MAX_LATENCY} s");
            return Err(Failure::invalid("latency", rule, Given::Number(latency))
                .mended_by("give seconds, as 0.1 for 100 ms"));
        }
        Ok(Self { latency, ..self })
    }

    /// Whether the robot is measured.
    #[must_use]
    pub fn of_robot(&self) -> bool {
        self.noisy != Noisy::Obstacles
    }

    /// Whether an obstacle is measured: one at rest is known exactly.
    #[must_use]
    pub fn of_obstacle(&self, stationary: bool) -> bool {
        self.noisy != Noisy::Robot && !stationary
    }

    /// Age of the measured positions in s.
    #[must_use]
    pub fn latency(&self) -> f64 {
        self.latency
    }

    /// Largest distance of a measured position from the one that is measured, in m.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        match self.distribution {
            Distribution::Uniform => std::f64::consts::SQRT_2 * self.scale,
            Distribution::Gaussian => GAUSSIAN_BOUND * self.scale,
        }
    }
}

/// Errors of one measured body, a stream of its own.
#[derive(Clone, Debug)]
pub struct Noise {
    stream: Stream,
    measurement: Measurement,
}

impl Noise {
    /// Errors of a measurement, from a stream of a seed.
    #[must_use]
    pub fn new(measurement: Measurement, seed: u64, stream: u64) -> Self {
        Self {
            stream: Stream::new(seed, stream),
            measurement,
        }
    }

    /// Uniform in [0, 1) with 53 bits.
    pub(crate) fn unit(&mut self) -> f64 {
        self.stream.unit()
    }

    /// Error of one position in m.
    pub fn draw(&mut self) -> [f64; 2] {
        let scale = self.measurement.scale;
        match self.measurement.distribution {
            Distribution::Uniform => {
                let x = self.unit();
                let y = self.unit();
                [(2.0 * x - 1.0) * scale, (2.0 * y - 1.0) * scale]
            }
            Distribution::Gaussian => loop {
                let (radius, direction) = self.stream.normal_vector();
                if radius <= GAUSSIAN_BOUND {
                    return direction.map(|part| scale * radius * part);
                }
            },
        }
    }
}
