//! From triggered sensors to a motion: Table 1, Table 3, and what to do between their rows.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

use crate::reflex::{Percept, Reflex};
use navigation_world::sensing::sonar::ring::PUBLISHED_SENSORS;

/// Motion directions of Figure 4 and Table 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// pi/2.
    North,
    /// -pi/2.
    South,
    /// pi.
    West,
    /// 0.
    East,
    /// 2 pi/3 (Table 3 prints 0.833 pi, which is no mirror of the north-east).
    NorthWest,
    /// pi/3.
    NorthEast,
    /// 4 pi/3.
    SouthWest,
    /// -pi/3.
    SouthEast,
}

impl Direction {
    /// All, in the order of Table 3.
    pub const ALL: [Self; 8] = [
        Self::North,
        Self::South,
        Self::West,
        Self::East,
        Self::NorthWest,
        Self::NorthEast,
        Self::SouthWest,
        Self::SouthEast,
    ];

    /// Angle, in rad.
    #[must_use]
    pub fn angle(self) -> f64 {
        match self {
            Self::North => FRAC_PI_2,
            Self::South => -FRAC_PI_2,
            Self::West => PI,
            Self::East => 0.0,
            Self::NorthWest => 2.0 * FRAC_PI_3,
            Self::NorthEast => FRAC_PI_3,
            Self::SouthWest => 4.0 * FRAC_PI_3,
            Self::SouthEast => -FRAC_PI_3,
        }
    }

    /// Its subscript in the source.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::North => "N",
            Self::South => "S",
            Self::West => "W",
            Self::East => "E",
            Self::NorthWest => "NW",
            Self::NorthEast => "NE",
            Self::SouthWest => "SW",
            Self::SouthEast => "SE",
        }
    }
}

/// Next action of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EscapeAction {
    /// Go on as before.
    Keep,
    /// Stand and turn.
    Spin,
    /// Move.
    Move(Direction),
}

/// Rule for a pattern that is not in Table 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Policy {
    /// The nearest triggered sensor, by Table 3.
    #[default]
    Nearest,
    /// The direction that leads away from all triggered sensors best.
    BestDirection,
    /// Nothing: keep the motion.
    TableOnly,
}

/// Rows of Table 1: sensors that see an obstacle, and the action. Row 6 prints the obstacles
/// 5, 6, 7; the direction north is opposite to 6, 7, 8.
pub const TABLE_1: [(&[usize], EscapeAction); 10] = [
    (&[1, 2, 3, 4, 5, 6, 7, 8, 9], EscapeAction::Spin),
    (&[2, 3], EscapeAction::Move(Direction::South)),
    (&[1, 9], EscapeAction::Move(Direction::East)),
    (&[1, 2, 9], EscapeAction::Move(Direction::SouthEast)),
    (&[4, 5], EscapeAction::Move(Direction::West)),
    (&[4, 5, 6], EscapeAction::Move(Direction::NorthWest)),
    (&[6, 7, 8], EscapeAction::Move(Direction::North)),
    (&[8, 9], EscapeAction::Move(Direction::NorthEast)),
    (&[3, 4, 5], EscapeAction::Move(Direction::SouthWest)),
    (&[], EscapeAction::Keep),
];

/// Table 3 by sensors 1 to 9: d1, L3 (2 and 3), d4, d5, d6, y, d7, d8.
const TABLE_3: [Direction; PUBLISHED_SENSORS] = [
    Direction::SouthEast,
    Direction::South,
    Direction::South,
    Direction::SouthWest,
    Direction::West,
    Direction::NorthWest,
    Direction::North,
    Direction::NorthEast,
    Direction::East,
];

/// Action of Table 1 for a pattern with bit k - 1 set where sensor k sees an obstacle.
#[must_use]
pub fn table_1(pattern: u64) -> Option<EscapeAction> {
    let of = |sensors: &[usize]| {
        sensors
            .iter()
            .fold(0, |bits, sensor| bits | 1 << (sensor - 1))
    };
    TABLE_1
        .iter()
        .find(|(sensors, _)| of(sensors) == pattern)
        .map(|(_, action)| *action)
}

/// Decides from readings.
#[derive(Clone, Debug, PartialEq)]
pub struct Decider {
    thresholds: Vec<f64>,
    bearings: Vec<f64>,
    escapes: Vec<Direction>,
    /// Actions of all patterns of the published ring.
    table: Vec<Option<EscapeAction>>,
    policy: Policy,
}

impl Reflex for &Decider {
    type Answer = EscapeAction;

    #[inline]
    fn answer(&mut self, percept: &Percept<'_>) -> EscapeAction {
        self.action(percept.readings)
    }
}

impl Decider {
    /// For sensors at bearings in rad with their triggering distances in m; `published` says that
    /// they are those of Tables 1 and 3.
    #[must_use]
    pub fn new(bearings: &[f64], thresholds: &[f64], published: bool, policy: Policy) -> Self {
        Self {
            thresholds: thresholds.to_vec(),
            bearings: bearings.to_vec(),
            escapes: if published {
                TABLE_3.to_vec()
            } else {
                bearings.iter().map(|bearing| opposite(*bearing)).collect()
            },
            table: if published {
                (0..1 << PUBLISHED_SENSORS).map(table_1).collect()
            } else {
                Vec::new()
            },
            policy,
        }
    }

    /// Bit k - 1 is set where sensor k sees an obstacle.
    #[inline]
    #[must_use]
    pub fn pattern(&self, readings: &[f64]) -> u64 {
        let triggered = readings.iter().zip(&self.thresholds);
        triggered
            .enumerate()
            .fold(0, |bits, (place, (reading, threshold))| {
                bits | u64::from(reading <= threshold) << place
            })
    }

    /// Action for readings in m.
    #[inline]
    #[must_use]
    pub fn action(&self, readings: &[f64]) -> EscapeAction {
        let pattern = self.pattern(readings);
        if pattern == 0 {
            return EscapeAction::Keep;
        }
        if pattern.count_ones() as usize == self.thresholds.len() {
            return EscapeAction::Spin;
        }
        let listed = usize::try_from(pattern)
            .ok()
            .and_then(|index| self.table.get(index).copied().flatten());
        listed.unwrap_or_else(|| match self.policy {
            Policy::Nearest => self.escape_nearest(readings),
            Policy::BestDirection => EscapeAction::Move(self.best_direction(readings)),
            Policy::TableOnly => EscapeAction::Keep,
        })
    }

    /// Away from the nearest triggered sensor.
    fn escape_nearest(&self, readings: &[f64]) -> EscapeAction {
        let triggered = readings
            .iter()
            .zip(&self.thresholds)
            .zip(&self.escapes)
            .filter(|((reading, threshold), _)| reading <= threshold);
        triggered
            .min_by(|((one, _), _), ((other, _), _)| one.total_cmp(other))
            .map_or(EscapeAction::Keep, |(_, escape)| {
                EscapeAction::Move(*escape)
            })
    }

    /// Direction phi with the least sum over the triggered sensors k at bearings `s_k` of
    /// exp(2 cos(phi - `s_k`)) (1.2 - `cm_k` / `threshold_k`); the first of Table 3 among equals.
    fn best_direction(&self, readings: &[f64]) -> Direction {
        let danger = |direction: Direction| -> f64 {
            let sensors = readings.iter().zip(&self.thresholds).zip(&self.bearings);
            sensors
                .filter(|((reading, threshold), _)| reading <= threshold)
                .map(|((reading, threshold), bearing)| {
                    (2.0 * (direction.angle() - bearing).cos()).exp() * (1.2 - reading / threshold)
                })
                .sum()
        };
        let mut best = (Direction::North, f64::INFINITY);
        for direction in Direction::ALL {
            let own = danger(direction);
            if own < best.1 {
                best = (direction, own);
            }
        }
        best.0
    }
}

/// Direction that is the nearest to the opposite of a bearing; the first of Table 3 among equals.
#[must_use]
pub fn opposite(bearing: f64) -> Direction {
    let mut best = (Direction::North, f64::INFINITY);
    for direction in Direction::ALL {
        let off = (direction.angle() - bearing).rem_euclid(TAU) - PI;
        // Below the rounding of angles, two directions are equally near.
        if off.abs() < best.1 - 1e-9 {
            best = (direction, off.abs());
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::{Decider, Direction, EscapeAction, Policy, TABLE_1, opposite, table_1};
    use navigation_world::sensing::sonar::ring::{PUBLISHED_WHEEL_GAP, Ring};

    fn decider(policy: Policy) -> Decider {
        let bearings = Ring::beside_wheels(9, PUBLISHED_WHEEL_GAP).unwrap();
        Decider::new(&bearings, &[0.336; 9], true, policy)
    }

    fn readings(near: &[(usize, f64)]) -> Vec<f64> {
        let mut all = vec![3.0; 9];
        for (sensor, reading) in near {
            all[sensor - 1] = *reading;
        }
        all
    }

    #[test]
    fn ten_patterns_of_512_are_listed() {
        assert_eq!((0..512).filter(|bits| table_1(*bits).is_some()).count(), 10);
    }

    #[test]
    fn rows_of_table_1_are_met_under_every_policy() {
        for policy in [Policy::Nearest, Policy::BestDirection, Policy::TableOnly] {
            for (sensors, action) in TABLE_1 {
                let near: Vec<_> = sensors.iter().map(|sensor| (*sensor, 0.2)).collect();
                assert_eq!(decider(policy).action(&readings(&near)), action);
            }
        }
    }

    #[test]
    fn between_the_rows_the_policy_decides() {
        let one = readings(&[(5, 0.3)]);
        let west = EscapeAction::Move(Direction::West);
        assert_eq!(decider(Policy::Nearest).action(&one), west);
        assert_eq!(decider(Policy::BestDirection).action(&one), west);
        assert_eq!(decider(Policy::TableOnly).action(&one), EscapeAction::Keep);
        let two = readings(&[(5, 0.3), (7, 0.1)]);
        let north = EscapeAction::Move(Direction::North);
        assert_eq!(decider(Policy::Nearest).action(&two), north);
    }

    #[test]
    fn best_direction_lies_between_two_obstacles() {
        // Obstacles in the west and in the south-east: the free side is the north-east.
        let found = decider(Policy::BestDirection).action(&readings(&[(9, 0.1), (6, 0.1)]));
        assert_eq!(found, EscapeAction::Move(Direction::NorthEast));
    }

    #[test]
    fn every_direction_is_the_opposite_of_its_opposite() {
        for direction in Direction::ALL {
            let facing = direction.angle() + std::f64::consts::PI;
            assert_eq!(opposite(facing), direction);
        }
    }
}
