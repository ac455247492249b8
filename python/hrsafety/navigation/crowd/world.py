"""A world of people, robots and walls that all move in step."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import field
from typing import Any

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, checked_seed, instance, pair, sequence
from hrsafety._doubts import checked_doubts
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import Person, Robot, Source
from hrsafety.navigation.crowd.doubts import (
    of_footprints,
    of_gaps,
    of_maps,
    of_numbers,
    of_robots,
    of_scans,
    of_sensors,
    of_unknown_walls,
    of_walls,
)
from hrsafety.navigation.crowd.routes import Routes, of_routes
from hrsafety.navigation.maps.outlines import Shape, checked_shapes, native_walls, outlines
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.navigation.place import Place
from hrsafety.navigation.scenario import Scenario
from hrsafety.plausibility import ResultWarning

__all__ = ["WallShape", "World"]

_STEP = 0.01
"""Longest step of the world of a scenario, in s."""
ROUNDING = 1e-9
"""Footprints that are so near touch, in m."""
_FARTHEST = 1e6
"""How far the robot of a scenario sees, in m."""

WallShape = Shape


def _all(name: str, kind: type, given: Iterable[object]) -> tuple[Any, ...]:
    """Return the members of a list if they are of a kind."""
    members = sequence(name, f"be a sequence of {kind.__name__}", given)
    return tuple(instance(f"{name}[{index}]", member, kind) for index, member in enumerate(members))


def _movers(obstacles: object) -> tuple[list[Person], list[Disc | Rectangle]]:
    """Return the obstacles that move as people who react to no person, and those that stand."""
    movers: list[Person] = []
    standing: list[Disc | Rectangle] = []
    kinds = Human, MovingDisc, Disc, Rectangle
    for index, each in enumerate(sequence("obstacles", "be a sequence of obstacles", obstacles)):
        given: Any = instance(f"obstacles[{index}]", each, *kinds)
        if isinstance(given, Disc | Rectangle):
            standing.append(given)
        else:
            movers.append(Person.moving(given))
    return movers, standing


@dataclass(frozen=True, kw_only=True, slots=True)
class World(Place):
    """People and robots that react to each other, and whatever else moves or stands.

    At every instant sources add people, everybody decides from the same snapshot, and all move by a step.
    Models whose largest step is smaller split it into equal parts, in each of which people decide anew.

    Parameters
    ----------
    people : sequence of Person
        Who is there at the start; people may overlap.
    robots : sequence of Robot
        The robots. None may start in contact.
    walls : StaticMap, or sequence of Disc, Rectangle or sequence of points
        What stands. Points are joined by segments. Every wall acts once, through its nearest point. Laws are told of
        the members of a sequence as obstacles that stand; of a map they know what they have a map of, or what their
        sensors see, and results carry the warning ``"unknown_wall"`` where that is less. People find their way around
        a map: where it blocks a straight way of a route, points of the detour of a `Guide` are added to the route;
        where none leads around, results carry the warning ``"route_blocked"``.
    obstacles : sequence of Obstacle
        What moves as it is told and reacts to no person, `Human` and `MovingDisc`, and what stands, `Disc` and
        `Rectangle`, which are walls. They are kept among people and walls, and no more here.
    sources : sequence of Source
        Where more people come from.
    period : tuple of float
        Lengths (Lx, Ly) in m after which the world repeats itself for the differences of positions; 0: it
        does not.
    step : float
        Time step in s.
    time_limit : float
        Longest simulated time, in s.
    seed : int
        Seed of everything that is drawn, 0 <= seed < 2**64.
    doubts : sequence of ResultWarning
        Why the people may not be what they seem to, such as `Recording.warnings` of people who were recorded; the
        warnings of the world and of its runs hold them.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range, a control period is no multiple of the step, or a robot
        starts in contact; the message names the list and the index.

    Examples
    --------
    Two people meet in a corridor:

    >>> from hrsafety import navigation as nav
    >>> walls = [[(-1, 0), (11, 0)], [(-1, 3), (11, 3)]]
    >>> people = [
    ...     nav.Person(start=(0, 1.4), route=[(10, 1.5)], desired_speed=1.3),
    ...     nav.Person(start=(10, 1.6), route=[(0, 1.5)], desired_speed=1.3),
    ... ]
    >>> world = nav.World(people=people, walls=walls, time_limit=20)
    >>> run = nav.simulate(world)
    >>> bool((run.person_arrival_time < 10).all())
    True
    """

    people: tuple[Person, ...] | Sequence[Person] = ()
    robots: tuple[Robot, ...] | Sequence[Robot] = ()
    walls: StaticMap | tuple[WallShape, ...] | Sequence[WallShape | Sequence[Pair]] = ()
    sources: tuple[Source, ...] | Sequence[Source] = ()
    period: Pair = (0.0, 0.0)
    step: float = 0.05
    time_limit: float = 60.0
    seed: int = 0
    doubts: Sequence[ResultWarning] = field(default=(), repr=False, compare=False)
    obstacles: Sequence[Obstacle] = ()
    _shapes: tuple[WallShape, ...] = field(init=False, repr=False, compare=False)
    _native: _hrsafety.CrowdWorld = field(init=False, repr=False, compare=False)
    _warnings: tuple[ResultWarning, ...] | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check the values."""
        self._as_numbers("step", "time_limit")
        known = self.walls if isinstance(self.walls, StaticMap) else None
        told = [] if known is not None else list(checked_shapes("walls", self.walls))
        movers, standing = _movers(self.obstacles)
        if known is not None and standing:
            known, standing = known + StaticMap.from_obstacles(standing), []
        told += standing
        shapes = tuple(told) if known is None else outlines(known)
        people, sources = _all("people", Person, self.people), _all("sources", Source, self.sources)
        if known is not None:
            routes = Routes(known)
            people, sources = tuple(map(routes.completed, people)), tuple(map(routes.completed, sources))
        self._set(
            people=(*people, *movers),
            robots=_all("robots", Robot, self.robots),
            sources=sources,
            walls=tuple(told) if known is None else known,
            _shapes=shapes,
            obstacles=(),
            period=pair("period", self.period),
            seed=checked_seed("seed", self.seed),
            doubts=checked_doubts("doubts", self.doubts),
        )
        # A step out of range is refused by the world, not by a robot that has it as its control period.
        step = self.step if 0.0 < self.step < float("inf") else 1.0
        native = _hrsafety.CrowdWorld(
            [person._native for person in self.people],
            [robot._at_step(step, known) for robot in self.robots],
            [source._native for source in self.sources],
            native_walls(shapes),
            untold=0 if known is None else len(shapes),
            period=self.period,
            step=self.step,
            time_limit=self.time_limit,
            seed=self.seed,
        )
        self._set(_native=native)
        if known is not None:
            self._check_starts(known)

    def _check_starts(self, known: StaticMap) -> None:
        """Refuse robots that start within what is filled."""
        for index, robot in enumerate(self.robots):
            outline = robot.body.footprint
            if outline is None:
                gap = float(known.clearance(robot.start)) - robot.body.radius
            else:
                gap = float(outline.clearance(known, [robot.start], [robot.heading])[0]) - ROUNDING
            if gap < 0.0:
                rule = "not be in contact with the walls"
                remedy = f"the bodies overlap by {-gap:.4f} m"
                raise InvalidParameterError(f"robots[{index}].start", rule, robot.start, remedy)

    @classmethod
    def of(cls, place: Place) -> World:
        """Return a place as a world.

        Parameters
        ----------
        place : Scenario or World
            The place.

        Returns
        -------
        World
            Of a scenario one robot, its moving obstacles as people who do not react, and what stands as walls, which
            beside a map are a part of it. Everybody moves in steps of at most 0.01 s, and the robot sees as far as
            it has to; regions are those that a world has, and a robot at rest does not end the run. A world is itself.

        Raises
        ------
        InvalidParameterError
            If it is no place, or a rectangle moves, which worlds do not have.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> [person.reacts for person in nav.World.of(scenarios.configuration("c2")).people]
        [False]
        """
        if isinstance(place, World):
            return place
        if not isinstance(place, Scenario):
            raise InvalidParameterError("place", "be a Scenario or World", place)
        period = place.control_period
        robot = Robot(
            place.robot,
            start=place.start,
            goal=place.goal,
            control_period=period,
            arrival_tolerance=place.arrival_tolerance,
            heading=place.heading,
            sensing_range=_FARTHEST,
            measurement=place.measurement,
        )
        return cls(
            robots=[robot],
            obstacles=place.obstacles,
            walls=() if place.walls is None else place.walls,
            step=period / math.ceil(period / _STEP - 1e-9),
            time_limit=place.time_limit,
            seed=place.seed,
            doubts=place.doubts,
        )

    @property
    def wall_shapes(self) -> tuple[WallShape, ...]:
        """The walls, or the outlines of the map that they are, as discs, rectangles and polylines."""
        return self._shapes

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts: implausible numbers, starts and goals inside walls, bounds of shields that the world exceeds."""
        found = self._warnings
        if found is None:
            own = tuple(self.people), tuple(self.sources), tuple(self.robots)
            shapes = self.wall_shapes
            of_shields = of_robots(*own, self.step, walls=len(shapes) > 0)
            known = self.walls if isinstance(self.walls, StaticMap) else None
            in_walls = of_walls(*own, self._native, known or shapes, self.time_limit) if shapes else ()
            seen = of_sensors(own[0], own[2], self.step, known)
            numbers = *of_numbers(*own, self.time_limit), *of_gaps(own[0], self.doubts)
            found = (*self.doubts, *numbers, *in_walls, *seen, *of_shields)
            found = (
                *found,
                *of_footprints(own[0], own[1], own[2]),
                *of_scans(*own, self.time_limit, walls=len(shapes) > 0),
            )
            if known is not None:
                lost = *of_routes(own[0], own[1], known), *of_unknown_walls(known, own[2])
                found = (*found, *known.warnings, *lost)
            found = (*found, *(each for each in of_maps(own[2]) if each not in found))
            self._set(_warnings=found)
        return found

    @property
    def unit_doubts(self) -> tuple[ResultWarning, ...]:
        """Warnings about numbers that are hardly meant in their unit."""
        return tuple(each for each in self.warnings if each.code == "implausible")
