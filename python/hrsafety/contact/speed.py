"""Allowed closing speeds, and what they hang on."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, not_negative, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.contact.bodies import OWN, BodyPart, agreeing, contact_width_doubt, larger_than_part, touched_area
from hrsafety.contact.covering import Covering
from hrsafety.contact.doubts import (
    Doubts,
    counted,
    covering_flags,
    flagged,
    implausible_numbers,
    not_checked,
    without_drive,
)
from hrsafety.contact.many import many, words_at
from hrsafety.contact.rows import Prepared, in_order, missing_limits
from hrsafety.contact.simulation import arrays_of, known
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table

__all__ = [
    "AllowedSpeed",
    "AllowedSpeeds",
    "allowed_of",
    "free_from_fixed_force",
    "speeds_of",
]

_GOVERNS = ("force", "pressure", "strain", "nothing")
_FLAGS = ("rising", "outside_paraboloid", "beyond_pad", "edge")


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class AllowedSpeed:
    """A closing speed at which every limit is just kept.

    Attributes
    ----------
    speed : float or None
        In m/s; ``None`` where nothing limits it.
    governs : {"force", "pressure", "strain", "nothing"}
        The limit that governs.
    status : str
        ``"closed_form"``; ``"monotone"`` or ``"several_crossings"`` by simulation (then the lowest one);
        ``"unlimited_up_to_20"``; ``"unbounded_mass"`` with speed 0; ``"not_checked"`` without a limit;
        ``"unfinished"`` if a simulation did not end, so that nothing is known.
    speeds : dict of str to float or None
        Speed at each limit by itself; ``None`` where it is not there or beyond the data.
    bare_speed_force : float or None
        Speed at the force limit without covering.
    further : tuple of float
        Further crossings in m/s.
    not_checked : tuple of str
        Limits that were not checked; they never count as kept.
    covering_compression : float or None
        Compression of the covering at the speed in m.
    warnings : tuple of ResultWarning
        Why the speed may not be what it seems: limits that are not checked, a clamped contact without the drive of the
        robot, loads that still rise at the horizon of a simulation, a covering outside its model, implausible numbers.
    robot_speed : float or None
        Closing speed less the speed of the person towards the robot, at least 0.
    human_speed : float
        That speed, in m/s.
    """

    speed: Annotated[float | None, "m/s"]
    governs: str
    status: str
    speeds: dict[str, float | None]
    bare_speed_force: float | None
    further: Annotated[tuple[float, ...], "m/s"]
    not_checked: tuple[str, ...]
    covering_compression: Annotated[float | None, "m"]
    warnings: Doubts
    robot_speed: float | None
    human_speed: Annotated[float, "m/s"]


def allowed_of(given: Prepared, human_speed: float) -> AllowedSpeed:
    """Return the closing speed at which a contact just keeps its limits."""
    shared, values, pad, limits, doubts = given
    walking = not_negative("human_speed", human_speed)
    found = _hrsafety.contact_speed(shared, in_order(values))
    speed = known(found["speed"])
    missing = missing_limits(values, bare=pad is None)
    flags = {"unfinished": found["status"] == "unfinished", "rising": found["rising"]}
    flags |= covering_flags(pad, found["covering_compression"], values)
    larger, part = larger_than_part(pad, found["covering_compression"], values, limits)
    wide: Doubts = ()
    if larger and part is not None:
        wide = (_too_wide(pad, shared, values, part, found["covering_compression"]),)
    return AllowedSpeed(
        speed=speed,
        governs=found["governs"],
        status=found["status"],
        speeds=dict(zip(("force", "pressure", "strain"), map(known, found["speeds"]), strict=True)),
        bare_speed_force=known(found["bare_speed_force"]),
        further=tuple(found["further"]),
        not_checked=missing,
        covering_compression=known(found["covering_compression"]),
        warnings=(
            *doubts,
            *not_checked(missing),
            *without_drive(values),
            *flagged(flags, pad, values),
            *wide,
            *implausible_numbers(pad, str(shared["region"]), values),
        ),
        robot_speed=None if speed is None else max(speed - walking, 0.0),
        human_speed=walking,
    )


def _too_wide(
    pad: Covering | None, shared: dict[str, object], values: dict[str, float], part: BodyPart, depth: float
) -> ResultWarning:
    """Return the doubt about a contact that is larger than the part of the body, with the speed at that area."""
    more = ""
    if pad is None or pad.shape == "flat":
        most = known(_hrsafety.contact_speed(shared, in_order(values | {"area": part.area}))["speed"])
        more = "" if most is None else f" (with that area {most:.3g} m/s is allowed)"
    return contact_width_doubt(pad, float(touched_area(pad, depth, values)), part, more)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class AllowedSpeeds(Table):
    """Allowed closing speeds as arrays of the broadcast shape, NaN where there is none.

    Attributes
    ----------
    speed, speed_force, speed_pressure, speed_strain, bare_speed_force : ndarray
        In m/s, as in `AllowedSpeed`.
    governs, status : ndarray of str
        As in `AllowedSpeed`, and ``"invalid_"`` with a name for rows with a bad number.
    covering_compression : ndarray
        Compression of the covering at the speed in m.
    rising, outside_paraboloid, beyond_pad, edge : ndarray of bool
        Whether loads of a simulation still rise at its horizon, and where the model of the covering does not
        hold, as in `Column`.
    not_checked : tuple of str
        Limits that were not checked in any row; they never count as kept.
    warnings : tuple of ResultWarning
        As in `AllowedSpeed`, with the number of rows.
    """

    speed: Annotated[Array, "m/s"]
    speed_force: Annotated[Array, "m/s"]
    speed_pressure: Annotated[Array, "m/s"]
    speed_strain: Annotated[Array, "m/s"]
    bare_speed_force: Annotated[Array, "m/s"]
    governs: npt.NDArray[np.str_]
    status: npt.NDArray[np.str_]
    covering_compression: Annotated[Array, "m"]
    rising: npt.NDArray[np.bool_]
    outside_paraboloid: npt.NDArray[np.bool_]
    beyond_pad: npt.NDArray[np.bool_]
    edge: npt.NDArray[np.bool_]
    not_checked: tuple[str, ...]
    warnings: Doubts

    def columns(self) -> Columns:
        """Return one-dimensional columns by name.

        Returns
        -------
        dict of str to ndarray
            Every field flattened.
        """
        return arrays_of(self)


def speeds_of(
    given: Prepared,
    arrays: Mapping[str, npt.ArrayLike],
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> AllowedSpeeds:
    """Return many allowed speeds: numbers of a contact as arrays."""
    shared, values, pad, limits, doubts = given
    for name, own in OWN.items():
        if name in arrays:
            agreeing(name, arrays[name], getattr(limits, own, None), limits)
    found = many("speed", (shared, values), arrays, pad, threads=threads, progress=progress)
    there = {name: 0.0 if name in arrays else values[name] for name in ("force_limit", "pressure_limit", "area")}
    missing = missing_limits(there, bare=pad is None)
    numbers: dict[str, Any] = dict(found.numbers)
    flags: dict[str, Any] = {name: found.flag(name) for name in _FLAGS}
    larger, part = larger_than_part(pad, numbers["covering_compression"], found.given, limits)
    wide: Doubts = ()
    if part is not None and np.any(larger):
        widest = float(np.nanmax(touched_area(pad, numbers["covering_compression"], found.given)))
        wide = (counted(contact_width_doubt(pad, widest, part), np.broadcast_to(larger, found.status.shape)),)
    codes = numbers.pop("governs_code")
    governs = words_at(_GOVERNS, codes)
    return AllowedSpeeds(
        **numbers,
        governs=governs,
        status=found.status,
        **flags,
        not_checked=missing,
        warnings=(*doubts, *not_checked(missing), *without_drive(found.given), *wide, *found.warnings),
    )


def free_from_fixed_force(*, force: float, robot_mass: float, body_mass: float) -> float:
    """Return the peak force on a free body from that on a fixed measuring device, for linear contacts.

    F_free = F_fixed sqrt(m_H/(m_R + m_H)).

    Parameters
    ----------
    force : float
        On the fixed device, in N.
    robot_mass, body_mass : float
        In kg.

    Returns
    -------
    float
        In N.

    Examples
    --------
    >>> from hrsafety import contact
    >>> round(contact.free_from_fixed_force(force=280.0, robot_mass=10.0, body_mass=0.6), 3)
    66.616
    """
    share = positive("body_mass", body_mass) / (positive("robot_mass", robot_mass) + body_mass)
    return positive("force", force) * math.sqrt(share)
