//! The price of staying where the robot makes no way: the program does not know that the shield refuses again and again what
//! it found, and its nodes may miss a narrow way.

use numeric::lanes::Vector2;

/// Distance at which the robot has left a place, in m.
const LEFT: f64 = 0.5;

/// Share of the preferred speed at which it makes no way.
const NO_WAY: f64 = 1.0 / 3.0;

/// Most that staying costs, in s.
const MOST: f64 = 5.0;

/// How long the robot has stayed around a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impatience {
    place: Vector2<f64>,
    /// Time until staying has a price, in s.
    patience: f64,
    /// Time since then, in s.
    stayed: f64,
}

impl Impatience {
    /// Of a robot that prefers a speed in m/s.
    pub fn new(preferred: f64) -> Self {
        Self {
            place: Vector2::repeat(f64::INFINITY),
            patience: LEFT / (NO_WAY * preferred),
            stayed: 0.0,
        }
    }

    /// Notes where the robot is at a decision, in m. One that lines up with gaps leaves where it is when its patience ends,
    /// not where it has been: it may have to back off.
    pub fn observe(&mut self, place: Vector2<f64>, period: f64, lines_up: bool) {
        if lines_up && self.stayed <= 0.0 && self.stayed + period > 0.0 {
            self.place = place;
        }
        let near = (place - self.place).norm() < LEFT;
        self.stayed = if near {
            self.stayed + period
        } else {
            self.place = place;
            -self.patience
        };
    }

    /// Price in s of a velocity that leads to a place in m.
    pub fn price(&self, to: Vector2<f64>) -> f64 {
        if self.stayed <= 0.0 {
            return 0.0;
        }
        self.stayed.min(MOST) * (1.0 - (to - self.place).norm() / LEFT).max(0.0)
    }
}
