//! The linear response as Taylor series, cell by cell.
//!
//! With the lag `u = x_d - x_r` of the manipulator behind its set-point, the displacement `w` of
//! the head against the torso and the compression `eps` of the foam,
//!
//! ```text
//! f_c        = K_c eps + C_c eps'
//! M_r u''    = f_c - C_r u' - K_r u + (1 - k_ff) M_r a_d
//! M_h w''    = f_c - C_h w' - K_h w
//! eps''      = a_d - u'' - w''
//! ```
//!
//! all with zero displacement at first contact. The coefficients of a cell follow from the
//! equations one after the other, so the series is the matrix exponential applied to the state,
//! without roots of the characteristic equation: repeated, real and complex roots are alike.
//! The three displacements are carried side by side although one of them would do, so that none
//! of them is a difference of the others.

use crate::parameters::{System, Target};
use numeric::lanes::Real;

/// Coefficients of a rate in a cell.
pub const ORDER: usize = 24;

/// Length of a cell times the bound of the fastest root: `2^23 / 23!` is below `4e-16`.
pub const CELL_ANGLE: f64 = 2.0;

/// The numbers that the motion depends on; `1 / M_h = 0` holds the head still.
#[derive(Clone, Copy, Debug)]
pub struct Plant<R> {
    /// `1 / M_r`, `C_r / M_r`, `K_r / M_r`.
    pub manipulator: [R; 3],
    /// `1 / M_h`, `C_h / M_h`, `K_h / M_h`.
    pub head: [R; 3],
    /// `K_c`, `C_c`.
    pub foam: [R; 2],
}

impl Plant<f64> {
    /// The numbers of a system.
    #[must_use]
    pub fn of(system: &System) -> Self {
        let over = |mass: f64, damping: f64, stiffness: f64| {
            [1.0 / mass, damping / mass, stiffness / mass]
        };
        let arm = system.manipulator;
        Self {
            manipulator: over(arm.mass, arm.damping, arm.stiffness),
            head: match system.head {
                Target::Free(head) => over(head.mass, head.damping, head.stiffness),
                Target::Constrained => [0.0; 3],
            },
            foam: [system.foam.stiffness, system.foam.damping],
        }
    }

    /// The bodies without foam between them.
    #[must_use]
    pub fn apart(self) -> Self {
        Self {
            foam: [0.0; 2],
            ..self
        }
    }
}

impl<R: Real> Plant<R> {
    /// An upper bound of the fastest root, in 1/s.
    ///
    /// In coordinates scaled by the square roots of the masses stiffness and damping are
    /// symmetric matrices; with their largest eigenvalues `k` and `c` every root has
    /// `|p|^2 <= c |p| + k`.
    #[inline(always)]
    pub fn fastest(&self) -> R {
        let half = R::splat(0.5);
        let coupling = self.manipulator[0] * self.head[0];
        let largest = |own_arm: R, own_head: R, foam: R| {
            let arm = own_arm + foam * self.manipulator[0];
            let head = own_head + foam * self.head[0];
            let difference = half * (arm - head);
            half * (arm + head) + (difference * difference + foam * foam * coupling).sqrt()
        };
        let damping = half * largest(self.manipulator[1], self.head[1], self.foam[1]);
        let stiffness = largest(self.manipulator[2], self.head[2], self.foam[0]);
        damping + (damping * damping + stiffness).sqrt()
    }

    /// Numbers of the recurrence for cells of a length.
    #[inline(always)]
    pub fn recurrence(&self, length: R) -> Recurrence<R> {
        let square = length * length;
        let body = |[inverse_mass, damping, stiffness]: [R; 3]| {
            [inverse_mass * square, damping * length, stiffness * square]
        };
        Recurrence {
            manipulator: body(self.manipulator),
            head: body(self.head),
            foam: [self.foam[0], self.foam[1] / length],
        }
    }
}

/// Numbers of the recurrence, time in cell lengths.
#[derive(Clone, Copy, Debug)]
pub struct Recurrence<R> {
    manipulator: [R; 3],
    head: [R; 3],
    foam: [R; 2],
}

/// Displacements and rates at one time; rates in m per cell.
#[derive(Clone, Copy, Debug)]
pub struct State<R> {
    /// `eps` and its rate.
    pub compression: [R; 2],
    /// `u` and its rate.
    pub lag: [R; 2],
    /// `w` and its rate.
    pub head: [R; 2],
}

impl<R: Real> State<R> {
    /// First contact.
    #[inline(always)]
    pub fn contact(closing_speed: R, length: R) -> Self {
        let zero = R::zero();
        Self {
            compression: [zero, closing_speed * length],
            lag: [zero; 2],
            head: [zero; 2],
        }
    }

    /// The state with rates for cells longer by a factor.
    #[must_use]
    pub fn rescaled(self, factor: R) -> Self {
        let rate = |[position, rate]: [R; 2]| [position, rate * factor];
        Self {
            compression: rate(self.compression),
            lag: rate(self.lag),
            head: rate(self.head),
        }
    }
}

/// Constant drive of a cell, in m per squared cell.
#[derive(Clone, Copy, Debug)]
pub struct CellDrive<R> {
    /// Acceleration of the set-point.
    pub set_point: R,
    /// The part of it that no feed-forward takes off the lag.
    pub lag: R,
}

impl<R: Real> CellDrive<R> {
    /// Set-point at constant speed.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        Self {
            set_point: R::zero(),
            lag: R::zero(),
        }
    }
}

/// Series of one cell in time over cell length, from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Cell<R, const N: usize = ORDER> {
    /// Rate of the compression.
    pub compression_rate: [R; N],
    /// Rate of the lag.
    pub lag_rate: [R; N],
    /// Rate of the head's displacement.
    pub head_rate: [R; N],
    /// State at the start.
    pub start: State<R>,
}

impl<R: Real, const N: usize> Cell<R, N> {
    /// A cell to be filled.
    #[inline(always)]
    #[must_use]
    pub fn empty() -> Self {
        let zero = [R::zero(); 2];
        Self {
            compression_rate: [R::zero(); N],
            lag_rate: [R::zero(); N],
            head_rate: [R::zero(); N],
            start: State {
                compression: zero,
                lag: zero,
                head: zero,
            },
        }
    }

    /// Fills the cell and gives the state at its end.
    #[inline(always)]
    pub fn fill(
        &mut self,
        numbers: &Recurrence<R>,
        drive: &CellDrive<R>,
        start: &State<R>,
    ) -> State<R> {
        let Recurrence {
            manipulator,
            head,
            foam,
        } = numbers;
        self.start = *start;
        let mut end = *start;
        let State {
            compression: [mut e, mut de],
            lag: [mut u, mut du],
            head: [mut w, mut dw],
        } = *start;
        let mut extra = *drive;
        for k in 0..N {
            self.compression_rate[k] = de;
            self.lag_rate[k] = du;
            self.head_rate[k] = dw;
            let inverse = R::splat(1.0 / (k + 1) as f64);
            let force = foam[0] * e + foam[1] * de;
            let lag = manipulator[0] * force - manipulator[1] * du - manipulator[2] * u + extra.lag;
            let push = head[0] * force - head[1] * dw - head[2] * w;
            let closing = extra.set_point - lag - push;
            e = de * inverse;
            u = du * inverse;
            w = dw * inverse;
            de = closing * inverse;
            du = lag * inverse;
            dw = push * inverse;
            extra = CellDrive::none();
            end.compression[0] += e;
            end.lag[0] += u;
            end.head[0] += w;
            if k + 1 < N {
                end.compression[1] += de;
                end.lag[1] += du;
                end.head[1] += dw;
            }
        }
        end
    }
}

/// Value and derivatives of a series, the first `D` of them.
#[inline(always)]
pub fn derivatives<R: Real, const D: usize, const N: usize>(series: &[R; N], x: R) -> [R; D] {
    let mut taylor = [R::zero(); D];
    for &coefficient in series.iter().rev() {
        for order in (1..D).rev() {
            taylor[order] = taylor[order] * x + taylor[order - 1];
        }
        taylor[0] = taylor[0] * x + coefficient;
    }
    let mut factorial = 1.0;
    for (order, value) in taylor.iter_mut().enumerate().skip(2) {
        factorial *= order as f64;
        *value *= R::splat(factorial);
    }
    taylor
}

/// Position at `x` from its value at the start and the series of its rate.
#[inline(always)]
pub fn integrated<R: Real, const N: usize>(start: R, rate: &[R; N], x: R) -> R {
    let mut value = R::zero();
    for (k, &coefficient) in rate.iter().enumerate().rev() {
        value = value * x + coefficient * R::splat(1.0 / (k + 1) as f64);
    }
    start + value * x
}
