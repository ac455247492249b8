//! What is around the follower: obstacles and the leader, as functions of time.

use crate::error::{Failure, Given, Result, finite_pair, not_negative};
use crate::sensing::sonar::Shape;

/// An obstacle that moves straight for a while, or stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// Shape at its first place.
    pub shape: Shape,
    /// Velocity while it moves, in m/s.
    pub velocity: [f64; 2],
    /// When it starts, in s.
    pub start: f64,
    /// When it stops, in s.
    pub stop: f64,
}

impl Mover {
    /// An obstacle that stands.
    #[must_use]
    pub fn standing(shape: Shape) -> Self {
        Self {
            shape,
            velocity: [0.0, 0.0],
            start: 0.0,
            stop: 0.0,
        }
    }

    /// Passes an obstacle that can be.
    ///
    /// # Errors
    /// A number is not finite or a time is negative, or it stops before it starts.
    pub fn checked(self) -> Result<Self> {
        self.shape.checked()?;
        finite_pair("velocity", self.velocity)?;
        not_negative("start", self.start)?;
        if self.stop.is_nan() || self.stop < self.start {
            let rule = "not be before start";
            return Err(Failure::invalid("stop", rule, Given::Number(self.stop)));
        }
        Ok(self)
    }

    /// Shift from its first place at a time in s, in m.
    #[inline]
    #[must_use]
    pub fn shift(&self, time: f64) -> [f64; 2] {
        let moving = time.min(self.stop) - self.start;
        let moving = moving.max(0.0);
        [self.velocity[0] * moving, self.velocity[1] * moving]
    }

    /// Shape at a time in s.
    #[inline]
    #[must_use]
    pub fn at(&self, time: f64) -> Shape {
        self.shape.shifted(self.shift(time))
    }

    /// Velocity at a time in s, in m/s.
    #[must_use]
    pub fn velocity_at(&self, time: f64) -> [f64; 2] {
        if (self.start..self.stop).contains(&time) {
            self.velocity
        } else {
            [0.0, 0.0]
        }
    }
}

/// The source of the sound: it goes from one place to another and stays there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leader {
    /// First place, in m.
    pub start: [f64; 2],
    /// Velocity on the way, in m/s.
    pub velocity: [f64; 2],
    /// How long it is on the way, in s.
    pub duration: f64,
    /// Half of its size along x and y if the sensors see it, in m.
    pub visible: Option<[f64; 2]>,
}

impl Leader {
    /// A source that stays.
    #[must_use]
    pub fn standing(position: [f64; 2]) -> Self {
        Self {
            start: position,
            velocity: [0.0, 0.0],
            duration: 0.0,
            visible: None,
        }
    }

    /// From a place to another at a speed in m/s.
    ///
    /// # Errors
    /// A number is not finite, or the speed is not positive though the places differ.
    pub fn going(start: [f64; 2], end: [f64; 2], speed: f64) -> Result<Self> {
        finite_pair("leader.start", start)?;
        finite_pair("leader.end", end)?;
        let way = [end[0] - start[0], end[1] - start[1]];
        let length = way[0].hypot(way[1]);
        if length == 0.0 {
            return Ok(Self::standing(start));
        }
        crate::error::positive("leader.speed", speed)?;
        let share = speed / length;
        Ok(Self {
            start,
            velocity: [share * way[0], share * way[1]],
            duration: length / speed,
            visible: None,
        })
    }

    /// Position at a time in s, in m.
    #[inline]
    #[must_use]
    pub fn at(&self, time: f64) -> [f64; 2] {
        let moving = time.min(self.duration);
        [
            self.start[0] + self.velocity[0] * moving,
            self.start[1] + self.velocity[1] * moving,
        ]
    }
}

/// Everything around the follower, which starts at the origin and looks along x.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Source of the sound.
    pub leader: Leader,
    /// Obstacles.
    pub obstacles: Vec<Mover>,
    /// How long it is watched, in s.
    pub duration: f64,
}
