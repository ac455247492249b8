//! Foam that pushes but does not pull: release and renewed contact.
//!
//! In contact the force is `K_c eps + C_c eps'`. When it would become negative the bodies part;
//! the foam then relaxes by `K_c s + C_c s' = 0` from its compression `s` at release and is
//! touched again when the distance of the bodies equals what is left.

use crate::joint::motion::MAX_CELLS;
use crate::roots::root;
use crate::series::{CELL_ANGLE, Cell, CellDrive, Plant, State, derivatives, integrated};
use crate::windows::first_fall;

/// Pieces of a cell between nodes of the search for events.
const PIECES: usize = 8;
/// Rounding errors of the force over its two terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Whether the foam is touched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// The foam is compressed by both bodies.
    Touching,
    /// The foam relaxes.
    Apart {
        /// Compression at release, in m.
        left: f64,
        /// Time of release, in s.
        since: f64,
    },
}

/// Event that ends a stretch of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The force came back to zero.
    Release,
    /// The foam is touched again.
    Touch,
}

/// Law of the foam.
#[derive(Clone, Copy, Debug)]
pub struct FoamLaw {
    /// `K_c`, in N/m.
    pub stiffness: f64,
    /// `C_c`, in N s/m.
    pub damping: f64,
}

impl FoamLaw {
    /// Force of the touched foam.
    #[must_use]
    pub fn force(&self, [compression, rate]: [f64; 2]) -> f64 {
        self.stiffness * compression + self.damping * rate
    }

    /// Compression of the foam left to itself and its rate.
    #[must_use]
    pub fn relaxed(&self, left: f64, duration: f64) -> [f64; 2] {
        if self.stiffness == 0.0 {
            return [left, 0.0];
        }
        if self.damping == 0.0 {
            return [0.0, 0.0];
        }
        let rate = self.stiffness / self.damping;
        let now = left * (-rate * duration).exp();
        [now, -rate * now]
    }
}

/// One cell of a motion with contact, states in m and m/s.
pub struct Stretch {
    /// Start, in s.
    pub start: f64,
    /// Length, in s.
    pub length: f64,
    /// End of the stretch inside the cell, in s from its start.
    pub used: f64,
    /// Its phase.
    pub phase: Phase,
    /// Event that ended it.
    pub event: Option<Event>,
    cell: Cell<f64>,
}

impl Stretch {
    /// Fills a cell from a state and looks for the event that ends the phase.
    #[must_use]
    pub fn new(
        bodies: &Bodies,
        start: f64,
        length: f64,
        state: &State<f64>,
        drive: CellDrive<f64>,
    ) -> Self {
        let plant = match bodies.phase {
            Phase::Touching => bodies.plant,
            Phase::Apart { .. } => bodies.plant.apart(),
        };
        let square = length * length;
        let drive = CellDrive {
            set_point: drive.set_point * square,
            lag: drive.lag * square,
        };
        let mut cell = Cell::empty();
        cell.fill(&plant.recurrence(length), &drive, &state.rescaled(length));
        let mut stretch = Self::of_cell(start, length, bodies.phase, cell);
        if bodies.unilateral {
            stretch.look(&bodies.law());
        }
        stretch
    }

    /// A filled cell that is used to its end.
    #[must_use]
    pub fn of_cell(start: f64, length: f64, phase: Phase, cell: Cell<f64>) -> Self {
        Self {
            start,
            length,
            used: length,
            phase,
            event: None,
            cell,
        }
    }

    fn look(&mut self, law: &FoamLaw) {
        let piece = self.length / PIECES as f64;
        for index in 0..PIECES {
            let [from, to] = [piece * index as f64, piece * (index + 1) as f64];
            let found = match self.phase {
                Phase::Touching => {
                    let jet = |time: f64| {
                        let [compression, rate, second] = self.compression(time);
                        let force = law.force([compression, rate]);
                        [0.0, force, law.force([rate, second]), 0.0]
                    };
                    let noise = |time: f64| {
                        let [compression, rate, _] = self.compression(time);
                        ROUNDING * law.force([compression.abs(), rate.abs()])
                    };
                    first_fall(jet, from, to, noise).map(|time| (time, Event::Release))
                }
                Phase::Apart { left, since } => {
                    let gap = |time: f64| {
                        let [compression, rate, _] = self.compression(time);
                        let [relaxed, relaxing] = law.relaxed(left, self.start + time - since);
                        [compression - relaxed, rate - relaxing]
                    };
                    (gap(to)[0] > 0.0 && gap(from)[0] < 0.0)
                        .then(|| (root(gap, from, to), Event::Touch))
                }
            };
            if let Some((time, event)) = found {
                self.used = time;
                self.event = Some(event);
                return;
            }
        }
    }

    /// Compression, its rate and acceleration at a time from the start.
    #[must_use]
    pub fn compression(&self, time: f64) -> [f64; 3] {
        let x = time / self.length;
        let [rate, second]: [f64; 2] = derivatives(&self.cell.compression_rate, x);
        [
            integrated(
                self.cell.start.compression[0],
                &self.cell.compression_rate,
                x,
            ),
            rate / self.length,
            second / (self.length * self.length),
        ]
    }

    /// State at a time from the start, rates in m/s.
    #[must_use]
    pub fn state(&self, time: f64) -> State<f64> {
        let x = time / self.length;
        let of = |start: [f64; 2], rate: &[f64; crate::series::ORDER]| {
            let [velocity]: [f64; 1] = derivatives(rate, x);
            [integrated(start[0], rate, x), velocity / self.length]
        };
        State {
            compression: of(self.cell.start.compression, &self.cell.compression_rate),
            lag: of(self.cell.start.lag, &self.cell.lag_rate),
            head: of(self.cell.start.head, &self.cell.head_rate),
        }
    }

    /// Velocity of the head and its first three derivatives at a time from the start.
    #[must_use]
    pub fn head(&self, time: f64) -> [f64; 4] {
        let mut jet: [f64; 4] = derivatives(&self.cell.head_rate, time / self.length);
        let mut factor = 1.0;
        for value in &mut jet {
            factor /= self.length;
            *value *= factor;
        }
        jet
    }

    /// Compression with its first three derivatives at a time from the start.
    #[must_use]
    pub fn compression_jet(&self, time: f64) -> [f64; 4] {
        let x = time / self.length;
        let [first, second, third]: [f64; 3] = derivatives(&self.cell.compression_rate, x);
        let length = self.length;
        [
            integrated(
                self.cell.start.compression[0],
                &self.cell.compression_rate,
                x,
            ),
            first / length,
            second / (length * length),
            third / (length * length * length),
        ]
    }
}

/// The bodies with the present phase of the foam.
#[derive(Clone, Copy, Debug)]
pub struct Bodies {
    /// Their numbers.
    pub plant: Plant<f64>,
    /// Whether the foam is touched.
    pub phase: Phase,
    /// Whether the foam can only push.
    pub unilateral: bool,
}

impl Bodies {
    /// Law of the foam between them.
    #[must_use]
    pub fn law(&self) -> FoamLaw {
        FoamLaw {
            stiffness: self.plant.foam[0],
            damping: self.plant.foam[1],
        }
    }

    /// Phase after an event at a time, in s, with a compression, in m.
    #[must_use]
    pub fn after(&self, event: Event, time: f64, compression: f64) -> Phase {
        match event {
            Event::Release => Phase::Apart {
                left: compression,
                since: time,
            },
            Event::Touch => Phase::Touching,
        }
    }

    /// Length of a cell, in s.
    #[must_use]
    pub fn cell_length(&self, duration: f64) -> f64 {
        (CELL_ANGLE / self.plant.fastest()).clamp(duration / MAX_CELLS as f64, duration)
    }
}
