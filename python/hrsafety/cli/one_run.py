"""``hrsafety simulate SCENARIO.toml``: one run, printed, and written if asked for."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.cli import output, terminal, verdict
from hrsafety.cli.output import decimal
from hrsafety.navigation.endings import robot_then
from hrsafety.navigation.outcomes import OUTCOMES
from hrsafety.pages.report import Report, ReportTable, Section

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["simulate_file"]


def simulate_file(options: argparse.Namespace) -> None:
    """Run a scenario file and report.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety simulate``.
    """
    verdict.failures_of(options.fail_on)  # a wrong word is told before the run
    output.check_targets(options)
    with output.located(options.scenario):
        described = scenarios.load(options.scenario)
    scenario, law = described.scenario, output.with_options(described.law, options)
    score = nav.evaluate(scenario, law, integrator=options.integrator, step=options.step, hold=options.hold)
    run = score.trajectory
    found, said = output.warnings_of(scenario, run), run.ending
    report = Report(
        title=f"Simulation of {Path(options.scenario).name}",
        facts=[
            ("scenario", options.scenario),
            ("law", output.law_words(law)),
            ("stepping", output.stepping_words(options, scenario.control_period)),
            *_summary(score),
        ],
        said=said,
        good=run.outcome == "arrived",
        sections=[Section("Obstacles", [_obstacle_table(run)])] if scenario.obstacles else [],
        warnings=found,
        source=options.scenario,
    )
    print(terminal.told(report))
    written: list[Path] = []
    if options.out is not None:
        place = output.folder(options.out)
        tables = [run.to_csv(place / "trajectory.csv")]
        written = output.write_report(report, place, _draw(run), tables, plays=[output.player(run)])
    written += output.mcap(run, options)
    if options.animate is not None:
        written.append(output.animation(run, options.animate))
    output.say_written(written, report, options)
    verdict.end(said, verdict.counted(run), found, options, 1)


def _summary(score: nav.Performance) -> Iterator[tuple[str, str]]:
    run = score.trajectory
    arrival = f"{run.arrival_time:.2f} s" if run.arrival_time == run.arrival_time else "-"
    parts = f"time H_T {score.arrival_time:.3f}, H_D {score.avoidance:.3f}, H_E {score.energy_saving:.3f}"
    yield "outcome", OUTCOMES[run.outcome]
    yield "arrival time", arrival
    yield "simulated", f"{run.time[-1]:.2f} s"
    yield "path length", f"{run.path_length:.2f} m"
    yield "energy", f"{run.energy:.2f} J"
    yield "performance H", f"{score.total:.3f}  ({parts})"


def _obstacle_table(run: nav.Trajectory) -> ReportTable:
    of_contact = ("first contact", "robot speed then", "robot moved")
    names = ("obstacle", "kind", "r_3", "r_2", "least distance", "least clearance", *of_contact)
    units = ("", "", "m", "m", "m", "m", "s", "m/s", "")
    rows = [
        (
            index,
            type(obstacle).__name__,
            decimal(obstacle.critical_radius, 3),
            decimal(obstacle.active_radius, 3),
            decimal(float(run.min_distance[index]), 3),
            decimal(float(run.min_clearance[index]), 3),
            decimal(float(run.contact_time[index])),
            decimal(float(run.contact_speed[index])),
            robot_then(run, index),
        )
        for index, obstacle in enumerate(run.scenario.obstacles)
    ]
    return ReportTable(headers=(names, units), rows=rows, left=(1,), printed=True)


def _draw(run: nav.Trajectory) -> Iterator[tuple[str, Figure, str]]:
    from hrsafety import plotting

    yield "paths", plotting.paths([run]), "Path of the robot and of everything that moves."
    yield "time_sequence", plotting.time_sequence(run), "The scene at instants of the run."
    yield "distances", plotting.distances([run]), "Distance to the goal and to the obstacles over time."
    yield "energy", plotting.energy([run]), "Wheel currents and accumulated loss over time."
