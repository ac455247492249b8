//! The list of metrics: name, kind, unit and meaning of each, from which rows, columns and documentation follow.

/// Unit of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number; NaN where it is not defined.
    Number,
    /// A count.
    Count,
    /// Yes or no.
    Flag,
}

impl Kind {
    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Number => "number",
            Self::Count => "count",
            Self::Flag => "flag",
        }
    }
}

/// Name, unit and meaning of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeclaredMetric {
    /// Its name, in every language and file.
    pub name: &'static str,
    /// Its unit.
    pub kind: Kind,
    /// Its unit; empty without one.
    pub unit: &'static str,
    /// Meaning in words.
    pub meaning: &'static str,
}

macro_rules! stored {
    (Number) => {
        f64
    };
    (Count) => {
        u32
    };
    (Flag) => {
        bool
    };
}

macro_rules! one {
    ($name:ident) => {
        1
    };
}

/// A row of values and the list that declares them.
macro_rules! declared {
    ($(#[$about:meta])* $row:ident, $list:ident { $($field:ident: $kind:ident, $unit:literal, $meaning:literal;)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $row {
            $(#[doc = concat!("The ", $meaning, " (unit: ", $unit, ").")] pub $field: stored!($kind),)*
        }

        impl $row {
            /// The values in the order of the list; a flag is 0 or 1.
            #[must_use]
            pub fn into_array(self) -> [f64; $list.len()] {
                [$(f64::from(self.$field),)*]
            }
        }

        #[doc = concat!("All values of [`", stringify!($row), "`] in their order.")]
        pub const $list: [DeclaredMetric; 0 $(+ one!($field))*] = [$(DeclaredMetric {
            name: stringify!($field),
            kind: Kind::$kind,
            unit: $unit,
            meaning: $meaning,
        },)*];
    };
}

declared! {
    /// How a robot fared among people.
    RobotMetrics, ROBOT_METRICS {
        arrived: Flag, "", "whether the robot came within the tolerance of its goal";
        arrival_time: Number, "s", "time until then; NaN without arrival";
        final_goal_distance: Number, "m", "distance to the goal at the end";
        success: Flag, "", "whether it arrived without touching people or walls";
        path_length: Number, "m", "length of the path";
        path_length_ratio: Number, "", "shortest length over the longer of both; NaN without arrival";
        spl: Number, "", "path length ratio of a success, else 0";
        path_irregularity: Number, "rad", "mean angle between the motion and the direction of the goal";
        heading_change: Number, "rad", "sum of the turns from one step to the next";
        mean_speed: Number, "m/s", "mean speed";
        max_speed: Number, "m/s", "greatest speed";
        efficacy: Number, "", "mean speed toward the goal over the greatest one allowed";
        mean_acceleration: Number, "m/s^2", "mean acceleration";
        max_acceleration: Number, "m/s^2", "greatest acceleration";
        mean_jerk: Number, "m/s^3", "mean jerk";
        stalled_time: Number, "s", "time with less than 0.05 m/s";
        longest_without_progress: Number, "s", "longest time in which the goal came less than 0.1 m nearer";
        frozen: Flag, "", "whether that time was 5 s or more";
        min_clearance: Number, "m", "least distance between the surfaces of robot and people";
        mean_clearance: Number, "m", "mean over the instants with people of the distance to the nearest";
        wall_clearance: Number, "m", "least distance to a wall";
        intimate_share: Number, "", "share of instants with a person's center nearer than 0.45 m";
        personal_share: Number, "", "share of instants with the nearest center from 0.45 to 1.2 m";
        social_share: Number, "", "share of instants with the nearest center from 1.2 to 3.6 m";
        comfort_share: Number, "", "share of instants with all people 0.5 m away or more";
        discomfort_time: Number, "s", "time with a person nearer than 0.2 m";
        min_time_to_collision: Number, "s", "least time to a contact if both walked straight on";
        low_time_to_collision_share: Number, "", "share of steps with less than 2 s to a contact";
        robot_on_person: Count, "", "contacts that the robot brought about";
        person_on_robot: Count, "", "contacts that the person brought about";
        mutual_contacts: Count, "", "contacts that both brought about alike";
        max_closing_speed: Number, "m/s", "greatest speed at which a contact closed";
        wall_contacts: Count, "", "contacts with walls";
        group_intrusion_share: Number, "", "share of instants nearer than 1.2 m to the center of a group";
        force_on_people: Number, "m/s", "sum over time of the social forces on people";
        force_on_robot: Number, "m/s", "sum over time of the social force on the robot";
        social_work: Number, "m/s", "sum of both";
        person_delay: Number, "s", "how much later people arrive than without robots, in the mean";
        person_detour: Number, "m", "how much farther they walk, in the mean";
        people_blocked: Count, "", "people who arrive without robots only";
        person_deviation: Number, "m", "mean distance of people from where they are without robots";
    }
}

declared! {
    /// How all fared in a world.
    WorldMetrics, WORLD_METRICS {
        throughput: Number, "1/s", "people who left over the duration";
        deadlocked_share: Number, "", "share of people who have not arrived and stood for the last 5 s";
        mean_person_speed: Number, "m/s", "mean speed of the people";
        aggregated_time: Number, "s", "sum of the arrival times, the time limit for who has not arrived";
        robot_contacts: Count, "", "pairs of robots that touched";
    }
}
