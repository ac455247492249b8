"""Measured accelerations: loads of the head over a whole record, and what is doubtful about it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, numbers, positive, vector
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.impact.criteria.filters import channel_corner, filtered_pulse, through_class
from hrsafety.impact.criteria.loads import whole_loads
from hrsafety.plausibility import ResultWarning, implausible, telling
from hrsafety.records import traces
from hrsafety.records.units import STANDARD_GRAVITY, in_unit
from hrsafety.standards.verdicts import doubted, strictest

__all__ = ["AccelerationRecord", "Hit", "acceleration"]

QUIET = 0.010
"""Length of the quiet part in s."""
BRIDGED = 0.001
"""Longest dip within a contact in s."""
_HIT = 0.3
_PER_CLASS = 8.0
_CRITERIA = ("peak_g", "hic15", "hic36", "clip_3ms_g")
_RESTS = ((9.80665, "m/s2"), (1.0, "g"))


class Hit(NamedTuple):
    """A part of a record with a peak of at least 30 % of the largest one.

    Attributes
    ----------
    time : float
        Of its peak in s.
    peak_g : float
        Peak in g.
    """

    time: float
    peak_g: float


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AccelerationRecord:
    """Loads of a measured acceleration.

    Attributes
    ----------
    time : ndarray, shape (n,)
        In s.
    signal_g : ndarray, shape (n,)
        Without offset, filtered, turned so that its peak is positive, or resultant of three axes, in g.
    peak_g : float
        Largest value in g.
    peak_time : float
        When it is reached, in s.
    hic15, hic36 : float
        Head injury criteria over the whole record.
    clip_3ms_g : float
        Level that is exceeded for 3 contiguous ms, over the whole record, in g; NaN for a record of less.
    start, end : float or None
        Impact period around the peak in s; ``None`` where the record begins or ends within it.
    velocity_change : float
        Integral over the impact period in m/s.
    offsets_g : ndarray, shape (axes,)
        Values at rest that were taken off, in g.
    noise_g : float
        Root mean square of the rest in g.
    hits : tuple of Hit
        Parts with peaks of at least 30 % of the largest one, in their order.
    warnings : tuple of ResultWarning
        ``negative_axis``, ``offset_removed``, ``several_hits`` and ``harder_later_hit`` change nothing about loads over
        the whole record; ``no_quiet_part``, ``offset``, ``saturated``, ``coarse_sampling``, ``filtered_pulse``,
        ``starts_inside``, ``no_release`` and ``implausible`` may.
    """

    time: Annotated[Array, "s"]
    signal_g: Annotated[Array, "g"]
    peak_g: Annotated[float, "g"]
    peak_time: Annotated[float, "s"]
    hic15: float
    hic36: float
    clip_3ms_g: Annotated[float, "g"]
    start: Annotated[float | None, "s"]
    end: Annotated[float | None, "s"]
    velocity_change: Annotated[float, "m/s"]
    offsets_g: Annotated[Array, "g"]
    noise_g: Annotated[float, "g"]
    hits: tuple[Hit, ...]
    warnings: tuple[ResultWarning, ...]

    def verdict(
        self,
        *,
        peak_g: float | None = None,
        hic15: float | None = None,
        hic36: float | None = None,
        clip_3ms_g: float | None = None,
    ) -> str:
        """Return what the loads mean for limits.

        Parameters
        ----------
        peak_g, hic15, hic36, clip_3ms_g : float or None
            Limits; at least one.

        Returns
        -------
        str
            ``"within_limits"``, ``"exceeds"``, or ``"not_checked"`` where a doubt may lie on the unsafe side or a load
            is not known.

        Raises
        ------
        InvalidParameterError
            If no limit is given, or one is not positive.
        """
        given = dict(zip(_CRITERIA, (peak_g, hic15, hic36, clip_3ms_g), strict=True))
        limits = {name: positive(name, value) for name, value in given.items() if value is not None}
        if not limits:
            raise InvalidParameterError("peak_g", f"or one of {', '.join(_CRITERIA[1:])} be given", None)
        words = []
        for name, limit in limits.items():
            load = getattr(self, name)
            words.append("not_checked" if np.isnan(load) else "exceeds" if load > limit else "within_limits")
        return doubted(strictest(words), self.warnings)


@telling()
def acceleration(
    time: npt.ArrayLike,
    values: npt.ArrayLike,
    *,
    unit: str = "m/s2",
    filter_class: int | None = None,
    full_scale: float | None = None,
) -> AccelerationRecord:
    """Return the loads of a measured acceleration, over the whole record.

    The offset of each axis is its median in the quietest 10 ms before the peak. One axis is turned so that its
    largest value is positive; of three axes the resultant counts. Peak, head injury criteria and 3 ms level are those
    of the whole record, so that neither noise before the contact nor a second hit hides anything.

    Parameters
    ----------
    time : array_like, shape (n,)
        Even times in s.
    values : array_like, shape (n,) or (n, 3)
        One axis, or three.
    unit : {"m/s2", "g"}
        Of the values.
    filter_class : int or None
        Channel class of SAE J211 through which every axis goes: 60, 180, 600 or 1000 (needs SciPy); ``None`` for
        records that were filtered before.
    full_scale : float or None
        Of the channel, in `unit`: values of 99.5 % of it are ``saturated``.

    Returns
    -------
    AccelerationRecord
        Loads, impact period, hits and doubts.

    Raises
    ------
    InvalidParameterError
        If times do not rise evenly, a value is not finite, or a unit is unknown.
    ShapeError
        If the arrays do not fit.

    Examples
    --------
    A half sine of 10 ms and 60 g on an axis that points backwards:

    >>> import numpy as np
    >>> from hrsafety import records
    >>> time = np.arange(0.0, 0.06, 5e-5)
    >>> pulse = np.where((time >= 0.02) & (time <= 0.03), 60.0 * np.sin(np.pi * (time - 0.02) / 0.01), 0.0)
    >>> found = records.acceleration(time, -pulse, unit="g")
    >>> round(found.peak_g, 1), round(found.hic15, 1), found.verdict(hic15=700.0)
    (60.0, 115.6, 'within_limits')
    """
    instants, given = vector("time", time), numbers("values", values)
    raw = given[:, None] if given.ndim == 1 else given
    if raw.ndim != 2 or len(raw) != len(instants) or raw.shape[1] not in (1, 3):
        raise ShapeError("values", f"have shape ({len(instants)},) or ({len(instants)}, 3)", given.shape)
    for name, array in (("time", instants), ("values", raw)):
        if not np.isfinite(array).all():
            raise InvalidParameterError(name, "be finite", float(array[~np.isfinite(array)][0]))
    step = traces.even_step(instants)
    axes = in_unit("unit", raw, unit, "acceleration") / STANDARD_GRAVITY
    sizes = np.linalg.norm(axes - np.median(axes, axis=0), axis=1)
    about = int(np.argmax(sizes))
    resting = traces.rest(axes, about, float(sizes[about]), traces.window_samples(QUIET, step))
    moved = axes - resting.offset
    lost: tuple[ResultWarning, ...] = ()
    if filter_class is not None:
        rate, corner = 1.0 / step, channel_corner(filter_class)
        if not corner < 0.5 * rate:
            rule = f"have a corner, {corner:g} Hz, below half of the {rate:.5g} samples per second"
            raise InvalidParameterError("filter_class", rule, filter_class, "take a lower class")
        before, moved = moved, np.column_stack([through_class(axis, rate, filter_class) for axis in moved.T])
        strongest = int(np.argmax(np.abs(before).max(axis=0)))
        lost = tuple(filtered_pulse(instants, before[:, strongest], filter_class, moved[:, strongest]))
    turned = moved.shape[1] == 1 and -moved.min() > moved.max()
    signal = np.linalg.norm(moved, axis=1) if moved.shape[1] == 3 else moved[:, 0] * (-1.0 if turned else 1.0)
    place = int(np.argmax(signal))
    peak = float(signal[place])
    level = traces.threshold(peak, resting.noise)
    parts = traces.parts(instants, signal, level, BRIDGED) if peak > 0.0 else []
    around = next((part for part in parts if part.first <= place <= part.last), None)
    tops = [traces.largest_of(signal, part) for part in parts]
    hits = tuple(Hit(float(instants[top]), size) for top, size in tops if size >= _HIT * peak)
    limit = None if full_scale is None else positive("full_scale", full_scale)
    flat = [traces.full(instants, raw[:, axis], limit) for axis in range(raw.shape[1])]
    loads = whole_loads(instants, signal)
    change = STANDARD_GRAVITY * traces.integral(instants, signal, around, level) if around else 0.0
    doubts = [
        *traces.rest_doubts(resting, peak, "g", QUIET, _likely_unit(resting.offset)),
        *_doubts(around, hits, peak, (turned, any(flat))),
        *_coarse(step, filter_class),
        *lost,
        *traces.shape_doubts(instants, signal, "g", QUIET),
        *(_units(peak, change) if around else ()),
    ]
    return AccelerationRecord(
        time=instants,
        signal_g=signal,
        peak_g=peak,
        peak_time=float(instants[place]),
        hic15=loads.hic15,
        hic36=loads.hic36,
        clip_3ms_g=loads.clip_3ms_g,
        start=around.start if around else None,
        end=around.end if around else None,
        velocity_change=change,
        offsets_g=resting.offset,
        noise_g=resting.noise,
        hits=hits,
        warnings=tuple(doubts),
    )


def _units(peak: float, change: float) -> tuple[ResultWarning, ...]:
    """Return the doubts about a peak in g and the velocity in m/s that the head gains by it."""
    named = {"peak of values": (peak, "recorded_peak_g"), "velocity_change": (change, "head_velocity_gain")}
    return implausible(
        {name: value for name, (value, _) in named.items()}, {name: quantity for name, (_, quantity) in named.items()}
    )


def _likely_unit(offset: Array) -> str:
    """Return what a rest near the acceleration of gravity says about the unit."""
    size = float(np.linalg.norm(offset)) * STANDARD_GRAVITY
    for rest, unit in _RESTS:
        if abs(size - rest) < 0.05 * rest:
            told = "" if unit == "m/s2" else ": is the unit g?"
            return f"; its size is {size:.3g} m/s2, gravity in {unit}{told}"
    return ""


def _doubts(
    around: traces.Part | None, hits: tuple[Hit, ...], peak: float, found: tuple[bool, bool]
) -> Iterator[ResultWarning]:
    """Give what is doubtful about the part around the peak, and about others."""
    turned, flat = found
    if turned:
        message = "the larger part of the axis is negative: it was turned, and a push is positive now"
        yield ResultWarning("negative_axis", "values", message, safe_side=True)
    if flat:
        message = "the largest values are equal neighbors, or the full scale of the channel: loads are lower bounds"
        yield ResultWarning("saturated", "values", message)
    if around is None:
        yield ResultWarning("no_push", "values", "no value is above the rest: nothing was measured")
        return
    if around.start is None:
        yield ResultWarning("starts_inside", "time", "the record begins within the contact: loads are lower bounds")
    if around.end is None:
        yield ResultWarning("no_release", "time", "the record ends within the contact: loads are lower bounds")
    if len(hits) > 1:
        shown = ", ".join(f"{hit.peak_g:.4g} g at {hit.time:.4g} s" for hit in hits[:4])
        message = f"there are {len(hits)} hits ({shown}): loads are those of the whole record"
        yield ResultWarning("several_hits", "values", message, safe_side=True)
        if hits[0].peak_g < peak:
            message = f"the first hit, {hits[0].peak_g:.4g} g, is not the hardest one, {peak:.4g} g"
            yield ResultWarning("harder_later_hit", "values", message, safe_side=True)


def _coarse(step: float, filter_class: int | None) -> Iterator[ResultWarning]:
    """Give the doubt that samples are too far apart for a channel class."""
    least = _PER_CLASS * (filter_class or 0)
    rate = 1.0 / step
    if rate < least * (1.0 - 1e-6):
        message = f"{rate:.5g} samples per second are fewer than the {least:g} that class {filter_class} needs"
        yield ResultWarning("coarse_sampling", "time", message)
