//! Virtual-force laws of other authors: an attraction, and a push from every obstacle whose
//! active region the robot is in. They know no critical region and never brake.

mod family;

pub use family::{Pairwise, PairwiseFamily};

use crate::{Command, FieldTerms, LaneLaw, Law, ObstacleTerms, Situation};
use navigation_world::world::geometry::{Body, Offset, RobotState};
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::lanes::{Mask, Planar, Real, Truth, Vector2};

/// Surfaces closer than this push as if they were this far apart, in m; without it the laws that
/// divide by the distance of the surfaces would pull the robot into an obstacle that it touches.
const LEAST_GAP: f64 = 1e-3;

/// One obstacle and its distance from the robot.
#[derive(Clone, Copy, Debug)]
pub struct Neighbor<'a, R: Real> {
    /// The obstacle.
    pub body: &'a Body<R>,
    /// Offset of the robot from it.
    pub offset: Offset<R>,
    /// `d` in m.
    pub distance: R,
    /// `u = D/d`.
    pub outward: Vector2<R>,
    /// Distance of the surfaces in m, at least [`LEAST_GAP`].
    pub gap: R,
    /// `r2` measured between the surfaces, in m.
    pub reach: R,
}

/// Forces of one law, gains in lanes.
pub trait PairwiseField<R: Real>: Copy + Send {
    /// Attraction in N; `inside`: lanes inside an active region.
    fn attraction(&self, to_goal: Vector2<R>, velocity: Vector2<R>, inside: R::Mask) -> Vector2<R>;
    /// Push of an obstacle on the robot inside its active region.
    fn push(&self, neighbor: &Neighbor<'_, R>, robot: &RobotState<R>) -> Push<R>;
}

/// Parts of the force of one obstacle, in N.
#[derive(Clone, Copy, Debug)]
pub struct Push<R> {
    /// Away from the obstacle.
    pub repulsive: Vector2<R>,
    /// Around it.
    pub detour: Vector2<R>,
}

impl<R: Real> Push<R> {
    /// A push without a detour.
    #[inline(always)]
    #[must_use]
    pub fn straight(repulsive: Vector2<R>) -> Self {
        let detour = Vector2::zeros();
        Self { repulsive, detour }
    }
}

/// A law of this kind at work in one scenario.
#[derive(Clone, Copy, Debug)]
pub struct PairwiseLaw<R, F> {
    field: F,
    goal: Vector2<R>,
    robot_radius: f64,
}

impl<R: Real, F: PairwiseField<R>> PairwiseLaw<R, F> {
    /// The law for one scenario.
    #[must_use]
    pub fn new(field: F, scenario: &Scenario) -> Self {
        Self {
            field,
            goal: Vector2::splat(scenario.goal),
            robot_radius: scenario.robot.radius,
        }
    }

    #[inline(always)]
    fn neighbor<'a>(&self, body: &'a Body<R>, offset: Offset<R>) -> Neighbor<'a, R> {
        let distance = offset.distance_squared.sqrt();
        let apart = distance.gt(R::zero());
        // A robot exactly on the centre, or inside a rectangle, is pushed nowhere.
        let outward = offset.vector * (R::splat(1.0) / distance);
        let touching = R::splat(self.robot_radius) + body.shape.inner_radius();
        Neighbor {
            body,
            offset,
            distance,
            outward: Vector2::select(apart, outward, Vector2::zeros()),
            gap: (distance - touching).max(R::splat(LEAST_GAP)),
            reach: body.regions.active_radius - touching,
        }
    }

    /// Lanes inside the active region of an obstacle, and its push there; `None` if no lane is.
    #[inline(always)]
    fn push_of(&self, body: &Body<R>, robot: &RobotState<R>) -> Option<(R::Mask, Push<R>)> {
        let offset = body.offset(robot.position);
        let r2 = body.regions.active_radius;
        let here = body.state.present;
        let active = offset.distance_squared.lt(r2 * r2) & here;
        if !active.any() {
            return None;
        }
        Some((active, self.field.push(&self.neighbor(body, offset), robot)))
    }
}

impl<F: PairwiseField<f64>> PairwiseLaw<f64, F> {
    /// Every term of one evaluation. These laws have neither a critical region nor Omega.
    pub fn terms(&mut self, situation: &Situation<'_, f64>) -> FieldTerms {
        let robot = &situation.robot;
        let pushes: Vec<_> = situation
            .bodies
            .iter()
            .map(|body| (body, self.push_of(body, robot)))
            .collect();
        let inside = pushes.iter().any(|(_, push)| push.is_some());
        let to_goal = self.goal - robot.position;
        let obstacle = |(body, push): &(&Body, Option<(_, Push<f64>)>)| {
            let Some((_, push)) = push else {
                return ObstacleTerms::idle(if body.state.present { "free" } else { "absent" });
            };
            let left = body.offset(robot.position).vector.left_normal();
            let along = push.detour.dot(&left);
            ObstacleTerms {
                repulsive: push.repulsive.lane(0),
                detour: push.detour.lane(0),
                region: "active",
                side: i8::from(along > 0.0) - i8::from(along < 0.0),
            }
        };
        FieldTerms {
            attractive: self
                .field
                .attraction(to_goal, robot.velocity, inside)
                .lane(0),
            obstacles: pushes.iter().map(obstacle).collect(),
            stabilizing: [0.0; 2],
            total: self.command(situation).force.lane(0),
            omega: f64::NAN,
            lyapunov: None,
        }
    }
}

impl<R: Real, F: PairwiseField<R>> LaneLaw<R> for PairwiseLaw<R, F> {}

impl<R: Real, F: PairwiseField<R>> Law<R> for PairwiseLaw<R, F> {
    #[inline(always)]
    fn command(&mut self, situation: &Situation<'_, R>) -> Command<R> {
        let robot = &situation.robot;
        let mut force = Vector2::zeros();
        let mut inside = R::Mask::none();
        for body in situation.bodies {
            let Some((active, push)) = self.push_of(body, robot) else {
                continue;
            };
            inside = inside | active;
            let both = force + (push.repulsive + push.detour);
            force = Vector2::select(active, both, force);
        }
        let to_goal = self.goal - robot.position;
        let attraction = self.field.attraction(to_goal, robot.velocity, inside);
        Command {
            force: attraction + force,
            stabilizing: Vector2::zeros(),
            lyapunov: R::splat(f64::NAN),
        }
    }

    fn felt_within(&self, obstacle: &PlacedObstacle) -> f64 {
        obstacle.regions.active_radius
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.goal = Vector2::splat(goal);
    }
}
