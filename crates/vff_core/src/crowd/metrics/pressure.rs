//! Social force between a robot and a person, which measures how much they are in each other's way.
//!
//! The interaction of M. Moussaid et al. (2009), Proc. R. Soc. B 276, without preference for a side.

use std::f64::consts::PI;

use nalgebra::Vector2;

use crate::robots::differential::wrapped;

/// Strength `A`, in m/s^2.
const STRENGTH: f64 = 4.5;
/// Range over the length of the interaction vector, `gamma`.
const RANGE: f64 = 0.35;
/// Decay with the angle of turning, `n`.
const TURNING: f64 = 2.0;
/// Decay with the angle of braking, `n'`.
const BRAKING: f64 = 3.0;
/// Weight of velocities against the direction, `lambda`.
const VELOCITY_WEIGHT: f64 = 2.0;
/// Distances and interaction vectors below it have no direction.
const NOWHERE: f64 = 1e-9;
/// Angles nearer to straight ahead or straight behind than this may differ in sign by rounding, in rad.
const STRAIGHT: f64 = 1e-9;

/// Forces on the person and on the robot, in m/s^2.
///
/// `to_person` is the position of the person less that of the robot, `closing` the velocity of the person
/// less that of the robot.
#[inline]
pub(super) fn forces(to_person: Vector2<f64>, closing: Vector2<f64>) -> [Vector2<f64>; 2] {
    let distance = to_person.norm();
    if distance < NOWHERE {
        // Where both stand at one point each is pushed along x.
        return [
            force(distance, Vector2::x(), closing),
            force(distance, Vector2::x(), -closing),
        ];
    }
    let outward = to_person / distance;
    let toward = -outward;
    let sum = closing * VELOCITY_WEIGHT + toward;
    let theta = toward.perp(&sum).atan2(toward.dot(&sum));
    if theta.abs() < STRAIGHT || theta.abs() > PI - STRAIGHT {
        return [
            force(distance, outward, closing),
            force(distance, toward, -closing),
        ];
    }
    // Seen from the robot everything is reversed.
    let on_person = turned(distance, sum, theta);
    [on_person, -on_person]
}

/// Force on one from another, from whom `outward` points to him and whose velocity is less by `relative`.
fn force(distance: f64, outward: Vector2<f64>, relative: Vector2<f64>) -> Vector2<f64> {
    let toward = -outward;
    let sum = relative * VELOCITY_WEIGHT + toward;
    let angle = |vector: Vector2<f64>| vector.y.atan2(vector.x);
    turned(distance, sum, wrapped(angle(sum) - angle(toward)))
}

/// `A exp(-d/B) (-exp(-(n' B theta)^2) t + sign(theta) exp(-(n B theta)^2) t_left)`, `t = D/|D|`,
/// `B = gamma |D|`.
#[inline]
fn turned(distance: f64, sum: Vector2<f64>, theta: f64) -> Vector2<f64> {
    let length = sum.norm();
    if length < NOWHERE {
        return Vector2::zeros();
    }
    let along = sum / length;
    let range = RANGE * length;
    let decay = -distance / range;
    let spread = range * theta;
    let brake = (decay - (BRAKING * spread).powi(2)).exp();
    let turn = (decay - (TURNING * spread).powi(2)).exp();
    let side = if theta == 0.0 { 0.0 } else { theta.signum() };
    (Vector2::new(-along.y, along.x) * (side * turn) - along * brake) * STRENGTH
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_are_pushed_alike_in_opposite_directions() {
        let (to_person, closing) = (Vector2::new(1.2, -0.7), Vector2::new(-1.1, 0.4));
        let [on_person, on_robot] = forces(to_person, closing);
        let distance = to_person.norm();
        let outward = to_person / distance;
        assert!((on_person - force(distance, outward, closing)).norm() < 1e-13);
        assert!((on_robot - force(distance, -outward, -closing)).norm() < 1e-13);
    }

    #[test]
    fn who_walks_straight_at_the_other_is_braked_only() {
        let [on_person, on_robot] = forces(Vector2::new(2.0, 0.0), Vector2::new(-1.0, 0.0));
        assert!(on_person.x > 0.0 && on_person.y == 0.0);
        assert_eq!(on_robot, -on_person);
    }

    #[test]
    fn at_one_point_both_are_pushed_along_x() {
        let [on_person, on_robot] = forces(Vector2::zeros(), Vector2::zeros());
        assert_eq!(on_person, Vector2::new(STRENGTH, 0.0));
        assert_eq!(on_robot, on_person);
    }
}
