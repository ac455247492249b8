//! Wheels: kinematics, motor, friction, encoder, observer, controller, slip.
//!
//! Equations of Zeng (2011), appendices D and E, with their misprints corrected; wheels do not
//! push each other, as worm gears let no load drive the motor.

mod control_loop;
mod controller;
mod drive;
mod dynamics;
mod follow;
mod kinematics;
mod open_loop;
mod presets;
mod reference;
mod slip;
mod tri_omni;

pub use control_loop::{WheelLoop, WheelSample};
pub use controller::{Feedback, WheelController};
pub use drive::{Encoder, Motor, WheelDrive};
pub use dynamics::{WheelDynamics, WheelState};
pub use follow::{WheelHistory, follow};
pub(crate) use kinematics::omni_rows;
pub use kinematics::{DifferentialKinematics, OmniKinematics};
pub use open_loop::{OpenLoopTest, open_loop_angles};
pub use presets::{differential_wheels, holonomic_wheels};
pub use reference::{WheelReference, WheelWish};
pub use slip::Slip;
pub use tri_omni::{TANGENTS, TriOmni};
