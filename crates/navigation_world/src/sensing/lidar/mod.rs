//! A 2-D lidar: exact ranges to a map and to what moves, and the boundary points that a law sees.

mod scans;

use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;
use numeric::random::Stream;

use crate::sensing::scanner::Scanner;
use crate::sensing::sensor::{RobotSensor, Sensor};
use crate::sensing::sonar::ranging::Normals;
use crate::world::frame::Frame;
use crate::world::map::{Beyond, MOST_POINTS, StaticMap, checked_kappa};
use crate::world::obstacle::{Obstacle, PlacedShape, Regions};
use crate::world::region::{self, Sensing};
use crate::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result, at_most, finite, not_negative, positive};

pub use scans::Scans;

/// Most beams of a scan.
pub const MOST_BEAMS: usize = 100_000;
/// Longest latency in s: it bounds the memory of scans.
const MAX_LATENCY: f64 = 5.0;
/// Force laws brake this near to a boundary point beyond the radius of the robot, in m.
const AT_THE_WALL: f64 = 0.001;
/// Streams of dropouts are so far above those of noise.
const DROPOUTS: u64 = 1 << 59;
/// Distance along its beam in m of a reading of zero: at the robot itself it would have no
/// direction, and no law would see it.
const NEAREST: f64 = 1e-9;

/// A lidar on a robot, and what a law is told of its scans.
///
/// A beam reads `range_max` where nothing is hit, zero inside of something or nearer than
/// `range_min`, and NaN where it drops out. Poses are those of the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Lidar {
    /// Static map.
    pub map: StaticMap,
    /// Number of beams.
    pub beams: usize,
    /// Pose on the robot, in m.
    pub mounting: Frame,
    /// Angle between the first and the last beam in rad; a whole turn is divided evenly.
    pub field_of_view: f64,
    /// Bearing of the first beam in rad; without it straight ahead is the middle of all.
    pub angle_min: Option<f64>,
    /// Least range in m.
    pub range_min: f64,
    /// Largest range in m.
    pub range_max: f64,
    /// Standard deviation of a range in m.
    pub range_noise: f64,
    /// Probability with which a beam reads nothing at all.
    pub dropout: f64,
    /// Age of scans when they arrive, in s.
    pub latency: f64,
    /// Set for a lidar that sees the obstacles of the scene, too.
    pub sees_obstacles: bool,
    /// Share `kappa` behind which points are left out.
    pub kappa: f64,
    /// Depth of the active region of a boundary point beyond the radius of the robot, in m.
    pub influence: f64,
    /// How far from the robot boundary points are told of, in m: the active region by default.
    pub reach: Option<f64>,
    /// Largest speed of what is seen, in m/s; above zero the regions are sized for it.
    pub max_speed: f64,
}

impl Default for Lidar {
    fn default() -> Self {
        Self {
            map: StaticMap::default(),
            beams: 360,
            mounting: Frame::at([0.0; 2], 0.0),
            field_of_view: TAU,
            angle_min: None,
            range_min: 0.0,
            range_max: 10.0,
            range_noise: 0.0,
            dropout: 0.0,
            latency: 0.0,
            sees_obstacles: true,
            kappa: 0.5,
            influence: 0.3,
            reach: None,
            max_speed: 0.0,
        }
    }
}

/// Noise of the ranges of a lidar, and what its dropouts are drawn from.
#[derive(Clone, Debug)]
pub struct ScanNoise {
    ranges: Normals,
    dropouts: Stream,
}

impl ScanNoise {
    /// Noise of a seed, from a stream of it.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        Self {
            ranges: Normals::new(Stream::new(seed, stream)),
            dropouts: Stream::new(seed, stream + DROPOUTS),
        }
    }
}

impl Lidar {
    /// Returns the lidar if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    pub fn checked(self) -> Result<Self> {
        if self.beams == 0 {
            return Err(Failure::invalid("beams", "be at least 1", Given::Count(0)));
        }
        at_most("beams", self.beams, MOST_BEAMS)?;
        if !(self.field_of_view > 0.0 && self.field_of_view <= TAU) {
            let rule = "be above 0 and at most a whole turn, 2 pi rad";
            let given = Given::Number(self.field_of_view);
            return Err(Failure::invalid("field_of_view", rule, given));
        }
        self.mounting
            .checked()
            .map_err(|error| error.within("mounting"))?;
        if let Some(first) = self.angle_min {
            finite("angle_min", first)?;
        }
        if !(0.0..=1.0).contains(&self.dropout) {
            let rule = "be a probability, from 0 to 1";
            return Err(Failure::invalid(
                "dropout",
                rule,
                Given::Number(self.dropout),
            ));
        }
        not_negative("range_min", self.range_min)?;
        positive("range_max", self.range_max)?;
        if self.range_max <= self.range_min {
            let given = Given::Number(self.range_max);
            return Err(Failure::invalid("range_max", "be above range_min", given));
        }
        not_negative("range_noise", self.range_noise)?;
        if not_negative("latency", self.latency)? > MAX_LATENCY {
            let rule = format!("be at most {MAX_LATENCY} s");
            return Err(Failure::invalid(
                "latency",
                rule,
                Given::Number(self.latency),
            ));
        }
        checked_kappa(self.kappa)?;
        positive("influence", self.influence)?;
        if let Some(reach) = self.reach {
            positive("reach", reach)?;
        }
        not_negative("max_speed", self.max_speed)?;
        Ok(self)
    }

    /// Bearing of a beam from straight ahead, in rad.
    #[must_use]
    pub fn bearing(&self, beam: usize) -> f64 {
        let whole = self.field_of_view >= TAU;
        let gaps = if whole { self.beams } else { self.beams - 1 };
        let Some(first) = self.angle_min else {
            if gaps == 0 {
                return 0.0;
            }
            return (beam as f64 / gaps as f64 - 0.5) * self.field_of_view;
        };
        first + beam as f64 / gaps.max(1) as f64 * self.field_of_view
    }

    /// Direction of a beam in the frame of the lidar.
    fn along(&self, beam: usize) -> Vector2<f64> {
        let (sin, cos) = self.bearing(beam).sin_cos();
        Vector2::new(cos, sin)
    }

    /// The beam that looks nearest to a point in the world from a pose; `None` outside the field of view.
    fn beam_toward(&self, robot: &Frame, point: Vector2<f64>) -> Option<usize> {
        let pose = robot.carrying(&self.mounting);
        let whole = self.field_of_view >= TAU;
        let gaps = if whole { self.beams } else { self.beams - 1 };
        let seen = pose.inward(point - pose.position);
        let mut bearing = seen.y.atan2(seen.x);
        if let Some(first) = self.angle_min {
            let middle = if gaps == 0 {
                first
            } else {
                first + 0.5 * self.field_of_view
            };
            bearing = (bearing - middle + PI).rem_euclid(TAU) - PI;
        }
        let place = (bearing / self.field_of_view + 0.5) * gaps as f64;
        if gaps == 0 {
            return (bearing.abs() <= 0.5 * self.field_of_view).then_some(0);
        }
        let within = place >= -0.5 && place <= gaps as f64 + 0.5;
        // The last beam of a whole turn is beside the first.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        within.then(|| place.round().max(0.0) as usize % self.beams)
    }

    /// Exact range of a beam along a unit vector among shapes that move, in m.
    #[must_use]
    pub fn range(&self, from: Vector2<f64>, along: Vector2<f64>, shapes: &[PlacedShape]) -> f64 {
        let wall = self.map.ray_up_to(from, along, self.range_max);
        let nearest = shapes.iter().map(|shape| shape.cast(from, along));
        let distance = nearest.fold(wall, f64::min);
        if distance < self.range_min {
            0.0
        } else {
            distance.min(self.range_max)
        }
    }

    /// Ranges of all beams from a pose, in m, with noise and dropouts.
    pub fn scan(
        &self,
        robot: &Frame,
        shapes: &[PlacedShape],
        noise: &mut ScanNoise,
        ranges: &mut Vec<f64>,
    ) {
        let pose = robot.carrying(&self.mounting);
        ranges.clear();
        for beam in 0..self.beams {
            if self.dropout > 0.0 && noise.dropouts.unit() < self.dropout {
                ranges.push(f64::NAN);
                continue;
            }
            let along = pose.outward(self.along(beam));
            let exact = self.range(pose.position, along, shapes);
            let hit = exact > 0.0 && exact < self.range_max;
            ranges.push(if self.range_noise > 0.0 && hit {
                self.reading(exact + self.range_noise * noise.ranges.draw())
            } else {
                exact
            });
        }
    }

    /// Reading of the lidar for a noisy distance: it has no ranges beyond its ends.
    fn reading(&self, noisy: f64) -> f64 {
        if noisy < self.range_min {
            0.0
        } else {
            noisy.min(self.range_max)
        }
    }

    /// Points in the world that a scan hit, as a robot knows them that takes itself to be at a
    /// pose; what is too near to be measured is taken to be at the least range.
    pub fn points(&self, robot: &Frame, ranges: &[f64], points: &mut Vec<Vector2<f64>>) {
        let pose = robot.carrying(&self.mounting);
        points.clear();
        for (beam, range) in ranges.iter().enumerate() {
            if *range < self.range_max {
                let along = self.along(beam) * range.max(self.range_min).max(NEAREST);
                points.push(pose.position + pose.outward(along));
            }
        }
    }
}

impl Lidar {
    /// Mounting, beams and ranges with which the scans of this lidar are read.
    #[must_use]
    pub fn scanner(&self) -> Scanner {
        Scanner {
            mounting: self.mounting,
            bearings: (0..self.beams).map(|beam| self.bearing(beam)).collect(),
            range_min: self.range_min,
            range_max: self.range_max,
        }
    }

    /// The lidar in an empty place, without errors.
    #[must_use]
    pub fn ideal_without_map(&self) -> Self {
        Self {
            map: StaticMap::default(),
            range_noise: 0.0,
            dropout: 0.0,
            latency: 0.0,
            ..self.clone()
        }
    }

    /// Regions of what it reads: at the wall and `influence` ahead of it, or sized for the largest speed of what is seen.
    ///
    /// # Errors
    /// Errors of [`region::radii`].
    pub fn regions(&self, scenario: &Scenario) -> Result<Regions> {
        let limits = scenario.limits();
        if self.max_speed == 0.0 {
            return Ok(Regions {
                critical_radius: limits.radius + AT_THE_WALL,
                active_radius: limits.radius + self.influence,
            });
        }
        let (point, period) = (Obstacle::point(self.max_speed), scenario.control_period());
        region::radii(&limits, &point, period, None, &Sensing::default())
    }
}

impl RobotSensor for Lidar {
    fn at_work(&self, scenario: &Scenario, index: u64) -> Result<Box<dyn Sensor>> {
        Ok(Box::new(Scans::new(scenario, self, index)?))
    }

    fn sight(&self, scenario: &Scenario) -> Result<Option<(Regions, f64)>> {
        let off = self.mounting.position.norm();
        Ok(Some((
            self.regions(scenario)?,
            (self.range_max - off).max(0.0),
        )))
    }
}

/// Boundary points among the points of a scan, as [`StaticMap::boundary_points`] of points.
pub fn boundary_points_of(
    points: &[Vector2<f64>],
    position: Vector2<f64>,
    reach: f64,
    kappa: f64,
    out: &mut Vec<[f64; 2]>,
) {
    out.clear();
    let mut beyond = Beyond::default();
    while out.len() < MOST_POINTS {
        let mut nearest: Option<(f64, Vector2<f64>)> = None;
        for point in points {
            let square = (point - position).norm_squared();
            let nearer = nearest.is_none_or(|(least, _)| square < least);
            // A point at the center of the robot is in no direction, and hides no other.
            let within = square > 0.0 && square <= reach * reach;
            if within && nearer && !beyond.hide(*point) {
                nearest = Some((square, *point));
            }
        }
        let Some((_, point)) = nearest else {
            return;
        };
        out.push(point.into());
        beyond.drop_behind(position, point, kappa);
    }
}

#[cfg(test)]
mod tests;
