//! The few boundary points that a law sees of a map.

use nalgebra::Vector2;

use crate::world::map::StaticMap;
use crate::world::map::capsule::Capsule;
use crate::world::map::index::BoundingBox;
use numeric::error::{Failure, Given, Result};

/// Most boundary points that are told of.
pub const MOST_POINTS: usize = 8;

/// Tolerance in m within which a point counts as behind a boundary point.
const SPARE: f64 = 1e-9;

/// Segments within reach that are kept in mind from one boundary point to the next; among more of
/// them each is searched for.
const MOST_PIECES: usize = 256;

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

    fn hide_all(&self, bounds: &BoundingBox) -> bool {
        let mut planes = self.planes().iter();
        planes.any(|(normal, offset)| bounds.least_along(*normal) >= *offset)
    }
}

/// Remaining part of a capsule.
#[derive(Clone, Copy, Debug, Default)]
struct CapsulePiece {
    /// Index of the capsule.
    index: usize,
    /// Shares of the segment between which it is left.
    left: [f64; 2],
}

impl CapsulePiece {
    fn whole(index: usize) -> Self {
        Self {
            index,
            left: [0.0, 1.0],
        }
    }

    /// Cuts off what lies behind a half plane; a capsule with a radius is judged by its nearest
    /// point later. Whether something is left.
    #[inline]
    fn cut(&mut self, capsule: &Capsule, (normal, offset): (Vector2<f64>, f64)) -> bool {
        if capsule.radius > 0.0 {
            return true;
        }
        let (here, there) = (
            normal.dot(&capsule.from) - offset,
            normal.dot(&capsule.to) - offset,
        );
        let [first, last] = &mut self.left;
        match (here >= 0.0, there >= 0.0) {
            (true, true) => return false,
            (false, false) => {}
            (true, false) => *first = first.max(here / (here - there)),
            (false, true) => *last = last.min(here / (here - there)),
        }
        first <= last
    }

    /// The nearest boundary point of what is left.
    #[inline]
    fn nearest(&self, capsule: &Capsule, place: Vector2<f64>) -> Vector2<f64> {
        let axis = capsule.at(capsule.share_nearest(place, self.left));
        capsule.surface(axis, place)
    }
}

/// The nearest boundary point so far: its squared distance, its capsule, and where it is.
type Found = (f64, usize, Vector2<f64>);

/// The nearer of two boundary points, of equally near ones that of the first segment.
#[inline]
fn nearer(found: Option<Found>, candidate: Found) -> Option<Found> {
    let first = |(square, index, _): Found| (square, index);
    let better = found.is_none_or(|found| first(candidate) < first(found));
    if better { Some(candidate) } else { found }
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
        let mut found: Option<Found> = None;
        self.parts.index.visit(
            reach * reach,
            |bounds| (!beyond.hide_all(bounds)).then(|| bounds.distance_squared(place)),
            |index, capsule, limit| {
                let mut piece = CapsulePiece::whole(index);
                let mut planes = beyond.planes().iter();
                if !planes.all(|plane| piece.cut(capsule, *plane)) {
                    return limit;
                }
                let point = piece.nearest(capsule, place);
                let square = (point - place).norm_squared();
                if square > limit || (capsule.radius > 0.0 && beyond.hide(point)) {
                    return limit;
                }
                found = nearer(found, (square, index, point));
                limit.min(square)
            },
        );
        found.map(|(_, _, point)| point)
    }

    /// All capsules with a boundary point within a reach; `None` if they are more than a few.
    fn pieces_near(
        &self,
        place: Vector2<f64>,
        reach: f64,
        pieces: &mut [CapsulePiece; MOST_PIECES],
    ) -> Option<(usize, Option<Found>)> {
        let (mut count, mut found) = (0, None);
        let mut fits = true;
        self.parts.index.visit(
            reach * reach,
            |bounds| Some(bounds.distance_squared(place)),
            |index, capsule, limit| {
                let piece = CapsulePiece::whole(index);
                let point = piece.nearest(capsule, place);
                let square = (point - place).norm_squared();
                if square > limit {
                    return limit;
                }
                if count == MOST_PIECES {
                    fits = false;
                    return -1.0;
                }
                pieces[count] = piece;
                count += 1;
                found = nearer(found, (square, index, point));
                limit
            },
        );
        fits.then_some((count, found))
    }

    /// Cuts pieces at a half plane and leaves out those without a point within a reach; returns how
    /// many are left, and the nearest boundary point of them.
    fn cut_all(
        &self,
        pieces: &mut [CapsulePiece],
        place: Vector2<f64>,
        reach: f64,
        plane: (Vector2<f64>, f64),
    ) -> (usize, Option<Found>) {
        let (mut left, mut found) = (0, None);
        for at in 0..pieces.len() {
            let mut piece = pieces[at];
            let capsule = &self.capsules()[piece.index];
            if !piece.cut(capsule, plane) {
                continue;
            }
            let point = piece.nearest(capsule, place);
            let square = (point - place).norm_squared();
            let hidden = capsule.radius > 0.0 && plane.0.dot(&point) >= plane.1;
            if square <= reach * reach && !hidden {
                pieces[left] = piece;
                left += 1;
                found = nearer(found, (square, piece.index, point));
            }
        }
        (left, found)
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
        let mut pieces = [CapsulePiece::default(); MOST_PIECES];
        let mut beyond = Beyond::default();
        let Some((mut left, mut found)) = self.pieces_near(position, reach, &mut pieces) else {
            return self.boundary_points_among_many(position, reach, kappa, out);
        };
        // A boundary through the center of the robot is in no direction.
        while let Some((_, _, point)) = found.filter(|(_, _, point)| *point != position) {
            out.push(point.into());
            beyond.drop_behind(position, point, kappa);
            let Some(plane) = beyond.planes().last().filter(|_| out.len() < MOST_POINTS) else {
                return;
            };
            (left, found) = self.cut_all(&mut pieces[..left], position, reach, *plane);
        }
    }

    /// Boundary points by a search through the index for every point.
    fn boundary_points_among_many(
        &self,
        position: Vector2<f64>,
        reach: f64,
        kappa: f64,
        out: &mut Vec<[f64; 2]>,
    ) {
        let mut beyond = Beyond::default();
        while out.len() < MOST_POINTS {
            let found = self.nearest_beyond(position, reach, &beyond);
            let Some(point) = found.filter(|point| *point != position) else {
                return;
            };
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
