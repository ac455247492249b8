"""Why masses of an arm may be no data: what a URDF, a payload and motor inertias give away without a measurement."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.arms.link_doubts import FAR, SMALL, links_with_verb, several, subject_of
from hrsafety.arms.payload import Payload
from hrsafety.plausibility import ResultWarning

__all__ = [
    "DIRECTIONAL",
    "NO_MOTOR_INERTIA",
    "doubts_of_given",
    "doubts_of_motors",
    "doubts_of_payloads",
    "doubts_of_plate",
    "doubts_of_point",
    "doubts_of_poses",
    "doubts_of_reading",
    "for_rule",
    "governs",
]

NO_MOTOR_INERTIA = "no motor inertia given{}: effective masses are lower bounds, on the unsafe side; give armature"

DIRECTIONAL = frozenset({"no_motor_inertia", "armature_suspicious", "estimated_inertia", "inertia_projected"})
"""Doubts about the mass along a direction that do not touch the mass of ISO/TS 15066."""
OF_LINKS = frozenset(
    {"density", "link_without_mass", "mass_below_type_plate", "moving_mass_small", "placeholder_inertial"}
)
"""Doubts about masses of links, which a mass of ISO/TS 15066 from the type plate does not depend on."""

MOST_MOTOR = 10.0
"""A motor inertia of so many times the largest inertia that any joint moves is hardly meant."""
LEAST_PAYLOAD = 0.005
"""A payload below this, in kg, is hardly worth telling."""
BEYOND_TURN = 7.0
"""Joints that turn are hardly beyond this, in rad."""
BEYOND_SLIDE = 10.0
"""Joints that slide are hardly beyond this, in m."""
SAME_MASS = 1e-9
"""Masses that differ by a smaller share are the same."""
OF_PLATE = (0.85, 1.15)
"""Sum of all links as a share of the type plate that is plausible; of the moving links half of it."""


def governs(rule: str, directional: Any, iso: float) -> npt.NDArray[np.bool_]:
    """Return where a doubt about the mass along a direction counts for the mass of a rule.

    Parameters
    ----------
    rule : {"larger", "iso", "directional"}
        Which mass the robot has.
    directional : array_like (...)
        Mass along the direction in kg. What it lacks cannot make an unbounded one larger.
    iso : float
        Mass of ISO/TS 15066 in kg. With the larger one of both a directional mass from a third of it on counts:
        motor inertias multiply masses by up to three and more.

    Returns
    -------
    ndarray (...) of bool
        Where the doubt may lie on the unsafe side.
    """
    mass = np.asarray(directional, dtype=np.float64)
    least = {"directional": 0.0, "iso": np.inf, "larger": iso / 3.0}[rule]
    return np.asarray((mass >= least) & np.isfinite(mass))


def for_rule(
    warnings: Iterable[ResultWarning], rule: str, directional: Any, iso: float, source: str = "links"
) -> tuple[ResultWarning, ...]:
    """Return the doubts of an arm for the mass of a rule: those that cannot touch it lie on the safe side.

    Parameters
    ----------
    warnings : iterable of ResultWarning
        Of the arm.
    rule, directional, iso
        As for `governs`.
    source : {"links", "type_plate", "scaled"}
        Where masses are from.

    Returns
    -------
    tuple of ResultWarning
        In their order.
    """
    counts = bool(governs(rule, directional, iso).any())
    apart = DIRECTIONAL | OF_LINKS if source == "type_plate" else DIRECTIONAL

    def beside(doubt: ResultWarning) -> ResultWarning:
        if counts or doubt.safe_side or doubt.code not in apart:
            return doubt
        why = "the mass of the rule does not depend on it in these poses"
        return replace(doubt, message=f"{doubt.message} ({why})", safe_side=True)

    return tuple(beside(each) for each in warnings)


def doubts_of_base(rule: str, mass: Any, held: Any) -> tuple[ResultWarning, ...]:
    """Return the doubt about a base that rolls away: brakes or the controller of its wheels may hold it.

    Parameters
    ----------
    rule : {"larger", "iso", "directional"}
        Of the mass; that of ISO/TS 15066 depends on no direction.
    mass : array_like (...)
        Mass that counts, in kg.
    held : array_like (...)
        Mass along the direction of the contact if the base stood still, in kg.

    Returns
    -------
    tuple of ResultWarning
        None where the mass that counts is the larger one.
    """
    counted, standing = (np.ravel(np.asarray(each, dtype=np.float64)) for each in np.broadcast_arrays(mass, held))
    with np.errstate(divide="ignore", invalid="ignore"):
        heavier = standing / counted
    if rule == "iso" or not (heavier > 1.0 + SAME_MASS).any():
        return ()
    at = int(np.nanargmax(heavier))
    message = (
        f"a base that brakes or its controller hold makes the contact heavier: {standing[at]:.3g} kg in place of "
        f"{counted[at]:.3g} kg: take robot_mass larger, leave base out, or confirm that the base rolls away"
    )
    return (ResultWarning("base_may_be_held", "base", message),)


def doubts_of_motors(
    armature: Sequence[tuple[str, float]], facts: Mapping[str, Any], free: Sequence[str]
) -> Iterator[ResultWarning]:
    """Return what is missing or hardly meant of the motor inertias.

    Parameters
    ----------
    armature : sequence of (str, float)
        Motor inertia by joint.
    facts : mapping
        Of the native arm.
    free : sequence of str
        Joints that are not locked.

    Yields
    ------
    ResultWarning
        ``no_motor_inertia``, ``armature_suspicious`` (below 1 % of what the joint moves), ``implausible``.
    """
    names, given = facts["joint_names"], dict(armature)
    if not any(given.values()):
        without = tuple(free) or tuple(names)
    else:
        without = tuple(name for name in free if name not in given)
    if without:
        named = "" if without == tuple(free) else f" for {', '.join(without)}"
        yield ResultWarning("no_motor_inertia", "armature", NO_MOTOR_INERTIA.format(named))
    # Joints of a base that rolls come last.
    own = dict(zip(free, np.asarray(facts["largest_own"]).tolist(), strict=False))
    small = [name for name in free if any(given.values()) and given.get(name, np.inf) < SMALL * own[name]]
    if small:
        first = small[0]
        yield ResultWarning(
            "armature_suspicious",
            f"armature[{first!r}]",
            f"motor inertia of {several(small)} is below 1 % of the inertia that the joint moves ({first}: "
            f"{given[first]:g} of {own[first]:.3g} kg m^2): on the side of the rotor? It has to be multiplied by the "
            "square of the gear ratio; or has the joint no motor?",
        )
    kinds = dict(zip(names, facts["joint_kinds"], strict=True))
    for kind, unit in (("turning", "kg m^2"), ("sliding", "kg")):
        most = max((own[name] for name in free if kinds[name] == kind), default=0.0)
        large = [name for name in free if kinds[name] == kind and given.get(name, 0.0) > MOST_MOTOR * most > 0.0]
        if large:
            first = large[0]
            message = (
                f"motor inertia of {several(large)} is more than ten times what any joint moves ({first}: "
                f"{given[first]:g}, at most {most:.3g} {unit}): kg cm^2 or g m^2 given for kg m^2?"
            )
            yield ResultWarning("implausible", f"armature[{first!r}]", message, safe_side=True)


def doubts_of_given(link_masses: Sequence[tuple[str, float]]) -> Iterator[ResultWarning]:
    """Return the doubt about links of which only the mass was given.

    Parameters
    ----------
    link_masses : sequence of (str, float)
        Mass by link in kg.

    Yields
    ------
    ResultWarning
        ``estimated_inertia``.
    """
    if link_masses:
        names = [name for name, _ in link_masses]
        message = (
            f"{links_with_verb(names)} a mass that was given and an inertia that was estimated from a shape: masses "
            "along a direction may be too low"
        )
        yield ResultWarning("estimated_inertia", subject_of(names), message)


def doubts_of_plate(total: float, moving: float, plate: float | None) -> Iterator[ResultWarning]:
    """Return what the type plate of an arm says about the masses of its links.

    Parameters
    ----------
    total, moving : float
        Mass of all links, and of those that joints move, in kg.
    plate : float or None
        Mass on the type plate, without payload and controller, in kg.

    Yields
    ------
    ResultWarning
        ``mass_below_type_plate``, ``mass_above_type_plate``, ``moving_mass_small``.
    """
    if plate is None:
        return
    said = f"{total:.4g} kg in all, {plate:g} kg on the type plate"
    if total < OF_PLATE[0] * plate:
        yield ResultWarning("mass_below_type_plate", "type_plate_mass", f"links weigh {said}: masses are too low")
    if total > OF_PLATE[1] * plate:
        message = f"links weigh {said}: masses are too high"
        yield ResultWarning("mass_above_type_plate", "type_plate_mass", message, safe_side=True)
    if moving < 0.5 * plate:
        message = f"links that joints move weigh {moving:.4g} kg, less than half of {plate:g} kg on the type plate"
        yield ResultWarning("moving_mass_small", "type_plate_mass", message)


def doubts_of_payloads(payloads: Sequence[Payload], moving: float) -> Iterator[ResultWarning]:
    """Return what is hardly meant of payloads.

    Parameters
    ----------
    payloads : sequence of Payload
        What the arm carries.
    moving : float
        Mass of the moving links in kg.

    Yields
    ------
    ResultWarning
        ``implausible``: more mass than the arm has, a center or a radius of gyration of more than 1 m.
    """
    carried = sum(each.mass for each in payloads)
    if carried > moving > 0.0:
        message = (
            f"a payload of {carried:g} kg is more than the {moving:.4g} kg of the arm itself: g given for kg, or are "
            "the masses of the links too low?"
        )
        yield ResultWarning("implausible", "payload.mass", message)
    elif 0.0 < carried < LEAST_PAYLOAD:
        message = f"a payload of {carried:g} kg is below {1e3 * LEAST_PAYLOAD:g} g: t given for kg?"
        yield ResultWarning("implausible", "payload.mass", message)
    for index, each in enumerate(payloads):
        owner = "payload" if len(payloads) == 1 else f"payload[{index}]"
        away = float(np.linalg.norm(each.center))
        if away > FAR:
            message = f"{owner}.center is {away:.4g} m off its link {each.link!r}: mm or cm given for m?"
            yield ResultWarning("implausible", f"{owner}.center", message)
        if float(np.trace(each.inertia)) > 2.0 * FAR**2 * each.mass > 0.0:
            message = f"{owner}.inertia has a radius of gyration above {FAR:g} m: kg mm^2 or g m^2 given for kg m^2?"
            yield ResultWarning("implausible", f"{owner}.inertia", message, safe_side=True)


def doubts_of_poses(poses: Array, names: Sequence[str], kinds: Sequence[str]) -> tuple[ResultWarning, ...]:
    """Return a warning of joints that are turned or slid too far: degrees and mm make another pose of the one meant.

    Parameters
    ----------
    poses : ndarray (..., n)
        Values in the order of the joints.
    names, kinds : sequence of str
        Of the joints, ``"turning"`` or ``"sliding"``.

    Returns
    -------
    tuple of ResultWarning
        One at most.
    """
    most = np.array([BEYOND_TURN if kind == "turning" else BEYOND_SLIDE for kind in kinds])
    farthest = np.abs(poses).reshape(-1, len(most)).max(axis=0, initial=0.0)
    far = np.flatnonzero(farthest > most).tolist()
    if not far:
        return ()
    named = several([names[index] for index in far])
    slip = "rad: degrees given for radians?" if kinds[far[0]] == "turning" else "m: mm given for m?"
    message = f"{named} {'is' if len(far) == 1 else 'are'} at {farthest[far[0]]:g} {slip}"
    return (ResultWarning("implausible", "joints", message),)


def doubts_of_point(point: object, reach: float) -> tuple[ResultWarning, ...]:
    """Return a warning of a point too far from its link: far away a mass seems smaller than it is.

    Parameters
    ----------
    point : array_like (..., 3)
        In the frame of the link, in m.
    reach : float
        How far the arm reaches, in m.

    Returns
    -------
    tuple of ResultWarning
        One at most.
    """
    away = np.linalg.norm(np.asarray(point, dtype=np.float64), axis=-1)
    farthest = float(np.max(away, initial=0.0))
    most = max(FAR, reach)
    if not farthest > most:
        return ()
    message = f"point is {farthest:g} m off its link, more than {most:.3g} m: mm or cm given for m?"
    return (ResultWarning("implausible", "point", message),)


def doubts_of_reading(facts: Mapping[str, Any]) -> Iterator[ResultWarning]:
    """Return what of a URDF was not taken as it is written.

    Parameters
    ----------
    facts : mapping
        Of the native arm.

    Yields
    ------
    ResultWarning
        ``inertia_projected``, ``inertia_ignored``, ``attribute_ignored``, ``implausible``.
    """
    for serious in (False, True):
        rows = [row for row in facts["projected"] if (row[1] > 0.1) == serious]
        names = [row[0] for row in rows]
        mass = dict(zip(facts["link_names"], np.asarray(facts["link_masses"]).tolist(), strict=True))
        counted = [name for name in names if mass[name] >= SMALL * float(facts["moving_mass"])]
        if rows:
            name, violation, (before, after) = max(rows, key=lambda row: float(row[1]))
            message = (
                f"{links_with_verb(names)} an inertia that no rigid body has ({name}: {100 * violation:.3g} % of its "
                f"trace off), computed with the nearest one of a body (trace {before:.4g}, now {after:.4g} kg m^2), "
                "which lowers no effective mass"
            )
            yield ResultWarning("inertia_projected", subject_of(names), message, safe_side=not (serious and counted))
    if facts["not_used"]:
        names = facts["not_used"]
        message = (
            f"{links_with_verb(names)} an inertia that no rigid body has; no joint moves it, so that it is not used"
        )
        yield ResultWarning("inertia_ignored", subject_of(names), message, safe_side=True)
    if facts["turned"]:
        message = (
            f"rpy of {several(facts['turned'])} is beyond a turn: degrees given for radians? Every mass along a "
            "direction depends on it"
        )
        yield ResultWarning("implausible", "urdf", message)
    if facts["passed_over"]:
        message = f"attributes that URDF does not have are passed over: {several(facts['passed_over'])}"
        yield ResultWarning("attribute_ignored", "urdf", message, safe_side=True)
