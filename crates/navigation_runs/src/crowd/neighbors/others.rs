//! Neighbors of a person side by side.

use crate::crowd::agent::{Agent, SHORTEST};
use crate::crowd::neighbors::grid::Period;
use numeric::lanes::{LaneMask, Lanes, Number, Planar, Real, Truth, Vector2};

type Vector = Vector2<f64>;

/// How many others are looked at side by side.
pub const WIDTH: usize = 4;

/// A number of each of them.
pub type Each = Lanes<WIDTH>;

/// Some who are near a person, side by side; the last one also fills the lanes that are left over.
#[derive(Clone, Copy, Debug)]
pub struct Others<'a> {
    /// Who they are.
    pub agents: [&'a Agent; WIDTH],
    /// How many there are.
    pub count: usize,
    /// `r`, from the neighbor to the person, in m.
    pub offset: Vector2<Each>,
    /// `d = |r|` in m.
    pub distance: Each,
    /// `n = r/d`.
    pub normal: Vector2<Each>,
    /// `w`: 1 for people, the awareness of the person for robots.
    pub weight: Each,
}

impl<'a> Others<'a> {
    #[inline(always)]
    pub(crate) fn new(
        own: &Agent,
        period: Period,
        agents: [&'a Agent; WIDTH],
        count: usize,
        weight: Each,
    ) -> Self {
        let place: Vector2<Each> = Planar::<Each>::splat(own.position.into());
        let mut offset = place - gathered(&agents, |agent| agent.position);
        if period != Period::default() {
            let wrapped: [_; WIDTH] =
                std::array::from_fn(|lane| period.wrap(offset.lane(lane).into()));
            offset = Vector2::new(
                Each::from_fn(|lane| wrapped[lane].x),
                Each::from_fn(|lane| wrapped[lane].y),
            );
        }
        let (distance, normal) = parted(offset, |lane| own.number < agents[lane].number);
        Self {
            agents,
            count,
            offset,
            distance,
            normal,
            weight,
        }
    }

    /// Their velocities in m/s.
    #[inline(always)]
    #[must_use]
    pub fn velocity(&self) -> Vector2<Each> {
        gathered(&self.agents, |agent| agent.velocity)
    }

    /// Where they want to go, or move.
    #[inline(always)]
    #[must_use]
    pub fn direction(&self) -> Vector2<Each> {
        gathered(&self.agents, |agent| agent.direction)
    }

    /// Their radii in m.
    #[inline(always)]
    #[must_use]
    pub fn radius(&self) -> Each {
        Each::from_fn(|lane| self.agents[lane].radius)
    }

    /// Which lanes are theirs.
    #[inline(always)]
    #[must_use]
    pub fn present(&self) -> LaneMask<WIDTH> {
        Each::from_fn(|lane| lane as f64).lt(Each::splat(self.count as f64))
    }

    /// Adds what belongs to each of them to a sum, one after the other.
    #[inline(always)]
    pub fn add(&self, vectors: Vector2<Each>, sum: &mut Vector) {
        // Minus zero changes no bit of a sum.
        let nothing: Vector2<Each> = Planar::<Each>::splat([-0.0; 2]);
        let vectors = Planar::<Each>::select(self.present(), vectors, nothing);
        for lane in 0..WIDTH {
            *sum += Vector::from(vectors.lane(lane));
        }
    }
}

/// Distances in m and unit vectors of offsets in m; who are at one place are parted along x, the one with the lower
/// number to the right.
#[inline(always)]
pub(crate) fn parted<R: Real>(
    offset: Vector2<R>,
    lower: impl Fn(usize) -> bool,
) -> (R, Vector2<R>) {
    let distance = offset.dot(&offset).sqrt();
    let normal = Vector2::new(offset.x / distance, offset.y / distance);
    let together = distance.lt(R::splat(SHORTEST));
    if !together.any() {
        return (distance, normal);
    }
    (
        distance,
        Planar::<R>::select(together, apart(lower), normal),
    )
}

/// Unit vectors that part who are at one place.
#[inline(always)]
pub(crate) fn apart<R: Real>(lower: impl Fn(usize) -> bool) -> Vector2<R> {
    let side = |lane: usize| if lower(lane) { 1.0 } else { -1.0 };
    Vector2::new(R::from_fn(side), R::zero())
}

/// A vector of each.
#[inline(always)]
fn gathered(agents: &[&Agent; WIDTH], of: impl Fn(&Agent) -> Vector) -> Vector2<Each> {
    Vector2::new(
        Each::from_fn(|lane| of(agents[lane]).x),
        Each::from_fn(|lane| of(agents[lane]).y),
    )
}
