//! Impact of a direct-drive joint with its controller, dry friction and limited command.
//!
//! The linear manipulator of the impact model is what a direct-drive joint would be with an amplifier
//! without limit (zeng2011, A.2.16 to A.2.20). Here the controller may ask for what it likes; the
//! motor gets what the limit lets through, and dry friction acts against the motion while the
//! controller compensates it along the desired motion.

mod modes;
#[cfg(test)]
mod tests;

use crate::error::{Failure, Given, Result, finite, not_negative, positive};
use crate::parameters::{Foam, Head, Manipulator};
use modes::{Machine, Quantities};
use numeric::threads::Interrupted;

/// Most stored samples of one run.
const MOST_SAMPLES: f64 = 1e7;
/// Part of the fastest time constant that one internal step may last.
const FINENESS: f64 = 0.01;
/// Internal steps between two looks whether to stop.
const CHECK: usize = 4096;

/// Direct-drive joint under proportional-derivative control with feed-forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectDrive {
    /// Moment of inertia of the arm `m_dd`, in kg m^2.
    pub inertia: f64,
    /// Distance from the axis to the impact point `l_1`, in m.
    pub lever_arm: f64,
    /// Torque constant `K_t`, in N m/A.
    pub torque_constant: f64,
    /// Amplifier gain `K_amp`, in A/V.
    pub amplifier_gain: f64,
    /// Viscous friction `B`, in N m s/rad.
    pub viscous_friction: f64,
    /// Dry friction `tau_st`, in N m.
    pub static_friction: f64,
    /// Largest command, in V; infinite for none.
    pub voltage_limit: f64,
    /// Command per angle `K_p`, in V/rad.
    pub proportional: f64,
    /// Command per angular velocity `K_d`, in V s/rad.
    pub derivative: f64,
}

impl DirectDrive {
    /// Returns the joint if its values are valid.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        positive("inertia", self.inertia)?;
        positive("lever_arm", self.lever_arm)?;
        positive("torque_constant", self.torque_constant)?;
        positive("amplifier_gain", self.amplifier_gain)?;
        not_negative("viscous_friction", self.viscous_friction)?;
        not_negative("static_friction", self.static_friction)?;
        not_negative("proportional", self.proportional)?;
        not_negative("derivative", self.derivative)?;
        if self.voltage_limit > 0.0 {
            Ok(self)
        } else {
            Err(Failure::invalid(
                "voltage_limit",
                "be positive",
                Given::Number(self.voltage_limit),
            ))
        }
    }

    /// Force at the impact point per volt, in N/V.
    #[must_use]
    pub fn force_per_volt(&self) -> f64 {
        self.torque_constant * self.amplifier_gain / self.lever_arm
    }

    /// The joint without dry friction and limit: `M_r = m / l^2`,
    /// `C_r = (K_t K_amp K_d + B) / l^2`, `K_r = K_t K_amp K_p / l^2`.
    #[must_use]
    pub fn linear(&self) -> Manipulator {
        let squared_arm = self.lever_arm * self.lever_arm;
        let torque_per_volt = self.torque_constant * self.amplifier_gain;
        Manipulator {
            mass: self.inertia / squared_arm,
            damping: (torque_per_volt * self.derivative + self.viscous_friction) / squared_arm,
            stiffness: torque_per_volt * self.proportional / squared_arm,
        }
    }
}

/// Impact of joint and head, and its record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveImpact {
    /// Closing speed `v_c`, in m/s.
    pub closing_speed: f64,
    /// Speed of the manipulator `v_r`, in m/s; the torso moves at `v_r - v_c`.
    pub manipulator_speed: f64,
    /// Length of the record, in s.
    pub duration: f64,
    /// Time between samples, in s.
    pub step: f64,
}

/// Record of an impact. Positions are measured from the manipulator's place at first contact, the head
/// stands at the foam's thickness then.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DriveRun {
    /// Times, in s.
    pub time: Vec<f64>,
    /// Position of the impact point, in m.
    pub manipulator_position: Vec<f64>,
    /// Velocity of the impact point, in m/s.
    pub manipulator_velocity: Vec<f64>,
    /// Position of the head, in m.
    pub head_position: Vec<f64>,
    /// Velocity of the head, in m/s.
    pub head_velocity: Vec<f64>,
    /// Acceleration of the head, in m/s^2.
    pub head_acceleration: Vec<f64>,
    /// Contact force, in N.
    pub contact_force: Vec<f64>,
    /// Compression of the foam, in m; negative where there is a gap.
    pub compression: Vec<f64>,
    /// Command after the limit, in V.
    pub command: Vec<f64>,
    /// Command that the controller asks for, in V.
    pub requested_command: Vec<f64>,
    /// Largest head acceleration of the impact period, in m/s^2.
    pub peak_head_acceleration: f64,
    /// Largest contact force of the impact period, in N.
    pub peak_contact_force: f64,
    /// Largest compression of the impact period, in m.
    pub max_compression: f64,
    /// Impact period, until the head acceleration is zero, in s; infinite if the record ends before.
    pub impact_duration: f64,
    /// First time at which the command is at its limit, in s.
    pub saturated_from: Option<f64>,
    /// Duration of the command at its limit, in s.
    pub saturated_time: f64,
}

/// Simulates an impact from the first contact on.
///
/// Fourth-order Runge-Kutta steps between events; contact, release, both limits of the command,
/// turns and sticking of the joint are located and change the equations exactly there.
///
/// # Errors
/// A parameter out of range, a closing speed that is not positive, a record of more than 1e7 samples, or the caller asked to stop.
pub fn simulate_direct_drive(
    drive: &DirectDrive,
    foam: &Foam,
    head: &Head,
    impact: &DriveImpact,
    interrupted: Interrupted<'_>,
) -> Result<DriveRun> {
    drive.checked().map_err(|error| error.within("drive"))?;
    foam.checked().map_err(|error| error.within("foam"))?;
    head.checked().map_err(|error| error.within("head"))?;
    positive("closing_speed", impact.closing_speed)?;
    finite("manipulator_speed", impact.manipulator_speed)?;
    positive("duration", impact.duration)?;
    positive("step", impact.step)?;
    let samples = (impact.duration / impact.step * (1.0 + 1e-12)).floor() + 1.0;
    if samples > MOST_SAMPLES {
        return Err(Failure::invalid(
            "step",
            "leave at most 1e7 samples",
            Given::Number(impact.step),
        ));
    }
    let mut machine = Machine::new(drive, foam, head, impact);
    let parts = (impact.step * machine.fastest_rate() / FINENESS)
        .ceil()
        .max(1.0);
    if parts * samples > 10.0 * MOST_SAMPLES {
        return Err(Failure::invalid(
            "duration",
            "leave at most 1e8 internal steps for so stiff a system",
            Given::Number(impact.duration),
        ));
    }
    let mut run = DriveRun {
        impact_duration: f64::INFINITY,
        ..DriveRun::default()
    };
    let mut peaks = SampledPeaks::default();
    run.record(0.0, &machine.quantities());
    peaks.see(&machine.quantities());
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let (samples, parts) = (samples as usize, parts as usize);
    let mut steps = 0_usize;
    for sample in 1..samples {
        for part in 1..=parts {
            let share = (sample - 1) as f64 + part as f64 / parts as f64;
            machine.advance(impact.step * share);
            steps += 1;
            if steps.is_multiple_of(CHECK) && interrupted() {
                return Err(Failure::Interrupted);
            }
            if machine.impact_end().is_none() {
                peaks.see(&machine.quantities());
            }
        }
        run.record(impact.step * sample as f64, &machine.quantities());
    }
    run.peak_head_acceleration = peaks.head_acceleration.largest();
    run.peak_contact_force = peaks.contact_force.largest();
    run.max_compression = peaks.compression.largest();
    run.impact_duration = machine.impact_end().unwrap_or(f64::INFINITY);
    run.saturated_from = machine.saturated_from();
    run.saturated_time = machine.saturated_time();
    Ok(run)
}

impl DriveRun {
    fn record(&mut self, time: f64, now: &Quantities) {
        self.time.push(time);
        self.manipulator_position.push(now.manipulator[0]);
        self.manipulator_velocity.push(now.manipulator[1]);
        self.head_position.push(now.head[0]);
        self.head_velocity.push(now.head[1]);
        self.head_acceleration.push(now.head_acceleration);
        self.contact_force.push(now.contact_force);
        self.compression.push(now.compression);
        self.command.push(now.command);
        self.requested_command.push(now.requested_command);
    }
}

/// Largest values of the impact period.
#[derive(Default)]
struct SampledPeaks {
    head_acceleration: SampledPeak,
    contact_force: SampledPeak,
    compression: SampledPeak,
}

impl SampledPeaks {
    fn see(&mut self, now: &Quantities) {
        self.head_acceleration.see(now.head_acceleration);
        self.contact_force.see(now.contact_force);
        self.compression.see(now.compression);
    }
}

/// Largest of equally spaced values, with a parabola through the largest and its neighbors.
#[derive(Default)]
struct SampledPeak {
    last: [f64; 2],
    seen: usize,
    largest: f64,
}

impl SampledPeak {
    fn see(&mut self, value: f64) {
        let [before, middle] = self.last;
        self.largest = self.largest.max(value);
        if self.seen >= 2 && middle >= before && middle > value {
            let (rise, bend) = (value - before, before - 2.0 * middle + value);
            self.largest = self.largest.max(middle - rise * rise / (8.0 * bend));
        }
        self.last = [middle, value];
        self.seen += 1;
    }

    fn largest(&self) -> f64 {
        self.largest
    }
}
