//! Classical Runge-Kutta steps of fourth order, cut where an event happens.

use super::{CHECK, ResponseRun};
use crate::contact::{Bodies, Event, Phase};
use crate::error::{Failure, Result};
use crate::roots::root;
use crate::series::{CellDrive, State};
use numeric::threads::Interrupted;

impl ResponseRun<'_> {
    pub(super) fn runge_kutta(
        &mut self,
        samples: usize,
        interrupted: Interrupted<'_>,
    ) -> Result<()> {
        self.record(0.0, &self.state.clone(), self.bodies.phase);
        for sample in 1..=samples {
            if sample.is_multiple_of(CHECK) && interrupted() {
                return Err(Failure::Interrupted);
            }
            let target = self.options.step * sample as f64;
            while self.time < target {
                let (drive, change) = self.drive();
                let stop = target.min(change);
                self.advance(stop, &drive);
            }
            self.record(target, &self.state.clone(), self.bodies.phase);
        }
        Ok(())
    }

    /// One step, cut where an event happens.
    fn advance(&mut self, stop: f64, drive: &CellDrive<f64>) {
        let span = stop - self.time;
        let after = |step: f64| runge_kutta_step(&self.bodies, &self.state, drive, step);
        let law = self.bodies.law();
        let pull = |step: f64| {
            let state = after(step);
            match self.bodies.phase {
                Phase::Touching => {
                    let closing = rates(&self.bodies, &state, drive).compression[1];
                    let [position, rate] = state.compression;
                    [-law.force([position, rate]), -law.force([rate, closing])]
                }
                Phase::Apart { left, since } => {
                    let [relaxed, relaxing] = law.relaxed(left, self.time + step - since);
                    [
                        state.compression[0] - relaxed,
                        state.compression[1] - relaxing,
                    ]
                }
            }
        };
        let happens = self.bodies.unilateral && pull(span)[0] > 0.0;
        let starts_on = match self.bodies.phase {
            Phase::Touching => true,
            Phase::Apart { since, .. } => since < self.time || pull(0.5 * span)[0] < 0.0,
        };
        if happens && starts_on {
            let step = root(pull, 0.0, span);
            self.state = after(step);
            self.time += step;
            let event = match self.bodies.phase {
                Phase::Touching => Event::Release,
                Phase::Apart { .. } => Event::Touch,
            };
            self.turn(event);
        } else {
            self.state = after(span);
            self.time = stop;
        }
    }
}

/// Rates of a state, those of positions in the first places.
pub(super) fn rates(bodies: &Bodies, state: &State<f64>, drive: &CellDrive<f64>) -> State<f64> {
    let force = match bodies.phase {
        Phase::Touching => bodies.law().force(state.compression),
        Phase::Apart { .. } => 0.0,
    };
    let of = |[inverse_mass, damping, stiffness]: [f64; 3], [position, rate]: [f64; 2]| {
        inverse_mass * force - damping * rate - stiffness * position
    };
    let lag = of(bodies.plant.manipulator, state.lag) + drive.lag;
    let head = of(bodies.plant.head, state.head);
    State {
        compression: [state.compression[1], drive.set_point - lag - head],
        lag: [state.lag[1], lag],
        head: [state.head[1], head],
    }
}

fn runge_kutta_step(
    bodies: &Bodies,
    state: &State<f64>,
    drive: &CellDrive<f64>,
    step: f64,
) -> State<f64> {
    let k1 = rates(bodies, state, drive);
    let k2 = rates(bodies, &moved(state, &k1, 0.5 * step), drive);
    let k3 = rates(bodies, &moved(state, &k2, 0.5 * step), drive);
    let k4 = rates(bodies, &moved(state, &k3, step), drive);
    let ends = moved(&moved(state, &k1, step / 6.0), &k4, step / 6.0);
    moved(&moved(&ends, &k2, step / 3.0), &k3, step / 3.0)
}

fn moved(state: &State<f64>, rates: &State<f64>, step: f64) -> State<f64> {
    let pair = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a + c * step, b + d * step];
    State {
        compression: pair(state.compression, rates.compression),
        lag: pair(state.lag, rates.lag),
        head: pair(state.head, rates.head),
    }
}
