//! Surroundings of the follower: obstacles and the leader, as functions of time.

use navigation_world::world::motion::Motion;
use navigation_world::world::obstacle::{Obstacle, Shape};
use numeric::error::{Result, finite_pair, positive};

/// The source of the sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Leader {
    /// Motion of the body.
    pub motion: Motion,
    /// Its shape if the sensors see it.
    pub shape: Option<Shape>,
}

impl Leader {
    /// A source that stays.
    #[must_use]
    pub fn standing(position: [f64; 2]) -> Self {
        Self {
            motion: Motion::at_rest(position),
            shape: None,
        }
    }

    /// From a place to another at a speed in m/s, where it stays.
    ///
    /// # Errors
    /// A number is not finite, or the speed is not positive though the places differ.
    pub fn going(start: [f64; 2], end: [f64; 2], speed: f64) -> Result<Self> {
        finite_pair("leader.start", start)?;
        finite_pair("leader.end", end)?;
        let way = [end[0] - start[0], end[1] - start[1]];
        let length = way[0].hypot(way[1]);
        if length == 0.0 {
            return Ok(Self::standing(start));
        }
        positive("leader.speed", speed)?;
        let share = speed / length;
        let velocity = way.map(|part| share * part);
        Ok(Self {
            motion: Motion::between(start, velocity, [0.0, length / speed])?,
            shape: None,
        })
    }
}

/// Everything around the follower, which starts at the origin and looks along x.
#[derive(Clone, Debug, PartialEq)]
pub struct FollowerScene {
    /// Source of the sound.
    pub leader: Leader,
    /// Obstacles.
    pub obstacles: Vec<Obstacle>,
    /// How long it is watched, in s.
    pub duration: f64,
}
