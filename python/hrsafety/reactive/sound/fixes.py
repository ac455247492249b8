"""Where a sound comes from: exact range and bearing from two delays, with their uncertainty."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import field
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, callback, instance, not_negative, square, thread_count
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.reactive.sound.microphones import MicrophoneArray, same_shape
from hrsafety.tables import Columns, Table, plane

__all__ = ["Fix", "Fixes", "locate", "locate_batch"]

STATUS_WORDS: tuple[str, ...] = tuple(_hrsafety.fix_status_words())
# A quarter of a sample at 100 kHz, in s.
QUARTER_SAMPLE = 2.5e-6


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Fix:
    """Range and bearing of one sound.

    Attributes
    ----------
    range : float
        Distance from the middle microphone M2, in m; NaN without a fix.
    bearing : float
        Angle from straight ahead, positive to the left, in rad; NaN without a fix.
    covariance : ndarray of shape (2, 2)
        Of range (m) and bearing (rad), to first order in the jitter of the delays.
    curvature : float
        c (t_1 - 2 t_2 + t_3) in m, what the range comes from.
    status : str
        ``"fix"``; ``"no_delay"``: a delay is NaN; ``"delay_too_long"``: longer than sound needs
        between the microphones; ``"no_curvature"``: the wave front is not that of a source in front.
    """

    range: Annotated[float, "m"]
    bearing: Annotated[float, "rad"]
    covariance: Array
    curvature: Annotated[float, "m"]
    status: str

    @property
    def found(self) -> bool:
        """Whether there is a fix."""
        return self.status == "fix"

    @property
    def position(self) -> Pair:
        """Place (x ahead, y to the left) in m, from M2."""
        return (self.range * math.cos(self.bearing), self.range * math.sin(self.bearing))

    @property
    def range_deviation(self) -> float:
        """Standard deviation of the range, in m."""
        return math.sqrt(self.covariance[0, 0])

    @property
    def bearing_deviation(self) -> float:
        """Standard deviation of the bearing, in rad."""
        return math.sqrt(self.covariance[1, 1])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Fixes(Table):
    """Ranges and bearings of many sounds: the fields of `Fix` as arrays of the broadcast shape.

    Attributes
    ----------
    range : ndarray
        Distances from M2, in m; NaN without a fix.
    bearing : ndarray
        In rad; NaN without a fix.
    covariance : ndarray of shape (..., 2, 2)
        Of range (m) and bearing (rad).
    curvature : ndarray
        c (t_1 - 2 t_2 + t_3) in m.
    """

    range: Annotated[Array, "m"]
    bearing: Annotated[Array, "rad"]
    covariance: Array
    curvature: Annotated[Array, "m"]
    _status_code: npt.NDArray[np.uint8] = field(repr=False)

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """Words of `Fix.status`."""
        return np.asarray(np.asarray(STATUS_WORDS)[self._status_code])

    @property
    def found(self) -> npt.NDArray[np.bool_]:
        """Whether there is a fix."""
        return np.asarray(self._status_code == STATUS_WORDS.index("fix"))

    @property
    def position(self) -> Array:
        """Places (x ahead, y to the left) in m, from M2; the last axis has two values."""
        return np.stack([self.range * np.cos(self.bearing), self.range * np.sin(self.bearing)], axis=-1)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each sound.

        Returns
        -------
        dict of str to ndarray
            Units are in the names.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> row = reactive.MicrophoneArray()
        >>> delay_12, delay_13 = row.delays(range=[1.0, 2.0, 3.0], bearing=0.5)
        >>> list(reactive.locate_batch(row, delay_12=delay_12, delay_13=delay_13).columns())[:3]
        ['status', 'range_m', 'bearing_rad']
        """
        found: Columns = {"status": self.status.ravel(), "range_m": self.range.ravel()}
        found |= {"bearing_rad": self.bearing.ravel(), "curvature_m": self.curvature.ravel()}
        found |= plane("{}", self.position.reshape(-1, 2), "m")
        found |= {"range_deviation_m": self.range_deviation.ravel()}
        return found | {"bearing_deviation_rad": self.bearing_deviation.ravel()}

    @property
    def range_deviation(self) -> Array:
        """Standard deviations of the ranges, in m."""
        return np.asarray(np.sqrt(self.covariance[..., 0, 0]))

    @property
    def bearing_deviation(self) -> Array:
        """Standard deviations of the bearings, in rad."""
        return np.asarray(np.sqrt(self.covariance[..., 1, 1]))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of every field but the covariance."""
        return self._status_code.shape

    def __len__(self) -> int:
        """Return the length of the first axis."""
        return len(self._status_code)


def locate(
    array: MicrophoneArray,
    *,
    delay_12: float,
    delay_13: float,
    arrival_deviation: float = QUARTER_SAMPLE,
    delay_covariance: npt.ArrayLike | None = None,
) -> Fix:
    """Return range and bearing of a sound from the delays of M2 and M3 against M1.

    Corrected (9): R1 = [2 l^2 + 2 (c dt12)^2 - (c dt13)^2] / [2 c (dt13 - 2 dt12)], from the equal
    areas (8-a) and (8-b); R2 = R1 + c dt12. In place of the parallel rays of (10) the bearing is
    exact, sin th = (R1^2 - R3^2) / (4 l R2). There is no fix without curvature and none with a delay
    that cannot be; nothing is cut to what could be.

    Parameters
    ----------
    array : MicrophoneArray
        The microphones.
    delay_12, delay_13 : float
        dt_12 and dt_13 in s, positive when the other microphone receives it later than M1; NaN where none
        was measured.
    arrival_deviation : float
        Standard deviation of the independent jitter of each of the three arrivals, in s. The
        default is a quarter of a sample at 100 kHz.
    delay_covariance : array_like of shape (2, 2) or None
        Covariance of the two delays in s^2, in place of what follows from the jitter.

    Returns
    -------
    Fix
        With covariance and status.

    Raises
    ------
    InvalidParameterError
        If a delay is no number, or the jitter or the covariance cannot be.
    ShapeError
        If the covariance is not (2, 2).

    Examples
    --------
    >>> import math
    >>> from hrsafety import reactive
    >>> row = reactive.MicrophoneArray()
    >>> delay_12, delay_13 = row.delays(range=3.0, bearing=math.radians(30.0))
    >>> fix = reactive.locate(row, delay_12=delay_12, delay_13=delay_13)
    >>> round(fix.range, 9), round(math.degrees(fix.bearing), 9), round(fix.range_deviation, 3)
    (3.0, 30.0, 0.157)
    >>> reactive.locate(row, delay_12=1e-4, delay_13=1e-4).status
    'no_curvature'
    """
    first, second = same_shape(delay_12=delay_12, delay_13=delay_13)
    for name, value in (("delay_12", delay_12), ("delay_13", delay_13)):
        if np.ndim(value) != 0:
            raise InvalidParameterError(name, "be one number; locate_batch takes arrays", value)
    covariance = _delay_covariance(arrival_deviation, delay_covariance)
    found = _located(array, first.ravel(), second.ravel(), covariance)
    return Fix(
        range=float(found["range"][0]),
        bearing=float(found["bearing"][0]),
        covariance=found["covariance"][0],
        curvature=float(found["curvature"][0]),
        status=STATUS_WORDS[found["status_code"][0]],
    )


def locate_batch(
    array: MicrophoneArray,
    *,
    delay_12: npt.ArrayLike,
    delay_13: npt.ArrayLike,
    arrival_deviation: float = QUARTER_SAMPLE,
    delay_covariance: npt.ArrayLike | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Fixes:
    """Return ranges and bearings of many sounds, by the equations of `locate`.

    Parameters
    ----------
    array : MicrophoneArray
        The microphones.
    delay_12, delay_13 : array_like
        In s; they broadcast.
    arrival_deviation : float
        Standard deviation of the jitter of each arrival, in s.
    delay_covariance : array_like of shape (2, 2) or None
        Covariance of the two delays in s^2, in place of what follows from the jitter.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``. Never changes a bit.
    progress : callable or None
        Called now and then as ``progress(done, total)``, and at the end.

    Returns
    -------
    Fixes
        Arrays of the broadcast shape; a row without a fix is NaN and says why.

    Raises
    ------
    InvalidParameterError
        If a delay is no number, or an option is out of range.
    ShapeError
        If the delays do not broadcast or the covariance is not (2, 2).
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import reactive
    >>> row = reactive.MicrophoneArray()
    >>> delay_12, delay_13 = row.delays(range=[1.0, 2.0, 3.0], bearing=0.5)
    >>> fixes = reactive.locate_batch(row, delay_12=delay_12, delay_13=delay_13)
    >>> fixes.range.round(9).tolist(), fixes.found.all()
    ([1.0, 2.0, 3.0], np.True_)
    """
    first, second = same_shape(delay_12=delay_12, delay_13=delay_13)
    covariance = _delay_covariance(arrival_deviation, delay_covariance)
    found = _located(
        array, first.ravel(), second.ravel(), covariance, threads=checked_threads(threads), progress=progress
    )
    shape = first.shape
    return Fixes(
        range=found["range"].reshape(shape),
        bearing=found["bearing"].reshape(shape),
        covariance=found["covariance"].reshape(*shape, 2, 2),
        curvature=found["curvature"].reshape(shape),
        _status_code=found["status_code"].reshape(shape),
    )


def checked_threads(threads: int | None) -> int | None:
    """Return the number of threads, or say what it should have been."""
    return thread_count(threads)


def _located(
    array: MicrophoneArray,
    first: Array,
    second: Array,
    covariance: list[float],
    *,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Any:
    return _hrsafety.locate_sounds(
        instance("array", array, MicrophoneArray)._native,
        first,
        second,
        covariance=covariance,
        threads=threads,
        progress=callback("progress", progress),
    )


def _delay_covariance(arrival_deviation: float, given: npt.ArrayLike | None) -> list[float]:
    """Return variance of dt_12, covariance, variance of dt_13 in s^2."""
    deviation = not_negative("arrival_deviation", arrival_deviation)
    variance = deviation * deviation
    if not np.isfinite(2.0 * variance):
        raise InvalidParameterError("arrival_deviation", "have a finite square", arrival_deviation)
    if given is None:
        return [2.0 * variance, variance, 2.0 * variance]
    matrix = square("delay_covariance", given, 2)
    symmetric = np.isfinite(matrix).all() and matrix[0, 1] == matrix[1, 0]
    if not symmetric or np.linalg.eigvalsh(matrix)[0] < -1e-12 * abs(np.trace(matrix)):
        raise InvalidParameterError("delay_covariance", "be symmetric and not negative", matrix.tolist())
    return [float(matrix[0, 0]), float(matrix[0, 1]), float(matrix[1, 1])]
