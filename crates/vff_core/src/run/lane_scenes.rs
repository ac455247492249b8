//! Scenes of robots side by side, one a lane: where the obstacles of each are.

use crate::lanes::{Mask, Real, Wide};
use crate::run::scene::World;
use crate::world::geometry::Body;
use crate::world::motion::{BodyState, Piece};
use crate::world::obstacle::{Regions, Shape};
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Most lanes.
const MOST_LANES: usize = 16;

/// Whether a scenario may share its lanes with others: its obstacles are discs, which are known
/// exactly, and nothing else is around. Rectangles, maps and measurements take the kernel of one scene.
pub(crate) fn fits(scenario: &Scenario) -> bool {
    let disc = |placed: &PlacedObstacle| matches!(placed.obstacle.shape, Shape::Disc { .. });
    let alone = scenario.measurement.is_none() && scenario.map.is_none();
    alone && scenario.obstacles.iter().all(disc)
}

/// Whether two scenarios may be side by side: everything but ways and obstacles is the same.
pub(crate) fn agree(one: &Scenario, other: &Scenario) -> bool {
    one.robot == other.robot && one.differential == other.differential && one.rules == other.rules
}

/// The scenarios of the lanes.
#[derive(Clone, Copy)]
pub(crate) struct LaneScenes<'a> {
    of: [&'a Scenario; MOST_LANES],
}

impl<'a> LaneScenes<'a> {
    /// All lanes in one scenario, whose robot and rules are those of all that follow.
    pub fn all_in(scenario: &'a Scenario) -> Self {
        Self {
            of: [scenario; MOST_LANES],
        }
    }

    /// A scenario with the robot and the rules of all.
    pub fn of_first(&self) -> &'a Scenario {
        self.of[0]
    }

    /// Gives a lane another scenario.
    pub fn enter(&mut self, lane: usize, scenario: &'a Scenario) {
        self.of[lane] = scenario;
    }

    /// A number of an obstacle in every lane, `padded` where a lane has no such obstacle.
    fn of_obstacle<R: Real>(
        &self,
        obstacle: usize,
        padded: f64,
        number: impl Fn(&PlacedObstacle) -> f64,
    ) -> R {
        let placed = |lane: usize| self.of[lane].obstacles.get(obstacle);
        R::from_fn(|lane| placed(lane).map_or(padded, &number))
    }
}

impl<R: Real + Wide<R>> World<R> for LaneScenes<'_> {
    type Number = R;

    fn common(&self) -> &Scenario {
        self.of[0]
    }

    fn of_lane(&self, lane: usize) -> &Scenario {
        self.of[lane]
    }

    fn reach(&self, obstacle: usize) -> R {
        self.of_obstacle(obstacle, 0.0, |placed| placed.contact_distance)
    }

    fn speed_bound(&self, obstacle: usize) -> R {
        let bound = |placed: &PlacedObstacle| placed.speed_bound.unwrap_or(f64::INFINITY);
        self.of_obstacle(obstacle, 0.0, bound)
    }

    /// Only searches ask, which run many gain sets in one scene.
    fn stands_from(&self) -> f64 {
        f64::INFINITY
    }
}

/// An obstacle of each lane. Where a lane has none it is absent, which adds nothing.
#[derive(Clone)]
pub(crate) struct LaneObstacle<R: Real> {
    /// Index of the piece of motion of each lane, and the piece.
    index: [usize; MOST_LANES],
    piece: Piece<R>,
    /// When the next piece of each lane begins, in s; infinite after the last one.
    until: R,
    /// First and last instant of presence, in s.
    presence: (R, R),
    /// Whether any lane ever takes another piece, and whether any is ever absent.
    turns: bool,
    leaves: bool,
}

impl<R: Real + Wide<R>> LaneObstacle<R> {
    /// Absent in every lane, and its body.
    pub fn absent() -> (Self, Body<R>) {
        let zero = [R::zero(); 2];
        let obstacle = Self {
            index: [0; MOST_LANES],
            piece: Piece {
                start: R::zero(),
                position: zero,
                velocity: zero,
                acceleration: zero,
            },
            until: R::splat(f64::INFINITY),
            presence: (R::splat(f64::INFINITY), R::splat(f64::NEG_INFINITY)),
            turns: false,
            leaves: true,
        };
        let body = Body {
            shape: Shape::Disc { radius: R::zero() },
            regions: Regions {
                critical_radius: R::zero(),
                active_radius: R::zero(),
            },
            state: BodyState {
                position: zero,
                velocity: zero,
                acceleration: zero,
                present: R::Mask::none(),
            },
        };
        (obstacle, body)
    }

    /// Gives a lane another obstacle, or none, at the start of its run.
    pub fn enter(&mut self, lane: usize, placed: Option<&PlacedObstacle>, body: &mut Body<R>) {
        self.index[lane] = 0;
        let Some(placed) = placed else {
            self.set_presence(lane, (f64::INFINITY, f64::NEG_INFINITY));
            self.until = self.until.replace(lane, f64::INFINITY);
            return;
        };
        self.set_presence(lane, placed.obstacle.motion.presence());
        self.take_piece(lane, placed);
        while self.until.lane(lane) <= 0.0 {
            self.index[lane] += 1;
            self.take_piece(lane, placed);
        }
        self.turns = (0..R::WIDTH).any(|lane| self.until.lane(lane) < f64::INFINITY);
        let radius = placed.obstacle.shape.inner_radius();
        let radius = body.shape.inner_radius().replace(lane, radius);
        body.shape = Shape::Disc { radius };
        let (own, regions) = (placed.regions, &mut body.regions);
        regions.critical_radius = regions.critical_radius.replace(lane, own.critical_radius);
        regions.active_radius = regions.active_radius.replace(lane, own.active_radius);
    }

    fn set_presence(&mut self, lane: usize, (from, to): (f64, f64)) {
        let (first, last) = &mut self.presence;
        (*first, *last) = (first.replace(lane, from), last.replace(lane, to));
        let always = |lane| (first.lane(lane), last.lane(lane)) == ALWAYS;
        self.leaves = !(0..R::WIDTH).all(always);
    }

    fn take_piece(&mut self, lane: usize, placed: &PlacedObstacle) {
        let (own, until) = placed.obstacle.motion.piece(self.index[lane]);
        let piece = &mut self.piece;
        piece.start = piece.start.replace(lane, own.start);
        for axis in 0..2 {
            piece.position[axis] = piece.position[axis].replace(lane, own.position[axis]);
            piece.velocity[axis] = piece.velocity[axis].replace(lane, own.velocity[axis]);
            piece.acceleration[axis] =
                piece.acceleration[axis].replace(lane, own.acceleration[axis]);
        }
        self.until = self.until.replace(lane, until);
    }

    /// State of the obstacle of every lane at an instant of its own, in s; time never runs back in
    /// a lane.
    #[inline(always)]
    pub fn place(&mut self, time: R, (scenes, obstacle): (&LaneScenes<'_>, usize)) -> BodyState<R> {
        if self.turns && self.until.le(time).any() {
            self.turn(time, (scenes, obstacle));
        }
        let (position, velocity) = self.piece.at(time);
        let present = if self.leaves {
            self.presence.0.le(time) & time.le(self.presence.1)
        } else {
            R::Mask::splat(true)
        };
        BodyState {
            position,
            velocity,
            acceleration: self.piece.acceleration,
            present,
        }
    }

    /// Takes the pieces that have begun.
    #[cold]
    fn turn(&mut self, time: R, (scenes, obstacle): (&LaneScenes<'_>, usize)) {
        for lane in 0..R::WIDTH {
            while self.until.lane(lane) <= time.lane(lane) {
                let Some(placed) = scenes.of[lane].obstacles.get(obstacle) else {
                    break;
                };
                self.index[lane] += 1;
                self.take_piece(lane, placed);
            }
        }
    }
}

/// Presence of an obstacle that never comes or goes.
const ALWAYS: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
