//! Parts of lines that one obstacle forbids all by itself.

use super::{Cone, ConeBase, Vector};

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
    /// Which cone forbade each line last; it mostly does so again.
    known: Vec<usize>,
}

impl Covers {
    /// Forgets all, and takes some cones.
    pub fn take(&mut self, cones: &[Cone], chosen: &[usize]) {
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

    /// Whether a disc forbids everything between two velocities of a line, and what is as near to that as
    /// roundings are: what a disc forbids is convex.
    pub fn cover(
        &mut self,
        cones: &[Cone],
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
