//! Social force between a robot and a person, which measures how much they are in each other's way.

use crate::crowd::agent::SHORTEST;
use crate::crowd::moussaid::Moussaid;
use crate::lanes::Vector2;

type Vector = Vector2<f64>;

/// The model of Moussaid et al. (2009) without preference for a side; of its parameters only those of the push
/// between two people matter here.
const MODEL: Moussaid = Moussaid {
    relaxation_time: 0.54,
    strength: 4.5,
    gamma: 0.35,
    n: 2.0,
    n_prime: 3.0,
    velocity_weight: 2.0,
    side_bias: 0.0,
    wall_strength: 3.0,
    wall_range: 0.1,
    gaze: 4.0,
    cohesion: 3.0,
    separation: 1.0,
    view_angle: std::f64::consts::FRAC_PI_2,
    contact_distance: 0.55,
    cutoff: f64::INFINITY,
};

/// Forces on the person and on the robot, in m/s^2.
///
/// `to_person` is the position of the person less that of the robot, `closing` the velocity of the person
/// less that of the robot.
#[inline]
pub(super) fn forces(to_person: Vector, closing: Vector) -> [Vector; 2] {
    let distance = to_person.norm();
    if distance < SHORTEST {
        // Where both stand at one point each is pushed along x.
        return [closing, -closing].map(|relative| MODEL.push(Vector::x(), distance, relative));
    }
    // Seen from the robot everything is reversed.
    let on_person = MODEL.push(to_person / distance, distance, closing);
    [on_person, -on_person]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_are_pushed_alike_in_opposite_directions() {
        let (to_person, closing) = (Vector::new(1.2, -0.7), Vector::new(-1.1, 0.4));
        let [on_person, on_robot] = forces(to_person, closing);
        let distance = to_person.norm();
        let own = MODEL.push(-to_person / distance, distance, -closing);
        assert!((on_robot - own).norm() < 1e-13);
        assert_eq!(on_person, -on_robot);
    }

    #[test]
    fn who_walks_straight_at_the_other_is_braked_only() {
        let [on_person, on_robot] = forces(Vector::new(2.0, 0.0), Vector::new(-1.0, 0.0));
        assert!(on_person.x > 0.0 && on_person.y == 0.0);
        assert_eq!(on_robot, -on_person);
    }

    #[test]
    fn at_one_point_both_are_pushed_along_x() {
        let [on_person, on_robot] = forces(Vector::zeros(), Vector::zeros());
        assert_eq!(on_person, Vector::new(MODEL.strength, 0.0));
        assert_eq!(on_robot, on_person);
    }
}
