//! What the tests of the searches share: functions with known answers, and how they are searched.

use std::sync::atomic::{AtomicU64, Ordering};

use vff_core::error::Result;
use vff_core::search::{
    Bounds, Evaluation, GlobalMethod, GlobalOptions, GridOptions, Problem, SearchOptions,
};

/// A function by a closure that gives the value, the margins and whether it failed.
pub struct Function<F> {
    dimension: usize,
    constraints: usize,
    of: F,
    /// Points that were evaluated.
    pub calls: AtomicU64,
}

impl<F: Fn(&[f64]) -> (f64, Vec<f64>, bool) + Sync> Function<F> {
    pub fn new(dimension: usize, constraints: usize, of: F) -> Self {
        Self {
            dimension,
            constraints,
            of,
            calls: AtomicU64::new(0),
        }
    }
}

impl<F: Fn(&[f64]) -> (f64, Vec<f64>, bool) + Sync> Problem for Function<F> {
    fn dimension(&self) -> usize {
        self.dimension
    }
    fn constraints(&self) -> usize {
        self.constraints
    }
    fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()> {
        for (index, point) in points.chunks_exact(self.dimension).enumerate() {
            self.calls.fetch_add(1, Ordering::Relaxed);
            let (value, margins, failed) = (self.of)(point);
            into.values[index] = value;
            into.failed[index] = failed;
            into.margins[index * self.constraints..][..self.constraints].copy_from_slice(&margins);
        }
        Ok(())
    }
}

/// From 0 to 1 along every axis.
pub fn unit_box(dimension: usize) -> Bounds {
    Bounds::new(vec![0.0; dimension], vec![1.0; dimension]).unwrap()
}

/// A search on grids alone.
pub fn grid(shape: &[usize], refinements: usize, survivors: usize) -> SearchOptions {
    SearchOptions {
        grid: GridOptions {
            shape: shape.to_vec(),
            refinements,
            survivors,
            keep: 20,
        },
        local: None,
        threads: Some(2),
    }
}

/// Many local optima, the global one in a corner that a constraint cuts.
pub fn rippled(x: &[f64]) -> (f64, Vec<f64>, bool) {
    let wave = |v: f64| (v - 0.7) * (v - 0.7) - 0.02 * (40.0 * (v - 0.7)).cos();
    let value = -x.iter().map(|v| wave(*v)).sum::<f64>();
    (value, vec![0.65 - x[0]], x[1] > 0.99)
}

/// Two bowls whose compromises are the segment between their centers.
pub struct Bowls;

impl Problem for Bowls {
    fn dimension(&self) -> usize {
        2
    }
    fn objectives(&self) -> usize {
        2
    }
    fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()> {
        let rows = points.chunks_exact(2).zip(into.values.chunks_exact_mut(2));
        for (x, value) in rows {
            let away = |a: f64, b: f64| (x[0] - a).powi(2) + (x[1] - b).powi(2);
            value[0] = -away(0.2, 0.5);
            value[1] = -away(0.8, 0.5);
        }
        Ok(())
    }
}

/// A search of eight islands.
pub fn global(method: GlobalMethod, threads: usize) -> GlobalOptions {
    GlobalOptions {
        method,
        evaluations: 24_001,
        islands: 8,
        seed: 5,
        threads: Some(threads),
    }
}
