//! Static maps: boundary points among 10,000 segments, plans through fields of cylinders.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector2;
use vff_core::laws::Stop;
use vff_core::laws::guide::Guide;
use vff_core::world::map::{GridPlace, MapShapes, StaticMap};

/// Whole numbers below a bound, the same in every run.
fn drawn(state: &mut u64, bound: u64) -> u64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) % bound
}

/// A floor of 50 m with rooms of cells of 0.05 m: about 10,000 segments.
fn floor() -> StaticMap {
    let (columns, mut cells, mut state) = (1000, vec![false; 1_000_000], 7);
    for _ in 0..2750 {
        let (column, row) = (drawn(&mut state, 960), drawn(&mut state, 960));
        let (width, height) = (1 + drawn(&mut state, 12), 1 + drawn(&mut state, 12));
        for y in row..row + height {
            for x in column..column + width {
                cells[usize::try_from(y * 1000 + x).unwrap_or(0)] = true;
            }
        }
    }
    let mut shapes = MapShapes::new();
    let place = GridPlace {
        resolution: 0.05,
        origin: [0.0; 2],
        yaw: 0.0,
    };
    let added = shapes.grid(&cells, columns, place, &|| false);
    assert!(added.is_ok());
    shapes.map()
}

/// A field of cylinders as in BARN: side walls, a closed end, and the field between them.
fn barn() -> StaticMap {
    let (mut shapes, mut state) = (MapShapes::new(), 3);
    let mut put = |x: f64, y: f64| assert!(shapes.disc([x, y], 0.075).is_ok());
    for step in 0..64 {
        let y = 0.075 + 0.15 * f64::from(step);
        put(-4.425, y);
        put(-0.075, y);
        if step < 29 {
            put(-4.275 + 0.15 * f64::from(step), 0.075);
        }
    }
    for _ in 0..100 {
        let (x, y) = (drawn(&mut state, 24), drawn(&mut state, 30));
        // A lane in the middle stays free.
        if !(10..14).contains(&x) {
            put(-4.1 + 0.15 * x as f64, 5.0 + 0.15 * y as f64);
        }
    }
    shapes.map()
}

fn bench(criterion: &mut Criterion) {
    let map = floor();
    assert!(map.capsules().len() >= 10_000);
    let mut state = 11;
    let mut free = || loop {
        let [x, y] = [0, 1].map(|_| drawn(&mut state, 50_000) as f64 / 1000.0);
        let place = Vector2::new(x, y);
        if map.clearance(place) > 0.2 {
            return place;
        }
    };
    let places: Vec<Vector2<f64>> = (0..1000).map(|_| free()).collect();
    let mut points = Vec::with_capacity(8);
    for (name, reach, kappa) in [("force_law", 0.5, 0.5), ("half_planes", 2.0, 1.0)] {
        let mut next = 0;
        criterion.bench_function(
            &format!("boundary_points/{name}/{}", map.capsules().len()),
            |bencher| {
                bencher.iter(|| {
                    next = (next + 1) % places.len();
                    map.boundary_points(black_box(places[next]), reach, kappa, &mut points);
                    points.len()
                });
            },
        );
    }
    let (map, ends) = (barn(), [[-2.0, 3.0], [-2.0, 13.0]]);
    let guide = Guide {
        bounds: Some([[-6.0, -0.5], [1.5, 15.0]]),
        ..Guide::default()
    };
    criterion.bench_function("guide/barn", |bencher| {
        bencher.iter(|| {
            guide
                .plan(black_box(&map), 0.22, ends, Stop::never())
                .is_ok()
        });
    });
    let Ok(plan) = guide.plan(&map, 0.22, ends, Stop::never()) else {
        return;
    };
    criterion.bench_function("guide/local_goal", |bencher| {
        let place = Vector2::new(-2.1, 4.2);
        bencher.iter(|| {
            plan.view(black_box(place))
                .map(|view| plan.local_goal(place, &view))
        });
    });
}

criterion_group!(maps, bench);
criterion_main!(maps);
