"""The worlds of the registered environments, and what differs between their episodes."""

from __future__ import annotations

from dataclasses import dataclass

from hrsafety import scenarios
from hrsafety._arguments import Pair, count, flag
from hrsafety.navigation.crowd.agents import CrowdRobot, Person, Source
from hrsafety.navigation.crowd.pedestrians import CollisionFreeSpeed, Pedestrian
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.robots.bodies import HolonomicRobot

__all__ = ["Task", "bottleneck", "circle_crossing", "corridor", "crossing"]

_PERIOD = 0.25  # time between two commands in s, as in CrowdNav
_MOST_PEOPLE = 10_000


@dataclass(frozen=True, kw_only=True)
class Task:
    """A world with a robot to drive, and how its episodes are drawn.

    Parameters
    ----------
    world : World
        People, walls, and the robot that is driven, the first one, without a law.
    circle : bool
        Whether starts and goals of the people are drawn on a circle anew for each episode.
    area : tuple or None
        Rectangle ``(low, high, level)`` in which starts are drawn, in m; ``level``: people walk along x, each at
        the height of the start.

    Examples
    --------
    >>> from hrsafety import gym
    >>> gym.circle_crossing(people=3).circle
    True
    """

    world: World
    circle: bool = False
    area: tuple[Pair, Pair, bool] | None = None


def _robot(start: Pair, goal: Pair) -> CrowdRobot:
    return CrowdRobot(start=start, goal=goal, robot=HolonomicRobot(radius=0.3, max_speed=1.0), control_period=_PERIOD)


def circle_crossing(*, people: int = 5, visible: bool = True, model: Pedestrian | None = None) -> Task:
    """Return people who cross a circle of 4 m, and a robot that crosses it, too, as in CrowdNav.

    Parameters
    ----------
    people : int
        How many.
    visible : bool
        Whether people avoid the robot.
    model : Pedestrian or None
        How people decide; `ReciprocalAvoidance` when ``None``.

    Returns
    -------
    Task
        Steps of 0.25 s, 25 s at most.

    Examples
    --------
    >>> from hrsafety import gym
    >>> len(gym.circle_crossing().world.people)
    5
    """
    world = scenarios.circle_crossing(0, visible=visible, people=people, model=model)
    return Task(world=world, circle=True)


def corridor(*, people: int = 10, visible: bool = True, model: Pedestrian | None = None) -> Task:
    """Return people who walk both ways through a corridor of 10 m x 3 m that repeats itself.

    Parameters
    ----------
    people : int
        How many.
    visible : bool
        Whether people avoid the robot.
    model : Pedestrian or None
        How people decide; `CollisionFreeSpeed` when ``None``.

    Returns
    -------
    Task
        Steps of 0.05 s, commands every 0.25 s, 30 s at most.

    Examples
    --------
    >>> from hrsafety import gym
    >>> gym.corridor().world.period
    (10.0, 0.0)
    """
    decide = CollisionFreeSpeed() if model is None else model
    awareness = 1.0 if flag("visible", visible) else 0.0
    far = 1e4
    walkers = [
        Person(
            start=(2.0 + 7.0 * (index % 10) / 10.0, 0.5 + 0.6 * (index % 4)),
            route=[(far if index % 2 == 0 else -far, 1.5)],
            model=decide,
            awareness=awareness,
        )
        for index in range(count("people", people, least=0, most=_MOST_PEOPLE))
    ]
    walls = [[(-far, 0.0), (far, 0.0)], [(-far, 3.0), (far, 3.0)]]
    robot = _robot((0.5, 1.5), (9.0, 1.5))
    world = World(people=walkers, robots=[robot], walls=walls, period=(10.0, 0.0), time_limit=30.0)
    return Task(world=world, area=((1.2, 0.3), (9.7, 2.7), True))


def crossing(*, rate: float = 1.0, visible: bool = True, model: Pedestrian | None = None) -> Task:
    """Return two streams of people who cross at right angles in corridors of 3 m.

    Parameters
    ----------
    rate : float
        People per second and stream.
    visible : bool
        Whether people avoid the robot.
    model : Pedestrian or None
        How people decide; `CollisionFreeSpeed` when ``None``.

    Returns
    -------
    Task
        Steps of 0.05 s, commands every 0.25 s, 40 s at most; the robot goes with one of the streams.

    Examples
    --------
    >>> from hrsafety import gym
    >>> len(gym.crossing().world.sources)
    2
    """
    decide = CollisionFreeSpeed() if model is None else model
    awareness = 1.0 if flag("visible", visible) else 0.0
    end, half = 8.0, 1.5
    walls = [[(x * end, y * half), (x * half, y * half), (x * half, y * end)] for x in (-1.0, 1.0) for y in (-1.0, 1.0)]
    low, high = 1.0 - end, 1.5 - end
    streams = [((low, -1.2), (high, 1.2), (end, 0.0)), ((-1.2, low), (1.2, high), (0.0, end))]
    sources = [
        Source(low=first, high=last, rate=rate, route=[goal], model=decide, arrival_radius=half, awareness=awareness)
        for first, last, goal in streams
    ]
    robot = _robot((0.0, -5.0), (0.0, 6.0))
    return Task(world=World(sources=sources, robots=[robot], walls=walls, time_limit=40.0))


def bottleneck(*, people: int = 20, door: float = 1.0, visible: bool = True, model: Pedestrian | None = None) -> Task:
    """Return people who leave a room of 8 m x 8 m through a door, and a robot among them.

    Parameters
    ----------
    people : int
        How many.
    door : float
        Width of the door in m.
    visible : bool
        Whether people avoid the robot.
    model : Pedestrian or None
        How people decide; `CollisionFreeSpeed` when ``None``.

    Returns
    -------
    Task
        Steps of 0.05 s, commands every 0.25 s, 60 s at most.

    Examples
    --------
    >>> from hrsafety import gym
    >>> gym.bottleneck(people=5).area
    ((0.4, 0.4), (6.0, 7.6), False)
    """
    decide = CollisionFreeSpeed() if model is None else model
    awareness = 1.0 if flag("visible", visible) else 0.0
    low, high = 4.0 - 0.5 * door, 4.0 + 0.5 * door
    walls = [[(8.0, low), (8.0, 0.0), (0.0, 0.0), (0.0, 8.0), (8.0, 8.0), (8.0, high)]]
    walkers = [
        Person(
            start=(2.0 + 0.5 * (index % 8), 0.4 + 0.7 * (index // 8 % 10)),
            route=[(8.0, 4.0), (10.0, 4.0)],
            model=decide,
            at_end="leave",
            awareness=awareness,
        )
        for index in range(count("people", people, least=0, most=_MOST_PEOPLE))
    ]
    robot = _robot((1.0, 4.0), (10.0, 4.0))
    world = World(people=walkers, robots=[robot], walls=walls, time_limit=60.0)
    return Task(world=world, area=((0.4, 0.4), (6.0, 7.6), False))
