//! Gaps between a robot and what is around it, and what they cost.

use super::Vector;
use crate::filters::Near;
use navigation_world::arguments::Arguments;
use navigation_world::world::map::StaticMap;
use navigation_world::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result};

/// Motion of people that is predicted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PeopleMotion {
    /// They stand, as in Nav2.
    #[default]
    Static,
    /// They keep their velocity.
    ConstantVelocity,
}

impl PeopleMotion {
    /// The prediction whose word an argument is.
    ///
    /// # Errors
    /// There is none of this word.
    pub(crate) fn given(given: &dyn Arguments, name: &str) -> Result<Self> {
        match &*given.word(name)? {
            "static" => Ok(Self::Static),
            "constant_velocity" => Ok(Self::ConstantVelocity),
            other => {
                let rule = "be one of static, constant_velocity";
                Err(Failure::invalid(name, rule, Given::Word(other.into())))
            }
        }
    }

    /// Velocity that counts of a measured one.
    fn of(self, velocity: Vector) -> Vector {
        match self {
            Self::Static => Vector::zeros(),
            Self::ConstantVelocity => velocity,
        }
    }
}

/// A rectangle, with its velocity in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingShape {
    /// The rectangle now.
    pub placed: PlacedShape,
    /// Its velocity in m/s.
    pub velocity: Vector,
}

/// Walls as a law is told of them.
#[derive(Clone, Copy, Debug)]
pub struct Walls<'a> {
    /// Rectangles.
    pub shapes: &'a [MovingShape],
    /// Map of what stands, if there is one.
    pub map: Option<&'a StaticMap>,
}

/// Gaps of a robot with a radius.
#[derive(Clone, Copy, Debug)]
pub struct Gaps<'a> {
    /// Radius of the robot in m.
    pub radius: f64,
    /// People.
    pub people: &'a [Near],
    /// Walls and filled shapes.
    pub walls: Walls<'a>,
}

impl Gaps<'_> {
    /// `gap(p, t)` in m: least distance of the surfaces at a place and a time in s.
    #[inline]
    #[must_use]
    pub fn at(&self, place: Vector, time: f64, prediction: PeopleMotion) -> f64 {
        self.up_to(place, (time, prediction), f64::INFINITY)
    }

    /// The gap, where all that is at least so many m away counts as that far.
    #[inline]
    #[must_use]
    pub fn up_to(&self, place: Vector, (time, prediction): (f64, PeopleMotion), most: f64) -> f64 {
        let mut least = most + self.radius;
        for person in self.people {
            let at = person.position + prediction.of(person.velocity) * time;
            let to = at - place;
            least = least.min(to.dot(&to).sqrt() - person.radius);
        }
        for wall in self.walls.shapes {
            let from = place - prediction.of(wall.velocity) * time;
            least = least.min(wall.placed.distance(from));
        }
        if let Some(map) = self.walls.map {
            least = least.min(map.clearance_up_to(place, least.max(0.0)));
        }
        least - self.radius
    }

    /// Speed of the fastest person in m/s, as predicted.
    #[must_use]
    pub fn fastest(&self, prediction: PeopleMotion) -> f64 {
        let people = self.people.iter().map(|person| person.velocity);
        let shapes = self.walls.shapes.iter().map(|wall| wall.velocity);
        let speeds = people
            .chain(shapes)
            .map(|velocity| prediction.of(velocity).norm());
        speeds.fold(0.0, f64::max)
    }
}

/// Cost of a gap: Nav2's inflation without cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inflation {
    /// How fast it falls, `k`, in 1/m.
    pub cost_scaling_factor: f64,
    /// Distance in m from the center of the robot beyond which nothing costs.
    pub inflation_radius: f64,
}

/// Cost of a contact.
const LETHAL: f64 = 254.0;
/// Cost of a gap that closes.
const INSCRIBED: f64 = 252.0;

impl Inflation {
    /// Nav2's defaults for the field of both numbers.
    pub const DEFAULT: Self = Self {
        cost_scaling_factor: 3.0,
        inflation_radius: 0.55,
    };

    /// `252 exp(-k d)` of a gap in m, 254 in contact, 0 beyond the inflation radius of a robot with a radius in m.
    #[inline]
    #[must_use]
    pub fn cost(&self, gap: f64, radius: f64) -> f64 {
        if gap <= 0.0 {
            LETHAL
        } else if gap > self.inflation_radius - radius {
            0.0
        } else {
            INSCRIBED * (-self.cost_scaling_factor * gap).exp()
        }
    }
}
