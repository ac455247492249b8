"""Study of a cell: verdicts, loads, curves, sensitivities and chances of its planned contacts."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, replace
from os import PathLike
from typing import Any, NamedTuple

import numpy as np

from hrsafety._arguments import Array, callback, instance
from hrsafety._records import dataclass
from hrsafety.contact.annex import Annex
from hrsafety.contact.cell.cell import Cell, PlannedContact, contact_of
from hrsafety.contact.cell.chances import chance_doubts, chance_of
from hrsafety.contact.cell.driven import drive_doubts, driven_of, driven_row
from hrsafety.contact.cell.file import load_cell
from hrsafety.contact.cell.handover import annex_of_cell, distances_fields, left_out, plan_of, regions_of
from hrsafety.contact.cell.judgement import (
    FASTEST,
    Judged,
    decided,
    governing,
    judged_of,
    known,
    reasons_of,
)
from hrsafety.contact.cell.stops import distances_of, doubts_of, speed_over_distance
from hrsafety.contact.covering import covering_of
from hrsafety.contact.plan import MeasurementPlan
from hrsafety.contact.simulation import ContactImpact
from hrsafety.contact.speed import AllowedSpeed
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, unsafe_doubts
from hrsafety.standards.separation import SpeedCurve
from hrsafety.standards.verdicts import doubted, strictest
from hrsafety.tables import Columns, Table, unit_suffix

__all__ = ["ContactStudy", "Curve", "label_of", "numbers_of", "study", "verdicts_of"]

SPEEDS = 41
MAP_POINTS = 25
MAP_SPAN = 4.0
"""A map reaches from a quarter of the covering's own numbers to four times them."""
CURVE_POINTS = 61
LATEST = 5.0
"""Time in s up to which a collision is followed whose loads still rise at the usual horizon."""
MAPPED = {"linear": "modulus", "gibson_ashby": "plateau", "rusch": "b", "avalle": "plateau"}
"""Number of each law that a map varies beside the thickness."""

_RESULT = (
    *("covering", "allowed_closing_speed", "governs", "status", "speed_force", "speed_pressure", "speed_strain"),
    *("further_crossings", "peak_force", "peak_pressure", "peak_strain", "bottomed", "end"),
    *("least_thickness", "least_thickness_status"),
)
"""Fields of a result; null where there is none."""
_LISTS = ("not_checked", "reasons", "least_thickness_reasons")
"""Fields of a result that are lists."""


class Curve(NamedTuple):
    """Force over speed of one contact."""

    label: str
    speed: Array
    force: Array


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ContactStudy(Table):
    """Contacts of a cell with their verdicts, and what pictures are drawn from.

    Attributes
    ----------
    verdict : {"not_permitted", "exceeds", "not_checked", "within_limits"}
        Strictest verdict of the contacts, and ``"not_checked"`` in place of ``"within_limits"`` where the separation
        distance is doubted on the unsafe side.
    verdicts : list of dict
        One row for each planned contact: its place, planned and allowed speeds in m/s, margin, verdict, the doubts
        that take part in it by code, and the reasons in words.
    fields : dict
        Every result by name, as report.json holds it: `verdicts`, loads, curves, map, sensitivity and chances.
    impacts : dict of str to dict of str to ContactImpact
        Collisions at the planned speed by region and label.
    curves : dict of str to list of Curve
        Peak force over closing speed by region.
    speeds : SpeedCurve or None
        Allowed speed over distance.
    plan : MeasurementPlan
        What to measure on the finished machine.
    annex : Annex
        For the technical file.
    warnings : tuple of ResultWarning
        Of every result.
    """

    verdict: str
    verdicts: list[dict[str, Any]]
    fields: dict[str, Any]
    impacts: Mapping[str, Mapping[str, ContactImpact]]
    curves: Mapping[str, list[Curve]]
    speeds: SpeedCurve | None
    plan: MeasurementPlan
    annex: Annex
    warnings: tuple[ResultWarning, ...]

    def columns(self) -> Columns:
        """Return one row for each planned contact.

        Returns
        -------
        dict of str to ndarray
            Place, verdict, speeds and margin by name; NaN where there is no speed.
        """
        words = ("region", "contact", "covering", "verdict", "governs")
        speeds = ("planned_speed", "allowed_speed", "margin")
        found: Columns = {name: np.array([str(each[name] or "") for each in self.verdicts]) for name in words}
        for name in speeds:
            values = [math.nan if each[name] is None else each[name] for each in self.verdicts]
            found[f"{name}{unit_suffix('m/s')}"] = np.array(values, dtype=np.float64)
        return found | {"doubts": np.array([", ".join(each["doubts"]) for each in self.verdicts])}


def study(cell: Cell | str | PathLike[str], *, progress: Callable[[int, int], object] | None = None) -> ContactStudy:
    """Return whether the planned contacts of a cell keep their limits, with loads, curves and chances.

    Parameters
    ----------
    cell : Cell or path-like
        The cell, or its file.
    progress : callable or None
        Called now and then as ``progress(done, total)`` while the longest part is computed, the map of speeds.

    Returns
    -------
    ContactStudy
        With the warnings of all results.

    Raises
    ------
    InvalidParameterError
        If a file cannot be read, or a value breaks a rule.

    Examples
    --------
    >>> from hrsafety import contact, standards
    >>> hand = standards.limits().contact("hand_finger", "transient")
    >>> cell = contact.Cell(
    ...     robot=contact.ContactRobot.of_mass(8.0),
    ...     contacts=[contact.PlannedContact(limit=hand, speed=0.25, area=1e-4)],
    ... )
    >>> found = contact.study(cell)
    >>> found.verdict, round(found.verdicts[0]["allowed_speed"], 3)
    ('within_limits', 1.369)
    """
    cell = load_cell(cell) if isinstance(cell, (str, PathLike)) else instance("cell", cell, Cell)
    callback("progress", progress)
    judged, loads, chances = verdicts_of(cell)
    curves = _over_speed(cell, judged)
    least = governing(judged)
    contact_speed = _least(judged)
    speeds = _over_distance(cell, contact_speed)
    rules = cell.separation
    distances = None if rules is None else distances_of(rules, rules["max_speed"], contact_speed)
    apart = doubts_of(speeds, distances, rules, cell.robot.payload_mass)
    plan, annex = plan_of(cell, judged, loads), annex_of_cell(cell, judged, distances)
    drawn = _by_region(judged, loads)
    verdicts = [each.verdict for each in judged]
    # Distances are handed over beside the contacts: a doubt about them is one about the whole.
    left = tuple(each for each in apart if each.code not in cell.confirmed)
    verdict = doubted(strictest(each["verdict"] for each in verdicts), left)
    fields: dict[str, Any] = {
        "verdict": verdict,
        "regions": regions_of(judged),
        "not_judged": left_out(cell.contacts),
        "verdicts": verdicts,
        "doubts": _counts(judged),
        "confirmed": dict(cell.confirmed),
        "robot": _robot(cell),
        "limits": _limits(cell),
        "results": [_result(cell, each, impacts) for each, impacts in zip(judged, loads, strict=True)],
        "curves": _curve_fields(drawn, curves),
        "map": None if least is None else _map(cell, least, progress),
        "speed_over_distance": None if speeds is None else _speed_fields(cell, speeds, left),
        "sensitivity": None if least is None else _sensitivity(cell, least),
        "probability": [_named(each) | chance for each, chance in zip(judged, chances, strict=True)],
        "distances": None if distances is None else distances_fields(distances),
        "plan": plan.fields(),
        "annex": annex.fields(),
    }
    return ContactStudy(
        verdict=verdict,
        verdicts=verdicts,
        fields=fields,
        impacts=drawn,
        curves=curves,
        speeds=speeds,
        plan=plan,
        annex=annex,
        warnings=(*_warnings(cell, judged, drawn), *apart),
    )


def verdicts_of(
    cell: Cell,
) -> tuple[list[Judged], list[dict[str | None, ContactImpact]], list[dict[str, Any]]]:
    """Return the contacts with their verdicts, their loads at the planned speed by covering, and their chances.

    Parameters
    ----------
    cell : Cell
        What was asked.

    Returns
    -------
    tuple of three lists
        In the order of the contacts.
    """
    found = [judged_of(cell, planned) for planned in cell.contacts]
    loads = [_loads(cell, each) for each in found]
    chances = [chance_of(cell, each.planned, each.chosen) for each in found]
    judged = []
    for each, impacts, chance in zip(found, loads, chances, strict=True):
        pressed = each._replace(verdict=each.verdict | {"drive": None})
        more: tuple[ResultWarning, ...] = ()
        if not _yields(each):
            driven = driven_of(cell, each.planned, each.verdict["planned_closing_speed"])
            pressed, more = driven_row(cell, each, driven), drive_doubts(cell, driven)
        chosen = impacts.get(each.planned.covering)
        doubts = (*(() if chosen is None else chosen.warnings), *more, *chance_doubts(cell, chance))
        judged.append(decided(cell, pressed, doubts))
    return judged, loads, chances


def _yields(judged: Judged) -> bool:
    """Return whether a contact is none that is clamped: nothing a drive could press."""
    return judged.chosen is None or judged.planned.limit.contact != "quasi_static"


def _counts(judged: list[Judged]) -> dict[str, int]:
    """Return for each doubt in how many verdicts it takes part."""
    codes = [code for each in judged for code in each.verdict["doubts"]]
    return {code: codes.count(code) for code in sorted(set(codes))}


def numbers_of(value: Any) -> Any:
    """Return a result as JSON holds it: infinite masses are words, what does not exist is null."""
    if isinstance(value, Mapping):
        return {str(key): numbers_of(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [numbers_of(each) for each in value]
    if isinstance(value, np.ndarray):
        return numbers_of(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return "unbounded" if value > 0.0 else None
    return value


# ---- robot and limits ---------------------------------------------------------------------------


def _robot(cell: Cell) -> dict[str, Any]:
    facts = asdict(replace(cell.robot, warnings=(), inputs={}))
    del facts["inputs"]
    if cell.robot.pose is not None:
        facts["pose"] = [{"joint": name, "value": value} for name, value in cell.robot.pose.items()]
    facts["warnings"] = [each.message for each in cell.robot.warnings]
    return facts


def _limits(cell: Cell) -> dict[str, Any]:
    rows = []
    for planned in cell.contacts:
        limit = planned.limit
        row: dict[str, Any] = {
            "region": limit.region,
            "area_name": limit.area,
            "contact": limit.contact,
            "permitted": limit.permitted,
            "pressure_area": limit.pressure_area,
        }
        numbers = {
            "force": limit.force_limit,
            "pressure": limit.pressure_limit,
            "spring_constant": limit.spring,
            "body_mass": limit.mass if limit.contact == "transient" else None,
        }
        for name, quantity in numbers.items():
            row[name] = None if quantity is None else quantity.value
            row[f"{name}_certainty"] = None if quantity is None else quantity.certainty
            row[f"{name}_sources"] = None if quantity is None else list(quantity.sources)
        rows.append(row)
    found = cell.limits
    header = {name: getattr(found, name) for name in ("id", "title", "edition", "note")}
    return {**header, "sources": dict(found.sources), "rows": rows}


# ---- loads --------------------------------------------------------------------------------------


def label_of(planned: PlannedContact, covering: str | None) -> str:
    """Return the label of a contact with a covering among those of its region."""
    kind = "clamped" if planned.limit.contact == "quasi_static" else "free"
    area = "" if planned.limit.area is None else f"{planned.limit.area}, "
    return f"{area}{kind}, {covering or 'bare'}"


def _impact(cell: Cell, planned: PlannedContact, covering: str | None) -> ContactImpact | None:
    if math.isinf(cell.robot.mass) and planned.limit.body_mass == math.inf:
        return None
    hit, closing = contact_of(cell, planned, covering), planned.speed + cell.human_speed
    try:
        found = hit.simulate(closing, head=False)
        return hit.simulate(closing, head=False, horizon=LATEST) if found.rising else found
    except InvalidParameterError as error:
        # A covering that is compressed by more than was measured has no loads; the verdict says so, too.
        if "beyond_data" not in error.requirement:
            raise
        return None


def _loads(cell: Cell, judged: Judged) -> dict[str | None, ContactImpact]:
    """Return the collisions at the planned speed, bare and with every covering."""
    if not known(judged.planned):
        return {}
    found = {covering: _impact(cell, judged.planned, covering) for covering in (None, *cell.coverings)}
    return {covering: impact for covering, impact in found.items() if impact is not None}


def _by_region(
    judged: list[Judged], loads: list[dict[str | None, ContactImpact]]
) -> dict[str, dict[str, ContactImpact]]:
    """Return collisions by region and label; of equal ones the last."""
    found: dict[str, dict[str, ContactImpact]] = {}
    for each, impacts in zip(judged, loads, strict=True):
        for covering, impact in impacts.items():
            found.setdefault(each.planned.limit.region, {})[label_of(each.planned, covering)] = impact
    return found


def _over_speed(cell: Cell, judged: list[Judged]) -> dict[str, list[Curve]]:
    found: dict[str, list[Curve]] = {}
    for each in judged:
        if not known(each.planned) or (math.isinf(cell.robot.mass) and each.planned.limit.body_mass == math.inf):
            continue
        most = 1.5 * max(each.verdict["planned_closing_speed"], each.verdict["allowed_closing_speed"] or 0.0)
        speeds = np.linspace(min(most, FASTEST) / SPEEDS, min(most, FASTEST), SPEEDS)
        for covering in dict.fromkeys((None, each.planned.covering)):
            rows = contact_of(cell, each.planned, covering).simulate_many(speeds)
            label = label_of(each.planned, covering)
            found.setdefault(each.planned.limit.region, []).append(Curve(label, speeds, rows.peak_force))
    return found


def _allowed_fields(allowed: AllowedSpeed) -> dict[str, Any]:
    return {
        "allowed_closing_speed": allowed.speed,
        "governs": allowed.governs,
        "status": allowed.status,
        **{f"speed_{name}": value for name, value in allowed.speeds.items()},
        "further_crossings": list(allowed.further),
        "not_checked": list(allowed.not_checked),
        "reasons": reasons_of(allowed.warnings),
    }


def _result(cell: Cell, judged: Judged, impacts: Mapping[str | None, ContactImpact]) -> dict[str, Any]:
    """Return what was found of a contact bare and with every covering."""
    planned = judged.planned
    rows = []
    for covering in (None, *cell.coverings):
        allowed = judged.bare if covering is None else judged.covered.get(covering)
        row: dict[str, Any] = dict.fromkeys(_RESULT) | {"covering": covering} | {name: [] for name in _LISTS}
        if allowed is not None:
            row |= _allowed_fields(allowed)
        impact = impacts.get(covering)
        if impact is not None:
            row |= {
                "peak_force": impact.peak_force,
                "peak_pressure": _pressure(planned, covering, impact),
                "peak_strain": impact.peak_strain,
                "bottomed": impact.bottomed,
                "end": impact.status,
            }
        if covering is not None and allowed is not None:
            row |= _thickness(cell, planned, covering)
        rows.append(row)
    return _named(judged) | {"rows": rows}


def _pressure(planned: PlannedContact, covering: str | None, impact: ContactImpact) -> float | None:
    """Return the peak pressure; of a bare contact it is the force over the area that was given."""
    if covering is not None:
        return impact.peak_pressure
    return None if planned.area is None or impact.peak_force is None else impact.peak_force / planned.area


def _thickness(cell: Cell, planned: PlannedContact, covering: str) -> dict[str, Any]:
    hit = contact_of(cell, planned, covering)
    pad = covering_of(hit.covering)
    if pad is None or pad.damping > 0.0 or pad.rate[:2] != (0.0, 0.0) or math.isinf(cell.robot.mass):
        return {"least_thickness": None, "least_thickness_status": "not_computed"}
    found = hit.thickness(planned.speed + cell.human_speed)
    return {
        "least_thickness": found.thickness,
        "least_thickness_status": found.status,
        "least_thickness_reasons": reasons_of(found.warnings),
    }


def _curve_fields(
    impacts: Mapping[str, Mapping[str, ContactImpact]], curves: Mapping[str, list[Curve]]
) -> list[dict[str, Any]]:
    return [
        {
            "region": region,
            "force_over_time": [
                {"label": label, "time": impact.time, "force": impact.force} for label, impact in by_label.items()
            ],
            "force_over_speed": [each._asdict() for each in curves.get(region, [])],
        }
        for region, by_label in impacts.items()
    ]


# ---- maps and chances ---------------------------------------------------------------------------


def _named(judged: Judged) -> dict[str, Any]:
    limit = judged.planned.limit
    return {
        "region": limit.region,
        "area_name": limit.area,
        "contact": limit.contact,
        "covering": judged.planned.covering,
    }


def _map(cell: Cell, judged: Judged, progress: Callable[[int, int], object] | None) -> dict[str, Any] | None:
    """Return the allowed speed over thickness and strength of the covering that is planned."""
    hit = contact_of(cell, judged.planned, judged.planned.covering)
    pad = covering_of(hit.covering)
    if pad is None:
        return None
    name = MAPPED.get(pad.material.law)
    own = None if name is None else getattr(pad.material, name)
    if name is None or not own:
        return None
    span = np.geomspace(1.0 / MAP_SPAN, MAP_SPAN, MAP_POINTS)
    thick, strength = pad.thickness * span, own * span
    found = hit.allowed_speeds(progress=progress, **{"thickness": thick[:, np.newaxis], name: strength})
    return {
        **_named(judged),
        "number": name,
        "thickness": thick,
        "strength": strength,
        "speed": [[None if math.isnan(each) else each for each in row] for row in found.speed.tolist()],
        "planned_closing_speed": judged.verdict["planned_closing_speed"],
        "reasons": reasons_of(found.warnings),
    }


def _least(judged: list[Judged]) -> float | None:
    """Return the speed at which every contact may happen, ``None`` where one has none."""
    # A contact that is not permitted, or of which something is not known, allows none at all; one that is planned too
    # fast has an allowed speed, if every limit behind it was checked.
    speeds = [None if each.verdict["doubts"] else each.verdict["allowed_speed"] for each in judged]
    return None if None in speeds else min(each for each in speeds if each is not None)


def _over_distance(cell: Cell, least: float | None) -> SpeedCurve | None:
    if cell.separation is None:
        return None
    distances = np.linspace(0.0, cell.separation["farthest"], CURVE_POINTS)
    return speed_over_distance(distances, cell.separation, contact_speed=least)


def _speed_fields(cell: Cell, curve: SpeedCurve, doubts: tuple[ResultWarning, ...]) -> dict[str, Any]:
    rules = dict(cell.separation or {})
    known = {*rules, "intrusion"} if "height" in rules else {*rules}
    return {
        "rules": rules,
        "contact": curve.status,
        "doubts": [each.code for each in unsafe_doubts(doubts)],
        "taken_as_zero": [name for name in ("intrusion", "uncertainty") if name not in known],
        "distance": curve.distance,
        "speed": curve.speed,
        "mode": curve.mode,
        "capped": curve.capped,
        "outside_table": curve.outside_table,
    }


def _sensitivity(cell: Cell, judged: Judged) -> dict[str, Any] | None:
    if math.isinf(cell.robot.mass):
        return None
    found = contact_of(cell, judged.planned, judged.planned.covering).sensitivity()
    return {**_named(judged), "values": [{"name": name, "value": value} for name, value in found.items()]}


def _warnings(
    cell: Cell, judged: list[Judged], impacts: Mapping[str, Mapping[str, ContactImpact]]
) -> Iterator[ResultWarning]:
    """Yield each doubt once, with the first contact that it is about and how many others."""
    yield from cell.robot.warnings
    places: dict[ResultWarning, list[str]] = {}
    for each in judged:
        limit = each.planned.limit
        careful = () if each.chosen is None else (doubt for doubt in each.chosen.warnings if doubt.safe_side)
        for found in (*each.doubts, *careful):
            if found not in cell.robot.warnings and found.code != "not_permitted":
                places.setdefault(found, []).append(f"{limit.region}, {limit.contact}")
    for region, by_label in impacts.items():
        for label, impact in by_label.items():
            for found in impact.warnings:
                places.setdefault(found, []).append(f"{region}, {label}, at the planned speed")
    for found, where in places.items():
        if not _told(found):
            more = "" if len(where) == 1 else f" and {len(where) - 1} more"
            yield replace(found, message=f"{where[0]}{more}: {found.message}")


def _told(doubt: ResultWarning) -> bool:
    """Whether a doubt about a contact is one about the mass of the robot, which says so once and knows the cause."""
    return doubt.code == "implausible" and doubt.subject == "robot_mass"
