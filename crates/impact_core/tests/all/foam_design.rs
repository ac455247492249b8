//! Foam boundaries of the specification.

use impact_core::foam_design::{
    CrossingStatus, DesignProblem, FoamBoundary, Quantity, Requirement, stiffness_lower,
    stiffness_upper,
};
use impact_core::parameters::{
    FOAM_1, FOAM_2, FOAM_3, HEAD_MAXIMUM, HEAD_MINIMUM, MANIPULATOR_1, MANIPULATOR_2, Manipulator,
    Target,
};

const ACCELERATION: Requirement = Requirement {
    quantity: Quantity::HeadAcceleration,
    limit: 10.0,
    head: Target::Free(HEAD_MINIMUM),
};
const COMPRESSION: Requirement = Requirement {
    quantity: Quantity::Compression,
    limit: 0.02,
    head: Target::Free(HEAD_MAXIMUM),
};

fn upper(manipulator: Manipulator, damping: f64) -> FoamBoundary {
    stiffness_upper(
        &DesignProblem::new(manipulator, 1.25),
        &[ACCELERATION],
        damping,
    )
    .unwrap()
}

fn lower(manipulator: Manipulator, damping: f64) -> FoamBoundary {
    stiffness_lower(
        &DesignProblem::new(manipulator, 1.25),
        &[COMPRESSION],
        damping,
    )
    .unwrap()
}

fn agrees(value: f64, printed: f64, unit: f64) {
    assert!(
        (value - printed).abs() <= 0.5 * unit,
        "{value} for {printed}"
    );
}

#[test]
fn boundaries_of_the_table() {
    for (damping, printed) in [
        (0.0, [46.036, 16.667, 37.262, 22.459]),
        (71.9, [55.860, 12.444, 44.502, 17.350]),
        (200.0, [64.730, 10.981, 50.761, 11.597]),
    ] {
        agrees(
            upper(MANIPULATOR_1, damping).stiffness,
            1e3 * printed[0],
            1.0,
        );
        agrees(
            lower(MANIPULATOR_1, damping).stiffness,
            1e3 * printed[1],
            1.0,
        );
        agrees(
            upper(MANIPULATOR_2, damping).stiffness,
            1e3 * printed[2],
            1.0,
        );
        agrees(
            lower(MANIPULATOR_2, damping).stiffness,
            1e3 * printed[3],
            1.0,
        );
    }
}

#[test]
fn upper_boundary_ends_where_the_first_step_reaches_the_limit() {
    agrees(upper(MANIPULATOR_1, 300.0).stiffness, 60_663.0, 1.0);
    agrees(upper(MANIPULATOR_2, 300.0).stiffness, 47_098.0, 1.0);
    let last = 10.0 * 9.806_65 * 4.4 / 1.25;
    agrees(last, 345.194, 1e-3);
    agrees(upper(MANIPULATOR_1, 345.194).stiffness, 43_131.0, 1.0);
    agrees(upper(MANIPULATOR_2, 345.194).stiffness, 33_125.0, 1.0);
    let beyond = upper(MANIPULATOR_1, 346.0);
    assert_eq!(beyond.status, CrossingStatus::None);
    assert!(beyond.stiffness.is_nan() && !beyond.holds_below);
}

#[test]
fn lower_boundary_changes_its_meaning() {
    let status = |damping: f64| lower(MANIPULATOR_1, damping).status;
    assert_eq!(status(71.0), CrossingStatus::LocalMaximum);
    assert_eq!(status(100.0), CrossingStatus::EndOfImpactPeriod);
    assert_eq!(status(210.7), CrossingStatus::EndOfImpactPeriod);
    let jump = lower(MANIPULATOR_1, 215.0);
    assert_eq!(jump.status, CrossingStatus::Jump);
    // Where the dip of the acceleration touches zero, and with it the impact period jumps. The
    // source of the printed 12073.10 steps over a dip that is 0.007 m/s^2 deep there.
    agrees(jump.stiffness, 12_026.14, 0.01);
    for damping in [215.0, 250.0, 270.0, 296.6] {
        assert_eq!(status(damping), CrossingStatus::Jump);
    }
    assert_eq!(lower(MANIPULATOR_1, 262.0).crossings.len(), 1);
    assert!(lower(MANIPULATOR_1, 270.0).crossings.len() > 1);
    let both = lower(MANIPULATOR_1, 300.0);
    println!("{both:?}");
    agrees(both.crossings[0].stiffness, 1698.4, 0.1);
    agrees(both.stiffness, 19_165.6, 0.1);
    let everywhere = lower(MANIPULATOR_2, 300.0);
    assert_eq!(everywhere.status, CrossingStatus::None);
    assert!(everywhere.holds_below && everywhere.holds_above);
}

#[test]
fn foams_of_the_source_are_classified() {
    let ratios = |manipulator, foam| {
        DesignProblem::new(manipulator, 1.25)
            .ratios(&[ACCELERATION, COMPRESSION], &foam)
            .unwrap()
    };
    for manipulator in [MANIPULATOR_1, MANIPULATOR_2] {
        assert!(
            ratios(manipulator, FOAM_1)
                .iter()
                .all(|ratio| *ratio <= 1.0)
        );
    }
    agrees(0.02 * ratios(MANIPULATOR_1, FOAM_2)[1], 0.019_992, 1e-6);
    agrees(0.02 * ratios(MANIPULATOR_2, FOAM_2)[1], 0.024_05, 1e-5);
    agrees(10.0 * ratios(MANIPULATOR_1, FOAM_3)[0], 10.06, 0.01);
    agrees(10.0 * ratios(MANIPULATOR_2, FOAM_3)[0], 11.55, 0.01);
}

#[test]
fn fastest_impact_of_the_specification() {
    for (manipulator, printed) in [(MANIPULATOR_1, 1.911_13), (MANIPULATOR_2, 1.625_38)] {
        let fastest = DesignProblem::new(manipulator, 1.25)
            .fastest(&[ACCELERATION, COMPRESSION], 71.9)
            .unwrap();
        agrees(fastest.closing_speed, printed, 1e-5);
    }
}
