//! Nobody passes a wall, whatever a model of people decides: who would is set back.
//!
//! A center keeps a tenth of its radius off every wall. After a motion that comes closer or crosses a wall it is set
//! back along the normal of that wall, and its velocity loses the component into it. Where several walls leave no such
//! place the person stays where the motion began.

use smallvec::SmallVec;

use crate::crowd::walls::{NearestPoint, Wall, contour};
use navigation_world::world::shape::{PlacedShape, Shape, into_axes, out_of_axes};
use numeric::lanes::{Planar, Vector2};

type Vector = Vector2<f64>;

/// Share of the radius of a person that the center keeps off walls.
const KEPT: f64 = 0.1;
/// Rounding of that distance, as a share of it.
const ROUNDING: f64 = 1e-9;
/// Most walls that set back one motion.
const MOST: usize = 12;
/// On a wall that is nearer than this there is no side, in m.
const ON: f64 = 1e-12;

/// Where a person is after being set back, and how fast, in m and m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rescue {
    /// Position in m.
    pub position: Vector,
    /// Velocity in m/s.
    pub velocity: Vector,
}

/// Motion of a center from one place to another, straight, and the distance in m that it keeps off walls.
#[derive(Clone, Copy, Debug)]
struct SweptMove {
    from: Vector,
    to: Vector,
    kept: f64,
}

/// Effect of a wall on a motion: the lower in order, the more urgent.
#[derive(Clone, Copy, Debug)]
struct WallStop {
    /// Share of the motion at which the wall is crossed, from 0 to 1; above 1 where it is only too near.
    order: f64,
    /// The place that the wall permits, in m.
    place: Vector,
    /// Away from the wall, of length 1.
    normal: Vector,
}

/// Sets back a person of a radius in m who moved from one place to another, with a velocity in m/s; `None`: no wall is
/// passed or too near.
#[inline]
#[must_use]
pub fn set_back(
    walls: &[Wall],
    [from, to]: [Vector; 2],
    velocity: Vector,
    radius: f64,
) -> Option<Rescue> {
    let kept = KEPT * radius;
    let first = most_urgent(walls, &SweptMove { from, to, kept })?;
    Some(held(walls, &SweptMove { from, to, kept }, first, velocity))
}

/// The place that all walls permit, from what the first one does.
#[cold]
fn held(walls: &[Wall], step: &SweptMove, first: WallStop, velocity: Vector) -> Rescue {
    let mut normals: SmallVec<[Vector; MOST]> = SmallVec::new();
    let mut stop = first;
    while normals.len() < MOST {
        normals.push(stop.normal);
        let tried = SweptMove {
            to: stop.place,
            ..*step
        };
        match most_urgent(walls, &tried) {
            Some(next) => stop = next,
            None => {
                return Rescue {
                    position: stop.place,
                    velocity: slowed(velocity, &normals),
                };
            }
        }
    }
    Rescue {
        position: step.from,
        velocity: Vector::zeros(),
    }
}

/// A velocity in m/s without what leads into walls; zero in a corner that leaves no direction.
fn slowed(velocity: Vector, normals: &[Vector]) -> Vector {
    let mut slower = velocity;
    for normal in normals {
        slower -= *normal * slower.dot(normal).min(0.0);
    }
    let least = -ROUNDING * velocity.norm();
    let free = normals.iter().all(|normal| slower.dot(normal) >= least);
    if free { slower } else { Vector::zeros() }
}

/// The wall that is crossed first, else the one that is nearest of those that are too near.
#[inline]
fn most_urgent(walls: &[Wall], step: &SweptMove) -> Option<WallStop> {
    let mut found: Option<WallStop> = None;
    let mut see = |stop: Option<WallStop>| {
        if let Some(stop) = stop
            && found.is_none_or(|known| stop.order < known.order)
        {
            found = Some(stop);
        }
    };
    for wall in walls {
        match wall {
            Wall::Polyline(points) => {
                for ends in points.windows(2) {
                    if step.may_meet(ends[0], ends[1]) {
                        see(off_segment([ends[0], ends[1]], step));
                    }
                }
            }
            Wall::Solid(shape) => {
                // No farther from the center than this, without a root.
                let extent = Vector::repeat(match shape.shape {
                    Shape::Disc { radius } => radius,
                    Shape::Rectangle {
                        half_length,
                        half_width,
                        axis,
                    } => (half_length + half_width) * (axis.x.abs() + axis.y.abs()),
                });
                if step.may_meet(shape.center - extent, shape.center + extent) {
                    see(off_solid(shape, step));
                }
            }
        }
    }
    found
}

impl SweptMove {
    /// Whether the motion may come too near to what lies in the box of two corners.
    #[inline(always)]
    fn may_meet(&self, one: Vector, other: Vector) -> bool {
        let apart = |from: f64, to: f64, one: f64, other: f64| {
            from.min(to) - self.kept > one.max(other) || from.max(to) + self.kept < one.min(other)
        };
        !apart(self.from.x, self.to.x, one.x, other.x)
            && !apart(self.from.y, self.to.y, one.y, other.y)
    }

    /// Effect of a wall that is crossed at a share of the motion at a place with a normal.
    fn crossing(&self, share: f64, place: Vector, normal: Vector) -> WallStop {
        WallStop {
            order: share,
            place: self.to + normal * (self.kept - normal.dot(&(self.to - place))),
            normal,
        }
    }

    /// Effect of a wall whose nearest point is `near` of the end of the motion.
    fn nearing(&self, near: NearestPoint) -> Option<WallStop> {
        (near.distance < self.kept * (1.0 - ROUNDING)).then(|| WallStop {
            // The nearest one first; all after those that are crossed.
            order: 2.0 + near.distance.max(-self.kept) / self.kept,
            place: self.to + near.normal * (self.kept - near.distance),
            normal: near.normal,
        })
    }
}

/// Effect of a segment on a motion.
fn off_segment([start, end]: [Vector; 2], step: &SweptMove) -> Option<WallStop> {
    let along = end - start;
    let length = along.norm();
    let axis = if length > 0.0 {
        along / length
    } else {
        Vector::x()
    };
    let (from, to) = (step.from - start, step.to - start);
    let left = axis.left_normal();
    let (before, after) = (left.dot(&from), left.dot(&to));
    // What cannot be told counts as crossed.
    let aside = before * after > 0.0;
    if before.abs() > ON && !aside {
        let share = before / (before - after);
        let at = axis.dot(&(from + (to - from) * share));
        let slack = ON * (1.0 + (to - from).norm());
        let passes_by = at < -slack || at > length + slack;
        if !passes_by {
            let normal = left * before.signum();
            return Some(step.crossing(share.clamp(0.0, 1.0), start + axis * at, normal));
        }
    } else if !aside && after.abs() <= ON {
        // Along the line of the segment: an end stands in the way.
        let (before, after) = (axis.dot(&from), axis.dot(&to));
        let at = before.clamp(0.0, length);
        let beyond = if before < 0.0 {
            after >= at
        } else {
            after <= at
        };
        if (before - at).abs() > ON && beyond {
            let normal = axis * (before - at).signum();
            let share = (at - before) / (after - before);
            return Some(step.crossing(share, start + axis * at, normal));
        }
    }
    let nearest = axis * axis.dot(&to).clamp(0.0, length);
    let offset = to - nearest;
    let distance = offset.norm();
    let normal = if distance > ON {
        offset / distance
    } else {
        let back = from - nearest;
        let away = back.norm();
        if away > ON { back / away } else { left }
    };
    step.nearing(NearestPoint { normal, distance })
}

/// Effect of a disc or rectangle on a motion.
fn off_solid(shape: &PlacedShape, step: &SweptMove) -> Option<WallStop> {
    let (from, to) = (step.from - shape.center, step.to - shape.center);
    let entry = match shape.shape {
        Shape::Disc { radius } => onto_disc(radius, from, to),
        Shape::Rectangle {
            half_length,
            half_width,
            axis,
        } => {
            let half = Vector::new(half_length, half_width);
            let (from, to) = (into_axes(from, axis), into_axes(to, axis));
            onto_rectangle(half, from, to).map(|(share, normal)| (share, out_of_axes(normal, axis)))
        }
    };
    if let Some((share, normal)) = entry {
        let place = step.from + (step.to - step.from) * share;
        return Some(step.crossing(share, place, normal));
    }
    step.nearing(contour(shape, step.to))
}

/// Share of a motion from outside a disc at which it meets the disc, and the normal there; places from its center.
fn onto_disc(radius: f64, from: Vector, to: Vector) -> Option<(f64, Vector)> {
    let way = to - from;
    let (square, inward) = (way.dot(&way), -from.dot(&way));
    let outside = from.dot(&from) - radius * radius;
    if outside <= 0.0 || inward <= 0.0 {
        return None;
    }
    let under_root = inward * inward - square * outside;
    if under_root < 0.0 {
        return None;
    }
    let share = outside / (inward + under_root.sqrt());
    (share <= 1.0).then(|| {
        let met = from + way * share;
        (share, met / met.norm())
    })
}

/// Share of a motion from outside a rectangle at which it meets the rectangle, and the normal there; along its axes,
/// from its center.
fn onto_rectangle(half: Vector, from: Vector, to: Vector) -> Option<(f64, Vector)> {
    let (mut enters, mut leaves, mut normal) = (f64::NEG_INFINITY, 1.0_f64, None);
    let sides = [
        (from.x, to.x, half.x, Vector::x()),
        (from.y, to.y, half.y, Vector::y()),
    ];
    for (from, to, half, axis) in sides {
        for side in [1.0, -1.0] {
            let (before, after) = (side * from - half, side * to - half);
            if before > 0.0 && after > 0.0 {
                return None;
            }
            let share = before / (before - after);
            if before > 0.0 {
                if share > enters {
                    (enters, normal) = (share, Some(axis * side));
                }
            } else if after > 0.0 {
                leaves = leaves.min(share);
            }
        }
    }
    normal
        .filter(|_| enters <= leaves)
        .map(|normal| (enters, normal))
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::random::Stream;

    fn set(walls: &[Wall], from: [f64; 2], to: [f64; 2]) -> Option<Rescue> {
        let motion = [Vector::from(from), Vector::from(to)];
        set_back(walls, motion, motion[1] - motion[0], 0.25)
    }

    #[test]
    fn who_crosses_a_wall_is_set_back_along_its_normal() {
        let wall = [Wall::polyline(vec![[0.0, -5.0], [0.0, 5.0]]).unwrap()];
        let back = set(&wall, [-0.05, 0.0], [0.3, 0.1]).unwrap();
        assert!((back.position - Vector::new(-0.025, 0.1)).norm() < 1e-15);
        assert!((back.velocity - Vector::new(0.0, 0.1)).norm() < 1e-15);
        // Too near, without crossing: the part along the wall and away from it stays.
        let near = set(&wall, [-0.05, 0.0], [-0.01, 0.1]).unwrap();
        assert!((near.position - Vector::new(-0.025, 0.1)).norm() < 1e-15);
        assert_eq!(set(&wall, [-0.05, 0.0], [-0.025, 0.1]), None);
        assert_eq!(set(&wall, [-0.05, 5.1], [0.3, 5.1]), None);
        // Someone too near who walks away is set out, with the whole velocity.
        let away = set(&wall, [-0.01, 0.0], [-0.02, 0.0]).unwrap();
        assert!((away.position - Vector::new(-0.025, 0.0)).norm() < 1e-15);
        assert_eq!(away.velocity, Vector::new(-0.01, 0.0));
    }

    #[test]
    fn solids_and_ends_hold_whoever_would_pass_them_in_one_step() {
        let disc = [Wall::solid(PlacedShape::disc([0.0, 0.0], 0.1)).unwrap()];
        let back = set(&disc, [-1.0, 0.0], [1.0, 0.0]).unwrap();
        assert!((back.position - Vector::new(-0.125, 0.0)).norm() < 1e-12);
        assert!(set(&disc, [-1.0, 0.2], [1.0, 0.2]).is_none());
        let block = [Wall::solid(PlacedShape::upright([0.0, 0.0], [0.02, 2.0])).unwrap()];
        let back = set(&block, [-1.0, 0.0], [1.0, 0.5]).unwrap();
        assert!((back.position - Vector::new(-0.035, 0.5)).norm() < 1e-12);
        assert!(set(&block, [-1.0, 0.9], [1.0, 1.4]).is_none());
        let end = [Wall::polyline(vec![[0.0, 0.0], [2.0, 0.0]]).unwrap()];
        let back = set(&end, [-1.0, 0.0], [3.0, 0.0]).unwrap();
        assert!((back.position - Vector::new(-0.025, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn a_corner_leaves_no_way_out() {
        let corner = [Wall::polyline(vec![[-3.0, 0.0], [0.0, 0.0], [0.0, -3.0]]).unwrap()];
        let back = set(&corner, [-0.1, -0.1], [0.5, 0.5]).unwrap();
        assert!((back.position - Vector::new(-0.025, -0.025)).norm() < 1e-12);
        assert_eq!(back.velocity, Vector::zeros());
    }

    /// Closed rooms of all kinds of walls keep whoever is in them, at any speed.
    #[test]
    fn nobody_leaves_a_closed_room() {
        let mut stream = Stream::new(41, 0);
        for round in 0..400 {
            let corners: usize = 3 + round % 7;
            let mut points: Vec<[f64; 2]> = (0..corners)
                .map(|corner| {
                    let angle = std::f64::consts::TAU * (corner as f64 + 0.6 * stream.unit())
                        / corners as f64;
                    let far = stream.uniform(0.6, 3.0);
                    [far * angle.cos(), far * angle.sin()]
                })
                .collect();
            points.push(points[0]);
            let ring: Vec<Vector> = points.iter().map(|point| Vector::from(*point)).collect();
            let inside = |place: Vector| {
                let turns = ring.windows(2).map(|ends| {
                    let (a, b) = (ends[0] - place, ends[1] - place);
                    a.perp(&b).atan2(a.dot(&b))
                });
                turns.sum::<f64>().abs() > 3.0
            };
            let mut walls = vec![Wall::polyline(points).unwrap()];
            for _ in 0..round % 4 {
                let center = [stream.uniform(-2.0, 2.0), stream.uniform(-2.0, 2.0)];
                let shape = if stream.unit() < 0.5 {
                    PlacedShape::disc(center, stream.uniform(0.01, 0.4))
                } else {
                    let sides = [stream.uniform(0.01, 0.6), stream.uniform(0.01, 0.6)];
                    PlacedShape::turned(center, sides, stream.uniform(-3.0, 3.0))
                };
                walls.push(Wall::solid(shape).unwrap());
            }
            let mut place = Vector::zeros();
            if !inside(place) || walls.iter().any(|wall| wall.clearance(place) < 0.03) {
                continue;
            }
            for _ in 0..300 {
                let size = 10.0_f64.powf(stream.uniform(-3.0, 3.0));
                let way = Vector::new(stream.uniform(-size, size), stream.uniform(-size, size));
                let back = set_back(&walls, [place, place + way], way, 0.25);
                let before = place;
                place = back.map_or(place + way, |found| found.position);
                assert!(inside(place), "{round}: {before:?} {way:?} {walls:?}");
                for wall in &walls {
                    let gap = wall.clearance(place);
                    assert!(
                        gap > 0.025 - 1e-9,
                        "{round}: {gap} {before:?} {way:?} {walls:?}"
                    );
                }
            }
        }
    }
}
