"""Discs that move, and people who walk or were recorded."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import field
from typing import Any, Self

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, assign, number, pair
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.obstacles.base import LIMITS, Obstacle
from hrsafety.navigation.obstacles.motions import Path, Segment, frozen_path, frozen_segments, moving_body

__all__ = ["Human", "MovingDisc"]


def _moving(obstacle: Human | MovingDisc, *, start: Pair, acceleration: Pair, default_max_speed: float | None) -> None:
    """Build the native counterpart of a round body that moves."""
    radius, velocity = number("radius", obstacle.radius), pair("velocity", obstacle.velocity)
    stop = None if obstacle.stop is None else pair("stop", obstacle.stop)
    if not (radius is obstacle.radius and velocity is obstacle.velocity and stop is obstacle.stop):
        obstacle._set(radius=radius, velocity=velocity, stop=stop)
    active, critical, speed = obstacle._limits()
    limits = (active, critical, default_max_speed if speed is None else speed)
    if obstacle.path is None and obstacle.segments is None:  # nearly always
        native = _hrsafety.Obstacle.moving((start, velocity, acceleration), stop, radius, limits)
    else:
        native = moving_body(obstacle, start, {"radius": radius, **dict(zip(LIMITS, limits, strict=True))})
    assign(obstacle, "_native", native)


@dataclass(frozen=True, kw_only=True, slots=True)
class MovingDisc(Obstacle):
    """A moving disc, for example another robot.

    Parameters
    ----------
    center : tuple of float
        Position (x, y) of the centre at time 0, in m.
    radius : float
        Radius in m.
    velocity, acceleration : tuple of float
        Velocity at time 0 in m/s and constant acceleration in m/s^2.
    stop : tuple of float or None
        Where it comes to a sudden stop, in m; needs a velocity towards it and no acceleration.
    active_radius, critical_radius : float or None
        Radii r_2 and r_3 of the active and critical region, in m; computed when ``None``.
    active_clearance, critical_clearance : float or None
        The same regions measured between the surfaces of obstacle and robot, in m; instead of the
        radii.
    max_speed : float or None
        Speed that the regions are sized for, in m/s; the largest initial speed of any segment
        of the motion when ``None``.
    segments, path : tuple or None
        Set by `from_segments` and `from_path`.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, the radius is not positive, ``stop`` does not lie ahead, or
        active_radius is not larger than critical_radius.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.MovingDisc(center=(3.0, 4.0), radius=0.2, velocity=(0.0, -0.5)).velocity
    (0.0, -0.5)
    """

    center: Pair
    radius: float
    velocity: Pair
    acceleration: Pair = (0.0, 0.0)
    stop: Pair | None = None
    active_radius: float | None = None
    critical_radius: float | None = None
    active_clearance: float | None = None
    critical_clearance: float | None = None
    max_speed: float | None = None
    segments: tuple[Segment, ...] | None = None
    path: Path | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        center, acceleration = pair("center", self.center), pair("acceleration", self.acceleration)
        if not (center is self.center and acceleration is self.acceleration):
            self._set(center=center, acceleration=acceleration)
        if self.path is None and not (math.isfinite(center[0]) and math.isfinite(center[1])):
            raise InvalidParameterError("center", "be finite", center)
        _moving(self, start=center, acceleration=acceleration, default_max_speed=None)

    @classmethod
    def from_path(cls, time: npt.ArrayLike, position: npt.ArrayLike, *, radius: float, **fields: Any) -> Self:
        """Return a disc that follows a recording; see `Human.from_path`."""
        path = frozen_path(time, position)
        return cls(center=path[1][0], velocity=(0.0, 0.0), radius=radius, path=path, **fields)

    @classmethod
    def from_segments(
        cls,
        start: Pair,
        segments: Iterable[tuple[float, Sequence[float], Sequence[float]]],
        *,
        radius: float,
        **fields: Any,
    ) -> Self:
        """Return a disc with piecewise constant acceleration; see `Human.from_segments`."""
        frozen = frozen_segments(segments)
        velocity = frozen[0][1] if frozen else (0.0, 0.0)
        return cls(center=start, velocity=velocity, radius=radius, segments=frozen, **fields)


@dataclass(frozen=True, kw_only=True, slots=True)
class Human(Obstacle):
    """A walking person, modelled as a disc.

    Parameters
    ----------
    start : tuple of float
        Position (x, y) at time 0, in m.
    velocity : tuple of float
        Walking velocity in m/s.
    stop : tuple of float or None
        Where the person comes to a sudden stop, in m; must lie ahead of ``start`` along
        ``velocity``. ``None``: walks on for ever.
    radius : float
        Radius in m; the default is half an average step of 0.8 m.
    active_radius, critical_radius : float or None
        Radii r_2 and r_3 of the active and critical region, in m; computed when ``None``.
    active_clearance, critical_clearance : float or None
        The same regions measured between the surfaces of obstacle and robot, in m; instead of the
        radii.
    max_speed : float or None
        Speed that the regions are sized for, in m/s; 1.0 when ``None``.
    segments, path : tuple or None
        Set by `from_segments` and `from_path`.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, the radius is not positive, ``stop`` does not lie ahead, or
        active_radius is not larger than critical_radius.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Human(start=(0.6, 0.6), velocity=(1.0, 0.0), stop=(4.0, 0.6)).radius
    0.4
    """

    start: Pair
    velocity: Pair
    stop: Pair | None = None
    radius: float = 0.4
    active_radius: float | None = None
    critical_radius: float | None = None
    active_clearance: float | None = None
    critical_clearance: float | None = None
    max_speed: float | None = None
    segments: tuple[Segment, ...] | None = None
    path: Path | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._converted(start=pair("start", self.start))
        _moving(self, start=self.start, acceleration=(0.0, 0.0), default_max_speed=1.0)

    @classmethod
    def from_path(cls, time: npt.ArrayLike, position: npt.ArrayLike, **fields: Any) -> Self:
        """Return a person who follows a recording.

        Between samples the position is linear and the velocity that of the segment; the
        acceleration is zero. Before the first and after the last sample the person is absent.

        Parameters
        ----------
        time : array_like, shape (n,)
            Instants in s, strictly increasing.
        position : array_like, shape (n, 2)
            Positions in m.
        **fields
            ``radius``, ``active_radius``, ``critical_radius``, ``active_clearance``,
            ``critical_clearance``, ``max_speed``.

        Returns
        -------
        Human
            The recorded person.

        Raises
        ------
        InvalidParameterError
            If the recording is empty, not finite or not strictly increasing in time.
        ShapeError
            If the arrays do not fit together.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> person = nav.Human.from_path([0.0, 0.4, 0.8], [[0, 0], [0.5, 0], [1.0, 0.1]])
        >>> person.start
        (0.0, 0.0)
        """
        path = frozen_path(time, position)
        return cls(start=path[1][0], velocity=(0.0, 0.0), path=path, **fields)

    @classmethod
    def from_segments(
        cls, start: Pair, segments: Iterable[tuple[float, Sequence[float], Sequence[float]]], **fields: Any
    ) -> Self:
        """Return a person whose acceleration is piecewise constant.

        Parameters
        ----------
        start : tuple of float
            Position at time 0, in m.
        segments : iterable of (duration, velocity, acceleration)
            Duration in s, velocity at the start of the segment in m/s, acceleration in m/s^2.
            After the last segment the velocity reached is kept.
        **fields
            ``radius``, ``active_radius``, ``critical_radius``, ``active_clearance``,
            ``critical_clearance``, ``max_speed``.

        Returns
        -------
        Human
            The person.

        Raises
        ------
        InvalidParameterError
            If there is no segment, a duration is not positive or a value is not finite.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> stops = nav.Human.from_segments(
        ...     (0.6, 0.0), [(1.0, (1.0, 0.0), (0.0, 0.0)), (1.0, (1.0, 0.0), (-1.0, 0.0))]
        ... )
        >>> len(stops.segments)
        2
        """
        frozen = frozen_segments(segments)
        velocity = frozen[0][1] if frozen else (0.0, 0.0)
        return cls(start=start, velocity=velocity, segments=frozen, **fields)
