//! Summary of a run.

/// A robot faster than this at a contact was moving, in m/s.
pub const CONTACT_SPEED: f64 = 0.05;

/// Overlap of two bodies in m from which on nobody is at fault any more: what walks on through a robot is
/// ahead of it at last, whoever came.
pub const DECIDED_OVERLAP: f64 = 0.1;

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

/// Totals of a run, the same few numbers for every scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunTotals {
    /// Outcome of the run.
    pub outcome: Outcome,
    /// When it ended, in s.
    pub end_time: f64,
    /// First entry into the circle around the goal, in s; NaN without arrival.
    pub arrival_time: f64,
    /// Electrical loss in J.
    pub energy: f64,
    /// Length of the path in m.
    pub path_length: f64,
    /// Contacts with obstacles and maps.
    pub contacts: ContactCounts,
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
    /// Whether the robot moved toward the obstacle then, faster than [`CONTACT_SPEED`].
    pub toward: bool,
    /// Whether the robot moved toward the body at any instant of a contact from the first touch until the bodies
    /// first overlap by [`DECIDED_OVERLAP`].
    pub at_fault: bool,
}

impl Contact {
    /// Whether the robot was moving.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        self.speed > CONTACT_SPEED
    }
}

/// Numbers of obstacles that were touched; the maps count as one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactCounts {
    /// While the robot was moving toward them.
    pub toward: u32,
    /// While it was moving, but not toward them.
    pub away: u32,
    /// While it stood.
    pub standing: u32,
    /// By its own fault; every contact with a map counts.
    pub at_fault: u32,
    /// Contacts with maps among all these: 1 or 0.
    pub walls: u32,
    /// Obstacles that appeared in the scene where the robot was, apart from all these.
    pub apart: u32,
}

impl ContactCounts {
    /// Of first contacts with obstacles and with the maps.
    pub fn of(
        obstacles: impl Iterator<Item = Contact>,
        map: Option<Contact>,
        apart: impl Iterator<Item = bool>,
    ) -> Self {
        let mut counts = Self {
            walls: u32::from(map.is_some()),
            apart: apart.map(u32::from).sum(),
            ..Self::default()
        };
        for touch in obstacles.chain(map) {
            let kind = match (touch.is_moving(), touch.toward) {
                (true, true) => &mut counts.toward,
                (true, false) => &mut counts.away,
                (false, _) => &mut counts.standing,
            };
            *kind += 1;
            counts.at_fault += u32::from(touch.at_fault);
        }
        counts
    }

    /// While the robot was moving.
    #[must_use]
    pub fn moving(&self) -> u32 {
        self.toward + self.away
    }

    /// Whether anything was touched.
    #[must_use]
    pub fn any(&self) -> bool {
        self.moving() + self.standing > 0
    }
}

/// Summary of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSummary {
    /// Outcome of the run.
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
    /// Whether each appeared in the scene where the robot was, and touched it then: counted apart.
    pub apart: Vec<bool>,
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
    /// Totals of the run, which every scenario has.
    #[must_use]
    pub fn totals(&self) -> RunTotals {
        let obstacles = self.contact.iter().flatten().copied();
        RunTotals {
            outcome: self.outcome,
            end_time: self.end_time,
            arrival_time: self.arrival_time.unwrap_or(f64::NAN),
            energy: self.energy,
            path_length: self.path_length,
            contacts: ContactCounts::of(obstacles, self.map_contact, self.apart.iter().copied()),
            map_clearance: self.map_clearance,
            descent_share: self.descent_share,
            force_evaluations: self.force_evaluations,
        }
    }
}
