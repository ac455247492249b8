"""A scenario: robot, start, goal, obstacles and the rules of the run."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Sequence
from dataclasses import field, fields
from typing import Any

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, assign, instance, pair, sequence
from hrsafety._doubts import checked_doubts
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.maps.outlines import checked_shapes, standing
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.place import Place
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.navigation.warnings import scenarios as scenario_warnings
from hrsafety.plausibility import ResultWarning

__all__ = ["Scenario"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Scenario(Place):
    """A robot that starts at rest, its goal, and what stands or walks between them.

    Parameters
    ----------
    start, goal : tuple of float
        Positions (x, y) in m.
    obstacles : iterable of Obstacle
        Discs, rectangles, people, moving discs. Kept as a tuple with the radii of all regions
        filled in; those that were not given are those of `region_radii` for this robot, this
        control period and this measurement, and are computed anew when one of them is replaced.
    robot : HolonomicRobot or DifferentialDriveRobot
        The robot. Batches of point masses take the first kind only.
    control_period : float
        Time T_s between two evaluations of the force, in s.
    time_limit : float
        Longest simulated time, in s.
    arrival_tolerance : float
        The robot has arrived when it is this close to the goal for the first time, in m.
    heading : float
        Heading of the robot in rad. It is constant and matters for wheel speeds and energy only;
        a `DifferentialDriveRobot` starts with it.
    rest_time : float
        A robot that has been at rest for this long has stopped for good, in s.
    measurement : Measurement or None
        Noise and age of the measured positions; ``None``: everything is known exactly.
    seed : int
        Seed of the noise, 0 <= seed < 2**64.
    walls : StaticMap, sequence of Disc, Rectangle or sequence of points, or None
        What stands beside the obstacles, as in a `World`; kept as a map. Contacts with it count in runs
        (``map_contact_time``); laws know of it what they have a map of, or what a lidar sees, and runs carry the
        warning ``"unknown_wall"`` where that is less.
    doubts : sequence of ResultWarning
        Why the obstacles may not be what they seem to, such as `Recording.warnings` of people who were recorded; the
        warnings of the scenario and of its runs hold them.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range, the robot would start in contact with an
        obstacle, start and goal are within the arrival tolerance, or a critical radius is below the
        distance at which robot and obstacle touch. A goal in the active region of a stationary obstacle is
        refused when a run under a force law begins, which is pushed away from it.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> scene = nav.Scenario(
    ...     start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[nav.Disc(center=(2.45, 0.595), radius=0.1)]
    ... )
    >>> round(scene.obstacles[0].critical_radius, 4)
    0.3665
    """

    start: Pair
    goal: Pair
    obstacles: tuple[Obstacle, ...] = ()
    robot: HolonomicRobot | DifferentialDriveRobot = field(default_factory=functools.cache(HolonomicRobot))
    control_period: float = 0.06
    time_limit: float = 60.0
    arrival_tolerance: float = 0.12
    heading: float = 0.0
    rest_time: float = 5.0
    measurement: Measurement | None = None
    seed: int = 0
    walls: StaticMap | None = None
    doubts: Sequence[ResultWarning] = field(default=(), repr=False, compare=False)
    _native: _hrsafety.Scenario = field(init=False, repr=False, compare=False)
    _warnings: tuple[ResultWarning, ...] | None = field(init=False, repr=False, compare=False, default=None)
    _units: tuple[ResultWarning, ...] | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check the values and compute the regions that were not given."""
        start, goal = pair("start", self.start), pair("goal", self.goal)
        rules = self._rules()
        robot, measurement, seed = self.robot, self.measurement, self.seed
        if type(robot) is not HolonomicRobot:
            instance("robot", robot, HolonomicRobot, DifferentialDriveRobot)
        if measurement is not None:
            instance("measurement", measurement, Measurement)
        if type(seed) is bool or not isinstance(seed, int) or not 0 <= seed < 2**64:
            raise InvalidParameterError("seed", "be an integer from 0 to 2**64 - 1", seed)
        if type(self.doubts) is not tuple or self.doubts:  # seldom
            self._set(doubts=checked_doubts("doubts", self.doubts))
        given = _as_given(robot, self.obstacles, rules[0], measurement)
        noise = (None if measurement is None else measurement._native, seed)
        walls = None if self.walls is None else self._standing(self.walls)
        try:
            natives = [obstacle._native for obstacle in given]
            native = _hrsafety.Scenario(robot._native, (start, goal), natives, rules, noise)
            native = native if walls is None else walls.around(native)
        except InvalidParameterError as error:
            raise _naming_kinds(error, given) from None
        if start is not self.start or goal is not self.goal:
            self._set(start=start, goal=goal)
        assign(self, "obstacles", given)
        assign(self, "_native", native)

    def _standing(self, walls: object) -> _hrsafety.StaticMap:
        """Return the native walls; the robot must not start in contact with them."""
        outline = self.robot.footprint
        if not isinstance(walls, StaticMap):
            walls = standing(checked_shapes("walls", walls))
            self._set(walls=walls)
        known = walls
        if outline is not None:
            if float(outline.clearance(known, [self.start], [self.heading])[0]) > 0.0:
                return known._native
            remedy = "the footprint overlaps them at this heading"
            raise InvalidParameterError("start", "not be in contact with the walls", self.start, remedy)
        gap = float(known.clearance(self.start)) - self.robot.radius
        if gap < 0.0:
            remedy = f"the bodies overlap by {-gap:.4f} m"
            raise InvalidParameterError("start", "not be in contact with the walls", self.start, remedy)
        return known._native

    def _rules(self) -> tuple[float, float, float, float, float]:
        """Return the numbers of a run in the order of the core, as floats."""
        period, limit, tolerance = self.control_period, self.time_limit, self.arrival_tolerance
        heading, rest = self.heading, self.rest_time
        if not type(period) is type(limit) is type(tolerance) is type(heading) is type(rest) is float:  # seldom
            checked = self._as_numbers("control_period", "time_limit", "arrival_tolerance", "heading", "rest_time")
            period, limit, tolerance, heading, rest = checked.values()
        return period, limit, tolerance, heading, rest

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why a run of the scenario may not mean what it seems to; found when first asked for."""
        if self._warnings is None:
            self._set(_warnings=scenario_warnings.found(self))
        return self._warnings  # type: ignore[return-value]  # just set

    @property
    def unit_doubts(self) -> tuple[ResultWarning, ...]:
        """Warnings about numbers that are hardly meant in their unit."""
        if self._units is None:
            self._set(_units=scenario_warnings.of_units(self))
        return self._units  # type: ignore[return-value]  # just set

    def __repr__(self) -> str:
        """Return the fields, and the warnings if there are any."""
        shown = ", ".join(f"{each.name}={getattr(self, each.name)!r}" for each in fields(self) if each.repr)
        return "\n".join([f"Scenario({shown})", *map(str, self.warnings)])


def _naming_kinds(error: InvalidParameterError, obstacles: Sequence[Obstacle]) -> InvalidParameterError:
    """Return an error whose rule says of what kind the obstacle is that it names by its index."""

    def named(found: re.Match[str]) -> str:
        return f"{found[0]} ({type(obstacles[int(found[1])]).__name__})"

    rule = re.sub(r"obstacles\[(\d+)\]", named, error.requirement)
    return InvalidParameterError(error.argument, rule, error.value, error.remedy)


class _Given(list[Obstacle]):
    """Obstacles without the radii that were not given."""


def _as_given(
    robot: HolonomicRobot | DifferentialDriveRobot,
    obstacles: Iterable[Obstacle],
    control_period: float,
    measurement: Measurement | None,
) -> _Given:
    """Return the obstacles as they were given; those with clearances get radii, which the core takes."""
    found = _Given(sequence("obstacles", "be a sequence of obstacles", obstacles))
    for index, obstacle in enumerate(found):
        if not isinstance(obstacle, Obstacle):
            instance(f"obstacles[{index}]", obstacle, Obstacle)
        given = getattr(obstacle, "_given", obstacle)  # as `as_given`, in the loop of every construction
        if given.active_clearance is not None or given.critical_clearance is not None:
            radii = given.radii_from_clearances(robot.radius)
            sensing = None if measurement is None else measurement._native
            if len(radii) < 2:
                # Everything is checked already: the native function without the checks of `region_radii`.
                critical, active = _hrsafety.region_radii(
                    robot._native, given._native, control_period, None, None, None, sensing
                )
                radii = {"critical_radius": critical, "active_radius": active, **radii}
            given = given.filled_in(**radii)
        if given is not obstacle:
            found[index] = given
    return found


def _with_radii(given: Obstacle, regions: tuple[float, float]) -> Obstacle:
    """Return an obstacle with the radii of its regions filled in."""
    if given.active_radius is None or given.critical_radius is None:
        return given._sized(*regions)
    return given


_SLOT: Any = Scenario.obstacles  # type: ignore[misc]  # a slot is found by its class


class _FilledIn:
    """The obstacles of a scenario, a tuple with the radii that the core has found.

    They are filled in when they are read: a study that constructs scenarios to run them would
    copy every obstacle for nothing.
    """

    __set__ = _SLOT.__set__  # as it is

    def __get__(self, scenario: Scenario | None, kind: type | None = None) -> object:
        if scenario is None:
            return self
        found = _SLOT.__get__(scenario)
        if isinstance(found, _Given):
            found = tuple(map(_with_radii, found, scenario._native.regions()))
            _SLOT.__set__(scenario, found)
        return found


Scenario.obstacles = _FilledIn()  # type: ignore[assignment, misc]  # in place of its slot
