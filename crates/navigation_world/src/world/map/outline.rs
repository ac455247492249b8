//! Outlines of filled polygons.

use nalgebra::Vector2;
use numeric::order::sort_indices;

use crate::world::map::capsule::Capsule;
use crate::world::map::index::{BoundingBox, Index};
use numeric::error::{Failure, Given, Result, finite_pair};

/// Edges of a filled polygon, counter-clockwise.
pub(super) fn outline(points: &[[f64; 2]]) -> Result<Vec<Capsule>> {
    for (index, point) in points.iter().enumerate() {
        finite_pair(&format!("point {index}"), *point)?;
    }
    if points.len() < 3 {
        let rule = "have three points at least";
        let given = Given::Count(points.len() as u64);
        let advice = "two points make a polyline";
        return Err(Failure::invalid("points", rule, given).mended_by(advice));
    }
    let edge = |index: usize| {
        let next = (index + 1) % points.len();
        let mut edge = Capsule::wall(points[index].into(), points[next].into(), 0.0);
        edge.filled = true;
        edge
    };
    let mut edges: Vec<Capsule> = (0..points.len()).map(edge).collect();
    if let Some(index) = edges.iter().position(|edge| edge.from == edge.to) {
        let rule = format!(
            "have different neighbors, unlike points {index} and {}",
            (index + 1) % points.len()
        );
        let advice = "the first point is not repeated at the end";
        return Err(Failure::invalid("points", rule, Given::Pair(points[index])).mended_by(advice));
    }
    check_corners(points)?;
    check_simple(&edges)?;
    if doubled_area(&edges) < 0.0 {
        for edge in &mut edges {
            std::mem::swap(&mut edge.from, &mut edge.to);
        }
    }
    Ok(edges)
}

/// Twice the area in m^2, positive counter-clockwise.
fn doubled_area(edges: &[Capsule]) -> f64 {
    let Some(first) = edges.first().map(|edge| edge.from) else {
        return 0.0;
    };
    let part = |edge: &Capsule| (edge.from - first).perp(&(edge.to - first));
    edges.iter().map(part).sum()
}

/// Checks that no two corners are the same point.
fn check_corners(points: &[[f64; 2]]) -> Result<()> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let mut before = |one: &usize, two: &usize| {
        let ([x, y], [u, v]) = (points[*one], points[*two]);
        x.total_cmp(&u).then(y.total_cmp(&v)).then(one.cmp(two))
    };
    sort_indices(&mut order, &mut before);
    let twice = order
        .windows(2)
        .find(|pair| points[pair[0]] == points[pair[1]]);
    let Some(pair) = twice else {
        return Ok(());
    };
    let rule = "be the corners of an outline that neither touches nor crosses itself";
    let given = Given::Pair(points[pair[0]]);
    let advice = format!("points {} and {} are the same", pair[0], pair[1]);
    Err(Failure::invalid("points", rule, given).mended_by(advice))
}

/// Checks that edges meet only where one follows the other.
fn check_simple(edges: &[Capsule]) -> Result<()> {
    let index = Index::new(edges.to_vec());
    for (place, edge) in edges.iter().enumerate() {
        let around = BoundingBox::of_segment(edge.from, edge.to);
        let mut crossed = None;
        index.visit(
            0.0,
            |bounds| (around.distance_squared_of(bounds) == 0.0).then_some(0.0),
            |_, other, limit| {
                if meets(edge, other) {
                    crossed = Some(crossing_of(edge, other));
                }
                limit
            },
        );
        if let Some(point) = crossed {
            let rule = "be the corners of an outline that neither touches nor crosses itself";
            let given = Given::Pair(point.into());
            let advice = format!("edge {place} meets another one near this point");
            return Err(Failure::invalid("points", rule, given).mended_by(advice));
        }
    }
    Ok(())
}

/// Whether two edges meet elsewhere than at the corner that one shares with the next.
fn meets(edge: &Capsule, other: &Capsule) -> bool {
    if edge == other {
        return false;
    }
    let shared = if edge.to == other.from {
        (edge.from - edge.to, other.to - other.from)
    } else if other.to == edge.from {
        (edge.to - edge.from, other.from - other.to)
    } else {
        return edge.crosses(other);
    };
    // Neighbors that fold back lie on one line, on the same side of their corner.
    shared.0.perp(&shared.1) == 0.0 && shared.0.dot(&shared.1) > 0.0
}

fn crossing_of(edge: &Capsule, other: &Capsule) -> Vector2<f64> {
    let (along, across) = (edge.to - edge.from, other.to - other.from);
    let turn = along.perp(&across);
    if turn == 0.0 {
        return edge.from;
    }
    edge.from + along * ((other.from - edge.from).perp(&across) / turn)
}
