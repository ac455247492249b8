"""Standard scenes of social navigation: one for each card of Francis and others (2023), figure 7."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import Pair, checked_seed, flag, meant
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import AtEnd, Person, Robot, Task
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.laws.python_law import AnyLaw

__all__ = ["SOCIAL", "social"]

Lines = tuple[tuple[Pair, ...], ...]


class _Draws:
    """Draws of one scene, in the order in which they are asked for."""

    def __init__(self, number: int, seed: int) -> None:
        self._generator = np.random.default_rng([number, seed])

    def uniform(self, low: float, high: float) -> float:
        """Return a number from low to high."""
        return low + (high - low) * float(self._generator.random())

    def side(self) -> float:
        """Return 1 or -1."""
        return 1.0 if self._generator.random() < 0.5 else -1.0

    def beside(self) -> float:
        """Return how far somebody walks beside the middle of a way, in m."""
        return self.uniform(-0.3, 0.3)

    def late(self) -> float:
        """Return how much later somebody comes than the robot would meet them, in s."""
        return self.uniform(-0.7, 0.7)

    def door(self) -> float:
        """Return the width of a door in m."""
        return self.uniform(0.9, 1.1)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Scene:
    """A scene whose numbers are drawn."""

    people: Sequence[Person]
    walls: Lines = ()
    start: Pair = (0.0, 0.0)
    goal: Pair = (12.0, 0.0)
    time_limit: float = 40.0
    occlusion: bool = False
    task: Task | None = None


def _walker(
    speed: float, start: Pair, *route: Pair, at_end: AtEnd = "stay", arrival_radius: float = 0.3, awareness: float = 1.0
) -> Person:
    return Person(
        start=start,
        route=route,
        desired_speed=speed,
        at_end=at_end,
        arrival_radius=arrival_radius,
        awareness=awareness,
    )


def _standing(place: Pair, group: int | None = None) -> Person:
    return Person(start=place, desired_speed=1.0, group=group)


def _tracked(speed: float, wait: float, places: Sequence[Pair], stays: int = 0, until: float | None = None) -> Person:
    """Return who walks straight from place to place at a speed in m/s, and stands at one of them for a time in s."""
    times, track = [0.0], [places[0]]
    for index, place in enumerate(places):
        if index:
            times.append(times[-1] + math.dist(places[index - 1], place) / speed)
            track.append(place)
        if index == stays:
            times.append(times[-1] + wait)
            track.append(place)
    if until is not None:
        times.append(until)
        track.append(places[-1])
    return Person(start=places[0], desired_speed=speed, recording=(times, track))


# ---- walls ----------------------------------------------------------------------------------


def _hallway(width: float, left: float = -4.0, right: float = 14.0) -> Lines:
    return tuple(((left, y), (right, y)) for y in (-width / 2, width / 2))


def _crossing() -> Lines:
    return tuple(
        line
        for s in (-1.0, 1.0)
        for line in (
            ((-4.0, 1.5 * s), (4.5, 1.5 * s), (4.5, 16.0 * s)),
            ((7.5, 16.0 * s), (7.5, 1.5 * s), (14.0, 1.5 * s)),
        )
    )


def _box(left: float, right: float, half: float) -> tuple[Pair, ...]:
    return ((left, -half), (right, -half), (right, half), (left, half), (left, -half))


def _doorway(width: float, x: float, half: float) -> Lines:
    return ((x, -half), (x, -width / 2)), ((x, width / 2), (x, half))


def _rooms(door: float) -> Lines:
    return (_box(-1.0, 11.0, 3.0), *_doorway(door, 5.0, 3.0))


_ELEVATOR: Lines = (
    ((6.0, -4.0), (6.0, -0.6)),
    ((6.0, 0.6), (6.0, 4.0), (-1.0, 4.0), (-1.0, -4.0), (6.0, -4.0)),
    ((6.0, -1.2), (8.4, -1.2), (8.4, 1.2), (6.0, 1.2)),
)


# ---- people in hallways ---------------------------------------------------------------------


def _frontal_approach(draws: _Draws) -> _Scene:
    v, y = draws.uniform(0.8, 1.4), draws.beside()
    return _Scene(walls=_hallway(3.0), people=[_walker(v, (12.0, y), (-3.0, y))])


def _pedestrian_obstruction(draws: _Draws) -> _Scene:
    v, y = draws.uniform(0.1, 0.3), draws.beside()
    return _Scene(walls=_hallway(2.0), people=[_walker(v, (4.0, y), (13.0, y))])


def _pedestrian_overtaking(draws: _Draws) -> _Scene:
    v, y, x = draws.uniform(1.3, 1.8), draws.beside(), draws.uniform(-3.5, -2.0)
    return _Scene(walls=_hallway(3.0), people=[_walker(v, (x, y), (13.5, y))])


def _robot_overtaking(draws: _Draws) -> _Scene:
    v, y = draws.uniform(0.4, 0.6), draws.beside()
    return _Scene(walls=_hallway(3.0), people=[_walker(v, (2.5, y), (13.0, y))])


def _down_path(draws: _Draws) -> _Scene:
    v, x, s = draws.uniform(0.8, 1.2), draws.uniform(-0.7, 0.7), draws.side()
    way = (3.0, 0.6 * s), (7.0, -0.3 * s), (13.0, 0.6 * s)
    return _Scene(walls=_hallway(2.4), people=[_walker(v, (x, 0.6 * s), *way)])


def _intersection(draws: _Draws, lateness: Pair, awareness: float) -> _Scene:
    v, late, s = draws.uniform(0.8, 1.4), draws.uniform(*lateness), draws.side()
    person = _walker(v, (6.0, -s * v * (6.0 + late)), (6.0, 14.0 * s), awareness=awareness)
    return _Scene(walls=_crossing(), people=[person])


def _intersection_no_gesture(draws: _Draws) -> _Scene:
    return _intersection(draws, (-0.7, 0.7), 1.0)


def _intersection_wait(draws: _Draws) -> _Scene:
    """Draw somebody who takes the right of way."""
    return _intersection(draws, (-0.5, 0.2), 0.0)


def _intersection_proceed(draws: _Draws) -> _Scene:
    v, wait, s = draws.uniform(0.8, 1.4), draws.uniform(2.0, 8.0), draws.side()
    places = (6.0, -6.0 * s), (6.0, -0.8 * s), (6.0, 10.0 * s)
    return _Scene(walls=_crossing(), people=[_tracked(v, wait, places, stays=1)])


def _blind_corner(draws: _Draws) -> _Scene:
    v, late = draws.uniform(0.8, 1.4), draws.late()
    walls: Lines = ((-3.0, -1.0), (7.0, -1.0), (7.0, 14.0)), ((-3.0, 1.0), (5.0, 1.0), (5.0, 14.0))
    person = _walker(v, (6.3, v * (6.0 + late)), (6.3, 0.3), (-2.5, 0.3))
    return _Scene(walls=walls, goal=(6.0, 6.0), people=[person], occlusion=True)


def _narrow_hallway(draws: _Draws) -> _Scene:
    width, v, y = draws.uniform(1.3, 1.6), draws.uniform(0.6, 1.0), draws.uniform(-0.1, 0.1)
    outline = (-3.0, 3.0), (3.0, 3.0), (3.0, width / 2), (9.0, width / 2), (9.0, 3.0), (14.0, 3.0)
    walls = tuple(tuple((x, side * wall) for x, wall in outline) for side in (1.0, -1.0))
    person = _walker(v, (10.0, y), (3.0, y), (0.0, 2.0))
    return _Scene(walls=walls, start=(1.0, -1.5), people=[person])


# ---- doors and elevators --------------------------------------------------------------------


def _narrow_doorway(draws: _Draws) -> _Scene:
    door, v = draws.door(), draws.uniform(0.7, 1.0)
    y, late = draws.uniform(-1.0, 1.0), draws.late()
    person = _walker(v, (5.0 + v * (4.3 + late), y), (5.6, 0.0), (4.4, 0.0), (0.5, 1.8))
    return _Scene(walls=_rooms(door), start=(1.0, -1.0), goal=(9.0, 0.0), people=[person])


def _entering_room(draws: _Draws) -> _Scene:
    door, v, x, s = draws.door(), draws.uniform(0.6, 1.0), draws.uniform(6.2, 7.5), draws.side()
    busy = _walker(v, (x, 2.0 * s), (x, -2.0 * s), (x, 2.0 * s), at_end="repeat")
    return _Scene(walls=_rooms(door), start=(1.0, 0.0), goal=(9.0, 0.0), people=[busy, _standing((8.0, -2.3 * s))])


def _exiting_room(draws: _Draws) -> _Scene:
    door, v, late, s = draws.door(), draws.uniform(0.8, 1.4), draws.uniform(0.0, 1.4), draws.side()
    room = (5.0, -3.0), (11.0, -3.0), (11.0, 3.0), (5.0, 3.0)
    walls: Lines = ((2.5, -12.0), (2.5, 12.0)), *_doorway(door, 5.0, 12.0), room
    person = _walker(v, (4.3, s * v * (4.0 + late)), (4.3, -11.0 * s))
    return _Scene(walls=walls, start=(8.5, 0.0), goal=(3.75, 5.0 * s), people=[person])


def _entering_elevator(draws: _Draws) -> _Scene:
    wait, v, s = draws.uniform(0.0, 3.0), draws.uniform(0.6, 1.0), draws.side()
    leaving = _tracked(v, wait, [(7.8, 0.6 * s), (6.4, 0.0), (6.0, 0.0), (1.8, 2.5 * s)])
    return _Scene(walls=_ELEVATOR, goal=(7.1, 0.0), people=[leaving, _standing((7.95, -0.75 * s))])


def _exiting_elevator(draws: _Draws) -> _Scene:
    wait, v, s = draws.uniform(1.0, 4.0), draws.uniform(0.6, 1.0), draws.side()
    entering = _tracked(v, wait, [(4.8, 0.9 * s), (6.0, 0.0), (7.95, 0.75 * s)], until=60.0)
    people = [entering, _standing((4.8, -s))]
    return _Scene(walls=_ELEVATOR, start=(7.9, -0.7 * s), goal=(2.0, 0.0), people=people)


# ---- groups and tasks -----------------------------------------------------------------------


def _group(draws: _Draws) -> tuple[Pair, list[Person]]:
    """Return the free place of a group on a circle, and who stands at the other ones."""
    places = 4 + math.floor(3.0 * draws.uniform(0.0, 1.0))
    turn = draws.uniform(-math.pi, math.pi)
    bearings = (math.pi + turn + 2.0 * math.pi * index / places for index in range(places))
    free, *taken = ((8.0 + 1.1 * math.cos(bearing), 1.1 * math.sin(bearing)) for bearing in bearings)
    return free, [_standing(place, group=0) for place in taken]


def _join_group(draws: _Draws) -> _Scene:
    free, people = _group(draws)
    return _Scene(walls=(_box(-2.0, 12.0, 4.0),), goal=free, people=people)


def _leave_group(draws: _Draws) -> _Scene:
    free, people = _group(draws)
    return _Scene(walls=(_box(-2.0, 12.0, 4.0),), start=free, goal=(0.0, draws.uniform(-3.0, 3.0)), people=people)


def _following_human(draws: _Draws) -> _Scene:
    v, y = draws.uniform(0.5, 0.8), draws.uniform(-0.2, 0.2)
    return _Scene(walls=_hallway(3.0), people=[_walker(v, (1.5, y), (13.2, y))], task="behind")


def _leading_human(draws: _Draws) -> _Scene:
    v, y = draws.uniform(0.6, 0.9), draws.uniform(-0.2, 0.2)
    return _Scene(walls=_hallway(3.0), people=[_walker(v, (-1.5, y), (10.5, y))], task="ahead")


def _accompanying_peer(draws: _Draws) -> _Scene:
    v, s = draws.uniform(0.5, 0.9), draws.side()
    person = _walker(v, (0.0, 0.9 * s), (12.0, 0.9 * s))
    start, goal = (0.0, -0.3 * s), (12.0, -0.3 * s)
    return _Scene(walls=_hallway(3.0), start=start, goal=goal, people=[person], task="beside")


# ---- crowds ---------------------------------------------------------------------------------


def _crowd_navigation(draws: _Draws) -> _Scene:
    places: list[Pair] = []
    while len(places) < 10:
        place = draws.uniform(1.5, 11.0), draws.uniform(-3.4, 3.4)
        if all(math.dist(place, other) > 0.8 for other in places):
            places.append(place)
    people = []
    for place in places:
        goal, v = (draws.uniform(0.0, 12.0), draws.uniform(-3.4, 3.4)), draws.uniform(0.5, 1.2)
        people.append(_walker(v, place, goal, place, at_end="repeat"))
    return _Scene(walls=(_box(-1.0, 13.0, 4.0),), people=people, time_limit=60.0)


def _parallel_traffic(draws: _Draws) -> _Scene:
    people = []
    for index in range(8):
        x, y, v = draws.beside(), draws.uniform(-0.5, 0.5), draws.uniform(0.8, 1.3)
        ahead = 2.2 * (index // 2) + x
        if index % 2 == 0:
            people.append(_walker(0.6 * v, (1.5 + ahead, 0.9 + y), (19.0, 0.9 + y)))
        else:
            people.append(_walker(v, (5.0 + ahead, -0.9 + y), (-5.0, -0.9 + y)))
    return _Scene(walls=_hallway(4.0, -6.0, 20.0), people=people, time_limit=60.0)


def _perpendicular_traffic(draws: _Draws) -> _Scene:
    people = []
    for index in range(8):
        x, y, v = draws.uniform(-0.4, 0.4), draws.uniform(2.0, 7.5), draws.uniform(0.8, 1.3)
        s, column = (-1.0) ** index, 2.5 + index + x
        people.append(_walker(v, (column, -s * y), (column, 8.0 * s), (column, -8.0 * s), at_end="repeat"))
    return _Scene(walls=(_box(-2.0, 14.0, 9.0),), people=people, time_limit=60.0)


def _circular_crossing(draws: _Draws) -> _Scene:
    turn, people = draws.beside(), []
    for index in range(6):
        dx, dy, v = draws.beside(), draws.beside(), draws.uniform(0.8, 1.2)
        bearing = -0.5 * math.pi + turn + 2.0 * math.pi * (index + 1) / 7.0
        x, y = 4.0 * math.cos(bearing) + dx, 4.0 * math.sin(bearing) + dy
        people.append(_walker(v, (x, y), (-x, -y)))
    return _Scene(start=(0.0, -4.0), goal=(0.0, 4.0), people=people)


def _robot_crowding(draws: _Draws) -> _Scene:
    turn, people = draws.uniform(-math.pi, math.pi), []
    for index in range(5):
        v, bearing = draws.uniform(0.6, 1.0), turn + math.pi * (index + 1) / 3.0
        far, near = ((way * math.cos(bearing), way * math.sin(bearing)) for way in (3.0, 0.9))
        people.append(_walker(v, far, near, arrival_radius=0.05))
    return _Scene(goal=(6.0, 0.0), people=people)


_SCENES: MappingProxyType[str, Callable[[_Draws], _Scene]] = MappingProxyType(
    {
        scene.__name__[1:]: scene
        for scene in (
            _frontal_approach,
            _pedestrian_obstruction,
            _pedestrian_overtaking,
            _robot_overtaking,
            _down_path,
            _intersection_no_gesture,
            _intersection_wait,
            _intersection_proceed,
            _blind_corner,
            _narrow_hallway,
            _narrow_doorway,
            _entering_room,
            _exiting_room,
            _entering_elevator,
            _exiting_elevator,
            _join_group,
            _leave_group,
            _following_human,
            _leading_human,
            _accompanying_peer,
            _crowd_navigation,
            _parallel_traffic,
            _perpendicular_traffic,
            _circular_crossing,
            _robot_crowding,
        )
    }
)

SOCIAL: tuple[str, ...] = tuple(_SCENES)
"""Names that `social` knows, in the order of their numbers."""


@functools.cache
def _body() -> nav.HolonomicRobot:
    return nav.HolonomicRobot(radius=0.25, max_speed=1.0, max_acceleration=3.0)


def social(name: str, seed: int, *, reacting: bool = True, law: AnyLaw | None = None) -> World:
    """Return a standard scene of social navigation.

    There is a scene for each card of figure 7 of Francis and others (2023), *Principles and guidelines for evaluating
    social robot navigation algorithms*. The cards are theirs; all numbers are choices of this package, such that every
    scene can be solved and the scenes tell laws apart. Not shown in the plane are gestures, gaze, speech, doors that
    move and calling an elevator.

    The robot has a radius of 0.25 m, 1 m/s and 3 m/s^2, and decides every 0.1 s; people have a radius of 0.25 m and
    walk by `CollisionFreeSpeed`, or along a track in ``"intersection_proceed"`` and at elevators. In
    ``"blind_corner"`` walls hide people from the robot. In ``"following_human"``, ``"leading_human"`` and
    ``"accompanying_peer"`` the robot has a `task`: its law's goal moves with the person.

    Parameters
    ----------
    name : str
        One of `SOCIAL`.
    seed : int
        Seed of the draws and of the world, 0 <= seed < 2**64.
    reacting : bool
        Whether people notice the robot. In ``"intersection_wait"`` the person never does.
    law : Law, callable, object or None
        Law of the robot; ``None``: it stands unless a verb is given a law.

    Returns
    -------
    World
        The same for the same arguments.

    Raises
    ------
    InvalidParameterError
        If the name is unknown, or the seed is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> world = scenarios.social("frontal_approach", 0, law=nav.OptimalReciprocalCollisionAvoidance(horizon=2.0))
    >>> nav.simulate(world).outcomes
    ('arrived',)
    """
    if not isinstance(name, str) or name not in _SCENES:
        raise InvalidParameterError("name", f"be one of {', '.join(SOCIAL)}", name, meant(name, SOCIAL))
    checked = checked_seed("seed", seed)
    scene = _SCENES[name](_Draws(SOCIAL.index(name), checked))
    noticed = flag("reacting", reacting)
    people = [each if noticed else replace(each, awareness=0.0) for each in scene.people]
    robot = Robot(
        _body(),
        start=scene.start,
        goal=scene.goal,
        law=law,
        control_period=0.1,
        occlusion=scene.occlusion,
        task=scene.task,
    )
    return World(people=people, robots=[robot], walls=scene.walls, step=0.05, time_limit=scene.time_limit, seed=checked)
