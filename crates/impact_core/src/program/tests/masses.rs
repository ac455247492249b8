//! Masses against closed forms, and one below the other.

use proptest::prelude::*;

use super::{motion, planar, six};

#[test]
fn masses_of_a_planar_tip() {
    let ([l1, l2], [m1, m2]): ([f64; 2], [f64; 2]) = ([0.25, 0.35], [5.21, 0.6]);
    let arm = planar([l1, l2], [m1, m2]);
    let bend: f64 = 2.43;
    // Across the second link it turns about the elbow, along it it takes the elbow along.
    let across = motion::<4>(&arm, "l2", [l2, 0.0, 0.0], &[0.4, bend], &[0.0, 1.3]);
    assert!((across.speed - 1.3 * l2).abs() < 1e-15);
    assert!((across.along_motion / m2 - 1.0).abs() < 1e-12);
    let heavy = m2 + m1 / bend.sin().powi(2);
    // Velocity along the second link: the first joint moves the tip, the second one takes away what is across.
    let rate = -(l2 + l1 * bend.cos()) / l2;
    let along = motion::<4>(&arm, "l2", [l2, 0.0, 0.0], &[0.4, bend], &[1.0, rate]);
    assert!((along.along_motion / heavy - 1.0).abs() < 1e-12);
    assert!((along.worst_normal / heavy - 1.0).abs() < 1e-12);
    assert!((along.energy / heavy - 1.0).abs() < 1e-12);
    assert!((along.reduced_worst(3.0) * (1.0 / heavy + 1.0 / 3.0) - 1.0).abs() < 1e-12);
}

#[test]
fn a_point_on_the_axis_stands_still_and_a_stretched_arm_has_no_infinite_mass() {
    let arm = planar([0.3, 0.2], [2.0, 1.0]);
    let still = motion::<4>(&arm, "l1", [0.0, 0.0, 0.1], &[0.4, 0.0], &[1.0, 0.0]);
    assert_eq!(still.speed, 0.0);
    assert!(still.along_motion.is_nan());
    let stretched = motion::<4>(&arm, "l2", [0.2, 0.0, 0.0], &[0.4, 0.0], &[1.0, 1.0]);
    assert!(stretched.worst_normal.is_finite());
    assert!(stretched.along_motion <= stretched.worst_normal);
    assert!(stretched.worst_normal <= stretched.energy);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn masses_stand_one_below_the_other(
        joints in prop::collection::vec(-3.0..3.0, 6),
        rates in prop::collection::vec(-2.0..2.0, 6),
        link in 1_usize..7,
        point in prop::array::uniform3(-0.3..0.3),
        body in 0.1..100.0,
    ) {
        let found = motion::<6>(&six(), &format!("l{link}"), point, &joints, &rates);
        prop_assert!(found.along_motion > 0.0);
        prop_assert!(found.along_motion <= found.worst_normal);
        prop_assert!(found.worst_normal <= found.energy);
        let (along, worst) = (found.reduced_along(body), found.reduced_worst(body));
        prop_assert!(along <= worst * (1.0 + 1e-12) && worst <= found.worst_normal);
    }
}
