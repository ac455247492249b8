"""People, robots and sources of people: who is in a world."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import field, replace
from typing import Any, Literal, get_args

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, Parameters, count, flag, instance, number, pair, points, sequence, vector, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.crowd.pedestrians import CollisionFreeSpeed, Pedestrian
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.navigation.sensing.robot_sensor import RobotSensor

__all__ = ["FASTEST_DRAWN", "AtEnd", "Person", "Robot", "Source", "Task", "Waypoint", "middle_of", "points_of"]

AtEnd = Literal["stay", "leave", "repeat"]
Task = Literal["behind", "ahead", "beside"]

_MOST_GROUPS = 2**32 - 1
FASTEST_DRAWN = 2.2
"""Largest speed that is drawn for people, in m/s, Weidmann (1993)."""


Line = tuple[Pair, Pair]
Waypoint = Pair | Line
"""An element of a route: a point (x, y) in m, or a line between two points."""


def _route(name: str, elements: object) -> tuple[Waypoint, ...]:
    """Return the points and lines of a route."""
    rule = "be a sequence of points (x, y) and lines ((x, y), (x, y))"
    return tuple(_element(f"{name}[{index}]", each) for index, each in enumerate(sequence(name, rule, elements)))


def _element(name: str, given: object) -> Waypoint:
    """Return a point, or a line of two points."""
    parts = sequence(name, "be a point (x, y) or a line of two points", given)
    if len(parts) == 2 and all(isinstance(part, Sequence | np.ndarray) and not isinstance(part, str) for part in parts):
        return pair(f"{name}[0]", parts[0]), pair(f"{name}[1]", parts[1])
    return pair(name, given)


def points_of(element: Waypoint) -> tuple[Pair, ...]:
    """Return the point, or the two ends of the line, of an element of a route."""
    first, second = element
    return (first, second) if isinstance(first, tuple) and isinstance(second, tuple) else (element,)  # type: ignore[return-value]


def middle_of(element: Waypoint) -> Pair:
    """Return the point, or the middle of the line, of an element of a route."""
    ends = points_of(element)
    return sum(x for x, _ in ends) / len(ends), sum(y for _, y in ends) / len(ends)


def _recording(given: object) -> tuple[tuple[float, ...], tuple[Pair, ...]] | None:
    """Return instants and positions of a recording."""
    if given is None:
        return None
    parts = sequence("recording", "be a pair of times and positions", given)
    if len(parts) != 2:
        raise ShapeError("recording", "two: times and positions", (len(parts),))
    time = tuple(vector("recording.time", parts[0]).tolist())
    return time, tuple((x, y) for x, y in points("recording.position", parts[1]).tolist())


def _traits(owner: Person | Source) -> dict[str, Any]:
    """Return what people have in common, with checked values."""
    speed = None if owner.desired_speed is None else number("desired_speed", owner.desired_speed)
    return {
        "radius": number("radius", owner.radius),
        "desired_speed": speed,
        "awareness": number("awareness", owner.awareness),
        "distracted_share": number("distracted_share", owner.distracted_share),
        "arrival_radius": number("arrival_radius", owner.arrival_radius),
        "at_end": word("at_end", owner.at_end, ("stay", "leave", "repeat")),
        "route": _route("route", owner.route),
    }


def _told(traits: dict[str, Any]) -> dict[str, Any]:
    """Return what people have in common as the core takes it."""
    return traits | {"route": [points_of(element) for element in traits["route"]]}


@dataclass(frozen=True, kw_only=True, slots=True)
class Person(Parameters):
    """A person who walks along a route.

    Parameters
    ----------
    start : tuple of float
        Position (x, y) in m.
    route : sequence of points and lines
        Points (x, y) in m and lines ((x, y), (x, y)), one after the other; without one the person stands. A point
        is reached within the arrival radius. Of a line, a door for example, the person goes to the nearest point
        that leaves room for the body at both ends, and it is passed where the center crosses it.
    model : Pedestrian
        How the person decides.
    radius : float
        Radius in m.
    desired_speed : float or None
        Speed in m/s; ``None``: drawn by the seed of the world from a normal distribution with mean 1.34
        and standard deviation 0.26 m/s, again if outside 0.5 to 2.2 m/s (Weidmann 1993).
    velocity : tuple of float
        Velocity at the start in m/s.
    at_end : {"stay", "leave", "repeat"}
        What the person does at the last point: stand there as a neighbor, be gone, or start again.
    arrival_radius : float
        Distance at which a point of the route is reached, in m.
    awareness : float
        Share from 0 to 1 by which robots are taken into account: 0 for a person who does not notice
        them, 1 for one who treats them as people.
    distracted_share : float
        Probability that the awareness is 0 instead, drawn by the seed of the world.
    enters : float
        When the person appears, in s.
    recording : tuple of (times, positions) or None
        A way over time in s and m, which the person follows without reacting to anybody: present between
        the first and the last instant, straight between two.
    mover : Human, MovingDisc or None
        An obstacle whose way the person follows without reacting to anybody; see `moving`.
    group : int or None
        Number of the group, of which `Moussaid` keeps the members together.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range, the ends of a line are one place, or an empty route is to be
        repeated or left.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Person(start=(0, 0), route=[(5, 0)], desired_speed=1.2).at_end
    'stay'
    """

    start: Pair
    route: tuple[Waypoint, ...] | Sequence[Waypoint] = ()
    model: Pedestrian = field(default_factory=functools.cache(CollisionFreeSpeed))
    radius: float = 0.25
    desired_speed: float | None = None
    velocity: Pair = (0.0, 0.0)
    at_end: AtEnd = "stay"
    arrival_radius: float = 0.3
    awareness: float = 1.0
    distracted_share: float = 0.0
    enters: float = 0.0
    recording: tuple[Sequence[float], Sequence[Pair]] | None = None
    mover: Human | MovingDisc | None = None
    group: int | None = None
    _native: _hrsafety.CrowdPerson = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        traits = _traits(self)
        instance("model", self.model, Pedestrian)
        places = {name: pair(name, getattr(self, name)) for name in ("start", "velocity")}
        group = None if self.group is None else count("group", self.group, least=0, most=_MOST_GROUPS)
        own = {"group": group, "enters": number("enters", self.enters), "recording": _recording(self.recording)}
        self._set(**traits, **places, **own)
        if self.mover is not None:
            instance("mover", self.mover, Human, MovingDisc)
            if self.recording is not None:
                raise InvalidParameterError("recording", "be None for somebody who moves as an obstacle", Shown("both"))
        told = {**own, "mover": None if self.mover is None else self.mover._native}
        if self.mover is not None:
            del told["recording"]
        native = _hrsafety.CrowdPerson(self.model._native, **_told(traits), **places, **told)
        self._set(_native=native)

    @property
    def reacts(self) -> bool:
        """Whether the person decides by a model, not by a recording or as an obstacle moves."""
        return self.recording is None and self.mover is None

    @classmethod
    def moving(cls, obstacle: Human | MovingDisc) -> Person:
        """Return a person who moves as an obstacle does and reacts to no person.

        Parameters
        ----------
        obstacle : Human or MovingDisc
            The obstacle.

        Returns
        -------
        Person
            With its start and radius.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.Person.moving(nav.Human(start=(1, 2), velocity=(0.5, 0.0))).reacts
        False
        """
        instance("obstacle", obstacle, Human, MovingDisc)
        start = obstacle.start if isinstance(obstacle, Human) else obstacle.center
        return cls(start=start, radius=obstacle.radius, mover=obstacle)


@dataclass(frozen=True, kw_only=True, slots=True)
class Source(Parameters):
    """A rectangle in which people appear while a world is under way.

    A person appears only where it touches no person, no robot and no wall, else at a later step. Numbers of
    people are not used again.

    Parameters
    ----------
    low, high : tuple of float
        Lower left and upper right corner (x, y) in m.
    rate : float
        People per second.
    arrivals : {"poisson", "regular"}
        At random, or at equal intervals.
    route, model, radius, desired_speed, at_end, arrival_radius, awareness, distracted_share
        As of a `Person`; they leave at the end of their route unless told otherwise.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Source(low=(0, 0), high=(0, 3), rate=1.0, route=[(10, 1.5)]).at_end
    'leave'
    """

    low: Pair
    high: Pair
    rate: float
    arrivals: Literal["poisson", "regular"] = "poisson"
    route: tuple[Waypoint, ...] | Sequence[Waypoint]
    model: Pedestrian = field(default_factory=functools.cache(CollisionFreeSpeed))
    radius: float = 0.25
    desired_speed: float | None = None
    at_end: AtEnd = "leave"
    arrival_radius: float = 0.3
    awareness: float = 1.0
    distracted_share: float = 0.0
    _native: _hrsafety.CrowdSource = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        traits = _traits(self)
        instance("model", self.model, Pedestrian)
        word("arrivals", self.arrivals, ("poisson", "regular"))
        own = {"low": pair("low", self.low), "high": pair("high", self.high), "rate": number("rate", self.rate)}
        self._set(**traits, **own)
        native = _hrsafety.CrowdSource(self.model._native, **_told(traits), **own, regular=self.arrivals == "regular")
        self._set(_native=native)


@dataclass(frozen=True, kw_only=True, slots=True)
class Robot(Parameters):
    """A robot of a world, of any body under any law.

    Parameters
    ----------
    body : HolonomicRobot or DifferentialDriveRobot
        What it is; may be given by position.
    start, goal : tuple of float
        Positions (x, y) in m.
    law : Law, callable, object or None
        What drives it unless a verb is given a law; ``None``: it stands.
    control_period : float or None
        Time between two commands in s, a multiple of the step of the world; ``None``: the step.
    arrival_tolerance : float
        It has arrived when it is this close to the goal for the first time, in m; it then brakes and stays.
    heading : float
        Heading at the start in rad.
    sensing_range : float
        Distance up to which it sees people and other robots, in m.
    occlusion : bool
        Whether walls hide people and other robots: who is in range is seen while no wall cuts the segment between the
        centers, also of who is measured late.
    task : {"behind", "ahead", "beside"} or None
        What the law does with the first person of the world: its goal is moved every control period to 1.2 m behind
        the person, 1.5 m ahead, or 1.2 m beside on the side of the robot, in the direction of the measured velocity,
        the last one of 0.05 m/s or more (at first along x). Laws that plan the whole way themselves, trees and
        Field D*, keep to the goal of the robot, and so does a guide in a map while it does not see the moving goal.
        The robot has arrived at its own goal. ``None``: nothing.
    measurement : Measurement or None
        Errors and age of what it sees; ``None``: everything is known exactly.
    sensors : sequence of RobotSensor
        Sensors on the robot, such as `Lidar` or `Ultrasonic`, beside those of ``built``. A lidar without a map sees
        the `StaticMap` that stands in its world.
    built : AsBuilt or None
        How it is built: wheels with controllers, cameras, how a two-wheel robot follows its law. Sensors look once
        a step of the world; wheels move in steps of 0.01 s.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range.

    Notes
    -----
    The law is told of everybody in its range as moving discs with their present velocity, and of walls
    as obstacles that stand. It does not know who is aware of the robot.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> law = nav.OptimalReciprocalCollisionAvoidance()
    >>> robot = nav.Robot(nav.DifferentialDriveRobot(), start=(0, 0), goal=(8, 0), law=law)
    >>> robot.sensing_range
    10.0
    """

    body: HolonomicRobot | DifferentialDriveRobot = field(
        default_factory=functools.cache(HolonomicRobot), kw_only=False
    )
    start: Pair
    goal: Pair
    law: AnyLaw | None = None
    control_period: float | None = None
    arrival_tolerance: float = 0.3
    heading: float = 0.0
    sensing_range: float = 10.0
    occlusion: bool = False
    task: Task | None = None
    measurement: Measurement | None = None
    sensors: Sequence[RobotSensor] = ()
    built: AsBuilt | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        given = sequence("sensors", "be a sequence of sensors, such as Lidar", self.sensors)
        self._set(sensors=tuple(instance(f"sensors[{i}]", one, RobotSensor) for i, one in enumerate(given)))
        if self.built is not None:
            instance("built", self.built, AsBuilt)
        if self.law is not None:
            self._set(law=as_law(self.law))
        instance("body", self.body, HolonomicRobot, DifferentialDriveRobot)
        if self.measurement is not None:
            instance("measurement", self.measurement, Measurement)
        if self.control_period is not None:
            self._as_numbers("control_period")
        self._as_numbers("arrival_tolerance", "heading", "sensing_range")
        self._set(occlusion=flag("occlusion", self.occlusion))
        if self.task is not None:
            word("task", self.task, get_args(Task))
        self._set(start=pair("start", self.start), goal=pair("goal", self.goal))
        self._at_step(1.0)

    def as_built(self, walls: StaticMap | None = None) -> AsBuilt | None:
        """Return how the robot is built with all its sensors; ``None`` for an ideal one.

        Parameters
        ----------
        walls : StaticMap or None
            What stands in its world, which lidars without a map see.

        Returns
        -------
        AsBuilt or None
            Wheels and sensors.
        """
        if self.built is None and not self.sensors:
            return None
        built = AsBuilt() if self.built is None else self.built
        sensors = [
            replace(one, map=walls) if isinstance(one, Lidar) and one.map is None else one
            for one in (*built.sensors, *self.sensors)
        ]
        return replace(built, sensors=sensors)

    def _at_step(self, step: float, walls: StaticMap | None = None) -> _hrsafety.CrowdRobot:
        """Return the native robot for a world with a step in s and a map that stands in it."""
        built = self.as_built(walls)
        return _hrsafety.CrowdRobot(
            self.body._native,
            None if self.law is None else self.law._native,  # type: ignore[union-attr]  # made a Law above
            None if self.measurement is None else self.measurement._native,
            None if built is None else built._native,
            start=self.start,
            goal=self.goal,
            heading=self.heading,
            control_period=step if self.control_period is None else self.control_period,
            arrival_tolerance=self.arrival_tolerance,
            sensing_range=self.sensing_range,
            occlusion=self.occlusion,
            task=self.task or "",
        )
