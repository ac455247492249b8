//! Cells that a beam crosses, after Amanatides and Woo (1987).

/// Hands the cells of a segment over one after the other, the first and the last included; ends are given in cells.
///
/// The number of cells is that of the lines of the grid between the ends, and one: rounding may choose the
/// other of two cells at a corner, but neither loses the last cell nor goes beyond it.
#[inline]
pub fn walk(from: [f64; 2], to: [f64; 2], mut visit: impl FnMut([i64; 2])) {
    walk_while(from, to, |cell| {
        visit(cell);
        true
    });
}

/// Hands the cells of a segment over as [`walk`] does, until one is answered by `false`.
#[inline]
#[allow(clippy::cast_possible_truncation)] // ends are checked to be cells of a grid
pub fn walk_while(from: [f64; 2], to: [f64; 2], mut visit: impl FnMut([i64; 2]) -> bool) {
    let mut cell = from.map(|axis| axis.floor() as i64);
    let last = to.map(|axis| axis.floor() as i64);
    let step = [(last[0] - cell[0]).signum(), (last[1] - cell[1]).signum()];
    let mut left = [(last[0] - cell[0]).abs(), (last[1] - cell[1]).abs()];
    let gap = [0, 1].map(|axis: usize| 1.0 / (to[axis] - from[axis]).abs());
    // Where no line of an axis is left, the next one is never met.
    let mut next = [0, 1].map(|axis: usize| {
        let line = if step[axis] > 0 {
            cell[axis] as f64 + 1.0
        } else {
            cell[axis] as f64
        };
        if left[axis] == 0 {
            f64::INFINITY
        } else {
            (line - from[axis]).abs() * gap[axis]
        }
    });
    if !visit(cell) {
        return;
    }
    for _ in 0..left[0] + left[1] {
        if next[1] < next[0] {
            cell[1] += step[1];
            left[1] -= 1;
            next[1] = if left[1] == 0 {
                f64::INFINITY
            } else {
                next[1] + gap[1]
            };
        } else {
            cell[0] += step[0];
            left[0] -= 1;
            next[0] = if left[0] == 0 {
                f64::INFINITY
            } else {
                next[0] + gap[0]
            };
        }
        if !visit(cell) {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::walk;

    proptest! {
        #[test]
        fn cells_of_a_walk_are_those_that_the_segment_meets(
            from in prop::array::uniform2(-20.0..20.0f64), to in prop::array::uniform2(-20.0..20.0f64)
        ) {
            let mut found = Vec::new();
            walk(from, to, |cell| found.push(cell));
            prop_assert_eq!(found[0], from.map(|axis| axis.floor() as i64));
            prop_assert_eq!(found[found.len() - 1], to.map(|axis| axis.floor() as i64));
            for pair in found.windows(2) {
                prop_assert_eq!((pair[1][0] - pair[0][0]).abs() + (pair[1][1] - pair[0][1]).abs(), 1);
            }
            for index in 0..=1000 {
                let share = f64::from(index) / 1000.0;
                let place = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
                let near = found.iter().any(|cell| (0..2).all(|axis| {
                    let low = cell[axis] as f64;
                    (low - 1e-9..=low + 1.0 + 1e-9).contains(&place[axis])
                }));
                prop_assert!(near, "{:?} of {:?}", place, found);
            }
            // No cell that the segment does not meet.
            for cell in &found {
                let share = |axis: usize, line: f64| (line - from[axis]) / (to[axis] - from[axis]);
                let span = |axis: usize| {
                    let ends = [share(axis, cell[axis] as f64), share(axis, cell[axis] as f64 + 1.0)];
                    [ends[0].min(ends[1]), ends[0].max(ends[1])]
                };
                let (x, y) = (span(0), span(1));
                prop_assert!(x[0].max(y[0]).max(0.0) <= x[1].min(y[1]).min(1.0) + 1e-9);
            }
        }
    }

    #[test]
    fn a_walk_within_a_cell_is_that_cell() {
        let mut found = Vec::new();
        walk([0.2, 0.3], [0.8, 0.3], |cell| found.push(cell));
        assert_eq!(found, [[0, 0]]);
        found.clear();
        walk([1.5, 0.5], [-0.5, 0.5], |cell| found.push(cell));
        assert_eq!(found, [[1, 0], [0, 0], [-1, 0]]);
    }
}
