//! One wheel under its controller.

use super::controller::{MeasuredWheel, WheelEstimator};
use super::drive::{WheelDrive, read_with};
use super::dynamics::{HeldStep, WheelState};
use super::reference::WheelWish;

/// Sample of one wheel period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSample {
    /// Angle at the end of the period, in rad.
    pub angle: f64,
    /// Speed at the end of the period, in rad/s.
    pub speed: f64,
    /// Motor current over the period, in A.
    pub current: f64,
    /// Motor voltage at the start of the period, in V.
    pub voltage: f64,
    /// Loss in the winding over the period `R_a i^2 T`, in J.
    pub energy: f64,
    /// Angle that the encoder gave at the start of the period, in rad.
    pub read_angle: f64,
    /// Angle that the controller took at the start of the period, in rad.
    pub known_angle: f64,
    /// Speed that the controller took at the start of the period, in rad/s.
    pub known_speed: f64,
}

/// A wheel with the state of its controller.
#[derive(Clone, Copy, Debug)]
pub struct WheelLoop {
    drive: WheelDrive,
    step: HeldStep,
    state: WheelState,
    estimator: WheelEstimator,
    /// Angle of a count of the encoder in rad, if it has one.
    resolution: Option<f64>,
}

impl WheelLoop {
    /// A wheel at rest at angle 0, its controller knowing that. The drive is expected to be checked.
    #[must_use]
    pub fn new(drive: &WheelDrive) -> Self {
        Self::starting_at(drive, WheelState::default())
    }

    /// A wheel in a state that its controller knows but for the encoder's resolution.
    #[must_use]
    pub fn starting_at(drive: &WheelDrive, state: WheelState) -> Self {
        let known = MeasuredWheel {
            angle: drive.read(state.angle),
            speed: state.speed,
        };
        Self {
            drive: *drive,
            step: HeldStep::new(&drive.dynamics, drive.period),
            state,
            estimator: WheelEstimator::new(&drive.controller, drive.period, known),
            resolution: drive.encoder.map(|encoder| encoder.resolution()),
        }
    }

    /// Angle and speed as they are.
    #[must_use]
    pub fn state(&self) -> WheelState {
        self.state
    }

    /// One wheel control period: reads the encoder, forms the command for the wish of this moment
    /// and holds its current for the period. In place, since a robot throws most of the sample away.
    #[inline(always)]
    pub fn step(&mut self, wish: &WheelWish) -> WheelSample {
        let drive = &self.drive;
        let read_angle = read_with(self.resolution, self.state.angle);
        let known = self.estimator.known(read_angle);
        let gain = drive.motor.amplifier_gain;
        let command = drive.controller.command(wish, &known, gain);
        let current = drive.motor.limited(gain * command, self.state.speed);
        let voltage = drive.motor.voltage(current, self.state.speed);
        let overcome = drive.controller.model.compensation(wish.speed);
        self.estimator.pass(read_angle, current - overcome);
        self.state = self.step.advance(self.state, current);
        WheelSample {
            angle: self.state.angle,
            speed: self.state.speed,
            current,
            voltage,
            energy: drive.motor.resistance * current * current * drive.period,
            read_angle,
            known_angle: known.angle,
            known_speed: known.speed,
        }
    }
}
