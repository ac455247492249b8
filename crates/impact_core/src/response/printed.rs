//! The linear response with the coefficient `q_2` that the source prints in (3.5.14).
//!
//! The printed `q_2` lacks `C_r C_h / (M_r M_h)`. Manipulator and head still answer to the force as
//! they should; what the misprint changes is the compression, which is larger than the distance
//! between the bodies says by a displacement `q`:
//!
//! ```text
//! M_r p'' + C_r p' + K_r p = C_r eps'
//! M_h q'' + C_h q' + K_h q = C_h p'
//! eps = v_c t - u - w + q
//! ```
//!
//! In the frequency domain `eps (1 + F/A + F/B - C_r C_h s^2 / (A B)) = v_c / s^2` with the force
//! `F = K_c + C_c s` per compression and `A`, `B` the impedances of manipulator and head: (3.5.14)
//! as printed, numerators included. Nothing but the explanation of printed numbers should use it.

use super::runge_kutta::rates;
use crate::contact::{Bodies, Phase, Stretch};
use crate::series::{Cell, CellDrive, ORDER, State};

/// The two displacements that the misprint adds, with their rates, in m and m/s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Misprint {
    arm: [f64; 2],
    head: [f64; 2],
}

/// The bodies and the misprint together; also terms of their series.
#[derive(Clone, Copy)]
struct Both {
    state: State<f64>,
    misprint: Misprint,
}

impl Misprint {
    /// Roots are at most so many times faster than the bound of the right ones.
    ///
    /// With that bound `b` both `C_r / M_r` and `C_h / M_h` are at most `b`, and where
    /// `|s| = r > b` the right polynomial is at least `(r - b)^4`; the missing term is at most
    /// `b^2 r^2`, which is less from `r = (3 + sqrt 5) / 2 b` on.
    pub(super) const FASTER: f64 = 2.618_033_988_749_895;

    /// The series of one cell; the misprint lasts to its end.
    pub(super) fn stretch(
        &mut self,
        bodies: &Bodies,
        start: f64,
        length: f64,
        state: &State<f64>,
    ) -> Stretch {
        let mut cell = Cell::empty();
        cell.start = state.rescaled(length);
        let mut term = Both {
            state: *state,
            misprint: *self,
        };
        for order in 0..ORDER {
            cell.compression_rate[order] = length * term.state.compression[1];
            cell.lag_rate[order] = length * term.state.lag[1];
            cell.head_rate[order] = length * term.state.head[1];
            term = term.rates(bodies).scaled(length / (order + 1) as f64);
            self.add(&term.misprint);
        }
        Stretch::of_cell(start, length, Phase::Touching, cell)
    }

    fn add(&mut self, other: &Self) {
        for place in 0..2 {
            self.arm[place] += other.arm[place];
            self.head[place] += other.head[place];
        }
    }
}

impl Both {
    fn rates(&self, bodies: &Bodies) -> Self {
        let mut state = rates(bodies, &self.state, &CellDrive::none());
        let follow =
            |[_, damping, stiffness]: [f64; 3], [position, rate]: [f64; 2], driving: f64| {
                [rate, damping * (driving - rate) - stiffness * position]
            };
        let Misprint { arm, head } = self.misprint;
        let misprint = Misprint {
            arm: follow(bodies.plant.manipulator, arm, self.state.compression[1]),
            head: follow(bodies.plant.head, head, arm[1]),
        };
        state.compression[1] += misprint.head[1];
        Self { state, misprint }
    }

    fn scaled(self, factor: f64) -> Self {
        let pair = |[position, rate]: [f64; 2]| [position * factor, rate * factor];
        Self {
            state: State {
                compression: pair(self.state.compression),
                lag: pair(self.state.lag),
                head: pair(self.state.head),
            },
            misprint: Misprint {
                arm: pair(self.misprint.arm),
                head: pair(self.misprint.head),
            },
        }
    }
}
