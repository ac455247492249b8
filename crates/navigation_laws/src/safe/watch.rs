//! People whom nobody sees, kept in mind by a robot in a map that it knows.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::guide::Pace;
use crate::safe::settings::SafeNavigation;
use crate::shield::{Hidden, Shield, ShieldLimits};
use crate::{Shown, Situation, Unwatched};
use navigation_world::sensing::measurement::Measurement;
use navigation_world::world::geometry::Body;
use navigation_world::world::map::StaticMap;
use navigation_world::world::obstacle::Shape;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use navigation_world::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Vector2;
use unknown_places::unseen::{Arrivals, Belief, Ground, Unseen};

/// Somebody who is tracked.
#[derive(Clone, Copy, Debug)]
struct Track {
    place: Vector2<f64>,
    /// When he was there, in s.
    time: f64,
}

/// Where the robot was.
#[derive(Clone, Copy, Debug)]
struct PastPose {
    time: f64,
    place: Vector2<f64>,
    heading: f64,
}

/// Belief of a robot about people whom it does not see.
pub(super) struct Watch {
    shield: Shield,
    unseen: Unseen,
    /// Largest speed of people in m/s.
    speed: f64,
    map: StaticMap,
    belief: Belief,
    arrivals: Arrivals,
    /// Who is tracked, for each obstacle.
    tracks: Vec<Option<Track>>,
    /// Whether each obstacle moves: what stands is known for all time.
    moves: Vec<bool>,
    /// Obstacles that the last scan showed where nobody was reckoned with.
    unexpected: Vec<usize>,
    /// Age in s of what is measured of others in a run, and whether the own pose is not as old.
    age: f64,
    poses: VecDeque<PastPose>,
    last: Option<f64>,
    /// Obstacles as they are seen.
    bodies: Vec<Body>,
    blocking: Vec<PlacedShape>,
}

impl Watch {
    /// Of a robot in a scenario whose obstacles can be people.
    ///
    /// # Errors
    /// Somebody is larger than those who are reckoned with, or measured so badly that he can be taken to be hidden
    /// where he is seen.
    pub fn new(family: &SafeNavigation, scenario: &Scenario, reach: f64) -> Result<Option<Self>> {
        let given = family.shield.and_then(|shield| {
            let speed = shield.person_speed?;
            Some((shield, shield.unseen?, speed))
        });
        let Some((shield, unseen, speed)) = given else {
            return Ok(None);
        };
        // Checked with the family.
        let map = family.map.clone().unwrap_or_default();
        // Points that a lidar tells of have no size: they are nobody.
        let is_point =
            |placed: &PlacedObstacle| placed.obstacle.shape == Shape::Disc { radius: 0.0 };
        let moves = |placed: &PlacedObstacle| !placed.stationary && !is_point(placed);
        let moves: Vec<bool> = scenario.obstacles.iter().map(moves).collect();
        for (index, placed) in scenario
            .obstacles
            .iter()
            .enumerate()
            .filter(|(index, _)| moves[*index])
        {
            check_size(&unseen, placed)
                .map_err(|error| error.within(&format!("obstacles[{index}]")))?;
        }
        let measurement = scenario.measurement;
        let own = measurement.filter(Measurement::of_robot);
        let others = measurement.filter(|found| found.of_obstacle(false));
        check_errors(
            &unseen,
            own.map(|found| found.error_bound()),
            others.map(|found| found.error_bound()),
        )?;
        let age = if own.is_none() {
            others.map_or(0.0, |found| found.latency())
        } else {
            0.0
        };
        let room = reach + scenario.robot.radius + unseen.person_radius;
        let ground = family
            .plans
            .ground(&map, &unseen, [scenario.start, scenario.goal], room)?;
        Ok(Some(Self {
            shield,
            speed,
            map,
            belief: Belief::new(ground),
            arrivals: Arrivals::default(),
            tracks: vec![None; moves.len()],
            moves,
            unexpected: Vec::new(),
            age,
            poses: VecDeque::new(),
            last: None,
            bodies: Vec::new(),
            blocking: Vec::new(),
            unseen,
        }))
    }

    /// Where those can be who are not seen, and who is.
    pub fn unwatched(&self) -> Unwatched<'_> {
        Unwatched {
            belief: &self.belief,
            tracked: self.tracks.iter().map(Option::is_some).collect(),
            unexpected: &self.unexpected,
        }
    }

    /// Speeds that they leave a robot with limits; `None` where it creeps at any speed.
    pub fn pace(&self, limits: &ShieldLimits) -> Option<Pace> {
        if self.unseen.creep_speed >= limits.max_speed {
            return None;
        }
        let apart = limits.radius + self.unseen.person_radius + self.shield.around();
        Some(Pace {
            ground: self.belief.ground().clone(),
            apart: apart + self.speed * (self.shield.latency + limits.period),
            person_speed: self.speed,
            max_speed: limits.max_speed,
            deceleration: limits.max_acceleration,
            period: limits.period,
            known: Arc::default(),
        })
    }

    /// For the shield: who is not seen.
    pub fn hidden(&self) -> Hidden<'_> {
        Hidden {
            arrivals: &self.arrivals,
            map: &self.map,
            unseen: &self.unseen,
            latency: self.shield.latency,
            grown: self.shield.grown_at(self.speed),
        }
    }

    /// Takes in what is seen; returns the obstacles without those who are hidden. `reach`: longest way until rest in m, with
    /// the time until then in s.
    pub fn look(
        &mut self,
        situation: &Situation<'_, f64>,
        [time, way]: [f64; 2],
        radius: f64,
    ) -> &[Body] {
        let now = situation.time;
        let pose = self.pose(situation);
        let gone = self.last.map_or(0.0, |last| (now - last).max(0.0)) + situation.scan.more;
        // The age of a scan by others is only bounded: as much longer may be between two of them.
        let between = match situation.scan.shown {
            Shown::All { .. } => gone,
            Shown::Nothing | Shown::Beams { .. } => gone + self.shield.latency,
        };
        if self.last.is_some() {
            self.belief.grow(self.speed * between);
        }
        self.last = Some(now);
        self.take_down(situation, &pose);
        self.see(situation, &pose);
        let from = situation.robot.position;
        let latest = time + self.shield.latency + self.unseen.sampling;
        let cell = self.unseen.cell;
        // As far as a plan is looked at, and somebody who can come there.
        let within = radius + self.unseen.person_radius + self.hidden().grown + way + 4.0 * cell;
        let longest = 1.03 * (self.speed * latest + 3.0 * cell);
        self.arrivals
            .find(&self.belief, from, [within + longest, longest], self.speed);
        &self.bodies
    }

    /// The pose at which what is told now was measured.
    fn pose(&mut self, situation: &Situation<'_, f64>) -> PastPose {
        let here = PastPose {
            time: situation.time,
            place: situation.robot.position,
            heading: situation.heading,
        };
        if self.age == 0.0 || !matches!(situation.scan.shown, Shown::All { .. }) {
            return here;
        }
        self.poses.push_back(here);
        let then = here.time - self.age;
        while self.poses.get(1).is_some_and(|next| next.time <= then) {
            self.poses.pop_front();
        }
        let first = self.poses[0];
        let next = self.poses.get(1).copied().unwrap_or(first);
        let share =
            ((then - first.time) / (next.time - first.time).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        PastPose {
            time: then,
            place: first.place + (next.place - first.place) * share,
            heading: first.heading + (next.heading - first.heading) * share,
        }
    }

    /// Takes down who is tracked: whoever is not any more can have gone anywhere since.
    fn take_down(&mut self, situation: &Situation<'_, f64>, pose: &PastPose) {
        self.bodies.clear();
        self.bodies.extend_from_slice(situation.bodies);
        self.unexpected.clear();
        let range = match situation.scan.shown {
            Shown::All { range } => Some(range),
            Shown::Nothing | Shown::Beams { .. } => None,
        };
        let placed = |body: &Body| PlacedShape {
            center: body.state.position.into(),
            shape: body.shape,
        };
        for index in 0..self.tracks.len().min(situation.bodies.len()) {
            if !self.moves[index] {
                continue;
            }
            let body = &situation.bodies[index];
            let place: Vector2<f64> = body.state.position.into();
            let seen = body.state.present
                && range.is_none_or(|range| {
                    self.blocking.clear();
                    let others = situation.bodies.iter().enumerate();
                    let others =
                        others.filter(|(other, body)| *other != index && body.state.present);
                    self.blocking.extend(others.map(|(_, body)| placed(body)));
                    let mut sensing = self.unseen.sensing;
                    sensing.range = sensing.range.min(range);
                    let size = body.shape.inner_radius();
                    sensing.sees(
                        &self.map,
                        (pose.place, pose.heading),
                        (place, size),
                        &self.blocking,
                    )
                });
            if seen {
                let told = situation.ages.get(index).copied().unwrap_or(0.0);
                let age = if range.is_some() {
                    0.0
                } else {
                    self.shield.latency.max(told)
                };
                let within = self.shield.position_error + self.speed * age;
                if self.tracks[index].is_none() && !self.belief.covers_within(place, within) {
                    self.unexpected.push(index);
                }
                self.tracks[index] = Some(Track {
                    place,
                    time: pose.time - age,
                });
            } else {
                self.bodies[index].state.present = false;
                if let Some(track) = self.tracks[index].take() {
                    let gone = (pose.time - track.time).max(0.0) + situation.scan.more;
                    self.belief
                        .add(track.place, self.shield.position_error + self.speed * gone);
                }
            }
        }
    }

    /// Takes out of the belief what beams saw empty.
    fn see(&mut self, situation: &Situation<'_, f64>, pose: &PastPose) {
        let (trusted, least) = (self.unseen.trusted_range(), self.unseen.kept_by_beams());
        match situation.scan.shown {
            Shown::Nothing => {}
            Shown::All { range } => {
                let error = self.shield.position_error;
                let present = self.bodies.iter().filter(|body| body.state.present);
                self.blocking.clear();
                self.blocking.extend(present.map(|body| grown(body, error)));
                let sensing = &self.unseen.sensing;
                let length = trusted.min(range);
                self.belief.see(
                    pose.place,
                    sensing.ends(pose.place, pose.heading, length, &self.blocking),
                    least,
                );
            }
            Shown::Beams { from, ends } => {
                let from = Vector2::from(from);
                let error = self.unseen.range_error;
                let shortened = ends.iter().map(|end| {
                    let along = Vector2::from(*end) - from;
                    let length = along.norm();
                    let kept = (length - error).min(trusted).max(0.0);
                    from + along * (kept / length.max(f64::MIN_POSITIVE))
                });
                self.belief.see(from, shortened, least);
            }
        }
    }
}

/// Outline of a body where it can be, if it was measured with an error in m.
fn grown(body: &Body, error: f64) -> PlacedShape {
    let center = Vector2::from(body.state.position);
    match body.shape {
        Shape::Disc { radius } => PlacedShape::disc(center.into(), radius + error),
        Shape::Rectangle { .. } => PlacedShape {
            center,
            shape: body.shape,
        },
    }
}

/// Refuses an obstacle that moves and is larger than the people who are reckoned with, or no disc.
fn check_size(unseen: &Unseen, placed: &PlacedObstacle) -> Result<()> {
    let (radius, most, least) = (
        placed.obstacle.shape.inner_radius(),
        unseen.person_radius,
        unseen.person_core,
    );
    let disc = matches!(placed.obstacle.shape, Shape::Disc { .. });
    if disc && radius <= most * (1.0 + 1e-9) && radius >= least {
        return Ok(());
    }
    let rule = format!(
        "be that of a disc from person_core, {least} m, to person_radius, {most} m, of the shield's unseen people"
    );
    let advice = "a larger person_radius holds it; rectangles that move are no people";
    Err(Failure::invalid("radius", rule, Given::Number(radius)).mended_by(advice))
}

/// Refuses errors of measurements that can hide who is seen.
fn check_errors(unseen: &Unseen, own: Option<f64>, others: Option<f64>) -> Result<()> {
    let given = own.unwrap_or(0.0);
    if given > unseen.pose_error {
        let rule =
            format!("be at least the largest error of the robot's measured position, {given:.4} m");
        return Err(Failure::invalid(
            "pose_error",
            rule,
            Given::Number(unseen.pose_error),
        ));
    }
    let least = unseen.person_core + others.unwrap_or(0.0);
    if unseen.person_radius < least {
        let rule = format!(
            "be at least person_core and the largest error of measured positions, {least:.4} m"
        );
        return Err(Failure::invalid(
            "person_radius",
            rule,
            Given::Number(unseen.person_radius),
        ));
    }
    Ok(())
}

impl crate::safe::Plans {
    /// Cells of a map for people who are not seen, with room in m around map, start and goal.
    fn ground(
        &self,
        map: &StaticMap,
        unseen: &Unseen,
        ends: [[f64; 2]; 2],
        room: f64,
    ) -> Result<Arc<Ground>> {
        let [start, goal] = ends.map(Vector2::from);
        let mut corners = [start.inf(&goal), start.sup(&goal)];
        for [lower, upper] in map.bounds().into_iter().chain(map.known_bounds()) {
            corners = [corners[0].inf(&lower), corners[1].sup(&upper)];
        }
        let around = Vector2::repeat(room);
        let bounds = [corners[0] - around, corners[1] + around].map(<[f64; 2]>::from);
        self.kept_ground(bounds, || {
            Ground::of_map(map, bounds, unseen.cell, unseen.person_core)
        })
    }
}
