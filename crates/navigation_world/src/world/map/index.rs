//! Index of the capsules of a map: a tree of boxes, whose answers are those of a search over all.

use nalgebra::Vector2;

use crate::world::map::capsule::Capsule;

/// Capsules in a leaf, at most.
const LEAF: usize = 4;

/// Levels of a tree over as many capsules as a map can hold.
const DEEPEST: usize = 24;

/// Boxes are larger than what they hold by this share of their coordinates, so that rounding never
/// hides a capsule.
const SPARE: f64 = 1e-12;

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BoundingBox {
    pub lower: Vector2<f64>,
    pub upper: Vector2<f64>,
}

impl BoundingBox {
    /// A box that holds nothing.
    fn nothing() -> Self {
        Self {
            lower: Vector2::repeat(f64::INFINITY),
            upper: Vector2::repeat(f64::NEG_INFINITY),
        }
    }

    /// The smallest box around a capsule.
    fn of(capsule: &Capsule) -> Self {
        let radius = Vector2::repeat(capsule.radius);
        Self {
            lower: capsule.from.inf(&capsule.to) - radius,
            upper: capsule.from.sup(&capsule.to) + radius,
        }
    }

    /// The smallest box around a segment.
    pub fn of_segment(from: Vector2<f64>, to: Vector2<f64>) -> Self {
        Self {
            lower: from.inf(&to),
            upper: from.sup(&to),
        }
    }

    fn joined(&self, other: &Self) -> Self {
        Self {
            lower: self.lower.inf(&other.lower),
            upper: self.upper.sup(&other.upper),
        }
    }

    fn with_spare(&self) -> Self {
        let size = self.lower.amax().max(self.upper.amax());
        let spare = Vector2::repeat(SPARE * size);
        Self {
            lower: self.lower - spare,
            upper: self.upper + spare,
        }
    }

    /// Square of the distance of a point from the box, in m^2; zero inside.
    #[inline]
    pub fn distance_squared(&self, place: Vector2<f64>) -> f64 {
        let x = (self.lower.x - place.x)
            .max(place.x - self.upper.x)
            .max(0.0);
        let y = (self.lower.y - place.y)
            .max(place.y - self.upper.y)
            .max(0.0);
        x * x + y * y
    }

    /// Square of a distance that no two points of the boxes fall below, in m^2.
    #[inline]
    pub fn distance_squared_of(&self, other: &Self) -> f64 {
        let x = (self.lower.x - other.upper.x).max(other.lower.x - self.upper.x);
        let y = (self.lower.y - other.upper.y).max(other.lower.y - self.upper.y);
        let (x, y) = (x.max(0.0), y.max(0.0));
        x * x + y * y
    }

    /// Least component of a point of the box along a vector.
    #[inline]
    pub fn least_along(&self, normal: Vector2<f64>) -> f64 {
        let x = normal.x
            * if normal.x > 0.0 {
                self.lower.x
            } else {
                self.upper.x
            };
        let y = normal.y
            * if normal.y > 0.0 {
                self.lower.y
            } else {
                self.upper.y
            };
        x + y
    }

    /// Distance along a ray at which it enters the box; infinite when it misses.
    #[inline]
    pub fn entered(&self, start: Vector2<f64>, inverse: Vector2<f64>) -> f64 {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..2 {
            let (to_lower, to_upper) = (
                self.lower[axis] - start[axis],
                self.upper[axis] - start[axis],
            );
            if inverse[axis].is_infinite() {
                if to_lower > 0.0 || to_upper < 0.0 {
                    return f64::INFINITY;
                }
                continue;
            }
            let (one, two) = (to_lower * inverse[axis], to_upper * inverse[axis]);
            enter = enter.max(one.min(two));
            leave = leave.min(one.max(two));
        }
        if enter <= leave { enter } else { f64::INFINITY }
    }
}

/// A box of the tree. The first child of an inner one follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    bounds: BoundingBox,
    /// First capsule of a leaf, or second child of an inner box.
    next: usize,
    /// Capsules of a leaf, none for an inner box.
    count: usize,
}

/// The tree; it has brought the capsules into its order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Index {
    nodes: Vec<Node>,
    pub capsules: Vec<Capsule>,
}

impl Index {
    /// The tree over capsules.
    pub fn new(mut capsules: Vec<Capsule>) -> Self {
        let mut nodes = Vec::with_capacity(2 * capsules.len().div_ceil(2));
        if !capsules.is_empty() {
            grow(&mut nodes, &mut capsules, 0);
        }
        Self { nodes, capsules }
    }

    /// The box around everything, `None` without capsules.
    pub fn bounds(&self) -> Option<BoundingBox> {
        let corners = self.capsules.iter().map(BoundingBox::of);
        corners.reduce(|all, one| all.joined(&one))
    }

    /// Visits the capsules of all leaves whose boxes, and those above them, have a rank of at most
    /// the limit that the visits return; of two boxes the one with the lower rank comes first.
    ///
    /// `rank` is given a box and returns `None` where nothing in it counts; `visit` is given a
    /// capsule and the limit so far, and returns the limit from then on.
    #[inline]
    pub fn visit(
        &self,
        mut limit: f64,
        rank: impl Fn(&BoundingBox) -> Option<f64>,
        mut visit: impl FnMut(usize, &Capsule, f64) -> f64,
    ) {
        let Some(first) = self.nodes.first().and_then(|root| rank(&root.bounds)) else {
            return;
        };
        let mut waiting = [(0_usize, 0.0_f64); DEEPEST];
        let mut left = 0;
        let mut present = Some((0, first));
        while let Some((at, ranked)) = present {
            present = None;
            if ranked <= limit {
                let node = &self.nodes[at];
                if node.count > 0 {
                    for index in node.next..node.next + node.count {
                        limit = visit(index, &self.capsules[index], limit);
                    }
                } else {
                    let children = [at + 1, node.next];
                    let [one, two] = children.map(|child| rank(&self.nodes[child].bounds));
                    let one = one.filter(|rank| *rank <= limit).map(|rank| (at + 1, rank));
                    let two = two
                        .filter(|rank| *rank <= limit)
                        .map(|rank| (node.next, rank));
                    present = match (one, two) {
                        (Some(one), Some(two)) => {
                            let (near, far) = if two.1 < one.1 {
                                (two, one)
                            } else {
                                (one, two)
                            };
                            waiting[left] = far;
                            left += 1;
                            Some(near)
                        }
                        (one, two) => one.or(two),
                    };
                }
            }
            if present.is_none() && left > 0 {
                left -= 1;
                present = Some(waiting[left]);
            }
        }
    }
}

/// Builds the box over capsules, the first of which has an index in the whole list.
fn grow(nodes: &mut Vec<Node>, capsules: &mut [Capsule], first: usize) {
    let all = capsules.iter().map(BoundingBox::of);
    let bounds = all.fold(BoundingBox::nothing(), |all, one| all.joined(&one));
    let at = nodes.len();
    let leaf = capsules.len() <= LEAF;
    nodes.push(Node {
        bounds: bounds.with_spare(),
        next: first,
        count: if leaf { capsules.len() } else { 0 },
    });
    if leaf {
        return;
    }
    let size = bounds.upper - bounds.lower;
    let axis = usize::from(size.y > size.x);
    let middle = capsules.len() / 2;
    capsules.select_nth_unstable_by(middle, |one, two| {
        let center = |capsule: &Capsule| capsule.from[axis] + capsule.to[axis];
        center(one).total_cmp(&center(two))
    });
    let (low, high) = capsules.split_at_mut(middle);
    grow(nodes, low, first);
    let second = nodes.len();
    nodes[at].next = second;
    grow(nodes, high, first + middle);
}
