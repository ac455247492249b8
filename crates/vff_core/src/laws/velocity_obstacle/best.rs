//! The best velocity so far, and what a line of velocities may still promise.

use super::cover::Covers;
use super::lines::{BESIDE, Cap, Line, Reachable};
use super::remaining::Remaining;
use super::{Selection, Situation, Vector, VelocityObstaclePlanner, cones};
use crate::lanes::{Lanes, Number, Planar, Real, Truth, Vector2};
use numeric::order::sort_pairs;

/// Numbers of the candidates of a line by itself; its crossings follow.
pub(super) const OWN: usize = 5;

/// A promise is worth this much more than it says, relative to it: well above all roundings.
const SLACK: f64 = 1e-6;

/// Most lines for which it does not pay to ask whether single obstacles forbid them.
const FEW: usize = 3;

/// Lines that are looked at side by side.
const GROUP: usize = 4;
type Group = Lanes<GROUP>;

/// A line that anything reachable lies on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Promising {
    /// What its velocities are worth at most.
    pub promise: f64,
    /// Its place among the lines.
    pub index: usize,
    /// The line.
    pub line: Line,
    /// Ends of its part that is reachable, generously.
    ends: [Vector; 2],
}

/// Place of a candidate in the order of all: the line, and its number there.
pub(super) type Place = (usize, usize);

/// The best free velocity of those that were offered, in any order: the same as in the order of
/// their places.
pub(super) struct Best<'a> {
    pub(super) planner: &'a VelocityObstaclePlanner,
    situation: &'a Situation<'a, f64>,
    pub(super) reachable: Reachable,
    pub(super) aim: Vector,
    /// What it is worth by the first number: whatever promises less is not looked at.
    least: f64,
    found: Option<((f64, f64), Place, Vector)>,
    /// Whether the cones that may forbid any velocity that may be worth enough have been sorted out.
    narrow: bool,
    /// Discs that hold all velocities that may be worth enough, once they have been.
    caps: &'a [Cap],
    room: Box<Room>,
}

/// Room for what is sorted out, kept from one control period to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Room {
    /// The cones that may forbid any velocity that may be worth enough.
    near: Vec<usize>,
    /// The lines on which there may be any.
    lines: Vec<usize>,
    covers: Covers,
    promising: Vec<Promising>,
    /// Promises and places of those, the most promising first.
    order: Vec<(f64, usize)>,
    /// Those that no single obstacle forbids.
    open: Vec<Promising>,
    pub remaining: Remaining,
}

impl<'a> Best<'a> {
    pub fn new(
        planner: &'a VelocityObstaclePlanner,
        situation: &'a Situation<'a, f64>,
        (reachable, aim): (Reachable, Vector),
        room: Box<Room>,
    ) -> Self {
        Self {
            planner,
            situation,
            reachable,
            aim,
            least: f64::NEG_INFINITY,
            found: None,
            narrow: false,
            caps: &[],
            room,
        }
    }

    /// The best velocity and its place, and the room.
    pub fn ended(self) -> (Option<(Place, Vector)>, Box<Room>) {
        let chosen = self.found.map(|(_, place, velocity)| (place, velocity));
        (chosen, self.room)
    }

    /// Takes a velocity if it is reachable, better than the one before, and free. Most are far out
    /// of reach, which their squares tell.
    #[inline]
    pub fn offer(&mut self, place: Place, velocity: Vector) {
        if self.may_be_taken(velocity) {
            self.take(place, velocity);
        }
    }

    /// Whether a velocity is not far out of reach and may be worth enough.
    #[inline]
    fn may_be_taken(&self, velocity: Vector) -> bool {
        self.reachable.may_hold(velocity) && self.at_most(velocity) >= self.least
    }

    /// The same for a velocity that may be taken.
    #[inline(never)]
    fn take(&mut self, place: Place, velocity: Vector) {
        if !self.reachable.holds(velocity) {
            return;
        }
        let worth = self.planner.worth(self.situation, self.aim, velocity);
        let better = self
            .found
            .is_none_or(|(known, earlier, _)| worth > known || (worth == known && place < earlier));
        if better && self.is_free(velocity) {
            self.found = Some((worth, place, velocity));
            self.least = worth.0;
        }
    }

    fn is_free(&self, velocity: Vector) -> bool {
        let (planner, situation) = (self.planner, self.situation);
        if self.narrow {
            // Whatever is elsewhere is forbidden, or worth less.
            let caps = &mut self.caps.iter();
            caps.any(|cap| cap.may_hold(velocity))
                && planner.free_of(self.room.near.iter().copied(), situation, velocity)
        } else {
            planner.free(situation, velocity)
        }
    }

    /// Sorts out the cones that can forbid nothing within some discs, which hold all velocities that may be worth
    /// more than what was found, and the legs on which there is nothing of that kind.
    pub fn narrow(&mut self, caps: &'a [Cap]) {
        self.narrow = true;
        self.caps = caps;
        let VelocityObstaclePlanner { cones, legs, .. } = self.planner;
        let Room { near, lines, .. } = &mut *self.room;
        let whole = self.planner.takes_whole_lines();
        cones::sort_out((cones, legs), (caps, whole), (near, lines));
        let ahead = 2 * cones.len();
        lines.extend(ahead..ahead + self.planner.ahead.len());
    }

    /// Whether no more than a few lines have anything on them that may be worth enough, as far as they were sorted out.
    pub fn few_lines(&self, few: usize) -> bool {
        self.narrow && self.room.lines.len() <= few
    }

    /// What is worth less than this is worth less than what was found, whatever the roundings, where worth is the
    /// component toward the goal.
    pub fn floor(&self) -> f64 {
        self.least - SLACK * (1.0 + self.least.abs())
    }

    /// The smallest disc that is known to hold everything reachable that may be worth enough.
    pub fn cap(&self) -> Cap {
        let wide = self.reachable.circles().map(|(center, radius)| {
            let wide = Cap { center, radius };
            if self.planner.settings.selection != Selection::ToGoal {
                return wide;
            }
            wide.beyond(self.floor(), self.aim)
        });
        let [one, other] = wide;
        if one.radius < other.radius {
            one
        } else {
            other
        }
    }

    /// What a velocity is worth at most, without a look at the obstacles.
    #[inline]
    fn at_most(&self, velocity: Vector) -> f64 {
        match self.planner.settings.selection {
            Selection::ToGoal => velocity.dot(&self.aim),
            Selection::Fastest { .. } => self.planner.rank(velocity.dot(&velocity).sqrt()),
            Selection::TimeAndRisk { .. } => -self.planner.time_left(self.situation, velocity),
        }
    }

    /// Offers what is on lines by themselves and where they cross, the most promising lines first.
    pub fn look_along_lines(&mut self, wanted: Vector) {
        self.sort_out_lines();
        self.room.open.clear();
        let least = self.least;
        for place in 0..self.room.order.len() {
            let line = self.room.promising[self.room.order[place].1];
            if self.is_better_than(line.promise) {
                break;
            }
            let many = self.room.lines.len() > FEW;
            if many && self.least > least && self.is_covered(&line) {
                continue;
            }
            self.offer_own(line.index, &line.line, wanted);
            self.look_at_crossings(&line);
            self.room.open.push(line);
        }
    }

    /// Offers what is on a line by itself.
    pub fn offer_own(&mut self, index: usize, line: &Line, wanted: Vector) {
        let own = line.own(wanted, &self.reachable);
        for (number, velocity) in own.into_iter().enumerate() {
            if let Some(velocity) = velocity {
                self.offer((1 + index, number), velocity);
            }
        }
    }

    /// Offers the crossing of a line with an earlier one.
    #[inline]
    pub fn offer_crossing(&mut self, later: (usize, &Line), earlier: (usize, &Line)) {
        if let Some(velocity) = later.1.crossing(earlier.1)
            && self.may_be_taken(velocity)
            && self.planner.meet(later.1, earlier.1, velocity)
        {
            self.take((1 + later.0, OWN + earlier.0), velocity);
        }
    }

    /// Offers the crossings of a line with those that were looked at before.
    #[inline]
    fn look_at_crossings(&mut self, line: &Promising) {
        for place in 0..self.room.open.len() {
            let other = &self.room.open[place];
            // Of two lines the later one is gone along.
            let (later, earlier) = if line.index > other.index {
                (line, other)
            } else {
                (other, line)
            };
            let (later, earlier) = ((later.index, later.line), (earlier.index, earlier.line));
            self.offer_crossing((later.0, &later.1), (earlier.0, &earlier.1));
        }
    }

    /// Lines that anything reachable lies on which may be worth enough and is not forbidden by a single
    /// obstacle, the most promising first.
    fn sort_out_lines(&mut self) {
        let planner = self.planner;
        self.room.promising.clear();
        if planner.settings.selection == Selection::ToGoal {
            self.room.covers.forget();
        }
        pulp::Arch::new().dispatch(LineSorting(self));
        // The lines follow each other by their places, so that equal promises are told apart by the order.
        let Room {
            promising, order, ..
        } = &mut *self.room;
        let promises = promising.iter().enumerate();
        order.clear();
        order.extend(promises.map(|(place, line)| (-line.promise, place)));
        sort_pairs(order);
    }

    /// The lines of a group, that from some place on among those that may hold anything.
    #[inline(always)]
    fn sort_out_group(&mut self, first: usize) {
        let count = GROUP.min(self.room.lines.len() - first);
        let chosen = &self.room.lines[first..first + count];
        let line = |lane: usize| self.planner.line_or_none(chosen[lane.min(count - 1)]);
        let group: [Line; GROUP] = [line(0), line(1), line(2), line(3)];
        let number = |of: fn(&Line) -> f64| Group::from_fn(|lane| of(&group[lane]));
        let from = Vector2::new(number(|line| line.from.x), number(|line| line.from.y));
        let along = Vector2::new(number(|line| line.along.x), number(|line| line.along.y));
        let begin = if self.planner.takes_whole_lines() {
            f64::NEG_INFINITY
        } else {
            -BESIDE
        };
        let (some, ends) = self.reachable.chords((from, along), begin);
        let to_goal = self.planner.settings.selection == Selection::ToGoal;
        let (promises, parts) = if to_goal {
            self.promises(ends)
        } else {
            (Group::splat(f64::INFINITY), ends)
        };
        let kept = some & !promises.lt(Group::splat(self.least));
        let many = to_goal && self.room.lines.len() > FEW;
        let forever = many && self.planner.settings.horizon == f64::INFINITY;
        let open = if forever && kept.any() {
            let line = |lane: usize| chosen[lane.min(count - 1)];
            kept & !self.room.covers.known(&self.planner.cones, line, parts)
        } else {
            kept
        };
        for lane in (0..count).filter(|lane| open.lane(*lane)) {
            let of_lane = |[one, other]: [Vector2<Group>; 2]| -> [Vector; 2] {
                [one.lane(lane).into(), other.lane(lane).into()]
            };
            let (index, ends) = (self.room.lines[first + lane], of_lane(ends));
            if many
                && !self.is_found_on(&group[lane])
                && self.covers(index, of_lane(parts), forever)
            {
                continue;
            }
            let promise = if to_goal {
                promises.lane(lane)
            } else {
                self.promise(ends)
            };
            if !self.is_better_than(promise) {
                self.room.promising.push(Promising {
                    promise,
                    index,
                    line: group[lane],
                    ends,
                });
            }
        }
    }

    /// What the velocities between ends are worth at most where worth is the component toward the goal,
    /// and the ends of the parts that may be worth as much as what was found, generously.
    #[inline(always)]
    fn promises(&self, ends: [Vector2<Group>; 2]) -> (Group, [Vector2<Group>; 2]) {
        let (aim, number) = (Vector2::splat([self.aim.x, self.aim.y]), Group::splat);
        let (first, second) = (ends[0].dot(&aim), ends[1].dot(&aim));
        let exact = first.max(second);
        let promises = exact + number(SLACK) * (number(1.0) + exact.abs());
        let least = number(self.least - SLACK * (1.0 + self.least.abs()));
        let way = ends[1] - ends[0];
        let share = (least - first) / (second - first);
        let cut = ends[0] + way * share;
        let rises = first.lt(least) & least.lt(second);
        let falls = second.lt(least) & least.lt(first);
        let parts = [
            Vector2::select(rises, cut, ends[0]),
            Vector2::select(falls, cut, ends[1]),
        ];
        (promises, parts)
    }

    /// Whether one obstacle forbids all velocities of a line that may be better than the best one.
    fn is_covered(&mut self, line: &Promising) -> bool {
        let part = self.better_part(line);
        part.is_some_and(|ends| self.covers(line.index, ends, false))
    }

    /// Whether what was found lies on a line: then no obstacle forbids all of it that may be worth as much.
    fn is_found_on(&self, line: &Line) -> bool {
        let across = |velocity: Vector| (velocity - line.from).perp(&line.along).abs();
        self.found
            .is_some_and(|(.., velocity)| across(velocity) <= BESIDE)
    }

    /// Whether one obstacle forbids a part of a line.
    #[inline(always)]
    fn covers(&mut self, line: usize, ends: [Vector; 2], asked: bool) -> bool {
        let VelocityObstaclePlanner {
            cones, settings, ..
        } = self.planner;
        let Room { near, covers, .. } = &mut *self.room;
        covers.cover((cones, near), (line, ends, asked), settings.horizon)
    }

    /// What the velocities between two are worth at most.
    fn promise(&self, ends: [Vector; 2]) -> f64 {
        let largest = |value: &dyn Fn(Vector) -> f64| value(ends[0]).max(value(ends[1]));
        let exact = match self.planner.settings.selection {
            Selection::ToGoal => largest(&|velocity| velocity.dot(&self.aim)),
            Selection::Fastest { .. } => self.planner.rank(largest(&|velocity| velocity.norm())),
            Selection::TimeAndRisk { .. } => {
                let forward = largest(&|velocity| velocity.dot(&self.aim));
                -self.planner.least_time_left(self.situation, forward)
            }
        };
        exact + SLACK * (1.0 + exact.abs())
    }

    /// Ends of the part of a line that may be worth as much as what was found, generously; `None` where
    /// worth is no component of the velocity.
    fn better_part(&self, line: &Promising) -> Option<[Vector; 2]> {
        if self.planner.settings.selection != Selection::ToGoal {
            return None;
        }
        let least = self.least - SLACK * (1.0 + self.least.abs());
        let ends = line.ends;
        let [first, second] = ends.map(|end| end.dot(&self.aim));
        let between = |low: f64, high: f64| (least - low) / (high - low);
        let way = ends[1] - ends[0];
        Some(if first < least && least < second {
            [ends[0] + way * between(first, second), ends[1]]
        } else if second < least && least < first {
            [ends[0], ends[1] - way * between(second, first)]
        } else {
            ends
        })
    }

    /// Whether what was found is worth more than a promise.
    fn is_better_than(&self, promise: f64) -> bool {
        self.found.is_some_and(|(known, ..)| known.0 > promise)
    }
}

/// Sorts out the lines, compiled for the instructions of the processor; its bits are the same for all.
struct LineSorting<'b, 'a>(&'b mut Best<'a>);

impl pulp::NullaryFnOnce for LineSorting<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for first in (0..self.0.room.lines.len()).step_by(GROUP) {
            self.0.sort_out_group(first);
        }
    }
}
