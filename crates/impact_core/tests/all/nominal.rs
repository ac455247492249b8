//! Nominal figures, to every digit that the specification prints.

use impact_core::criteria::metrics;
use impact_core::error::Failure;
use impact_core::joint::drive::SetPoint;
use impact_core::metrics::{MetricOptions, Status};
use impact_core::parameters::{
    FOAM_1, FOAM_3, Foam, HEAD_APPARATUS, HEAD_MINIMUM, MANIPULATOR_1, MANIPULATOR_2, System,
    Target,
};
use impact_core::response::{
    Approach, Contact, Equations, Method, SimulationOptions, simulate, simulate_until,
};

/// Direct-drive manipulator, Foam 1 as measured, head of the apparatus.
fn nominal() -> System {
    System {
        manipulator: MANIPULATOR_1,
        foam: Foam {
            stiffness: 24.25e3,
            damping: 71.9,
            thickness: 0.0254,
            linear_range: 0.02,
        },
        head: Target::Free(HEAD_APPARATUS),
    }
}

/// Half a unit of the last printed digit.
fn agrees(value: f64, printed: f64, unit: f64) {
    assert!(
        (value - printed).abs() <= 0.5 * unit,
        "{value} for {printed}"
    );
}

#[test]
fn metrics_of_the_nominal_impact() {
    let m = metrics(&nominal(), 1.25, &MetricOptions::default()).unwrap();
    println!("{m:#?}");
    agrees(m.peak_contact_force, 299.120_823, 1e-6);
    agrees(m.peak_head_acceleration_g, 6.567_85, 1e-5);
    agrees(m.hic15, 1.370_26, 1e-5);
    agrees(m.hic36, 1.614_66, 1e-5);
    agrees(m.max_compression, 0.011_975, 1e-6);
    agrees(m.average_3ms_g, 6.548_04, 1e-5);
    agrees(m.clip_3ms_g, 6.508_46, 1e-5);
    agrees(m.mean_head_acceleration_g, 4.382_34, 1e-5);
    agrees(m.peak_power_manipulator, 301.16, 1e-2);
    agrees(m.peak_power_foam, 212.910, 1e-3);
    assert_eq!(m.status, Status::Released);
    let slow = MetricOptions {
        manipulator_speed: Some(0.25),
        ..MetricOptions::default()
    };
    let m = metrics(&nominal(), 1.25, &slow).unwrap();
    agrees(m.peak_power_manipulator, 36.94, 1e-2);
}

fn exact(contact: Contact, set_point: SetPoint) -> SimulationOptions {
    SimulationOptions {
        duration: 0.06,
        step: 1e-3,
        method: Method::Exact,
        contact,
        set_point,
        equations: Equations::Corrected,
    }
}

fn approach(closing_speed: f64) -> Approach {
    Approach {
        closing_speed,
        manipulator_speed: None,
    }
}

#[test]
fn state_of_the_nominal_impact_at_60_ms() {
    for contact in [Contact::Linear, Contact::Unilateral] {
        let options = exact(contact, SetPoint::default());
        let r = simulate(&nominal(), &approach(1.25), &options).unwrap();
        assert_eq!(r.time.len(), 61);
        assert!(r.releases.is_empty());
        agrees(r.manipulator_position[60], 0.064_148_060_444_069_1, 2e-15);
        agrees(r.manipulator_velocity[60], 1.345_018_422_810_622_8, 4e-14);
        agrees(
            r.head_position[60] - 0.0254,
            0.058_218_591_148_986_36,
            2e-15,
        );
        // From a matrix exponential of 40 digits; the printed 0.867_762_397_946_4 is wrong from the ninth.
        agrees(r.head_velocity[60], 0.867_762_393_947_603_7, 4e-15);
    }
}

#[test]
fn foam_releases_when_the_specification_says() {
    let foam3 = System {
        manipulator: MANIPULATOR_1,
        foam: FOAM_3,
        head: Target::Free(HEAD_MINIMUM),
    };
    let puma = System {
        manipulator: MANIPULATOR_2,
        foam: FOAM_1,
        head: Target::Free(HEAD_APPARATUS),
    };
    for (system, printed) in [(foam3, 0.024_928_11), (puma, 0.047_138_50)] {
        let options = exact(Contact::Unilateral, SetPoint::default());
        let r = simulate(&system, &approach(1.25), &options).unwrap();
        println!("{:?} {:?}", r.releases, r.touches);
        agrees(r.releases[0], printed, 1e-8);
        let mut errors = [0.0; 2];
        for (error, step) in errors.iter_mut().zip([1e-3, 5e-4]) {
            let options = SimulationOptions {
                method: Method::RungeKutta,
                step,
                ..options.clone()
            };
            let steps = simulate(&system, &approach(1.25), &options).unwrap();
            let last = steps.time.len() - 1;
            *error = (steps.head_position[last] - r.head_position[60]).abs();
            assert!((steps.releases[0] - printed).abs() < 1e-5);
        }
        println!("{errors:?}");
        assert!(errors[0] / errors[1] > 12.0);
    }
}

#[test]
fn driven_manipulator_gives_the_percentages_of_the_specification() {
    let system = System {
        head: Target::Free(HEAD_MINIMUM),
        ..nominal()
    };
    let peaks = |acceleration: f64, feed_forward: bool| {
        let set_point = SetPoint::accelerating(acceleration, 0.05, feed_forward).unwrap();
        let options = exact(Contact::Linear, set_point);
        let r = simulate(&system, &approach(1.25), &options).unwrap();
        r.peaks.unwrap()
    };
    let still = peaks(0.0, true);
    let a = 0.51 * 9.806_65;
    let percent = |value: f64, base: f64| 100.0 * (value / base - 1.0);
    for (sign, feed_forward, force, head, unit) in [
        (1.0, true, 4.68, 3.97, 0.01),
        (-1.0, true, -4.41, -3.77, 0.01),
        (1.0, false, 0.899, 0.634, 0.001),
        (-1.0, false, -0.861, -0.615, 0.001),
    ] {
        let driven = peaks(sign * a, feed_forward);
        agrees(
            percent(driven.contact_force, still.contact_force),
            force,
            unit,
        );
        agrees(
            percent(driven.head_acceleration, still.head_acceleration),
            head,
            unit,
        );
    }
}

#[test]
fn printed_coefficient_changes_nothing_without_damping_of_the_neck() {
    let options = exact(Contact::Linear, SetPoint::default());
    let printed = SimulationOptions {
        equations: Equations::AsPrinted,
        ..options.clone()
    };
    let [right, other] =
        [options, printed].map(|options| simulate(&nominal(), &approach(1.25), &options).unwrap());
    for (one, other) in [
        (&right.contact_force, &other.contact_force),
        (&right.head_position, &other.head_position),
        (&right.manipulator_velocity, &other.manipulator_velocity),
        (&right.compression, &other.compression),
    ] {
        let scale = one
            .iter()
            .fold(0.0_f64, |scale, value| scale.max(value.abs()));
        for (one, other) in one.iter().zip(other) {
            assert!((one - other).abs() < 1e-13 * scale, "{one} {other}");
        }
    }
}

#[test]
fn printed_coefficient_is_for_the_plain_response_only() {
    let plain = SimulationOptions {
        equations: Equations::AsPrinted,
        ..exact(Contact::Linear, SetPoint::default())
    };
    let moving = SetPoint::accelerating(1.0, 0.05, false).unwrap();
    for options in [
        SimulationOptions {
            method: Method::RungeKutta,
            ..plain.clone()
        },
        SimulationOptions {
            contact: Contact::Unilateral,
            ..plain.clone()
        },
        SimulationOptions {
            set_point: moving,
            ..plain.clone()
        },
    ] {
        let error = simulate(&nominal(), &approach(1.25), &options).unwrap_err();
        assert!(error.to_string().starts_with("equations must"), "{error}");
    }
}

#[test]
fn simulation_stops_when_asked() {
    for method in [Method::Exact, Method::RungeKutta] {
        let options = SimulationOptions {
            method,
            step: 1e-6,
            ..exact(Contact::Linear, SetPoint::default())
        };
        let error = simulate_until(&nominal(), &approach(1.25), &options, &|| true).unwrap_err();
        assert_eq!(error, Failure::Interrupted);
    }
}
