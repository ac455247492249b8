"""What a shield, yielding, a guide and a controller cost on one core.

Processor time, the best of several rounds, except for the controller, whose updates are timed one by one. Nothing here
asserts a time.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety.benchmarks import benchmark as suite

EPISODES, ROUNDS, UPDATES = 200, 3, 5000
ENTRIES = ("field", "field+shield", "field+shield+yielding", "orca", "orca+shield+yielding")


def fastest(work: Callable[[], object]) -> float:
    """Return the least processor time of several rounds in s."""
    spent = []
    for _ in range(ROUNDS):
        start = time.process_time()
        work()
        spent.append(time.process_time() - start)
    return min(spent)


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.benchmark(group="episodes of S5, one core")
def test_episodes_among_twelve(benchmark: Any, entry: str) -> None:
    def episodes() -> object:
        return suite("s5", [entry], cases=EPISODES, person_speed=1.0, threads=1)

    rate = EPISODES / fastest(episodes)
    benchmark.extra_info["episodes per s"] = rate
    benchmark.pedantic(episodes, rounds=1)
    print(f"{entry}: {rate:.0f} episodes per s")


@pytest.mark.benchmark(group="decisions of a shield, one core")
@pytest.mark.parametrize(("near", "status"), [(6.0, "kept"), (0.9, "changed")], ids=["verified", "searched"])
def test_decisions_among_twelve(benchmark: Any, near: float, status: str) -> None:
    angles = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    people = [(near * float(np.cos(angle)), near * float(np.sin(angle))) for angle in angles]
    shield = nav.Shield(person_speed=1.0)

    def decide() -> Any:
        return shield.decide((0.7, 0.0), velocity=(0.3, 0.0), people=people, radius=0.3)

    assert decide().status == status
    print(f"people at {near} m: {status}, {fastest(lambda: [decide() for _ in range(500)]) / 500 * 1e6:.1f} us")
    benchmark.pedantic(decide, rounds=100)


def pillars(count: int) -> list[nav.Disc]:
    """Return thin pillars around the middle of a room."""
    places = np.random.default_rng(1).uniform((-4.0, -1.5), (4.0, 1.5), (count, 2))
    return [nav.Disc(center=(x, y), radius=0.075) for x, y in places.tolist()]


@pytest.mark.benchmark(group="maps, one core")
def test_plan_of_a_guide(benchmark: Any) -> None:
    walls = nav.maps.StaticMap.from_obstacles(pillars(60))

    def plan() -> object:
        return nav.maps.Guide(box=((-6.0, -3.0), (6.0, 3.0))).plan(
            walls, radius=0.2, start=(-5.0, 0.0), goal=(5.0, 0.0)
        )

    print(f"plan of 12 m x 6 m in cells of 5 cm: {fastest(plan) * 1e3:.1f} ms")
    benchmark.pedantic(plan, rounds=3)


@pytest.mark.benchmark(group="maps, one core")
def test_boundary_points_of_many_segments(benchmark: Any) -> None:
    rng = np.random.default_rng(1)
    ends = rng.uniform(-50.0, 50.0, (10_000, 1, 2)) + rng.uniform(-0.5, 0.5, (10_000, 2, 2))
    walls = nav.maps.StaticMap.from_polylines(ends.tolist())
    places = rng.uniform(-40.0, 40.0, (200, 2)).tolist()

    def points() -> None:
        for place in places:
            walls.boundary_points(place, reach=3.0)

    print(f"boundary points within 3 m of 10,000 segments, from Python: {fastest(points) / len(places) * 1e6:.1f} us")
    benchmark.pedantic(points, rounds=3)


def test_updates_of_a_controller(benchmark: Any) -> None:
    law = nav.SafeNavigation(
        nav.VirtualForceField(),
        map=nav.maps.StaticMap.from_obstacles(pillars(20)),
        guide=nav.maps.Guide(box=((-6.0, -3.0), (6.0, 3.0))),
        shield=nav.Shield(latency=0.1, position_error=0.036),
        yielding=nav.Yielding(),
    )
    robot = nav.HolonomicRobot()
    controller = nav.Controller(law, robot, (5.0, 0.0), start=(-5.0, 0.0), people=12)
    rng = np.random.default_rng(2)
    people = rng.uniform((-5.0, -2.5), (5.0, 2.5), (12, 2))
    walk = rng.uniform(-1.0, 1.0, (12, 2))
    position, velocity, spent = np.array([-5.0, 0.0]), np.zeros(2), []
    for step in range(UPDATES):
        time_now = 0.06 * step
        phase = (0.2 * time_now + np.arange(12))[:, None]
        seen = np.hstack([people + 2.0 * np.sin(phase) * walk, 0.4 * np.cos(phase) * walk])
        begin = time.thread_time()  # other processes of a shared machine do not count
        command = controller.update(time_now, position, velocity, people=seen)
        spent.append(time.thread_time() - begin)
        velocity = np.asarray(command.velocity, dtype=np.float64)
        position = position + 0.06 * velocity
        if np.hypot(*(position - (5.0, 0.0))) < 0.3:
            position = np.array([-5.0, 0.0])
    shown = [f"{np.quantile(spent, share) * 1e6:.0f}" for share in (0.5, 0.99, 0.999, 1.0)]
    benchmark.pedantic(lambda: None, rounds=1)
    print(f"updates with 12 people and a map: median, 99 %, 99.9 %, largest {', '.join(shown)} us")
