//! Contacts with people, and who brought them about; contacts with walls.

use numeric::order::sort_indices;

use crate::crowd::walls::Wall;
use numeric::lanes::Vector2;

use super::episode::ObservedEpisode;

/// Speeds that differ by no more are equal, in m/s.
const ALIKE: f64 = 1e-9;
/// Bodies whose centers are nearer than this have no direction between them, in m.
const NOWHERE: f64 = 1e-9;

/// A person who is touched at an instant, or in the step that ends there.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Touch {
    pub person: usize,
    pub instant: usize,
}

/// Events up to the end; an event is a longest run of instants in which one person is touched, or
/// a step within which one is, on straight ways, and at neither end.
pub(super) struct Contacts {
    pub robot_on_person: u32,
    pub person_on_robot: u32,
    pub mutual: u32,
    pub max_closing_speed: f64,
    pub walls: u32,
    pub wall_clearance: f64,
}

impl Contacts {
    pub fn of(episode: &ObservedEpisode<'_>, end: usize, touches: &[Touch]) -> Self {
        let (walls, wall_clearance) = at_walls(episode, end);
        let mut contacts = Self {
            robot_on_person: 0,
            person_on_robot: 0,
            mutual: 0,
            max_closing_speed: 0.0,
            walls,
            wall_clearance,
        };
        let mut order: Vec<usize> = (0..touches.len()).collect();
        sort_indices(&mut order, &mut |one, other| {
            touches[*one].cmp(&touches[*other])
        });
        let mut before: Option<Touch> = None;
        for Touch { person, instant } in order.iter().map(|index| touches[*index]) {
            let goes_on =
                before.is_some_and(|last| last.person == person && last.instant + 1 == instant);
            if !goes_on {
                contacts.add(closing(episode, (instant, end), person));
            }
            before = Some(Touch { person, instant });
        }
        contacts
    }

    /// Whether nothing was touched.
    pub fn none(&self) -> bool {
        self.robot_on_person + self.person_on_robot + self.mutual + self.walls == 0
    }

    /// Adds an event with the speeds of robot and person toward each other.
    fn add(&mut self, [robot, person]: [f64; 2]) {
        self.max_closing_speed = self.max_closing_speed.max(robot + person);
        let kind = if (robot - person).abs() <= ALIKE {
            &mut self.mutual
        } else if robot > person {
            &mut self.robot_on_person
        } else {
            &mut self.person_on_robot
        };
        *kind += 1;
    }
}

/// From the robot to a person.
#[inline]
fn offset(episode: &ObservedEpisode<'_>, instant: usize, person: usize) -> Vector2<f64> {
    let place = episode.people.at(instant)[person];
    episode.rules.period.wrap(place - episode.robot[instant])
}

/// Speeds of robot and person toward each other over the step into a contact; over the next step where
/// there is none before.
fn closing(
    episode: &ObservedEpisode<'_>,
    (instant, end): (usize, usize),
    person: usize,
) -> [f64; 2] {
    let (people, step) = (&episode.people, episode.rules.step);
    let came = instant > 0 && people.place(instant - 1, person).is_some();
    let start = if came { instant - 1 } else { instant };
    let to_person = offset(episode, start, person);
    let distance = to_person.norm();
    let toward = if distance < NOWHERE {
        Vector2::x()
    } else {
        to_person / distance
    };
    if start >= end {
        return [0.0; 2];
    }
    let mut robot = (episode.robot[start + 1] - episode.robot[start]) / step;
    let mut toward = toward;
    if let Some(body) = &episode.body {
        let turning;
        [toward, turning] = body.toward(start, to_person, step);
        robot += turning;
    }
    let other = people.velocity(start, person, step).unwrap_or_default();
    [robot.dot(&toward).max(0.0), (-other.dot(&toward)).max(0.0)]
}

/// Number of contacts with walls, those within steps too, and least distance to one, in m.
fn at_walls(episode: &ObservedEpisode<'_>, end: usize) -> (u32, f64) {
    let (mut count, mut least, mut touched) = (0, f64::INFINITY, false);
    if episode.walls.is_empty() {
        return (count, least);
    }
    let mut before = episode.robot[0];
    for (instant, place) in episode.robot[..=end].iter().enumerate() {
        // Where the world repeats itself, the robot may have been put to the other side of it.
        let from = place - episode.rules.period.wrap(place - before);
        let radius = episode.rules.robot_radius;
        let gaps = episode.walls.iter();
        let gap = gaps.fold(f64::INFINITY, |least, wall| {
            let gap = match &episode.body {
                None => wall.gap_on_way(from, *place, radius),
                Some(body) => body.gap_on_way(wall, instant, [from, *place]),
            };
            least.min(gap)
        });
        let touches = gap < 0.0;
        count += u32::from(touches && !touched);
        // What was touched on the way only is left again.
        let clear = |wall: &Wall| match &episode.body {
            None => wall.clearance(*place) >= radius,
            Some(body) => body.gap_on_way(wall, instant, [*place; 2]) >= 0.0,
        };
        touched = touches && !episode.walls.iter().all(clear);
        least = least.min(gap);
        before = *place;
    }
    (count, least)
}
