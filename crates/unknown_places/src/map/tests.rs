//! Evidence, kinds and distances against plain readings of their definitions.

use nalgebra::Vector2;
use navigation_world::world::frame::Frame;
use proptest::prelude::*;

use super::*;

const RANGE: f64 = 10.0;

fn small() -> RollingMap {
    RollingMap::new(MapOptions {
        reach: 2.0,
        ..MapOptions::default()
    })
    .unwrap()
}

/// Ranges in a turn from a place within a disc of walls.
fn turn(map: &mut RollingMap, place: [f64; 2], ranges: &[f64]) {
    let beams: Vec<Vector2<f64>> = (0..ranges.len())
        .map(|beam| {
            let (sin, cos) = (beam as f64 / ranges.len() as f64 * std::f64::consts::TAU).sin_cos();
            Vector2::new(cos, sin)
        })
        .collect();
    let scan = Scan {
        pose: Frame::at(place, 0.0),
        beams: &beams,
        ranges,
        range_min: 0.0,
        range_max: RANGE,
    };
    map.follow(place.into());
    map.enter(scan).unwrap();
}

fn read(map: &mut RollingMap) -> Cells {
    let mut cells = Cells::new(map, 0.6);
    cells.read(map);
    cells
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn distances_and_the_front_are_those_of_their_definitions(
        ranges in prop::collection::vec(0.1..3.0f64, 20..200), x in -3.0..3.0f64, y in -3.0..3.0f64
    ) {
        let mut map = small();
        turn(&mut map, [x, y], &ranges);
        turn(&mut map, [x, y], &ranges);
        let cells = read(&mut map);
        let size = cells.size();
        let kind = |column: i64, row: i64| {
            let inside = (0..size as i64).contains(&column) && (0..size as i64).contains(&row);
            inside.then(|| cells.kind(column as usize, row as usize))
        };
        let occupied: Vec<[i64; 2]> = (0..size * size)
            .map(|at| [(at % size) as i64, (at / size) as i64])
            .filter(|[column, row]| kind(*column, *row) == Some(Kind::Occupied))
            .collect();
        let mut front = 0;
        for at in (0..size * size).step_by(7) {
            let (column, row) = ((at % size) as i64, (at / size) as i64);
            let least = occupied.iter().map(|[x, y]| (x - column).pow(2) + (y - row).pow(2)).min();
            let least = least.unwrap_or(i64::MAX).min(i64::from(cells.farthest()));
            prop_assert_eq!(i64::from(cells.squares()[at]), least);
        }
        for at in 0..size * size {
            let (column, row) = ((at % size) as i64, (at / size) as i64);
            let beside = [(1, 0), (-1, 0), (0, 1), (0, -1)]
                .iter()
                .any(|(x, y)| kind(column + x, row + y) == Some(Kind::Free));
            front += usize::from(kind(column, row) == Some(Kind::Unknown) && beside);
        }
        let (mut points, mut discs) = (0, 0);
        cells.known_near(Vector2::new(x, y), 100.0, |known| {
            if known.radius == 0.0 { points += 1 } else { discs += 1 }
        });
        prop_assert_eq!(points, occupied.len());
        prop_assert_eq!(discs, front);
    }

    #[test]
    fn cells_that_are_read_again_are_those_of_a_new_reading(
        ways in prop::collection::vec((-0.9..0.9f64, -0.9..0.9f64, 0.2..1.9f64), 2..8)
    ) {
        let mut map = small();
        let mut cells = Cells::new(&mut map, 0.6);
        for (x, y, range) in ways {
            let ranges: Vec<f64> = (0..60).map(|beam| range * (1.0 + 0.3 * f64::from(beam % 7))).collect();
            for _ in 0..30 {
                turn(&mut map, [x, y], &ranges);
            }
            cells.read(&mut map);
            let again = read(&mut map.clone());
            prop_assert_eq!(cells.squares(), again.squares());
            for at in 0..cells.size() * cells.size() {
                let (column, row) = (at % cells.size(), at / cells.size());
                prop_assert_eq!(cells.kind(column, row), again.kind(column, row));
            }
            let points = |cells: &Cells| {
                let mut found = Vec::new();
                cells.known_near(Vector2::new(x, y), 100.0, |known| found.push(known));
                found
            };
            prop_assert_eq!(points(&cells), points(&again));
        }
    }

    #[test]
    fn a_window_that_moves_keeps_what_stays_in_it(
        ranges in prop::collection::vec(0.3..1.9f64, 40), x in -0.9..0.9f64, y in -0.9..0.9f64
    ) {
        let mut map = small();
        turn(&mut map, [0.0, 0.0], &ranges);
        turn(&mut map, [0.0, 0.0], &ranges);
        let before = read(&mut map);
        map.follow(Vector2::new(x, y));
        let after = read(&mut map);
        let size = after.size() as i64;
        for row in 0..size {
            for column in 0..size {
                let there = [column + after.low()[0] - before.low()[0], row + after.low()[1] - before.low()[1]];
                let now = after.kind(column as usize, row as usize);
                if there.iter().all(|axis| (0..size).contains(axis)) {
                    prop_assert_eq!(now, before.kind(there[0] as usize, there[1] as usize));
                } else {
                    prop_assert_eq!(now, Kind::Unknown);
                }
            }
        }
    }
}

#[test]
fn a_hit_stands_until_enough_beams_have_passed() {
    let mut map = small();
    let cell = |map: &mut RollingMap| {
        let cells = read(map);
        let index = cells.index_of(Vector2::new(1.02, 0.02)).unwrap();
        cells.kind(index % cells.size(), index / cells.size())
    };
    turn(&mut map, [0.02, 0.02], &[1.0]);
    assert_eq!(cell(&mut map), Kind::Unknown);
    turn(&mut map, [0.02, 0.02], &[1.0]);
    assert_eq!(cell(&mut map), Kind::Occupied);
    let mut passes = 0;
    while cell(&mut map) == Kind::Occupied {
        turn(&mut map, [0.02, 0.02], &[1.9]);
        passes += 1;
    }
    // 2 hits are a tenth of 20.
    assert_eq!(passes, 19);
}

#[test]
fn what_reads_nothing_tells_nothing_and_what_hits_nothing_frees_the_way() {
    let mut map = small();
    turn(&mut map, [0.0, 0.0], &[f64::NAN, f64::INFINITY]);
    let cells = read(&mut map);
    let kind = |x: f64| {
        let index = cells.index_of(Vector2::new(x, 0.0)).unwrap();
        cells.kind(index % cells.size(), index / cells.size())
    };
    assert_eq!((kind(1.0), kind(-1.0)), (Kind::Unknown, Kind::Free));
}

#[test]
fn scans_that_are_none_are_refused() {
    let mut map = small();
    map.follow(Vector2::zeros());
    let beams = [Vector2::new(1.0, 0.0)];
    let scan = |ranges: &'static [f64], place: [f64; 2]| Scan {
        pose: Frame::at(place, 0.0),
        beams: &beams,
        ranges,
        range_min: 0.0,
        range_max: RANGE,
    };
    assert!(map.enter(scan(&[1.0], [0.0, 0.0])).is_ok());
    assert!(map.enter(scan(&[1.0, 1.0], [0.0, 0.0])).is_err());
    assert!(map.enter(scan(&[-0.1], [0.0, 0.0])).is_err());
    assert!(map.enter(scan(&[1.0], [50.0, 0.0])).is_err());
    assert!(map.enter(scan(&[1.0], [f64::NAN, 0.0])).is_err());
}
