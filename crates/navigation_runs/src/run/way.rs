//! The way of a robot past an obstacle within a motion step: where they touch, and how deep.

use crate::run::outcome::DECIDED_OVERLAP;
use navigation_world::world::shape::Shape;
use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// Bodies that pass each other between two motion steps touch if they overlap by more, in m.
const ROUNDING: f64 = 1e-9;

/// Halvings of an interval within a motion step: as many as a number has digits.
const HALVINGS: usize = 52;

/// A contact within a motion step.
pub(crate) struct Met {
    /// Shares of the step at which it begins, and at which it ends or the bodies first overlap by
    /// [`DECIDED_OVERLAP`].
    pub shares: [f64; 2],
    pub decided: bool,
    /// Least distance in the step, in m.
    pub least: f64,
}

/// The way of a robot past an obstacle in a motion step, as seen from the center of that.
pub(crate) struct Way {
    pub shape: Shape,
    pub from: Vector,
    pub to: Vector,
}

impl Way {
    /// From the obstacle to the robot, at a share of the step.
    pub fn offset(&self, share: f64) -> Vector {
        self.shape.offset(self.from + (self.to - self.from) * share)
    }

    fn distance(&self, share: f64) -> f64 {
        self.offset(share).norm()
    }

    /// Share of the step at which they are nearest: the distance from a convex shape falls before and grows after it.
    fn nearest(&self) -> f64 {
        let way = self.to - self.from;
        let squared = way.norm_squared();
        if squared == 0.0 {
            return 0.0;
        }
        if let Shape::Disc { .. } = self.shape {
            return (-self.from.dot(&way) / squared).clamp(0.0, 1.0);
        }
        let [mut low, mut high] = [0.0, 1.0];
        // A third less each time.
        for _ in 0..2 * HALVINGS {
            let third = (high - low) / 3.0;
            if self.distance(low + third) <= self.distance(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        low
    }

    /// Share between one that is farther than a distance and one that is not, at which that is reached.
    fn crossing(&self, [mut outside, mut inside]: [f64; 2], distance: f64) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (outside + inside);
            if self.distance(middle) > distance {
                outside = middle;
            } else {
                inside = middle;
            }
        }
        inside
    }

    /// The contact of bodies that touch at a distance; `touching`: at the end of the step they do.
    pub fn contact(&self, reach: f64, touching: bool) -> Option<Met> {
        let nearest = self.nearest();
        let least = self.distance(nearest);
        if !touching && least >= reach - ROUNDING {
            return None;
        }
        let entered = |end: f64, distance: f64| {
            if self.distance(end) <= distance {
                end
            } else {
                self.crossing([end, nearest], distance)
            }
        };
        let (begin, deep) = (entered(0.0, reach), reach - DECIDED_OVERLAP);
        let decided = least <= deep;
        let end = if decided {
            entered(0.0, deep)
        } else {
            entered(1.0, reach)
        };
        Some(Met {
            shares: [begin, end],
            decided,
            least,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(shape: Shape, from: [f64; 2], to: [f64; 2]) -> Way {
        Way {
            shape,
            from: from.into(),
            to: to.into(),
        }
    }

    #[test]
    fn a_passage_between_two_instants_is_found_with_its_begin() {
        let disc = Shape::Disc { radius: 0.3 };
        let met = way(disc, [-1.0, 0.3], [1.0, 0.3])
            .contact(0.5, false)
            .unwrap();
        assert!((met.shares[0] - 0.3).abs() < 1e-12, "{}", met.shares[0]);
        assert!(met.decided && (met.least - 0.3).abs() < 1e-12);
        // Overlapping by 0.1 m where the distance is 0.4 m.
        let deep = (1.0 - (0.16_f64 - 0.09).sqrt()) / 2.0;
        assert!((met.shares[1] - deep).abs() < 1e-12);
        let grazed = way(disc, [-1.0, 0.45], [1.0, 0.45])
            .contact(0.5, false)
            .unwrap();
        assert!(!grazed.decided && (grazed.shares[0] + grazed.shares[1] - 1.0).abs() < 1e-12);
        assert!(
            way(disc, [-1.0, 0.5], [1.0, 0.5])
                .contact(0.5, false)
                .is_none()
        );
        assert!(
            way(disc, [-1.0, 0.3], [-0.6, 0.3])
                .contact(0.5, false)
                .is_none()
        );
    }

    #[test]
    fn a_thin_wall_is_met_where_its_face_is() {
        let wall = Shape::upright([0.0, 4.0]);
        let met = way(wall, [-1.0, 0.0], [1.0, 0.0])
            .contact(0.2, false)
            .unwrap();
        assert!((met.shares[0] - 0.4).abs() < 1e-12 && met.least < 1e-12);
        let past = way(wall, [-1.0, 2.3], [1.0, 2.3]).contact(0.2, false);
        assert!(past.is_none());
    }

    #[test]
    fn who_stands_is_where_it_is() {
        let disc = Shape::Disc { radius: 0.3 };
        let met = way(disc, [0.45, 0.0], [0.45, 0.0])
            .contact(0.5, true)
            .unwrap();
        assert!(!met.decided && met.shares == [0.0, 1.0]);
    }
}
