//! Microphones on a robot that locate a sound which an obstacle or person carries: the robot heads for it.

use crate::arguments::{Arguments, Named};
use crate::sensing::fixes::{Ear, FixNoise, Fixes};
use crate::sensing::sensor::{RobotSensor, Sensor, Truth};
use crate::world::frame::Frame;
use crate::world::geometry::Body;
use crate::world::obstacle::Regions;
use crate::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result, not_negative, positive};
use numeric::lanes::Vector2;
use numeric::random::Stream;

/// Streams of the scatter of localizers, counted up from here.
const SOUND_STREAM: u64 = 1 << 60;

/// A row of microphones, and how near the robot goes to the source.
///
/// The goal of the law becomes the point at `standoff` before the source, each time a burst is heard; between two
/// bursts the last one counts.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundLocalizer {
    /// Index of the obstacle that carries the source.
    pub carrier: usize,
    /// Distance from the source at which the robot wants to be, in m.
    pub standoff: f64,
    /// Bursts and their scatter.
    pub fixes: Fixes,
}

impl Named for SoundLocalizer {
    const NAME: &'static str = "sound_localizer";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let scale = not_negative("noise_scale", given.number("noise_scale")?)?;
        let standoff = not_negative("standoff", given.number("standoff")?)?;
        let fixes = Fixes {
            interval: positive("burst_interval", given.number("burst_interval")?)?,
            noise: FixNoise::default().scaled(scale),
            mirrored: given.flag("mirrored")?,
        };
        Ok(Self {
            carrier: given.count("carrier")?,
            standoff,
            fixes,
        })
    }
}

impl RobotSensor for SoundLocalizer {
    fn at_work(&self, scenario: &Scenario, index: u64) -> Result<Box<dyn Sensor>> {
        if self.carrier >= scenario.obstacles.len() {
            let rule = "be the index of an obstacle or person of the world";
            let given = Given::Count(self.carrier as u64);
            return Err(Failure::invalid("carrier", rule, given));
        }
        let scatter = Stream::new(scenario.seed, SOUND_STREAM + index);
        Ok(Box::new(Localizing {
            carrier: self.carrier,
            standoff: self.standoff,
            ear: Ear::new(&self.fixes, scenario.control_period(), scatter),
            goal: None,
        }))
    }

    fn sight(&self, _scenario: &Scenario) -> Result<Option<(Regions, f64)>> {
        Ok(None)
    }
}

/// A localizer at work.
struct Localizing {
    carrier: usize,
    standoff: f64,
    ear: Ear,
    goal: Option<Vector2<f64>>,
}

impl Sensor for Localizing {
    fn observe(&mut self, truth: &Truth<'_>, known: &Frame, _bodies: &mut [Body]) {
        let carrier = truth.bodies.get(self.carrier);
        let source = carrier.filter(|body| body.state.present);
        self.ear
            .listen(source.map(|body| body.state.position.into()), known);
        if let Some(heard) = self.ear.heard() {
            let ahead = (heard.range - self.standoff).max(0.0);
            self.goal = Some(known.position + known.outward(heard.direction) * ahead);
        }
    }

    fn goal(&self) -> Option<Vector2<f64>> {
        self.goal
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots::HolonomicRobot;
    use crate::world::geometry::RobotState;
    use crate::world::motion::Motion;
    use crate::world::obstacle::{Limits, Obstacle};
    use crate::world::scenario::Rules;

    fn scenario() -> Scenario {
        let person = Obstacle::disc(0.3, Motion::at_rest([3.0, 4.0]), Limits::default()).unwrap();
        let robot = HolonomicRobot::default();
        Scenario::new(robot, [0.0; 2], [9.0, 0.0], vec![person], Rules::default()).unwrap()
    }

    fn localizer(carrier: usize) -> SoundLocalizer {
        SoundLocalizer {
            carrier,
            standoff: 1.0,
            fixes: Fixes {
                interval: 1.0,
                noise: FixNoise::none(),
                mirrored: false,
            },
        }
    }

    /// Goal that a localizer tells a robot at rest at the origin, with a front in rad, at successive samples.
    fn goals(places: &[Option<[f64; 2]>], front: f64) -> Vec<Option<Vector2<f64>>> {
        let scenario = scenario();
        let mut sensor = localizer(0).at_work(&scenario, 0).unwrap();
        let known = Frame::at([0.0; 2], front);
        let robot = RobotState {
            position: Vector2::zeros(),
            velocity: Vector2::zeros(),
        };
        let listen = |place: &Option<[f64; 2]>| {
            let placed = &scenario.obstacles[0];
            let mut body = Body {
                shape: placed.obstacle.shape,
                regions: placed.regions,
                state: placed.obstacle.motion.at(0.0, &mut 0),
            };
            body.state.present = place.is_some();
            body.state.position = place.unwrap_or([99.0; 2]);
            let bodies = [body];
            sensor.observe(&Truth::among(0.0, robot, front, &bodies), &known, &mut []);
            sensor.goal()
        };
        places.iter().map(listen).collect()
    }

    #[test]
    fn the_goal_is_at_the_standoff_before_the_source_whatever_the_robot_faces() {
        for front in [0.0, 1.0, -2.5] {
            let found = goals(&[Some([3.0, 4.0])], front)[0].unwrap();
            assert!((found - Vector2::new(2.4, 3.2)).norm() < 1e-12);
        }
    }

    #[test]
    fn between_bursts_the_last_goal_counts_and_who_is_absent_is_not_heard() {
        // A burst each second, a sample each 0.06 s: the second place is not heard before sample 17.
        let mut places = vec![Some([3.0, 4.0])];
        places.resize(18, Some([6.0, 8.0]));
        let found = goals(&places, 0.0);
        assert_eq!(found[16], found[0]);
        assert!((found[17].unwrap() - Vector2::new(5.4, 7.2)).norm() < 1e-12);
        assert_eq!(goals(&[None], 0.0)[0], None);
    }

    #[test]
    fn the_carrier_is_one_of_the_world() {
        let scenario = scenario();
        assert!(localizer(0).at_work(&scenario, 0).is_ok());
        assert!(localizer(1).at_work(&scenario, 0).is_err());
    }
}
