//! Sample of a run of the follower.

use nalgebra::Vector2;

use navigation_world::world::frame::Frame;
use navigation_world::world::shape::PlacedShape;

/// Everything at one sample.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// Time, in s.
    pub time: f64,
    /// Robot.
    pub pose: &'a Frame,
    /// Virtual velocity at the end of the step, in m/s.
    pub virtual_velocity: Vector2<f64>,
    /// Speeds (left, right) of the wheels until the next sample, in m/s.
    pub wheels: [f64; 2],
    /// Where it wants to be, in m.
    pub target: Vector2<f64>,
    /// Source, in m.
    pub source: Vector2<f64>,
    /// Attraction, in N.
    pub attraction: Vector2<f64>,
    /// Repulsion, in N.
    pub repulsion: Vector2<f64>,
    /// Readings, in m; infinite without echo.
    pub readings: &'a [f64],
    /// Obstacles.
    pub shapes: &'a [PlacedShape],
}

/// Receives samples.
pub trait SampleObserver {
    /// Takes one sample.
    fn sample(&mut self, sample: &Sample<'_>);
}

impl SampleObserver for () {
    #[inline]
    fn sample(&mut self, _sample: &Sample<'_>) {}
}

impl<O: SampleObserver> SampleObserver for &mut O {
    #[inline]
    fn sample(&mut self, sample: &Sample<'_>) {
        (**self).sample(sample);
    }
}
