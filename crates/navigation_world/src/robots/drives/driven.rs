//! Wheels with their own controllers, several periods of them in a motion step.

use crate::robots::drives::WHEELS;
use crate::robots::wheels::{Slip, WheelDrive, WheelLoop, WheelReference};
use numeric::error::{Failure, Given, Result};

/// Largest deviation of a motion step from a whole number of wheel periods, relative.
const WHOLE_PERIODS: f64 = 1e-9;

/// Wheels of a robot.
#[derive(Clone, Debug)]
pub(crate) struct DrivenWheels {
    loops: Vec<WheelLoop>,
    references: Vec<WheelReference>,
    slip: Slip,
    radius: f64,
    /// Effective winding resistance in ohm.
    resistance: f64,
    pub period: f64,
    periods: usize,
    /// Wanted speeds at the end of the last step, in rad/s.
    wanted: [f64; WHEELS],
    /// Ground speeds in m/s.
    ground: [f64; WHEELS],
    /// Speeds in rad/s at the end of the last step.
    pub speeds: [f64; WHEELS],
    /// Mean currents in A over the last step.
    pub currents: [f64; WHEELS],
    /// Electrical loss over the last step in J.
    pub loss: f64,
}

/// Radius in m and effective winding resistance in ohm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WheelSize {
    pub radius: f64,
    pub resistance: f64,
}

/// Number of wheel periods in a motion step.
///
/// # Errors
/// A wheel is not sound, or the step is not a whole number of periods that all wheels share.
fn periods_of(drives: &[WheelDrive], step: f64) -> Result<usize> {
    let mut whole = 1.0;
    for (index, drive) in drives.iter().enumerate() {
        let wheel = format!("wheels[{index}]");
        let period = drive
            .checked()
            .map_err(|error| error.within(&wheel))?
            .period;
        whole = (step / period).round();
        let shared = drives[0].period.to_bits() == period.to_bits();
        if !shared || whole < 1.0 || (whole * period - step).abs() > WHOLE_PERIODS * step {
            let rule = "be the same for all wheels and divide the motion step";
            let name = format!("{wheel}.period");
            return Err(Failure::invalid(name, rule, Given::Number(period)));
        }
    }
    Ok(count_of(whole))
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a checked ratio of periods
fn count_of(whole: f64) -> usize {
    whole as usize
}

impl DrivenWheels {
    pub fn new(drives: &[WheelDrive], slip: Slip, size: WheelSize, step: f64) -> Result<Self> {
        let periods = periods_of(drives, step)?;
        let period = step / periods as f64;
        Ok(Self {
            loops: drives.iter().map(WheelLoop::new).collect(),
            references: drives.iter().map(|_| WheelReference::new(period)).collect(),
            slip: slip.checked()?,
            radius: size.radius,
            resistance: size.resistance,
            period,
            periods,
            wanted: [0.0; WHEELS],
            ground: [0.0; WHEELS],
            speeds: [0.0; WHEELS],
            currents: [0.0; WHEELS],
            loss: 0.0,
        })
    }

    /// Advances by one motion step in which the wanted speeds change evenly to new ones, in rad/s;
    /// `moved` is called after every wheel period with how fast the wheels roll on the ground, and how fast
    /// they turn, in rad/s.
    pub fn step(
        &mut self,
        wanted: [f64; WHEELS],
        mut moved: impl FnMut([f64; WHEELS], [f64; WHEELS]),
    ) {
        let before = self.wanted;
        let mut sums = [0.0; WHEELS];
        let mut squared = 0.0;
        let mut rolling = [0.0; WHEELS];
        for period in 1..=self.periods {
            let share = period as f64 / self.periods as f64;
            let wheels = self.loops.iter_mut().zip(&mut self.references);
            for (wheel, (controlled, reference)) in wheels.enumerate() {
                let speed = before[wheel] + share * (wanted[wheel] - before[wheel]);
                let sample = controlled.step(&reference.next(speed));
                let rim = self.radius * sample.speed;
                let ground = self.slip.ground_speed(rim, self.ground[wheel], self.period);
                self.ground[wheel] = ground;
                self.speeds[wheel] = sample.speed;
                rolling[wheel] = ground / self.radius;
                sums[wheel] += sample.current;
                squared += sample.current * sample.current;
            }
            moved(rolling, self.speeds);
        }
        self.wanted = wanted;
        self.currents = sums.map(|sum| sum / self.periods as f64);
        self.loss = squared * self.resistance * self.period;
    }
}
