"""Runs that keep some rows and columns, and tables of gain sets in parts."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, ShapeError, plotting, scenarios
from hrsafety import navigation as nav

SCENE = scenarios.configuration("c2")
LAW = nav.VirtualForceField()
OPTIONAL = ("force", "stabilizing", "lyapunov", "wheel_current", "obstacle_position", "distance")


# ---- one run ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("every", [1, 6, 7, 10**6])
@pytest.mark.parametrize("record", [None, [], ["distance"], ["lyapunov", "force"], list(OPTIONAL)])
def test_kept_rows_and_columns_are_those_of_the_whole_run(every: int, record: list[str] | None) -> None:
    whole, run = nav.simulate(SCENE, LAW), nav.simulate(SCENE, LAW, record=record, every=every)
    last = len(whole.time) - 1
    rows = [*range(0, last, every), last]
    for name in ("time", "position", "velocity", "heading", *(OPTIONAL if record is None else record)):
        assert getattr(run, name).tobytes() == np.ascontiguousarray(getattr(whole, name)[rows]).tobytes(), name
    for name in set(OPTIONAL) - set(OPTIONAL if record is None else record):
        assert getattr(run, name) is None
    for name in ("outcome", "arrival_time", "energy", "path_length"):
        assert getattr(run, name) == getattr(whole, name)
    for name in ("min_distance", "min_clearance", "contact_time", "contact_at_fault"):
        np.testing.assert_array_equal(getattr(run, name), getattr(whole, name))


def test_table_and_copies_have_the_columns_that_were_kept() -> None:
    run = nav.simulate(SCENE, LAW, record=["distance"], every=6)
    names = list(run.columns())
    assert "distance_0_m" in names
    assert not any(name.startswith(("force", "obstacle", "lyapunov", "current", "stabilizing")) for name in names)
    assert {len(values) for values in run.columns().values()} == {len(run.time)}
    assert pickle.loads(pickle.dumps(run)).force is None
    assert "distance_0_m" in repr(run)


def test_pictures_ask_for_a_whole_run() -> None:
    run = nav.simulate(SCENE, LAW, record=["distance"], every=6)
    with pytest.raises(InvalidParameterError, match=r"without force, stabilizing.*simulate without `record`"):
        plotting.paths(run)
    plotting.paths(nav.simulate(SCENE, LAW, every=6))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"record": ["forces"]}, r'record\[0\].*did you mean "force"'),
        ({"record": "force"}, "record"),
        ({"every": 0}, "every must be an integer from 1"),
        ({"every": 2.5}, "every"),
        ({"every": 2, "built": nav.robots.AsBuilt()}, "every must be 1 for robots as built"),
        ({"record": [], "built": nav.robots.AsBuilt()}, "record must be None for robots as built"),
    ],
)
def test_wrong_rows_and_columns_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        nav.simulate(SCENE, LAW, **options)


# ---- gain sets in parts -----------------------------------------------------------------------------

SCENES = [SCENE, scenarios.configuration("c1")]
GRID = {"attractive_gain": np.linspace(1.0, 5.0, 5)[:, None], "repulsive_gain": np.linspace(0.1, 1.0, 4)}


@pytest.mark.parametrize("rows", [1, 6, 7, 1000])
def test_parts_put_together_are_the_whole_table(rows: int) -> None:
    whole = nav.simulate_batch(SCENES, LAW, GRID)
    parts = list(nav.gains.stream_batch(SCENES, LAW, GRID, rows=rows))
    assert len(parts) == -(-20 // max(1, rows // 2))
    for name in ("gains", "gain_index", "scenario_index", "outcome", "performance_total", "min_distance", "energy"):
        joined = np.concatenate([getattr(part, name) for part in parts])
        assert joined.tobytes() == getattr(whole, name).tobytes(), name


def test_an_array_and_no_gains_are_streamed_too() -> None:
    sets = np.array([[2.0, 0.5, 0.5, 0.5, 0.5][: len(LAW.GAIN_NAMES)]] * 3)
    parts = list(nav.gains.stream_batch([SCENE], LAW, sets, rows=2))
    assert [len(part) for part in parts] == [2, 1]
    (single,) = nav.gains.stream_batch([SCENE], LAW)
    assert single.gains.tolist() == [list(LAW.gains)]


def test_progress_counts_through_all_parts() -> None:
    heard: list[tuple[int, int]] = []
    list(nav.gains.stream_batch(SCENES, LAW, GRID, rows=8, progress=lambda *both: heard.append(both)))
    assert heard[-1] == (40, 40)
    assert [done for done, _ in heard] == sorted(done for done, _ in heard)


def test_errors_name_the_gain_set_among_all() -> None:
    bad = {"attractive_gain": [1.0, 2.0, 3.0, -1.0]}
    with pytest.raises(InvalidParameterError, match=r"gains\[3\]"):
        list(nav.gains.stream_batch([SCENE], LAW, bad, rows=2))
    with pytest.raises(InvalidParameterError, match="keys among"):
        nav.gains.stream_batch([SCENE], LAW, {"gain": [1.0]})
    with pytest.raises(ShapeError, match="broadcast"):
        nav.gains.stream_batch([SCENE], LAW, {"attractive_gain": [1.0, 2.0], "repulsive_gain": [1.0, 2.0, 3.0]})
    wide = {"attractive_gain": np.ones((20_000, 1)), "repulsive_gain": np.ones(20_000)}
    with pytest.raises(InvalidParameterError, match="at most 100000000 gain sets"):
        nav.gains.stream_batch([SCENE], LAW, wide)
    with pytest.raises(InvalidParameterError, match="rows"):
        nav.gains.stream_batch([SCENE], LAW, GRID, rows=0)
