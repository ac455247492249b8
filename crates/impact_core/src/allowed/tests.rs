use serde_json::Value;

use super::{
    Drive, LimitedContact, Limits, clopper_pearson, differential_mass, holonomic_mass,
    least_thickness, normal_probability, numeric_speed,
};
use crate::collision::reading::{collision, number_or, pad, region};
use crate::collision::{Wanted, simulate};

fn cases() -> Value {
    serde_json::from_str(include_str!("../../../../tests/golden/contact_cases.json")).unwrap()
}

fn limits(input: &Value) -> Limits {
    Limits {
        force: input["limits"]["force"].as_f64(),
        pressure: input["limits"]["pressure"].as_f64(),
        max_strain: input["max_strain"].as_f64(),
    }
}

fn contact<'a>(input: &Value, pad: Option<&'a crate::covering::Pad>) -> LimitedContact<'a> {
    LimitedContact {
        robot_mass: number_or(input, "robot_mass", f64::NAN),
        body_mass: number_or(input, "body_mass", f64::INFINITY),
        region: region(&input["region"]),
        pad,
        area: None,
        limits: limits(input),
    }
}

fn close(found: f64, expected: &Value, tolerance: f64, about: &Value) {
    match expected.as_f64() {
        None => assert!(found.is_nan(), "{about}: {found}"),
        Some(expected) => assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{about}: {found} {expected}"
        ),
    }
}

/// The numbers are given to 13 digits.
const PRINTED: f64 = 2e-12;

#[test]
fn golden_speeds_from_stored_energy() {
    for case in cases()["allowed_speed"].as_array().unwrap() {
        let pad = pad(&case["input"]["covering"]).unwrap();
        let found = contact(&case["input"], Some(&pad)).closed_form();
        close(found.speed, &case["speed"], PRINTED, case);
        assert_eq!(found.governs.word(), case["governs"], "{case}");
        for (name, speed) in ["force", "pressure", "strain"]
            .into_iter()
            .zip(found.speeds)
        {
            close(speed, &case["speeds"][name], PRINTED, case);
        }
    }
}

#[test]
fn golden_speeds_by_simulation() {
    for case in cases()["allowed_speed_numeric"].as_array().unwrap() {
        let pad = pad(&case["input"]["covering"]).unwrap();
        let collision = collision(&case["input"], Some(&pad), 1e-10);
        let found = numeric_speed(&collision, (&limits(&case["input"]), None), 1.0, &|| false);
        close(found.speed, &case["speed"], 1e-7, case);
        assert_eq!(found.status.word(), "monotone");
    }
}

#[test]
fn golden_thicknesses() {
    for case in cases()["thickness"].as_array().unwrap() {
        let input = &case["input"];
        let pad = pad(&input["covering"]).unwrap();
        let found = least_thickness(
            &contact(input, Some(&pad)),
            &pad,
            input["speed"].as_f64().unwrap(),
        );
        close(found.thickness, &case["thickness"], PRINTED, case);
        assert_eq!(found.status.word(), case["status"]);
    }
}

#[test]
fn golden_mobile_bases() {
    for case in cases()["mobile_base"].as_array().unwrap() {
        let input = &case["input"];
        let pair = |name: &str| [0, 1].map(|index: usize| input[name][index].as_f64().unwrap());
        let [mass, inertia] = ["mass", "inertia"].map(|name| number_or(input, name, f64::NAN));
        let (point, direction) = (pair("point"), pair("direction"));
        let found = if input["kind"] == "holonomic" {
            holonomic_mass(mass, inertia, point, direction).unwrap()
        } else {
            differential_mass(mass, inertia, Drive::default(), point, direction).unwrap()
        };
        match case["effective_mass"].as_f64() {
            Some(expected) => assert!((found / expected - 1.0).abs() < 1e-12, "{case}"),
            None => assert!(found.is_infinite(), "{case}"),
        }
    }
    let drive = Drive {
        offset: 0.05,
        wheel_inertia: 0.001,
        wheel_radius: 0.08,
        half_track: 0.2,
    };
    let found = differential_mass(20.0, 0.8, drive, [0.2, 0.1], [0.8, 0.6]).unwrap();
    assert!((found - 29.97354).abs() < 5e-6, "{found}");
}

#[test]
fn a_speed_that_is_allowed_reaches_its_limit() {
    for case in cases()["allowed_speed"].as_array().unwrap() {
        let pad = pad(&case["input"]["covering"]).unwrap();
        let found = contact(&case["input"], Some(&pad)).closed_form();
        let mut collision = collision(&case["input"], Some(&pad), 1e-10);
        (collision.closing_speed, collision.horizon) = (found.speed, 10.0);
        let outcome = simulate(&collision, Wanted::default(), &|| false);
        let limits = limits(&case["input"]);
        let loads = [
            ("force", outcome.peak_force, limits.force),
            ("pressure", outcome.peak_pressure, limits.pressure),
            ("strain", outcome.peak_strain, limits.max_strain),
        ];
        let (_, load, limit) = loads
            .into_iter()
            .find(|(name, ..)| case["governs"] == *name)
            .unwrap();
        let share = load / limit.unwrap();
        assert!((share - 1.0).abs() < 1e-8, "{case}: {share}");
    }
}

#[test]
fn clopper_and_pearson_as_printed() {
    // 10 of 100: 0.0490047 to 0.1762226 (Clopper and Pearson, as in R's binom.test).
    let found = clopper_pearson(10, 100);
    assert!(
        (found.low - 0.049_004_69).abs() < 1e-7 && (found.high - 0.176_222_6).abs() < 1e-7,
        "{found:?}"
    );
    let none = clopper_pearson(0, 20);
    assert!(none.low == 0.0 && (none.high - (1.0 - 0.025_f64.powf(0.05))).abs() < 1e-12);
    let all = clopper_pearson(20, 20);
    assert!((all.low - 0.025_f64.powf(0.05)).abs() < 1e-12 && all.high == 1.0);
    assert!((normal_probability(1.96) - 0.975_002_104_851_779_5).abs() < 1e-15);
}

#[test]
fn a_point_too_far_away_to_feel_a_base_is_refused() {
    let far = [0.2, 1e308];
    assert!(super::holonomic_mass(4.4, 0.1, far, [1.0, 0.0]).is_err());
    let drive = super::Drive::default();
    assert!(super::differential_mass(4.4, 0.1, drive, far, [1.0, 0.0]).is_err());
}

#[test]
fn a_law_that_falls_before_the_strain_that_is_allowed_is_refused() {
    let falling = serde_json::json!({
        "material": {"law": "avalle", "A": 5e4, "E": 1e6, "m": 3.0, "B": 1.0, "n": 1.0},
        "thickness": 0.02, "shape": "flat", "area": 1e-3, "bottom": [0.05, 0.0]
    });
    let pad = pad(&falling).unwrap();
    let limits = |strain| Limits {
        force: Some(40.0),
        pressure: None,
        max_strain: Some(strain),
    };
    assert!(limits(0.2).check(Some(&pad)).is_ok());
    // It pushes with 43.6 N at a strain of 0.25, and with less beyond.
    assert!(limits(0.9).check(Some(&pad)).is_err());
}
