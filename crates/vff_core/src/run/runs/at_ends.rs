//! Far obstacles, side by side, that the robot was nearest to where it began or ended, or soon after it began: its
//! mean velocities tell.

use super::dormant::Bound;
use super::means::Means;
use super::path::{Path, straight_disc};
use crate::lanes::{Lanes, Mask, Real, Vector2};
use crate::run::options::Clock;
use crate::world::motion::Piece;
use crate::world::scenario::PlacedObstacle;

/// Obstacles that are looked at side by side.
const GROUP: usize = 4;
type Group = Lanes<GROUP>;

/// A path that has been measured, past obstacles of which some have been left alone on all of it.
pub(super) struct AtEnds<'a> {
    pub path: &'a Path,
    pub clock: &'a Clock,
    pub means: &'a Means,
    pub obstacles: &'a [PlacedObstacle],
    /// First motion step of each whose distance is not counted yet.
    pub since: &'a [usize],
    pub bounds: &'a [Bound],
    /// Those whose least distance is known, with its square in m^2.
    pub found: &'a mut Vec<(usize, f64)>,
}

impl AtEnds<'_> {
    /// Finds the least distances that are at an end or in the head; compiled for the instructions of the processor,
    /// its bits are the same for all.
    pub fn find(self) {
        pulp::Arch::new().dispatch(self);
    }

    /// Obstacles as seen from the robot after a motion step.
    #[inline(always)]
    fn sees(&self, motion: &Piece<Group>, step: usize) -> Vector2<Group> {
        let ([x, y], _) = motion.at(Group::splat(self.clock.time(step)));
        let place = self.path.at(step);
        Vector2::new(Group::splat(place.x) - x, Group::splat(place.y) - y)
    }

    #[inline(always)]
    fn find_in_group(&mut self, first: usize) {
        let count = GROUP.min(self.obstacles.len() - first);
        // In place of what is no disc that moves straight on, or was not left alone, there is no number.
        let mut numbers = [[f64::NAN; GROUP]; 6];
        for lane in 0..count {
            let index = first + lane;
            if self.since[index] == self.path.first() + 1
                && let Some(piece) = straight_disc(&self.obstacles[index])
            {
                let ([x, y], [u, v]) = (piece.position, piece.velocity);
                let own = [x, y, u, v, piece.start, self.bounds[index].margin];
                for (number, own) in numbers.iter_mut().zip(own) {
                    number[lane] = own;
                }
            }
        }
        let number = [
            group_of(&numbers[0]),
            group_of(&numbers[1]),
            group_of(&numbers[2]),
            group_of(&numbers[3]),
            group_of(&numbers[4]),
            group_of(&numbers[5]),
        ];
        let [x, y, u, v, start, margin] = number;
        let motion = Piece {
            start,
            position: [x, y],
            velocity: [u, v],
            acceleration: [Group::splat(0.0); 2],
        };
        let ends = [
            self.sees(&motion, self.path.first()),
            self.sees(&motion, self.path.last()),
        ];
        let step = Group::splat(self.clock.step);
        let way = Vector2::new(u * step, v * step);
        let settled = self.means.nearest_at_an_end(ends, way, margin);
        let [begin, end] = ends.map(|end| end.dot(&end));
        self.note((first, count), settled, begin.min(end));
        let open = !settled;
        if !open.any() {
            return;
        }
        let head = self.sees(&motion, self.path.head());
        let early = open & self.means.nearest_in_the_head(head, way, margin);
        if early.any() {
            let mut least = begin;
            for step in self.path.first() + 1..=self.path.head() {
                let seen = self.sees(&motion, step);
                least = least.min(seen.dot(&seen));
            }
            self.note((first, count), early, least);
        }
    }

    /// Notes the least distances of some lanes.
    #[inline(always)]
    fn note(
        &mut self,
        (first, count): (usize, usize),
        known: <Group as Real>::Mask,
        squared: Group,
    ) {
        if known.any() {
            let lanes = (0..count).filter(|lane| known.lane(*lane));
            self.found
                .extend(lanes.map(|lane| (first + lane, squared.lane(lane))));
        }
    }
}

#[inline(always)]
fn group_of(numbers: &[f64; GROUP]) -> Group {
    Group::from_fn(|lane| numbers[lane])
}

impl pulp::NullaryFnOnce for AtEnds<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        for first in (0..self.obstacles.len()).step_by(GROUP) {
            self.find_in_group(first);
        }
    }
}
