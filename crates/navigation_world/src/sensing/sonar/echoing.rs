//! An array of sonars at work: its last readings, and the noise of the next ones.

use crate::sensing::sensor::{Sensor, Truth};
use crate::sensing::sonar::array::SonarArray;
use crate::sensing::sonar::ranging::Normals;
use crate::world::frame::Frame;
use crate::world::geometry::Body;
use crate::world::shape::PlacedShape;
use numeric::random::Stream;

/// An array on a robot that reads once a control period.
#[derive(Clone, Debug)]
pub struct Sonar {
    array: SonarArray,
    /// Last readings in m.
    readings: Vec<f64>,
    /// Reading without echo in m.
    silent: f64,
    shapes: Vec<PlacedShape>,
    noise: Normals,
    samples: usize,
}

impl Sonar {
    /// An array with noise from a stream, that reads a distance in m without echo.
    #[must_use]
    pub fn new(array: &SonarArray, noise: Stream, silent: f64) -> Self {
        Self {
            readings: vec![silent; array.mounts().len()],
            array: array.clone(),
            silent,
            shapes: Vec::new(),
            noise: Normals::new(noise),
            samples: 0,
        }
    }

    /// Sensors of the array.
    #[must_use]
    pub fn array(&self) -> &SonarArray {
        &self.array
    }

    /// Last readings in m.
    #[inline]
    #[must_use]
    pub fn readings(&self) -> &[f64] {
        &self.readings
    }

    /// Reads the sensors whose turn it is, on a robot in a frame among outlines.
    ///
    /// The frame is taken where it lies: a copy that was written just before is slow to read again.
    #[inline]
    pub fn fire(&mut self, body: &Frame, shapes: &[PlacedShape]) {
        let (array, readings) = (&self.array, &mut self.readings);
        array.measure(body, shapes, self.samples, readings, &mut self.noise);
        if self.silent.is_finite() {
            for sensor in array.firing().fired(readings.len(), self.samples) {
                if !readings[sensor].is_finite() {
                    readings[sensor] = self.silent;
                }
            }
        }
        self.samples += 1;
    }
}

impl Sensor for Sonar {
    #[inline]
    fn observe(&mut self, truth: &Truth<'_>, _known: &Frame, _bodies: &mut [Body]) {
        if truth.bodies.is_empty() {
            self.fire(&truth.frame(), truth.outlines);
            return;
        }
        let mut shapes = std::mem::take(&mut self.shapes);
        let present = truth.bodies.iter().filter(|body| body.state.present);
        shapes.clear();
        shapes.extend(present.map(|body| PlacedShape {
            center: body.state.position.into(),
            shape: body.shape,
        }));
        shapes.extend_from_slice(truth.outlines);
        self.fire(&truth.frame(), &shapes);
        self.shapes = shapes;
    }
}
