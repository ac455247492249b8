"""Decisions of people at one instant."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, instance, numbers, pair, points, positive, sequence
from hrsafety.errors import InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.crowd.pedestrians import Pedestrian
from hrsafety.navigation.crowd.world import WallShape
from hrsafety.navigation.maps.outlines import native_walls

__all__ = ["decide"]


def _column(name: str, given: npt.ArrayLike | None, count: int, default: float) -> Array:
    """Return one number for each agent."""
    if given is None:
        return np.full(count, default)
    found = numbers(name, given, "be an array of numbers")
    if found.ndim == 0:
        found = np.full(count, float(found))
    if found.shape != (count,):
        raise ShapeError(name, f"({count},)", found.shape)
    _all_finite(name, found)
    return found


def _all_finite(name: str, found: Array) -> None:
    """Refuse what is not finite, by its index."""
    wrong = ~np.isfinite(found)
    if wrong.any():
        index = int(np.argwhere(wrong)[0][0])
        raise InvalidParameterError(f"{name}[{index}]", "be finite", found[index].tolist())


def _in_range(name: str, found: Array, valid: npt.NDArray[np.bool_], rule: str) -> None:
    """Refuse what is out of range, by its index."""
    if not valid.all():
        index = int(np.argmin(valid))
        raise InvalidParameterError(f"{name}[{index}]", rule, float(found[index]))


def _rows(name: str, given: npt.ArrayLike, count: int | None = None) -> Array:
    """Return finite vectors, one for each agent."""
    found = points(name, given)
    count = len(found) if count is None else count
    if len(found) != count:
        raise ShapeError(name, f"({count}, 2)", found.shape)
    _all_finite(name, found)
    return found


def decide(
    model: Pedestrian,
    *,
    position: npt.ArrayLike,
    velocity: npt.ArrayLike,
    goal: npt.ArrayLike,
    radius: npt.ArrayLike = 0.25,
    desired_speed: npt.ArrayLike = 1.34,
    awareness: npt.ArrayLike | None = None,
    robot: npt.ArrayLike | None = None,
    group: Sequence[int | None] | None = None,
    heading: npt.ArrayLike | None = None,
    walls: Sequence[WallShape | Sequence[Pair]] = (),
    step: float = 0.05,
    period: Pair = (0.0, 0.0),
) -> Array:
    """Return what people of one model decide at one instant: for maps of forces, and to compare with others.

    Parameters
    ----------
    model : Pedestrian
        The model.
    position, velocity, goal : array_like of shape (n, 2)
        Of people and robots, in m, m/s and m. Who is exactly at the goal stays there.
    radius, desired_speed : array_like of shape (n,) or float
        In m and m/s.
    awareness : array_like of shape (n,) or None
        Share by which robots are taken into account; ``None``: 1.
    robot : array_like of bool of shape (n,) or None
        Who is a robot; ``None``: no person.
    group : sequence of int or None
        Number of the group of each, ``None`` for those who belong to none.
    heading : array_like of shape (n, 2) or None
        Unit vectors in which `CollisionFreeSpeed` walked last; ``None``: along x.
    walls : sequence of Disc, Rectangle or sequence of points
        What stands.
    step : float
        How long the decision holds, in s.
    period : tuple of float
        Lengths after which the world repeats itself, in m; 0: it does not.

    Returns
    -------
    ndarray of shape (n, 2)
        Acceleration in m/s^2 of force models, velocity in m/s of `CollisionFreeSpeed` and
        `ReciprocalAvoidance`; NaN for robots.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range.
    ShapeError
        If lengths differ.
    SimulationError
        If a decision is not finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> found = nav.crowd.decide(
    ...     nav.crowd.SocialForce2000(), position=[(0, 0)], velocity=[(0.5, 0.1)], goal=[(3, 4)], desired_speed=1.3
    ... )
    >>> found.round(2).tolist()
    [[0.56, 1.88]]
    """
    instance("model", model, Pedestrian)
    places = _rows("position", position)
    count = len(places)
    columns = [
        _column("radius", radius, count, 0.25),
        _column("desired_speed", desired_speed, count, 1.34),
        _column("awareness", awareness, count, 1.0),
    ]
    _in_range("radius", columns[0], columns[0] > 0.0, "be positive")
    _in_range("desired_speed", columns[1], columns[1] >= 0.0, "not be negative")
    _in_range("awareness", columns[2], (columns[2] >= 0.0) & (columns[2] <= 1.0), "be from 0 to 1")
    groups = [None] * count if group is None else list(sequence("group", "be a sequence of numbers", group))
    if len(groups) != count:
        raise ShapeError("group", f"({count},)", (len(groups),))
    fronts = np.tile([1.0, 0.0], (count, 1)) if heading is None else _rows("heading", heading, count)
    lengths = pair("period", period)
    _in_range(
        "period", np.array(lengths), np.isfinite(lengths) & np.greater_equal(lengths, 0.0), "be finite and not negative"
    )
    robots = np.zeros(count, bool) if robot is None else np.asarray(robot, bool)
    if robots.shape != (count,):
        raise ShapeError("robot", f"({count},)", robots.shape)
    found = _hrsafety.crowd_decisions(
        model._native,
        places,
        _rows("velocity", velocity, count),
        _rows("goal", goal, count),
        np.column_stack(columns),
        robot=np.ascontiguousarray(robots),
        walls=native_walls(walls),
        heading=fronts,
        group=groups,
        step=positive("step", step),
        period=lengths,
    )
    decision: Array = found["decision"]
    lost = ~robots & ~np.isfinite(decision).all(axis=1)
    if lost.any():
        raise SimulationError(
            f"the decision of row {int(np.argmax(lost))} is not finite: positions, velocities or goals are too large"
        )
    return decision
