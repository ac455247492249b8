"""``hrsafety zones`` and ``hrsafety zones check``: zones that hold, and the verdict on those of a collision monitor."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from hrsafety import io, zones
from hrsafety._words import some
from hrsafety.cli import output, progress, terminal, verdict
from hrsafety.cli.parsers import UsageError
from hrsafety.errors import InvalidParameterError
from hrsafety.pages.report import Report, ReportCell, ReportTable, Section
from hrsafety.plausibility import ResultWarning
from hrsafety.zones.checking import VERDICTS
from hrsafety.zones.monitor_files import corners_of_text
from hrsafety.zones.monitor_text import grown_shapes

__all__ = ["FAILURES", "run_zones"]

FAILURES = ("broken", "not_covered", "any")
"""Words of ``--fail-on`` of ``hrsafety zones check``."""
CONDITIONS = (
    *("max_speed", "min_speed", "max_turn_rate", "holonomic", "deceleration", "turn_deceleration", "acceleration"),
    *("build_up", "command_fall", "turn_command_fall", "tracking_lag", "scan_period", "command_period", "error"),
    *("min_range", "max_range", "person_speed", "leg_radius", "supplement"),
)
"""Options that are parameters of `zones.Conditions` under the same name."""
NEEDED = ("--footprint", "--max-speed", "--max-turn-rate", "--deceleration", "--reaction", "--error", "--beam-step-deg")
OTHER_NAMES = {"reaction_time": "--reaction", "beam_step": "--beam-step-deg", "faults_only": "--all-sides"}
WORDS = {"broken": "broken", "not_covered": "not covered", "holds": "holds"}


def run_zones(options: argparse.Namespace) -> None:
    """Write zones that hold, or judge those of a file.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety zones``.
    """
    try:
        (_design if options.action is None else _check)(options)
    except InvalidParameterError as error:
        name = OTHER_NAMES.get(error.argument, f"--{error.argument.replace('_', '-')}")
        known = error.argument in OTHER_NAMES or hasattr(options, error.argument)
        raise (error.renamed(name) if known else error) from None


def _given(options: argparse.Namespace) -> dict[str, Any]:
    """Return the conditions that were given."""
    values = {name: getattr(options, name) for name in CONDITIONS}
    found = {name: value for name, value in values.items() if value is not None and value is not False}
    if options.footprint is not None:
        found["footprint"] = _footprint(options.footprint)
    if options.reaction is not None:
        found["reaction_time"] = options.reaction
    if options.beam_step_deg is not None:
        found["beam_step"] = math.radians(options.beam_step_deg)
    if options.scanner is not None:
        found["scanner"] = tuple(options.scanner)
    return found


def _footprint(text: str) -> object:
    """Return a radius or corners, as Nav2 writes a footprint."""
    try:
        return float(text)
    except ValueError:
        corners = corners_of_text(text)
        if corners is None:
            rule = 'be a radius in m, or corners as "[[x, y], [x, y], ...]"'
            raise InvalidParameterError("--footprint", rule, text) from None
        return corners


def _of_file(path: str) -> tuple[dict[str, Any], tuple[ResultWarning, ...]]:
    """Return what the file of the zones says of the robot elsewhere, and doubts; nothing if it holds zones alone."""
    try:
        settings = io.read_nav2(path)
    except InvalidParameterError:
        return {}, ()
    found: dict[str, Any] = {
        "footprint": settings.robot_radius if settings.footprint is None else settings.padded,
        "max_speed": settings.max_speed,
        "max_turn_rate": settings.max_turn_rate,
    }
    if settings.drive == "holonomic":
        speeds = [each for each in (settings.max_speed, settings.max_lateral_speed) if each is not None]
        found |= {"holonomic": True, "max_speed": max(speeds, default=None)}
    elif settings.min_speed is not None:
        found["min_speed"] = min(settings.min_speed, 0.0)
    return {name: value for name, value in found.items() if value is not None}, settings.body_warnings


# ---- zones that hold -----------------------------------------------------------------------------


def _design(options: argparse.Namespace) -> None:
    """Write zones that hold as YAML, and their table."""
    given = _given(options)
    names = ("footprint", "max_speed", "max_turn_rate", "deceleration", "reaction_time", "error", "beam_step")
    missing = [option for name, option in zip(names, NEEDED, strict=True) if name not in given]
    if missing:
        raise UsageError(f"zones needs {', '.join(missing)} (see hrsafety zones --help)")
    for name in ("attacks", "mend", "fail_on"):
        if getattr(options, name) is not None:
            raise UsageError(f"--{name.replace('_', '-')} goes with zones check FILE only (see hrsafety zones --help)")
    place = None if options.out is None else output.target("--out", options.out, (".yaml", ".yml"))
    if options.report is not None:
        output.planned_folder(options.report)
        output.require_page("--report")
    output.check_json(options)
    found = zones.design(
        zones.Conditions(**given),
        ranges=options.ranges,
        turn_ranges=options.turn_ranges,
        corners=options.corners,
        min_points=options.min_points,
        faults_only=not options.all_sides,
    )
    report = _design_report(found)
    print(terminal.told(report))
    written = [] if place is None else [output.write_text(place, found.yaml())]
    if options.report is not None:
        written = output.write_report(report, output.folder(options.report), _fields(found), written, "zones")
    output.say_written(written, report, options)
    if place is not None:
        print(f"next  hrsafety zones check {place} with the same robot, delays, scanner and people")
    output.report_warnings(found.warnings, options.strict)


def _design_report(found: zones.ZoneSet) -> Report:
    given = found.conditions
    stop = _stop(given, given.max_speed)
    manual = {
        "deceleration": given.deceleration,
        "control_time": 0.0,
        "scanner_time": given.reaction_time + given.build_up / 2.0,
    }
    standing = zones.protective_field(given.max_speed, **manual)
    walking = zones.protective_field(given.max_speed, **manual, person_speed=given.person_speed)
    blind = zones.blind_range(given.leg_radius, beam_step=given.beam_step, points=found.min_points)
    sides = "faces that move outward: the robot touches nobody" if found.faults_only else "every side until it stands"
    facts = [
        ("zones", f"{len(found.zones)}, slowest first, the robot stops for {some(found.min_points, 'point')}"),
        ("clear", sides),
        ("people", f"up to {given.person_speed:g} m/s, legs of radius {given.leg_radius:g} m or more"),
        ("stop", f"{stop.travel:.3f} m in {stop.time:.3f} s from {given.max_speed:g} m/s, reaction included"),
        ("source_timeout", f"{found.source_timeout:.4g} s, of a reaction of {given.reaction_time:g} s"),
        ("blind range", f"{blind:.2f} m: a thin leg beyond may have fewer beams than points are asked for"),
        (
            "manuals",
            f"S_L {standing:.2f} m for who stands, {walking:.2f} m for who walks {given.person_speed:g} m/s (with "
            "0.065 m tolerance, 0.35 m for reflectors, 0.15 m for a low clearance, 10 % brake wear)",
        ),
    ]
    rows = []
    for zone in found.zones:
        front, rear, left, right = zone.extents
        commands = zone.commands
        stop = _stop(given, max(abs(commands.linear_min), abs(commands.linear_max)))
        cells = [commands.linear_min, commands.linear_max, commands.theta_min, commands.theta_max]
        numbers = [front, rear, left, right, zone.area, stop.travel, stop.time, zone.leg_depth]
        rows.append((zone.name, *(f"{each:.3f}" for each in (*cells, *numbers))))
    header = (
        "zone",
        "from",
        "to",
        "turn from",
        "to",
        "front",
        "rear",
        "left",
        "right",
        "area",
        "travel",
        "time",
        "leg",
    )
    units = ("", "m/s", "m/s", "rad/s", "rad/s", "m", "m", "m", "m", "m2", "m", "s", "m")
    table = ReportTable(headers=(header, units), rows=rows, printed=True)
    note = (
        "Fields reach from the base frame. Travel and time are those of the fastest command of a zone; leg is what was "
        "added so that a leg between two beams is seen. The zones hold for the numbers above: measure deceleration and "
        "reaction of the loaded robot, let a velocity smoother keep command_fall, and see that turns end with the way: "
        "velocity and turn rate are taken to brake together."
    )
    return Report(
        title="Zones that hold",
        facts=facts,
        sections=[Section("Fields", [table, note])],
        warnings=found.warnings,
        values={
            "zones": [
                {
                    "name": each.name,
                    **each.commands._asdict(),
                    "points_m": each.corners,
                    "area_m2": each.area,
                    **dict(zip(("front_m", "rear_m", "left_m", "right_m"), each.extents, strict=True)),
                    "leg_depth_m": each.leg_depth,
                }
                for each in found.zones
            ],
            "min_points": found.min_points,
            "source_timeout_s": found.source_timeout,
            "blind_range_m": blind,
            "manual_standing_m": standing,
            "manual_walking_m": walking,
            "conditions": given.numbers(),
        },
    )


def _stop(given: zones.Conditions, speed: float) -> zones.StoppingTravel:
    return zones.stopping_travel(
        speed, deceleration=given.deceleration, reaction_time=given.reaction_time, build_up=given.build_up
    )


def _fields(found: zones.ZoneSet | zones.ZoneCheck) -> Iterator[tuple[str, Any, str]]:
    from hrsafety import plotting

    words = "Zones around the robot in its base frame; it drives to the right."
    yield "zones", plotting.zone_fields(found), words


# ---- verdict -------------------------------------------------------------------------------------


def _check(options: argparse.Namespace) -> None:
    """Judge the zones of a file."""
    if options.file is None:
        raise UsageError("zones check needs a FILE.yaml (see hrsafety zones --help)")
    if options.report is not None:
        raise UsageError("--report goes with zones only: the page of zones check is written by --out DIR")
    verdict.failures_of(options.fail_on, FAILURES)
    if options.out is not None:
        output.planned_folder(options.out)
        output.require_page("--out")
    mend = None if options.mend is None else output.target("--mend", options.mend, (".yaml", ".yml"))
    output.check_json(options)
    of_file, doubts = _of_file(options.file)
    given = _given(options)
    if options.holonomic:
        of_file.pop("min_speed", None)
    if not of_file.keys() - given.keys():
        doubts = ()  # nothing of them is used
    given = of_file | given
    conditions, _ = zones.Conditions.assumed(**given)
    with output.located(options.file):
        monitor = zones.load_monitor(options.file, footprint=conditions.footprint)
    with progress.live() as shown:
        found = zones.check(
            monitor,
            attacks=1000 if options.attacks is None else options.attacks,
            generations=options.generations,
            seed=options.seed,
            progress=None if shown is None else lambda done, total: shown("attacks", done, total, None),
            **given,
        )
    found = replace(found, warnings=tuple(dict.fromkeys((*found.warnings, *doubts))))
    report = _check_report(found, options)
    print(terminal.told(report))
    written = []
    if mend is not None:
        zones.mended(options.file, found).write(mend)
        written.append(mend)
        stops = {each.name for each in found.shapes}
        for name in grown_shapes(found):
            if name not in stops:
                print(f"mended  {name} grows too: it lies around a zone that stops, and keeps its lead")
    if options.out is not None:
        place = output.folder(options.out)
        written += [output.write_csv(place / "worst_attack.csv", *_steps(found.worst))]
        written = output.write_report(report, place, _pictures(found), written, "zones")
    output.say_written(written, report, options)
    counts = {word: int(found.verdict == word) for word in VERDICTS if word != "holds"}
    counts["any"] = int(found.verdict != "holds")
    said = _said(found)
    verdict.end(said, counts, found.warnings, options, 1, words=FAILURES)


def _said(found: zones.ZoneCheck) -> str:
    """Return the verdict in a sentence."""
    if found.verdict == "broken":
        worst = found.worst
        return (
            f"broken: {found.broken.count} of {some(found.broken.runs, 'attack')} by chance and "
            f"{found.searched_broken} of {found.searched} searched ones touched somebody while the robot moved toward "
            f"the person, the worst at {worst.contact_speed:.2f} m/s"
        )
    tried = (
        f"none of {some(found.broken.runs, 'attack')} by chance (at most {100.0 * found.broken.high:.2g} %, 95 %) and "
        f"{found.searched} searched ones"
    )
    if found.verdict == "not_covered":
        return f"not covered: {tried} broke the zones, but there are commands or places without one"
    return f"holds: {tried} broke the zones"


def _check_report(found: zones.ZoneCheck, options: argparse.Namespace) -> Report:
    given = found.conditions
    rows: list[tuple[object, ...]] = []
    for each in found.shapes:
        missing = "beyond sight" if each.needed is None else f"{each.missing:.3f}"
        look = "good" if each.missing == 0.0 else "bad"
        sides = (each.missing_front, each.missing_rear, each.missing_left, each.missing_right)
        numbers = [each.commands.linear_min, each.commands.linear_max, each.margin, each.standing_speed]
        cells = [f"{number:.3f}" for number in (*numbers, each.walking_speed)]
        rows.append((each.name, *cells, ReportCell(missing, look), *(output.decimal(side, 3) for side in sides)))
    header = ("zone", "from", "to", "margin", "standing", "walking", "too small by", "front", "rear", "left", "right")
    units = ("", "m/s", "m/s", "m", "m/s", "m/s", "m", "m", "m", "m", "m")
    table = ReportTable(headers=(header, units), rows=rows, printed=True)
    note = (
        "Standing and walking are the greatest speeds for which the margin along the way holds against people who "
        f"stand, and against those who walk {given.person_speed:g} m/s. A zone is too small by what the one that its "
        "commands need reaches beyond it, if it has to hold alone: with zones around it that slow the robot less may "
        "do, which the attacks tell."
    )
    facts = [
        ("file", f"{found.monitor.source or options.file}, {some(len(found.monitor.polygons), 'zone')}"),
        ("robot", _robot_words(given)),
        ("people", f"up to {given.person_speed:g} m/s, legs of radius {given.leg_radius:g} m or more"),
        ("by chance", str(found.broken)),
        (
            "searched",
            f"{found.searched_broken} of {some(found.searched, 'attack')} of CMA-ES, from the worst by chance",
        ),
        ("verdict", WORDS[found.verdict]),
    ]
    for name, command in found.uncovered:
        words = ", ".join(f"{each:.4g}" for each in command)
        facts.append(("uncovered", f"{name}: ({words}) m/s, m/s, rad/s"))
    sections = [Section("Zones that stop", [table, note])] if rows else [Section("", ["No zone stops the robot."])]
    return Report(
        title=f"Zones of {Path(options.file).name}",
        facts=facts,
        said=_said(found),
        good=found.verdict == "holds",
        advice=_advice(found),
        sections=sections,
        warnings=found.warnings,
        values=_values(found),
        source=options.file,
    )


def _robot_words(given: zones.Conditions) -> str:
    return (
        f"{given.slowest:g} to {given.max_speed:g} m/s, turns to {given.max_turn_rate:g} rad/s, brakes with "
        f"{given.deceleration:g} m/s^2 after {given.reaction_time:g} s"
    )


def _advice(found: zones.ZoneCheck) -> str:
    if found.verdict == "holds":
        return "Holds for the numbers above, whatever one person of them does; the attacks are a sample, not a proof."
    return "Make the zones larger (--mend FILE), the robot slower, or its reaction shorter."


def _values(found: zones.ZoneCheck) -> dict[str, Any]:
    worst = found.worst
    return {
        "verdict": found.verdict,
        "attacks": found.broken.runs,
        "broken": found.broken.count,
        "broken_share": {"value": found.broken.value, "low": found.broken.low, "high": found.broken.high},
        "searched": found.searched,
        "searched_broken": found.searched_broken,
        "seed": found.seed,
        "worst": {
            "genes": dict(zip(zones.GENES, worst.genes, strict=True)),
            "contact_time_s": worst.contact_time,
            "contact_speed_m_per_s": worst.contact_speed,
            "least_gap_m": float(worst.gap.min()),
        },
        "uncovered": [{"zone": name, "command": command} for name, command in found.uncovered],
        "zones": [
            {
                "name": each.name,
                **each.commands._asdict(),
                "margin_m": each.margin,
                "standing_speed_m_per_s": each.standing_speed,
                "walking_speed_m_per_s": each.walking_speed,
                "missing_m": each.missing,
                "missing_front_m": each.missing_front,
                "missing_rear_m": each.missing_rear,
                "missing_left_m": each.missing_left,
                "missing_right_m": each.missing_right,
                "blind_range_m": each.blind_range,
                "points_m": each.corners,
                "needed_points_m": each.needed,
            }
            for each in found.shapes
        ],
        "conditions": found.conditions.numbers(),
        "warning_codes": [each.code for each in found.warnings],
    }


def _steps(run: zones.AttackRun) -> tuple[list[str], list[list[float]]]:
    """Return header and rows of an attack."""
    header = ["time_s", "x_m", "y_m", "heading_rad", "vx_m_per_s", "vy_m_per_s", "turn_rate_rad_per_s"]
    header += ["command_vx_m_per_s", "command_vy_m_per_s", "command_turn_rate_rad_per_s", "leg_x_m", "leg_y_m", "gap_m"]
    columns = zip(run.time, run.pose, run.velocity, run.command, run.person, run.gap, strict=True)
    return header, [[float(t), *map(float, (*p, *v, *c, *leg)), float(gap)] for t, p, v, c, leg, gap in columns]


def _pictures(found: zones.ZoneCheck) -> Iterator[tuple[str, Any, str]]:
    from hrsafety import plotting

    yield from _fields(found)
    words = "The worst attack: robot and leg at five instants, and speed and gap over time."
    yield "worst_attack", plotting.zone_attack(found), words
