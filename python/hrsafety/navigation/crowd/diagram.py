"""The fundamental diagram: how fast people walk, the denser they are."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Annotated

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, instance, numbers, positive, sequence
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown, SimulationError
from hrsafety.navigation.crowd.agents import points_of
from hrsafety.navigation.crowd.simulation import simulated
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.crowd.world_run import WorldRun
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.tables import Columns, Table

__all__ = ["FundamentalDiagram", "fundamental_diagram", "weidmann_speed"]

FREE_SPEED, STEEPNESS, JAM = 1.34, 1.913, 5.4
"""Of Weidmann (1993): speed of a person alone in m/s, 1/m^2, and the density at which no person walks, in 1/m^2."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class FundamentalDiagram(Table):
    """Speed over density of people in corridors; made by `fundamental_diagram`.

    Attributes
    ----------
    density : ndarray of shape (n,)
        People for each square meter.
    speed : ndarray of shape (n,)
        Mean velocity along the corridor in m/s.
    reference : ndarray of shape (n,)
        Speed of Weidmann (1993) at the density, in m/s.
    """

    density: Array
    speed: Annotated[Array, "m/s"]
    reference: Annotated[Array, "m/s"]

    @property
    def rms(self) -> float:
        """Root of the mean squared difference from the reference, in m/s."""
        return float(np.sqrt(np.mean((self.speed - self.reference) ** 2)))

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each corridor.

        Returns
        -------
        dict of str to ndarray
            Units are in the names.
        """
        return {
            "density_1_per_m2": self.density,
            "speed_m_per_s": self.speed,
            "reference_m_per_s": self.reference,
        }


def weidmann_speed(density: npt.ArrayLike) -> Array:
    """Return the speed of people at a density, ``1.34 (1 - exp(-1.913 (1/density - 1/5.4)))``, Weidmann (1993).

    Parameters
    ----------
    density : array_like
        People for each square meter, above 0 and at most 5.4.

    Returns
    -------
    ndarray
        Speeds in m/s.

    Raises
    ------
    InvalidParameterError
        If a density is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.crowd.weidmann_speed([0.5, 2.0]).round(2).tolist()
    [1.3, 0.61]
    """
    given = numbers("density", density)
    wrong = given[~((given > 0.0) & (given <= JAM))]
    if wrong.size > 0:
        raise InvalidParameterError("density", f"be above 0 and at most {JAM}", float(wrong.flat[0]))
    found: Array = FREE_SPEED * (1.0 - np.exp(-STEEPNESS * (1.0 / given - 1.0 / JAM)))
    return found


def fundamental_diagram(
    worlds: Iterable[World],
    *,
    width: float = 3.0,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> FundamentalDiagram:
    """Return how fast people walk in corridors that repeat themselves along x, the denser they are.

    Parameters
    ----------
    worlds : iterable of World
        Corridors with a period along x, all of whose people walk to +x, as of ``scenarios.corridor`` with
        ``two_way=False``.
    width : float
        Their width in m.
    threads : int or None
        Number of threads; all cores when ``None``. Never changes a bit of the result.
    progress : callable or None
        Progress callback ``(done, total)``.

    Returns
    -------
    FundamentalDiagram
        A row for each world: the mean velocity along x over the second half of its time.

    Raises
    ------
    InvalidParameterError
        If there is no world, or one does not repeat itself along x, has no person or has sources, has a person
        who does not walk to +x or arrives, has walls at another distance than the width, or is denser than
        5.4 people for each square meter.
    SimulationError
        If the state of a world became non-finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> worlds = [
    ...     scenarios.corridor(n, length=20, two_way=False, radius=0.2, time_limit=20) for n in (15, 120)
    ... ]
    >>> diagram = nav.crowd.fundamental_diagram(worlds)
    >>> diagram.density.tolist(), bool(diagram.speed[0] > 1.0 > diagram.speed[1])
    ([0.25, 2.0], True)
    """
    given = sequence("worlds", "be a sequence of World", worlds)
    if not given:
        raise InvalidParameterError("worlds", "hold at least one world", Shown("none"))
    wide = positive("width", width)
    density = np.array([_density(f"worlds[{index}]", world, wide) for index, world in enumerate(given)])
    reference = weidmann_speed(density)
    runs = simulated(given, threads=threads, progress=progress)
    speed = np.array([_speed(index, run) for index, run in enumerate(runs)])
    return FundamentalDiagram(density=density, speed=speed, reference=reference)


def _density(name: str, world: object, width: float) -> float:
    """Return people for each square meter."""
    place = instance(name, world, World)
    if place.period[0] <= 0.0:
        raise InvalidParameterError(f"{name}.period", "repeat the world along x", place.period)
    if not place.people or place.sources:
        found = "nobody" if not place.people else "sources"
        raise InvalidParameterError(f"{name}.people", "be there from the start, at least one", Shown(found))
    for index, person in enumerate(place.people):
        way = [person.start[0], *(min(x for x, _ in points_of(element)) for element in person.route)]
        if len(way) < 2 or not (np.diff(way) > 0.0).all():
            rule = "lead to +x, as of everybody in the corridor"
            remedy = "of scenarios.corridor, give two_way=False"
            raise InvalidParameterError(f"{name}.people[{index}].route", rule, person.route, remedy)
    apart = _between_walls(place)
    if apart is not None and not math.isclose(apart, width, rel_tol=1e-6):
        raise InvalidParameterError("width", f"be the distance of the walls of {name}, {apart:g} m", width)
    return len(place.people) / (place.period[0] * width)


def _between_walls(world: World) -> float | None:
    """Return the distance of the walls along x on both sides of all people; ``None`` without them."""
    across = [person.start[1] for person in world.people]
    walls = [np.asarray(wall)[:, 1] for wall in world.wall_shapes if not isinstance(wall, Disc | Rectangle)]
    along = [float(wall[0]) for wall in walls if (wall == wall[0]).all()]
    below, above = [y for y in along if y <= min(across)], [y for y in along if y >= max(across)]
    return min(above) - max(below) if below and above else None


def _speed(index: int, run: WorldRun) -> float:
    """Return the mean velocity along x over the second half of the time."""
    if run.diverged is not None:
        raise SimulationError(f"worlds[{index}] diverged at {run.diverged.time:g} s", index)
    arrived = np.flatnonzero(~np.isnan(run.person_arrival_time))
    if arrived.size > 0:
        found = Shown(f"an arrival at {run.person_arrival_time[arrived[0]]:g} s")
        rule = "lead farther than the person walks within the time limit"
        raise InvalidParameterError(f"worlds[{index}].people[{arrived[0]}].route", rule, found)
    first = len(run.time) // 2
    way = run.obstacle_position[-1, :, 0] - run.obstacle_position[first, :, 0]
    return float(way.mean() / (run.time[-1] - run.time[first]))
