//! Ground that the center of the robot keeps out of: obstacles grown by its radius and a margin.

use navigation_world::world::geometry::Body;
use navigation_world::world::map::StaticMap;
use navigation_world::world::obstacle::Shape;

/// A point, a segment, a rectangle or the way that it takes, grown by a radius: a disc, the way that a
/// disc takes, or a rectangle with round corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Vertices of the core, counter-clockwise, in m.
    vertices: [[f64; 2]; 6],
    /// Number of vertices that count.
    count: usize,
    /// Radius that the core is grown by, in m.
    pub radius: f64,
}

impl Footprint {
    /// A disc that moves in a straight line from one point to another.
    #[must_use]
    pub fn swept_disc(from: [f64; 2], to: [f64; 2], radius: f64) -> Self {
        Self {
            vertices: [from, to, to, to, to, to],
            count: if from == to { 1 } else { 2 },
            radius,
        }
    }

    /// An obstacle grown by the robot's radius and margin, on its way for a time at its present
    /// velocity; positions relative to `origin`. `None` for an obstacle that is absent, or whose state
    /// is not finite.
    #[must_use]
    pub fn of(body: &Body, origin: [f64; 2], growth: f64, time: f64) -> Option<Self> {
        let state = &body.state;
        let known = state.position.iter().chain(&state.velocity);
        if !state.present || !known.copied().all(f64::is_finite) {
            return None;
        }
        let [x, y] = [state.position[0] - origin[0], state.position[1] - origin[1]];
        let way = state.velocity.map(|speed| speed * time);
        Some(match body.shape {
            Shape::Disc { radius } => {
                Self::swept_disc([x, y], [x + way[0], y + way[1]], radius + growth)
            }
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => {
                let corner = |along: f64, across: f64| {
                    let (a, b) = (along * half_length, across * half_width);
                    [x + a * axis[0] - b * axis[1], y + a * axis[1] + b * axis[0]]
                };
                let corners = [
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(1.0, 1.0),
                    corner(-1.0, 1.0),
                ];
                Self::swept_rectangle(corners, axis.into(), way, growth)
            }
        })
    }

    /// A rectangle by its corners, counter-clockwise, that moves straight along a way, grown by a
    /// radius.
    fn swept_rectangle(corners: [[f64; 2]; 4], axis: [f64; 2], way: [f64; 2], radius: f64) -> Self {
        let [one, two, three, four] = corners;
        if way == [0.0; 2] {
            return Self {
                vertices: [one, two, three, four, four, four],
                count: 4,
                radius,
            };
        }
        // The corner that trails, and its neighbor on either side, begin and end the rim that stays.
        let along = axis[0] * way[0] + axis[1] * way[1];
        let across = axis[0] * way[1] - axis[1] * way[0];
        let trailing = match (along >= 0.0, across >= 0.0) {
            (true, true) => 0,
            (false, true) => 1,
            (false, false) => 2,
            (true, false) => 3,
        };
        let at = |next: usize| corners[(trailing + next) % 4];
        let moved = |next: usize| [at(next)[0] + way[0], at(next)[1] + way[1]];
        Self {
            vertices: [at(0), at(1), moved(1), moved(2), moved(3), at(3)],
            count: 6,
            radius,
        }
    }

    /// The walls of a map grown by the robot's radius and margin, as far as they reach into a box
    /// from `low` to `high`; positions relative to `origin`. No path leads through the boundary of
    /// what is filled, so its inside need not be told.
    #[must_use]
    pub fn of_map(
        map: &StaticMap,
        origin: [f64; 2],
        growth: f64,
        [low, high]: [[f64; 2]; 2],
    ) -> Vec<Self> {
        let walls = map.capsules().iter().map(|wall| {
            let [from, to] = [wall.from, wall.to].map(|end| minus(end.into(), origin));
            Self::swept_disc(from, to, wall.radius + growth)
        });
        let within = |footprint: &Self| {
            let vertices = footprint.corners();
            (0..2).all(|axis| {
                let along = vertices.iter().map(|vertex| vertex[axis]);
                let least = along.clone().fold(f64::INFINITY, f64::min) - footprint.radius;
                let most = along.fold(f64::NEG_INFINITY, f64::max) + footprint.radius;
                least <= high[axis] && low[axis] <= most
            })
        };
        walls.filter(within).collect()
    }

    /// The vertices of the core.
    fn corners(&self) -> &[[f64; 2]] {
        &self.vertices[..self.count]
    }

    /// Sides of the core, counter-clockwise; none for a point, both ways for a segment.
    fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let sides = if self.count == 1 { 0 } else { self.count };
        (0..sides).map(|side| [self.vertices[side], self.vertices[(side + 1) % self.count]])
    }

    fn core_holds(&self, point: [f64; 2]) -> bool {
        self.count > 2
            && self
                .sides()
                .all(|[a, b]| cross(minus(b, a), minus(point, a)) >= 0.0)
    }

    /// Distance of a point from the core, 0 inside, in m.
    #[must_use]
    pub fn core_distance(&self, point: [f64; 2]) -> f64 {
        if self.core_holds(point) {
            return 0.0;
        }
        if self.count == 1 {
            return norm(minus(point, self.vertices[0]));
        }
        self.sides()
            .map(|side| point_to_segment(point, side))
            .fold(f64::INFINITY, f64::min)
    }

    /// Distance of a segment from the core, 0 where they meet, in m.
    #[must_use]
    pub fn core_distance_to_segment(&self, segment: [[f64; 2]; 2]) -> f64 {
        if self.count == 1 {
            return point_to_segment(self.vertices[0], segment);
        }
        if self.core_holds(segment[0]) {
            return 0.0;
        }
        self.sides()
            .map(|side| segment_to_segment(segment, side))
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether a segment comes closer to the core than the radius.
    #[must_use]
    pub fn meets(&self, segment: [[f64; 2]; 2]) -> bool {
        self.core_distance_to_segment(segment) < self.radius
    }

    /// Whether a point is closer to the core than the radius.
    #[must_use]
    pub fn holds(&self, point: [f64; 2]) -> bool {
        self.core_distance(point) < self.radius
    }

    /// Extent along y, in m.
    #[must_use]
    pub fn height(&self) -> [f64; 2] {
        let heights = self.corners().iter().map(|corner| corner[1]);
        [
            heights.clone().fold(f64::INFINITY, f64::min) - self.radius,
            heights.fold(f64::NEG_INFINITY, f64::max) + self.radius,
        ]
    }

    /// Extent along x of the part between two values of y, in m. Borders of a convex set are
    /// farthest out at the ends of the strip or beside a vertex.
    #[must_use]
    pub fn width_between(&self, low: f64, high: f64) -> Option<[f64; 2]> {
        let beside = self
            .corners()
            .iter()
            .map(|corner| corner[1].clamp(low, high));
        beside
            .chain([low, high])
            .filter_map(|y| self.width_at(y))
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    fn width_at(&self, y: f64) -> Option<[f64; 2]> {
        let mut width: Option<[f64; 2]> = None;
        let mut grow = |left: f64, right: f64| {
            let [a, b] = width.unwrap_or([left, right]);
            width = Some([a.min(left), b.max(right)]);
        };
        for corner in self.corners() {
            let rise = y - corner[1];
            if rise.abs() <= self.radius {
                let half = (self.radius * self.radius - rise * rise).max(0.0).sqrt();
                grow(corner[0] - half, corner[0] + half);
            }
        }
        for [a, b] in self.sides() {
            let along = minus(b, a);
            let per_length = self.radius / norm(along);
            let out = [along[1] * per_length, -along[0] * per_length];
            let part = (y - (a[1] + out[1])) / along[1];
            if (0.0..=1.0).contains(&part) {
                let x = a[0] + out[0] + part * along[0];
                grow(x, x);
            }
        }
        width
    }
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn norm(a: [f64; 2]) -> f64 {
    (a[0] * a[0] + a[1] * a[1]).sqrt()
}

/// Distance of a point from a segment in m.
fn point_to_segment(point: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = minus(b, a);
    let from = minus(point, a);
    let square = along[0] * along[0] + along[1] * along[1];
    let part = if square > 0.0 {
        ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    norm([from[0] - part * along[0], from[1] - part * along[1]])
}

/// Distance of two segments in m, 0 where they cross.
fn segment_to_segment(first: [[f64; 2]; 2], second: [[f64; 2]; 2]) -> f64 {
    let side = |[a, b]: [[f64; 2]; 2], point| cross(minus(b, a), minus(point, a));
    let apart = |line, [a, b]: [[f64; 2]; 2]| side(line, a) * side(line, b) >= 0.0;
    if !apart(first, second) && !apart(second, first) {
        return 0.0;
    }
    // Segments that touch or overlap without crossing have an end on the other one.
    point_to_segment(first[0], second)
        .min(point_to_segment(first[1], second))
        .min(point_to_segment(second[0], first))
        .min(point_to_segment(second[1], first))
}
