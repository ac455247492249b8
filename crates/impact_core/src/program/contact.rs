//! Points of an arm with the limits of their contacts, and the hardest of them in a motion.

use nalgebra::Vector3;
use numeric::error::{Failure, Given, Result, not_negative, positive};

use super::masses::PointMotion;
use crate::arm::Arm;
use crate::arm::pose::Pose;

/// Most rows of limits.
pub const MOST_LIMITS: usize = 100_000;

/// The mass of the robot that counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassRule {
    /// The larger one of both.
    Larger,
    /// That of ISO/TS 15066.
    Iso,
    /// The effective mass of the motion.
    Directional,
}

/// The normal of the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactNormal {
    /// Along the motion of the point.
    Motion,
    /// The worst one.
    Worst,
}

/// Allowed closing speed over the reduced mass at some masses.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedTable {
    masses: Vec<f64>,
    speeds: Vec<f64>,
}

impl SpeedTable {
    /// A table with rising masses; the last one may be infinite.
    ///
    /// # Errors
    /// There is no mass, masses do not rise, a speed is below zero or no number.
    pub fn new(masses: Vec<f64>, speeds: Vec<f64>) -> Result<Self> {
        let rising = masses.iter().all(|mass| !mass.is_nan())
            && masses.windows(2).all(|pair| pair[0] < pair[1]);
        if masses.is_empty() || masses.len() != speeds.len() || !rising || masses[0] <= 0.0 {
            let found =
                Given::Found(format!("{} masses, {} speeds", masses.len(), speeds.len()).into());
            return Err(Failure::invalid(
                "tables",
                "hold a speed for each of rising masses",
                found,
            ));
        }
        if let Some(speed) = speeds.iter().find(|speed| speed.is_nan() || **speed < 0.0) {
            return Err(Failure::invalid(
                "tables",
                "hold speeds of at least 0",
                Given::Number(*speed),
            ));
        }
        Ok(Self { masses, speeds })
    }

    /// The slower one of the neighbors of a mass; below all masses that of the first, above them none.
    #[must_use]
    pub fn speed(&self, mass: f64) -> f64 {
        let above = self.masses.partition_point(|other| *other < mass);
        let Some(upper) = self.speeds.get(above) else {
            return 0.0;
        };
        upper.min(self.speeds[above.saturating_sub(1)])
    }
}

/// The limit of a contact of one point: with a region in a class of contact, or a speed as it is.
#[derive(Clone, Copy, Debug)]
pub struct PointLimit {
    /// The point.
    pub point: usize,
    /// Energy that covering and region store at their limits (J), infinite without such a limit.
    pub energy: f64,
    /// Mass of the region (kg), infinite where it is clamped.
    pub body_mass: f64,
    /// Speed of the human towards the point (m/s).
    pub human_speed: f64,
    /// Largest speed of the point (m/s), infinite without such a limit.
    pub speed: f64,
    /// A table of allowed closing speeds.
    pub table: Option<usize>,
    /// Range of the path where the limit counts.
    pub range: [f64; 2],
}

/// Points of an arm with the limits of their contacts.
#[derive(Clone, Debug)]
pub struct PathContact {
    /// The arm.
    pub arm: Arm,
    /// Links and places on them (m).
    pub points: Vec<(usize, Vector3<f64>)>,
    /// The limits.
    pub limits: Vec<PointLimit>,
    /// Tables of closing speeds.
    pub tables: Vec<SpeedTable>,
    /// The mass that counts.
    pub rule: MassRule,
    /// The normal that counts.
    pub normal: ContactNormal,
    /// Mass of the robot by ISO/TS 15066 (kg).
    pub iso_mass: f64,
    /// Limits of each point that may be the hardest one.
    decisive: Vec<Vec<usize>>,
}

/// The hardest limit at a place of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hardest {
    /// Square of the speed of its point for `ds/dt = 1` as a share of the allowed one.
    pub load: f64,
    /// The limit.
    pub limit: Option<usize>,
}

impl PathContact {
    /// Points and their limits.
    ///
    /// # Errors
    /// A number is out of range, or a row names a point or a table that there is not.
    pub fn new(
        arm: Arm,
        points: Vec<(usize, Vector3<f64>)>,
        limits: Vec<PointLimit>,
        tables: Vec<SpeedTable>,
        (rule, normal, iso_mass): (MassRule, ContactNormal, f64),
    ) -> Result<Self> {
        positive("iso_mass", iso_mass)?;
        numeric::error::at_most("limits", limits.len(), MOST_LIMITS)?;
        for (row, limit) in limits.iter().enumerate() {
            let named = |failure: Failure| failure.within(&format!("limits[{row}]"));
            check(limit, points.len(), tables.len()).map_err(named)?;
        }
        for (_, point) in &points {
            if let Some(wrong) = point.iter().find(|value| !value.is_finite()) {
                return Err(Failure::invalid(
                    "points",
                    "be finite",
                    Given::Number(*wrong),
                ));
            }
        }
        let decisive = decisive(&limits, points.len());
        Ok(Self {
            arm,
            points,
            limits,
            tables,
            rule,
            normal,
            iso_mass,
            decisive,
        })
    }

    /// Reduced mass of the robot at a point and a body (kg).
    #[must_use]
    pub fn reduced_mass(&self, motion: &PointMotion, body_mass: f64) -> f64 {
        let iso = || (self.iso_mass.recip() + body_mass.recip()).recip();
        let directional = || match self.normal {
            ContactNormal::Motion => motion.reduced_along(body_mass),
            ContactNormal::Worst => motion.reduced_worst(body_mass),
        };
        match self.rule {
            MassRule::Larger => iso().max(directional()),
            MassRule::Iso => iso(),
            MassRule::Directional => directional(),
        }
    }

    /// Allowed speed of a point that moves (m/s), infinite without a limit.
    #[must_use]
    pub fn allowed_speed(&self, limit: &PointLimit, motion: &PointMotion) -> f64 {
        let mut found = limit.speed;
        if limit.energy < f64::INFINITY || limit.table.is_some() {
            let mass = self.reduced_mass(motion, limit.body_mass);
            let mut closing = (2.0 * limit.energy / mass).sqrt();
            if let Some(table) = limit.table {
                closing = closing.min(self.tables[table].speed(mass));
            }
            found = found.min(closing - limit.human_speed);
        }
        found.max(0.0)
    }

    /// The hardest limit that counts between two places of the path, for rates by `s`.
    #[must_use]
    pub fn hardest<const N: usize>(
        &self,
        pose: &Pose<'_, N>,
        rates: &[f64],
        span: [f64; 2],
    ) -> Hardest {
        let weights = pose.weights(rates);
        let mut found = Hardest::default();
        for ((link, point), rows) in self.points.iter().zip(&self.decisive) {
            if rows.is_empty() {
                continue;
            }
            let motion = PointMotion::of(pose, (*link, point), rates, &weights);
            if motion.speed == 0.0 {
                continue;
            }
            for row in rows {
                let limit = &self.limits[*row];
                if !limit.counts(span) {
                    continue;
                }
                let share = motion.speed / self.allowed_speed(limit, &motion);
                let load = share * share;
                if load > found.load || found.limit.is_none() {
                    found = Hardest {
                        load,
                        limit: Some(*row),
                    };
                }
            }
        }
        found
    }

    /// Refuses motions of a locked joint: its mass would be missing.
    ///
    /// # Errors
    /// There is one.
    pub fn check_locked(&self, rates: impl Fn(usize) -> bool) -> Result<()> {
        for (index, joint) in self.arm.joints.iter().enumerate() {
            if joint.column.is_none() && rates(index) {
                let found = Given::Found("a motion of a locked joint".into());
                let name = format!("joint {:?}", joint.name);
                return Err(Failure::invalid(name, "stand still", found));
            }
        }
        Ok(())
    }
}

impl PointLimit {
    /// Whether the limit counts somewhere between two places of the path, or at one.
    #[must_use]
    pub fn counts(&self, [from, to]: [f64; 2]) -> bool {
        let [first, last] = self.range;
        if from == to {
            first <= from && from <= last
        } else {
            first < to && from < last
        }
    }
}

fn check(limit: &PointLimit, points: usize, tables: usize) -> Result<()> {
    if limit.point >= points {
        let given = Given::Count(limit.point as u64);
        return Err(Failure::invalid("point", "be one of the points", given));
    }
    if limit.table.is_some_and(|table| table >= tables) {
        let given = Given::Count(limit.table.unwrap_or_default() as u64);
        return Err(Failure::invalid("table", "be one of the tables", given));
    }
    not_negative("human_speed", limit.human_speed)?;
    let positive = [
        ("body_mass", limit.body_mass, limit.body_mass > 0.0),
        ("energy", limit.energy, limit.energy >= 0.0),
        ("speed", limit.speed, limit.speed >= 0.0),
        ("first", limit.range[0], !limit.range[0].is_nan()),
        ("last", limit.range[1], limit.range[1] >= limit.range[0]),
    ];
    for (name, value, right) in positive {
        if !right {
            let rule = match name {
                "body_mass" => "be positive",
                "last" => "be a number that is not below first",
                "first" => "be a number",
                _ => "be at least 0",
            };
            return Err(Failure::invalid(name, rule, Given::Number(value)));
        }
    }
    Ok(())
}

/// Limits of each point without those that another one always outdoes: with less energy for equal bodies, human speed
/// and range.
fn decisive(limits: &[PointLimit], points: usize) -> Vec<Vec<usize>> {
    let key = |limit: &PointLimit| {
        let numbers = [
            limit.body_mass,
            limit.human_speed,
            limit.speed,
            limit.range[0],
            limit.range[1],
        ];
        (limit.table, numbers.map(f64::to_bits))
    };
    let mut found = vec![Vec::new(); points];
    for (row, limit) in limits.iter().enumerate() {
        found[limit.point].push(row);
    }
    for rows in &mut found {
        rows.sort_by(|one, other| {
            let (one, other) = (&limits[*one], &limits[*other]);
            key(one)
                .cmp(&key(other))
                .then(one.energy.total_cmp(&other.energy))
        });
        rows.dedup_by_key(|row| key(&limits[*row]));
        rows.sort_unstable();
    }
    found
}
