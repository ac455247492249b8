"""Print the tables of the stabilizing modes, or write them into the page on validation.

``python docs/measure_stabilizing.py`` prints, ``--write`` replaces what stands between the two
marks of docs/validation.md.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hrsafety import reproduce

PAGE = Path(__file__).resolve().parent / "validation.md"
MARKS = ("<!-- tables of measure_stabilizing.py begin -->\n", "<!-- tables of measure_stabilizing.py end -->\n")
MODES = ("off", "capped, 10 N", "capped, 0.1 m|V|/T_s", "full")
GAINS = {"new_vff": "New", "new_vff_optimised": "New*"}
SIDE = "decided afresh"

Row = dict[str, Any]


def aggregates() -> tuple[list[Row], list[Row]]:
    """Return the rows of single runs and those of many runs."""
    with tempfile.TemporaryDirectory() as folder:
        reproduce.run(folder, only="stabilizing")
        found = json.loads((Path(folder) / "stabilizing.json").read_text(encoding="utf-8"))["aggregates"]
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


def written(text: str) -> str:
    """Return the tables that the page holds."""
    return text.split(MARKS[0])[1].split(MARKS[1])[0]


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--write"]):
        sys.exit("usage: python docs/measure_stabilizing.py [--write]")
    if sys.argv[1:]:
        before, _, rest = PAGE.read_text(encoding="utf-8").partition(MARKS[0])
        PAGE.write_text(before + MARKS[0] + page() + MARKS[1] + rest.partition(MARKS[1])[2], encoding="utf-8")
    else:
        print(page())
