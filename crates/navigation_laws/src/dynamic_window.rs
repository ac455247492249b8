//! Dynamic window of Fox, Burgard and Thrun, "The dynamic window approach to collision avoidance", IEEE Robotics and
//! Automation Magazine 4(1), 1997, without smoothing.

use std::f64::consts::PI;

use crate::local_planning::{
    Choice, Gaps, Mode, Pose, Prediction, TwistFamily, TwistPlanner, View, arc, evenly, numbers,
    wrap,
};
use navigation_world::arguments::{Arguments, Named};
use numeric::error::{Result, not_negative, positive};

/// Arcs are followed for so many m, `D`.
const REACH: f64 = 3.0;
/// A gap that is none, in m.
const TOUCH: f64 = 0.001;
/// Slower robots turn in place, in m/s.
const STILL: f64 = 1e-9;
/// Scores nearer than this are equal.
const EQUAL: f64 = 1e-12;
/// Speeds and turn rates that are tried.
const SPEEDS: usize = 11;
const TURN_RATES: usize = 21;
/// Most steps along an arc; a longer one counts as free up to there.
const MOST_STEPS: usize = 10_000;

/// Parameters; heading, dist and velocity are the weights of the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicWindow {
    /// Weight `h` of the heading.
    pub heading: f64,
    /// Weight `d` of the distance that is free.
    pub dist: f64,
    /// Weight `s` of the speed.
    pub velocity: f64,
    /// `a` in m/s^2.
    pub acceleration: f64,
    /// `b` in m/s^2.
    pub braking: f64,
    /// `alpha` in rad/s^2.
    pub turn_acceleration: f64,
    /// `beta` in rad/s^2.
    pub turn_braking: f64,
    /// Largest turn rate in rad/s.
    pub max_turn_rate: f64,
    /// How people go on.
    pub prediction: Prediction,
}

numbers!(DynamicWindow {
    heading, dist, velocity, acceleration, braking, turn_acceleration, turn_braking, max_turn_rate,
} beside {
    prediction: Prediction::given,
});

impl Named for DynamicWindow {
    const NAME: &'static str = "dynamic_window";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Self::given(given)
    }
}

impl TwistFamily for DynamicWindow {
    type Planner = Self;

    fn planner(&self, _seed: u64) -> Self {
        *self
    }
}

impl DynamicWindow {
    fn checked(self) -> Result<Self> {
        for (name, weight) in [
            ("heading", self.heading),
            ("dist", self.dist),
            ("velocity", self.velocity),
        ] {
            not_negative(name, weight)?;
        }
        positive("acceleration", self.acceleration)?;
        positive("braking", self.braking)?;
        positive("turn_acceleration", self.turn_acceleration)?;
        positive("turn_braking", self.turn_braking)?;
        positive("max_turn_rate", self.max_turn_rate)?;
        Ok(self)
    }

    /// Distance along an arc in m up to a contact, `D` at most.
    fn free(
        &self,
        gaps: &Gaps<'_>,
        pose: &Pose,
        [speed, turn_rate]: [f64; 2],
        fastest: f64,
    ) -> f64 {
        let gap = gaps.at(pose.position, 0.0, self.prediction);
        if speed <= STILL {
            return if gap > TOUCH { REACH } else { 0.0 };
        }
        let front = pose.front();
        let (per_meter, approach) = (turn_rate / speed, 1.0 + fastest / speed);
        let (mut length, mut gap) = (0.0, gap);
        for _ in 0..MOST_STEPS {
            // A gap that is no number is none.
            if gap.is_nan() || gap <= TOUCH {
                return length;
            }
            length += gap / approach;
            if length >= REACH {
                return REACH;
            }
            let place = pose.position + arc(front, length, per_meter * length);
            gap = gaps.at(place, length / speed, self.prediction);
        }
        length
    }
}

impl TwistPlanner for DynamicWindow {
    fn choose(&mut self, view: &View<'_>) -> Choice {
        let (period, most) = (view.period, view.max_speed);
        let [speed, _, turn_rate] = view.twist;
        let slowest = (speed - self.acceleration * period).max(0.0).min(most);
        let fastest = (speed + self.acceleration * period).min(most).max(slowest);
        let (limit, change) = (self.max_turn_rate, self.turn_acceleration * period);
        let [right, left] =
            [turn_rate - change, turn_rate + change].map(|rate| rate.clamp(-limit, limit));
        let (pose, front) = (&view.pose, view.pose.front());
        let people = view.gaps.fastest(self.prediction);
        let mut best = Choice::BLOCKED;
        for speed in evenly(slowest, fastest, SPEEDS) {
            for turn_rate in evenly(right, left, TURN_RATES) {
                let free = self.free(view.gaps, pose, [speed, turn_rate], people);
                let stops = speed <= (2.0 * free * self.braking).sqrt()
                    && turn_rate.abs() <= (2.0 * free * self.turn_braking).sqrt();
                if free < REACH && !stops {
                    continue;
                }
                let turn = turn_rate * period;
                let place = pose.position + arc(front, speed * period, turn);
                let to = view.local_goal - place;
                let halt = turn_rate * turn_rate.abs() / (2.0 * self.turn_braking);
                let error = wrap(to.y.atan2(to.x) - (pose.heading + turn + halt));
                let score = self.heading * (1.0 - error.abs() / PI)
                    + self.dist * free / REACH
                    + self.velocity * speed / most;
                if best.score.is_none_or(|known| score > known + EQUAL) {
                    best = Choice {
                        twist: [speed, 0.0, turn_rate],
                        score: Some(score),
                        mode: Mode::Track,
                    };
                }
            }
        }
        best
    }
}
