"""Measured contact forces: transient and quasi-static parts of every contact, and what they mean for limits."""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _keys as kind
from hrsafety._arguments import Array, checked_text, columns, flag, not_negative, positive
from hrsafety._display import displayed
from hrsafety._keys import Keys, checked, parsed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, implausible, telling
from hrsafety.records import traces
from hrsafety.records.units import in_unit
from hrsafety.standards.verdicts import doubted, strictest

__all__ = ["ForceDevice", "ForceRecord", "MeasuredContact", "force", "load_device"]

QUIET = 0.020
"""Length of the quiet part, and longest dip within a contact, in s."""
TRANSIENT = 0.5
"""How long the transient part of a contact lasts, in s."""
_LONGER = 0.1
_CONTACT = 0.3
_SLOWEST = 1000.0
_ENDING = 8
"""The last one of so many parts of a quasi-static force is held against the one before."""
_RISING = 0.005
"""Share of the peak by which it may be higher."""
_SPRING = 0.05
_DEVIATIONS = 5.0


@dataclass(frozen=True, kw_only=True, slots=True)
class ForceDevice:
    """A device that stands in for a region of the body.

    Parameters
    ----------
    spring : float or None
        Spring constant in N/m.
    damping_shore : float or None
        Hardness of its damping layer, Shore A.
    range : float or None
        Largest force that it measures, in N.
    uncertainty : float or None
        Standard uncertainty of a force in N.
    calibrated : str or None
        When, as its certificate says.

    Examples
    --------
    >>> from hrsafety import records
    >>> records.ForceDevice(spring=75e3, range=500.0).spring
    75000.0
    """

    spring: Annotated[float | None, "N/m"] = None
    damping_shore: float | None = None
    range: Annotated[float | None, "N"] = None
    uncertainty: Annotated[float | None, "N"] = None
    calibrated: str | None = None

    def __post_init__(self) -> None:
        """Check every value."""
        for name in ("spring", "damping_shore", "range"):
            if getattr(self, name) is not None:
                positive(name, getattr(self, name))
        if self.uncertainty is not None:
            not_negative("uncertainty", self.uncertainty)
        if self.calibrated is not None:
            checked_text("calibrated", self.calibrated, "be a text or None")


_KEYS: Keys = {
    **dict.fromkeys(("spring", "damping_shore", "range", "uncertainty"), kind.number),
    "calibrated": kind.word,
}


def load_device(path: str | PathLike[str]) -> ForceDevice:
    r"""Return the device of a TOML file.

    Parameters
    ----------
    path : path-like
        File with any of ``spring`` (N/m), ``damping_shore``, ``range`` (N), ``uncertainty`` (N), ``calibrated`` (text).

    Returns
    -------
    ForceDevice
        The device.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, has another key, or a value is out of range.

    Examples
    --------
    >>> from pathlib import Path
    >>> from hrsafety import records
    >>> _ = Path("device.toml").write_text("spring = 75e3\nrange = 500.0\n")
    >>> records.load_device("device.toml").range
    500.0
    """
    return ForceDevice(**checked("", parsed(Path(path)), _KEYS))


@displayed
class MeasuredContact(NamedTuple):
    """A contact of a force record.

    Attributes
    ----------
    start, end : float or None
        In s; ``None`` where the record begins or ends within it.
    transient : float
        Largest force within 0.5 s of its start, in N.
    quasi_static : float or None
        Largest force after that in N, 0 if it was released before, ``None`` where the record is too short to tell.
    ends : {"released", "clamped", "too_short"}
        How it ends.
    """

    start: Annotated[float | None, "s"]
    end: Annotated[float | None, "s"]
    transient: Annotated[float, "N"]
    quasi_static: Annotated[float | None, "N"]
    ends: Literal["released", "clamped", "too_short"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ForceRecord:
    """Forces of a measured contact.

    Attributes
    ----------
    time : ndarray, shape (n,)
        In s.
    force : ndarray, shape (n,)
        Without offset, turned so that a push is positive, in N; for a wrong spring corrected to the careful side.
    peak : float
        Largest force in N.
    peak_time : float
        When it is reached, in s.
    transient : float
        Largest one of all transient parts, in N.
    quasi_static : float or None
        Largest one of all quasi-static parts, in N; ``None`` where the record is too short to tell.
    offset : float
        Force at rest that was taken off, in N.
    noise : float
        Root mean square of the rest in N.
    contacts : tuple of MeasuredContact
        In their order.
    warnings : tuple of ResultWarning
        ``negative_axis``, ``offset_removed``, ``several_contacts`` and ``wrong_spring`` are accounted for;
        ``no_quiet_part``, ``offset``, ``saturated``, ``coarse_sampling``, ``starts_inside``, ``ends_inside``,
        ``too_short`` and ``implausible`` may hide loads.
    """

    time: Annotated[Array, "s"]
    force: Annotated[Array, "N"]
    peak: Annotated[float, "N"]
    peak_time: Annotated[float, "s"]
    transient: Annotated[float, "N"]
    quasi_static: Annotated[float | None, "N"]
    offset: Annotated[float, "N"]
    noise: Annotated[float, "N"]
    contacts: tuple[MeasuredContact, ...]
    warnings: tuple[ResultWarning, ...]

    def verdict(
        self,
        *,
        transient: float | None = None,
        quasi_static: float | None = None,
        clamped: bool = True,
        strict: bool = True,
    ) -> str:
        """Return what the forces mean for limits.

        Parameters
        ----------
        transient, quasi_static : float or None
            Limits in N; one that is needed and not given is not checked.
        clamped : bool
            Whether the body part was fixed. A free one is judged by the transient limit alone; a clamped one by its
            transient part against the transient, its quasi-static part against the quasi-static limit.
        strict : bool
            Whether the peak of a clamped contact counts against the quasi-static limit, too.

        Returns
        -------
        str
            ``"within_limits"``, ``"exceeds"``, or ``"not_checked"`` where a limit or a load is not known, or a doubt
            may lie on the unsafe side.

        Raises
        ------
        InvalidParameterError
            If a limit is not positive.
        """
        pairs: list[tuple[float | None, float | None, str]] = [(self.transient, transient, "transient")]
        if flag("clamped", clamped):
            pairs.append((self.quasi_static, quasi_static, "quasi_static"))
            if flag("strict", strict):
                pairs.append((self.peak, quasi_static, "quasi_static"))
        return doubted(strictest(_word(load, limit, name) for load, limit, name in pairs), self.warnings)


def _word(load: float | None, limit: float | None, name: str) -> str:
    """Return what a load means for a limit."""
    bound = None if limit is None else positive(name, limit)
    if load is None or bound is None:
        return "not_checked"
    return "exceeds" if load > bound else "within_limits"


@telling()
def force(
    time: npt.ArrayLike,
    values: npt.ArrayLike,
    *,
    unit: str = "N",
    device: ForceDevice | None = None,
    region_spring: float | None = None,
) -> ForceRecord:
    """Return the forces of a measured contact.

    The offset is the median of the quietest 20 ms before the peak; the signal is turned so that its largest value is
    positive. A contact lasts while the force is above 5 % of the peak, or three times the noise, over dips of 20 ms.

    Parameters
    ----------
    time : array_like, shape (n,)
        Even times in s.
    values : array_like, shape (n,)
        Force.
    unit : {"N", "kN", "daN", "lbf"}
        Of the values.
    device : ForceDevice or None
        The device, for its range and spring.
    region_spring : float or None
        Spring constant in N/m of the region that is judged. A spring of the device that differs by more than 5 % is
        told, and forces grow by the region's over the device's where that is above 1.

    Returns
    -------
    ForceRecord
        Contacts, their transient and quasi-static forces, and doubts.

    Raises
    ------
    InvalidParameterError
        If times do not rise evenly, a value is not finite, or a unit is unknown.
    ShapeError
        If the arrays do not fit.

    Examples
    --------
    A hand is hit with 180 N and let go:

    >>> import numpy as np
    >>> from hrsafety import records
    >>> time = np.arange(0.0, 1.0, 5e-4)
    >>> push = np.where((time >= 0.2) & (time <= 0.26), 180.0 * np.sin(np.pi * (time - 0.2) / 0.06), 0.0)
    >>> found = records.force(time, push)
    >>> round(found.transient), found.quasi_static, found.contacts[0].ends
    (180, 0.0, 'released')
    >>> found.verdict(transient=280.0, quasi_static=140.0, clamped=False)
    'within_limits'
    """
    instants, given = columns(time=time, values=values)
    for name, array in (("time", instants), ("values", given)):
        if not np.isfinite(array).all():
            raise InvalidParameterError(name, "be finite", float(array[~np.isfinite(array)][0]))
    step = traces.even_step(instants)
    raw = in_unit("unit", given, unit, "force")
    window = traces.window_samples(QUIET, step)
    sizes = np.abs(raw - np.median(raw[: max(window, 1)]))
    about = int(np.argmax(sizes))
    resting = traces.rest(raw[:, None], about, float(sizes[about]), window)
    moved = raw - resting.offset[0]
    turned = -moved.min() > moved.max()
    signal = -moved if turned else moved
    stiffer = _stiffer(device, region_spring)
    signal = signal * stiffer[0]
    place = int(np.argmax(signal))
    peak = float(signal[place])
    level = traces.threshold(peak, resting.noise * stiffer[0])
    parts = traces.parts(instants, signal, level, QUIET) if peak > 0.0 else []
    contacts = tuple(_contact(instants, signal, part) for part in parts)
    full_scale = None if device is None else device.range
    doubts = [
        *traces.rest_doubts(resting, peak, "N", QUIET, ""),
        *_doubts(contacts, (turned, traces.full(instants, raw, full_scale)), peak, step),
        *traces.shape_doubts(instants, signal, "N", QUIET),
        *(_rising(instants, signal, contacts[-1], peak, resting.noise * stiffer[0]) if contacts else ()),
        *(implausible({"peak of values": peak}, {"peak of values": "peak_contact_force"}) if contacts else ()),
        *stiffer[1],
    ]
    lasting = [contact.quasi_static for contact in contacts]
    return ForceRecord(
        time=instants,
        force=signal,
        peak=peak,
        peak_time=float(instants[place]),
        transient=max((contact.transient for contact in contacts), default=0.0),
        quasi_static=None if None in lasting else max((each for each in lasting if each is not None), default=0.0),
        offset=float(resting.offset[0]),
        noise=resting.noise,
        contacts=contacts,
        warnings=tuple(doubts),
    )


def _contact(time: Array, signal: Array, part: traces.Part) -> MeasuredContact:
    """Return the forces of a contact."""
    inside = slice(part.first, part.last + 1)
    instants, forces = time[inside], signal[inside]
    window = (part.start if part.start is not None else float(time[0])) + TRANSIENT
    early = instants <= window
    transient, after = float(forces[early].max()), forces[~early]
    if part.end is None and time[-1] < window + _LONGER:
        return MeasuredContact(part.start, None, transient, None, "too_short")
    quasi_static = float(after.max()) if len(after) else 0.0
    return MeasuredContact(part.start, part.end, transient, quasi_static, "clamped" if part.end is None else "released")


def _doubts(
    contacts: tuple[MeasuredContact, ...], found: tuple[bool, bool], peak: float, step: float
) -> Iterator[ResultWarning]:
    """Give what is doubtful about contacts and how they were measured."""
    turned, flat = found
    if turned:
        message = "the larger part of the force is negative: it was turned, and a push is positive now"
        yield ResultWarning("negative_axis", "values", message, safe_side=True)
    if flat:
        message = "the largest values are equal neighbors, or the range of the device: forces are lower bounds"
        yield ResultWarning("saturated", "values", message)
    if not contacts:
        yield ResultWarning("no_push", "values", "no value is above the rest: nothing was measured")
    if any(contact.start is None for contact in contacts):
        message = "the record begins within a contact: its forces are lower bounds"
        yield ResultWarning("starts_inside", "time", message)
    if any(contact.ends == "too_short" for contact in contacts):
        message = (
            f"the record ends less than {_LONGER:g} s after the transient part of a contact that lasts: its "
            "quasi-static force is not known; record longer"
        )
        yield ResultWarning("too_short", "time", message)
    large = sum(max(contact.transient, contact.quasi_static or 0.0) >= _CONTACT * peak for contact in contacts)
    if large > 1:
        message = f"there are {large} contacts of at least {_CONTACT:.0%} of the peak: the largest of each part counts"
        yield ResultWarning("several_contacts", "values", message, safe_side=True)
    if 1.0 / step < _SLOWEST * (1.0 - 1e-6):
        message = f"{1.0 / step:.5g} samples per second are fewer than {_SLOWEST:g}: peaks may lie between them"
        yield ResultWarning("coarse_sampling", "time", message)


def _rising(time: Array, signal: Array, contact: MeasuredContact, peak: float, noise: float) -> Iterator[ResultWarning]:
    """Give the doubt that the quasi-static part of the last contact still rises where the record ends."""
    if contact.ends != "clamped":
        return
    static = signal[time > (float(time[0]) if contact.start is None else contact.start) + TRANSIENT]
    if len(static) < 2 * _ENDING:
        return  # too few samples, which is a doubt of its own
    *_, before, last = np.array_split(static, _ENDING)
    rise = float(last.mean() - before.mean())
    if rise > max(_RISING * peak, _DEVIATIONS * noise / len(last) ** 0.5):
        message = (
            f"the force still rises where the record ends, by {rise:.3g} N in the last "
            f"{_ENDING}th of its quasi-static part: it may become larger; record until it is steady"
        )
        yield ResultWarning("ends_inside", "time", message)


def _stiffer(device: ForceDevice | None, region_spring: float | None) -> tuple[float, tuple[ResultWarning, ...]]:
    """Return by how much forces grow for the spring of a region, and the doubt about the device's."""
    wanted = None if region_spring is None else positive("region_spring", region_spring)
    if device is None or device.spring is None or wanted is None:
        return 1.0, ()
    ratio = wanted / device.spring
    if abs(device.spring / wanted - 1.0) <= _SPRING:
        return 1.0, ()
    message = (
        f"the device has a spring of {device.spring:g} N/m, the region one of {wanted:g} N/m: forces were multiplied "
        f"by {max(ratio, 1.0):.4g}"
    )
    return max(ratio, 1.0), (ResultWarning("wrong_spring", "device", message, safe_side=True),)
