//! Obstacles with their regions, and the rules that regions and the ends of a way keep to.

use crate::world::footprint::Footprint;
use crate::world::frame::Frame;
use crate::world::obstacle::{Obstacle, Regions, Shape};
use crate::world::region::{self, RobotLimits, Sensing};
use crate::world::scenario::Rules;
use crate::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result};

/// Rounding of a critical radius that was computed as the contact distance, in m.
const ROUNDING: f64 = 1e-9;

/// An obstacle whose regions are known.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedObstacle {
    /// Shape and motion.
    pub obstacle: Obstacle,
    /// Region radii.
    pub regions: Regions,
    /// Distance `d` at which robot and obstacle touch, in m.
    pub contact_distance: f64,
    /// True for an obstacle that never moves.
    pub stationary: bool,
    /// Largest speed at any time in m/s, `None` if there is none.
    pub speed_bound: Option<f64>,
}

impl PlacedObstacle {
    /// Largest speed at any time in m/s, infinite if there is none.
    #[inline]
    #[must_use]
    pub fn fastest(&self) -> f64 {
        self.speed_bound.unwrap_or(f64::INFINITY)
    }

    /// Whether it moves as nobody knows before: its motion tells only where it starts.
    #[must_use]
    pub fn moves_unforeseen(&self) -> bool {
        !self.stationary && self.obstacle.motion.is_stationary()
    }

    /// No number of its contour at the start is larger, in m; infinite if it comes or goes.
    #[must_use]
    pub fn size(&self) -> f64 {
        let Obstacle { shape, motion, .. } = &self.obstacle;
        if motion.presence() != (f64::NEG_INFINITY, f64::INFINITY) {
            return f64::INFINITY;
        }
        let [x, y] = motion.at(0.0, &mut 0).position;
        x.abs() + y.abs() + shape.extent()
    }
}

/// Obstacles with their regions, and why laws that keep to regions cannot reach the goal, if they cannot.
///
/// # Errors
/// A region breaks a rule, or the start touches an obstacle.
pub(super) fn place_all(
    (robot, outline): (&RobotLimits, Option<&Footprint>),
    [start, goal]: [[f64; 2]; 2],
    obstacles: impl IntoIterator<Item = Obstacle, IntoIter: ExactSizeIterator>,
    rules: &Rules,
    sensing: &Sensing,
) -> Result<(Vec<PlacedObstacle>, Option<Box<Failure>>)> {
    let obstacles = obstacles.into_iter();
    // A result of a collection would forget how many there are.
    let mut all = Vec::with_capacity(obstacles.len());
    for (index, obstacle) in obstacles.enumerate() {
        let placed = place(robot, obstacle, rules.control_period, sensing)
            .map_err(|error| error.within(&format!("obstacles[{index}]")))?;
        check_critical_region(&placed, index, robot, rules, sensing)?;
        all.push(placed);
    }
    let mut blocked = None;
    for (index, placed) in all.iter().enumerate() {
        check_start(placed, index, (start, rules.heading), outline)?;
        blocked = blocked.or_else(|| goal_in_region(placed, index, goal).map(Box::new));
    }
    Ok((all, blocked))
}

/// An obstacle with its regions: those that are given, and the others as computed.
pub(super) fn place(
    robot: &RobotLimits,
    obstacle: Obstacle,
    control_period: f64,
    sensing: &Sensing,
) -> Result<PlacedObstacle> {
    let limits = obstacle.limits;
    let given = limits.critical_radius.zip(limits.active_radius);
    let regions = if let Some((critical_radius, active_radius)) = given {
        Regions {
            critical_radius,
            active_radius,
        }
    } else {
        let computed = region::radii(robot, &obstacle, control_period, None, sensing)?;
        Regions {
            critical_radius: limits.critical_radius.unwrap_or(computed.critical_radius),
            active_radius: limits.active_radius.unwrap_or(computed.active_radius),
        }
    };
    if regions.active_radius <= regions.critical_radius {
        let rule = format!(
            "be larger than critical_radius, {} m",
            metres(regions.critical_radius)
        );
        let given = Given::Number(regions.active_radius);
        return Err(Failure::invalid("active_radius", rule, given));
    }
    let contact_distance = robot.radius + obstacle.shape.inner_radius();
    if regions.active_radius <= contact_distance {
        let rule = format!(
            "be larger than the radii of robot and obstacle together, {} m",
            metres(contact_distance)
        );
        let given = Given::Number(regions.active_radius);
        return Err(Failure::invalid("active_radius", rule, given));
    }
    let stationary = obstacle.motion.is_stationary();
    let speed_bound = obstacle.motion.speed_bound();
    Ok(PlacedObstacle {
        obstacle,
        regions,
        contact_distance,
        stationary,
        speed_bound,
    })
}

/// Refuses a critical region in which robot and obstacle touch before it is entered.
fn check_critical_region(
    placed: &PlacedObstacle,
    index: usize,
    robot: &RobotLimits,
    rules: &Rules,
    sensing: &Sensing,
) -> Result<()> {
    let critical = placed.regions.critical_radius;
    if critical >= placed.contact_distance - ROUNDING {
        return Ok(());
    }
    let owner = format!("obstacles[{index}]");
    let safe = region::radii(robot, &placed.obstacle, rules.control_period, None, sensing)?;
    let rule = format!(
        "be at least {} m, where the robot (radius {} m) touches {owner}",
        metres(placed.contact_distance),
        robot.radius,
    );
    let name = format!("{owner}.critical_radius");
    Err(
        Failure::invalid(name, rule, Given::Number(critical)).mended_by(format!(
            "leave it out, or give the {} m of region_radii or more, in which the robot can stop",
            metres(safe.critical_radius)
        )),
    )
}

/// A length in m as a message shows it: rounded up to 0.1 mm, so that it does as a least value.
fn metres(length: f64) -> f64 {
    (length * 1e4 - 1e-4).ceil() / 1e4
}

/// An end of the way that is nearer to an obstacle than it may be.
fn too_near(
    (name, place): (&str, [f64; 2]),
    rule: &str,
    (placed, index): (&PlacedObstacle, usize),
    (distance, least): (f64, f64),
) -> Failure {
    let side = match placed.obstacle.shape {
        Shape::Disc { .. } => "center",
        Shape::Rectangle { .. } => "contour",
    };
    let rule = format!(
        "{rule}: at least {} m from the {side} of obstacles[{index}]",
        metres(least)
    );
    let away = metres(least - distance).max(1e-4);
    let near = (distance * 1e4).round() / 1e4;
    Failure::invalid(name, rule, Given::Pair(place))
        .mended_by(format!("it is {near} m away, move it by {away} m or more"))
}

/// Refuses a start in contact with an obstacle.
fn check_start(
    placed: &PlacedObstacle,
    index: usize,
    (start, heading): ([f64; 2], f64),
    outline: Option<&Footprint>,
) -> Result<()> {
    let state = placed.obstacle.motion.at(0.0, &mut 0);
    if let Some(outline) = outline {
        let shape = PlacedShape {
            center: state.position.into(),
            shape: placed.obstacle.shape,
        };
        let gap = outline
            .separation(&Frame::at(start, heading), &shape)
            .distance;
        if !state.present || gap > 0.0 {
            return Ok(());
        }
        let rule = format!("not be in contact with obstacles[{index}]");
        return Err(Failure::invalid("start", rule, Given::Pair(start))
            .mended_by(format!("the footprint overlaps it by {} m", metres(-gap))));
    }
    let distance = placed.obstacle.distance(state.position, start);
    let least = placed.contact_distance;
    if !state.present || distance > least {
        return Ok(());
    }
    let rule = "not be in contact with an obstacle";
    Err(too_near(
        ("start", start),
        rule,
        (placed, index),
        (distance, least),
    ))
}

/// Why a law that keeps to regions cannot reach the goal because of an obstacle, if it cannot.
fn goal_in_region(placed: &PlacedObstacle, index: usize, goal: [f64; 2]) -> Option<Failure> {
    let state = placed.obstacle.motion.at(0.0, &mut 0);
    let distance = placed.obstacle.distance(state.position, goal);
    let least = placed.regions.active_radius;
    let rule = "lie outside the active region of every stationary obstacle";
    (placed.stationary && distance < least)
        .then(|| too_near(("goal", goal), rule, (placed, index), (distance, least)))
}
