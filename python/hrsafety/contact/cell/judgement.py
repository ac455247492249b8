"""Whether each planned contact of a cell keeps its limits: allowed speeds, verdicts, what governs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from hrsafety.contact.cell.cell import Cell, PlannedContact, contact_of
from hrsafety.contact.covering import covering_of
from hrsafety.contact.speed import AllowedSpeed
from hrsafety.plausibility import ResultWarning, unsafe_doubts
from hrsafety.standards.sets import SETS
from hrsafety.standards.verdicts import speed_verdict

__all__ = ["FASTEST", "REGION_UNKNOWN", "Judged", "decided", "governing", "judged_of", "known", "reasons_of"]

FASTEST = 20.0
"""Up to this speed, in m/s, contacts are examined."""
NOT_PERMITTED = ResultWarning("not_permitted", "limits", "the limit set does not permit this contact")
REGION_UNKNOWN = ResultWarning(
    "region_unknown",
    "limits",
    "the limit set has no spring constant or no mass of the region, without which no speed is known: give "
    f'spring_constant_N_per_mm and effective_mass_kg, or base = "{SETS[0]}" at the top of a set in TOML',
)


class Judged(NamedTuple):
    """A planned contact with its allowed speeds, bare and with every covering, its verdict and the doubts of that."""

    planned: PlannedContact
    bare: AllowedSpeed | None
    covered: Mapping[str, AllowedSpeed]
    verdict: dict[str, Any]
    doubts: tuple[ResultWarning, ...] = ()

    @property
    def chosen(self) -> AllowedSpeed | None:
        """The allowed speed with the planned covering."""
        return self.bare if self.planned.covering is None else self.covered.get(self.planned.covering)


def reasons_of(found: Iterable[ResultWarning]) -> list[str]:
    """Return why limits do not count as kept."""
    return list(dict.fromkeys(each.message for each in unsafe_doubts(apart_from_drive(found))))


def apart_from_drive(found: Iterable[ResultWarning]) -> tuple[ResultWarning, ...]:
    """Return doubts without that of a clamped contact about the drive, which a cell judges by its own stop."""
    return tuple(each for each in found if (each.code, each.subject) != ("drive_not_given", "drive"))


def known(planned: PlannedContact) -> bool:
    """Whether a contact can be computed at all."""
    return planned.limit.spring_constant is not None and planned.limit.body_mass is not None


def _allowed(cell: Cell, planned: PlannedContact, covering: str | None) -> AllowedSpeed:
    found = contact_of(cell, planned, covering).allowed_speed(human_speed=cell.human_speed)
    return replace(found, warnings=apart_from_drive(found.warnings))


def judged_of(cell: Cell, planned: PlannedContact) -> Judged:
    """Return what was found of a contact."""
    permitted = planned.limit.permitted
    bare = _allowed(cell, planned, None) if permitted and known(planned) else None
    covered: dict[str, AllowedSpeed] = {}
    if bare is not None:
        covered = {name: _allowed(cell, planned, name) for name in cell.coverings}
    found = Judged(planned, bare, covered, {})
    return found._replace(verdict=_fields(cell, planned, found.chosen))


def decided(cell: Cell, judged: Judged, more: Iterable[ResultWarning]) -> Judged:
    """Return a contact with its verdict: every doubt that may lie on the unsafe side takes part unless confirmed.

    Parameters
    ----------
    cell : Cell
        What was asked, with the doubts of its robot.
    judged : Judged
        Without verdict.
    more : iterable of ResultWarning
        Doubts beside those of the allowed speed: of the loads, the drive, the chance.

    Returns
    -------
    Judged
        With ``verdict``, ``reasons``, ``doubts`` and ``confirmed``.
    """
    limit, allowed, row = judged.planned.limit, judged.chosen, dict(judged.verdict)
    found: list[ResultWarning] = []
    if not limit.permitted:
        found.append(NOT_PERMITTED)
    elif allowed is None:
        found.append(REGION_UNKNOWN)
    else:
        found += unsafe_doubts((*allowed.warnings, *cell.robot.warnings, *more))
    found = list(dict.fromkeys(found))
    left = [each for each in found if each.code not in cell.confirmed]
    most = row["allowed_closing_speed"]
    checked = allowed is not None and most is not None and not left
    row["verdict"] = speed_verdict(row["planned_closing_speed"], most, permitted=limit.permitted, checked=checked)
    row["reasons"] = [each.message for each in left]
    row["doubts"] = list(dict.fromkeys(each.code for each in left if each is not NOT_PERMITTED))
    row["confirmed"] = list(dict.fromkeys(each.code for each in found if each.code in cell.confirmed))
    return judged._replace(verdict=row, doubts=tuple(found))


def _fields(cell: Cell, planned: PlannedContact, allowed: AllowedSpeed | None) -> dict[str, Any]:
    limit, closing = planned.limit, planned.speed + cell.human_speed
    most = None
    if allowed is not None:
        most = FASTEST if allowed.status == "unlimited_up_to_20" else allowed.speed
    speed = None if most is None else max(most - cell.human_speed, 0.0)
    pad = covering_of(contact_of(cell, planned, planned.covering).covering)
    return {
        "region": limit.region,
        "area_name": limit.area,
        "contact": limit.contact,
        "covering": planned.covering,
        "contact_area": planned.area if pad is None else pad.area,
        "planned_speed": planned.speed,
        "planned_closing_speed": closing,
        "allowed_speed": speed,
        "allowed_closing_speed": most,
        "margin": None if speed is None else speed - planned.speed,
        "governs": None if allowed is None else allowed.governs,
        "status": "not_permitted" if not limit.permitted else None if allowed is None else allowed.status,
    }


def governing(judged: list[Judged]) -> Judged | None:
    """Return the contact with the least margin that has an allowed speed above 0."""
    allowed = [each for each in judged if each.verdict["allowed_closing_speed"]]
    return min(allowed, key=lambda each: float(each.verdict["margin"]), default=None)
