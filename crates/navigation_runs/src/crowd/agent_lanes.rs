//! People and robots of several worlds side by side, each world a lane, and pairs of them.

use crate::crowd::agent::SHORTEST;
use crate::crowd::divergence::is_finite;
use crate::crowd::neighbors::others::parted;
pub(super) use crate::crowd::neighbors::pairs::{Each, WIDTH};
use numeric::lanes::{LaneMask, Mask, Number, Planar, Real, Truth, Vector2, Zero};

/// Most people and robots who are compared with each other without lists.
pub(super) const FEW: usize = 12;
/// A vector of each world.
pub(super) type Vectors = Vector2<Each>;

/// One person or robot of each world.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneAgent {
    /// Position in m.
    pub position: Vectors,
    /// Velocity in m/s.
    pub velocity: Vectors,
    /// Where a person wants to go, where a robot moves: of length 1, or zero.
    pub direction: Vectors,
    /// Radius in m.
    pub radius: Each,
}

/// Intention of one person of each world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Intention {
    /// Speed `v0` in m/s.
    pub desired_speed: Each,
    /// Share by which robots are taken into account.
    pub awareness: Each,
    /// Next point of the route in m.
    pub target: Vectors,
    /// Distance from it in m.
    pub to_go: Each,
    /// Whether the person is on the way, not at the end of it.
    pub walks: LaneMask<WIDTH>,
}

/// Two of each world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// From the second to the first, in m.
    pub offset: Vectors,
    /// Velocity of the first relative to the second, in m/s.
    pub relative: Vectors,
    /// Their distance in m.
    pub distance: Each,
    /// Direction from the second to the first, of length 1.
    pub normal: Vectors,
    /// 1 for two people, the share by which the first is aware of the second if that is a robot.
    pub weight: Each,
    /// Where they act on each other.
    pub near: LaneMask<WIDTH>,
}

/// Everybody in some worlds.
#[derive(Clone, Debug, Default)]
pub(super) struct AgentLanes {
    /// People, then robots.
    pub all: Vec<LaneAgent>,
    /// Intentions of the people.
    pub intentions: Vec<Intention>,
    /// Places of two who may be near each other: a person, and another one who comes later, then a robot.
    pub pairs: Vec<(usize, usize)>,
}

impl AgentLanes {
    /// Makes room for people, who stay, and robots.
    pub fn open(&mut self, people: usize, robots: usize) {
        let all = people + robots;
        if (self.people(), self.all.len()) != (people, all) {
            let beside = |one| (one + 1..people).map(move |other| (one, other));
            let robots = |one| (people..all).map(move |robot| (one, robot));
            self.pairs.clear();
            self.pairs.extend((0..people).flat_map(beside));
            self.pairs.extend((0..people).flat_map(robots));
        }
        self.all.resize(all, LaneAgent::nobody());
        self.intentions.resize(people, Intention::none());
        for intention in &mut self.intentions {
            intention.walks = LaneMask::none();
        }
    }

    /// Finds where everybody wants to go.
    #[inline(always)]
    pub fn look_ahead(&mut self) {
        for (agent, intention) in self.all.iter_mut().zip(&mut self.intentions) {
            let way = intention.target - agent.position;
            let length = Planar::<Each>::length(way);
            let nowhere = !intention.walks | length.lt(Each::splat(SHORTEST));
            agent.direction = Planar::<Each>::select(
                nowhere,
                Vectors::zeros(),
                Planar::<Each>::over(way, length),
            );
            intention.to_go = Each::select(intention.walks, length, Each::zero());
        }
    }

    /// Moves the people by their decisions, which hold for a step in s: velocities, or, where there is a cap on the
    /// speed as a multiple of the desired one, accelerations. Returns where everybody is at a finite place.
    #[inline(always)]
    pub fn advance(
        &mut self,
        decisions: &[Vectors],
        cap: Option<f64>,
        step: f64,
    ) -> LaneMask<WIDTH> {
        let step = Each::splat(step);
        let mut finite = LaneMask::splat(true);
        let people = self.all.iter_mut().zip(&self.intentions);
        for ((agent, intention), decision) in people.zip(decisions) {
            agent.velocity = if let Some(cap) = cap {
                let velocity = agent.velocity + *decision * step;
                let speed = Planar::<Each>::length(velocity);
                let most = Each::splat(cap) * intention.desired_speed;
                let shorter = velocity * (most / speed);
                Planar::<Each>::select(speed.gt(most), shorter, velocity)
            } else {
                *decision
            };
            agent.position += agent.velocity * step;
            finite = finite & is_finite(agent.position, agent.velocity);
        }
        finite
    }

    /// How many people there are.
    #[inline(always)]
    pub fn people(&self) -> usize {
        self.intentions.len()
    }

    /// Two who are within a distance in m of each other, if they are in any world.
    #[inline(always)]
    pub fn pair(&self, (one, other): (usize, usize), cutoff: f64) -> Option<Pair> {
        let (first, second) = (&self.all[one], &self.all[other]);
        let offset = first.position - second.position;
        let mut near = !offset.dot(&offset).gt(Each::splat(cutoff * cutoff));
        let mut weight = Each::splat(1.0);
        if other >= self.people() {
            weight = self.intentions[one].awareness;
            near = near & weight.gt(Each::zero());
        }
        if !near.any() {
            return None;
        }
        let (distance, normal) = parted(offset, |_| true);
        Some(Pair {
            offset,
            relative: first.velocity - second.velocity,
            distance,
            normal,
            weight,
            near,
        })
    }

    /// Accelerations of everybody under a model of forces without walls: drives `(v0 e - v)/tau`, and what each pair
    /// within a distance in m brings the two of it.
    #[inline(always)]
    pub fn accelerations(
        &self,
        (relaxation_time, cutoff): (f64, f64),
        forces: impl Fn((usize, usize), &Pair) -> [Vectors; 2],
        sums: &mut Vec<Vectors>,
    ) {
        for (own, intention) in self.all.iter().zip(&self.intentions) {
            let wanted = own.direction * intention.desired_speed;
            let time = Each::splat(relaxation_time);
            sums.push(Planar::<Each>::over(wanted - own.velocity, time));
        }
        for &(one, other) in &self.pairs {
            let Some(pair) = self.pair((one, other), cutoff) else {
                continue;
            };
            let [mine, theirs] = forces((one, other), &pair);
            sums[one] += pair.where_near(mine);
            if let Some(sum) = sums.get_mut(other) {
                *sum += pair.where_near(theirs);
            }
        }
        // What walls add where there are none: it makes a negative zero positive.
        for sum in sums {
            *sum += Vectors::zeros();
        }
    }
}

impl Pair {
    /// A vector where the two are near each other, elsewhere minus zero, which changes no bit of a sum.
    #[inline(always)]
    fn where_near(&self, vector: Vectors) -> Vectors {
        Planar::<Each>::select(self.near, vector, Planar::<Each>::splat([-0.0; 2]))
    }
}

impl LaneAgent {
    fn nobody() -> Self {
        Self {
            position: Vectors::zeros(),
            velocity: Vectors::zeros(),
            direction: Vectors::zeros(),
            radius: Each::zero(),
        }
    }

    /// Takes the place of somebody in a world.
    #[inline(always)]
    pub fn stand(
        &mut self,
        lane: usize,
        position: Vector2<f64>,
        velocity: Vector2<f64>,
        radius: f64,
    ) {
        set(&mut self.position, lane, position);
        set(&mut self.velocity, lane, velocity);
        self.radius.set(lane, radius);
    }

    /// Faces where somebody in a world moves.
    #[inline(always)]
    pub fn face(&mut self, lane: usize, direction: Vector2<f64>) {
        set(&mut self.direction, lane, direction);
    }
}

impl Intention {
    fn none() -> Self {
        Self {
            desired_speed: Each::zero(),
            awareness: Each::zero(),
            target: Vectors::zeros(),
            to_go: Each::zero(),
            walks: LaneMask::none(),
        }
    }

    /// Says where somebody in a world walks.
    #[inline(always)]
    pub fn walk(&mut self, lane: usize, target: Vector2<f64>) {
        set(&mut self.target, lane, target);
        // In its place: a copy of the whole mask would wait for the lane that was written before.
        self.walks.set(lane);
    }
}

#[inline(always)]
fn set(vectors: &mut Vectors, lane: usize, vector: Vector2<f64>) {
    vectors.x.set(lane, vector.x);
    vectors.y.set(lane, vector.y);
}
