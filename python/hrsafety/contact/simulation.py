"""Collisions of a robot with a person through a covering."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, number, positive, thread_count
from hrsafety.contact.covering import Covering, Region, covering_of
from hrsafety.contact.rows import NAMES, columns_of, contact_row, in_order
from hrsafety.errors import InvalidParameterError
from hrsafety.tables import Columns, Table

__all__ = ["ContactBatch", "ContactImpact", "batch", "simulate"]

GRAVITY = 9.80665
HEAD_MASS = 10.0
"""Bodies below this mass, in kg, may be a head, and get a head injury criterion unless told otherwise."""
_WORDS, _SPEED_WORDS, _THICKNESS_WORDS = _hrsafety.contact_words()
_FOUND = (
    *("release_time", "peak_force", "peak_force_time", "peak_total_compression", "peak_body_deflection"),
    *("peak_covering_compression", "peak_strain", "peak_pressure", "rebound_speed", "body_speed_end"),
    *("hic15", "hic36", "end_force"),
)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ContactImpact(Table):
    """Loads of a collision and its motion; a number that does not exist is ``None``.

    Attributes
    ----------
    status : {"released", "horizon", "no_impact", "beyond_data", "unfinished"}
        How it ended; after ``"beyond_data"``, a law that does not reach as far as it was compressed, no
        load is known.
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
    time, force, total_compression, covering_compression, body_deflection, body_acceleration : ndarray
        The motion at the steps of the solution, SI units.
    """

    status: str
    release_time: float | None
    peak_force: float | None
    peak_force_time: float | None
    peak_total_compression: float | None
    peak_body_deflection: float | None
    peak_covering_compression: float | None
    peak_strain: float | None
    peak_pressure: float | None
    rebound_speed: float | None
    peak_body_acceleration_g: float | None
    body_speed_end: float | None
    hic15: float | None
    hic36: float | None
    end_force: float | None
    bottomed: bool
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
        names = [each.name for each in fields(self) if isinstance(getattr(self, each.name), np.ndarray)]
        return {name: getattr(self, name) for name in names}


def _gravity(head: bool | None, body_mass: object) -> float | None:
    """Return the gravity of the head injury criterion if it is asked for."""
    light = body_mass is not None and number("body_mass", body_mass) < HEAD_MASS
    return GRAVITY if (light if head is None else head) else None


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
    horizon: float = 0.2,
    head: bool | None = None,
    tolerance: float = 1e-8,
) -> ContactImpact:
    """Return the loads of a collision, from the first touch to the first loss of contact.

    Parameters
    ----------
    robot_mass : float
        M_r in kg.
    closing_speed : float
        v in m/s; none above 0 is ``"no_impact"``.
    region : Region, mapping, float or None
        Spring of the body's region; a number is k in N/m, ``None`` a rigid region.
    body_mass : float or None
        M_h in kg; ``None`` or inf: clamped.
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
        Relative tolerance of the solution, from 1e-12 to 1e-3.

    Returns
    -------
    ContactImpact
        Loads and motion.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range; the message names it.

    Examples
    --------
    >>> from hrsafety import contact
    >>> hit = contact.simulate(robot_mass=3.0, closing_speed=0.5, region=75e3, body_mass=0.6)
    >>> hit.status, round(hit.peak_force, 2)
    ('released', 96.82)
    """
    shared, values = contact_row(
        robot_mass=robot_mass,
        body_mass=body_mass,
        region=region,
        covering=covering,
        tolerance=tolerance,
        robot_damping=robot_damping,
        robot_stiffness=robot_stiffness,
        body_damping=body_damping,
        body_stiffness=body_stiffness,
        closing_speed=number("closing_speed", closing_speed),
        horizon=horizon,
        stop=stop,
    )
    found = _hrsafety.contact_simulate(shared, in_order(values), gravity=_gravity(head, body_mass))
    loads: dict[str, Any] = {name: known(found[name]) for name in _FOUND}
    acceleration = known(found["peak_body_acceleration"])
    motion = ("force", "total_compression", "covering_compression", "body_deflection", "body_acceleration")
    return ContactImpact(
        status=found["status"],
        **loads,
        peak_body_acceleration_g=None if acceleration is None else acceleration / GRAVITY,
        bottomed=found["bottomed"],
        time=found["time"],
        **{name: found[name] for name in motion},
    )


def known(value: float) -> float | None:
    """Return a number, ``None`` for one that does not exist."""
    return None if np.isnan(value) else float(value)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ContactBatch(Table):
    """Loads of many collisions as arrays of the broadcast shape, NaN where a number does not exist.

    Attributes
    ----------
    status : ndarray of str
        As `ContactImpact.status`, and ``"invalid_"`` with a name for rows with a bad number.
    release_time, peak_force, peak_force_time, peak_total_compression, peak_body_deflection,
    peak_covering_compression, peak_strain, peak_pressure, rebound_speed, peak_body_acceleration_g,
    body_speed_end, hic15, hic36, end_force : ndarray
        As in `ContactImpact`.
    bottomed : ndarray of bool
        Whether the backing was reached.
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

    def columns(self) -> Columns:
        """Return one-dimensional columns by name.

        Returns
        -------
        dict of str to ndarray
            Every field flattened.
        """
        return {each.name: getattr(self, each.name).ravel() for each in fields(self)}


def batch(
    *,
    robot_mass: npt.ArrayLike,
    closing_speed: npt.ArrayLike,
    region: Region | Mapping[str, object] | float | None = None,
    body_mass: npt.ArrayLike | None = None,
    covering: Covering | Mapping[str, object] | None = None,
    stop: tuple[float, float] | None = None,
    horizon: float = 0.2,
    head: bool = False,
    tolerance: float = 1e-6,
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
    region, covering, stop, horizon, tolerance
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
        numbers of the law (``modulus``, ``plateau``, ...).

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
    callback("progress", progress)
    varying = {"robot_mass": robot_mass, "closing_speed": closing_speed, **arrays}
    if body_mass is not None:
        varying["body_mass"] = body_mass
    shared, values = contact_row(
        robot_mass=1.0,
        body_mass=None,
        region=region,
        covering=covering,
        tolerance=tolerance,
        horizon=positive("horizon", horizon),
        stop=stop,
    )
    if not isinstance(head, (bool, np.bool_)):
        raise InvalidParameterError("head", "be True or False", head)
    gravity = GRAVITY if head else None
    found, status, word, shape = many("collide", shared, values, varying, covering, gravity, threads, progress, _WORDS)
    loads = {name: found[name].reshape(shape) for name in _FOUND}
    return ContactBatch(
        status=status,
        **loads,
        peak_body_acceleration_g=(found["peak_body_acceleration"] / GRAVITY).reshape(shape),
        bottomed=word == 1,
    )


def many(
    kind: str,
    shared: dict[str, object],
    values: dict[str, float],
    varying: Mapping[str, object],
    covering: Covering | Mapping[str, object] | None,
    gravity: float | None,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
    words: list[str],
) -> tuple[dict[str, Array], npt.NDArray[np.str_], npt.NDArray[np.uint8], tuple[int, ...]]:
    """Return columns of the core, the status of each row, a second code and the shape."""
    pad = covering_of(covering)
    columns, shape = columns_of(shared, values, varying, pad)
    rows = int(np.prod(shape, dtype=np.int64))
    found = _hrsafety.contact_rows(
        kind, shared, columns, rows, gravity=gravity, threads=thread_count(threads), progress=progress
    )
    names = list(NAMES)
    if pad is not None:
        for place, name in enumerate(pad.material.keys.values()):
            names[names.index(f"material_{place}")] = name
    codes = found.pop("status_code")
    all_words = np.asarray([*words, *(f"invalid_{name}" for name in names), "invalid_covering"])
    status = all_words[np.minimum(codes, len(all_words) - 1)].reshape(shape)
    return found, status, found.pop("word_code").reshape(shape), shape
