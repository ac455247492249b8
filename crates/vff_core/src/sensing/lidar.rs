//! A 2-D lidar: exact ranges to a map and to what moves, and the boundary points that a law sees.

use nalgebra::Vector2;
use numeric::error::at_most;
use numeric::random::Stream;

use crate::error::{Failure, Given, Result, not_negative, positive};
use crate::sensing::sensor::{Sensor, Truth};
use crate::sensing::sonar::ranging::Normals;
use crate::world::frame::Frame;
use crate::world::geometry::Body;
use crate::world::map::{Beyond, MOST_POINTS, StaticMap, checked_kappa};
use crate::world::motion::{BodyState, Motion};
use crate::world::obstacle::{Limits, Obstacle, PlacedShape, Regions, Shape};
use crate::world::region::{self, Sensing};
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Most beams of a scan.
pub const MOST_BEAMS: usize = 100_000;
/// Streams of the noise of lidars, counted up from here, above those of sonars.
const LIDAR_STREAM: u64 = (1 << 61) + (1 << 60);
/// Force laws brake this near to a boundary point beyond the radius of the robot, in m.
const AT_THE_WALL: f64 = 0.001;

/// A lidar on a robot, and what a law is told of its scans.
///
/// A beam reads `range_max` where nothing is hit, and zero inside of something or nearer than
/// `range_min`.
#[derive(Clone, Debug, PartialEq)]
pub struct Lidar {
    /// What stands still.
    pub map: StaticMap,
    /// Number of beams.
    pub beams: usize,
    /// Angle between the first and the last beam in rad, ahead in its middle; a whole turn is
    /// divided evenly.
    pub field_of_view: f64,
    /// Least range in m.
    pub range_min: f64,
    /// Largest range in m.
    pub range_max: f64,
    /// Standard deviation of a range in m.
    pub range_noise: f64,
    /// Whether it sees the obstacles of the scene, too.
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
            field_of_view: std::f64::consts::TAU,
            range_min: 0.0,
            range_max: 10.0,
            range_noise: 0.0,
            sees_obstacles: true,
            kappa: 0.5,
            influence: 0.3,
            reach: None,
            max_speed: 0.0,
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
        if !(self.field_of_view > 0.0 && self.field_of_view <= std::f64::consts::TAU) {
            let rule = "be above 0 and at most a whole turn, 2 pi rad";
            let given = Given::Number(self.field_of_view);
            return Err(Failure::invalid("field_of_view", rule, given));
        }
        not_negative("range_min", self.range_min)?;
        positive("range_max", self.range_max)?;
        if self.range_max <= self.range_min {
            let given = Given::Number(self.range_max);
            return Err(Failure::invalid("range_max", "be above range_min", given));
        }
        not_negative("range_noise", self.range_noise)?;
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
        let whole = self.field_of_view >= std::f64::consts::TAU;
        let gaps = if whole { self.beams } else { self.beams - 1 };
        if gaps == 0 {
            return 0.0;
        }
        (beam as f64 / gaps as f64 - 0.5) * self.field_of_view
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

    /// Ranges of all beams from a pose, in m, with noise.
    pub fn scan(
        &self,
        pose: &Frame,
        shapes: &[PlacedShape],
        noise: &mut Normals,
        ranges: &mut Vec<f64>,
    ) {
        ranges.clear();
        for beam in 0..self.beams {
            let (sin, cos) = self.bearing(beam).sin_cos();
            let along = pose.outward(Vector2::new(cos, sin));
            let exact = self.range(pose.position, along, shapes);
            let hit = exact > 0.0 && exact < self.range_max;
            ranges.push(if self.range_noise > 0.0 && hit {
                self.reading(exact + self.range_noise * noise.draw())
            } else {
                exact
            });
        }
    }

    /// What the lidar shows for a noisy distance: it has no ranges beyond its ends.
    fn reading(&self, noisy: f64) -> f64 {
        if noisy < self.range_min {
            0.0
        } else {
            noisy.min(self.range_max)
        }
    }

    /// Points in the world that a scan hit, as a robot knows them that takes itself to be at a
    /// pose; what is too near to be measured is taken to be at the least range.
    pub fn points(&self, pose: &Frame, ranges: &[f64], points: &mut Vec<Vector2<f64>>) {
        points.clear();
        for (beam, range) in ranges.iter().enumerate() {
            if *range < self.range_max {
                let (sin, cos) = self.bearing(beam).sin_cos();
                let along = Vector2::new(cos, sin) * range.max(self.range_min);
                points.push(pose.position + pose.outward(along));
            }
        }
    }

    /// Regions of a boundary point for the robot of a scenario: at the wall and `influence` ahead
    /// of it, or sized for the largest speed of what is seen.
    ///
    /// # Errors
    /// As [`region::radii`].
    pub fn regions(&self, scenario: &Scenario) -> Result<Regions> {
        let limits = scenario.limits();
        if self.max_speed == 0.0 {
            return Ok(Regions {
                critical_radius: limits.radius + AT_THE_WALL,
                active_radius: limits.radius + self.influence,
            });
        }
        let (point, period) = (self.point(), scenario.control_period());
        region::radii(&limits, &point, period, None, &Sensing::default())
    }

    /// What a boundary point is taken for.
    fn point(&self) -> Obstacle {
        Obstacle {
            shape: Shape::Disc { radius: 0.0 },
            motion: Motion::at_rest([0.0; 2]),
            limits: Limits {
                max_speed: Some(self.max_speed),
                ..Limits::default()
            },
        }
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
            obstacle: options.point(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots::HolonomicRobot;
    use crate::world::map::MapShapes;
    use crate::world::scenario::Rules;

    fn room() -> StaticMap {
        let mut shapes = MapShapes::new();
        let corners = [
            [-2.0, -1.0],
            [2.0, -1.0],
            [2.0, 1.0],
            [-2.0, 1.0],
            [-2.0, -1.0],
        ];
        shapes.polyline(&corners, 0.0).unwrap();
        shapes.map()
    }

    fn scan(lidar: &Lidar, pose: &Frame, shapes: &[PlacedShape]) -> Vec<f64> {
        let mut ranges = Vec::new();
        let mut noise = Normals::new(Stream::new(1, 2));
        lidar.scan(pose, shapes, &mut noise, &mut ranges);
        ranges
    }

    #[test]
    fn four_beams_of_a_turn_look_along_the_axes() {
        let lidar = Lidar {
            map: room(),
            beams: 4,
            range_max: 1.5,
            ..Lidar::default()
        };
        let ranges = scan(&lidar, &Frame::at([0.0, 0.0], 0.0), &[]);
        // Behind, right, ahead, left; the ends of the room are out of range.
        assert_eq!(ranges.len(), 4);
        for (range, expected) in ranges.iter().zip([1.5, 1.0, 1.5, 1.0]) {
            assert!((range - expected).abs() < 1e-12);
        }
        let turned = scan(
            &lidar,
            &Frame::at([0.0, 0.5], std::f64::consts::FRAC_PI_2),
            &[],
        );
        for (range, expected) in turned.iter().zip([1.5, 1.5, 0.5, 1.5]) {
            assert!((range - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn people_hide_walls_and_the_inside_reads_zero() {
        let narrow = Lidar {
            map: room(),
            beams: 3,
            field_of_view: 1.0,
            range_min: 0.2,
            ..Lidar::default()
        };
        let person = [PlacedShape::disc([1.0, 0.0], 0.3)];
        let ranges = scan(&narrow, &Frame::at([0.0, 0.0], 0.0), &person);
        assert!((ranges[1] - 0.7).abs() < 1e-12);
        assert!((ranges[0] - 1.0 / 0.5_f64.sin()).abs() < 1e-12);
        assert_eq!(ranges[0], ranges[2]);
        let inside = scan(&narrow, &Frame::at([0.9, 0.0], 0.0), &person);
        assert_eq!(inside, [0.0; 3]);
        let near = scan(&narrow, &Frame::at([0.6, 0.0], 0.0), &person);
        assert_eq!(near[1], 0.0);
    }

    #[test]
    fn points_of_a_dense_scan_are_boundary_points_of_the_map() {
        let lidar = Lidar {
            map: room(),
            beams: 3600,
            ..Lidar::default()
        };
        let pose = Frame::at([1.3, 0.4], 0.3);
        let ranges = scan(&lidar, &pose, &[]);
        let (mut points, mut seen, mut exact) = (Vec::new(), Vec::new(), Vec::new());
        lidar.points(&pose, &ranges, &mut points);
        boundary_points_of(&points, pose.position, 2.0, 0.5, &mut seen);
        lidar
            .map
            .boundary_points(pose.position, 2.0, 0.5, &mut exact);
        assert_eq!(seen.len(), exact.len());
        for (seen, exact) in seen.iter().zip(&exact) {
            assert!((Vector2::from(*seen) - Vector2::from(*exact)).norm() < 5e-3);
        }
    }

    #[test]
    fn a_reading_of_zero_hides_no_other_point() {
        let place = Vector2::new(1.0, 0.0);
        let points = [place, Vector2::new(1.5, 0.0)];
        let mut seen = Vec::new();
        boundary_points_of(&points, place, 1.0, 0.5, &mut seen);
        assert_eq!(seen, [[1.5, 0.0]]);
        boundary_points_of(&points[..1], place, 1.0, 0.5, &mut seen);
        assert!(seen.is_empty());
    }

    #[test]
    fn noise_has_its_deviation_and_other_beams_read_as_before() {
        let lidar = Lidar {
            map: room(),
            beams: 2000,
            range_max: 1.8,
            range_noise: 0.02,
            ..Lidar::default()
        };
        let exact = Lidar {
            range_noise: 0.0,
            ..lidar.clone()
        };
        let pose = Frame::at([0.0, 0.0], 0.0);
        let pairs = scan(&lidar, &pose, &[])
            .into_iter()
            .zip(scan(&exact, &pose, &[]));
        let (mut squares, mut hits) = (0.0, 0.0);
        for (noisy, exact) in pairs {
            if exact < 1.7 {
                squares += (noisy - exact).powi(2);
                hits += 1.0;
            } else if exact == 1.8 {
                assert_eq!(noisy, 1.8);
            }
        }
        let deviation = f64::sqrt(squares / hits);
        assert!(
            hits > 500.0 && (deviation - 0.02).abs() < 0.002,
            "{deviation}"
        );
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        for (lidar, name) in [
            (
                Lidar {
                    beams: 0,
                    ..Lidar::default()
                },
                "beams",
            ),
            (
                Lidar {
                    beams: MOST_BEAMS + 1,
                    ..Lidar::default()
                },
                "beams",
            ),
            (
                Lidar {
                    field_of_view: 7.0,
                    ..Lidar::default()
                },
                "field_of_view",
            ),
            (
                Lidar {
                    range_min: 20.0,
                    ..Lidar::default()
                },
                "range_max",
            ),
            (
                Lidar {
                    kappa: 0.0,
                    ..Lidar::default()
                },
                "kappa",
            ),
            (
                Lidar {
                    kappa: f64::NAN,
                    ..Lidar::default()
                },
                "kappa",
            ),
            (
                Lidar {
                    range_noise: -1.0,
                    ..Lidar::default()
                },
                "range_noise",
            ),
        ] {
            let message = lidar.checked().unwrap_err().to_string();
            assert!(message.starts_with(name), "{message}");
        }
    }

    #[test]
    fn a_rectangle_is_gone_only_where_beams_would_have_hit_it() {
        let options = Lidar {
            beams: 91,
            field_of_view: std::f64::consts::FRAC_PI_2,
            range_max: 20.0,
            ..Lidar::default()
        };
        let pose = Frame::at([0.0, 0.0], 0.0);
        let mut scans = Scans::new(&empty_floor(), &options, 0).unwrap();
        scans.read(&[f64::INFINITY; 91], &pose, &mut []).unwrap();
        // Along the left edge of the view, and all of it beyond: only the disc around it is in view.
        let gate =
            |center: [f64; 2]| PlacedShape::turned(center, [4.0, 0.1], std::f64::consts::FRAC_PI_4);
        assert!(!scans.saw_empty(&pose, &gate([3.0, 3.5])));
        assert!(scans.saw_empty(&pose, &gate([3.5, 0.5])));
        assert!(!scans.saw_empty(&pose, &gate([19.0, 0.5])));
    }

    fn empty_floor() -> Scenario {
        let (robot, rules) = (HolonomicRobot::default(), Rules::default());
        Scenario::new(robot, [0.0; 2], [9.0, 0.0], Vec::new(), rules).unwrap()
    }
}
