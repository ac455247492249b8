//! A camera that measures the position of a body now and then, late, with errors and lost frames.

use std::collections::VecDeque;

use crate::sensing::camera::Camera;
use crate::sensing::estimator::{Estimate, Estimator, Track};
use crate::sensing::measurement::{Distribution, Measurement, Noise, Noisy};
use numeric::error::{Failure, Given, Result, finite, not_negative, positive};

/// A frame is due when it is this share of a period away: times of control steps are rounded.
const ROUNDING: f64 = 1e-9;

/// Streams of the lost frames are those of the errors with this bit set.
const LOST: u64 = 1 << 63;

/// Error of one measured position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // one for each kind of body, never in an array
pub enum PositionError {
    /// Added to x and y.
    Plane {
        /// Kind of error.
        distribution: Distribution,
        /// Half width or standard deviation in m.
        scale: f64,
    },
    /// The centroid of a color patch at a known height, seen by a camera and reconstructed with
    /// what is believed about it.
    Patch {
        /// The camera as it is.
        camera: Camera,
        /// The camera as it was calibrated.
        believed: Camera,
        /// Height of the patch in m.
        height: f64,
        /// Standard deviation of each coordinate of the centroid in pixels.
        deviation: f64,
    },
}

impl PositionError {
    /// Checks that the values make sense.
    ///
    /// # Errors
    /// Names the value that does not.
    pub fn check(&self) -> Result<()> {
        match self {
            Self::Plane { scale, .. } => not_negative("scale", *scale)?,
            Self::Patch {
                height, deviation, ..
            } => {
                finite("height", *height)?;
                not_negative("centroid_deviation_px", *deviation)?
            }
        };
        Ok(())
    }

    /// Error source in its own unit.
    fn noise(&self, seed: u64, stream: u64) -> Result<Noise> {
        let (distribution, scale) = match self {
            Self::Plane {
                distribution,
                scale,
            } => (*distribution, *scale),
            Self::Patch { deviation, .. } => (Distribution::Gaussian, *deviation),
        };
        let measurement = Measurement::new(scale, distribution, Noisy::Both)?;
        Ok(Noise::new(measurement, seed, stream))
    }

    /// Position that is measured; none if the patch is not in the picture.
    fn measured(&self, position: [f64; 2], [a, b]: [f64; 2]) -> Option<[f64; 2]> {
        let [x, y] = position;
        match self {
            Self::Plane { .. } => Some([x + a, y + b]),
            Self::Patch {
                camera,
                believed,
                height,
                ..
            } => {
                let seen = camera.project([x, y, *height])?;
                let centroid = [seen[0] + a, seen[1] + b];
                if !camera.contains(centroid) {
                    return None;
                }
                let [x, y, _] = believed.reconstruct(centroid, *height)?;
                Some([x, y])
            }
        }
    }
}

/// How the position of one body is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vision {
    /// Time between two exposures in s.
    pub period: f64,
    /// Time from an exposure until its position is known, in s.
    pub delay: f64,
    /// Error of a measured position.
    pub error: PositionError,
    /// Probability that a frame gives no position.
    pub drop_probability: f64,
    /// How position and velocity follow.
    pub estimator: Estimator,
    /// Whether the position is moved on to the present with the velocity.
    pub compensated: bool,
}

/// Most frames of one body in a run.
const MOST_FRAMES: f64 = 1e7;

impl Vision {
    /// Checks that a time in s holds frames that can be taken one by one.
    ///
    /// # Errors
    /// There are too many.
    pub fn check_frames(&self, duration: f64) -> Result<()> {
        if duration / self.period <= MOST_FRAMES {
            return Ok(());
        }
        let rule = format!("be so long that {duration} s hold at most {MOST_FRAMES:e} frames");
        let least = duration / MOST_FRAMES;
        let error = Failure::invalid("period", rule, Given::Number(self.period));
        Err(error.mended_by(format!("take at least {least:?} s")))
    }

    /// Returns the vision if its values make sense.
    ///
    /// # Errors
    /// Names the value that does not.
    pub fn checked(self) -> Result<Self> {
        positive("period", self.period)?;
        not_negative("delay", self.delay)?;
        self.error.check()?;
        if !(self.drop_probability >= 0.0 && self.drop_probability < 1.0) {
            return Err(Failure::invalid(
                "drop_probability",
                "be at least 0 and below 1",
                Given::Number(self.drop_probability),
            ));
        }
        self.estimator.checked()?;
        Ok(self)
    }
}

/// Measurement of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Time of the exposure in s.
    pub exposed: f64,
    /// Measured position in m; none for a lost frame.
    pub measured: Option<[f64; 2]>,
}

/// Estimate that is known from a time on.
#[derive(Clone, Copy, Debug)]
struct Knowledge {
    from: f64,
    estimate: Option<Estimate>,
}

/// Vision of one body during a run. Errors and lost frames come from streams of their own: a body
/// has the same errors whatever else is measured and whichever frames are lost.
#[derive(Clone, Debug)]
pub struct VisionSensor {
    vision: Vision,
    errors: Noise,
    losses: Noise,
    track: Track,
    next_frame: u64,
    last: Option<(f64, [f64; 2])>,
    known: VecDeque<Knowledge>,
    frames: Vec<Exposure>,
}

impl VisionSensor {
    /// Sensor of one body; frames are exposed at whole multiples of the period.
    ///
    /// # Errors
    /// The vision has a value that makes no sense.
    pub fn new(vision: &Vision, seed: u64, stream: u64) -> Result<Self> {
        let vision = vision.checked()?;
        let whole = Measurement::new(1.0, Distribution::Uniform, Noisy::Both)?;
        Ok(Self {
            errors: vision.error.noise(seed, stream)?,
            losses: Noise::new(whole, seed, stream | LOST),
            track: Track::new(vision.estimator),
            next_frame: 0,
            last: None,
            known: VecDeque::new(),
            frames: Vec::new(),
            vision,
        })
    }

    /// When the next frame is exposed, in s.
    #[must_use]
    pub fn due(&self) -> f64 {
        self.next_frame as f64 * self.vision.period
    }

    /// The frames that the last call of [`Self::sample`] or [`Self::absent`] exposed.
    #[must_use]
    pub fn frames(&self) -> &[Exposure] {
        &self.frames
    }

    /// Tells where the body is at a time in s, in m; times must not fall. All frames that are due
    /// up to then are exposed, with positions on the line from the place told before. The first
    /// call starts the camera.
    pub fn sample(&mut self, time: f64, position: [f64; 2]) {
        self.start(time);
        let slack = ROUNDING * self.vision.period;
        while self.due() <= time + slack {
            let due = self.due();
            let place = match self.last {
                Some((before, from)) if time > before => {
                    let share = ((due - before) / (time - before)).clamp(0.0, 1.0);
                    [0, 1].map(|i| from[i] + share * (position[i] - from[i]))
                }
                _ => position,
            };
            self.expose(due, place);
        }
        self.last = Some((time, position));
        self.forget_before(time);
    }

    /// Tells that the body is absent at a time in s: due frames show nothing, and its track ends.
    pub fn absent(&mut self, time: f64) {
        self.start(time);
        let slack = ROUNDING * self.vision.period;
        while self.due() <= time + slack {
            let due = self.due();
            self.pass_over();
            self.track = Track::new(self.vision.estimator);
            self.learn(due, None);
        }
        self.last = None;
        self.forget_before(time);
    }

    /// Estimate at a time in s, from frames whose delay has passed; none before the first.
    #[must_use]
    pub fn estimate(&self, time: f64) -> Option<Estimate> {
        let slack = ROUNDING * self.vision.period;
        let available = |knowledge: &&Knowledge| knowledge.from <= time + slack;
        let mut estimate = self.known.iter().rev().find(available)?.estimate?;
        if self.vision.compensated {
            let age = time - estimate.measured_at;
            for (position, velocity) in estimate.position.iter_mut().zip(estimate.velocity) {
                *position += age * velocity;
            }
        }
        Some(estimate)
    }

    /// Frames before the first call are not exposed.
    fn start(&mut self, time: f64) {
        self.frames.clear();
        if self.last.is_none() && self.known.is_empty() {
            let period = self.vision.period;
            while self.due() < time - ROUNDING * period {
                self.pass_over();
                self.next_frame += 1;
            }
        }
    }

    /// Makes the draws of a frame that measures nothing. Every frame takes the same numbers from the
    /// streams, whether the body is seen or not, so those of a later frame do not depend on it.
    fn pass_over(&mut self) {
        self.errors.draw();
        self.losses.unit();
    }

    fn expose(&mut self, due: f64, position: [f64; 2]) {
        let error = self.errors.draw();
        let lost = self.losses.unit() < self.vision.drop_probability;
        let seen = self.vision.error.measured(position, error);
        let measured = if lost { None } else { seen };
        if let Some(position) = measured {
            self.track.measure(due, position);
        }
        self.learn(due, measured);
    }

    fn learn(&mut self, due: f64, measured: Option<[f64; 2]>) {
        self.next_frame += 1;
        self.frames.push(Exposure {
            exposed: due,
            measured,
        });
        self.known.push_back(Knowledge {
            from: due + self.vision.delay,
            estimate: self.track.estimate(),
        });
    }

    /// How long ago the body was where it is known to be at a time, at least, in s: a position that is
    /// moved on with the velocity may be off by as much again.
    #[must_use]
    pub fn age(&self, time: f64) -> f64 {
        let age = |found: Estimate| (time - found.measured_at).max(0.0);
        let moved = if self.vision.compensated { 2.0 } else { 1.0 };
        moved * self.estimate(time).map_or(0.0, age)
    }

    /// Drops what newer knowledge has replaced at a time.
    fn forget_before(&mut self, time: f64) {
        while self.known.get(1).is_some_and(|next| next.from <= time) {
            self.known.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_is_as_old_as_its_frame() {
        let exact = Vision {
            period: 0.1,
            delay: 0.25,
            error: PositionError::Plane {
                distribution: Distribution::Uniform,
                scale: 0.0,
            },
            drop_probability: 0.0,
            estimator: Estimator::Differences,
            compensated: false,
        };
        for (compensated, share) in [(false, 1.0), (true, 2.0)] {
            let vision = Vision {
                compensated,
                ..exact
            };
            let mut sensor = VisionSensor::new(&vision, 1, 1).unwrap();
            sensor.sample(0.0, [0.0, 0.0]);
            assert_eq!(sensor.age(0.0), 0.0);
            sensor.sample(1.0, [1.0, 0.0]);
            // The frame of 0.7 s is known from 0.95 s on.
            assert!((sensor.age(1.0) - share * 0.3).abs() < 1e-9);
            // No further frame: it stays where it was seen last, ever longer ago.
            assert!((sensor.age(3.0) - share * 2.0).abs() < 1e-9);
        }
    }
}
