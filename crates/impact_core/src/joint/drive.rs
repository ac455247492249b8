//! Motion of the manipulator's set-point during an impact.

use crate::error::{Failure, Given, Result, finite, not_negative, positive};

/// Constant acceleration of the set-point from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSegment {
    /// Start, in s.
    pub start: f64,
    /// Acceleration, in m/s^2.
    pub acceleration: f64,
}

/// Set-point of the manipulator: constant speed, then segments of constant acceleration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SetPoint {
    /// Segments in order of time.
    pub segments: Vec<DriveSegment>,
    /// Whether the controller feeds `M_r x_d''` forward.
    pub feed_forward: bool,
}

impl SetPoint {
    /// An acceleration from contact on for a duration, then constant speed (section 3.8).
    ///
    /// # Errors
    /// A number is out of range.
    pub fn accelerating(acceleration: f64, duration: f64, feed_forward: bool) -> Result<Self> {
        let set_point = Self {
            segments: vec![
                DriveSegment {
                    start: 0.0,
                    acceleration: finite("acceleration", acceleration)?,
                },
                DriveSegment {
                    start: positive("duration", duration)?,
                    acceleration: 0.0,
                },
            ],
            feed_forward,
        };
        Ok(set_point)
    }

    /// Constant speed until the impact is detected, then constant deceleration to rest.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn stopping(stop: &Stop, feed_forward: bool) -> Result<Self> {
        finite("manipulator_speed", stop.manipulator_speed)?;
        not_negative("detection", stop.detection)?;
        positive("rest", stop.rest)?;
        if stop.rest <= stop.detection {
            let given = Given::Number(stop.rest);
            return Err(Failure::invalid("rest", "come after the detection", given));
        }
        Ok(Self {
            segments: vec![
                DriveSegment {
                    start: stop.detection,
                    acceleration: -stop.manipulator_speed / (stop.rest - stop.detection),
                },
                DriveSegment {
                    start: stop.rest,
                    acceleration: 0.0,
                },
            ],
            feed_forward,
        })
    }

    /// Returns the set-point if its segments are in order.
    ///
    /// # Errors
    /// They are not, or a number is not finite.
    pub fn check(&self) -> Result<()> {
        let mut last = 0.0;
        for segment in &self.segments {
            finite("acceleration", segment.acceleration)?;
            not_negative("start", segment.start)?;
            if segment.start < last {
                let given = Given::Number(segment.start);
                return Err(Failure::invalid("start", "not decrease", given));
            }
            last = segment.start;
        }
        Ok(())
    }

    /// Acceleration at a time and when it changes next.
    #[must_use]
    pub fn at(&self, time: f64) -> (f64, f64) {
        let mut now = 0.0;
        for segment in &self.segments {
            if segment.start > time {
                return (now, segment.start);
            }
            now = segment.acceleration;
        }
        (now, f64::INFINITY)
    }

    /// Displacement of the set-point beyond that of constant speed and its rate.
    #[must_use]
    pub fn excess(&self, time: f64) -> [f64; 2] {
        let (mut position, mut speed, mut now) = (0.0, 0.0, 0.0);
        while now < time {
            let (acceleration, change) = self.at(now);
            let span = change.min(time) - now;
            position += span * (speed + 0.5 * acceleration * span);
            speed += acceleration * span;
            now = change.min(time);
        }
        [position, speed]
    }
}

/// A stop after the impact has been detected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Speed before, in m/s.
    pub manipulator_speed: f64,
    /// Time of detection of the impact, in s.
    pub detection: f64,
    /// Time from which the set-point rests, in s.
    pub rest: f64,
}
