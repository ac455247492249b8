//! The fastest that is safe toward one person, in closed form.

/// Largest speed in m/s at an angle `theta` between the velocity and the direction to a person, a
/// free gap `g` in m, with a deceleration `a` in m/s^2 and the person's speed `v` in m/s:
/// `2 a g/(v + sqrt(v^2 + 2 a g cos theta))`. `None`: no limit.
///
/// With `g = |o-P| - R - e - v (L + 2T) - 1.5 V_max T > 0` every command below it is verified.
#[must_use]
pub fn speed_bound(gap: f64, angle: f64, deceleration: f64, person_speed: f64) -> Option<f64> {
    let work = 2.0 * deceleration * gap;
    let square = person_speed * person_speed + work * angle.cos();
    if square < 0.0 {
        return None;
    }
    let denominator = person_speed + square.sqrt();
    (denominator > 0.0).then(|| work / denominator)
}

#[cfg(test)]
mod tests {
    use super::speed_bound;

    #[test]
    fn values_of_the_specification() {
        let near = |given: Option<f64>, value: f64| (given.unwrap() - value).abs() < 1e-9;
        let toward = speed_bound(0.357_869_627, 0.879_100_347, 3.0, 1.0);
        assert!(near(toward, 0.845_578_560_3));
        let still = speed_bound(0.861_824_121, 1.025_294_077, 10.0, 0.0);
        assert!(near(still, 5.763_740_917_4));
        let away = speed_bound(1.810_287_673, -2.027_249_685, 10.0, 1.6);
        assert_eq!(away, None);
    }

    #[test]
    fn straight_toward_a_person_it_is_the_stopping_law() {
        let (gap, a, v) = (0.8, 3.0, 1.6_f64);
        let straight = (v * v + 2.0 * a * gap).sqrt() - v;
        assert!((speed_bound(gap, 0.0, a, v).unwrap() - straight).abs() < 1e-12);
    }
}
