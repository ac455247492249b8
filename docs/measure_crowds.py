"""Measure how laws fare among people that react, or write it into the page on validation.

``python docs/measure_crowds.py`` prints, ``--write`` replaces what stands between the marks of docs/validation.md. The
recording is zara01.csv of ``HRSAFETY_RECORDINGS``; without that folder ``--only crossings`` cannot be made.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from hrsafety import datasets, scenarios
from hrsafety import navigation as nav
from hrsafety.benchmarks import SUITES, entry
from hrsafety.benchmarks.protocol import Case
from hrsafety.benchmarks.reacting import SCENES
from hrsafety.navigation.crowd.contacts import contacts_of
from page_tables import DOCS, head, line, percent, print_or_write

MODELS = (
    nav.crowd.CollisionFreeSpeed,
    nav.crowd.SocialForce2000,
    nav.crowd.ReciprocalAvoidance,
    nav.crowd.Moussaid,
    nav.crowd.SocialForce1995,
)
LAWS = (
    *("field", "khatib", "borenstein_koren", "masoud", "ge_cui", "impedance", "velocity_obstacle", "orca", "dstar"),
    "rrt",
)
CROSSINGS = 24
SUITE_CASES = {"circle_crossing": 500, "circle_crossing_unseen": 500, "antipodal": 100, "bottleneck": 20}
COUNTED = ("antipodal", "bottleneck")
STANDS = 0.05
"""Speed in m/s up to which a robot stands."""


def say(*words: object) -> None:
    """Tell what is under way."""
    print(time.strftime("%H:%M:%S"), *words, file=sys.stderr, flush=True)


def crossings() -> str:
    """Return the contacts in crossings of a recording whose people react."""
    recording = datasets.load_pedestrians(Path(os.environ["HRSAFETY_RECORDINGS"]) / "zara01.csv")
    laws = {"field": nav.VirtualForceField(), "ORCA": nav.OptimalReciprocalCollisionAvoidance()}
    lines = head("people", *(f"{law}: {what}" for law in laws for what in ("standing", "moving")))
    for model in MODELS:
        say(model.__name__)
        cells = [count for law in laws.values() for count in encounters(model(), recording, law)]
        lines.append(line(f"`{model.__name__}`", *cells))
    return "\n".join(lines) + "\n"


def encounters(model: nav.crowd.Pedestrian, recording: datasets.Recording, law: nav.Law) -> tuple[int, int]:
    """Return how many crossings have a contact with the standing and with the moving robot."""
    standing = moving = 0
    for crossing in scenarios.crossings(recording, runs=CROSSINGS):
        scene = crossing.scenario
        robot = nav.crowd.CrowdRobot(start=scene.start, goal=scene.goal, law=law, robot=scene.robot)
        world = scenarios.with_recording(
            recording, 1.0, model=model, robots=[robot], start_time=crossing.start_time, radius=0.4
        )
        run = nav.crowd.simulate_crowd(world)
        gap = np.hypot(*np.moveaxis(run.position - run.robot_position, -1, 0)) - run.radius - scene.robot.radius
        speed = np.hypot(*run.robot_velocity[:, 0].T)
        touched = np.min(np.where(np.isnan(gap), np.inf, gap), axis=1, initial=np.inf) < 0.0
        standing += bool((touched & (speed <= STANDS)).any())
        moving += bool((touched & (speed > STANDS)).any())
    return standing, moving


def suites() -> str:
    """Return a table for each suite: every law with and without a shield."""
    return "\n".join("\n".join(suite(name)) + "\n" for name in SUITE_CASES)


def suite(name: str) -> Iterator[str]:
    """Yield the lines of a suite."""
    kind, speed = SUITES[name], SUITES[name].fastest
    yield f"`{name}`, {SUITE_CASES[name]} episodes: {kind.summary}; shields assume people of up to {speed:g} m/s."
    yield ""
    kinds = ("contact with people %", "with walls %", "moving toward %", "moving away %", "at fault %")
    words = ("law", "success %", *kinds, "time, s", "least gap, m", "delay of people, s")
    yield from head(*words, *(("exits, 1/s", "deadlocked %") if name in COUNTED else ()))
    alone = nav.crowd.simulate_crowds([replace(world, robots=()) for world in worlds_of(name, LAWS[0])])
    for law in LAWS:
        for word in (law, f"{law}+shield"):
            say(name, word)
            yield row(worlds_of(name, word), word, alone, counted=name in COUNTED)


def worlds_of(name: str, word: str) -> list[nav.crowd.World]:
    """Return the worlds of a suite with a law."""
    speed = SUITES[name].fastest or 0.0
    cases = range(SUITE_CASES[name])
    case = Case(cases=cases, entry=entry(word), person_speed=speed, data=None, seed=0, threads=None)
    return [SCENES[name](case, index) for index in cases]


def row(worlds: list[nav.crowd.World], word: str, alone: list[nav.crowd.CrowdTrajectories], *, counted: bool) -> str:
    """Return the row of a law."""
    runs = nav.crowd.simulate_crowds(worlds)
    episodes = [nav.crowd.episodes_of(run, other)[0] for run, other in zip(runs, alone, strict=True)]
    table = nav.metrics.evaluate_many(episodes)
    found = [contacts_of(*each) for each in zip(episodes, table.arrival_time.tolist(), strict=True)]
    walls = table.wall_contacts > 0
    people = np.array([each.moving + each.standing > 0 for each in found])
    faults = np.array([each.at_fault > 0 for each in found]) | walls
    whole = [nav.crowd.world_metrics(run) for run in runs]
    ends = ()
    if counted:
        exits = np.mean([each.throughput for each in whole])
        ends = (f"{exits:.2f}", f"{100 * np.mean([each.deadlocked_share for each in whole]):.1f}")
    # Of those who leave the last place is not kept, but the time is.
    delays = [run.person_arrival_time - other.person_arrival_time for run, other in zip(runs, alone, strict=True)]
    toward, away = (np.array([getattr(each, kind) > 0 for each in found]) for kind in ("toward", "away"))
    counts = (int(np.sum(each)) for each in (table.success, people, walls, toward, away, faults))
    return line(
        word,
        *(percent(count, len(worlds)) for count in counts),
        f"{mean(table.arrival_time):.2f}",
        f"{np.mean(table.min_clearance):.2f}",
        f"{mean(np.concatenate(delays)):.2f}",
        *ends,
    )


def mean(values: np.ndarray) -> float:
    """Return the mean of what is a number; NaN if nothing is."""
    known = values[~np.isnan(values)]
    return float(known.mean()) if len(known) else float("nan")


if __name__ == "__main__":
    print_or_write(
        DOCS / "validation.md",
        {
            "crossings": ("crossings of measure_crowds.py", crossings),
            "suites": ("suites of measure_crowds.py", suites),
        },
    )
