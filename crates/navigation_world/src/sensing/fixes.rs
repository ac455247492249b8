//! An ear: range and bearing of a source of sound once per burst.

use nalgebra::Vector2;

use crate::sensing::sensor::{Sensor, Truth};
use crate::sensing::sonar::ranging::Normals;
use crate::world::frame::Frame;
use crate::world::geometry::Body;
use numeric::error::{Failure, Given, Result, finite, not_negative, positive};
use numeric::random::Stream;

/// Scatter of range and bearing on a grid of range and bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct FixNoise {
    ranges: Vec<f64>,
    bearings: Vec<f64>,
    /// Standard deviations (m, rad), ranges by rows.
    deviations: Vec<[f64; 2]>,
}

/// Ranges of Table 2 of Avi (2019), in m.
const TABLE_RANGES: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

/// Bearings of the table, in degrees.
const TABLE_BEARINGS: [f64; 3] = [0.0, 30.0, 60.0];

/// Standard deviations of the table: range in m, bearing in degrees.
const TABLE: [[(f64, f64); 3]; 4] = [
    [(0.02, 0.08), (0.03, 0.20), (0.07, 0.20)],
    [(0.05, 0.05), (0.08, 0.34), (0.13, 0.54)],
    [(0.09, 0.15), (0.12, 0.35), (0.37, 0.66)],
    [(0.48, 1.12), (0.20, 2.27), (0.43, 2.40)],
];

impl Default for FixNoise {
    /// Table 2 of Avi (2019).
    fn default() -> Self {
        let cells = TABLE.iter().flatten();
        Self {
            ranges: TABLE_RANGES.to_vec(),
            bearings: TABLE_BEARINGS.map(f64::to_radians).to_vec(),
            deviations: cells
                .map(|(range, degrees)| [*range, degrees.to_radians()])
                .collect(),
        }
    }
}

impl FixNoise {
    /// Scatter on a grid: `deviations` in m and rad, ranges by rows.
    ///
    /// # Errors
    /// A grid does not ascend, its size is not that of the deviations, or one of those is negative.
    pub fn new(ranges: Vec<f64>, bearings: Vec<f64>, deviations: Vec<[f64; 2]>) -> Result<Self> {
        for (name, grid) in [("ranges", &ranges), ("bearings", &bearings)] {
            for value in grid {
                finite(name, *value)?;
            }
            if grid.is_empty() || !grid.is_sorted_by(|one, next| one < next) {
                let given = Given::Count(grid.len() as u64);
                let rule = "ascend and hold at least one number";
                return Err(Failure::invalid(name, rule, given));
            }
        }
        if deviations.len() != ranges.len() * bearings.len() {
            let given = Given::Count(deviations.len() as u64);
            let rule = "hold one pair for each range and bearing";
            return Err(Failure::invalid("deviations", rule, given));
        }
        for deviation in deviations.iter().flatten() {
            not_negative("deviations", *deviation)?;
        }
        Ok(Self {
            ranges,
            bearings,
            deviations,
        })
    }

    /// Scatter with all deviations times a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let scaled = |each: &[f64; 2]| each.map(|one| factor * one);
        Self {
            deviations: self.deviations.iter().map(scaled).collect(),
            ..self
        }
    }

    /// No scatter at all.
    #[must_use]
    pub fn none() -> Self {
        Self {
            ranges: vec![1.0],
            bearings: vec![0.0],
            deviations: vec![[0.0; 2]],
        }
    }

    /// Standard deviations of range in m and bearing in rad: bilinear in range and size of the
    /// bearing, those of the edge outside the grid.
    #[must_use]
    pub fn at(&self, range: f64, bearing: f64) -> [f64; 2] {
        let (row, down) = place(&self.ranges, range);
        let (column, right) = place(&self.bearings, bearing.abs());
        let width = self.bearings.len();
        let next_row = (row + 1).min(self.ranges.len() - 1);
        let next_column = (column + 1).min(width - 1);
        std::array::from_fn(|which| {
            let cell = |row: usize, column: usize| self.deviations[row * width + column][which];
            let upper = cell(row, column) * (1.0 - right) + cell(row, next_column) * right;
            let lower =
                cell(next_row, column) * (1.0 - right) + cell(next_row, next_column) * right;
            upper * (1.0 - down) + lower * down
        })
    }
}

/// Cell of a value in an ascending grid, and where in the cell it is, from 0 to 1.
fn place(grid: &[f64], value: f64) -> (usize, f64) {
    let above = grid.partition_point(|edge| *edge <= value);
    if above == 0 {
        return (0, 0.0);
    }
    if above == grid.len() {
        return (above - 1, 0.0);
    }
    let (low, high) = (grid[above - 1], grid[above]);
    (above - 1, (value - low) / (high - low))
}

/// When and how well the source is heard.
#[derive(Clone, Debug, PartialEq)]
pub struct Fixes {
    /// Time between two bursts, in s.
    pub interval: f64,
    /// Scatter of range and bearing.
    pub noise: FixNoise,
    /// A source behind the microphones is taken for one in front: three microphones in a row
    /// cannot tell.
    pub mirrored: bool,
}

impl Default for Fixes {
    fn default() -> Self {
        Self {
            interval: 2.0,
            noise: FixNoise::default(),
            mirrored: false,
        }
    }
}

impl Fixes {
    /// Returns the numbers if they are valid.
    ///
    /// # Errors
    /// The interval is not positive.
    pub fn checked(self) -> Result<Self> {
        positive("fix_interval", self.interval)?;
        Ok(self)
    }

    /// Range in m and direction (unit vector, forward and left) of a source at an offset in m in
    /// the axes of the robot.
    pub fn fix(&self, offset: Vector2<f64>, normals: &mut Normals) -> (f64, Vector2<f64>) {
        let forward = if self.mirrored {
            offset.x.abs()
        } else {
            offset.x
        };
        let range = (forward * forward + offset.y * offset.y).sqrt();
        let bearing = offset.y.atan2(forward);
        let [range_deviation, bearing_deviation] = self.noise.at(range, bearing);
        let range = range + range_deviation * normals.draw();
        let (sin, cos) = (bearing + bearing_deviation * normals.draw()).sin_cos();
        (range, Vector2::new(cos, sin))
    }
}

/// A source as it was heard, from the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heard {
    /// Range in m.
    pub range: f64,
    /// Unit vector toward it, forward and left.
    pub direction: Vector2<f64>,
}

/// Microphones on a robot, which locate the source at every burst.
#[derive(Clone, Debug)]
pub struct Ear {
    fixes: Fixes,
    normals: Normals,
    /// Samples from one burst to the next, and those left.
    between: usize,
    left: usize,
    heard: Option<Heard>,
}

impl Ear {
    /// With scatter from a stream, sampled with a period in s; the first sample is a burst.
    #[must_use]
    pub fn new(fixes: &Fixes, period: f64, scatter: Stream) -> Self {
        let between = (fixes.interval / period).round().max(1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
        let between = between as usize;
        Self {
            fixes: fixes.clone(),
            normals: Normals::new(scatter),
            between,
            left: 0,
            heard: None,
        }
    }

    /// The source, if a burst was heard at the last sample.
    #[inline]
    #[must_use]
    pub fn heard(&self) -> Option<Heard> {
        self.heard
    }

    /// Hears a source in m, if there is one, at a sample of a robot that knows its frame.
    #[inline]
    pub fn listen(&mut self, source: Option<Vector2<f64>>, known: &Frame) {
        self.heard = None;
        if self.left > 0 {
            self.left -= 1;
            return;
        }
        self.left = self.between - 1;
        self.heard = source.map(|source| self.fix(source, known));
    }

    fn fix(&mut self, source: Vector2<f64>, known: &Frame) -> Heard {
        let offset = known.inward(source - known.position);
        let (range, direction) = self.fixes.fix(offset, &mut self.normals);
        Heard { range, direction }
    }
}

impl Sensor for Ear {
    #[inline]
    fn observe(&mut self, truth: &Truth<'_>, known: &Frame, _bodies: &mut [Body]) {
        self.listen(truth.source, known);
    }
}
