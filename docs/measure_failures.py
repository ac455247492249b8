"""Print what a person who seeks contact makes of the entries of the arena, or write it into the page about failures.

``python docs/measure_failures.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/where_laws_fail.md. Finished rows are kept in the folder of ``HRSAFETY_ROWS``, if there is one; all of it
takes four minutes of one core.
"""

from __future__ import annotations

import functools

from hrsafety.benchmarks import entry
from hrsafety.cli.parsers import ARENA_LAWS
from page_tables import DOCS, LATENCY, head, line, print_or_write
from searched_person import FASTEST, HOLONOMIC, OFF, heading, row

CHOSEN = (
    *("straight", "velocity_obstacle", "orca(horizon=2,margin=0.05)", "field", "straight+barrier"),
    "orca(horizon=2,margin=0.05)+shield+yielding",
)
COLUMNS = (0, 2, 4, 5, 6)
"""Entries and columns of the searched person that stand first."""


@functools.cache
def against(word: str) -> str:
    """Return the row of an entry on open floor; its shield knows the largest speed of the searched person."""
    exact = entry(word).built(person_speed=FASTEST)
    late = entry(word).built(person_speed=FASTEST, latency=LATENCY, position_error=OFF)
    return row((f"`{word}`",), HOLONOMIC, late, exact)


def persons() -> str:
    """Return the table of the searched person."""
    return "\n".join([*heading("entry"), *map(against, ARENA_LAWS)]) + "\n"


def chosen() -> str:
    """Return a few columns of a few entries of it."""
    found = []
    for each in (*heading("entry")[:1], *map(against, CHOSEN)):
        cells = each.strip("| ").split(" | ")
        found.append([cells[at] for at in COLUMNS])
    return "\n".join([*head(*found[0]), *(line(*cells) for cells in found[1:])]) + "\n"


if __name__ == "__main__":
    print_or_write(
        DOCS / "guides" / "where_laws_fail.md",
        {
            "chosen": ("first rows of measure_failures.py", chosen),
            "persons": ("persons of measure_failures.py", persons),
        },
    )
