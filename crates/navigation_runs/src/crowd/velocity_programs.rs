//! Permitted velocities of one person in several worlds, side by side: half-planes in the order of the neighbors, and
//! the linear program of [`half_planes`](navigation_laws::planning::half_planes), lane by lane with the same bits.

use crate::crowd::agent_lanes::{Each, FEW, Vectors, WIDTH};
use navigation_laws::planning::half_planes::{HalfPlane, PARALLEL, Solver};
use numeric::lanes::{LaneMask, Mask, Number, Planar, Real, Truth, Vector2, Zero};

/// The constraint on the velocity of one person of each world by another one.
#[derive(Clone, Copy, Debug)]
struct Constraint {
    /// Change of the own velocity in m/s.
    change: Vectors,
    /// Direction of the line of permitted velocities.
    direction: Vectors,
    /// Distance in m; infinite where they are not near each other.
    distance: Each,
    /// Where they are.
    near: LaneMask<WIDTH>,
}

/// A half-plane of each world.
type Plane = HalfPlane<Each>;

/// Limit and goal of the programs of one person of each world.
#[derive(Clone, Copy, Debug)]
pub(super) struct VelocityGoal {
    /// Greatest speed in m/s.
    pub max_speed: Each,
    /// Wanted velocity in m/s.
    pub wanted: Vectors,
}

/// Places for half-planes, as many as there are others at least.
const PLACES: usize = FEW.next_power_of_two();

/// The constraints on the velocity of one person of each world, in the order of the others' numbers.
#[derive(Clone, Copy, Debug)]
struct ConstraintRow {
    all: [Constraint; PLACES],
    count: usize,
}

/// Half-planes of the people of some worlds.
#[derive(Clone, Debug)]
pub(super) struct VelocityPrograms {
    /// One for each person.
    rows: Vec<ConstraintRow>,
    ranks: [Each; PLACES],
    planes: [Plane; PLACES],
    /// How many half-planes there are in each world, and at most.
    counts: Each,
    most: usize,
    /// Half-planes of one world, and its program if it has no solution.
    alone: Vec<HalfPlane>,
    solver: Solver,
}

impl Default for VelocityPrograms {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            ranks: [Each::zero(); PLACES],
            planes: [everything(); PLACES],
            counts: Each::zero(),
            most: 0,
            alone: Vec::new(),
            solver: Solver::default(),
        }
    }
}

/// Room that decisions in lanes need, used again and again.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneRoom {
    /// How long a decision holds, in s.
    pub step: f64,
    /// Ways that everybody takes, in m.
    pub ways: Vec<Vectors>,
    /// Programs for the velocity of everybody.
    pub programs: VelocityPrograms,
}

impl VelocityPrograms {
    /// Nothing constrains any of so many people.
    pub fn open(&mut self, people: usize) {
        self.rows.resize(people, ConstraintRow::empty());
        for row in &mut self.rows {
            row.count = 0;
        }
    }

    /// Adds the constraint by somebody with a higher number than those before: a change of the own velocity and the
    /// direction of the line of permitted ones, a distance in m, infinite where they are not near, and where they are.
    /// Robots have none.
    #[inline(always)]
    pub fn constrain(
        &mut self,
        person: usize,
        (change, direction): (Vectors, Vectors),
        (distance, near): (Each, LaneMask<WIDTH>),
    ) {
        if let Some(row) = self.rows.get_mut(person)
            && let Some(place) = row.all.get_mut(row.count)
        {
            // One by one: a copy of the whole would go through memory once more.
            place.change = change;
            place.direction = direction;
            (place.distance, place.near) = (distance, near);
            row.count += 1;
        }
    }

    /// The permitted velocity of a person with a velocity, who avoids so many at most.
    #[inline(always)]
    pub fn nearest(
        &mut self,
        (person, velocity): (usize, Vectors),
        most: usize,
        objective: &VelocityGoal,
    ) -> Vectors {
        self.rank(person, most);
        self.line_up(person, velocity);
        self.program(objective)
    }

    /// Finds how many come before each: who is nearer, then who has a lower number.
    #[inline(always)]
    fn rank(&mut self, person: usize, most: usize) {
        let row = self.rows[person].known();
        let (one, none) = (Each::splat(1.0), Each::zero());
        let mut counts = none;
        for (index, later) in row.iter().enumerate() {
            let mut rank = none;
            for (earlier, before) in self.ranks.iter_mut().zip(&row[..index]) {
                let first = before.distance.le(later.distance);
                rank += Each::select(first, one, none);
                *earlier += Each::select(first, none, one);
            }
            self.ranks[index] = rank;
            counts += Each::select(later.near, one, none);
        }
        self.counts = counts.min(Each::splat(most as f64));
        let counts = (0..WIDTH).map(|lane| place_of(self.counts.lane(lane)));
        self.most = counts.max().unwrap_or(0);
    }

    /// Puts the half-planes into that order.
    // By comparisons: numbers that are written lane by lane cannot be read side by side at once.
    #[inline(always)]
    fn line_up(&mut self, person: usize, velocity: Vectors) {
        let row = self.rows[person].known();
        for (place, plane) in self.planes[..self.most].iter_mut().enumerate() {
            let place = Each::splat(place as f64);
            let mut found = everything();
            for (constraint, rank) in row.iter().zip(&self.ranks) {
                let here = rank.le(place) & rank.ge(place);
                let (change, direction) = (constraint.change, constraint.direction);
                found.point = Planar::<Each>::select(here, change, found.point);
                found.direction = Planar::<Each>::select(here, direction, found.direction);
            }
            found.point = velocity + found.point;
            *plane = found;
        }
    }

    /// The program of each world; those without a solution are left to the solver.
    #[inline(always)]
    fn program(&mut self, objective: &VelocityGoal) -> Vectors {
        let VelocityGoal { max_speed, wanted } = *objective;
        let speed = wanted.dot(&wanted).sqrt();
        let shorter = wanted * (max_speed / speed);
        let mut velocity = Planar::<Each>::select(speed.gt(max_speed), shorter, wanted);
        let mut failed = LaneMask::none();
        let mut failures = [0; WIDTH];
        for (index, plane) in self.planes[..self.most].iter().enumerate() {
            let violation = plane.violation(velocity);
            let there = Each::splat(index as f64).lt(self.counts);
            let broken = violation.gt(Each::zero()) & there & !failed;
            if !broken.any() {
                continue;
            }
            let (better, nothing) = on_line(&self.planes[..index], plane, objective);
            let lost = broken & nothing;
            velocity = Planar::<Each>::select(broken & !nothing, better, velocity);
            if lost.any() {
                failed = failed | lost;
                for (lane, failure) in failures.iter_mut().enumerate() {
                    if lost.lane(lane) {
                        *failure = index;
                    }
                }
            }
        }
        if failed.any() {
            for (lane, failure) in failures.into_iter().enumerate() {
                if failed.lane(lane) {
                    let best = Planar::<Each>::lane(velocity, lane).into();
                    let found = self.compromise(lane, failure, max_speed.lane(lane), best);
                    velocity.x.set(lane, found.x);
                    velocity.y.set(lane, found.y);
                }
            }
        }
        velocity
    }

    /// Velocity of one world that violates its half-planes least; `failed` is the one whose feasible set was empty.
    fn compromise(
        &mut self,
        lane: usize,
        failure: usize,
        max_speed: f64,
        best: Vector2<f64>,
    ) -> Vector2<f64> {
        let planes = self.planes[..place_of(self.counts.lane(lane))].iter();
        self.alone.clear();
        self.alone.extend(planes.map(|plane| HalfPlane {
            point: Planar::<Each>::lane(plane.point, lane).into(),
            direction: Planar::<Each>::lane(plane.direction, lane).into(),
        }));
        self.solver
            .least_violation(&self.alone, 0, failure, max_speed, best)
    }
}

impl ConstraintRow {
    fn empty() -> Self {
        let nothing = Constraint {
            change: Vectors::zeros(),
            direction: Vectors::zeros(),
            distance: Each::zero(),
            near: LaneMask::none(),
        };
        Self {
            all: [nothing; PLACES],
            count: 0,
        }
    }

    #[inline(always)]
    fn known(&self) -> &[Constraint] {
        &self.all[..self.count.min(PLACES)]
    }
}

/// A half-plane of all velocities.
#[inline(always)]
fn everything() -> Plane {
    Plane {
        point: Vector2::zeros(),
        direction: Vector2::zeros(),
    }
}

/// Best velocities on the lines of half-planes, and where there are none.
#[inline(always)]
fn on_line(
    earlier: &[Plane],
    plane: &Plane,
    objective: &VelocityGoal,
) -> (Vectors, LaneMask<WIDTH>) {
    let Plane { point, direction } = *plane;
    let foot = point.dot(&direction);
    let away = point.perp(&direction);
    let reach = objective.max_speed * objective.max_speed - away * away;
    let mut nothing = reach.lt(Each::zero());
    let reach = reach.sqrt();
    let (mut low, mut high) = (-foot - reach, -foot + reach);
    for other in earlier {
        let sine = direction.perp(&other.direction);
        let offset = other.direction.perp(&(point - other.point));
        let parallel = sine.abs().le(Each::splat(PARALLEL));
        nothing = nothing | (parallel & offset.lt(Each::zero()));
        let crossing = offset / sine;
        let ahead = sine.gt(Each::zero());
        high = Each::select(!parallel & ahead, high.min(crossing), high);
        low = Each::select(!parallel & !ahead, low.max(crossing), low);
        nothing = nothing | low.gt(high);
    }
    let share = direction
        .dot(&(objective.wanted - point))
        .max(low)
        .min(high);
    (point + direction * share, nothing)
}

/// A small count as a place: the last bits of the sum hold it.
#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // below PLACES
fn place_of(count: f64) -> usize {
    const SHIFT: f64 = (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;
    (count + SHIFT).to_bits() as usize % PLACES
}
