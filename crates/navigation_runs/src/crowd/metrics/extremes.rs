//! Extremes of what an episode holds, from which follows for most episodes that nothing of it is in doubt.

use super::episode::ObservedEpisode;

/// Names of the extremes, as [`Extremes::into_array`] has them.
pub const EXTREMES: [&str; 6] = [
    "step",
    "robot_radius",
    "least_person_radius",
    "greatest_person_radius",
    "person_speed",
    "may_be_passed",
];

/// Extremes of an episode; NaN without people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Time between two instants, in s.
    pub step: f64,
    /// Radius of the robot, in m.
    pub robot_radius: f64,
    /// Least radius of a person, in m.
    pub least_person_radius: f64,
    /// Greatest one, in m.
    pub greatest_person_radius: f64,
    /// Greatest mean speed from the first to the last instant of who is there at both, in m/s; NaN of nobody.
    pub person_speed: f64,
    /// Whether somebody may touch the robot between two instants, and at none of them.
    pub may_be_passed: bool,
}

impl Extremes {
    pub(super) fn of(episode: &ObservedEpisode<'_>, may_be_passed: bool) -> Self {
        let (rules, people) = (&episode.rules, &episode.people);
        let last = people.instants().saturating_sub(1);
        let mut way = f64::NAN;
        if last > 0 {
            // A way that is not a number is not the greatest.
            for (from, to) in people.at(0).iter().zip(people.at(last)) {
                way = way.max((to - from).norm());
            }
        }
        let radii = episode.radii.iter().copied();
        Self {
            step: rules.step,
            robot_radius: rules.robot_radius,
            least_person_radius: radii.clone().fold(f64::NAN, f64::min),
            greatest_person_radius: radii.fold(f64::NAN, f64::max),
            person_speed: way / (last as f64 * rules.step),
            may_be_passed,
        }
    }

    /// The values by [`EXTREMES`].
    #[must_use]
    pub fn into_array(self) -> [f64; EXTREMES.len()] {
        [
            self.step,
            self.robot_radius,
            self.least_person_radius,
            self.greatest_person_radius,
            self.person_speed,
            f64::from(u8::from(self.may_be_passed)),
        ]
    }
}
