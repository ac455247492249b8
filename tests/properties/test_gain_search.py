"""What holds for any search for gains: order, scale, bounds, fronts."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import _hrsafety, scenarios
from hrsafety import navigation as nav

SCENES = [scenarios.configuration(name) for name in ("c1", "c3")]
LAW = nav.VirtualForceField(stabilizing="off")
HIGHEST = (50.0, 200.0, 500.0, 3.0)


@st.composite
def boxes(draw: st.DrawFn) -> np.ndarray:
    """Draw bounds of the gains, some of them held."""
    rows = []
    for highest in HIGHEST:
        ends = sorted(draw(st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0))))
        rows.append([highest * end for end in ends])
    return np.array(rows)


grids = st.tuples(*[st.integers(2, 4)] * 4)
few = settings(max_examples=25)


def points_of(entry: nav.gains.SearchStage) -> np.ndarray:
    return np.array(list(itertools.product(*entry.axes)))


def mean_scores(points: np.ndarray, weights: tuple[float, ...] = (1 / 3, 1 / 3, 1 / 3)) -> np.ndarray:
    table = nav.simulate_batch(SCENES, LAW, points, weights=weights, stop_on_contact=True)
    return table.performance_total.reshape(len(points), -1).mean(axis=1)


def judged(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return mean H with ratios up to 1, and the number of runs that fail, of each point."""
    table = nav.simulate_batch(SCENES, LAW, points, stop_on_contact=True)
    parts = (np.minimum(table.performance_arrival_time, 1.0), np.minimum(table.performance_energy_saving, 1.0))
    total = np.where(table.performance_total > 0.0, sum(parts, table.performance_avoidance) / 3.0, 0.0)
    failed = table.outcome != "arrived"
    return total.reshape(len(points), -1).mean(axis=1), failed.reshape(len(points), -1).sum(axis=1)


@few
@given(boxes(), grids, st.integers(1, 40), st.integers(0, 3))
def test_best_is_at_least_every_point_and_inside_the_bounds(
    bounds: np.ndarray, grid: tuple[int, ...], survivors: int, starts: int
) -> None:
    found = nav.optimize_gains(
        SCENES, bounds=bounds, grid=grid, refinements=1, survivors=survivors, local_starts=starts
    )
    nearest = np.array(found.nearest.gains)
    assert ((bounds[:, 0] <= nearest) & (nearest <= bounds[:, 1])).all()
    for entry in found.grids:
        points = points_of(entry)
        assert ((bounds[:, 0] <= points) & (points <= bounds[:, 1])).all()
        scores, failures = judged(points)
        assert (failures >= found.violation).all()
        assert (scores[failures == found.violation] <= found.best_value + 1e-12).all()
    (score,), (missed,) = judged(nearest[None, :])
    assert score == pytest.approx(found.best_value, abs=1e-12)
    assert found.violation == missed
    assert found.valid == found.feasible == (missed == 0)


@few
@given(grids, st.floats(0.01, 100.0), st.floats(-5.0, 5.0))
def test_a_scaled_and_shifted_objective_has_the_same_best(grid: tuple[int, ...], scale: float, shift: float) -> None:
    def scores(table: nav.RunTable) -> np.ndarray:
        return np.round(table.performance_total.reshape(-1, len(SCENES)).mean(axis=1), 6)

    options: dict[str, Any] = {"grid": grid, "refinements": 1, "survivors": 12, "local_starts": 0}
    plain = nav.optimize_gains(SCENES, objective=scores, **options)
    other = nav.optimize_gains(SCENES, objective=lambda table: scale * scores(table) + shift, **options)
    assert other.best.gains == plain.best.gains
    assert other.best_value == scale * plain.best_value + shift
    np.testing.assert_array_equal(other.top, plain.top)


@few
@given(grids, st.permutations(range(3)))
def test_order_of_the_scenarios_does_not_matter(grid: tuple[int, ...], order: list[int]) -> None:
    scenes = [scenarios.configuration(name) for name in ("c1", "c2", "c3")]
    options: dict[str, Any] = {"grid": grid, "refinements": 0, "local_starts": 0}
    plain = nav.optimize_gains(scenes, **options)
    other = nav.optimize_gains([scenes[index] for index in order], **options)
    assert other.best_value == pytest.approx(plain.best_value, abs=1e-14)
    np.testing.assert_allclose(other.top_values, plain.top_values, atol=1e-14)


@few
@given(grids, st.floats(0.0, 0.6))
def test_a_tighter_constraint_never_makes_it_better(grid: tuple[int, ...], least: float) -> None:
    options: dict[str, Any] = {"grid": grid, "refinements": 0, "local_starts": 0}
    values = []
    for limit in (least, least + 0.1):
        constraint = nav.gains.GainConstraint(metric="min_clearance", at_least=limit)
        found = nav.optimize_gains(SCENES, constraints=[constraint], **options)
        table = nav.simulate_batch(SCENES, found.nearest, stop_on_contact=True)
        holds = bool(table.min_clearance.min() >= limit and (table.outcome == "arrived").all())
        assert holds == (found.violation == 0.0)
        values.append((-found.violation, found.best_value if holds else -math.inf))
    assert values[1] <= values[0]


def dominates(one: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return which of the others are beaten by one, all objectives maximized."""
    return (one >= others).all(axis=1) & (one > others).any(axis=1)


METRICS = ("arrival_time", "energy", "path_length", "min_clearance", "performance", "performance_avoidance")


@few
@given(grids, st.lists(st.sampled_from(METRICS), min_size=2, max_size=3, unique=True))
def test_front_is_what_no_point_of_the_grid_dominates(grid: tuple[int, ...], objectives: list[str]) -> None:
    front = nav.gains.pareto_front(SCENES, objectives=objectives, grid=grid, refinements=0)
    axes = [np.linspace(0.0, high, count) for high, count in zip(HIGHEST, grid, strict=True)]
    points = np.array(list(itertools.product(*axes)))
    table = nav.simulate_batch(SCENES, LAW, points, stop_on_contact=True)
    columns = []
    for metric in objectives:
        values = getattr(table, {"performance": "performance_total"}.get(metric, metric)).reshape(len(points), -1)
        combined = values.min(axis=1) if metric == "min_clearance" else values.mean(axis=1)
        columns.append(combined if front.maximized[objectives.index(metric)] else -combined)
    raised = np.column_stack(columns)
    arrived = (table.outcome == "arrived").reshape(len(points), -1).all(axis=1)
    signs = np.where(front.maximized, 1.0, -1.0)
    assert front.evaluations == len(points)
    runs = nav.simulate_batch(SCENES, LAW, front.gains, stop_on_contact=True) if len(front) else None
    assert runs is None or (runs.outcome == "arrived").all()
    for own in front.values * signs:
        # The slack is for the mean, which may be summed in another order.
        assert not (raised[arrived] > own + 1e-9).all(axis=1).any()
        assert not dominates(own, front.values * signs).any()
    for each in raised[arrived]:
        covered = ((front.values * signs) >= each - 1e-9).all(axis=1).any()
        assert covered
    assert 0.0 <= front.hypervolume <= 1.0


@settings(max_examples=100)
@given(st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1)), min_size=1, max_size=12))
def test_volume_of_a_flat_front_is_that_of_its_steps(points: list[tuple[float, float]]) -> None:
    found = _hrsafety.front_hypervolume(np.array(points).ravel().tolist(), 2, [0.0, 0.0])
    # Area of the union of rectangles, column by column.
    edges = np.unique([0.0, *(x for x, _ in points)])
    area = sum((right - left) * max(y for x, y in points if x >= right) for left, right in itertools.pairwise(edges))
    assert found == pytest.approx(area, abs=1e-12)


@settings(max_examples=40)
@given(st.lists(st.tuples(*[st.integers(0, 4)] * 3), min_size=1, max_size=8))
def test_volume_in_three_dimensions_is_the_number_of_cells(points: list[tuple[int, ...]]) -> None:
    found = _hrsafety.front_hypervolume([float(x) for point in points for x in point], 3, [0.0] * 3)
    cells = itertools.product(range(4), repeat=3)
    below = sum(any(all(c < x for c, x in zip(cell, point, strict=True)) for point in points) for cell in cells)
    assert found == pytest.approx(below, abs=1e-9)
