"""Print how laws and filters stand in the standard scenes, or write it into the guide of the arena.

``python docs/measure_arena.py`` prints, ``--write`` replaces what stands between the marks of docs/guides/arena.md.
Finished tasks are kept in the folder of ``HRSAFETY_ARENA``, if there is one, and the next call resumes there.
``--speed`` prints instead how long nine entries take in 25 scenes with 100 seeds and three sensings on two cores.
"""

from __future__ import annotations

import functools
import multiprocessing
import os
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor

from hrsafety import arena
from hrsafety.cli.arena import HEAD, cells_of
from hrsafety.cli.parsers import ARENA_LAWS
from page_tables import DOCS, head, line, print_or_write

SEEDS = 20
CONDITIONS = (("reacting", "exact"), ("not_reacting", "exact"), ("not_reacting", "noise_delay"))

CHOSEN = (
    *("orca(horizon=2,margin=0.05)+barrier", "straight+barrier", "orca(horizon=2,margin=0.05)+shield+yielding"),
    *("orca(horizon=2,margin=0.05)", "dynamic_window", "straight"),
)


@functools.cache
def board(people: str, sensing: str) -> arena.Leaderboard:
    """Return the episodes under conditions."""
    out = os.environ.get("HRSAFETY_ARENA")
    return arena.run(ARENA_LAWS, seeds=SEEDS, people=[people], sensing=[sensing], out=out)


def standings() -> str:
    """Return a table for each of the conditions."""
    parts = []
    for people, sensing in CONDITIONS:
        rows = head(f"{people.replace('_', ' ')}, {sensing.replace('_', ' and ')}", *HEAD)
        for each in board(people, sensing).standings():
            entry, *cells = cells_of(each)
            rows.append(line(f"`{entry}`", *cells))
        parts.append("\n".join(rows))
    return "\n" + "\n\n".join(parts) + "\n\n"


def chosen() -> str:
    """Return a few entries among people who do not react and are measured with noise and delay."""
    names = ("success %", "by the robot %", "time ratio")
    rows = head("entry", *names)
    for each in board("not_reacting", "noise_delay").standings():
        entry, *cells = cells_of(each)
        found = dict(zip(HEAD, cells, strict=True))
        if entry in CHOSEN:
            rows.append(line(f"`{entry}`", *(found[name] for name in names)))
    return "\n" + "\n".join(rows) + "\n\n"


def fails() -> str:
    """Return the share of successes by scene, of people who do not react and are known exactly."""
    found = board("not_reacting", "exact")
    cells = list(found.episodes)
    rows = head("scene, success %", *(f"`{cell.entry}`" for cell in cells))
    scores = [found.scores(cell) for cell in cells]
    for name in found.scenes:
        rows.append(line(f"`{name}`", *(f"{100 * score[name].value:.0f}" for score in scores)))
    return "\n" + "\n".join(rows) + "\n\n"


def speed(seeds: int = 100) -> str:
    """Return how many episodes were run in two processes, and how long they took."""
    context = multiprocessing.get_context("spawn")
    with tempfile.TemporaryDirectory() as folder, ProcessPoolExecutor(2, mp_context=context) as pool:
        begun = time.perf_counter()
        sensing = ("exact", "noise", "noise_delay")
        found = arena.run(
            ARENA_LAWS[:9], seeds=seeds, people=["not_reacting"], sensing=sensing, out=folder, executor=pool
        )
        taken = time.perf_counter() - begun
    episodes = sum(each["end"].size for each in found.episodes.values())
    return f"{episodes:,} episodes in {taken:.0f} s, {episodes / taken:.0f} per second"


if __name__ == "__main__":
    if "--speed" in sys.argv:
        print(speed())
        sys.exit()
    print_or_write(
        DOCS / "guides" / "arena.md",
        {
            "chosen": ("first rows of measure_arena.py", chosen),
            "standings": ("standings of measure_arena.py", standings),
            "fails": ("failures of measure_arena.py", fails),
        },
    )
