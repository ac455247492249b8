//! Direct-drive joint from open-loop tests, controller gains, inertia of its tube.

use super::check_samples;
use super::least_squares::{InitialGuess, minimize};
use super::line::{CONFIDENCE, fit_line, student_quantile};
use crate::error::{Failure, Given, Result, not_negative, positive};
use crate::signal::check_time;
use numeric::threads::Interrupted;

/// Response of the joint to a constant command, `theta'' = A - kappa theta'` from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenLoop {
    /// Initial acceleration `A`, in rad/s^2.
    pub acceleration: f64,
    /// Decay of the speed `kappa`, in 1/s.
    pub decay: f64,
    /// Covariance of both.
    pub covariance: [[f64; 2]; 2],
    /// 95 % intervals of both.
    pub interval: [[f64; 2]; 2],
    /// Standard deviation of the residuals, in rad.
    pub residual_deviation: f64,
}

/// Fits `theta = A (kappa t - 1 + exp(-kappa t)) / kappa^2` (zeng2011, A.2.12 with the letters in
/// their places) to an open-loop test that starts at rest at angle 0.
///
/// # Errors
/// Fewer than four samples, times that do not rise, unequal lengths, a joint that does not move, or the caller asked to stop.
pub fn fit_open_loop(
    time: &[f64],
    angle: &[f64],
    interrupted: Interrupted<'_>,
) -> Result<OpenLoop> {
    check_time("time", time)?;
    let like_time = "have as many values as time, at least 4";
    check_samples("angle", angle, time.len(), 4, like_time)?;
    let elapsed: Vec<f64> = time.iter().map(|now| now - time[0]).collect();
    let (mut product, mut square) = (0.0, 0.0);
    for (time, angle) in elapsed.iter().zip(angle) {
        product += 0.5 * time * time * angle;
        square += (0.5 * time * time).powi(2);
    }
    let moving = || {
        let largest = angle
            .iter()
            .fold(0.0_f64, |most, angle| most.max(angle.abs()));
        Failure::invalid("angle", "move away from 0", Given::Number(largest))
    };
    let acceleration = product / square;
    if acceleration == 0.0 {
        return Err(moving());
    }
    let start = InitialGuess {
        parameters: vec![acceleration, 0.0],
        scale: vec![acceleration.abs(), 1.0 / elapsed[elapsed.len() - 1]],
        lower: vec![f64::NEG_INFINITY; 2],
    };
    let found = minimize(&start, |parameters| {
        if interrupted() {
            return None;
        }
        let pairs = elapsed.iter().zip(angle);
        let left = |(time, angle): (&f64, &f64)| {
            angle - parameters[0] * time * time * lag(parameters[1] * time)
        };
        Some(pairs.map(left).collect())
    });
    if interrupted() {
        return Err(Failure::Interrupted);
    }
    let found = found.ok_or_else(moving)?;
    let degrees = elapsed.len() - 2;
    let squares: f64 = found.residuals.iter().map(|left| left * left).sum();
    let variance = squares / degrees as f64;
    let quantile = student_quantile(CONFIDENCE, degrees)?;
    let covariance = [0, 1].map(|row| [0, 1].map(|column| variance * found.inverse[(row, column)]));
    let interval = [0, 1].map(|k| {
        let half = quantile * covariance[k][k].sqrt();
        [found.parameters[k] - half, found.parameters[k] + half]
    });
    Ok(OpenLoop {
        acceleration: found.parameters[0],
        decay: found.parameters[1],
        covariance,
        interval,
        residual_deviation: variance.sqrt(),
    })
}

/// `(x - 1 + exp(-x)) / x^2`, by its series where the difference would cancel.
fn lag(x: f64) -> f64 {
    if x.abs() > 0.1 {
        return (x + (-x).exp_m1()) / (x * x);
    }
    let (mut term, mut sum) = (0.5, 0.0);
    for order in 3..14 {
        sum += term;
        term *= -x / f64::from(order);
    }
    sum
}

/// Dynamic model of the joint, `theta'' = Theta u - kappa theta' + Gamma sgn(theta')`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectDriveFit {
    /// Acceleration per command `Theta`, in rad/(s^2 V).
    pub command_gain: f64,
    /// Acceleration by dry friction `Gamma`, negative, in rad/s^2.
    pub friction_offset: f64,
    /// Mean decay `kappa`, in 1/s.
    pub decay: f64,
    /// Torque constant `K_t = Theta m / K_amp`, in N m/A.
    pub torque_constant: f64,
    /// Viscous friction `B = kappa m`, in N m s/rad.
    pub viscous_friction: f64,
    /// Dry friction `-Gamma m`, in N m.
    pub static_friction: f64,
    /// Covariance of `Theta` and `Gamma`.
    pub covariance: [[f64; 2]; 2],
    /// 95 % intervals of `Theta` and `Gamma`.
    pub interval: [[f64; 2]; 2],
    /// 95 % interval of the mean decay.
    pub decay_interval: [f64; 2],
}

/// Regression of the fitted accelerations on the commands (zeng2011, A.2.13 and A.2.14) and the mean
/// of the fitted decays.
///
/// # Errors
/// Fewer than three tests, unequal lengths, numbers that are not finite, commands that are all alike,
/// an inertia or a gain that is not positive.
pub fn identify_direct_drive(
    voltage: &[f64],
    acceleration: &[f64],
    decay: &[f64],
    inertia: f64,
    amplifier_gain: f64,
) -> Result<DirectDriveFit> {
    positive("inertia", inertia)?;
    positive("amplifier_gain", amplifier_gain)?;
    check_samples(
        "voltage",
        voltage,
        voltage.len(),
        3,
        "have at least 3 values",
    )?;
    let like_voltage = "have as many values as voltage";
    check_samples("acceleration", acceleration, voltage.len(), 3, like_voltage)?;
    check_samples("decay", decay, decay.len(), 2, "have at least 2 values")?;
    let line = fit_line("voltage", voltage, acceleration, true)?;
    let count = decay.len() as f64;
    let mean = decay.iter().sum::<f64>() / count;
    let squares: f64 = decay.iter().map(|value| (value - mean).powi(2)).sum();
    let quantile = student_quantile(CONFIDENCE, decay.len() - 1)?;
    let half = quantile * (squares / (count - 1.0) / count).sqrt();
    Ok(DirectDriveFit {
        command_gain: line.slope,
        friction_offset: line.intercept,
        decay: mean,
        torque_constant: line.slope * inertia / amplifier_gain,
        viscous_friction: mean * inertia,
        static_friction: -line.intercept * inertia,
        covariance: line.covariance,
        interval: [line.slope_interval, line.intercept_interval],
        decay_interval: [mean - half, mean + half],
    })
}

/// Constants between a command and its force at the impact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveConstants {
    /// Distance from the axis to the impact point `l_1`, in m.
    pub lever_arm: f64,
    /// Torque constant `K_t`, in N m/A.
    pub torque_constant: f64,
    /// Viscous friction `B`, in N m s/rad.
    pub viscous_friction: f64,
    /// Amplifier gain `K_amp`, in A/V.
    pub amplifier_gain: f64,
}

/// Gains of the joint's controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PdGains {
    /// Command per angle `K_p`, in V/rad.
    pub proportional: f64,
    /// Command per angular velocity `K_d`, in V s/rad.
    pub derivative: f64,
}

/// Gains that give the impact point a stiffness and a damping:
/// `K_p = K_r l^2 / (K_t K_amp)`, `K_d = (C_r l^2 - B) / (K_t K_amp)`.
///
/// The printed (A.2.21b) takes the friction of the joint from the damping of the impact point.
///
/// # Errors
/// A negative stiffness or damping, a constant out of range.
pub fn pd_gains(stiffness: f64, damping: f64, drive: &DriveConstants) -> Result<PdGains> {
    not_negative("stiffness", stiffness)?;
    not_negative("damping", damping)?;
    positive("lever_arm", drive.lever_arm)?;
    positive("torque_constant", drive.torque_constant)?;
    not_negative("viscous_friction", drive.viscous_friction)?;
    positive("amplifier_gain", drive.amplifier_gain)?;
    let torque_per_volt = drive.torque_constant * drive.amplifier_gain;
    let squared_arm = drive.lever_arm * drive.lever_arm;
    Ok(PdGains {
        proportional: stiffness * squared_arm / torque_per_volt,
        derivative: (damping * squared_arm - drive.viscous_friction) / torque_per_volt,
    })
}

/// A rectangular tube with open ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tube {
    /// Density, in kg/m^3.
    pub density: f64,
    /// Length, in m.
    pub length: f64,
    /// Outer width, across the axis of rotation, in m.
    pub width: f64,
    /// Outer height, along the axis of rotation, in m.
    pub height: f64,
    /// Thickness of the wall, in m.
    pub wall: f64,
}

/// Mass and inertia of a tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeInertia {
    /// Mass, in kg.
    pub mass: f64,
    /// Moment of inertia about the cross axis through the center, in kg m^2.
    pub inertia: f64,
}

/// Mass and inertia of a tube with open ends: a block less the block inside.
///
/// # Errors
/// A dimension that is not positive, walls that leave no room.
pub fn tube_inertia(tube: &Tube) -> Result<TubeInertia> {
    positive("density", tube.density)?;
    positive("length", tube.length)?;
    positive("width", tube.width)?;
    positive("height", tube.height)?;
    positive("wall", tube.wall)?;
    let (width, height) = (tube.width - 2.0 * tube.wall, tube.height - 2.0 * tube.wall);
    if width < 0.0 || height < 0.0 {
        return Err(Failure::invalid(
            "wall",
            "leave room inside the tube",
            Given::Number(tube.wall),
        ));
    }
    let block = |width: f64, height: f64| {
        let mass = tube.density * tube.length * width * height;
        (mass, mass * (tube.length.powi(2) + width * width) / 12.0)
    };
    let (outer, inner) = (block(tube.width, tube.height), block(width, height));
    Ok(TubeInertia {
        mass: outer.0 - inner.0,
        inertia: outer.1 - inner.1,
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Table A.1.
    const VOLTAGE: [f64; 5] = [0.3, 0.4, 0.6, 0.8, 1.0];
    const ACCELERATION: [f64; 5] = [0.497, 0.808, 1.504, 2.555, 3.723];
    const DECAY: [f64; 10] = [
        0.121, 0.161, 0.098, 0.110, 0.109, 0.113, 0.138, 0.138, 0.184, 0.183,
    ];

    fn constants(torque_constant: f64, viscous_friction: f64) -> DriveConstants {
        DriveConstants {
            lever_arm: 0.078,
            torque_constant,
            viscous_friction,
            amplifier_gain: 1.0,
        }
    }

    #[test]
    fn table_a_1_gives_its_regression() {
        let found = identify_direct_drive(&VOLTAGE, &ACCELERATION, &DECAY, 0.059, 1.0).unwrap();
        assert!((found.command_gain - 4.597).abs() < 5e-4, "{found:?}");
        assert!((found.friction_offset + 1.033).abs() < 5e-4, "{found:?}");
        assert!((found.decay - 0.1355).abs() < 1e-12, "{found:?}");
        assert!((found.torque_constant - 0.27121).abs() < 5e-6, "{found:?}");
        assert!(
            (found.viscous_friction - 0.007_994_5).abs() < 1e-9,
            "{found:?}"
        );
    }

    #[test]
    fn gains_are_those_of_both_torque_constants() {
        let printed = pd_gains(20e3, 250.0, &constants(0.2807, 0.0079)).unwrap();
        assert!((printed.proportional - 433.488).abs() < 5e-4, "{printed:?}");
        assert!((printed.derivative - 5.390_45).abs() < 5e-6, "{printed:?}");
        let right = pd_gains(20e3, 250.0, &constants(0.27121, 0.007_994_5)).unwrap();
        assert!((right.proportional - 448.7).abs() < 0.05, "{right:?}");
        assert!((right.derivative - 5.579).abs() < 5e-4, "{right:?}");
    }

    #[test]
    fn the_tube_needs_thinner_walls_and_open_ends() {
        let tube = Tube {
            density: 2700.0,
            length: 0.664,
            width: 0.0508,
            height: 0.0508,
            wall: 0.0254 / 16.0,
        };
        let found = tube_inertia(&tube).unwrap();
        assert!((found.inertia - 0.020_811).abs() < 5e-7, "{found:?}");
        assert!((found.mass - 0.560).abs() < 5e-4, "{found:?}");
        assert!(tube_inertia(&Tube { wall: 0.03, ..tube }).is_err());
    }

    #[test]
    fn open_loop_tests_are_fitted_whatever_the_decay() {
        let time: Vec<f64> = (0..800).map(|k| 2.0 + f64::from(k) * 1e-3).collect();
        for decay in [0.0, 0.0042, 0.1355, 3.0, 40.0] {
            let angle: Vec<f64> = time
                .iter()
                .map(|time| {
                    let elapsed = time - 2.0;
                    1.5 * elapsed * elapsed * lag(decay * elapsed)
                })
                .collect();
            let found = fit_open_loop(&time, &angle, &|| false).unwrap();
            for looks in 0..8 {
                let looked = AtomicUsize::new(0);
                let stopped = || looked.fetch_add(1, Ordering::Relaxed) >= looks;
                let stopped = fit_open_loop(&time, &angle, &stopped);
                assert!(matches!(stopped, Err(Failure::Interrupted)), "{looks}");
            }
            assert!((found.acceleration - 1.5).abs() < 1e-6, "{decay} {found:?}");
            assert!(
                (found.decay - decay).abs() < 1e-6 * (1.0 + decay),
                "{decay} {found:?}"
            );
        }
        assert!(fit_open_loop(&time, &vec![0.0; 800], &|| false).is_err());
    }

    #[test]
    fn the_lag_is_smooth_where_its_forms_meet() {
        for x in [0.1, -0.1] {
            let formula = (x + f64::exp_m1(-x)) / (x * x);
            assert!((lag(x) - formula).abs() < 1e-14);
        }
        assert_eq!(lag(0.0), 0.5);
    }

    #[test]
    fn bad_tests_are_named() {
        assert!(identify_direct_drive(&VOLTAGE, &ACCELERATION[..4], &DECAY, 0.059, 1.0).is_err());
        assert!(identify_direct_drive(&[1.0; 5], &ACCELERATION, &DECAY, 0.059, 1.0).is_err());
        assert!(identify_direct_drive(&VOLTAGE, &ACCELERATION, &DECAY, 0.0, 1.0).is_err());
        assert!(pd_gains(-1.0, 0.0, &constants(0.28, 0.0)).is_err());
        assert!(pd_gains(1.0, 0.0, &constants(0.0, 0.0)).is_err());
    }
}
