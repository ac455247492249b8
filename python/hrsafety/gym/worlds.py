"""The worlds of the registered environments, and what differs between their episodes."""

from __future__ import annotations

from dataclasses import dataclass, replace

from hrsafety import scenarios
from hrsafety._arguments import Pair, count, finite, flag, instance, pair, sequence
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import Robot
from hrsafety.navigation.crowd.pedestrians import Pedestrian
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.place import Place
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.scenario import Scenario

__all__ = ["Task", "bottleneck", "circle_crossing", "corridor", "crossing"]

_PERIOD = 0.25  # time between two commands in s, as in CrowdNav
_MOST_PEOPLE = 10_000

Area = tuple[Pair, Pair, bool]


@dataclass(frozen=True, kw_only=True)
class Task:
    """A world with a robot to drive, and how its episodes are drawn.

    Parameters
    ----------
    world : World or Scenario
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
    area: Area | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        object.__setattr__(self, "world", World.of(instance("world", self.world, World, Scenario)))
        flag("circle", self.circle)
        if self.area is not None:
            rule = "be (low, high, level) or None"
            parts = sequence("area", rule, self.area)
            if len(parts) != 3:
                raise InvalidParameterError("area", rule, self.area)
            area = (_corner("area.low", parts[0]), _corner("area.high", parts[1]), flag("area.level", parts[2]))
            object.__setattr__(self, "area", area)


def task_of(given: object) -> Task:
    """Return the task of driving the first robot of a world or scenario; a task as it is."""
    if isinstance(given, Task):
        return given
    if not isinstance(given, Place):
        raise InvalidParameterError("world", "be a World, Scenario or Task", given)
    return Task(world=World.of(given))


def _corner(name: str, value: object) -> Pair:
    x, y = pair(name, value)
    return finite(name, x), finite(name, y)


def _robot(start: Pair, goal: Pair) -> Robot:
    return Robot(HolonomicRobot(radius=0.3, max_speed=1.0), start=start, goal=goal, control_period=_PERIOD)


def _among(world: World, robot: Robot, visible: bool, area: Area | None = None) -> Task:
    """Return the task of a robot in a world; starts that are drawn anew lie in a corner of their area before."""
    awareness = 1.0 if flag("visible", visible) else 0.0
    people = [replace(each, awareness=awareness, start=area[1] if area else each.start) for each in world.people]
    sources = [replace(each, awareness=awareness) for each in world.sources]
    return Task(world=replace(world, people=people, sources=sources, robots=[robot]), area=area)


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
    walkers = count("people", people, least=0, most=_MOST_PEOPLE)
    world = scenarios.corridor(walkers, model=model, time_limit=30.0)
    return _among(world, _robot((0.5, 1.5), (9.0, 1.5)), visible, ((1.2, 0.3), (9.7, 2.7), True))


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
    world = scenarios.crossing(0, rate=rate, model=model, time_limit=40.0)
    return _among(world, _robot((0.0, -5.0), (0.0, 6.0)), visible)


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
    walkers = count("people", people, least=0, most=_MOST_PEOPLE)
    world = scenarios.bottleneck(walkers, door=door, model=model, time_limit=60.0)
    return _among(world, _robot((1.0, 4.0), (10.0, 4.0)), visible, ((0.4, 0.4), (6.0, 7.6), False))
