//! Map of a window around the robot that moves by whole cells: hits, passes and points of scans.

use nalgebra::Vector2;
use navigation_world::world::footprint::Footprint;
use navigation_world::world::frame::Frame;
use numeric::error::{Failure, Given, Result, positive};

use super::walk;

/// Evidence of a cell that is kept; of more, all is scaled down before another beam counts, which forgets the drift
/// of the odometry.
const MOST_EVIDENCE: f32 = 40.0;
/// Evidence that stands in for a beam where the robot stood at the start.
const GIVEN: f32 = 1e-6;
/// Cells in a word of a row.
pub(super) const WORD: usize = 64;
/// Most cells along a side of the window.
const MOST_CELLS: usize = 1024;
/// Cells that the robot may be off the middle of the window.
const SLACK: usize = 7;

/// Size and rules of a rolling map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapOptions {
    /// Side of a cell in m.
    pub cell: f64,
    /// How far from the robot beams count, in m; the window holds as much on all sides.
    pub reach: f64,
    /// Share of hits in all evidence of a cell above which it is occupied.
    pub hit_share: f64,
    /// Least hits of an occupied cell.
    pub least_hits: f64,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self {
            cell: 0.05,
            reach: 6.0,
            hit_share: 0.1,
            least_hits: 2.0,
        }
    }
}

impl MapOptions {
    /// Returns the options if they are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        positive("cell", self.cell)?;
        positive("reach", self.reach)?;
        positive("least_hits", self.least_hits)?;
        let most = ((MOST_CELLS / 2 - SLACK - 1) as f64) * self.cell;
        if self.reach > most || self.reach < 4.0 * self.cell {
            let rule = format!(
                "be at least 4 cells and at most {most:.3} m with cells of {} m",
                self.cell
            );
            return Err(Failure::invalid("reach", rule, Given::Number(self.reach)));
        }
        if !(self.hit_share > 0.0 && self.hit_share <= 0.5) {
            let rule = "be above 0 and at most 0.5";
            return Err(Failure::invalid(
                "hit_share",
                rule,
                Given::Number(self.hit_share),
            ));
        }
        if self.least_hits > f64::from(MOST_EVIDENCE) * self.hit_share {
            let rule =
                format!("be at most {MOST_EVIDENCE} hit_share: no cell could be occupied for long");
            return Err(Failure::invalid(
                "least_hits",
                rule,
                Given::Number(self.least_hits),
            ));
        }
        Ok(self)
    }
}

/// Readings of a lidar at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Scan<'a> {
    /// Pose of the lidar at that instant, in the frame of the odometry.
    pub pose: Frame,
    /// Unit vectors of the beams in the frame of the lidar.
    pub beams: &'a [Vector2<f64>],
    /// Ranges in m: NaN where nothing is known, `range_max` or more where nothing was hit.
    pub ranges: &'a [f64],
    /// Least range in m; what reads less is taken to be there.
    pub range_min: f64,
    /// Largest range in m.
    pub range_max: f64,
}

impl Scan<'_> {
    /// Refuses a scan of another number of beams, or with a range that no beam reads.
    ///
    /// # Errors
    /// Names what is wrong.
    pub fn checked(self) -> Result<Self> {
        if self.ranges.len() != self.beams.len() {
            let rule = format!("have a range for each of {} beams", self.beams.len());
            return Err(Failure::invalid(
                "scan",
                rule,
                Given::Count(self.ranges.len() as u64),
            ));
        }
        for (beam, range) in self.ranges.iter().enumerate() {
            if *range < 0.0 {
                let rule =
                    "be at least 0, infinite where nothing is hit, and NaN where that is not known";
                return Err(Failure::invalid(
                    format!("scan[{beam}]"),
                    rule,
                    Given::Number(*range),
                ));
            }
        }
        self.pose.checked()?;
        Ok(self)
    }
}

/// A window of square cells around the robot, fixed to the frame of the odometry.
#[derive(Clone, Debug)]
pub struct RollingMap {
    options: MapOptions,
    size: usize,
    /// The cell at the lowest corner of the window.
    low: [i64; 2],
    evidence: Vec<Evidence>,
    /// Words of each row whose evidence changed since its reader asked, one bit each.
    changed: Vec<u16>,
    /// Set once the window was placed around the robot.
    placed: bool,
}

/// Counts of beams in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Evidence {
    pub(super) hits: f32,
    pub(super) passes: f32,
    /// Sum of the points that were hit, from the middle of the cell, in m.
    pub(super) sum: [f32; 2],
}

impl Evidence {
    /// Whether another beam that passes changes nothing: so many passed, and nothing was hit.
    #[inline]
    fn passed_for_long(&self) -> bool {
        self.passes == MOST_EVIDENCE && self.hits == 0.0
    }

    /// Scales evidence down that would be too much with another beam.
    #[inline]
    fn forget(&mut self) {
        let all = self.hits + self.passes;
        if all >= MOST_EVIDENCE {
            let share = (MOST_EVIDENCE - 1.0) / all;
            self.hits *= share;
            self.passes *= share;
            self.sum = self.sum.map(|axis| axis * share);
        }
    }
}

impl RollingMap {
    /// An empty map.
    ///
    /// # Errors
    /// An option is not allowed.
    pub fn new(options: MapOptions) -> Result<Self> {
        let options = options.checked()?;
        let half = (options.reach / options.cell).ceil() as usize + SLACK + 1;
        let size = (2 * half).div_ceil(WORD) * WORD;
        Ok(Self {
            options,
            size,
            low: [0; 2],
            evidence: vec![Evidence::default(); size * size],
            changed: vec![u16::MAX; size],
            placed: false,
        })
    }

    /// Size and rules.
    #[must_use]
    pub fn options(&self) -> &MapOptions {
        &self.options
    }

    /// Cells along a side.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// The cell at the lowest corner of the window, counted from the origin of the odometry.
    #[must_use]
    pub fn low(&self) -> [i64; 2] {
        self.low
    }

    pub(super) fn evidence(&self) -> &[Evidence] {
        &self.evidence
    }

    /// Lets everything be read again.
    pub(super) fn all_changed(&mut self) {
        self.changed.fill(u16::MAX);
    }

    /// Words of a row whose evidence changed since this was asked, one bit each.
    pub(super) fn take_changed(&mut self, row: usize) -> u16 {
        std::mem::take(&mut self.changed[row])
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.evidence.fill(Evidence::default());
        self.all_changed();
        self.placed = false;
    }

    /// Whether a place lies in the window.
    #[must_use]
    pub fn holds(&self, place: Vector2<f64>) -> bool {
        let most = self.size as f64;
        self.in_cells(place)
            .iter()
            .all(|axis| (0.0..most).contains(axis))
    }

    /// Coordinates in cells of the window.
    #[inline]
    pub(super) fn in_cells(&self, place: Vector2<f64>) -> [f64; 2] {
        [0, 1].map(|axis: usize| place[axis] / self.options.cell - self.low[axis] as f64)
    }

    /// Moves the window by whole cells so that the robot is near its middle. Returns whether it moved.
    pub fn follow(&mut self, place: Vector2<f64>) -> bool {
        let half = (self.size / 2) as i64;
        let cell = [0, 1].map(|axis: usize| (place[axis] / self.options.cell).floor() as i64);
        let off = [0, 1].map(|axis: usize| cell[axis] - self.low[axis] - half);
        if self.placed && off.iter().all(|axis| axis.unsigned_abs() as usize <= SLACK) {
            return false;
        }
        let low = [cell[0] - half, cell[1] - half];
        if self.placed {
            self.shift(off);
        }
        self.low = low;
        self.placed = true;
        true
    }

    /// Moves what is known by cells of the window; what leaves it is forgotten.
    fn shift(&mut self, by: [i64; 2]) {
        self.all_changed();
        let size = self.size as i64;
        if by.iter().any(|axis| axis.abs() >= size) {
            self.evidence.fill(Evidence::default());
            return;
        }
        let clip = |from: i64| from.clamp(0, size) as usize;
        let rows = self.size;
        let row_order: Vec<usize> = if by[1] >= 0 {
            (0..rows).collect()
        } else {
            (0..rows).rev().collect()
        };
        let (first, last) = (clip(by[0]), clip(size + by[0]));
        let (to_first, to_last) = (clip(-by[0]), clip(size - by[0]));
        for row in row_order {
            let begin = row * rows;
            let from = row as i64 + by[1];
            if (0..size).contains(&from) {
                let start = from as usize * rows;
                self.evidence
                    .copy_within(start + first..start + last, begin + to_first);
                self.evidence[begin..begin + to_first].fill(Evidence::default());
                self.evidence[begin + to_last..begin + rows].fill(Evidence::default());
            } else {
                self.evidence[begin..begin + rows].fill(Evidence::default());
            }
        }
    }

    /// Counts what lies under the outline, and up to a margin in m around it, as free: the robot stands there.
    pub fn stands(&mut self, footprint: &Footprint, pose: &Frame, margin: f64) {
        self.all_changed();
        let reach = footprint.outer_radius() + margin + self.options.cell;
        let most = self.size as f64 - 1.0;
        let bounds = [-reach, reach].map(|off| {
            let corner = pose.position + Vector2::new(off, off);
            self.in_cells(corner)
                .map(|axis| axis.clamp(0.0, most) as usize)
        });
        for row in bounds[0][1]..=bounds[1][1] {
            for column in bounds[0][0]..=bounds[1][0] {
                let middle = self.middle(column, row);
                if footprint.signed_distance(pose.inward(middle - pose.position)) <= margin {
                    let cell = &mut self.evidence[row * self.size + column];
                    cell.passes = cell.passes.max(GIVEN);
                }
            }
        }
    }

    /// Middle of a cell of the window in m.
    #[inline]
    pub(super) fn middle(&self, column: usize, row: usize) -> Vector2<f64> {
        let axis = |index: usize, low: i64| {
            (index as i64 + low) as f64 * self.options.cell + 0.5 * self.options.cell
        };
        Vector2::new(axis(column, self.low[0]), axis(row, self.low[1]))
    }

    /// Enters the readings of a scan, those within reach.
    ///
    /// # Errors
    /// The scan is not allowed, or was made outside of the window.
    pub fn enter(&mut self, scan: Scan<'_>) -> Result<()> {
        let scan = scan.checked()?;
        let reach = self.options.reach.min(scan.range_max);
        let from = self.in_cells(scan.pose.position);
        if !self.holds(scan.pose.position) {
            let rule = "be made within the window of the map";
            return Err(Failure::invalid(
                "scan",
                rule,
                Given::Pair(scan.pose.position.into()),
            ));
        }
        for (beam, range) in scan.beams.iter().zip(scan.ranges) {
            if range.is_nan() {
                continue;
            }
            let read = range.max(scan.range_min);
            let end = scan.pose.position + scan.pose.outward(*beam) * read.min(reach);
            let hit = *range < scan.range_max && read <= self.options.reach;
            self.beam(from, end, hit);
        }
        Ok(())
    }

    /// Enters a beam: cells before its end are passed, and the last is hit or left as it is.
    fn beam(&mut self, from: [f64; 2], end: Vector2<f64>, hit: bool) {
        let to = self.in_cells(end);
        let size = self.size as i64;
        let last = to.map(|axis| axis.floor() as i64);
        let (evidence, changed) = (&mut self.evidence[..], &mut self.changed[..]);
        walk(from, to, |[column, row]| {
            let inside = (column as u64) < size as u64 && (row as u64) < size as u64;
            if inside && [column, row] != last {
                let cell = &mut evidence[(row * size + column) as usize];
                if !cell.passed_for_long() {
                    cell.forget();
                    cell.passes += 1.0;
                    changed[row as usize] |= 1 << (column as usize / WORD);
                }
            }
        });
        if hit && last.iter().all(|axis| (0..size).contains(axis)) {
            let (column, row) = (last[0] as usize, last[1] as usize);
            let from_middle = end - self.middle(column, row);
            let cell = &mut self.evidence[row * self.size + column];
            cell.forget();
            cell.hits += 1.0;
            cell.sum[0] += from_middle.x as f32;
            cell.sum[1] += from_middle.y as f32;
            self.changed[row] |= 1 << (column / WORD);
        }
    }
}
