"""Print what shield and yielding bring, or write it into the page on validation.

``python docs/measure_safe.py`` prints, ``--write`` replaces what stands between the marks of docs/validation.md;
``--only shares`` are the shares of the suites, ``--only adversary`` the search for a fault, ``--only poses`` the
arrivals of two wheels. The recordings are those of ``HRSAFETY_RECORDINGS``, a folder with zara01.csv and zara03.csv,
the worlds of BARN and DynaBARN those of ``HRSAFETY_BARN``, a folder that ``challenge_worlds.py`` fills.
"""

from __future__ import annotations

import math
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from hrsafety import navigation as nav
from hrsafety.benchmarks import Result, benchmark, entry
from hrsafety.benchmarks.suites import ERROR, LATENCY, PURSUED
from page_tables import DOCS, SENSING, head, line, percent, print_or_write

GUARDED = "field+shield+yielding"
SUITES = (
    ("S5", "s5", 1.0, None, ["field", GUARDED, "orca", "orca+shield+yielding"]),
    ("S5", "s5", 1.6, None, [GUARDED, "orca+shield+yielding"]),
    ("S4", "s4", 1.0, None, ["field", GUARDED]),
    ("crowd of 12", "crowd", 1.0, 0, ["field", GUARDED, "orca", "orca+shield", "orca+shield+yielding"]),
    ("crowd of 12", "crowd", 1.6, 0, [GUARDED]),
)
RANDOM, SEARCHES, EVALUATIONS = 20_000, 20, 300
PURSUED_LAWS = ("field+shield", "orca+shield", "velocity_obstacle+shield")
BARE = ("field", "orca", "velocity_obstacle")
BARE_RANDOM = 1000
POSES = 10_000
LEAST_X, LEAST_Y, MOST_X, MOST_Y = -3.0, -3.0, 6.0, 3.0
ROOM = [(LEAST_X, LEAST_Y), (MOST_X, LEAST_Y), (MOST_X, MOST_Y), (LEAST_X, MOST_Y), (LEAST_X, LEAST_Y)]
TRAP, SCREEN = [(1, 1.5), (3, 1.5), (3, -1.5), (1, -1.5)], [(4.5, 3), (4.5, 0.2)]
GOAL = (5.3, 2.0)


SPLIT = ("moving toward %", "moving away %", "at fault %")
"""Shares of episodes with a contact of a moving robot, by who came toward whom, and with one at fault."""


def say(*words: object) -> None:
    """Tell what is under way."""
    print(time.strftime("%H:%M:%S"), *words, file=sys.stderr, flush=True)


def rows_of(result: Result, where: str, speed: float, sensing: str = "exact") -> Iterator[str]:
    """Return the lines of a suite."""
    for name, rows in result.rows.items():
        counts = [sum(row.outcome == "arrived" for row in rows)]
        counts += [sum(getattr(row, name) > 0 for row in rows) for name in ("contacts", "toward", "away", "at_fault")]
        shown = "-" if "shield" not in name else f"{speed:.1f}"
        cells = [percent(count, len(rows)) for count in counts]
        yield line(where, name, shown, sensing, len(rows), *cells, f"{result.mean_arrival(name):.1f}")


def shares() -> str:
    """Return the table of the suites."""
    lines = head(
        "suite",
        "law",
        "v of shield, m/s",
        "people measured",
        "episodes",
        "success %",
        "contact %",
        *SPLIT,
        "arrival, s",
    )
    for where, suite, speed, seed, laws in SUITES:
        for sensing, measured in SENSING.items():
            say(where, speed, laws, sensing)
            result = benchmark(suite, laws, person_speed=speed, seed=seed, **measured)
            lines += rows_of(result, where, speed, sensing)
    worlds = os.environ.get("HRSAFETY_BARN")
    if worlds:
        say("BARN")
        lines += rows_of(benchmark("barn", data=worlds), "BARN", 1.6)
        for name, suite in (("DynaBARN", "dynabarn"), ("DynaBARN, robot of 3 m/s^2", "dynabarn3")):
            for seed, phases in ((None, ""), (1, ", other phases")):
                lines += rows_of(benchmark(suite, data=worlds, seed=seed), name + phases, 1.6)
    folder = os.environ.get("HRSAFETY_RECORDINGS")
    for name in ("zara01", "zara03") if folder else ():
        say(name)
        result = benchmark("recordings", ["field", GUARDED], data=Path(str(folder)) / f"{name}.csv")
        lines += rows_of(result, name, 1.6)
    return "\n".join(lines) + "\n"


def pursued(name: str, robot: nav.HolonomicRobot | nav.DifferentialDriveRobot) -> tuple[nav.Scenario, nav.Law]:
    """Return where a law is pursued, and the law."""
    measurement = nav.Measurement(scale=ERROR, of="obstacles", latency=LATENCY)
    scene = nav.Scenario(
        start=(0.0, 0.0), goal=(8.0, 0.0), robot=robot, time_limit=PURSUED, rest_time=PURSUED, measurement=measurement
    )
    error = float(np.hypot(ERROR, ERROR))
    return scene, entry(name).built(person_speed=1.6, latency=LATENCY, position_error=error)


def adversary() -> str:
    """Return the table of the search for a fault."""
    kinds = ("moving toward", "moving away", "at fault")
    lines = head("robot", "law", "random persons", *kinds, "runs of CMA-ES", "episodes", "runs with a fault")
    robots = {"holonomic": nav.HolonomicRobot(), "two wheels": nav.DifferentialDriveRobot()}
    for robot, built in robots.items():
        for name in (*BARE, *PURSUED_LAWS):
            say(robot, name)
            scene, law = pursued(name, built)
            episodes = RANDOM if "shield" in name else BARE_RANDOM
            random = nav.metrics.falsify(scene, law, episodes=episodes, seed=1)
            worst = [
                nav.metrics.falsify(scene, law, method="cma_es", episodes=EVALUATIONS, seed=seed)
                for seed in range(SEARCHES)
            ]
            faults = sum(each.broken for each in worst)
            broken = int((random.margin < 0.0).sum())
            counts = [int((each > 0).sum()) for each in (random.contacts_toward, random.contacts_away)]
            cells = (
                *(percent(each, episodes, 2) for each in (*counts, broken)),
                SEARCHES,
                SEARCHES * EVALUATIONS,
                faults,
            )
            lines.append(line(robot, name, episodes, *cells))
    return "\n".join(lines) + "\n"


def arrivals() -> str:
    """Return the table of two wheels from random poses, each with the clearance at which a plan is certain."""
    lines = head("law", "poses", "arrived", "nearest to a wall, mm", "slowest arrival, s")
    walls = nav.StaticMap.from_polylines([TRAP, ROOM, SCREEN])
    guide, robot = nav.Guide(box=((LEAST_X, LEAST_Y), (MOST_X, MOST_Y))), nav.DifferentialDriveRobot()
    least = robot.radius + guide.margin + guide.spacing / math.sqrt(2.0)
    generator, scenes = np.random.default_rng(11), list[nav.Scenario]()
    while len(scenes) < POSES:
        place, heading = generator.uniform((LEAST_X, LEAST_Y), (MOST_X, MOST_Y)), generator.uniform(-np.pi, np.pi)
        if walls.clearance(place) > least and math.dist(place, GOAL) > 0.2:
            scenes.append(
                nav.Scenario(robot=robot, start=place, goal=GOAL, heading=heading, time_limit=60.0, rest_time=60.0)
            )
    say("poses")
    law = nav.SafeNavigation(nav.VirtualForceField(), map=walls, guide=guide, shield=nav.Shield())
    table = nav.simulate_many(scenes, [law])
    arrived = int((table.outcome == "arrived").sum())
    nearest, slowest = 1e3 * float(table.min_clearance.min()), float(np.nanmax(table.arrival_time))
    lines.append(line("field+guide+shield", POSES, arrived, f"{nearest:.1f}", f"{slowest:.1f}"))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print_or_write(
        DOCS / "validation.md",
        {
            "shares": ("shares of measure_safe.py", shares),
            "adversary": ("persons of measure_safe.py", adversary),
            "poses": ("poses of measure_safe.py", arrivals),
        },
    )
