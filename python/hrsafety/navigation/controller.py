"""A law on a robot: observations come from outside, whenever they do, and commands go out."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, count, instance, number, numbers, pair, positive, sequence
from hrsafety.errors import InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.free_space import stands
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.laws.safe_navigation import SafeNavigation
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.measured_people import MeasuredPeople
from hrsafety.navigation.named_people import NamedPeople, Told
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human
from hrsafety.navigation.robot_command import Command, Sighting
from hrsafety.navigation.robots.bodies import NUMBERS, DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.sensing.lidar import Lidar, in_meters
from hrsafety.navigation.warnings.filters import of_filter
from hrsafety.navigation.warnings.shields import maps_of, of_controller, of_order, shield_of
from hrsafety.navigation.warnings.units import of_lidar
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["Command", "Controller", "Sighting"]

MOST_PEOPLE = 10_000
UNMEASURED_AFTER = 1.0
"""After so many seconds without people and scans somebody may have come, in s."""
FAR = 1e6
"""Where the scenario has those who were not seen yet, in m."""


class Controller:
    """A law on a robot: told what is seen, it returns what to do.

    Told the same at the same instants, it commands the same as a run, bit for bit. It keeps what it was
    told: whoever is not measured again stays where he was, with an age that grows, and the shield reckons
    with wherever he can be by then; so it does with the points of a scan. What is told without its instant
    can be as old as the ``latency`` of the shield when it is told. A person is forgotten when ``gone`` names
    him, or after 2 s if a scan sees his place to be empty, or after ``age_limit``. Measurements older than what is
    known of a person count for nothing.

    Who was not measured is not away: give ``people={}`` where somebody looked and nobody was there. Without ``people``
    or ``gone`` from the start, or for more than 1 s, nothing is guaranteed (``unmeasured``), but by a shield with
    `Unseen` people, and with ``people=0``, which says that nobody can be there. A scan alone is no look: the law is
    told of at most eight of its points, those within the ``reach`` of the lidar, and people may be behind them.

    Names are those of a tracker that keeps them. A new name is one more person. Where three updates in a row have no
    name in common, or there is no room, who is new counts as the nearest of those who were not measured and can have
    got there (``renamed``): people are then judged by their places only.

    Give the times of a monotonic clock. After one that was set back the robot executes the plan that it has, and rests.
    It moves again when the clock shows a later time, or has run for as long as the plan lasts; a person who is not
    measured then may be anywhere.

    Parameters
    ----------
    law : law
        What drives the robot; `SafeNavigation` for one that is to be safe.
    robot : HolonomicRobot or DifferentialDriveRobot
        The robot; one with two wheels needs a law with a shield.
    goal : (float, float)
        In m.
    map : StaticMap or None
        What stands and is known before; that of the law when ``None``.
    start : (float, float) or None
        From where plans are made; the first position that is told when ``None``, and then the first update
        takes as long as planning does.
    obstacles : sequence of Obstacle
        What stands, beside the map; who moves is told in updates.
    people : int
        How many can be there at once; 0: nobody, ever.
    person_radius, person_speed : float
        Their radius in m, and the speed in m/s that their regions are sized for.
    lidar : Lidar or None
        What ranges in updates come from.
    control_period : float
        Time between updates in s.
    arrival_tolerance : float
        The robot has arrived this close to the goal, in m.
    age_limit : float or None
        After so many seconds without a measurement a person is lost for good: he counts no more, and commands name him
        in ``lost``. ``None``: never, and the robot may stand for all time.
    seed : int
        Of laws that draw.

    Raises
    ------
    InvalidParameterError
        If an argument is not valid, or the law cannot work with it; without ``start`` the latter by the
        first update.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), yielding=nav.Yielding())
    >>> controller = nav.Controller(law, nav.HolonomicRobot(), goal=(5.0, 0.0))
    >>> command = controller.update(0.0, (0.0, 0.0), (0.0, 0.0), people={"Ada": (3.0, 0.1, -1.0, 0.0)})
    >>> command.status, command.timing
    ('changed', 'regular')
    >>> controller.update(0.06, None, None).timing
    'lost'
    """

    __slots__ = (
        "_capacity",
        "_last",
        "_law",
        "_lidar",
        "_looked",
        "_measured",
        "_names",
        "_native",
        "_person_radius",
        "_person_speed",
        "_rules",
    )

    def __init__(
        self,
        law: AnyLaw,
        robot: HolonomicRobot | DifferentialDriveRobot,
        goal: npt.ArrayLike,
        map: StaticMap | None = None,
        *,
        start: npt.ArrayLike | None = None,
        obstacles: Sequence[Obstacle] = (),
        people: int = 12,
        person_radius: float = 0.4,
        person_speed: float = 1.6,
        lidar: Lidar | None = None,
        control_period: float = 0.06,
        arrival_tolerance: float = 0.12,
        age_limit: float | None = 30.0,
        seed: int = 0,
    ) -> None:
        self._law = _with_map(as_law(law), map)
        self._lidar = None if lidar is None else instance("lidar", lidar, Lidar)
        self._capacity = count("people", people, least=0, most=MOST_PEOPLE)
        size, speed = positive("person_radius", person_radius), positive("person_speed", person_speed)
        places = [
            Human(start=(FAR + 10.0 * index, FAR), velocity=(speed, 0.0), radius=size, max_speed=speed)
            for index in range(self._capacity)
        ]
        self._person_radius, self._person_speed = size, speed
        self._rules: dict[str, Any] = {
            "robot": instance("robot", robot, HolonomicRobot, DifferentialDriveRobot),
            "goal": pair("goal", goal),
            "obstacles": (*places, *_standing(obstacles)),
            "control_period": positive("control_period", control_period),
            "arrival_tolerance": positive("arrival_tolerance", arrival_tolerance),
            "seed": seed,
        }
        limit = None if age_limit is None else positive("age_limit", age_limit)
        shield = _shield(self._law)
        most = speed if shield is None or shield.person_speed is None else shield.person_speed
        error = 0.0 if shield is None else shield.position_error
        self._names = NamedPeople(self._capacity, most, _latency(self._law), error, limit)
        self._measured = None if shield is None else MeasuredPeople(shield, most)
        self._last: Command | None = None
        self._looked = -math.inf
        self._native: _hrsafety.Controller | None = None
        if start is not None:
            self._native = self._made(pair("start", start))

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Gaps in the cover of the law's shield, what its filter assumes, doubts of its maps, implausible numbers."""
        shield, lidar, speed = _shield(self._law), self._lidar is not None, self._person_speed
        units = (*self._units(), *(() if self._lidar is None else of_lidar("lidar", self._lidar)))
        units = (*units, *dict.fromkeys(doubt for map in maps_of(self._law) for doubt in map.warnings))
        if shield is None:
            stands = len(self._rules["obstacles"]) > self._capacity or any(maps_of(self._law))
            return (*units, *of_filter(self._law, measured=True, walls=stands or lidar))
        rules = {"control_period": self._rules["control_period"], "person_speed": speed}
        reach = None if self._lidar is None else self._lidar.reach
        found = of_controller(shield, self._rules["robot"], **rules, lidar=lidar, reach=reach)
        return (*units, *of_order(self._law), *found)

    def _units(self) -> tuple[ResultWarning, ...]:
        """Return doubts about the units of numbers."""
        rules, robot = self._rules, self._rules["robot"]
        values: dict[str, object] = {name: rules[name] for name in ("control_period", "arrival_tolerance")}
        values |= {"goal": rules["goal"], "person_radius": self._person_radius, "person_speed": self._person_speed}
        values |= {f"robot.{name}": getattr(robot, name, None) for name in NUMBERS}
        quantities = {"goal": "floor_position", "person_speed": "expected_speed"}
        quantities |= {f"robot.{name}": f"robot_{name}" for name in NUMBERS}
        return implausible(values, quantities)

    def _made(self, start: Pair) -> _hrsafety.Controller:
        scenario = Scenario(start=start, **self._rules)
        lidar = None if self._lidar is None else self._lidar._lidar
        return _hrsafety.Controller(scenario._native, self._law._native, lidar, _latency(self._law))

    def _refuted(self, now: float, told: Mapping[Hashable, Told]) -> dict[str, tuple[Hashable, ...]]:
        """Return the people whose measurements refute what the shield assumes, by the fields of the command."""
        found: dict[str, tuple[Hashable, ...]] = dict.fromkeys(_OF_PEOPLE, ())
        if self._measured is None:
            return found
        for name, (position, velocity, time) in told.items():
            for field in self._measured.refuted(name, now, position, velocity, time):
                found[field] = (*found[field], name)
        return found

    @property
    def people(self) -> tuple[Hashable, ...]:
        """Names of those who are there, as far as is known."""
        if self._native is None:
            return ()
        present = self._native.present()
        return tuple(name for name, index in self._names.indices.items() if present[index])

    def update(
        self,
        time: float,
        position: npt.ArrayLike | None,
        velocity: npt.ArrayLike | None,
        *,
        heading: float | None = None,
        people: Mapping[Hashable, Sequence[float | None]] | npt.ArrayLike | None = None,
        gone: Iterable[Hashable] = (),
        scan: npt.ArrayLike | None = None,
    ) -> Command:
        """Tell what is known by now, and return what the robot is to do.

        Parameters
        ----------
        time : float
            Now, in s; an update that is not after the last one counts for nothing, and so does one whose robot is
            farther on in its plan than the time tells.
        position, velocity : array_like of shape (2,), or None
            The robot, in m and m/s; ``None`` where its place is not known: it brakes.
        heading : float or None
            In rad, which a robot with two wheels needs.
        people : mapping, array_like of shape (n, 4) or None
            Who was measured: by names of your own, `Sighting` or ``(x, y, vx, vy)`` with the instant of the
            measurement as a fifth number if it is older than ``time``; or rows of these numbers, named by
            their index. Who is not in it was not measured. ``None``: nobody looked; ``{}``: nobody was seen.
        gone : iterable
            Names of those who are known to have left.
        scan : array_like of shape (beams,), or None
            Ranges of the lidar in m; infinite where nothing was hit, which some drivers report as 0: here 0 is
            something that touches the lidar, and the robot stands. NaN: not known, neither hit nor free.

        Returns
        -------
        Command
            What to do until the next update.

        Raises
        ------
        InvalidParameterError
            If a value is not finite, there are more people than the controller has room for, or a measurement
            is later than the update, or ranges are hardly in m.
        SimulationError
            If the law answers no finite force.
        """
        now = number("time", time)
        if (position is None) != (velocity is None):
            missing = "position" if position is None else "velocity"
            raise InvalidParameterError(missing, "be given together with the other of position and velocity", None)
        robot = (
            None if position is None or velocity is None else (pair("position", position), pair("velocity", velocity))
        )
        if heading is None and isinstance(self._rules["robot"], DifferentialDriveRobot) and robot is not None:
            raise InvalidParameterError("heading", "be given for a DifferentialDriveRobot", None)
        angle = 0.0 if heading is None else number("heading", heading)
        if self._native is None:
            if robot is None:
                return self._told(now, _NOTHING, dict.fromkeys((*_OF_PEOPLE, "renamed"), ()))
            self._native = self._made(robot[0])
        told = {} if people is None else self._seen(people)
        ranges = None if scan is None else _ranges(scan, self._lidar)
        names = self._left(gone, told)
        before = self._names.copy()
        try:
            present = self._native.present()
            departed = self._names.left(names)
            left = [*departed, *self._names.outlived(now, told, present)]
            renamed = self._names.place(now, told, present)
            places = self._names.indices
            unknown = (math.nan, math.nan)
            seen = [(places[name], who.position, who.velocity or unknown, who.time) for name, who in told.items()]
            fields = self._native.update(now, robot, angle, seen=seen, gone=left, scan=ranges)
        except BaseException:
            self._names = before
            raise
        last = self._last
        if fields["timing"] == "out_of_order" and last is not None:
            # It counts for nothing.
            self._names = before
            found = {field: getattr(last, field) for field in (*_OF_PEOPLE, "renamed")}
        else:
            # Who was gone before tells of no look.
            if people is not None or any(present[slot] for slot in departed):
                self._looked = now
            if self._measured is not None:
                self._measured.forget(names)
                for name, former in renamed.items():
                    self._measured.rename(name, former)
            found = self._refuted(now, told) | {"renamed": tuple(renamed)}
            if fields["timing"] != "lost":
                surprises = set(self._native.unexpected())
                found["unexpected"] = tuple(name for name in told if places[name] in surprises)
        self._last = self._told(now, fields, found)
        return self._last

    def _told(self, now: float, fields: Mapping[str, Any], found: Mapping[str, tuple[Hashable, ...]]) -> Command:
        rules, robot = self._rules, self._rules["robot"]
        limits = {"period": rules["control_period"], "max_acceleration": robot.guaranteed_acceleration}
        told = {**fields, **found, "lost": tuple(self._names.lost)}
        told["unmeasured"] = self._unmeasured(now)
        told["plan"] = tuple((time, (rates[0], rates[1])) for time, rates in told["plan"])
        if isinstance(robot, DifferentialDriveRobot) and told["speed"] is None:
            # Two wheels that were never told where they are stand.
            told |= {"speed": 0.0, "turn_rate": 0.0}
        shield = _shield(self._law)
        told["refuted"] = tuple(name for name in _assumed(shield) if told[name])
        command = Command(**limits, **told)
        assumes = shield is not None or (isinstance(self._law, SafeNavigation) and self._law.filter is not None)
        if assumes and command.doubts and command.status in ("kept", "changed"):
            return replace(command, status="not_guaranteed")
        return command

    def _unmeasured(self, now: float) -> bool:
        """Return whether people may be there for whom nobody looked."""
        shield = _shield(self._law)
        if self._capacity == 0 or (shield is not None and shield.unseen is not None):
            return False
        return now - self._looked > UNMEASURED_AFTER

    def _seen(self, people: Mapping[Hashable, Sequence[float | None]] | npt.ArrayLike) -> dict[Hashable, Told]:
        """Return who was measured."""
        if not isinstance(people, Mapping):
            rows = numbers("people", people)
            if rows.size and (rows.ndim != 2 or rows.shape[1] not in (4, 5)):
                raise ShapeError("people", "(n, 4) or (n, 5)", rows.shape)
            people = dict(enumerate(rows.reshape(-1, max(1, rows.shape[-1])).tolist() if rows.size else []))
        return {name: self._sighting(name, given) for name, given in people.items()}

    def _sighting(self, name: Hashable, given: Sequence[float | None]) -> Told:
        """Return place, velocity and instant of a person who was measured."""
        label = f"people[{name!r}]"
        if isinstance(given, (str, Mapping)) or not (hasattr(given, "__len__") and hasattr(given, "__getitem__")):
            rule = "be a Sighting or (x, y, vx, vy), with the instant as a fifth number"
            raise InvalidParameterError(label, rule, given)
        if len(given) not in (4, 5):
            raise ShapeError(label, "(4,) or (5,)", (len(given),))
        x, y = (number(label, value) for value in given[:2])
        vx, vy = (self._speed(label, value) for value in given[2:4])
        instant = given[4] if len(given) == 5 else None
        velocity = None if vx is None or vy is None else (vx, vy)
        return Told((x, y), velocity, None if instant is None else number(f"{label}.time", instant))

    def _speed(self, name: str, value: float | None) -> float | None:
        """Return a component of a velocity; who is not known to move may not be taken to stand."""
        if value is not None:
            return number(name, value)
        if isinstance(self._law, SafeNavigation) and self._law.filter is not None:
            raise InvalidParameterError(name, "have a velocity, as the filter of the law takes it for known", None)
        shield = _shield(self._law)
        if shield is not None and shield.velocity_error is not None:
            rule = "have a velocity, as the shield assumes one to be known to velocity_error"
            remedy = "give vx and vy, or a shield without velocity_error and person_acceleration"
            raise InvalidParameterError(name, rule, None, remedy)
        return None

    def _left(self, gone: Iterable[Hashable], told: Mapping[Hashable, Told]) -> list[Hashable]:
        """Return the names of those who left; no person can have left who is measured in the same update."""
        names = sequence("gone", "be names in a list, a tuple or a set", gone)
        for name in names:
            try:
                hash(name)  # a tuple, or a number of NumPy with fields, may hold what has none
            except TypeError:
                raise InvalidParameterError("gone", "hold names as they stand in people", name) from None
            if name in told:
                raise InvalidParameterError("gone", "name nobody who is measured in the same update", name)
        return list(names)

    def __repr__(self) -> str:
        """Return law, goal and who is there."""
        return f"Controller(law={self._law!r}, goal={self._rules['goal']}, people={self.people!r})"

    def __reduce__(self) -> NoReturn:
        """Refuse: a law may remember anything, and its copy would not be independent."""
        raise SimulationError("a Controller cannot be copied or pickled; make another with the same arguments")


_NOTHING: Mapping[str, Any] = {
    "force": (0.0, 0.0),
    "velocity": (0.0, 0.0),
    "before": (0.0, 0.0),
    "heading": 0.0,
    "plan": (),
    "robot_off_plan": None,
    "speed": None,
    "turn_rate": None,
    "status": "braking",
    "taken_over": False,
    "timing": "lost",
    "arrived": False,
    "oldest": 0.0,
    "clock_set_back": None,
    "unknown_beams": 0,
}
"""Fields of the command of a robot that does not know its position yet."""


_OF_PEOPLE = ("faster", "accelerated", "velocity_off", "unexpected")
"""Fields of a command that name people whose measurements refute something."""


def _assumed(shield: Shield | None) -> tuple[str, ...]:
    """Return the fields of a command that tell of a refuted assumption of a shield."""
    if shield is None:
        return ()
    velocities = () if shield.velocity_error is None else ("velocity_off",)
    unseen = () if shield.unseen is None else ("unexpected",)
    return ("faster", "accelerated", *velocities, *unseen, "robot_off_plan")


def _ranges(scan: npt.ArrayLike, lidar: Lidar | None) -> Array:
    """Return ranges of a lidar, checked."""
    ranges = np.ascontiguousarray(numbers("scan", scan))
    if ranges.ndim != 1:
        raise ShapeError("scan", "(beams,)", ranges.shape)
    return ranges if lidar is None else in_meters("scan", ranges, lidar)


def _standing(obstacles: Sequence[Obstacle]) -> list[Obstacle]:
    """Return obstacles that stand: where another one is, it would never be noticed."""
    found: list[Obstacle] = sequence("obstacles", "be a sequence of obstacles", obstacles)
    for index, obstacle in enumerate(found):
        if not stands(instance(f"obstacles[{index}]", obstacle, Obstacle)):
            remedy = "tell where it is in people= of every update"
            raise InvalidParameterError(f"obstacles[{index}]", "stand for all time", obstacle, remedy)
    return found


def _shield(law: AnyLaw) -> Shield | None:
    """Return the shield of a law, if it has one."""
    return shield_of(law)[0]


def _latency(law: AnyLaw) -> float:
    """Return how old may be what is told without its instant, in s."""
    shield = _shield(law)
    return 0.0 if shield is None else shield.latency


def _with_map(law: Any, map: StaticMap | None) -> Any:
    """Return the law with a map that it is to know."""
    if map is None:
        return law
    instance("map", map, StaticMap)
    if not isinstance(law, SafeNavigation):
        return SafeNavigation(law, map=map)
    if law.map is not None and law.map != map:
        raise InvalidParameterError("map", "be None for a law that knows a map", map)
    return law.replaced(map=map)
