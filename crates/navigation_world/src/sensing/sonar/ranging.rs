//! From a distance to a reading: temperature, limits, noise.

use numeric::error::{Failure, Given, Result, finite, not_negative, positive};
use numeric::random::Stream;

/// Temperature at which sound has 340 m/s by [`speed_of_sound`], in degrees Celsius.
pub const DEFAULT_TEMPERATURE: f64 = 8.5 / 0.6;

/// Speed of sound in air at a temperature in degrees Celsius, in m/s: (23) of Avi (2019).
#[must_use]
pub fn speed_of_sound(temperature: f64) -> f64 {
    331.5 + 0.6 * temperature
}

/// How a distance becomes a reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranging {
    /// Smallest reading, in m; nearer echoes are lost.
    pub least: f64,
    /// Largest reading, in m; farther echoes are lost.
    pub most: f64,
    /// Standard deviation of the noise, in m.
    pub noise: f64,
    /// Temperature of the air, in degrees Celsius.
    pub temperature: f64,
    /// Temperature that the sensor takes for granted, in degrees Celsius.
    pub assumed_temperature: f64,
}

impl Default for Ranging {
    fn default() -> Self {
        Self {
            least: 0.03,
            most: 3.0,
            noise: 0.005,
            temperature: DEFAULT_TEMPERATURE,
            assumed_temperature: DEFAULT_TEMPERATURE,
        }
    }
}

impl Ranging {
    /// Returns the limits if they are valid.
    ///
    /// # Errors
    /// A number is not finite or out of range.
    pub fn checked(self) -> Result<Self> {
        not_negative("least_range", self.least)?;
        positive("most_range", self.most)?;
        if self.most <= self.least {
            let rule = "be above least_range";
            return Err(Failure::invalid(
                "most_range",
                rule,
                Given::Number(self.most),
            ));
        }
        not_negative("range_noise", self.noise)?;
        for (name, value) in [
            ("temperature", self.temperature),
            ("assumed_temperature", self.assumed_temperature),
        ] {
            finite(name, value)?;
            if speed_of_sound(value) <= 0.0 {
                let rule = "be above -552.5 degrees";
                return Err(Failure::invalid(name, rule, Given::Number(value)));
            }
        }
        Ok(self)
    }

    /// Reading a distance: the flight time is taken at another speed of sound than it was flown.
    #[inline]
    #[must_use]
    pub fn scale(&self) -> f64 {
        speed_of_sound(self.assumed_temperature) / speed_of_sound(self.temperature)
    }

    /// Farthest distance that gives a reading, in m.
    #[inline]
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.most / self.scale()
    }

    /// Reading of a distance without noise, in m; infinite without echo.
    #[inline]
    #[must_use]
    pub fn reading(&self, distance: f64) -> f64 {
        self.scaled(distance * self.scale())
    }

    /// A distance as the sensor takes it, in m, if that is within the limits; infinite without echo.
    #[inline]
    pub(super) fn scaled(&self, reading: f64) -> f64 {
        if (self.least..=self.most).contains(&reading) {
            reading
        } else {
            f64::INFINITY
        }
    }
}

/// Standard normal numbers one by one.
#[derive(Clone, Debug)]
pub struct Normals {
    stream: Stream,
    spare: Option<f64>,
}

impl Normals {
    /// Numbers from a stream.
    #[must_use]
    pub fn new(stream: Stream) -> Self {
        Self {
            stream,
            spare: None,
        }
    }

    /// The next number.
    #[inline]
    pub fn draw(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let [one, other] = self.stream.normals();
        self.spare = Some(other);
        one
    }
}
