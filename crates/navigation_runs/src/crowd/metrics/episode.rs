//! Observed episodes: positions over time with the sizes and rules that they are measured by.

use super::body::ObservedBody;
use crate::crowd::neighbors::grid::Period;
use crate::crowd::walls::Wall;
use numeric::error::{Failure, Given, Result, finite, finite_pair, not_negative, positive};
use numeric::lanes::Vector2;

type Point = Vector2<f64>;

/// Positions of some bodies at equal instants, by instant; NaN while one is absent.
#[derive(Clone, Copy, Debug, Default)]
pub struct Paths<'a> {
    positions: &'a [Point],
    bodies: usize,
}

impl<'a> Paths<'a> {
    /// Positions of so many bodies, all of an instant after another.
    ///
    /// # Errors
    /// They are no whole instants, infinite, or half absent.
    pub fn new(name: &str, positions: &'a [Point], bodies: usize) -> Result<Self> {
        if !positions.len().is_multiple_of(bodies.max(1)) {
            return Err(Failure::invalid(
                name,
                format!("hold whole instants of {bodies} bodies"),
                Given::Count(positions.len() as u64),
            ));
        }
        let paths = Self { positions, bodies };
        match positions.iter().position(|place| !sound(place)) {
            None => Ok(paths),
            Some(index) => Err(Failure::invalid(
                format!(
                    "{name}[{}, {}]",
                    index / bodies.max(1),
                    index % bodies.max(1)
                ),
                "be finite, or NaN in both coordinates while absent",
                Given::Pair(positions[index].into()),
            )),
        }
    }

    /// Positions that are known to be valid.
    #[must_use]
    pub fn known(positions: &'a [Point], bodies: usize) -> Self {
        Self { positions, bodies }
    }

    /// How many bodies there are.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.bodies
    }

    /// How many instants there are; 0 without bodies.
    #[must_use]
    pub fn instants(&self) -> usize {
        self.positions.len() / self.bodies.max(1)
    }

    /// Where all are at an instant.
    #[inline]
    #[must_use]
    pub fn at(&self, instant: usize) -> &'a [Point] {
        &self.positions[instant * self.bodies..(instant + 1) * self.bodies]
    }

    /// Where one is at an instant, if it is there.
    #[inline]
    #[must_use]
    pub fn place(&self, instant: usize, body: usize) -> Option<Point> {
        let place = self.positions[instant * self.bodies + body];
        (!place.x.is_nan()).then_some(place)
    }

    /// Velocity of one over the step from an instant, if it is there before and after.
    #[inline]
    #[must_use]
    pub fn velocity(&self, instant: usize, body: usize, step: f64) -> Option<Point> {
        let (from, to) = (self.place(instant, body)?, self.place(instant + 1, body)?);
        Some((to - from) / step)
    }
}

fn sound(place: &Point) -> bool {
    (place.x.is_finite() && place.y.is_finite()) || (place.x.is_nan() && place.y.is_nan())
}

/// Sizes and bounds that a robot is measured by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetricRules {
    /// Time between two instants, in s.
    pub step: f64,
    /// Goal of the robot, in m.
    pub goal: Point,
    /// Radius of the robot, in m.
    pub robot_radius: f64,
    /// Distance to the goal that counts as arrival, in m.
    pub arrival_tolerance: f64,
    /// Tolerance of arrival for people, in m.
    pub person_tolerance: f64,
    /// Speed that efficacy is measured by, in m/s.
    pub max_speed: f64,
    /// Shortest length of a path to the goal, in m; the straight one when `None`.
    pub shortest_length: Option<f64>,
    /// Lengths after which the world repeats, in m; 0 where it does not.
    pub period: Period,
}

impl MetricRules {
    /// Rules where there is no robot: a step of 1 s, a tolerance of 0.3 m.
    #[must_use]
    pub fn of_people() -> Self {
        Self {
            step: 1.0,
            goal: Point::zeros(),
            robot_radius: 1.0,
            arrival_tolerance: 0.3,
            person_tolerance: 0.3,
            max_speed: 1.0,
            shortest_length: None,
            period: Period::default(),
        }
    }

    pub(super) fn check(&self) -> Result<()> {
        positive("step", self.step)?;
        finite_pair("goal", self.goal.into())?;
        positive("robot_radius", self.robot_radius)?;
        not_negative("arrival_tolerance", self.arrival_tolerance)?;
        not_negative("person_tolerance", self.person_tolerance)?;
        positive("max_speed", self.max_speed)?;
        if let Some(length) = self.shortest_length {
            not_negative("shortest_length", length)?;
        }
        not_negative("period[0]", self.period.0[0])?;
        not_negative("period[1]", self.period.0[1])?;
        Ok(())
    }
}

/// People of the same world without robots.
#[derive(Clone, Copy, Debug)]
pub struct Without<'a> {
    /// Where they are.
    pub people: Paths<'a>,
    /// Goals of the people, in m; NaN for people without one.
    pub goals: &'a [Point],
    /// Arrivals of the people with robots and without them, where they are known; `None`: the first instants
    /// near the goals.
    pub arrivals: Option<[&'a [KnownArrival]; 2]>,
}

/// When and where a person reached the goal. Who leaves there is recorded no more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownArrival {
    /// When, in s; NaN for who did not.
    pub time: f64,
    /// Where, in m.
    pub place: Point,
}

impl KnownArrival {
    fn check(&self, name: &str) -> Result<()> {
        if self.time.is_nan() {
            return Ok(());
        }
        not_negative(name, self.time)?;
        finite_pair(name, self.place.into()).map(|_| ())
    }
}

/// One robot among people.
#[derive(Clone, Copy, Debug)]
pub struct ObservedEpisode<'a> {
    /// Positions of the robot at all instants, in m.
    pub robot: &'a [Point],
    /// Positions of the people at the same instants.
    pub people: Paths<'a>,
    /// Their radii, in m.
    pub radii: &'a [f64],
    /// Their groups; below 0 for who belongs to none, empty without any.
    pub groups: &'a [i64],
    /// Walls and other things that stand still.
    pub walls: &'a [Wall],
    /// Paths of the people without robots, if known.
    pub without: Option<Without<'a>>,
    /// Outline of a robot that is no disc; its radius is that of the circle around it.
    pub body: Option<ObservedBody<'a>>,
    /// Sizes and bounds of the metrics.
    pub rules: MetricRules,
}

impl ObservedEpisode<'_> {
    /// Distance in m of a place, given from the robot, from the center of a disc whose surface is as far from it as that of
    /// the robot is at an instant.
    #[inline]
    pub(super) fn distance(&self, instant: usize, place: Point) -> f64 {
        match &self.body {
            None => place.norm(),
            Some(body) => body.distance(instant, place) + self.rules.robot_radius,
        }
    }

    /// Looks at all values.
    ///
    /// # Errors
    /// Names the value that is out of range, or the array of another length.
    pub fn check(&self) -> Result<()> {
        self.rules.check()?;
        let count = self.people.bodies();
        if self.robot.is_empty() {
            return Err(Failure::invalid(
                "position",
                "hold at least one instant",
                Given::Found("none".into()),
            ));
        }
        for (index, place) in self.robot.iter().enumerate() {
            finite_pair(&format!("position[{index}]"), (*place).into())?;
        }
        if let Some(body) = &self.body {
            same("heading", "instants", body.headings.len(), self.robot.len())?;
            for (index, heading) in body.headings.iter().enumerate() {
                finite(&format!("heading[{index}]"), *heading)?;
            }
        }
        if count > 0 {
            same(
                "people",
                "instants",
                self.people.instants(),
                self.robot.len(),
            )?;
        }
        same("person_radius", "people", self.radii.len(), count)?;
        for (index, radius) in self.radii.iter().enumerate() {
            positive(&format!("person_radius[{index}]"), *radius)?;
        }
        if !self.groups.is_empty() {
            same("groups", "people", self.groups.len(), count)?;
        }
        if let Some(without) = &self.without {
            same("people_without", "people", without.people.bodies(), count)?;
            same("person_goals", "people", without.goals.len(), count)?;
            for (index, goal) in without.goals.iter().enumerate() {
                if !sound(goal) {
                    finite_pair(&format!("person_goals[{index}]"), (*goal).into())?;
                }
            }
            let names = ["person_arrivals", "person_arrivals_without"];
            for (name, known) in names
                .into_iter()
                .zip(without.arrivals.into_iter().flatten())
            {
                same(name, "people", known.len(), count)?;
                for (index, each) in known.iter().enumerate() {
                    each.check(&format!("{name}[{index}]"))?;
                }
            }
        }
        Ok(())
    }
}

pub(super) fn same(name: &str, what: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    Err(Failure::invalid(
        name,
        format!("be of {expected} {what}"),
        Given::Count(found as u64),
    ))
}
