//! A lidar at work: what its scans tell a law.

use std::collections::VecDeque;

use nalgebra::Vector2;

use super::{Lidar, ScanNoise, boundary_points_of};
use crate::sensing::scanner::Scanner;
use crate::sensing::sensor::{LidarScan, Sensor, Truth};
use crate::world::frame::Frame;
use crate::world::geometry::Body;
use crate::world::map::MOST_POINTS;
use crate::world::motion::BodyState;
use crate::world::obstacle::{Obstacle, PlacedShape};
use crate::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::{Failure, Given, Result};

/// Streams of the noise of lidars, counted up from here, above those of sonars.
const LIDAR_STREAM: u64 = (1 << 61) + (1 << 60);

/// Most ranges of scans that have not arrived.
const MOST_WAITING: f64 = 1e7;
/// Rounding of instants in s.
const ROUNDING: f64 = 1e-9;

/// A lidar at work.
pub struct Scans {
    options: Lidar,
    scanner: Scanner,
    obstacles: Vec<PlacedObstacle>,
    reach: f64,
    noise: ScanNoise,
    shapes: Vec<PlacedShape>,
    ranges: Vec<f64>,
    /// When the last scan that arrived was made, in s.
    scanned: f64,
    /// Scans that have not arrived, with instant in s and pose of the robot as it knew it.
    late: VecDeque<(f64, Frame, Vec<f64>)>,
    points: Vec<Vector2<f64>>,
    boundary: Vec<[f64; 2]>,
    /// Points of scans that were told, with their instants in s.
    told: Vec<(Vector2<f64>, f64)>,
    /// When each point that a law is told of was scanned, in s.
    instants: Vec<f64>,
    /// How many beams of the last scan that was told read nothing at all.
    unknown: usize,
}

impl Scans {
    /// The lidar of a robot in a scenario, the one with an index among several.
    ///
    /// # Errors
    /// An option is out of range in this scenario.
    pub fn new(scenario: &Scenario, options: &Lidar, index: u64) -> Result<Self> {
        let options = options.clone().checked()?;
        let regions = options.regions(scenario)?;
        let waiting = (options.latency / scenario.control_period()).ceil() * options.beams as f64;
        if waiting > MOST_WAITING {
            let rule = format!(
                "be so short that at most {MOST_WAITING} ranges wait, with its beams and the control period"
            );
            return Err(Failure::invalid(
                "latency",
                rule,
                Given::Number(options.latency),
            ));
        }
        let placed = PlacedObstacle {
            obstacle: Obstacle::point(options.max_speed),
            regions,
            contact_distance: scenario.limits().radius,
            stationary: false,
            speed_bound: Some(options.max_speed),
        };
        Ok(Self {
            scanner: options.scanner(),
            obstacles: vec![placed; MOST_POINTS],
            reach: options.reach.unwrap_or(regions.active_radius),
            noise: ScanNoise::new(scenario.seed, LIDAR_STREAM + index),
            shapes: Vec::with_capacity(scenario.obstacles.len()),
            ranges: Vec::with_capacity(options.beams),
            scanned: f64::NEG_INFINITY,
            late: VecDeque::new(),
            points: Vec::with_capacity(options.beams),
            boundary: Vec::with_capacity(MOST_POINTS),
            told: Vec::new(),
            instants: Vec::new(),
            unknown: 0,
            options,
        })
    }
}

impl Sensor for Scans {
    fn obstacles(&self) -> Option<&[PlacedObstacle]> {
        Some(&self.obstacles)
    }

    fn observe(&mut self, truth: &Truth<'_>, known: &Frame, bodies: &mut [Body]) {
        self.shapes.clear();
        if self.options.sees_obstacles {
            let present = truth.bodies.iter().filter(|body| body.state.present);
            self.shapes.extend(present.map(|body| PlacedShape {
                center: body.state.position.into(),
                shape: body.shape,
            }));
        }
        let actual = truth.frame();
        let options = &self.options;
        let mut ranges = if options.latency > 0.0 {
            Vec::with_capacity(options.beams)
        } else {
            std::mem::take(&mut self.ranges)
        };
        options.scan(&actual, &self.shapes, &mut self.noise, &mut ranges);
        if options.latency > 0.0 {
            self.late.push_back((truth.time, *known, ranges));
            let arrived = truth.time - options.latency + ROUNDING;
            let Some((scanned, pose, ranges)) = newest(&mut self.late, arrived) else {
                return self.tell(known, bodies);
            };
            (self.scanned, self.ranges) = (scanned, ranges);
            self.hit(&pose);
        } else {
            (self.scanned, self.ranges) = (truth.time, ranges);
            self.hit(known);
        }
        self.tell(known, bodies);
    }

    fn scan(&self) -> Option<LidarScan<'_>> {
        Some(LidarScan {
            scanner: &self.scanner,
            time: self.scanned,
            ranges: &self.ranges,
        })
    }
}

/// The last scan that was made until a time in s; those before it are dropped.
fn newest(
    late: &mut VecDeque<(f64, Frame, Vec<f64>)>,
    until: f64,
) -> Option<(f64, Frame, Vec<f64>)> {
    let mut found = None;
    while late.front().is_some_and(|(made, ..)| *made <= until) {
        found = late.pop_front();
    }
    found
}

impl Scans {
    /// Points of the scan that has arrived, made at a pose of the robot.
    fn hit(&mut self, pose: &Frame) {
        if self.options.dropout > 0.0 {
            self.keep(self.scanned, pose);
        } else {
            self.options.points(pose, &self.ranges, &mut self.points);
        }
    }

    /// Points as a law can know them.
    #[must_use]
    pub fn points(&self) -> &[PlacedObstacle] {
        &self.obstacles
    }

    /// When each point that a law is told of was scanned, in s.
    #[must_use]
    pub fn instants(&self) -> &[f64] {
        &self.instants
    }

    /// Ends of the beams of a scan from a pose, in m; those that read nothing, or something too near, end where they
    /// begin.
    pub fn ends(&self, pose: &Frame, ranges: &[f64], ends: &mut Vec<[f64; 2]>) {
        let options = &self.options;
        ends.extend(ranges.iter().enumerate().map(|(beam, range)| {
            let (sin, cos) = options.bearing(beam).sin_cos();
            let known = if range.is_nan() {
                0.0
            } else {
                range.min(options.range_max)
            };
            <[f64; 2]>::from(pose.position + pose.outward(Vector2::new(cos, sin) * known))
        }));
    }

    /// How many beams of the last scan that was told read nothing at all.
    #[must_use]
    pub fn unknown(&self) -> usize {
        self.unknown
    }

    /// Tells of a scan that was made elsewhere at a time in s; ranges in m, NaN where it is not known whether
    /// anything was hit. What was seen there before stays, as old as it is, until another beam looks there.
    ///
    /// # Errors
    /// It has not one range for each beam, or one that no beam reads.
    pub fn read(
        &mut self,
        ranges: &[f64],
        time: f64,
        known: &Frame,
        bodies: &mut [Body],
    ) -> Result<()> {
        if ranges.len() != self.options.beams {
            let rule = format!("have a range for each of {} beams", self.options.beams);
            let given = Given::Count(ranges.len() as u64);
            return Err(Failure::invalid("scan", rule, given));
        }
        for (beam, range) in ranges.iter().enumerate() {
            // A beam that hits nothing may read infinity.
            if *range < 0.0 {
                let rule =
                    "be at least 0, infinite where nothing is hit, and NaN where that is not known";
                let name = format!("scan[{beam}]");
                return Err(Failure::invalid(&name, rule, Given::Number(*range)));
            }
        }
        self.ranges.clear();
        self.ranges.extend_from_slice(ranges);
        self.keep(time, known);
        self.tell(known, bodies);
        let instants = self.boundary.iter().map(|point| {
            let same = |told: &&(Vector2<f64>, f64)| <[f64; 2]>::from(told.0) == *point;
            self.told.iter().find(same).map_or(time, |told| told.1)
        });
        self.instants = instants.collect();
        Ok(())
    }

    /// Points of a scan made at a time in s; where a beam reads nothing at all, what was seen there before stays.
    fn keep(&mut self, time: f64, known: &Frame) {
        self.unknown = self.ranges.iter().filter(|range| range.is_nan()).count();
        let kept = self.still_unknown(known);
        let options = &self.options;
        options.points(known, &self.ranges, &mut self.points);
        self.told.clear();
        self.told
            .extend(self.points.iter().map(|point| (*point, time)));
        self.told.extend(kept);
        self.points.clear();
        self.points
            .extend(self.told.iter().map(|(point, _)| *point));
    }

    /// The nearest point that was told of before, for each beam that reads nothing now.
    fn still_unknown(&self, pose: &Frame) -> Vec<(Vector2<f64>, f64)> {
        if self.unknown == 0 {
            return Vec::new();
        }
        let mut kept: Vec<Option<(Vector2<f64>, f64)>> = vec![None; self.ranges.len()];
        let from = pose.carrying(&self.options.mounting).position;
        let away = |point: Vector2<f64>| (point - from).norm_squared();
        for told in &self.told {
            let beam = self.options.beam_toward(pose, told.0);
            let Some(beam) = beam.filter(|beam| self.ranges[*beam].is_nan()) else {
                continue;
            };
            let place = &mut kept[beam];
            if place.is_none_or(|other| away(told.0) < away(other.0)) {
                *place = Some(*told);
            }
        }
        kept.into_iter().flatten().collect()
    }

    /// Whether the last scan saw a place to be empty: beams go through the outline there, and none ends
    /// in or before the disc around it. Nothing is seen beyond the largest range.
    #[must_use]
    pub fn saw_empty(&self, robot: &Frame, placed: &PlacedShape) -> bool {
        let pose = robot.carrying(&self.options.mounting);
        let radius = placed.shape.extent();
        let around = PlacedShape::disc(placed.center.into(), radius);
        let mut through = false;
        for (beam, range) in self.ranges.iter().enumerate() {
            let along = pose.outward(self.options.along(beam));
            if !around.cast(pose.position, along).is_finite() {
                continue;
            }
            let far = (placed.center - pose.position).dot(&along) + radius;
            // Who reads nothing has not seen that nobody is there.
            if range.is_nan() || range.min(self.options.range_max) < far {
                return false;
            }
            // A beam beside a rectangle, though in the disc around it, tells nothing of it.
            through |= placed.cast(pose.position, along).is_finite();
        }
        through
    }

    fn tell(&mut self, known: &Frame, bodies: &mut [Body]) {
        let (position, kappa) = (known.position, self.options.kappa);
        boundary_points_of(
            &self.points,
            position,
            self.reach,
            kappa,
            &mut self.boundary,
        );
        for (index, body) in bodies.iter_mut().enumerate() {
            let point = self.boundary.get(index).copied();
            body.state = BodyState {
                position: point.unwrap_or(position.into()),
                velocity: [0.0; 2],
                acceleration: [0.0; 2],
                present: point.is_some(),
            };
        }
    }
}
