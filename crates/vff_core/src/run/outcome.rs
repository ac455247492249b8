//! What is left of a run.

/// A robot faster than this at a contact was moving, in m/s.
pub const CONTACT_SPEED: f64 = 0.05;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Reached the goal without a contact.
    Arrived,
    /// Touched an obstacle, whatever came after.
    Collided,
    /// Ran out of time.
    TimedOut,
    /// Stood still for good.
    Stopped,
}

impl Outcome {
    /// Every outcome.
    pub const ALL: [Self; 4] = [Self::Arrived, Self::Collided, Self::TimedOut, Self::Stopped];

    /// Its word, and what it says.
    #[must_use]
    pub fn words(self) -> [&'static str; 2] {
        match self {
            Self::Arrived => ["arrived", "arrived without a contact"],
            Self::Collided => ["collided", "touched an obstacle"],
            Self::TimedOut => ["timed_out", "timed out"],
            Self::Stopped => ["stopped", "stopped before the goal"],
        }
    }

    /// Its word.
    #[must_use]
    pub fn word(self) -> &'static str {
        self.words()[0]
    }
}

/// What is left of a run in the same few numbers for every scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunTotals {
    /// How it ended.
    pub outcome: Outcome,
    /// When it ended, in s.
    pub end_time: f64,
    /// First entry into the circle around the goal, in s; NaN without arrival.
    pub arrival_time: f64,
    /// Electrical loss in J.
    pub energy: f64,
    /// Length of the path in m.
    pub path_length: f64,
    /// Obstacles touched while the robot was moving, and while it stood; the maps count as one.
    pub contacts: [u32; 2],
    /// Obstacles toward which it moved, faster than [`CONTACT_SPEED`], at some instant of a contact;
    /// every contact with a map counts.
    pub at_fault: u32,
    /// Least distance of the surfaces from the maps in m; infinite without any.
    pub map_clearance: f64,
    /// Share of the control periods over which the Lyapunov function did not grow, if counted.
    pub descent_share: f64,
    /// Number of samples of the force.
    pub force_evaluations: u64,
}

/// First contact with an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// When, in s.
    pub time: f64,
    /// Speed of the robot then, in m/s.
    pub speed: f64,
    /// Whether the robot moved toward the obstacle at any instant of a contact with it.
    pub at_fault: bool,
}

/// What is left of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSummary {
    /// How it ended.
    pub outcome: Outcome,
    /// When it ended, in s.
    pub end_time: f64,
    /// First entry into the circle around the goal, in s.
    pub arrival_time: Option<f64>,
    /// Electrical loss in J.
    pub energy: f64,
    /// Length of the path in m.
    pub path_length: f64,
    /// Least distance `d` to each obstacle in m; infinite if it was never present.
    pub min_distance: Vec<f64>,
    /// First contact with each obstacle.
    pub contact: Vec<Option<Contact>>,
    /// First contact with a map.
    pub map_contact: Option<Contact>,
    /// Least distance of the surfaces from the maps in m; infinite without any.
    pub map_clearance: f64,
    /// Share of the control periods over which the Lyapunov function did not grow, if counted.
    pub descent_share: f64,
    /// Number of samples of the force.
    pub force_evaluations: u64,
}

impl RunSummary {
    /// The same in the numbers that every scenario has.
    #[must_use]
    pub fn totals(&self) -> RunTotals {
        let (mut contacts, mut at_fault) = ([0, 0], 0);
        for touch in self.contact.iter().chain([&self.map_contact]).flatten() {
            contacts[usize::from(touch.speed <= CONTACT_SPEED)] += 1;
            at_fault += u32::from(touch.at_fault);
        }
        RunTotals {
            outcome: self.outcome,
            end_time: self.end_time,
            arrival_time: self.arrival_time.unwrap_or(f64::NAN),
            energy: self.energy,
            path_length: self.path_length,
            contacts,
            at_fault,
            map_clearance: self.map_clearance,
            descent_share: self.descent_share,
            force_evaluations: self.force_evaluations,
        }
    }
}
