//! Differences between the episodes of an environment: where people start and where they go.

use numeric::random::Stream;

use crate::crowd::neighbors::circle;
use crate::crowd::world::{CrowdWorld, Waypoint};
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Vector2;

type Point = Vector2<f64>;

/// Streams of seeds of episodes, and of places; those of a world count from other numbers.
const EPISODES: u64 = 101 << 48;
const PLACES: u64 = 102 << 48;

/// Most draws of a place.
const MOST_DRAWS: usize = 100_000;

/// A rectangle in which people start anywhere without touching.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// Lower left corner of the centers, in m.
    pub low: [f64; 2],
    /// Upper right corner of the centers, in m.
    pub high: [f64; 2],
    /// Whether people walk along x, each at his own height.
    pub level: bool,
}

/// How an episode is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layout {
    /// All start where the world says; what it draws itself, speeds and sources, differs.
    Fixed,
    /// Starts and goals are drawn on a circle, see [`circle`].
    Circle,
    /// Starts are drawn.
    Area(Area),
}

/// Seed of the world of an episode; that of the first one is the seed itself.
#[must_use]
pub fn seed_of(seed: u64, episode: u64) -> u64 {
    if episode == 0 {
        return seed;
    }
    Stream::new(seed, EPISODES | episode).bits()
}

impl Layout {
    /// Draws the places of a world from its seed.
    ///
    /// # Errors
    /// There is no room for everybody.
    pub fn draw(&self, world: &mut CrowdWorld) -> Result<()> {
        match self {
            Self::Fixed => Ok(()),
            Self::Circle => draw_circle(world),
            Self::Area(area) => area.draw(world, &mut Stream::new(world.seed, PLACES)),
        }
    }
}

fn no_room(person: usize) -> Failure {
    Failure::invalid(
        "layout",
        format!("have room for people[{person}]"),
        Given::Found(format!("no free place in {MOST_DRAWS} draws").into()),
    )
    .mended_by("take fewer or smaller people, or a larger layout")
}

/// Draws starts and goals on the circle.
fn draw_circle(world: &mut CrowdWorld) -> Result<()> {
    let starts = circle::starts(world.seed, world.people.len());
    if starts.len() < world.people.len() {
        return Err(no_room(starts.len()));
    }
    for (drawn, start) in world.people.iter_mut().zip(starts) {
        drawn.start = start;
        let goal = start.map(std::ops::Neg::neg);
        drawn.traits.route.points.clear();
        drawn.traits.route.points.push(Waypoint::Point(goal));
    }
    Ok(())
}

impl Area {
    fn draw(&self, world: &mut CrowdWorld, stream: &mut Stream) -> Result<()> {
        for person in 0..world.people.len() {
            let mut draws = 0;
            let start = loop {
                let start = Point::new(
                    stream.uniform(self.low[0], self.high[0]),
                    stream.uniform(self.low[1], self.high[1]),
                );
                if is_clear(world, person, start) {
                    break start;
                }
                draws += 1;
                if draws == MOST_DRAWS {
                    return Err(no_room(person));
                }
            };
            let drawn = &mut world.people[person];
            drawn.start = start.into();
            if self.level {
                for point in &mut drawn.traits.route.points {
                    if let Waypoint::Point(point) = point {
                        point[1] = start.y;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Whether a person at a place touches no robot and nobody before.
fn is_clear(world: &CrowdWorld, person: usize, start: Point) -> bool {
    let radius = world.people[person].traits.radius;
    let apart = |place: [f64; 2], other: f64| {
        world.period.wrap(Point::from(place) - start).norm() >= radius + other
    };
    let others = world.people[..person].iter();
    world
        .robots
        .iter()
        .all(|robot| apart(robot.start, robot.radius()))
        && others
            .clone()
            .all(|other| apart(other.start, other.traits.radius))
}
