//! Several sensors on one robot.

use std::ops::Range;

use nalgebra::Vector2;

use crate::sensing::sonar::beam::Beam;
use crate::sensing::sonar::ranging::{Normals, Ranging};
use crate::world::frame::Frame;
use crate::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result};

/// Which sensors fire in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Firing {
    /// All of them, and none receives the others.
    #[default]
    Together,
    /// All of them, and each receives the echoes of the others.
    TogetherWithCrossTalk,
    /// One after the other, the first one in step 0.
    InTurn,
}

impl Firing {
    /// The order of a word.
    ///
    /// # Errors
    /// There is none.
    pub fn named(word: &str) -> Result<Self> {
        match word {
            "together" => Ok(Self::Together),
            "cross_talk" => Ok(Self::TogetherWithCrossTalk),
            "in_turn" => Ok(Self::InTurn),
            other => {
                let rule = "be one of \"together\", \"cross_talk\", \"in_turn\"";
                Err(Failure::invalid("firing", rule, Given::Word(other.into())))
            }
        }
    }

    /// Indices of the sensors that fire in a step.
    #[inline]
    #[must_use]
    pub fn fired(self, count: usize, step: usize) -> Range<usize> {
        match self {
            Self::Together | Self::TogetherWithCrossTalk => 0..count,
            Self::InTurn => step % count..step % count + 1,
        }
    }
}

/// Equal sensors on one robot.
#[derive(Clone, Debug, PartialEq)]
pub struct SonarArray {
    /// Places on the robot, x forward and y left; beams lie along their x axes.
    mounts: Vec<Frame>,
    beam: Beam,
    ranging: Ranging,
    /// `ranging.scale()` and `ranging.reach()`, asked for at every echo.
    scale: f64,
    reach: f64,
    firing: Firing,
}

impl SonarArray {
    /// Sensors at their places.
    ///
    /// # Errors
    /// There is no sensor, or a place or a limit cannot be.
    pub fn new(mounts: Vec<Frame>, beam: Beam, ranging: Ranging, firing: Firing) -> Result<Self> {
        if mounts.is_empty() {
            let given = Given::Count(0);
            let rule = "hold at least one sensor";
            return Err(Failure::invalid("sensors", rule, given));
        }
        for (index, mount) in mounts.iter().enumerate() {
            let owner = format!("sensors[{index}]");
            mount.checked().map_err(|error| error.within(&owner))?;
        }
        let ranging = ranging.checked()?;
        Ok(Self {
            mounts,
            beam,
            ranging,
            scale: ranging.scale(),
            reach: ranging.reach(),
            firing,
        })
    }

    /// Places of the sensors.
    #[must_use]
    pub fn mounts(&self) -> &[Frame] {
        &self.mounts
    }

    /// Beam of each sensor.
    #[must_use]
    pub fn beam(&self) -> &Beam {
        &self.beam
    }

    /// Which sensors fire when.
    #[must_use]
    pub fn firing(&self) -> Firing {
        self.firing
    }

    /// Limits and noise of each sensor.
    #[must_use]
    pub fn ranging(&self) -> &Ranging {
        &self.ranging
    }

    /// Reading of one sensor without noise, in m; infinite without echo.
    #[inline]
    #[must_use]
    pub fn echo(&self, body: &Frame, sensor: usize, shapes: &[PlacedShape]) -> f64 {
        let Some(mount) = self.mounts.get(sensor) else {
            return f64::INFINITY;
        };
        let pose = body.carrying(mount);
        let mut distance = self.beam.nearest(&pose, shapes, self.reach);
        if self.firing == Firing::TogetherWithCrossTalk {
            for (index, other) in self.mounts.iter().enumerate() {
                if index != sensor {
                    distance = distance.min(self.overheard(&pose, &body.carrying(other), shapes));
                }
            }
        }
        self.ranging.scaled(distance * self.scale)
    }

    /// New readings of the sensors that fire in a step, in m, infinite without echo; those of the
    /// others stay. `noise` is asked once for every echo.
    #[inline]
    pub fn measure(
        &self,
        body: &Frame,
        shapes: &[PlacedShape],
        step: usize,
        readings: &mut [f64],
        noise: &mut Normals,
    ) {
        let count = self.mounts.len().min(readings.len());
        for sensor in self.firing.fired(count, step) {
            let mut reading = self.echo(body, sensor, shapes);
            if reading.is_finite() && self.ranging.noise > 0.0 {
                reading += self.ranging.noise * noise.draw();
            }
            readings[sensor] = reading;
        }
    }

    /// Half of the way from another sensor to a point of its beam and on to this one: the
    /// shortest of those that this one can see.
    fn overheard(&self, listener: &Frame, speaker: &Frame, shapes: &[PlacedShape]) -> f64 {
        let limit = (0.5 * self.beam.width()).cos();
        let mut least = f64::INFINITY;
        for ray in self.beam.rays() {
            let direction = speaker.outward(*ray);
            let out = cast(shapes, speaker.position, direction);
            if !out.is_finite() {
                continue;
            }
            let back = speaker.position + direction * out - listener.position;
            let way = back.x.hypot(back.y);
            let unit = back / way;
            let seen = way > 0.0
                && listener.inward(unit).x >= limit
                && cast(shapes, listener.position, unit) >= way * (1.0 - BEHIND);
            if seen {
                least = least.min(0.5 * (out + way));
            }
        }
        least
    }
}

/// A point that is farther than its surface by this share is hidden; rounding stays far below.
const BEHIND: f64 = 1e-9;

/// Distance along a ray to the first shape, in m.
fn cast(shapes: &[PlacedShape], from: Vector2<f64>, direction: Vector2<f64>) -> f64 {
    shapes
        .iter()
        .map(|shape| shape.cast(from, direction))
        .fold(f64::INFINITY, f64::min)
}
