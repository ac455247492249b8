//! Parts of lines that one obstacle forbids all by itself.

use super::{Cone, ConeBase, Vector};
use crate::lanes::{Real, Vector2};

/// How far within a cone a velocity is at least, relative to 1 m/s and the magnitudes: well above all
/// roundings.
const WITHIN: f64 = 1e-6;

/// Share of the horizon within which the contact is at least.
const SOON: f64 = 0.9;

/// Most discs that are looked at: the nearest ones have the widest cones, and others mostly forbid no
/// whole line.
const MOST: usize = 24;

/// The cone of a disc.
#[derive(Clone, Copy, Debug)]
struct Cover {
    left: Vector,
    right: Vector,
    /// How far its tip is beside lines through zero along its legs, and 1 m/s more than the magnitude of
    /// that.
    beside: [f64; 2],
    size: f64,
    /// Its place among all cones.
    index: usize,
}

/// Cones of the nearest discs that are not touched.
#[derive(Clone, Debug, Default)]
pub(super) struct Covers {
    /// Squares of distances in m^2, with places among all cones.
    nearest: Vec<(f64, usize)>,
    discs: Vec<Cover>,
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
        let cover = |&(_, index): &(f64, usize)| Cover::of(&cones[index], index);
        self.discs.clear();
        self.discs.extend(nearest.iter().filter_map(cover));
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
        let disc = |lane: usize| {
            let index = *self.known.get(line(lane))?;
            Cover::of(cones.get(index)?, index)
        };
        let mut numbers = [R::splat(f64::NAN); 7];
        for lane in 0..R::WIDTH {
            if let Some(disc) = disc(lane) {
                let [one, other] = disc.beside;
                let (left, right) = (disc.left, disc.right);
                let own = [left.x, left.y, right.x, right.y, one, other, disc.size];
                for (number, own) in numbers.iter_mut().zip(own) {
                    number.set(lane, own);
                }
            }
        }
        let [left_x, left_y, right_x, right_y, left, right, own] = numbers;
        let (to_left, to_right) = (Vector2::new(left_x, left_y), Vector2::new(right_x, right_y));
        let size = |end: &Vector2<R>| end.x.abs() + end.y.abs();
        let within = (own + size(&ends[0]).max(size(&ends[1]))) * R::splat(WITHIN);
        let (left, right) = (left - within, right + within);
        to_left.perp(&ends[0]).lt(left)
            & to_left.perp(&ends[1]).lt(left)
            & right.lt(to_right.perp(&ends[0]))
            & right.lt(to_right.perp(&ends[1]))
    }

    /// Whether one of the chosen discs forbids everything between two velocities of a line, and what is as near
    /// to that as roundings are: what a disc forbids is convex.
    pub fn cover(
        &mut self,
        (cones, chosen): (&[Cone], &[usize]),
        (line, ends): (usize, [Vector; 2]),
        horizon: f64,
    ) -> bool {
        let size = ends.map(|end| end.x.abs() + end.y.abs());
        let size = size[0].max(size[1]);
        let forbids = |disc: &Cover| {
            disc.holds(ends, size)
                && (horizon == f64::INFINITY || {
                    let cone = &cones[disc.index];
                    let soon = |end: &Vector| cone.time_to_contact(*end, &[]) <= SOON * horizon;
                    ends.iter().all(soon)
                })
        };
        let known = self.known.get(line);
        let known = known.and_then(|index| Cover::of(cones.get(*index)?, *index));
        if known.is_some_and(|disc| forbids(&disc)) {
            return true;
        }
        if !self.ready {
            self.take(cones, chosen);
        }
        let Some(found) = self.discs.iter().position(forbids) else {
            return false;
        };
        if self.known.len() <= line {
            self.known.resize(line + 1, usize::MAX);
        }
        self.known[line] = self.discs[found].index;
        // It mostly forbids the next line, too.
        self.discs.swap(0, found);
        true
    }
}

impl Cover {
    /// `None` where it is touched, or is no disc.
    #[inline]
    fn of(cone: &Cone, index: usize) -> Option<Self> {
        if matches!(cone.base, ConeBase::Edges(_)) {
            return None;
        }
        let (legs, tip) = (cone.legs?, cone.tip);
        Some(Self {
            left: legs.left,
            right: legs.right,
            beside: [legs.left.perp(&tip), legs.right.perp(&tip)],
            size: 1.0 + tip.x.abs() + tip.y.abs(),
            index,
        })
    }

    /// Without a branch for each end, which nothing foretells.
    #[inline]
    fn holds(&self, [first, second]: [Vector; 2], size: f64) -> bool {
        let within = WITHIN * (self.size + size);
        let [left, right] = self.beside;
        let (left, right) = (left - within, right + within);
        (self.left.perp(&first) < left)
            & (self.left.perp(&second) < left)
            & (self.right.perp(&first) > right)
            & (self.right.perp(&second) > right)
    }
}
