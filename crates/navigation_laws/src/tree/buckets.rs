//! The nearest of many points, found through square buckets.

use crate::planning::grid::whole;

/// End of a list of points.
const NONE: usize = usize::MAX;

/// Most buckets along one axis.
const MOST_ALONG: usize = 256;

/// Points in square buckets over a box; each bucket chains its points.
#[derive(Clone, Debug)]
pub struct Buckets {
    low: [f64; 2],
    side: f64,
    counts: [usize; 2],
    /// Last point of each bucket.
    first: Vec<usize>,
    /// Point before it in the same bucket.
    next: Vec<usize>,
    points: Vec<[f64; 2]>,
    /// Buckets that are in use.
    used: Vec<usize>,
}

impl Buckets {
    /// Buckets of about a given side over a box.
    #[must_use]
    pub fn new(low: [f64; 2], high: [f64; 2], side: f64) -> Self {
        let longest = (high[0] - low[0]).max(high[1] - low[1]);
        let side = side.max(longest / MOST_ALONG as f64);
        let counts = [0, 1].map(|i| whole((high[i] - low[i]) / side, MOST_ALONG) + 1);
        Self {
            low,
            side,
            counts,
            first: vec![NONE; counts[0] * counts[1]],
            next: Vec::new(),
            points: Vec::new(),
            used: Vec::new(),
        }
    }

    /// Forgets all points.
    pub fn clear(&mut self) {
        for &bucket in &self.used {
            self.first[bucket] = NONE;
        }
        self.used.clear();
        self.next.clear();
        self.points.clear();
    }

    /// The points in the order in which they came.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Adds a point; one outside the box goes to the bucket nearest to it.
    pub fn push(&mut self, point: [f64; 2]) {
        let [column, row] = self.bucket(point);
        let bucket = row * self.counts[0] + column;
        if self.first[bucket] == NONE {
            self.used.push(bucket);
        }
        self.next.push(self.first[bucket]);
        self.first[bucket] = self.points.len();
        self.points.push(point);
    }

    fn bucket(&self, point: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|i| whole((point[i] - self.low[i]) / self.side, self.counts[i] - 1))
    }

    /// Number of the point nearest to a place; the earliest of several.
    ///
    /// Buckets are looked through in rings around the place. What is outside the box is nearer to
    /// nothing than its nearest point in the box, so the rings bound its distances too.
    #[must_use]
    pub fn nearest(&self, place: [f64; 2]) -> Option<usize> {
        let home = self.bucket(place);
        let mut best: Option<(f64, usize)> = None;
        for ring in 0..self.counts[0].max(self.counts[1]) {
            let least = ring.saturating_sub(1) as f64 * self.side;
            if best.is_some_and(|(square, _)| square < least * least) {
                break;
            }
            self.for_ring(home, ring, |bucket| {
                let mut number = self.first[bucket];
                while number != NONE {
                    let [x, y] = self.points[number];
                    let (dx, dy) = (x - place[0], y - place[1]);
                    let square = dx * dx + dy * dy;
                    if best.is_none_or(|known| (square, number) < known) {
                        best = Some((square, number));
                    }
                    number = self.next[number];
                }
            });
        }
        best.map(|(_, number)| number)
    }

    /// Calls with the buckets that are so many away from one.
    fn for_ring(&self, [column, row]: [usize; 2], ring: usize, mut each: impl FnMut(usize)) {
        let [columns, rows] = self.counts;
        let span = |at: usize, count: usize| at.saturating_sub(ring)..=(at + ring).min(count - 1);
        for y in span(row, rows) {
            if y.abs_diff(row) == ring {
                for x in span(column, columns) {
                    each(y * columns + x);
                }
                continue;
            }
            if column >= ring {
                each(y * columns + column - ring);
            }
            if column + ring < columns {
                each(y * columns + column + ring);
            }
        }
    }
}
