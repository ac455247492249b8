//! One test with everything recorded, firing by firing.

use std::sync::Arc;

use nalgebra::Vector2;

use crate::run::Interrupted;
use crate::run::episode::Episode;
use crate::run::skirt::batch::TestPlan;
use crate::run::skirt::robot::{Moment, MomentObserver, Skirt, SkirtParts, SkirtResult, episode};
use crate::run::skirt::scene::DiscScene;
use navigation_laws::escape::{Decider, EscapeAction};
use navigation_laws::reflex::Percept;
use numeric::error::Result;

/// States after each firing: one row each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkirtRecord {
    /// In s.
    pub time: Vec<f64>,
    /// In m.
    pub position: Vec<Vector2<f64>>,
    /// In m/s.
    pub velocity: Vec<Vector2<f64>>,
    /// In rad, counterclockwise from x, from -pi to pi.
    pub heading: Vec<f64>,
    /// In rad/s.
    pub yaw_rate: Vec<f64>,
    /// Sensors of a firing side by side, in m.
    pub readings: Vec<f64>,
    /// Decisions.
    pub action: Vec<EscapeAction>,
}

impl MomentObserver for SkirtRecord {
    fn moment(&mut self, moment: &Moment<'_>) {
        self.time.push(moment.time);
        self.position.push(moment.pose.position);
        self.velocity.push(moment.velocity);
        self.heading.push(moment.pose.angle());
        self.yaw_rate.push(moment.yaw_rate);
        self.readings.extend_from_slice(moment.readings);
        self.action.push(moment.action);
    }
}

/// A test that is stepped from outside and keeps every firing.
pub struct SkirtSteps {
    episode: Episode<SkirtParts<Arc<Decider>, Arc<DiscScene>, SkirtRecord>>,
    scene: Arc<DiscScene>,
}

impl SkirtSteps {
    /// A test of a plan at its start.
    ///
    /// # Errors
    /// The plan is out of range, or there is no room for the discs.
    pub fn new(skirt: &Skirt, plan: &TestPlan, index: usize) -> Result<Self> {
        let plan = plan.checked(skirt)?;
        let (course, scene, noise) = plan.test(skirt, index)?;
        let (law, scene) = (Arc::clone(skirt.decider()), Arc::new(scene));
        let (start, record) = ((course, noise), SkirtRecord::default());
        let around = Arc::clone(&scene);
        let episode = episode(skirt, law, &plan.motion, around, start, record)?;
        Ok(Self { episode, scene })
    }

    /// One firing period under the skirt's decision, or under another. Does nothing at the end.
    ///
    /// # Errors
    /// The state became non-finite, or the caller asked to stop.
    pub fn period(
        &mut self,
        action: Option<EscapeAction>,
        interrupted: Interrupted<'_>,
    ) -> Result<()> {
        self.episode.period(action, interrupted)
    }

    /// Runs to the end under the skirt's decisions.
    ///
    /// # Errors
    /// Errors of [`Self::period`].
    pub fn run(&mut self, interrupted: Interrupted<'_>) -> Result<()> {
        self.episode.finish(interrupted)
    }

    /// Whether the test has ended.
    #[must_use]
    pub fn finished(&self) -> bool {
        self.episode.finished()
    }

    /// Time of the firings so far, in s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.episode.stepped()
    }

    /// Readings that the skirt decides by.
    #[must_use]
    pub fn percept(&self) -> Percept<'_> {
        self.episode.parts.percept()
    }

    /// The discs.
    #[must_use]
    pub fn scene(&self) -> &DiscScene {
        &self.scene
    }

    /// Result of the test so far.
    #[must_use]
    pub fn recorded(&self) -> (SkirtResult, &SkirtRecord) {
        (self.episode.parts.found, &self.episode.parts.watch)
    }
}
