"""A shield around any law: it never lets the robot move into anybody."""

from __future__ import annotations

import math
from dataclasses import field

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, instance, not_negative, number, numbers, pair, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.laws.unseen import Unseen

__all__ = ["Shield", "ShieldDecision", "speed_bound"]


_HUGE = 1e150
"""Vectors that are longer have no square."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class ShieldDecision:
    """Decision of a shield about a wanted velocity.

    Parameters
    ----------
    velocity : ndarray, shape (2,)
        Velocity in m/s that is commanded.
    status : str
        ``"kept"``, ``"changed"`` or ``"braking"``; ``"not_guaranteed"`` in place of the first two where a person is
        `faster`.
    wanted_gap, gap : float
        Least distance in m between the half disc ahead of the robot and everywhere that people can be,
        over the plans behind the wanted velocity, as far as it is reached, and behind the commanded one;
        infinite without people.
    faster : tuple of int
        Which people were measured to be faster than the shield assumes: what it guarantees does not hold for
        them.
    """

    velocity: Array
    status: str
    wanted_gap: float
    gap: float
    faster: tuple[int, ...] = ()


@dataclass(frozen=True, kw_only=True, slots=True)
class Shield(Parameters):
    """Passive safety around any law, whatever people do within their bounds.

    Whenever robot and person touch, the robot rests or does not move toward the person. A velocity is
    commanded only if the plan behind it is verified: take it up within a control period, then brake to
    rest, while the half disc ahead stays clear of everywhere that people can be by then. If the wanted
    velocity is not, the nearest verified one is searched; if none is found, the rest of the last verified
    plan is executed. Being walked into while standing remains possible.

    Parameters
    ----------
    person_speed : float or None
        Largest speed of people in m/s; 1.6 m/s is that of ISO 13855. ``None``: that of each
        obstacle of the scene, without a bound for one that accelerates: then the robot stays where it is
        unless velocities are bounded. What never moves in a scene is taken to stand.
    latency : float
        Largest age of a measured position when the command takes effect, in s.
    position_error : float
        Largest error of a measured position in m, its length in the plane.
    velocity_error, person_acceleration : float or None
        Largest error of a measured velocity in m/s and largest acceleration of people in m/s^2. Both or
        neither: without them nothing is assumed of velocities.
    margin : float
        Error of the robot's own pose and of its motion, in m: half a motion step at the largest
        acceleration for a control period, and what its localization adds.
    wall_margin : float
        Distance that is kept from walls, in m.
    position_tracking : float or None
        Largest distance of the robot from the plan that it executes, in m, beside ``margin``; ``None``: ``margin``
        covers it, too.
    velocity_tracking : (float, float)
        Largest difference between the velocity of the robot and that of its plan: so many m/s, and so large a
        share of the planned speed. The default is a base whose zero is exact and that follows to 2 %.
    reaction_time, person_deceleration : float or None
        Passive friendly safety: people are left the way in which they stop, ``v t_r + v^2/(2 b)``.
        Both or neither, in s and m/s^2.
    unseen : Unseen or None
        Whether it reckons with people who are not seen, and what it assumes of them; the law then needs a map.

    Raises
    ------
    InvalidParameterError
        If a number is negative or not finite, or one of two that belong together is missing.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(person_speed=1.0))
    >>> run = nav.simulate(scenarios.configuration("c2"), law)
    >>> run.contacts_moving
    0
    """

    person_speed: float | None = 1.6
    latency: float = 0.0
    position_error: float = 0.0
    velocity_error: float | None = None
    person_acceleration: float | None = None
    margin: float = 0.005
    wall_margin: float = 0.005
    position_tracking: float | None = None
    velocity_tracking: tuple[float, float] = (0.0, 0.02)
    reaction_time: float | None = None
    person_deceleration: float | None = None
    unseen: Unseen | None = None
    _native: _hrsafety.Shield = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._as_numbers("latency", "position_error", "margin", "wall_margin")
        optional = (
            "person_speed",
            *("velocity_error", "person_acceleration"),
            *("reaction_time", "person_deceleration"),
        )
        for name in optional:
            value = getattr(self, name)
            self._set(**{name: None if value is None else number(name, value)})
        for one, other in (optional[1:3], optional[3:5]):
            if (getattr(self, one) is None) != (getattr(self, other) is None):
                missing, given = (one, other) if getattr(self, one) is None else (other, one)
                raise InvalidParameterError(missing, f"be given with {given}", None)
        values = {name: getattr(self, name) for name in (*optional, "latency", "position_error")}
        if self.position_tracking is not None:
            self._set(position_tracking=number("position_tracking", self.position_tracking))
        self._set(velocity_tracking=pair("velocity_tracking", self.velocity_tracking))
        values |= {name: getattr(self, name) for name in ("margin", "wall_margin", "velocity_tracking")}
        if self.unseen is not None:
            instance("unseen", self.unseen, Unseen)
        values["unseen"] = None if self.unseen is None else self.unseen._native
        self._set(_native=_hrsafety.Shield(**values, position_tracking=self.position_tracking or 0.0))

    def decide(
        self,
        wanted: npt.ArrayLike,
        *,
        velocity: npt.ArrayLike,
        people: npt.ArrayLike,
        position: npt.ArrayLike = (0.0, 0.0),
        person_radius: float = 0.4,
        person_velocity: npt.ArrayLike | None = None,
        radius: float = 0.2,
        max_speed: float = 0.7,
        max_acceleration: float = 10.0,
        control_period: float = 0.06,
    ) -> ShieldDecision:
        """Return what the shield makes of a wanted velocity at one instant.

        Parameters
        ----------
        wanted : array_like of shape (2,)
            Wanted velocity in m/s.
        velocity, position : array_like of shape (2,)
            Of the robot, in m/s and m.
        people : array_like of shape (n, 2)
            Measured positions in m.
        person_radius : float
            Radius of everybody in m.
        person_velocity : array_like of shape (n, 2) or None
            Measured velocities in m/s; they count with ``velocity_error`` only.
        radius, max_speed, max_acceleration, control_period : float
            Of the robot, in m, m/s, m/s^2 and s.

        Returns
        -------
        ShieldDecision
            Velocity, status and gaps.

        Raises
        ------
        InvalidParameterError
            If a number is out of range, or the speed of people is not given.
        ShapeError
            If an array has another shape.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> decision = nav.Shield(person_speed=1.0).decide(
        ...     (0.078256, 0.2163), velocity=(0, 0), people=[(0.560601, 0.553135)], radius=0.3
        ... )
        >>> decision.status, round(decision.wanted_gap, 3)
        ('changed', -0.05)
        """
        if self.person_speed is None:
            raise InvalidParameterError("person_speed", "be given where there is no scene", None)
        if self.unseen is not None:
            remedy = "ask a SafeNavigation or a Controller with a map"
            raise InvalidParameterError("unseen", "be None where there is no map", self.unseen, remedy)
        limits = [
            positive(name, value)
            for name, value in (
                ("radius", radius),
                ("max_speed", max_speed),
                ("max_acceleration", max_acceleration),
                ("control_period", control_period),
            )
        ]
        centers = _rows("people", people)
        speeds = np.full_like(centers, np.nan)
        if person_velocity is not None:
            speeds = _rows("person_velocity", person_velocity, len(centers))
        size = positive("person_radius", person_radius)
        found, status, gaps = self._native.decide(
            (limits[0], limits[1], limits[2], limits[3]),
            (_vector("position", position), _vector("velocity", velocity)),
            _vector("wanted", wanted),
            [(_pair(center), size, _pair(speed)) for center, speed in zip(centers, speeds, strict=True)],
        )
        most = self.person_speed + (self.velocity_error or 0.0)
        faster = tuple(index for index, speed in enumerate(speeds.tolist()) if math.hypot(*speed) > most)
        if faster and status != "braking":
            status = "not_guaranteed"
        return ShieldDecision(velocity=np.array(found), status=status, wanted_gap=gaps[0], gap=gaps[1], faster=faster)


def speed_bound(gap: float, angle: float, *, deceleration: float, person_speed: float) -> float:
    """Return the largest safe speed toward one person, in closed form.

    ``2 a g/(v + sqrt(v^2 + 2 a g cos theta))``; straight toward a person ``sqrt(v^2 + 2 a g) - v``.

    Parameters
    ----------
    gap : float
        Free distance g in m, not negative.
    angle : float
        Angle theta between the velocity and the direction to the person, in rad.
    deceleration : float
        Deceleration a of the robot in m/s^2.
    person_speed : float
        Speed v of the person in m/s.

    Returns
    -------
    float
        Speed in m/s; infinite where there is no limit.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> round(nav.laws.speed_bound(0.357869627, 0.879100347, deceleration=3.0, person_speed=1.0), 10)
    0.8455785603
    """
    theta = number("angle", angle)
    if not math.isfinite(theta):
        raise InvalidParameterError("angle", "be finite", angle)
    found = _hrsafety.shield_speed_bound(
        not_negative("gap", gap),
        theta,
        positive("deceleration", deceleration),
        not_negative("person_speed", person_speed),
    )
    return math.inf if math.isnan(found) else found


def _vector(name: str, value: npt.ArrayLike) -> tuple[float, float]:
    array = numbers(name, value, "be two numbers (x, y)")
    if array.shape != (2,):
        raise ShapeError(name, "(2,)", array.shape)
    if not math.hypot(*array) < _HUGE:
        raise InvalidParameterError(name, f"be finite and shorter than {_HUGE:g}", array.tolist())
    return _pair(array)


def _pair(row: Array) -> tuple[float, float]:
    x, y = row.tolist()
    return x, y


def _rows(name: str, value: npt.ArrayLike, count: int | None = None) -> Array:
    array = numbers(name, value, "be pairs of numbers (x, y)")
    if array.size == 0:
        array = array.reshape(0, 2)
    if array.ndim != 2 or array.shape[1] != 2 or (count is not None and len(array) != count):
        raise ShapeError(name, "(n, 2)" if count is None else f"({count}, 2)", array.shape)
    if not np.isfinite(array).all():
        raise InvalidParameterError(name, "be finite", array.tolist())
    return array
