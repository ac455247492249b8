//! The one loop that steps time: sense, decide, move, one control period after the other.
//!
//! Sensing, decision and motion are the parts of an episode; every robot under every
//! law is stepped here. The lane kernel, [`super::lanes`], is its fast path for ideal point masses
//! side by side.

use crate::run::Interrupted;
use crate::run::options::Clock;
use numeric::error::{Failure, Result};

/// Parts of an episode: a world, a robot with sensors, a drive and a law or a command, and the counts and records
/// of its run.
///
/// Times are those of the clock after a number of motion steps.
pub trait Parts {
    /// Request in a control period; its default is the law of the episode.
    type Request: Default;
    /// Control periods between two questions whether to stop.
    const ATTENTION: usize = 1;

    /// Whether the run has ended.
    fn ended(&self) -> bool;

    /// Decides until the next sample and tells the drive, from what was sensed last; `false` if there
    /// is nothing to decide by.
    ///
    /// # Errors
    /// The command or the state is not finite, or the caller stopped the run; the state is unchanged
    /// then.
    fn decide(
        &mut self,
        time: f64,
        request: Self::Request,
        interrupted: Interrupted<'_>,
    ) -> Result<bool>;

    /// Moves the robot by the motion step that starts after a number of them, and accounts for it.
    fn travel(&mut self, clock: &Clock, step: usize);

    /// Brings the world to an instant between or at samples, and shows it to the sensors.
    fn look_around(&mut self, clock: &Clock, step: usize);

    /// Returns nothing if the state is finite.
    ///
    /// # Errors
    /// It is not.
    fn check(&self, time: f64) -> Result<()>;

    /// Ends the run because its time is over, unless it has ended.
    fn time_over(&mut self, time: f64);

    /// Measures once, at a sample.
    fn sense(&mut self, clock: &Clock, step: usize);
}

/// A run that is under way.
pub struct Episode<P> {
    /// Parts of the episode.
    pub(crate) parts: P,
    clock: Clock,
    /// Motion steps so far.
    step: usize,
    /// The number of them at the next sample.
    sample: usize,
}

impl<P: Parts> Episode<P> {
    /// A run at its start, where the robot senses for the first time.
    pub(crate) fn starting(parts: P, clock: Clock) -> Result<Self> {
        let mut episode = Self {
            parts,
            clock,
            step: 0,
            sample: 0,
        };
        episode.restart(clock)?;
        Ok(episode)
    }

    /// Starts again with its parts, which somebody has brought back to the start.
    pub(crate) fn restart(&mut self, clock: Clock) -> Result<()> {
        (self.clock, self.step) = (clock, 0);
        self.parts.look_around(&self.clock, 0);
        self.parts.check(0.0)?;
        self.parts.sense(&self.clock, 0);
        Ok(())
    }

    /// Whether the run has ended.
    #[must_use]
    pub fn finished(&self) -> bool {
        self.parts.ended()
    }

    /// Time of the motion steps so far in s.
    pub(crate) fn stepped(&self) -> f64 {
        self.clock.time(self.step)
    }

    /// Motion step in s.
    pub(crate) fn motion_step(&self) -> f64 {
        self.clock.step
    }

    /// Decides, moves for one control period, and senses what comes of it. Does nothing once the
    /// run has ended, or without a law where the law is to decide.
    ///
    /// # Errors
    /// The force or the state is not finite, or the caller asked to stop; the episode then stands
    /// where it was.
    #[inline]
    pub fn period(&mut self, request: P::Request, interrupted: Interrupted<'_>) -> Result<()> {
        if !self.begin(request, interrupted)? {
            return Ok(());
        }
        while self.advance() {}
        self.end()
    }

    /// The first part of a control period: decides; `false` if there is nothing to do after it.
    ///
    /// # Errors
    /// Errors of [`Self::period`].
    #[inline]
    pub(crate) fn begin(
        &mut self,
        request: P::Request,
        interrupted: Interrupted<'_>,
    ) -> Result<bool> {
        if self.finished() {
            return Ok(false);
        }
        if (self.step + 1).is_multiple_of(P::ATTENTION) && interrupted() {
            return Err(Failure::Interrupted);
        }
        let next = self.step + self.clock.steps_per_sample;
        self.sample = self.clock.steps.min(next);
        self.parts.decide(self.stepped(), request, interrupted)
    }

    /// The second part, again and again: moves by a motion step; whether another one belongs to the
    /// control period.
    #[inline]
    pub(crate) fn advance(&mut self) -> bool {
        self.parts.travel(&self.clock, self.step);
        self.step += 1;
        self.parts.look_around(&self.clock, self.step);
        !(self.step == self.sample || self.finished())
    }

    /// The last part: senses what has come of it.
    ///
    /// # Errors
    /// The state is not finite.
    #[inline]
    pub(crate) fn end(&mut self) -> Result<()> {
        let time = self.stepped();
        self.parts.check(time)?;
        if self.step == self.clock.steps {
            self.parts.time_over(time);
        }
        self.parts.sense(&self.clock, self.step);
        Ok(())
    }

    /// Runs to the end under the law.
    ///
    /// # Errors
    /// Errors of [`Self::period`].
    #[inline]
    pub(crate) fn run(mut self, interrupted: Interrupted<'_>) -> Result<Self> {
        self.finish(interrupted)?;
        Ok(self)
    }

    /// Runs to the end under the law.
    ///
    /// # Errors
    /// Errors of [`Self::period`].
    #[inline]
    pub(crate) fn finish(&mut self, interrupted: Interrupted<'_>) -> Result<()> {
        while !self.finished() {
            self.period(P::Request::default(), interrupted)?;
        }
        Ok(())
    }
}
