//! The world of a run: frames, motions, shapes, obstacles with their regions, scenarios.

pub mod arrays;
pub mod footprint;
pub mod frame;
pub mod geometry;
pub mod map;
pub mod motion;
pub mod obstacle;
pub mod random_scenes;
pub mod region;
pub mod scenario;
pub mod shape;
