//! Caps of `x = (ds/dt)^2` on the intervals of a path: joints, the path itself, contacts.

use numeric::error::{Failure, Given, Result};
use numeric::parallel::{Work, each_run};

use super::contact::{Hardest, PathContact};
use super::path::JointPath;
use crate::arm::model::sized;
use crate::arm::pose::{Pose, Singular, singular};

/// Places of an interval, both ends among them, where a motion is checked.
pub const CHECKED: usize = 16;

/// Places of an interval, both ends among them, that give its cap by contacts.
const SEEN: usize = 5;

/// Intervals that a thread does before it takes others.
const BLOCK: usize = 16;

/// Contacts on an interval.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Largest `x` of the interval by contacts.
    pub cap: f64,
    /// The hardest limit on the interval.
    pub limit: Option<usize>,
    /// Loads at the places where the motion is checked.
    pub loads: [f64; CHECKED],
}

/// Place of a number of even places on an interval of a length.
#[must_use]
pub fn way(place: usize, places: usize, length: f64) -> f64 {
    length * place as f64 / (places - 1) as f64
}

/// Largest `x` of each interval by the velocities of the joints, and the joint that gives it.
///
/// # Errors
/// A joint moves too little or too much for a number.
pub fn by_velocity(path: &JointPath, velocity: &[f64]) -> Result<Vec<(f64, usize)>> {
    let of = |index: usize| {
        let piece = path.piece(index);
        let mut found = (0.0_f64, 0);
        for (joint, limit) in velocity.iter().enumerate() {
            let rate = piece
                .tangents(joint)
                .iter()
                .fold(0.0_f64, |most, rate| most.max(rate.abs()));
            if rate / limit > found.0 {
                found = (rate / limit, joint);
            }
        }
        let cap = (found.0 * found.0).recip();
        if cap.is_normal() {
            Ok((cap, found.1))
        } else {
            let rule = "move joints by an amount that fits the length of the interval";
            let given = Given::Number(found.0);
            Err(Failure::invalid(
                format!("coefficients[{index}]"),
                rule,
                given,
            ))
        }
    };
    (0..path.intervals()).map(of).collect()
}

/// Contacts on all intervals: caps hold between the places, too, by the second differences of the loads.
///
/// # Errors
/// Path and arm have different joints, a locked joint moves, the mass matrix of a pose is singular, the caller asked to
/// stop.
pub fn by_contact(path: &JointPath, contact: &PathContact, work: Work<'_>) -> Result<Vec<Touch>> {
    if path.joints() != contact.arm.joints.len() {
        let given = Given::Count(path.joints() as u64);
        return Err(Failure::invalid(
            "coefficients",
            "hold all joints of the arm",
            given,
        ));
    }
    contact.check_locked(|joint| {
        let mut intervals = 0..path.intervals();
        intervals.any(|index| path.piece(index).tangents(joint) != [0.0; 3])
    })?;
    let blocks = path.intervals().div_ceil(BLOCK);
    let found = sized!(contact.arm, SIZE => each_run(blocks, work, |block| {
        let mut pose = Pose::<SIZE>::new(&contact.arm);
        let intervals = block * BLOCK..path.intervals().min((block + 1) * BLOCK);
        intervals.map(|index| touch(path, index, contact, &mut pose)).collect::<Result<Vec<_>>>()
    }))?;
    Ok(found.concat())
}

/// Contacts on one interval.
fn touch<const N: usize>(
    path: &JointPath,
    index: usize,
    contact: &PathContact,
    pose: &mut Pose<'_, N>,
) -> Result<Touch> {
    let piece = path.piece(index);
    let span = [path.nodes()[index], path.nodes()[index + 1]];
    let (mut values, mut rates) = (vec![0.0; path.joints()], vec![0.0; path.joints()]);
    let mut at = |way: f64| -> Result<Hardest> {
        piece.place(way, &mut values);
        piece.rates(way, &mut rates);
        pose.set(&values).map_err(|Singular { column }| {
            singular(&contact.arm, column, &format!(" on interval {index}"))
        })?;
        Ok(contact.hardest(pose, &rates, span))
    };
    let mut checked = [Hardest::default(); CHECKED];
    for (place, found) in checked.iter_mut().enumerate() {
        *found = at(way(place, CHECKED, piece.length))?;
    }
    let mut seen = [checked[0]; SEEN];
    for (place, found) in seen.iter_mut().enumerate().take(SEEN - 1).skip(1) {
        *found = at(way(place, SEEN, piece.length))?;
    }
    seen[SEEN - 1] = checked[CHECKED - 1];
    let all = seen.iter().chain(&checked);
    let hardest = all.fold(Hardest::default(), |most, other| {
        if other.load > most.load || most.limit.is_none() {
            *other
        } else {
            most
        }
    });
    Ok(Touch {
        cap: cap(&seen.map(|place| place.load)),
        limit: hardest.limit,
        loads: checked.map(|place| place.load),
    })
}

/// Largest `x` for loads at even places: between them a load is above by an eighth of its second difference at most.
fn cap(loads: &[f64; SEEN]) -> f64 {
    let most = loads.iter().fold(0.0_f64, |most, load| most.max(*load));
    if most == f64::INFINITY {
        return 0.0;
    }
    let bends = loads
        .windows(3)
        .map(|three| (three[0] - 2.0 * three[1] + three[2]).abs());
    (most + bends.fold(0.0, f64::max) / 8.0).recip()
}
