//! Exact derivatives of every metric with respect to every parameter.
//!
//! The response is computed once more with numbers that carry their partial derivatives. At a
//! maximum inside the impact period the place does not matter to first order; a place that moves
//! (the end of the period, the window of a held level) moves by the implicit function theorem.

use crate::criteria::{Findings, Impact};
use crate::dual::Dual;
use crate::error::{Result, finite, positive};
use crate::joint::motion::ImpactMotion;
use crate::metrics::{HELD_WINDOW, Loads, MetricOptions, Metrics, Status};
use crate::parameters::{System, Target};
use crate::roots::Peak;
use crate::series::Plant;
use crate::windows::Window;
use numeric::lanes::Zero;

/// Number of parameters.
pub const PARAMETERS: usize = 10;
/// Names of the parameters, in the order of derivatives.
pub const PARAMETER_NAMES: [&str; PARAMETERS] = [
    "manipulator_mass",
    "manipulator_damping",
    "manipulator_stiffness",
    "foam_stiffness",
    "foam_damping",
    "head_mass",
    "head_damping",
    "head_stiffness",
    "closing_speed",
    "manipulator_speed",
];

/// Share of the interval within which a place counts as its end.
const AT_END: f64 = 1e-12;

type Number = Dual<PARAMETERS>;

/// Metrics with their derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradients {
    /// The metrics.
    pub metrics: Metrics,
    /// Derivative of each metric with respect to each parameter, SI units, accelerations of
    /// metrics in g in g; NaN where the metric is NaN or infinite.
    pub values: Loads<[f64; PARAMETERS]>,
}

/// Derivatives of all metrics. The speed of the manipulator counts as a parameter of its own; if
/// it is not given it equals the closing speed, whose derivative then includes it.
///
/// # Errors
/// An argument is out of range.
pub fn gradients(
    system: &System,
    closing_speed: f64,
    options: &MetricOptions,
) -> Result<Gradients> {
    system.checked()?;
    finite("closing_speed", closing_speed)?;
    options.check()?;
    if closing_speed <= 0.0 {
        return Ok(Gradients {
            metrics: Metrics::none(Status::NoImpact),
            values: Loads::of(|_| [f64::NAN; PARAMETERS]),
        });
    }
    let impact = Impact::new(system, closing_speed, options.horizon)?;
    let speed = options.manipulator_speed.unwrap_or(closing_speed);
    let findings = impact.findings(speed);
    let metrics = findings.metrics(system, options.gravity);
    let mut motion = ImpactMotion::new(
        &plant(system),
        Number::parameter(closing_speed, 8),
        impact.motion().length(),
    );
    motion.reach(impact.end());
    let manipulator_speed = match options.manipulator_speed {
        Some(speed) => Number::parameter(speed, 9),
        None => Number::parameter(closing_speed, 8),
    };
    let view = View {
        motion: &motion,
        findings: &findings,
        constrained: system.head == Target::Constrained,
        manipulator_speed,
    };
    Ok(Gradients {
        metrics,
        values: view.rows(positive("gravity", options.gravity)?),
    })
}

fn plant(system: &System) -> Plant<Number> {
    let arm = system.manipulator;
    let over = |[mass, damping, stiffness]: [f64; 3], first: usize| {
        let mass = Number::parameter(mass, first);
        [
            Number::constant(1.0) / mass,
            Number::parameter(damping, first + 1) / mass,
            Number::parameter(stiffness, first + 2) / mass,
        ]
    };
    Plant {
        manipulator: over([arm.mass, arm.damping, arm.stiffness], 0),
        head: match system.head {
            Target::Free(head) => over([head.mass, head.damping, head.stiffness], 5),
            Target::Constrained => [Number::zero(); 3],
        },
        foam: [
            Number::parameter(system.foam.stiffness, 3),
            Number::parameter(system.foam.damping, 4),
        ],
    }
}

struct View<'a> {
    motion: &'a ImpactMotion<Number>,
    findings: &'a Findings,
    constrained: bool,
    manipulator_speed: Number,
}

impl View<'_> {
    fn rows(&self, gravity: f64) -> Loads<[f64; PARAMETERS]> {
        let per_g = |row: [f64; PARAMETERS]| row.map(|value| value / gravity);
        let scale = gravity * gravity * gravity.sqrt();
        let peaks = &self.findings.peaks;
        let force = self.at_peak(peaks.contact_force, |time| {
            let [value, slope, _] = self.motion.force(time);
            [value, slope]
        });
        let compression = self.at_peak(peaks.compression, |time| {
            let [value, slope, _, _] = self.motion.compression(time);
            [value, slope]
        });
        let manipulator = self.at_peak(self.findings.manipulator_power, |time| {
            let [force, slope, _] = self.motion.force(time);
            let [rate, second, _, _] = self.motion.lag_rate(time);
            let speed = self.manipulator_speed - rate;
            [force * speed, slope * speed - force * second]
        });
        let foam = self.at_peak(self.findings.foam_power, |time| {
            let [force, slope, _] = self.motion.force(time);
            let [_, rate, second, _] = self.motion.compression(time);
            [force * rate, slope * rate + force * second]
        });
        let nothing = [f64::NAN; PARAMETERS];
        if self.constrained {
            // The head has no parameters.
            let without_head = |mut row: [f64; PARAMETERS]| {
                row[5..8].fill(f64::NAN);
                row
            };
            return Loads {
                peak_contact_force: without_head(force),
                max_compression: without_head(compression),
                peak_power_manipulator: without_head(manipulator),
                peak_power_foam: without_head(foam),
                ..Loads::of(|_| nothing)
            };
        }
        let head = self.at_peak(peaks.head_acceleration, |time| {
            let [_, value, slope, _] = self.motion.head(time);
            [value, slope]
        });
        let injury = |window: &Window| self.injury(window).map(|value| value / scale);
        let held = |row: fn(&Self, &Window) -> [f64; PARAMETERS], window: Option<&Window>| {
            window.map_or(nothing, |window| per_g(row(self, window)))
        };
        let windows = self.findings.held.as_ref();
        Loads {
            peak_head_acceleration: head,
            peak_head_acceleration_g: per_g(head),
            mean_head_acceleration_g: per_g(self.mean()),
            peak_contact_force: force,
            max_compression: compression,
            impact_duration: self.duration().unwrap_or(nothing),
            hic15: injury(&self.findings.injury[0]),
            hic36: injury(&self.findings.injury[1]),
            average_3ms_g: held(Self::average, windows.map(|both| &both.0)),
            clip_3ms_g: held(Self::clip, windows.map(|both| &both.1)),
            peak_power_manipulator: manipulator,
            peak_power_foam: foam,
        }
    }

    /// Derivative of the end of the impact, `-(da/dp) / a'`; `None` without an end.
    fn duration(&self) -> Option<[f64; PARAMETERS]> {
        let time = self.findings.peaks.impact_duration;
        time.is_finite().then(|| {
            let [_, value, slope, _] = self.motion.head(time);
            value.partial.map(|partial| -partial / slope.value)
        })
    }

    /// Derivative of how far the end of the search moves.
    fn end(&self) -> [f64; PARAMETERS] {
        self.duration().unwrap_or([0.0; PARAMETERS])
    }

    fn at_peak(&self, peak: Peak, function: impl Fn(f64) -> [Number; 2]) -> [f64; PARAMETERS] {
        let [value, slope] = function(peak.time);
        if peak.time < self.findings.peaks.end {
            return value.partial;
        }
        let end = self.end();
        std::array::from_fn(|index| value.partial[index] + slope.value * end[index])
    }

    fn mean(&self) -> [f64; PARAMETERS] {
        let time = self.findings.peaks.end;
        let [velocity, acceleration] = self.motion.head_pair(time);
        let end = self.end();
        std::array::from_fn(|index| {
            let moved = (acceleration.value - velocity.value / time) * end[index];
            (velocity.partial[index] + moved) / time
        })
    }

    /// Rise of the velocity over a window whose end may move with the end of the search.
    fn rise(&self, window: &Window) -> (Number, [f64; PARAMETERS]) {
        let [last, acceleration] = self.motion.head_pair(window.end);
        let [first, _] = self.motion.head_pair(window.start);
        let search_end = self.findings.peaks.end;
        let at_end = (window.end - search_end).abs() <= AT_END * search_end;
        let moves = if at_end {
            self.end()
        } else {
            [0.0; PARAMETERS]
        };
        let mut rise = last - first;
        for (partial, moved) in rise.partial.iter_mut().zip(moves) {
            *partial += acceleration.value * moved;
        }
        (rise, moves)
    }

    fn injury(&self, window: &Window) -> [f64; PARAMETERS] {
        let (rise, moves) = self.rise(window);
        let length = window.end - window.start;
        if rise.value <= 0.0 {
            return [0.0; PARAMETERS];
        }
        std::array::from_fn(|index| {
            let relative = 2.5 * rise.partial[index] / rise.value - 1.5 * moves[index] / length;
            window.value * relative
        })
    }

    fn average(&self, window: &Window) -> [f64; PARAMETERS] {
        let (rise, _) = self.rise(window);
        let [_, left] = self.motion.head_pair(window.start);
        let search_end = self.findings.peaks.end;
        let moves = if (window.end - search_end).abs() <= AT_END * search_end {
            self.end()
        } else {
            [0.0; PARAMETERS]
        };
        // The start moves along with the end.
        std::array::from_fn(|index| (rise.partial[index] - left.value * moves[index]) / HELD_WINDOW)
    }

    /// Derivative of the held level: of the lower end of its window, or of both ends that stay
    /// equal, or of a trough between them.
    fn clip(&self, window: &Window) -> [f64; PARAMETERS] {
        let [_, left, left_slope, _] = self.motion.head(window.start);
        let [_, right, right_slope, _] = self.motion.head(window.end);
        let near = |value: f64| (value - window.value).abs() <= 1e-9 * window.value.abs();
        match (near(left.value), near(right.value)) {
            (true, true) => {
                let slope = right_slope.value - left_slope.value;
                std::array::from_fn(|index| {
                    let moved = (left.partial[index] - right.partial[index]) / slope;
                    left.partial[index] + left_slope.value * moved
                })
            }
            (true, false) => left.partial,
            (false, true) => right.partial,
            (false, false) => self.trough(window),
        }
    }

    /// Derivative of the lowest acceleration inside a window.
    fn trough(&self, window: &Window) -> [f64; PARAMETERS] {
        let steps = 200;
        let place = |step: usize| {
            window.start + (window.end - window.start) * (step as f64 / f64::from(steps))
        };
        let mut lowest = window.start;
        let mut least = f64::INFINITY;
        for step in 0..=200 {
            let [_, value, _, _] = self.motion.head(place(step));
            if value.value < least {
                least = value.value;
                lowest = place(step);
            }
        }
        // Newton steps to the zero of the slope.
        for _ in 0..8 {
            let [_, _, slope, curve] = self.motion.head(lowest);
            let next = lowest - slope.value / curve.value;
            if next > window.start && next < window.end {
                lowest = next;
            }
        }
        let [_, value, _, _] = self.motion.head(lowest);
        value.partial
    }
}
