//! Input and output of a pedestrian model.

use crate::crowd::agent::{Agent, SHORTEST};
use crate::crowd::agent_lanes::{AgentLanes, Vectors};
use crate::crowd::neighbors::Neighbors;
use crate::crowd::neighbors::grid::Period;
use crate::crowd::neighbors::mutual::Mutual;
use crate::crowd::neighbors::nearest::Nearest;
use crate::crowd::neighbors::others::Each;
use crate::crowd::neighbors::pairs::PairQueue;
use crate::crowd::velocity_programs::LaneRoom;
use crate::crowd::walls::Wall;
use navigation_laws::planning::half_planes::{HalfPlane, Solver};
use navigation_world::arguments::Named;
use numeric::lanes::Vector2;

/// A person who decides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Walker {
    /// The person as others see them.
    pub agent: Agent,
    /// Speed `v0` that the person wants, in m/s.
    pub desired_speed: f64,
    /// Whether the person decides, not a recording.
    pub decides: bool,
    /// Distance from the next point of the route in m.
    pub to_go: f64,
    /// Whether the route has ended: the person stays.
    pub stays: bool,
    /// Direction in which the person walked last, of length 1.
    pub heading: Vector2<f64>,
    /// Share `a` by which the person takes robots into account.
    pub awareness: f64,
}

/// Decision of a person.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PersonDecision {
    /// Acceleration in m/s^2 of a force model, velocity in m/s of a velocity model.
    pub order: Vector2<f64>,
    /// Direction in which the person walks now, of models that keep it.
    pub heading: Vector2<f64>,
}

impl PersonDecision {
    /// An order that leaves the heading of a person as it is.
    #[inline(always)]
    pub(super) fn of(own: &Walker, order: Vector2<f64>) -> Self {
        Self {
            order,
            heading: own.heading,
        }
    }
}

/// Members of the person's group, relative to the person.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Company {
    /// Members present, the person included.
    pub members: usize,
    /// Sum of the ways from the person to the others, in m.
    pub ways: Vector2<f64>,
    /// Sum of the unit vectors from those nearer than the distance that groups keep.
    pub crowding: Vector2<f64>,
}

/// Everything around a person.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a> {
    /// The others.
    pub neighbors: Neighbors<'a>,
    /// Walls of the world.
    pub walls: &'a [Wall],
    /// Group of the person.
    pub company: &'a dyn Fellows,
    /// How long the decision holds, in s.
    pub step: f64,
}

/// The group of a person.
pub trait Fellows: std::fmt::Debug {
    /// Whether anybody belongs to a group.
    fn any(&self) -> bool;

    /// Its members around a person; `near`: the distance in m below which they are too near.
    fn company(&self, own: &Agent, near: f64) -> Company;
}

/// The members of a group, by number and position, around one of them.
pub(super) fn company_of(
    own: &Agent,
    members: impl Iterator<Item = (u32, Vector2<f64>)>,
    near: f64,
    period: Period,
) -> Company {
    let mut found = Company::default();
    for (number, position) in members {
        found.members += 1;
        if number == own.number {
            continue;
        }
        let way = period.wrap(position - own.position);
        found.ways += way;
        let distance = way.norm();
        if distance < SHORTEST {
            found.crowding.x += if own.number < number { 1.0 } else { -1.0 };
        } else if distance < near {
            found.crowding -= way / distance;
        }
    }
    found
}

/// Groups at a state: the group of every agent, who are all people.
#[derive(Clone, Copy, Debug)]
pub struct Groupings<'a> {
    /// Everybody by number.
    pub agents: &'a [Agent],
    /// Their groups.
    pub of: &'a [Option<u32>],
    /// Lengths after which the world repeats itself.
    pub period: Period,
}

impl Fellows for Groupings<'_> {
    fn any(&self) -> bool {
        self.of.iter().any(Option::is_some)
    }

    fn company(&self, own: &Agent, near: f64) -> Company {
        let group = self.of.get(own.number as usize).copied().flatten();
        if group.is_none() {
            return Company::default();
        }
        let all = self.agents.iter().zip(self.of);
        let members = all.filter(|(_, other)| **other == group);
        let places = members.map(|(agent, _)| (agent.number, agent.position));
        company_of(own, places, near, self.period)
    }
}

/// Some bodies side by side as somebody sees them who does not want to walk into them.
#[derive(Clone, Copy, Debug)]
pub struct SeenBody {
    /// From the bodies, in m.
    pub offset: Vector2<Each>,
    /// Distance of the surfaces in m, over the weight; infinite in lanes that are left over.
    pub gap: Each,
    /// Sum of the radii in m.
    pub touch: Each,
}

/// Room that decisions need, used again and again.
#[derive(Clone, Debug, Default)]
pub struct Room {
    /// Places in the grids of those who are near.
    pub near: Vec<u32>,
    /// The nearest of them.
    pub nearest: Nearest,
    /// Bodies ahead.
    pub ahead: Vec<SeenBody>,
    /// Half-planes of permitted velocities.
    pub planes: Vec<HalfPlane>,
    /// Linear programs.
    pub solver: Solver,
    /// Pairs of those who act on each other.
    pub pairs: PairQueue,
    /// Half-planes that they keep off each other by.
    pub mutual: Mutual,
    /// Ways that everybody takes, and where everybody wants to go, by the same places.
    pub ways: Vec<Vector2<f64>>,
    /// See `ways`.
    pub aheads: Vec<Vector2<f64>>,
    /// Sums of all people so far, by the places of [`Pairs`](crate::crowd::neighbors::pairs::Pairs).
    pub sums: Vec<Vector2<f64>>,
}

/// A model of people.
pub(in crate::crowd) trait Pedestrian: Named {
    /// Largest step in s.
    const LARGEST_STEP: f64;
    /// Largest speed as a multiple of the desired one, infinite for none.
    const CAP: f64;
    /// Whether a decision is an acceleration, not a velocity.
    const IS_FORCE: bool;
    /// Whether people of worlds side by side decide in lanes.
    const LANES: bool = false;

    /// Acceleration in m/s^2 of a force model, velocity in m/s of a velocity model.
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector2<f64>;

    /// Decides for everybody in a world that does not repeat itself, pairs at once; returns whether it has.
    fn decide_together(
        &self,
        _walkers: &[Walker],
        _around: &Around<'_>,
        _room: &mut Room,
        _decisions: &mut [PersonDecision],
    ) -> bool {
        false
    }

    /// Decides for the people of worlds side by side, if they do that in lanes.
    fn decide_in_lanes(
        &self,
        _agents: &AgentLanes,
        _room: &mut LaneRoom,
        _decisions: &mut Vec<Vectors>,
    ) {
    }
}

/// Drive `(v0 e - v)/tau` of the force models.
#[inline]
pub(super) fn drive(own: &Walker, relaxation_time: f64) -> Vector2<f64> {
    (own.agent.direction * own.desired_speed - own.agent.velocity) / relaxation_time
}

/// Drives of everybody by their places in a grid, where the sums of their forces start.
#[inline(always)]
pub(super) fn drives(
    walkers: &[Walker],
    relaxation_time: f64,
) -> impl Iterator<Item = Vector2<f64>> + '_ {
    walkers.iter().map(move |own| drive(own, relaxation_time))
}

/// People who decide, with their places in a grid.
#[inline(always)]
pub(super) fn deciding(walkers: &[Walker]) -> impl Iterator<Item = (usize, &Walker)> {
    walkers.iter().enumerate().filter(|(_, own)| own.decides)
}

/// Awareness of robots of somebody at a place of a grid.
#[inline(always)]
pub(super) fn awareness_of(walkers: &[Walker]) -> impl Fn(usize) -> f64 + Copy + '_ {
    |place| walkers[place].awareness
}
