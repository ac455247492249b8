//! A law that chooses twists, at work on a robot: one with two wheels takes them up as they are, any other keeps a heading
//! for the law.

use super::{
    Gaps, LocalView, MovingShape, Pose, TwistChoice, TwistPlanner, Vector, Walls, Way, wrap,
};
use crate::filters::Near;
use crate::{Command, Law, LawFamily, Situation, force_toward};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::robots::differential::Twist;
use navigation_world::robots::drives::velocity_of;
use navigation_world::world::map::{MOST_POINTS, StaticMap};
use navigation_world::world::obstacle::Shape;
use navigation_world::world::scenario::Scenario;
use navigation_world::world::shape::PlacedShape;
use numeric::error::{Result, finite};

/// A heading that has turned as commanded, up to this rate in rad/s.
const AS_TOLD: f64 = 0.05;

/// A parameter class whose numbers a search may choose.
pub trait Tuned: Sized {
    /// Names of the numbers, in their order.
    const NAMES: &'static [&'static str];
    /// Its numbers.
    fn numbers(&self) -> Vec<f64>;
    /// With other numbers.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    fn tuned(&self, numbers: &[f64]) -> Result<Self>;
}

/// Numbers of a law by the names of its fields, and the law made of arguments: of numbers, and of others that are read
/// in a way of their own.
macro_rules! numbers {
    ($law:ident { $($field:ident),+ $(,)? } beside { $($other:ident: $read:expr),* $(,)? }) => {
        impl $crate::local_planning::Tuned for $law {
            const NAMES: &'static [&'static str] = &[$(stringify!($field)),+];

            fn numbers(&self) -> Vec<f64> {
                vec![$(self.$field),+]
            }

            fn tuned(&self, numbers: &[f64]) -> numeric::error::Result<Self> {
                let mut changed = *self;
                let fields = [$(&mut changed.$field),+];
                for ((field, number), name) in fields.into_iter().zip(numbers).zip(Self::NAMES) {
                    *field = numeric::error::finite(name, *number)?;
                }
                changed.checked()
            }
        }

        impl $law {
            fn given(given: &dyn navigation_world::arguments::Arguments) -> numeric::error::Result<Self> {
                let made = Self {
                    $($field: numeric::error::finite(stringify!($field), given.number(stringify!($field))?)?,)+
                    $($other: ($read)(given, stringify!($other))?,)*
                };
                made.checked()
            }
        }
    };
}
pub(crate) use numbers;

/// A finite argument that no search chooses.
pub(crate) fn finite_number(given: &dyn Arguments, name: &str) -> Result<f64> {
    finite(name, given.number(name)?)
}

/// A law whose twists depend on numbers.
pub trait TwistFamily: Tuned + Clone + Send + Sync + 'static {
    /// The law at work.
    type Planner: TwistPlanner;
    /// It at work, with the seed of its draws.
    fn planner(&self, seed: u64) -> Self::Planner;
}

/// A family of laws that choose twists as a family of laws.
#[derive(Clone, Copy, Debug)]
pub struct Steered<F>(pub F);

impl<F: Named> Named for Steered<F> {
    const NAME: &'static str = F::NAME;

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        F::made_of(given).map(Self)
    }
}

/// Indices of the numbers: each may change the way without obstacles.
const INDICES: [usize; 32] = {
    let mut indices = [0; 32];
    let mut index = 0;
    while index < indices.len() {
        indices[index] = index;
        index += 1;
    }
    indices
};

impl<F: TwistFamily> LawFamily for Steered<F> {
    fn gain_names(&self) -> &'static [&'static str] {
        F::NAMES
    }

    fn gains(&self) -> Vec<f64> {
        self.0.numbers()
    }

    fn free_gains(&self) -> &'static [usize] {
        &INDICES[..F::NAMES.len()]
    }

    fn chooses_velocities(&self) -> bool {
        true
    }

    fn steers_by_velocity(&self) -> bool {
        true
    }

    fn twist_planner(&self, seed: u64) -> Option<Box<dyn TwistPlanner>> {
        Some(Box::new(self.0.planner(seed)))
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        self.0.tuned(gains).map(|_| ())
    }

    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        _record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        let family = self.0.tuned(gains)?;
        Ok(Box::new(SteeredLaw::new(
            family.planner(scenario.seed),
            scenario,
        )))
    }
}

/// Heading and turn rate that a law knows of.
#[derive(Clone, Copy, Debug)]
struct Turn {
    /// When they were told, in s.
    time: f64,
    /// Heading then, in rad.
    heading: f64,
    /// Turn rate then, and the one that was commanded, in rad/s.
    rates: [f64; 2],
}

/// A law at work on one robot.
struct SteeredLaw<P> {
    planner: P,
    goal: Vector,
    /// Way to the goal as a guide has it; empty: straight to the goal.
    told: Vec<Vector>,
    way: Way,
    mass: f64,
    radius: f64,
    max_speed: f64,
    map: Option<StaticMap>,
    /// Bodies before the boundary points of the map, which the map itself shows.
    bodies: usize,
    wheels: bool,
    last: Option<Turn>,
    people: Vec<Near>,
    shapes: Vec<MovingShape>,
}

impl<P: TwistPlanner> SteeredLaw<P> {
    fn new(planner: P, scenario: &Scenario) -> Self {
        let goal = scenario.goal.into();
        let all = scenario.obstacles.len();
        Self {
            planner,
            goal,
            told: Vec::new(),
            way: Way::straight(scenario.start.into(), goal),
            mass: scenario.robot.mass,
            radius: scenario.robot.radius,
            max_speed: scenario.robot.max_speed,
            bodies: match scenario.map {
                Some(_) => all.saturating_sub(MOST_POINTS),
                None => usize::MAX,
            },
            map: scenario.map.clone(),
            wheels: scenario.differential.is_some(),
            last: None,
            people: Vec::new(),
            shapes: Vec::new(),
        }
    }

    /// People and walls of a situation.
    fn look(&mut self, situation: &Situation<'_, f64>) {
        self.people.clear();
        self.shapes.clear();
        for body in situation.bodies.iter().take(self.bodies) {
            if !body.state.present {
                continue;
            }
            let (position, velocity) = (body.state.position.into(), body.state.velocity.into());
            match body.shape {
                Shape::Disc { radius } => self.people.push(Near {
                    position,
                    velocity,
                    radius,
                }),
                shape @ Shape::Rectangle { .. } => self.shapes.push(MovingShape {
                    placed: PlacedShape {
                        center: position,
                        shape,
                    },
                    velocity,
                }),
            }
        }
    }

    /// Heading and turn rate now: as measured, or as the law keeps them.
    fn turn(&self, situation: &Situation<'_, f64>) -> [f64; 2] {
        let to = self.goal - situation.robot.position;
        match (self.last, self.wheels) {
            (None, true) => [situation.heading, 0.0],
            (None, false) => [to.y.atan2(to.x), 0.0],
            (Some(last), false) => [last.heading, last.rates[1]],
            (Some(last), true) => {
                let [before, told] = last.rates;
                let gone = situation.time - last.time;
                let turned = wrap(situation.heading - last.heading) / gone;
                // Wheels take up a command evenly within its period.
                let as_told = (turned - 0.5 * (before + told)).abs() <= AS_TOLD;
                let rate = if as_told || gone <= 0.0 { told } else { turned };
                [situation.heading, rate]
            }
        }
    }
}

impl<P: TwistPlanner> Law<f64> for SteeredLaw<P> {
    fn thinks(&self) -> bool {
        true
    }

    fn command(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        self.look(situation);
        let position = situation.robot.position;
        let [heading, rate] = self.turn(situation);
        if self.told.is_empty() {
            self.way.set([position, self.goal]);
        } else {
            self.way.set(self.told.iter().copied());
        }
        let pose = Pose { position, heading };
        let velocity = pose.inward(situation.robot.velocity);
        let gaps = Gaps {
            radius: self.radius,
            people: &self.people,
            walls: Walls {
                shapes: &self.shapes,
                map: self.map.as_ref(),
            },
        };
        let TwistChoice { twist, .. } = self.planner.choose(&LocalView {
            pose,
            twist: [velocity.x, velocity.y, rate],
            local_goal: self.goal,
            way: &self.way,
            period: situation.interval,
            max_speed: self.max_speed,
            gaps: &gaps,
        });
        let [ahead, left, turn_rate] = twist;
        let turn = turn_rate * situation.interval;
        let kept = if self.wheels {
            heading
        } else {
            wrap(heading + turn)
        };
        self.last = Some(Turn {
            time: situation.time,
            heading: kept,
            rates: [rate, turn_rate],
        });
        let wanted = if self.wheels {
            let twist = Twist {
                speed: ahead,
                turn_rate,
            };
            velocity_of(twist, heading, situation.interval)
        } else {
            let (sine, cosine) = (heading + 0.5 * turn).sin_cos();
            Vector::new(ahead * cosine - left * sine, ahead * sine + left * cosine)
        };
        Command::plain(force_toward(wanted, situation, self.mass))
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.goal = goal.into();
    }

    fn follows(&self) -> bool {
        true
    }

    fn lead(&mut self, way: &[Vector]) {
        self.told.clear();
        self.told.extend_from_slice(way);
    }
}
