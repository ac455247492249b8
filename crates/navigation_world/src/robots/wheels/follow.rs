//! One wheel after a wanted motion.

use super::control_loop::WheelLoop;
use super::drive::WheelDrive;
use super::dynamics::WheelState;
use super::reference::WheelWish;
use numeric::error::{Failure, Result};

/// Periods between two looks at whether to stop.
pub(super) const LOOK: usize = 1 << 14;

/// History of a wheel, one value for each command; states are those at the command, currents and voltages those
/// of the period after it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WheelHistory {
    /// Angle in rad.
    pub angle: Vec<f64>,
    /// Speed in rad/s.
    pub speed: Vec<f64>,
    /// Angle that the encoder gave, in rad.
    pub read_angle: Vec<f64>,
    /// Angle that the controller took, in rad.
    pub known_angle: Vec<f64>,
    /// Speed that the controller took, in rad/s.
    pub known_speed: Vec<f64>,
    /// Motor current in A.
    pub current: Vec<f64>,
    /// Motor voltage at the start of the period, in V.
    pub voltage: Vec<f64>,
    /// Current of a perfect follower (D.3.2), in A.
    pub ideal_current: Vec<f64>,
    /// Loss in the winding `R_a sum i^2 T`, in J.
    pub energy: f64,
    /// Energy of a perfect follower, in J.
    pub ideal_energy: f64,
}

impl WheelHistory {
    fn with_capacity(count: usize) -> Self {
        let column = || Vec::with_capacity(count);
        Self {
            angle: column(),
            speed: column(),
            read_angle: column(),
            known_angle: column(),
            known_speed: column(),
            current: column(),
            voltage: column(),
            ideal_current: column(),
            energy: 0.0,
            ideal_energy: 0.0,
        }
    }
}

/// Lets a wheel follow one wish per wheel period.
///
/// # Errors
/// `Interrupted` once the caller asks to stop; `NonFinite` if the wheel is driven beyond all bounds.
pub fn follow(
    drive: &WheelDrive,
    start: WheelState,
    wishes: impl ExactSizeIterator<Item = WheelWish>,
    interrupted: &dyn Fn() -> bool,
) -> Result<WheelHistory> {
    let mut wheel = WheelLoop::starting_at(drive, start);
    let mut history = WheelHistory::with_capacity(wishes.len());
    for (index, wish) in wishes.enumerate() {
        if index % LOOK == 0 && interrupted() {
            return Err(Failure::Interrupted);
        }
        let WheelState { angle, speed } = wheel.state();
        let sample = wheel.step(&wish);
        if !(sample.angle.is_finite() && sample.speed.is_finite()) {
            let time = index as f64 * drive.period;
            return Err(Failure::non_finite(0, time));
        }
        history.angle.push(angle);
        history.speed.push(speed);
        history.read_angle.push(sample.read_angle);
        history.known_angle.push(sample.known_angle);
        history.known_speed.push(sample.known_speed);
        history.current.push(sample.current);
        history.voltage.push(sample.voltage);
        let ideal = drive.controller.model.ideal_current(&wish);
        history.ideal_current.push(ideal);
        history.energy += sample.energy;
        history.ideal_energy += drive.ideal_energy(&wish);
    }
    Ok(history)
}
