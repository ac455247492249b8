//! Scenes of robots side by side, one a lane: where the obstacles of each are.

use crate::run::scene::World;
use navigation_world::world::geometry::Body;
use navigation_world::world::map::StaticMap;
use navigation_world::world::motion::{BodyState, Piece};
use navigation_world::world::obstacle::{Regions, Shape};
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::lanes::{Mask, Real, Truth, Vector2};

/// Most lanes.
const MOST_LANES: usize = 8;

/// Whether two scenarios may be side by side: everything but ways, seeds, and sizes and motions of
/// obstacles is the same.
pub(crate) fn agree(one: &Scenario, other: &Scenario) -> bool {
    if std::ptr::eq(one, other) {
        return true;
    }
    let box_at = |scenario: &Scenario, index: usize| {
        let placed = scenario.obstacles.get(index);
        placed.is_some_and(|placed| matches!(placed.obstacle.shape, Shape::Rectangle { .. }))
    };
    let most = one.obstacles.len().max(other.obstacles.len());
    same(one.map.as_ref(), other.map.as_ref())
        && same(one.walls.as_ref(), other.walls.as_ref())
        && one.robot == other.robot
        && one.differential == other.differential
        && one.rules == other.rules
        && one.measurement == other.measurement
        && (0..most).all(|index| box_at(one, index) == box_at(other, index))
}

fn same(one: Option<&StaticMap>, other: Option<&StaticMap>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => one.is(other),
        (one, other) => one.is_none() && other.is_none(),
    }
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

    /// The scenario of a lane.
    pub fn in_lane(&self, lane: usize) -> &'a Scenario {
        self.of[lane]
    }

    /// Gives a lane another scenario.
    pub fn enter(&mut self, lane: usize, scenario: &'a Scenario) {
        self.of[lane] = scenario;
    }
}

impl World for LaneScenes<'_> {
    fn common(&self) -> &Scenario {
        self.of[0]
    }

    fn of_lane(&self, lane: usize) -> &Scenario {
        self.of[lane]
    }
}

/// The obstacles of every lane that are looked at.
#[derive(Clone)]
pub(crate) struct LaneObstacles<R: Real> {
    /// Places of them in the lists of their scenarios.
    pub told: Vec<usize>,
    obstacles: Vec<LaneObstacle<R>>,
    pub bodies: Vec<Body<R>>,
}

impl<R: Real> LaneObstacles<R> {
    /// Obstacles of a scenario in every lane, with places for so many.
    pub fn all_in(scenario: &Scenario, count: usize) -> Self {
        let (obstacles, bodies) = (0..count).map(|_| LaneObstacle::absent()).unzip();
        let mut all = Self {
            told: (0..count).collect(),
            obstacles,
            bodies,
        };
        for lane in 0..R::WIDTH {
            all.enter(lane, scenario, false);
        }
        all
    }

    /// Gives a lane the obstacles of another scenario, or again those that it had, at the start of its run.
    pub fn enter(&mut self, lane: usize, scenario: &Scenario, again: bool) {
        let obstacles = self.obstacles.iter_mut().zip(&mut self.bodies);
        for (number, (obstacle, body)) in obstacles.enumerate() {
            // On its first piece of motion it is as it was.
            if !again || obstacle.index[lane] > 0 {
                obstacle.enter(lane, scenario.obstacles.get(number), body);
            }
        }
    }

    /// Brings the obstacles of some places to the instant of each lane, in s; time never runs back in
    /// a lane.
    #[inline(always)]
    pub fn place(&mut self, time: R, scenes: &LaneScenes<'_>, chosen: impl Fn(usize) -> bool) {
        let obstacles = self.obstacles.iter_mut().zip(&mut self.bodies);
        for (slot, ((obstacle, body), index)) in obstacles.zip(&self.told).enumerate() {
            if chosen(slot) {
                obstacle.place(time, (scenes, *index), &mut body.state);
            }
        }
    }

    /// Takes one in, as it is now.
    pub fn insert(&mut self, slot: usize, (index, placed): (usize, &PlacedObstacle), now: &Body) {
        let (mut obstacle, mut body) = LaneObstacle::absent();
        for lane in 0..R::WIDTH {
            obstacle.enter(lane, Some(placed), &mut body);
        }
        body.state = now.widened().state;
        self.told.insert(slot, index);
        self.obstacles.insert(slot, obstacle);
        self.bodies.insert(slot, body);
    }

    /// Forgets one.
    pub fn remove(&mut self, slot: usize) {
        self.told.remove(slot);
        self.obstacles.remove(slot);
        self.bodies.remove(slot);
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.told.clear();
        self.obstacles.clear();
        self.bodies.clear();
    }
}

/// How an obstacle moves in all lanes, until one of them takes another piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    Stands,
    Straight,
    Bends,
}

/// An obstacle of each lane. Where a lane has none it is absent, which adds nothing.
#[derive(Clone)]
struct LaneObstacle<R: Real> {
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
    /// How all lanes move for now.
    course: Course,
}

impl<R: Real> LaneObstacle<R> {
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
            course: Course::Stands,
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
            self.until.set(lane, f64::INFINITY);
            for axis in &mut self.piece.acceleration {
                axis.set(lane, 0.0);
            }
            self.settle(&mut body.state);
            return;
        };
        self.set_presence(lane, placed.obstacle.motion.presence());
        self.take_piece(lane, placed);
        while self.until.lane(lane) <= 0.0 {
            self.index[lane] += 1;
            self.take_piece(lane, placed);
        }
        self.turns = (0..R::WIDTH).any(|lane| self.until.lane(lane) < f64::INFINITY);
        body.shape.set_lane(lane, &placed.obstacle.shape);
        let (own, regions) = (placed.regions, &mut body.regions);
        regions.critical_radius.set(lane, own.critical_radius);
        regions.active_radius.set(lane, own.active_radius);
        self.settle(&mut body.state);
    }

    /// Writes down what changes with the pieces only.
    fn settle(&mut self, state: &mut BodyState<R>) {
        // A negative zero would not leave the sign of a velocity as it is.
        let zero = |axis: &R| (0..R::WIDTH).all(|lane| axis.lane(lane).to_bits() == 0);
        state.velocity = self.piece.velocity;
        self.course = Course::Bends;
        if self.piece.acceleration.iter().all(zero) {
            // As the pieces compute it, whatever the time.
            state.velocity = self.piece.velocity.map(|axis| axis + R::zero());
            self.course = Course::Straight;
            if state.velocity.iter().all(zero) {
                state.position = self.piece.position.map(|axis| axis + R::zero());
                self.course = Course::Stands;
            }
        }
        state.acceleration = self.piece.acceleration;
        if !self.leaves {
            state.present = R::Mask::splat(true);
        }
    }

    fn set_presence(&mut self, lane: usize, (from, to): (f64, f64)) {
        let (first, last) = &mut self.presence;
        first.set(lane, from);
        last.set(lane, to);
        let always = |lane| (first.lane(lane), last.lane(lane)) == ALWAYS;
        self.leaves = !(0..R::WIDTH).all(always);
    }

    fn take_piece(&mut self, lane: usize, placed: &PlacedObstacle) {
        let (own, until) = placed.obstacle.motion.piece(self.index[lane]);
        let piece = &mut self.piece;
        piece.start.set(lane, own.start);
        for axis in 0..2 {
            piece.position[axis].set(lane, own.position[axis]);
            piece.velocity[axis].set(lane, own.velocity[axis]);
            piece.acceleration[axis].set(lane, own.acceleration[axis]);
        }
        self.until.set(lane, until);
    }

    /// State of the obstacle of every lane at an instant of its own, in s; time never runs back in
    /// a lane.
    #[inline(always)]
    pub fn place(
        &mut self,
        time: R,
        (scenes, obstacle): (&LaneScenes<'_>, usize),
        state: &mut BodyState<R>,
    ) {
        if self.turns && self.until.le(time).any() {
            self.turn(time, (scenes, obstacle));
            self.settle(state);
        }
        match self.course {
            Course::Stands => {}
            Course::Straight => {
                let t = time - self.piece.start;
                for (axis, position) in state.position.iter_mut().enumerate() {
                    *position = self.piece.position[axis] + state.velocity[axis] * t;
                }
            }
            Course::Bends => self.bend(time, state),
        }
        if self.leaves {
            state.present = self.presence.0.le(time) & time.le(self.presence.1);
        }
    }

    /// State on a way that is not straight; a function of its own, or the compiler would write both ways
    /// number by number.
    #[inline(never)]
    fn bend(&self, time: R, state: &mut BodyState<R>) {
        (state.position, state.velocity) = self.piece.at(time);
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

/// The discs that the robots feel, close up: the first one of each lane, the second one, and so
/// on in their order. Lanes feel different ones, so that all of them together are more than those of
/// any lane.
#[derive(Clone)]
pub(crate) struct FeltObstacles<R: Real> {
    bodies: Vec<Body<R>>,
}

impl<R: Real> FeltObstacles<R> {
    /// Room for a number of obstacles.
    pub fn of_at_most(count: usize) -> Self {
        let absent = |_| LaneObstacle::absent().1;
        Self {
            bodies: (0..count).map(absent).collect(),
        }
    }

    /// Discs in whose active regions the robots of some lanes are.
    #[inline(always)]
    pub fn among(
        &mut self,
        bodies: &[Body<R>],
        position: Vector2<R>,
        lanes: R::Mask,
    ) -> &[Body<R>] {
        let (mut counts, mut most) = ([0; MOST_LANES], 0);
        for body in bodies {
            let reach = body.regions.active_radius;
            let squared = body.offset(position).distance_squared;
            let felt = squared.lt(reach * reach) & body.state.present & lanes;
            if !felt.any() {
                continue;
            }
            let mut left = felt.bits();
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                let own = &mut self.bodies[counts[lane]];
                if counts[lane] == most {
                    own.state.present = R::Mask::none();
                    most += 1;
                }
                copy_lane(own, body, lane);
                counts[lane] += 1;
            }
        }
        &self.bodies[..most]
    }
}

/// Makes the obstacle of a lane that of another body.
#[inline(always)]
fn copy_lane<R: Real>(to: &mut Body<R>, from: &Body<R>, lane: usize) {
    let copy = |to: &mut R, from: R| to.set(lane, from.lane(lane));
    for axis in 0..2 {
        copy(&mut to.state.position[axis], from.state.position[axis]);
        copy(&mut to.state.velocity[axis], from.state.velocity[axis]);
        let acceleration = from.state.acceleration[axis];
        copy(&mut to.state.acceleration[axis], acceleration);
    }
    copy(
        &mut to.regions.critical_radius,
        from.regions.critical_radius,
    );
    copy(&mut to.regions.active_radius, from.regions.active_radius);
    if let Shape::Disc { radius } = &mut to.shape {
        copy(radius, from.shape.inner_radius());
    }
    to.state.present.set(lane);
}

/// Presence of an obstacle that never comes or goes.
const ALWAYS: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::lanes::{Lanes, Number, Zero};

    /// An obstacle at (place, 0) in some lanes, felt within 1 m.
    fn body(place: f64, lanes: &[usize]) -> Body<Lanes<8>> {
        let mut body = LaneObstacle::absent().1;
        body.state.position[0] = Lanes::splat(place);
        body.regions.active_radius = Lanes::splat(1.0);
        for lane in lanes {
            body.state.present.set(*lane);
        }
        body
    }

    #[test]
    fn every_lane_has_the_obstacles_that_its_robot_feels_in_their_order() {
        let bodies = [
            body(0.1, &[0, 1]),
            body(5.0, &[0, 1, 2]),
            body(0.3, &[0, 2]),
        ];
        let position = Vector2::new(Lanes::zero(), Lanes::zero());
        let lanes = Lanes::<8>::splat(1.0).gt(Lanes::zero());
        let mut felt = FeltObstacles::of_at_most(bodies.len());
        for _ in 0..2 {
            let found = felt.among(&bodies, position, lanes);
            let places = |index: usize, lane: usize| found[index].state.position[0].lane(lane);
            assert_eq!(found.len(), 2);
            assert_eq!(found[0].state.present.bits(), 0b111);
            assert_eq!([0, 1, 2].map(|lane| places(0, lane)), [0.1, 0.1, 0.3]);
            assert_eq!(found[1].state.present.bits(), 0b001);
            assert_eq!(places(1, 0), 0.3);
        }
        let others = felt.among(&bodies, position, lanes.without(0));
        assert_eq!(others.len(), 1);
    }
}
