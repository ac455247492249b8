"""Print where the entries of the arena fail, or write it into the page about failures.

``python docs/measure_failures.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/where_laws_fail.md; ``--only persons`` and ``--only chosen`` are the person who seeks contact, whose
finished rows are kept in the folder of ``HRSAFETY_ROWS``, if there is one, ``--only scenes`` the standard scenes, whose
episodes are those of measure_arena.py, kept in that of ``HRSAFETY_ARENA``.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator

import numpy as np

from hrsafety import arena
from hrsafety.arena.episodes import ENDS
from hrsafety.benchmarks import entry
from hrsafety.cli.parsers import ARENA_LAWS
from measure_arena import CONDITIONS, board
from page_tables import DOCS, LATENCY, head, line, percent, print_or_write
from searched_person import FASTEST, HOLONOMIC, OFF, heading, row

CHOSEN = (
    *("straight", "velocity_obstacle", "orca(horizon=2,margin=0.05)", "field", "straight+barrier"),
    "orca(horizon=2,margin=0.05)+shield+yielding",
)
COLUMNS = (0, 2, 4, 5, 6)
"""Entries and columns of the searched person that stand first."""
WORST = 3
"""Scenes of each entry that are shown."""
HOW = {
    "by_robot": "moves into somebody",
    "by_person": "is walked into",
    "wall": "touches a wall",
    "late": "is late",
    "lost": "is lost",
}


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


def scenes() -> str:
    """Return the scenes in which each entry fails most, by condition."""
    people, sensing = CONDITIONS[-1]
    found = board(people, sensing)
    rows = head("entry", "scene", "success %", "otherwise, %")
    for cell in found.episodes:
        rows += (line(f"`{cell.entry}`", *cells) for cells in worst(found, cell))
    return "\n".join(rows) + "\n"


def worst(found: arena.Leaderboard, cell: arena.ArenaCell) -> Iterator[tuple[str, str, str]]:
    """Yield the scenes in which an entry fails most, its successes there, and how its other episodes end."""
    ends = found.episodes[cell]["end"]
    won = (ends == "success").sum(axis=1)
    for place in np.argsort(won, kind="stable")[:WORST]:
        counts = {end: int((ends[place] == end).sum()) for end in ENDS[1:]}
        often = sorted((end for end in counts if counts[end]), key=lambda end: -counts[end])
        words = (f"{HOW[end]} {100 * counts[end] / found.seeds:.0f}" for end in often)
        yield f"`{found.scenes[place]}`", percent(int(won[place]), found.seeds), ", ".join(words)


if __name__ == "__main__":
    print_or_write(
        DOCS / "guides" / "where_laws_fail.md",
        {
            "chosen": ("first rows of measure_failures.py", chosen),
            "persons": ("persons of measure_failures.py", persons),
            "scenes": ("scenes of measure_failures.py", scenes),
        },
    )
