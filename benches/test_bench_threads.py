"""Elapsed time on one thread, on two and on the default number of them, for each kind of work; needs two free cores."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hrsafety import arms, contact, impact, scenarios
from hrsafety import navigation as nav

ROUNDS = 7
ROWS = 8_000
DRAWS = np.random.default_rng(3)
CROSSING = scenarios.configuration("c1")
FOAM = contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9)

Work = Callable[[int | None], object]


def scenes() -> nav.Scenarios:
    """Return a robot of 0.3 m over 10 m past three discs, many times."""
    place, speed = DRAWS.uniform([2.0, -3.0], [9.0, 3.0], (ROWS, 3, 2)), DRAWS.uniform(0.0, 1.0, (ROWS, 3, 1))
    course = DRAWS.uniform(-np.pi, np.pi, (ROWS, 3))
    return nav.Scenarios.from_arrays(
        start=np.zeros((ROWS, 2)),
        goal=np.tile([10.0, 0.0], (ROWS, 1)),
        obstacle_position=place,
        obstacle_velocity=speed * np.stack([np.cos(course), np.sin(course)], axis=2),
        obstacle_radius=0.3,
        robot=nav.HolonomicRobot(radius=0.3, max_speed=1.0, max_acceleration=10.0),
        control_period=0.1,
        time_limit=15.0,
        arrival_tolerance=0.3,
    )


def gain_sets() -> Work:
    gains = np.array([4.3, 20.3, 240.7, 0.68]) * DRAWS.uniform(0.8, 1.2, (40_000, 4))
    return lambda threads: nav.simulate_batch([CROSSING], nav.VirtualForceField(), gains=gains, threads=threads)


def many_scenes(law: Any) -> Work:
    given = scenes()
    return lambda threads: nav.simulate_many(given, [law], step=0.02, threads=threads)


def search() -> Work:
    return lambda threads: nav.optimize_gains([CROSSING], grid=(12, 12, 12, 12), local_starts=0, threads=threads)


def impacts() -> Work:
    stiffness, damping = np.linspace(5e3, 80e3, 300_000), np.linspace(0.0, 200.0, 300_000)
    return lambda threads: impact.metrics_batch(
        manipulator=impact.MANIPULATOR_1,
        head=impact.Head.minimum(),
        closing_speed=1.25,
        foam_stiffness=stiffness,
        foam_damping=damping,
        threads=threads,
    )


def collisions() -> Work:
    covering = contact.Covering(material=FOAM, thickness=0.02, area=4e-3, rate=(0.05, 0.02, 0.1))
    speeds = np.linspace(0.1, 0.6, 60_000)
    hit = contact.Contact(robot=8.0, body=40.0, region=25e3, covering=covering)
    return lambda threads: hit.simulate_many(speeds, tolerance=1e-6, threads=threads)


def allowed_speeds() -> Work:
    covering = contact.Covering(material=FOAM, thickness=0.02, area=4e-3)
    masses = np.linspace(2.0, 30.0, 1_000_000)
    hit = contact.Contact(robot=8.0, body=0.6, region=75e3, covering=covering)
    limits = {"force": 280.0, "pressure": 380e4}
    return lambda threads: hit.allowed_speeds(limits, robot_mass=masses, threads=threads)


def masses() -> Work:
    arm = arms.Arm.example()
    poses = np.random.default_rng(18).uniform(-2.0, 2.0, (1_000_000, len(arm.joint_names)))
    along = np.array([0.6, -0.48, 0.64])
    return lambda threads: arm.effective_mass(poses, link="tool", direction=along, threads=threads).mass


KINDS: dict[str, Callable[[], Work]] = {
    "40,000 gain sets": gain_sets,
    "8,000 scenes, new field": lambda: many_scenes(nav.VirtualForceField()),
    "8,000 scenes, ORCA": lambda: many_scenes(nav.OptimalReciprocalCollisionAvoidance()),
    "search of 20,736 gain sets": search,
    "300,000 impacts": impacts,
    "60,000 collisions with rate": collisions,
    "10^6 poses": masses,
    "10^6 allowed speeds": allowed_speeds,
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.benchmark(group="one thread, elapsed time")
def test_threads(benchmark: Any, kind: str) -> None:
    work = KINDS[kind]()

    def least(threads: int | None) -> float:
        spent = []
        for _ in range(ROUNDS):
            start = time.perf_counter()
            work(threads)
            spent.append(time.perf_counter() - start)
        return min(spent)

    work(2)
    one, two, default = (least(threads) for threads in (1, 2, None))
    benchmark.extra_info |= {"two threads": round(one / two, 2), "default": round(one / default, 2)}
    benchmark.pedantic(work, (1,), rounds=1)
    print(f"{kind}: one {one:.3f} s, two threads {one / two:.2f}, default {one / default:.2f} times as fast")
