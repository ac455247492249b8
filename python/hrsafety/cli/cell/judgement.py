"""Whether each planned contact of a cell keeps its limits: allowed speeds, verdicts, what governs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from hrsafety import contact
from hrsafety.cli.cell.file import Cell, Planned
from hrsafety.plausibility import ResultWarning
from hrsafety.standards.verdicts import speed_verdict

__all__ = ["FASTEST", "Judged", "common", "governing", "judged_of", "known", "reasons_of", "strain"]

UNCHECKED = frozenset(
    {
        *("rising_at_horizon", "unfinished", "beyond_data", "invalid_numbers", "not_checked"),
        *("outside_paraboloid", "beyond_pad", "beyond_thickness", "edge", "bare_exceeds"),
    }
)
"""Warnings with which a limit does not count as kept."""
FASTEST = 20.0
"""Up to this speed, in m/s, contacts are looked at."""


class Judged(NamedTuple):
    """A planned contact with its allowed speeds, bare and with every covering, and the verdict."""

    planned: Planned
    bare: contact.AllowedSpeed | None
    covered: Mapping[str, contact.AllowedSpeed]
    verdict: dict[str, Any]

    @property
    def chosen(self) -> contact.AllowedSpeed | None:
        """The allowed speed with the planned covering."""
        return self.bare if self.planned.covering is None else self.covered.get(self.planned.covering)


def reasons_of(found: Iterable[ResultWarning]) -> list[str]:
    """Return why limits do not count as kept."""
    return [each.message for each in found if each.code in UNCHECKED]


def common(cell: Cell, planned: Planned) -> dict[str, Any]:
    """Return what every computation about a contact is given."""
    limit = planned.limit
    return {
        "robot_mass": cell.robot.mass,
        "body_mass": limit.body_mass,
        "region": limit.spring_constant,
    }


def known(planned: Planned) -> bool:
    """Whether a contact can be computed at all."""
    return planned.limit.spring_constant is not None and planned.limit.body_mass is not None


def strain(cell: Cell, covering: str | None) -> float | None:
    """Return the largest strain of a covering, ``None`` for its own."""
    return None if covering is None else cell.strains[covering]


def _allowed(cell: Cell, planned: Planned, covering: str | None) -> contact.AllowedSpeed:
    pad = None if covering is None else cell.coverings[covering]
    return contact.allowed_speed(
        **common(cell, planned),
        limits={"force": planned.limit.force, "pressure": planned.limit.pressure},
        covering=pad,
        area=planned.area if pad is None else None,
        max_strain=strain(cell, covering),
        human_speed=cell.human_speed,
    )


def judged_of(cell: Cell, planned: Planned) -> Judged:
    """Return what was found of a contact."""
    permitted = planned.limit.permitted
    bare = _allowed(cell, planned, None) if permitted and known(planned) else None
    covered: dict[str, contact.AllowedSpeed] = {}
    if bare is not None:
        covered = {name: _allowed(cell, planned, name) for name in cell.coverings}
    found = Judged(planned, bare, covered, {})
    return found._replace(verdict=_verdict(cell, planned, found.chosen))


def _verdict(cell: Cell, planned: Planned, allowed: contact.AllowedSpeed | None) -> dict[str, Any]:
    limit, closing = planned.limit, planned.speed + cell.human_speed
    reasons: list[str] = []
    if not limit.permitted:
        reasons.append("the limit set does not permit this contact")
    elif allowed is None:
        reasons.append("the limit set has no spring constant or no mass of the region")
    else:
        reasons += reasons_of(allowed.warnings)
    most = None
    if allowed is not None:
        most = FASTEST if allowed.status == "unlimited_up_to_20" else allowed.speed
    checked = allowed is not None and most is not None and not reasons
    word = speed_verdict(closing, most, permitted=limit.permitted, checked=checked)
    speed = None if most is None else max(most - cell.human_speed, 0.0)
    return {
        "region": limit.region,
        "area_name": limit.area,
        "contact": limit.contact,
        "covering": planned.covering,
        "planned_speed": planned.speed,
        "planned_closing_speed": closing,
        "allowed_speed": speed,
        "allowed_closing_speed": most,
        "margin": None if speed is None else speed - planned.speed,
        "governs": None if allowed is None else allowed.governs,
        "status": "not_permitted" if not limit.permitted else None if allowed is None else allowed.status,
        "verdict": word,
        "reasons": reasons,
    }


def governing(judged: list[Judged]) -> Judged | None:
    """Return the contact with the least margin that has an allowed speed above 0."""
    allowed = [each for each in judged if each.verdict["allowed_closing_speed"]]
    return min(allowed, key=lambda each: float(each.verdict["margin"]), default=None)
