//! Parts of lines that one obstacle forbids all by itself.

use super::{Cone, Vector};

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
    discs: Vec<Cover>,
}

impl Covers {
    /// Of some cones.
    pub fn of(cones: &[Cone], chosen: &[usize]) -> Self {
        let distance = |index: &usize| {
            let center = cones[*index].outline.center()?;
            Some((center.dot(&center), *index))
        };
        let mut discs: Vec<(f64, usize)> = chosen.iter().filter_map(distance).collect();
        if discs.len() > MOST {
            discs.select_nth_unstable_by(MOST, |one, other| one.0.total_cmp(&other.0));
            discs.truncate(MOST);
        }
        let cover = |&(_, index): &(f64, usize)| Cover::of(&cones[index], index);
        Self {
            discs: discs.iter().filter_map(cover).collect(),
        }
    }

    /// Whether one of the discs forbids everything between two velocities, and what is as near to that
    /// as roundings are: what a disc forbids is convex.
    pub fn cover(&mut self, cones: &[Cone], ends: [Vector; 2], horizon: f64) -> bool {
        let size = ends.map(|end| end.x.abs() + end.y.abs());
        let size = size[0].max(size[1]);
        let forbids = |disc: &Cover| {
            disc.holds(ends, size)
                && (horizon == f64::INFINITY || {
                    let soon =
                        |end: &Vector| cones[disc.index].time_to_contact(*end) <= SOON * horizon;
                    ends.iter().all(soon)
                })
        };
        let Some(found) = self.discs.iter().position(forbids) else {
            return false;
        };
        // It mostly forbids the next line, too.
        self.discs.swap(0, found);
        true
    }
}

impl Cover {
    fn of(cone: &Cone, index: usize) -> Option<Self> {
        let (legs, tip) = (cone.legs?, cone.outline.velocity);
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
