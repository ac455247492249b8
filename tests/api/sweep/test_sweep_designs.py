"""Axes and designs: against SciPy and numpy, lazy in any order, and what they refuse."""

from __future__ import annotations

import pickle
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import qmc

from hrsafety import InvalidParameterError, ShapeError, impact, sweep
from hrsafety.sweep.strata import latin_shares, permuted

UNIT_AXES = [sweep.Axis(name=name, low=0.0, high=1.0) for name in "abc"]
# Rows of the longest designs.
MANY = 10**8
# Centered discrepancy of a Latin hypercube scatters by so much from seed to seed.
LIKE_SCIPY = 3.0


def in_pieces(design: sweep.Design, size: int, *, backwards: bool) -> Any:
    starts = list(range(0, len(design), size))
    pieces = {start: design.rows(start, min(start + size, len(design))) for start in sorted(starts, reverse=backwards)}
    return np.concatenate([pieces[start] for start in starts])


def test_grid_is_that_of_meshgrid() -> None:
    axes = [
        sweep.Axis(name="a", values=[3.0, 1.0]),
        sweep.Axis(name="b", low=1.0, high=1000.0, points=4, scale="log"),
        sweep.Axis(name="c", low=-2, high=2, scale="integer"),
    ]
    grid = sweep.Grid(axes)
    expected = np.meshgrid([3.0, 1.0], [1.0, 10.0, 100.0, 1000.0], [-2, -1, 0, 1, 2], indexing="ij")
    np.testing.assert_allclose(grid.rows(), np.stack([each.ravel() for each in expected], axis=1), rtol=1e-14)
    assert grid.shape == (2, 4, 5)


@pytest.mark.parametrize("rows", [1, 2, 7, 64, 1000])
@pytest.mark.parametrize("scramble", [True, False])
def test_sobol_rows_are_those_of_scipy(rows: int, scramble: bool) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        expected = qmc.Sobol(3, scramble=scramble, rng=np.random.default_rng(5)).random(rows)
    design = sweep.Sobol(UNIT_AXES, rows, seed=5, scramble=scramble)
    np.testing.assert_array_equal(design.rows(), expected)
    for backwards in (False, True):
        np.testing.assert_array_equal(in_pieces(design, 3, backwards=backwards), expected)


@pytest.mark.parametrize("rows", [1, 2, 7, 1000])
def test_latin_hypercube_rows_are_those_of_scipy(rows: int) -> None:
    design = sweep.LatinHypercube(UNIT_AXES, rows, seed=5)
    expected = qmc.LatinHypercube(3, rng=np.random.default_rng(5)).random(rows)
    np.testing.assert_array_equal(design.rows(), expected)
    np.testing.assert_array_equal(in_pieces(design, 3, backwards=True), expected)


@given(rows=st.integers(1, 3000), seed=st.integers(0, 2**32), axis=st.integers(0, 20))
def test_keyed_permutation_is_one(rows: int, seed: int, axis: int) -> None:
    found = permuted(np.arange(rows, dtype=np.uint64), rows, seed, axis)
    np.testing.assert_array_equal(np.sort(found), np.arange(rows))


def test_long_latin_hypercube_has_one_row_in_each_stratum_and_is_the_same_in_pieces() -> None:
    rows = 100_003
    design = sweep.LatinHypercube(UNIT_AXES, rows, seed=7)
    whole = design.rows()
    for column in whole.T:
        np.testing.assert_array_equal(np.sort(np.floor(column * rows).astype(int)), np.arange(rows))
    np.testing.assert_array_equal(in_pieces(design, 9001, backwards=True), whole)
    assert np.abs(np.corrcoef(whole.T) - np.eye(3)).max() < 4.0 / np.sqrt(rows)
    assert abs(np.corrcoef(whole[1:, 0], whole[:-1, 0])[0, 1]) < 4.0 / np.sqrt(rows)


@pytest.mark.parametrize("rows", [64, 512])
def test_long_scheme_fills_space_as_well_as_that_of_scipy(rows: int) -> None:
    own = np.median([qmc.discrepancy(latin_shares(rows, 3, seed, 0, rows)) for seed in range(9)])
    scipy = np.median([qmc.discrepancy(qmc.LatinHypercube(3, rng=seed).random(rows)) for seed in range(9)])
    plain = np.median([qmc.discrepancy(np.random.default_rng(seed).random((rows, 3))) for seed in range(9)])
    assert own < LIKE_SCIPY * scipy
    assert own < 0.5 * plain


@pytest.mark.parametrize(
    "design",
    [
        sweep.Grid([sweep.Axis(name=name, low=0.0, high=1.0, points=10**4) for name in "ab"]),
        sweep.LatinHypercube(UNIT_AXES, MANY),
        sweep.Sobol(UNIT_AXES, MANY),
    ],
    ids=lambda design: design.kind,
)
def test_a_hundred_million_rows_cost_nothing_until_they_are_asked_for(design: sweep.Design) -> None:
    assert len(design) == MANY
    started = time.perf_counter()
    for start in (MANY - 10, 0, MANY // 2):
        rows = design.rows(start, start + 10)
        assert rows.shape == (10, len(design.axes))
        assert rows.min() >= 0.0
        assert rows.max() <= 1.0
    # Not a measure of speed: making all rows would take minutes and more memory than there is.
    assert time.perf_counter() - started < 30.0


def test_shares_become_values_of_the_axis() -> None:
    share = np.array([0.0, 0.25, 0.5, 0.999999])
    np.testing.assert_allclose(sweep.Axis(name="a", low=2.0, high=4.0).at(share[:3]), [2.0, 2.5, 3.0])
    log = sweep.Axis(name="a", low=1.0, high=1e4, scale="log")
    np.testing.assert_allclose(log.at(share[:3]), [1.0, 10.0, 100.0], rtol=1e-14)
    assert sweep.Axis(name="a", low=3, high=6, scale="integer").at(share).tolist() == [3.0, 4.0, 5.0, 6.0]
    assert sweep.Axis(name="a", values=[9.0, 7.0]).at(share).tolist() == [9.0, 9.0, 7.0, 7.0]


def test_designs_are_pickled_and_compared_by_value() -> None:
    for design in (sweep.Grid([sweep.Axis(name="a", values=[1.0])]), sweep.Sobol(UNIT_AXES, 8, seed=2)):
        again = pickle.loads(pickle.dumps(design))
        assert again == design
        np.testing.assert_array_equal(again.rows(), design.rows())


def test_unit_that_contradicts_the_study_is_refused() -> None:
    design = sweep.Grid([sweep.Axis(name="a", unit="mm", values=[1.0])])
    with pytest.raises(InvalidParameterError, match=r"unit of axis 'a' must be 'm' in this study, got 'mm'"):
        design.with_units({"a": "m"})
    assert design.with_units({}).axes[0].unit == "mm"


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"name": "a b", "values": [1.0]}, "name must be a name"),
        ({"name": "_a", "values": [1.0]}, "name must be a name"),
        ({"name": 3, "values": [1.0]}, "name must be a name"),
        ({"name": "a"}, "low must be given"),
        ({"name": "a", "low": 0.0}, "high must be given"),
        ({"name": "a", "low": 1.0, "high": 1.0}, "high must be above"),
        ({"name": "a", "low": float("nan"), "high": 1.0}, "low must be finite"),
        ({"name": "a", "low": 0.0, "high": float("inf")}, "high must be finite"),
        ({"name": "a", "low": "0", "high": 1.0}, "low must be a number"),
        ({"name": "a", "low": 0.0, "high": 1.0, "scale": "log"}, "low must be positive"),
        ({"name": "a", "low": 0.5, "high": 3.0, "scale": "integer"}, "low must be an integer"),
        ({"name": "a", "low": 0, "high": 3, "scale": "integer", "points": 5}, "points must be at most 4"),
        ({"name": "a", "low": 0.0, "high": 1.0, "scale": "cubic"}, "scale must be one of"),
        ({"name": "a", "low": 0.0, "high": 1.0, "points": 1}, "points must be an integer from 2 to"),
        ({"name": "a", "low": 0.0, "high": 1.0, "points": 2.5}, "points must be an integer"),
        ({"name": "a", "low": 0.0, "high": 1.0, "unit": 3}, "unit must be a text"),
        ({"name": "a", "values": [1.0], "low": 0.0}, "low must be None"),
        ({"name": "a", "values": [1.0], "scale": "log"}, "scale must be"),
        ({"name": "a", "values": [1.0, 1.0]}, "values must be different"),
        ({"name": "a", "values": [1.0, float("inf")]}, "values must be finite"),
        ({"name": "a", "values": ["x"]}, "values must be"),
        ({"name": "a", "values": []}, "values must have shape"),
        ({"name": "a", "values": [[1.0]]}, "values must have shape"),
    ],
)
def test_bad_axis_is_refused(fields: dict[str, Any], words: str) -> None:
    with pytest.raises((InvalidParameterError, ShapeError), match=words):
        sweep.Axis(**fields)


BAD_DESIGNS: list[tuple[type, tuple[Any, ...], str]] = [
    (sweep.Grid, ([],), "axes must hold at least one"),
    (sweep.Grid, (3,), "axes must be a sequence"),
    (sweep.Grid, (["a"],), r"axes\[0\] must be an Axis"),
    (sweep.Grid, (UNIT_AXES,), "points of axis 'a' must be given"),
    (sweep.Grid, ([sweep.Axis(name="a", values=[1.0])] * 2,), "axes must have different names"),
    (sweep.Grid, ([sweep.Axis(name=n, low=0, high=10**6, scale="integer") for n in "abc"],), "at most 2"),
    (sweep.Sobol, (UNIT_AXES, 0), "size must be an integer from 1 to"),
    (sweep.Sobol, (UNIT_AXES, 2**31), "size must be at most 2"),
    (sweep.Sobol, (UNIT_AXES, 8, -1), "seed must be an integer from 0 to"),
    (sweep.Sobol, (UNIT_AXES, 8, 0, 1), "scramble must be True or False"),
    (sweep.LatinHypercube, (UNIT_AXES, 2.0), "size must be an integer"),
    (sweep.LatinHypercube, (UNIT_AXES, 2**60), "size must be an integer from 1 to 9007199254740992, got 115"),
    (sweep.LatinHypercube, (UNIT_AXES, 8, "x"), "seed must be an integer"),
]


@pytest.mark.parametrize(("kind", "arguments", "words"), BAD_DESIGNS)
def test_bad_design_is_refused(kind: type, arguments: tuple[Any, ...], words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        kind(*arguments)


@pytest.mark.parametrize(("start", "stop"), [(-1, 2), (3, 2), (0, 9), (0.0, 2), (0, True)])
def test_bad_range_of_rows_is_refused(start: Any, stop: Any) -> None:
    with pytest.raises(InvalidParameterError, match="must be"):
        sweep.Sobol(UNIT_AXES, 8).rows(start, stop)


# ---- doubts ---------------------------------------------------------------------------------


@pytest.mark.parametrize(("size", "better"), [(3, "2 or 4"), (100, "64 or 128"), (1023, "512 or 1024")])
def test_sobol_design_of_another_length_warns_and_names_the_right_ones(size: int, better: str) -> None:
    (warning,) = sweep.Sobol(UNIT_AXES, size).warnings
    assert (warning.code, warning.subject) == ("unbalanced", "size")
    assert f"is {size}, not a power of two" in warning.message
    assert f"take {better} rows" in warning.message


@pytest.mark.parametrize("size", [1, 2, 64, 2**30])
def test_sobol_design_of_a_power_of_two_does_not_warn(size: int) -> None:
    assert sweep.Sobol(UNIT_AXES, size).warnings == ()
    assert sweep.LatinHypercube(UNIT_AXES, min(size, 100) + 1).warnings == ()


def test_result_carries_the_warning_of_its_design(tmp_path: Path) -> None:
    study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    speeds = [sweep.Axis(name="closing_speed", low=0.2, high=2.0)]
    made = sweep.run(sweep.Sobol(speeds, 6), study, out=tmp_path / "out")
    (warning,) = made.warnings
    assert sweep.open(tmp_path / "out").warnings == (warning,)
    assert str(warning) in repr(made)
