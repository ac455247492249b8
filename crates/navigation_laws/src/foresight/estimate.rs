//! Positions and velocities of people, estimated from measurements with an error.

use crate::foresight::Scene;
use numeric::lanes::Vector2;

/// A residual beyond so many standard deviations is a maneuver.
const GATE: f64 = 9.0;

/// Variance of the acceleration in a maneuver, as a multiple of the usual one: more by this.
const MANEUVER: f64 = 8.0;

/// Standard deviation in m/s of a velocity that nobody measured.
const UNKNOWN: f64 = 1.0;

/// Times that differ from a period by less than this share of it are a period.
const ROUNDING: f64 = 1e-6;

/// Somebody as measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Number of the person among all.
    pub who: usize,
    /// Position in m.
    pub position: Vector2<f64>,
    /// Velocity in m/s; NaN where nobody measured it.
    pub velocity: Vector2<f64>,
    /// When it was measured, in s.
    pub instant: f64,
    /// Age of the measurement when the command takes effect, in s.
    pub age: f64,
    /// Distance of the centers at contact, in m.
    pub touch: f64,
}

/// Motion of a person with one covariance for both axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    pub position: Vector2<f64>,
    pub velocity: Vector2<f64>,
    /// When the person was measured last, in s.
    instant: f64,
    /// Variance of the position, covariance, and variance of the velocity.
    variance: [f64; 3],
}

impl Estimate {
    fn new(seen: &Sighting, square: f64, period: f64) -> Self {
        let known = !seen.velocity.x.is_nan();
        let velocity = if known {
            seen.velocity
        } else {
            Vector2::zeros()
        };
        let spread = if known {
            2.0 * square / (period * period)
        } else {
            UNKNOWN * UNKNOWN
        };
        Self {
            position: seen.position,
            velocity,
            instant: seen.instant,
            variance: [square, 0.0, spread],
        }
    }

    /// Standard deviation of the velocity in m/s.
    pub fn deviation(&self) -> f64 {
        self.variance[2].max(0.0).sqrt()
    }

    fn blur(&mut self, time: f64, square: f64) {
        let [position, both, velocity] = &mut self.variance;
        *position += square * time.powi(4) / 4.0;
        *both += square * time.powi(3) / 2.0;
        *velocity += square * time * time;
    }

    /// After a time without a measurement.
    fn predict(&mut self, time: f64, acceleration: f64) {
        self.position += self.velocity * time;
        let [position, both, velocity] = self.variance;
        self.variance = [
            position + 2.0 * time * both + time * time * velocity,
            both + time * velocity,
            velocity,
        ];
        self.blur(time, acceleration * acceleration);
    }

    /// Takes in a measurement with a variance in m^2.
    fn correct(&mut self, measured: Vector2<f64>, square: f64, time: f64, acceleration: f64) {
        let residual = measured - self.position;
        if residual.norm_squared() > GATE * (self.variance[0] + square) {
            self.blur(time, MANEUVER * acceleration * acceleration);
        }
        let [position, both, velocity] = self.variance;
        let all = position + square;
        let gain = [position / all, both / all];
        self.position += residual * gain[0];
        self.velocity += residual * gain[1];
        let rest = 1.0 - gain[0];
        self.variance = [position * rest, both * rest, velocity - gain[1] * both];
    }
}

/// Estimates of all people, by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Estimates(Vec<Option<Estimate>>);

impl Estimates {
    /// Takes in what was measured; who is absent loses the estimate.
    pub fn observe(&mut self, scene: &Scene<'_>, acceleration: f64, period: f64) {
        let most = scene.people.iter().map(|each| each.who + 1).max();
        self.0.resize(self.0.len().max(most.unwrap_or(0)), None);
        let mut seen = scene.people.iter().peekable();
        let square = scene.position_error * scene.position_error / 6.0;
        for (who, kept) in self.0.iter_mut().enumerate() {
            let Some(person) = seen.next_if(|each| each.who == who) else {
                *kept = None;
                continue;
            };
            // What is measured exactly needs no estimate.
            let exact = square == 0.0 && !person.velocity.x.is_nan();
            match kept {
                Some(estimate) if !exact && person.instant >= estimate.instant => {
                    let elapsed = person.instant - estimate.instant;
                    let whole = (elapsed - period).abs() <= ROUNDING * period;
                    let elapsed = if whole { period } else { elapsed };
                    // Who was lost is where the last measurement lets him be.
                    if elapsed > 0.0 {
                        estimate.instant = person.instant;
                        estimate.predict(elapsed, acceleration);
                        estimate.correct(person.position, square, elapsed, acceleration);
                    }
                }
                _ => *kept = Some(Estimate::new(person, square, period)),
            }
        }
    }

    /// Estimate of somebody.
    pub fn of(&self, person: &Sighting) -> Option<Estimate> {
        self.0.get(person.who).copied().flatten()
    }
}
