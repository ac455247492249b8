//! The terms of the virtual force field, one file each.

pub mod attractive;
pub mod detour;
pub mod gains;
pub mod law;
pub mod lyapunov;
pub mod repulsive;
pub mod side;
pub mod stabilizing;
pub mod terms;
