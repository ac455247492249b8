//! Field D*: least costs against other ways to find them, repairs against fresh searches, paths.

use crate::draws::Draws;
use proptest::prelude::*;
use vff_core::laws::field_d_star::IncrementalSearch;
use vff_core::laws::field_d_star::cost::corner_cost;
use vff_core::laws::field_d_star::extraction::extract;
use vff_core::laws::planning::path::length;

/// Of a cost of up to a few hundred cells: far above rounding.
const EQUAL: f64 = 1e-9;
/// In cells: the reference minimizes numerically.
const NUMERIC: f64 = 1e-6;

type Cell = [usize; 2];

/// Least of a convex function over an interval.
fn least(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut a, mut b) = (low, high);
    for _ in 0..45 {
        let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if f(c) < f(d) { b = d } else { a = c }
    }
    f(0.5 * (a + b)).min(f(low)).min(f(high))
}

/// The minimum that `corner_cost` states, by search; infinite costs stand for a large number.
fn corner_cost_by_search(g1: f64, g2: f64, c: f64, b: f64) -> f64 {
    let [g1, g2, c, b] = [g1, g2, c, b].map(|value| value.min(1e7));
    least(0.0, 1.0, |x| {
        least(0.0, 1.0, |y| {
            b * x + c * (1.0 - x).hypot(y) + (1.0 - y) * g1 + y * g2
        })
    })
}

/// A grid of its own: rows of cell costs.
#[derive(Clone)]
struct Costs {
    sides: Cell,
    cells: Vec<f64>,
}

impl Costs {
    fn at(&self, x: isize, y: isize) -> f64 {
        let inside = |v: isize, side: usize| usize::try_from(v).ok().filter(|v| *v < side);
        match (inside(x, self.sides[0]), inside(y, self.sides[1])) {
            (Some(x), Some(y)) => self.cells[y * self.sides[0] + x],
            _ => f64::INFINITY,
        }
    }

    #[allow(clippy::cast_possible_truncation, reason = "grids are small")]
    fn around(&self, point: [f64; 2]) -> f64 {
        self.at(point[0].floor() as isize, point[1].floor() as isize)
    }

    fn search(&self, goal: Cell, start: Cell) -> IncrementalSearch {
        let mut search = IncrementalSearch::new(self.sides, goal, start).unwrap();
        for (index, &cost) in self.cells.iter().enumerate() {
            let cell = [index % self.sides[0], index / self.sides[0]];
            search.set_cost(cell, cost).unwrap();
        }
        search.repair();
        search
    }

    /// Sweeps over all corners until nothing changes, with the minimum from `through`.
    fn iterated(&self, goal: Cell, through: impl Fn(f64, f64, f64, f64) -> f64) -> Vec<f64> {
        let across = self.sides[0] + 1;
        let count = across * (self.sides[1] + 1);
        let mut values = vec![f64::INFINITY; count];
        values[goal[1] * across + goal[0]] = 0.0;
        loop {
            let mut change = 0.0f64;
            for index in 0..count {
                if index == goal[1] * across + goal[0] {
                    continue;
                }
                let best = self.best_step(&values, index, &through);
                if best < values[index] {
                    change = change.max((values[index] - best).min(1.0));
                    values[index] = best;
                }
            }
            if change < 1e-12 {
                return values;
            }
        }
    }

    fn best_step(
        &self,
        values: &[f64],
        index: usize,
        through: impl Fn(f64, f64, f64, f64) -> f64,
    ) -> f64 {
        let across = (self.sides[0] + 1).cast_signed();
        let (x, y) = (index.cast_signed() % across, index.cast_signed() / across);
        let value = |x: isize, y: isize| {
            let inside = x >= 0 && y >= 0 && x < across && y <= self.sides[1].cast_signed();
            if inside {
                values[(y * across + x).cast_unsigned()]
            } else {
                f64::INFINITY
            }
        };
        let mut best = f64::INFINITY;
        for sx in [-1isize, 1] {
            for sy in [-1isize, 1] {
                let cell = |sx: isize, sy: isize| self.at(x + sx.min(0), y + sy.min(0));
                let far = value(x + sx, y + sy);
                let beside = [(x + sx, y, cell(sx, -sy)), (x, y + sy, cell(-sx, sy))];
                for (x, y, b) in beside {
                    let near = value(x, y);
                    // No way is cheaper than the cheapest end of the edge.
                    if near.min(far) < best {
                        best = best.min(through(near, far, cell(sx, sy), b));
                    }
                }
            }
        }
        best
    }
}

fn random_costs(draws: &mut Draws, sides: Cell, blocked: f64, kinds: usize) -> Costs {
    let cells = (0..sides[0] * sides[1])
        .map(|_| random_cost(draws, blocked, kinds))
        .collect();
    Costs { sides, cells }
}

fn random_cost(draws: &mut Draws, blocked: f64, kinds: usize) -> f64 {
    if draws.between(0.0, 1.0) < blocked {
        f64::INFINITY
    } else {
        1.0 + draws.below(kinds) as f64 * 0.75
    }
}

fn assert_equal(actual: f64, expected: f64, what: &str) {
    let equal = actual == expected || (actual - expected).abs() <= EQUAL;
    assert!(equal, "{what}: {actual} is not {expected}");
}

proptest! {
    #[test]
    fn closed_form_is_the_minimum(
        g1 in 0.0..20.0f64, gap in -3.0..8.0f64, c in 1.0..6.0f64, b in 1.0..6.0f64,
    ) {
        let cost = corner_cost(g1 + 8.0, g1 + 8.0 - gap, c, b);
        let search = corner_cost_by_search(g1 + 8.0, g1 + 8.0 - gap, c, b);
        prop_assert!((cost - search).abs() < NUMERIC, "{cost} {search}");
        // A blocked cell on either side, or an unreached neighbor.
        let walled = corner_cost(g1 + 8.0, g1 + 8.0 - gap, f64::INFINITY, b);
        prop_assert_eq!(walled, g1 + 8.0 + b);
        prop_assert_eq!(corner_cost(g1, f64::INFINITY, c, b), g1 + c.min(b));
        let far = corner_cost(f64::INFINITY, g1, c, f64::INFINITY);
        prop_assert!((far - g1 - c * 2f64.sqrt()).abs() < NUMERIC);
    }
}

#[test]
fn costs_are_those_of_value_iteration() {
    let mut draws = Draws::new(1);
    for round in 0..9 {
        let sides = [3 + draws.below(5), 3 + draws.below(5)];
        let costs = random_costs(&mut draws, sides, 0.2, 1 + 2 * (round % 3));
        let goal = [draws.below(sides[0] + 1), draws.below(sides[1] + 1)];
        let values = costs.iterated(goal, |g1, g2, c, b| {
            if c.min(b) == f64::INFINITY || g1.min(g2) == f64::INFINITY {
                return f64::INFINITY;
            }
            let cost = corner_cost_by_search(g1, g2, c, b);
            if cost < 1e6 { cost } else { f64::INFINITY }
        });
        for row in 0..sides[1] {
            for column in 0..sides[0] {
                let search = costs.search(goal, [column, row]);
                for (index, cost) in search.start_costs().into_iter().enumerate() {
                    let corner = [column + index % 2, row + index / 2];
                    let value = values[corner[1] * (sides[0] + 1) + corner[0]];
                    let equal = cost == value || (cost - value).abs() < NUMERIC;
                    assert!(equal, "round {round}, {corner:?}: {cost} is not {value}");
                }
            }
        }
    }
}

#[test]
fn repaired_costs_are_those_of_a_fresh_search() {
    let mut draws = Draws::new(2);
    let (mut unreachable, mut finite, mut saved) = (0, 0, (0u64, 0u64));
    for (sides, blocked, kinds, flips) in [
        ([40, 30], 0.25, 1, 3),
        ([40, 30], 0.3, 4, 12),
        ([25, 50], 0.1, 6, 40),
        ([12, 12], 0.45, 2, 5),
        ([1, 30], 0.02, 3, 1),
    ] {
        let goal = [draws.below(sides[0] + 1), draws.below(sides[1] + 1)];
        let mut start = [draws.below(sides[0]), draws.below(sides[1])];
        let mut costs = random_costs(&mut draws, sides, blocked, kinds);
        let mut search = costs.search(goal, start);
        for _ in 0..60 {
            for _ in 0..draws.below(flips + 1) {
                let cell = [draws.below(sides[0]), draws.below(sides[1])];
                let cost = random_cost(&mut draws, blocked, kinds);
                costs.cells[cell[1] * sides[0] + cell[0]] = cost;
                search.set_cost(cell, cost).unwrap();
            }
            // Mostly to a neighboring cell, at times across the grid.
            let far = draws.below(4) == 0;
            for i in [0, 1] {
                let near = (start[i] + draws.below(3)).saturating_sub(1);
                let any = draws.below(sides[i]);
                start[i] = if far { any } else { near.min(sides[i] - 1) };
            }
            let before = search.expansions();
            search.move_start(start).unwrap();
            search.repair();
            let fresh = costs.search(goal, start);
            saved.0 += search.expansions() - before;
            saved.1 += fresh.expansions();
            for (repaired, fresh) in search.start_costs().into_iter().zip(fresh.start_costs()) {
                assert_equal(repaired, fresh, "start");
                if fresh < f64::INFINITY {
                    finite += 1;
                } else {
                    unreachable += 1;
                }
            }
        }
    }
    // Both kinds were met, and repairs are what saves work.
    assert!(finite > 500 && unreachable > 50, "{finite} {unreachable}");
    println!(
        "{} nodes expanded in repairs, {} in fresh searches",
        saved.0, saved.1
    );
    assert!(saved.0 < saved.1, "{saved:?}");
}

#[test]
fn free_grid_costs_lie_between_the_straight_line_and_eight_directions() {
    let goal = [7, 11];
    let mut worst = 0.0f64;
    for start in [[0, 0], [29, 0], [0, 24], [29, 24], [8, 24], [20, 12]] {
        let mut search = IncrementalSearch::new([30, 25], goal, start).unwrap();
        search.repair();
        for (index, cost) in search.start_costs().into_iter().enumerate() {
            let corner = [start[0] + index % 2, start[1] + index / 2];
            let away = [0, 1].map(|i| corner[i].abs_diff(goal[i]) as f64);
            let straight = away[0].hypot(away[1]);
            let octile = away[0].max(away[1]) + (2f64.sqrt() - 1.0) * away[0].min(away[1]);
            assert!(cost >= straight - EQUAL && cost <= octile + EQUAL);
            worst = worst.max(cost / straight);
            // The path itself is nearly straight: 4 % is the worst case of interpolation.
            let mut path = Vec::new();
            assert!(extract(
                &search,
                corner.map(|v| v as f64),
                f64::INFINITY,
                &mut path
            ));
            assert!(length(&path) <= 1.04 * straight + EQUAL);
        }
    }
    // Eight directions alone would be up to 8.2 % too long.
    assert!(worst < 1.05, "{worst}");
}

#[test]
fn paths_reach_the_goal_through_free_cells_at_about_their_cost() {
    let mut draws = Draws::new(3);
    let mut found = 0;
    for round in 0..60 {
        let kinds = 1 + 3 * (round % 2);
        let sides = [20 + draws.below(20), 20 + draws.below(20)];
        let costs = random_costs(&mut draws, sides, 0.2, kinds);
        let goal = [draws.below(sides[0] + 1), draws.below(sides[1] + 1)];
        let start = [draws.below(sides[0]), draws.below(sides[1])];
        let search = costs.search(goal, start);
        let through = costs.at(start[0].cast_signed(), start[1].cast_signed());
        if search.start_costs().contains(&f64::INFINITY) || through == f64::INFINITY {
            continue;
        }
        found += 1;
        let from = start.map(|v| v as f64 + 0.5);
        let mut path = Vec::new();
        assert!(
            extract(&search, from, f64::INFINITY, &mut path),
            "round {round}"
        );
        assert_eq!(*path.last().unwrap(), goal.map(|v| v as f64));
        let mut total = 0.0;
        for leg in path.windows(2) {
            let step = length(leg);
            // A leg lies within one cell, or on the edge of two: the cheaper one counts.
            let middle = [0, 1].map(|i| 0.5 * (leg[0][i] + leg[1][i]));
            let cost = [-1e-9, 1e-9]
                .into_iter()
                .flat_map(|x| [-1e-9, 1e-9].map(|y| [middle[0] + x, middle[1] + y]))
                .map(|point| costs.around(point))
                .fold(f64::INFINITY, f64::min);
            assert!(step > 0.0 && cost < f64::INFINITY, "round {round}: {leg:?}");
            total += step * cost;
        }
        let corners = search.start_costs();
        let bound = corners.map(|g| g + through * 0.5f64.sqrt());
        let bound = bound.into_iter().fold(f64::INFINITY, f64::min);
        assert!(total <= 1.05 * bound, "round {round}: {total} {bound}");
    }
    assert!(found > 20, "{found}");
}

#[test]
fn costs_and_places_out_of_range_are_refused() {
    let mut search = IncrementalSearch::new([3, 3], [0, 0], [2, 2]).unwrap();
    for cost in [0.5, -1.0, f64::NAN] {
        assert!(search.set_cost([1, 1], cost).is_err());
    }
    assert!(search.set_cost([3, 0], 1.0).is_err() && search.move_start([0, 3]).is_err());
    assert!(IncrementalSearch::new([3, 3], [4, 0], [0, 0]).is_err());
    assert!(IncrementalSearch::new([0, 3], [0, 0], [0, 0]).is_err());
}
