"""Memory of crowds: peak of the process for each person, environment and pair of a robot and what its law sees.

Each number is the difference of two processes of different size over the difference of their sizes. Measured on a
64-bit Linux: a person of a world, the Python objects included, 2.1 kB; a place in a record 65 bytes; an environment
of five people 5.9 kB; somebody whom a robot under a law may see 0.3 kB; `parallel_env` 0.2 kB times the cube of its
robots. All but the last are linear. Bounds: 10^6 people and 10^4 robots of a world, 10^8 places of records, 10^7 people
and robots of environments, 10^7 pairs of a robot under a law and somebody it may see.
"""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import pytest

HEAD = """
import resource, sys
import numpy as np
import hrsafety.gym
from hrsafety import gym, scenarios
from hrsafety import navigation as nav
n = int(sys.argv[1])
def people(count, size=1e3):
    places = np.random.default_rng(0).uniform(-size, size, (count, 2)).tolist()
    return [nav.Person(start=tuple(each), route=[(0.0, 0.0)], desired_speed=1.0) for each in places]
def robots(count, law):
    ends = [((3.0 * k, 0.0), (3.0 * k, 9.0)) for k in range(count)]
    return [nav.Robot(start=a, goal=b, law=law) for a, b in ends]
"""
TAIL = "\nprint(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
WORK: dict[str, tuple[str, int, int, int]] = {
    # Work, two sizes, and the power of the size to which memory is in proportion.
    "person of a world": (
        "nav.simulate(nav.World(people=people(n), time_limit=0.1))",
        20_000,
        60_000,
        1,
    ),
    "recorded place": (
        "nav.simulate(nav.World(people=people(100), time_limit=0.05 * n / 100))",
        200_000,
        800_000,
        1,
    ),
    "environment of five people": (
        "hrsafety.gym.CrowdVectorEnv(gym.circle_crossing(), num_envs=n, metrics=False).reset(seed=0)",
        4_000,
        12_000,
        1,
    ),
    "robot and somebody its law sees": (
        "law = nav.OptimalReciprocalCollisionAvoidance()\n"
        "nav.simulate(nav.World(people=people(n), robots=robots(20, law), time_limit=0.1))",
        1_000,
        4_000,
        1,
    ),
    "parallel environment, robots cubed": (
        "gym.parallel_env(nav.World(robots=robots(n, None))).reset(seed=0)",
        10,
        40,
        3,
    ),
}


def peak(work: str, size: int) -> int:
    """Return the peak memory of a process in bytes."""
    script = HEAD + work + TAIL
    done = subprocess.run([sys.executable, "-c", script, str(size)], capture_output=True, text=True, check=True)
    return int(done.stdout.split()[-1])


@pytest.mark.parametrize("kind", WORK)
@pytest.mark.benchmark(group="memory of crowds")
def test_memory(benchmark: Any, kind: str) -> None:
    work, small, large, power = WORK[kind]
    each = (peak(work, large) - peak(work, small)) / (large**power - small**power)
    if kind == "robot and somebody its law sees":
        each /= 20  # robots
    benchmark.extra_info["bytes"] = each
    benchmark.pedantic(lambda: None, rounds=1)
    print(f"{kind}: {each:.0f} bytes")
