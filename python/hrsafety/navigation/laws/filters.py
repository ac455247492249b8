"""Safety filters of the field: the permitted velocity nearest to a wanted one, in the place of a shield."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field, fields
from types import MappingProxyType
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, number, numbers, pair, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plausibility import ResultWarning

__all__ = [
    "FILTERS",
    "FILTER_INFEASIBLE",
    "ApproachMonitor",
    "Barrier",
    "BarrierUnicycle",
    "CollisionCone",
    "FilterDecision",
    "ResponsibilityRule",
    "SafetyFilter",
    "VelocityClamp",
]

FILTER_INFEASIBLE = "filter_infeasible"


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FilterDecision:
    """Decision of a filter about a wanted velocity.

    Parameters
    ----------
    velocity : ndarray, shape (2,)
        Velocity in m/s; of `BarrierUnicycle` speed in m/s and turn rate in rad/s.
    status : str
        ``"kept"``; ``"changed"``, as the rule asks; ``"infeasible"``, where nothing obeys the rule and the violation is
        least; ``"touching"``, where somebody is within the distance that is kept, and the robot brakes; ``"stopped"``,
        where no share of the wanted velocity is safe.
    slack : float
        By how much all half-planes of the rule are given up where it is infeasible, in m/s; of `CollisionCone` in
        m/s^2. NaN where the limits of the robot themselves contradict each other, and it brakes.
    share : float
        Share of the wanted velocity that `VelocityClamp` and `ApproachMonitor` let through; of others 1.
    """

    velocity: Array
    status: str
    slack: float
    share: float

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts of the decision: a rule that no velocity obeys, with the code ``"filter_infeasible"``."""
        if str(self.status) not in ("infeasible", "touching", "stopped"):
            return ()
        by = f", by at least {self.slack:.3g}" if self.status == "infeasible" else ""
        message = f"the rule of the filter is not obeyed ({self.status}){by}: it promises nothing at this instant"
        return (ResultWarning(FILTER_INFEASIBLE, "velocity", message),)


class SafetyFilter(Parameters):
    """Base of the filters. None is a shield: what each assumes of people stands with it, and no plan is verified.

    Attributes
    ----------
    NAME : str
        Name of the filter.
    LOOKS_AT_WALLS : bool
        Whether it keeps off what stands.
    """

    __slots__ = ("_native",)
    NAME: ClassVar[str]
    LOOKS_AT_WALLS: ClassVar[bool] = False
    _native: _hrsafety.SafetyFilter

    def __post_init__(self) -> None:
        """Check the values."""
        names = [each.name for each in fields(self) if each.init]  # type: ignore[arg-type]  # all are dataclasses
        self._set(_native=_hrsafety.SafetyFilter(self.NAME, **self._as_numbers(*names)))

    def decide(
        self,
        wanted: npt.ArrayLike,
        *,
        velocity: npt.ArrayLike,
        people: npt.ArrayLike,
        points: npt.ArrayLike = (),
        position: npt.ArrayLike = (0.0, 0.0),
        heading: float = 0.0,
        turn_rate: float = 0.0,
        radius: float = 0.25,
        max_speed: float = 1.0,
        max_acceleration: float | None = None,
        max_turn_rate: float = 1.5,
        control_period: float = 0.1,
    ) -> FilterDecision:
        """Return what the filter makes of a wanted velocity at one instant.

        Parameters
        ----------
        wanted : array_like of shape (2,)
            Wanted velocity in m/s; of `BarrierUnicycle` speed in m/s and turn rate in rad/s.
        velocity, position : array_like of shape (2,)
            Of the robot, in m/s and m.
        people : array_like of shape (n, 5)
            Rows (x, y, vx, vy, radius) as measured, in m and m/s.
        points : array_like of shape (k, 2)
            Nearest points of what stands, in m, for the barriers.
        heading : float
            Of the robot, in rad.
        turn_rate : float
            Wanted turn rate in rad/s, for `ApproachMonitor`.
        radius, max_speed, max_turn_rate, control_period : float
            Of the robot, in m, m/s, rad/s and s.
        max_acceleration : float or None
            In m/s^2; ``None``: `Barrier` has no bound of the change, the cone none of its accelerations.

        Returns
        -------
        FilterDecision
            Velocity, status and doubts.

        Raises
        ------
        InvalidParameterError
            If a number is out of range.
        ShapeError
            If an array has another shape.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.Barrier().decide((1, 0), velocity=(1, 0), people=[(1, 0, -0.5, 0, 0.25)]).status
        'changed'
        """
        limits = (
            positive("radius", radius),
            positive("max_speed", max_speed),
            None if max_acceleration is None else positive("max_acceleration", max_acceleration),
            positive("max_turn_rate", max_turn_rate),
            positive("control_period", control_period),
        )
        asked = (*(_vector(name, each) for name, each in (("position", position), ("velocity", velocity))),)
        state = (asked[0], asked[1], _finite("heading", heading))
        rows = [((x, y), r, (vx, vy)) for x, y, vx, vy, r in _rows("people", people, 5)]
        for index, (_, size, _) in enumerate(rows):
            if size < 0.0:
                raise InvalidParameterError(f"people[{index}]", "have a radius of 0 or more", size)
        stands = [(x, y) for x, y in _rows("points", points, 2)]
        wish = _vector("wanted", wanted), _finite("turn_rate", turn_rate)
        found, status, (slack, share) = self._native.decide(limits, state, wish, rows, stands)
        return FilterDecision(velocity=np.array(found), status=status, slack=slack, share=share)


def _finite(name: str, value: object) -> float:
    checked = number(name, value)
    if not math.isfinite(checked):
        raise InvalidParameterError(name, "be finite", value)
    return checked


def _vector(name: str, value: npt.ArrayLike) -> tuple[float, float]:
    x, y = pair(name, value)
    return _finite(name, x), _finite(name, y)


def _rows(name: str, value: npt.ArrayLike, width: int) -> list[list[float]]:
    rows = numbers(name, value)
    if rows.size == 0:
        return []
    if rows.ndim != 2 or rows.shape[1] != width:
        raise ShapeError(name, f"(n, {width})", rows.shape)
    if not np.isfinite(rows).all():
        raise InvalidParameterError(name, "be finite", value)
    found: list[list[float]] = rows.tolist()
    return found


@dataclass(frozen=True, kw_only=True, slots=True)
class Barrier(SafetyFilter):
    """Control barrier function of a robot that takes up any velocity at once.

    ``h = (d^2 - R^2)/2`` of the distance of the centers and the sum of radii and margin falls at most by ``rate h``;
    the same of the distance from what stands. It assumes that people keep their velocities, are measured exactly, and
    that the velocity is reached at once; where that holds and a velocity obeys all, nobody is touched.

    Parameters
    ----------
    rate : float
        Rate in 1/s.
    margin : float
        Distance that is kept between the surfaces, in m.

    Raises
    ------
    InvalidParameterError
        If the rate is not positive, or the margin negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.SafeNavigation(nav.VirtualForceField(), filter=nav.Barrier(rate=2.0)).filter.rate
    2.0
    """

    NAME: ClassVar[str] = "barrier"
    LOOKS_AT_WALLS: ClassVar[bool] = True
    rate: float = 1.0
    margin: float = 0.0
    _native: _hrsafety.SafetyFilter = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class BarrierUnicycle(SafetyFilter):
    """`Barrier` of a point ahead of the axle of a robot with two wheels, with the radius larger by as much.

    It assumes the same as `Barrier`, and bounds speed and turn rate. The law's velocity is taken for that of the point.

    Parameters
    ----------
    rate : float
        Rate in 1/s.
    ahead : float
        Distance of the point from the middle of the axle, in m.
    margin : float
        Distance that is kept between the surfaces, in m.

    Raises
    ------
    InvalidParameterError
        If rate or distance is not positive, or the margin negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> person = (0.9, 0.0, -0.5, 0.0, 0.25)
    >>> nav.BarrierUnicycle().decide((1.0, 0.0), velocity=(1, 0), people=[person]).status
    'changed'
    """

    NAME: ClassVar[str] = "barrier_unicycle"
    LOOKS_AT_WALLS: ClassVar[bool] = True
    rate: float = 1.0
    ahead: float = 0.1
    margin: float = 0.0
    _native: _hrsafety.SafetyFilter = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class CollisionCone(SafetyFilter):
    """Control barrier function of the cone of relative velocities that lead to a contact, for accelerations.

    It assumes that people keep their velocities and are measured exactly. Somebody within the radii and the margin
    ends it: the robot brakes. It does not look at walls.

    Parameters
    ----------
    rate : float
        Rate in 1/s.
    margin : float
        Distance that is kept between the surfaces, in m.

    Raises
    ------
    InvalidParameterError
        If the rate is not positive, or the margin negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> person = (0.3, 0.0, 0.0, 0.0, 0.25)
    >>> nav.CollisionCone().decide((1, 0), velocity=(1, 0), people=[person], max_acceleration=3.0).status
    'touching'
    """

    NAME: ClassVar[str] = "collision_cone"
    rate: float = 1.0
    margin: float = 0.0
    _native: _hrsafety.SafetyFilter = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class VelocityClamp(SafetyFilter):
    """The largest share of the wanted velocity with which nobody who walks straight on is touched within a horizon.

    It assumes that people keep their velocities, are measured exactly, and that the velocity is reached at once.
    Where no share is safe the robot stops, which need not be safe either. It does not look at walls.

    Parameters
    ----------
    horizon : float
        Horizon in s.
    margin : float
        Distance that is kept between the surfaces, in m.

    Raises
    ------
    InvalidParameterError
        If the horizon is not positive, or the margin negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.VelocityClamp().decide((1, 0), velocity=(1, 0), people=[(2, 0, 0, 0, 0.25)]).share
    0.5
    """

    NAME: ClassVar[str] = "velocity_clamp"
    horizon: float = 3.0
    margin: float = 0.0
    _native: _hrsafety.SafetyFilter = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class ResponsibilityRule(SafetyFilter):
    """Responsibility-sensitive safety of Shalev-Shwartz and others (2017), on the line of the centers.

    The rule is the one for opposite directions.
    Where the gap is smaller than both need to stop, the robot brakes toward the person. It assumes the accelerations
    of both, and looks at nothing beside the line of the centers and at no walls. All values are choices.

    Parameters
    ----------
    reaction_time : float
        In s.
    acceleration, braking : float
        Of the robot within the reaction time, and after it, in m/s^2.
    person_acceleration, person_braking : float
        The same of people.
    margin : float
        Distance that is kept between the surfaces, in m.

    Raises
    ------
    InvalidParameterError
        If a braking is not positive, or another number negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.ResponsibilityRule().decide((1, 0), velocity=(0.5, 0), people=[(3, 0, 0, 0, 0.25)]).status
    'kept'
    """

    NAME: ClassVar[str] = "responsibility_rule"
    reaction_time: float = 0.2
    acceleration: float = 1.0
    braking: float = 2.0
    person_acceleration: float = 0.0
    person_braking: float = 1.5
    margin: float = 0.0
    _native: _hrsafety.SafetyFilter = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class ApproachMonitor(SafetyFilter):
    """Approach action of the collision monitor of Nav2: the command is scaled by the time to the first contact.

    It assumes that people stand, and looks at no walls here.

    Parameters
    ----------
    time_before_collision : float
        Time before a contact from which on the robot slows down, in s.
    simulation_time_step : float
        Time between two poses in s.
    margin : float
        Distance that is kept between the surfaces, in m.

    Raises
    ------
    InvalidParameterError
        If a time is not positive, the step below 1e-5 of the other one, or the margin negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> round(nav.ApproachMonitor().decide((1, 0), velocity=(1, 0), people=[(1.05, 0, 0, 0, 0.25)]).share, 3)
    0.417
    """

    NAME: ClassVar[str] = "approach_monitor"
    time_before_collision: float = 1.2
    simulation_time_step: float = 0.1
    margin: float = 0.0
    _native: _hrsafety.SafetyFilter = field(init=False, repr=False, compare=False)


FILTERS: Mapping[str, type[SafetyFilter]] = MappingProxyType(
    {
        kind.NAME: kind
        for kind in (Barrier, BarrierUnicycle, CollisionCone, VelocityClamp, ResponsibilityRule, ApproachMonitor)
    }
)
"""Filters by their names."""
