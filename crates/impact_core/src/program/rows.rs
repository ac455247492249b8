//! Masses and allowed speeds of all points at waypoints: rows of numbers over all cores.

use numeric::error::{Failure, Given, Result, at_most};
use numeric::parallel::{Work, each_run};

use super::contact::PathContact;
use super::masses::PointMotion;
use crate::arm::model::sized;
use crate::arm::pose::{Pose, Singular, singular};

/// Waypoints that a thread does before it takes others.
const BLOCK: usize = 64;

/// Most results of one call.
pub const MOST_RESULTS: usize = 100_000_000;

/// Values and rates of all joints at waypoints.
#[derive(Clone, Copy, Debug)]
pub struct Waypoints<'a> {
    /// Values by rows.
    pub joints: &'a [f64],
    /// Rates by rows, of any length.
    pub rates: &'a [f64],
    /// Place of each row on the path.
    pub places: &'a [f64],
    /// Whether values have to keep the limits of the joints.
    pub check_limits: bool,
}

/// Allowed speeds of all points, by waypoints.
#[derive(Clone, Debug, Default)]
pub struct AllowedSpeeds {
    /// Speed of each point (m/s).
    pub speed: Vec<f64>,
    /// The least of the allowed speeds of each point (m/s), infinite without a limit.
    pub lowest: Vec<f64>,
    /// Its limit, if there is one.
    pub governs: Vec<Option<usize>>,
    /// Allowed speed by each limit (m/s), if asked for.
    pub every: Vec<f64>,
}

impl PathContact {
    /// Motions of all points, by waypoints.
    ///
    /// # Errors
    /// Numbers do not fit each other, are not finite or outside the limits of their joints, a locked joint moves, the
    /// mass matrix of a pose is singular, or the caller asked to stop.
    pub fn motions(&self, waypoints: &Waypoints<'_>, work: Work<'_>) -> Result<Vec<PointMotion>> {
        let count = self.count(waypoints)?;
        at_most(
            "joints",
            count.saturating_mul(self.points.len()),
            MOST_RESULTS / 10,
        )?;
        let blocks = sized!(self.arm, SIZE => self.each::<SIZE, _>(waypoints, count, work, |block: &mut Vec<PointMotion>, _, motions| {
            block.extend_from_slice(motions);
        }))?;
        Ok(blocks.concat())
    }

    /// Allowed speeds of all points, by waypoints, and of every limit if asked for.
    ///
    /// # Errors
    /// Errors of `motions`.
    pub fn allowed(
        &self,
        waypoints: &Waypoints<'_>,
        every: bool,
        work: Work<'_>,
    ) -> Result<AllowedSpeeds> {
        let count = self.count(waypoints)?;
        let width = if every {
            self.limits.len()
        } else {
            self.points.len()
        };
        at_most("joints", count.saturating_mul(width), MOST_RESULTS)?;
        let blocks = sized!(self.arm, SIZE => {
            self.each::<SIZE, AllowedSpeeds>(waypoints, count, work, |block, place, motions| {
                self.add(block, place, motions, every);
            })
        })?;
        let mut found = AllowedSpeeds::default();
        for block in blocks {
            found.speed.extend(block.speed);
            found.lowest.extend(block.lowest);
            found.governs.extend(block.governs);
            found.every.extend(block.every);
        }
        Ok(found)
    }

    /// Adds the allowed speeds at one waypoint.
    fn add(&self, block: &mut AllowedSpeeds, place: f64, motions: &[PointMotion], every: bool) {
        let start = block.speed.len();
        block
            .speed
            .extend(motions.iter().map(|motion| motion.speed));
        block.lowest.resize(start + motions.len(), f64::INFINITY);
        block.governs.resize(start + motions.len(), None);
        for (row, limit) in self.limits.iter().enumerate() {
            let motion = &motions[limit.point];
            let counts = motion.speed > 0.0 && limit.counts([place; 2]);
            let allowed = if counts {
                self.allowed_speed(limit, motion)
            } else {
                f64::INFINITY
            };
            let point = start + limit.point;
            if allowed < block.lowest[point] {
                block.lowest[point] = allowed;
                block.governs[point] = Some(row);
            }
            if every {
                block.every.push(allowed);
            }
        }
    }

    /// Checks the waypoints and counts them.
    fn count(&self, waypoints: &Waypoints<'_>) -> Result<usize> {
        let width = self.arm.joints.len();
        let (joints, rates) = (waypoints.joints, waypoints.rates);
        let count = waypoints.places.len();
        for (name, rows) in [("joints", joints), ("rates", rates)] {
            if rows.len() != count * width {
                let found = Given::Found(format!("{} numbers", rows.len()).into());
                return Err(Failure::invalid(
                    name,
                    "have a row of all joints for each waypoint",
                    found,
                ));
            }
        }
        for (name, values) in [("rates", rates), ("place", waypoints.places)] {
            if let Some(wrong) = values.iter().find(|value| !value.is_finite()) {
                return Err(Failure::invalid(name, "be finite", Given::Number(*wrong)));
            }
        }
        self.arm.check_joints(joints, waypoints.check_limits)?;
        self.check_locked(|joint| {
            rates
                .iter()
                .skip(joint)
                .step_by(width)
                .any(|rate| *rate != 0.0)
        })?;
        Ok(count)
    }

    /// Results of blocks of waypoints in order; `add` puts those of one to its block.
    fn each<const N: usize, T: Send + Default>(
        &self,
        waypoints: &Waypoints<'_>,
        count: usize,
        work: Work<'_>,
        add: impl Fn(&mut T, f64, &[PointMotion]) + Sync,
    ) -> Result<Vec<T>> {
        let width = self.arm.joints.len();
        each_run(count.div_ceil(BLOCK), work, |index| {
            let mut pose = Pose::<N>::new(&self.arm);
            let mut motions = Vec::with_capacity(self.points.len());
            let mut block = T::default();
            for row in index * BLOCK..count.min((index + 1) * BLOCK) {
                let range = row * width..(row + 1) * width;
                let rates = &waypoints.rates[range.clone()];
                pose.set(&waypoints.joints[range])
                    .map_err(|Singular { column }| {
                        singular(&self.arm, column, &format!(" in joints[{row}]"))
                    })?;
                let weights = pose.weights(rates);
                motions.clear();
                motions.extend(
                    self.points.iter().map(|(link, point)| {
                        PointMotion::of(&pose, (*link, point), rates, &weights)
                    }),
                );
                add(&mut block, waypoints.places[row], &motions);
            }
            Ok(block)
        })
    }
}
