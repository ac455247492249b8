//! How an obstacle moves: pieces of constant acceleration, or a recording.

use numeric::error::{Failure, Given, Result, finite_pair, not_negative};
use numeric::lanes::{Mask, Real, Truth};

/// Largest distance of a stop from the line of the velocity, in m: rounding of typed numbers.
const STOP_OFFSET: f64 = 5e-7;

/// Speed in m/s above which a step of a recording is a jump and no motion, as at the end of a loop.
pub const JUMP_SPEED: f64 = 100.0;

/// Position, velocity and acceleration of a body at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState<B: Real = f64> {
    /// Position in m.
    pub position: [B; 2],
    /// Velocity in m/s.
    pub velocity: [B; 2],
    /// Acceleration in m/s^2.
    pub acceleration: [B; 2],
    /// Whether the body is in the scene.
    pub present: B::Mask,
}

impl<B: Real> BodyState<B> {
    /// The state of one lane.
    pub fn of_lane(&self, lane: usize) -> BodyState {
        BodyState {
            position: self.position.map(|axis| axis.lane(lane)),
            velocity: self.velocity.map(|axis| axis.lane(lane)),
            acceleration: self.acceleration.map(|axis| axis.lane(lane)),
            present: self.present.lane(lane),
        }
    }

    /// Replaces the state of one lane.
    pub fn set_lane(&mut self, lane: usize, state: &BodyState) {
        for axis in 0..2 {
            self.position[axis].set(lane, state.position[axis]);
            self.velocity[axis].set(lane, state.velocity[axis]);
            self.acceleration[axis].set(lane, state.acceleration[axis]);
        }
        self.present = self.present.without(lane);
        if state.present {
            self.present.set(lane);
        }
    }
}

/// A piece of motion with constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece<B = f64> {
    /// When it begins, in s.
    pub start: B,
    /// Position then, in m.
    pub position: [B; 2],
    /// Velocity then, in m/s.
    pub velocity: [B; 2],
    /// Acceleration in m/s^2.
    pub acceleration: [B; 2],
}

impl<B: Real> Piece<B> {
    /// Position and velocity at an instant.
    #[inline(always)]
    pub fn at(&self, time: B) -> ([B; 2], [B; 2]) {
        let t = time - self.start;
        let half = B::splat(0.5);
        let along =
            |i: usize| self.position[i] + (self.velocity[i] + half * self.acceleration[i] * t) * t;
        let speed = |i: usize| self.velocity[i] + self.acceleration[i] * t;
        ([along(0), along(1)], [speed(0), speed(1)])
    }
}

/// Duration in s, velocity at its begin in m/s, acceleration in m/s^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Duration in s; may be infinite.
    pub duration: f64,
    /// Velocity at the start in m/s.
    pub velocity: [f64; 2],
    /// Acceleration in m/s^2.
    pub acceleration: [f64; 2],
}

/// Motion of a body over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Pieces in order of time; the last one lasts for ever. Most bodies have one, in its place here.
    first: Piece,
    later: Vec<Piece>,
    /// First and last instant of presence.
    presence: (f64, f64),
}

impl Motion {
    /// A body that never moves.
    #[must_use]
    pub fn at_rest(position: [f64; 2]) -> Self {
        Self::constant(position, [0.0; 2], [0.0; 2])
    }

    fn constant(position: [f64; 2], velocity: [f64; 2], acceleration: [f64; 2]) -> Self {
        let piece = Piece {
            start: 0.0,
            position,
            velocity,
            acceleration,
        };
        Self {
            first: piece,
            later: Vec::new(),
            presence: (f64::NEG_INFINITY, f64::INFINITY),
        }
    }

    /// All pieces in their order.
    fn pieces(&self) -> impl Iterator<Item = &Piece> {
        std::iter::once(&self.first).chain(&self.later)
    }

    /// Constant acceleration, or constant velocity until a sudden stop.
    ///
    /// # Errors
    /// A value is not finite, the stop does not lie ahead, or a stop is combined with an
    /// acceleration.
    pub fn moving(
        start: [f64; 2],
        velocity: [f64; 2],
        acceleration: [f64; 2],
        stop: Option<[f64; 2]>,
    ) -> Result<Self> {
        finite_pair("start", start)?;
        finite_pair("velocity", velocity)?;
        finite_pair("acceleration", acceleration)?;
        let mut motion = Self::constant(start, velocity, acceleration);
        if let Some(stop) = stop {
            finite_pair("stop", stop)?;
            if acceleration != [0.0; 2] {
                let rule = "be zero for a body with a stop";
                return Err(Failure::invalid(
                    "acceleration",
                    rule,
                    Given::Pair(acceleration),
                ));
            }
            let way = [stop[0] - start[0], stop[1] - start[1]];
            let speed_squared = velocity[0] * velocity[0] + velocity[1] * velocity[1];
            let along = way[0] * velocity[0] + way[1] * velocity[1];
            let across = way[0] * velocity[1] - way[1] * velocity[0];
            if !(along > 0.0 && across.abs() <= STOP_OFFSET * speed_squared.sqrt()) {
                let rule = "lie ahead of the start along the velocity";
                return Err(Failure::invalid("stop", rule, Given::Pair(stop)));
            }
            motion.later.push(Piece {
                start: along / speed_squared,
                position: stop,
                velocity: [0.0; 2],
                acceleration: [0.0; 2],
            });
        }
        Ok(motion)
    }

    /// A body that stands, moves straight from one instant to another, and stands again; the last
    /// instant may be infinite.
    ///
    /// # Errors
    /// A value is not finite, the first instant is negative, or the last one is before it.
    pub fn between(start: [f64; 2], velocity: [f64; 2], [from, until]: [f64; 2]) -> Result<Self> {
        finite_pair("position", start)?;
        finite_pair("velocity", velocity)?;
        not_negative("start", from)?;
        if until.is_nan() || until < from {
            let rule = "not be before start";
            return Err(Failure::invalid("stop", rule, Given::Number(until)));
        }
        let mut motion = Self::at_rest(start);
        let moving = Piece {
            start: from,
            position: start,
            velocity,
            acceleration: [0.0; 2],
        };
        if until > from {
            motion.later.push(moving);
        }
        if until > from && until.is_finite() {
            let (position, _) = moving.at(until);
            motion.later.push(Piece {
                start: until,
                position,
                velocity: [0.0; 2],
                ..moving
            });
        }
        Ok(motion)
    }

    /// First piece in which the body moves: instants in s between which it does, and its velocity
    /// at the first one in m/s.
    #[must_use]
    pub fn first_move(&self) -> Option<([f64; 2], [f64; 2])> {
        let moves = |piece: &Piece| piece.velocity != [0.0; 2] || piece.acceleration != [0.0; 2];
        let index = self.pieces().position(moves)?;
        let (piece, end) = self.piece(index);
        Some(([piece.start, end], piece.velocity))
    }

    /// Piecewise constant acceleration; after the last segment the velocity reached is kept.
    ///
    /// # Errors
    /// There is no segment, a duration is not positive, or a value is not finite.
    pub fn piecewise(start: [f64; 2], segments: &[Segment]) -> Result<Self> {
        finite_pair("start", start)?;
        if segments.is_empty() {
            let none = Given::Found("an empty list".into());
            return Err(Failure::invalid(
                "segments",
                "hold at least one segment",
                none,
            ));
        }
        let mut motion = Self::at_rest(start);
        let (mut time, mut position) = (0.0, start);
        for (index, segment) in segments.iter().enumerate() {
            let owner = format!("segments[{index}]");
            finite_pair("velocity", segment.velocity).map_err(|error| error.within(&owner))?;
            finite_pair("acceleration", segment.acceleration)
                .map_err(|error| error.within(&owner))?;
            if segment.duration.is_nan() || segment.duration <= 0.0 {
                let name = format!("{owner}.duration");
                return Err(Failure::invalid(
                    name,
                    "be positive",
                    Given::Number(segment.duration),
                ));
            }
            let piece = Piece {
                start: time,
                position,
                velocity: segment.velocity,
                acceleration: segment.acceleration,
            };
            if index == 0 {
                motion.first = piece;
            } else {
                motion.later.push(piece);
            }
            if segment.duration == f64::INFINITY {
                return Ok(motion);
            }
            time += segment.duration;
            let (reached, velocity) = piece.at(time);
            position = reached;
            if index + 1 == segments.len() {
                motion.later.push(Piece {
                    start: time,
                    position,
                    velocity,
                    acceleration: [0.0; 2],
                });
            }
        }
        Ok(motion)
    }

    /// A recording: linear between samples, absent before the first and after the last.
    ///
    /// # Errors
    /// It is empty, not finite or not strictly increasing in time.
    pub fn recorded(time: &[f64], position: &[[f64; 2]]) -> Result<Self> {
        let (Some(first), Some(last)) = (time.first(), time.last()) else {
            let none = Given::Found("an empty recording".into());
            return Err(Failure::invalid("time", "hold at least one sample", none));
        };
        if time.len() != position.len() {
            let count = Given::Count(position.len() as u64);
            return Err(Failure::invalid(
                "position",
                "have one row for each time",
                count,
            ));
        }
        for (index, (&instant, &place)) in time.iter().zip(position).enumerate() {
            if !instant.is_finite() {
                return Err(Failure::invalid(
                    format!("time[{index}]"),
                    "be finite",
                    Given::Number(instant),
                ));
            }
            finite_pair(&format!("position[{index}]"), place)?;
            if index > 0 && instant <= time[index - 1] {
                let rule = "be later than the sample before";
                let name = format!("time[{index}]");
                return Err(Failure::invalid(name, rule, Given::Number(instant)));
            }
        }
        let mut pieces = time.windows(2).zip(position.windows(2)).map(|(t, p)| {
            let rate = |i: usize| (p[1][i] - p[0][i]) / (t[1] - t[0]);
            Piece {
                start: t[0],
                position: p[0],
                velocity: [rate(0), rate(1)],
                acceleration: [0.0; 2],
            }
        });
        let alone = Piece {
            start: *first,
            position: position[0],
            velocity: [0.0; 2],
            acceleration: [0.0; 2],
        };
        Ok(Self {
            first: pieces.next().unwrap_or(alone),
            later: pieces.collect(),
            presence: (*first, *last),
        })
    }

    /// Whether the body stands where it is for all time.
    #[must_use]
    pub fn is_stationary(&self) -> bool {
        let stands = |piece: &Piece| piece.velocity == [0.0; 2] && piece.acceleration == [0.0; 2];
        self.presence == (f64::NEG_INFINITY, f64::INFINITY) && self.pieces().all(stands)
    }

    /// Instant from which the body stands where it is for all time, in s; infinite if there is
    /// none.
    #[must_use]
    pub fn stands_from(&self) -> f64 {
        let last = self.later.last().unwrap_or(&self.first);
        let stands = last.velocity == [0.0; 2] && last.acceleration == [0.0; 2];
        if stands && self.presence == (f64::NEG_INFINITY, f64::INFINITY) {
            last.start
        } else {
            f64::INFINITY
        }
    }

    /// Largest speed at any time in m/s, or `None` for a motion that accelerates.
    #[must_use]
    pub fn speed_bound(&self) -> Option<f64> {
        let steady = self.pieces().all(|piece| piece.acceleration == [0.0; 2]);
        steady.then(|| self.max_initial_speed())
    }

    /// Largest speed at the start of any piece, in m/s.
    #[must_use]
    pub fn max_initial_speed(&self) -> f64 {
        let speed = |piece: &Piece| piece.velocity[0].hypot(piece.velocity[1]);
        self.pieces().map(speed).fold(0.0, f64::max)
    }

    /// The piece of an index, and when the next one begins; infinite for the last one.
    #[must_use]
    pub fn piece(&self, index: usize) -> (&Piece, f64) {
        let next = self.later.get(index);
        let until = next.map_or(f64::INFINITY, |next| next.start);
        (self.at_index(index), until)
    }

    #[inline]
    fn at_index(&self, index: usize) -> &Piece {
        match index {
            0 => &self.first,
            _ => &self.later[index - 1],
        }
    }

    /// Whether the body is put elsewhere between two instants in s: faster than [`JUMP_SPEED`].
    #[must_use]
    pub fn jumps(&self, [from, to]: [f64; 2]) -> bool {
        (0..=self.later.len()).any(|index| {
            let (piece, until) = self.piece(index);
            let (_, [u, v]) = piece.at(from.max(piece.start));
            (index == 0 || piece.start < to) && until > from && u.hypot(v) > JUMP_SPEED
        })
    }

    /// First and last instant of presence, in s.
    #[must_use]
    pub fn presence(&self) -> (f64, f64) {
        self.presence
    }

    /// State at an instant. `cursor` remembers the piece; start it at 0.
    #[inline]
    #[must_use]
    pub fn at(&self, time: f64, cursor: &mut usize) -> BodyState {
        let mut index = (*cursor).min(self.later.len());
        while index > 0 && time < self.later[index - 1].start {
            index -= 1;
        }
        while index < self.later.len() && time >= self.later[index].start {
            index += 1;
        }
        *cursor = index;
        let piece = self.at_index(index);
        let (position, velocity) = piece.at(time);
        let present = self.presence.0 <= time && time <= self.presence.1;
        BodyState {
            position,
            velocity,
            acceleration: piece.acceleration,
            present,
        }
    }

    /// State at an instant as a sensor had it then, which may be before the start of a run at 0: whoever is
    /// there at the start was there before, and moved as the first piece of the motion has it.
    #[inline]
    #[must_use]
    pub fn at_or_before_start(&self, time: f64, cursor: &mut usize) -> BodyState {
        let state = self.at(time, cursor);
        let (from, until) = self.presence;
        let before = time < from && from <= 0.0 && until >= 0.0;
        BodyState {
            present: state.present || before,
            ..state
        }
    }
}

#[cfg(test)]
mod tests;
