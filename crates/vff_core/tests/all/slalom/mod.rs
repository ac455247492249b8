//! What the tests of the tree share: rows of discs with gaps.

use vff_core::world::geometry::Body;
use vff_core::world::obstacle::Shape;

use crate::planning::body;

/// In m: rounding of positions of up to some ten meters.
pub const ROUNDING: f64 = 1e-9;

/// A disc in the scene.
pub fn disc(radius: f64, place: [f64; 2], velocity: [f64; 2]) -> Body {
    body(Shape::Disc { radius }, place, velocity)
}

/// Rows of discs with gaps, on the way from `[6, 0]` to the origin.
pub fn slalom() -> Vec<Body> {
    let row = |x: f64, gap: f64| {
        let places = (-7..=7).map(|n| f64::from(n) * 0.4);
        places
            .filter(move |y| (y - gap).abs() > 0.5)
            .map(move |y| disc(0.15, [x, y], [0.0; 2]))
    };
    row(1.5, 1.0)
        .chain(row(3.0, -1.0))
        .chain(row(4.5, 1.0))
        .collect()
}
