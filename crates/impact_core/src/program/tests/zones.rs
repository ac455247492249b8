//! Zones against all choices.

use proptest::prelude::*;

use crate::program::zones;

/// Least time of all choices of at most `count` zones.
fn all_choices(lengths: &[f64], caps: &[f64], count: usize) -> f64 {
    let cells = lengths.len();
    (0_u32..1 << (cells - 1))
        .filter(|cuts| (cuts.count_ones() as usize) < count)
        .map(|cuts| {
            let (mut time, mut length, mut cap) = (0.0, 0.0, f64::INFINITY);
            for cell in 0..cells {
                length += lengths[cell];
                cap = caps[cell].min(cap);
                if cell + 1 == cells || cuts & (1 << cell) != 0 {
                    time += length / ((cap / 0.05 + 1e-9).floor() * 0.05);
                    (length, cap) = (0.0, f64::INFINITY);
                }
            }
            time
        })
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn zones_prefer_fewer_and_refuse_less_than_a_step() {
    let found = zones::fastest_zones(&[1.0; 4], &[0.21, 0.23, 0.249, 0.2], 3, 0.05)
        .unwrap()
        .unwrap();
    assert_eq!(
        found,
        [zones::Zone {
            cells: [0, 4],
            speed: 0.05 * 4.0
        }]
    );
    assert_eq!(
        zones::fastest_zones(&[1.0; 2], &[0.2, 0.04], 3, 0.05),
        Ok(None)
    );
    assert!(zones::fastest_zones(&[1.0; 2], &[0.2, f64::NAN], 3, 0.05).is_err());
    assert!(zones::fastest_zones(&[1.0; 401], &[0.2; 401], 3, 0.05).is_err());
}

#[test]
fn zones_start_before_short_ones_where_the_way_is_too_short() {
    let found = zones::starts(&[0.0, 1.0, 1.1, 2.0], &[1.0, 0.9, 0.1], 1.0).unwrap();
    // From 1 to 0.1 m/s it brakes along 0.495 m, which begins before the second zone.
    assert!((found[2] - (1.1 - 0.495)).abs() < 1e-12);
    assert_eq!(found[1], found[2]);
    let rising = zones::starts(&[0.0, 1.0, 2.0], &[0.1, 0.5], 1.0).unwrap();
    assert_eq!(rising, [0.0, 1.0]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn zones_are_those_of_all_choices(
        cells in prop::collection::vec((0.02..0.08, 0.1..0.9), 1..10),
        count in 1_usize..5,
    ) {
        let (lengths, caps): (Vec<f64>, Vec<f64>) = cells.into_iter().unzip();
        let found = zones::fastest_zones(&lengths, &caps, count, 0.05).unwrap().unwrap();
        let time: f64 = found
            .iter()
            .map(|zone| lengths[zone.cells[0]..zone.cells[1]].iter().sum::<f64>() / zone.speed)
            .sum();
        prop_assert!((time / all_choices(&lengths, &caps, count) - 1.0).abs() < 1e-12);
        prop_assert!(found.len() <= count);
    }
}
