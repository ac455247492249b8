//! Dynamic window of Fox, Burgard and Thrun, "The dynamic window approach to collision avoidance", IEEE Robotics and
//! Automation Magazine 4(1), 1997, without smoothing.

use std::f64::consts::PI;

use crate::local_planning::{
    Each, EachVector, LaneGaps, LocalView, Mode, PeopleMotion, TwistChoice, TwistFamily,
    TwistPlanner, WIDTH, all, arc, evenly, numbers, wrap,
};
use navigation_world::arguments::{Arguments, Named};
use numeric::elementary::cosine_and_sine;
use numeric::error::{Result, not_negative, positive};
use numeric::lanes::{Number, Planar, Real, Truth, Vector2, vectors};

/// Arcs are followed for so many m, `D`.
const REACH: f64 = 3.0;
/// A gap that is none, in m.
const TOUCH: f64 = 0.001;
/// Slower robots turn in place, in m/s.
const STILL: f64 = 1e-9;
/// Half turns below this are straight, in rad: the arc differs by less than its rounding.
const STRAIGHT: f64 = 1e-9;
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
    /// Motion of people that is predicted.
    pub prediction: PeopleMotion,
}

numbers!(DynamicWindow {
    heading, dist, velocity, acceleration, braking, turn_acceleration, turn_braking, max_turn_rate,
} beside {
    prediction: PeopleMotion::given,
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
}

/// Arcs of a speed side by side.
struct Arcs<'a> {
    gaps: LaneGaps<'a>,
    position: EachVector,
    front: EachVector,
    /// Speed of the fastest person in m/s.
    fastest: f64,
    /// Gap where the robot is, in m.
    here: f64,
}

impl Arcs<'_> {
    /// Distances along the arcs of a speed and turn rates, in m, up to a contact, `D` at most.
    #[inline(always)]
    fn free(&self, speed: f64, turn_rates: Each) -> Each {
        if speed <= STILL {
            return Each::splat(if self.here > TOUCH { REACH } else { 0.0 });
        }
        let (touch, reach, straight) = (
            Each::splat(TOUCH),
            Each::splat(REACH),
            Each::splat(STRAIGHT),
        );
        let half_turn = turn_rates * (0.5 / speed);
        let per_approach = Each::splat(1.0 / (1.0 + self.fastest / speed));
        let mut length = Each::splat(0.0);
        let mut gap = Each::splat(self.here);
        let mut going = all(true);
        for _ in 0..MOST_STEPS {
            // A gap that is no number is none.
            going = going & gap.gt(touch);
            length = Each::select(going, length + gap * per_approach, length);
            let over = length.ge(reach);
            length = Each::select(over, reach, length);
            going = going & !over;
            if !going.any() {
                break;
            }
            // The chord of the arc, half way through the turn.
            let half = half_turn * length;
            let [cosine, sine] = cosine_and_sine(half);
            let bent = length * sine / half;
            let chord = Each::select(half.abs().lt(straight), length, bent);
            let way = EachVector::new(
                self.front.x * cosine - self.front.y * sine,
                self.front.x * sine + self.front.y * cosine,
            );
            let times = length * (1.0 / speed);
            gap = self.gaps.at(self.position + way * chord, times, going);
        }
        length
    }
}

impl TwistPlanner for DynamicWindow {
    fn choose(&mut self, view: &LocalView<'_>) -> TwistChoice {
        let search = Search { law: self, view };
        match vectors() {
            Some(vectors) => pulp::Simd::vectorize(vectors, search),
            None => search.run(),
        }
    }
}

/// A search among all twists, in vectors of the processor where it has them.
struct Search<'a, 'v> {
    law: &'a DynamicWindow,
    view: &'a LocalView<'v>,
}

impl pulp::NullaryFnOnce for Search<'_, '_> {
    type Output = TwistChoice;

    #[inline(always)]
    fn call(self) -> TwistChoice {
        self.run()
    }
}

impl Search<'_, '_> {
    #[inline(always)]
    fn run(self) -> TwistChoice {
        let Self { law, view } = self;
        let (period, most) = (view.period, view.max_speed);
        let [speed, _, turn_rate] = view.twist;
        let slowest = (speed - law.acceleration * period).max(0.0).min(most);
        let fastest = (speed + law.acceleration * period).min(most).max(slowest);
        let (limit, change) = (law.max_turn_rate, law.turn_acceleration * period);
        let [right, left] =
            [turn_rate - change, turn_rate + change].map(|rate| rate.clamp(-limit, limit));
        let (pose, front) = (&view.pose, view.pose.front());
        let arcs = Arcs {
            gaps: LaneGaps::new(view.gaps, law.prediction, f64::INFINITY),
            position: EachVector::splat(pose.position.into()),
            front: EachVector::splat(front.into()),
            fastest: view.gaps.fastest(law.prediction),
            here: view.gaps.at(pose.position, 0.0, law.prediction),
        };
        let mut rates = [left; TURN_RATES.next_multiple_of(WIDTH)];
        for (rate, value) in rates.iter_mut().zip(evenly(right, left, TURN_RATES)) {
            *rate = value;
        }
        let mut best = TwistChoice::BLOCKED;
        for speed in evenly(slowest, fastest, SPEEDS) {
            for (block, rates) in rates.chunks(WIDTH).enumerate() {
                let free = arcs.free(speed, Each::from_fn(|lane| rates[lane]));
                for (lane, &turn_rate) in rates.iter().enumerate() {
                    if block * WIDTH + lane < TURN_RATES {
                        law.weigh(view, front, [speed, turn_rate], free.lane(lane), &mut best);
                    }
                }
            }
        }
        best
    }
}

impl DynamicWindow {
    /// Takes a twist with a distance that is free if it is admissible and better than the best.
    #[inline(always)]
    fn weigh(
        &self,
        view: &LocalView<'_>,
        front: Vector2<f64>,
        [speed, turn_rate]: [f64; 2],
        free: f64,
        best: &mut TwistChoice,
    ) {
        let stops = speed <= (2.0 * free * self.braking).sqrt()
            && turn_rate.abs() <= (2.0 * free * self.turn_braking).sqrt();
        if free < REACH && !stops {
            return;
        }
        let (pose, turn) = (&view.pose, turn_rate * view.period);
        let place = pose.position + arc(front, speed * view.period, turn);
        let to = view.local_goal - place;
        let halt = turn_rate * turn_rate.abs() / (2.0 * self.turn_braking);
        let error = wrap(to.y.atan2(to.x) - (pose.heading + turn + halt));
        let score = self.heading * (1.0 - error.abs() / PI)
            + self.dist * free / REACH
            + self.velocity * speed / view.max_speed;
        if best.score.is_none_or(|known| score > known + EQUAL) {
            *best = TwistChoice {
                twist: [speed, 0.0, turn_rate],
                score: Some(score),
                mode: Mode::Track,
            };
        }
    }
}
