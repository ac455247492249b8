"""Sobol indices of sweeps, against closed forms of a published function."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from hrsafety import InvalidParameterError, impact, sweep

AXES = [sweep.Axis(name=name, low=-np.pi, high=np.pi) for name in ("x", "y", "z")]


def ishigami(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> dict[str, np.ndarray]:
    """Return the function of Ishigami and Homma with a = 7, b = 0.1."""
    return {"value": np.sin(x) + 7.0 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x), "flat": np.full(len(x), 2.0)}


STUDY = sweep.FunctionStudy(function=ishigami, results=["value", "flat"])
# Closed forms of Sobol and Levitan (1999).
VARIANCE = 49.0 / 8.0 + 0.1 * np.pi**4 / 5.0 + 0.01 * np.pi**8 / 18.0 + 0.5
FIRST = np.array([0.5 * (1.0 + 0.1 * np.pi**4 / 5.0) ** 2, 49.0 / 8.0, 0.0]) / VARIANCE
BOTH = 8.0 * 0.01 * np.pi**8 / 225.0 / VARIANCE
TOTAL = FIRST + np.array([BOTH, 0.0, BOTH])


def test_indices_of_a_function_with_closed_forms() -> None:
    found = sweep.sobol_indices(sweep.run(sweep.Saltelli(AXES, 4096), STUDY), "value", resamples=200)
    assert found.axes == ("x", "y", "z")
    np.testing.assert_allclose(found.first, FIRST, atol=0.02)
    np.testing.assert_allclose(found.total, TOTAL, atol=0.02)
    assert found.variance == pytest.approx(VARIANCE, rel=0.02)
    for interval, value in ((found.first_interval, FIRST), (found.total_interval, TOTAL)):
        assert (interval[:, 0] <= value + 0.005).all()
        assert (interval[:, 1] >= value - 0.005).all()
    assert found.warnings == ()


def test_few_rows_are_doubted_and_the_same_seed_gives_the_same_intervals() -> None:
    result = sweep.run(sweep.Saltelli(AXES, 64), STUDY)
    one, two = (sweep.sobol_indices(result, "value", resamples=50, seed=3) for _ in range(2))
    assert [each.code for each in one.warnings] == ["wide_interval"]
    assert np.array_equal(one.total_interval, two.total_interval)
    other = sweep.sobol_indices(result, "value", resamples=50, seed=4)
    assert not np.array_equal(one.total_interval, other.total_interval)


def test_a_stored_sweep_keeps_its_design(tmp_path: Path) -> None:
    made = sweep.run(sweep.Saltelli(AXES, 32, seed=5), STUDY, out=tmp_path / "rows", chunk_rows=7)
    again = sweep.open(tmp_path / "rows")
    assert again.design == made.design
    assert len(again) == 32 * 5
    assert np.array_equal(sweep.sobol_indices(again, "value").total, sweep.sobol_indices(made, "value").total)


@settings(max_examples=30, deadline=None)
@given(axes=some.integers(1, 5), size=some.sampled_from([2, 8, 64]), cut=some.data())
def test_any_range_of_rows_is_that_of_all_rows(axes: int, size: int, cut: some.DataObject) -> None:
    design = sweep.Saltelli([sweep.Axis(name=f"a{index}", low=0.0, high=1.0) for index in range(axes)], size, seed=1)
    rows = design.rows()
    start = cut.draw(some.integers(0, len(design)))
    stop = cut.draw(some.integers(start, len(design)))
    assert np.array_equal(design.rows(start, stop), rows[start:stop])
    by_row = rows.reshape(size, axes + 2, axes)
    for index in range(axes):
        expected = by_row[:, 0].copy()
        expected[:, index] = by_row[:, 1, index]
        assert np.array_equal(by_row[:, 2 + index], expected)


def test_what_has_no_indices_is_refused(tmp_path: Path) -> None:
    result = sweep.run(sweep.Saltelli(AXES, 8), STUDY)
    with pytest.raises(InvalidParameterError, match="must vary over the axes"):
        sweep.sobol_indices(result, "flat")
    with pytest.raises(InvalidParameterError, match="must be of a Saltelli design"):
        sweep.sobol_indices(sweep.run(sweep.Sobol(AXES, 8), STUDY), "value")
    with pytest.raises(InvalidParameterError, match="must be a power of two"):
        sweep.Saltelli(AXES, 100)
    part = sweep.run(sweep.Saltelli(AXES, 8), STUDY, out=tmp_path / "part", chunk_rows=8, chunks="0:1")
    with pytest.raises(InvalidParameterError, match="must be complete"):
        sweep.sobol_indices(part, "value")
    holes = sweep.FunctionStudy(function=lambda x: {"y": np.where(x > 0.0, x, np.nan)}, results=["y"])
    with pytest.raises(InvalidParameterError, match="must be finite in every row"):
        sweep.sobol_indices(sweep.run(sweep.Saltelli(AXES[:1], 8), holes), "y")


def test_one_axis_alone_causes_all() -> None:
    study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    result = sweep.run(sweep.Saltelli([sweep.Axis(name="closing_speed", low=0.2, high=2.0)], 64), study)
    found = sweep.sobol_indices(result, "peak_contact_force", resamples=20)
    assert found.first.shape == found.total.shape == (1,)
    assert found.total[0] == pytest.approx(1.0, abs=0.1)
