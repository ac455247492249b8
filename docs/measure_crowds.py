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

from hrsafety import datasets, io, scenarios
from hrsafety import navigation as nav
from hrsafety.benchmarks import SUITES, entry
from hrsafety.benchmarks.protocol import Case
from hrsafety.benchmarks.reacting import SCENES
from hrsafety.navigation.crowd.contacts import contacts_of
from hrsafety.navigation.crowd.simulation import simulated
from page_tables import DOCS, SENSING, head, line, percent, print_or_write

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
CORRIDOR = (
    *((0.13, 1.37), (0.28, 1.41), (0.49, 1.42), (0.69, 1.36), (0.88, 1.28), (1.10, 1.21), (1.30, 1.13), (1.51, 1.06)),
    *((1.70, 0.93), (1.89, 0.80), (2.10, 0.62), (2.30, 0.52), (2.49, 0.47), (2.69, 0.41), (2.90, 0.35), (3.12, 0.31)),
    *((3.33, 0.29), (3.47, 0.28)),
)
"""People for each square meter and their speed in m/s, measured in corridors: what ``laboratory_data.py`` prints."""
DOORS = ((0.70, 1.61), (0.95, 1.76), (1.20, 2.27), (1.30, 2.72), (1.60, 3.10), (2.00, 3.85))
"""Widths of doors in m and people per second, likewise; of 1.6 m the mean of two."""
WALKED = {"length": 20.0, "width": 3.0, "two_way": False, "radius": 0.2, "time_limit": 40.0}
"""Corridor in which people of a model walk."""
LABORATORY_SEEDS = 5


def say(*words: object) -> None:
    """Tell what is under way."""
    print(time.strftime("%H:%M:%S"), *words, file=sys.stderr, flush=True)


def crossings() -> str:
    """Return the contacts in crossings of a recording whose people react."""
    recording = io.load_people(Path(os.environ["HRSAFETY_RECORDINGS"]) / "zara01.csv")
    laws = {"field": nav.VirtualForceField(), "ORCA": nav.OptimalReciprocalCollisionAvoidance()}
    lines = head("people", *(f"{law}: {what}" for law in laws for what in ("toward", "away", "standing")))
    for model in MODELS:
        say(model.__name__)
        cells = [count for law in laws.values() for count in encounters(model(), recording, law)]
        lines.append(line(f"`{model.__name__}`", *cells))
    return "\n".join(lines) + "\n"


def encounters(model: nav.crowd.Pedestrian, recording: datasets.Recording, law: nav.Law) -> tuple[int, ...]:
    """Return how many crossings have a contact while the robot moves toward somebody, moves away, and stands."""
    found = []
    for crossing in scenarios.crossings(recording, runs=CROSSINGS):
        scene = crossing.scenario
        robot = nav.Robot(scene.robot, start=scene.start, goal=scene.goal, law=law)
        world = scenarios.with_recording(
            recording, 1.0, model=model, robots=[robot], start_time=crossing.start_time, radius=0.4
        )
        (episode,) = nav.crowd.episodes_of(nav.simulate(world))
        (arrival_time,) = nav.metrics.evaluate_many([episode]).arrival_time.tolist()
        found.append(contacts_of(episode, arrival_time))
    return tuple(sum(getattr(each, kind) > 0 for each in found) for kind in ("toward", "away", "standing"))


def laboratory() -> str:
    """Return speeds over density and flows through doors, beside those of the laboratory."""
    people = {kind.__name__: kind() for kind in MODELS}
    people = {"CollisionFreeSpeed(time_gap=0.5)": nav.crowd.CollisionFreeSpeed(time_gap=0.5)} | people
    density, measured = np.array(CORRIDOR).T
    say("corridor")
    speeds = {name: walked(model, density) for name, model in people.items()}
    width, through = np.array(DOORS).T
    say("doors")
    flows = {name: [flow(model, door) for door in width.tolist()] for name, model in people.items()}
    names = [f"`{name}`" for name in people]
    lines = head("people, 1/m²", "laboratory, m/s", *names)
    for row, (one, other) in enumerate(CORRIDOR):
        lines.append(line(f"{one:.2f}", f"{other:.2f}", *(f"{each[row]:.2f}" for each in speeds.values())))
    shares = [100.0 * float(np.mean(each / measured) - 1.0) for each in speeds.values()]
    lines.append(line("mean difference, %", "", *(f"{share:+.0f}" for share in shares)))
    ratios = [float(np.max(each / measured)) for each in speeds.values()]
    lines.append(line("largest ratio", "", *(f"{ratio:.2f}" for ratio in ratios)))
    rms = [float(np.sqrt(np.mean((each - measured) ** 2))) for each in speeds.values()]
    lines += [line("rms, m/s", "", *(f"{value:.2f}" for value in rms)), ""]
    lines += head("door, m", "laboratory, 1/s", *names)
    for row, (one, other) in enumerate(DOORS):
        lines.append(line(f"{one:.2f}", f"{other:.2f}", *(each[row][0] for each in flows.values())))
    parts = [np.array([share for _, share in each]) / through for each in flows.values()]
    lines.append(line("mean difference, %", "", *(f"{100 * float(np.mean(part) - 1):+.0f}" for part in parts)))
    return "\n".join(lines) + "\n"


def walked(model: nav.crowd.Pedestrian, density: np.ndarray) -> np.ndarray:
    """Return how fast people walk in corridors at densities."""
    area = float(WALKED["length"]) * float(WALKED["width"])
    worlds = [
        scenarios.corridor(round(each * area), model=model, seed=seed, **WALKED)
        for each in density.tolist()
        for seed in range(LABORATORY_SEEDS)
    ]
    found = nav.crowd.fundamental_diagram(worlds, width=float(WALKED["width"]))
    return found.speed.reshape(-1, LABORATORY_SEEDS).mean(axis=1)


def flow(model: nav.crowd.Pedestrian, door: float) -> tuple[str, float]:
    """Return people per second through a door, from the first fifth of them to the fourth, and how many stay."""
    rooms = [scenarios.bottleneck(100, door=door, model=model, seed=seed) for seed in range(LABORATORY_SEEDS)]
    flows, inside = [], 0
    for run in simulated(rooms):
        out = ~(run.obstacle_position[..., 0] < 8.0)
        times = np.sort(run.time[out.argmax(axis=0)[out.any(axis=0)]])
        inside += int((~out[-1]).sum())
        first, last = int(0.2 * len(times)), int(0.8 * len(times))
        flows.append((last - first) / (times[last] - times[first]) if last - first > 5 else 0.0)
    found = float(np.mean(flows))
    stay = inside / len(rooms)
    return f"{found:.2f}" + (f" ({stay:.0f} stay)" if stay >= 0.5 else ""), found


def suites() -> str:
    """Return a table for each suite: every law with and without a shield."""
    return "\n".join("\n".join(suite(name)) + "\n" for name in SUITE_CASES)


def suite(name: str) -> Iterator[str]:
    """Yield the lines of a suite."""
    kind, speed = SUITES[name], SUITES[name].fastest
    yield f"`{name}`, {SUITE_CASES[name]} episodes: {kind.summary}; shields assume people of up to {speed:g} m/s."
    yield ""
    kinds = ("contact with people %", "with walls %", "moving toward %", "moving away %", "at fault %")
    words = ("law", "people measured", "success %", *kinds, "time, s", "least gap, m", "delay of people, s")
    yield from head(*words, *(("exits, 1/s", "deadlocked %") if name in COUNTED else ()))
    alone = simulated([replace(world, robots=()) for world in worlds_of(name, LAWS[0], "exact")])
    for law in LAWS:
        for word in (law, f"{law}+shield"):
            for sensing in SENSING:
                say(name, word, sensing)
                yield row(worlds_of(name, word, sensing), (word, sensing), alone, counted=name in COUNTED)


def worlds_of(name: str, word: str, sensing: str) -> list[nav.World]:
    """Return the worlds of a suite with a law, which knows how people are measured."""
    speed = SUITES[name].fastest or 0.0
    cases = range(SUITE_CASES[name])
    case = Case(cases=cases, entry=entry(word), person_speed=speed, data=None, seed=0, threads=None, **SENSING[sensing])
    return [SCENES[name](case, index) for index in cases]


def row(worlds: list[nav.World], words: tuple[str, str], alone: list[nav.Trajectory], *, counted: bool) -> str:
    """Return the row of a law and of how people are measured."""
    runs = simulated(worlds)
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
        *words,
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
            "laboratory": ("laboratory of measure_crowds.py", laboratory),
            "suites": ("suites of measure_crowds.py", suites),
        },
    )
