"""Why masses and inertias of links may be no data: fillers, other units, links without a mass, bases that roll."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["FAR", "SMALL", "doubts_of_links", "links_with_verb", "several", "subject_of"]

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
FAR = 1.0
"""Farther from its link, in m, a payload is hardly meant; a point neither, unless the arm reaches farther."""
SAME = 4
"""So many links on a way from the base outwards, all of them, do not weigh the same."""
ROD = 0.3
"""Radius of gyration of a rod as long as an arm reaches, as a share of that: no link has a larger one."""
WHEELS = ("wheel", "caster", "castor")
"""Names of links of rolling bases, also where their joints are locked, steered or on springs."""
NOTHING = 1e-4
"""Negligible share of the moving mass."""
_NAMES = 4


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
            f"{links_with_verb(names[suspicious])} a radius of gyration below 2 mm: the inertia is hardly real "
            f"({100 * share:.2g} % of the moving mass)"
        )
        yield ResultWarning("suspicious_link", subject_of(names[suspicious]), message, safe_side=share < SMALL)
    yield from _placeholders(facts, names, mass)
    yield from _densities(facts, names, mass)
    for joints, what in ((facts["wheels"], "turn without limits like wheels"), (facts["floors"], "slide over a floor")):
        if joints:
            message = f"{several(joints)} {what}, and the base is taken to stand still: one that rolls has other masses"
            yield ResultWarning("base_assumed_fixed", "base", message)
    called = [str(name) for name in names if any(word in str(name).lower() for word in WHEELS)]
    if called and not facts["wheels"]:
        message = (
            f"links are called {several(called)}, and the base is taken to stand still: one that rolls has other masses"
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
            f"{links_with_verb(names[without])} a shape but no mass: without what it weighs masses are too low; "
            "give its inertial, or take the shape of a mere mark out"
        )
        yield ResultWarning("link_without_mass", subject_of(names[without]), message)
    elif facts["massless_joints"]:
        joints = facts["massless_joints"]
        message = f"{several(joints)} moves a part of the arm without a mass: what it weighs is missing"
        yield ResultWarning("link_without_mass", f"joint[{joints[0]!r}]", message)


def _counted(facts: Mapping[str, Any], mass: Array) -> npt.NDArray[np.bool_]:
    """Return which moving links count: from 1 % of the moving mass on, of many links from half of their mean."""
    moved = np.asarray(facts["moved"], dtype=bool) & (mass > 0.0)
    share = min(SMALL, 0.5 / max(int(moved.sum()), 1))
    return np.asarray(moved & (mass >= share * float(facts["moving_mass"])))


def _placeholders(facts: Mapping[str, Any], names: Array, mass: Array) -> Iterator[ResultWarning]:
    """Return signs of inertials that were only filled in."""
    counted = np.flatnonzero(_counted(facts, mass))
    moments = np.asarray(facts["link_moments"])
    signs: list[tuple[Any, str]] = []
    alike = _alike(facts, counted, mass, moments)
    if len(alike) >= ALIKE and 2 * len(alike) >= len(counted):
        what = f"one mass ({mass[alike[0]]:g} kg) and one inertia for {len(alike)} of {len(counted)} links"
        signs.append((alike, what))
    elif len({f"{mass[index]:.9e}" for index in counted}) == 1 and _in_a_row(facts, counted.tolist()) >= SAME:
        signs.append((counted, f"one mass ({mass[counted[0]]:g} kg)"))
    # Links that a joint moves by themselves, not those that hang fixed on others.
    segments, parents = facts["segments"], facts["parents"]
    own = [index for index in counted.tolist() if segments[index] != segments[parents[index]]]
    if _in_a_row(facts, own) >= ALIKE and not np.asarray(facts["link_off_centers"])[own].any():
        signs.append((own, "their centers of mass where their joints are"))
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
    told = [f"{links_with_verb(names[which])} {what}" for which, what in signs]
    if reach > REACHING and 0.0 < moving < max(LIGHT, SLENDER * reach**3):
        told.append(f"the moving links weigh {moving:.3g} kg and reach {reach:.3g} m")
    if told:
        subject = subject_of(names[signs[0][0]]) if signs else "links"
        yield ResultWarning("placeholder_inertial", subject, f"{'; '.join(told)}: filled in, or in another unit?")
    yield from _wide(facts, names, mass)


def _wide(facts: Mapping[str, Any], names: Array, mass: Array) -> Iterator[ResultWarning]:
    """Return links whose inertia belongs to a larger mass or is in another unit."""
    every, moving = np.asarray(facts["link_moments"]), float(facts["moving_mass"])
    moments, rod = every[:, 2], (ROD * float(facts["reach"])) ** 2
    moved = np.asarray(facts["moved"], dtype=bool) & (moving > 0.0)
    # A light link that would be longer than the arm. Three equal powers of ten are a filler of the inertia.
    light = moved & (mass < SMALL * moving) & (moments > rod * np.maximum(mass, NOTHING * moving))
    light &= np.array([not _power_of_ten(each) for each in every], dtype=bool)
    if light.any() and rod > 0.0:
        message = (
            f"{links_with_verb(names[light])} {mass[light].sum():.3g} kg in all, and inertias that at least "
            f"{float(moments[light].sum()) / rod:.3g} kg have in an arm of this reach: t given for kg, or no data?"
        )
        yield ResultWarning("placeholder_inertial", subject_of(names[light]), message)
    reach = float(facts["reach"])
    far = max(FAR, reach)
    wide = moved & ~light & (moments > far**2 * np.maximum(mass, SMALL * moving))
    if wide.any():
        message = f"{links_with_verb(names[wide])} a radius of gyration above {far:.3g} m: an inertia in another unit?"
        yield ResultWarning("implausible", subject_of(names[wide]), message, safe_side=True)


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
            f"{links_with_verb(names[odd])} a density of {density:.4g} kg/m^3 by shape and mass, outside the plausible "
            f"{least:g} to {most:g}: mass or shape is no data"
        )
        yield ResultWarning("density", subject_of(names[odd]), message)


def subject_of(names: Sequence[str] | Array) -> str:
    """Return one link by name, or that there are several."""
    return f"link[{names[0]!r}]" if len(names) == 1 else "links"


def links_with_verb(names: Sequence[str] | Array) -> str:
    """Return one or several links with their verb."""
    quoted = [repr(str(name)) for name in names]
    return f"link {quoted[0]} has" if len(quoted) == 1 else f"links {several(quoted)} have"


def several(names: Sequence[str]) -> str:
    """Return the first of some names, and how many there are beyond."""
    more = f" and {len(names) - _NAMES} more" if len(names) > _NAMES else ""
    return ", ".join(names[:_NAMES]) + more
