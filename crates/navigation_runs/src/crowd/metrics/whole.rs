//! Metrics of a whole world: people who left or stand, robots that touch each other.

use numeric::lanes::Vector2;

use super::STANDSTILL;
use super::declared::WorldMetrics;
use super::effect::arrival;
use super::episode::{MetricRules, Paths, same};
use numeric::error::{Result, not_negative, positive};

/// Who has stood for so long is in a deadlock, in s.
const DEADLOCK: f64 = 5.0;
/// Rounding of a number of steps.
const ROUNDING: f64 = 1e-9;

/// All people and robots of a world.
#[derive(Clone, Copy, Debug)]
pub struct Whole<'a> {
    /// Positions of the people.
    pub people: Paths<'a>,
    /// Goals of the people, in m; NaN for people without one.
    pub goals: &'a [Vector2<f64>],
    /// When they arrived, in s, NaN for who did not; `None`: at the first instants near the goals.
    pub arrival_times: Option<&'a [f64]>,
    /// Positions of the robots.
    pub robots: Paths<'a>,
    /// Radii of the robots, in m.
    pub radii: &'a [f64],
    /// Time limit, in s.
    pub time_limit: f64,
    /// Step, tolerance of people and period.
    pub rules: MetricRules,
}

/// Metrics of a world.
///
/// # Errors
/// Names the value that is out of range, or the array of another length.
pub fn evaluate_world(world: &Whole<'_>) -> Result<WorldMetrics> {
    world.check()?;
    Ok(totals(world))
}

impl Whole<'_> {
    fn check(&self) -> Result<()> {
        self.rules.check()?;
        not_negative("time_limit", self.time_limit)?;
        same(
            "person_goals",
            "people",
            self.goals.len(),
            self.people.bodies(),
        )?;
        same(
            "robot_radius",
            "robots",
            self.radii.len(),
            self.robots.bodies(),
        )?;
        for (index, time) in self.arrival_times.into_iter().flatten().enumerate() {
            if !time.is_nan() {
                not_negative(&format!("person_arrival_time[{index}]"), *time)?;
            }
        }
        if let Some(times) = self.arrival_times {
            same(
                "person_arrival_time",
                "people",
                times.len(),
                self.goals.len(),
            )?;
        }
        for (index, radius) in self.radii.iter().enumerate() {
            positive(&format!("robot_radius[{index}]"), *radius)?;
        }
        if self.people.bodies() > 0 && self.robots.bodies() > 0 {
            let instants = self.people.instants();
            same("robots", "instants", self.robots.instants(), instants)?;
        }
        Ok(())
    }
}

fn totals(world: &Whole<'_>) -> WorldMetrics {
    let (people, step) = (&world.people, world.rules.step);
    let (count, instants) = (people.bodies(), people.instants());
    let (mut left, mut deadlocked, mut time) = (0, 0, 0.0);
    let (mut speed, mut steps) = (0.0, 0_u64);
    for person in 0..count {
        let aim = (world.goals[person], world.rules.person_tolerance);
        let near = || Some(arrival(people, person, aim)?.0 as f64 * step);
        let arrived = world.arrival_times.map_or_else(near, |times| {
            Some(times[person]).filter(|time| !time.is_nan())
        });
        time += arrived.unwrap_or(world.time_limit);
        left += u32::from(has_left(people, person));
        deadlocked += u32::from(arrived.is_none() && stands(people, person, step));
        for instant in 1..instants {
            if let Some(velocity) = people.velocity(instant - 1, person, step) {
                speed += velocity.norm();
                steps += 1;
            }
        }
    }
    let duration = instants.saturating_sub(1) as f64 * step;
    WorldMetrics {
        throughput: f64::from(left) / duration,
        deadlocked_share: f64::from(deadlocked) / count as f64,
        mean_person_speed: speed / steps as f64,
        aggregated_time: time,
        robot_contacts: touching_pairs(world),
    }
}

/// Whether somebody was there and is not at the end.
fn has_left(people: &Paths<'_>, person: usize) -> bool {
    let last = people.instants().saturating_sub(1);
    let there = |instant| people.place(instant, person).is_some();
    !there(last) && (0..last).any(there)
}

/// Whether somebody has stood all through the last seconds.
fn stands(people: &Paths<'_>, person: usize, step: f64) -> bool {
    // At most as many steps as there are instants, which is checked below.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let needed = (DEADLOCK / step - ROUNDING).ceil() as usize;
    let last = people.instants().saturating_sub(1);
    let slow = |instant| {
        let velocity = people.velocity(instant, person, step);
        velocity.is_some_and(|velocity| velocity.norm() < STANDSTILL)
    };
    last >= needed && (last - needed..last).all(slow)
}

/// Number of pairs of robots that touched at some instant.
fn touching_pairs(world: &Whole<'_>) -> u32 {
    let robots = &world.robots;
    let touch = |one: usize, other: usize| {
        (0..robots.instants()).any(|instant| {
            let places = robots.at(instant);
            let apart = world.rules.period.wrap(places[one] - places[other]);
            apart.norm() - world.radii[one] - world.radii[other] < 0.0
        })
    };
    let pairs = (0..robots.bodies()).flat_map(|one| (0..one).map(move |other| (one, other)));
    let touching = pairs.filter(|(one, other)| touch(*one, *other)).count();
    u32::try_from(touching).unwrap_or(u32::MAX)
}
