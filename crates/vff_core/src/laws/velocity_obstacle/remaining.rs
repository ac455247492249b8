//! What single obstacles leave of the velocities that may be the best: each one forbids a convex set, and what
//! is left of a convex set beside that are two convex sets.

use super::best::Best;
use super::cones::{Cone, LegGroup, deepest};
use super::lines::{Cap, Reachable};
use super::parts::{Forbidden, NO_LINE, Part};
use super::sweep::Swept;
use super::{Selection, Vector};

/// Room for roundings around what is reachable, relative: well above all roundings.
const BESIDE: f64 = 1e-7;

/// A velocity that is farther out of reach than this, relative, is cut off.
const OUTSIDE: f64 = 1e-4;

/// Most parts that are looked at after a sweep that left too much; where these are not enough, nothing is taken away.
const MOST: usize = 40;

/// Share of the disc around all of them that is little.
const NARROW: f64 = 0.3;

/// Most searches for which it is not tried again after too much was left.
const LONGEST_PAUSE: u32 = 31;

/// Most lines for which it does not pay.
const FEW: usize = 8;

/// Where there are more cones and a larger share of the velocities may be worth enough, there are mostly more.
const FEW_CONES: usize = 8;
const SMALL: f64 = 0.01;

/// Most cones that are asked first, since they forbade the most promising velocities last.
const ASKED_FIRST: usize = 8;

/// Room for what is left, kept from one control period to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Remaining {
    /// Parts that may be worth enough, with what they are worth at most and the corner that is.
    open: Vec<(f64, usize, Part)>,
    /// Those whose most promising velocity no single obstacle forbids.
    left: Vec<Part>,
    /// Cones that forbade the most promising velocities, the last ones first.
    asked: Vec<usize>,
    /// Discs around what is left.
    pub caps: Vec<Cap>,
    /// Room for sweeps, which come first.
    swept: Swept,
    /// For how many searches nothing is tried, and how many it were last, since too much was left.
    paused: [u32; 2],
}

impl Remaining {
    /// Whether little may be left: not soon after it was too much.
    fn is_worth_it(&self) -> bool {
        self.paused[0] == 0
    }

    /// Notes whether little was left.
    fn pause(&mut self, little: bool) {
        let [left, last] = self.paused;
        self.paused = match (left, little) {
            (_, true) => [0; 2],
            (0, false) => [LONGEST_PAUSE.min(2 * last + 1); 2],
            (left, false) => [left - 1, last],
        };
    }

    /// Notes a part, if it may be worth enough.
    fn open(&mut self, part: Part, aim: Vector, floor: f64) {
        if !part.corners().is_empty() {
            let (top, corner) = part.top(aim);
            if top >= floor {
                self.open.push((top, corner, part));
            }
        }
    }

    /// Takes the most promising part.
    fn next(&mut self) -> Option<(f64, usize, Part)> {
        let places = 0..self.open.len();
        let place =
            places.max_by(|one, other| self.open[*one].0.total_cmp(&self.open[*other].0))?;
        Some(self.open.swap_remove(place))
    }

    /// Draws discs around what is left and may be worth enough.
    fn close(&mut self, aim: Vector, floor: f64) {
        let parts = self
            .left
            .iter()
            .map(|part| part.beyond(aim, floor, NO_LINE));
        let parts = parts.filter(|part| !part.corners().is_empty());
        self.caps.extend(parts.map(|part| part.cap()));
    }

    /// What forbids a velocity for certain.
    fn forbids(
        &mut self,
        (cones, legs): (&[Cone], &[LegGroup]),
        velocity: Vector,
        size: f64,
    ) -> Option<Forbidden> {
        let of = |index: usize| Forbidden::of(cones.get(index)?, index, size);
        for place in 0..self.asked.len() {
            if let Some(forbidden) = of(self.asked[place]).filter(|cone| cone.holds(velocity)) {
                self.asked[..=place].rotate_right(1);
                return Some(forbidden);
            }
        }
        let deepest = deepest(legs, velocity)?;
        let forbidden = of(deepest).filter(|cone| cone.holds(velocity))?;
        self.asked.truncate(ASKED_FIRST - 1);
        self.asked.insert(0, deepest);
        Some(forbidden)
    }
}

impl<'a> Best<'a> {
    /// Sorts out cones and legs by discs that hold everything reachable that may be worth enough: a given one or,
    /// where that leaves many lines and a free velocity is known, those around what single obstacles leave.
    pub fn narrow_down(
        &mut self,
        wide: &'a [Cap; 1],
        remaining: &'a mut Remaining,
        wanted: Vector,
    ) {
        if self.is_easy(wide) {
            return;
        }
        // Where no free velocity is known, mostly too much is left.
        if self.floor() == f64::NEG_INFINITY {
            return self.narrow(wide);
        }
        let narrow = |caps: &[Cap]| {
            let mut caps = caps.iter();
            caps.all(|cap| cap.radius < NARROW * wide[0].radius)
        };
        let swept =
            self.sweep(&mut remaining.swept, &mut remaining.caps) && narrow(&remaining.caps);
        let taken = swept || (remaining.is_worth_it() && self.take_away(remaining, wanted));
        if !swept {
            remaining.pause(taken && narrow(&remaining.caps));
        }
        self.narrow(if taken { &remaining.caps } else { wide });
    }

    /// Whether nothing is to be taken away: only for a component toward the goal, and for contacts that count
    /// whenever they are, or there are few lines, which are sorted out then.
    fn is_easy(&mut self, wide: &'a [Cap; 1]) -> bool {
        let settings = &self.planner.settings;
        let possible = settings.selection == Selection::ToGoal && settings.horizon == f64::INFINITY;
        let many = self.planner.cones.len() > FEW_CONES
            && wide[0].radius > SMALL * self.reachable.max_speed;
        if possible && many {
            return false;
        }
        self.narrow(wide);
        !possible || self.few_lines(FEW)
    }

    /// Finds discs that hold everything reachable that may be worth enough and that no single obstacle forbids,
    /// if there are few of them. The most promising velocities are taken first, and offered where none forbids them.
    pub fn take_away(&mut self, remaining: &mut Remaining, wanted: Vector) -> bool {
        remaining.open.clear();
        remaining.left.clear();
        remaining.caps.clear();
        let all = self.outer_part();
        let sizes = all.corners().iter();
        let mut sizes = sizes.map(|corner| corner.x.abs() + corner.y.abs());
        // Where a number is not one nothing is certain.
        let Some(size) =
            sizes.try_fold(0.0, |size: f64, own| own.is_finite().then(|| size.max(own)))
        else {
            return false;
        };
        remaining.open(all, self.aim, self.floor());
        for _ in 0..MOST {
            let floor = self.floor();
            let Some((_, corner, part)) = remaining.next().filter(|(top, ..)| *top >= floor) else {
                remaining.close(self.aim, floor);
                return true;
            };
            let velocity = part.corners()[corner];
            let cones = (&*self.planner.cones, &*self.planner.legs);
            if let Some(cone) = remaining.forbids(cones, velocity, size) {
                for part in cone.taken_from(&part) {
                    remaining.open(part, self.aim, floor);
                }
                continue;
            }
            self.offer_corner(&part, corner, wanted);
            match outside(&self.reachable, velocity) {
                Some((outward, most)) => {
                    let part = part.beyond(-outward, -most, NO_LINE);
                    remaining.open(part, self.aim, self.floor());
                }
                None => remaining.left.push(part),
            }
        }
        false
    }

    /// Offers what is on the lines that meet in a corner.
    fn offer_corner(&mut self, part: &Part, corner: usize, wanted: Vector) {
        let [one, other] = part.lines_at(corner);
        let (earlier, later) = if one < other {
            (one, other)
        } else {
            (other, one)
        };
        let planner = self.planner;
        let on = |index: usize| planner.line(index);
        for index in [earlier, later] {
            if let Some(line) = on(index) {
                self.offer_own(index, &line, wanted);
            }
        }
        if let (Some(earlier_line), Some(later_line)) = (on(earlier), on(later)) {
            self.offer_crossing((later, &later_line), (earlier, &earlier_line));
        }
    }

    /// A part that holds everything reachable that may be worth enough.
    fn outer_part(&self) -> Part {
        let (aim, across) = (self.aim, Vector::new(-self.aim.y, self.aim.x));
        if let Some(segment) = self.segment() {
            return segment.part([across, aim]);
        }
        let mut ahead = [self.floor(), f64::INFINITY];
        let mut beside = [f64::NEG_INFINITY, f64::INFINITY];
        for (center, radius) in self.reachable.circles() {
            let wide = radius * (1.0 + BESIDE) + BESIDE;
            let [far, side] = [center.dot(&aim), center.dot(&across)];
            ahead = [ahead[0].max(far - wide), ahead[1].min(far + wide)];
            beside = [beside[0].max(side - wide), beside[1].min(side + wide)];
        }
        let corner = |ahead: f64, beside: f64| aim * ahead + across * beside;
        Part::quadrangle([
            corner(ahead[0], beside[0]),
            corner(ahead[1], beside[0]),
            corner(ahead[1], beside[1]),
            corner(ahead[0], beside[1]),
        ])
    }

    /// The smallest such part between a chord and the tangents where it ends and beyond its middle; `None` where there
    /// is none.
    pub fn segment(&self) -> Option<Segment> {
        let mut least: Option<Segment> = None;
        for (center, radius) in self.reachable.circles() {
            let wide = radius * (1.0 + BESIDE) + BESIDE;
            let away = self.floor() - center.dot(&self.aim);
            // Also where a number is not one.
            if !(away > 0.0 && away < wide) {
                continue;
            }
            let half = (wide * wide - away * away).sqrt();
            if least.is_none_or(|known| half < known.half) {
                least = Some(Segment {
                    center,
                    bottom: away,
                    top: wide,
                    half,
                    side: half * wide / (wide + away),
                });
            }
        }
        least
    }
}

/// What is above a chord of a circle, up to the tangents where the chord ends and to that at the top, in m/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub center: Vector,
    /// Heights above the center.
    pub bottom: f64,
    pub top: f64,
    /// How far it goes to each side at the bottom and at the top.
    pub half: f64,
    pub side: f64,
}

impl Segment {
    /// The velocity at a place, given the directions to the side and up.
    #[inline(always)]
    pub fn velocity(&self, [across, up]: [Vector; 2], [side, height]: [f64; 2]) -> Vector {
        self.center + across * side + up * height
    }

    /// Its corners, counter-clockwise.
    #[inline(always)]
    pub fn part(&self, axes: [Vector; 2]) -> Part {
        let corner = |side: f64, height: f64| self.velocity(axes, [side, height]);
        Part::quadrangle([
            corner(-self.half, self.bottom),
            corner(-self.side, self.top),
            corner(self.side, self.top),
            corner(self.half, self.bottom),
        ])
    }
}

/// The direction in which a velocity is out of reach, and how far is in reach there, generously.
fn outside(reachable: &Reachable, velocity: Vector) -> Option<(Vector, f64)> {
    reachable
        .circles()
        .into_iter()
        .find_map(|(center, radius)| {
            let offset = velocity - center;
            let length = offset.norm();
            let far = radius * (1.0 + OUTSIDE) + OUTSIDE;
            (length > far).then(|| {
                let outward = offset * (1.0 / length);
                (
                    outward,
                    outward.dot(&center) + radius * (1.0 + BESIDE) + BESIDE,
                )
            })
        })
}
