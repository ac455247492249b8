//! The obstacles that a law is told of which feels them from anywhere: all of them, or those that matter for
//! the velocities that it may choose.

use crate::lanes::{Lanes, Mask, Real, Vector2};
use crate::laws::outlook::{Attention, Discs, Outlook};
use crate::run::scene::body_at;
use crate::world::geometry::Body;
use crate::world::motion::Piece;
use crate::world::obstacle::Shape;
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Discs that are looked at side by side.
const GROUP: usize = 4;
type Group = Lanes<GROUP>;

/// The obstacles of one run.
#[derive(Clone, Debug)]
pub(crate) struct Relevant {
    /// Those that the law is told of, in their order, and as they are at the last sample.
    told: Vec<usize>,
    bodies: Vec<Body>,
    /// How those of them move that move straight on.
    straight: Vec<Option<Piece>>,
    /// Cursors of the motions of all obstacles.
    cursors: Vec<usize>,
    /// All obstacles, once they are chosen from.
    tracks: Tracks,
}

/// Straight motions of discs side by side: where they are at the start, velocities and radii. What is no disc, or
/// moves otherwise, has no number for its place.
#[derive(Clone, Debug, Default)]
struct Tracks {
    center: [Vec<f64>; 2],
    velocity: [Vec<f64>; 2],
    radius: Vec<f64>,
}

impl Relevant {
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            told: Vec::new(),
            bodies: Vec::new(),
            straight: Vec::new(),
            cursors: vec![0; scenario.obstacles.len()],
            tracks: Tracks::default(),
        }
    }

    /// The obstacles at an instant in s, those that the law attends to.
    pub fn at(&mut self, scenario: &Scenario, time: f64, attention: Attention) -> &[Body] {
        let all = scenario.obstacles.len();
        match attention {
            Attention::Within(outlook) => {
                if self.tracks.radius.is_empty() {
                    self.tracks = Tracks::of(&scenario.obstacles);
                }
                self.told.clear();
                let (tracks, told) = (&self.tracks, &mut self.told);
                pulp::Arch::new().dispatch(Choice {
                    tracks,
                    outlook: &outlook,
                    time,
                    told,
                });
                self.place(scenario, time);
            }
            Attention::All if self.told.len() < all => {
                self.told.clear();
                self.told.extend(0..all);
                self.place(scenario, time);
            }
            Attention::All | Attention::Same => self.advance(scenario, time),
        }
        &self.bodies
    }

    /// Looks at those anew that the law is told of from now on.
    fn place(&mut self, scenario: &Scenario, time: f64) {
        let cursors = &mut self.cursors;
        let body = |index: &usize| body_at(&scenario.obstacles[*index], time, &mut cursors[*index]);
        self.bodies.clear();
        self.bodies.extend(self.told.iter().map(body));
        let motion = |index: &usize| &scenario.obstacles[*index].obstacle.motion;
        let straight = |index: &usize| motion(index).straight().copied();
        self.straight.clear();
        self.straight.extend(self.told.iter().map(straight));
    }

    /// Moves on to an instant.
    fn advance(&mut self, scenario: &Scenario, time: f64) {
        let bodies = self.bodies.iter_mut().zip(&self.straight);
        for ((body, straight), index) in bodies.zip(&self.told) {
            if let Some(piece) = straight {
                (body.state.position, body.state.velocity) = piece.at(time);
                continue;
            }
            let placed = &scenario.obstacles[*index];
            if !placed.stationary {
                body.state = placed.obstacle.motion.at(time, &mut self.cursors[*index]);
            }
        }
    }
}

impl Tracks {
    fn of(obstacles: &[PlacedObstacle]) -> Self {
        let mut tracks = Self::default();
        for placed in obstacles {
            let ([x, y], [u, v], radius) = track(placed).unwrap_or(([f64::NAN; 2], [0.0; 2], 0.0));
            tracks.center[0].push(x);
            tracks.center[1].push(y);
            tracks.velocity[0].push(u);
            tracks.velocity[1].push(v);
            tracks.radius.push(radius);
        }
        tracks
    }

    /// Discs from one on, at an instant in s; the last one again where there are no more.
    #[inline(always)]
    fn group(&self, first: usize, time: f64) -> Discs<Group> {
        let last = self.radius.len() - 1;
        let number = |of: &[f64]| match of.get(first..first + GROUP) {
            Some(numbers) => Group::from_fn(|lane| numbers[lane]),
            None => Group::from_fn(|lane| of[(first + lane).min(last)]),
        };
        let pair = |[x, y]: &[Vec<f64>; 2]| Vector2::new(number(x), number(y));
        let velocity = pair(&self.velocity);
        Discs {
            center: pair(&self.center) + velocity * Group::splat(time),
            velocity,
            radius: number(&self.radius),
        }
    }
}

/// Place at the start, velocity and radius of a disc that moves straight on.
fn track(placed: &PlacedObstacle) -> Option<([f64; 2], [f64; 2], f64)> {
    let Shape::Disc { radius } = placed.obstacle.shape else {
        return None;
    };
    let piece = placed.obstacle.motion.straight()?;
    Some((piece.at(0.0).0, piece.velocity, radius))
}

/// Chooses the obstacles, compiled for the instructions of the processor; its bits are the same for all.
struct Choice<'a> {
    tracks: &'a Tracks,
    outlook: &'a Outlook,
    time: f64,
    told: &'a mut Vec<usize>,
}

impl pulp::NullaryFnOnce for Choice<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let count = self.tracks.radius.len();
        for first in (0..count).step_by(GROUP) {
            let concerned = self.outlook.concerns(&self.tracks.group(first, self.time));
            if concerned.any() {
                let lanes = 0..GROUP.min(count - first);
                let chosen = lanes.filter(|lane| concerned.lane(*lane));
                self.told.extend(chosen.map(|lane| first + lane));
            }
        }
    }
}
