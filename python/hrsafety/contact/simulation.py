"""Collisions of a robot with a person through a covering."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, flag, number, positive
from hrsafety._records import dataclass
from hrsafety.contact.bodies import agreeing, body_of
from hrsafety.contact.covering import Covering, Region, covering_of
from hrsafety.contact.doubts import Doubts, covering_flags, flagged, implausible_numbers
from hrsafety.contact.many import many
from hrsafety.contact.rows import HORIZON, TOLERANCE, contact_row, in_order, spring_of
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import telling
from hrsafety.tables import Columns, Table, unit_suffix

__all__ = ["ContactBatch", "ContactImpact", "batch", "simulate"]

GRAVITY = 9.80665
HEAD_MASS = 10.0
"""Bodies below this mass, in kg, may be a head, and get a head injury criterion unless told otherwise."""
_FOUND = (
    *("release_time", "peak_force", "peak_force_time", "peak_total_compression", "peak_body_deflection"),
    *("peak_covering_compression", "peak_strain", "peak_pressure", "rebound_speed", "body_speed_end"),
    *("hic15", "hic36", "end_force"),
)
_FLAGS = ("rising", "outside_paraboloid", "beyond_pad", "edge")
UNITS = {
    "release_time": "s",
    "peak_force": "N",
    "peak_force_time": "s",
    "peak_total_compression": "m",
    "peak_body_deflection": "m",
    "peak_covering_compression": "m",
    "peak_pressure": "Pa",
    "rebound_speed": "m/s",
    "body_speed_end": "m/s",
    "end_force": "N",
    "time": "s",
    "force": "N",
    "total_compression": "m",
    "covering_compression": "m",
    "body_deflection": "m",
    "body_acceleration": "m/s^2",
}
"""Units of the loads and of the motion; what has none is not here, and `_g` is a unit of its own."""


def arrays_of(result: Any) -> Columns:
    """Return the arrays of a result flattened, under their names with units."""
    named = {each.name: getattr(result, each.name) for each in fields(result)}
    return {
        f"{'t' if name == 'time' else name}{unit_suffix(UNITS.get(name, ''))}": values.ravel()
        for name, values in named.items()
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
    time: Array
    force: Array
    total_compression: Array
    covering_compression: Array
    body_deflection: Array
    body_acceleration: Array

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
        loads = {name: getattr(self, name) for name in (*_FOUND, "peak_body_acceleration_g")}
        shown = [
            f"{name} {value:.6g} {UNITS.get(name, '')}".strip() for name, value in loads.items() if value is not None
        ]
        words = [self.status, *(name for name in ("bottomed", "rising") if getattr(self, name))]
        return "\n".join([f"ContactImpact: {', '.join(words)}", *(f"  {line}" for line in shown), Table.__repr__(self)])


def _gravity(head: bool | None, body_mass: object) -> float | None:
    """Return the gravity of the head injury criterion if it is asked for."""
    light = body_mass is not None and number("body_mass", body_mass) < HEAD_MASS
    return GRAVITY if (light if head is None else flag("head", head)) else None


@telling()
def simulate(
    *,
    robot_mass: float,
    closing_speed: float,
    region: Region | Mapping[str, object] | float | None = None,
    body_mass: float | None = None,
    covering: Covering | Mapping[str, object] | None = None,
    robot_damping: float = 0.0,
    robot_stiffness: float = 0.0,
    body_damping: float = 0.0,
    body_stiffness: float = 0.0,
    stop: tuple[float, float] | None = None,
    horizon: float = HORIZON,
    head: bool | None = None,
    tolerance: float = TOLERANCE,
    limits: object = None,
) -> ContactImpact:
    """Return the loads of a collision, from the first touch to the first loss of contact.

    Parameters
    ----------
    robot_mass : float
        M_r in kg.
    closing_speed : float
        v in m/s; none above 0 is ``"no_impact"``.
    region : Region, mapping, float or None
        Spring of the body's region; a number is k in N/m. ``None``: that of `limits`, else a rigid region.
    body_mass : float or None
        M_h in kg; inf: clamped. ``None``: that of `limits`, else clamped.
    covering : Covering, mapping or None
        ``None``: bare.
    robot_damping, robot_stiffness, body_damping, body_stiffness : float
        Supports C_r, C_h in N s/m and K_r, K_h in N/m.
    stop : tuple of two floats or None
        When the robot's set point begins to brake, in s, and its deceleration in m/s^2.
    horizon : float
        Time in s after which the collision is left alone.
    head : bool or None
        Whether to give the head injury criterion; for bodies below 10 kg when ``None``.
    tolerance : float
        Relative tolerance of the solution, from 1e-12 to 1e-3. Compressions, and speeds after the contact, may err by
        up to a hundred times as much where a covering turns just behind the start or the end of a plateau; forces
        mostly do not (of 2,000 random collisions one by 120 times).
    limits : ContactLimit or None
        A limit object that knows spring and mass of the region, for those that are left out; others than its own are
        refused.

    Returns
    -------
    ContactImpact
        Loads and motion.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or the covering is compressed by more than its table holds
        (``beyond_data``); the message names it.

    Examples
    --------
    >>> from hrsafety import contact
    >>> hit = contact.simulate(robot_mass=3.0, closing_speed=0.5, region=75e3, body_mass=0.6)
    >>> hit.status, round(hit.peak_force, 2)
    ('released', 96.82)
    """
    pad = covering_of(covering)
    body = body_of(limits, region, body_mass)
    shared, values = contact_row(
        robot_mass=robot_mass,
        body_mass=body.mass,
        region=body.region,
        covering=pad,
        tolerance=tolerance,
        robot_damping=robot_damping,
        robot_stiffness=robot_stiffness,
        body_damping=body_damping,
        body_stiffness=body_stiffness,
        closing_speed=number("closing_speed", closing_speed),
        horizon=horizon,
        stop=stop,
    )
    found = _hrsafety.contact_simulate(shared, in_order(values), gravity=_gravity(head, body.mass))
    if pad is not None and found["status"] == "beyond_data":
        rule = f"not compress the covering by more than was measured (beyond_data, at {float(found['time'][-1]):.6g} s)"
        raise InvalidParameterError("closing_speed", rule, closing_speed, "measure the covering to larger strains")
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
        warnings=(*flagged(flags, pad, values), *implausible_numbers(pad, str(shared["region"]), values)),
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
    release_time: Array
    peak_force: Array
    peak_force_time: Array
    peak_total_compression: Array
    peak_body_deflection: Array
    peak_covering_compression: Array
    peak_strain: Array
    peak_pressure: Array
    rebound_speed: Array
    peak_body_acceleration_g: Array
    body_speed_end: Array
    hic15: Array
    hic36: Array
    end_force: Array
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


@telling()
def batch(
    *,
    robot_mass: npt.ArrayLike,
    closing_speed: npt.ArrayLike,
    region: Region | Mapping[str, object] | float | None = None,
    body_mass: npt.ArrayLike | None = None,
    covering: Covering | Mapping[str, object] | None = None,
    stop: tuple[float, float] | None = None,
    horizon: float = HORIZON,
    head: bool = False,
    tolerance: float = TOLERANCE,
    limits: object = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
    **arrays: npt.ArrayLike,
) -> ContactBatch:
    """Return the loads of many collisions over all cores; every number may be an array, and all broadcast.

    A row with a bad number is NaN with a status that names it; it never fails the batch.

    Parameters
    ----------
    robot_mass, closing_speed, body_mass : array_like
        As for `simulate`; a body mass of inf is clamped.
    region, covering, stop, horizon, tolerance, limits
        As for `simulate`, the same for all rows.
    head : bool
        Whether to give the head injury criterion, which takes longer than the collision.
    threads : int or None
        Number of threads; all cores when ``None``. Never changes a bit.
    progress : callable or None
        Called now and then as ``progress(done, total)``.
    **arrays : array_like
        Numbers of region and covering that differ from row to row: ``stiffness`` (of the region),
        ``thickness``, ``area``, ``radius``, ``damping``, supports such as ``robot_stiffness``, and the
        numbers of the law (``modulus``, ``plateau``, ...). One without effect, such as a thickness of no
        covering, is an error.

    Returns
    -------
    ContactBatch
        Arrays of the broadcast shape.

    Raises
    ------
    InvalidParameterError
        If a name is not known or an option out of range.
    ShapeError
        If the arrays do not broadcast.

    Examples
    --------
    >>> from hrsafety import contact
    >>> pad = contact.Covering(material=contact.Linear(modulus=2e5), thickness=0.02, area=4e-3)
    >>> found = contact.batch(
    ...     robot_mass=8.0, body_mass=40.0, closing_speed=[0.3, 0.6], region=25e3, covering=pad,
    ...     thickness=[[0.01], [0.02]],
    ... )
    >>> found.peak_force.round(1).tolist()
    [[106.9, 213.8], [96.1, 192.2]]
    """
    pad = covering_of(covering)
    varying = {"robot_mass": robot_mass, "closing_speed": closing_speed, **arrays}
    body = body_of(limits, region, body_mass, given=tuple(arrays))
    if "stiffness" in arrays:
        agreeing("stiffness", arrays["stiffness"], getattr(limits, "spring_constant", None), limits)
    if body.mass is not None:
        varying["body_mass"] = body.mass
    row = contact_row(
        robot_mass=1.0,
        body_mass=None,
        region=spring_of(body.region, arrays),
        covering=pad,
        tolerance=tolerance,
        horizon=positive("horizon", horizon),
        stop=stop,
    )
    if not isinstance(head, (bool, np.bool_)):
        raise InvalidParameterError("head", "be True or False", head)
    gravity = GRAVITY if head else None
    found = many("collide", row, varying, pad, gravity=gravity, threads=threads, progress=progress)
    loads: dict[str, Any] = {name: found.numbers[name] for name in _FOUND}
    flags: dict[str, Any] = {name: found.flag(name) for name in _FLAGS}
    return ContactBatch(
        status=found.status,
        **loads,
        peak_body_acceleration_g=found.numbers["peak_body_acceleration"] / GRAVITY,
        bottomed=found.numbers["bottomed"].astype(bool),
        **flags,
        warnings=found.warnings,
    )
