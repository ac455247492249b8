//! Metrics of an impact on its continuous linear response.

use crate::error::{Result, finite};
use crate::fast;
use crate::joint::motion::{ImpactMotion, cell_length};
use crate::metrics::{
    CONSTRAINED_HORIZON, FREE_HORIZON, HELD_WINDOW, INJURY_WINDOWS, Loads, MetricOptions, Metrics,
    Searches, Status,
};
use crate::parameters::{System, Target};
use crate::roots::{Peak, maximum};
use crate::series::Plant;
use crate::windows::{Window, first_fall, held, injury};

/// Pieces of a cell between nodes of a search: a quarter of a radian of the fastest root.
pub(crate) const PIECES: usize = 8;
/// Rounding errors of the acceleration over the terms that it is the sum of.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Peaks and impact duration, which design needs, and the end of their search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// Acceleration of the head, in m/s^2; NaN if constrained.
    pub head_acceleration: Peak,
    /// Contact force, in N.
    pub contact_force: Peak,
    /// Compression of the foam, in m.
    pub compression: Peak,
    /// End of the impact, in s; infinite without one.
    pub impact_duration: f64,
    /// End of the search, in s.
    pub end: f64,
}

/// Results of all searches on one response, with their times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Findings {
    /// The peaks.
    pub peaks: Peaks,
    /// Velocity gained by the head against the torso over the mean's duration, in m/s.
    pub mean: f64,
    /// Windows of the injury criteria, accelerations in m/s^2.
    pub injury: [Window; 2],
    /// Windows of the largest mean and held level over 3 ms, in m/s^2.
    pub held: Option<(Window, Window)>,
    /// Power from the manipulator, in W.
    pub manipulator_power: Peak,
    /// Power of compression, in W.
    pub foam_power: Peak,
}

/// A response on which metrics are searched.
pub struct Impact {
    motion: ImpactMotion<f64>,
    plant: Plant<f64>,
    constrained: bool,
    duration: f64,
    end: f64,
    horizon: f64,
    pieces: usize,
}

impl Impact {
    /// The response up to its first zero of the head's acceleration or the horizon.
    ///
    /// # Errors
    /// The system is too fast for the horizon.
    pub fn new(system: &System, closing_speed: f64, horizon: Option<f64>) -> Result<Self> {
        let constrained = system.head == Target::Constrained;
        let horizon = horizon.unwrap_or(if constrained {
            CONSTRAINED_HORIZON
        } else {
            FREE_HORIZON
        });
        let plant = Plant::of(system);
        let length = cell_length(&plant, horizon)?;
        let mut impact = Self {
            motion: ImpactMotion::new(&plant, closing_speed, length),
            plant,
            constrained,
            duration: f64::INFINITY,
            end: horizon,
            horizon,
            pieces: 0,
        };
        impact.run(horizon);
        impact.pieces = impact.pieces_of(impact.end);
        Ok(impact)
    }

    fn run(&mut self, horizon: f64) {
        while self.motion.end() < horizon {
            let from = self.motion.end();
            self.motion.grow();
            if self.constrained {
                continue;
            }
            let piece = self.motion.length() / PIECES as f64;
            for index in 0..PIECES {
                let start = from + piece * index as f64;
                let stop = if index + 1 == PIECES {
                    self.motion.end()
                } else {
                    from + piece * (index + 1) as f64
                };
                let stop = stop.min(horizon);
                if start >= stop {
                    break;
                }
                let fall = first_fall(
                    |time| self.motion.head(time),
                    start,
                    stop,
                    |time| self.noise(time),
                );
                if let Some(time) = fall {
                    self.duration = time;
                    self.end = time;
                    return;
                }
            }
        }
    }

    /// Rounding error of the head's acceleration.
    fn noise(&self, time: f64) -> f64 {
        let [_, damping, stiffness] = self.plant.head;
        let terms = self.plant.head[0] * self.motion.force(time)[0].abs()
            + damping * self.motion.head(time)[0].abs()
            + stiffness * self.motion.head_displacement(time).abs();
        ROUNDING * terms
    }

    fn pieces_of(&self, duration: f64) -> usize {
        let exact = duration / self.motion.length() * PIECES as f64;
        // Bounded by the number of cells.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let pieces = exact.ceil() as usize;
        pieces.max(PIECES)
    }

    /// The motion behind it.
    #[must_use]
    pub fn motion(&self) -> &ImpactMotion<f64> {
        &self.motion
    }

    /// End of the search, in s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Largest acceleration of the head, in m/s^2; NaN if constrained.
    #[must_use]
    pub fn peak_head_acceleration(&self) -> Peak {
        if self.constrained {
            return Peak {
                value: f64::NAN,
                time: f64::NAN,
            };
        }
        self.maximum(|time| {
            let [_, value, first, second] = self.motion.head(time);
            [value, first, second]
        })
    }

    /// Largest contact force, in N.
    #[must_use]
    pub fn peak_contact_force(&self) -> Peak {
        self.maximum(|time| self.motion.force(time))
    }

    /// Largest compression, in m.
    #[must_use]
    pub fn max_compression(&self) -> Peak {
        self.maximum(|time| {
            let [value, first, second, _] = self.motion.compression(time);
            [value, first, second]
        })
    }

    /// Largest compression until the foam gives back, which may be after the impact period; infinite
    /// if it does not within the horizon: then the foam stops nothing, whatever the period says.
    #[must_use]
    pub fn compression_of_contact(&self) -> f64 {
        let inside = self.max_compression().value;
        if self.motion.compression(self.end)[1] <= 0.0 {
            return inside;
        }
        let mut motion = self.motion.clone();
        let piece = motion.length() / PIECES as f64;
        let mut from = self.end;
        while from < self.horizon {
            let to = (from + piece).min(self.horizon);
            motion.reach(to);
            if motion.compression(to)[1] <= 0.0 {
                let turn = maximum(
                    |time| {
                        let [value, first, second, _] = motion.compression(time);
                        [value, first, second]
                    },
                    from,
                    to,
                    1,
                );
                return inside.max(turn.value);
            }
            from = to;
        }
        f64::INFINITY
    }

    /// Window of the head injury criterion, accelerations in m/s^2.
    #[must_use]
    pub fn injury(&self, width: f64) -> Window {
        injury(|time| self.motion.head(time), self.end, width, self.pieces)
    }

    /// The peaks and the impact period.
    #[must_use]
    pub fn peaks(&self) -> Peaks {
        Peaks {
            head_acceleration: self.peak_head_acceleration(),
            contact_force: self.peak_contact_force(),
            compression: self.max_compression(),
            impact_duration: self.duration,
            end: self.end,
        }
    }

    fn maximum(&self, function: impl Fn(f64) -> [f64; 3]) -> Peak {
        maximum(function, 0.0, self.end, self.pieces)
    }

    /// Results of all searches, for a speed of the manipulator.
    #[must_use]
    pub fn findings(&self, manipulator_speed: f64) -> Findings {
        self.findings_of(manipulator_speed, Searches::ALL)
    }

    /// Findings of some searches and the period, NaN for the rest.
    #[must_use]
    pub fn findings_of(&self, manipulator_speed: f64, searches: Searches) -> Findings {
        let head = |time: f64| self.motion.head(time);
        let manipulator_power = |time: f64| {
            let [rate, first, second, _] = self.motion.lag_rate(time);
            product(
                self.motion.force(time),
                [manipulator_speed - rate, -first, -second],
            )
        };
        let foam_power = |time: f64| {
            let compression = self.motion.compression(time);
            let [_, first, second, third] = compression;
            product(self.motion.force_of(compression), [first, second, third])
        };
        let nothing = Window {
            value: f64::NAN,
            start: f64::NAN,
            end: f64::NAN,
        };
        let no_peak = Peak {
            value: f64::NAN,
            time: f64::NAN,
        };
        let power = |function: &dyn Fn(f64) -> [f64; 3]| {
            if searches.powers {
                self.maximum(function)
            } else {
                no_peak
            }
        };
        let peak = |asked: bool, of: fn(&Self) -> Peak| if asked { of(self) } else { no_peak };
        // A head that cannot move has no acceleration to look at.
        let free = !self.constrained;
        Findings {
            peaks: Peaks {
                head_acceleration: peak(searches.acceleration, Self::peak_head_acceleration),
                contact_force: peak(searches.force, Self::peak_contact_force),
                compression: peak(searches.compression, Self::max_compression),
                impact_duration: self.duration,
                end: self.end,
            },
            mean: if free && searches.mean {
                head(self.end)[0] / self.end
            } else {
                f64::NAN
            },
            injury: [0, 1].map(|window| {
                if free && searches.injury[window] {
                    self.injury(INJURY_WINDOWS[window])
                } else {
                    nothing
                }
            }),
            held: if free && searches.held {
                held(head, self.end, HELD_WINDOW, self.pieces)
            } else {
                None
            },
            manipulator_power: power(&manipulator_power),
            foam_power: power(&foam_power),
        }
    }
}

/// Value, first and second derivative of a product.
fn product([f, f1, f2]: [f64; 3], [g, g1, g2]: [f64; 3]) -> [f64; 3] {
    [f * g, f1 * g + f * g1, f2 * g + 2.0 * f1 * g1 + f * g2]
}

/// Metrics of an impact at a closing speed, in m/s.
///
/// # Errors
/// An argument is out of range.
pub fn metrics(system: &System, closing_speed: f64, options: &MetricOptions) -> Result<Metrics> {
    system.checked()?;
    finite("closing_speed", closing_speed)?;
    options.check()?;
    if closing_speed <= 0.0 {
        return Ok(Metrics::none(Status::NoImpact));
    }
    let (mut found, missing) = fast::usual(system, closing_speed, options);
    if !missing.is_nothing() {
        let impact = Impact::new(system, closing_speed, options.horizon)?;
        let speed = options.manipulator_speed.unwrap_or(closing_speed);
        let findings = impact.findings_of(speed, missing.searches());
        found.take(&findings.metrics(system, options.gravity), missing);
    }
    if found.status == Status::BeyondLinearRange {
        // The kernel knows linear ranges only.
        found.status = Status::released(found.max_compression, &system.foam);
    }
    Ok(found)
}

/// Metrics by the general search, whatever the shape of the response; `closing_speed` in m/s.
///
/// # Errors
/// The system is too fast for the horizon.
pub fn searched(system: &System, closing_speed: f64, options: &MetricOptions) -> Result<Metrics> {
    let impact = Impact::new(system, closing_speed, options.horizon)?;
    let speed = options.manipulator_speed.unwrap_or(closing_speed);
    Ok(impact.findings(speed).metrics(system, options.gravity))
}

impl Findings {
    /// The metrics in their units.
    #[must_use]
    pub fn metrics(&self, system: &System, gravity: f64) -> Metrics {
        // T mean^2.5 with the mean in g.
        let injury = |window: Window| window.value / (gravity * gravity * gravity.sqrt());
        let (average, clip) = self.held.map_or((f64::NAN, f64::NAN), |(average, clip)| {
            (average.value, clip.value)
        });
        let peaks = self.peaks.metrics(system, gravity);
        Metrics {
            loads: Loads {
                mean_head_acceleration_g: self.mean / gravity,
                hic15: injury(self.injury[0]),
                hic36: injury(self.injury[1]),
                average_3ms_g: average / gravity,
                clip_3ms_g: clip / gravity,
                peak_power_manipulator: self.manipulator_power.value,
                peak_power_foam: self.foam_power.value,
                ..peaks.loads
            },
            ..peaks
        }
    }
}

impl Peaks {
    /// The metrics that peaks give; NaN elsewhere.
    #[must_use]
    pub fn metrics(&self, system: &System, gravity: f64) -> Metrics {
        let loads = Loads {
            peak_head_acceleration: self.head_acceleration.value,
            peak_head_acceleration_g: self.head_acceleration.value / gravity,
            peak_contact_force: self.contact_force.value,
            max_compression: self.compression.value,
            impact_duration: if system.head == Target::Constrained {
                f64::NAN
            } else {
                self.impact_duration
            },
            ..Loads::none()
        };
        Metrics {
            loads,
            status: self.status(system),
        }
    }

    fn status(&self, system: &System) -> Status {
        let Self {
            compression,
            impact_duration,
            ..
        } = *self;
        if system.head == Target::Constrained {
            Status::Constrained
        } else if impact_duration.is_infinite() {
            Status::NoRelease
        } else {
            Status::released(compression.value, &system.foam)
        }
    }
}
