"""Three microphones in a row: delays of a sound, parallel rays, the range formula as printed."""

from __future__ import annotations

from dataclasses import field
from typing import Literal

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, instance, numbers, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["MicrophoneArray", "microphone_elevations", "parallel_ray_bearing", "parallel_ray_bias", "printed_range"]

MicrophonePair = Literal["12", "23", "13"]


@dataclass(frozen=True, kw_only=True, slots=True)
class MicrophoneArray(Parameters):
    """Three microphones M1, M2, M3 in a row across the direction of travel, evenly spaced.

    M2 is the origin and M3 is on the left. Bearings count from straight ahead, positive to the
    left. A row cannot tell front from back: the source is taken to be in front.

    Parameters
    ----------
    spacing : float
        Distance l of neighbors, in m. The default is that of the source of 2019.
    speed_of_sound : float
        c in m/s; `speed_of_sound` gives that of a temperature. The default, 340 m/s, is that of air
        of 14 degrees Celsius.

    Raises
    ------
    InvalidParameterError
        If a value is not finite and positive.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.MicrophoneArray()
    MicrophoneArray(spacing=0.4, speed_of_sound=340.0)
    """

    spacing: float = 0.4
    speed_of_sound: float = 340.0
    _native: _hrsafety.MicrophoneArray = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(_native=_hrsafety.MicrophoneArray(**self._as_numbers("spacing", "speed_of_sound")))

    def delays(self, *, range: npt.ArrayLike, bearing: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the exact delays of sources, by (7): dt_1i = (R_i - R_1) / c.

        Parameters
        ----------
        range : array_like
            Distance from M2, in m.
        bearing : array_like
            In rad; broadcast with the range.

        Returns
        -------
        delay_12, delay_13 : ndarray
            How much later than M1 the microphones M2 and M3 receive the source, in s.

        Raises
        ------
        InvalidParameterError
            If a range is negative or a value not finite.
        ShapeError
            If the arrays do not broadcast.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> delay_12, delay_13 = reactive.MicrophoneArray().delays(range=2.0, bearing=0.0)
        >>> round(float(delay_12) * 1e6, 1), round(float(delay_13) * 1e6, 1)
        (-116.5, 0.0)
        """
        distance, angle = same_shape(range=range, bearing=bearing)
        check_finite("range", distance)
        check_finite("bearing", angle)
        if (distance < 0.0).any():
            raise InvalidParameterError("range", "be finite and not negative", float(distance[distance < 0.0][0]))
        found = _hrsafety.microphone_delays(self._native, distance.ravel(), angle.ravel())
        return found["delay_12"].reshape(distance.shape), found["delay_13"].reshape(distance.shape)


def parallel_ray_bearing(
    array: MicrophoneArray, *, delay_12: npt.ArrayLike, delay_13: npt.ArrayLike, pair: MicrophonePair = "13"
) -> Array:
    """Return the bearing of a source that is far away, from one pair of microphones.

    Corrected (10): th = -asin(c dt / d), with the delay dt and the distance d of the pair. The
    printed acos(c dt / d) is the angle from the row, while the tables have the angle from straight
    ahead. Rays are never quite parallel: see `parallel_ray_bias`, and `locate` for the exact bearing.

    Parameters
    ----------
    array : MicrophoneArray
        The microphones.
    delay_12, delay_13 : array_like
        Delays of M2 and M3 against M1, in s.
    pair : str
        ``"12"``, ``"23"`` or ``"13"``, the two microphones.

    Returns
    -------
    ndarray
        In rad, positive to the left; NaN where the delay is longer than sound needs from one of the
        pair to the other. It is never cut to that.

    Raises
    ------
    InvalidParameterError
        If the pair is unknown or a delay is no number.
    ShapeError
        If the delays do not broadcast.

    Examples
    --------
    A source straight ahead at 1 m seems to be 11 degrees to the side:

    >>> import math
    >>> from hrsafety import reactive
    >>> row = reactive.MicrophoneArray()
    >>> delay_12, delay_13 = row.delays(range=1.0, bearing=0.0)
    >>> seen = reactive.sound.parallel_ray_bearing(row, delay_12=delay_12, delay_13=delay_13, pair="12")
    >>> round(math.degrees(seen), 1)
    11.1
    """
    own = instance("array", array, MicrophoneArray)
    chosen = word("pair", pair, ("12", "23", "13"))
    first, second = same_shape(delay_12=delay_12, delay_13=delay_13)
    bearings: Array = _hrsafety.parallel_ray_bearings(own._native, chosen, first.ravel(), second.ravel())["bearing"]
    return bearings.reshape(first.shape)


def parallel_ray_bias(
    array: MicrophoneArray, *, range: npt.ArrayLike, bearing: npt.ArrayLike, pair: MicrophonePair = "13"
) -> Array:
    """Return by how much parallel rays miss the bearing of a source, without any noise.

    Parameters
    ----------
    array : MicrophoneArray
        The microphones.
    range, bearing : array_like
        Where the source is, in m from M2 and rad.
    pair : str
        ``"12"``, ``"23"`` or ``"13"``, the two microphones.

    Returns
    -------
    ndarray
        Bearing by parallel rays less the true one, in rad.

    Raises
    ------
    InvalidParameterError
        If the pair is unknown, a range is negative or a value not finite.
    ShapeError
        If the arrays do not broadcast.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import reactive
    >>> row = reactive.MicrophoneArray()
    >>> bias = reactive.sound.parallel_ray_bias(row, range=[1.0, 2.0, 4.0], bearing=np.radians(30.0))
    >>> np.degrees(bias).round(2).tolist()
    [-1.87, -0.49, -0.12]
    """
    own = instance("array", array, MicrophoneArray)
    delay_12, delay_13 = own.delays(range=range, bearing=bearing)
    seen = parallel_ray_bearing(own, delay_12=delay_12, delay_13=delay_13, pair=pair)
    return np.asarray(seen - numbers("bearing", bearing))


def microphone_elevations(array: MicrophoneArray, *, range: npt.ArrayLike, bearing: npt.ArrayLike) -> Array:
    """Return the angles between the row and a source, seen from each microphone.

    Corrected (9) to (11) of Kim and Lee (2017): th_i = asin(h/R_i), or pi - asin(h/R_i) for a
    microphone that lies farther to the left than the source, with the normal distance h of the source from the
    row and the range R_i = D + c t_i of the microphone. The printed asin(D/(D + c t_i)) takes the
    common offset D of all ranges for h, and its third line the wrong delay.

    Parameters
    ----------
    array : MicrophoneArray
        The microphones.
    range, bearing : array_like
        Where the source is, in m from M2 and rad from straight ahead, in front of the row.

    Returns
    -------
    ndarray, shape (..., 3)
        Angles at M1, M2, M3 from the row's direction towards M3, in rad, from 0 to pi.

    Raises
    ------
    InvalidParameterError
        If a range is not positive, or a bearing not below a quarter turn.
    ShapeError
        If the arrays do not broadcast.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import reactive
    >>> angles = reactive.sound.microphone_elevations(reactive.MicrophoneArray(), range=0.4, bearing=0.0)
    >>> np.degrees(angles).round(6).tolist()
    [45.0, 90.0, 135.0]
    """
    own = instance("array", array, MicrophoneArray)
    distance, angle = same_shape(range=range, bearing=bearing)
    check_finite("range", distance)
    check_finite("bearing", angle)
    if (distance <= 0.0).any():
        raise InvalidParameterError("range", "be finite and positive", float(distance[distance <= 0.0][0]))
    behind = np.abs(angle) >= np.pi / 2.0
    if behind.any():
        raise InvalidParameterError("bearing", "be below a quarter turn: in front of the row", float(angle[behind][0]))
    elevations: Array = _hrsafety.microphone_elevations(own._native, distance.ravel(), angle.ravel())["elevation"]
    return elevations.reshape((*distance.shape, 3))


def printed_range(array: MicrophoneArray, *, delay_12: npt.ArrayLike, delay_13: npt.ArrayLike) -> Array:
    """Return what the printed range formula (9) gives; it is wrong, `locate` has the right one.

    Printed: D = [l^2 + l c (dt12 + dt13) - c^2 (dt12^2 + dt12 dt13 + dt13^2)] / [2 c (dt12 + dt13)].
    It belongs to no microphone and not to the distance from the row either.

    Parameters
    ----------
    array : MicrophoneArray
        The microphones.
    delay_12, delay_13 : array_like
        Delays of M2 and M3 against M1, in s.

    Returns
    -------
    ndarray
        In m; infinite or NaN where the delays add up to zero.

    Raises
    ------
    InvalidParameterError
        If a delay is no number.
    ShapeError
        If the delays do not broadcast.

    Examples
    --------
    A source at 2 m and 20 degrees:

    >>> import math
    >>> from hrsafety import reactive
    >>> row = reactive.MicrophoneArray()
    >>> delay_12, delay_13 = row.delays(range=2.0, bearing=math.radians(20.0))
    >>> round(float(reactive.sound.printed_range(row, delay_12=delay_12, delay_13=delay_13)), 2)
    0.18
    """
    own = instance("array", array, MicrophoneArray)
    first, second = same_shape(delay_12=delay_12, delay_13=delay_13)
    ranges: Array = _hrsafety.printed_ranges(own._native, first.ravel(), second.ravel())["range"]
    return ranges.reshape(first.shape)


def same_shape(**values: npt.ArrayLike) -> tuple[Array, ...]:
    """Return the values as contiguous arrays of the shape that they broadcast to."""
    arrays = {name: numbers(name, value) for name, value in values.items()}
    shape: tuple[int, ...] = ()
    for name, array in arrays.items():
        try:
            shape = np.broadcast_shapes(shape, array.shape)
        except ValueError:
            raise ShapeError(name, f"that broadcasts with {shape}", array.shape) from None
    return tuple(np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(shape) for array in arrays.values())


def check_finite(name: str, values: Array) -> None:
    """Raise unless all values are finite."""
    bad = ~np.isfinite(values)
    if bad.any():
        raise InvalidParameterError(name, "be finite", float(values[bad][0]))
