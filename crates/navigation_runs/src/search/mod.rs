//! Search over the gains of a navigation law, the problem of Zeng (2011), appendix C.2, and over those who
//! may hit its robot; both ask the searches over boxes.

mod falsify;
mod gain_objective;
mod gain_options;
mod gain_problem;

pub use box_search::*;

pub use falsify::{Falsification, Property};
pub use gain_objective::{
    Limit, Metric, MetricConstraint, Objective, Over, Robustness, arrival_margin,
};
pub use gain_options::GainOptions;
pub use gain_problem::GainProblem;
