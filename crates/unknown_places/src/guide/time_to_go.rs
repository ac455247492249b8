//! Result of a search: times to the goal, and the way of each node.

use nalgebra::Vector2;

/// Nodes that the direction of the plan looks ahead.
const AHEAD: u32 = 7;
/// Nearer than this in m a node is in no direction.
const NEAR: f64 = 0.1;
/// No node.
pub(super) const NONE: u32 = u32::MAX;

/// Times to the goal over the cells of a window.
#[derive(Clone, Debug, Default)]
pub struct TimeToGo {
    pub(super) size: usize,
    pub(super) cell: f64,
    pub(super) low: [i64; 2],
    /// Time to the goal in s; infinite where it is not known.
    pub(super) time: Vec<f32>,
    /// The next node on the way.
    pub(super) next: Vec<u32>,
    /// The node that the direction looks at, found when it is asked for.
    pub(super) ahead: Vec<u32>,
}

/// Time to the goal from a place, and the place that the plan looks ahead to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlook {
    /// In s.
    pub time: f64,
    /// Way to the place that the plan looks ahead to in m; `None` beside the end of the plan.
    pub ahead: Option<Vector2<f64>>,
}

impl TimeToGo {
    /// Nothing, with room for so many nodes.
    #[must_use]
    pub fn with_room(nodes: usize) -> Self {
        Self {
            time: vec![f32::INFINITY; nodes],
            next: vec![NONE; nodes],
            ahead: vec![NONE; nodes],
            ..Self::default()
        }
    }

    fn middle(&self, node: usize) -> Vector2<f64> {
        let axis = |place: usize, low: i64| ((place as i64 + low) as f64 + 0.5) * self.cell;
        Vector2::new(
            axis(node % self.size, self.low[0]),
            axis(node / self.size, self.low[1]),
        )
    }

    /// The four nodes around a place with the weights of the place.
    #[inline]
    fn around(&self, place: Vector2<f64>) -> Option<[(usize, f64); 4]> {
        let most = self.size as f64 - 1.0;
        let axis = |index: usize| {
            let found = place[index] / self.cell - self.low[index] as f64 - 0.5;
            // Cut off, a number that is not negative is rounded down.
            let node = found as i64;
            (found >= 0.0 && found < most).then_some((node as usize, found - node as f64))
        };
        let ((column, x), (row, y)) = (axis(0)?, axis(1)?);
        let node = row * self.size + column;
        Some([
            (node, (1.0 - x) * (1.0 - y)),
            (node + 1, x * (1.0 - y)),
            (node + self.size, (1.0 - x) * y),
            (node + self.size + 1, x * y),
        ])
    }

    /// Time from a place in s, bilinear over the nodes around it whose times are known.
    #[inline]
    #[must_use]
    pub fn time(&self, place: Vector2<f64>) -> Option<f64> {
        self.weighed(place).map(|(time, _)| time)
    }

    /// Time from a place, and the nearest to the goal of the nodes around it.
    #[inline]
    fn weighed(&self, place: Vector2<f64>) -> Option<(f64, usize)> {
        let (mut sum, mut weights, mut least) = (0.0, 0.0, (f32::INFINITY, 0));
        for (node, weight) in self.around(place)? {
            let time = self.time[node];
            if time < f32::INFINITY {
                sum += weight * f64::from(time);
                weights += weight;
                if time < least.0 {
                    least = (time, node);
                }
            }
        }
        // Beside the only node that is known the weight may be nothing.
        (least.0 < f32::INFINITY).then(|| {
            let time = if weights > 1e-9 {
                sum / weights
            } else {
                f64::from(least.0)
            };
            (time, least.1)
        })
    }

    /// Time from a place and direction of the plan there.
    #[inline]
    pub fn outlook(&mut self, place: Vector2<f64>) -> Option<Outlook> {
        let (time, node) = self.weighed(place)?;
        let ahead = self.look_ahead(node);
        let toward = self.middle(ahead) - place;
        let ahead = (toward.norm_squared() >= NEAR * NEAR).then_some(toward);
        Some(Outlook { time, ahead })
    }

    fn look_ahead(&mut self, node: usize) -> usize {
        if self.ahead[node] == NONE {
            let mut at = node;
            for _ in 0..AHEAD {
                at = self.next[at] as usize;
            }
            let found = at as u32;
            self.ahead[node] = found;
        }
        self.ahead[node] as usize
    }

    /// Places of the plan from a place to where it ends, in m.
    #[must_use]
    pub fn way(&self, place: Vector2<f64>) -> Vec<Vector2<f64>> {
        let Some((_, first)) = self.weighed(place) else {
            return Vec::new();
        };
        let mut way = vec![self.middle(first)];
        let mut node = first;
        while way.len() < self.time.len() && self.next[node] as usize != node {
            node = self.next[node] as usize;
            way.push(self.middle(node));
        }
        way
    }
}
