"""Times of paths by toppra, an implementation of time-optimal path parameterization by others."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest


def toppra_time(knots: Any, values: Any, velocity: Any, acceleration: Any, intervals: int) -> float:
    """Return the time of a not-a-knot spline from rest to rest, with accelerations kept at both ends of intervals."""
    toppra = pytest.importorskip("toppra", reason="toppra is not installed")
    from toppra import algorithm, constraint

    limits = [np.stack([-np.asarray(each), np.asarray(each)], axis=1) for each in (velocity, acceleration)]
    scheme = constraint.DiscretizationType.Interpolation
    bounds = [
        constraint.JointVelocityConstraint(limits[0]),
        constraint.JointAccelerationConstraint(limits[1], discretization_scheme=scheme),
    ]
    path = toppra.SplineInterpolator(np.asarray(knots), np.asarray(values))
    grid = np.linspace(knots[0], knots[-1], intervals + 1)
    found = algorithm.TOPPRA(bounds, path, gridpoints=grid, solver_wrapper="seidel")
    speed = found.compute_parameterization(0, 0)[1]
    return float(np.sum(2 * np.diff(grid) / (speed[1:] + speed[:-1])))
