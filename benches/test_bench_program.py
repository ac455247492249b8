"""Programs of robots on one core: allowed speeds along a path, and its retiming beside toppra.

Every bench records times of the processor. Nothing here asserts a time; agreement is asserted.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest

from hrsafety import _hrsafety, arms
from reference.toppra_times import toppra_time

ARM = arms.Arm.example()
WAYPOINTS = 10_000
AREAS = 29
VELOCITY = np.array([2.0, 2.0, 2.5, 3.0, 3.0, 3.0])
ACCELERATION = np.array([4.0, 4.0, 5.0, 8.0, 8.0, 8.0])
KNOTS = np.linspace(0.0, 1.0, 6)
VALUES = np.random.default_rng(48).uniform(-1.4, 1.4, (6, 6))
NO_STOPS = np.array([], dtype=np.int64)


def contact(direction: str) -> tuple[Any, int]:
    """Return all moving links with two classes of every area, and the number of rows."""
    links = [name for name, moved in zip(ARM.link_names, ARM._facts["moved"], strict=True) if moved]
    random = np.random.default_rng(29)
    rows = len(links) * AREAS * 2
    clamped = np.tile([True, False], rows // 2)
    limits = {
        "point": np.repeat(np.arange(len(links)), AREAS * 2),
        "energy": random.uniform(0.05, 2.0, rows),
        "body_mass": np.where(clamped, np.inf, random.uniform(0.5, 40.0, rows)),
        "human_speed": np.zeros(rows),
        "speed": np.full(rows, np.inf),
        "table": np.full(rows, -1),
        "first": np.full(rows, -np.inf),
        "last": np.full(rows, np.inf),
    }
    rule = {"rule": "larger", "direction": direction, "iso_mass": 16.0}
    points = random.uniform(-0.1, 0.1, (len(links), 3))
    return _hrsafety.ProgramContact(ARM._native, links=links, points=points, limits=limits, tables=[], **rule), rows


@pytest.mark.parametrize("direction", ["motion", "worst"])
def test_allowed_speeds_of_all_areas(benchmark: Any, direction: str) -> None:
    hits, rows = contact(direction)
    random = np.random.default_rng(10)
    joints, rates = random.uniform(-1.5, 1.5, (2, WAYPOINTS, 6))
    place = np.zeros(WAYPOINTS)
    found = benchmark.pedantic(
        lambda: hits.allowed(joints, rates, place, every=True, check_limits=False, threads=1), rounds=3
    )
    assert found["allowed"].shape == (WAYPOINTS, rows)
    assert (found["lowest"] == found["allowed"].reshape(WAYPOINTS, -1, AREAS * 2).min(axis=2)).all()


def retimed(intervals: int, **more: Any) -> dict[str, Any]:
    s, coefficients = _hrsafety.program_refine(
        KNOTS, _hrsafety.program_spline(KNOTS, VALUES), np.full(5, intervals // 5)
    )
    limits = {"velocity": VELOCITY, "acceleration": ACCELERATION, "stops": NO_STOPS}
    found: dict[str, Any] = _hrsafety.program_retime(s, coefficients, threads=1, **limits, **more)
    assert found["status"] == "verified"
    return found


def test_retiming_with_caps_given(benchmark: Any) -> None:
    found = benchmark.pedantic(lambda: retimed(WAYPOINTS, path_speed=np.full(WAYPOINTS, 0.2)), rounds=3)
    assert found["time"] > 5.0


def test_retiming_with_contact(benchmark: Any) -> None:
    hits, _ = contact("motion")
    assert benchmark.pedantic(lambda: retimed(2_000, contact=hits), rounds=3)["time"] > retimed(2_000)["time"]


def test_toppra_agrees(benchmark: Any) -> None:
    started = time.process_time()
    expected = toppra_time(KNOTS, VALUES, VELOCITY, ACCELERATION, WAYPOINTS)
    benchmark.extra_info["seconds_of_toppra"] = time.process_time() - started
    found = benchmark.pedantic(lambda: retimed(WAYPOINTS), rounds=3)
    assert found["time"] == pytest.approx(expected, rel=0.01)
