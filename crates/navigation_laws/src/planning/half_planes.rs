//! The permitted velocity nearest to a wanted one: linear programs in the plane with a speed limit.
//!
//! The incremental method of de Berg et al. (2008), chapter 4, with the rule of van den Berg et
//! al. (2011), section 5.3, for programs without a solution: the velocity that violates the
//! half-planes least.

use numeric::lanes::{Number, Planar, Real, Truth, Vector2};

type Vector = Vector2<f64>;

/// Lines whose directions differ by less than this, as a sine, are parallel.
pub const PARALLEL: f64 = 1e-9;

/// Velocities on the left of a line.
#[derive(Clone, Copy, Debug)]
pub struct HalfPlane<R = f64> {
    /// A velocity on the line, in m/s.
    pub point: Vector2<R>,
    /// Direction of the line, of length 1.
    pub direction: Vector2<R>,
}

impl<R: Real> HalfPlane<R> {
    /// How far a velocity is on the wrong side, in m/s; negative on the right one.
    #[inline(always)]
    #[must_use]
    pub fn violation(&self, velocity: Vector2<R>) -> R {
        self.direction.perp(&(self.point - velocity))
    }
}

/// Objective of a program.
#[derive(Clone, Copy, Debug)]
enum Wish {
    /// Least distance from a velocity.
    Near(Vector),
    /// Greatest component along a direction of length 1.
    Along(Vector),
}

/// Solver with room for its programs.
#[derive(Clone, Debug, Default)]
pub struct Solver {
    projected: Vec<HalfPlane>,
}

impl Solver {
    /// The velocity nearest to a wanted one that is at most as fast as allowed and permitted by
    /// every half-plane. If there is none, the first `hard` half-planes are kept and the largest
    /// violation of the others is as small as possible.
    #[must_use]
    pub fn nearest(
        &mut self,
        planes: &[HalfPlane],
        hard: usize,
        max_speed: f64,
        wanted: Vector,
    ) -> Vector {
        match program(planes, max_speed, Wish::Near(wanted)) {
            Ok(velocity) => velocity,
            Err((failed, velocity)) => {
                self.least_violation(planes, hard, failed, max_speed, velocity)
            }
        }
    }

    /// Three-dimensional program: adds the half-planes from `failed` on, one after the other,
    /// and moves along the line on which two violations are equal.
    pub fn least_violation(
        &mut self,
        planes: &[HalfPlane],
        hard: usize,
        failed: usize,
        max_speed: f64,
        mut velocity: Vector,
    ) -> Vector {
        let mut largest = 0.0;
        for (index, plane) in planes.iter().enumerate().skip(failed) {
            if plane.violation(velocity) <= largest {
                continue;
            }
            self.projected.clear();
            self.projected.extend_from_slice(&planes[..hard.min(index)]);
            for other in planes.iter().take(index).skip(hard) {
                self.projected.extend(equal_violation(plane, other));
            }
            let inward = Wish::Along(plane.direction.left_normal());
            if let Ok(better) = program(&self.projected, max_speed, inward) {
                velocity = better;
            }
            largest = plane.violation(velocity);
        }
        velocity
    }
}

/// Velocities that violate a half-plane at least as much as another one.
fn equal_violation(plane: &HalfPlane, other: &HalfPlane) -> Option<HalfPlane> {
    let sine = plane.direction.perp(&other.direction);
    let point = if sine.abs() <= PARALLEL {
        if plane.direction.dot(&other.direction) > 0.0 {
            return None;
        }
        (plane.point + other.point) * 0.5
    } else {
        let share = other.direction.perp(&(plane.point - other.point)) / sine;
        plane.point + plane.direction * share
    };
    let direction = other.direction - plane.direction;
    let length = direction.dot(&direction).sqrt();
    Some(HalfPlane {
        point,
        direction: direction * (1.0 / length),
    })
}

/// A velocity, or the one along it with the largest speed: where no half-plane forbids that, it is the nearest one.
#[inline(always)]
#[must_use]
pub fn not_faster<R: Real>(wanted: Vector2<R>, max_speed: f64) -> Vector2<R> {
    let (speed, most) = (wanted.length(), R::splat(max_speed));
    let fast = most.lt(speed);
    if !fast.any() {
        return wanted;
    }
    Planar::<R>::select(fast, wanted * (most / speed), wanted)
}

/// Two-dimensional program; on failure the number of the half-plane that left nothing, and the
/// best velocity before it.
fn program(planes: &[HalfPlane], max_speed: f64, wish: Wish) -> Result<Vector, (usize, Vector)> {
    let mut velocity = match wish {
        Wish::Along(direction) => direction * max_speed,
        Wish::Near(wanted) => not_faster(wanted, max_speed),
    };
    for (index, plane) in planes.iter().enumerate() {
        if plane.violation(velocity) > 0.0 {
            velocity =
                on_line(&planes[..index], plane, max_speed, wish).ok_or((index, velocity))?;
        }
    }
    Ok(velocity)
}

/// One-dimensional program on the line of a half-plane.
fn on_line(earlier: &[HalfPlane], plane: &HalfPlane, max_speed: f64, wish: Wish) -> Option<Vector> {
    let HalfPlane { point, direction } = *plane;
    let foot = point.dot(&direction);
    // Distance of the line from the origin, not by the difference of two squares: the point may be far.
    let away = point.perp(&direction);
    let reach = max_speed * max_speed - away * away;
    if reach < 0.0 {
        return None;
    }
    let reach = reach.sqrt();
    let (mut low, mut high) = (-foot - reach, -foot + reach);
    for other in earlier {
        let sine = direction.perp(&other.direction);
        let offset = other.direction.perp(&(point - other.point));
        if sine.abs() <= PARALLEL {
            if offset < 0.0 {
                return None;
            }
            continue;
        }
        let crossing = offset / sine;
        if sine > 0.0 {
            high = Number::min(high, crossing);
        } else {
            low = Number::max(low, crossing);
        }
        if low > high {
            return None;
        }
    }
    let share = match wish {
        Wish::Along(aim) => {
            if aim.dot(&direction) > 0.0 {
                high
            } else {
                low
            }
        }
        Wish::Near(wanted) => {
            let share = direction.dot(&(wanted - point));
            Number::min(Number::max(share, low), high)
        }
    };
    Some(point + direction * share)
}
