//! Virtual impedance: collision vectors, conventional and active law, attraction.
//!
//! Equation numbers are those of Avi (2019), in the form that `docs/theory/errata` derives.

pub mod attraction;
pub mod bank;
pub mod collision;
pub mod following;
pub mod law;
pub mod navigation;
pub mod rate;

pub use attraction::Attraction;
pub use bank::{Bank, BankOptions, Rotation};
pub use collision::{clamped_foot, collision_point, foot, pair_echoes, printed_foot};
pub use law::{Form, Impedance};
pub use navigation::ImpedanceFamily;
pub use rate::{Rate, RateFilter, Speed};
