"""``hrsafety judge LOG``: a recorded robot judged, printed, and written as a page."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from hrsafety import io, scenarios
from hrsafety import navigation as nav
from hrsafety._words import some
from hrsafety.cli import output, terminal, verdict
from hrsafety.cli.output import decimal
from hrsafety.cli.recordings import in_words, is_given, loaded, told_in_options
from hrsafety.datasets import Recording
from hrsafety.errors import InvalidParameterError
from hrsafety.io.places.nav2 import body_of
from hrsafety.navigation.judging.unjudged import REASONS
from hrsafety.navigation.metrics import METRICS, Judgement
from hrsafety.pages.report import Report, ReportCell, ReportTable, Section
from hrsafety.plausibility import ResultWarning

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["FAILURES", "judge_log"]

FAILURES = {
    "contact": "a contact with a person or a wall",
    "moving_contact": "a contact with a person while the robot moved faster than 0.05 m/s",
    "at_fault": "a contact in which the robot moved toward the person or wall",
    "wall_contact": "a contact with a wall",
    "possible_contact": "a contact that the error of the positions leaves open",
    "broken_assumption": "an assumption of the shield was broken",
    "violated_rule": "a rule of permission was violated",
    "any": "any of these",
}
"""Words of ``--fail-on``."""
UNSHIELDED = "none was given: the log shows what one would have to assume, and no assumption can be broken"
MOST = 20
"""Rows of a table before it is folded."""


def judge_log(options: argparse.Namespace) -> None:
    """Judge a log and report.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety judge``.
    """
    fail_on = verdict.failures_of(options.fail_on, tuple(FAILURES))  # a wrong word is told before the work
    output.check_targets(options)
    people = _people(options)
    with told_in_options():
        log = io.load_log(
            options.log,
            robot=options.robot_frame,
            people=people,
            frame=options.frame,
            offset=_offsets(options.offset),
        )
    if options.time is not None:
        log = log.part(*options.time)
    given, told = _robot(options)
    if "shield" not in given and "broken_assumption" in fail_on:
        rule = "name broken_assumption only with a shield, whose assumptions a log can break"
        remedy = "give --robot FILE.toml with a table [safe.shield]"
        raise InvalidParameterError("--fail-on", rule, options.fail_on, remedy)
    walls = log.map if options.map is None else _map(options.map, options.unknown)
    goal = None if options.goal is None else tuple(options.goal)
    found = nav.metrics.judge(
        log,
        map=walls,
        step=options.step,
        goal=goal,
        moments=options.moments,
        person_radius=options.person_radius,
        view=options.view,
        **given,
    )
    found = replace(found, warnings=tuple(dict.fromkeys(in_words(_without_fits(*found.warnings, *told)))))
    report = _report(options, log, found)
    print(terminal.told(report))
    written: list[Path] = []
    if options.out is not None:
        from hrsafety import plotting

        place = output.folder(options.out)
        plays = [plotting.player(found, title=report.title)]
        written = output.write_report(report, place, _draw(found), [_table(found, place)], plays=plays)
    written += output.mcap(found, options)
    output.say_written(written, report, options)
    verdict.end(report.said, found.counts, found.warnings, options, 1, tuple(FAILURES))


def _people(options: argparse.Namespace) -> Recording | str | None:
    """Return the people of a file, read as the options say, or what says where they are."""
    if not is_given(options):
        people: str | None = options.people
        return people
    if options.people is None or not Path(options.people).exists():
        rule = "be a file of recorded people, where options say how to read it"
        raise InvalidParameterError("--people", rule, options.people)
    return loaded(options.people, options)


def _offsets(given: Sequence[str] | None) -> dict[str, float] | None:
    found = {}
    for each in given or ():
        topic, sign, value = each.rpartition("=")
        try:
            found[topic] = float(value)
        except ValueError:
            sign = ""
        if not sign or not topic:
            raise InvalidParameterError("--offset", "be TOPIC=SECONDS", each)
    return found or None


def _without_fits(*found: ResultWarning) -> Iterator[ResultWarning]:
    """Yield warnings without the remedy of noise that a judgement has in itself."""
    for each in found:
        have = "the judgement fits velocities over its window, and its errors hold the noise"
        yield replace(each, message=each.message.replace("recording.smoothed(0.6) takes the noise out", have))


def _map(path: str, unknown: Literal["free", "occupied"]) -> nav.StaticMap:
    """Return the walls of a map; by default the robot touches nothing where the map is unknown."""
    try:
        return io.load_map(path, unknown=unknown)
    except InvalidParameterError as error:
        if error.argument != "unknown":
            raise
    return io.load_map(path)  # a plan, which has no unknown cells


def _robot(options: argparse.Namespace) -> tuple[dict[str, Any], tuple[ResultWarning, ...]]:
    """Return what is known of the robot, and doubts: from settings of Nav2, a scenario file, and the command line."""
    given: dict[str, Any] = {}
    told: tuple[ResultWarning, ...] = ()
    if options.params is not None:
        with output.located(options.params):
            settings = io.read_nav2(options.params)
            told = settings.body_warnings
            given |= _robot_of(settings, options.radius)
        outlined = "robot" in given and given["robot"].footprint is not None and options.robot is None
        if settings.circumscribed_radius is not None and not outlined:
            given["robot_radius"] = settings.circumscribed_radius
    if options.robot is not None:
        with output.located(options.robot):
            described = scenarios.load(options.robot)
        given["robot"] = described.scenario.robot
        given["control_period"] = described.scenario.control_period
        if isinstance(described.law, nav.laws.SafeNavigation) and described.law.shield is not None:
            given["shield"] = described.law.shield
    if options.radius is not None:
        given["robot_radius"] = options.radius
    if not given.keys() & {"robot", "robot_radius"}:
        remedy = "give --radius M, or --robot or --params with a radius or footprint"
        raise InvalidParameterError("--radius", "be known", None, remedy)
    return given, told


def _robot_of(settings: io.Nav2Settings, radius: float | None) -> dict[str, Any]:
    """Return the robot of a file if it gives all limits; its outline is examined without them, too."""
    if radius is None:
        body_of(settings)
        own = {}
    else:
        own = {"radius": radius}
    limits = (settings.max_speed, settings.max_acceleration)
    if settings.drive == "car" or None in limits or (settings.circumscribed_radius is None and radius is None):
        return {}
    return {"robot": settings.robot(**own)}


# ---- report -------------------------------------------------------------------------------------------------


def _body(found: Judgement) -> str:
    """Return by what the robot is judged."""
    if found.footprint is None:
        return f"radius {found.robot_radius:g} m"
    return f"footprint of {some(len(found.footprint.corners), 'corner')}, within {found.robot_radius:.3g} m"


def _said(found: Judgement) -> str:
    """Return the verdict in a sentence."""
    counts = found.counts
    unknown = sum(each.kind == "apart" for each in found.contacts)
    open_fault = f", {unknown} not known" if unknown else ""
    contacts = (
        f"{some(counts['contact'], 'contact')} ({counts['at_fault']} at fault{open_fault})"
        if counts["contact"]
        else "no contact"
    )
    parts = [contacts]
    if counts["possible_contact"]:
        parts.append(f"{counts['possible_contact']} more possible")
    rules = [word for each in found.passings for word in each.kept.values()]
    if rules:
        open_ones = sum(word in ("not_judged", "not_measurable") for word in rules)
        kept, violated = some(rules.count("kept"), "rule"), rules.count("violated")
        passed = some(len(found.passings), "passing")
        parts.append(f"{passed}: {kept} kept, {violated} violated, {open_ones} open")
    return f"{', '.join(parts)}; {100.0 * found.judged_share:.1f} % of the log judged"


def _report(options: argparse.Namespace, log: io.RobotLog, found: Judgement) -> Report:
    robot, people = found.bandwidth
    wide = f"{robot:.2g} Hz for the robot" + ("" if math.isnan(people) else f", {people:.2g} Hz for people")
    delays = ", ".join(
        f"{topic} {1e3 * each.median:.0f} ms (95 % {1e3 * each.high:.0f}, at most {1e3 * each.most:.0f})"
        for topic, each in log.delay.items()
    )
    factor = [] if log.time_factor is None else [("clock", f"simulated, {log.time_factor:.3g} s in a second")]
    crowd = "nobody" if log.people is None else f"{len(log.people.people())}, {some(len(log.people), 'position')}"
    facts = [
        ("log", f"{options.log} ({log.source.format}, SHA-256 {log.source.sha256[:16]})"),
        ("robot", f"{some(len(log), 'pose')} in {log.duration:.2f} s, in frame {log.frame}; {_body(found)}"),
        ("people", f"{crowd}; radius {found.person_radius:g} m"),
        ("instants", f"every {found.step:g} s; velocities over {found.window:g} s keep what is slower than {wide}"),
        *([] if found.shielded else [("shield", UNSHIELDED)]),
        ("error", f"{found.error:.3f} m of a clearance, from the noise of the log"),
        *([("delays", delays)] if delays else []),
        *factor,
    ]
    sections = [
        Section("Contacts", list(_contacts(found))),
        Section("Worst moments", list(_moments(found))),
        Section("Rules of permission", list(_rules(found))),
        Section("Assumptions of the shield", list(_assumptions(found))),
        Section("What is not judged", list(_open(found))),
        Section("Social metrics", list(_metrics(found))),
    ]
    return Report(
        title=f"Judgement of {Path(options.log).name}",
        facts=facts,
        said=_said(found),
        good=found.counts["any"] == 0,
        sections=[each for each in sections if each.blocks],
        warnings=found.warnings,
        values=_values(log, found),
        source=options.log,
    )


def _who(person: int | str | None) -> str:
    return "-" if person is None else str(person)


def _contacts(found: Judgement) -> Iterator[str | ReportTable]:
    every = sorted((*found.contacts, *found.possible_contacts), key=lambda each: each.begin)
    if not every:
        yield "The robot touched nobody where it and people were seen, also on straight lines between the instants."
        return
    names = ("begin", "end", "with", "kind", "at fault", "robot speed", "clearance", "error", "between")
    units = ("s", "s", "", "", "", "m/s", "m", "m", "s")
    rows = [
        (
            decimal(each.begin),
            decimal(each.end),
            "wall" if each.person is None else _who(each.person),
            ReportCell(each.kind.replace("_", " "), "bad"),
            "yes" if each.at_fault else "not known" if each.kind in ("apart", "possible_contact") else "no",
            decimal(each.speed),
            decimal(each.clearance, 3),
            decimal(each.error, 3),
            f"{'?' if each.kind == 'apart' else f'{each.earliest:.2f}'} to {each.latest:.2f}",
        )
        for each in every
    ]
    yield ReportTable(headers=(names, units), rows=rows, left=(2, 3), printed=True, most=MOST, summary="all contacts")


def _moments(found: Judgement) -> Iterator[ReportTable]:
    names = ("", "time", "person", "clearance", "error", "missing", "robot speed", "closing speed", "time to collision")
    units = ("", "s", "", "m", "m", "m", "m/s", "m/s", "s")
    rows = [
        (
            number,
            decimal(each.time),
            _who(each.person),
            *(decimal(value, 3) for value in (each.clearance, each.error, each.missing)),
            *(decimal(value) for value in (each.robot_speed, each.closing_speed, each.time_to_collision)),
        )
        for number, each in enumerate(found.moments, start=1)
    ]
    if rows:
        yield ReportTable(headers=(names, units), rows=rows, left=(2,), printed=True)


LOOKS = {"kept": "good", "held": "good", "violated": "bad", "broken": "bad"}


def _word(word: str) -> ReportCell:
    return ReportCell(word.replace("_", " "), LOOKS.get(word, ""))


def _rules(found: Judgement) -> Iterator[str | ReportTable]:
    early = ("early adjustment", "lead time", "lead distance")
    calm = ("no swerve", "lateral", "turn", "braking", "judged", "open because of")
    names = ("person", "from", "passing", *early, "passing clearance", "clearance", "required", *calm)
    units = ("", "s", "s", "", "s", "m", "", "m", "m", "", "m/s^2", "rad", "m/s^2", "%", "")
    rows = [
        (
            _who(each.person),
            decimal(each.begin),
            decimal(each.pass_time),
            _word(each.early_adjustment),
            decimal(each.lead_time),
            decimal(each.lead_distance),
            _word(each.clearance_kept),
            decimal(each.passing_clearance),
            decimal(each.required_clearance),
            _word(each.no_swerve),
            decimal(each.lateral_acceleration),
            decimal(each.turn),
            decimal(each.braking),
            f"{100.0 * each.judged_share:.0f}",
            each.reason.replace("_", " "),
        )
        for each in found.passings
    ]
    if rows:
        yield ReportTable(
            headers=(names, units), rows=rows, left=(0, 3, 6, 9, 14), printed=True, most=MOST, summary="all passings"
        )
        yield "A rule counts as kept only if 95 % of its encounter is judged, and nobody was lost nearby."


def _assumptions(found: Judgement) -> Iterator[str | ReportTable]:
    names = ("assumption", "status", "assumed", "99 %", "largest", "error", "unit", "at", "note")
    units = ("", "", "", "", "", "", "", "s", "")
    rows = [
        (
            each.name.replace("_", " "),
            _word(each.status),
            decimal(each.limit, 3),
            decimal(each.quantile, 3),
            decimal(each.most, 3),
            decimal(each.error, 3),
            each.unit,
            decimal(each.time),
            each.note,
        )
        for each in found.assumptions
    ]
    yield ReportTable(headers=(names, units), rows=rows, left=(0, 1, 6, 8), printed=True)
    if not found.shielded:
        yield f"No shield: {UNSHIELDED}."


def _metrics(found: Judgement) -> Iterator[str | ReportTable]:
    begin, end = found.scored
    if math.isnan(begin):
        yield "There is no part in which the robot is followed from instant to instant."
        return
    values = found.metrics.to_dict()
    rows = [(metric.name, _shown(values[metric.name]), metric.unit, metric.meaning) for metric in METRICS.values()]
    without = "" if math.isfinite(values["final_goal_distance"]) else " What needs a goal (--goal) is left open."
    yield f"Of the longest part without a gap or a jump of the pose, {begin:.2f} to {end:.2f} s.{without}"
    yield ReportTable(headers=(("metric", "value", "unit", "meaning"),), rows=rows, left=(0, 2, 3))


def _shown(value: float | int | bool) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return str(value) if isinstance(value, int) else decimal(value, 3)


def _open(found: Judgement) -> Iterator[ReportTable]:
    rows = [
        (decimal(each.begin), decimal(each.end), _who(each.person), REASONS[each.reason]) for each in found.not_judged
    ]
    if rows:
        headers = (("from", "to", "person", "reason"), ("s", "s", "", ""))
        yield ReportTable(headers=headers, rows=rows, left=(2, 3), most=MOST, summary="all parts")


def _values(log: io.RobotLog, found: Judgement) -> dict[str, Any]:
    return {
        "source": {"path": log.source.path, "format": log.source.format, "sha256": log.source.sha256},
        "verdict": _said(found),
        "counts": found.counts,
        "judged_share": found.judged_share,
        "step_s": found.step,
        "window_s": found.window,
        "bandwidth_Hz": found.bandwidth,
        "error_m": found.error,
        "robot_radius_m": found.robot_radius,
        "footprint_m": None if found.footprint is None else found.footprint.corners,
        "person_radius_m": found.person_radius,
        "delay_s": {topic: each._asdict() for topic, each in log.delay.items()},
        "pose_jumps": [each._asdict() for each in log.pose_jumps],
        "contacts": [each._asdict() for each in found.contacts],
        "possible_contacts": [each._asdict() for each in found.possible_contacts],
        "moments": [each._asdict() for each in found.moments],
        "passings": [each._asdict() for each in found.passings],
        "assumptions": [each._asdict() for each in found.assumptions],
        "scored_s": found.scored,
        "metrics": found.metrics.to_dict(),
        "not_judged": [each._asdict() for each in found.not_judged],
    }


def _table(found: Judgement, place: Path) -> Path:
    """Write the synchronized robot with the nearest person at each instant."""
    header = ("t_s", "x_m", "y_m", "yaw_rad", "vx_m_s", "vy_m_s", "nearest_person", "clearance_m", "wall_clearance_m")
    rows = []
    for row, time in enumerate(found.time.tolist()):
        gaps = found.clearance[row]
        near = int(np.nanargmin(gaps)) if np.isfinite(gaps).any() else -1
        person, gap = ("", math.nan) if near < 0 else (str(found.people[near]), float(gaps[near]))
        own = (*found.position[row].tolist(), float(found.heading[row]), *found.velocity[row].tolist())
        rows.append((time, *own, person, gap, float(found.wall_clearance[row])))
    return output.write_csv(place / "judged.csv", header, rows)


def _draw(found: Judgement) -> Iterator[tuple[str, Figure, str]]:
    from hrsafety import plotting

    yield "way", plotting.runs.judged_way(found), "Way of the robot, people who came nearest, and the worst moments."
    if found.moments:
        caption = "The worst moments, 2 s before and after; the robot stands in the middle."
        yield "moments", plotting.runs.worst_moments(found), caption
