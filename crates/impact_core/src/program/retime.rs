//! The fastest motion along a path, verified between its nodes.

use numeric::error::{Failure, Given, Result, positive, proceed};
use numeric::parallel::Work;

use super::bounds::{CHECKED, Touch, by_contact, by_velocity, way};
use super::contact::PathContact;
use super::path::JointPath;
use super::profile::{fastest, times};
use super::strips::coefficients;

/// Most rounds of caps that are lowered.
const MOST_ROUNDS: usize = 5;

/// A share above this exceeds its limit.
const EXCEEDED: f64 = 1.0 + 1e-6;

/// Largest change of the tangent at a node that is passed, as a share of its length by velocities: turns of 1e-3 rad
/// are below it in any unit.
const LARGEST_TURN: f64 = 2e-3;

/// Shares that differ by less are equal.
const EQUAL: f64 = 1e-6;

/// Limits of a motion.
#[derive(Clone, Copy, Debug)]
pub struct MotionLimits<'a> {
    /// Velocities of the joints.
    pub velocity: &'a [f64],
    /// Accelerations of the joints, infinite without a limit.
    pub acceleration: &'a [f64],
    /// Inner nodes where the motion rests, rising.
    pub stops: &'a [usize],
    /// Largest `ds/dt` on each interval, infinite without a limit.
    pub path_speed: Option<&'a [f64]>,
    /// Contacts along the path.
    pub contact: Option<&'a PathContact>,
}

/// Whether the motion keeps its limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verification {
    /// At all places that were checked.
    Verified,
    /// Not at all of them.
    NotVerified,
    /// Some limit allows no motion.
    Standstill,
}

impl Verification {
    /// The word of a status.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Verified => "verified",
            Self::NotVerified => "not_verified",
            Self::Standstill => "standstill",
        }
    }
}

/// The limit that an interval uses most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// Acceleration of a joint.
    Acceleration(usize),
    /// Velocity of a joint.
    Velocity(usize),
    /// A row of the contacts.
    Contact(usize),
    /// Speed of the path.
    PathSpeed,
}

/// A motion along a path.
#[derive(Clone, Debug)]
pub struct Retimed {
    /// Whether the run keeps its limits.
    pub status: Verification,
    /// Rounds until then.
    pub rounds: usize,
    /// Times at the nodes (s).
    pub times: Vec<f64>,
    /// `(ds/dt)^2` at the nodes.
    pub squares: Vec<f64>,
    /// Largest shares of the limits of accelerations, velocities and contacts on each interval.
    pub shares: Vec<[f64; 3]>,
    /// The limit that each interval uses most.
    pub reasons: Vec<Reason>,
    /// The hardest contact on each interval, whether it governs or not.
    pub contacts: Vec<Option<usize>>,
}

/// Caps of `x` on one interval.
#[derive(Clone, Copy)]
struct Caps {
    velocity: f64,
    joint: usize,
    contact: f64,
    path: f64,
}

impl Caps {
    fn least(&self) -> f64 {
        self.velocity.min(self.contact).min(self.path)
    }
}

/// The fastest motion from rest to rest.
///
/// # Errors
/// Limits do not fit the path or are out of range, the path turns without a stop, stops are neighbors, errors of the
/// contacts, or the caller asked to stop.
pub fn retime(path: &JointPath, limits: &MotionLimits<'_>, work: Work<'_>) -> Result<Retimed> {
    check(path, limits)?;
    let touches = match limits.contact {
        Some(contact) => by_contact(path, contact, work)?,
        None => Vec::new(),
    };
    let mut caps: Vec<Caps> = by_velocity(path, limits.velocity)?
        .into_iter()
        .enumerate()
        .map(|(index, (velocity, joint))| Caps {
            velocity,
            joint,
            contact: touches.get(index).map_or(f64::INFINITY, |touch| touch.cap),
            path: limits
                .path_speed
                .map_or(f64::INFINITY, |speeds| speeds[index] * speeds[index]),
        })
        .collect();
    let mut rounds = 0;
    loop {
        rounds += 1;
        let tops = tops(&caps, limits.stops);
        let squares = fastest(path, limits.acceleration, &tops, work.interrupted)?;
        let shares = shares(path, limits, &touches, &squares, work)?;
        let stands = squares.windows(2).any(|pair| pair == [0.0; 2]);
        let kept = !lower(&mut caps, &shares, &touches);
        if stands || kept || rounds == MOST_ROUNDS {
            let status = match (stands, kept) {
                (true, _) => Verification::Standstill,
                (false, true) => Verification::Verified,
                (false, false) => Verification::NotVerified,
            };
            let reasons = (0..path.intervals())
                .map(|index| reason(path, limits, index, (&caps[index], &touches), &squares))
                .collect();
            return Ok(Retimed {
                status,
                rounds,
                times: times(path, &squares),
                squares,
                shares,
                reasons,
                contacts: touches.iter().map(|touch| touch.limit).collect(),
            });
        }
    }
}

/// Largest `x` at the nodes: the smaller cap of both sides, none at stops.
fn tops(caps: &[Caps], stops: &[usize]) -> Vec<f64> {
    let mut found = vec![0.0; caps.len() + 1];
    for (node, pair) in caps.windows(2).enumerate() {
        found[node + 1] = pair[0].least().min(pair[1].least());
    }
    for stop in stops {
        found[*stop] = 0.0;
    }
    found
}

/// Lowers the caps of intervals that exceed a limit; whether there were any.
fn lower(caps: &mut [Caps], shares: &[[f64; 3]], touches: &[Touch]) -> bool {
    let mut lowered = false;
    for (index, (cap, shares)) in caps.iter_mut().zip(shares).enumerate() {
        let [acceleration, velocity, contact] = shares.map(|share| {
            lowered |= share > EXCEEDED;
            if share > EXCEEDED { share * share } else { 1.0 }
        });
        cap.velocity /= velocity * acceleration;
        cap.contact /= contact;
        // The cap may lie far above the motion, where a share of it changes nothing.
        if let Some(touch) = touches.get(index).filter(|_| contact > 1.0) {
            let most = touch
                .loads
                .iter()
                .fold(0.0_f64, |most, load| most.max(*load));
            cap.contact = cap.contact.min(most.recip());
        }
    }
    lowered
}

/// Largest shares of accelerations, velocities and contacts at the places of every interval.
fn shares(
    path: &JointPath,
    limits: &MotionLimits<'_>,
    touches: &[Touch],
    squares: &[f64],
    work: Work<'_>,
) -> Result<Vec<[f64; 3]>> {
    let mut found = Vec::with_capacity(path.intervals());
    for (index, pair) in squares.windows(2).enumerate() {
        if index % 1024 == 0 {
            proceed(work.interrupted)?;
        }
        let piece = path.piece(index);
        let rise = 0.5 * (pair[1] - pair[0]) / piece.length;
        let x: [f64; CHECKED] =
            std::array::from_fn(|place| way(place, CHECKED, pair[1] - pair[0]) + pair[0]);
        let mut most = [0.0_f64; 3];
        let limits = limits.acceleration.iter().zip(limits.velocity);
        for (joint, (acceleration, velocity)) in limits.enumerate() {
            let [_, q1, q2, q3] = piece.powers(joint);
            let mut largest = [0.0_f64; 2];
            for (place, x) in x.iter().enumerate() {
                let way = way(place, CHECKED, piece.length);
                let rate = q1 + way * (2.0 * q2 + 3.0 * way * q3);
                let bend = 2.0 * q2 + 6.0 * way * q3;
                largest[0] = largest[0].max((rate * rise + bend * x).abs());
                largest[1] = largest[1].max(rate * rate * x);
            }
            most[0] = most[0].max(largest[0] / acceleration);
            most[1] = most[1].max(largest[1].sqrt() / velocity);
        }
        if let Some(touch) = touches.get(index) {
            // A load may be infinite where nothing moves.
            let moving = x.iter().zip(&touch.loads).filter(|(x, _)| **x > 0.0);
            most[2] = moving
                .fold(0.0_f64, |most, (x, load)| most.max(x * load))
                .sqrt();
        }
        found.push(most);
    }
    Ok(found)
}

/// The limit that an interval uses most: a contact before a velocity before the path before an acceleration where
/// shares are equal.
fn reason(
    path: &JointPath,
    limits: &MotionLimits<'_>,
    index: usize,
    (caps, touches): (&Caps, &[Touch]),
    squares: &[f64],
) -> Reason {
    let piece = path.piece(index);
    let ends = [squares[index], squares[index + 1]];
    let rise = 0.5 * (ends[1] - ends[0]) / piece.length;
    let most = ends[0].max(ends[1]);
    let share = |cap: f64| if cap > 0.0 { (most / cap).sqrt() } else { 1.0 };
    let mut found = (share(caps.velocity), Reason::Velocity(caps.joint));
    let path_share = share(caps.path);
    if path_share > found.0 + EQUAL {
        found = (path_share, Reason::PathSpeed);
    }
    for (joint, limit) in limits.acceleration.iter().enumerate() {
        for [p, r] in coefficients(&piece, joint) {
            let share = (p * rise + r * ends[0]).abs() / limit;
            if share > found.0 + EQUAL {
                found = (share, Reason::Acceleration(joint));
            }
        }
    }
    let contact = touches.get(index).and_then(|touch| touch.limit);
    match contact {
        Some(limit) if share(caps.contact) + EQUAL >= found.0 => Reason::Contact(limit),
        _ => found.1,
    }
}

fn check(path: &JointPath, limits: &MotionLimits<'_>) -> Result<()> {
    let joints = path.joints();
    for (name, values) in [
        ("velocity", limits.velocity),
        ("acceleration", limits.acceleration),
    ] {
        if values.len() != joints {
            let given = Given::Count(values.len() as u64);
            return Err(Failure::invalid(
                name,
                "hold a number for each joint of the path",
                given,
            ));
        }
    }
    for (joint, limit) in limits.velocity.iter().enumerate() {
        positive(&format!("velocity[{joint}]"), *limit)?;
    }
    for (joint, limit) in limits.acceleration.iter().enumerate() {
        if limit.is_nan() || *limit <= 0.0 {
            let name = format!("acceleration[{joint}]");
            return Err(Failure::invalid(name, "be positive", Given::Number(*limit)));
        }
    }
    if let Some(speeds) = limits.path_speed {
        if speeds.len() != path.intervals() {
            let given = Given::Count(speeds.len() as u64);
            return Err(Failure::invalid(
                "path_speed",
                "hold a number for each interval",
                given,
            ));
        }
        if let Some(speed) = speeds.iter().find(|speed| speed.is_nan() || **speed < 0.0) {
            return Err(Failure::invalid(
                "path_speed",
                "be at least 0",
                Given::Number(*speed),
            ));
        }
    }
    check_stops(path, limits.stops)?;
    check_turns(path, limits)
}

/// Refuses stops that are no inner nodes, and intervals between two of them: they would never be left.
fn check_stops(path: &JointPath, stops: &[usize]) -> Result<()> {
    let mut before = 0;
    for stop in stops.iter().copied().chain([path.intervals()]) {
        if stop < before + 2 || stop > path.intervals() {
            let rule = "be inner nodes that rise, with another node between two stops, the start and the end; refine \
                        the path";
            return Err(Failure::invalid("stops", rule, Given::Count(stop as u64)));
        }
        before = stop;
    }
    Ok(())
}

/// Refuses a jump of the tangent at a node that is passed: no acceleration is enough for it.
fn check_turns(path: &JointPath, limits: &MotionLimits<'_>) -> Result<()> {
    let mut next = limits.stops.iter().copied().peekable();
    for node in 1..path.intervals() {
        if next.next_if_eq(&node).is_some() {
            continue;
        }
        let (before, after) = (path.piece(node - 1), path.piece(node));
        let (mut jump, mut size) = (0.0, 0.0);
        for (joint, limit) in limits.velocity.iter().enumerate() {
            let end = before.tangents(joint)[2] / limit;
            let start = after.tangents(joint)[0] / limit;
            jump += (start - end) * (start - end);
            size += (start * start).max(end * end);
        }
        if jump.sqrt() > LARGEST_TURN * f64::sqrt(size) {
            let given = Given::Found(format!("a jump of the tangent at node {node}").into());
            let failure =
                Failure::invalid("stops", "hold all nodes where the tangent jumps", given);
            return Err(failure.mended_by("stop there, or put in a blend"));
        }
    }
    Ok(())
}
