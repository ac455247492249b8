//! Random layouts of the experiments.

use crate::run::follower::scene::{FollowerScene, Leader};
use navigation_world::world::motion::Motion;
use navigation_world::world::obstacle::{Limits, Obstacle, Shape};
use numeric::error::{Failure, Given, Result, finite, positive};
use numeric::random::Stream;

/// Stream of a seed that draws the layout.
const LAYOUT: u64 = 0;

/// Obstacles in the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// A moving source and nothing else: experiment 1.
    Tracking,
    /// Two boxes that stand: experiment 2.
    Static,
    /// A moving source and a moving box: experiment 3.
    OneDynamic,
    /// A moving source and two moving boxes: experiment 3.
    TwoDynamic,
}

/// How layouts are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layouts {
    /// Obstacles in the way.
    pub setting: Setting,
    /// Slowest and fastest lateral speed of the moving boxes, in m/s.
    pub speeds: [f64; 2],
    /// Factor on the sizes of all boxes.
    pub size_factor: f64,
    /// Half of the size of the leader along x and y if the sensors see it, in m.
    pub leader: Option<[f64; 2]>,
}

impl Layouts {
    /// Layouts of a setting as the experiments have them.
    #[must_use]
    pub fn of(setting: Setting) -> Self {
        Self {
            setting,
            speeds: [0.15, 0.5],
            size_factor: 1.0,
            leader: None,
        }
    }

    /// Returns the numbers if they are valid.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn checked(self) -> Result<Self> {
        positive("obstacle_speed[0]", self.speeds[0])?;
        finite("obstacle_speed[1]", self.speeds[1])?;
        if self.speeds[1] < self.speeds[0] {
            return Err(Failure::invalid(
                "obstacle_speed",
                "ascend",
                Given::Pair(self.speeds),
            ));
        }
        positive("size_factor", self.size_factor)?;
        if let Some([x, y]) = self.leader {
            positive("leader_size[0]", x)?;
            positive("leader_size[1]", y)?;
        }
        Ok(self)
    }

    /// Layout of a seed.
    ///
    /// # Errors
    /// A number drawn is out of range: the layouts were not checked.
    pub fn scene(&self, seed: u64) -> Result<FollowerScene> {
        let mut draw = Stream::new(seed, LAYOUT);
        let mut scene = match self.setting {
            Setting::Static => FollowerScene {
                leader: Leader::standing([6.0, 0.0]),
                obstacles: self.standing(&mut draw),
                duration: 40.0,
            },
            Setting::Tracking | Setting::OneDynamic | Setting::TwoDynamic => FollowerScene {
                leader: moving_leader()?,
                obstacles: self.moving(&mut draw)?,
                duration: 26.0,
            },
        };
        let seen = |half: [f64; 2]| Shape::upright(half.map(|side| 2.0 * side));
        scene.leader.shape = self.leader.map(seen);
        Ok(scene)
    }

    fn boxed(&self, size: [f64; 2], motion: Motion) -> Obstacle {
        Obstacle {
            shape: Shape::upright(size.map(|side| self.size_factor * side)),
            motion,
            limits: Limits::default(),
        }
    }

    fn standing(&self, draw: &mut Stream) -> Vec<Obstacle> {
        [([1.6, 2.4], [0.5, 1.0]), ([3.4, 4.2], [0.5, 0.8])]
            .into_iter()
            .map(|([low, high], size)| {
                let center = [draw.uniform(low, high), draw.uniform(-0.6, 0.6)];
                self.boxed(size, Motion::at_rest(center))
            })
            .collect()
    }

    fn moving(&self, draw: &mut Stream) -> Result<Vec<Obstacle>> {
        let boxes: &[([f64; 2], [f64; 2])] = match self.setting {
            Setting::OneDynamic => &[([2.5, 4.0], [0.8, 0.5])],
            Setting::TwoDynamic => &[([2.5, 4.0], [0.8, 0.5]), ([4.5, 6.5], [0.5, 0.2])],
            Setting::Tracking | Setting::Static => &[],
        };
        let mut side = if draw.unit() < 0.5 { -1.0 } else { 1.0 };
        let along = draw.uniform(-0.2, 0.2);
        let mut movers = Vec::with_capacity(boxes.len());
        for ([low, high], size) in boxes {
            let crossing = draw.uniform(*low, *high);
            let speed = draw.uniform(self.speeds[0], self.speeds[1]);
            let time = (crossing - 0.1) / 0.3 + draw.uniform(-2.0, 2.0);
            let run_in = (speed * time).min(RUN);
            let before = run_in / speed;
            let center = [crossing - along * before, side * run_in];
            let between = [(time - before).max(0.0), time + RUN / speed];
            let motion = Motion::between(center, [along, -side * speed], between)?;
            movers.push(self.boxed(*size, motion));
            side = -side;
        }
        Ok(movers)
    }
}

/// Longest run-in of a moving box before it crosses the way of the leader, and its way beyond, in m.
const RUN: f64 = 3.0;

fn moving_leader() -> Result<Leader> {
    Ok(Leader {
        motion: Motion::between([1.2, 0.0], [0.3, 0.0], [0.0, (7.5 - 1.2) / 0.3])?,
        shape: None,
    })
}
