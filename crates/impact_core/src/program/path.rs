//! Paths of the joints: cubic pieces over a parameter that is no time.

use numeric::error::{Failure, Given, Result, at_most};

/// Most intervals of a path.
pub const MOST_INTERVALS: usize = 1_000_000;

/// Least length of an interval as a share of the path.
const LEAST_LENGTH: f64 = 1e-12;

/// Largest gap between neighboring pieces as a share of 1 rad or m, or of the value where that is larger.
const LARGEST_GAP: f64 = 1e-6;

/// A path `q(s)`: one cubic polynomial on each interval, in powers of the way from its start.
#[derive(Clone, Debug, PartialEq)]
pub struct JointPath {
    joints: usize,
    nodes: Vec<f64>,
    /// By intervals, powers (the lowest one first) and joints.
    coefficients: Vec<f64>,
}

/// The polynomial of one interval.
#[derive(Clone, Copy, Debug)]
pub struct CubicPiece<'a> {
    /// Length of the interval.
    pub length: f64,
    joints: usize,
    coefficients: &'a [f64],
}

impl JointPath {
    /// A path with intervals between rising nodes.
    ///
    /// # Errors
    /// Numbers do not fit each other or are not finite, nodes do not rise, pieces do not meet, an interval does not move.
    pub fn new(nodes: Vec<f64>, coefficients: Vec<f64>, joints: usize) -> Result<Self> {
        let intervals = nodes.len().saturating_sub(1);
        at_most("s", intervals, MOST_INTERVALS)?;
        if intervals == 0 || joints == 0 || coefficients.len() != 4 * joints * intervals {
            let rule = "hold 4 powers of each joint for each interval between two nodes, of which there is one at least";
            let found = Given::Found(format!("{} numbers", coefficients.len()).into());
            return Err(Failure::invalid("coefficients", rule, found));
        }
        for (name, numbers) in [("s", &nodes), ("coefficients", &coefficients)] {
            if let Some(wrong) = numbers.iter().find(|number| !number.is_finite()) {
                return Err(Failure::invalid(name, "be finite", Given::Number(*wrong)));
            }
        }
        let path = Self {
            joints,
            nodes,
            coefficients,
        };
        path.check_nodes()?;
        path.check_pieces()?;
        Ok(path)
    }

    fn check_nodes(&self) -> Result<()> {
        let [first, last] = [self.nodes[0], self.nodes[self.intervals()]];
        for (index, pair) in self.nodes.windows(2).enumerate() {
            let length = pair[1] - pair[0];
            if !length.is_finite() || length <= LEAST_LENGTH * (last - first) {
                let rule = format!("rise by more than {LEAST_LENGTH:?} of the whole path");
                let name = format!("s[{}]", index + 1);
                return Err(Failure::invalid(name, rule, Given::Number(pair[1])));
            }
        }
        Ok(())
    }

    fn check_pieces(&self) -> Result<()> {
        let mut end = vec![0.0; self.joints];
        for index in 0..self.intervals() {
            let piece = self.piece(index);
            if (0..self.joints).all(|joint| piece.tangents(joint) == [0.0; 3]) {
                let found = Given::Found("an interval without motion".into());
                let name = format!("coefficients[{index}]");
                return Err(Failure::invalid(name, "move a joint", found));
            }
            if index > 0 {
                for (joint, before) in end.iter().enumerate() {
                    let after = piece.powers(joint)[0];
                    let gap = (after - before).abs();
                    if gap.is_nan() || gap > LARGEST_GAP * after.abs().max(1.0) {
                        let name = format!("coefficients[{index}, 0, {joint}]");
                        let rule = "be the value at the end of the interval before";
                        return Err(Failure::invalid(name, rule, Given::Number(after)));
                    }
                }
            }
            piece.place(piece.length, &mut end);
        }
        Ok(())
    }

    /// Number of joints.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.joints
    }

    /// Number of intervals.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Nodes between the intervals, and both ends.
    #[must_use]
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Coefficients by intervals, powers (the lowest one first) and joints.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The polynomial of an interval.
    #[must_use]
    pub fn piece(&self, index: usize) -> CubicPiece<'_> {
        let size = 4 * self.joints;
        CubicPiece {
            length: self.nodes[index + 1] - self.nodes[index],
            joints: self.joints,
            coefficients: &self.coefficients[index * size..(index + 1) * size],
        }
    }

    /// Path with every interval cut into so many equal ones.
    ///
    /// # Errors
    /// There is not a count for each interval, one is zero, or there are too many intervals.
    pub fn refined(&self, parts: &[usize]) -> Result<Self> {
        let wrong = parts.len() != self.intervals() || parts.contains(&0);
        if wrong {
            let found = Given::Found("another number of counts, or a zero".into());
            let rule = "hold a count of at least 1 for each interval";
            return Err(Failure::invalid("parts", rule, found));
        }
        let total = parts
            .iter()
            .fold(0_usize, |sum, part| sum.saturating_add(*part));
        at_most("parts", total, MOST_INTERVALS)?;
        let mut nodes = Vec::with_capacity(total + 1);
        let mut coefficients = vec![0.0; 4 * self.joints * total];
        let mut rows = coefficients.chunks_exact_mut(4 * self.joints);
        nodes.push(self.nodes[0]);
        for (index, count) in parts.iter().enumerate() {
            let piece = self.piece(index);
            for (part, row) in (0..*count).zip(&mut rows) {
                let way = piece.length * part as f64 / *count as f64;
                piece.shifted(way, row);
                nodes.push(if part + 1 == *count {
                    self.nodes[index + 1]
                } else {
                    self.nodes[index] + piece.length * (part + 1) as f64 / *count as f64
                });
            }
        }
        Self::new(nodes, coefficients, self.joints)
    }
}

impl CubicPiece<'_> {
    /// Coefficients of a joint, that of the lowest power first.
    #[must_use]
    pub fn powers(&self, joint: usize) -> [f64; 4] {
        std::array::from_fn(|power| self.coefficients[power * self.joints + joint])
    }

    /// Values of the joints at a way from the start.
    pub fn place(&self, way: f64, values: &mut [f64]) {
        for (joint, value) in values.iter_mut().enumerate() {
            let [q0, q1, q2, q3] = self.powers(joint);
            *value = q0 + way * (q1 + way * (q2 + way * q3));
        }
    }

    /// Derivatives of the joints by `s` at a way from the start.
    pub fn rates(&self, way: f64, values: &mut [f64]) {
        for (joint, value) in values.iter_mut().enumerate() {
            let [_, q1, q2, q3] = self.powers(joint);
            *value = q1 + way * (2.0 * q2 + 3.0 * way * q3);
        }
    }

    /// Derivative of a joint at the start, its Bernstein coefficient in the middle, derivative at the end.
    #[must_use]
    pub fn tangents(&self, joint: usize) -> [f64; 3] {
        let ([_, q1, q2, q3], h) = (self.powers(joint), self.length);
        [q1, q1 + h * q2, q1 + h * (2.0 * q2 + 3.0 * h * q3)]
    }

    /// Writes the coefficients of the polynomial in powers of the way from another place.
    fn shifted(&self, way: f64, row: &mut [f64]) {
        for joint in 0..self.joints {
            let [q0, q1, q2, q3] = self.powers(joint);
            let moved = [
                q0 + way * (q1 + way * (q2 + way * q3)),
                q1 + way * (2.0 * q2 + 3.0 * way * q3),
                q2 + 3.0 * way * q3,
                q3,
            ];
            for (power, value) in moved.into_iter().enumerate() {
                row[power * self.joints + joint] = value;
            }
        }
    }
}
