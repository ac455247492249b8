//! Follows a sound: attraction to a point before its source, repulsion by echoes or by what a camera
//! sees.

use std::ops::Deref;

use nalgebra::Vector2;

use crate::impedance::attraction::Attraction;
use crate::impedance::bank::{Bank, BankLayout, BankOptions};
use crate::impedance::law::Prepared;
use crate::reflex::{Percept, Reflex};
use navigation_world::world::frame::Frame;
use navigation_world::world::shape::PlacedShape;

/// Sensors of a bank.
pub(crate) const BANK: usize = 3;

/// Most banks of a robot.
pub(crate) const BANKS: usize = 2;

/// Distance of surfaces that touch or overlap, in m: the force needs a direction.
const TOUCHING: f64 = 1e-9;

/// Source of the repulsion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RepulsionSource {
    /// Readings of banks of three sonars.
    Echoes,
    /// Bodies that a camera sees.
    Bodies,
    /// Nothing: there is none.
    Nothing,
}

/// The two forces of the law in N.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Toward the target.
    pub attraction: Vector2<f64>,
    /// Away from obstacles.
    pub repulsion: Vector2<f64>,
}

/// Constants of the law.
#[derive(Clone, Debug)]
pub struct FollowingLaw {
    /// Attraction to the source.
    pub attraction: Attraction,
    /// Repulsion of a collision vector.
    pub repulsion: Prepared,
    /// Source of the repulsion.
    pub sight: RepulsionSource,
    /// Sensors in the axes of their bank.
    pub layout: BankLayout,
    /// Banks on the robot.
    pub banks: Vec<Frame>,
    /// From readings to forces.
    pub options: BankOptions,
    /// Control period in s, and weight of a new sample in the filter of the speed.
    pub timing: (f64, f64),
    /// Radius of the body in m.
    pub body_radius: f64,
    /// Distance in m up to which bodies repel, as far as sonar reaches.
    pub reach: f64,
}

/// The law at work; `L` refers to what does not change of it, or shares it.
#[derive(Clone, Debug)]
pub struct Following<L> {
    law: L,
    banks: [Bank; BANKS],
    /// Where the robot wants to be, in m.
    target: Vector2<f64>,
}

impl<L: Deref<Target = FollowingLaw>> Following<L> {
    /// At the start.
    pub fn new(law: L) -> Self {
        Self {
            law,
            banks: [Bank::default(); BANKS],
            target: Vector2::zeros(),
        }
    }

    /// Source of its repulsion.
    #[inline]
    pub fn sight(&self) -> RepulsionSource {
        self.law.sight
    }

    /// Where the robot wants to be, in m.
    pub fn target(&self) -> Vector2<f64> {
        self.target
    }

    /// Repulsive force of bodies in N: from the surface of the robot to the nearest point of each
    /// within reach.
    fn of_bodies(&self, percept: &Percept<'_>) -> Vector2<f64> {
        let (robot, law) = (percept.pose.position, &*self.law);
        let present = percept.bodies.iter().filter(|body| body.state.present);
        law.repulsion.force_of_points(present.filter_map(|body| {
            let known = PlacedShape {
                center: body.state.position.into(),
                shape: body.shape,
            };
            let to = known.nearest(robot);
            let distance = to.dot(&to).sqrt();
            let gap = (distance - law.body_radius).max(TOUCHING);
            (distance > 0.0 && gap <= law.reach).then(|| {
                let change = Vector2::from(body.state.velocity) - percept.velocity;
                (to * (gap / distance), change)
            })
        }))
    }

    /// Repulsive force of all banks in N.
    #[inline]
    fn of_echoes(&mut self, percept: &Percept<'_>) -> Vector2<f64> {
        let law = &*self.law;
        let mut sum = Vector2::zeros();
        let readings = percept.readings.as_chunks::<BANK>().0;
        for ((bank, mounted), own) in self.banks.iter_mut().zip(&law.banks).zip(readings) {
            let pose = percept.pose.carrying(mounted);
            let (layout, options) = (&law.layout, &law.options);
            sum += bank.force(layout, own, &pose, &law.repulsion, options, law.timing);
        }
        sum
    }
}

impl<L: Deref<Target = FollowingLaw>> Reflex for Following<L> {
    type Answer = Forces;

    #[inline]
    fn answer(&mut self, percept: &Percept<'_>) -> Forces {
        let pose = &percept.pose;
        if let Some(heard) = percept.heard {
            let advance = self.law.attraction.advance(heard.range);
            self.target = pose.position + pose.outward(heard.direction) * advance;
        }
        let repulsion = match self.law.sight {
            RepulsionSource::Bodies => self.of_bodies(percept),
            RepulsionSource::Echoes => self.of_echoes(percept),
            RepulsionSource::Nothing => Vector2::zeros(),
        };
        let offset = self.target - pose.position;
        Forces {
            attraction: self.law.attraction.force(offset, percept.wanted),
            repulsion,
        }
    }
}
