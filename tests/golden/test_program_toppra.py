"""Retimed motions of random splines against toppra, to 1 %, and never much faster."""

from __future__ import annotations

import numpy as np
import pytest

from hrsafety import _hrsafety
from reference.toppra_times import toppra_time

INTERVALS = 2000
VELOCITY = np.array([2.0, 2.0, 2.5, 3.0, 3.0, 3.0])


@pytest.mark.parametrize("seed", range(8))
def test_times_of_random_splines(seed: int) -> None:
    random = np.random.default_rng(seed)
    knots = np.sort(np.concatenate([[0.0, 1.0], random.uniform(0.1, 0.9, 3)]))
    values = random.uniform(-1.5, 1.5, (5, 6))
    acceleration = random.uniform(2.0, 12.0, 6)
    coefficients = _hrsafety.program_spline(knots, values)
    s, coefficients = _hrsafety.program_refine(knots, coefficients, np.full(4, INTERVALS // 4))
    found = _hrsafety.program_retime(
        s, coefficients, velocity=VELOCITY, acceleration=acceleration, stops=np.array([], dtype=np.int64)
    )
    assert found["status"] == "verified"
    expected = toppra_time(knots, values, VELOCITY, acceleration, INTERVALS)
    assert found["time"] == pytest.approx(expected, rel=0.01)
