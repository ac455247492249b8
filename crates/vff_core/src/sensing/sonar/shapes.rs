//! Shapes that echo, the point of each that is nearest, and where a ray meets them.

use crate::error::{Result, finite, finite_pair, positive};

/// A box seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Center, in m.
    pub center: [f64; 2],
    /// Half of the size along its own axes, in m.
    pub half_size: [f64; 2],
    /// Unit vector of its first axis.
    pub axis: [f64; 2],
}

impl Rectangle {
    /// A box with its sides along x and y.
    #[must_use]
    pub fn upright(center: [f64; 2], size: [f64; 2]) -> Self {
        Self {
            center,
            half_size: [0.5 * size[0], 0.5 * size[1]],
            axis: [1.0, 0.0],
        }
    }

    /// A box turned by an angle in rad, counterclockwise.
    #[must_use]
    pub fn turned(center: [f64; 2], size: [f64; 2], angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self {
            axis: [cos, sin],
            ..Self::upright(center, size)
        }
    }

    /// A vector in the axes of the box.
    #[inline]
    fn own(&self, vector: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.axis;
        [c * vector[0] + s * vector[1], c * vector[1] - s * vector[0]]
    }

    /// Vector from a point to the nearest point of the box, zero inside.
    #[inline]
    #[must_use]
    pub fn nearest(&self, from: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.own([from[0] - self.center[0], from[1] - self.center[1]]);
        let [w, h] = self.half_size;
        let to = [x.max(-w).min(w) - x, y.max(-h).min(h) - y];
        let [c, s] = self.axis;
        [c * to[0] - s * to[1], s * to[0] + c * to[1]]
    }

    /// Distance along a ray: the later of the two entries, unless an exit comes before it.
    #[inline]
    fn cast(&self, from: [f64; 2], direction: [f64; 2]) -> f64 {
        let p = self.own([from[0] - self.center[0], from[1] - self.center[1]]);
        let u = self.own(direction);
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..2 {
            let half = self.half_size[axis];
            if u[axis] == 0.0 {
                if p[axis].abs() > half {
                    return f64::INFINITY;
                }
                continue;
            }
            let inverse = 1.0 / u[axis];
            let [one, other] = [(-half - p[axis]) * inverse, (half - p[axis]) * inverse];
            enter = enter.max(one.min(other));
            leave = leave.min(one.max(other));
        }
        if enter <= leave { enter } else { f64::INFINITY }
    }
}

/// A disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Center, in m.
    pub center: [f64; 2],
    /// Radius, in m.
    pub radius: f64,
}

impl Disc {
    /// Vector from a point to the nearest point of the disc, zero inside.
    #[inline]
    #[must_use]
    pub fn nearest(&self, from: [f64; 2]) -> [f64; 2] {
        let to = [self.center[0] - from[0], self.center[1] - from[1]];
        let distance = (to[0] * to[0] + to[1] * to[1]).sqrt();
        if distance <= self.radius {
            return [0.0, 0.0];
        }
        let share = (distance - self.radius) / distance;
        [share * to[0], share * to[1]]
    }

    #[inline]
    fn cast(&self, from: [f64; 2], direction: [f64; 2]) -> f64 {
        let to = [self.center[0] - from[0], self.center[1] - from[1]];
        let outside = to[0] * to[0] + to[1] * to[1] - self.radius * self.radius;
        if outside <= 0.0 {
            return 0.0;
        }
        let along = to[0] * direction[0] + to[1] * direction[1];
        // From the distance of the center to the ray: along^2 - |to|^2 would cancel.
        let across = to[0] * direction[1] - to[1] * direction[0];
        let square = self.radius * self.radius - across * across;
        if along <= 0.0 || square < 0.0 {
            return f64::INFINITY;
        }
        // The nearer root as a quotient, exact when the ray starts close to the disc.
        outside / (along + square.sqrt())
    }
}

/// A straight wall without thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// One end, in m.
    pub start: [f64; 2],
    /// The other end, in m.
    pub end: [f64; 2],
}

impl Wall {
    /// Vector from a point to the nearest point of the wall.
    #[inline]
    #[must_use]
    pub fn nearest(&self, from: [f64; 2]) -> [f64; 2] {
        let to = [self.start[0] - from[0], self.start[1] - from[1]];
        let along = [self.end[0] - self.start[0], self.end[1] - self.start[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let share = if square > 0.0 {
            (-(to[0] * along[0] + to[1] * along[1]) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        [to[0] + share * along[0], to[1] + share * along[1]]
    }

    #[inline]
    fn cast(&self, from: [f64; 2], direction: [f64; 2]) -> f64 {
        let to = [self.start[0] - from[0], self.start[1] - from[1]];
        let along = [self.end[0] - self.start[0], self.end[1] - self.start[1]];
        let cross = direction[0] * along[1] - direction[1] * along[0];
        if cross == 0.0 {
            return Self::cast_parallel(to, along, direction);
        }
        let distance = (to[0] * along[1] - to[1] * along[0]) / cross;
        let share = (to[0] * direction[1] - to[1] * direction[0]) / cross;
        if distance >= 0.0 && (0.0..=1.0).contains(&share) {
            distance
        } else {
            f64::INFINITY
        }
    }

    /// A ray along the wall meets its nearer end, or starts on it.
    fn cast_parallel(to: [f64; 2], along: [f64; 2], direction: [f64; 2]) -> f64 {
        if to[0] * direction[1] - to[1] * direction[0] != 0.0 {
            return f64::INFINITY;
        }
        let one = to[0] * direction[0] + to[1] * direction[1];
        let other = one + along[0] * direction[0] + along[1] * direction[1];
        match (one.min(other), one.max(other)) {
            (_, farther) if farther < 0.0 => f64::INFINITY,
            (nearer, _) => nearer.max(0.0),
        }
    }
}

/// A shape of any kind. All are convex: what a beam can see of one is decided by its nearest
/// point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A box.
    Rectangle(Rectangle),
    /// A disc.
    Disc(Disc),
    /// A wall.
    Wall(Wall),
}

impl Shape {
    /// Passes a shape that can be.
    ///
    /// # Errors
    /// A number is not finite, a size is not positive, or the axis has no direction.
    pub fn checked(self) -> Result<Self> {
        match self {
            Self::Rectangle(shape) => {
                finite_pair("center", shape.center)?;
                positive("half_size[0]", shape.half_size[0])?;
                positive("half_size[1]", shape.half_size[1])?;
                finite_pair("axis", shape.axis)?;
                positive("length of axis", shape.axis[0].hypot(shape.axis[1]))?;
            }
            Self::Disc(shape) => {
                finite_pair("center", shape.center)?;
                positive("radius", shape.radius)?;
            }
            Self::Wall(shape) => {
                finite_pair("start", shape.start)?;
                finite_pair("end", shape.end)?;
                finite("length", shape.start[0] - shape.end[0])?;
            }
        }
        Ok(self)
    }

    /// The shape somewhere else, `by` in m.
    #[inline]
    #[must_use]
    pub fn shifted(&self, by: [f64; 2]) -> Self {
        let moved = |point: [f64; 2]| [point[0] + by[0], point[1] + by[1]];
        match *self {
            Self::Rectangle(shape) => Self::Rectangle(Rectangle {
                center: moved(shape.center),
                ..shape
            }),
            Self::Disc(shape) => Self::Disc(Disc {
                center: moved(shape.center),
                ..shape
            }),
            Self::Wall(shape) => Self::Wall(Wall {
                start: moved(shape.start),
                end: moved(shape.end),
            }),
        }
    }

    /// Vector from a point to the nearest point of the shape, zero inside.
    #[inline]
    #[must_use]
    pub fn nearest(&self, from: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Rectangle(shape) => shape.nearest(from),
            Self::Disc(shape) => shape.nearest(from),
            Self::Wall(shape) => shape.nearest(from),
        }
    }

    /// Distance from a point, zero inside, in m.
    #[must_use]
    pub fn distance(&self, from: [f64; 2]) -> f64 {
        let [x, y] = self.nearest(from);
        (x * x + y * y).sqrt()
    }

    /// Whether all of the shape lies beyond the line through a point, on the side of its normal.
    #[inline]
    #[must_use]
    pub fn beyond(&self, from: [f64; 2], normal: [f64; 2]) -> bool {
        let along =
            |point: [f64; 2]| (point[0] - from[0]) * normal[0] + (point[1] - from[1]) * normal[1];
        match self {
            Self::Rectangle(shape) => {
                let [x, y] = shape.own(normal);
                let [w, h] = shape.half_size;
                along(shape.center) > x.abs() * w + y.abs() * h
            }
            Self::Disc(shape) => along(shape.center) > shape.radius,
            Self::Wall(shape) => along(shape.start) > 0.0 && along(shape.end) > 0.0,
        }
    }

    /// Distance from a point to the shape along a unit vector, in m: zero inside, infinite when
    /// the ray misses.
    #[inline]
    #[must_use]
    pub fn cast(&self, from: [f64; 2], direction: [f64; 2]) -> f64 {
        match self {
            Self::Rectangle(shape) => shape.cast(from, direction),
            Self::Disc(shape) => shape.cast(from, direction),
            Self::Wall(shape) => shape.cast(from, direction),
        }
    }
}
