//! Far obstacles, side by side, that the robot was nearest to where it began or ended, or soon after it began: its
//! mean velocities tell.

use super::bounds::Bounds;
use super::means::Means;
use super::path::Path;
use crate::lanes::{Number, Real, Truth, Vector2};
use crate::run::options::Clock;
use crate::world::scenario::{GROUP, Group, ObstacleGroup};

/// A path that has been measured, past obstacles of which some have been left alone on all of it.
pub(super) struct AtEnds<'a, R> {
    pub path: &'a Path,
    pub clock: &'a Clock,
    pub means: &'a Means,
    pub groups: &'a [ObstacleGroup],
    pub bounds: &'a Bounds,
    /// First motion step of each whose distance is not counted yet.
    pub since: &'a mut [usize],
    /// Squares of the least distances in m^2.
    pub least: &'a mut [R],
}

/// A place on the path, and when the robot is there, for obstacles side by side.
#[derive(Clone, Copy)]
struct Instant {
    time: Group,
    place: Vector2<Group>,
}

impl<R: Real> AtEnds<'_, R> {
    /// Finds the least distances that are at an end or in the head, and counts all steps of these obstacles; compiled
    /// for the instructions of the processor, its bits are the same for all.
    pub fn find(self) {
        pulp::Arch::new().dispatch(self);
    }

    #[inline(always)]
    fn instant(&self, step: usize) -> Instant {
        let place = self.path.at(step);
        Instant {
            time: Group::splat(self.clock.time(step)),
            place: Vector2::new(Group::splat(place.x), Group::splat(place.y)),
        }
    }

    #[inline(always)]
    fn find_in_group(&mut self, place: usize, ends: [Instant; 2], head: &[Instant]) {
        let first = place * GROUP;
        let since = &self.since[first..self.since.len().min(first + GROUP)];
        let begin = self.path.first() + 1;
        let group = &self.groups[place];
        let mut margin = self.bounds.margin(place);
        if since != [begin; GROUP] {
            // Nothing is farther by what is no number.
            let alone = |lane: usize| since.get(lane) == Some(&begin);
            let own = |lane| {
                if alone(lane) {
                    margin.lane(lane)
                } else {
                    f64::NAN
                }
            };
            margin = Group::from_fn(own);
        }
        let sees = |instant: &Instant| instant.place - group.at(instant.time);
        let seen = [sees(&ends[0]), sees(&ends[1])];
        let [u, v] = group.velocity;
        let step = Group::splat(self.clock.step);
        let way = Vector2::new(u * step, v * step);
        let settled = self.means.nearest_at_an_end(seen, way, margin);
        let [begin, end] = seen.map(|end| end.dot(&end));
        self.count(first, settled, begin.min(end));
        let open = !settled;
        if !open.any() {
            return;
        }
        let Some(last) = head.last() else { return };
        let early = open & self.means.nearest_in_the_head(sees(last), way, margin);
        if early.any() {
            let mut least = begin;
            for instant in head {
                let seen = sees(instant);
                least = least.min(seen.dot(&seen));
            }
            self.count(first, early, least);
        }
    }

    /// Counts all steps of some lanes, whose least distances are known.
    #[inline(always)]
    fn count(&mut self, first: usize, known: <Group as Number>::Mask, squared: Group) {
        let end = self.path.last() + 1;
        let lanes = self.since[first..].iter_mut().zip(&mut self.least[first..]);
        for (lane, (since, least)) in lanes.take(GROUP).enumerate() {
            if known.lane(lane) {
                *least = least.min(R::splat(squared.lane(lane)));
                *since = end;
            }
        }
    }
}

impl<R: Real> pulp::NullaryFnOnce for AtEnds<'_, R> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        let (first, last) = (self.path.first(), self.path.last());
        let ends = [self.instant(first), self.instant(last)];
        let head = first + 1..=self.path.head();
        let head: Vec<Instant> = head.map(|step| self.instant(step)).collect();
        for place in 0..self.groups.len() {
            self.find_in_group(place, ends, &head);
        }
    }
}
