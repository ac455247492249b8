//! Motions of an arm without a program: all within the velocities of its joints.

use std::f64::consts::{PI, TAU};

use numeric::error::{Failure, Given, Result, at_most, positive};
use numeric::random::Stream;

use crate::arm::{Arm, JointKind};

/// Most draws.
pub const MOST_DRAWS: usize = 1_000_000;

/// Values and rates of all joints by draws: values uniform between the limits, a joint that turns without limits within
/// one turn; rates with `sum (dq_j/v_j)^2 = 1`, all directions alike. A locked joint rests at the value nearest to 0.
///
/// # Errors
/// There are too many draws, velocities do not fit the arm, nothing moves, or a joint slides without limits.
pub fn draws(arm: &Arm, velocity: &[f64], count: usize, seed: u64) -> Result<[Vec<f64>; 2]> {
    at_most("count", count, MOST_DRAWS)?;
    if velocity.len() != arm.joints.len() {
        let given = Given::Count(velocity.len() as u64);
        return Err(Failure::invalid(
            "velocity",
            "hold a number for each joint of the arm",
            given,
        ));
    }
    if arm.free == 0 {
        let found = Given::Found("none".into());
        return Err(Failure::invalid("arm", "have a joint that moves", found));
    }
    let mut ranges = Vec::with_capacity(velocity.len());
    for (joint, limit) in arm.joints.iter().zip(velocity) {
        positive(&format!("velocity[{:?}]", joint.name), *limit)?;
        let [low, high] = joint.limits;
        let limited = [low, high].map(f64::is_finite);
        ranges.push(match (joint.column, joint.kind, limited) {
            (None, ..) => [0.0_f64.max(low).min(high); 2],
            (_, _, [true, true]) => [low, high],
            (_, JointKind::Turning, [true, false]) => [low, low + TAU],
            (_, JointKind::Turning, [false, true]) => [high - TAU, high],
            (_, JointKind::Turning, _) => [-PI, PI],
            (_, JointKind::Sliding, _) => {
                let found = Given::Found("none".into());
                let name = format!("limits of joint {:?}", joint.name);
                return Err(Failure::invalid(name, "be finite where it slides", found));
            }
        });
    }
    let (mut values, mut rates) = (Vec::new(), Vec::new());
    for draw in 0..count as u64 {
        let mut stream = Stream::new(seed, draw);
        values.extend(ranges.iter().map(|[low, high]| stream.uniform(*low, *high)));
        let mut normals = Vec::with_capacity(velocity.len() + 1);
        while normals.len() < velocity.len() {
            normals.extend(stream.normals());
        }
        let free = arm
            .joints
            .iter()
            .map(|joint| f64::from(u8::from(joint.column.is_some())));
        let parts: Vec<f64> = normals
            .into_iter()
            .zip(free)
            .map(|(part, free)| part * free)
            .collect();
        let size = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
        // All parts are zero once in 2^1000 draws.
        let scale = if size > 0.0 { size.recip() } else { 0.0 };
        rates.extend(
            parts
                .iter()
                .zip(velocity)
                .map(|(part, limit)| part * scale * limit),
        );
    }
    Ok([values, rates])
}
