"""Why masses of an arm may be no data: what a URDF, a payload and motor inertias give away without a measurement."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.arms.payload import Payload
from hrsafety.plausibility import ResultWarning, implausible

__all__ = [
    "DIRECTIONAL",
    "NO_MOTOR_INERTIA",
    "doubts_of_links",
    "doubts_of_motors",
    "doubts_of_payloads",
    "doubts_of_plate",
    "doubts_of_point",
    "doubts_of_reading",
    "for_rule",
    "governs",
]

NO_MOTOR_INERTIA = "no motor inertia given{}: effective masses are lower bounds, on the unsafe side; give armature"

DIRECTIONAL = frozenset({"no_motor_inertia", "armature_suspicious", "inertia_projected"})
"""Doubts about the mass along a direction that do not touch the mass of ISO/TS 15066."""

SMALL = 0.01
"""Below this share of the moving mass a link is small, below this share of what its joint moves a motor."""
DENSITIES = (300.0, 8000.0)
"""Plausible densities of links in kg/m^3: hollow castings to solid steel."""
AROUND = 0.1
"""Collision shapes around what is seen of a link may be so much less dense."""
GYRATIONS = (0.1, 0.6)
"""Plausible radii of gyration as shares of the diagonal of a shape."""
ALIKE = 3
"""So many links with one mass and one inertia on a way from the base outwards are no coincidence."""
LIGHT = 0.5
REACHING = 0.3
"""An arm that reaches farther than this, in m, is heavier than `LIGHT`, in kg."""
SLENDER = 1.0
"""Moving mass over reach cubed, in kg/m^3, below which no arm is: the lightest of a hundred real ones have 3."""
MOST_MOTOR = 10.0
"""A motor inertia of so many times the largest inertia that any joint moves is hardly meant."""
FAR = 1.0
"""Farther from its link, in m, a payload is hardly meant; a point neither, unless the arm reaches farther."""
OF_PLATE = (0.85, 1.15)
"""Sum of all links as a share of the type plate that is plausible; of the moving links half of it."""
_NAMES = 4


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


def for_rule(warnings: Iterable[ResultWarning], rule: str, directional: Any, iso: float) -> tuple[ResultWarning, ...]:
    """Return the doubts of an arm for the mass of a rule: those that cannot touch it lie on the safe side.

    Parameters
    ----------
    warnings : iterable of ResultWarning
        Of the arm.
    rule, directional, iso
        As for `governs`.

    Returns
    -------
    tuple of ResultWarning
        In their order.
    """
    counts = bool(governs(rule, directional, iso).any())

    def beside(doubt: ResultWarning) -> ResultWarning:
        if counts or doubt.safe_side or doubt.code not in DIRECTIONAL:
            return doubt
        why = "the mass of the rule does not depend on it in these poses"
        return replace(doubt, message=f"{doubt.message} ({why})", safe_side=True)

    return tuple(beside(each) for each in warnings)


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
    own = dict(zip(free, np.asarray(facts["largest_own"]).tolist(), strict=True))
    small = [name for name in free if any(given.values()) and given.get(name, np.inf) < SMALL * own[name]]
    if small:
        first = small[0]
        yield ResultWarning(
            "armature_suspicious",
            f"armature[{first!r}]",
            f"motor inertia of {_several(small)} is below 1 % of the inertia that the joint moves ({first}: "
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
                f"motor inertia of {_several(large)} is more than ten times what any joint moves ({first}: "
                f"{given[first]:g}, at most {most:.3g} {unit}): kg cm^2 or g m^2 given for kg m^2?"
            )
            yield ResultWarning("implausible", f"armature[{first!r}]", message, safe_side=True)


def doubts_of_links(facts: Mapping[str, Any]) -> Iterator[ResultWarning]:
    """Return why masses and inertias of links may be no data.

    Parameters
    ----------
    facts : mapping
        Of the native arm.

    Yields
    ------
    ResultWarning
        ``link_without_mass``, ``suspicious_link``, ``placeholder_inertial``, ``density``, ``base_assumed_fixed``,
        ``implausible``.
    """
    moved = np.asarray(facts["moved"], dtype=bool)
    if not moved.any():
        return
    names = np.asarray(facts["link_names"], dtype=object)
    mass = np.asarray(facts["link_masses"])
    moving = float(facts["moving_mass"])
    yield from _without_mass(facts, names, moving)
    suspicious = np.isin(names, facts["suspicious_links"])
    if suspicious.any():
        share = float(mass[suspicious].sum()) / moving
        message = (
            f"{_links(names[suspicious])} a radius of gyration below 2 mm: the inertia is hardly real "
            f"({100 * share:.2g} % of the moving mass)"
        )
        yield ResultWarning("suspicious_link", _subject(names[suspicious]), message, safe_side=share < SMALL)
    yield from _placeholders(facts, names, mass)
    yield from _densities(facts, names, mass)
    for joints, what in ((facts["wheels"], "turn without limits like wheels"), (facts["floors"], "slide over a floor")):
        if joints:
            message = (
                f"{_several(joints)} {what}, and the base is taken to stand still: one that rolls has other masses"
            )
            yield ResultWarning("base_assumed_fixed", "base", message)
    reach = float(facts["reach"])
    if facts["chained"] or reach > 1.0:
        yield from implausible({"reach": reach}, {"reach": "arm_reach"})
    heavy = implausible({"moving_mass": moving}, {"moving_mass": "arm_moving_mass"})
    yield from (replace(each, safe_side=True) for each in heavy if moving > 1.0)


def _without_mass(facts: Mapping[str, Any], names: Array, moving: float) -> Iterator[ResultWarning]:
    without = np.isin(names, facts["links_without_mass"])
    volume = np.asarray(facts["link_volumes"])[without]
    # What steel of the size of the shape weighs; a mesh may be of any size.
    if moving == 0.0:
        message = "no link that a joint moves has a mass: every mass lacks all that the arm weighs"
        yield ResultWarning("link_without_mass", "links", message)
    elif without.any() and not float(volume.sum()) * DENSITIES[1] < SMALL * moving:
        message = (
            f"{_links(names[without])} a shape but no mass: without what it weighs masses are too low; "
            "give its inertial, or take the shape of a mere mark out"
        )
        yield ResultWarning("link_without_mass", _subject(names[without]), message)
    elif facts["massless_joints"]:
        joints = facts["massless_joints"]
        message = f"{_several(joints)} moves a part of the arm without a mass: what it weighs is missing"
        yield ResultWarning("link_without_mass", f"joint[{joints[0]!r}]", message)


def _counted(facts: Mapping[str, Any], mass: Array) -> npt.NDArray[np.bool_]:
    """Return which moving links count: from 1 % of the moving mass on, of many links from half of their mean."""
    moved = np.asarray(facts["moved"], dtype=bool) & (mass > 0.0)
    share = min(SMALL, 0.5 / max(int(moved.sum()), 1))
    return np.asarray(moved & (mass >= share * float(facts["moving_mass"])))


def _placeholders(facts: Mapping[str, Any], names: Array, mass: Array) -> Iterator[ResultWarning]:
    """Return signs of inertials that somebody only filled in."""
    counted = np.flatnonzero(_counted(facts, mass))
    moments = np.asarray(facts["link_moments"])
    signs: list[tuple[Any, str]] = []
    alike = _alike(facts, counted, mass, moments)
    if len(alike) >= ALIKE and 2 * len(alike) >= len(counted):
        what = f"one mass ({mass[alike[0]]:g} kg) and one inertia for {len(alike)} of {len(counted)} links"
        signs.append((alike, what))
    even = [index for index in counted if _power_of_ten(moments[index])]
    if len(counted) > 1 and 2 * len(even) >= len(counted):
        signs.append((even, f"three equal moments of {moments[even[0]][0]:g} kg m^2"))
    share = np.sqrt(np.maximum(moments[:, 2], 0.0)[counted] / mass[counted])
    share /= np.asarray(facts["link_diagonals"])[counted]
    odd = (share < GYRATIONS[0]) | ((share > GYRATIONS[1]) & np.asarray(facts["link_whole"])[counted])
    if odd.any():
        least, most = GYRATIONS
        what = f"a radius of gyration of {share[odd][0]:.3g} of the diagonal of the shape ({least:g} to {most:g})"
        signs.append((counted[odd], what))
    moving, reach = float(facts["moving_mass"]), float(facts["reach"])
    told = [f"{_links(names[which])} {what}" for which, what in signs]
    if reach > REACHING and 0.0 < moving < max(LIGHT, SLENDER * reach**3):
        told.append(f"the moving links weigh {moving:.3g} kg and reach {reach:.3g} m")
    if told:
        subject = _subject(names[signs[0][0]]) if signs else "links"
        yield ResultWarning("placeholder_inertial", subject, f"{'; '.join(told)}: filled in, or in another unit?")
    far = max(FAR, reach)
    moved = np.flatnonzero(np.asarray(facts["moved"], dtype=bool))
    wide = [index for index in moved if moments[index, 2] > far**2 * max(mass[index], SMALL * moving) > 0.0]
    if wide:
        message = f"{_links(names[wide])} a radius of gyration above {far:.3g} m: an inertia in another unit?"
        yield ResultWarning("implausible", _subject(names[wide]), message, safe_side=True)


def _alike(facts: Mapping[str, Any], real: npt.NDArray[np.intp], mass: Array, moments: Array) -> list[int]:
    """Return the largest group of links with one mass and one inertia, if three of them follow each other outwards."""
    groups: dict[tuple[object, ...], list[int]] = {}
    for index in real.tolist():
        largest = float(moments[index, 2])
        shape = np.round(moments[index] / largest, 9) + 0.0 if largest > 0.0 else np.zeros(3)
        groups.setdefault((f"{mass[index]:.9e}", f"{largest:.9e}", *shape.tolist()), []).append(index)
    most = max(groups.values(), key=len, default=[])
    return most if _in_a_row(facts, most) >= ALIKE else []


def _in_a_row(facts: Mapping[str, Any], links: Sequence[int]) -> int:
    """Return how many of some links, of different joints, lie on one way from the base outwards."""
    segments, parents = facts["segments"], facts["segment_parents"]
    chosen = {segments[index] for index in links}
    most = 0
    for segment in chosen:
        length, at = 0, segment
        while at is not None:
            length += at in chosen
            at = parents[at]
        most = max(most, length)
    return most


def _power_of_ten(moments: Array) -> bool:
    least, largest = float(moments[0]), float(moments[2])
    if not least > 0.0 or largest - least > 1e-9 * largest:
        return False
    power = np.log10(largest)
    return bool(abs(power - round(power)) < 1e-9)


def _densities(facts: Mapping[str, Any], names: Array, mass: Array) -> Iterator[ResultWarning]:
    """Return links whose mass does not fit their shape; beside a mesh, primitives may be a part of it, or around it."""
    volume = np.asarray(facts["link_volumes"])
    moved = np.asarray(facts["moved"], dtype=bool) & (mass > 0.0)
    least, most = DENSITIES
    whole = np.asarray(facts["link_whole"], dtype=bool)
    bound = np.where(whole, least, AROUND * least)
    # A light link counts by what it lacks.
    light = moved & (bound * volume - mass > SMALL * float(facts["moving_mass"]))
    heavy = _counted(facts, mass) & (mass > most * volume) & whole
    odd = light | heavy
    if odd.any():
        density = float((mass[odd] / volume[odd])[0])
        message = (
            f"{_links(names[odd])} a density of {density:.4g} kg/m^3 by shape and mass, outside the plausible "
            f"{least:g} to {most:g}: mass or shape is no data"
        )
        yield ResultWarning("density", _subject(names[odd]), message)


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
    for index, each in enumerate(payloads):
        owner = "payload" if len(payloads) == 1 else f"payload[{index}]"
        away = float(np.linalg.norm(each.center))
        if away > FAR:
            message = f"{owner}.center is {away:.4g} m off its link {each.link!r}: mm or cm given for m?"
            yield ResultWarning("implausible", f"{owner}.center", message)
        if float(np.trace(each.inertia)) > 2.0 * FAR**2 * each.mass > 0.0:
            message = f"{owner}.inertia has a radius of gyration above {FAR:g} m: kg mm^2 or g m^2 given for kg m^2?"
            yield ResultWarning("implausible", f"{owner}.inertia", message, safe_side=True)


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
        ``inertia_projected``, ``inertia_ignored``, ``attribute_ignored``.
    """
    for serious in (False, True):
        rows = [row for row in facts["projected"] if (row[1] > 0.1) == serious]
        names = [row[0] for row in rows]
        mass = dict(zip(facts["link_names"], np.asarray(facts["link_masses"]).tolist(), strict=True))
        counted = [name for name in names if mass[name] >= SMALL * float(facts["moving_mass"])]
        if rows:
            name, violation, (before, after) = max(rows, key=lambda row: float(row[1]))
            message = (
                f"{_links(names)} an inertia that no rigid body has ({name}: {100 * violation:.3g} % of its trace "
                f"off), computed with the nearest one of a body (trace {before:.4g}, now {after:.4g} kg m^2), "
                "which lowers no effective mass"
            )
            yield ResultWarning("inertia_projected", _subject(names), message, safe_side=not (serious and counted))
    if facts["not_used"]:
        names = facts["not_used"]
        message = f"{_links(names)} an inertia that no rigid body has; no joint moves it, so that it is not used"
        yield ResultWarning("inertia_ignored", _subject(names), message, safe_side=True)
    if facts["passed_over"]:
        message = f"attributes that URDF does not have are passed over: {_several(facts['passed_over'])}"
        yield ResultWarning("attribute_ignored", "urdf", message, safe_side=True)


def _subject(names: Sequence[str] | Array) -> str:
    return f"link[{names[0]!r}]" if len(names) == 1 else "links"


def _links(names: Sequence[str] | Array) -> str:
    """Return one or several links with their verb."""
    quoted = [repr(str(name)) for name in names]
    return f"link {quoted[0]} has" if len(quoted) == 1 else f"links {_several(quoted)} have"


def _several(names: Sequence[str]) -> str:
    """Return the first of some names, and how many there are beyond."""
    more = f" and {len(names) - _NAMES} more" if len(names) > _NAMES else ""
    return ", ".join(names[:_NAMES]) + more
