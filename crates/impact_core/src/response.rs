//! Trajectories of an impact, exact or by Runge-Kutta steps, with foam that may release.

use crate::contact::{Bodies, Event, Phase, Stretch};
use crate::drive::SetPoint;
use crate::error::{Given, ImpactError, Result, finite, positive};
use crate::motion::cell_length;
use crate::parameters::{System, Target};
use crate::roots::{Peak, maximum, root};
use crate::series::{Drive, Plant, State};
use crate::windows::first_fall;

/// Samples that a response may have.
pub const MAX_SAMPLES: usize = 100_000_000;
/// Pieces of a cell between nodes of a search.
const PIECES: usize = 8;

/// How the motion is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Series of the exact solution.
    Exact,
    /// Classical Runge-Kutta steps of fourth order from sample to sample.
    RungeKutta,
}

/// What the foam can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// Push and pull.
    Linear,
    /// Push only.
    Unilateral,
}

/// Speeds at first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// `v_c = v_r - v_h`, in m/s.
    pub closing_speed: f64,
    /// `v_r`, in m/s; the closing speed when `None`.
    pub manipulator_speed: Option<f64>,
}

/// What a simulation depends on beside system and speeds.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulationOptions {
    /// Duration, in s.
    pub duration: f64,
    /// Time between samples, in s.
    pub step: f64,
    /// How the motion is found.
    pub method: Method,
    /// What the foam can do.
    pub contact: Contact,
    /// Motion of the set-point.
    pub set_point: SetPoint,
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
    system.checked()?;
    positive("closing_speed", approach.closing_speed)?;
    if let Some(speed) = approach.manipulator_speed {
        finite("manipulator_speed", speed)?;
    }
    positive("duration", options.duration)?;
    positive("step", options.step)?;
    options.set_point.check()?;
    let samples = (options.duration / options.step + 1e-9).floor();
    if samples > MAX_SAMPLES as f64 {
        let given = Given::Number(options.step);
        return Err(ImpactError::invalid(
            "step",
            "give fewer than 1e8 samples",
            given,
        ));
    }
    let plant = Plant::of(system);
    cell_length(&plant, options.duration)?;
    let mut run = Run {
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
    match options.method {
        Method::Exact => run.exact(samples),
        Method::RungeKutta => run.runge_kutta(samples),
    }
    Ok(run.response)
}

struct Run<'a> {
    bodies: Bodies,
    constrained: bool,
    thickness: f64,
    speeds: [f64; 2],
    options: &'a SimulationOptions,
    time: f64,
    state: State<f64>,
    response: Response,
}

impl Run<'_> {
    fn drive(&self) -> (Drive<f64>, f64) {
        let (acceleration, change) = self.options.set_point.at(self.time);
        let lag = if self.options.set_point.feed_forward {
            0.0
        } else {
            acceleration
        };
        let drive = Drive {
            set_point: acceleration,
            lag,
        };
        (drive, change)
    }

    fn exact(&mut self, samples: usize) {
        let mut watch = Watch::new(self.constrained);
        let longest = self.bodies.cell_length(self.options.duration);
        let last = self.options.step * samples as f64;
        let mut next = 0;
        while next <= samples {
            let (drive, change) = self.drive();
            let length = longest.min(change - self.time);
            let stretch = Stretch::new(&self.bodies, self.time, length, &self.state, drive);
            watch.look(&stretch, &self.bodies, self.options.duration);
            let end = self.time + stretch.used;
            while next <= samples {
                let time = self.options.step * next as f64;
                if time > end || (time == end && stretch.event.is_some() && time < last) {
                    break;
                }
                self.record(time, &stretch.state(time - self.time), stretch.phase);
                next += 1;
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

    fn runge_kutta(&mut self, samples: usize) {
        self.record(0.0, &self.state.clone(), self.bodies.phase);
        for sample in 1..=samples {
            let target = self.options.step * sample as f64;
            while self.time < target {
                let (drive, change) = self.drive();
                let stop = target.min(change);
                self.advance(stop, &drive);
            }
            self.record(target, &self.state.clone(), self.bodies.phase);
        }
    }

    /// One step, cut where an event happens.
    fn advance(&mut self, stop: f64, drive: &Drive<f64>) {
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
fn rates(bodies: &Bodies, state: &State<f64>, drive: &Drive<f64>) -> State<f64> {
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
    drive: &Drive<f64>,
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

/// Collects peaks until the head's acceleration comes back to zero.
struct Watch {
    peaks: ResponsePeaks,
    over: bool,
}

impl Watch {
    fn new(constrained: bool) -> Self {
        let head = if constrained { f64::NAN } else { 0.0 };
        Self {
            peaks: ResponsePeaks {
                head_acceleration: head,
                contact_force: 0.0,
                compression: 0.0,
                impact_duration: if constrained { f64::NAN } else { f64::INFINITY },
            },
            over: false,
        }
    }

    fn look(&mut self, stretch: &Stretch, bodies: &Bodies, duration: f64) {
        if self.over || stretch.start >= duration {
            return;
        }
        let free = !self.peaks.impact_duration.is_nan();
        let mut end = stretch.used.min(duration - stretch.start);
        if free {
            let piece = end / PIECES as f64;
            let noise = |time: f64| {
                let state = stretch.state(time);
                let [inverse_mass, damping, stiffness] = bodies.plant.head;
                let [compression, rate] = state.compression.map(f64::abs);
                let force = bodies.law().force([compression, rate]);
                let [position, velocity] = state.head.map(f64::abs);
                16.0 * f64::EPSILON
                    * (inverse_mass * force + damping * velocity + stiffness * position)
            };
            let fall = (0..PIECES).find_map(|index| {
                let from = piece * index as f64;
                first_fall(|time| stretch.head(time), from, from + piece, noise)
            });
            if let Some(time) = fall {
                end = time;
                self.over = true;
                self.peaks.impact_duration = stretch.start + time;
            }
        }
        let peak =
            |function: &dyn Fn(f64) -> [f64; 3]| -> Peak { maximum(function, 0.0, end, PIECES) };
        let law = bodies.law();
        if free {
            let acceleration = peak(&|time| {
                let [_, value, first, second] = stretch.head(time);
                [value, first, second]
            });
            self.peaks.head_acceleration = self.peaks.head_acceleration.max(acceleration.value);
        }
        if stretch.phase == Phase::Touching {
            let force = peak(&|time| {
                let [value, first, second, third] = stretch.compression_jet(time);
                [
                    law.force([value, first]),
                    law.force([first, second]),
                    law.force([second, third]),
                ]
            });
            let compression = peak(&|time| {
                let [value, first, second, _] = stretch.compression_jet(time);
                [value, first, second]
            });
            self.peaks.contact_force = self.peaks.contact_force.max(force.value);
            self.peaks.compression = self.peaks.compression.max(compression.value);
        }
    }
}
