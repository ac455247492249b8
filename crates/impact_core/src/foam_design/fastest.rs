//! The fastest impact that some foam makes acceptable.

use super::{DesignProblem, Requirement, check};
use crate::error::{Result, not_negative};

impl DesignProblem {
    /// Largest closing speed at which a foam of this damping keeps all requirements, and its
    /// stiffness; 0 and NaN where none does at any speed. Metrics are powers of the closing speed, so one response serves all speeds.
    ///
    /// # Errors
    /// An argument is out of range.
    pub fn fastest(&self, requirements: &[Requirement], damping: f64) -> Result<FastestImpact> {
        check(self, requirements)?;
        not_negative("damping", damping)?;
        let speed = |stiffness: f64| -> Result<f64> {
            let mut least = f64::INFINITY;
            for requirement in requirements {
                let (value, _) = self.value(requirement, [stiffness, damping])?;
                let ratio = requirement.limit / value;
                least = least.min(ratio.powf(1.0 / requirement.quantity.power()));
            }
            Ok(self.closing_speed * least)
        };
        let nodes = self
            .nodes()
            .map(|stiffness| Ok([stiffness, speed(stiffness)?]))
            .collect::<Result<Vec<_>>>()?;
        let mut best = [f64::NAN, 0.0];
        for (index, node) in nodes.iter().enumerate() {
            let left = nodes[index.saturating_sub(1)];
            let right = nodes[(index + 1).min(nodes.len() - 1)];
            // Foam that stops nothing keeps nothing, at any speed.
            if node[1] == 0.0 || node[1] < left[1] || node[1] < right[1] {
                continue;
            }
            let found = golden(&speed, left[0], right[0])?;
            for other in [*node, found] {
                if other[1] > best[1] {
                    best = other;
                }
            }
        }
        Ok(FastestImpact {
            stiffness: best[0],
            closing_speed: best[1],
        })
    }
}

/// The fastest impact that some foam makes acceptable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FastestImpact {
    /// Stiffness of that foam, in N/m.
    pub stiffness: f64,
    /// Closing speed, in m/s.
    pub closing_speed: f64,
}

/// Largest value in a bracket around a single peak, which may be a kink.
fn golden(function: &impl Fn(f64) -> Result<f64>, from: f64, to: f64) -> Result<[f64; 2]> {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (from, to);
    let mut left = high - share * (high - low);
    let mut right = low + share * (high - low);
    let (mut left_value, mut right_value) = (function(left)?, function(right)?);
    while high - low > 1e-13 * high {
        if left_value > right_value {
            high = right;
            (right, right_value) = (left, left_value);
            left = high - share * (high - low);
            left_value = function(left)?;
        } else {
            low = left;
            (left, left_value) = (right, right_value);
            right = low + share * (high - low);
            right_value = function(right)?;
        }
        if left >= right {
            break;
        }
    }
    Ok(if left_value > right_value {
        [left, left_value]
    } else {
        [right, right_value]
    })
}
