//! People on a circle who cross it, the cases of `CrowdNav`: Chen, Liu, Kreiss and Alahi, ICRA 2019.

use std::f64::consts::TAU;

use numeric::random::Stream;

use crate::crowd::people::{Purpose, stream_of};
use numeric::lanes::Vector2;

/// Radius of the circle in m.
const RADIUS: f64 = 4.0;
/// Start and goal of the robot in m.
pub const ENDS: [[f64; 2]; 2] = [[0.0, -RADIUS], [0.0, RADIUS]];
/// Half the width in m of what is added to each coordinate.
const SCATTER: f64 = 0.5;
/// Radius of everybody in m.
pub const BODY: f64 = 0.3;
/// Gap in m that is kept to starts and goals of those before.
const GAP: f64 = 0.2;
/// Places that are tried for one person: more do not fit.
const TRIES: usize = 10_000;

/// Starts of a number of people in m, whose goals are the opposite points; fewer where no more find room.
#[must_use]
pub fn starts(seed: u64, people: usize) -> Vec<[f64; 2]> {
    let mut stream = stream_of(seed, Purpose::Place, 0);
    let most = people.min(1024);
    let mut taken: Vec<Vector2<f64>> = Vec::with_capacity(ENDS.len() + 2 * most);
    taken.extend(ENDS.map(Vector2::from));
    let mut found = Vec::with_capacity(most);
    while found.len() < people {
        let Some(place) = (0..TRIES)
            .map(|_| drawn(&mut stream))
            .find(|place| is_free(*place, &taken))
        else {
            return found;
        };
        taken.extend([place, -place]);
        found.push(place.into());
    }
    found
}

fn drawn(stream: &mut Stream) -> Vector2<f64> {
    let (sin, cos) = stream.uniform(0.0, TAU).sin_cos();
    let x = RADIUS * cos + stream.uniform(-SCATTER, SCATTER);
    Vector2::new(x, RADIUS * sin + stream.uniform(-SCATTER, SCATTER))
}

/// Whether start and goal keep their distance from those of everybody before.
fn is_free(place: Vector2<f64>, taken: &[Vector2<f64>]) -> bool {
    let least = 2.0 * BODY + GAP;
    let far =
        |other: &Vector2<f64>| (place - other).norm() >= least && (place + other).norm() >= least;
    taken.iter().all(far)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_start_apart_and_the_same_for_a_seed() {
        let found = starts(7, 5);
        assert_eq!(found, starts(7, 5));
        assert_ne!(found, starts(8, 5));
        assert_eq!(starts(7, 3), found[..3]);
        for (index, place) in found.iter().enumerate() {
            let place = Vector2::from(*place);
            for other in found[..index].iter().map(|other| Vector2::from(*other)) {
                assert!((place - other).norm() >= 0.8 && (place + other).norm() >= 0.8);
            }
        }
        assert!(starts(7, 1000).len() < 100);
    }
}
