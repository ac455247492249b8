"""Chances of a cell file: spreads around the number of each contact, or distributions of their own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from hrsafety import _keys as kind
from hrsafety.contact.cell.cell import Cell, PlannedContact, contact_of
from hrsafety.contact.cell.judgement import reasons_of
from hrsafety.contact.covering import Covering, covering_of
from hrsafety.contact.speed import AllowedSpeed
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning

__all__ = ["chance_doubts", "chance_of", "spread"]

CERTAIN = ("covering", "draws", "human_speed", "limits", "progress", "region", "seed", "speed", "threads")
"""Numbers that cannot be uncertain."""
OF_REGIONS = ("body_mass", "stiffness", "force_limit", "pressure_limit")
"""Numbers that differ from region to region: one distribution for all of them would be wrong for most."""


def spread(name: str, given: Any, nominal: float | None) -> Mapping[str, object]:
    """Return a distribution; one number is a spread around the number of the contact.

    Parameters
    ----------
    name : str
        What is uncertain.
    given : mapping
        ``{"lognormal": [median, s]}`` and the like, or ``{"lognormal": s}``: then the median, the mean or the
        middle is the number of the contact, and `s` is a share of it.
    nominal : float or None
        The number of the contact.

    Returns
    -------
    mapping
        As for `Contact.probability`.
    """
    if name in CERTAIN:
        raise InvalidParameterError(
            f"uncertain.{name}",
            "be a number of the contact, such as robot_mass, force_limit or thickness",
            name,
            "judge the largest speed that may happen" if "speed" in name else None,
        )
    table = kind.table(f"uncertain.{name}", given)
    if len(table) != 1:
        rule = "be one distribution, such as { lognormal = 0.2 } or { normal = [10.0, 0.5] }"
        raise InvalidParameterError(f"uncertain.{name}", rule, kind.shown(given))
    ((word, values),) = table.items()
    if isinstance(values, list):
        if name in OF_REGIONS:
            rule = "be a spread, one number: each region has its own"
            raise InvalidParameterError(f"uncertain.{name}.{word}", rule, kind.shown(values))
        return {word: kind.numbers(f"uncertain.{name}.{word}", values)}
    share = kind.number(f"uncertain.{name}.{word}", values)
    if not 0.0 < share < 1.0:
        raise InvalidParameterError(f"uncertain.{name}.{word}", "be above 0 and below 1", share)
    if nominal is None or not math.isfinite(nominal):
        raise InvalidParameterError(f"uncertain.{name}", "have a number to spread around", kind.shown(nominal))
    made = {
        "normal": [nominal, share * nominal],
        "lognormal": [nominal, share],
        "uniform": [(1.0 - share) * nominal, (1.0 + share) * nominal],
        "triangular": [(1.0 - share) * nominal, nominal, (1.0 + share) * nominal],
    }
    return {word: made[kind.one_of(f"uncertain.{name}", word, made)]}


def chance_of(cell: Cell, planned: PlannedContact, allowed: AllowedSpeed | None) -> dict[str, Any]:
    """Return the chance that the planned speed is too fast, or why there is none.

    Parameters
    ----------
    cell : Cell
        What was asked.
    planned : PlannedContact
        The contact.
    allowed : AllowedSpeed or None
        Its allowed speed, if there is one.

    Returns
    -------
    dict
        Fields of the report.
    """
    hit = contact_of(cell, planned, planned.covering)
    pad = covering_of(hit.covering)
    reason = _reason(cell, planned, allowed, pad)
    if reason is not None:
        return {"status": "not_computed", "reason": reason}
    nominal = _nominal(cell, planned, pad)
    uncertain: dict[str, Any] = {
        name: spread(name, given, nominal.get(name)) for name, given in _applying(cell, planned).items()
    }
    try:
        found = hit.probability(planned.speed + cell.human_speed, draws=cell.draws, seed=cell.seed, **uncertain)
    except InvalidParameterError as error:
        raise error.renamed(f"uncertain: {error.argument}") from None
    return {
        "status": "computed",
        "probability": found.probability,
        "interval": list(found.interval),
        "quantiles": list(found.quantiles),
        "draws": found.draws,
        "uncertain": sorted(uncertain),
        "allowed": cell.allowed_chance,
        "reasons": reasons_of(found.warnings),
    }


def chance_doubts(cell: Cell, found: Mapping[str, Any]) -> tuple[ResultWarning, ...]:
    """Return the doubt about a contact that is too fast with more than the allowed chance, or whose chance is unknown.

    Parameters
    ----------
    cell : Cell
        What was asked.
    found : mapping
        Of `chance_of`.

    Returns
    -------
    tuple of ResultWarning
        Empty where the upper end of the interval is allowed, and where no input is uncertain.
    """
    if found["status"] != "computed":
        if not cell.uncertain:
            return ()
        message = f"inputs are uncertain, and the chance of being too fast is not known: {found['reason']}"
        return (ResultWarning("probability", "uncertain", message),)
    upper = found["interval"][1]
    if upper <= cell.allowed_chance:
        return ()
    message = (
        f"the chance of being too fast is {100.0 * found['probability']:.3g} % (at most {100.0 * upper:.3g} % with "
        f"95 % confidence), more than the allowed {100.0 * cell.allowed_chance:g} %"
    )
    return (ResultWarning("probability", "uncertain", message),)


def _reason(cell: Cell, planned: PlannedContact, allowed: AllowedSpeed | None, pad: Covering | None) -> str | None:
    if not cell.uncertain:
        return "no input is uncertain"
    if allowed is None:
        return "not checked" if planned.limit.permitted else "not permitted"
    if allowed.governs == "nothing":
        return "no limit is checked"
    if pad is not None and (pad.damping > 0.0 or pad.rate[:2] != (0.0, 0.0)):
        return "the covering has a damper or a rate"
    if math.isinf(cell.robot.mass):
        return "the mass of the robot is unbounded"
    return None


def _nominal(cell: Cell, planned: PlannedContact, pad: Covering | None) -> dict[str, float | None]:
    limit = planned.limit
    found: dict[str, float | None] = {
        "robot_mass": cell.robot.mass,
        "body_mass": limit.body_mass,
        "stiffness": limit.spring_constant,
        "force_limit": limit.force,
        "pressure_limit": limit.pressure,
        "area": planned.area,
    }
    if pad is not None:
        found |= {name: getattr(pad, name) for name in ("thickness", "area", "radius", "length")}
        found |= dict(zip(pad.material.keys.values(), pad.material.numbers, strict=True))
    return found


def _applying(cell: Cell, planned: PlannedContact) -> dict[str, Any]:
    """Return what is uncertain of a contact: a clamped body has no mass, a limit that is not there no spread."""
    nominal = _nominal(cell, planned, covering_of(contact_of(cell, planned, planned.covering).covering))
    gone = {name for name in OF_REGIONS if nominal[name] is None or not math.isfinite(float(nominal[name] or 0.0))}
    numbers_of_coverings = {name for pad in cell.coverings.values() for name in _own(pad)}
    gone |= {name for name in numbers_of_coverings if nominal.get(name) is None}
    return {name: given for name, given in cell.uncertain.items() if name not in gone}


def _own(pad: Covering) -> set[str]:
    """Return the names of the numbers that a covering has."""
    shape = {name for name in ("thickness", "area", "radius", "length") if getattr(pad, name) is not None}
    return shape | set(pad.material.keys.values())
