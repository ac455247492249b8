"""Ultrasonic ranging: shapes that echo, rays, and the sensors of the follower."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from typing import Annotated, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, Parameters, checked_seed, count, flag, number, numbers, pair, sequence
from hrsafety._bounds import MOST_RAYS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["Box", "Cylinder", "Sonar", "SonarMounts", "Wall", "cast_rays", "speed_of_sound"]

# In degrees Celsius.
ABSOLUTE_ZERO = -273.15


@dataclass(frozen=True, kw_only=True, slots=True)
class Box(Parameters):
    """A box seen from above.

    Parameters
    ----------
    center : tuple of float
        Center in m.
    size : tuple of float
        Sides along its own x and y, in m.
    angle : float
        Turn of its x axis, counterclockwise, in rad.

    Raises
    ------
    InvalidParameterError
        If a number is not finite, or a side is not positive.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.Box(center=(2.0, 0.0), size=(0.5, 1.0)).angle
    0.0
    """

    center: Pair
    size: Pair
    angle: float = 0.0
    _native: _hrsafety.EchoShape = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(center=pair("center", self.center), size=_sides(self.size), angle=number("angle", self.angle))
        if not np.isfinite(self.angle):
            raise InvalidParameterError("angle", "be finite", self.angle)
        self._set(_native=_hrsafety.EchoShape.rectangle(center=self.center, size=self.size, angle=self.angle))


def _sides(value: object) -> Pair:
    sides = pair("size", value)
    if not all(0.0 < side < np.inf for side in sides):
        raise InvalidParameterError("size", "be two finite and positive numbers", value)
    return sides


@dataclass(frozen=True, kw_only=True, slots=True)
class Cylinder(Parameters):
    """A disc.

    Parameters
    ----------
    center : tuple of float
        Center in m.
    radius : float
        Radius in m.

    Raises
    ------
    InvalidParameterError
        If a number is not finite, or the radius is not positive.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.Cylinder(center=(1.0, 0.5), radius=0.1).radius
    0.1
    """

    center: Pair
    radius: float
    _native: _hrsafety.EchoShape = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(center=pair("center", self.center), radius=number("radius", self.radius))
        self._set(_native=_hrsafety.EchoShape.disc(center=self.center, radius=self.radius))


@dataclass(frozen=True, kw_only=True, slots=True)
class Wall(Parameters):
    """A straight wall without thickness.

    Parameters
    ----------
    start, end : tuple of float
        Its ends in m.

    Raises
    ------
    InvalidParameterError
        If a number is not finite.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.Wall(start=(0.0, 1.0), end=(5.0, 1.0)).end
    (5.0, 1.0)
    """

    start: Pair
    end: Pair
    _native: _hrsafety.EchoShape = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(start=pair("start", self.start), end=pair("end", self.end))
        self._set(_native=_hrsafety.EchoShape.wall(start=self.start, end=self.end))


Echoing = Box | Cylinder | Wall


def native_shapes(name: str, shapes: object) -> list[_hrsafety.EchoShape]:
    """Return the native counterparts of shapes."""
    rule = "be a sequence of Box, Cylinder and Wall"
    given = sequence(name, rule, shapes)
    for shape in given:
        if not isinstance(shape, Echoing):
            raise InvalidParameterError(name, rule, shape)
    return [shape._native for shape in given]


@displayed
class SonarMounts(NamedTuple):
    """Places of the sensors on the robot, x forward and y left, right to left.

    Attributes
    ----------
    position : ndarray of shape (n, 2)
        In m.
    axis : ndarray of shape (n,)
        Directions in rad.
    """

    position: Annotated[Array, "m"]
    axis: Annotated[Array, "rad"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Sonar(Parameters):
    """Three ultrasonic sensors in front of the robot, and three more behind if wanted.

    The beam of a sensor is a fan of rays; the nearest echo counts. The range is the flight time
    at the speed of sound that the sensor takes for granted, 331.5 + 0.6 T, (23) of Avi (2019).

    Parameters
    ----------
    forward : float
        Distance of the sensors ahead of the center of the robot, in m.
    spacing : float
        Distance of the outer sensors from the middle one, in m.
    fan : float
        Angle between neighboring axes, in rad.
    beam_width : float
        Full angle of a beam, in rad.
    rays : int
        Rays of a beam, evenly spread over its width; one lies on the axis.
    least_range, most_range : float
        Nearer and farther echoes are lost, in m.
    range_noise : float
        Standard deviation of a reading, in m.
    temperature, assumed_temperature : float
        Of the air, and what the sensor takes for granted, in degrees Celsius; 14.17 makes 340 m/s.
    firing : str
        ``"together"``; ``"cross_talk"``: together, and each sensor receives the echoes of the others
        that it can see; ``"in_turn"``: one sensor a step, the others keep their readings.
    rear : bool
        Three more sensors, those in front turned by half a turn about the center.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> box = reactive.Box(center=(2.0, 0.0), size=(0.5, 1.0))
    >>> reactive.Sonar().readings([box], noise=False).round(3).tolist()
    [inf, 1.55, inf]
    """

    forward: float = 0.20
    spacing: float = 0.15
    fan: float = np.pi / 6.0
    beam_width: float = np.pi / 6.0
    rays: int = 13
    least_range: float = 0.03
    most_range: float = 3.0
    range_noise: float = 0.005
    temperature: float = 8.5 / 0.6
    assumed_temperature: float = 8.5 / 0.6
    firing: Literal["together", "cross_talk", "in_turn"] = "together"
    rear: bool = False
    _native: _hrsafety.Sonar = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers(
            *("forward", "spacing", "fan", "beam_width", "least_range", "most_range", "range_noise"),
            *("temperature", "assumed_temperature"),
        )
        self._set(
            _native=_hrsafety.Sonar(
                rays=count("rays", self.rays, most=MOST_RAYS),
                firing=str(self.firing),
                rear=flag("rear", self.rear),
                **values,
            )
        )

    @property
    def mounts(self) -> SonarMounts:
        """Places of the sensors on the robot."""
        return SonarMounts(**_hrsafety.sonar_mounts(self._native))

    def readings(
        self, shapes: Sequence[Echoing], poses: npt.ArrayLike = (0.0, 0.0, 0.0), *, noise: bool = True, seed: int = 0
    ) -> Array:
        """Return what the sensors read.

        Parameters
        ----------
        shapes : sequence of Box, Cylinder or Wall
            What echoes.
        poses : array_like, shape (3,) or (n, 3)
            Position (m) and heading (rad) of the robot, step by step.
        noise : bool
            With noise.
        seed : int
            Seed of the noise.

        Returns
        -------
        ndarray of shape (sensors,) or (n, sensors)
            In m, right to left, the front sensors first; infinite without an echo.

        Raises
        ------
        InvalidParameterError
            If an argument is of the wrong kind.
        ShapeError
            If the poses have another shape.

        Examples
        --------
        One wall at the left, seen by the left sensor only:

        >>> from hrsafety import reactive
        >>> wall = reactive.Wall(start=(-5.0, 1.0), end=(5.0, 1.0))
        >>> reactive.Sonar(beam_width=0.0, rays=1).readings([wall], noise=False).round(3).tolist()
        [inf, inf, 1.7]
        """
        given = numbers("poses", poses)
        if given.shape[-1:] != (3,) or given.ndim not in (1, 2):
            raise ShapeError("poses", "(3,) or (n, 3)", given.shape)
        if not np.all(np.isfinite(given)):
            raise InvalidParameterError("poses", "be finite", poses)
        found: Array = _hrsafety.sonar_readings(
            self._native,
            native_shapes("shapes", shapes),
            given.reshape(-1, 3),
            seed=checked_seed("seed", seed),
            noise=flag("noise", noise),
        )["readings"]
        return found[0] if given.ndim == 1 else found


def cast_rays(shapes: Sequence[Echoing], origins: npt.ArrayLike, angles: npt.ArrayLike) -> Array:
    """Return how far rays go until they meet a shape.

    Parameters
    ----------
    shapes : sequence of Box, Cylinder or Wall
        What they may meet.
    origins : array_like, shape (n, 2)
        Where they start, in m.
    angles : array_like, shape (n,)
        Their directions from x, counterclockwise, in rad.

    Returns
    -------
    ndarray of shape (n,)
        Distances in m: 0 from inside a shape, infinite when nothing is met.

    Raises
    ------
    InvalidParameterError
        If a number is not finite, or a shape is of the wrong kind.
    ShapeError
        If the shapes of the arrays do not fit.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.sonar.cast_rays([reactive.Cylinder(center=(3.0, 0.0), radius=1.0)], [(0.0, 0.0)], [0.0])
    array([2.])
    """
    starts, directions = numbers("origins", origins), numbers("angles", angles)
    if starts.ndim != 2 or starts.shape[1] != 2:
        raise ShapeError("origins", "(n, 2)", starts.shape)
    if directions.shape != (len(starts),):
        raise ShapeError("angles", f"({len(starts)},)", directions.shape)
    for name, array in (("origins", starts), ("angles", directions)):
        if not np.all(np.isfinite(array)):
            raise InvalidParameterError(name, "be finite", array)
    distances: Array = _hrsafety.cast_rays(native_shapes("shapes", shapes), starts, directions)["distance"]
    return distances


def speed_of_sound(temperature: float) -> float:
    """Return the speed of sound in air, 331.5 + 0.6 T: (23) of Avi (2019).

    Parameters
    ----------
    temperature : float
        T in degrees Celsius.

    Returns
    -------
    float
        In m/s.

    Raises
    ------
    InvalidParameterError
        If the temperature is not a finite number above absolute zero.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.sonar.speed_of_sound(25.0)
    346.5
    """
    given = number("temperature", temperature)
    if not ABSOLUTE_ZERO < given < np.inf:
        raise InvalidParameterError("temperature", f"be finite and above {ABSOLUTE_ZERO} degrees Celsius", given)
    return _hrsafety.speed_of_sound(given)
