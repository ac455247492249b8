"""Collisions of a robot with a person through a covering."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, flag
from hrsafety._display import fields_with_units
from hrsafety._records import dataclass
from hrsafety.contact.bodies import OWN, agreeing
from hrsafety.contact.doubts import Doubts, covering_flags, flagged, implausible_numbers
from hrsafety.contact.many import many
from hrsafety.contact.rows import Prepared, in_order
from hrsafety.errors import InvalidParameterError
from hrsafety.tables import Columns, Table, unit_suffix

__all__ = ["ContactBatch", "ContactImpact", "impact_of", "impacts_of"]

GRAVITY = 9.80665
HEAD_MASS = 10.0
"""Bodies below this mass, in kg, may be a head, and get a head injury criterion unless told otherwise."""
_FOUND = (
    *("release_time", "peak_force", "peak_force_time", "peak_total_compression", "peak_body_deflection"),
    *("peak_covering_compression", "peak_strain", "peak_pressure", "rebound_speed", "body_speed_end"),
    *("hic15", "hic36", "end_force"),
)
_FLAGS = ("rising", "outside_paraboloid", "beyond_pad", "edge")


def arrays_of(result: Any) -> Columns:
    """Return the arrays of a result flattened, under their names with units."""
    named = {name: (getattr(result, name), unit) for name, unit in fields_with_units(type(result)).items()}
    return {
        f"{'t' if name == 'time' else name}{unit_suffix(unit)}": values.ravel()
        for name, (values, unit) in named.items()
        if isinstance(values, np.ndarray)
    }


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ContactImpact(Table):
    """Loads of a collision and its motion; a number that does not exist is ``None``.

    Attributes
    ----------
    status : {"released", "horizon", "no_impact", "unfinished"}
        How it ended; after ``"unfinished"`` no load is known, and after ``"horizon"`` loads may still rise.
    release_time : float or None
        End in s.
    peak_force : float or None
        Largest force in N.
    peak_force_time : float or None
        When, in s; ``None`` on a plateau.
    peak_total_compression, peak_body_deflection, peak_covering_compression : float or None
        Largest eps, delta and d in m.
    peak_strain : float or None
        Largest strain of the covering.
    peak_pressure : float or None
        Largest pressure in Pa: force over area of flat contacts, stress at the apex of others.
    rebound_speed : float or None
        Speed at which the bodies part, in m/s.
    peak_body_acceleration_g : float or None
        Largest acceleration of the body in g, ``None`` if clamped.
    body_speed_end : float or None
        Speed of the body at the end, in m/s.
    hic15, hic36 : float or None
        Head injury criterion in windows of 15 and 36 ms.
    end_force : float or None
        Force at the end, in N.
    bottomed : bool
        Whether the backing was reached.
    rising : bool
        Whether a load was largest at the horizon, so that its peak may come later and be larger.
    warnings : tuple of ResultWarning
        Why the loads may not be what they seem: loads that rise at the horizon, a covering outside its model,
        implausible numbers.
    time, force, total_compression, covering_compression, body_deflection, body_acceleration : ndarray
        The motion at the steps of the solution, SI units.
    """

    status: str
    release_time: Annotated[float | None, "s"]
    peak_force: Annotated[float | None, "N"]
    peak_force_time: Annotated[float | None, "s"]
    peak_total_compression: Annotated[float | None, "m"]
    peak_body_deflection: Annotated[float | None, "m"]
    peak_covering_compression: Annotated[float | None, "m"]
    peak_strain: float | None
    peak_pressure: Annotated[float | None, "Pa"]
    rebound_speed: Annotated[float | None, "m/s"]
    peak_body_acceleration_g: Annotated[float | None, "g"]
    body_speed_end: Annotated[float | None, "m/s"]
    hic15: float | None
    hic36: float | None
    end_force: Annotated[float | None, "N"]
    bottomed: bool
    rising: bool
    warnings: Doubts
    time: Annotated[Array, "s"]
    force: Annotated[Array, "N"]
    total_compression: Annotated[Array, "m"]
    covering_compression: Annotated[Array, "m"]
    body_deflection: Annotated[Array, "m"]
    body_acceleration: Annotated[Array, "m/s^2"]

    def columns(self) -> Columns:
        """Return the motion as columns by name.

        Returns
        -------
        dict of str to ndarray
            One row for each step.
        """
        return arrays_of(self)

    def __repr__(self) -> str:
        """Return how it ended with the loads, then the first steps and the warnings."""
        units = fields_with_units(ContactImpact) | {"peak_body_acceleration_g": ""}
        loads = {name: getattr(self, name) for name in (*_FOUND, "peak_body_acceleration_g")}
        shown = [f"{name} {value:.6g} {units[name]}".strip() for name, value in loads.items() if value is not None]
        words = [self.status, *(name for name in ("bottomed", "rising") if getattr(self, name))]
        return "\n".join([f"ContactImpact: {', '.join(words)}", *(f"  {line}" for line in shown), Table.__repr__(self)])


def _gravity(head: bool | None, body_mass: float) -> float | None:
    """Return the gravity of the head injury criterion if it is asked for."""
    return GRAVITY if (body_mass < HEAD_MASS if head is None else flag("head", head)) else None


def impact_of(given: Prepared, head: bool | None) -> ContactImpact:
    """Return the loads of a collision, from the first touch to the first loss of contact."""
    shared, values, pad, _, doubts = given
    found = _hrsafety.contact_simulate(shared, in_order(values), gravity=_gravity(head, values["body_mass"]))
    if pad is not None and found["status"] == "beyond_data":
        rule = f"not compress the covering by more than was measured (beyond_data, at {float(found['time'][-1]):.6g} s)"
        raise InvalidParameterError("speed", rule, values["closing_speed"], "measure the covering to larger strains")
    flags = {"unfinished": found["status"] == "unfinished", "rising": found["rising"]}
    flags |= covering_flags(pad, found["peak_covering_compression"], values)
    loads: dict[str, Any] = {name: known(found[name]) for name in _FOUND}
    acceleration = known(found["peak_body_acceleration"])
    motion = ("force", "total_compression", "covering_compression", "body_deflection", "body_acceleration")
    return ContactImpact(
        status=found["status"],
        **loads,
        peak_body_acceleration_g=None if acceleration is None else acceleration / GRAVITY,
        bottomed=found["bottomed"],
        rising=found["rising"],
        warnings=(*doubts, *flagged(flags, pad, values), *implausible_numbers(pad, str(shared["region"]), values)),
        time=found["time"],
        **{name: found[name] for name in motion},
    )


def known(value: float) -> float | None:
    """Return a number, ``None`` for one that does not exist."""
    return None if np.isnan(value) else float(value)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ContactBatch(Table):
    """Loads of many collisions as arrays of the broadcast shape, NaN where a number does not exist.

    Attributes
    ----------
    status : ndarray of str
        As `ContactImpact.status`, ``"beyond_data"`` where the covering was compressed by more than its table
        holds, so that no load is known, and ``"invalid_"`` with a name for rows with a bad number.
    release_time, peak_force, peak_force_time, peak_total_compression, peak_body_deflection,
    peak_covering_compression, peak_strain, peak_pressure, rebound_speed, peak_body_acceleration_g,
    body_speed_end, hic15, hic36, end_force : ndarray
        As in `ContactImpact`.
    bottomed, rising : ndarray of bool
        As in `ContactImpact`.
    outside_paraboloid, beyond_pad, edge : ndarray of bool
        Where the model of the covering does not hold, as in `Column`.
    warnings : tuple of ResultWarning
        For how many rows that holds, how many are invalid, and implausible numbers.
    """

    status: npt.NDArray[np.str_]
    release_time: Annotated[Array, "s"]
    peak_force: Annotated[Array, "N"]
    peak_force_time: Annotated[Array, "s"]
    peak_total_compression: Annotated[Array, "m"]
    peak_body_deflection: Annotated[Array, "m"]
    peak_covering_compression: Annotated[Array, "m"]
    peak_strain: Array
    peak_pressure: Annotated[Array, "Pa"]
    rebound_speed: Annotated[Array, "m/s"]
    peak_body_acceleration_g: Array
    body_speed_end: Annotated[Array, "m/s"]
    hic15: Array
    hic36: Array
    end_force: Annotated[Array, "N"]
    bottomed: npt.NDArray[np.bool_]
    rising: npt.NDArray[np.bool_]
    outside_paraboloid: npt.NDArray[np.bool_]
    beyond_pad: npt.NDArray[np.bool_]
    edge: npt.NDArray[np.bool_]
    warnings: Doubts

    def columns(self) -> Columns:
        """Return one-dimensional columns by name.

        Returns
        -------
        dict of str to ndarray
            Every field flattened.
        """
        return arrays_of(self)


def impacts_of(
    given: Prepared,
    arrays: Mapping[str, npt.ArrayLike],
    head: bool,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> ContactBatch:
    """Return the loads of many collisions: numbers of a contact as arrays."""
    shared, values, pad, limits, doubts = given
    for name in ("body_mass", "stiffness"):
        if name in arrays:
            agreeing(name, arrays[name], getattr(limits, OWN[name], None), limits)
    gravity = GRAVITY if flag("head", head) else None
    found = many("collide", (shared, values), arrays, pad, gravity=gravity, threads=threads, progress=progress)
    loads: dict[str, Any] = {name: found.numbers[name] for name in _FOUND}
    flags: dict[str, Any] = {name: found.flag(name) for name in _FLAGS}
    return ContactBatch(
        status=found.status,
        **loads,
        peak_body_acceleration_g=found.numbers["peak_body_acceleration"] / GRAVITY,
        bottomed=found.numbers["bottomed"].astype(bool),
        **flags,
        warnings=(*doubts, *found.warnings),
    )
