"""Ultrasonic skirt: sensors around a robot with three omni-wheels, and what their readings cause."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, count, vector, word
from hrsafety._bounds import MOST_RAYS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["MOTION_DIRECTIONS", "SkirtState", "UltrasonicSkirt", "skirt_states"]

Layout = Literal["wheels", "even"]
Triggering = Literal["consistent", "printed"]
Policy = Literal["nearest", "best_direction", "table_only"]

MOTION_DIRECTIONS: Mapping[str, float] = MappingProxyType(dict(_hrsafety.skirt_directions()))
"""Motion directions of Table 3 of Gussu and Lin (2017), by the subscripts of the source, in rad from
the east, counterclockwise. North-west is 2 pi/3, the mirror of north-east; the source prints 0.833 pi."""

MOST_SENSORS = 64
PUBLISHED_WHEEL_GAP = math.pi / 8.0
PUBLISHED_SAFE_DISTANCE = 0.666
PUBLISHED_CHASSIS_RADIUS = 0.33


@displayed
class SkirtState(NamedTuple):
    """One row of the state table.

    Attributes
    ----------
    sensors : tuple of int
        Numbers of the sensors that see an obstacle, from 1.
    pattern : str
        Sensors 9 to 1; 0 where there is an obstacle, as in the table of the source.
    action : str
        A word of `MOTION_DIRECTIONS`, ``"keep"`` or ``"spin"``.
    """

    sensors: tuple[int, ...]
    pattern: str
    action: str


def skirt_states() -> tuple[SkirtState, ...]:
    """Return the state table of the published skirt, states 0 to 9.

    Returns
    -------
    tuple of SkirtState
        Table 1 of Gussu and Lin (2017): 10 of the 512 patterns. State 6 has the obstacles 6, 7, 8,
        opposite to the north; the source prints 5, 6, 7. State 9, "arbitrary direction", keeps the
        present one.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.skirt.skirt_states()[1]
    SkirtState(sensors=(2, 3), pattern='111111001', action='S')
    """
    rows = _hrsafety.skirt_states()
    return tuple(SkirtState(tuple(sensors), _pattern(sensors, 9), action) for sensors, action in rows)


def _pattern(sensors: list[int], size: int) -> str:
    return "".join("0" if place in sensors else "1" for place in range(size, 0, -1))


@dataclass(frozen=True, kw_only=True, slots=True)
class UltrasonicSkirt(Parameters):
    """Ring of ultrasonic sensors that fire in turn, and the rules that turn readings into motion.

    A sensor is triggered when its reading is at most its triggering distance. The pattern of
    triggered sensors is looked up in the state table (`skirt_states`); between its rows, and for
    every ring but the published one, the policy decides. x points east and y north in the frame of
    the body; wheels stand at 90, 210 and 330 deg. Defaults are the robot of Gussu and Lin (2017).

    Parameters
    ----------
    chassis_radius : float
        Radius R of the chassis, in m.
    sensor_inset : float
        Distance w of the sensor faces inside the edge of the chassis, in m; negative for sensors
        that stand outside it, by up to a radius. A contact is that of the chassis.
    sensors : int
        Number N of sensors, up to 64; with the layout ``"wheels"`` a multiple of three from 6 on.
    layout : str
        ``"wheels"``: two sensors beside each wheel, the others evenly between them, clockwise from
        150 deg for nine. ``"even"``: equal gaps, clockwise from 90 deg.
    wheel_gap : float
        Angle theta_1 between a wheel and the sensors beside it, in rad; for ``"wheels"`` only.
    safe_distance : float or None
        Distance R_S from the center within which an echo triggers, in m. ``None``: where the beams
        beside the largest gap meet (`meeting_distance`), 0.610 m for the published ring; its
        printed 0.666 m is the default.
    triggering : str
        ``"consistent"``: R - w + cm <= R_S for every sensor. ``"printed"``: d1 to d8 and y of (7) to
        (9) and Table 3, which trigger sensors 1 to 4 at 2 R_S - R + w; nine sensors only.
    policy : str
        What decides between the rows of the state table: ``"nearest"``, the nearest triggered
        sensor by Table 3 (in other rings, the direction that is opposite to it);
        ``"best_direction"``, the direction phi that maximizes the sum over triggered sensors k of
        -exp(2 cos(phi - s_k)) (1.2 - cm_k / threshold_k); ``"table_only"``, nothing.
    beam_width : float
        Full angle of a beam, in rad.
    rays : int
        Rays that a beam is made of.
    least_range, most_range : float
        Smallest and largest reading, in m; other echoes are lost, and the reading is the largest
        one then.
    range_noise : float
        Standard deviation of a reading, in m.
    firing_period : float
        Time from one sensor to the next, in s.

    Raises
    ------
    InvalidParameterError
        If a number is out of range, a word unknown, or the safe distance not beyond the sensors.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import reactive
    >>> skirt = reactive.UltrasonicSkirt()
    >>> np.degrees(skirt.bearings).round(1).tolist()
    [150.0, 112.5, 67.5, 30.0, -7.5, -52.5, -90.0, -127.5, 187.5]
    >>> skirt.action([3.0, 0.2, 0.25, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0])
    'S'
    """

    chassis_radius: float = PUBLISHED_CHASSIS_RADIUS
    sensor_inset: float = 0.0
    sensors: int = 9
    layout: Layout = "wheels"
    wheel_gap: float = PUBLISHED_WHEEL_GAP
    safe_distance: float | None = PUBLISHED_SAFE_DISTANCE
    triggering: Triggering = "consistent"
    policy: Policy = "nearest"
    beam_width: float = math.radians(40.0)
    rays: int = 13
    least_range: float = 0.02
    most_range: float = 3.0
    range_noise: float = 0.005
    firing_period: float = 0.02
    _native: _hrsafety.UltrasonicSkirt = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        lengths = self._as_numbers(
            *("chassis_radius", "sensor_inset", "wheel_gap", "beam_width", "least_range", "most_range"),
            *("range_noise", "firing_period"),
        )
        if self.safe_distance is not None:
            self._as_numbers("safe_distance")
        for name, most in (("sensors", MOST_SENSORS), ("rays", MOST_RAYS)):
            if count(name, getattr(self, name)) > most:
                raise InvalidParameterError(name, f"be at most {most}", getattr(self, name))
        self._set(
            _native=_hrsafety.UltrasonicSkirt(
                **lengths,
                sensors=self.sensors,
                layout=word("layout", self.layout, ("wheels", "even")),
                safe_distance=self.safe_distance,
                triggering=word("triggering", self.triggering, ("consistent", "printed")),
                policy=word("policy", self.policy, ("nearest", "best_direction", "table_only")),
                rays=self.rays,
            )
        )

    @property
    def bearings(self) -> Array:
        """Bearings of the sensors in their order, in rad, shape (N,)."""
        return np.asarray(self._native.bearings())

    @property
    def gaps(self) -> Array:
        """Angles from sensor to sensor, counterclockwise from the east, in rad, shape (N,); their sum is 2 pi."""
        return np.asarray(self._native.gaps())

    @property
    def positions(self) -> Array:
        """Places of the sensor faces in the frame of the body, in m, shape (N, 2)."""
        radius = self.chassis_radius - self.sensor_inset
        return radius * np.stack([np.cos(self.bearings), np.sin(self.bearings)], axis=1)

    @property
    def trigger_distances(self) -> Array:
        """Largest readings at which the sensors are triggered, in m, shape (N,)."""
        return np.asarray(self._native.trigger_distances())

    @property
    def meeting_distance(self) -> float:
        """R_S by the geometry of Figure 1(b) for the largest gap, in m; infinite from a gap of 90 deg on."""
        return self._native.meeting_distance()

    @property
    def scan_time(self) -> float:
        """Time in which every sensor fires once, in s."""
        return self.sensors * self.firing_period

    def normal_distances(self, readings: npt.ArrayLike) -> tuple[Array, Array]:
        """Return d1 to d8 and their limits d1' to d8', (7) to (9) of Gussu and Lin (2017).

        A motion is triggered where d <= d'. With ``triggering="printed"`` they are those of the
        source: R_S is subtracted in d1 to d4 only, d8 has the reading of sensor 8, and d5 another
        sine than d5'. With ``"consistent"`` d = (R - w + cm) sin and d' = R_S sin for every sensor,
        which is what `trigger_distances` says.

        Parameters
        ----------
        readings : array_like, shape (9,)
            Readings cm of the sensors, in m.

        Returns
        -------
        distances, limits : ndarray, shape (8,)
            In m.

        Raises
        ------
        InvalidParameterError
            If the ring is not one of nine sensors, or readings are not numbers.
        ShapeError
            If there is not one reading for each sensor.

        Examples
        --------
        An echo at 0.3 m in front of sensor 1 only:

        >>> from hrsafety import reactive
        >>> distances, limits = reactive.UltrasonicSkirt().normal_distances([0.3] + [3.0] * 8)
        >>> (distances <= limits).tolist()
        [True, False, False, False, False, False, False, False]
        """
        values = vector("readings", readings)
        if values.shape != (self.sensors,):
            raise ShapeError("readings", f"({self.sensors},)", values.shape)
        safe = self.meeting_distance if self.safe_distance is None else self.safe_distance
        rows = self._native.normal_distances(values, safe, self.triggering)
        return rows[:, 0].copy(), rows[:, 1].copy()

    def pattern(self, readings: npt.ArrayLike) -> str:
        """Return which sensors are triggered, as the source writes it.

        Parameters
        ----------
        readings : array_like, shape (N,)
            Readings cm of the sensors, in m.

        Returns
        -------
        str
            Sensors N to 1; 0 where there is an obstacle.

        Raises
        ------
        InvalidParameterError
            If readings are not numbers.
        ShapeError
            If there is not one for each sensor.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> reactive.UltrasonicSkirt().pattern([0.3, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0, 0.1])
        '011111110'
        """
        bits = self._native.pattern(self._readings(readings))
        return format(~bits & (1 << self.sensors) - 1, f"0{self.sensors}b")

    def action(self, readings: npt.ArrayLike) -> str:
        """Return what the robot does.

        Parameters
        ----------
        readings : array_like, shape (N,)
            Readings cm of the sensors, in m.

        Returns
        -------
        str
            A word of `MOTION_DIRECTIONS`; ``"keep"`` if no sensor is triggered; ``"spin"`` if all are.

        Raises
        ------
        InvalidParameterError
            If readings are not numbers.
        ShapeError
            If there is not one for each sensor.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> reactive.UltrasonicSkirt().action([3.0] * 9)
        'keep'
        """
        return self._native.action(self._readings(readings))

    def _readings(self, readings: npt.ArrayLike) -> Array:
        given = vector("readings", readings)
        if given.shape != (self.sensors,):
            raise ShapeError("readings", f"({self.sensors},)", given.shape)
        return given
