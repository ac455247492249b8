//! Giving way: a velocity that stays out of the way of people, as far as their velocities tell.
//!
//! A wanted velocity that meets nobody within the horizon is kept. Otherwise many velocities are
//! priced by how far they are from the wanted one, how little they lead to the goal, how soon they
//! meet somebody, and how near they come to anybody.

mod conflict;

use crate::shield::{ShieldLimits, StaticObstacles};
use conflict::{Conflict, Crowd, NearestConflict, Stretch};
use navigation_world::world::geometry::RobotState;
use numeric::error::{Result, not_negative, positive};
use numeric::lanes::{Lanes, Mask, Number, Planar, Real, Truth, Vector2};

pub use conflict::Passerby;

/// Directions of the candidates.
const DIRECTIONS: usize = 36;

/// Their speeds, as shares of the largest.
const SPEEDS: usize = 3;

/// Candidates side by side.
const WIDTH: usize = 8;

/// Chunks of candidates; what is left of the last one repeats the first candidate.
const CHUNKS: usize = (2 + DIRECTIONS * SPEEDS).div_ceil(WIDTH);

/// Times to contact below this are priced alike, in s.
const SOONEST: f64 = 0.05;

/// How far ahead walls are looked for, in s.
const WALL_HORIZON: f64 = 1.0;

/// People of whom those who matter are sorted out before velocities are priced; more are all looked at.
const SORTED: usize = 64;

/// People after whom it is looked again whether some velocity can still be the cheapest.
const LOOKED_AT: usize = 2;

/// More than what rounding adds to a distance, in m.
const SLACK: f64 = 1e-6;

/// Distance from a wall in m below which a robot meets it.
const TOUCHING: f64 = 1e-3;

/// How the robot gives way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yielding {
    /// Surfaces that come nearer than this meet, `y` in m.
    pub clearance: f64,
    /// Time `H` for which everybody is taken to keep his velocity, in s.
    pub horizon: f64,
    /// Weight `k_t` of the inverse time to contact in s.
    pub time_weight: f64,
    /// Weight `k_d` of coming nearer than `comfort`.
    pub distance_weight: f64,
    /// Distance of the surfaces that is comfortable, `c_p` in m.
    pub comfort: f64,
    /// Weight `k_g` of progress.
    pub goal_weight: f64,
    /// People whose surface is farther away are not looked at, in m; may be infinite.
    pub reach: f64,
}

impl Default for Yielding {
    fn default() -> Self {
        Self {
            clearance: 0.15,
            horizon: 5.0,
            time_weight: 3.8,
            distance_weight: 1.0,
            comfort: 0.1,
            goal_weight: 1.3,
            reach: f64::INFINITY,
        }
    }
}

impl Yielding {
    /// Returns it if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        not_negative("clearance", self.clearance)?;
        positive("horizon", self.horizon)?;
        not_negative("time_weight", self.time_weight)?;
        not_negative("distance_weight", self.distance_weight)?;
        positive("comfort", self.comfort)?;
        not_negative("goal_weight", self.goal_weight)?;
        if self.reach != f64::INFINITY {
            positive("reach", self.reach)?;
        }
        Ok(self)
    }
}

/// Wanted velocity and state of the robot.
#[derive(Clone, Copy, Debug)]
pub struct Outlook<'a> {
    /// The robot.
    pub robot: RobotState<f64>,
    /// Wanted velocity in m/s.
    pub wanted: Vector2<f64>,
    /// Unit vector to the (local) goal.
    pub to_goal: Vector2<f64>,
    /// Everybody around.
    pub people: &'a [Passerby],
    /// Whether somebody who cannot be met has been left out.
    pub left_out: bool,
    /// Static obstacles.
    pub walls: StaticObstacles<'a>,
}

/// Giving way, for one robot.
#[derive(Clone, Debug)]
pub struct Yielder {
    settings: Yielding,
    /// Limits of the robot.
    pub(crate) limits: ShieldLimits,
    /// Directions of the candidates from that to the goal: nearest first.
    turns: [Vector2<f64>; DIRECTIONS],
    processor: pulp::Arch,
}

impl Yielder {
    /// Giving way with the limits of a robot.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    pub fn new(settings: Yielding, limits: ShieldLimits) -> Result<Self> {
        let mut turns = [Vector2::zeros(); DIRECTIONS];
        for (index, turn) in turns.iter_mut().enumerate() {
            let steps = index.div_ceil(2) as f64;
            let side = if index % 2 == 0 { -1.0 } else { 1.0 };
            let (sin, cos) = (side * steps * std::f64::consts::TAU / DIRECTIONS as f64).sin_cos();
            *turn = Vector2::new(cos, sin);
        }
        Ok(Self {
            settings: settings.checked()?,
            limits,
            turns,
            processor: pulp::Arch::new(),
        })
    }

    /// Settings of yielding.
    #[must_use]
    pub fn settings(&self) -> &Yielding {
        &self.settings
    }

    /// The velocity to have at the next sample, among those that `verified` admits; `None` if it
    /// admits none.
    pub fn decide(
        &self,
        outlook: &Outlook<'_>,
        mut verified: impl FnMut(Vector2<f64>) -> bool,
    ) -> Option<Vector2<f64>> {
        let wanted = self.limits.clipped(outlook.robot.velocity, outlook.wanted);
        let Yielding {
            horizon, comfort, ..
        } = self.settings;
        let mut room = [Passerby::NOBODY; SORTED];
        let crowd = self.near(outlook, &mut room);
        let alone = self.conflict::<f64>(outlook, &crowd, outlook.wanted);
        let free = alone.clearance >= comfort && alone.time >= horizon;
        if free && self.wall_time(outlook, outlook.wanted) >= horizon && verified(wanted) {
            return Some(wanted);
        }
        let choice = Choice {
            yielder: self,
            outlook,
            crowd,
            verified,
        };
        self.processor.dispatch(choice)
    }

    /// Those who can be met, or passed with less than the comfortable distance, within the horizon by some
    /// velocity: nobody else has a part in any price. Who is near comes first, so that velocities which
    /// meet somebody soon are given up early.
    fn near<'a>(&self, outlook: &Outlook<'a>, room: &'a mut [Passerby; SORTED]) -> Crowd<'a> {
        let all = outlook.people;
        if all.len() > SORTED {
            return Crowd {
                people: all,
                early: all.len(),
                left_out: outlook.left_out,
            };
        }
        let [before, wanted] =
            [outlook.robot.velocity, outlook.wanted].map(|velocity| velocity.norm());
        let fastest = self.limits.max_speed.max(before).max(wanted);
        let taking_up = (before + fastest) / self.limits.max_acceleration;
        let room_left = self.settings.clearance.max(self.settings.comfort) + SLACK;
        let (mut count, mut early) = (0, 0);
        for person in all {
            if person.gap_to(fastest, self.settings.horizon) > room_left {
                continue;
            }
            room[count] = *person;
            if person.gap_within(fastest, taking_up) <= room_left {
                room.swap(early, count);
                early += 1;
            }
            count += 1;
        }
        let distance = |person: &Passerby| person.offset.norm_squared();
        for part in [0..early, early..count] {
            room[part].sort_unstable_by(|a, b| distance(a).total_cmp(&distance(b)));
        }
        Crowd {
            people: &room[..count],
            early,
            left_out: outlook.left_out || count < all.len(),
        }
    }

    /// First meeting and least clearance of a robot that takes up velocities and keeps them.
    #[inline(always)]
    fn conflict<R: Real>(
        &self,
        outlook: &Outlook<'_>,
        crowd: &Crowd<'_>,
        velocity: Vector2<R>,
    ) -> Conflict<R> {
        let never = |_: R| false;
        self.conflict_unless(outlook, crowd, velocity, never)
            .unwrap_or_else(|| Conflict::never(self.settings.horizon))
    }

    /// Conflict, or nothing as soon as the first meeting so far makes the answer useless.
    #[inline(always)]
    fn conflict_unless<R: Real>(
        &self,
        outlook: &Outlook<'_>,
        crowd: &Crowd<'_>,
        velocity: Vector2<R>,
        useless: impl Fn(R) -> bool,
    ) -> Option<Conflict<R>> {
        let Yielding {
            clearance, horizon, ..
        } = self.settings;
        let half = R::splat(0.5);
        let before = Vector2::<R>::splat(outlook.robot.velocity.into());
        let change = velocity - before;
        let per_second = R::splat(1.0 / self.limits.max_acceleration);
        let ramp = (change.dot(&change).sqrt() * per_second).min(R::splat(horizon));
        let rest = R::splat(horizon) - ramp;
        let mean = (before + velocity) * half;
        let mut first_time = R::splat(horizon);
        let mut nearest = NearestConflict::new();
        if crowd.left_out {
            // As of somebody who is not met: a sum that may be rounded.
            first_time = first_time.min(ramp + rest);
        }
        for (index, person) in crowd.people.iter().enumerate() {
            let (touch, near) = (person.touch, person.touch + clearance);
            let own = Vector2::<R>::splat(person.velocity.into());
            let taking_up = Stretch {
                from: Vector2::<R>::splat(person.offset.into()),
                velocity: own - mean,
                duration: ramp,
            };
            let keeping = Stretch {
                from: taking_up.from + taking_up.velocity * ramp,
                velocity: own - velocity,
                duration: rest,
            };
            let (second, later) = keeping.meet(near, touch);
            let mut time = ramp + second;
            nearest.add(later, touch);
            if index < crowd.early {
                let (first, least) = taking_up.meet(near, touch);
                time = R::select(first.lt(ramp), first, time);
                nearest.add(least, touch);
            }
            first_time = first_time.min(time);
            if index % LOOKED_AT == LOOKED_AT - 1 && useless(first_time) {
                return None;
            }
        }
        Some(Conflict {
            time: first_time,
            clearance: nearest.clearance(),
        })
    }

    /// When a velocity is stopped by a wall, in s: the time until it meets one, if that is soon,
    /// and the time to brake; infinite without one.
    fn wall_time(&self, outlook: &Outlook<'_>, velocity: Vector2<f64>) -> f64 {
        let speed = velocity.norm();
        if outlook.walls.is_empty() || speed == 0.0 {
            return f64::INFINITY;
        }
        let mut time = 0.0;
        while time < WALL_HORIZON {
            let place = outlook.robot.position + velocity * time;
            let most = self.limits.radius + speed * WALL_HORIZON;
            let room = outlook.walls.clearance_up_to(place, most) - self.limits.radius;
            if room < TOUCHING {
                return time + speed / self.limits.max_acceleration;
            }
            time += room / speed;
        }
        f64::INFINITY
    }

    /// A chunk of candidates: the wanted velocity, rest, then directions and speeds.
    #[inline(always)]
    fn candidates(&self, outlook: &Outlook<'_>, chunk: usize) -> Vector2<Lanes<WIDTH>> {
        let mut x = [0.0; WIDTH];
        let mut y = [0.0; WIDTH];
        for lane in 0..WIDTH {
            let velocity = match chunk * WIDTH + lane {
                1 => Vector2::zeros(),
                index if (2..2 + DIRECTIONS * SPEEDS).contains(&index) => {
                    let (turn, speed) = ((index - 2) / SPEEDS, SPEEDS - (index - 2) % SPEEDS);
                    let turn = self.turns[turn];
                    let length = self.limits.max_speed * (speed as f64 / SPEEDS as f64);
                    let goal = outlook.to_goal;
                    Vector2::new(
                        (goal.x * turn.x - goal.y * turn.y) * length,
                        (goal.x * turn.y + goal.y * turn.x) * length,
                    )
                }
                _ => outlook.wanted,
            };
            (x[lane], y[lane]) = (velocity.x, velocity.y);
        }
        Vector2::new(
            Lanes::from_fn(|lane| x[lane]),
            Lanes::from_fn(|lane| y[lane]),
        )
    }

    /// Price of velocities without regard to others.
    #[inline(always)]
    fn aims<R: Real>(&self, outlook: &Outlook<'_>, velocity: Vector2<R>) -> R {
        let change = velocity - Vector2::<R>::splat(outlook.wanted.into());
        let ahead = velocity.dot(&Vector2::<R>::splat(outlook.to_goal.into()));
        let per_speed = R::splat(1.0 / self.limits.max_speed);
        (change.dot(&change).sqrt() - ahead * R::splat(self.settings.goal_weight)) * per_speed
    }

    /// Price of meeting others after times in s.
    #[inline(always)]
    fn haste<R: Real>(&self, time: R) -> R {
        let Yielding {
            horizon,
            time_weight,
            ..
        } = self.settings;
        let soon = R::splat(1.0) / time.max(R::splat(SOONEST)) - R::splat(1.0 / horizon);
        soon.max(R::zero()) * R::splat(time_weight)
    }

    /// Price of meeting and passing others.
    #[inline(always)]
    fn price<R: Real>(&self, conflict: &Conflict<R>) -> R {
        let Yielding {
            distance_weight,
            comfort,
            ..
        } = self.settings;
        let one = R::splat(1.0);
        let soon = self.haste(conflict.time);
        let share = conflict.clearance.max(R::zero()) * R::splat(1.0 / comfort);
        let short = (one - share).max(R::zero());
        soon + short * short * R::splat(distance_weight)
    }
}

/// The choice among the candidates, compiled once for each instruction set.
struct Choice<'a, F> {
    yielder: &'a Yielder,
    outlook: &'a Outlook<'a>,
    crowd: Crowd<'a>,
    verified: F,
}

impl<F: FnMut(Vector2<f64>) -> bool> pulp::NullaryFnOnce for Choice<'_, F> {
    type Output = Option<Vector2<f64>>;

    #[inline(always)]
    fn call(mut self) -> Self::Output {
        let (yielder, outlook, crowd) = (self.yielder, self.outlook, self.crowd);
        let before = outlook.robot.velocity;
        let (mut best, mut chosen) = (f64::INFINITY, None);
        for chunk in 0..CHUNKS {
            let candidates = yielder.candidates(outlook, chunk);
            let aims = yielder.aims(outlook, candidates);
            // Others only add to the price.
            if !aims.lt(Lanes::splat(best)).any() {
                continue;
            }
            // Whom they have still to meet only adds to the price, too.
            let useless =
                |time: Lanes<WIDTH>| !(aims + yielder.haste(time)).lt(Lanes::splat(best)).any();
            let Some(conflict) = yielder.conflict_unless(outlook, &crowd, candidates, useless)
            else {
                continue;
            };
            let prices = aims + yielder.price(&conflict);
            let mut tried = prices.lt(Lanes::splat(best));
            while let Some(lane) = cheapest(prices, tried) {
                tried = tried.without(lane);
                let velocity = Vector2::from(candidates.lane(lane));
                let mut price = prices.lane(lane);
                if price >= best {
                    break;
                }
                if !outlook.walls.is_empty() {
                    let wall = yielder.wall_time(outlook, velocity);
                    let conflict = Conflict {
                        time: conflict.time.lane(lane).min(wall),
                        clearance: conflict.clearance.lane(lane),
                    };
                    price = aims.lane(lane) + yielder.price(&conflict);
                }
                let command = yielder.limits.clipped(before, velocity);
                if price < best && (self.verified)(command) {
                    (best, chosen) = (price, Some(command));
                }
            }
        }
        chosen
    }
}

/// The lane of the least price among some lanes.
#[inline(always)]
fn cheapest(prices: Lanes<WIDTH>, among: <Lanes<WIDTH> as Number>::Mask) -> Option<usize> {
    (0..WIDTH)
        .filter(|lane| among.lane(*lane))
        .min_by(|a, b| prices.lane(*a).total_cmp(&prices.lane(*b)))
}

#[cfg(test)]
mod tests;
