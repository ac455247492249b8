"""Obstacles: discs, rectangles, walking and recorded people, moving discs."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, Parameters, not_negative, number, pair, positive
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.motions import Path, Segment, frozen_path, frozen_segments, moving_body

__all__ = ["Disc", "Human", "MovingDisc", "Obstacle", "Rectangle"]


class Obstacle(Parameters):
    """What all obstacles share: an active and a critical region.

    A region is given by its radius as in the source, from the center of a disc and from the contour
    of a rectangle to the center of the robot, or by its clearance, between the surfaces of obstacle
    and robot for every shape. What is left ``None`` is computed by a `Scenario` from the limits of
    its robot (see `region_radii`). Given values must obey active > critical >= 0, and a critical
    radius may not be below the distance at which the scenario's robot touches the obstacle.
    """

    __slots__ = ("_given",)  # set only where a scenario filled in radii
    active_radius: float | None
    critical_radius: float | None
    active_clearance: float | None
    critical_clearance: float | None
    max_speed: float | None
    _native: _hrsafety.Obstacle

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
        given: Self = getattr(self, "_given", self)
        return given

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
        values = {name: getattr(self, name) for name in _init_names(type(self))}  # type: ignore[arg-type]  # a class
        values |= {name: value for name, value in radii.items() if values[name] is None}
        if self._by_clearance():
            values |= dict.fromkeys(_CLEARANCES.values())
        filled = type(self)(**values)
        object.__setattr__(filled, "_given", self)
        return filled

    def _sized(self, critical_radius: float, active_radius: float) -> Self:
        """Return `filled_in` with radii that the native scenario has found and checked already."""
        filled = object.__new__(type(self))
        for read, write in _slots(type(self)):  # type: ignore[arg-type]  # a class
            write(filled, read(self))
        native = self._native.sized(critical_radius, active_radius)
        filled._set(critical_radius=critical_radius, active_radius=active_radius, _native=native, _given=self)
        return filled

    def _by_clearance(self) -> bool:
        return self.active_clearance is not None or self.critical_clearance is not None

    def contact_distance(self, robot_radius: float) -> float:
        """Return the distance, measured as the radii are, at which a robot touches the obstacle.

        Parameters
        ----------
        robot_radius : float
            Radius of the robot in m.

        Returns
        -------
        float
            Distance in m from the center of a disc or the contour of a rectangle.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.Human(start=(0, 0), velocity=(1, 0)).contact_distance(0.25)
        0.65
        """
        return robot_radius + self._inner_radius()

    def _inner_radius(self) -> float:
        """Return the part of the radii that lies inside the obstacle, in m."""
        return float(getattr(self, "radius", 0.0))

    def radii_from_clearances(self, robot_radius: float) -> dict[str, float]:
        """Return the radii of the regions that were given by clearances.

        Parameters
        ----------
        robot_radius : float
            Radius of the robot in m.

        Returns
        -------
        dict of str to float
            ``active_radius`` and ``critical_radius`` in m, as far as given.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.Disc(center=(0, 0), radius=0.5, critical_clearance=0.25).radii_from_clearances(0.25)
        {'critical_radius': 1.0}
        """
        if not self._by_clearance():
            return {}
        contact = self.contact_distance(robot_radius)
        given = {radius: getattr(self, clearance) for radius, clearance in _CLEARANCES.items()}
        return {radius: contact + clearance for radius, clearance in given.items() if clearance is not None}

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by public fields; what a scenario filled in is filled in again."""
        given = self.as_given()
        if given is self:
            return super().__reduce__()
        return _filled_in, (given, {name: getattr(self, name) for name in _CLEARANCES})

    def _limits(self) -> dict[str, float | None]:
        if self.active_radius is self.critical_radius is self.max_speed is None and not self._by_clearance():
            return dict(_NO_LIMITS)  # nearly always
        limits = {}
        for name in _NO_LIMITS:
            value = getattr(self, name)
            limits[name] = None if value is None else number(name, value)
        self._set(**limits)
        if self._by_clearance():
            self._check_clearances()
        return limits

    def _check_clearances(self) -> None:
        """Check clearances, which exclude radii."""
        for radius, clearance in _CLEARANCES.items():
            value = getattr(self, clearance)
            if value is not None:
                check = positive if radius == "active_radius" else not_negative
                self._set(**{clearance: check(clearance, value)})
            if getattr(self, radius) is not None:
                given = next(name for name in _CLEARANCES.values() if getattr(self, name) is not None)
                remedy = "a radius is measured to the center of the robot, a clearance between the surfaces"
                raise InvalidParameterError(radius, f"be None where {given} is given", getattr(self, radius), remedy)
        active, critical = self.active_clearance, self.critical_clearance
        if active is not None and critical is not None and active <= critical:
            raise InvalidParameterError(
                "active_clearance", f"be larger than critical_clearance, {critical:g} m", active
            )


# The limits that every obstacle may have.
_NO_LIMITS = dict.fromkeys(("active_radius", "critical_radius", "max_speed"))
# The clearance that stands for each radius.
_CLEARANCES = {"active_radius": "active_clearance", "critical_radius": "critical_clearance"}


@functools.cache
def _init_names(kind: type[Obstacle]) -> tuple[str, ...]:
    """Return the fields that a class takes; `dataclasses.replace` would look them up for every obstacle."""
    return tuple(each.name for each in dataclasses.fields(kind) if each.init)  # type: ignore[arg-type]  # a dataclass


@functools.cache
def _slots(kind: type[Obstacle]) -> tuple[tuple[Callable[[object], Any], Callable[[object, Any], None]], ...]:
    """Return what reads and writes the fields of a class, for copies that need no second check."""
    members = [getattr(kind, each.name) for each in dataclasses.fields(kind)]  # type: ignore[arg-type]  # a dataclass
    return tuple((member.__get__, member.__set__) for member in members)


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
    active_clearance, critical_clearance : float or None
        The same regions measured between the surfaces of obstacle and robot, in m; instead of the
        radii.
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
    active_clearance: float | None = None
    critical_clearance: float | None = None
    max_speed: float | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)

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
    active_clearance, critical_clearance : float or None
        The same regions measured between the surfaces of obstacle and robot, in m; instead of the
        radii.
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
    active_clearance: float | None = None
    critical_clearance: float | None = None
    max_speed: float | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(center=pair("center", self.center))
        sides = {name: number(name, getattr(self, name)) for name in ("length", "width", "heading")}
        self._set(**sides)
        native = _hrsafety.Obstacle.rectangle(
            center=self.center, length=self.length, width=self.width, heading=self.heading, **self._limits()
        )
        self._set(_native=native)


def _moving(obstacle: Human | MovingDisc, *, start: Pair, acceleration: Pair, default_max_speed: float | None) -> None:
    """Build the native counterpart of a round body that moves."""
    radius, velocity = number("radius", obstacle.radius), pair("velocity", obstacle.velocity)
    stop = None if obstacle.stop is None else pair("stop", obstacle.stop)
    if not (radius is obstacle.radius and velocity is obstacle.velocity and stop is obstacle.stop):
        obstacle._set(radius=radius, velocity=velocity, stop=stop)
    limits = obstacle._limits()
    if limits["max_speed"] is None:
        limits["max_speed"] = default_max_speed

    def straight() -> _hrsafety.Obstacle:
        return _hrsafety.Obstacle.moving((start, velocity, acceleration), stop, radius, tuple(limits.values()))  # type: ignore[arg-type]  # three

    if obstacle.path is None and obstacle.segments is None:  # nearly always
        native = straight()
    else:
        native = moving_body(obstacle, start, {"radius": radius, **limits}, straight)
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
