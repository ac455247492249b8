//! Parts of safe navigation, and the scenario that its law works in.

use std::sync::Arc;

use crate::LawFamily;
use crate::filters::Filter;
use crate::foresight::Foresight;
use crate::guide::{Guidance, Guide, Pace, RobotRoom, TakeoverOptions};
use crate::safe::boundary::boundary_obstacle;
use crate::safe::plans::Plans;
use crate::shield::Shield;
use crate::yielding::Yielding;
use navigation_world::world::map::{MOST_POINTS, StaticMap};
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result, not_negative, positive};

/// The local goal of a robot that reckons with people who are not seen is no farther ahead, in m: it cuts no corners.
const BEHIND_CORNERS: f64 = 0.5;

/// A law with the parts around it.
#[derive(Clone)]
pub struct SafeNavigation {
    /// The law that wants a velocity.
    pub law: Arc<dyn LawFamily>,
    /// Map of what stands, if it is known before.
    pub map: Option<StaticMap>,
    /// How ways are planned, if they are.
    pub guide: Option<Guide>,
    /// Plans that were made, shared by all runs.
    pub plans: Plans,
    /// The shield, if there is one.
    pub shield: Option<Shield>,
    /// Filter in the place of a shield, if there is one.
    pub filter: Option<Filter>,
    /// How the robot gives way, if it does.
    pub yielding: Option<Yielding>,
    /// Search ahead, in place of the law and of yielding.
    pub foresight: Option<Foresight>,
    /// Whether a robot that makes no progress heads for its (local) goal by itself.
    pub takeover: bool,
    /// When that is, where it was told.
    pub rule: TakeoverOptions,
    /// Limit of the wanted velocity, for which regions are sized, in m/s; that of the robot where
    /// `None`.
    pub preferred_speed: Option<f64>,
    /// Distance of the surfaces in m at which force laws brake, in place of their critical regions.
    pub critical_distance: Option<f64>,
}

impl SafeNavigation {
    /// A law with nothing around it.
    #[must_use]
    pub fn bare(law: impl Into<Arc<dyn LawFamily>>) -> Self {
        Self {
            law: law.into(),
            map: None,
            guide: None,
            plans: Plans::default(),
            shield: None,
            filter: None,
            yielding: None,
            foresight: None,
            takeover: false,
            rule: TakeoverOptions::default(),
            preferred_speed: None,
            critical_distance: None,
        }
    }

    /// Returns it if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        if self.law.maps_its_scans() {
            let rule = "be a law that is told of obstacles: plans that another part changes are not those that were verified";
            let given = Given::Found("ArcRollouts".into());
            return Err(
                Failure::invalid("law", rule, given).mended_by("run ArcRollouts by themselves")
            );
        }
        if let Some(shield) = self.shield {
            shield.checked()?;
            if shield.unseen.is_some() && self.map.is_none() {
                let rule = "be given for a shield that reckons with people who are not seen: walls hide them";
                let given = Given::Found("None".into());
                return Err(Failure::invalid("map", rule, given));
            }
        }
        if self.filter.is_some() && self.shield.is_some() {
            let rule = "be None beside a shield";
            let given = Given::Found("a filter".into());
            return Err(Failure::invalid("filter", rule, given).mended_by("leave one of them out"));
        }
        if let Some(yielding) = self.yielding {
            yielding.checked()?;
        }
        if let Some(foresight) = self.foresight {
            foresight.checked()?;
        }
        if let Some(guide) = self.guide {
            guide.checked()?;
        }
        self.rule.checked()?;
        if let Some(speed) = self.preferred_speed {
            positive("preferred_speed", speed)?;
        }
        if let Some(distance) = self.critical_distance {
            not_negative("critical_distance", distance)?;
        }
        Ok(self)
    }

    /// Scenario of the law within: the robot with its preferred speed, the map for planners of whole paths, and
    /// room for the boundary points of the map.
    pub(super) fn inner(&self, scenario: &Scenario) -> Result<Scenario> {
        let mut inner = match self.preferred_speed {
            Some(speed) => slowed(scenario, speed)?,
            None => scenario.clone(),
        };
        if let Some(map) = &self.map {
            check_ends(map, scenario)?;
            inner = inner.with_map(map.clone());
            let point = boundary_obstacle(scenario.robot.radius);
            inner
                .obstacles
                .extend(std::iter::repeat_n(point, MOST_POINTS));
        }
        Ok(inner)
    }

    /// The filter, if it is for the robot of a scenario.
    pub(super) fn filter_for(&self, scenario: &Scenario) -> Result<Option<Filter>> {
        let wheels = scenario.differential.is_some();
        match self.filter {
            Some(filter) if filter.is_for_wheels() != wheels => {
                let (rule, found) = if wheels {
                    (
                        "be BarrierUnicycle for a robot with two wheels",
                        "a filter for robots that move in any direction",
                    )
                } else {
                    (
                        "be another filter for a robot that moves in any direction",
                        "BarrierUnicycle",
                    )
                };
                Err(Failure::invalid("filter", rule, Given::Found(found.into())))
            }
            filter => Ok(filter),
        }
    }

    /// The guide at work in a scenario.
    pub(super) fn guidance(
        &self,
        scenario: &Scenario,
        pace: Option<Pace>,
    ) -> Result<Option<Guidance>> {
        let Some(mut guide) = self.guide else {
            return Ok(None);
        };
        if pace.is_some() {
            guide.look_ahead = guide.look_ahead.min(BEHIND_CORNERS);
        }
        let robot = RobotRoom::from(scenario);
        let ends = [scenario.start, scenario.goal];
        let plan = self
            .plans
            .get(&guide, self.map.as_ref(), robot, ends, pace)?;
        let around = self.plans.around.clone();
        Ok(Some(Guidance::new(guide, robot, plan).sharing(around)))
    }
}

fn slowed(scenario: &Scenario, speed: f64) -> Result<Scenario> {
    let most = scenario.robot.max_speed;
    if speed > most {
        let rule = format!("be at most the largest speed of the robot, {most} m/s");
        let given = Given::Number(speed);
        return Err(Failure::invalid("preferred_speed", rule, given));
    }
    scenario.slowed(speed)
}

/// Refuses a start in contact with the map, and a goal that the robot cannot stand on.
fn check_ends(map: &StaticMap, scenario: &Scenario) -> Result<()> {
    if scenario.footprint.is_some() && scenario.distance_from(map, scenario.start) <= 0.0 {
        let rule = "not be in contact with the map";
        let given = Given::Pair(scenario.start);
        return Err(Failure::invalid("start", rule, given).mended_by("the footprint overlaps it"));
    }
    let radius = scenario.least_room();
    let check = |name: &str, place: [f64; 2], words: &str, allowed: fn(f64, f64) -> bool| {
        let clearance = map.clearance(place.into());
        if allowed(clearance, radius) {
            return Ok(());
        }
        let rule = format!("be {words} the map than the radius of the robot, {radius} m");
        let advice = format!("the map is {clearance:.4} m away");
        Err(Failure::invalid(name, rule, Given::Pair(place)).mended_by(advice))
    };
    check("start", scenario.start, "farther from", |away, least| {
        away > least
    })?;
    check("goal", scenario.goal, "no nearer to", |away, least| {
        away >= least
    })
}
