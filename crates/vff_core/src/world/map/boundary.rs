//! The few boundary points that a law sees of a map.

use nalgebra::Vector2;

use crate::error::{Failure, Given, Result};
use crate::world::map::StaticMap;
use crate::world::map::capsule::Capsule;
use crate::world::map::index::Bounds;

/// Most boundary points that are told of.
pub const MOST_POINTS: usize = 8;

/// What lies behind a boundary point by less than this counts as behind it, in m.
const SPARE: f64 = 1e-9;

/// Half planes behind the boundary points found so far: `n.b >= offset`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beyond {
    planes: [(Vector2<f64>, f64); MOST_POINTS],
    count: usize,
}

impl Default for Beyond {
    fn default() -> Self {
        Self {
            planes: [(Vector2::zeros(), 0.0); MOST_POINTS],
            count: 0,
        }
    }
}

impl Beyond {
    fn planes(&self) -> &[(Vector2<f64>, f64)] {
        &self.planes[..self.count]
    }

    /// Drops what lies behind a boundary point, seen from a place.
    pub(crate) fn drop_behind(&mut self, place: Vector2<f64>, point: Vector2<f64>, kappa: f64) {
        let to = point - place;
        let distance = to.norm();
        if distance > 0.0 && self.count < MOST_POINTS {
            let normal = to / distance;
            let offset = normal.dot(&place) + kappa * distance - SPARE;
            self.planes[self.count] = (normal, offset);
            self.count += 1;
        }
    }

    pub(crate) fn hide(&self, point: Vector2<f64>) -> bool {
        let mut planes = self.planes().iter();
        planes.any(|(normal, offset)| normal.dot(&point) >= *offset)
    }

    fn hide_all(&self, bounds: &Bounds) -> bool {
        let mut planes = self.planes().iter();
        planes.any(|(normal, offset)| bounds.least_along(*normal) >= *offset)
    }

    /// The boundary point of a capsule that is nearest to a place: a segment without radius is cut
    /// at the half planes, any other capsule is judged by its nearest point.
    #[inline]
    fn nearest_of(&self, capsule: &Capsule, place: Vector2<f64>) -> Option<Vector2<f64>> {
        if capsule.radius > 0.0 {
            let axis = capsule.at(capsule.share_nearest(place, [0.0, 1.0]));
            let point = capsule.surface(axis, place);
            return (!self.hide(point)).then_some(point);
        }
        let [mut first, mut last] = [0.0_f64, 1.0_f64];
        for (normal, offset) in self.planes() {
            let (here, there) = (
                normal.dot(&capsule.from) - offset,
                normal.dot(&capsule.to) - offset,
            );
            match (here >= 0.0, there >= 0.0) {
                (true, true) => return None,
                (false, false) => {}
                (true, false) => first = first.max(here / (here - there)),
                (false, true) => last = last.min(here / (here - there)),
            }
        }
        (first <= last).then(|| capsule.at(capsule.share_nearest(place, [first, last])))
    }
}

impl StaticMap {
    /// The nearest boundary point within a reach that no half plane hides; of equally near ones
    /// that of the first segment.
    pub(super) fn nearest_beyond(
        &self,
        place: Vector2<f64>,
        reach: f64,
        beyond: &Beyond,
    ) -> Option<Vector2<f64>> {
        let mut found: Option<(f64, usize, Vector2<f64>)> = None;
        self.parts.index.visit(
            reach * reach,
            |bounds| (!beyond.hide_all(bounds)).then(|| bounds.distance_squared(place)),
            |index, capsule, limit| {
                let Some(point) = beyond.nearest_of(capsule, place) else {
                    return limit;
                };
                let square = (point - place).norm_squared();
                let nearer = found.is_none_or(|(least, first, _)| (square, index) < (least, first));
                if square <= limit && nearer {
                    found = Some((square, index, point));
                }
                limit.min(square)
            },
        );
        found.map(|(_, _, point)| point)
    }

    /// Boundary points that a law sees from a position, the nearest first, at most [`MOST_POINTS`].
    ///
    /// `b_1` is the nearest one within the reach in m; every point with `n_1.(b - P) >= kappa d_1`
    /// is then left out, `d_1 = |b_1 - P|`, `n_1 = (b_1 - P)/d_1`; the next is the nearest of what
    /// is left, and so on. With `kappa = 1` their half planes span the convex free region around
    /// the position; force laws use 1/2.
    pub fn boundary_points(
        &self,
        position: Vector2<f64>,
        reach: f64,
        kappa: f64,
        out: &mut Vec<[f64; 2]>,
    ) {
        out.clear();
        let mut beyond = Beyond::default();
        while out.len() < MOST_POINTS {
            let Some(point) = self.nearest_beyond(position, reach, &beyond) else {
                return;
            };
            // A boundary through the center of the robot is in no direction.
            if point == position {
                return;
            }
            out.push(point.into());
            beyond.drop_behind(position, point, kappa);
        }
    }
}

/// Returns the share if a law may use it for its boundary points.
///
/// # Errors
/// It is outside (0, 1].
pub fn checked_kappa(kappa: f64) -> Result<f64> {
    if kappa > 0.0 && kappa <= 1.0 {
        Ok(kappa)
    } else {
        let rule = "be above 0 and at most 1";
        Err(Failure::invalid("kappa", rule, Given::Number(kappa)))
    }
}
