//! Foresight within safe navigation: it chooses among the velocities that the shield verifies.

use crate::foresight::{AcceptedTarget, Driven, Foreseer, Scene, Target, taken_up};
use crate::guide::Guidance;
use crate::safe::law::{SafeLaw, verified_twist};
use crate::safe::watch::Watch;
use crate::shield::{
    Decision, Guard, OutlineGuard, Shield, Status, TwistGuard, TwistView, Verifier, View, braking,
};
use navigation_world::robots::differential::Twist;
use navigation_world::world::geometry::RobotState;
use numeric::lanes::Vector2;

impl SafeLaw {
    /// Knowledge of foresight.
    fn scene<'a>(
        &'a self,
        robot: &RobotState<f64>,
        outline: Option<(&'a OutlineGuard, f64)>,
        to_goal: Vector2<f64>,
    ) -> Scene<'a> {
        let leads = |guidance: &&Guidance| self.detour.is_none() || guidance.leads_around();
        let plan = self.guidance.as_ref().filter(leads).map(Guidance::plan);
        // The plan leads to the goal of the scene, not to one that moves.
        let seen = |goal: &Vector2<f64>| plan.is_none_or(|plan| plan.sees(robot.position, *goal));
        let moving = self.moving.filter(seen);
        Scene {
            robot: *robot,
            goal: moving.unwrap_or(self.goal),
            ahead: to_goal,
            people: &self.around.sightings,
            position_error: self.guard.map_or(0.0, |guard| guard.shield.position_error),
            walls: self.around.walls(),
            outline,
            plan: plan.filter(|_| moving.is_none()),
        }
    }

    /// Command of foresight, among those that the shield verifies.
    pub(super) fn foreseen(
        &self,
        foreseer: &mut Foreseer,
        (guard, outline): (Option<&Guard>, Option<(&OutlineGuard, f64)>),
        robot: &RobotState<f64>,
        wanted: &mut Vector2<f64>,
        to_goal: Vector2<f64>,
    ) -> Decision {
        let view = View {
            robot: *robot,
            people: &self.around.people,
            walls: self.around.walls(),
            hidden: self.watch.as_ref().map(Watch::hidden),
        };
        let disc = guard.filter(|_| outline.is_none());
        let mut verifier = disc.map(|guard| Verifier::new(guard, view));
        let step = foreseer.settings().step;
        let driven = |target: &Target| Driven {
            places: taken_up(robot, target.velocity, self.limits.max_acceleration, step),
            headings: [outline.map_or(0.0, |(_, heading)| heading); 4],
            turn_price: None,
        };
        let take = |target: &Target| {
            let target = self.limits.slowed(target.velocity);
            let command = self.limits.clipped(robot.velocity, target);
            let admits = if let Some(outline) = outline {
                self.verified_outline(outline, &view, command)
            } else {
                let verifier = verifier.as_mut();
                verifier.is_none_or(|verifier| verifier.admits(command))
            };
            admits.then_some(command)
        };
        let mut take = take;
        let found = foreseer
            .decide(
                &self.scene(robot, outline, to_goal),
                false,
                driven,
                &mut take,
            )
            .or_else(|| creeping(guard.map(|guard| &guard.shield), to_goal, take));
        let (velocity, status) = chosen(found, wanted, braking(robot.velocity, &self.limits));
        Decision { velocity, status }
    }

    /// Command of foresight for a robot with two wheels, which drives toward velocities on arcs.
    pub(super) fn foreseen_twist(
        &self,
        foreseer: &mut Foreseer,
        (guard, outline): (&TwistGuard, Option<&OutlineGuard>),
        view: &TwistView<'_>,
        wanted: &mut Vector2<f64>,
        to_goal: Vector2<f64>,
    ) -> (Twist, Status) {
        let (state, step) = (&view.robot, foreseer.settings().step);
        let (sin, cos) = state.heading.sin_cos();
        let robot = RobotState {
            position: state.position,
            velocity: Vector2::new(cos, sin) * state.twist.speed,
        };
        let take = |target: &Target| {
            let twist = guard.toward(state, target.velocity, target.backwards);
            verified_twist((guard, outline), view, twist).then_some(twist)
        };
        let driven = |target: &Target| guard.driven(state, target, step);
        let posed = outline.map(|outline| (outline, state.heading));
        let found = foreseer
            .decide(&self.scene(&robot, posed, to_goal), true, driven, take)
            .or_else(|| creeping(Some(&guard.shield), to_goal, take));
        chosen(found, wanted, guard.limits.braking(state.twist))
    }
}

/// The command toward where the robot is to go that is slow enough not to reckon with people who are not seen.
fn creeping<C>(
    shield: Option<&Shield>,
    to_goal: Vector2<f64>,
    mut take: impl FnMut(&Target) -> Option<C>,
) -> Option<AcceptedTarget<C>> {
    let creep = Some(shield?.unseen?.creep_speed).filter(|creep| *creep > 0.0)?;
    let target = Target {
        velocity: to_goal * (creep / to_goal.norm().max(f64::MIN_POSITIVE)),
        backwards: false,
    };
    take(&target).map(|command| AcceptedTarget {
        command,
        target: target.velocity,
        cheapest: false,
    })
}

/// Command and status of a choice, whose target is what is wanted; braking without one.
fn chosen<C>(
    found: Option<AcceptedTarget<C>>,
    wanted: &mut Vector2<f64>,
    braking: C,
) -> (C, Status) {
    let Some(found) = found else {
        return (braking, Status::Braking);
    };
    *wanted = found.target;
    let status = if found.cheapest {
        Status::Kept
    } else {
        Status::Changed
    };
    (found.command, status)
}
