//! How near people are: clearances, zones, time to a collision, groups, social forces.

use numeric::order::sort_indices;

use crate::crowd::neighbors::grid::Period;
use numeric::lanes::Vector2;

use super::contacts::Touch;
use super::episode::ObservedEpisode;
use super::pressure::Pressures;

/// Ends of the intimate, personal and social zones of E. T. Hall (1966), in m.
const ZONES: [f64; 3] = [0.45, 1.2, 3.6];
/// Clearance from which on a robot is comfortable, in m.
const COMFORT: f64 = 0.5;
/// Clearance below which it is uncomfortable, in m.
const DISCOMFORT: f64 = 0.2;
/// A time to a collision below it is low, in s.
const LOW_TIME: f64 = 2.0;
/// Relative change of lengths and times by rounding: far more than it is.
const SLACK: f64 = 1e-9;

/// Metrics of the distances to people.
pub(super) struct Proximity {
    pub min_clearance: f64,
    pub mean_clearance: f64,
    pub intimate_share: f64,
    pub personal_share: f64,
    pub social_share: f64,
    pub comfort_share: f64,
    pub discomfort_time: f64,
    pub min_time_to_collision: f64,
    pub low_time_to_collision_share: f64,
    pub group_intrusion_share: f64,
    pub force_on_people: f64,
    pub force_on_robot: f64,
    /// Whether somebody may touch the robot within a step and at no instant.
    pub may_be_passed: bool,
}

/// Sums over the instants.
#[derive(Default)]
struct Sums {
    clearance: f64,
    with_people: u32,
    zones: [u32; 3],
    comfort: u32,
    discomfort: u32,
    low_time: u32,
    intrusion: u32,
}

impl Proximity {
    /// Looks at everybody once at every instant, and tells who is touched.
    pub fn of(episode: &ObservedEpisode<'_>, end: usize) -> (Self, Vec<Touch>) {
        let groups = members(episode.groups);
        let mut sums = Sums::default();
        let mut watch = Watch {
            end,
            pressures: Pressures::new(),
            touches: Vec::new(),
            touched: Vec::new(),
            passing: Vec::new(),
        };
        let (mut least, mut least_time) = (f64::INFINITY, f64::INFINITY);
        for instant in 0..=end {
            let near = watch.at(episode, instant);
            sums.count(&near, instant < end);
            least = least.min(near.gap).min(near.passed);
            least_time = least_time.min(near.time);
            let intruded = groups.iter().any(|group| intrudes(episode, instant, group));
            sums.intrusion += u32::from(intruded);
        }
        // Where the world repeats itself, somebody may have been put to the other side of it.
        let may_be_passed = if episode.rules.period == Period::default() {
            watch.is_passed()
        } else {
            least_time <= episode.rules.step * (1.0 + SLACK)
        };
        let [force_on_people, force_on_robot] = watch.pressures.sums();
        let (step, steps) = (episode.rules.step, end as f64);
        let share = |count: u32| f64::from(count) / (steps + 1.0);
        let proximity = Self {
            min_clearance: least,
            mean_clearance: sums.clearance / f64::from(sums.with_people),
            intimate_share: share(sums.zones[0]),
            personal_share: share(sums.zones[1]),
            social_share: share(sums.zones[2]),
            comfort_share: share(sums.comfort),
            discomfort_time: f64::from(sums.discomfort) * step,
            min_time_to_collision: least_time,
            low_time_to_collision_share: f64::from(sums.low_time) / steps,
            group_intrusion_share: share(sums.intrusion),
            force_on_people: force_on_people * step,
            force_on_robot: force_on_robot * step,
            may_be_passed,
        };
        (proximity, watch.touches)
    }
}

/// Least distances at an instant; infinite without people.
struct Nearness {
    /// Between the surfaces, in m.
    gap: f64,
    /// Least gap to people who are touched within the next step only, on straight ways; negative.
    passed: f64,
    /// From the surface of the robot to a center, in m.
    zone: f64,
    /// To a collision over the next step, in s.
    time: f64,
}

/// Sums on the way.
struct Watch {
    end: usize,
    pressures: Pressures,
    touches: Vec<Touch>,
    /// Who is touched at an instant beyond all rounding, and who may be within a step.
    touched: Vec<usize>,
    passing: Vec<usize>,
}

impl Watch {
    /// Whether somebody may touch the robot within a step and at no instant.
    fn is_passed(&mut self) -> bool {
        self.touched.sort_unstable();
        let hidden = |person: &usize| self.touched.binary_search(person).is_err();
        self.passing.iter().any(hidden)
    }

    fn at(&mut self, episode: &ObservedEpisode<'_>, instant: usize) -> Nearness {
        let (rules, robot, people) = (&episode.rules, episode.robot, &episode.people);
        let next = instant + usize::from(instant < self.end);
        let velocity = (robot[next] - robot[instant]) / rules.step;
        let mut near = Nearness {
            gap: f64::INFINITY,
            passed: f64::INFINITY,
            zone: f64::INFINITY,
            time: f64::INFINITY,
        };
        let (step, scale) = (rules.step, robot[instant].norm());
        let moves = people.at(instant).iter().zip(people.at(next));
        for (person, ((from, to), radius)) in moves.zip(episode.radii).enumerate() {
            if from.x.is_nan() {
                continue;
            }
            let to_person = rules.period.wrap(from - robot[instant]);
            let distance = episode.distance(instant, to_person);
            let (zone, reach) = (distance - rules.robot_radius, rules.robot_radius + radius);
            near.zone = near.zone.min(zone);
            near.gap = near.gap.min(zone - radius);
            let (gap, slack) = (distance - reach, SLACK * (reach + scale));
            if gap < 0.0 {
                self.touches.push(Touch { person, instant });
            }
            if gap < -slack {
                self.touched.push(person);
            }
            if next == instant || to.x.is_nan() {
                continue;
            }
            let closing = (to - from) / rules.step - velocity;
            let time = time_to_collision(to_person, closing, reach);
            near.time = near.time.min(time);
            self.pressures.add(instant, to_person, closing);
            if let Some(body) = &episode.body {
                let moved = (to - from) - (robot[next] - robot[instant]);
                let end = to_person + rules.period.wrap(moved);
                let later = episode.distance(next, end) - reach;
                if gap >= 0.0 && later >= 0.0 && body.meets(instant, [to_person, end], *radius) {
                    self.passing.push(person);
                    near.passed = near.passed.min(-f64::MIN_POSITIVE);
                    self.touches.push(Touch {
                        person,
                        instant: next,
                    });
                }
                continue;
            }
            // Most are too far away to come here within a step; whoever is touched is told of already.
            let far = 1.01 * step * step * closing.norm_squared() + 101.0 * slack * slack;
            if gap >= -slack && gap * gap <= far {
                let time = time_to_collision(to_person, closing, reach + slack);
                if time <= step * (1.0 + SLACK) {
                    self.passing.push(person);
                }
                let moved = rules
                    .period
                    .wrap((to - from) - (robot[next] - robot[instant]));
                let end = to_person + moved;
                let least = nearest_between(to_person, end) - reach;
                if least < -slack && gap >= 0.0 && end.norm() >= reach {
                    near.passed = near.passed.min(least);
                    self.touches.push(Touch {
                        person,
                        instant: next,
                    });
                }
            }
        }
        near
    }
}

impl Sums {
    fn count(&mut self, near: &Nearness, moves: bool) {
        if near.gap < f64::INFINITY {
            self.clearance += near.gap;
            self.with_people += 1;
        }
        if let Some(zone) = ZONES.iter().position(|end| near.zone < *end) {
            self.zones[zone] += 1;
        }
        self.comfort += u32::from(near.gap >= COMFORT);
        self.discomfort += u32::from(moves && near.gap < DISCOMFORT);
        self.low_time += u32::from(moves && near.time < LOW_TIME);
    }
}

/// Least distance from zero to the points between two.
pub(crate) fn nearest_between(from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    let along = to - from;
    let squared = along.dot(&along);
    if squared == 0.0 {
        return to.norm();
    }
    let share = (-from.dot(&along) / squared).clamp(0.0, 1.0);
    (from + along * share).norm()
}

/// Least time `t >= 0` with `|r + w t| = reach`, 0 if nearer already, infinite if never, in s.
fn time_to_collision(offset: Vector2<f64>, closing: Vector2<f64>, reach: f64) -> f64 {
    let outside = offset.norm_squared() - reach * reach;
    if outside <= 0.0 {
        return 0.0;
    }
    let approach = -offset.dot(&closing);
    let square = approach * approach - closing.norm_squared() * outside;
    if approach <= 0.0 || square < 0.0 {
        return f64::INFINITY;
    }
    // The lesser root as a quotient: the difference in the other form would cancel.
    outside / (approach + square.sqrt())
}

/// Members of each group of two or more.
fn members(groups: &[i64]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..groups.len())
        .filter(|person| groups[*person] >= 0)
        .collect();
    sort_indices(&mut order, &mut |one, other| {
        (groups[*one], one).cmp(&(groups[*other], other))
    });
    let all = order.chunk_by(|one, other| groups[*one] == groups[*other]);
    let more = all.filter(|group| group.len() >= 2);
    more.map(<[usize]>::to_vec).collect()
}

/// Whether the robot is in the personal zone of a group, all of whom are present.
fn intrudes(episode: &ObservedEpisode<'_>, instant: usize, group: &[usize]) -> bool {
    let (rules, places) = (&episode.rules, episode.people.at(instant));
    let first = places[group[0]];
    // From the first one, so that a group is not torn apart where the world repeats; NaN if one is absent.
    let sum: Vector2<f64> = group
        .iter()
        .map(|person| rules.period.wrap(places[*person] - first))
        .sum();
    let center = first + sum / group.len() as f64;
    let place = rules.period.wrap(center - episode.robot[instant]);
    episode.distance(instant, place) - rules.robot_radius < ZONES[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crowd::metrics::{MetricRules, Paths};

    /// A robot of 0.3 m at zero, and somebody of 0.2 m who walks 1 m in each of two steps of 1 s.
    fn passed(start: [f64; 2]) -> (bool, usize) {
        let people = [0.0, 1.0, 2.0].map(|x| Vector2::new(start[0] + x, start[1]));
        let episode = ObservedEpisode {
            robot: &[Vector2::zeros(); 3],
            people: Paths::new("people", &people, 1).unwrap(),
            radii: &[0.2],
            groups: &[],
            walls: &[],
            without: None,
            body: None,
            rules: MetricRules {
                robot_radius: 0.3,
                ..MetricRules::of_people()
            },
        };
        let (found, touches) = Proximity::of(&episode, 2);
        (found.may_be_passed, touches.len())
    }

    #[test]
    fn who_may_pass_through_between_instants_is_told_of() {
        assert_eq!(passed([-0.5, 0.45]), (true, 1));
        assert_eq!(passed([-0.5, 0.51]), (false, 0));
        // At an instant, on the way to it, and gone before the first one.
        assert_eq!(passed([-1.0, 0.45]), (false, 1));
        assert_eq!(passed([-2.9, 0.0]), (false, 0));
        assert_eq!(passed([0.5, 0.1]), (false, 0));
        // Rounding decides nothing: grazed, and touched by less than it.
        assert_eq!(passed([-0.5, 0.5]), (true, 0));
        assert_eq!(passed([-1.0, 0.5 - 1e-12]), (true, 1));
    }

    #[test]
    fn the_time_to_a_collision_has_its_limits() {
        let (far, toward) = (Vector2::new(3.0, 0.0), Vector2::new(-2.0, 0.0));
        assert_eq!(time_to_collision(far, toward, 1.0), 1.0);
        assert_eq!(time_to_collision(far, -toward, 1.0), f64::INFINITY);
        assert_eq!(time_to_collision(far, Vector2::zeros(), 1.0), f64::INFINITY);
        assert_eq!(time_to_collision(far, toward, 3.0), 0.0);
        let aside = Vector2::new(3.0, 1.1);
        assert_eq!(time_to_collision(aside, toward, 1.0), f64::INFINITY);
    }
}
