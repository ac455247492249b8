"""What a control period costs with many obstacles: ten, a hundred, and a thousand that are far away.

Robots go 20 m through discs that are spread over 18 m by 16 m, or that stay 60 m away; processor time,
medians of rounds in turn, one core. Nothing here asserts a time: machines differ.
"""

from __future__ import annotations

import functools
import statistics
import time
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety.benchmarks import SUITES, entry
from hrsafety.benchmarks.protocol import Case
from hrsafety.benchmarks.reacting import SCENES

ROUNDS = 25
AWAY = 60.0
FASTEST = SUITES["bottleneck"].fastest or 0.0  # of the people, in m/s
LAWS: dict[str, nav.Law] = {
    "field": nav.VirtualForceField(),
    "Masoud": nav.Masoud(),
    "Khatib": nav.Khatib(),
    "Ge and Cui": nav.GeCui(),
    "Borenstein and Koren": nav.BorensteinKoren(),
    "impedance": nav.laws.VirtualImpedanceLaw(),
    "velocity obstacle": nav.VelocityObstacle(),
    "ORCA": nav.OptimalReciprocalCollisionAvoidance(),
}


@functools.cache
def scene(obstacles: int, *, far: bool = False, away: float = AWAY, seed: int = 3) -> nav.Scenario:
    """Return a scene with so many discs that move slowly."""
    rng = np.random.default_rng(seed)
    around = rng.uniform(-np.pi, np.pi, obstacles)
    near = np.stack([rng.uniform(1.0, 19.0, obstacles), rng.uniform(-8.0, 8.0, obstacles)], axis=-1)
    ring = away * rng.uniform(1.0, 2.0, obstacles)[:, None] * np.stack([np.cos(around), np.sin(around)], axis=-1)
    speed, course = rng.uniform(0.0, 0.5, obstacles), rng.uniform(-np.pi, np.pi, obstacles)
    velocity = np.stack([speed * np.cos(course), speed * np.sin(course)], axis=-1)
    discs = [
        nav.MovingDisc(
            center=(float(x), float(y)),
            velocity=(float(u), float(v)),
            radius=0.1,
            critical_radius=0.6,
            active_radius=1.0,
        )
        for (x, y), (u, v) in zip(ring if far else near, velocity, strict=True)
    ]
    return nav.Scenario(start=(0.0, 0.0), goal=(20.0, 0.0), obstacles=discs, time_limit=20.0)


def periods(law: nav.Law, scenes: list[nav.Scenario]) -> list[float]:
    """Return the processor time of a control period in each scene in microseconds."""
    taken: list[list[float]] = [[] for _ in scenes]
    for _ in range(ROUNDS):
        for where, times in zip(scenes, taken, strict=True):
            begin = time.process_time()
            table = nav.simulate_batch([where], law, threads=1)
            times.append((time.process_time() - begin) / int(table.force_evaluations[0]))
    return [1e6 * statistics.median(times) for times in taken]


@pytest.mark.benchmark(group="a control period among many obstacles, one core")
@pytest.mark.parametrize("law", LAWS)
def test_growth(benchmark: Any, law: str) -> None:
    own = LAWS[law]
    benchmark.pedantic(nav.simulate_batch, ([scene(100)], own), {"threads": 1}, rounds=ROUNDS, iterations=1)
    none, ten, hundred, away = periods(own, [*map(scene, (0, 10, 100)), scene(1000, far=True)])
    benchmark.extra_info["us_of_none_10_100_and_1000_far"] = [round(each, 2) for each in (none, ten, hundred, away)]
    benchmark.extra_info["hundred_over_ten"] = round(hundred / ten, 2)
    benchmark.extra_info["far_over_none"] = round(away / none, 1)


@pytest.mark.benchmark(group="a control period deep in a crowd, one core")
def test_before_a_door(benchmark: Any) -> None:
    """A hundred people leave a room, and a velocity obstacle finds hardly a velocity that is free."""
    taken = {}
    for word in ("velocity_obstacle", "field"):
        case = Case(cases=range(1), entry=entry(word), person_speed=FASTEST, data=None, seed=0, threads=1)
        world = SCENES["bottleneck"](case, 1)
        begin = time.process_time()
        run = nav.simulate(world)
        periods = run.time[-1] / (world.robots[0].control_period or world.step)
        taken[word] = (time.process_time() - begin) / float(periods)
    benchmark.pedantic(nav.simulate, (world,), rounds=1)
    benchmark.extra_info["us_of_people_and_field"] = round(1e6 * taken["field"])
    benchmark.extra_info["us_of_people_and_velocity_obstacle"] = round(1e6 * taken["velocity_obstacle"])
