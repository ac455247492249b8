//! Stretches of the trajectory: how each of them moves, and which event ends it.

use super::motion::DropMotion;
use super::{CHECK, DropContact, DropModel};
use crate::error::{Failure, Result};
use numeric::threads::Interrupted;

/// Step of a search for an event, in radians of the foam's frequency.
pub(super) const SEARCH_STEP: f64 = 0.4;

/// Time constants after which a relaxing foam is undeformed to the last bit of its deformation, and far beyond.
const RELAXED: f64 = 50.0;

/// State at the start of a stretch.
pub(super) struct DropState {
    pub(super) time: f64,
    pub(super) position: f64,
    pub(super) velocity: f64,
    /// Time and position at which a relaxing foam was let go.
    pub(super) surface: Option<(f64, f64)>,
}

impl DropState {
    pub(super) fn advance(
        &mut self,
        model: &DropModel,
        motion: DropMotion,
        until: f64,
        [position, velocity]: [f64; 2],
        [was_flying, flying]: [bool; 2],
    ) {
        self.time = until;
        self.position = position;
        // A stretch that continues in the same medium ends at a turn.
        let turned = was_flying == flying || matches!(motion, DropMotion::Rest { .. });
        self.velocity = if turned { 0.0 } else { velocity };
        if !was_flying {
            let relaxing = flying && model.contact == DropContact::Unilateral;
            self.surface = relaxing.then_some((until, position));
        }
    }
}

/// A stretch above the foam: the motion, how long it lasts and whether the next one is above too.
pub(super) fn flight(
    model: &DropModel,
    state: &DropState,
    end: f64,
    interrupted: Interrupted<'_>,
) -> Result<(DropMotion, f64, bool)> {
    let drag = model.friction / model.mass;
    let rising = state.velocity > 0.0;
    if !rising && drag >= model.gravity {
        let position = state.position;
        return Ok((DropMotion::Rest { position }, f64::INFINITY, true));
    }
    let acceleration = if rising {
        -model.gravity - drag
    } else {
        drag - model.gravity
    };
    let motion = DropMotion::Free {
        position: state.position,
        velocity: state.velocity,
        acceleration,
    };
    let turn = if rising {
        -state.velocity / acceleration
    } else {
        f64::INFINITY
    };
    let rate = 0.5 * model.relaxation_rate();
    let landing = match state.surface {
        // A relaxing surface is below the undeformed one and comes up.
        Some((time, position)) if rate.is_finite() => {
            let above = |at: f64| {
                let surface = position * (2.0 * rate * (time - state.time - at)).exp();
                motion.at(at).0 - surface
            };
            let fall = (2.0 * state.position.abs() / acceleration.abs()).sqrt();
            let step = (0.25 / rate).min(0.25 * turn).min(0.25 * fall.max(1e-4));
            let limit = turn.min(end - state.time);
            // From then on it is undeformed, and landing on it has a closed form.
            let relaxed = (time - state.time + RELAXED / (2.0 * rate)).max(0.0);
            match first_root(above, step, limit.min(relaxed), interrupted)? {
                None if relaxed < limit => falls_on_surface(state, acceleration)
                    .filter(|landing| *landing >= relaxed && *landing <= limit),
                found => found,
            }
        }
        _ if rising => None,
        _ => falls_on_surface(state, acceleration),
    };
    Ok(match landing {
        Some(landing) => (motion, landing, false),
        None if rising => (motion, turn, true),
        None => (motion, f64::INFINITY, true),
    })
}

/// A stretch on the foam.
pub(super) fn contact(
    model: &DropModel,
    state: &DropState,
    end: f64,
    interrupted: Interrupted<'_>,
) -> Result<(DropMotion, f64, bool)> {
    let weight = model.mass * model.gravity;
    let drive = -weight - model.stiffness * state.position;
    let direction = if state.velocity != 0.0 {
        state.velocity.signum()
    } else if drive.abs() <= model.friction {
        let position = state.position;
        return Ok((DropMotion::Rest { position }, f64::INFINITY, false));
    } else {
        drive.signum()
    };
    let frequency = (model.stiffness / model.mass).sqrt();
    let center = -(weight + model.friction * direction) / model.stiffness;
    let motion = DropMotion::Foam {
        center,
        offset: state.position - center,
        velocity: state.velocity,
        decay: model.damping_ratio * frequency,
        frequency,
    };
    let step = SEARCH_STEP / frequency;
    let limit = end - state.time;
    let turn = first_root(|at| direction * motion.at(at).1, step, limit, interrupted)?;
    let released = if direction > 0.0 {
        let pull = match model.contact {
            DropContact::Unilateral => 2.0 * model.damping_ratio / frequency,
            DropContact::Attached => 0.0,
        };
        let push = |at: f64| {
            let (position, velocity) = motion.at(at);
            -position - pull * velocity
        };
        first_root(push, step, turn.unwrap_or(limit), interrupted)?
    } else {
        None
    };
    Ok(match (released, turn) {
        (Some(at), _) => (motion, at, true),
        (None, Some(at)) => (motion, at, false),
        (None, None) => (motion, f64::INFINITY, false),
    })
}

/// Time after which a slide above the foam passes the undeformed surface downwards, if it ever does.
fn falls_on_surface(state: &DropState, acceleration: f64) -> Option<f64> {
    let squared = state.velocity * state.velocity - 2.0 * acceleration * state.position;
    (squared >= 0.0).then(|| (squared.sqrt() + state.velocity) / -acceleration)
}

impl DropModel {
    /// `K / C` of the foam, in 1/s.
    fn relaxation_rate(&self) -> f64 {
        (self.stiffness / self.mass).sqrt() / (2.0 * self.damping_ratio)
    }
}

/// First time at which `value`, positive after the start, becomes zero: steps, then the Illinois
/// variant of the false position.
///
/// # Errors
/// The caller asked to stop.
fn first_root(
    value: impl Fn(f64) -> f64,
    step: f64,
    limit: f64,
    interrupted: Interrupted<'_>,
) -> Result<Option<f64>> {
    let mut low = 0.0;
    let mut at_low = value(low).max(0.0);
    let mut steps = 0_usize;
    while low < limit {
        steps += 1;
        // Steps so small that they vanish in the time never end either.
        if steps.is_multiple_of(CHECK) && interrupted() {
            return Err(Failure::Interrupted);
        }
        let mut high = (low + step).min(limit);
        let mut at_high = value(high);
        if at_high > 0.0 {
            (low, at_low) = (high, at_high);
            continue;
        }
        let mut kept = 0_i8;
        for _ in 0..200 {
            let middle = if at_low > 0.0 {
                (low * at_high - high * at_low) / (at_high - at_low)
            } else {
                // Zero at the start as well: bisect until the positive side is found.
                0.5 * (low + high)
            };
            if !(middle > low && middle < high) || high - low < 1e-15 * high {
                break;
            }
            let at_middle = value(middle);
            if at_middle > 0.0 {
                (low, at_low) = (middle, at_middle);
                at_high *= if kept == 1 { 0.5 } else { 1.0 };
                kept = 1;
            } else {
                (high, at_high) = (middle, at_middle);
                at_low *= if kept == -1 { 0.5 } else { 1.0 };
                kept = -1;
            }
        }
        return Ok(Some(high));
    }
    Ok(None)
}
