//! On which side the detour leads around an obstacle: the rules of Zeng (2011), 5.4.

use navigation_world::world::geometry::{Approach, Body, COLLINEAR_ANGLE, RobotState, separation};
use navigation_world::world::obstacle::Shape;
use numeric::lanes::{Real, Truth, Vector2};

/// An obstacle faster than this counts as moving, in m/s.
const MOVING_SPEED: f64 = 0.05;

/// Robot and goal are on a side of a velocity line only beyond this distance, in m.
const VELOCITY_LINE: f64 = 1e-9;

/// Which rules apply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideRules {
    /// Moving obstacles are passed behind.
    pub pass_behind: bool,
    /// The side is kept as long as `|Phi|` is larger than this, in rad; infinite: never.
    pub hysteresis: f64,
}

/// Side and turn of a detour.
#[derive(Clone, Copy, Debug)]
pub struct DetourSide<R: Real> {
    /// `s`: +1 counter-clockwise, -1 clockwise, 0 not decided yet.
    pub side: R,
    /// Angle still to be turned, in rad: `|Phi|`, or `2 pi - |Phi|` on a latched long way round.
    pub turn: R,
    /// `sigma = s sign(Phi)`, and 1 on a latched long way round, whose turn shrinks.
    pub descent: R,
}

/// Side from the rules that need no other obstacle; 0 where only the tie-break can tell.
///
/// In order: a moving obstacle that robot and goal straddle is passed behind (Fig. 5.8a), a rectangle
/// between robot and goal is passed on the robot's side of its centroid (Fig. 5.9), exactly collinear is left open, anything else turns the shortest way.
#[inline(always)]
pub fn decide<R: Real>(
    rules: &SideRules,
    body: &Body<R>,
    approach: &Approach<R>,
    robot: &RobotState<R>,
    goal: Vector2<R>,
) -> R {
    let side = R::select(approach.collinear, R::zero(), approach.shortest_side);
    match body.shape {
        Shape::Disc { .. } => behind(rules, body, (approach.offset, approach.to_goal), side),
        Shape::Rectangle {
            half_length,
            half_width,
            axis,
        } => {
            let half = [half_length, half_width];
            let (between, cross, dot) = separation(body, half, axis, robot.position, goal);
            let open = dot.lt(R::zero()) & cross.abs().lt(R::splat(-COLLINEAR_ANGLE) * dot);
            let own = R::select(open, R::zero(), cross.sign());
            let side = R::select(between, own, side);
            let center = Vector2::from(body.state.position);
            behind(rules, body, (robot.position - center, goal - center), side)
        }
    }
}

/// The side that leads behind a moving obstacle which robot and goal straddle, given as seen from its
/// center; the side as it is otherwise.
#[inline(always)]
fn behind<R: Real>(
    rules: &SideRules,
    body: &Body<R>,
    (to_robot, to_goal): (Vector2<R>, Vector2<R>),
    side: R,
) -> R {
    let [x, y] = body.state.velocity;
    let speed = (x * x + y * y).sqrt();
    let moving = speed.gt(R::splat(MOVING_SPEED));
    if !rules.pass_behind || !moving.any() {
        return side;
    }
    let course: Vector2<R> = Vector2::from([x / speed, y / speed]);
    let robot_side = course.perp(&to_robot);
    let goal_side = course.perp(&to_goal);
    let line = R::splat(VELOCITY_LINE);
    let straddled =
        (robot_side.gt(line) & goal_side.lt(-line)) | (robot_side.lt(-line) & goal_side.gt(line));
    R::select(straddled & moving, robot_side.sign(), side)
}

/// Turn of a decided side, and the side that hysteresis keeps.
///
/// `latched` is the side at the sample before, 0 if the robot was outside the active region.
#[inline(always)]
pub fn latch<R: Real>(
    rules: &SideRules,
    approach: &Approach<R>,
    side: R,
    latched: R,
) -> DetourSide<R> {
    let mut detour = DetourSide {
        side,
        turn: approach.angle,
        descent: side * approach.shortest_side,
    };
    if rules.hysteresis.is_finite() {
        let kept = latched.abs().gt(R::zero()) & approach.angle.gt(R::splat(rules.hysteresis));
        let long_way = kept & (latched * approach.shortest_side).lt(R::zero());
        detour.side = R::select(kept, latched, side);
        let whole = R::splat(std::f64::consts::TAU);
        detour.turn = R::select(long_way, whole - approach.angle, approach.angle);
        detour.descent = R::select(
            long_way,
            R::splat(1.0),
            detour.side * approach.shortest_side,
        );
    }
    detour
}

/// Tie-break (5.4.4) for a robot, goal and obstacle in line: towards the sum of the other
/// detour forces, counter-clockwise when that sum has no component across, relative to the
/// summed magnitudes.
#[inline(always)]
pub fn tie_break<R: Real>(outward: Vector2<R>, others: Vector2<R>, magnitudes: R) -> R {
    let across = outward.perp(&others);
    let clear = across.abs().gt(R::splat(COLLINEAR_ANGLE) * magnitudes);
    // Lanes without any other force have 0 > 0, which is false: counter-clockwise.
    R::select(clear, across.sign(), R::splat(1.0))
}
