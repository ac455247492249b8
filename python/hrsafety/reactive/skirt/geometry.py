"""Number and spacing of the sensors of a skirt: what closes the ring, and the printed equations."""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

from hrsafety import _hrsafety
from hrsafety._arguments import count, number, positive
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError
from hrsafety.reactive.skirt.ring import MOST_SENSORS

__all__ = [
    "SensorCount",
    "SkirtSpacing",
    "least_skirt_sensors",
    "skirt_closing_radius",
    "skirt_safe_distance",
    "skirt_spacing",
]


@displayed
class SensorCount(NamedTuple):
    """Least number of sensors.

    Attributes
    ----------
    least : int
        Smallest N that fulfills (6).
    multiple_of_three : int
        Smallest multiple of three from it on: the same number between all wheels.
    """

    least: int
    multiple_of_three: int


@displayed
class SkirtSpacing(NamedTuple):
    """Gap between sensors that are not beside a wheel, in four ways.

    Attributes
    ----------
    closing_gap : float
        theta of the ring that closes, (2 pi - 6 theta_1) / (N - 3), in rad.
    printed_gap : float
        theta by (3), in rad.
    printed_gap_closed : float
        theta by (5), that is (3) with theta_1 = 60 deg - theta, in rad.
    closing_correction : float
        Factor a with which (3) gives the gap of the ring that closes.
    """

    closing_gap: Annotated[float, "rad"]
    printed_gap: Annotated[float, "rad"]
    printed_gap_closed: Annotated[float, "rad"]
    closing_correction: float


def least_skirt_sensors(*, wheel_sensor_radius: float, sensor_radius: float) -> SensorCount:
    """Return the least number of sensors of a skirt, N > 3 (1 + r_1/r).

    Parameters
    ----------
    wheel_sensor_radius : float
        Distance r_1 of the sensors beside the wheels from the center, in m.
    sensor_radius : float
        Distance r of the other sensors from the center, in m.

    Returns
    -------
    SensorCount
        (6) of Gussu and Lin (2017), and the next multiple of three.

    Raises
    ------
    InvalidParameterError
        If a radius is not finite and positive.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.skirt.least_skirt_sensors(wheel_sensor_radius=0.33, sensor_radius=0.33)
    SensorCount(least=7, multiple_of_three=9)
    """
    least, multiple = _hrsafety.skirt_least_sensors(
        wheel_sensor_radius=positive("wheel_sensor_radius", wheel_sensor_radius),
        sensor_radius=positive("sensor_radius", sensor_radius),
    )
    return SensorCount(int(least), int(multiple))


def skirt_closing_radius(
    sensors: int = 9,
    *,
    gap: float,
    wheel_gap: float = math.pi / 8.0,
    sensor_radius: float = 0.33,
    wheel_sensor_radius: float = 0.33,
    sensor_length: float = 0.046,
    correction: float = 0.68,
) -> float:
    """Return the radius of the chassis that (1) of Gussu and Lin (2017) closes.

    2 pi R = a N L + 3 S_1 + (N - 3) S_2 with the arcs S_1 = r_1 theta_1 and S_2 = r theta of (2).
    `skirt_spacing` solves the same equation for theta, (3).

    Parameters
    ----------
    sensors : int
        Number N of sensors, 4 to 64.
    gap, wheel_gap : float
        Angles theta between sensors and theta_1 beside a wheel, in rad.
    sensor_radius, wheel_sensor_radius : float
        Distances r and r_1 of the sensors from the center, in m.
    sensor_length : float
        Length L of a sensor along the edge, in m.
    correction : float
        Factor a.

    Returns
    -------
    float
        R in m.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    With the printed theta the published numbers close at 0.313 m, not at 0.33 m:

    >>> import math
    >>> from hrsafety import reactive
    >>> round(reactive.skirt.skirt_closing_radius(gap=math.radians(37.5)), 3)
    0.313
    """
    if count("sensors", sensors) > MOST_SENSORS:
        raise InvalidParameterError("sensors", f"be at most {MOST_SENSORS}", sensors)
    return _hrsafety.skirt_closing_radius(
        sensors=sensors,
        gap=number("gap", gap),
        wheel_gap=number("wheel_gap", wheel_gap),
        sensor_radius=number("sensor_radius", sensor_radius),
        wheel_sensor_radius=number("wheel_sensor_radius", wheel_sensor_radius),
        sensor_length=number("sensor_length", sensor_length),
        correction=number("correction", correction),
    )


def skirt_spacing(
    sensors: int = 9,
    *,
    wheel_gap: float = math.pi / 8.0,
    chassis_radius: float = 0.33,
    sensor_radius: float = 0.33,
    wheel_sensor_radius: float = 0.33,
    sensor_length: float = 0.046,
    correction: float = 0.68,
) -> SkirtSpacing:
    """Return the spacing of the sensors: of a ring that closes, and as printed.

    The printed (1) counts 3 theta_1 + (N - 3) theta, which is 292.5 deg for the published ring; the
    rest of the turn is in a N L, so the factor a has to be fitted. Defaults are the published
    values and the length of its sensor type.

    Parameters
    ----------
    sensors : int
        Number N of sensors, more than 3 (1 + r_1/r).
    wheel_gap : float
        Angle theta_1 between a wheel and the sensors beside it, in rad, below 60 deg.
    chassis_radius : float
        R in m.
    sensor_radius, wheel_sensor_radius : float
        Distances r and r_1 of the sensors from the center, in m.
    sensor_length : float
        Length L of a sensor along the edge, in m.
    correction : float
        Factor a.

    Returns
    -------
    SkirtSpacing
        Gaps and factor, (3) and (5) of Gussu and Lin (2017).

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> import math
    >>> from hrsafety import reactive
    >>> spacing = reactive.skirt.skirt_spacing()
    >>> [round(math.degrees(gap), 1) for gap in spacing[:3]], round(spacing.closing_correction, 3)
    ([37.5, 40.6, 43.7], 0.939)
    """
    if count("sensors", sensors) > MOST_SENSORS:
        raise InvalidParameterError("sensors", f"be at most {MOST_SENSORS}", sensors)
    printed, closed, factor = _hrsafety.skirt_printed_gaps(
        sensors=sensors,
        wheel_gap=number("wheel_gap", wheel_gap),
        chassis_radius=number("chassis_radius", chassis_radius),
        sensor_radius=number("sensor_radius", sensor_radius),
        wheel_sensor_radius=number("wheel_sensor_radius", wheel_sensor_radius),
        sensor_length=number("sensor_length", sensor_length),
        correction=number("correction", correction),
    )
    closing = _hrsafety.skirt_closing_gap(sensors=sensors, wheel_gap=float(wheel_gap))
    return SkirtSpacing(closing, printed, closed, factor)


def skirt_safe_distance(*, sensor_radius: float, gap: float) -> float:
    """Return the distance from the center at which the beams of two neighbors meet.

    The lines at 135 deg from the inward axes of the two sensors meet at
    R_S = r / (cos(gap/2) - sin(gap/2)).

    Parameters
    ----------
    sensor_radius : float
        Distance r of the sensors from the center, in m.
    gap : float
        Angle between them, in rad.

    Returns
    -------
    float
        R_S in m, Figure 1(b) of Gussu and Lin (2017); infinite from a gap of 90 deg on.

    Raises
    ------
    InvalidParameterError
        If the radius is not positive or the gap not an angle from 0 to 2 pi.

    Examples
    --------
    >>> import math
    >>> from hrsafety import reactive
    >>> round(reactive.skirt.skirt_safe_distance(sensor_radius=0.33, gap=math.radians(45.0)), 4)
    0.6098
    """
    angle = number("gap", gap)
    if not 0.0 <= angle <= 2.0 * math.pi:
        raise InvalidParameterError("gap", "be an angle from 0 to 2 pi", gap)
    return _hrsafety.skirt_safe_distance(sensor_radius=positive("sensor_radius", sensor_radius), gap=angle)
