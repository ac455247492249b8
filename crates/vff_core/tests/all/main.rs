//! All tests of the crate from outside in one binary: what is generic is compiled for them once.

mod bitwise;
mod built;
mod compared_laws;
mod configurations;
mod convergence;
mod crowd_metrics;
mod crowd_states;
mod crowd_worlds;
mod dormant;
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts are small"
)]
mod draws;
mod episode;
mod field_d_star;
mod field_d_star_planner;
mod fields;
mod follower;
mod functions;
mod gain_search;
mod golden;
mod guide;
mod hock_schittkowski;
mod impedance;
mod lane_scenes;
mod lanes;
mod lanes_batches;
mod listening;
mod moving_rectangles;
mod optimize;
mod optimize_global;
mod optimize_resumed;
mod pairs;
mod planner_geometry;
mod planning;
mod properties;
mod sensing;
mod shield;
mod skirt;
mod slalom;
mod sonar;
mod sound;
mod sound_bursts;
mod sound_properties;
mod static_maps;
mod tracking;
mod tree;
mod tree_planner;
mod ultrasonic;
mod velocity_obstacle;
mod wheels;
mod worlds;
