//! Position and velocity of a body from its measured positions.

use std::ops::RangeInclusive;

use numeric::error::{Failure, Given, Result, positive};

/// Standard deviations whose squares and ratios stay inside the range of numbers.
const DEVIATIONS: RangeInclusive<f64> = 1e-100..=1e100;

/// How position and velocity follow from measured positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Estimator {
    /// The last position; velocity by the backward difference of the last two.
    Differences,
    /// Constant gains: `x += alpha r`, `v += beta r / dt` with the residual r of the prediction.
    AlphaBeta {
        /// Share alpha of the residual that moves the position.
        position_gain: f64,
        /// Share beta of the residual that changes the velocity.
        velocity_gain: f64,
    },
    /// Kalman filter of a body with a random acceleration, constant from one measurement to the
    /// next; x and y alike.
    Kalman {
        /// Standard deviation of the acceleration in m/s^2.
        acceleration_deviation: f64,
        /// Standard deviation of a measured coordinate in m.
        position_deviation: f64,
        /// Standard deviation of the velocity before the first measurement, in m/s.
        speed_deviation: f64,
    },
}

impl Estimator {
    /// Returns the estimator if its numbers make sense: gains inside the stable range
    /// `0 < alpha <= 1`, `0 < beta < 4 - 2 alpha`, positive deviations.
    ///
    /// # Errors
    /// Names the value that does not.
    pub fn checked(self) -> Result<Self> {
        match self {
            Self::Differences => {}
            Self::AlphaBeta {
                position_gain,
                velocity_gain,
            } => {
                let refuse = |name, requirement, value| {
                    Err(Failure::invalid(name, requirement, Given::Number(value)))
                };
                if !(position_gain > 0.0 && position_gain <= 1.0) {
                    return refuse("position_gain", "be above 0 and at most 1", position_gain);
                }
                if !(velocity_gain > 0.0 && velocity_gain < 4.0 - 2.0 * position_gain) {
                    let requirement = "be above 0 and below 4 - 2 position_gain";
                    return refuse("velocity_gain", requirement, velocity_gain);
                }
            }
            Self::Kalman {
                acceleration_deviation,
                position_deviation,
                speed_deviation,
            } => {
                with_square("acceleration_deviation", acceleration_deviation)?;
                with_square("position_deviation", position_deviation)?;
                with_square("speed_deviation", speed_deviation)?;
            }
        }
        Ok(self)
    }

    /// Steady gains alpha and beta of the Kalman filter for a constant period, Kalata (1984):
    /// with `L = sigma_a T^2 / sigma_z`,
    /// `alpha = -(L^2 + 8 L - (L + 4) sqrt(L^2 + 8 L)) / 8`, `beta = (L^2 + 4 L - L sqrt(L^2 + 8 L)) / 4`.
    ///
    /// # Errors
    /// A value is not finite and positive.
    pub fn steady_gains(
        acceleration_deviation: f64,
        position_deviation: f64,
        period: f64,
    ) -> Result<[f64; 2]> {
        positive("acceleration_deviation", acceleration_deviation)?;
        positive("position_deviation", position_deviation)?;
        positive("period", period)?;
        let index = acceleration_deviation * period * period / position_deviation;
        // Both without the cancellation of the printed forms for small and large indices.
        let root = (index * (index + 8.0)).sqrt();
        let decay = 4.0 / (4.0 + index + root); // sqrt(1 - alpha)
        Ok([(1.0 - decay) * (1.0 + decay), index * decay])
    }
}

/// Returns a positive number if its square can be divided by.
fn with_square(name: &str, value: f64) -> Result<f64> {
    positive(name, value)?;
    if DEVIATIONS.contains(&value) {
        Ok(value)
    } else {
        let requirement = "be between 1e-100 and 1e100";
        Err(Failure::invalid(name, requirement, Given::Number(value)))
    }
}

/// Estimate at the time of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Position in m.
    pub position: [f64; 2],
    /// Velocity in m/s; zero while there is one measurement only.
    pub velocity: [f64; 2],
    /// When the last measurement in it was taken, in s.
    pub measured_at: f64,
}

/// An estimator at work on one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    estimator: Estimator,
    last: Option<Estimate>,
    last_position: [f64; 2],
    count: usize,
    /// Covariance of position, of position with velocity, and of velocity, of the Kalman filter.
    covariance: [f64; 3],
}

impl Track {
    /// A track without measurements.
    #[must_use]
    pub fn new(estimator: Estimator) -> Self {
        Self {
            estimator,
            last: None,
            last_position: [0.0; 2],
            count: 0,
            covariance: [0.0; 3],
        }
    }

    /// Last estimate; none before the first measurement.
    #[must_use]
    pub fn estimate(&self) -> Option<Estimate> {
        self.last
    }

    /// Covariance of one coordinate: position (m^2), with velocity (m^2/s), velocity (m^2/s^2); zero
    /// for estimators without one.
    #[must_use]
    pub fn covariance(&self) -> [f64; 3] {
        self.covariance
    }

    /// Takes a position that was measured at a later time than the last one, in s and m.
    pub fn measure(&mut self, time: f64, position: [f64; 2]) -> Estimate {
        let estimate = match self.last {
            None => self.first(time, position),
            Some(last) => self.next(last, time, position),
        };
        self.count += 1;
        self.last_position = position;
        self.last = Some(estimate);
        estimate
    }

    fn first(&mut self, time: f64, position: [f64; 2]) -> Estimate {
        if let Estimator::Kalman {
            position_deviation,
            speed_deviation,
            ..
        } = self.estimator
        {
            self.covariance = [position_deviation.powi(2), 0.0, speed_deviation.powi(2)];
        }
        Estimate {
            position,
            velocity: [0.0; 2],
            measured_at: time,
        }
    }

    fn next(&mut self, last: Estimate, time: f64, position: [f64; 2]) -> Estimate {
        let interval = time - last.measured_at;
        let (alpha, beta_rate) = match self.estimator {
            Estimator::Differences => (1.0, 1.0 / interval),
            // The second measurement starts the track: there is no velocity to predict with yet.
            Estimator::AlphaBeta { .. } if self.count == 1 => (1.0, 1.0 / interval),
            Estimator::AlphaBeta {
                position_gain,
                velocity_gain,
            } => (position_gain, velocity_gain / interval),
            Estimator::Kalman {
                acceleration_deviation,
                position_deviation,
                ..
            } => self.kalman_gains(interval, acceleration_deviation, position_deviation),
        };
        if self.estimator == Estimator::Differences {
            let velocity = [0, 1].map(|i| (position[i] - self.last_position[i]) * beta_rate);
            return Estimate {
                position,
                velocity,
                measured_at: time,
            };
        }
        let predicted = [0, 1].map(|i| last.position[i] + last.velocity[i] * interval);
        let residual = [0, 1].map(|i| position[i] - predicted[i]);
        Estimate {
            position: [0, 1].map(|i| predicted[i] + alpha * residual[i]),
            velocity: [0, 1].map(|i| last.velocity[i] + beta_rate * residual[i]),
            measured_at: time,
        }
    }

    /// Predicts and corrects the covariance; returns both gains, the second in 1/s.
    fn kalman_gains(&mut self, interval: f64, acceleration: f64, position: f64) -> (f64, f64) {
        let [p, c, v] = self.covariance;
        let speed_change = acceleration * interval;
        let shift = 0.5 * speed_change * interval;
        let p = p + interval * (2.0 * c + interval * v) + shift * shift;
        let c = c + interval * v + shift * speed_change;
        let v = v + speed_change * speed_change;
        let noise = position * position;
        let innovation = p + noise;
        let gains = (p / innovation, c / innovation);
        // Corrected without subtraction in the position: p - p^2 / (p + r) = p r / (p + r).
        let left = noise / innovation;
        self.covariance = [p * left, c * left, v - c * gains.1];
        gains
    }
}
