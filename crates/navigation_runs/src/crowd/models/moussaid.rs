//! Model of Moussaid et al., Proceedings of the Royal Society B 276 (2009) 2755, with the groups of Moussaid et al.,
//! `PLoS` ONE 5 (2010) e10047.
//!
//! The angle between line of sight and interaction direction is wrapped into (-pi, pi] before the bias `epsilon B` is
//! added: other programs leave it out and turn people the wrong way.

use std::f64::consts::PI;

use crate::crowd::agent::SHORTEST;
use crate::crowd::agent_lanes::{AgentLanes, Pair, Vectors};
use crate::crowd::models::parameters::Parameters;
use crate::crowd::neighbors::Unnoticed;
use crate::crowd::neighbors::others::Each;
use crate::crowd::pedestrian::{
    Around, Pedestrian, PersonDecision, Room, Walker, awareness_of, deciding, drive, drives,
};
use crate::crowd::velocity_programs::LaneRoom;
use crate::crowd::walls::pushes;
use navigation_world::arguments::{Arguments, Named};
use numeric::angle::unsigned_angle;
use numeric::elementary::fading;
use numeric::error::Result;
use numeric::lanes::{Planar, Real, Vector2};

type Vector = Vector2<f64>;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moussaid {
    /// `tau` in s.
    pub relaxation_time: f64,
    /// `A` in m/s^2.
    pub strength: f64,
    /// `gamma`.
    pub gamma: f64,
    /// `n`, how narrow the turning is.
    pub n: f64,
    /// `n'`, how narrow the slowing is.
    pub n_prime: f64,
    /// `lambda`, weight of the relative velocity, in s/m.
    pub velocity_weight: f64,
    /// `epsilon`, bias to one side.
    pub side_bias: f64,
    /// Push of walls in m/s^2.
    pub wall_strength: f64,
    /// Range of walls in m.
    pub wall_range: f64,
    /// `beta_1` in 1/(s rad).
    pub gaze: f64,
    /// `beta_2` in m/s^2.
    pub cohesion: f64,
    /// `beta_3` in m/s^2.
    pub separation: f64,
    /// `phi`, half the angle of view in groups, in rad.
    pub view_angle: f64,
    /// `d0`, distance that members of a group keep, in m.
    pub contact_distance: f64,
    /// Distance in m beyond which nobody acts; infinite for none.
    pub cutoff: f64,
}

impl Named for Moussaid {
    const NAME: &'static str = "moussaid";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let given = Parameters(given);
        Ok(Self {
            relaxation_time: given.positive("relaxation_time")?,
            strength: given.not_negative("strength")?,
            gamma: given.positive("gamma")?,
            n: given.not_negative("n")?,
            n_prime: given.not_negative("n_prime")?,
            velocity_weight: given.not_negative("velocity_weight")?,
            side_bias: given.finite("side_bias")?,
            wall_strength: given.not_negative("wall_strength")?,
            wall_range: given.positive("wall_range")?,
            gaze: given.not_negative("gaze")?,
            cohesion: given.not_negative("cohesion")?,
            separation: given.not_negative("separation")?,
            view_angle: given.not_negative("view_angle")?,
            contact_distance: given.not_negative("contact_distance")?,
            cutoff: given.cutoff()?,
        })
    }
}

impl Moussaid {
    /// Acceleration by somebody at distance `d` in direction `-n`, with the velocity relative to him in m/s:
    /// `A exp(-d/B)` times `exp(-(n B theta)^2)` to the side and `exp(-(n' B theta)^2)` backward, as two exponentials.
    #[inline(always)]
    #[must_use]
    pub fn push<R: Real>(
        &self,
        normal: Vector2<R>,
        distance: R,
        relative: Vector2<R>,
    ) -> Vector2<R> {
        let (zero, pi) = (R::zero(), R::splat(PI));
        let weight = R::splat(self.velocity_weight);
        let interaction = relative * weight - normal;
        let length = interaction.dot(&interaction).sqrt();
        let least = R::splat(SHORTEST);
        let per_length = R::splat(1.0) / length.max(least);
        // The angle is that of the directions: their lengths do not matter.
        let across = normal.y * interaction.x - normal.x * interaction.y;
        let angle = unsigned_angle(across, -normal.dot(&interaction)).copysign(across);
        let angle = R::select(angle.le(-pi), pi, angle);
        let reach = R::splat(self.gamma) * length;
        let theta = angle + R::splat(self.side_bias) * reach;
        // A product of exponentials is that of a sum.
        let apart = distance * per_length * R::splat(1.0 / self.gamma);
        // Written out: a map over the two would not be compiled in its place.
        let wide = R::splat(self.n) * reach * theta;
        let turning = fading(-(apart + wide * wide));
        let narrow = R::splat(self.n_prime) * reach * theta;
        let slowing = fading(-(apart + narrow * narrow));
        // Nobody without a direction pushes.
        let size = R::splat(self.strength) * per_length;
        let size = R::select(length.lt(least), zero, size);
        let slowing = slowing * size;
        let turning = (turning * size).copysign(theta);
        let turning = R::select(theta.abs().gt(zero), turning, zero);
        Vector2::new(
            -interaction.y * turning - interaction.x * slowing,
            interaction.x * turning - interaction.y * slowing,
        )
    }

    /// Adds walls and the group of a person, if there may be one, to a force.
    #[inline(always)]
    fn beside_others(
        &self,
        mut force: Vector,
        own: &Walker,
        (around, grouped): (&Around<'_>, bool),
    ) -> Vector {
        force += pushes(around.walls, own.agent.position, |near| {
            near.normal * (self.wall_strength * (-near.distance / self.wall_range).exp())
        });
        if !grouped {
            return force + Vector::zeros();
        }
        force + self.group(own, around)
    }

    /// Acceleration by the group of a person.
    fn group(&self, own: &Walker, around: &Around<'_>) -> Vector {
        let found = around.company.company(&own.agent, self.contact_distance);
        if found.members < 2 {
            return Vector::zeros();
        }
        let members = found.members as f64;
        let center = found.ways / members;
        let mut force = found.crowding * self.separation;
        let away = center.norm();
        if away > 0.5 * (members - 1.0) {
            force += center * (self.cohesion / away);
        }
        let others = found.ways / (members - 1.0);
        let ahead = own.agent.direction;
        if others.norm() > 0.0 && ahead != Vector::zeros() {
            let angle = ahead.perp(&others).abs().atan2(ahead.dot(&others));
            let turned = (angle - self.view_angle).max(0.0);
            force -= own.agent.velocity * (self.gaze * turned);
        }
        force
    }
}

impl Pedestrian for Moussaid {
    const LARGEST_STEP: f64 = 0.05;
    const CAP: f64 = 1.3;
    const IS_FORCE: bool = true;
    const LANES: bool = true;

    #[inline(always)]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector {
        let mut force = drive(own, self.relaxation_time);
        let velocity: Vector2<Each> = Planar::<Each>::splat(own.agent.velocity.into());
        let limits = (self.cutoff, own.awareness);
        let neighbors = around.neighbors;
        for others in neighbors.near(&own.agent, limits, Unnoticed::Skipped, &mut room.near) {
            let relative = velocity - others.velocity();
            let push = self.push(others.normal, others.distance, relative);
            others.add(push * others.weight, &mut force);
        }
        self.beside_others(force, own, (around, true))
    }

    #[inline(always)]
    fn decide_together(
        &self,
        walkers: &[Walker],
        around: &Around<'_>,
        room: &mut Room,
        decisions: &mut [PersonDecision],
    ) -> bool {
        let awareness = awareness_of(walkers);
        let Room { pairs, sums, .. } = room;
        sums.clear();
        sums.extend(drives(walkers, self.relaxation_time));
        let robots = around.neighbors.robots.agents().len();
        sums.resize(walkers.len() + robots, Vector::zeros());
        pairs.open(&around.neighbors);
        while pairs.find(&around.neighbors, self.cutoff, awareness) {
            for pairs in pairs.side_by_side() {
                let push = self.push(pairs.normal, pairs.distance, pairs.relative);
                pairs.add(push * pairs.weight, sums);
            }
        }
        let grouped = around.company.any();
        for (place, own) in deciding(walkers) {
            let decision = self.beside_others(sums[place], own, (around, grouped));
            decisions[own.agent.number as usize] = PersonDecision::of(own, decision);
        }
        true
    }

    #[inline(always)]
    fn decide_in_lanes(
        &self,
        agents: &AgentLanes,
        _room: &mut LaneRoom,
        decisions: &mut Vec<Vectors>,
    ) {
        // A closure that is a function of its own would not get the instructions of the lanes.
        agents.accelerations(
            (self.relaxation_time, self.cutoff),
            #[inline(always)]
            |_, pair: &Pair| {
                let push = self.push(pair.normal, pair.distance, pair.relative) * pair.weight;
                [push, -push]
            },
            decisions,
        );
    }
}
