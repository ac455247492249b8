"""Print what foresight brings beside yielding, or write it into its guide.

``python docs/measure_foresight.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/foresight.md; ``--only shares`` are the suites, ``--only scenes`` the standard scenes of social navigation,
``--only outlines`` crowds around robots with a footprint, ``--only gaps`` such robots before a gap, ``--only
crossings`` rectangles that move, ``--only challenge`` the worlds of DynaBARN, ``--only adversary`` the search for a
fault, ``--only first`` the first rows of the page, which are some of its table of suites. The recordings are those of
``HRSAFETY_RECORDINGS``, a folder with zara01.csv and zara03.csv, the worlds those of ``HRSAFETY_BARN``, a folder that
``challenge_worlds.py`` fills.
"""

from __future__ import annotations

import math
import os
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from api.navigation.test_moving_rectangles import crossings
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
NOISES = range(10)
"""Seeds of the errors of measured people in recordings."""
CROWDS, FIRST = 200, 40_000
"""Crowds of two wheels, and the seed of the first one."""
OUTLINED, FIRST_OUTLINED = 100, 50_000
"""Crowds of robots with a footprint, and the seed of the first one."""
FOOTPRINT = nav.robots.Footprint.rectangle(0.508, 0.430)
WIDTHS, DEPTHS, NARROW = (0.50, 0.56, 0.60, 0.80), (0.1, 1.0), nav.robots.Footprint.rectangle(0.50, 0.43)
"""Widths and depths of a gap in m, and the robot that drives through it."""
GAP_RUNS, GAP_SEED = 100, 5
CROSSINGS, FIRST_CROSSING = 150, 8
"""Scenes of rectangles that cross the way, and their seed."""
UNSHIELDED = ("field(attractive_gain=13)+yielding", "field(attractive_gain=13)+foresight")
"""Entries without a shield: that of the worlds of DynaBARN, and foresight in the place of yielding."""
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
            # A recording is one set of episodes; errors of measurements are drawn several times.
            seeds = NOISES if suite == "recordings" and measured else [options.get("seed")]
            results = [benchmark(suite, LAWS, **(options | {"seed": seed}), **measured) for seed in seeds]
            for law in results[0].rows:
                found = [row for result in results for row in result.rows[law]]
                mean = np.nanmean([row.arrival_time for row in found])
                good = sum(row.outcome == "arrived" and not row.contacts for row in found)
                counts = (percent(each, len(found)) for each in (good, sum(row.at_fault > 0 for row in found)))
                rows.append(line(where, law, sensing, len(found), *counts, f"{mean:.1f}"))
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


def gaps() -> str:
    """Return the table of a robot with a footprint in a room whose only way out is a gap in a wall."""
    rows = head("depth, m", "law", *(f"gap of {width:.2f} m" for width in WIDTHS))
    for depth in DEPTHS:
        for law in ("field+guide+shield", "field+guide+shield+yielding", "field+guide+shield+foresight"):
            say("gaps", depth, law)
            arrived = []
            for width in WIDTHS:
                map, scenes = before_a_gap(width, depth)
                table = nav.simulate_many(scenes, [entry(law).built(person_speed=1.6, map=map)])
                arrived.append(percent(int((table.outcome == "arrived").sum()), len(scenes), digits=0))
            rows.append(line(depth, law.replace("+guide", ""), *arrived))
    return "\n".join(rows) + "\n"


def before_a_gap(width: float, depth: float) -> tuple[nav.StaticMap, list[nav.Scenario]]:
    """Return a room with a gap of a width in a wall of a depth in m, and robots at drawn places before it."""
    sides = [[(2, y), (2, edge), (2 + depth, edge), (2 + depth, y)] for y, edge in ((3, width / 2), (-3, -width / 2))]
    map = nav.StaticMap.from_polylines([*sides, [(-2, -3), (5 + depth, -3), (5 + depth, 3), (-2, 3), (-2, -3)]])
    scenes = []
    for run in range(GAP_RUNS):
        draws = np.random.default_rng([GAP_SEED, run])
        start = draws.uniform([-1.4, -2.4], [1.4, 2.4])
        place = nav.Scenario(
            robot=nav.DifferentialDriveRobot(footprint=NARROW),
            start=tuple(start.tolist()),
            goal=(4.0 + depth, draws.uniform(-1.5, 1.5)),
            heading=draws.uniform(-math.pi, math.pi),
            time_limit=60.0,
            walls=map,
        )
        scenes.append(place)
    return map, scenes


def crossed() -> str:
    """Return the table of rectangles that cross the way."""
    rows = head("robot", "law", "episodes", "success %", "at fault %", "arrival, s")
    drawn = crossings(CROSSINGS, FIRST_CROSSING)
    robots = {
        f"{shape}, {drive}": kind(footprint=footprint)
        for shape, footprint in (("disc", None), ("rectangle", FOOTPRINT))
        for drive, kind in (("holonomic", nav.HolonomicRobot), ("two wheels", nav.DifferentialDriveRobot))
    }
    for name, robot in robots.items():
        scenes = [replace(each, robot=robot) for each in drawn]
        for law in LAWS:
            say("crossings", name, law)
            table = nav.simulate_many(scenes, [entry(law).built(person_speed=1.6)], stop_on_contact=True)
            counts = (int((table.outcome == "arrived").sum()), int((table.contacts_at_fault > 0).sum()))
            cells = (percent(each, len(scenes)) for each in counts)
            rows.append(line(name, law, len(scenes), *cells, f"{np.nanmean(table.arrival_time):.1f}"))
    return "\n".join(rows) + "\n"


def challenge() -> str:
    """Return the table of the worlds of DynaBARN."""
    rows = head("worlds", "law", "episodes", "success %", "at fault %", "arrival, s")
    kinds = (("DynaBARN", "dynabarn", LAWS), ("DynaBARN, robot of 3 m/s^2", "dynabarn3", (*LAWS, *UNSHIELDED)))
    for name, suite, laws in kinds:
        say(name)
        result = benchmark(suite, laws, data=os.environ["HRSAFETY_BARN"])
        for law, found in result.rows.items():
            good = sum(row.outcome == "arrived" and not row.contacts for row in found)
            counts = (percent(each, len(found)) for each in (good, sum(row.at_fault > 0 for row in found)))
            rows.append(line(name, law, len(found), *counts, f"{result.mean_arrival(law):.1f}"))
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
            "gaps": ("gaps of measure_foresight.py", gaps),
            "crossings": ("crossings of measure_foresight.py", crossed),
            "challenge": ("challenge of measure_foresight.py", challenge),
            "scenes": ("scenes of measure_foresight.py", standard_scenes),
            "adversary": ("adversary of measure_foresight.py", adversary),
        },
    )
