"""A scenario: robot, start, goal, obstacles and the rules of the run."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from typing import Literal, NamedTuple

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, Parameters, number, pair, sequence, with_article
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.obstacles import Obstacle
from hrsafety.navigation.robots import DifferentialDriveRobot, HolonomicRobot
from hrsafety.plausibility import ResultWarning

__all__ = ["Measurement", "Regions", "Scenario", "region_radii"]


class Regions(NamedTuple):
    """Radii of the regions of one obstacle.

    Attributes
    ----------
    critical_radius : float
        Radius r_3 of the critical region, in m.
    active_radius : float
        Radius r_2 of the active region, in m.
    """

    critical_radius: float
    active_radius: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Measurement(Parameters):
    """Noisy and late positions, measured once a control period; velocities are backward differences.

    What is measured at time t is the position at ``t - latency`` plus the noise. Obstacles at rest
    are known exactly. The noise is drawn from the seed of the scenario, one stream for the robot and
    one for each obstacle.

    Before time 0 the robot stood at its start, and an obstacle moved as the first piece of its
    motion says, run backwards: straight at its velocity, on its parabola if it accelerates, as
    recorded if the recording begins earlier. One that was absent ``latency`` ago is not seen yet,
    and one that has left since is still seen.

    Parameters
    ----------
    scale : float
        Half width of the uniform error of x and y each, or its standard deviation for
        ``"gaussian"``, in m.
    distribution : {"uniform", "gaussian"}
        Kind of error. A Gaussian error is drawn again beyond 8 standard deviations, so it is
        bounded; a scale of 0.0032 m has the mean error of 4 mm of the source's camera.
    of : {"obstacles", "robot", "both"}
        Which positions are noisy and late: those of moving obstacles, that of the robot, or both.
    latency : float
        Age of the measured positions, in s, at most 60.

    Raises
    ------
    InvalidParameterError
        If scale or latency is negative or not finite, latency is above 60 s, or a word is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Measurement(scale=0.025).distribution
    'uniform'
    """

    scale: float = 0.025
    distribution: Literal["uniform", "gaussian"] = "uniform"
    of: Literal["obstacles", "robot", "both"] = "obstacles"
    latency: float = 0.0
    _native: _hrsafety.Measurement = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers("scale", "latency")
        self._set(_native=_hrsafety.Measurement(distribution=self.distribution, of=self.of, **values))


@dataclass(frozen=True, kw_only=True, slots=True)
class Scenario(Parameters):
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

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range, the robot would start in contact with an
        obstacle, the goal lies in the active region of a stationary obstacle, start and goal are
        within the arrival tolerance, or a critical radius is below the distance at which robot and
        obstacle touch.

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
    robot: HolonomicRobot | DifferentialDriveRobot = field(default_factory=HolonomicRobot)
    control_period: float = 0.06
    time_limit: float = 60.0
    arrival_tolerance: float = 0.12
    heading: float = 0.0
    rest_time: float = 5.0
    measurement: Measurement | None = None
    seed: int = 0
    _native: _hrsafety.Scenario = field(init=False, repr=False, compare=False)
    _warnings: tuple[ResultWarning, ...] | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check the values and compute the regions that were not given."""
        self._set(start=pair("start", self.start), goal=pair("goal", self.goal))
        numbers = ("control_period", "time_limit", "arrival_tolerance", "heading", "rest_time")
        values = {name: number(name, getattr(self, name)) for name in numbers}
        self._set(**values)
        _require("robot", self.robot, HolonomicRobot, DifferentialDriveRobot)
        if self.measurement is not None:
            _require("measurement", self.measurement, Measurement)
        if isinstance(self.seed, bool) or not isinstance(self.seed, int) or not 0 <= self.seed < 2**64:
            raise InvalidParameterError("seed", "be an integer from 0 to 2**64 - 1", self.seed)
        obstacles = _with_regions(self.robot, self.obstacles, self.control_period, self.measurement)
        try:
            native = _hrsafety.Scenario(
                robot=self.robot._native,
                start=self.start,
                goal=self.goal,
                obstacles=[obstacle._native for obstacle in obstacles],
                measurement=None if self.measurement is None else self.measurement._native,
                seed=self.seed,
                **values,
            )
        except InvalidParameterError as error:
            raise _naming_kinds(error, obstacles) from None
        self._set(obstacles=obstacles, _native=native)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why a run of the scenario may not mean what it seems to; found when first asked for."""
        if self._warnings is None:
            from hrsafety.navigation import scenario_warnings  # which needs this module

            self._set(_warnings=scenario_warnings.found(self))
        return self._warnings  # type: ignore[return-value]  # just set

    def __repr__(self) -> str:
        """Return the fields, and the warnings if there are any."""
        shown = ", ".join(f"{each.name}={getattr(self, each.name)!r}" for each in fields(self) if each.repr)
        return "\n".join([f"Scenario({shown})", *map(str, self.warnings)])


def _require(name: str, value: object, *kinds: type) -> None:
    if not isinstance(value, kinds):
        words = " or ".join(kind.__name__ for kind in kinds)
        raise InvalidParameterError(name, f"be {with_article(words)}", value)


def _naming_kinds(error: InvalidParameterError, obstacles: tuple[Obstacle, ...]) -> InvalidParameterError:
    """Return an error whose rule says of what kind the obstacle is that it names by its index."""

    def named(found: re.Match[str]) -> str:
        return f"{found[0]} ({type(obstacles[int(found[1])]).__name__})"

    rule = re.sub(r"obstacles\[(\d+)\]", named, error.requirement)
    return InvalidParameterError(error.argument, rule, error.value, error.remedy)


def _with_regions(
    robot: HolonomicRobot | DifferentialDriveRobot,
    obstacles: Iterable[Obstacle],
    control_period: float,
    measurement: Measurement | None,
) -> tuple[Obstacle, ...]:
    """Return the obstacles with every region radius filled in."""
    complete = []
    sensing = None if measurement is None else measurement._native
    for index, obstacle in enumerate(sequence("obstacles", "be a sequence of obstacles", obstacles)):
        _require(f"obstacles[{index}]", obstacle, Obstacle)
        given = getattr(obstacle, "_given", obstacle)  # as `as_given`, in the loop of every construction
        if None in (given.active_radius, given.critical_radius):
            radii = given.radii_from_clearances(robot.radius)
            if len(radii) < 2:
                # Everything is checked already: the native function without the checks of `region_radii`.
                critical, active = _hrsafety.region_radii(
                    robot._native, given._native, control_period, None, None, None, sensing
                )
                radii = {"critical_radius": critical, "active_radius": active, **radii}
            obstacle = given.filled_in(**radii)
        complete.append(obstacle)
    return tuple(complete)


def region_radii(
    robot: HolonomicRobot | DifferentialDriveRobot,
    obstacle: Obstacle,
    control_period: float = 0.06,
    faced_side: float | None = None,
    *,
    latency: float | None = None,
    position_error: float | None = None,
    measurement: Measurement | None = None,
) -> Regions:
    """Return the smallest safe regions of an obstacle, Zeng (2011), section 5.3.

    The robot stops within ``delta_r = V T_s + a dt1^2 / 2`` with ``dt1 = V/a``, while a moving
    obstacle comes ``delta_o = V_o (dt1 + T_s)`` closer::

        disc, person   r_3 = delta_r + delta_o + rho_o + rho_r + delta
                       r_2 = (V + V_o) (dt2 + T_s) + delta,   dt2 = (r_3 - a t_a^2 / 2)/V + t_a
        rectangle      r_3 = delta_r + rho_r + delta
                       r_2 = V (dt2 + T_s) + delta,   dt2 = (r_3 + B - a t_a^2 / 2)/V + t_a

    with ``t_a = V/a`` and B half the side that is faced. A differential-drive robot needs
    ``sqrt(pi / alpha_max)`` more for the turn.

    ``delta`` is not in the source, which knows positions exactly: the most by which the known
    distance can exceed the true one. A measured body has gone ``speed * latency`` since, at most V_o
    an obstacle and V the robot, and each measured position errs by at most ``sqrt(2) scale`` with
    uniform and ``8 scale`` with Gaussian noise. Obstacles at rest are known exactly; their delta is
    above 0 where the robot's own position is measured. It bounds the distance and not the velocity:
    a robot that measures its own position brakes against a velocity that is noisy and late, too.

    Parameters
    ----------
    robot : HolonomicRobot or DifferentialDriveRobot
        Its limits.
    obstacle : Obstacle
        Radii that the obstacle has already are not looked at.
    control_period : float
        Control period T_s in s.
    faced_side : float or None
        Side of a rectangle that the robot faces, in m; the longer one when ``None``.
    latency : float or None
        Age of the measured positions in s; that of ``measurement`` when ``None``. Without a
        measurement it is the age of the obstacle's position.
    position_error : float or None
        Largest error of the measured distance in m, whoever is measured; the bound that follows from
        ``measurement`` when ``None``.
    measurement : Measurement or None
        How positions are measured; exactly when ``None``. A `Scenario` uses its own.

    Returns
    -------
    Regions
        critical_radius and active_radius in m.

    Raises
    ------
    InvalidParameterError
        If a value is not finite and positive, latency or position_error is negative, or faced_side
        is given for a round obstacle.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> radii = nav.region_radii(nav.HolonomicRobot(), nav.Human(start=(0, 0), velocity=(1, 0)))
    >>> [round(radius, 4) for radius in radii]
    [0.7965, 2.0959]
    >>> late = nav.region_radii(
    ...     nav.HolonomicRobot(), nav.Human(start=(0, 0), velocity=(1, 0)), latency=0.1, position_error=0.03
    ... )
    >>> [round(radius, 4) for radius in late]
    [0.9265, 2.5416]
    """
    _require("robot", robot, HolonomicRobot, DifferentialDriveRobot)
    _require("obstacle", obstacle, Obstacle)
    if measurement is not None:
        _require("measurement", measurement, Measurement)
    critical, active = _hrsafety.region_radii(
        robot._native,
        obstacle._native,
        number("control_period", control_period),
        _number_or_none("faced_side", faced_side),
        _number_or_none("latency", latency),
        _number_or_none("position_error", position_error),
        None if measurement is None else measurement._native,
    )
    return Regions(critical, active)


def _number_or_none(name: str, value: object) -> float | None:
    return None if value is None else number(name, value)
