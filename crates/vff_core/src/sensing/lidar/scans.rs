//! A lidar at work: what its scans tell a law.

use nalgebra::Vector2;
use numeric::random::Stream;

use super::{Lidar, boundary_points_of};
use crate::error::{Failure, Given, Result};
use crate::sensing::sensor::{RobotSensor, Sensor, Truth};
use crate::sensing::sonar::ranging::Normals;
use crate::world::frame::Frame;
use crate::world::geometry::Body;
use crate::world::map::MOST_POINTS;
use crate::world::motion::BodyState;
use crate::world::obstacle::{Obstacle, PlacedShape};
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Streams of the noise of lidars, counted up from here, above those of sonars.
const LIDAR_STREAM: u64 = (1 << 61) + (1 << 60);

/// A lidar at work.
pub(crate) struct Scans {
    options: Lidar,
    obstacles: Vec<PlacedObstacle>,
    reach: f64,
    noise: Normals,
    shapes: Vec<PlacedShape>,
    ranges: Vec<f64>,
    points: Vec<Vector2<f64>>,
    boundary: Vec<[f64; 2]>,
}

impl Scans {
    /// The lidar of a robot in a scenario, the one with an index among several.
    pub fn new(scenario: &Scenario, options: &Lidar, index: u64) -> Result<Self> {
        let options = options.clone().checked()?;
        let regions = options.regions(scenario)?;
        let placed = PlacedObstacle {
            obstacle: Obstacle::point(options.max_speed),
            regions,
            contact_distance: scenario.limits().radius,
            stationary: false,
            speed_bound: Some(options.max_speed),
        };
        Ok(Self {
            obstacles: vec![placed; MOST_POINTS],
            reach: options.reach.unwrap_or(regions.active_radius),
            noise: Normals::new(Stream::new(scenario.seed, LIDAR_STREAM + index)),
            shapes: Vec::with_capacity(scenario.obstacles.len()),
            ranges: Vec::with_capacity(options.beams),
            points: Vec::with_capacity(options.beams),
            boundary: Vec::with_capacity(MOST_POINTS),
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
        options.scan(&actual, &self.shapes, &mut self.noise, &mut self.ranges);
        self.tell(known, bodies);
    }
}

impl Scans {
    /// What a law can know of points.
    pub fn points(&self) -> &[PlacedObstacle] {
        &self.obstacles
    }

    /// Tells of a scan that was made elsewhere, in m.
    ///
    /// # Errors
    /// It has not one range for each beam, or one that no beam reads.
    pub fn read(&mut self, ranges: &[f64], known: &Frame, bodies: &mut [Body]) -> Result<()> {
        if ranges.len() != self.options.beams {
            let rule = format!("have a range for each of {} beams", self.options.beams);
            let given = Given::Count(ranges.len() as u64);
            return Err(Failure::invalid("scan", rule, given));
        }
        for (beam, range) in ranges.iter().enumerate() {
            // A beam that hits nothing may read infinity.
            if range.is_nan() || *range < 0.0 {
                let rule = "be at least 0, and infinite where nothing is hit";
                let name = format!("scan[{beam}]");
                return Err(Failure::invalid(&name, rule, Given::Number(*range)));
            }
        }
        self.ranges.clear();
        self.ranges.extend_from_slice(ranges);
        self.tell(known, bodies);
        Ok(())
    }

    /// Whether the last scan saw a place to be empty: beams go through the outline there, and none ends
    /// in or before the disc around it. Nothing is seen beyond the largest range.
    pub fn saw_empty(&self, pose: &Frame, placed: &PlacedShape) -> bool {
        let radius = placed.shape.extent();
        let around = PlacedShape::disc(placed.center.into(), radius);
        let mut through = false;
        for (beam, range) in self.ranges.iter().enumerate() {
            let (sin, cos) = self.options.bearing(beam).sin_cos();
            let along = pose.outward(Vector2::new(cos, sin));
            if !around.cast(pose.position, along).is_finite() {
                continue;
            }
            let far = (placed.center - pose.position).dot(&along) + radius;
            if range.min(self.options.range_max) < far {
                return false;
            }
            // A beam beside a rectangle, though in the disc around it, tells nothing of it.
            through |= placed.cast(pose.position, along).is_finite();
        }
        through
    }

    fn tell(&mut self, known: &Frame, bodies: &mut [Body]) {
        let options = &self.options;
        options.points(known, &self.ranges, &mut self.points);
        let (position, kappa) = (known.position, options.kappa);
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
