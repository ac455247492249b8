//! Outlines, velocity obstacles and linear programs against plain sampling.

use proptest::prelude::*;
use vff_core::lanes::{Planar, Vector2};
use vff_core::laws::planning::half_planes::{HalfPlane, Solver};
use vff_core::laws::planning::outline::Outline;
use vff_core::laws::reciprocal::avoiding;
use vff_core::world::geometry::Body;
use vff_core::world::motion::BodyState;
use vff_core::world::obstacle::{Regions, Shape};

type Vector = Vector2<f64>;

/// Samples along a curve.
const SAMPLES: u32 = 4_000;

fn vector(x: f64, y: f64) -> Vector {
    Vector2::new(x, y)
}

fn length(v: Vector) -> f64 {
    v.dot(&v).sqrt()
}

prop_compose! {
    fn outlines()(
        x in 0.8..4.0f64, turn in 0.0..6.3f64, disc in any::<bool>(), heading in 0.0..3.2f64,
        half in (0.1..1.0f64, 0.1..1.0f64), radius in 0.1..0.5f64,
    ) -> Outline {
        let axis = [heading.cos(), heading.sin()].into();
        let shape = if disc {
            Shape::Disc { radius }
        } else {
            Shape::Rectangle { half_length: half.0, half_width: half.1, axis }
        };
        outline(vector(x * turn.cos(), x * turn.sin()), shape)
    }
}

/// Outline of a body at rest for a robot of 0.2 m at the origin.
fn outline(position: Vector, shape: Shape) -> Outline {
    let state = BodyState {
        position: [position.x, position.y],
        velocity: [0.0; 2],
        acceleration: [0.0; 2],
        present: true,
    };
    let regions = Regions {
        critical_radius: 1.0,
        active_radius: 2.0,
    };
    let body = Body {
        shape,
        regions,
        state,
    };
    Outline::new(&body, Vector::zeros(), 0.2, 0.0)
}

/// Distance of a place from an outline, negative inside the rounding.
fn gap(outline: &Outline, place: Vector) -> f64 {
    let (point, inside) = outline.nearest(place);
    if inside {
        -outline.radius
    } else {
        length(place - point) - outline.radius
    }
}

/// Checks that the half plane of an outline that does not avoid moves a velocity to the nearest edge
/// of its velocity obstacle.
fn check_nearest_edge(outline: &Outline, velocity: Vector, horizon: f64) {
    let plane = avoiding(outline, velocity, horizon, 0.06, 1.0);
    let change = plane.point - velocity;
    // The point is on the edge: a little further out is free for the whole horizon, a little
    // further in is not. "Out" is the left of the line.
    let out = plane.direction.left_normal() * (1e-6);
    assert!(outline.time_to_contact(plane.point + out) > horizon);
    assert!(outline.time_to_contact(plane.point - out) <= horizon);
    // Nothing on the edge is nearer: every velocity within the change is on the same side.
    let own = outline.time_to_contact(velocity) <= horizon;
    let reach = length(change) - 1e-6;
    for n in 0..64u32 {
        let angle = std::f64::consts::TAU * f64::from(n) / 64.0;
        if reach > 0.0 {
            let near = velocity + vector(angle.cos(), angle.sin()) * reach;
            assert_eq!(outline.time_to_contact(near) <= horizon, own);
        }
    }
}

#[test]
fn face_in_front_may_be_nearer_than_the_legs_from_behind_a_rectangle() {
    let outline = outline(
        vector(-0.187_574_884_4, 0.978_767_416_7),
        Shape::Rectangle {
            half_length: 0.667_448_402_2,
            half_width: 0.555_848_490_9,
            axis: [0.0, 1.0].into(),
        },
    );
    check_nearest_edge(&outline, vector(-0.311_734_05, 0.841_756_79), 1.978_643_17);
}

proptest! {
    #[test]
    fn time_to_contact_is_the_first_touching_sample(
        outline in outlines(), speed in 0.1..2.0f64, course in 0.0..6.3f64,
    ) {
        prop_assume!(!outline.touches());
        let velocity = vector(speed * course.cos(), speed * course.sin());
        let time = outline.time_to_contact(velocity);
        let end = 8.0 / speed;
        let at = |sample: u32| end * f64::from(sample) / f64::from(SAMPLES);
        let first = (0..=SAMPLES).find(|&n| gap(&outline, velocity * at(n)) < 0.0);
        match first {
            Some(sample) => prop_assert!(time <= at(sample) && time >= at(sample - 1) - 1e-9, "{time}"),
            None => prop_assert!(time > end || gap(&outline, velocity * time).abs() < 1e-9),
        }
        if time.is_finite() {
            prop_assert!(gap(&outline, velocity * time).abs() < 1e-9);
        }
        prop_assert_eq!(time == f64::INFINITY, outline.missed_by(velocity));
    }

    #[test]
    fn legs_touch_without_entering(outline in outlines()) {
        prop_assume!(!outline.touches());
        let legs = outline.legs().unwrap();
        for (direction, reach) in [(legs.left, legs.left_reach), (legs.right, legs.right_reach)] {
            prop_assert!((length(direction) - 1.0).abs() < 1e-12);
            prop_assert!(gap(&outline, direction * reach).abs() < 1e-9);
            for n in 0..=SAMPLES {
                let place = direction * (8.0 * f64::from(n) / f64::from(SAMPLES));
                prop_assert!(gap(&outline, place) > -1e-9);
            }
        }
    }

    #[test]
    fn half_plane_moves_to_the_nearest_edge_of_the_velocity_obstacle(
        outline in outlines(), speed in 0.0..2.0f64, course in 0.0..6.3f64, horizon in 1.0..5.0f64,
    ) {
        prop_assume!(!outline.touches());
        let velocity = vector(speed * course.cos(), speed * course.sin());
        check_nearest_edge(&outline, velocity, horizon);
    }

    #[test]
    fn nearest_permitted_velocity_is_that_of_a_fine_grid(
        lines in proptest::collection::vec((-1.0..1.0f64, -1.0..1.0f64, 0.0..6.3f64), 1..6),
        wanted in (-1.0..1.0f64, -1.0..1.0f64),
    ) {
        let planes: Vec<HalfPlane> = lines
            .iter()
            .map(|&(x, y, angle)| HalfPlane {
                point: vector(x, y),
                direction: vector(angle.cos(), angle.sin()),
            })
            .collect();
        let wanted = vector(wanted.0, wanted.1);
        let found = Solver::default().nearest(&planes, 0, 1.0, wanted);
        prop_assert!(length(found) <= 1.0 + 1e-9);
        let worst = |v: Vector| planes.iter().map(|p| p.violation(v)).fold(0.0, f64::max);
        let grid = || (-100..=100).flat_map(|i| (-100..=100).map(move |j| vector(f64::from(i) / 100.0, f64::from(j) / 100.0)))
            .filter(|v| length(*v) <= 1.0);
        if worst(found) <= 1e-9 {
            for v in grid().filter(|v| worst(*v) <= 0.0) {
                prop_assert!(length(found - wanted) <= length(v - wanted) + 1e-9);
            }
        } else {
            for v in grid() {
                prop_assert!(worst(found) <= worst(v) + 1e-9, "{} {}", worst(found), worst(v));
            }
        }
    }
}
