//! Foams that keep an impact within limits.
//!
//! Along the stiffness `K_c` at a given damping `C_c`, the ratio of a metric to its limit crosses
//! 1 at boundaries. It need not be continuous: the impact period jumps where a local minimum of
//! the head's acceleration touches zero, and with it a maximum at its end. Every crossing is
//! therefore found on a grid, closed in by halving, and classed by the behavior of the metric there.

mod fastest;

pub use fastest::FastestImpact;

use crate::criteria::Impact;
use crate::error::{Failure, Given, Result, not_negative, positive};
use crate::metrics::INJURY_WINDOWS;
use crate::parameters::{Foam, GRAVITY, Manipulator, System, Target};

/// Range of stiffness to search by default, in N/m.
pub const STIFFNESS_RANGE: [f64; 2] = [1.0, 1e7];
/// Nodes of the grid, evenly spaced in the logarithm.
const NODES: usize = 420;
/// Halvings after which neighbouring numbers are reached.
const HALVINGS: usize = 80;
/// Ratio over its limit at both sides of a crossing below which it is a root; a root reaches
/// rounding, a jump is far larger.
const ROOT_RESIDUAL: f64 = 1e-10;

/// A metric that can be limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Peak acceleration of the head; limit in g.
    HeadAcceleration,
    /// Peak contact force; limit in N.
    ContactForce,
    /// Head injury criterion, windows up to 15 ms.
    Injury15,
    /// Head injury criterion, windows up to 36 ms.
    Injury36,
    /// Largest compression in the impact period; limit in m.
    Compression,
    /// Largest compression until the foam gives back, infinite if it never does; limit in m.
    ContactCompression,
}

impl Quantity {
    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::HeadAcceleration => "peak_head_acceleration_g",
            Self::ContactForce => "peak_contact_force",
            Self::Injury15 => "hic15",
            Self::Injury36 => "hic36",
            Self::Compression => "max_compression",
            Self::ContactCompression => "contact_compression",
        }
    }

    /// Power of the closing speed that it grows with.
    #[must_use]
    pub fn power(self) -> f64 {
        match self {
            Self::Injury15 | Self::Injury36 => 2.5,
            Self::HeadAcceleration
            | Self::ContactForce
            | Self::Compression
            | Self::ContactCompression => 1.0,
        }
    }
}

/// A limit of a metric for a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirement {
    /// The limited metric.
    pub quantity: Quantity,
    /// The limit.
    pub limit: f64,
    /// The head that is hit.
    pub head: Target,
}

/// Manipulator and impact of a design, and the range of stiffness to search.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignProblem {
    /// The manipulator.
    pub manipulator: Manipulator,
    /// `v_c`, in m/s.
    pub closing_speed: f64,
    /// Horizon of the impacts, in s; the default of each head when `None`.
    pub horizon: Option<f64>,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
    /// Range of stiffness to search, in N/m.
    pub range: [f64; 2],
}

impl DesignProblem {
    /// A problem with defaults.
    #[must_use]
    pub fn new(manipulator: Manipulator, closing_speed: f64) -> Self {
        Self {
            manipulator,
            closing_speed,
            horizon: None,
            gravity: GRAVITY,
            range: STIFFNESS_RANGE,
        }
    }
}

/// Behavior of a metric at a crossing of its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrossingStatus {
    /// Its peak inside the impact period equals the limit.
    LocalMaximum,
    /// Its value at the end of the impact period, or of the horizon, equals the limit.
    EndOfImpactPeriod,
    /// Its value at first contact equals the limit.
    InitialStep,
    /// It jumps over the limit.
    Jump,
    /// There is no crossing.
    None,
}

impl CrossingStatus {
    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::LocalMaximum => "local_maximum",
            Self::EndOfImpactPeriod => "end_of_impact_period",
            Self::InitialStep => "initial_step",
            Self::Jump => "jump",
            Self::None => "none",
        }
    }
}

/// A stiffness at which the requirements begin or cease to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// `K_c`, in N/m.
    pub stiffness: f64,
    /// Behavior of the metric there.
    pub status: CrossingStatus,
    /// Whether the requirements cease to hold towards larger stiffness.
    pub rising: bool,
    /// The metric that crosses its limit.
    pub quantity: Quantity,
}

/// A boundary and all crossings in the range.
#[derive(Clone, Debug, PartialEq)]
pub struct FoamBoundary {
    /// `K_c` of the boundary, in N/m; NaN without one.
    pub stiffness: f64,
    /// Behavior of the metric there.
    pub status: CrossingStatus,
    /// All crossings, by increasing stiffness.
    pub crossings: Vec<Crossing>,
    /// Whether the requirements hold at the lower end of the range.
    pub holds_below: bool,
    /// Whether the requirements hold at the upper end of the range.
    pub holds_above: bool,
}

/// The largest ratio to a limit, and where the peak behind it is.
#[derive(Clone, Copy, Debug)]
struct Load {
    ratio: f64,
    quantity: Quantity,
    place: CrossingStatus,
}

/// Upper boundary: the smallest stiffness above which the requirements cease to hold.
///
/// # Errors
/// An argument is out of range.
pub fn stiffness_upper(
    problem: &DesignProblem,
    requirements: &[Requirement],
    damping: f64,
) -> Result<FoamBoundary> {
    boundary(problem, requirements, damping, |crossings| {
        crossings.iter().find(|crossing| crossing.rising)
    })
}

/// Lower boundary: the smallest stiffness such that the requirements hold for every larger one.
///
/// # Errors
/// An argument is out of range.
pub fn stiffness_lower(
    problem: &DesignProblem,
    requirements: &[Requirement],
    damping: f64,
) -> Result<FoamBoundary> {
    boundary(problem, requirements, damping, |crossings| {
        crossings.last().filter(|crossing| !crossing.rising)
    })
}

fn boundary(
    problem: &DesignProblem,
    requirements: &[Requirement],
    damping: f64,
    choose: impl Fn(&[Crossing]) -> Option<&Crossing>,
) -> Result<FoamBoundary> {
    check(problem, requirements)?;
    not_negative("damping", damping)?;
    let load = |stiffness: f64| problem.load(requirements, [stiffness, damping]);
    let nodes = problem
        .nodes()
        .map(|stiffness| Ok((stiffness, load(stiffness)?)))
        .collect::<Result<Vec<_>>>()?;
    let mut crossings = Vec::new();
    for pair in nodes.windows(2) {
        let [low, high] = [pair[0], pair[1]];
        if (low.1.ratio > 1.0) != (high.1.ratio > 1.0) {
            crossings.push(close_in(&load, low, high)?);
        }
    }
    let holds = |node: Option<&(f64, Load)>| node.is_some_and(|node| node.1.ratio <= 1.0);
    let chosen = choose(&crossings).copied();
    Ok(FoamBoundary {
        stiffness: chosen.map_or(f64::NAN, |crossing| crossing.stiffness),
        status: chosen.map_or(CrossingStatus::None, |crossing| crossing.status),
        crossings,
        holds_below: holds(nodes.first()),
        holds_above: holds(nodes.last()),
    })
}

/// Halves a bracket down to neighboring numbers and classes the crossing there.
fn close_in(
    load: &impl Fn(f64) -> Result<Load>,
    mut low: (f64, Load),
    mut high: (f64, Load),
) -> Result<Crossing> {
    let rising = high.1.ratio > 1.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low.0 + high.0);
        if middle <= low.0 || middle >= high.0 {
            break;
        }
        let there = load(middle)?;
        if (there.ratio > 1.0) == rising {
            high = (middle, there);
        } else {
            low = (middle, there);
        }
    }
    let (inside, outside) = if rising { (low, high) } else { (high, low) };
    let residual = |side: (f64, Load)| (side.1.ratio - 1.0).abs();
    let jump = residual(inside).max(residual(outside)) > ROOT_RESIDUAL;
    Ok(Crossing {
        stiffness: inside.0,
        status: if jump {
            CrossingStatus::Jump
        } else {
            inside.1.place
        },
        rising,
        quantity: outside.1.quantity,
    })
}

fn check(problem: &DesignProblem, requirements: &[Requirement]) -> Result<()> {
    problem.manipulator.checked()?;
    positive("closing_speed", problem.closing_speed)?;
    positive("gravity", problem.gravity)?;
    if let Some(horizon) = problem.horizon {
        positive("horizon", horizon)?;
    }
    let [low, high] = problem.range;
    positive("range", low)?;
    positive("range", high)?;
    if low >= high {
        let given = Given::Number(high);
        return Err(Failure::invalid("range", "increase", given));
    }
    if requirements.is_empty() {
        let given = Given::Found("no limit".into());
        return Err(Failure::invalid("limits", "hold at least one", given));
    }
    for requirement in requirements {
        positive(requirement.quantity.word(), requirement.limit)?;
        match requirement.head {
            Target::Free(head) => {
                head.checked().map_err(|error| error.within("head"))?;
            }
            Target::Constrained => {
                let meaningful = matches!(
                    requirement.quantity,
                    Quantity::ContactForce | Quantity::Compression | Quantity::ContactCompression
                );
                if !meaningful {
                    let rule = "not be limited for a constrained head";
                    let given = Given::Number(requirement.limit);
                    let name = requirement.quantity.word();
                    return Err(Failure::invalid(name, rule, given));
                }
            }
        }
    }
    Ok(())
}

impl DesignProblem {
    fn nodes(&self) -> impl Iterator<Item = f64> {
        let [low, high] = self.range;
        let ratio = (high / low).ln();
        (0..=NODES).map(move |node| {
            if node == NODES {
                high
            } else {
                low * (ratio * (node as f64 / NODES as f64)).exp()
            }
        })
    }

    fn load(&self, requirements: &[Requirement], foam: [f64; 2]) -> Result<Load> {
        let mut worst = Load {
            ratio: f64::NEG_INFINITY,
            quantity: Quantity::Compression,
            place: CrossingStatus::None,
        };
        for requirement in requirements {
            let (value, place) = self.value(requirement, foam)?;
            let ratio = value / requirement.limit;
            if ratio > worst.ratio {
                worst = Load {
                    ratio,
                    quantity: requirement.quantity,
                    place,
                };
            }
        }
        Ok(worst)
    }

    /// A metric in the unit of its limit, and where it is taken.
    fn value(
        &self,
        requirement: &Requirement,
        [stiffness, damping]: [f64; 2],
    ) -> Result<(f64, CrossingStatus)> {
        let system = System {
            manipulator: self.manipulator,
            foam: Foam {
                stiffness,
                damping,
                thickness: 1.0,
                linear_range: 1.0,
            },
            head: requirement.head,
        };
        let impact = Impact::new(&system, self.closing_speed, self.horizon)?;
        let peak = match requirement.quantity {
            Quantity::HeadAcceleration => {
                let mut peak = impact.peak_head_acceleration();
                peak.value /= self.gravity;
                peak
            }
            Quantity::ContactForce => impact.peak_contact_force(),
            Quantity::Compression => impact.max_compression(),
            Quantity::ContactCompression => {
                let largest = impact.compression_of_contact();
                return Ok((largest, CrossingStatus::LocalMaximum));
            }
            Quantity::Injury15 | Quantity::Injury36 => {
                let index = usize::from(requirement.quantity == Quantity::Injury36);
                let window = impact.injury(INJURY_WINDOWS[index]);
                let scale = self.gravity * self.gravity * self.gravity.sqrt();
                return Ok((window.value / scale, CrossingStatus::LocalMaximum));
            }
        };
        let place = if peak.time == 0.0 {
            CrossingStatus::InitialStep
        } else if peak.time == impact.end() {
            CrossingStatus::EndOfImpactPeriod
        } else {
            CrossingStatus::LocalMaximum
        };
        Ok((peak.value, place))
    }

    /// Ratio of every metric to its limit for a foam; it keeps within limits where all are at
    /// most 1.
    ///
    /// # Errors
    /// An argument is out of range.
    pub fn ratios(&self, requirements: &[Requirement], foam: &Foam) -> Result<Vec<f64>> {
        check(self, requirements)?;
        foam.checked()?;
        requirements
            .iter()
            .map(|requirement| {
                let (value, _) = self.value(requirement, [foam.stiffness, foam.damping])?;
                Ok(value / requirement.limit)
            })
            .collect()
    }
}
