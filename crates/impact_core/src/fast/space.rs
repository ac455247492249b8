//! Space for the walk along a response: nodes, pieces between them, what was found in them.

use super::modes::LaneMotion;
use super::scan::{Piece, SignChange, Tops};
use numeric::lanes::Number;

/// Nodes after which an impact is refused.
pub(super) const NODES: usize = 129;

/// Space for one group after the other.
pub struct Workspace<S, R: Number> {
    /// Instructions that may be used.
    pub simd: S,
    /// Zero in every lane.
    pub zero: R,
    /// The motion; what is this large is not moved.
    pub(super) motion: Option<LaneMotion<S, R>>,
    pub(super) walked: Walked<R>,
}

impl<S, R: Number> Workspace<S, R> {
    /// Space for groups with lanes like those of zero.
    #[inline(always)]
    #[must_use]
    pub fn new(simd: S, zero: R) -> Self {
        Self {
            simd,
            zero,
            motion: None,
            walked: Walked::new(zero),
        }
    }
}

/// The nodes of a group and what is found between them.
pub(super) struct Walked<R: Number> {
    /// Velocity of the head, up to a constant, and its acceleration.
    pub(super) head: [[R; 2]; NODES],
    /// Time, velocity and acceleration in the nodes before the end of the impact and there.
    pub(super) clipped: Vec<[R; 3]>,
    /// Where the criterion of windows from a node to the others grows with their start and with their
    /// end, and the same from the node before it.
    pub(super) signs: [Vec<[R::Mask; 2]>; 2],
    /// Two nodes that follow each other, by turns.
    pub(super) pair: [Node<R>; 2],
    pub(super) found: Extrema<R>,
}

/// Tops of all quantities that have a maximum, and a valley of the acceleration.
pub(super) struct Extrema<R: Number> {
    pub(super) acceleration: Tops<R>,
    pub(super) force: Tops<R>,
    pub(super) compression: Tops<R>,
    pub(super) manipulator_power: Tops<R>,
    pub(super) foam_power: Tops<R>,
    pub(super) valley: SignChange<R>,
}

impl<R: Number> Extrema<R> {
    #[inline(always)]
    fn new(zero: R) -> Self {
        Self {
            acceleration: Tops::new(zero),
            force: Tops::new(zero),
            compression: Tops::new(zero),
            manipulator_power: Tops::new(zero),
            foam_power: Tops::new(zero),
            valley: SignChange::none(zero),
        }
    }

    /// Forgets the extrema; their numbers stay, as none of them is read.
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.acceleration.clear();
        self.force.clear();
        self.compression.clear();
        self.manipulator_power.clear();
        self.foam_power.clear();
        self.valley.clear();
    }
}

impl<R: Number> Walked<R> {
    #[inline(always)]
    fn new(zero: R) -> Self {
        Self {
            head: [[zero; 2]; NODES],
            clipped: Vec::new(),
            signs: [Vec::new(), Vec::new()],
            pair: [Node::at_rest(zero); 2],
            found: Extrema::new(zero),
        }
    }
}

/// Values and slopes at a node of all functions whose signs matter.
#[derive(Clone, Copy)]
pub(super) struct Node<R> {
    pub(super) time: R,
    pub(super) velocity: R,
    pub(super) acceleration: [R; 3],
    pub(super) force: [R; 2],
    pub(super) compression: [R; 2],
    pub(super) manipulator_power: [R; 2],
    pub(super) foam_power: [R; 2],
}

impl<R: Number> Node<R> {
    /// Velocity and acceleration of the head.
    #[inline(always)]
    pub(super) fn head(&self) -> [R; 2] {
        [self.velocity, self.acceleration[0]]
    }

    /// Acceleration of the head and its slope.
    #[inline(always)]
    pub(super) fn fall(&self) -> [R; 2] {
        [self.acceleration[0], self.acceleration[1]]
    }

    #[inline(always)]
    pub(super) fn at_rest(zero: R) -> Self {
        Self {
            time: zero,
            velocity: zero,
            acceleration: [zero; 3],
            force: [zero; 2],
            compression: [zero; 2],
            manipulator_power: [zero; 2],
            foam_power: [zero; 2],
        }
    }
}

/// Values at a node, and at the next one.
pub(super) struct NodePair<'a, R> {
    left: &'a Node<R>,
    right: &'a Node<R>,
}

impl<'a, R: Number> NodePair<'a, R> {
    /// The piece that ends with a node.
    #[inline(always)]
    pub(super) fn ending([even, odd]: &'a [Node<R>; 2], index: usize) -> Self {
        let (left, right) = if index % 2 == 1 {
            (even, odd)
        } else {
            (odd, even)
        };
        Self { left, right }
    }

    #[inline(always)]
    pub(super) fn piece(&self, of: impl Fn(&Node<R>) -> [R; 2]) -> Piece<R> {
        let [left, right] = [of(self.left), of(self.right)];
        Piece {
            from: self.left.time,
            width: self.right.time - self.left.time,
            values: [left[0], right[0]],
            slopes: [left[1], right[1]],
        }
    }
}
