//! Static maps: walls, filled polygons, discs and occupancy grids as one map.
//!
//! Everything becomes segments with a radius, and filled interiors. Distances are exact, and zero
//! inside. A map is shared by reference count, so a copy costs nothing.

mod boundary;
mod capsule;
pub mod distance_transform;
mod grid;
mod index;
mod outline;
mod queries;

use std::sync::Arc;

use nalgebra::Vector2;

use crate::world::map::grid::Cells;
use crate::world::map::index::Index;
use crate::world::shape::{PlacedShape, Shape};
pub(crate) use boundary::Beyond;
pub use boundary::{MOST_POINTS, checked_kappa};
pub use capsule::Capsule;
pub use grid::{GridPlace, MOST_CELLS};
use numeric::error::{
    Failure, Given, Interrupted, Result, at_most, finite_pair, not_negative, positive,
};

/// Most segments of a map.
pub const MOST_SEGMENTS: usize = 1 << 23;

/// A map of what stands still.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticMap {
    parts: Arc<MapParts>,
}

#[derive(Debug, PartialEq)]
struct MapParts {
    index: Index,
    /// Whether some segments are edges of filled outlines.
    outlines: bool,
    grids: Vec<Cells>,
}

/// Contents of a map.
#[derive(Clone, Debug, Default)]
pub struct MapShapes {
    capsules: Vec<Capsule>,
    grids: Vec<Cells>,
}

impl MapShapes {
    /// Nothing so far.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    fn room_for(&self, name: &str, more: usize) -> Result<()> {
        at_most(
            name,
            self.capsules.len().saturating_add(more),
            MOST_SEGMENTS,
        )
        .map(|_| ())
        .map_err(|error| error.mended_by("a coarser grid or fewer vertices give fewer segments"))
    }

    /// Adds walls along a polyline, with a radius in m.
    ///
    /// # Errors
    /// A number is not finite, the radius is negative, or the polyline has no length.
    pub fn polyline(&mut self, points: &[[f64; 2]], radius: f64) -> Result<()> {
        not_negative("radius", radius)?;
        for (index, point) in points.iter().enumerate() {
            finite_pair(&format!("point {index}"), *point)?;
        }
        self.room_for("segments", points.len())?;
        let walls = points
            .windows(2)
            .map(|pair| Capsule::wall(pair[0].into(), pair[1].into(), radius));
        let before = self.capsules.len();
        self.capsules
            .extend(walls.filter(|wall| wall.from != wall.to));
        if self.capsules.len() == before {
            let rule = "have two different points at least";
            let given = Given::Count(points.len() as u64);
            let advice = "a single place is a disc";
            return Err(Failure::invalid("points", rule, given).mended_by(advice));
        }
        Ok(())
    }

    /// Adds a filled polygon; its first point is not repeated at the end.
    ///
    /// # Errors
    /// A number is not finite, there are fewer than three points, or the outline touches or crosses
    /// itself.
    pub fn polygon(&mut self, points: &[[f64; 2]]) -> Result<()> {
        self.room_for("segments", points.len())?;
        self.capsules.extend(outline::outline(points)?);
        Ok(())
    }

    /// Adds a filled disc of a radius in m.
    ///
    /// # Errors
    /// A number is not finite, or the radius is not positive.
    pub fn disc(&mut self, center: [f64; 2], radius: f64) -> Result<()> {
        finite_pair("center", center)?;
        positive("radius", radius)?;
        self.room_for("discs", 1)?;
        self.capsules.push(Capsule::disc(center.into(), radius));
        Ok(())
    }

    /// Adds a grid of cells, row after row from the lowest y; `true` is occupied. What lies outside
    /// of the grid is free.
    ///
    /// # Errors
    /// The place is not allowed, the number of cells is not that of the rows and columns, the
    /// boundary has too many segments, or the caller asked to stop.
    pub fn grid(
        &mut self,
        occupied: &[bool],
        columns: usize,
        place: GridPlace,
        interrupted: Interrupted<'_>,
    ) -> Result<()> {
        self.add_cells(Cells::new(occupied, columns, place)?, interrupted)
    }

    /// Adds a grid as [`MapShapes::grid`] does; nothing is known of what lies outside of it, and of
    /// other such grids.
    ///
    /// # Errors
    /// Fails like [`MapShapes::grid`].
    pub fn limiting_grid(
        &mut self,
        occupied: &[bool],
        columns: usize,
        place: GridPlace,
        interrupted: Interrupted<'_>,
    ) -> Result<()> {
        let cells = Cells::new(occupied, columns, place)?.limiting();
        self.add_cells(cells, interrupted)
    }

    fn add_cells(&mut self, cells: Cells, interrupted: Interrupted<'_>) -> Result<()> {
        self.room_for("segments", cells.count_boundary(interrupted)?)?;
        cells.boundary(&mut self.capsules, interrupted)?;
        self.grids.push(cells);
        Ok(())
    }

    /// The map of all that was added.
    #[must_use]
    pub fn map(self) -> StaticMap {
        StaticMap {
            parts: Arc::new(MapParts {
                outlines: self.capsules.iter().any(|capsule| capsule.filled),
                index: Index::new(self.capsules),
                grids: self.grids,
            }),
        }
    }
}

impl Default for StaticMap {
    /// A map with nothing in it.
    fn default() -> Self {
        MapShapes::new().map()
    }
}

impl StaticMap {
    /// Identity of two maps, which is quicker told than their equality.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.parts, &other.parts)
    }

    /// The segments in the order of the index.
    #[must_use]
    pub fn capsules(&self) -> &[Capsule] {
        &self.parts.index.capsules
    }

    /// Its segments, if it is made of walls without a radius only: its clearance is the least distance from them.
    #[must_use]
    pub fn bare_walls(&self) -> Option<&[Capsule]> {
        let bare = |wall: &Capsule| wall.radius == 0.0 && wall.from != wall.to;
        let plain = self.parts.grids.is_empty() && !self.parts.outlines;
        (plain && self.capsules().iter().all(bare)).then(|| self.capsules())
    }

    /// Lower and upper corner of the box around everything, in m; `None` for an empty map.
    #[must_use]
    pub fn bounds(&self) -> Option<[Vector2<f64>; 2]> {
        let bounds = self.parts.index.bounds()?;
        Some([bounds.lower, bounds.upper])
    }

    fn limits(&self) -> impl Iterator<Item = &Cells> {
        self.parts.grids.iter().filter(|cells| cells.limits())
    }

    /// Whether something is known of a place: it lies in a grid outside of which nothing is known, or there is
    /// no such grid.
    #[must_use]
    pub fn knows(&self, place: Vector2<f64>) -> bool {
        let mut limits = self.limits().peekable();
        limits.peek().is_none() || limits.any(|cells| cells.covers(place))
    }

    /// Lower and upper corner of the box around all grids outside of which nothing is known, in m; `None`
    /// without such grids.
    #[must_use]
    pub fn known_bounds(&self) -> Option<[Vector2<f64>; 2]> {
        let corners = self.limits().flat_map(Cells::corners);
        corners.fold(None, |bounds: Option<[Vector2<f64>; 2]>, corner| {
            let [lower, upper] = bounds.unwrap_or([corner, corner]);
            Some([lower.inf(&corner), upper.sup(&corner)])
        })
    }

    /// The map with discs and rectangles added to it.
    #[must_use]
    pub fn with_shapes(&self, added: &[PlacedShape]) -> Self {
        let mut shapes = MapShapes {
            capsules: self.parts.index.capsules.clone(),
            grids: self.parts.grids.clone(),
        };
        for placed in added {
            match placed.shape {
                Shape::Disc { radius } => {
                    shapes.capsules.push(Capsule::disc(placed.center, radius));
                }
                Shape::Rectangle {
                    half_length,
                    half_width,
                    ..
                } => {
                    let [one, two, three, four] = placed.corners().map(<[f64; 2]>::from);
                    if let Ok(sides) = outline::outline(&[one, two, four, three]) {
                        shapes.capsules.extend(sides);
                    } else {
                        // Sides that rounding makes one line: the disc around it.
                        let around = half_length.hypot(half_width);
                        shapes.capsules.push(Capsule::disc(placed.center, around));
                    }
                }
            }
        }
        shapes.map()
    }

    /// Everything in two maps.
    ///
    /// # Errors
    /// Together they have too many segments.
    pub fn joined(&self, other: &Self) -> Result<Self> {
        let mut shapes = MapShapes {
            capsules: self.parts.index.capsules.clone(),
            grids: self.parts.grids.clone(),
        };
        shapes.room_for("segments", other.capsules().len())?;
        shapes.capsules.extend_from_slice(other.capsules());
        shapes.grids.extend_from_slice(&other.parts.grids);
        Ok(shapes.map())
    }
}
