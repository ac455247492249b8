"""A person who seeks contact with a robot on open floor: what laws and filters let happen, as rows of a table."""

from __future__ import annotations

import functools
import json
import os
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from hrsafety import navigation as nav
from hrsafety.navigation.metrics import mean_interval
from page_tables import ERROR, LATE, LATENCY, head, line, percent

FASTEST, WIDTH, LIMIT = 1.6, 0.25, 12.0
"""Speed in m/s and radius in m of the person, and time limit in s."""
OFF = float(np.hypot(ERROR, ERROR))
"""How far a person can be from where he was when he was measured, in m."""
RANDOM, SHIELDED, EXACT = 4000, 20_000, 2000
"""Random persons against each robot, against one with a shield, and where people are known exactly."""
SEARCHES, EVALUATIONS = 10, 300
HOLONOMIC = nav.HolonomicRobot(radius=0.25, max_speed=1.0, max_acceleration=3.0)
WHEELS = nav.DifferentialDriveRobot(radius=0.25, max_speed=1.0)
Robot = nav.HolonomicRobot | nav.DifferentialDriveRobot
MEASURED = nav.Measurement(scale=ERROR, of="obstacles", latency=LATENCY)


def say(*words: object) -> None:
    """Tell what is under way."""
    print(time.strftime("%H:%M:%S"), *words, file=sys.stderr, flush=True)


def heading(*names: str) -> list[str]:
    """Return the first lines of the table, with columns before those of `cells`."""
    return head(
        *names,
        "random persons",
        f"at fault, {LATE}, %",
        f"at fault, exact, {EXACT}, %",
        f"CMA-ES, {SEARCHES} searches: at fault",
        f"arrives, {LATE}, %",
        f"time to the goal, s, {LIMIT:g} s where late",
    )


def row(names: tuple[str, ...], robot: Robot, late: nav.laws.Law, exact: nav.laws.Law) -> str:
    """Return the row of a law that knows how people are measured, and of that which knows them exactly.

    With a folder in ``HRSAFETY_ROWS`` finished rows are kept there.
    """
    folder = os.environ.get("HRSAFETY_ROWS")
    stem = "".join(each if each.isalnum() else "_" for each in "-".join(names))
    kept = None if folder is None else Path(folder) / f"{stem}.json"
    if kept is not None and kept.exists():
        return line(*names, *json.loads(kept.read_text(encoding="utf-8")))
    say(*names)
    found = list(cells(robot, late, exact, SHIELDED if "shield" in stem else RANDOM))
    if kept is not None:
        kept.write_text(json.dumps(found), encoding="utf-8")
    return line(*names, *found)


def cells(robot: Robot, late: nav.laws.Law, exact: nav.laws.Law, runs: int) -> Iterator[str]:
    """Yield what so many random persons, and searches, make of a robot."""
    scene = nav.Scenario(
        start=(0.0, 0.0), goal=(8.0, 0.0), robot=robot, control_period=0.1, time_limit=LIMIT, rest_time=LIMIT
    )
    measured = replace(scene, measurement=MEASURED)
    search = functools.partial(nav.falsify, person_radius=WIDTH, person_speed=FASTEST)
    found = search(measured, late, episodes=runs, seed=1)
    known = search(scene, exact, episodes=EXACT, seed=1)
    worst = [search(measured, late, method="cma_es", episodes=EVALUATIONS, seed=seed) for seed in range(SEARCHES)]
    yield str(runs)
    for each in (found, known):
        yield percent(int((each.contacts_toward > 0).sum()), each.episodes, 2)
    yield str(sum(int(each.worst.contacts_toward > 0) for each in worst))
    yield percent(int(np.isfinite(found.arrival_time).sum()), runs)
    spent = mean_interval(np.where(np.isnan(found.arrival_time), LIMIT, found.arrival_time))
    yield f"{spent.value:.2f} ({spent.low:.2f} to {spent.high:.2f})"
