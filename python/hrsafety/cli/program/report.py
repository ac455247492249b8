"""The report of a program: what report.json holds, and the answer in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from hrsafety import __version__
from hrsafety._keys import canonical
from hrsafety.cli.cell.report import CONFIRM, NOT_COVERED, sha256_of, to_thousandths
from hrsafety.contact.cell.study import numbers_of
from hrsafety.pages import sentence, versions
from hrsafety.pages.report import Report, ReportTable, Section
from hrsafety.program import DrawnStudy, ProgramStudy
from hrsafety.program.draws import LISTED, Quantile
from hrsafety.standards.verdicts import VERDICT_WORDS

__all__ = ["heaviest_held", "report_of", "report_of_draws"]

FORMAT = 1
CLASSES = {"quasi_static": "clamped", "transient": "free"}
OF_PROGRAMS = (
    "Jerk and torque: times hold for limits of velocity and acceleration of joints, and a controller may be slower.",
    "What the robot carries beyond its payload, and points of it that are not named.",
)


def report_of(path: str, study: ProgramStudy, *, command: str, date: str | None) -> Report:
    """Return the report of a study.

    Parameters
    ----------
    path : str
        The program file, as given.
    study : ProgramStudy
        What was found.
    command : str
        How the report was made.
    date : str or None
        Date to print; absent when ``None``.
    """
    program = study.program
    values = _values(study, list(_answer(study)), command, date, {"plan": study.plan.fields()})
    return Report(
        title=program.title,
        facts=[("program", path), *_facts(values)],
        said=VERDICT_WORDS[study.verdict],
        good=study.verdict == "within_limits",
        sections=[Section("Cycle times", [_times(study)]), Section("Segments", [_segments(study)]), *_zones(study)],
        warnings=study.warnings,
        values=values,
        source=path,
    )


def report_of_draws(path: str, study: DrawnStudy, *, command: str, date: str | None) -> Report:
    """Return the report of a robot without a program; the arguments are those of `report_of`."""
    program = study.program
    values = _values(study, list(_answer_of_draws(study)), command, date, {})
    return Report(
        title=program.title,
        facts=[("file", path), *_facts(values)],
        said=VERDICT_WORDS[study.verdict],
        good=study.verdict == "within_limits",
        sections=[
            Section("Limits over drawn motions", [SHARES, _shares(study)]),
            Section("Masses", [MASSES_TOLD, _masses(study)]),
            Section("What is not covered", values["not_covered"]),
            Section("Annex for Regulation (EU) 2023/1230", [values["annex"]["regulation"]]),
            *_annexed(study),
        ],
        warnings=study.warnings,
        values=values,
        files=["report.json"],
        made=date or "",
        source=path,
    )


def _values(
    study: ProgramStudy | DrawnStudy, answer: list[str], command: str, date: str | None, more: Mapping[str, Any]
) -> dict[str, Any]:
    """Return what report.json holds."""
    program = study.program
    inputs = canonical(numbers_of(program.given))
    values: dict[str, Any] = numbers_of(
        {
            "format": "hrsafety program report",
            "format_version": FORMAT,
            **({} if date is None else {"date": date}),
            "answer": answer,
            **study.fields,
            **more,
            "limits": {name: getattr(program.limits, name) for name in ("id", "title", "edition", "note")},
            "inputs": inputs,
            "not_covered": [*OF_PROGRAMS, *NOT_COVERED],
            "confirmation": CONFIRM,
            "audit": {
                "hrsafety": __version__,
                "versions": versions("numpy", "jinja2"),
                "command": command,
                "inputs_sha256": sha256_of(inputs),
                "files_sha256": dict(program.files),
            },
        }
    )
    return values


RETURNED = 0.01
"""Largest difference of a joint between start and end, in rad or m, of a path that returns."""
SHARES = (
    "Planned over allowed speed: quantiles of the drawn motions, each with its 95 % interval between order "
    "statistics, and the worst one. Each motion is as fast as the joints and the speed of the tool center point allow."
)
MASSES_TOLD = "Directional masses in kg. Near a singular pose a mass is above ten medians."


def _answer_of_draws(study: DrawnStudy) -> Iterator[str]:
    """Yield the answer in three sentences: the verdict, the hardest limit, the masses."""
    program, motion = study.program, study.program.motion
    worst = next((each for each in study.rows if each.exposure.limit.permitted and each.waypoint >= 0), None)
    held = "the worst one" if program.accept_quantile is None else f"the quantile of {program.accept_quantile:g}"
    verdict = VERDICT_WORDS[study.verdict]
    yield f"There is no program: of {motion.draws} drawn motions {held} counts, which makes the verdict: {verdict}."
    if worst is None:
        yield "No point that may move is permitted or able to touch."
    else:
        name = f"{program.points[worst.exposure.point].name} ({_limit(worst.exposure)})"
        speeds = f"{worst.speed:.3f} m/s where {to_thousandths(worst.allowed_speed):.3f} m/s are allowed"
        yield f"The hardest drawn motion is that of {name}: {speeds}."
    near = max((each.near_singular for each in study.masses), default=0.0)
    yield f"Up to {100.0 * near:.3g} % of the motions of a point are near a singular pose."


def _quantile(found: Quantile) -> str:
    low, high = (f"{each:.3g}" for each in (found.low, found.high))
    return f"{found.value:.3g} ({low} to {high})"


def _shares(study: DrawnStudy) -> ReportTable:
    rows = [
        (
            f"{row['segment']}: {row['point']}, {(row['area_name'] or row['region']).replace('_', ' ')}, "
            + CLASSES[row["contact"]]
            + (", with the drive" if row["with_drive"] else ""),
            VERDICT_WORDS[row["verdict"]],
            *(_quantile(each) for each in shares),
            f"{row['share_worst']:.3g}",
            ", ".join(row["doubts"]).replace("_", " ") or "-",
        )
        for row, shares in zip(study.fields["rows"], study.shares, strict=True)
    ]
    names = ("limit", "verdict", *(f"{100.0 * level:g} %" for level in LISTED), "worst", "doubts")
    return ReportTable(headers=[names], rows=rows, left=(0, 1, len(names) - 1), printed=True)


def _annexed(study: DrawnStudy) -> Iterator[Section]:
    """Yield the tables of the annex."""
    for heading, titles, rows in study.annex.tables():
        if rows:
            yield Section(heading, [ReportTable(headers=[titles], rows=rows, left=tuple(range(len(titles))))])


def _masses(study: DrawnStudy) -> ReportTable:
    rows = [
        (
            each.point,
            *(_quantile(one) for one in each.quantiles or ()),
            f"{each.worst:.3g}",
            f"{100.0 * each.near_singular:.3g} %",
        )
        for each in study.masses
        if each.quantiles
    ]
    names = ("point", *(f"{100.0 * level:g} %" for level in LISTED), "worst", "near a singular pose")
    return ReportTable(headers=[names], rows=rows, printed=True)


def _facts(values: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    robot = values["robot"]
    yield "robot", f"{robot['name']}, ISO/TS 15066 mass {robot['iso_mass']:.3f} kg ({robot['mass_rule']})"
    if robot["base"] is not None:
        yield "base", f"{robot['base']['kind']}, {robot['base']['mass']:g} kg on wheels{_held(values.get('rows', []))}"
    yield "limits", f"{values['limits']['title']}, edition {values['limits']['edition']}"
    yield "verdict", VERDICT_WORDS[values["verdict"]]
    for each in values["answer"]:
        yield "", each
    yield "", CONFIRM


def heaviest_held(rows: Sequence[Mapping[str, Any]]) -> int | None:
    """Return the number of the row that is heaviest if a base that rolls stands, ``None`` where none is known."""
    known = [place for place, each in enumerate(rows) if isinstance(each.get("mass_if_base_stands"), float)]
    return max(known, key=lambda place: float(rows[place]["mass_if_base_stands"]), default=None)


def _held(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return what the row that is heaviest if a base stands weighs with the base free to roll, and if it stands."""
    place = heaviest_held(rows)
    if place is None:
        return ""
    heavy = rows[place]
    masses = f"{heavy['mass_along_motion']:.3f} kg along its motion, {heavy['mass_if_base_stands']:.3f} kg"
    return f"; {heavy['point']}: {masses} if the base stood still"


def _answer(study: ProgramStudy) -> Iterator[str]:
    """Yield the answer: whether it may run as planned, what it takes, where the time goes, whether it returns."""
    yield _as_planned(study)
    yield _durations(study)
    yield _slowest(study)
    joints = study.waypoints.joints
    if np.abs(joints[-1] - joints[0]).max() > RETURNED:
        yield (
            "The path ends in another pose than it starts in: the way back is no part of it, neither its time nor its "
            "contacts."
        )


def _as_planned(study: ProgramStudy) -> str:
    program = study.program
    moving = [each for each in study.rows if each.waypoint >= 0]
    forbidden = next((each for each in study.rows if each.verdict == "not_permitted"), None)
    if forbidden is not None:
        limit = forbidden.exposure.limit
        place = program.segment_name(forbidden.exposure.segment)
        return (
            f"The program may not run as planned: {limit.contact.replace('_', '-')} contact of "
            f"{_region(limit)} is not permitted, and {place} has it within reach."
        )
    if not moving:
        return "No point moves where somebody is within reach."
    worst = moving[0]
    place = f"{program.points[worst.exposure.point].name} in {program.segment_name(worst.exposure.segment)}"
    allowed = to_thousandths(worst.allowed_speed)
    speeds = f"{worst.speed:.3f} m/s where {allowed:.3f} m/s are allowed ({_limit(worst.exposure)})"
    if worst.share > 1.0 + 1e-9:
        return f"As planned the program is too fast: {place} moves at {speeds}."
    if study.verdict == "not_checked":
        doubts = ", ".join(study.fields["doubts"]) or "path without segment"
        return f"As planned no limit is exceeded, hardest {place} at {speeds}, but doubts remain: {doubts}."
    return f"As planned the program keeps every limit, hardest {place} at {speeds}."


def _region(limit: Any) -> str:
    return str(limit.area or limit.region).replace("_", " ")


def _limit(exposure: Any) -> str:
    held = "with the drive" if exposure.how == "drive" else exposure.governs
    return f"{_region(exposure.limit)}, {CLASSES[exposure.limit.contact]}, {held}"


def _durations(study: ProgramStudy) -> str:
    times = {each.name: each for each in study.times}
    base = times.get("as recorded") or times["at robot limits"]
    words = []
    for each in study.times:
        if each.name.startswith("within limits of contacts, "):
            covering = each.name.removeprefix("within limits of contacts, ")
            words.append(
                f"{_seconds(each.time)} {covering if covering in ('bare', 'as planned') else f'with {covering}'}"
            )
    typed = times.get("with typed zones")
    zones = "" if typed is None else f", and {_seconds(typed.time)} with the zones as typed"
    return f"Within the limits of contacts it takes {', '.join(words)}{zones}; {base.name} {_seconds(base.time)}."


def _seconds(time: float | None) -> str:
    return "no finite time" if time is None else f"{time:.2f} s"


def _slowest(study: ProgramStudy) -> str:
    first = study.segments[0]
    if study.limited.standstill >= 0:
        return f"In {first.name} some limit allows no motion at all."
    if first.cost <= 0.005:
        return "No segment is slowed down by limits of contacts."
    return sentence(
        f"{first.name} costs most, {first.cost:.2f} s more than at robot limits: for "
        f"{100.0 * first.share:.0f} % of its time {_plainly(first.governs)} holds it back."
    )


def _plainly(governs: str) -> str:
    """Return what governs in words: point, region, class and limit."""
    point, colon, limit = governs.partition(": ")
    region, _, rest = limit.partition("/")
    contact, _, of = rest.partition("/")
    if not colon or contact not in CLASSES:
        return governs
    held = "with the drive" if of == "drive" else f"by its {of.replace('_', ' ')}"
    return f"{point} against a {region.replace('_', ' ')}, {CLASSES[contact]}, {held},"


def _times(study: ProgramStudy) -> ReportTable:
    rows = [(each.name, "-" if each.time is None else f"{each.time:.3f}", each.status) for each in study.times]
    return ReportTable(headers=[("cycle time", "time", "status"), ("", "s", "")], rows=rows, left=(0, 2), printed=True)


def _segments(study: ProgramStudy) -> ReportTable:
    rows = []
    for each in study.fields["segments"]:
        numbers = [each[name] for name in ("time_joints", "time_contact", "cost")]
        shown = ["-" if value is None else f"{value:.3f}" for value in numbers]
        rows.append((each["name"], ", ".join(each["regions"]) or "-", *shown, each["governs"]))
    names = ("segment", "regions", "joint limits", "contact limits", "cost", "governs longest")
    return ReportTable(headers=[names, ("", "", "s", "s", "s", "")], rows=rows, left=(0, 1, 5), printed=True)


def _zones(study: ProgramStudy) -> Iterator[Section]:
    zones = study.fields["zones"]
    if zones is None or not zones["zones"]:
        return
    rows = [
        (
            *(f"{each[end]['move']} {each[end]['distance']:.0f} mm".strip() for end in ("from", "to")),
            f"{each['speed']:g}",
            each["change"].replace("_", " "),
            each["reason"],
        )
        for each in zones["zones"]
    ]
    names = ("from", "to", "speed", "change", "reason")
    table = ReportTable(headers=[names, ("", "", zones["unit"], "", "")], rows=rows, left=(0, 1, 3, 4), printed=True)
    yield Section("Zones", [table])
