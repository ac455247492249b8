//! Static obstacles of the shield: rectangles that stand, and the map.

use navigation_world::world::footprint::{Footprint, Sweep};
use navigation_world::world::frame::Frame;
use navigation_world::world::map::StaticMap;
use navigation_world::world::shape::PlacedShape;
use numeric::lanes::Vector2;

/// Rounding of distances in m.
pub(super) const ROUNDING: f64 = 1e-9;

/// Half the way over which the direction of a wall is taken, in m.
const BESIDE: f64 = 0.05;

/// Everything that does not move.
#[derive(Clone, Copy, Debug)]
pub struct StaticObstacles<'a> {
    /// Shapes that stand.
    pub shapes: &'a [PlacedShape],
    /// The map.
    pub map: Option<&'a StaticMap>,
}

impl StaticObstacles<'_> {
    /// Nothing stands anywhere.
    pub const NONE: Self = Self {
        shapes: &[],
        map: None,
    };

    /// Whether there is nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.shapes.is_empty() && self.map.is_none()
    }

    /// Distance of a point from the nearest wall in m, zero inside; all that is at least `most` away
    /// counts as that far.
    #[must_use]
    pub fn clearance_up_to(&self, point: Vector2<f64>, most: f64) -> f64 {
        let distances = self.shapes.iter().map(|shape| shape.distance(point));
        let least = distances.fold(most, f64::min);
        self.map
            .map_or(least, |map| map.clearance_up_to(point, least))
    }

    /// Unit vector away from the nearest wall within a distance of a point in m, by central differences; `None` where there
    /// is none.
    pub(crate) fn away(&self, point: Vector2<f64>, most: f64) -> Option<Vector2<f64>> {
        let slope = |along: Vector2<f64>| {
            let clearance = |at: Vector2<f64>| self.clearance_up_to(at, most + 2.0 * BESIDE);
            clearance(point + along) - clearance(point - along)
        };
        let away = Vector2::new(slope(Vector2::x() * BESIDE), slope(Vector2::y() * BESIDE));
        away.try_normalize(0.0)
    }

    /// Distance of an outline at a pose from the nearest wall in m, zero where they meet; all that is at least `most` away
    /// counts as that far.
    pub(super) fn clearance_of(&self, outline: &Footprint, pose: &Frame, most: f64) -> f64 {
        let distances = self.shapes.iter();
        let distances = distances.map(|shape| outline.separation(pose, shape).distance.max(0.0));
        let least = distances.fold(most, f64::min);
        self.map
            .map_or(least, |map| outline.clearance(pose, map, least))
    }

    /// Whether an outline stays at least so far from every wall while it moves from a pose, in m.
    pub(super) fn sweep_keeps(
        &self,
        outline: &Footprint,
        pose: &Frame,
        sweep: Sweep,
        least: f64,
    ) -> bool {
        let apart = |shape: &PlacedShape| outline.keeps_off_shape(pose, sweep, shape, least);
        self.shapes.iter().all(apart)
            && self
                .map
                .is_none_or(|map| outline.keeps_off(pose, sweep, map, least))
    }

    /// Whether all points of a segment are at least so far from every wall, in m.
    #[must_use]
    pub fn segment_keeps(&self, from: Vector2<f64>, to: Vector2<f64>, least: f64) -> bool {
        let apart = |shape: &PlacedShape| shape.distance_of_segment(from, to) >= least;
        self.shapes.iter().all(apart)
            && self
                .map
                .is_none_or(|map| map.segment_keeps(from, to, least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_is_as_near_as_its_nearest_point() {
        let table = PlacedShape::turned([0.4, -0.2], [1.2, 0.3], 0.7);
        let pillar = PlacedShape::disc([-1.0, 0.5], 0.3);
        let shapes = [table, pillar];
        let walls = StaticObstacles {
            shapes: &shapes,
            map: None,
        };
        for [a, b, c, d] in [
            [-2.0, 0.0, 2.0, 1.5],
            [1.5, -1.0, 1.0, 1.0],
            [0.4, -0.2, 3.0, 3.0],
            [-1.0, 2.0, -1.0, 2.0],
        ] {
            let (from, to) = (Vector2::new(a, b), Vector2::new(c, d));
            let sampled = (0..=4000)
                .map(|part| {
                    let place = from + (to - from) * (f64::from(part) / 4000.0);
                    walls.clearance_up_to(place, 9.0)
                })
                .fold(f64::INFINITY, f64::min);
            assert!(walls.segment_keeps(from, to, sampled - 2e-3));
            assert!(!walls.segment_keeps(from, to, sampled + 1e-12));
        }
    }
}
