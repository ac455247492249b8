//! Parts of lines that one obstacle forbids all by itself.

use super::{Cone, ConeBase, Vector};
use crate::lanes::{Lanes, Planar, Real, Truth, Vector2};

/// How far within a cone a velocity is at least, relative to 1 m/s and the magnitudes: well above all
/// roundings.
const WITHIN: f64 = 1e-6;

/// Share of the horizon within which the contact is at least.
const SOON: f64 = 0.9;

/// Most discs that are looked at: the nearest ones have the widest cones, and others mostly forbid no
/// whole line.
const MOST: usize = 24;

/// Discs that are looked at side by side.
const GROUP: usize = 4;
type Group = Lanes<GROUP>;

/// The cone of a disc, or those of discs side by side.
#[derive(Clone, Copy, Debug)]
struct Cover<R> {
    left: Vector2<R>,
    right: Vector2<R>,
    /// How far its tip is beside lines through zero along its legs, and 1 m/s more than the magnitude of
    /// that.
    beside: [R; 2],
    size: R,
}

/// Cones of the nearest discs that are not touched.
#[derive(Clone, Debug, Default)]
pub(super) struct Covers {
    /// Squares of distances in m^2, with places among all cones.
    nearest: Vec<(f64, usize)>,
    discs: Vec<(Cover<Group>, [usize; GROUP])>,
    /// Whether those have been taken.
    ready: bool,
    /// Which cone forbade each line last; it mostly does so again.
    known: Vec<usize>,
}

impl Covers {
    /// Forgets all.
    pub fn forget(&mut self) {
        self.ready = false;
    }

    /// Takes some cones, once none forbids a line that did so last.
    #[inline(never)]
    fn take(&mut self, cones: &[Cone], chosen: &[usize]) {
        self.ready = true;
        let distance = |index: &usize| match cones[*index].base {
            ConeBase::Disc(center, _) => Some((center.dot(&center), *index)),
            ConeBase::Edges(_) => None,
        };
        let nearest = &mut self.nearest;
        nearest.clear();
        nearest.extend(chosen.iter().filter_map(distance));
        if nearest.len() > MOST {
            nearest.select_nth_unstable_by(MOST, |one, other| one.0.total_cmp(&other.0));
            nearest.truncate(MOST);
        }
        self.discs.clear();
        for group in nearest.chunks(GROUP) {
            let place = |lane: usize| group.get(lane).map_or(usize::MAX, |(_, index)| *index);
            self.discs.push((
                Cover::side_by_side(cones, place),
                std::array::from_fn(place),
            ));
        }
    }

    /// Whether the disc that forbade each of some lines last forbids everything between two velocities of it again,
    /// at any time.
    #[inline(always)]
    pub fn known<R: Real>(
        &self,
        cones: &[Cone],
        line: impl Fn(usize) -> usize,
        ends: [Vector2<R>; 2],
    ) -> R::Mask {
        let place = |lane: usize| {
            self.known
                .get(line(lane))
                .map_or(usize::MAX, |index| *index)
        };
        Cover::side_by_side(cones, place).holds(ends)
    }

    /// Whether one of the chosen discs forbids everything between two velocities of a line, and what is as near
    /// to that as roundings are: what a disc forbids is convex. `known` said no before where it was `asked`.
    #[inline(always)]
    pub fn cover(
        &mut self,
        (cones, chosen): (&[Cone], &[usize]),
        (line, ends, asked): (usize, [Vector; 2], bool),
        horizon: f64,
    ) -> bool {
        let soon = |index: usize| {
            let soon = |end: &Vector| cones[index].time_to_contact(*end, &[]) <= SOON * horizon;
            horizon == f64::INFINITY || ends.iter().all(soon)
        };
        if !asked {
            let known = self.known.get(line).copied().unwrap_or(usize::MAX);
            let disc = cones.get(known).and_then(Cover::of);
            if disc.is_some_and(|disc| disc.holds(ends) && soon(known)) {
                return true;
            }
        }
        if !self.ready {
            self.take(cones, chosen);
        }
        let wide = ends.map(|end| Vector2::splat([end.x, end.y]));
        for place in 0..self.discs.len() {
            let (group, indices) = &self.discs[place];
            let holds = group.holds(wide);
            if !holds.any() {
                continue;
            }
            let Some(lane) = (0..GROUP).find(|lane| holds.lane(*lane) && soon(indices[*lane]))
            else {
                continue;
            };
            self.know(line, indices[lane]);
            // It mostly forbids the next line, too.
            self.discs.swap(0, place);
            return true;
        }
        false
    }

    /// Notes which cone forbade a line.
    fn know(&mut self, line: usize, index: usize) {
        if self.known.len() <= line {
            self.known.resize(line + 1, usize::MAX);
        }
        self.known[line] = index;
    }
}

impl Cover<f64> {
    /// `None` where it is touched, or is no disc.
    #[inline(always)]
    fn of(cone: &Cone) -> Option<Self> {
        if matches!(cone.base, ConeBase::Edges(_)) {
            return None;
        }
        let (legs, tip) = (cone.legs?, cone.tip);
        Some(Self {
            left: legs.left,
            right: legs.right,
            beside: [legs.left.perp(&tip), legs.right.perp(&tip)],
            size: 1.0 + tip.x.abs() + tip.y.abs(),
        })
    }
}

impl<R: Real> Cover<R> {
    /// Those of some cones; numbers that are none hold nothing.
    #[inline(always)]
    fn side_by_side(cones: &[Cone], place: impl Fn(usize) -> usize) -> Self {
        let mut numbers = [R::splat(f64::NAN); 7];
        for lane in 0..R::WIDTH {
            if let Some(disc) = cones.get(place(lane)).and_then(Cover::of) {
                let [one, other] = disc.beside;
                let (left, right) = (disc.left, disc.right);
                let own = [left.x, left.y, right.x, right.y, one, other, disc.size];
                for (number, own) in numbers.iter_mut().zip(own) {
                    number.set(lane, own);
                }
            }
        }
        let [left_x, left_y, right_x, right_y, left, right, size] = numbers;
        Self {
            left: Vector2::new(left_x, left_y),
            right: Vector2::new(right_x, right_y),
            beside: [left, right],
            size,
        }
    }

    /// Whether both ends are well within: without a branch for each, which nothing foretells.
    #[inline(always)]
    fn holds(&self, ends: [Vector2<R>; 2]) -> R::Mask {
        let size = |end: &Vector2<R>| end.x.abs() + end.y.abs();
        let within = (self.size + size(&ends[0]).max(size(&ends[1]))) * R::splat(WITHIN);
        let [left, right] = self.beside;
        let (left, right) = (left - within, right + within);
        self.left.perp(&ends[0]).lt(left)
            & self.left.perp(&ends[1]).lt(left)
            & right.lt(self.right.perp(&ends[0]))
            & right.lt(self.right.perp(&ends[1]))
    }
}
