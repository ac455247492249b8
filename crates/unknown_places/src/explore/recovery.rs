//! A robot that makes no progress drives somewhere else for a while.

use std::collections::VecDeque;

use navigation_world::robots::differential::Twist;
use numeric::random::Stream;

/// Progress is asked for over this time in s, between the least time to the goal of the last half second and then.
const WINDOW: f64 = 2.5;
const LATELY: f64 = 0.5;
/// Progress in s.
const PROGRESS: f64 = 0.05;
/// How long the robot drives somewhere else, in s.
const LASTS: f64 = 0.7;
/// Speeds and turn rates then, in m/s and rad/s.
const TWISTS: [[f64; 2]; 7] = [
    [0.0, 3.0],
    [0.0, -3.0],
    [-0.4, 0.0],
    [-0.3, 1.0],
    [-0.3, -1.0],
    [0.3, 2.0],
    [0.3, -2.0],
];

/// Times to the goal in the last control periods, and what is driven instead of progress.
#[derive(Clone, Debug)]
pub struct Recovery {
    times: VecDeque<f64>,
    window: usize,
    lately: usize,
    lasts: usize,
    left: usize,
    twist: Twist,
    stream: Stream,
    begun: u64,
}

fn periods(time: f64, period: f64) -> usize {
    (time / period).round().max(1.0) as usize
}

impl Recovery {
    /// Nothing is known yet.
    pub fn new(period: f64, seed: u64) -> Self {
        Self {
            times: VecDeque::new(),
            window: periods(WINDOW, period),
            lately: periods(LATELY, period),
            lasts: periods(LASTS, period),
            left: 0,
            twist: Twist::default(),
            stream: Stream::new(seed, 0),
            begun: 0,
        }
    }

    /// How often the robot made no progress.
    pub fn begun(&self) -> u64 {
        self.begun
    }

    /// Forgets the last times.
    pub fn restart(&mut self) {
        self.times.clear();
        self.left = 0;
    }

    /// The twist to drive instead of one that makes no progress; `time`: to the goal in s, if there is a way.
    pub fn observe(&mut self, time: Option<f64>) -> Option<Twist> {
        if self.left > 0 {
            self.left -= 1;
            if self.left == 0 {
                self.times.clear();
            }
            return Some(self.twist);
        }
        self.times.push_back(time.unwrap_or(f64::INFINITY));
        if self.times.len() <= self.window {
            return None;
        }
        let before = self.times.pop_front().unwrap_or(f64::INFINITY);
        let lately = self
            .times
            .iter()
            .rev()
            .take(self.lately)
            .copied()
            .fold(f64::INFINITY, f64::min);
        // Without a way, before and now, there is no progress either.
        if lately <= before - PROGRESS {
            return None;
        }
        let [speed, turn_rate] = TWISTS[self.stream.below(TWISTS.len())];
        self.twist = Twist { speed, turn_rate };
        self.left = self.lasts;
        self.begun += 1;
        Some(self.twist)
    }
}
