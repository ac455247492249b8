//! Laws that decide by what sensors on the robot read, without a map and without a goal.

use nalgebra::Vector2;

use navigation_world::sensing::fixes::Heard;
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::Body;

/// Input of a reflex at a sample.
#[derive(Clone, Copy, Debug)]
pub struct Percept<'a> {
    /// Where the robot is and where it looks, by its wheels.
    pub pose: Frame,
    /// Velocity that it has over ground, in m/s.
    pub velocity: Vector2<f64>,
    /// Velocity that the law wants since the last sample, in m/s.
    pub wanted: Vector2<f64>,
    /// Last readings of range sensors in m; infinite without echo.
    pub readings: &'a [f64],
    /// A source of sound, at the samples at which it is heard.
    pub heard: Option<Heard>,
    /// Bodies as a camera knows them.
    pub bodies: &'a [Body],
}

/// A law that decides by what sensors read; it may remember what it needs.
pub trait Reflex {
    /// Type of its commands.
    type Answer;

    /// Command until the next sample.
    fn answer(&mut self, percept: &Percept<'_>) -> Self::Answer;
}
