//! Places where people will be, at a constant velocity and along walls.

use crate::foresight::Foresight;
use crate::foresight::estimate::{Estimates, Sighting};
use crate::shield::StaticObstacles;
use numeric::lanes::Vector2;

/// Clearance below which somebody slides along a wall, as a share of his radius.
const SLIDING: f64 = 0.8;

/// Somebody who is foreseen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foreknown {
    /// Number of the person among all.
    pub who: usize,
    /// Distance of the centers at contact, in m.
    pub touch: f64,
    /// Standard deviation of the velocity in m/s.
    pub deviation: f64,
    /// Largest speed of the prediction in m/s.
    pub speed: f64,
}

/// Places of people at every half stage from when the command takes effect.
#[derive(Clone, Debug, Default)]
pub(super) struct Prediction {
    pub people: Vec<Foreknown>,
    places: Vec<Vector2<f64>>,
    instants: usize,
}

impl Prediction {
    /// Foresees everybody.
    pub fn foresee<'a>(
        &mut self,
        settings: &Foresight,
        people: impl Iterator<Item = &'a Sighting>,
        estimates: &Estimates,
        walls: StaticObstacles<'_>,
        robot_radius: f64,
    ) {
        self.people.clear();
        self.places.clear();
        self.instants = 2 * settings.stages + 1;
        for person in people {
            let Some(estimate) = estimates.of(person) else {
                continue;
            };
            // Who was lost long ago is taken to have walked for the time that is foreseen.
            let age = person.age.min(settings.stages as f64 * settings.step);
            let mut place = estimate.position + estimate.velocity * age;
            let step = 0.5 * settings.step;
            self.people.push(Foreknown {
                who: person.who,
                touch: person.touch,
                deviation: estimate.deviation(),
                speed: estimate.velocity.norm(),
            });
            self.places.push(place);
            for _ in 1..self.instants {
                let near = SLIDING * (person.touch - robot_radius);
                place += sliding(place, estimate.velocity, step, near, walls) * step;
                self.places.push(place);
            }
        }
    }

    /// Places of somebody at the half stages.
    pub fn places(&self, person: usize) -> &[Vector2<f64>] {
        &self.places[person * self.instants..][..self.instants]
    }

    /// Places of everybody at the stages.
    pub fn ways(&self) -> Vec<(usize, Vec<[f64; 2]>)> {
        let way = |person| {
            let places = self.places(person).iter().step_by(2);
            let places = places.map(|place| (*place).into());
            (self.people[person].who, places.collect())
        };
        (0..self.people.len()).map(way).collect()
    }
}

/// A velocity without its part into a wall that it would meet.
fn sliding(
    place: Vector2<f64>,
    velocity: Vector2<f64>,
    step: f64,
    near: f64,
    walls: StaticObstacles<'_>,
) -> Vector2<f64> {
    if walls.is_empty() {
        return velocity;
    }
    let after = walls.clearance_up_to(place + velocity * step, near);
    if after >= near || after >= walls.clearance_up_to(place, near) {
        return velocity;
    }
    walls.away(place, near).map_or(velocity, |away| {
        velocity - away * velocity.dot(&away).min(0.0)
    })
}
