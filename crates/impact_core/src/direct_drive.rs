//! Impact of a direct-drive joint with its controller, dry friction and limited command.
//!
//! The linear manipulator of the impact model is what a direct-drive joint would be with an amplifier
//! without limit (zeng2011, A.2.16 to A.2.20). Here the controller may ask for what it likes; the
//! motor gets what the limit lets through, and dry friction acts against the motion while the
//! controller compensates it along the desired motion.

mod modes;

use crate::error::{Given, ImpactError, Result, finite, not_negative, positive};
use crate::parameters::{Foam, Head, Manipulator};
use modes::{Machine, Quantities};

/// Most stored samples of one run.
const MOST_SAMPLES: f64 = 1e7;
/// Part of the fastest time constant that one internal step may last.
const FINENESS: f64 = 0.01;

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
    /// Passes a joint that can be.
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
            Err(ImpactError::invalid(
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

    /// The same joint without dry friction and limit: `M_r = m / l^2`,
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

/// How joint and head meet, and how it is recorded.
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
    /// How long the command is at its limit, in s.
    pub saturated_time: f64,
}

/// Simulates an impact from the first contact on.
///
/// Fourth-order Runge-Kutta steps between events; contact, release, both limits of the command,
/// turns and sticking of the joint are located and change the equations exactly there.
///
/// # Errors
/// A parameter out of range, a closing speed that is not positive, a record of more than 1e7 samples.
pub fn simulate_direct_drive(
    drive: &DirectDrive,
    foam: &Foam,
    head: &Head,
    impact: &DriveImpact,
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
        return Err(ImpactError::invalid(
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
        return Err(ImpactError::invalid(
            "duration",
            "leave at most 1e8 internal steps for so stiff a system",
            Given::Number(impact.duration),
        ));
    }
    let mut run = DriveRun {
        impact_duration: f64::INFINITY,
        ..DriveRun::default()
    };
    let mut peaks = Peaks::default();
    run.record(0.0, &machine.quantities());
    peaks.see(&machine.quantities());
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let (samples, parts) = (samples as usize, parts as usize);
    for sample in 1..samples {
        for part in 1..=parts {
            let share = (sample - 1) as f64 + part as f64 / parts as f64;
            machine.advance(impact.step * share);
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
struct Peaks {
    head_acceleration: Peak,
    contact_force: Peak,
    compression: Peak,
}

impl Peaks {
    fn see(&mut self, now: &Quantities) {
        self.head_acceleration.see(now.head_acceleration);
        self.contact_force.see(now.contact_force);
        self.compression.see(now.compression);
    }
}

/// Largest of equally spaced values, with a parabola through the largest and its neighbors.
#[derive(Default)]
struct Peak {
    last: [f64; 2],
    seen: usize,
    largest: f64,
}

impl Peak {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{FOAM_1, HEAD_APPARATUS};

    /// Fourth-order steps of 0.01 time constants over one impact.
    const STEPS: f64 = 1e-10;

    /// The joint whose linear form is the nominal manipulator: 9.6 kg, 250 N s/m, 20 kN/m.
    fn nominal() -> DirectDrive {
        let (lever_arm, torque_constant, viscous_friction) = (0.078, 0.27121, 0.007_994_5);
        let squared_arm: f64 = lever_arm * lever_arm;
        DirectDrive {
            inertia: 9.6 * squared_arm,
            lever_arm,
            torque_constant,
            amplifier_gain: 1.0,
            viscous_friction,
            static_friction: 0.061,
            voltage_limit: 5.0,
            proportional: 20e3 * squared_arm / torque_constant,
            derivative: (250.0 * squared_arm - viscous_friction) / torque_constant,
        }
    }

    fn foam() -> Foam {
        Foam {
            stiffness: 24.25e3,
            ..FOAM_1
        }
    }

    fn impact(manipulator_speed: f64) -> DriveImpact {
        DriveImpact {
            closing_speed: 1.25,
            manipulator_speed,
            duration: 0.06,
            step: 1e-4,
        }
    }

    fn run(drive: DirectDrive, manipulator_speed: f64) -> DriveRun {
        simulate_direct_drive(&drive, &foam(), &HEAD_APPARATUS, &impact(manipulator_speed)).unwrap()
    }

    fn unlimited() -> DirectDrive {
        DirectDrive {
            voltage_limit: f64::INFINITY,
            ..nominal()
        }
    }

    #[test]
    fn without_limit_the_joint_is_the_linear_manipulator() {
        let linear = nominal().linear();
        assert!((linear.mass - 9.6).abs() < 1e-12 && (linear.damping - 250.0).abs() < 1e-10);
        assert!((linear.stiffness - 20e3).abs() < 1e-8);
        // Dry friction is compensated while the joint moves as desired.
        let free = DirectDrive {
            static_friction: 0.0,
            ..unlimited()
        };
        for drive in [unlimited(), free] {
            let run = run(drive, 1.25);
            let last = [
                run.manipulator_position[600],
                run.manipulator_velocity[600],
                run.head_position[600] - foam().thickness,
                run.head_velocity[600],
            ];
            let expected = [
                0.064_148_060_444_069_1,
                1.345_018_422_810_622_8,
                0.058_218_591_148_986_36,
                0.867_762_393_947_603_6,
            ];
            for (found, expected) in last.iter().zip(expected) {
                assert!((found - expected).abs() < STEPS, "{found} {expected}");
            }
            assert!((run.peak_head_acceleration / 9.80665 - 6.567_85).abs() < 5e-6);
            assert!((run.peak_contact_force - 299.120_823).abs() < 5e-7 + 1e-4);
            assert!((run.max_compression - 0.011_975).abs() < 5e-7);
            assert_eq!((run.saturated_from, run.saturated_time), (None, 0.0));
        }
    }

    #[test]
    fn the_linear_joint_would_ask_256_5_newtons() {
        let run = run(unlimited(), 1.25);
        let end = run.impact_duration;
        let near = run.time.iter().position(|time| *time >= end).unwrap();
        let share = (end - run.time[near - 1]) / 1e-4;
        let asked = |k: usize| {
            20e3 * (1.25 * run.time[k] - run.manipulator_position[k])
                + 250.0 * (1.25 - run.manipulator_velocity[k])
        };
        let asked = asked(near - 1) + share * (asked(near) - asked(near - 1));
        assert!((asked - 256.5).abs() < 0.05, "{asked} at {end}");
        let printed = DirectDrive {
            torque_constant: 0.2807,
            ..nominal()
        };
        assert!((5.0 * printed.force_per_volt() - 18.0).abs() < 0.05);
        assert!((5.0 * nominal().force_per_volt() - 17.4).abs() < 0.05);
    }

    #[test]
    fn the_real_joint_saturates_and_hits_softer() {
        let (limited, linear) = (run(nominal(), 1.25), run(unlimited(), 1.25));
        let from = limited.saturated_from.unwrap();
        assert!(from > 0.0 && from < 0.01, "{from}");
        assert!(limited.command.iter().all(|command| command.abs() <= 5.0));
        assert!(
            limited
                .requested_command
                .iter()
                .any(|command| *command > 5.0)
        );
        assert!(limited.peak_head_acceleration < linear.peak_head_acceleration);
        assert!(limited.saturated_time > 0.02);
        // The share of the difference stays small: inertia does the work.
        assert!(limited.peak_head_acceleration > 0.9 * linear.peak_head_acceleration);
    }

    #[test]
    fn momentum_accounts_for_every_force() {
        for speed in [1.25, 0.25, 0.0] {
            let drive = nominal();
            let fine = DriveImpact {
                step: 1e-6,
                ..impact(speed)
            };
            let run = simulate_direct_drive(&drive, &foam(), &HEAD_APPARATUS, &fine).unwrap();
            let mut impulse = 0.0;
            for k in 1..run.time.len() {
                for k in [k - 1, k] {
                    let moving = run.manipulator_velocity[k];
                    let pull = drive.force_per_volt() * run.command[k]
                        - drive.viscous_friction / 0.078_f64.powi(2) * moving
                        - run.contact_force[k];
                    // A joint at rest is held by whatever friction it takes.
                    let dry = 0.061 / 0.078_f64;
                    let friction = if moving == 0.0 {
                        pull.clamp(-dry, dry)
                    } else {
                        dry * moving.signum()
                    };
                    impulse += 0.5e-6 * (pull - friction);
                }
            }
            let gained = 9.6 * (run.manipulator_velocity[run.time.len() - 1] - speed);
            // Trapezoid sums across the jumps of dry friction, 1 us wide.
            assert!(
                (impulse - gained).abs() < 1e-5,
                "{speed} {impulse} {gained}"
            );
        }
    }

    #[test]
    fn events_leave_the_order_of_the_steps_as_it_is() {
        let at = |step: f64| {
            let impact = DriveImpact {
                step,
                ..impact(0.25)
            };
            let stiff = Foam {
                stiffness: 60.6e3,
                ..foam()
            };
            let run = simulate_direct_drive(&nominal(), &stiff, &HEAD_APPARATUS, &impact).unwrap();
            let last = run.time.len() - 1;
            (run.manipulator_position[last], run.head_velocity[last])
        };
        let (coarse, fine) = (at(1e-3), at(1e-5));
        assert!((coarse.0 - fine.0).abs() < 1e-9, "{coarse:?} {fine:?}");
        assert!((coarse.1 - fine.1).abs() < 1e-7, "{coarse:?} {fine:?}");
    }

    #[test]
    fn foam_never_pulls_and_lets_go() {
        let stiff = Foam {
            stiffness: 60.6e3,
            damping: 113.6,
            ..foam()
        };
        let run = simulate_direct_drive(
            &unlimited(),
            &stiff,
            &Head {
                mass: 4.4,
                damping: 46.0,
                stiffness: 3e3,
            },
            &impact(1.25),
        )
        .unwrap();
        assert!(run.contact_force.iter().all(|force| *force >= 0.0));
        // Release time of the specification's case.
        let released = run
            .contact_force
            .iter()
            .position(|force| *force == 0.0)
            .unwrap();
        assert!((run.time[released] - 0.024_928).abs() <= 1e-4);
    }

    #[test]
    fn a_resting_joint_sticks_until_it_is_pushed_hard_enough() {
        let weak = DirectDrive {
            proportional: 0.0,
            derivative: 0.0,
            static_friction: 1e3,
            ..nominal()
        };
        let run = run(weak, 0.0);
        assert!(
            run.manipulator_position
                .iter()
                .all(|position| *position == 0.0)
        );
    }

    #[test]
    fn bad_joints_are_named() {
        for drive in [
            DirectDrive {
                inertia: 0.0,
                ..nominal()
            },
            DirectDrive {
                voltage_limit: 0.0,
                ..nominal()
            },
            DirectDrive {
                voltage_limit: f64::NAN,
                ..nominal()
            },
        ] {
            let refused = simulate_direct_drive(&drive, &foam(), &HEAD_APPARATUS, &impact(1.25));
            assert!(refused.unwrap_err().to_string().starts_with("drive."));
        }
        let slow = DriveImpact {
            closing_speed: 0.0,
            ..impact(1.25)
        };
        assert!(simulate_direct_drive(&nominal(), &foam(), &HEAD_APPARATUS, &slow).is_err());
    }
}
