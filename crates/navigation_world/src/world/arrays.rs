//! Many scenarios from arrays: discs that move straight on.

use crate::world::motion::Motion;
use crate::world::obstacle::{Limits, Obstacle};
use crate::world::scenario::{Mover, Rules, Scenario};
use numeric::error::{Failure, Given, Result};

/// Speed in m/s that the regions of people are sized for.
pub const PERSON_SPEED: f64 = 1.0;

/// Rows of scenarios with the same robot and the same rules, `m` obstacles each at most.
#[derive(Clone, Copy, Debug)]
pub struct SceneArrays<'a> {
    /// Start of each row in m.
    pub start: &'a [[f64; 2]],
    /// Goal of each row in m.
    pub goal: &'a [[f64; 2]],
    /// Obstacles at time 0 in m, those of a row together; not a number where there is none.
    pub position: &'a [[f64; 2]],
    /// Their velocities in m/s.
    pub velocity: &'a [[f64; 2]],
    /// Their radii in m.
    pub radius: &'a [f64],
    /// Whether they are people, whose regions are sized for [`PERSON_SPEED`]; for the speed of each
    /// otherwise.
    pub person: bool,
    /// The robot of all rows.
    pub robot: Mover,
    /// The rules of all rows.
    pub rules: Rules,
    /// Seed of each row.
    pub seed: &'a [u64],
}

impl SceneArrays<'_> {
    /// The scenarios.
    ///
    /// # Errors
    /// The arrays are not of one length, or a row is no scenario; the error names it.
    pub fn scenarios(&self) -> Result<Vec<Scenario>> {
        let rows = self.start.len();
        for (name, count) in [("goal", self.goal.len()), ("seed", self.seed.len())] {
            same_length(name, count, rows)?;
        }
        let bodies = self.position.len();
        same_length("obstacle_velocity", self.velocity.len(), bodies)?;
        same_length("obstacle_radius", self.radius.len(), bodies)?;
        let width = bodies.checked_div(rows).unwrap_or(0);
        same_length("obstacle_position", bodies, width * rows)?;
        let mut made = Vec::with_capacity(rows);
        for row in 0..rows {
            let scenario = self.scenario(row, width);
            made.push(scenario.map_err(|error| error.within(&format!("scenarios[{row}]")))?);
        }
        Ok(made)
    }

    fn scenario(&self, row: usize, width: usize) -> Result<Scenario> {
        let own = row * width..(row + 1) * width;
        let there = own.filter(|body| !self.position[*body].iter().all(|axis| axis.is_nan()));
        let mut obstacles = Vec::with_capacity(width);
        for (index, body) in there.enumerate() {
            let obstacle = self.obstacle(body);
            obstacles.push(obstacle.map_err(|error| error.within(&format!("obstacles[{index}]")))?);
        }
        let ends = [self.start[row], self.goal[row]];
        let scenario = Scenario::sensed(self.robot, ends, obstacles, self.rules, None)?;
        Ok(scenario.reseeded(self.seed[row]))
    }

    fn obstacle(&self, body: usize) -> Result<Obstacle> {
        let motion = Motion::moving(self.position[body], self.velocity[body], [0.0; 2], None)?;
        let limits = Limits {
            max_speed: self.person.then_some(PERSON_SPEED),
            ..Limits::default()
        };
        Obstacle::disc(self.radius[body], motion, limits)
    }
}

fn same_length(name: &str, count: usize, wanted: usize) -> Result<()> {
    if count == wanted {
        return Ok(());
    }
    let rule = format!("hold {wanted} entries");
    let given = Given::Count(count as u64);
    Err(Failure::invalid(name, rule, given))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots::HolonomicRobot;

    const NOBODY: [f64; 2] = [f64::NAN; 2];

    fn arrays<'a>(position: &'a [[f64; 2]], radius: &'a [f64]) -> SceneArrays<'a> {
        SceneArrays {
            start: &[[0.0, 0.0], [0.0, 1.0]],
            goal: &[[5.0, 0.0], [5.0, 1.0]],
            position,
            velocity: &[[0.1, 0.0]; 4],
            radius,
            person: true,
            robot: Mover::Holonomic(HolonomicRobot::default()),
            rules: Rules::default(),
            seed: &[3, 4],
        }
    }

    #[test]
    fn rows_are_the_scenarios_of_their_obstacles() {
        let position = [NOBODY, [2.0, 2.0], [3.0, 3.0], NOBODY];
        let found = arrays(&position, &[f64::NAN, 0.4, 0.3, f64::NAN]).scenarios();
        let person = Motion::moving([3.0, 3.0], [0.1, 0.0], [0.0; 2], None).unwrap();
        let limits = Limits {
            max_speed: Some(1.0),
            ..Limits::default()
        };
        let expected = Scenario::new(
            HolonomicRobot::default(),
            [0.0, 1.0],
            [5.0, 1.0],
            vec![Obstacle::disc(0.3, person, limits).unwrap()],
            Rules::default(),
        );
        assert_eq!(found.unwrap()[1], expected.unwrap().reseeded(4));
    }

    #[test]
    fn an_error_names_row_and_obstacle() {
        let position = [NOBODY, [2.0, 2.0], [3.0, 3.0], NOBODY];
        let error = arrays(&position, &[f64::NAN, 0.4, -0.3, f64::NAN]).scenarios();
        let words = error.unwrap_err().to_string();
        assert!(
            words.contains("scenarios[1].obstacles[0].radius"),
            "{words}"
        );
        let half = [[1.0, f64::NAN], [2.0, 2.0], [3.0, 3.0], NOBODY];
        let error = arrays(&half, &[0.4; 4]).scenarios();
        let words = error.unwrap_err().to_string();
        assert!(words.contains("scenarios[0].obstacles[0].start"), "{words}");
    }
}
