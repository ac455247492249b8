//! Optimal reciprocal collision avoidance, van den Berg, Guy, Lin and Manocha (2011).

mod discs;
mod side_by_side;

use discs::{front, nearer_leg, pass_disc};
use numeric::order::sort_pairs;

use crate::Situation;
use crate::planning::Planner;
use crate::planning::half_planes::{HalfPlane, Solver};
use crate::planning::outline::{Legs, Outline};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::Body;
use navigation_world::world::obstacle::Shape;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::Result;
use numeric::lanes::{Planar, Vector2};

type Vector = Vector2<f64>;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReciprocalAvoidance {
    /// Time `tau` within which no contact may come, in s.
    pub horizon: f64,
    /// Share of the avoidance that the robot takes: 1/2 among robots of the same kind, 1 among
    /// people who do not give way.
    pub share: f64,
    /// Obstacles whose surface is farther away than this are not looked at, in m.
    pub reach: f64,
    /// Distance that is kept between the surfaces, in m.
    pub margin: f64,
    /// Angle by which the wanted velocity is turned to the left of the goal, in rad: without it
    /// a robot that meets somebody head-on would only slow down.
    pub turn: f64,
}

impl Default for ReciprocalAvoidance {
    fn default() -> Self {
        Self {
            horizon: 2.0,
            share: 1.0,
            reach: 5.0,
            margin: 0.0,
            turn: 0.01,
        }
    }
}

impl Named for ReciprocalAvoidance {
    const NAME: &'static str = "optimal_reciprocal_collision_avoidance";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Ok(Self {
            horizon: given.number("horizon")?,
            share: given.number("share")?,
            reach: given.number("reach")?,
            margin: given.number("margin")?,
            turn: given.number("turn")?,
        })
    }
}

/// The velocities that avoid an outline for the time of the horizon, by the share of the change
/// of velocity that is needed.
///
/// `u` leads from the relative velocity to the nearest point of the edge of the velocity obstacle
/// `VO = {v: t v in the outline for a t in [0, tau]}`, and the line passes through
/// `V + share u`, at right angles to `u`. Obstacles that are touched must be left within
/// `interval`.
#[must_use]
pub fn avoiding(
    outline: &Outline,
    velocity: Vector,
    horizon: f64,
    interval: f64,
    share: f64,
) -> HalfPlane {
    let relative = velocity - outline.velocity;
    let (direction, change) = match outline.center() {
        Some(center) if center.dot(&center) > outline.radius * outline.radius => {
            pass_disc((center, outline.radius), relative, horizon)
        }
        _ => edge(outline, relative, [1.0 / horizon, 1.0 / interval]),
    };
    HalfPlane {
        point: velocity + change * share,
        direction,
    }
}

/// To the nearest edge of the velocity obstacle of any outline, for the inverse of the horizon and of
/// the interval.
fn edge(outline: &Outline, relative: Vector, [horizon, interval]: [f64; 2]) -> (Vector, Vector) {
    match outline.legs() {
        None => leave(&outline.scaled(interval), relative),
        Some(legs) => pass(&outline.scaled(horizon), &legs, relative),
    }
}

/// Out of an outline by the shortest way.
fn leave(scaled: &Outline, relative: Vector) -> (Vector, Vector) {
    let (point, inside) = scaled.nearest(relative);
    let way = if inside {
        point - relative
    } else {
        relative - point
    };
    let length = way.dot(&way).sqrt();
    if length == 0.0 {
        // Exactly on the set: any direction is as short as any other.
        return front(Vector2::new(1.0, 0.0), scaled.radius);
    }
    let depth = if inside {
        scaled.radius + length
    } else {
        scaled.radius - length
    };
    front(way * (1.0 / length), depth)
}

/// To the nearest edge of the velocity obstacle of an outline ahead: front or one of the legs.
fn pass(scaled: &Outline, legs: &Legs, relative: Vector) -> (Vector, Vector) {
    let left_depth = -legs.left.perp(&relative);
    let right_depth = legs.right.perp(&relative);
    let (point, inside) = scaled.nearest(relative);
    let way = relative - point;
    let length = way.dot(&way).sqrt();
    if !inside && length > 0.0 {
        let normal = way * (1.0 / length);
        let (left_normal, right_normal) = (legs.left.left_normal(), -legs.right.left_normal());
        if left_normal.perp(&normal) > 0.0 && normal.perp(&right_normal) > 0.0 {
            return front(normal, scaled.radius - length);
        }
    }
    // The set is convex: its nearest edge is the one that is least deep, from behind the outline too.
    let (depth, normal) = front_face(scaled, relative);
    if depth < left_depth.min(right_depth) {
        return front(normal, depth);
    }
    nearer_leg(legs, relative)
}

/// Depth below the nearest face that looks to the robot, and its normal.
fn front_face(scaled: &Outline, place: Vector) -> (f64, Vector) {
    let corners = scaled.corners();
    let mut best = (f64::INFINITY, Vector2::new(1.0, 0.0));
    for (index, &from) in corners.iter().enumerate() {
        let edge = corners[(index + 1) % corners.len()] - from;
        let length = edge.dot(&edge).sqrt();
        if length == 0.0 {
            continue;
        }
        let normal = -edge.left_normal() * (1.0 / length);
        let depth = scaled.radius + normal.dot(&(from - place));
        // Faces whose rounded side the origin sees.
        if normal.dot(&from) + scaled.radius < 0.0 && depth < best.0 {
            best = (depth, normal);
        }
    }
    best
}

/// Whether a body is a boundary point, of a map or read by a sensor: a disc without extent that
/// stands. An echo that is taken to come nearer is avoided as what moves.
fn is_boundary_point(body: &Body) -> bool {
    let point = matches!(body.shape, Shape::Disc { radius } if radius == 0.0);
    point && body.state.velocity == [0.0; 2]
}

/// Whether a body is a rectangle that stands: one that moves is avoided as people are.
fn is_wall(body: &Body) -> bool {
    matches!(body.shape, Shape::Rectangle { .. }) && body.state.velocity == [0.0; 2]
}

/// The planner at work in one scenario.
#[derive(Clone, Debug)]
pub struct ReciprocalPlanner {
    settings: ReciprocalAvoidance,
    goal: Vector,
    robot_radius: f64,
    max_speed: f64,
    /// Cosine and sine of the turn.
    turn: Vector,
    neighbors: Vec<(f64, usize)>,
    planes: Vec<HalfPlane>,
    solver: Solver,
}

impl ReciprocalPlanner {
    /// The planner for one scenario.
    #[must_use]
    pub fn new(settings: ReciprocalAvoidance, scenario: &Scenario) -> Self {
        let (sine, cosine) = settings.turn.sin_cos();
        let count = scenario.obstacle_count();
        Self {
            settings,
            goal: Vector::splat(scenario.goal),
            robot_radius: scenario.robot.radius,
            max_speed: scenario.robot.max_speed,
            turn: Vector2::new(cosine, sine),
            neighbors: Vec::with_capacity(count),
            planes: Vec::with_capacity(count),
            solver: Solver::default(),
        }
    }

    /// Distance of the surfaces less the margin, in m; 0 inside a rectangle.
    #[inline]
    fn gap(&self, body: &Body, position: Vector) -> f64 {
        if let Shape::Disc { radius } = body.shape {
            let to = Vector::splat(body.state.position) - position;
            return to.length() - self.touch(radius);
        }
        let outline = self.outline(body, position);
        let (point, inside) = outline.nearest(Vector::zeros());
        if inside {
            0.0
        } else {
            point.dot(&point).sqrt() - outline.radius
        }
    }

    /// By what neighbors are put in order: what stands with edges comes first, for it cannot be violated.
    fn order(gap: f64, soft: bool) -> f64 {
        if soft { gap.max(0.0) } else { -1.0 }
    }

    /// The velocities that avoid a body.
    fn half_plane(&self, body: &Body, situation: &Situation<'_, f64>) -> HalfPlane {
        let robot = &situation.robot;
        if is_boundary_point(body) {
            return self.off_boundary(Vector::splat(body.state.position) - robot.position);
        }
        let outline = self.outline(body, robot.position);
        let share = if is_wall(body) {
            1.0
        } else {
            self.settings.share
        };
        let horizon = self.settings.horizon;
        avoiding(&outline, robot.velocity, horizon, situation.interval, share)
    }

    /// The permitted velocity nearest to a wanted one, for neighbors with their half-planes.
    fn solve(&mut self, wanted: Vector, plane: impl Fn(&Self, usize) -> HalfPlane) -> Vector {
        sort_pairs(&mut self.neighbors);
        let mut planes = std::mem::take(&mut self.planes);
        planes.clear();
        planes.extend(self.neighbors.iter().map(|(_, index)| plane(self, *index)));
        let hard = self.neighbors.iter().take_while(|(order, _)| *order < 0.0);
        let hard = hard.count();
        let velocity = self.solver.nearest(&planes, hard, self.max_speed, wanted);
        self.planes = planes;
        velocity
    }

    fn outline(&self, body: &Body, position: Vector) -> Outline {
        Outline::new(body, position, self.robot_radius, self.settings.margin)
    }
}

impl Planner for ReciprocalPlanner {
    /// The permitted velocity nearest to the one towards the goal. Rectangles that stand are never
    /// traded for people: where nothing is permitted, only the half-planes of people are violated.
    fn desired_velocity(&mut self, situation: &Situation<'_, f64>) -> [f64; 2] {
        let Situation { bodies, robot, .. } = *situation;
        self.neighbors.clear();
        for (index, body) in bodies.iter().enumerate() {
            if !body.state.present {
                continue;
            }
            let gap = self.gap(body, robot.position);
            if gap < self.settings.reach {
                let soft = !is_wall(body) && !is_boundary_point(body);
                self.neighbors.push((Self::order(gap, soft), index));
            }
        }
        let wanted = self.wanted(self.goal - robot.position, situation.interval);
        let velocity = self.solve(wanted, |own, index| {
            own.half_plane(&bodies[index], situation)
        });
        [velocity.x, velocity.y]
    }

    fn felt_within(&self, obstacle: &PlacedObstacle) -> f64 {
        obstacle.contact_distance + self.settings.margin + self.settings.reach
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.goal = Vector::splat(goal);
    }
}
