//! Trajectory of a slide that falls on a foam and bounces (zeng2011, A.1.3 and A.1.4).
//!
//! Every stretch between two events (contact, release, turn, rest) has a closed form; only the
//! events are searched for.

mod motion;
mod stretch;

use crate::error::{Failure, Given, Result, finite, not_negative, positive};
use crate::signal::check_time;
use motion::DropMotion;
use numeric::threads::Interrupted;
use stretch::{DropState, SEARCH_STEP, contact, flight};

/// Events after which a slide counts as resting; only bounces below rounding are that many.
const MOST_STRETCHES: usize = 100_000;
/// Steps of a search, and samples, between two looks whether to stop.
const CHECK: usize = 4096;
/// Least step as a share of the record: below it times are rounded away.
const LEAST_STEP: f64 = 1e-14;

/// When the foam lets go of the slide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DropContact {
    /// When its force would become a pull; the foam then relaxes on its own.
    Unilateral,
    /// When the slide passes the undeformed surface: the foam sticks to it until then.
    Attached,
}

/// A slide on a rail with friction above a foam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropModel {
    /// Moving mass `m`, in kg.
    pub mass: f64,
    /// Foam stiffness `K_c`, in N/m.
    pub stiffness: f64,
    /// Foam damping as a ratio, `C = 2 xi sqrt(m K_c)`.
    pub damping_ratio: f64,
    /// Friction of the rail `f`, in N.
    pub friction: f64,
    /// Height above the foam from which it is released at rest, in m.
    pub height: f64,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
    /// When the foam lets go.
    pub contact: DropContact,
}

impl DropModel {
    fn checked(self) -> Result<Self> {
        positive("mass", self.mass)?;
        positive("stiffness", self.stiffness)?;
        not_negative("damping_ratio", self.damping_ratio)?;
        not_negative("friction", self.friction)?;
        not_negative("height", self.height)?;
        positive("gravity", self.gravity)?;
        Ok(self)
    }

    /// Also passes a foam whose oscillations are resolved by the numbers of the times.
    fn checked_for(self, time: &[f64]) -> Result<Self> {
        let model = self.checked()?;
        let fastest = SEARCH_STEP / (LEAST_STEP * (time[time.len() - 1] - time[0]));
        let most = model.mass * fastest * fastest;
        if model.stiffness > most {
            let rule = format!("be at most {most:.3e} N/m for this mass and duration");
            return Err(Failure::invalid(
                "stiffness",
                rule,
                Given::Number(model.stiffness),
            ));
        }
        Ok(model)
    }
}

/// Position over time, in m, up from the surface of the foam; released at the first time.
///
/// In contact `m y'' + C y' + K y = -(m g + f sign(y'))`, above it gravity and friction only. The
/// slide stays where friction can hold it.
///
/// # Errors
/// A parameter out of range, times that do not rise, numbers so far apart that positions overflow, or the caller asked to stop.
pub fn drop_trajectory(
    time: &[f64],
    model: &DropModel,
    interrupted: Interrupted<'_>,
) -> Result<Vec<f64>> {
    check_time("time", time)?;
    finite("friction", model.friction)?;
    let path = trajectory_until(time, &model.checked_for(time)?, interrupted)?;
    let Some(place) = path.iter().position(|height| !height.is_finite()) else {
        return Ok(path);
    };
    let rule = format!("give finite positions, also at {:?} s", time[place]);
    let failure = Failure::invalid("model", rule, Given::Number(path[place]));
    Err(failure.mended_by(
        "mass, stiffness, damping_ratio, friction or height is too large or too small by orders of \
         magnitude: they are in kg, N/m, 1, N and m",
    ))
}

/// Drop trajectory without checks, for the fit.
///
/// # Errors
/// The caller asked to stop.
pub(super) fn trajectory_until(
    time: &[f64],
    model: &DropModel,
    interrupted: Interrupted<'_>,
) -> Result<Vec<f64>> {
    let end = time[time.len() - 1] - time[0];
    let mut state = DropState {
        time: 0.0,
        position: model.height,
        velocity: 0.0,
        surface: None,
    };
    let mut flying = true;
    let mut result = Vec::with_capacity(time.len());
    for stretch in 0.. {
        if result.len() == time.len() {
            break;
        }
        let (motion, duration, next_flying) = if stretch > MOST_STRETCHES {
            let position = state.position;
            (DropMotion::Rest { position }, f64::INFINITY, flying)
        } else if flying {
            flight(model, &state, end, interrupted)?
        } else {
            contact(model, &state, end, interrupted)?
        };
        if stretch % CHECK == 0 && interrupted() {
            return Err(Failure::Interrupted);
        }
        let until = state.time + duration;
        while result.len() < time.len() && (time[result.len()] - time[0] <= until || until >= end) {
            let at = time[result.len()] - time[0] - state.time;
            result.push(motion.at(at).0);
            if result.len().is_multiple_of(CHECK) && interrupted() {
                return Err(Failure::Interrupted);
            }
        }
        let (position, velocity) = motion.at(duration);
        state.advance(
            model,
            motion,
            until,
            [position, velocity],
            [flying, next_flying],
        );
        flying = next_flying;
    }
    Ok(result)
}

#[cfg(test)]
mod tests;
