"""Whether standing obstacles leave a robot no way: a coarse grid, on the safe side of doubt."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, Pair
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.obstacles.moving_rectangle import Box, Mobile
from hrsafety.navigation.obstacles.standing import Disc, Rectangle

__all__ = ["certainly_closed", "depth", "distance", "stands"]

# Cells per radius of the robot, and most cells: beyond that the cells get larger.
FINENESS = 5
MOST_CELLS = 250_000

# Fewer convex bodies than this enclose nothing.
LEAST_BODIES = 3


def stands(obstacle: Obstacle) -> bool:
    """Return whether an obstacle stands for all time.

    Parameters
    ----------
    obstacle : Obstacle
        What is asked about.

    Returns
    -------
    bool
        Whether it is a disc, a rectangle, or a body whose velocity is zero for ever.
    """
    if isinstance(obstacle, Mobile):
        still = obstacle.path is None and obstacle.segments is None and not any(obstacle.velocity)
        return still and not any(getattr(obstacle, "acceleration", ()))
    return isinstance(obstacle, (Disc, Rectangle))


def distance(obstacle: Obstacle, point: Pair) -> float:
    """Return the distance that the radii of an obstacle are compared with, from where it stands or sets out.

    Parameters
    ----------
    obstacle : Obstacle
        Where it stands, or where its motion begins, counts.
    point : tuple of float
        Where the center of the robot is, in m.

    Returns
    -------
    float
        Distance from the center of a disc or the contour of a rectangle, in m.
    """
    return float(_distances(obstacle, np.array([point[0]]), np.array([point[1]]))[0, 0])


def depth(obstacle: Obstacle, point: Pair, radius: float) -> float:
    """Return how far a robot has to go until it no longer overlaps an obstacle at time 0.

    Parameters
    ----------
    obstacle : Obstacle
        One that stands.
    point : tuple of float
        Where the center of the robot is, in m.
    radius : float
        Radius of the robot in m.

    Returns
    -------
    float
        Way of its center to the nearest place at which it touches the obstacle, in m; negative outside: the
        distance of the surfaces.
    """
    inside = 0.0
    if isinstance(obstacle, Box):
        along, across = _beyond_sides(obstacle, np.array([point[0]]), np.array([point[1]]))
        inside = max(-max(along.item(), across.item()), 0.0)
    return obstacle.contact_distance(radius) - distance(obstacle, point) + inside


def _beyond_sides(box: Box, x: Array, y: Array) -> tuple[Array, Array]:
    """Return how far the crossings of columns x and rows y lie beyond the sides of a rectangle, negative within."""
    cos, sin = math.cos(box.heading), math.sin(box.heading)
    right, up = x[None, :] - box.center[0], y[:, None] - box.center[1]
    along = np.abs(right * cos + up * sin) - 0.5 * box.length
    return along, np.abs(up * cos - right * sin) - 0.5 * box.width


def _distances(obstacle: Obstacle, x: Array, y: Array) -> Array:
    """Return distances at the crossings of columns x and rows y."""
    if isinstance(obstacle, Box):
        along, across = _beyond_sides(obstacle, x, y)
        return np.hypot(np.maximum(along, 0.0), np.maximum(across, 0.0))
    center = _center(obstacle)
    return np.hypot(x[None, :] - center[0], y[:, None] - center[1])


def certainly_closed(
    obstacles: Iterable[Obstacle], *, start: Pair, goal: Pair, radius: float, arrival_tolerance: float
) -> bool:
    """Return whether the standing obstacles leave no way from start to goal.

    A cell counts as closed only if the robot touches one obstacle wherever its center is in the cell,
    and a way may lead over corners of cells. So ``True`` is certain; a gap that is too narrow by less
    than a cell is not noticed.

    Parameters
    ----------
    obstacles : iterable of Obstacle
        Those that move are left out.
    start, goal : tuple of float
        Where the center of the robot begins and has to come, in m.
    radius : float
        Radius of the robot in m.
    arrival_tolerance : float
        How near to the goal it has to come, in m.

    Returns
    -------
    bool
        Whether there is no way.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> from hrsafety.navigation.free_space import certainly_closed
    >>> box = [nav.Rectangle(center=c, length=4.2, width=0.2, heading=h, active_radius=0.4, critical_radius=0.3)
    ...        for c, h in (((0, 2), 0), ((0, -2), 0), ((2, 0), 1.5708), ((-2, 0), 1.5708))]
    >>> certainly_closed(box, start=(5, 0), goal=(0, 0), radius=0.2, arrival_tolerance=0.12)
    True
    """
    standing = [each for each in obstacles if stands(each)]
    if len(standing) < LEAST_BODIES:
        return False
    ends = np.array([start, goal])
    low, high = _bounds(standing, ends, radius)
    side = radius / FINENESS
    side = max(side, math.sqrt(float(np.prod(high - low)) / MOST_CELLS))
    x, y = (np.arange(low[axis] - 2.0 * side, high[axis] + 3.0 * side, side) for axis in (0, 1))
    reach = side / math.sqrt(2.0)  # from the center of a cell to its corner
    free = np.ones((len(y), len(x)), dtype=bool)
    for obstacle in standing:
        closed = obstacle.contact_distance(radius) - reach
        if closed > 0.0:
            (left, bottom), (right, top) = _box(obstacle, closed)
            columns = slice(*np.searchsorted(x, [left, right]))
            rows = slice(*np.searchsorted(y, [bottom, top]))
            free[rows, columns] &= _distances(obstacle, x[columns], y[rows]) > closed
    from_goal = np.hypot(x[None, :] - ends[1, 0], y[:, None] - ends[1, 1])
    target = free & (from_goal <= arrival_tolerance + reach)
    begin = np.hypot(x[None, :] - ends[0, 0], y[:, None] - ends[0, 1]) <= reach
    return not _connected(free, begin & free, target)


def _bounds(standing: list[Obstacle], ends: Array, radius: float) -> tuple[Array, Array]:
    """Return the corners of the area outside which everything is free."""
    corners = np.concatenate([ends, *(_box(obstacle, radius) for obstacle in standing)])
    return corners.min(axis=0), corners.max(axis=0)


def _box(obstacle: Obstacle, margin: float) -> Array:
    """Return the corners of an upright box around an obstacle."""
    center = np.array(_center(obstacle))
    half = margin + obstacle.contact_distance(0.0)
    if isinstance(obstacle, Box):
        half += 0.5 * math.hypot(obstacle.length, obstacle.width)
    return np.array([center - half, center + half])


def _center(obstacle: Obstacle) -> Pair:
    """Return where the center of an obstacle that stands is, in m."""
    if isinstance(obstacle, Human):
        return obstacle.start
    if isinstance(obstacle, Disc | MovingDisc | Box):
        return obstacle.center
    raise TypeError(type(obstacle).__name__)


def _connected(free: npt.NDArray[np.bool_], begin: npt.NDArray[np.bool_], target: npt.NDArray[np.bool_]) -> bool:
    """Return whether free cells, corners included, lead from the begin to the target."""
    rows, columns = free.shape
    padded = np.zeros((rows + 2, columns + 2), dtype=bool)
    padded[1:-1, 1:-1] = free
    wanted = np.zeros_like(padded)
    wanted[1:-1, 1:-1] = target
    open_cells, goal = padded.ravel(), wanted.ravel()
    width = columns + 2
    around = np.array([-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1])
    start = np.zeros_like(padded)
    start[1:-1, 1:-1] = begin
    front = np.flatnonzero(start.ravel())
    while len(front):
        if goal[front].any():
            return True
        open_cells[front] = False
        near = np.unique(front[:, None] + around)
        front = near[open_cells[near]]
    return False
