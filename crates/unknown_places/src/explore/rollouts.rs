//! Commands that are tried, each rolled out on two arcs, and what the places that they lead to are worth.

use nalgebra::Vector2;
use navigation_world::robots::differential::Twist;
use navigation_world::world::footprint::Footprint;
use navigation_world::world::frame::Frame;

use super::verify::{Chassis, moved};
use crate::guide::TimeToGo;
use crate::map::Cells;

/// Speeds that are tried, as shares of the largest one.
const SPEEDS: [f64; 7] = [1.0, 0.75, 0.5, 0.3, 0.15, 0.0, -0.15];
/// Turn rates that are tried first, as shares of the largest one.
const FIRST: [f64; 13] = [
    0.0, 0.075, -0.075, 0.175, -0.175, 0.325, -0.325, 0.5, -0.5, 0.75, -0.75, 1.0, -1.0,
];
/// Turn rates that follow.
const SECOND: [f64; 7] = [0.0, 0.25, -0.25, 0.5, -0.5, 1.0, -1.0];
/// Commands that are tried.
pub const COMMANDS: usize = SPEEDS.len() * FIRST.len();
/// Parts of a rollout with the first turn rate, and in all.
const FIRST_PARTS: usize = 3;
const PARTS: usize = 11;
/// Parts after which a rollout is judged.
const JUDGED: [usize; 4] = [3, 6, 8, PARTS];
/// A rollout of this time in s is long enough for a robot that stops in 0.2 s.
const LEAST_PARTS_TIME: f64 = 0.05;
/// Distance in m from what is known that a pose has, unless less is present; and how much less than the present one.
const DISTANCE: f64 = 0.05;
const LESS: f64 = 0.002;
/// Distance beyond that which costs, in m.
const NEAR: f64 = 0.08;
/// How far the point of an occupied cell, and a place, can be from the middles of their cells: twice half a diagonal.
const DIAGONAL: f64 = std::f64::consts::SQRT_2;
/// Price of an angle from the direction of the plan, in s/rad.
const TURN_PRICE: f64 = 0.2;
/// Price of driving back at speed, and of rest, in s.
const BACK_PRICE: f64 = 0.15;
const REST_PRICE: f64 = 0.3;

/// A command with its score: least is best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rated {
    /// The twist after the next control period.
    pub twist: Twist,
    /// In s; infinite where the command is not to be tried.
    pub score: f64,
}

/// Limits of rollouts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Largest speed in m/s.
    pub max_speed: f64,
    /// Largest turn rate in rad/s.
    pub max_turn_rate: f64,
    /// Control periods of a part.
    pub periods: usize,
}

impl Reach {
    /// Parts that are long enough to see where the robot can stop.
    #[must_use]
    pub fn of(chassis: &Chassis, max_speed: f64, max_turn_rate: f64) -> Self {
        let to_rest = max_speed / chassis.acceleration;
        let part = (to_rest / PARTS as f64).max(LEAST_PARTS_TIME);
        let periods = (part / chassis.period).round().clamp(1.0, 64.0) as usize;
        Self {
            max_speed,
            max_turn_rate,
            periods,
        }
    }

    /// Longest way of a rollout in m.
    #[must_use]
    pub fn longest(&self, period: f64) -> f64 {
        (PARTS * self.periods) as f64 * period * self.max_speed
    }
}

/// Poses to which commands lead.
#[derive(Clone, Debug)]
pub struct Rollouts {
    reach: Reach,
    rated: Vec<Rated>,
    turns: Vec<Turn>,
    /// Change of speed in a control period in m/s, and the period in s.
    rates: [f64; 2],
}

/// Turning within a control period: direction of the chord for each m of the way, heading after it.
#[derive(Clone, Copy, Debug)]
struct Turn {
    chord: Vector2<f64>,
    heading: Vector2<f64>,
    /// Whether the pose after it is looked at, and whether it is judged.
    looked: bool,
    judged: bool,
}

/// A rollout under way.
#[derive(Clone, Copy)]
struct Rolled {
    place: Vector2<f64>,
    speed: f64,
    cost: f64,
    score: f64,
}

/// Cells and times by which poses are judged.
struct Judge<'a> {
    cells: &'a Cells,
    plan: &'a mut TimeToGo,
    footprint: &'a Footprint,
    inner: f64,
    outer: f64,
    /// Distance in m that a pose has at least.
    least: f64,
    off: f64,
}

impl Judge<'_> {
    /// Share of the price of being near, or `None` where the pose is too near.
    fn nearness(&self, place: Vector2<f64>, heading: Vector2<f64>) -> Option<f64> {
        let away = self.cells.distance(place)?;
        let most = self.least + NEAR;
        if away > self.outer + most + self.off {
            return Some(0.0);
        }
        if away + self.off < self.inner + self.least {
            return None;
        }
        let mut nearest = most;
        let pose = Frame {
            position: place,
            direction: heading,
        };
        self.cells.occupied_near(place, self.outer + most, |point| {
            let seen = pose.inward(point - place);
            if self.footprint.beyond(seen) < nearest {
                nearest = nearest.min(self.footprint.signed_distance(seen));
            }
            nearest >= self.least
        });
        (nearest >= self.least).then(|| {
            if nearest < most {
                1.0 - (nearest - self.least) / NEAR
            } else {
                0.0
            }
        })
    }

    /// Time from a pose to the goal, with the price of the turn.
    fn value(&mut self, place: Vector2<f64>, heading: Vector2<f64>) -> Option<f64> {
        let outlook = self.plan.outlook(place)?;
        let off = outlook
            .ahead
            .map_or(0.0, |ahead| heading.perp(&ahead).atan2(heading.dot(&ahead)));
        Some(outlook.time + TURN_PRICE * off.abs())
    }
}

fn toward(value: f64, wanted: f64, step: f64) -> f64 {
    value + (wanted - value).clamp(-step, step)
}

impl Rollouts {
    /// None yet.
    #[must_use]
    pub fn new(reach: Reach) -> Self {
        Self {
            reach,
            rated: Vec::with_capacity(COMMANDS),
            turns: Vec::new(),
            rates: [0.0; 2],
        }
    }

    /// Rates all commands from a pose and a twist on; `present`: least signed distance from what is known in m.
    pub fn rate(
        &mut self,
        chassis: &Chassis,
        cells: &Cells,
        plan: &mut TimeToGo,
        pose: &Frame,
        twist: Twist,
        present: f64,
    ) -> &[Rated] {
        let (reach, period) = (self.reach, chassis.period);
        let (step, turn_step) = (
            chassis.acceleration * period,
            chassis.turn_acceleration * period,
        );
        self.rates = [step, period];
        let mut judge = Judge {
            cells,
            plan,
            footprint: &chassis.footprint,
            inner: chassis.footprint.inner_radius(),
            outer: chassis.footprint.outer_radius(),
            least: (chassis.margin + 0.02).max(DISTANCE).min(present - LESS),
            off: DIAGONAL * cells.cell(),
        };
        let part = reach.periods;
        let first = FIRST_PARTS * part;
        self.rated.clear();
        self.rated.resize(
            COMMANDS,
            Rated {
                twist: Twist::default(),
                score: f64::INFINITY,
            },
        );
        let mut turns = std::mem::take(&mut self.turns);
        for (turn, share) in FIRST.iter().enumerate() {
            let wanted = share * reach.max_turn_rate;
            turns.clear();
            let after = turned(
                &mut turns,
                (pose.direction, twist.turn_rate),
                [wanted, turn_step, period],
                (first, part),
            );
            let begun: [Option<Rolled>; SPEEDS.len()] = std::array::from_fn(|speed| {
                let mut rolled = Rolled {
                    place: pose.position,
                    speed: twist.speed,
                    cost: 0.0,
                    score: f64::INFINITY,
                };
                let wanted = SPEEDS[speed] * reach.max_speed;
                self.roll(&mut judge, &mut rolled, wanted, &turns, 0)
                    .then_some(rolled)
            });
            let mut best = begun.map(|rolled| rolled.map_or(f64::INFINITY, |rolled| rolled.score));
            if begun.iter().any(Option::is_some) {
                for share in SECOND {
                    turns.truncate(first);
                    let wanted = share * reach.max_turn_rate;
                    let rest = (PARTS - FIRST_PARTS) * part;
                    turned(&mut turns, after, [wanted, turn_step, period], (rest, part));
                    for (speed, rolled) in begun.iter().enumerate() {
                        if let Some(rolled) = rolled {
                            let wanted = SPEEDS[speed] * reach.max_speed;
                            let mut ended = *rolled;
                            self.roll(&mut judge, &mut ended, wanted, &turns, first);
                            best[speed] = best[speed].min(ended.score);
                        }
                    }
                }
            }
            for (speed, best) in best.into_iter().enumerate() {
                let target = SPEEDS[speed];
                let mut score = best;
                if target < 0.0 && twist.speed > 0.1 {
                    score += BACK_PRICE;
                }
                if target == 0.0 && *share == 0.0 {
                    score += REST_PRICE;
                }
                self.rated[speed * FIRST.len() + turn] = Rated {
                    twist: Twist {
                        speed: toward(twist.speed, target * reach.max_speed, step),
                        turn_rate: toward(twist.turn_rate, wanted, turn_step),
                    },
                    score,
                };
            }
        }
        self.turns = turns;
        &self.rated
    }

    /// Rolls on along the turns from a period on. Returns whether it came too near to nothing.
    fn roll(
        &self,
        judge: &mut Judge<'_>,
        rolled: &mut Rolled,
        wanted: f64,
        turns: &[Turn],
        from: usize,
    ) -> bool {
        let [step, period] = self.rates;
        // A rollout of longer parts pays no more for being near: against its time the prices of turns and rest stand.
        let stride = if self.reach.periods > 1 { 2.0 } else { 1.0 };
        let long = period * stride / self.reach.periods as f64;
        for (at, turn) in turns.iter().enumerate().skip(from) {
            let speed = toward(rolled.speed, wanted, step);
            rolled.place += turn.chord * (0.5 * (rolled.speed + speed) * period);
            rolled.speed = speed;
            if turn.looked {
                let Some(share) = judge.nearness(rolled.place, turn.heading) else {
                    return false;
                };
                rolled.cost += share * long;
            }
            if turn.judged
                && let Some(value) = judge.value(rolled.place, turn.heading)
            {
                let done = (at + 1) as f64 * period;
                rolled.score = rolled.score.min(done + value + rolled.cost);
            }
        }
        true
    }
}

/// Adds the turns of some periods with a turn rate that approaches a wanted one; returns heading and turn rate then.
fn turned(
    turns: &mut Vec<Turn>,
    (mut heading, mut rate): (Vector2<f64>, f64),
    [wanted, step, period]: [f64; 3],
    (periods, part): (usize, usize),
) -> (Vector2<f64>, f64) {
    // Between two poses that are looked at there are two periods, where a part has several.
    let stride = if part > 1 { 2 } else { 1 };
    for _ in 0..periods {
        let next = toward(rate, wanted, step);
        let (chord, turn) = moved(1.0, 0.5 * (rate + next) * period);
        let rotated = |vector: Vector2<f64>| {
            Vector2::new(
                heading.x * vector.x - heading.y * vector.y,
                heading.y * vector.x + heading.x * vector.y,
            )
        };
        let (chord, after) = (rotated(chord), rotated(turn));
        heading = after;
        rate = next;
        let done = turns.len() + 1;
        turns.push(Turn {
            chord,
            heading,
            looked: done.is_multiple_of(stride),
            judged: JUDGED.iter().any(|parts| parts * part == done),
        });
    }
    (heading, rate)
}
