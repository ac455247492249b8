//! One wheel with its motor, encoder and controller.

use std::f64::consts::TAU;

use super::controller::WheelController;
use super::dynamics::WheelDynamics;
use super::reference::WheelWish;
use numeric::error::{Result, positive};

/// Share of a limit below which rounding cannot reach it.
const CLEAR: f64 = 1.0 - 1e-9;

/// From here on every number is whole, 2^52.
const ALL_WHOLE: f64 = 4_503_599_627_370_496.0;

/// Motor with its current amplifier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Current for a unit of command `K_amp`, in A/V.
    pub amplifier_gain: f64,
    /// Winding resistance `R_a` in ohm.
    pub resistance: f64,
    /// Induced voltage for a unit of wheel speed, in V s/rad: torque constant times gear ratio.
    pub back_emf: f64,
    /// Largest current in A.
    pub current_limit: f64,
    /// Supply voltage in V.
    pub supply_voltage: f64,
}

impl Motor {
    fn checked(&self) -> Result<()> {
        positive("amplifier_gain", self.amplifier_gain)?;
        positive("winding_resistance", self.resistance)?;
        positive("back_emf", self.back_emf)?;
        positive("current_limit", self.current_limit)?;
        positive("supply_voltage", self.supply_voltage)?;
        Ok(())
    }

    /// Current in A that a wanted current becomes at a wheel speed: what the supply can drive
    /// against the induced voltage, `|R i + k_e theta'| <= U`, within the limit of the amplifier.
    /// The winding's inductance is neglected.
    #[inline]
    #[must_use]
    pub fn limited(&self, current: f64, speed: f64) -> f64 {
        let induced = self.back_emf * speed;
        // Clear of both limits by more than rounding: no need to divide.
        let needed = (self.resistance * current).abs() + induced.abs();
        if needed < CLEAR * self.supply_voltage && current.abs() <= self.current_limit {
            return current;
        }
        self.limited_near(current, induced)
    }

    /// Limits a current like `limited` by both limits, for an induced voltage in V.
    #[cold]
    #[inline(never)]
    fn limited_near(&self, current: f64, induced: f64) -> f64 {
        let most = (self.supply_voltage - induced) / self.resistance;
        let least = (-self.supply_voltage - induced) / self.resistance;
        let driven = between(current, least, most);
        between(driven, -self.current_limit, self.current_limit)
    }

    /// Voltage at the motor in V.
    #[must_use]
    pub fn voltage(&self, current: f64, speed: f64) -> f64 {
        self.resistance * current + self.back_emf * speed
    }
}

/// The value, or the bound that it passes; what is not a number stays so.
fn between(value: f64, least: f64, most: f64) -> f64 {
    if value > most {
        most
    } else if value < least {
        least
    } else {
        value
    }
}

/// Incremental encoder on the motor shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// Counts per turn of the motor.
    pub counts: f64,
    /// Turns of the motor per turn of the wheel.
    pub gear_ratio: f64,
}

impl Encoder {
    fn checked(&self) -> Result<()> {
        positive("encoder_counts", self.counts)?;
        positive("gear_ratio", self.gear_ratio)?;
        Ok(())
    }

    /// Angle of the wheel for one count, in rad.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        TAU / (self.counts * self.gear_ratio)
    }

    /// Angle that is read, in rad: the nearest whole count.
    #[must_use]
    pub fn read(&self, angle: f64) -> f64 {
        read_with(Some(self.resolution()), angle)
    }
}

/// An angle as it is read: the nearest multiple of a resolution, or the angle itself without one, all in rad.
#[inline]
pub(super) fn read_with(resolution: Option<f64>, angle: f64) -> f64 {
    resolution.map_or(angle, |count| rounded(angle / count) * count)
}

/// Rounds like `f64::round`, which without SSE 4.1 is a call; the sign of zero included.
#[inline]
fn rounded(value: f64) -> f64 {
    if value.abs() >= ALL_WHOLE || value.is_nan() {
        return value;
    }
    #[allow(clippy::cast_possible_truncation)] // below 2^52
    let whole = value as i64 as f64;
    let rest = value - whole;
    let away = if rest.abs() >= 0.5 { 1.0_f64 } else { 0.0 };
    (whole.abs() + away).copysign(value)
}

/// One wheel with its loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelDrive {
    /// Motion of the wheel as it is.
    pub dynamics: WheelDynamics,
    /// Motor and amplifier.
    pub motor: Motor,
    /// Encoder; `None` reads the angle exactly.
    pub encoder: Option<Encoder>,
    /// Controller, with the motion that it assumes.
    pub controller: WheelController,
    /// Control period of the wheel in s.
    pub period: f64,
}

impl WheelDrive {
    /// Returns the drive if its values are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        self.dynamics.checked()?;
        self.motor.checked()?;
        if let Some(encoder) = &self.encoder {
            encoder.checked()?;
        }
        self.controller.checked()?;
        positive("period", self.period)?;
        Ok(self)
    }

    /// Angle that the encoder reads, in rad.
    #[must_use]
    pub fn read(&self, angle: f64) -> f64 {
        self.encoder.map_or(angle, |encoder| encoder.read(angle))
    }

    /// Loss in the winding over one period of a perfect follower, in J: `R_a i^2 T` with (D.3.2).
    #[must_use]
    pub fn ideal_energy(&self, wish: &WheelWish) -> f64 {
        let current = self.controller.model.ideal_current(wish);
        self.motor.resistance * current * current * self.period
    }
}

#[cfg(test)]
mod tests {
    use super::super::presets::holonomic_wheels;
    use super::*;

    #[test]
    fn a_turn_has_twenty_thousand_counts() {
        let encoder = holonomic_wheels()[0].encoder.unwrap();
        assert!((encoder.resolution() - 3.141_592_653_589_793e-4).abs() < 1e-18);
        assert!((encoder.read(1.0) - 1.0).abs() <= 0.5 * encoder.resolution());
        assert_eq!(encoder.read(0.4 * encoder.resolution()), 0.0);
    }

    #[test]
    fn supply_and_amplifier_limit_the_current() {
        let motor = holonomic_wheels()[0].motor;
        assert_eq!(motor.limited(2.0, 0.0), 2.0);
        assert_eq!(motor.limited(200.0, 0.0), motor.current_limit);
        let fast = 0.95 * motor.supply_voltage / motor.back_emf;
        let most = motor.limited(200.0, fast);
        assert!((motor.voltage(most, fast) - motor.supply_voltage).abs() < 1e-12);
        assert_eq!(motor.limited(-200.0, fast), -motor.current_limit);
        assert!(motor.limited(f64::NAN, 0.0).is_nan());
    }

    #[test]
    fn a_clear_current_is_what_the_limits_leave_of_it() {
        let motor = holonomic_wheels()[0].motor;
        let fastest = motor.supply_voltage / motor.back_emf;
        for step in -1200..=1200 {
            let speed = fastest * f64::from(step) / 1000.0;
            let edge = (motor.supply_voltage - motor.back_emf * speed) / motor.resistance;
            for current in [
                edge,
                edge.next_up(),
                edge.next_down(),
                -edge,
                0.4 * edge,
                0.0,
                3.0,
            ] {
                let limited = motor.limited(current, speed);
                let by_limits = motor.limited_near(current, motor.back_emf * speed);
                assert_eq!(limited.to_bits(), by_limits.to_bits());
            }
        }
    }

    #[test]
    fn whole_numbers_are_those_of_the_library() {
        let halves = (-4000..4000).map(|step| 0.25 * f64::from(step));
        let large = [
            4e15,
            4.5e15,
            4.6e15,
            1e300,
            0.499_999_999_999_999_94,
            1e-320,
        ];
        for value in halves.chain(large).chain(large.map(|value| -value)) {
            for value in [value, value.next_up(), value.next_down(), f64::INFINITY] {
                assert_eq!(rounded(value).to_bits(), value.round().to_bits(), "{value}");
            }
        }
        assert!(rounded(f64::NAN).is_nan());
    }

    #[test]
    fn values_out_of_range_are_named() {
        let good = holonomic_wheels()[0];
        let mut drive = good;
        drive.motor.resistance = 0.0;
        assert!(drive.checked().is_err());
        drive = good;
        drive.period = f64::NAN;
        assert!(drive.checked().is_err());
        drive = good;
        drive.encoder = Some(Encoder {
            counts: 2000.0,
            gear_ratio: -1.0,
        });
        assert!(drive.checked().is_err());
        assert!(good.checked().is_ok());
    }
}
