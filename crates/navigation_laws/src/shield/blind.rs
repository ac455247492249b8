//! Speed past a corner behind which a person may be who is not seen yet, in closed form.

use numeric::error::{Result, not_negative, positive};

/// Side of an opening in a wall beside the robot, nearest or farthest along its course.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerEdge {
    /// Edge that the robot passes first.
    Near,
    /// Edge that the robot passes last; people come from behind its inner side.
    Far,
}

/// Assumptions of a robot about people behind corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlindCorner {
    /// Radius of the robot in m.
    pub robot_radius: f64,
    /// Radius of a person in m.
    pub person_radius: f64,
    /// Radius in m of the core of a person, which never overlaps a wall and ends every beam that meets it.
    pub person_core: f64,
    /// Margin of the shield in m.
    pub margin: f64,
    /// Thickness of the wall in m.
    pub wall_thickness: f64,
    /// Largest speed of people in m/s.
    pub person_speed: f64,
    /// Age of a measured position in s when the command takes effect.
    pub latency: f64,
    /// Control period in s.
    pub control_period: f64,
    /// Deceleration of the robot in m/s^2.
    pub deceleration: f64,
    /// Largest speed of the robot in m/s.
    pub max_speed: f64,
}

impl BlindCorner {
    /// Checks the values.
    ///
    /// # Errors
    /// A value is out of range.
    pub fn checked(self) -> Result<Self> {
        positive("robot_radius", self.robot_radius)?;
        positive("person_radius", self.person_radius)?;
        not_negative("person_core", self.person_core)?;
        not_negative("margin", self.margin)?;
        not_negative("wall_thickness", self.wall_thickness)?;
        positive("person_speed", self.person_speed)?;
        not_negative("latency", self.latency)?;
        positive("control_period", self.control_period)?;
        positive("deceleration", self.deceleration)?;
        positive("max_speed", self.max_speed)?;
        Ok(self)
    }

    /// Nearest place of a hidden person's center in m, ahead of the robot and beside it, behind an edge so far ahead and
    /// beside the robot.
    #[must_use]
    pub fn hidden(&self, edge: CornerEdge, distance: f64, offset: f64) -> [f64; 2] {
        let core = self.person_core;
        match edge {
            CornerEdge::Near => {
                let (sin, cos) = offset.atan2(distance).sin_cos();
                [distance + core, ((distance + core) * sin + core) / cos]
            }
            CornerEdge::Far => {
                let inner = offset + self.wall_thickness;
                let (sin, cos) = inner.atan2(distance).sin_cos();
                let beside = inner + core;
                [(beside * cos + core) / sin, beside]
            }
        }
    }

    /// Largest speed in m/s, not above that of the robot, with which it comes to rest before a person from there reaches
    /// the half disc ahead; the straight way of the person bounds every other one.
    #[must_use]
    pub fn speed(&self, [ahead, beside]: [f64; 2]) -> f64 {
        let keeps = |speed: f64| {
            let way = speed * (self.latency + self.control_period)
                + speed * speed / (2.0 * self.deceleration);
            (ahead - way).max(0.0).hypot(beside) >= self.needed(speed)
        };
        if keeps(self.max_speed) {
            return self.max_speed;
        }
        let (mut kept, mut broken) = (0.0, self.max_speed);
        if !keeps(kept) {
            return 0.0;
        }
        loop {
            let middle = 0.5 * (kept + broken);
            if middle <= kept || middle >= broken {
                return kept;
            }
            if keeps(middle) {
                kept = middle;
            } else {
                broken = middle;
            }
        }
    }

    /// Largest speed in m/s, not above that of the robot, past an opening wherever its far edge is.
    #[must_use]
    pub fn passing_speed(&self, offset: f64) -> f64 {
        let hidden = offset + self.wall_thickness + self.person_core;
        let time = (hidden - self.reach()) / self.person_speed - self.latency - self.control_period;
        (self.deceleration * time).clamp(0.0, self.max_speed)
    }

    /// Distance of the centers in m at which robot and person touch, with the margin.
    fn reach(&self) -> f64 {
        self.robot_radius + self.person_radius + self.margin
    }

    /// Distance in m of a person who cannot reach the robot until it rests.
    fn needed(&self, speed: f64) -> f64 {
        let until_rest = self.latency + self.control_period + speed / self.deceleration;
        self.reach() + self.person_speed * until_rest
    }
}

#[cfg(test)]
mod tests {
    use super::{BlindCorner, CornerEdge};

    fn corner(deceleration: f64) -> BlindCorner {
        BlindCorner {
            robot_radius: 0.2,
            person_radius: 0.3,
            person_core: 0.15,
            margin: 0.005,
            wall_thickness: 0.1,
            person_speed: 1.6,
            latency: 0.05,
            control_period: 0.05,
            deceleration,
            max_speed: 3.0,
        }
    }

    #[test]
    fn limits_are_those_of_the_specification() {
        for (deceleration, offset, distance, place, near, far, pass) in [
            (
                2.0,
                0.6,
                0.4,
                [0.55, 1.095_416],
                0.622_568_740,
                0.444_342_148,
                0.231_25,
            ),
            (
                0.8,
                0.9,
                1.0,
                [1.15, 1.236_804],
                0.454_986_628,
                0.486_253_206,
                0.242_5,
            ),
        ] {
            let corner = corner(deceleration);
            let hidden = corner.hidden(CornerEdge::Near, distance, offset);
            assert!((hidden[0] - place[0]).abs() < 1e-6 && (hidden[1] - place[1]).abs() < 1e-6);
            assert!((corner.speed(hidden) - near).abs() < 1e-9);
            let behind = corner.hidden(CornerEdge::Far, distance, offset);
            assert!((corner.speed(behind) - far).abs() < 1e-9);
            assert!((corner.passing_speed(offset) - pass).abs() < 1e-12);
        }
    }

    #[test]
    fn whoever_can_be_at_the_robot_leaves_it_no_speed() {
        assert_eq!(corner(2.0).speed([0.2, 0.1]), 0.0);
        assert_eq!(corner(2.0).passing_speed(0.1), 0.0);
    }
}
