//! Social force between a robot and a person, which measures how much they are in each other's way.

use crate::crowd::agent::SHORTEST;
use crate::crowd::models::moussaid::Moussaid;
use crate::crowd::neighbors::pairs::{Each, WIDTH};
use numeric::lanes::{Number, Planar, Real, Vector2};

type Vector = Vector2<f64>;

/// The model of Moussaid et al. (2009) without preference for a side; of its parameters only those of the push
/// between two people matter here.
const MODEL: Moussaid = Moussaid {
    relaxation_time: 0.54,
    strength: 4.5,
    gamma: 0.35,
    n: 2.0,
    n_prime: 3.0,
    velocity_weight: 2.0,
    side_bias: 0.0,
    wall_strength: 3.0,
    wall_range: 0.1,
    gaze: 4.0,
    cohesion: 3.0,
    separation: 1.0,
    view_angle: std::f64::consts::FRAC_PI_2,
    contact_distance: 0.55,
    cutoff: f64::INFINITY,
};

/// Forces on the person and on the robot, in m/s^2.
///
/// `to_person` is the position of the person less that of the robot, `closing` the velocity of the person
/// less that of the robot.
#[inline]
pub(super) fn forces(to_person: Vector, closing: Vector) -> [Vector; 2] {
    let distance = to_person.norm();
    if distance < SHORTEST {
        // Where both stand at one point each is pushed along x.
        return [closing, -closing].map(|relative| MODEL.push(Vector::x(), distance, relative));
    }
    // Seen from the robot everything is reversed.
    let on_person = MODEL.push(to_person / distance, distance, closing);
    [on_person, -on_person]
}

/// Sums of the forces over the instants. Pairs wait until there are enough of them to be looked at side by side, and
/// are added in the order in which they came, so that no bit of a sum depends on it.
pub(super) struct Pressures {
    processor: pulp::Arch,
    to_person: Vector2<Each>,
    closing: Vector2<Each>,
    instants: [usize; WIDTH],
    waiting: usize,
    on_people: f64,
    on_robot: f64,
    /// Force on the robot at an instant so far.
    at_instant: Vector,
    instant: usize,
}

impl Pressures {
    pub fn new() -> Self {
        let nothing: Vector2<Each> = Planar::<Each>::splat([0.0; 2]);
        Self {
            processor: pulp::Arch::new(),
            to_person: nothing,
            closing: nothing,
            instants: [0; WIDTH],
            waiting: 0,
            on_people: 0.0,
            on_robot: 0.0,
            at_instant: Vector::zeros(),
            instant: 0,
        }
    }

    /// Adds a person at an instant; instants never fall.
    #[inline]
    pub fn add(&mut self, instant: usize, to_person: Vector, closing: Vector) {
        let lane = self.waiting;
        self.instants[lane] = instant;
        self.to_person.x.set(lane, to_person.x);
        self.to_person.y.set(lane, to_person.y);
        self.closing.x.set(lane, closing.x);
        self.closing.y.set(lane, closing.y);
        self.waiting += 1;
        if self.waiting == WIDTH {
            self.add_waiting();
        }
    }

    fn add_waiting(&mut self) {
        let [to_person, closing] = [self.to_person, self.closing];
        let found = self.processor.dispatch(Pushes { to_person, closing });
        for lane in 0..self.waiting {
            let mut on_person = Vector::from(found.force.lane(lane));
            let (mut on_robot, mut size) = (-on_person, found.size.lane(lane));
            if found.distance.lane(lane) < SHORTEST {
                let [way, relative] = [to_person, closing].map(|each| each.lane(lane).into());
                [on_person, on_robot] = forces(way, relative);
                size = on_person.norm();
            }
            self.on_people += size;
            if self.instants[lane] > self.instant {
                self.end_instant();
                self.instant = self.instants[lane];
            }
            self.at_instant += on_robot;
        }
        self.waiting = 0;
    }

    fn end_instant(&mut self) {
        self.on_robot += self.at_instant.norm();
        self.at_instant = Vector::zeros();
    }

    /// Sums over all instants of the sizes of the forces on people and of that of the force on the robot, in m/s^2.
    pub fn sums(mut self) -> [f64; 2] {
        self.add_waiting();
        self.end_instant();
        [self.on_people, self.on_robot]
    }
}

/// Forces on people side by side, compiled once for each instruction set; their bits are the same for all.
struct Pushes {
    to_person: Vector2<Each>,
    closing: Vector2<Each>,
}

/// Forces on people, their sizes, and the distances.
struct Pushed {
    force: Vector2<Each>,
    size: Each,
    distance: Each,
}

impl pulp::NullaryFnOnce for Pushes {
    type Output = Pushed;

    #[inline(always)]
    fn call(self) -> Pushed {
        let way = self.to_person;
        let distance = way.length();
        let force = MODEL.push(way.over(distance), distance, self.closing);
        Pushed {
            force,
            size: force.length(),
            distance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::random::Stream;

    #[test]
    fn both_are_pushed_alike_in_opposite_directions() {
        let (to_person, closing) = (Vector::new(1.2, -0.7), Vector::new(-1.1, 0.4));
        let [on_person, on_robot] = forces(to_person, closing);
        let distance = to_person.norm();
        let own = MODEL.push(-to_person / distance, distance, -closing);
        assert!((on_robot - own).norm() < 1e-13);
        assert_eq!(on_person, -on_robot);
    }

    #[test]
    fn who_walks_straight_at_the_other_is_braked_only() {
        let [on_person, on_robot] = forces(Vector::new(2.0, 0.0), Vector::new(-1.0, 0.0));
        assert!(on_person.x > 0.0 && on_person.y == 0.0);
        assert_eq!(on_robot, -on_person);
    }

    #[test]
    fn sums_have_the_bits_of_one_pair_after_the_other() {
        let mut random = Stream::new(7, 0);
        let mut vector =
            |scale: f64| Vector::new(random.uniform(-scale, scale), random.uniform(-scale, scale));
        for count in 0..40 {
            let mut sums = Pressures::new();
            let (mut on_people, mut on_robots) = (0.0, 0.0);
            for instant in 0..count {
                let mut on_robot = Vector::zeros();
                for person in 0..instant % 4 {
                    let nowhere = (instant + person) % 7 == 0;
                    let way = if nowhere {
                        Vector::zeros()
                    } else {
                        vector(5.0)
                    };
                    let closing = vector(2.0);
                    sums.add(instant, way, closing);
                    let [on_person, back] = forces(way, closing);
                    on_people += on_person.norm();
                    on_robot += back;
                }
                on_robots += on_robot.norm();
            }
            assert_eq!(sums.sums(), [on_people, on_robots]);
        }
    }

    #[test]
    fn at_one_point_both_are_pushed_along_x() {
        let [on_person, on_robot] = forces(Vector::zeros(), Vector::zeros());
        assert_eq!(on_person, Vector::new(MODEL.strength, 0.0));
        assert_eq!(on_robot, on_person);
    }
}
