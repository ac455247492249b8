"""Print what foresight brings beside yielding, or write it into its guide.

``python docs/measure_foresight.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/foresight.md; ``--only shares`` are the suites, ``--only scenes`` the standard scenes of social navigation,
``--only outlines`` crowds around robots with a footprint, ``--only adversary`` the search for a fault, ``--only first``
the first rows of the page, which are some of its table of suites. The recordings are those of
``HRSAFETY_RECORDINGS``, a folder with zara01.csv and zara03.csv.
"""

from __future__ import annotations

import os
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks import benchmark, entry
from hrsafety.navigation.crowd.simulation import simulated
from page_tables import DOCS, ERROR, LATE, LATENCY, SENSING, head, line, percent, print_or_write, selected, written
from properties.pursued_robot import episode

PAGE = DOCS / "guides" / "foresight.md"
FIRST_MARKS, SHARES_MARKS = "first rows of measure_foresight.py", "shares of measure_foresight.py"
FORESEES = "field+shield+foresight"
LAWS = ("field+shield+yielding", "orca+shield+yielding", FORESEES)
CROWDS, FIRST = 200, 40_000
"""Crowds of two wheels, and the seed of the first one."""
OUTLINED, FIRST_OUTLINED = 100, 50_000
"""Crowds of robots with a footprint, and the seed of the first one."""
FOOTPRINT = nav.robots.Footprint.rectangle(0.508, 0.430)
SEEDS, MARGIN = range(4, 8), 0.01
"""Seeds of each standard scene, and the margin of shields there, whose robots move in steps of 0.05 s, in m."""
LEFT_OUT = ("blind_corner", "following_human", "leading_human", "accompanying_peer")
"""Standard scenes with people whom nobody sees, and those in which the robot has another task than to arrive."""
RANDOM, SEARCHES, EVALUATIONS, PLANT = 10_000, 5, 1000, 10_000
PURSUED = 12.0


def say(*words: object) -> None:
    """Tell what is under way."""
    print(time.strftime("%H:%M:%S"), *words, file=sys.stderr, flush=True)


def shares() -> str:
    """Return the table of the suites."""
    rows = head("suite", "law", "people measured", "episodes", "success %", "at fault %", "arrival, s")
    folder = os.environ.get("HRSAFETY_RECORDINGS")
    suites = [
        ("S5, seed 7701", "s5", {"cases": 500, "seed": 7701}),
        ("crowd of 12", "crowd", {"cases": 200, "seed": 30_000}),
        *((name, "recordings", {"data": Path(folder, f"{name}.csv")}) for name in ("zara01", "zara03") if folder),
    ]
    for where, suite, options in suites:
        for sensing, measured in SENSING.items():
            say(where, sensing)
            result = benchmark(suite, LAWS, **options, **measured)
            for law, found in result.rows.items():
                good = sum(row.outcome == "arrived" and not row.contacts for row in found)
                counts = (percent(each, len(found)) for each in (good, sum(row.at_fault > 0 for row in found)))
                rows.append(line(where, law, sensing, len(found), *counts, f"{result.mean_arrival(law):.1f}"))
    two_wheels = crowded("crowd of 12, two wheels", nav.DifferentialDriveRobot(), range(FIRST, FIRST + CROWDS))
    return "\n".join([*rows, *two_wheels]) + "\n"


def first() -> str:
    """Return the rows of crowds and of S5 with people who are measured late, from the table of suites of the page."""
    table = written(PAGE.read_text(encoding="utf-8"), SHARES_MARKS)
    columns = ("suite", "law", "episodes", "success %", "at fault %", "arrival, s")
    return selected(table, lambda row: row["people measured"] == LATE and "zara" not in row["suite"], columns)


def outlines() -> str:
    """Return the table of robots with a footprint in crowds of 12."""
    rows = head("robot", "law", "people measured", "episodes", "success %", "at fault %", "arrival, s")
    seeds = range(FIRST_OUTLINED, FIRST_OUTLINED + OUTLINED)
    for name, kind in (("two wheels", nav.DifferentialDriveRobot), ("holonomic", nav.HolonomicRobot)):
        rows += crowded(name, kind(footprint=FOOTPRINT), seeds)
    return "\n".join(rows) + "\n"


def crowded(name: str, robot: nav.DifferentialDriveRobot | nav.HolonomicRobot, seeds: range) -> list[str]:
    """Return the rows of a robot in crowds of 12."""
    rows = []
    drawn = scenarios.random_traffic_batch(seeds, obstacles=12)
    for sensing, measured in SENSING.items():
        late = nav.Measurement(scale=ERROR, latency=LATENCY, of="obstacles") if measured else None
        scenes = [replace(each, robot=robot, measurement=late) for each in drawn]
        error = float(np.hypot(ERROR, ERROR)) if measured else 0.0
        for law in LAWS:
            say(name, sensing, law)
            built = entry(law).built(person_speed=1.6, latency=LATENCY if measured else 0.0, position_error=error)
            table = nav.simulate_many(scenes, [built], stop_on_contact=True)
            counts = (int((table.outcome == "arrived").sum()), int((table.contacts_at_fault > 0).sum()))
            cells = (percent(each, len(seeds)) for each in counts)
            mean = f"{np.nanmean(table.arrival_time):.1f}"
            rows.append(line(name, law, sensing, len(seeds), *cells, mean))
    return rows


def standard_scenes() -> str:
    """Return the table of the standard scenes of social navigation."""
    rows = head("people", "law", "people measured", "episodes", "success %", "at fault %")
    for reacting in (False, True):
        for sensing, measured in SENSING.items():
            late = nav.Measurement(scale=ERROR, latency=LATENCY, of="obstacles") if measured else None
            error = float(np.hypot(ERROR, ERROR)) if measured else 0.0
            for law in LAWS:
                say("standard scenes", reacting, sensing, law)
                worlds = []
                for name in (each for each in scenarios.SOCIAL if each not in LEFT_OUT):
                    for seed in SEEDS:
                        world = scenarios.social(name, seed, reacting=reacting)
                        map = nav.StaticMap.from_polylines(world.walls) if world.walls else None
                        guided = law if map is None else law.replace("+", "+guide+", 1)
                        sees = {"latency": LATENCY if measured else 0.0, "position_error": error}
                        built = entry(guided).built(person_speed=1.6, margin=MARGIN, map=map, **sees)
                        robot = replace(world.robots[0], law=built, measurement=late)
                        worlds.append(replace(world, robots=[robot]))
                runs = [each.robots[0] for each in simulated(worlds)]
                counts = (
                    sum(each.outcome == "arrived" for each in runs),
                    sum(each.contacts_at_fault > 0 for each in runs),
                )
                cells = (percent(each, len(runs)) for each in counts)
                rows.append(line("react" if reacting else "do not react", law, sensing, len(runs), *cells))
    return "\n".join(rows) + "\n"


def adversary() -> str:
    """Return the table of the search for a fault."""
    rows = head("robot", "search", "episodes", "at fault")
    sensed = nav.Measurement(scale=ERROR, of="obstacles", latency=LATENCY)
    law = entry(FORESEES).built(person_speed=1.6, latency=LATENCY, position_error=float(np.hypot(ERROR, ERROR)))
    for name, robot in (("holonomic", nav.HolonomicRobot()), ("two wheels", nav.DifferentialDriveRobot())):
        say(name)
        scene = nav.Scenario(
            start=(0.0, 0.0), goal=(8.0, 0.0), robot=robot, time_limit=PURSUED, rest_time=PURSUED, measurement=sensed
        )
        random = nav.metrics.falsify(scene, law, episodes=RANDOM, seed=1)
        rows.append(line(name, f"random persons, {LATE}", RANDOM, int((random.margin < 0.0).sum())))
        runs = range(SEARCHES)
        worst = [nav.metrics.falsify(scene, law, method="cma_es", episodes=EVALUATIONS, seed=seed) for seed in runs]
        rows.append(line(name, "runs of CMA-ES", SEARCHES * EVALUATIONS, sum(each.broken for each in worst)))
        strict = sum(episode(seed, wheels=name == "two wheels", foresees=True).fault for seed in range(PLANT))
        rows.append(line(name, "the plant of the tests, own motion told wrong, updates late or dropped", PLANT, strict))
    return "\n".join(rows) + "\n"


if __name__ == "__main__":
    print_or_write(
        PAGE,
        {
            "shares": (SHARES_MARKS, shares),
            "first": (FIRST_MARKS, first),
            "outlines": ("outlines of measure_foresight.py", outlines),
            "scenes": ("scenes of measure_foresight.py", standard_scenes),
            "adversary": ("adversary of measure_foresight.py", adversary),
        },
    )
