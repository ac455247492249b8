"""Episodes per second of many different scenes on one core, from arrays and from objects, and a peer.

The scenes are S4 and S5: a robot of 0.3 m and 1 m/s goes 10 m past three or twelve discs that move
straight on, control period 0.1 s, contacts end an episode. Processor time, median of rounds in turn;
the scenes are made inside the timed part. The peer steps the robot through the same scenes with the
reciprocal avoidance of its authors and measures nothing else. Nothing here asserts a time.
"""

from __future__ import annotations

import functools
import math
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pyrvo  # type: ignore[import-untyped]  # it has no type information
import pytest

from hrsafety import navigation as nav

ROUNDS = 7
ROWS = 2000
PEER_ROWS = 40
ROBOT = nav.HolonomicRobot(radius=0.3, max_speed=1.0)
RULES: dict[str, float] = {"control_period": 0.1, "time_limit": 15.0, "arrival_tolerance": 0.3}
RADIUS = 0.3
LAWS: dict[str, nav.Law] = {
    "field": nav.VirtualForceField(),
    "field, without stabilizing": nav.VirtualForceField(stabilizing="off"),
    "ORCA": nav.OptimalReciprocalCollisionAvoidance(),
}
Work = Callable[[], nav.RunTable]


@functools.cache
def arrays(obstacles: int) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and velocities of the obstacles of all rows."""
    rng = np.random.default_rng(1)
    shape = (ROWS, obstacles)
    x, y = rng.uniform(2.0, 9.0, shape), rng.uniform(-3.0, 3.0, shape)
    speed, course = rng.uniform(0.0, 1.0, shape), rng.uniform(-math.pi, math.pi, shape)
    velocity = np.stack([speed * np.cos(course), speed * np.sin(course)], axis=-1)
    return np.stack([x, y], axis=-1), velocity


def from_arrays(obstacles: int) -> nav.Scenarios:
    """Return the scenes in one call."""
    position, velocity = arrays(obstacles)
    return nav.Scenarios.from_arrays(
        start=(0.0, 0.0),
        goal=(10.0, 0.0),
        obstacle_position=position,
        obstacle_velocity=velocity,
        obstacle_radius=RADIUS,
        person=False,
        robot=ROBOT,
        **RULES,  # type: ignore[arg-type]  # numbers
    )


def from_objects(obstacles: int) -> list[nav.Scenario]:
    """Return the scenes one after the other."""
    position, velocity = (values.tolist() for values in arrays(obstacles))
    return [
        nav.Scenario(
            start=(0.0, 0.0),
            goal=(10.0, 0.0),
            obstacles=[
                nav.MovingDisc(center=(x, y), velocity=(u, v), radius=RADIUS)
                for (x, y), (u, v) in zip(places, speeds, strict=True)
            ],
            robot=ROBOT,
            **RULES,  # type: ignore[arg-type]  # numbers
        )
        for places, speeds in zip(position, velocity, strict=True)
    ]


def run(make: Callable[[int], Any], obstacles: int, law: nav.Law, step: float, threads: int | None = 1) -> nav.RunTable:
    """Make the scenes and run a law in them."""
    return nav.simulate_many(make(obstacles), law, step=step, stop_on_contact=True, threads=threads)


def with_peer(obstacles: int) -> int:
    """Step the peer through the first scenes; return its steps."""
    position, velocity = (values.tolist() for values in arrays(obstacles))
    steps = 0
    for places, speeds in zip(position[:PEER_ROWS], velocity[:PEER_ROWS], strict=True):
        peer = pyrvo.RVOSimulator(0.1, 5.0, 25, 2.0, 2.0, RADIUS, 1.0)
        robot = peer.add_agent((0.0, 0.0))
        others = [peer.add_agent(place) for place in places]
        for _ in range(150):
            x, y = peer.get_agent_position(robot).x, peer.get_agent_position(robot).y
            away = math.hypot(10.0 - x, y)
            if away <= 0.3:
                break
            speed = min(1.0, away / 0.1) / away
            peer.set_agent_pref_velocity(robot, ((10.0 - x) * speed, -y * speed))
            for other, course in zip(others, speeds, strict=True):
                peer.set_agent_pref_velocity(other, tuple(course))
            peer.do_step()
            steps += 1
    return steps


def seconds(work: Callable[[], object]) -> float:
    """Return the median processor time."""
    taken = []
    for _ in range(ROUNDS):
        begin = time.process_time()
        work()
        taken.append(time.process_time() - begin)
    return statistics.median(taken)


def measure(benchmark: Any, work: Work) -> None:
    """Time the work and note its rates."""
    table = benchmark.pedantic(work, rounds=2, iterations=1)
    own = seconds(work)
    benchmark.extra_info["episodes_per_s"] = round(len(table) / own)
    benchmark.extra_info["million_control_periods_per_s"] = round(int(table.force_evaluations.sum()) / own / 1e6, 2)
    benchmark.extra_info["arrived"] = round(table.success.value, 4)


@pytest.mark.benchmark(group="episodes from arrays, one core")
@pytest.mark.parametrize("step", [0.1, 0.02])
@pytest.mark.parametrize("obstacles", [3, 12])
@pytest.mark.parametrize("law", LAWS)
def test_episodes_from_arrays(benchmark: Any, law: str, obstacles: int, step: float) -> None:
    measure(benchmark, functools.partial(run, from_arrays, obstacles, LAWS[law], step))
    made = from_arrays(obstacles)
    options: dict[str, Any] = {"step": step, "stop_on_contact": True, "threads": 1}
    ways: dict[str, Work] = {
        "made_before": functools.partial(nav.simulate_many, made, LAWS[law], **options),
        "one_by_one": functools.partial(nav.simulate_batch, made, LAWS[law], lanes=1, **options),
    }
    for name, work in ways.items():
        benchmark.extra_info[f"episodes_per_s_{name}"] = round(ROWS / seconds(work))


@pytest.mark.benchmark(group="scenes of three discs, one core")
@pytest.mark.parametrize("make", [from_arrays, from_objects])
def test_scenes_of_three_discs(benchmark: Any, make: Callable[[int], Any]) -> None:
    made = benchmark.pedantic(make, (3,), rounds=2)
    benchmark.extra_info["us_per_scene"] = round(1e6 * seconds(functools.partial(make, 3)) / len(made), 2)


@pytest.mark.benchmark(group="episodes from objects, one core")
def test_episodes_from_objects(benchmark: Any) -> None:
    measure(benchmark, functools.partial(run, from_objects, 3, LAWS["field"], 0.1))


@pytest.mark.benchmark(group="one gain set in 512 scenes made before, one core")
@pytest.mark.parametrize("law", LAWS)
def test_scenes_made_before(benchmark: Any, law: str) -> None:
    scenes = from_arrays(3)[:512]
    measure(benchmark, functools.partial(nav.simulate_many, scenes, LAWS[law], step=0.1, threads=1))


@pytest.mark.benchmark(group="episodes from arrays, all cores")
def test_episodes_on_all_cores(benchmark: Any) -> None:
    work = functools.partial(run, from_arrays, 3, LAWS["field"], 0.02, None)
    benchmark.pedantic(work, rounds=ROUNDS, iterations=1)


@pytest.mark.benchmark(group="episodes from arrays, one core")
@pytest.mark.parametrize("obstacles", [3, 12])
def test_episodes_of_pyrvo(benchmark: Any, obstacles: int) -> None:
    steps = benchmark.pedantic(with_peer, (obstacles,), rounds=2, iterations=1)
    own = seconds(functools.partial(with_peer, obstacles))
    assert steps > 0
    benchmark.extra_info["episodes_per_s"] = round(PEER_ROWS / own)
    benchmark.extra_info["million_control_periods_per_s"] = round(steps / own / 1e6, 4)
