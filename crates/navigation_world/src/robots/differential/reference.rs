//! The robot that is followed, and paths for it.

use super::full_speed::STANDSTILL;
use crate::world::motion::Motion;
use numeric::error::{Failure, Given, Result, finite, finite_pair, positive};

/// State of the robot that is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Position `P_d` in m.
    pub position: [f64; 2],
    /// Velocity `V_d` in m/s.
    pub velocity: [f64; 2],
    /// Acceleration in m/s^2.
    pub acceleration: [f64; 2],
}

impl Reference {
    /// A reference that stands.
    #[must_use]
    pub fn at_rest(position: [f64; 2]) -> Self {
        Self {
            position,
            velocity: [0.0; 2],
            acceleration: [0.0; 2],
        }
    }

    /// Speed `v_d` in m/s.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.velocity[0].hypot(self.velocity[1])
    }

    /// Turn rate of the velocity, `d phi_d/dt = (V x A)/|V|^2`, in rad/s; none while it stands.
    #[must_use]
    pub fn turn_rate(&self) -> Option<f64> {
        let ([x, y], [ax, ay]) = (self.velocity, self.acceleration);
        (self.speed() > STANDSTILL).then(|| (x * ay - y * ax) / (x * x + y * y))
    }
}

/// Motion of the reference over time.
#[derive(Clone, Debug, PartialEq)]
pub enum ReferencePath {
    /// Pieces of constant acceleration, the first from time 0 on.
    Pieces(Motion),
    /// A circle at constant speed.
    Circle {
        /// Center in m.
        center: [f64; 2],
        /// Radius in m.
        radius: f64,
        /// Speed in m/s, counter-clockwise; negative clockwise.
        speed: f64,
        /// Direction of the start as seen from the center, in rad.
        start_angle: f64,
    },
    /// Cubic between samples of position and velocity; stands before the first and after the
    /// last.
    Samples {
        /// Instants in s.
        time: Vec<f64>,
        /// Positions in m.
        position: Vec<[f64; 2]>,
        /// Velocities in m/s.
        velocity: Vec<[f64; 2]>,
    },
}

impl ReferencePath {
    /// A circle at constant speed.
    ///
    /// # Errors
    /// A number is not finite or the radius is not positive.
    pub fn circle(center: [f64; 2], radius: f64, speed: f64, start_angle: f64) -> Result<Self> {
        Ok(Self::Circle {
            center: finite_pair("center", center)?,
            radius: positive("radius", radius)?,
            speed: finite("speed", speed)?,
            start_angle: finite("start_angle", start_angle)?,
        })
    }

    /// A cubic between samples.
    ///
    /// # Errors
    /// There is none, their numbers differ, one is not finite or time does not grow.
    pub fn samples(
        time: Vec<f64>,
        position: Vec<[f64; 2]>,
        velocity: Vec<[f64; 2]>,
    ) -> Result<Self> {
        if time.is_empty() {
            let none = Given::Found("an empty path".into());
            let rule = "hold at least one sample";
            return Err(Failure::invalid("time", rule, none));
        }
        for (name, count) in [("position", position.len()), ("velocity", velocity.len())] {
            if count != time.len() {
                let rule = "have one row for each time";
                let given = Given::Count(count as u64);
                return Err(Failure::invalid(name, rule, given));
            }
        }
        for (index, instant) in time.iter().enumerate() {
            let name = format!("time[{index}]");
            finite(&name, *instant)?;
            if index > 0 && *instant <= time[index - 1] {
                let rule = "be later than the sample before";
                return Err(Failure::invalid(name, rule, Given::Number(*instant)));
            }
            finite_pair(&format!("position[{index}]"), position[index])?;
            finite_pair(&format!("velocity[{index}]"), velocity[index])?;
        }
        Ok(Self::Samples {
            time,
            position,
            velocity,
        })
    }

    /// State at an instant. `cursor` remembers the piece; start it at 0.
    #[must_use]
    pub fn at(&self, instant: f64, cursor: &mut usize) -> Reference {
        match self {
            Self::Pieces(motion) => {
                let state = motion.at(instant, cursor);
                Reference {
                    position: state.position,
                    velocity: state.velocity,
                    acceleration: state.acceleration,
                }
            }
            Self::Circle {
                center,
                radius,
                speed,
                start_angle,
            } => {
                let turn = speed / radius;
                let (sin, cos) = (start_angle + turn * instant).sin_cos();
                Reference {
                    position: [center[0] + radius * cos, center[1] + radius * sin],
                    velocity: [-speed * sin, speed * cos],
                    acceleration: [-turn * speed * cos, -turn * speed * sin],
                }
            }
            Self::Samples {
                time,
                position,
                velocity,
            } => {
                let after = advance(time, instant, cursor);
                if after == 0 {
                    return Reference::at_rest(position[0]);
                }
                let before = after - 1;
                if after == time.len() {
                    return Reference::at_rest(position[before]);
                }
                let span = time[after] - time[before];
                let share = (instant - time[before]) / span;
                let ends = [position[before], position[after]];
                cubic(ends, [velocity[before], velocity[after]], span, share)
            }
        }
    }
}

/// Index of the first sample after an instant, looked for from where it was last.
fn advance(time: &[f64], instant: f64, cursor: &mut usize) -> usize {
    let mut index = (*cursor).min(time.len());
    while index > 0 && instant < time[index - 1] {
        index -= 1;
    }
    while index < time.len() && time[index] <= instant {
        index += 1;
    }
    *cursor = index;
    index
}

/// Hermite's cubic over a span of time at a share of it.
fn cubic(position: [[f64; 2]; 2], velocity: [[f64; 2]; 2], span: f64, share: f64) -> Reference {
    let s = share;
    let mut state = Reference::at_rest([0.0; 2]);
    for axis in 0..2 {
        let way = position[1][axis] - position[0][axis];
        let (first, last) = (span * velocity[0][axis], span * velocity[1][axis]);
        let square = 3.0 * way - 2.0 * first - last;
        let cube = first + last - 2.0 * way;
        state.position[axis] = position[0][axis] + s * (first + s * (square + s * cube));
        state.velocity[axis] = (first + s * (2.0 * square + s * 3.0 * cube)) / span;
        state.acceleration[axis] = (2.0 * square + 6.0 * s * cube) / (span * span);
    }
    state
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_goes_through_its_samples() {
        // x = t^3, y = 1 - t^2 are cubics: exact between the samples, too.
        let time = vec![0.0, 0.5, 2.0];
        let place = |t: f64| [t * t * t, 1.0 - t * t];
        let speed = |t: f64| [3.0 * t * t, -2.0 * t];
        let position = time.iter().map(|t| place(*t)).collect();
        let velocity = time.iter().map(|t| speed(*t)).collect();
        let path = ReferencePath::samples(time, position, velocity).unwrap();
        let mut cursor = 0;
        for instant in [0.0, 0.3, 0.5, 1.2, 1.999, 0.1] {
            let state = path.at(instant, &mut cursor);
            for axis in 0..2 {
                assert!((state.position[axis] - place(instant)[axis]).abs() < 1e-14);
                assert!((state.velocity[axis] - speed(instant)[axis]).abs() < 1e-13);
            }
            assert!((state.acceleration[0] - 6.0 * instant).abs() < 1e-12);
            assert!((state.acceleration[1] + 2.0).abs() < 1e-12);
        }
        assert_eq!(path.at(2.5, &mut cursor), Reference::at_rest([8.0, -3.0]));
        assert_eq!(path.at(-0.5, &mut cursor), Reference::at_rest([0.0, 1.0]));
    }

    #[test]
    fn a_circle_turns_at_speed_over_radius() {
        let path = ReferencePath::circle([1.0, 2.0], 0.5, -0.3, 0.7).unwrap();
        let mut cursor = 0;
        let state = path.at(1.3, &mut cursor);
        assert!((state.turn_rate().unwrap() + 0.6).abs() < 1e-14);
        assert!((state.speed() - 0.3).abs() < 1e-15);
        assert!(Reference::at_rest([0.0; 2]).turn_rate().is_none());
        assert!(ReferencePath::circle([0.0; 2], 0.0, 0.1, 0.0).is_err());
    }
}
