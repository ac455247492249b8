//! Contact on one thread: closed-form speeds, draws, collisions. Rates are of rows of a batch, all of it counted.

use std::time::Instant;

use impact_core::allowed::{
    Distribution, Given, Kind, LOADS, Law, NAMES, Outline, RegionKind, Room, Row, SPEEDS, Setup,
    collide_rows, exceedance, speed_rows,
};
use impact_core::collision::Wanted;
use impact_core::columns::Column;
use numeric::error::Result;
use numeric::parallel::Work;

const ROWS: usize = 200_000;
const SHARED: [(&str, f64); 22] = [
    ("robot_mass", 8.0),
    ("robot_damping", 0.0),
    ("robot_stiffness", 0.0),
    ("body_mass", 40.0),
    ("body_damping", 0.0),
    ("body_stiffness", 0.0),
    ("closing_speed", 0.4),
    ("stiffness", 25e3),
    ("region_cubic", 0.0),
    ("thickness", 0.02),
    ("area", 4e-3),
    ("damping", 0.0),
    ("rate_base", 0.0),
    ("rate_slope", 0.0),
    ("rate_reference", 1.0),
    ("unloading_retained", 1.0),
    ("unloading_exponent", 1.0),
    ("bottoming_strain", 0.8),
    ("backing_stiffness", 1e7),
    ("horizon", 0.2),
    ("force_limit", 280.0),
    ("pressure_limit", 2.4e6),
];
const GIBSON: [f64; 5] = [3e5, 15e3, 0.9, 2.3, 1.0];
const RUSCH: [f64; 5] = [15e3, 0.5, 2e5, 5.0, f64::NAN];

fn place(name: &str) -> usize {
    NAMES
        .iter()
        .position(|known| *known == name)
        .unwrap_or_default()
}

fn row(material: [f64; 5]) -> Row {
    let mut numbers = [f64::NAN; NAMES.len()];
    for (name, value) in SHARED {
        numbers[place(name)] = value;
    }
    numbers[place("material_0")..].copy_from_slice(&material);
    Row(numbers)
}

fn setup(law: Law, region: RegionKind) -> Setup {
    Setup {
        kind: Kind {
            covering: Some((law, Outline::Flat)),
            region,
        },
        tolerance: 1e-6,
    }
}

fn shown(name: &str, count: usize, mut work: impl FnMut()) {
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        work();
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("{name}: {:.3e} per s", count as f64 / best);
}

/// Work with room for the columns of its results.
fn in_room(columns: usize, rows: usize, work: impl FnOnce(Room<'_>) -> Result<()>) {
    let mut numbers = vec![vec![0.0; rows]; columns];
    let mut codes = [vec![0; rows], vec![0; rows]];
    let [status, word] = &mut codes;
    let numbers = numbers.iter_mut().map(Vec::as_mut_slice).collect();
    drop(work(Room {
        numbers,
        status,
        word,
    }));
}

fn main() {
    let (never, nobody) = (|| false, |_: usize| ());
    let alone = Work {
        threads: Some(1),
        interrupted: &never,
        progress: &nobody,
    };
    let spread: Vec<f64> = (0..ROWS)
        .map(|index| 0.1 + 0.5 * index as f64 / ROWS as f64)
        .collect();
    let masses: Vec<f64> = spread.iter().map(|value| 40.0 * value).collect();
    for (name, law, material) in [
        (
            "linear",
            Law::Linear,
            [2e5, f64::NAN, f64::NAN, f64::NAN, f64::NAN],
        ),
        ("gibson_ashby", Law::GibsonAshby, GIBSON),
        ("rusch", Law::Rusch, RUSCH),
    ] {
        let row = row(material);
        let mut given = Given {
            columns: std::array::from_fn(|index| Column::Value(row.0[index])),
            rows: ROWS,
        };
        given.columns[place("robot_mass")] = Column::Array(&masses);
        let speeds = setup(law.clone(), RegionKind::Spring);
        shown(&format!("closed form, {name}"), ROWS, || {
            in_room(SPEEDS.len(), given.rows, |room| {
                speed_rows(&speeds, &given, alone, room)
            });
        });
        given.columns[place("robot_mass")] = Column::Value(8.0);
        given.columns[place("closing_speed")] = Column::Array(&spread);
        given.rows = ROWS / 10;
        let some = &spread[..ROWS / 10];
        given.columns[place("closing_speed")] = Column::Array(some);
        for rate in [0.0, 0.05] {
            given.columns[place("rate_base")] = Column::Value(rate);
            for region in [RegionKind::Rigid, RegionKind::Spring] {
                let moving = setup(law.clone(), region);
                shown(
                    &format!("collisions, {name}, {region:?}, n {rate}"),
                    some.len(),
                    || {
                        in_room(LOADS.len(), given.rows, |room| {
                            collide_rows(&moving, &given, Wanted::default(), (alone, room))
                        });
                    },
                );
            }
        }
    }
    let uncertain = ["robot_mass", "stiffness", "force_limit"].map(|name| {
        (
            place(name),
            Distribution::LogNormal([row(GIBSON).0[place(name)], 0.2]),
        )
    });
    let drawn = setup(Law::GibsonAshby, RegionKind::Spring);
    shown("draws", 1_000_000, || {
        drop(exceedance(
            &drawn,
            &row(GIBSON),
            &uncertain,
            0.5,
            (1_000_000, 1),
            alone,
        ));
    });
}
