"""``hrsafety simulate --people FILE.csv``: a robot across recorded people, many times."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety import datasets, scenarios
from hrsafety import navigation as nav
from hrsafety._records import dataclass
from hrsafety._words import some
from hrsafety.cli import output, terminal, verdict
from hrsafety.cli.output import decimal
from hrsafety.cli.recordings import in_words, loaded
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.outcomes import OUTCOMES
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.pages.report import Report, ReportTable, Section
from hrsafety.plausibility import ResultWarning, gathered
from hrsafety.scenarios.laws import name_of
from hrsafety.scenarios.recorded_people import ACTIVE_RADIUS, CRITICAL_RADIUS, PERSON_RADIUS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["simulate_people"]

Array = npt.NDArray[np.float64]
DEFAULT_RUNS = 24
MANY = 5
"""A run meets many people when so many enter the active region."""


@dataclass(frozen=True, slots=True)
class _Encounters:
    """Least distance of every person in every run, one row each."""

    run: npt.NDArray[np.int64]
    person: npt.NDArray[Any]
    distance: Array
    contact: float
    critical: float
    active: float


def simulate_people(options: argparse.Namespace) -> None:
    """Cross the main flow of recorded people at many start times and report.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety simulate``.
    """
    runs = DEFAULT_RUNS if options.runs is None else options.runs
    shown = options.animate_run
    if shown is not None and not 0 <= shown < runs:
        raise InvalidParameterError("--animate-run", f"be from 0 to {runs - 1}", shown)
    if shown is not None and options.animate is None:
        raise InvalidParameterError("--animate-run", "come with --animate FILE", shown)
    verdict.failures_of(options.fail_on)  # a wrong word is told before the runs
    output.check_targets(options)
    law = output.with_options(nav.VirtualForceField(), options)
    recording = loaded(options.people, options)
    crossings = scenarios.crossings(recording, runs=runs, selection=options.selection or "busiest")
    stepping = {"integrator": options.integrator, "step": options.step, "hold": options.hold}
    summary = nav.simulate_batch([crossing.scenario for crossing in crossings], law, **stepping)
    met = _encounters(crossings, summary)
    found = _doubts(recording, crossings, summary, [nav.simulate(each.scenario, law, **stepping) for each in crossings])
    counts, totals = verdict.counted(summary), "\n".join(_totals(summary, met))
    said = _how_they_ended(summary, counts)
    report = Report(
        title=f"Simulation of {Path(options.people).name}",
        facts=list(_heading(options, recording, crossings, law)),
        said=said,
        good=not counts["any"],
        sections=[Section("Runs", [_run_table(crossings, summary), totals])],
        warnings=found,
        values=_values(recording, crossings, law, summary, met),
        source=options.people,
    )
    print(f"{terminal.told(report)}\n\n{totals}")
    written: list[Path] = []
    if options.out is not None or options.animate is not None or options.mcap is not None:
        index = int(np.argmax(summary.entered_active)) if shown is None else shown
        trajectory = nav.simulate(crossings[index].scenario, law, **stepping)
        if options.out is not None:
            place = output.folder(options.out)
            tables = list(_tables(crossings, summary, met, place))
            plays = [output.player(trajectory)]
            written += output.write_report(report, place, _draw(summary, trajectory), tables, plays=plays)
        written += output.mcap(trajectory, options)
        if options.animate is not None:
            print(f"\nanimated run  {index}")
            written.append(output.animation(trajectory, options.animate))
    output.say_written(written, report, options)
    verdict.end(said, counts, found, options, len(summary))


def _doubts(
    recording: datasets.Recording,
    crossings: Sequence[scenarios.Crossing],
    summary: RunTable,
    runs: Sequence[nav.Trajectory],
) -> tuple[ResultWarning, ...]:
    """Return the doubts about a recording, and the first of each kind about the runs with the number of the others."""
    own = dict.fromkeys(recording.warnings)
    of_runs = [
        (
            f"run {row}",
            [
                *(each for each in run.warnings if each not in own),
                *recording.lost_near(run, start_time=crossing.start_time, person_radius=PERSON_RADIUS),
            ],
        )
        for row, (crossing, run) in enumerate(zip(crossings, runs, strict=True))
    ]
    told = (*own, *gathered(of_runs, "runs"))
    codes = {each.code for each in told}
    return in_words((*told, *(each for each in summary.warnings if each.code not in codes)))


def _how_they_ended(summary: RunTable, counts: verdict.Counts) -> str:
    """Return in one sentence what came of all runs."""
    arrived = len(summary) - counts["any"]
    return (
        f"{arrived} of {some(len(summary), 'run')} arrived without a contact, {counts['contact']} had one "
        f"({counts['moving_contact']} with the robot moving, {int((summary.contacts_toward > 0).sum())} toward "
        f"somebody), {counts['timed_out']} timed out, "
        f"{counts['stopped']} stopped"
    )


def _encounters(crossings: Sequence[scenarios.Crossing], summary: RunTable) -> _Encounters:
    """Return the least distances of everybody who was in view during the run."""
    rows, people, distances = [], [], []
    for row, crossing in enumerate(crossings):
        least = summary.min_distance[row, : len(crossing.people)]
        seen = np.isfinite(least)
        rows.append(np.full(int(seen.sum()), row))
        people.append(np.array(crossing.people)[seen])
        distances.append(least[seen])
    return _Encounters(
        run=np.concatenate(rows),
        person=np.concatenate(people),
        distance=np.concatenate(distances),
        contact=crossings[0].scenario.robot.radius + PERSON_RADIUS,
        critical=CRITICAL_RADIUS,
        active=ACTIVE_RADIUS,
    )


def _heading(
    options: argparse.Namespace,
    recording: datasets.Recording,
    crossings: Sequence[scenarios.Crossing],
    law: nav.Law,
) -> Iterator[tuple[str, str]]:
    flow, scenario = recording.main_flow(), crossings[0].scenario
    way = [f"({x:.2f}, {y:.2f})" for x, y in (scenario.start, scenario.goal)]
    single = len(recording.momentary(float(recording.time_s[0]), duration=max(recording.duration, 1.0) + 1.0))
    left_out = f", {single} of them at one instant only and left out" if single else ""
    center = f"({flow.center[0]:.2f}, {flow.center[1]:.2f}) m"
    yield (
        "people",
        f"{options.people}: {some(len(recording.people()), 'person', 'people')} in {recording.duration:.1f} s"
        + left_out,
    )
    yield "flow", f"through {center} at {math.degrees(flow.angle):.0f} degrees, spread {flow.spread:.2f} m"
    yield "robot", f"from {way[0]} to {way[1]} m, {math.dist(scenario.start, scenario.goal):.2f} m across the flow"
    yield "law", output.law_words(law)
    yield "stepping", output.stepping_words(options, scenario.control_period)


RUN_HEADER = (
    ("run", "start", "people", "entered", "outcome", "arrival", "least", *("contacts",) * 5),
    ("", "time", "seen", "active region", "", "time", "clearance", "toward", "away", "standing", "at fault", "apart"),
    ("", "s", "", "", "", "s", "m", *("",) * 5),
)


def _run_table(crossings: Sequence[scenarios.Crossing], summary: RunTable) -> ReportTable:
    rows = [
        (
            row,
            f"{crossing.start_time:.1f}",
            int(np.isfinite(summary.min_distance[row]).sum()),
            summary.entered_active[row],
            summary.outcome[row],
            decimal(float(summary.arrival_time[row])),
            decimal(float(summary.min_clearance[row])),
            summary.contacts_toward[row],
            summary.contacts_away[row],
            summary.contacts_standing[row],
            summary.contacts_at_fault[row],
            summary.contacts_apart[row],
        )
        for row, crossing in enumerate(crossings)
    ]
    return ReportTable(headers=RUN_HEADER, rows=rows, left=(4,), printed=True)


def _totals(summary: RunTable, met: _Encounters) -> Iterator[str]:
    arrived = np.isfinite(summary.arrival_time)
    touched = summary.outcome == "collided"
    while_moving = touched & (summary.contacts_moving > 0)
    entered = summary.entered_active
    near = np.sort(met.distance[met.distance < met.active])
    yield f"runs       {len(summary)}: {int(arrived.sum())} reached the goal"
    for word, meaning in OUTCOMES.items():
        if word != "diverged":  # as worlds do only
            yield f"  {word:<10} {int((summary.outcome == word).sum()):4d}  {meaning}"
    yield (
        f"  of those that collided, {int((touched & arrived).sum())} reached the goal; at a contact the robot moved "
        f"in {int(while_moving.sum())} and only stood in {int((touched & ~while_moving).sum())}"
    )
    yield (
        f"contacts   {int(summary.contacts_moving.sum())} with the robot moving: toward "
        f"{int(summary.contacts_toward.sum())}, away from {int(summary.contacts_away.sum())}; "
        f"{int(summary.contacts_at_fault.sum())} at fault"
    )
    yield f"           {int(summary.contacts_standing.sum())} with the robot standing (a person walked into it)"
    if summary.contacts_apart.any():
        yield f"           {int(summary.contacts_apart.sum())} people appeared where the robot was, counted apart"
    yield (
        f"people     {len(met.distance)} seen in all runs, {int(entered.sum())} entered the active region: per run "
        f"{int(entered.min())} to {int(entered.max())}, median {np.median(entered):g}, "
        f"{MANY} or more in {int((entered >= MANY).sum())} runs"
    )
    if len(near):
        quantiles = np.quantile(near, (0.0, 0.05, 0.25, 0.5))
        words = ", ".join(
            f"{name} {value:.2f}" for name, value in zip(("least", "5 %", "25 %", "median"), quantiles, strict=True)
        )
        yield f"distance   center to center in m, of the {len(near)} below {met.active:g} m: {words}"
        yield (
            f"           {int((met.distance <= met.contact).sum())} at most {met.contact:g} m (contact), "
            f"{int((met.distance <= met.critical).sum())} at most {met.critical:g} m (critical region)"
        )


PERSON_COLUMNS = ("run", "start_time_s", "ped_id", "min_distance_m", "min_clearance_m")
RUN_COLUMNS = {
    "outcome": "outcome",
    "end_time": "end_time_s",
    "arrival_time": "arrival_time_s",
    "min_clearance": "min_clearance_m",
    "entered_active": "entered_active",
    "contacts_moving": "contacts_moving",
    "contacts_toward": "contacts_toward",
    "contacts_away": "contacts_away",
    "contacts_standing": "contacts_standing",
    "contacts_at_fault": "contacts_at_fault",
    "contacts_apart": "contacts_apart",
    "path_length": "path_length_m",
    "energy": "energy_J",
}


def _run_records(crossings: Sequence[scenarios.Crossing], summary: RunTable) -> list[dict[str, Any]]:
    """Return one record for each run, with units in the keys."""
    records = []
    for row, crossing in enumerate(crossings):
        record: dict[str, Any] = {
            "run": row,
            "start_time_s": crossing.start_time,
            "planned_time_s": crossing.planned_time,
            "traffic": crossing.traffic,
            "people_seen": int(np.isfinite(summary.min_distance[row]).sum()),
        }
        record |= {name: getattr(summary, key)[row].item() for key, name in RUN_COLUMNS.items()}
        records.append(record)
    return records


def _person_records(crossings: Sequence[scenarios.Crossing], met: _Encounters) -> list[dict[str, Any]]:
    """Return one record for each person in each run."""
    rows = zip(met.run.tolist(), met.person.tolist(), met.distance.tolist(), strict=True)
    values = ((run, crossings[run].start_time, person, away, away - met.contact) for run, person, away in rows)
    return [dict(zip(PERSON_COLUMNS, row, strict=True)) for row in values]


def _law(law: nav.Law) -> dict[str, Any]:
    """Return name and numbers of a law; of the virtual force field also its stabilizing force."""
    numbers = dict(zip(law.GAIN_NAMES, law.gains, strict=True))
    if isinstance(law, nav.VirtualForceField):
        return {"stabilizing": law.stabilizing, **numbers}
    return {"type": name_of(law), **numbers}


def _values(
    recording: datasets.Recording,
    crossings: Sequence[scenarios.Crossing],
    law: nav.Law,
    summary: RunTable,
    met: _Encounters,
) -> dict[str, Any]:
    flow, scenario = recording.main_flow(), crossings[0].scenario
    words, counts = np.unique(summary.outcome, return_counts=True)
    records = _run_records(crossings, summary)
    return {
        "flow": {
            "center_m": flow.center,
            "direction": flow.direction,
            "angle_rad": flow.angle,
            "spread_m": flow.spread,
        },
        "robot": {"start_m": scenario.start, "goal_m": scenario.goal, "radius_m": scenario.robot.radius},
        "law": _law(law),
        "outcomes": dict(zip(words.tolist(), counts.tolist(), strict=True)),
        **{name: int(getattr(summary, name).sum()) for name in RUN_COLUMNS if name.startswith("contacts_")},
        "runs": records,
        "people": _person_records(crossings, met),
    }


def _tables(
    crossings: Sequence[scenarios.Crossing], summary: RunTable, met: _Encounters, place: Path
) -> Iterator[Path]:
    """Write what came of each run and of each person."""
    runs, people = _run_records(crossings, summary), _person_records(crossings, met)
    yield output.write_csv(place / "runs.csv", list(runs[0]), (list(record.values()) for record in runs))
    yield output.write_csv(place / "people.csv", PERSON_COLUMNS, (list(record.values()) for record in people))


def _draw(summary: RunTable, trajectory: nav.Trajectory) -> Iterator[tuple[str, Figure, str]]:
    """Yield the pictures of one run and of all, each with its caption."""
    from hrsafety import plotting

    yield "paths", plotting.paths([trajectory], regions=False), "Path of the robot across the people, in one run."
    yield "time_sequence", plotting.time_sequence(trajectory), "Instants of the same run."
    yield "outcomes", plotting.outcomes({"all runs": summary}), "How the runs ended."
    if np.isfinite(summary.min_clearance).any():
        yield "clearances", plotting.clearances({"all runs": summary}), "Least clearance of the runs."
