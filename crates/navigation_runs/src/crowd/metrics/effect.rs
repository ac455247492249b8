//! Costs of a robot for people: differences between one world and seed with it and without.

use numeric::lanes::Vector2;

use super::episode::{KnownArrival, ObservedEpisode, Paths, Without};

/// Share of a step by which an arrival may miss an instant.
const ROUNDING: f64 = 1e-6;

/// Differences of the people, over all instants.
pub(super) struct Effect {
    pub delay: f64,
    pub detour: f64,
    pub blocked: u32,
    pub deviation: f64,
}

impl Effect {
    pub fn of(episode: &ObservedEpisode<'_>) -> Self {
        let Some(without) = &episode.without else {
            return Self {
                delay: f64::NAN,
                detour: f64::NAN,
                blocked: 0,
                deviation: f64::NAN,
            };
        };
        let (mut delay, mut detour, mut both, mut blocked) = (0.0, 0.0, 0, 0);
        for (person, goal) in without.goals.iter().enumerate() {
            let [with, alone] = match without.arrivals {
                None => [&episode.people, &without.people]
                    .map(|people| Arrival::near(people, episode, person, *goal)),
                Some([with, alone]) => {
                    [(&episode.people, with), (&without.people, alone)].map(|(people, known)| {
                        Arrival::known(people, person, &known[person], episode.rules.step)
                    })
                }
            };
            match (with, alone) {
                (Some(with), Some(alone)) => {
                    delay += with.time - alone.time;
                    detour += with.length - alone.length;
                    both += 1;
                }
                (None, Some(_)) => blocked += 1,
                (_, None) => {}
            }
        }
        Self {
            delay: delay / f64::from(both),
            detour: detour / f64::from(both),
            blocked,
            deviation: deviation(episode, without),
        }
    }
}

/// Arrival of a person.
pub(super) struct Arrival {
    /// When, in s.
    pub time: f64,
    /// Length of the path up to it, in m.
    pub length: f64,
}

impl Arrival {
    /// The first instant within the tolerance of the goal.
    pub fn near(
        people: &Paths<'_>,
        episode: &ObservedEpisode<'_>,
        person: usize,
        goal: Vector2<f64>,
    ) -> Option<Self> {
        let rules = &episode.rules;
        let (instant, length) = arrival(people, person, (goal, rules.person_tolerance))?;
        Some(Self {
            time: instant as f64 * rules.step,
            length,
        })
    }

    /// An arrival that is known, with the length of the path up to it.
    pub fn known(
        people: &Paths<'_>,
        person: usize,
        arrival: &KnownArrival,
        step: f64,
    ) -> Option<Self> {
        if arrival.time.is_nan() {
            return None;
        }
        let before = |instant: &usize| *instant as f64 <= arrival.time / step + ROUNDING;
        let recorded = (0..people.instants()).take_while(before);
        let places = recorded.filter_map(|instant| people.place(instant, person));
        let mut length = 0.0;
        let mut last: Option<Vector2<f64>> = None;
        for place in places.chain([arrival.place]) {
            length += last.map_or(0.0, |last| (place - last).norm());
            last = Some(place);
        }
        Some(Self {
            time: arrival.time,
            length,
        })
    }
}

/// First instant of a person within a tolerance of the goal, and the length of the path up to it.
pub(super) fn arrival(
    people: &Paths<'_>,
    person: usize,
    (goal, tolerance): (Vector2<f64>, f64),
) -> Option<(usize, f64)> {
    let mut length = 0.0;
    let mut before: Option<Vector2<f64>> = None;
    for instant in 0..people.instants() {
        let place = people.place(instant, person);
        if let Some(place) = place {
            length += before.map_or(0.0, |before| (place - before).norm());
            if (goal - place).norm() <= tolerance {
                return Some((instant, length));
            }
        }
        before = place;
    }
    None
}

/// Mean distance of the people from where they are without robots, over the instants at which both are there.
fn deviation(episode: &ObservedEpisode<'_>, without: &Without<'_>) -> f64 {
    let instants = episode.people.instants().min(without.people.instants());
    let (mut sum, mut count) = (0.0, 0_u64);
    for instant in 0..instants {
        let places = episode.people.at(instant).iter();
        for (place, alone) in places.zip(without.people.at(instant)) {
            let distance = (place - alone).norm();
            if !distance.is_nan() {
                sum += distance;
                count += 1;
            }
        }
    }
    sum / count as f64
}
