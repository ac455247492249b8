//! One obstacle as the force field sees it from the robot.

use crate::world::motion::BodyState;
use crate::world::obstacle::Regions;
use crate::world::shape::{Shape, into_axes, out_of_axes};
use numeric::angle::unsigned_angle;
use numeric::lanes::{Mask, Planar, Real, Truth, Vector2};

/// The robot and its goal are collinear with the obstacle when `pi - |Phi|` is below this, in
/// rad; a plain equality would make results depend on the rotation of the scene.
pub const COLLINEAR_ANGLE: f64 = 1e-9;

/// An obstacle closer to the goal than this has no bearing to it, in m.
const ON_THE_GOAL: f64 = 1e-9;

/// State of the robots, one a lane.
#[derive(Clone, Copy, Debug)]
pub struct RobotState<R> {
    /// Position in m.
    pub position: Vector2<R>,
    /// Velocity in m/s.
    pub velocity: Vector2<R>,
}

/// An obstacle at one instant: the same for every lane, or one a lane.
#[derive(Clone, Copy, Debug)]
pub struct Body<B: Real = f64> {
    /// Outline.
    pub shape: Shape<B>,
    /// Region radii.
    pub regions: Regions<B>,
    /// State as the controller knows it.
    pub state: BodyState<B>,
}

impl Body {
    /// The obstacle in every lane.
    #[must_use]
    pub fn widened<B: Real>(&self) -> Body<B> {
        let wide = |pair: [f64; 2]| pair.map(B::splat);
        Body {
            shape: self.shape.widened(),
            regions: Regions {
                critical_radius: B::splat(self.regions.critical_radius),
                active_radius: B::splat(self.regions.active_radius),
            },
            state: BodyState {
                position: wide(self.state.position),
                velocity: wide(self.state.velocity),
                acceleration: wide(self.state.acceleration),
                present: B::Mask::splat(self.state.present),
            },
        }
    }
}

/// Where the robot is relative to an obstacle: enough to tell its region.
#[derive(Clone, Copy, Debug)]
pub struct Offset<R> {
    /// `D`: from the obstacle (centre of a disc, nearest contour point) to the robot, in m.
    pub vector: Vector2<R>,
    /// `d^2` in m^2.
    pub distance_squared: R,
}

impl<B: Real> Body<B> {
    /// Offset of a position from this obstacle.
    #[inline(always)]
    pub fn offset(&self, position: Vector2<B>) -> Offset<B> {
        let from_center = position - Vector2::from(self.state.position);
        let vector = self.shape.offset(from_center);
        Offset {
            vector,
            distance_squared: vector.dot(&vector),
        }
    }
}

/// Everything the forces of one obstacle depend on.
#[derive(Clone, Copy, Debug)]
pub struct Approach<R: Real> {
    /// Lanes inside the active region.
    pub active: R::Mask,
    /// `u = D/d`.
    pub outward: Vector2<R>,
    /// `W`: from the obstacle to the goal, in m; zero for an obstacle on the goal.
    pub to_goal: Vector2<R>,
    /// `D`, in m.
    pub offset: Vector2<R>,
    /// `d` in m.
    pub distance: R,
    /// `ddot = u.(V - V_o)` in m/s.
    pub range_rate: R,
    /// `betadot = t.(V - V_o)/d` in rad/s, `t` left of `u`.
    pub bearing_rate: R,
    /// `alphadot = t_W.(-V_o)/|W|` in rad/s.
    pub goal_bearing_rate: R,
    /// `|Phi|`, `Phi = alpha - beta` wrapped, in rad.
    pub angle: R,
    /// sign of `Phi`: +1 where the shortest turn to the goal is counter-clockwise.
    pub shortest_side: R,
    /// Lanes where `pi - |Phi|` vanishes.
    pub collinear: R::Mask,
    /// `a = r2 - d` in m.
    pub depth: R,
    /// `c = d - r3` in m.
    pub margin: R,
}

impl<R: Real> Approach<R> {
    /// `Phidot = alphadot - betadot` in rad/s.
    #[inline(always)]
    pub fn angle_rate(&self) -> R {
        self.goal_bearing_rate - self.bearing_rate
    }

    /// Seen by the robots from an obstacle. Values are meaningless outside the active region.
    #[inline(always)]
    pub fn new(
        body: &Body<R>,
        offset: Offset<R>,
        active: R::Mask,
        robot: &RobotState<R>,
        goal: Vector2<R>,
    ) -> Self {
        let distance = offset.distance_squared.sqrt();
        let inverse = R::splat(1.0) / distance;
        let outward = offset.vector * inverse;
        let point = NearestPoint::of(body, &offset, robot, goal);
        let relative = robot.velocity - point.velocity;
        let bearing_rate = outward.perp(&relative) * inverse;
        let to_goal = point.to_goal;
        let away = to_goal
            .dot(&to_goal)
            .gt(R::splat(ON_THE_GOAL * ON_THE_GOAL));
        let aim = Vector2::select(away, to_goal, Vector2::zeros());
        let (cross, dot) = (offset.vector.perp(&aim), offset.vector.dot(&aim));
        let behind = dot.lt(R::zero()) & cross.abs().lt(R::splat(-COLLINEAR_ANGLE) * dot);
        Self {
            active,
            outward,
            to_goal: aim,
            offset: offset.vector,
            distance,
            range_rate: outward.dot(&relative),
            bearing_rate: R::select(point.slides, R::zero(), bearing_rate),
            goal_bearing_rate: point.goal_bearing_rate(aim),
            angle: unsigned_angle(cross, dot),
            shortest_side: cross.sign(),
            collinear: behind,
            depth: body.regions.active_radius - distance,
            margin: distance - body.regions.critical_radius,
        }
    }
}

/// The point of an obstacle that distances are measured from.
struct NearestPoint<R: Real> {
    /// Velocity in m/s: that of the obstacle, and along a face that of the robot relative to it.
    velocity: Vector2<R>,
    /// Where it slides along a face with the robot.
    slides: R::Mask,
    /// Where its direction from the goal may change.
    moves: R::Mask,
    /// From it to the goal, in m.
    to_goal: Vector2<R>,
}

impl<R: Real> NearestPoint<R> {
    /// Rectangles keep their heading.
    #[inline(always)]
    fn of(body: &Body<R>, offset: &Offset<R>, robot: &RobotState<R>, goal: Vector2<R>) -> Self {
        let (center, own) = (
            Vector2::from(body.state.position),
            Vector2::from(body.state.velocity),
        );
        match body.shape {
            Shape::Disc { .. } => Self {
                velocity: own,
                slides: R::Mask::none(),
                moves: !at_rest(body.state.velocity),
                // Straight from its center, so that one on the goal gives exactly zero.
                to_goal: goal - center,
            },
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => {
                let local = into_axes(robot.position - center, axis);
                // No branch for those that stand: with one the compiler takes the lanes of all apart.
                let velocity = into_axes(robot.velocity - own, axis);
                let beside = local.x.abs().le(half_length);
                let abreast = local.y.abs().le(half_width);
                let slide = Vector2::new(
                    R::select(beside, velocity.x, R::zero()),
                    R::select(abreast, velocity.y, R::zero()),
                );
                Self {
                    velocity: own + out_of_axes(slide, axis),
                    slides: beside | abreast,
                    moves: R::Mask::splat(true),
                    to_goal: goal - (robot.position - offset.vector),
                }
            }
        }
    }

    /// `alphadot = t_W.(-V_o)/|W|` in rad/s; 0 for an obstacle exactly on the goal.
    #[inline(always)]
    fn goal_bearing_rate(&self, to_goal: Vector2<R>) -> R {
        if !self.moves.any() {
            return R::zero();
        }
        let length_squared = to_goal.dot(&to_goal);
        let rate = -to_goal.perp(&self.velocity) / length_squared;
        R::select(length_squared.gt(R::zero()) & self.moves, rate, R::zero())
    }
}

/// Where both components are zero, of either sign.
#[inline(always)]
pub fn at_rest<B: Real>([x, y]: [B; 2]) -> B::Mask {
    let zero = B::zero();
    x.le(zero) & x.ge(zero) & y.le(zero) & y.ge(zero)
}

/// Lanes whose segment from robot to goal meets the rectangle, and the cross product of the
/// directions from the centroid to robot and goal, with their dot product.
#[inline(always)]
#[must_use]
pub fn separation<R: Real>(
    body: &Body<R>,
    half: [R; 2],
    axis: Vector2<R>,
    position: Vector2<R>,
    goal: Vector2<R>,
) -> (R::Mask, R, R) {
    let center = Vector2::from(body.state.position);
    let from = into_axes(position - center, axis);
    let to = into_axes(goal - center, axis);
    // Separating axes of a segment (midpoint m, half vector h) and a box (Ericson 2005, 5.3.3).
    let two = R::splat(0.5);
    let middle = (from + to) * two;
    let reach = (to - from) * two;
    let [half_x, half_y] = half;
    let overlaps = middle.x.abs().le(half_x + reach.x.abs())
        & middle.y.abs().le(half_y + reach.y.abs())
        & middle
            .perp(&reach)
            .abs()
            .le(half_x * reach.y.abs() + half_y * reach.x.abs());
    (overlaps, from.perp(&to), from.dot(&to))
}
