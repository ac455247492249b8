//! Trajectories of an impact, exact or by Runge-Kutta steps, with foam that may release.

mod peaks;
mod printed;
mod runge_kutta;

use crate::contact::{Bodies, Event, Phase, Stretch};
use crate::error::{Failure, Given, Result, finite, positive};
use crate::joint::drive::SetPoint;
use crate::joint::motion::cell_length;
use crate::parameters::{System, Target};
use crate::series::{CellDrive, Plant, State};
use numeric::threads::Interrupted;
use peaks::Watch;
use printed::Misprint;

/// Samples that a response may have.
pub const MAX_SAMPLES: usize = 100_000_000;
/// Pieces of a cell between nodes of a search.
const PIECES: usize = 8;
/// Samples between two looks whether to stop.
const CHECK: usize = 4096;

/// Method of the solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Series of the exact solution.
    Exact,
    /// Classical Runge-Kutta steps of fourth order from sample to sample.
    RungeKutta,
}

/// Forces that the foam can give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// Push and pull.
    Linear,
    /// Push only.
    Unilateral,
}

/// Coefficients of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equations {
    /// Coefficients of the bodies.
    Corrected,
    /// `q_2` of (3.5.14) as the source prints it, without `C_r C_h / (M_r M_h)`: only to explain
    /// its numbers.
    AsPrinted,
}

/// Speeds at first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// `v_c = v_r - v_h`, in m/s.
    pub closing_speed: f64,
    /// `v_r`, in m/s; the closing speed when `None`.
    pub manipulator_speed: Option<f64>,
}

/// Settings of a simulation beside system and speeds.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulationOptions {
    /// Duration, in s.
    pub duration: f64,
    /// Time between samples, in s.
    pub step: f64,
    /// Method of the solution.
    pub method: Method,
    /// Forces that the foam can give.
    pub contact: Contact,
    /// Motion of the set-point.
    pub set_point: SetPoint,
    /// Coefficients of the motion; the printed ones need the exact method, linear contact
    /// and a set-point at constant speed.
    pub equations: Equations,
}

/// A trajectory. Positions are measured from the manipulator's place at first contact, the head
/// stands at the foam's thickness then.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Response {
    /// Time, in s.
    pub time: Vec<f64>,
    /// Contact force `f_c`, in N.
    pub contact_force: Vec<f64>,
    /// Acceleration of the head, in m/s^2; NaN if constrained.
    pub head_acceleration: Vec<f64>,
    /// `x_h`, in m.
    pub head_position: Vec<f64>,
    /// `x_h'`, in m/s.
    pub head_velocity: Vec<f64>,
    /// `x_r`, in m.
    pub manipulator_position: Vec<f64>,
    /// `x_r'`, in m/s.
    pub manipulator_velocity: Vec<f64>,
    /// `T_u - x_h + x_r`, in m; below what is left in the foam while the bodies are apart.
    pub compression: Vec<f64>,
    /// Times of release, in s.
    pub releases: Vec<f64>,
    /// Times of renewed contact, in s.
    pub touches: Vec<f64>,
    /// Peaks up to the first zero of the head's acceleration or the end, on the continuous
    /// solution; `None` for Runge-Kutta steps.
    pub peaks: Option<ResponsePeaks>,
}

/// Peaks of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponsePeaks {
    /// Acceleration of the head, in m/s^2; NaN if constrained.
    pub head_acceleration: f64,
    /// Contact force, in N.
    pub contact_force: f64,
    /// Compression of the foam, in m.
    pub compression: f64,
    /// First zero of the head's acceleration, in s; infinite if there is none, NaN if constrained.
    pub impact_duration: f64,
}

/// Simulates an impact.
///
/// # Errors
/// An argument is out of range.
pub fn simulate(
    system: &System,
    approach: &Approach,
    options: &SimulationOptions,
) -> Result<Response> {
    simulate_until(system, approach, options, &|| false)
}

/// Simulates an impact unless the caller asks to stop.
///
/// # Errors
/// An argument is out of range, the samples do not fit into memory, or the caller asked to stop.
pub fn simulate_until(
    system: &System,
    approach: &Approach,
    options: &SimulationOptions,
    interrupted: Interrupted<'_>,
) -> Result<Response> {
    system.checked()?;
    positive("closing_speed", approach.closing_speed)?;
    if let Some(speed) = approach.manipulator_speed {
        finite("manipulator_speed", speed)?;
    }
    positive("duration", options.duration)?;
    positive("step", options.step)?;
    options.set_point.check()?;
    options.check_equations()?;
    let samples = (options.duration / options.step + 1e-9).floor();
    if samples > MAX_SAMPLES as f64 {
        let given = Given::Number(options.step);
        return Err(Failure::invalid(
            "step",
            "give fewer than 1e8 samples",
            given,
        ));
    }
    let plant = Plant::of(system);
    cell_length(&plant, options.duration)?;
    let mut run = ResponseRun {
        bodies: Bodies {
            plant,
            phase: Phase::Touching,
            unilateral: options.contact == Contact::Unilateral,
        },
        constrained: system.head == Target::Constrained,
        thickness: system.foam.thickness,
        speeds: [
            approach.closing_speed,
            approach.manipulator_speed.unwrap_or(approach.closing_speed),
        ],
        options,
        time: 0.0,
        state: State::contact(approach.closing_speed, 1.0),
        response: Response::default(),
    };
    // Checked above; the cast does not lose anything.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let samples = samples as usize;
    run.response.reserve(samples + 1).ok_or_else(|| {
        let given = Given::Number(options.step);
        Failure::invalid("step", "give samples that fit into memory", given)
    })?;
    match options.method {
        Method::Exact => run.exact(samples, interrupted)?,
        Method::RungeKutta => run.runge_kutta(samples, interrupted)?,
    }
    Ok(run.response)
}

impl SimulationOptions {
    fn check_equations(&self) -> Result<()> {
        let plain = self.method == Method::Exact
            && self.contact == Contact::Linear
            && self.set_point.segments.is_empty();
        if plain || self.equations == Equations::Corrected {
            return Ok(());
        }
        Err(Failure::invalid(
            "equations",
            "be \"corrected\" unless method, contact and set-point are the usual ones",
            Given::Word("as_printed".to_owned()),
        ))
    }
}

impl Response {
    /// Makes room for samples if there is.
    fn reserve(&mut self, samples: usize) -> Option<()> {
        let columns = [
            &mut self.time,
            &mut self.contact_force,
            &mut self.head_acceleration,
            &mut self.head_position,
            &mut self.head_velocity,
            &mut self.manipulator_position,
            &mut self.manipulator_velocity,
            &mut self.compression,
        ];
        for column in columns {
            column.try_reserve_exact(samples).ok()?;
        }
        Some(())
    }
}

struct ResponseRun<'a> {
    bodies: Bodies,
    constrained: bool,
    thickness: f64,
    speeds: [f64; 2],
    options: &'a SimulationOptions,
    time: f64,
    state: State<f64>,
    response: Response,
}

impl ResponseRun<'_> {
    fn drive(&self) -> (CellDrive<f64>, f64) {
        let (acceleration, change) = self.options.set_point.at(self.time);
        let lag = if self.options.set_point.feed_forward {
            0.0
        } else {
            acceleration
        };
        let drive = CellDrive {
            set_point: acceleration,
            lag,
        };
        (drive, change)
    }

    fn exact(&mut self, samples: usize, interrupted: Interrupted<'_>) -> Result<()> {
        let mut misprint = match self.options.equations {
            Equations::Corrected => None,
            Equations::AsPrinted => Some(Misprint::default()),
        };
        let mut watch = Watch::new(self.constrained);
        let mut longest = self.bodies.cell_length(self.options.duration);
        if misprint.is_some() {
            longest /= Misprint::FASTER;
        }
        let last = self.options.step * samples as f64;
        let mut next = 0;
        while next <= samples {
            if interrupted() {
                return Err(Failure::Interrupted);
            }
            let (drive, change) = self.drive();
            let length = longest.min(change - self.time);
            let stretch = match &mut misprint {
                None => Stretch::new(&self.bodies, self.time, length, &self.state, drive),
                Some(misprint) => misprint.stretch(&self.bodies, self.time, length, &self.state),
            };
            watch.look(&stretch, &self.bodies, self.options.duration);
            let end = self.time + stretch.used;
            while next <= samples {
                let time = self.options.step * next as f64;
                if time > end || (time == end && stretch.event.is_some() && time < last) {
                    break;
                }
                self.record(time, &stretch.state(time - self.time), stretch.phase);
                next += 1;
                if next.is_multiple_of(CHECK) && interrupted() {
                    return Err(Failure::Interrupted);
                }
            }
            self.state = stretch.state(stretch.used);
            self.time = if length == change - self.time && stretch.event.is_none() {
                change
            } else {
                end
            };
            if let Some(event) = stretch.event {
                self.turn(event);
            }
        }
        self.response.peaks = Some(watch.peaks);
        Ok(())
    }

    fn turn(&mut self, event: Event) {
        self.bodies.phase = self
            .bodies
            .after(event, self.time, self.state.compression[0]);
        if self.time <= self.options.duration {
            match event {
                Event::Release => self.response.releases.push(self.time),
                Event::Touch => self.response.touches.push(self.time),
            }
        }
    }

    fn force(&self, state: &State<f64>, phase: Phase) -> f64 {
        match phase {
            Phase::Touching => self.bodies.law().force(state.compression),
            Phase::Apart { .. } => 0.0,
        }
    }

    fn record(&mut self, time: f64, state: &State<f64>, phase: Phase) {
        let force = self.force(state, phase);
        let [closing, manipulator] = self.speeds;
        let torso = manipulator - closing;
        let [excess, rate] = self.options.set_point.excess(time);
        let head = self.bodies.plant.head;
        let acceleration = if self.constrained {
            f64::NAN
        } else {
            head[0] * force - head[1] * state.head[1] - head[2] * state.head[0]
        };
        let out = &mut self.response;
        out.time.push(time);
        out.contact_force.push(force);
        out.head_acceleration.push(acceleration);
        out.head_position
            .push(self.thickness + torso * time + state.head[0]);
        out.head_velocity.push(torso + state.head[1]);
        out.manipulator_position
            .push(manipulator * time + excess - state.lag[0]);
        out.manipulator_velocity
            .push(manipulator + rate - state.lag[1]);
        out.compression.push(state.compression[0]);
    }
}
