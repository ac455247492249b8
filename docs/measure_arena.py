"""Print how laws and filters stand in the standard scenes, or write it into the guide of the arena.

``python docs/measure_arena.py`` prints, ``--write`` replaces what stands between the marks of docs/guides/arena.md.
Finished tasks are kept in the folder of ``HRSAFETY_ARENA``, if there is one, and the next call resumes there.
"""

from __future__ import annotations

import functools
import os

from hrsafety import arena
from hrsafety._statistics import Share
from hrsafety.cli.parsers import ARENA_LAWS
from page_tables import DOCS, head, line, print_or_write

SEEDS = 10
CONDITIONS = (("reacting", "exact"), ("not_reacting", "exact"), ("not_reacting", "noise_delay"))


@functools.cache
def board(people: str, sensing: str) -> arena.Leaderboard:
    """Return the episodes under conditions."""
    out = os.environ.get("HRSAFETY_ARENA")
    return arena.run(ARENA_LAWS, seeds=SEEDS, people=[people], sensing=[sensing], out=out)


def percent(share: Share) -> str:
    """Return a share with its interval."""
    return f"{100 * share.value:.1f} ({100 * share.low:.1f} to {100 * share.high:.1f})"


def standings() -> str:
    """Return a table for each of the conditions."""
    parts = []
    for people, sensing in CONDITIONS:
        rows = head(
            f"{people.replace('_', ' ')}, {sensing.replace('_', ' and ')}",
            "success %",
            "by the robot %",
            "wall %",
            "by a person %",
            "late %",
            "time ratio",
            "p",
            "rank",
            "front %",
        )
        for each in board(people, sensing).standings():
            shares = map(percent, (each.success, each.by_robot, each.wall, each.by_person, each.late))
            ratio = f"{each.time_ratio.value:.2f} ({each.time_ratio.low:.2f} to {each.time_ratio.high:.2f})"
            rank = f"{each.rank:g} ({each.rank_low:g} to {each.rank_high:g})"
            front = f"{100 * each.front:.0f}"
            rows.append(line(f"`{each.cell.entry}`", *shares, ratio, f"{each.p_value:.2g}", rank, front))
        parts.append("\n".join(rows))
    return "\n" + "\n\n".join(parts) + "\n\n"


def fails() -> str:
    """Return the share of successes by scene, of people who do not react and are known exactly."""
    found = board("not_reacting", "exact")
    cells = list(found.episodes)
    rows = head("scene, success %", *(f"`{cell.entry}`" for cell in cells))
    scores = [found.scores(cell) for cell in cells]
    for name in found.scenes:
        rows.append(line(f"`{name}`", *(f"{100 * score[name].value:.0f}" for score in scores)))
    return "\n" + "\n".join(rows) + "\n\n"


if __name__ == "__main__":
    print_or_write(
        DOCS / "guides" / "arena.md",
        {"standings": ("standings of measure_arena.py", standings), "fails": ("failures of measure_arena.py", fails)},
    )
