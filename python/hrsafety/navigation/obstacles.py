"""Obstacles: discs, rectangles, walking and recorded people, moving discs."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, Parameters, number, numbers, pair, points, sequence
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["Disc", "Human", "MovingDisc", "Obstacle", "Rectangle"]

Segment = tuple[float, Pair, Pair]
Path = tuple[tuple[float, ...], tuple[Pair, ...]]


class Obstacle(Parameters):
    """What all obstacles share: a radius of the active and of the critical region.

    Both radii may be left ``None``; a `Scenario` then computes them from the limits of its
    robot (see `region_radii`). Given radii must obey active > critical >= 0.
    """

    __slots__ = ()
    active_radius: float | None
    critical_radius: float | None
    _native: _hrsafety.Obstacle
    _given: Obstacle | None

    def as_given(self) -> Self:
        """Return the obstacle as it was before a scenario filled in the radii of its regions.

        Returns
        -------
        Obstacle
            The obstacle itself if no radius was filled in.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> scene = nav.Scenario(start=(4, 0), goal=(0, 0), obstacles=[nav.Disc(center=(2, 0), radius=0.1)])
        >>> scene.obstacles[0].as_given() == nav.Disc(center=(2, 0), radius=0.1)
        True
        """
        return self if self._given is None else self._given  # type: ignore[return-value]  # of the same class

    def filled_in(self, **radii: float) -> Self:
        """Return the obstacle with the radii that were not given.

        Parameters
        ----------
        **radii : float
            ``active_radius`` and ``critical_radius`` in m.

        Returns
        -------
        Obstacle
            A copy that remembers what was given.
        """
        missing = {name: value for name, value in radii.items() if getattr(self, name) is None}
        filled = dataclasses.replace(self, **missing)  # type: ignore[type-var]  # obstacles are dataclasses
        filled._set(_given=self)
        return filled

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by public fields; what a scenario filled in is filled in again."""
        if self._given is None:
            return super().__reduce__()
        radii = {name: getattr(self, name) for name in ("active_radius", "critical_radius")}
        return _filled_in, (self._given, radii)

    def _limits(self) -> dict[str, float | None]:
        limits = {}
        for name in ("active_radius", "critical_radius", "max_speed"):
            value = getattr(self, name)
            limits[name] = None if value is None else number(name, value)
        self._set(**limits)
        return limits


def _filled_in(given: Obstacle, radii: dict[str, float]) -> Obstacle:
    return given.filled_in(**radii)


@dataclass(frozen=True, kw_only=True, slots=True)
class Disc(Obstacle):
    """A disc that stands still.

    Parameters
    ----------
    center : tuple of float
        Position (x, y) of the centre, in m.
    radius : float
        Radius in m.
    active_radius, critical_radius : float or None
        Radii r_2 and r_3 of the active and critical region around the centre, in m; computed
        by the scenario when ``None``.
    max_speed : float or None
        Speed that the regions are sized for, in m/s; ``None`` means 0.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, a radius is not positive, or active_radius is not larger
        than critical_radius.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Disc(center=(2.45, 0.595), radius=0.1, active_radius=0.8, critical_radius=0.4).radius
    0.1
    """

    center: Pair
    radius: float
    active_radius: float | None = None
    critical_radius: float | None = None
    max_speed: float | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)
    _given: Obstacle | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(center=pair("center", self.center), radius=number("radius", self.radius))
        native = _hrsafety.Obstacle.disc(center=self.center, radius=self.radius, **self._limits())
        self._set(_native=native)


@dataclass(frozen=True, kw_only=True, slots=True)
class Rectangle(Obstacle):
    """A rectangle that stands still, at any heading.

    Its regions are measured from the contour, not from the centre.

    Parameters
    ----------
    center : tuple of float
        Position (x, y) of the centroid, in m.
    length, width : float
        Sides in m; ``length`` lies along ``heading``.
    heading : float
        Angle of the length to the x axis, in rad.
    active_radius, critical_radius : float or None
        Distances r_2 and r_3 of the borders of the active and critical region from the
        contour, in m; computed by the scenario when ``None``.
    max_speed : float or None
        Must be ``None`` or 0: a rectangle does not move.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, a side is not positive, or active_radius is not larger than
        critical_radius.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Rectangle(center=(2.3, 0.0), length=1.4, width=0.6).heading
    0.0
    """

    center: Pair
    length: float
    width: float
    heading: float = 0.0
    active_radius: float | None = None
    critical_radius: float | None = None
    max_speed: float | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)
    _given: Obstacle | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(center=pair("center", self.center))
        sides = {name: number(name, getattr(self, name)) for name in ("length", "width", "heading")}
        self._set(**sides)
        native = _hrsafety.Obstacle.rectangle(
            center=self.center, length=self.length, width=self.width, heading=self.heading, **self._limits()
        )
        self._set(_native=native)


def _recorded(time: npt.ArrayLike, position: npt.ArrayLike) -> Path:
    """Check the shapes of a recording and freeze it."""
    instants = numbers("time", time, "be an array of numbers")
    places = points("position", position)
    if instants.ndim != 1:
        raise ShapeError("time", "(n,)", instants.shape)
    if len(places) != len(instants):
        raise ShapeError("position", f"({len(instants)}, 2)", places.shape)
    if len(instants) == 0:
        raise InvalidParameterError("time", "hold at least one sample", "an empty array")
    return tuple(instants.tolist()), tuple((x, y) for x, y in places.tolist())


def _segments(segments: Iterable[tuple[float, Sequence[float], Sequence[float]]]) -> tuple[Segment, ...]:
    """Freeze a list of (duration, velocity, acceleration)."""
    frozen = []
    rule = "be (duration, velocity, acceleration)"
    for index, segment in enumerate(sequence("segments", "be a list of (duration, velocity, acceleration)", segments)):
        parts = sequence(f"segments[{index}]", rule, segment)
        if len(parts) != 3:
            raise InvalidParameterError(f"segments[{index}]", rule, segment)
        duration, velocity, acceleration = parts
        frozen.append(
            (
                number(f"segments[{index}].duration", duration),
                pair(f"segments[{index}].velocity", velocity),
                pair(f"segments[{index}].acceleration", acceleration),
            )
        )
    return tuple(frozen)


def _moving(obstacle: Human | MovingDisc, *, start: Pair, acceleration: Pair, default_max_speed: float | None) -> None:
    """Build the native counterpart of a moving body from whichever motion it was given."""
    obstacle._set(radius=number("radius", obstacle.radius), velocity=pair("velocity", obstacle.velocity))
    if obstacle.stop is not None:
        obstacle._set(stop=pair("stop", obstacle.stop))
    limits = obstacle._limits()
    if limits["max_speed"] is None:
        limits["max_speed"] = default_max_speed
    shape: dict[str, Any] = {"radius": obstacle.radius, **limits}
    if obstacle.path is not None:
        native = _hrsafety.Obstacle.recorded(time=obstacle.path[0], position=obstacle.path[1], **shape)
    elif obstacle.segments is not None:
        native = _hrsafety.Obstacle.piecewise(start=start, segments=obstacle.segments, **shape)
    else:
        native = _hrsafety.Obstacle.moving(
            start=start, velocity=obstacle.velocity, acceleration=acceleration, stop=obstacle.stop, **shape
        )
    obstacle._set(_native=native)


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
    max_speed: float | None = None
    segments: tuple[Segment, ...] | None = None
    path: Path | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)
    _given: Obstacle | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(center=pair("center", self.center), acceleration=pair("acceleration", self.acceleration))
        if self.path is None and not np.isfinite(self.center).all():
            raise InvalidParameterError("center", "be finite", self.center)
        _moving(self, start=self.center, acceleration=self.acceleration, default_max_speed=None)

    @classmethod
    def from_path(cls, time: npt.ArrayLike, position: npt.ArrayLike, *, radius: float, **fields: Any) -> Self:
        """Return a disc that follows a recording; see `Human.from_path`."""
        path = _recorded(time, position)
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
        frozen = _segments(segments)
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
    max_speed: float | None = None
    segments: tuple[Segment, ...] | None = None
    path: Path | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)
    _given: Obstacle | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(start=pair("start", self.start))
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
            ``radius``, ``active_radius``, ``critical_radius``, ``max_speed``.

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
        path = _recorded(time, position)
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
            Duration in s, velocity at the begin of the segment in m/s, acceleration in m/s^2.
            After the last segment the velocity reached is kept.
        **fields
            ``radius``, ``active_radius``, ``critical_radius``, ``max_speed``.

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
        frozen = _segments(segments)
        velocity = frozen[0][1] if frozen else (0.0, 0.0)
        return cls(start=start, velocity=velocity, segments=frozen, **fields)
