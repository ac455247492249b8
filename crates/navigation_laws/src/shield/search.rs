//! Search for the admissible velocity that is nearest to a wanted one.

use numeric::lanes::Vector2;

/// Directions of a ring.
const DIRECTIONS: u32 = 32;

/// Rings around the wanted velocity.
const RINGS: u32 = 12;

/// Halvings of the distance between two rings.
const HALVINGS: u32 = 6;

/// Steps along the edge of what is admissible.
const SLIDES: u32 = 16;

/// A velocity and its distance from the wanted one.
type Found = (f64, Vector2<f64>);

/// From where and toward which side angles are taken. Both are those of the scene: one that is turned
/// or mirrored is searched alike.
#[derive(Clone, Copy, Debug)]
pub(super) struct SearchFrame {
    /// Direction of angle 0, of length 1.
    axis: Vector2<f64>,
    /// 1 if angles grow counterclockwise, else -1.
    side: f64,
}

impl SearchFrame {
    /// From a direction of length 1 toward its left or its right side.
    pub fn new(axis: Vector2<f64>, left: bool) -> Self {
        Self {
            axis,
            side: if left { 1.0 } else { -1.0 },
        }
    }

    /// A direction turned by an angle in rad.
    fn turned(&self, way: Vector2<f64>, angle: f64) -> Vector2<f64> {
        let (sin, cos) = (self.side * angle).sin_cos();
        Vector2::new(way.x * cos - way.y * sin, way.x * sin + way.y * cos)
    }

    fn unit(&self, angle: f64) -> Vector2<f64> {
        self.turned(self.axis, angle)
    }

    fn angle(&self, way: Vector2<f64>) -> f64 {
        (self.side * self.axis.perp(&way)).atan2(self.axis.dot(&way))
    }
}

/// The admissible velocity nearest to `wanted`, as far as rings of directions find it, or `first`
/// where nothing nearer is found. Everything admissible lies within `farthest` m/s of it.
pub(super) fn nearest(
    frame: SearchFrame,
    wanted: Vector2<f64>,
    farthest: f64,
    first: Option<Vector2<f64>>,
    mut admissible: impl FnMut(Vector2<f64>) -> bool,
) -> Option<Vector2<f64>> {
    let mut best: Option<Found> = first.map(|velocity| ((velocity - wanted).norm(), velocity));
    let width = farthest / f64::from(RINGS);
    let mut inner = 0.0;
    for ring in 1..=RINGS {
        let radius = f64::from(ring) * width;
        if best.is_some_and(|(distance, _)| distance <= radius) {
            break;
        }
        // Every other ring is turned by half a step, so that no direction is looked at twice.
        let turn = 0.5 * f64::from(ring % 2);
        if let Some(found) = on_ring(frame, wanted, radius, turn, &mut admissible) {
            best = Some((radius, found));
            break;
        }
        inner = radius;
    }
    let (mut outer, mut found) = best?;
    for halving in 0..HALVINGS {
        let radius = 0.5 * (inner + outer);
        let turn = 0.25 + 0.5 * f64::from(halving % 2);
        let nearer = beside(frame, wanted, found, radius, halving, &mut admissible)
            .or_else(|| on_ring(frame, wanted, radius, turn, &mut admissible));
        match nearer {
            Some(nearer) => (outer, found) = (radius, nearer),
            None => inner = radius,
        }
    }
    Some(slid(frame, wanted, found, &mut admissible))
}

/// The velocity after steps of falling size that bring it nearer: it slides along the edge of what is
/// admissible into corners that are narrower than the directions of a ring.
fn slid(
    frame: SearchFrame,
    wanted: Vector2<f64>,
    found: Vector2<f64>,
    admissible: &mut impl FnMut(Vector2<f64>) -> bool,
) -> Vector2<f64> {
    let (mut found, mut distance) = (found, (found - wanted).norm());
    let mut step = 0.25 * distance;
    for _ in 0..SLIDES {
        let way = (wanted - found) * (1.0 / distance.max(f64::MIN_POSITIVE));
        // Straight ahead, then ever more to either side.
        let nearer = [0.0, 0.4, -0.4, 0.8, -0.8, 1.2, -1.2]
            .into_iter()
            .map(|angle| found + frame.turned(way, angle) * step)
            .find(|velocity| (velocity - wanted).norm() < distance && admissible(*velocity));
        match nearer {
            Some(velocity) => (found, distance) = (velocity, (velocity - wanted).norm()),
            None => step *= 0.5,
        }
    }
    found
}

/// An admissible velocity on a ring whose directions are turned by a part of their step.
fn on_ring(
    frame: SearchFrame,
    wanted: Vector2<f64>,
    radius: f64,
    turn: f64,
    admissible: &mut impl FnMut(Vector2<f64>) -> bool,
) -> Option<Vector2<f64>> {
    let step = std::f64::consts::TAU / f64::from(DIRECTIONS);
    // Along the axis first, then ever more to either side.
    let steps = |index: u32| {
        let steps = f64::from(index.div_ceil(2));
        if index % 2 == 1 { steps } else { -steps }
    };
    (0..DIRECTIONS)
        .map(|index| wanted + frame.unit((steps(index) + turn) * step) * radius)
        .find(|velocity| admissible(*velocity))
}

/// An admissible velocity at a radius in nearly the direction of one that is.
fn beside(
    frame: SearchFrame,
    wanted: Vector2<f64>,
    found: Vector2<f64>,
    radius: f64,
    halving: u32,
    admissible: &mut impl FnMut(Vector2<f64>) -> bool,
) -> Option<Vector2<f64>> {
    let angle = frame.angle(found - wanted);
    let step = std::f64::consts::PI / f64::from(DIRECTIONS) / f64::from(1 + halving);
    [0.0, 1.0, -1.0, 2.0, -2.0]
        .into_iter()
        .map(|steps| wanted + frame.unit(angle + steps * step) * radius)
        .find(|velocity| admissible(*velocity))
}
