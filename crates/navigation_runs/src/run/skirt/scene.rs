//! Random layouts of discs: one on the course, the others anywhere.

use nalgebra::Vector2;

use navigation_world::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result, not_negative, positive};
use numeric::random::Stream;

/// Most places that are tried for a disc.
const MOST_TRIES: usize = 10_000;

/// How discs are laid out. The start is the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscSceneOptions {
    /// Number of discs, the one on the course included.
    pub obstacles: usize,
    /// Range of their radii, in m.
    pub radius: [f64; 2],
    /// Range of the distance of the first one along the course, in m.
    pub course_distance: [f64; 2],
    /// Its largest offset to either side, in m.
    pub course_offset: f64,
    /// The others lie within this of the start, in x and in y, in m.
    pub half_size: f64,
    /// Least gap between the robot at the start and the others, in m.
    pub start_clearance: f64,
    /// Least gap between discs, in m.
    pub spacing: f64,
    /// Share of the discs that are too low for the sensors.
    pub unseen_share: f64,
}

impl Default for DiscSceneOptions {
    fn default() -> Self {
        Self {
            obstacles: 8,
            radius: [0.05, 0.25],
            course_distance: [1.2, 2.0],
            course_offset: 0.3,
            half_size: 3.0,
            start_clearance: 0.8,
            spacing: 0.1,
            unseen_share: 0.0,
        }
    }
}

impl DiscSceneOptions {
    /// Returns the options if they are valid, for a robot of a radius in m.
    ///
    /// # Errors
    /// A number is out of range, or the disc on the course may touch the robot at the start.
    pub fn checked(self, chassis_radius: f64) -> Result<Self> {
        if self.obstacles == 0 {
            let given = Given::Count(0);
            return Err(Failure::invalid("obstacles", "be at least 1", given));
        }
        ascending("disc_radius", self.radius)?;
        ascending("course_distance", self.course_distance)?;
        not_negative("course_offset", self.course_offset)?;
        positive("half_size", self.half_size)?;
        not_negative("start_clearance", self.start_clearance)?;
        not_negative("spacing", self.spacing)?;
        if !(0.0..=1.0).contains(&self.unseen_share) {
            let given = Given::Number(self.unseen_share);
            let rule = "be a share from 0 to 1";
            return Err(Failure::invalid("unseen_share", rule, given));
        }
        if self.course_distance[0] <= chassis_radius + self.radius[1] {
            let given = Given::Pair(self.course_distance);
            let rule = "exceed the radii of robot and disc together";
            return Err(Failure::invalid("course_distance", rule, given));
        }
        Ok(self)
    }
}

fn ascending(name: &str, range: [f64; 2]) -> Result<()> {
    if range[0] > 0.0 && range[0] <= range[1] && range[1].is_finite() {
        return Ok(());
    }
    let rule = "be two finite positive numbers, the smaller one first";
    Err(Failure::invalid(name, rule, Given::Pair(range)))
}

/// Discs of one test.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscScene {
    /// The discs; the first one is on the course.
    pub discs: Vec<PlacedShape>,
    /// Whether the sensors can see them.
    pub seen: Vec<bool>,
}

impl DiscScene {
    /// Draws the discs of a test with a course at an angle in rad.
    ///
    /// # Errors
    /// There is no room for so many discs.
    pub fn draw(
        options: &DiscSceneOptions,
        chassis_radius: f64,
        course: f64,
        stream: &mut Stream,
    ) -> Result<Self> {
        let [least, most] = options.radius;
        let ahead = stream.uniform(options.course_distance[0], options.course_distance[1]);
        let aside = stream.uniform(-options.course_offset, options.course_offset);
        let (sin, cos) = course.sin_cos();
        let center = [ahead * cos - aside * sin, ahead * sin + aside * cos];
        let mut discs = vec![PlacedShape::disc(center, stream.uniform(least, most))];
        let mut seen = vec![stream.unit() >= options.unseen_share];
        let clear = chassis_radius + options.start_clearance;
        let mut tries = 0;
        while discs.len() < options.obstacles {
            let place = || -options.half_size;
            let center = [
                stream.uniform(place(), options.half_size),
                stream.uniform(place(), options.half_size),
            ];
            let disc = PlacedShape::disc(center, stream.uniform(least, most));
            let far = length(disc.center) - disc.shape.inner_radius() > clear;
            if far
                && discs
                    .iter()
                    .all(|other| gap(&disc, other) >= options.spacing)
            {
                discs.push(disc);
                seen.push(stream.unit() >= options.unseen_share);
                tries = 0;
            } else if tries == MOST_TRIES {
                let given = Given::Count(options.obstacles as u64);
                let rule = "leave room for each other";
                return Err(Failure::invalid("obstacles", rule, given));
            } else {
                tries += 1;
            }
        }
        Ok(Self { discs, seen })
    }
}

/// Distance between two discs, in m.
fn gap(disc: &PlacedShape, other: &PlacedShape) -> f64 {
    let between = disc.center - other.center;
    length(between) - disc.shape.inner_radius() - other.shape.inner_radius()
}

fn length(vector: Vector2<f64>) -> f64 {
    vector.dot(&vector).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{DiscScene, DiscSceneOptions, gap, length};
    use numeric::random::Stream;

    #[test]
    fn discs_lie_where_they_may() {
        let options = DiscSceneOptions::default().checked(0.33).unwrap();
        for index in 0..200 {
            let scene = DiscScene::draw(&options, 0.33, 1.0, &mut Stream::new(5, index)).unwrap();
            assert_eq!((scene.discs.len(), scene.seen.len()), (8, 8));
            let (sin, cos) = 1.0_f64.sin_cos();
            let [x, y]: [f64; 2] = scene.discs[0].center.into();
            assert!((1.2..=2.0).contains(&(x * cos + y * sin)));
            assert!((y * cos - x * sin).abs() <= 0.3 + 1e-12);
            for (place, disc) in scene.discs.iter().enumerate() {
                let radius = disc.shape.inner_radius();
                assert!((0.05..=0.25).contains(&radius));
                assert!(place == 0 || length(disc.center) - radius > 1.13);
                for other in &scene.discs[..place] {
                    assert!(gap(disc, other) >= 0.1);
                }
            }
        }
    }

    #[test]
    fn the_share_of_unseen_discs_changes_nothing_else() {
        let with = DiscSceneOptions {
            unseen_share: 0.4,
            ..DiscSceneOptions::default()
        };
        let mut hidden = 0;
        for index in 0..100 {
            let draw =
                |options| DiscScene::draw(options, 0.33, 0.0, &mut Stream::new(1, index)).unwrap();
            let (one, other) = (draw(&DiscSceneOptions::default()), draw(&with));
            assert_eq!(one.discs, other.discs);
            hidden += other.seen.iter().filter(|seen| !**seen).count();
        }
        assert!((250..390).contains(&hidden), "{hidden} of 800");
    }

    #[test]
    fn a_full_area_is_an_error_not_a_loop() {
        let crowded = DiscSceneOptions {
            obstacles: 500,
            ..DiscSceneOptions::default()
        };
        assert!(DiscScene::draw(&crowded, 0.33, 0.0, &mut Stream::new(0, 0)).is_err());
    }

    #[test]
    fn options_that_cannot_be_are_refused() {
        let base = DiscSceneOptions::default();
        for bad in [
            DiscSceneOptions {
                obstacles: 0,
                ..base
            },
            DiscSceneOptions {
                radius: [0.2, 0.1],
                ..base
            },
            DiscSceneOptions {
                unseen_share: 1.5,
                ..base
            },
            DiscSceneOptions {
                course_distance: [0.5, 2.0],
                ..base
            },
            DiscSceneOptions {
                half_size: f64::NAN,
                ..base
            },
        ] {
            assert!(bad.checked(0.33).is_err());
        }
    }
}
