//! A way as a line of straight parts, and places on it by their arc length.

use super::Vector;

/// Two parts in line are one: sine of the angle between them, at most.
const STRAIGHT: f64 = 1e-9;

/// A way, one point long at least.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    points: Vec<Vector>,
    /// Arc length of every point in m.
    along: Vec<f64>,
}

impl Way {
    /// The way along points in m; `None` without a point.
    #[must_use]
    pub fn new(points: impl IntoIterator<Item = Vector>) -> Option<Self> {
        let mut way = Self {
            points: Vec::new(),
            along: Vec::new(),
        };
        way.set(points);
        (!way.points.is_empty()).then_some(way)
    }

    /// The straight way between two places in m.
    #[must_use]
    pub fn straight(from: Vector, to: Vector) -> Self {
        Self {
            points: vec![from, to],
            along: vec![0.0, (to - from).norm()],
        }
    }

    /// Takes another way; points in line are left out.
    pub fn set(&mut self, points: impl IntoIterator<Item = Vector>) {
        self.points.clear();
        self.along.clear();
        for point in points {
            if let [.., before, last] = self.points[..] {
                let (one, two) = (last - before, point - last);
                let (across, ahead) = (one.perp(&two).abs(), one.dot(&two));
                if ahead > 0.0 && across <= STRAIGHT * ahead {
                    self.points.pop();
                    self.along.pop();
                }
            }
            let length = match (self.points.last(), self.along.last()) {
                (Some(last), Some(along)) => along + (point - last).norm(),
                _ => 0.0,
            };
            self.points.push(point);
            self.along.push(length);
        }
    }

    /// Its points in m.
    #[must_use]
    pub fn points(&self) -> &[Vector] {
        &self.points
    }

    /// Its end in m.
    #[must_use]
    pub fn end(&self) -> Vector {
        self.points.last().copied().unwrap_or_else(Vector::zeros)
    }

    /// Its length `L` in m.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.along.last().copied().unwrap_or(0.0)
    }

    /// `q(s)`: the place at an arc length in m, an end where that is beyond it.
    #[must_use]
    pub fn at(&self, along: f64) -> Vector {
        let next = self.along.partition_point(|known| *known < along);
        let (Some(before), Some(to)) = (next.checked_sub(1), self.points.get(next)) else {
            return if next == 0 {
                self.points[0]
            } else {
                self.end()
            };
        };
        let (from, begun) = (self.points[before], self.along[before]);
        let part = self.along[next] - begun;
        from + (to - from) * ((along - begun) / part)
    }

    /// Squared distance of a place in m^2, and arc length in m of the first of its nearest places.
    #[must_use]
    pub fn nearest(&self, place: Vector) -> (f64, f64) {
        let from = place - self.points[0];
        let mut best = (from.dot(&from), 0.0);
        for ((pair, begun), ended) in self
            .points
            .windows(2)
            .zip(&self.along)
            .zip(&self.along[1..])
        {
            let (part, to) = (pair[1] - pair[0], place - pair[0]);
            let squared = part.dot(&part);
            let share = if squared > 0.0 {
                (part.dot(&to) / squared).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let off = to - part * share;
            let distance = off.dot(&off);
            if distance < best.0 {
                best = (distance, begun + share * (ended - begun));
            }
        }
        best
    }

    /// Distance of a place in m.
    #[must_use]
    pub fn distance(&self, place: Vector) -> f64 {
        self.nearest(place).0.sqrt()
    }

    /// The first place at least a distance in m away from a place, else the end.
    #[must_use]
    pub fn first_beyond(&self, center: Vector, distance: f64) -> Vector {
        let squared = distance * distance;
        let first = self.points[0] - center;
        if first.dot(&first) >= squared {
            return self.points[0];
        }
        for pair in self.points.windows(2) {
            let (from, to) = (pair[0] - center, pair[1] - center);
            if to.dot(&to) >= squared {
                // |from + s part| = distance, s from 0 to 1: the end is out, the start is in.
                let part = to - from;
                let (a, b) = (part.dot(&part), from.dot(&part));
                let c = from.dot(&from) - squared;
                let root = (b * b - a * c).max(0.0).sqrt();
                let share = if b > 0.0 {
                    -c / (b + root)
                } else {
                    (root - b) / a
                };
                return pair[0] + part * share.clamp(0.0, 1.0);
            }
        }
        self.end()
    }

    /// Where it first leaves the square of a half side in m about a place, else its end.
    #[must_use]
    pub fn leaves_square(&self, center: Vector, half: f64) -> Vector {
        let first = self.points[0] - center;
        if first.x.abs().max(first.y.abs()) > half {
            return self.points[0];
        }
        for pair in self.points.windows(2) {
            let (from, to) = (pair[0] - center, pair[1] - center);
            if to.x.abs().max(to.y.abs()) > half {
                let share = [(from.x, to.x), (from.y, to.y)].map(|(from, to)| {
                    if to.abs() > half {
                        (half.copysign(to) - from) / (to - from)
                    } else {
                        1.0
                    }
                });
                return pair[0] + (pair[1] - pair[0]) * share[0].min(share[1]);
            }
        }
        self.end()
    }
}
