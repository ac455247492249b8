//! Motion steps of robots side by side.

use crate::run::runs::LaneState;
use crate::run::scene::World;
use navigation_world::world::geometry::RobotState;
use numeric::lanes::{Real, Vector2};

#[inline(always)]
pub(crate) fn semi_implicit_euler<W: World, R: Real>(runs: &mut LaneState<W, R>) {
    let robot = &runs.scenario.common().robot;
    let (position, velocity) = (runs.position, runs.velocity);
    let mut state = RobotState { position, velocity };
    runs.speed = robot.advance(&mut state, runs.push, runs.clock.step);
    (runs.position, runs.velocity) = (state.position, state.velocity);
}

/// Runge-Kutta of order 4 with a held acceleration; the second and third stage coincide.
pub(crate) fn rk4_held<W: World, R: Real>(runs: &mut LaneState<W, R>) {
    let robot = &runs.scenario.common().robot;
    let step = runs.clock.step;
    let change = robot.change(runs.velocity, runs.acceleration * R::splat(step), step);
    let at = |share: f64| match robot.max_deceleration {
        None => runs.velocity + runs.acceleration * R::splat(share * step),
        Some(_) => runs.velocity + change * R::splat(share),
    };
    let middle = robot.limited_velocity(at(0.5)).0;
    let (last, speed) = robot.limited_velocity(at(1.0));
    let weighted = runs.velocity + middle * R::splat(4.0) + last;
    runs.position += weighted * R::splat(step / 6.0);
    (runs.velocity, runs.speed) = (last, speed);
}

/// Runge-Kutta of order 4 with the force evaluated in every stage: in N, after a share of the step.
pub(crate) fn rk4<W: World, R: Real>(
    runs: &mut LaneState<W, R>,
    mut force: impl FnMut(f64, RobotState<R>) -> Vector2<R>,
) {
    let robot = &runs.scenario.common().robot;
    let step = runs.clock.step;
    let begun = runs.velocity;
    // Every stage keeps the limits of the velocity at the start of the step.
    let kept = |acceleration: Vector2<R>| match robot.max_deceleration {
        None => acceleration,
        Some(_) => robot.change(begun, acceleration * R::splat(step), step) * R::splat(1.0 / step),
    };
    let first = kept(runs.acceleration);
    let (start, velocity) = (runs.position, runs.velocity);
    let mut push = |share: f64, position, velocity| {
        kept(robot.acceleration(force(share, RobotState { position, velocity })))
    };
    let limited = |velocity| robot.limited_velocity(velocity).0;
    let (half, whole) = (R::splat(0.5 * step), R::splat(step));
    let v2 = limited(velocity + first * half);
    let second = push(0.5, start + velocity * half, v2);
    let v3 = limited(velocity + second * half);
    let third = push(0.5, start + v2 * half, v3);
    let v4 = limited(velocity + third * whole);
    let fourth = push(1.0, start + v3 * whole, v4);
    let (sixth, two) = (R::splat(step / 6.0), R::splat(2.0));
    runs.position = start + (velocity + (v2 + v3) * two + v4) * sixth;
    let gain = (first + (second + third) * two + fourth) * sixth;
    let gain = robot.change(velocity, gain, step);
    (runs.velocity, runs.speed) = robot.limited_velocity(velocity + gain);
}
