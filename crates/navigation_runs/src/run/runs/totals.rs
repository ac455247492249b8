//! Results of a run that has ended.

use super::LaneState;
use crate::run::outcome::{CONTACT_SPEED, Contact, ContactCounts, Outcome, RunSummary, RunTotals};
use crate::run::record::Recorder;
use crate::run::scene::World;
use numeric::lanes::{Real, Truth};

impl<W: World, R: Real> LaneState<W, R> {
    /// Least distance `d` to an obstacle in m; infinite if it was never present.
    pub fn min_distance(&self, obstacle: usize, lane: usize) -> f64 {
        self.min_distance_squared[obstacle].lane(lane).sqrt()
    }

    /// First contact with an obstacle.
    fn contact(&self, obstacle: usize, lane: usize) -> Option<Contact> {
        self.touches[obstacle * R::WIDTH + lane].first
    }

    /// Whether an obstacle appeared in the scene where the robot was.
    fn apart(&self, obstacle: usize, lane: usize) -> bool {
        self.touches[obstacle * R::WIDTH + lane].apart
    }

    /// First contact with a map: it stands, so that a robot that moves comes toward it, and is always at fault.
    fn map_contact(&self, lane: usize) -> Option<Contact> {
        let walls = self.walls.as_ref()?;
        let (time, speed) = (
            walls.contact_time.lane(lane),
            walls.contact_speed.lane(lane),
        );
        (!time.is_nan()).then_some(Contact {
            time,
            speed,
            toward: speed > CONTACT_SPEED,
            at_fault: true,
        })
    }

    /// Least distance of the surfaces from the maps in m; infinite without any.
    fn map_clearance(&self, lane: usize) -> f64 {
        let walls = self.walls.as_ref();
        walls.map_or(f64::INFINITY, |walls| walls.least.lane(lane))
    }

    /// Totals of the run of a lane, whatever the number of obstacles.
    pub fn totals(&self, lane: usize, recorder: &impl Recorder<R>) -> RunTotals {
        let obstacles = 0..self.scenario.of_lane(lane).obstacle_count();
        let touched = obstacles.clone();
        let touched = touched.filter_map(|obstacle| self.contact(obstacle, lane));
        let apart = obstacles.map(|obstacle| self.apart(obstacle, lane));
        let contacts = ContactCounts::of(touched, self.map_contact(lane), apart);
        let arrival_time = self.arrival_time.lane(lane);
        let outcome = if contacts.any() {
            Outcome::Collided
        } else if !arrival_time.is_nan() {
            Outcome::Arrived
        } else if self.stopped.lane(lane) {
            Outcome::Stopped
        } else {
            Outcome::TimedOut
        };
        RunTotals {
            outcome,
            end_time: self.end_time.lane(lane),
            arrival_time,
            energy: self.squared_current.lane(lane) * self.wheels.loss_per_square(),
            path_length: self.path.lane(lane),
            contacts,
            map_clearance: self.map_clearance(lane),
            descent_share: recorder.descent_share(lane),
            force_evaluations: count_of(self.force_evaluations.lane(lane)),
        }
    }

    /// Everything that is left of the run of a lane.
    pub fn summary(&self, lane: usize, recorder: &impl Recorder<R>) -> RunSummary {
        let totals = self.totals(lane, recorder);
        let obstacles = 0..self.scenario.of_lane(lane).obstacle_count();
        let distance = |obstacle| self.min_distance(obstacle, lane);
        let contact = |obstacle| self.contact(obstacle, lane);
        RunSummary {
            outcome: totals.outcome,
            end_time: totals.end_time,
            arrival_time: (!totals.arrival_time.is_nan()).then_some(totals.arrival_time),
            energy: totals.energy,
            path_length: totals.path_length,
            min_distance: obstacles.clone().map(distance).collect(),
            contact: obstacles.clone().map(contact).collect(),
            apart: obstacles
                .map(|obstacle| self.apart(obstacle, lane))
                .collect(),
            map_contact: self.map_contact(lane),
            map_clearance: totals.map_clearance,
            descent_share: totals.descent_share,
            force_evaluations: totals.force_evaluations,
        }
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a counted number of samples
fn count_of(whole: f64) -> u64 {
    whole as u64
}
