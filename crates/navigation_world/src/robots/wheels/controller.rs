//! Controller of one wheel: proportional-derivative feedback, feed-forward, friction compensation,
//! observer.

use super::dynamics::{Response, WheelDynamics};
use super::reference::WheelWish;
use numeric::error::{Failure, Given, Result, not_negative};

/// Where the controller takes angle and speed of the wheel from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feedback {
    /// Angle as read, speed from the difference of the last two readings.
    Differences,
    /// Both from a Luenberger observer (D.3.3).
    Observer {
        /// Poles of the observer in 1/s, negative.
        poles: [f64; 2],
    },
    /// Angle as read, speed from a Luenberger observer.
    ObservedSpeed {
        /// Poles of the observer in 1/s, negative.
        poles: [f64; 2],
    },
}

/// Controller of one wheel (D.3.1, E.3.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelController {
    /// Command per error of angle `K_P`, in V/rad.
    pub proportional: f64,
    /// Command per error of speed `K_D`, in V s/rad.
    pub derivative: f64,
    /// Motion that feed-forward and observer assume.
    pub model: WheelDynamics,
    /// Where angle and speed come from.
    pub feedback: Feedback,
}

impl WheelController {
    pub(super) fn checked(&self) -> Result<()> {
        not_negative("proportional_gain", self.proportional)?;
        not_negative("derivative_gain", self.derivative)?;
        self.model
            .checked()
            .map_err(|error| error.within("model"))?;
        if let Feedback::Observer { poles } | Feedback::ObservedSpeed { poles } = self.feedback {
            for pole in poles {
                if !(pole.is_finite() && pole < 0.0) {
                    return Err(Failure::invalid(
                        "observer_poles",
                        "be finite and negative",
                        Given::Number(pole),
                    ));
                }
            }
        }
        Ok(())
    }

    /// Command in V for what is known of the wheel; `amplifier_gain` in A/V turns the currents of
    /// the feed-forward into commands.
    pub(super) fn command(
        &self,
        wish: &WheelWish,
        known: &MeasuredWheel,
        amplifier_gain: f64,
    ) -> f64 {
        self.proportional * (wish.angle - known.angle)
            + self.derivative * (wish.speed - known.speed)
            + self.model.ideal_current(wish) / amplifier_gain
    }
}

/// Angle and speed of a wheel as its controller knows them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MeasuredWheel {
    pub(super) angle: f64,
    pub(super) speed: f64,
}

/// Source of angle and speed.
#[derive(Clone, Copy, Debug)]
pub(super) enum WheelEstimator {
    Differences { last: f64, period: f64 },
    Observer(WheelObserver),
    ObservedSpeed(WheelObserver),
}

impl WheelEstimator {
    pub(super) fn new(controller: &WheelController, period: f64, start: MeasuredWheel) -> Self {
        let observer = |poles| WheelObserver::new(&controller.model, poles, period, start);
        match controller.feedback {
            Feedback::Differences => Self::Differences {
                last: start.angle - start.speed * period,
                period,
            },
            Feedback::Observer { poles } => Self::Observer(observer(poles)),
            Feedback::ObservedSpeed { poles } => Self::ObservedSpeed(observer(poles)),
        }
    }

    /// Angle and speed now.
    pub(super) fn known(&self, read: f64) -> MeasuredWheel {
        match self {
            Self::Differences { last, period } => MeasuredWheel {
                angle: read,
                speed: (read - last) / period,
            },
            Self::Observer(observer) => observer.known,
            Self::ObservedSpeed(observer) => MeasuredWheel {
                angle: read,
                speed: observer.known.speed,
            },
        }
    }

    /// Passes one period, under a current less the friction that it overcomes, in A.
    pub(super) fn pass(&mut self, read: f64, current: f64) {
        match self {
            Self::Differences { last, .. } => *last = read,
            Self::Observer(observer) | Self::ObservedSpeed(observer) => {
                observer.pass(read, current);
            }
        }
    }
}

/// Luenberger observer of `theta'' = K/J i - B/J theta'` (the printed matrices lack the minus), in
/// its exact form for a current that is held over a period: the error passes with the poles
/// `exp(p T)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct WheelObserver {
    known: MeasuredWheel,
    response: Response,
    gain: f64,
    correction: [f64; 2],
}

impl WheelObserver {
    fn new(model: &WheelDynamics, poles: [f64; 2], period: f64, start: MeasuredWheel) -> Self {
        let response = Response::new(model.decay(), period);
        let [first, second] = poles.map(|pole| (pole * period).exp());
        // z^2 - (1 - l_1 + kept) z + (1 - l_1) kept + l_2 rise = (z - z_1)(z - z_2).
        let angle = 1.0 + response.kept - first - second;
        let speed = (first * second - (1.0 - angle) * response.kept) / response.rise;
        Self {
            known: start,
            response,
            gain: model.gain(),
            correction: [angle, speed],
        }
    }

    fn pass(&mut self, read: f64, current: f64) {
        let MeasuredWheel { angle, speed } = self.known;
        let error = read - angle;
        let acceleration = self.gain * current;
        self.known = MeasuredWheel {
            angle: angle
                + self.response.rise * speed
                + self.response.lift * acceleration
                + self.correction[0] * error,
            speed: self.response.kept * speed
                + self.response.rise * acceleration
                + self.correction[1] * error,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::presets::holonomic_wheels;
    use super::*;

    #[test]
    fn the_observer_error_passes_with_its_poles() {
        let drive = holonomic_wheels()[0];
        let model = drive.controller.model;
        let (poles, period) = ([-10.0, -25.0], 0.01);
        let mut observer = WheelObserver::new(&model, poles, period, MeasuredWheel::default());
        let (mut angle, mut speed) = (0.3, -2.0);
        let response = Response::new(model.decay(), period);
        let mut errors = Vec::new();
        for step in 0..60 {
            errors.push(angle - observer.known.angle);
            let current = 0.2 * f64::from(step % 7) - 0.5;
            observer.pass(angle, current);
            let acceleration = model.gain() * current;
            angle += response.rise * speed + response.lift * acceleration;
            speed = response.kept * speed + response.rise * acceleration;
        }
        let [first, second] = poles.map(|pole: f64| (pole * period).exp());
        for three in errors.windows(3) {
            let next = (first + second) * three[1] - first * second * three[0];
            assert!((three[2] - next).abs() < 1e-12, "{three:?}");
        }
    }

    #[test]
    fn poles_must_be_negative() {
        let mut controller = holonomic_wheels()[0].controller;
        controller.feedback = Feedback::Observer {
            poles: [-10.0, 0.0],
        };
        assert!(controller.checked().is_err());
    }
}
