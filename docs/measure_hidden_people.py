"""Print encounters with people who were hidden, or write them into the guide.

``python docs/measure_hidden_people.py --places 30`` prints a table, ``--write`` replaces what stands between the marks
of docs/guides/people_behind_corners.md; ``--only first`` are the first rows of the page, which are some of its table.
Encounters are kept in the folder ``HRSAFETY_ROWS`` where that is set, place by place, and the run resumes there;
``--kept`` counts those alone.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np

from hrsafety.benchmarks.hidden import LIMIT, SUITE_LAWS, WALKING, encounters, hidden_entry
from page_tables import DOCS, head, line, percent, print_or_write, selected, written

PAGE = DOCS / "guides" / "people_behind_corners.md"
FIRST_MARKS, TABLE_MARKS = "first rows of measure_hidden_people.py", "hidden people"
MOST = 60
"""Encounters in a place: one every half second, at most."""


def place(word: str, number: int, *, only_kept: bool) -> dict[str, Any] | None:
    """Return the encounters in a place, kept ones where there are some."""
    folder = os.environ.get("HRSAFETY_ROWS")
    kept = None if folder is None else Path(folder) / f"{word}-{number}.json"
    if kept is not None and kept.exists():
        found: dict[str, Any] = json.loads(kept.read_text(encoding="utf-8"))
        return found
    if only_kept:
        return None
    columns, alone = encounters(hidden_entry(word), number, person_speed=WALKING, most=MOST)
    faulty = columns["margin"] < 0.0
    found = {
        "count": len(faulty),
        "fault": int(faulty.sum()),
        "fastest": float(columns["fault_speed"][faulty].max(initial=0.0)),
        "moving": int((columns["contacts_toward"] + columns["contacts_away"] > 0).sum()),
        "overlooked": int((columns["overlooked"] > 0).sum()),
        "time": LIMIT if math.isnan(alone) else alone,
    }
    if kept is not None:
        kept.write_text(json.dumps(found), encoding="utf-8")
    print(word, number, found, file=sys.stderr, flush=True)
    return found


def table(places: int, words: list[str], *, only_kept: bool) -> str:
    """Return the table."""
    lines = head(
        "place and shield",
        "places",
        "encounters",
        "at fault %",
        "fastest at fault, m/s",
        "touched while moving",
        "neither seen nor reckoned with",
        "time with nobody there: median, worst s",
        "not in 60 s",
    )
    for word in words:
        made = (place(word, number, only_kept=only_kept) for number in range(places))
        found = [each for each in made if each is not None]
        if not found:
            continue
        total = {name: sum(each[name] for each in found) for name in ("count", "fault", "moving", "overlooked")}
        times = [each["time"] for each in found]
        lines.append(
            line(
                f"`{word}`",
                len(found),
                total["count"],
                percent(total["fault"], total["count"], 2),
                f"{max(each['fastest'] for each in found):.2f}" if total["fault"] else "-",
                total["moving"],
                total["overlooked"],
                f"{np.median(times):.1f}, {max(times):.1f}",
                sum(time >= LIMIT for time in times),
            )
        )
    return "\n".join(lines) + "\n"


def first() -> str:
    """Return the rows of robots that do not creep, with and without unseen people, from the table of the page."""
    table = written(PAGE.read_text(encoding="utf-8"), TABLE_MARKS)
    columns = ("place and shield", "encounters", "at fault %", "time with nobody there: median, worst s")
    return selected(
        table, lambda row: not {"creep", "cell"} & set(re.findall(r"\w+", row["place and shield"])), columns
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--places", type=int, default=10, help="places of each kind")
    parser.add_argument("--laws", nargs="*", default=list(SUITE_LAWS))
    parser.add_argument("--kept", action="store_true", help="no new encounters")
    given, sys.argv[1:] = parser.parse_known_args()
    made = {
        "encounters": (TABLE_MARKS, lambda: table(given.places, given.laws, only_kept=given.kept)),
        "first": (FIRST_MARKS, first),
    }
    print_or_write(PAGE, made)
