"""Print the tables of the stabilizing modes, or write them into the page on validation.

``python docs/measure_stabilizing.py`` prints, ``--write`` replaces what stands between the marks of
docs/validation.md. ``--only modes`` makes the tables of the reproduction, ``--only sensing`` those of
contacts with exact, noisy and late sensing.
"""

from __future__ import annotations

import functools
import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.reproduce import records, study
from hrsafety.reproduce.measured import GAIN_SETS
from measure_shares import SENSINGS, sized_for_sensing
from page_tables import DOCS, head, line, print_or_write, shares

PAGE = DOCS / "validation.md"
MARKS = "tables of measure_stabilizing.py"
SENSING_MARKS = "sensing of measure_stabilizing.py"
MODES = ("off", "capped, 10 N", "capped, 0.1 m|V|/T_s", "full")
GAINS = {"new_vff": "New", "new_vff_optimised": "New*"}
SIDE = "decided afresh"
# Whose positions are measured: where nothing moves, only those of the robot can be wrong.
MEASURED = {
    "people": ("obstacles", ("c2", "c4", "crowds of 3", "crowds of 12")),
    "people and robot": ("both", ("c1", "c2", "c3", "c4", "crowds of 3", "crowds of 12")),
}
NOISE_SEEDS, CROWD_SEEDS = range(200), range(500)
EXPERIMENTS = [(body, name) for body, (_, names) in MEASURED.items() for name in names]

Row = dict[str, Any]


def aggregates() -> tuple[list[Row], list[Row]]:
    """Return the rows of single runs and those of many runs."""
    found = json.loads(records.study_json(study.compare()))["aggregates"]
    rows = [row for row in found if row["side"] == SIDE]
    return [row for row in rows if row["runs"] == 1], [row for row in rows if row["runs"] > 1]


def table(rows: list[Row], cell: Callable[[Row], str]) -> list[str]:
    """Return a table with a row for each experiment and gain set and a column for each mode."""
    names = [mode.replace("|", "\\|") for mode in MODES]
    lines = [f"| | {' | '.join(names)} |", "|---|" + "---|" * len(MODES)]
    for experiment in dict.fromkeys(row["experiment"] for row in rows):
        for gains, name in GAINS.items():
            own = {row["mode"]: row for row in rows if row["experiment"] == experiment and row["gains"] == gains}
            runs = own["off"]["runs"]
            label = experiment.replace("+-", "±") + (f" ({runs} runs)" if runs > 1 else "")
            lines.append(f"| {label}, {name} | {' | '.join(cell(own[mode]) for mode in MODES)} |")
    return [*lines, ""]


def decimal(value: float | None, digits: int) -> str:
    """Return a number, or a dash where there is none."""
    return "-" if value is None else f"{value:.{digits}f}"


def distances(row: Row) -> str:
    """Return arrival time and least distances of a single run."""
    least = row["min_distances_m"].split()
    return f"{decimal(row['median_arrival_time_s'], 2)}; {', '.join(least)}"


def contacts(row: Row) -> str:
    """Return the runs with a contact, robot moving and standing, and the runs that arrived."""
    return f"{row['contacts_moving']} + {row['contacts_standing']}; {row['arrivals']}"


def scores(row: Row) -> str:
    """Return time, H and the share of control periods in which V does not grow."""
    time, total, share = row["median_arrival_time_s"], row["mean_score"], row["descent_share"]
    return f"{decimal(time, 2)}; {decimal(total, 3)}; {decimal(share, 2)}"


def page() -> str:
    """Return the tables."""
    single, many = aggregates()
    parts = [
        ("Single runs: arrival time (s); least distance d to each obstacle (m).", single, distances),
        ("Single runs: arrival time (s); H; share of control periods in which V does not grow.", single, scores),
        ("Many runs: runs with a contact, robot moving + standing; runs that reached the goal.", many, contacts),
        ("Many runs: median arrival time (s); mean H; mean share as above.", many, scores),
    ]
    lines = [line for words, rows, cell in parts for line in (words, "", *table(rows, cell))]
    return "\n" + "\n".join(lines) + "\n"


# ---- contacts with exact, noisy and late sensing -------------------------------------------------


@functools.lru_cache(maxsize=2)
def exact_scenes(name: str) -> tuple[nav.Scenario, ...]:
    """Return the scenarios of an experiment as they are without noise."""
    if name.startswith("crowds"):
        return tuple(scenarios.random_crowd(int(name.split()[-1]), seed=seed) for seed in CROWD_SEEDS)
    return (scenarios.configuration(name),)


def sensed_scenes(name: str, body: str, sensing: str, sized: bool) -> list[nav.Scenario]:
    """Return the scenarios of an experiment with one sensing, with regions of the source or sized for it."""
    measurement = SENSINGS[sensing]
    if measurement is not None:
        measurement = replace(measurement, of=MEASURED[body][0])
    scenes = [replace(scene, measurement=measurement) for scene in exact_scenes(name)]
    if sized:
        scenes = [sized_for_sensing(scene) for scene in scenes]
    if len(scenes) == 1 and measurement is not None:
        return [replace(scenes[0], seed=seed) for seed in NOISE_SEEDS]
    return scenes


def contact_cells(name: str, body: str, sensing: str, sized: bool) -> dict[tuple[str, str], str]:
    """Return the shares of contacts by gain set and mode; without noise a configuration is a single run."""
    scenes = sensed_scenes(name, body, sensing, sized)
    cells = {}
    for mode, options in study.MODES.items():
        law = nav.VirtualForceField(**options)
        for gains, values in GAIN_SETS.items():
            table = nav.simulate_batch(scenes, law, np.array([values]))
            cells[gains, mode] = shares(table) if len(scenes) > 1 else single(table)
    return cells


def single(table: nav.RunTable) -> str:
    """Return what a single run touched."""
    if table.contacts_toward[0]:
        return "contact, moving toward it"
    if table.contacts_moving[0]:
        return "contact, moving away"
    return "contact, standing" if table.contacts_standing[0] else "none"


def sensing_table(sized: bool) -> Iterator[str]:
    """Yield a row for each experiment, gain set and mode, and a column for each sensing."""
    yield from head("", "runs", *SENSINGS)
    for body, name in EXPERIMENTS:
        columns = [contact_cells(name, body, sensing, sized) for sensing in SENSINGS]
        runs = len(sensed_scenes(name, body, "25 mm noise", sized))
        for gains, label in GAINS.items():
            for mode in study.MODES:
                title = f"{name}, {body} measured, {label}, {mode}".replace("|", "\\|")
                yield line(title, runs, *(column[gains, mode] for column in columns))
    yield ""


def sensing_page() -> str:
    """Return the tables of contacts with each sensing."""
    words = {
        False: "Regions of the source, for people of 1.0 m/s and exact sensing.",
        True: "Regions sized for the speed of each person and the sensing of each column: larger by what both add.",
    }
    lines = [entry for sized in words for entry in (words[sized], "", *sensing_table(sized))]
    return "\n" + "\n".join(lines) + "\n"


if __name__ == "__main__":
    print_or_write(PAGE, {"modes": (MARKS, page), "sensing": (SENSING_MARKS, sensing_page)})
