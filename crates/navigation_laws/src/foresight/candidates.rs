//! First velocities and their prices.

use crate::foresight::program::FARTHEST_MOVE;
use crate::foresight::{Foreseer, ROOM, Scene};
use crate::guide::RobotRoom;
use crate::shield::{OutlineGuard, StaticObstacles, braking};
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::RobotState;
use numeric::lanes::Vector2;
use std::f64::consts::TAU;

/// Directions and speeds of the candidates.
const DIRECTIONS: u32 = 36;
const SPEEDS: u32 = 3;

/// Speed in m/s of a robot that turns on the spot toward a direction.
const ON_THE_SPOT: f64 = 1e-3;

/// Turns in rad in which such a robot lines up with a gap, and how many of them to each side.
const FINE_TURN: f64 = 0.04;
const FINE: i32 = 2;

/// Places on the straight way on from the first one.
const AHEAD: u32 = 4;

/// Price of a straight way on that is blocked, as a multiple of the time of a stage: the robot has to turn or to back off.
const BLOCKED: f64 = 2.0;

/// Prices that differ by less are alike, in s.
const ALIKE: f64 = 1e-9;

/// Cells that the first velocity can lead over, with one more.
pub(super) fn cells_of_first_velocity(max_speed: f64, preferred: f64) -> f64 {
    (FARTHEST_MOVE * max_speed / preferred).ceil() + 1.0
}

/// Velocity that the robot takes up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// In m/s.
    pub velocity: Vector2<f64>,
    /// Whether a robot with two wheels drives backwards.
    pub backwards: bool,
}

impl Target {
    /// A velocity that is taken up forwards.
    #[must_use]
    pub fn forwards(velocity: Vector2<f64>) -> Self {
        Self {
            velocity,
            backwards: false,
        }
    }
}

/// Target that was accepted, with the command toward it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcceptedTarget<C> {
    /// Velocity in m/s that the robot takes up.
    pub target: Vector2<f64>,
    /// Command toward it.
    pub command: C,
    /// Whether no cheaper one was refused.
    pub cheapest: bool,
}

/// Way of a robot that takes up a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driven {
    /// Places after the four quarters of a stage, in m.
    pub places: [Vector2<f64>; 4],
    /// Headings there in rad.
    pub headings: [f64; 4],
    /// Price of a turn in s for each rad, of a robot with two wheels.
    pub turn_price: Option<f64>,
}

impl Driven {
    /// Price of the turn to a direction at the end, in s.
    fn turning(&self, to: impl FnOnce() -> Vector2<f64>) -> f64 {
        self.turn_price.map_or(0.0, |price| {
            let (sin, cos) = self.headings[3].sin_cos();
            let (ahead, to) = (Vector2::new(cos, sin), to());
            price * ahead.perp(&to).atan2(ahead.dot(&to)).abs()
        })
    }
}

/// Places after the four quarters of a time in s of a robot that takes up a velocity evenly and keeps it.
#[must_use]
pub fn taken_up(
    robot: &RobotState<f64>,
    velocity: Vector2<f64>,
    acceleration: f64,
    time: f64,
) -> [Vector2<f64>; 4] {
    let change = velocity - robot.velocity;
    let ramp = change.norm() / acceleration;
    std::array::from_fn(|quarter| {
        let time = 0.25 * time * (quarter + 1) as f64;
        if time < ramp {
            return robot.position + (robot.velocity + change * (0.5 * time / ramp)) * time;
        }
        robot.position + robot.velocity * ramp + change * (0.5 * ramp) + velocity * (time - ramp)
    })
}

/// Walls beside a robot.
struct Beside<'a> {
    robot: RobotRoom,
    walls: StaticObstacles<'a>,
    /// Distance of its middle from them now, in m.
    clearance: f64,
    /// Outline of a robot that is no disc, with its distance from them now in m.
    outline: Option<(&'a OutlineGuard, f64)>,
}

impl<'a> Beside<'a> {
    /// `None` where no wall is near on a way in m.
    fn new(scene: &Scene<'a>, robot: RobotRoom, way: f64) -> Option<Self> {
        let near = Self::near(&robot);
        let clearance = scene
            .walls
            .clearance_up_to(scene.robot.position, near + way);
        let outline = scene.outline.map(|(guard, heading)| {
            let pose = Frame::at(scene.robot.position.into(), heading);
            (guard, guard.wall_clearance(&pose, &scene.walls))
        });
        (clearance < near + way).then_some(Self {
            robot,
            walls: scene.walls,
            clearance,
            outline,
        })
    }

    /// Clearance in m from which on walls do not matter.
    fn near(robot: &RobotRoom) -> f64 {
        if robot.turns() {
            robot.free()
        } else {
            robot.least + ROOM
        }
    }

    /// Share of a straight way in m on from the end of another on which a robot that is no disc and has two wheels meets a
    /// wall.
    fn blocked(&self, driven: &Driven, way: f64) -> f64 {
        if self.outline.is_none() || driven.turn_price.is_none() {
            return 0.0;
        }
        let (from, heading) = (driven.places[3], driven.headings[3]);
        let (sin, cos) = heading.sin_cos();
        let free = (1..=AHEAD).take_while(|part| {
            let ahead = way * f64::from(*part) / f64::from(AHEAD);
            self.kept(from + Vector2::new(cos, sin) * ahead, heading)
        });
        1.0 - free.count() as f64 / f64::from(AHEAD)
    }

    /// Whether a robot at a place with a heading in rad keeps its distance, or the present one where that is less.
    fn kept(&self, place: Vector2<f64>, heading: f64) -> bool {
        let near = Self::near(&self.robot);
        let clearance = self.walls.clearance_up_to(place, near);
        clearance >= near
            || match &self.outline {
                Some((guard, now)) => {
                    let pose = Frame::at(place.into(), heading);
                    guard.wall_clearance(&pose, &self.walls) >= *now
                }
                None => clearance >= self.clearance,
            }
    }

    /// Whether it does so on a whole way.
    fn keeps(&self, driven: &Driven) -> bool {
        let mut poses = driven.places.iter().zip(driven.headings);
        poses.all(|(place, heading)| self.kept(*place, heading))
    }

    /// Whether a robot that is no disc cannot turn at a place.
    fn narrow(&self, place: Vector2<f64>) -> bool {
        let free = self.robot.free();
        self.robot.turns() && self.walls.clearance_up_to(place, free) < free
    }
}

/// Target with its price.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub target: Target,
    pub price: f64,
}

/// Takes the cheapest candidate out of what is left, of those that are alike the first.
pub(super) fn cheapest(candidates: &mut [Candidate]) -> Option<Target> {
    let least = candidates
        .iter()
        .map(|each| each.price)
        .fold(f64::INFINITY, f64::min);
    let found = candidates
        .iter_mut()
        .find(|each| each.price < least + ALIKE)?;
    if found.price == f64::INFINITY {
        return None;
    }
    found.price = f64::INFINITY;
    Some(found.target)
}

impl Foreseer {
    /// Prices all candidates.
    pub(super) fn price(
        &mut self,
        scene: &Scene<'_>,
        wheels: bool,
        driven: &impl Fn(&Target) -> Driven,
    ) {
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.clear();
        let (before, last) = (scene.robot.velocity, self.last);
        let slower = Target {
            velocity: braking(before, &self.limits),
            ..last
        };
        let first = [last, Target::forwards(Vector2::zeros()), slower];
        candidates.extend(first.map(|target| Candidate { target, price: 0.0 }));
        let fastest = self.limits.max_speed.max(before.norm());
        let beside = Beside::new(scene, self.room, fastest * self.settings.step);
        let ahead = scene.ahead.y.atan2(scene.ahead.x);
        let circle = (0..DIRECTIONS)
            .map(|direction| ahead + f64::from(direction) * TAU / f64::from(DIRECTIONS));
        // Beside walls a robot that is no disc lines up with a gap before it drives on.
        let lines_up = wheels && beside.is_some() && self.room.turns();
        let fine = scene.outline.filter(|_| lines_up).map(|(_, heading)| {
            let around = -FINE..=FINE;
            around.map(move |turn| heading + f64::from(turn) * FINE_TURN)
        });
        let directions: Vec<f64> = circle.chain(fine.into_iter().flatten()).collect();
        let sides: &[bool] = if wheels { &[false, true] } else { &[false] };
        for backwards in sides {
            for speed in u32::from(!lines_up)..=SPEEDS {
                let length = match speed {
                    0 => ON_THE_SPOT,
                    _ => self.limits.max_speed * f64::from(speed) / f64::from(SPEEDS),
                };
                for direction in &directions {
                    let (sin, cos) = direction.sin_cos();
                    let velocity = Vector2::new(cos, sin) * length;
                    let target = Target {
                        velocity,
                        backwards: *backwards,
                    };
                    candidates.push(Candidate { target, price: 0.0 });
                }
            }
        }
        let met = self.met(scene, fastest);
        for candidate in &mut candidates {
            let driven = driven(&candidate.target);
            let (mut blocked, mut narrow) = (0.0, false);
            if let Some(beside) = &beside {
                if !beside.keeps(&driven) {
                    candidate.price = f64::INFINITY;
                    continue;
                }
                blocked = beside.blocked(&driven, self.preferred * self.settings.step);
                narrow = beside.narrow(driven.places[3]);
            }
            candidate.price = self.price_of(scene, &candidate.target, (&driven, narrow), &met)
                + BLOCKED * self.settings.step * blocked;
        }
        self.candidates = candidates;
    }

    /// People who can be near the robot within the first stage.
    fn met(&self, scene: &Scene<'_>, fastest: f64) -> Vec<usize> {
        let step = self.settings.step;
        let near = |index: &usize| {
            let person = &self.prediction.people[*index];
            let blur = self.settings.blur(step, person.deviation);
            let most = person.touch + self.settings.felt(blur) + (fastest + person.speed) * step;
            let offset = self.prediction.places(*index)[0] - scene.robot.position;
            offset.norm_squared() < most * most
        };
        (0..self.prediction.people.len()).filter(near).collect()
    }

    fn price_of(
        &self,
        scene: &Scene<'_>,
        target: &Target,
        (driven, narrow): (&Driven, bool),
        met: &[usize],
    ) -> f64 {
        let settings = &self.settings;
        let part = 0.25 * settings.step;
        let mut price = 0.0;
        for index in met {
            let person = &self.prediction.people[*index];
            let foreseen = self.prediction.places(*index);
            let others = [
                (foreseen[0] + foreseen[1]) * 0.5,
                foreseen[1],
                (foreseen[1] + foreseen[2]) * 0.5,
                foreseen[2],
            ];
            for (quarter, (place, other)) in driven.places.iter().zip(others).enumerate() {
                let blur = settings.blur((quarter + 1) as f64 * part, person.deviation);
                let gap = (place - other).norm() - person.touch;
                let short = (1.0 - gap / settings.comfort).max(0.0);
                price += part
                    * (settings.risk_weight * settings.risk(gap, blur)
                        + settings.comfort_weight * short * short);
            }
        }
        let change = (target.velocity - self.last.velocity).norm() / self.limits.max_speed;
        let haste = (target.velocity.norm() / self.preferred - 1.0).max(0.0);
        let end = driven.places[3] - scene.robot.position;
        let turning = driven.turning(|| {
            if narrow {
                // The nodes are too coarse to line up with a gap; the (local) goal is seen through it.
                return scene.ahead - end;
            }
            self.program.onward(end).unwrap_or_default()
        });
        price
            + self.program.cost(end)
            + turning
            + settings.change_weight * change
            + settings.speed_weight * settings.step * haste
            + self
                .impatience
                .price(scene.robot.position + target.velocity * settings.step)
    }
}
