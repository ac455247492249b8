//! Which obstacles a law that chooses velocities must be told of: those that some of the velocities lead
//! past closely. Nothing is said about the others, since no velocity that matters leads near them.

use crate::lanes::{Planar, Real, Vector2};

type Vector = Vector2<f64>;

/// Room for rounding in bounds: as a share of all numbers, and of velocities, where laws themselves leave room
/// for theirs.
const SHARE: f64 = 1e-9;
const BESIDE: f64 = 1e-6;

/// Which obstacles a law wants to be told of.
#[derive(Clone, Copy, Debug)]
pub enum Attention {
    /// All of them.
    All,
    /// Those that it was told of last.
    Same,
    /// Those that some velocities lead past closely, and all that are no discs which move straight on.
    Within(Outlook),
}

/// Velocities that a robot may choose for a while, and where it is meanwhile.
#[derive(Clone, Copy, Debug)]
pub struct Outlook {
    /// Center of a disc of velocities in m/s.
    pub center: Vector,
    /// Radius of that in m/s.
    pub radius: f64,
    /// From where obstacles are seen now, in m. It moves on at the velocity of the center.
    pub place: Vector,
    /// How far off that it may be, in m.
    pub off: f64,
    /// How far ahead of now obstacles are seen, in s.
    pub ahead: f64,
    /// For how long all this holds, in s.
    pub span: f64,
    /// Distance from the surface of an obstacle within which no velocity may lead past it, in m.
    pub clearance: f64,
    /// What is added to that for the way of a robot in a control period, in m: obstacles that are so near matter
    /// whatever the velocity.
    pub way: f64,
    /// The same for each m/s of the speed of an obstacle, in s.
    pub haste: f64,
    /// Whether obstacles that all of the velocities lead away from matter, too.
    pub behind: bool,
}

/// Discs that move straight on, side by side.
#[derive(Clone, Copy, Debug)]
pub struct Discs<R> {
    /// Centers in m.
    pub center: Vector2<R>,
    /// Velocities in m/s.
    pub velocity: Vector2<R>,
    /// Radii in m.
    pub radius: R,
}

impl Outlook {
    /// Which discs matter at any instant: seen from the robot, which moves at the velocity of the center, a
    /// disc passes at the distance `|c x w|/|w|`, `c` to where it is and `w` the velocity relative to it.
    /// A velocity within `r` of that passes by `r |c|/|w|` nearer, since `sin(a + b) <= sin a + sin b`, with
    /// `b` the angle between the two and `a` that at which the disc is seen.
    /// The same holds for directions away from it: `c . w < 0` for `w` and all velocities within `r` of it.
    /// Where a number is not one, it matters.
    #[inline(always)]
    pub fn concerns<R: Real>(&self, discs: &Discs<R>) -> R::Mask {
        let number = R::splat;
        let vector = |of: Vector| Vector2::splat([of.x, of.y]);
        let size = |of: Vector2<R>| of.x.abs() + of.y.abs();
        let Discs {
            center,
            velocity,
            radius,
        } = *discs;
        let seen = center + velocity * number(self.ahead) - vector(self.place);
        let relative = vector(self.center) - velocity;
        let speed = relative.dot(&relative).sqrt();
        let distance = seen.dot(&seen).sqrt();
        let hasty = size(velocity);
        let rounding = number(size_of(self.place)) + size(center) + hasty;
        let kept = number(self.clearance + self.off) + radius + rounding * number(SHARE);
        let near = kept + number(self.way) + hasty * number(self.haste);
        let wide = number(self.radius * (1.0 + BESIDE) + BESIDE * (1.0 + size_of(self.center)))
            + hasty * number(BESIDE);
        let farthest = distance + speed * number(self.span) + number(self.off);
        let across = seen.perp(&relative).abs();
        let least = distance * number(1.0 - SHARE) - speed * number(self.span);
        let beside = (across * number(1.0 - SHARE)).gt(kept * speed + wide * farthest);
        let nearer = seen.dot(&relative) + number(self.off) * speed + wide * farthest;
        let left = if self.behind {
            beside
        } else {
            beside | nearer.lt(R::zero())
        };
        !(left & least.gt(near))
    }
}

fn size_of(vector: Vector) -> f64 {
    vector.x.abs() + vector.y.abs()
}
