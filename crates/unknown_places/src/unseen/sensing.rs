//! Scans of a known map with people in it.

use nalgebra::Vector2;
use std::f64::consts::TAU;

use navigation_world::world::map::StaticMap;
use navigation_world::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result, at_most, positive};

/// Most beams of a scan.
const MOST_BEAMS: usize = 100_000;

/// Beams of a scan, ahead in the middle of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensing {
    /// How many there are.
    pub beams: usize,
    /// How far they reach, in m.
    pub range: f64,
    /// Angle that they divide evenly, in rad.
    pub field_of_view: f64,
}

impl Default for Sensing {
    fn default() -> Self {
        Self {
            beams: 1440,
            range: 8.0,
            field_of_view: TAU,
        }
    }
}

impl Sensing {
    /// Returns it if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        if self.beams == 0 {
            return Err(Failure::invalid("beams", "be at least 1", Given::Count(0)));
        }
        at_most("beams", self.beams, MOST_BEAMS)?;
        positive("range", self.range)?;
        if !(self.field_of_view > 0.0 && self.field_of_view <= TAU) {
            let rule = "be above 0 and at most a whole turn, 2 pi rad";
            let given = Given::Number(self.field_of_view);
            return Err(Failure::invalid("field_of_view", rule, given));
        }
        Ok(self)
    }

    /// True if it looks all around.
    #[must_use]
    pub fn all_round(&self) -> bool {
        self.field_of_view >= TAU
    }

    /// Angle of the first beam and between two, in rad; a whole turn does not turn with the robot.
    fn angles(&self, heading: f64) -> [f64; 2] {
        let step = self.field_of_view / self.beams as f64;
        let ahead = if self.all_round() { 0.0 } else { heading };
        [ahead - 0.5 * self.field_of_view + 0.5 * step, step]
    }

    /// Ends of the beams from a pose, of a length in m at most, among shapes.
    pub fn ends<'a>(
        &self,
        from: Vector2<f64>,
        heading: f64,
        length: f64,
        shapes: &'a [PlacedShape],
    ) -> impl Iterator<Item = Vector2<f64>> + 'a {
        let [first, step] = self.angles(heading);
        (0..self.beams).map(move |beam| {
            let (sin, cos) = (first + beam as f64 * step).sin_cos();
            let along = Vector2::new(cos, sin);
            let cast = shapes.iter().map(|shape| shape.cast(from, along));
            from + along * cast.fold(length, f64::min)
        })
    }

    /// Whether a beam from a pose in a map meets a disc, of a radius in m, before anything else.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // numbers of beams
    pub fn sees(
        &self,
        map: &StaticMap,
        (from, heading): (Vector2<f64>, f64),
        (place, radius): (Vector2<f64>, f64),
        others: &[PlacedShape],
    ) -> bool {
        let offset = place - from;
        let away = offset.norm();
        if away <= radius {
            return true;
        }
        if away - radius > self.range {
            return false;
        }
        let [first, step] = self.angles(heading);
        let half = (radius / away).asin();
        let mut middle = offset.y.atan2(offset.x) - first;
        middle -= ((middle - 0.5 * (self.field_of_view - step)) / TAU).round() * TAU;
        let (from_beam, to_beam) = (
            ((middle - half) / step).ceil(),
            ((middle + half) / step).floor(),
        );
        let disc = PlacedShape::disc(place.into(), radius);
        let count = self.beams as i64;
        (from_beam as i64..=to_beam as i64).any(|beam| {
            let beam = if self.all_round() {
                beam.rem_euclid(count)
            } else {
                beam
            };
            if !(0..count).contains(&beam) {
                return false;
            }
            let (sin, cos) = (first + beam as f64 * step).sin_cos();
            let along = Vector2::new(cos, sin);
            let met = disc.cast(from, along);
            met <= self.range
                && others.iter().all(|other| other.cast(from, along) >= met)
                && map.ray_up_to(from, along, met) >= met
        })
    }
}
