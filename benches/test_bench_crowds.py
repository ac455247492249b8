"""Steps per second of people that react on one core, beside JuPedSim, PySocialForce and pyrvo in the same run.

Processor time, the best of several rounds: people of 0.3 m on a jittered grid of 0.2 people for each square meter, who
go to random goals. A step is one decision and motion of one person; recording everybody's places is included.
"""

from __future__ import annotations

import logging
import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.navigation.crowd.simulation import simulated

ROUNDS = 3
DENSITY, RADIUS, SPEED = 0.2, 0.3, 1.3
MODELS: dict[str, tuple[nav.crowd.Pedestrian, float, int]] = {
    "social force 2000": (nav.crowd.SocialForce2000(), 0.01, 100),
    "collision-free speed": (nav.crowd.CollisionFreeSpeed(), 0.05, 100),
    "social force 1995": (nav.crowd.SocialForce1995(), 0.1, 60),
    "Moussaid, 5 m": (nav.crowd.Moussaid(cutoff=5.0), 0.05, 60),
    "reciprocal, 5 m": (nav.crowd.ReciprocalAvoidance(cutoff=5.0, horizon=2.0, margin=0.0), 0.25, 40),
}
"""Model, step in s, and steps of a round."""


def fastest(work: Callable[[], object], clock: Callable[[], float] = time.process_time) -> float:
    """Return the least time of several rounds in s."""
    spent = []
    for _ in range(ROUNDS):
        start = clock()
        work()
        spent.append(clock() - start)
    return min(spent)


def crowd(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return places and goals."""
    generator = np.random.default_rng(count)
    side = math.sqrt(count / DENSITY)
    columns = math.ceil(math.sqrt(count))
    cell = side / columns
    grid = cell * (np.stack(np.divmod(np.arange(count), columns), axis=1) + 0.5)
    place = grid + generator.uniform(-0.5, 0.5, grid.shape) * (cell - 2.0 * RADIUS)
    return place, generator.uniform(0.0, side, grid.shape)


def world(count: int, model: nav.crowd.Pedestrian, step: float, steps: int) -> nav.World:
    """Return people on a grid."""
    people = [
        nav.Person(start=tuple(a), route=[tuple(b)], model=model, radius=RADIUS, desired_speed=SPEED)
        for a, b in zip(*(each.tolist() for each in crowd(count)), strict=True)
    ]
    return nav.World(people=people, step=step, time_limit=step * steps)


def told(benchmark: Any, name: str, rate: float, work: Callable[[], object]) -> None:
    benchmark.extra_info["steps per s"] = rate
    benchmark.pedantic(work, rounds=1)
    print(f"{name}: {rate / 1e6:.3f} M steps of people per s")


@pytest.mark.parametrize("count", [1000, 10_000])
@pytest.mark.parametrize("name", MODELS)
@pytest.mark.benchmark(group="steps of people, one core")
def test_people(benchmark: Any, name: str, count: int) -> None:
    model, step, steps = MODELS[name]
    steps = steps if count == 1000 else steps // 5
    given = world(count, model, step, steps)

    def run() -> None:
        simulated([given], threads=1)

    told(benchmark, f"{name}, {count}", count * steps / fastest(run), run)


# ---- peers ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [1000, 10_000])
@pytest.mark.parametrize("kind", ["social force 2000", "collision-free speed"])
@pytest.mark.benchmark(group="steps of people, one core")
def test_jupedsim(benchmark: Any, kind: str, count: int) -> None:
    jupedsim = pytest.importorskip("jupedsim")
    place, goal = crowd(count)
    side = math.sqrt(count / DENSITY)
    area = [(-20.0, -20.0), (side + 20.0, -20.0), (side + 20.0, side + 20.0), (-20.0, side + 20.0)]
    force = kind == "social force 2000"
    model = jupedsim.SocialForceModel() if force else jupedsim.CollisionFreeSpeedModelV2()
    simulation = jupedsim.Simulation(model=model, geometry=area, dt=MODELS[kind][1])
    for a, b in zip(place.tolist(), goal.tolist(), strict=True):
        stage = simulation.add_waypoint_stage(tuple(b), 0.3)
        journey = simulation.add_journey(jupedsim.JourneyDescription([stage]))
        traits: dict[str, Any] = {"position": tuple(a), "journey_id": journey, "stage_id": stage}
        traits |= {"desired_speed": SPEED, "radius": RADIUS}
        agent = (
            jupedsim.SocialForceModelAgentParameters(**traits)
            if force
            else jupedsim.CollisionFreeSpeedModelV2AgentParameters(**traits)
        )
        simulation.add_agent(agent)
    steps = 20 if count == 1000 else 4

    def run() -> None:
        simulation.iterate(steps)

    told(benchmark, f"JuPedSim, {kind}, {count}", count * steps / fastest(run), run)


@pytest.mark.benchmark(group="steps of people, one core")
def test_pysocialforce(benchmark: Any, tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # it writes a log into the working folder
    pysocialforce = pytest.importorskip("pysocialforce")
    logging.disable(logging.CRITICAL)
    place, goal = crowd(1000)
    simulator = pysocialforce.Simulator(np.hstack([place, np.zeros_like(place), goal]))

    def run() -> None:
        simulator.step(1)

    told(benchmark, "PySocialForce, Moussaid, 1000", 1000 / fastest(run), run)
    logging.disable(logging.NOTSET)


@pytest.mark.parametrize("count", [1000, 10_000])
@pytest.mark.parametrize("driven", [False, True], ids=["bare", "with goals"])
@pytest.mark.benchmark(group="steps of people, one core")
def test_pyrvo(benchmark: Any, driven: bool, count: int) -> None:
    pyrvo = pytest.importorskip("pyrvo")
    place, goal = crowd(count)
    simulator = pyrvo.RVOSimulator(0.25, 5.0, 10, 2.0, 2.0, RADIUS, SPEED)
    for a in place.tolist():
        simulator.add_agent(tuple(a))
    steps = 20 if count == 1000 else 4

    def aim() -> None:
        for index, b in enumerate(goal):
            way = b - simulator.get_agent_position(index).to_tuple()
            length = math.hypot(*way)
            pace = min(SPEED, length / 0.25) / max(length, 1e-9)
            simulator.set_agent_pref_velocity(index, (float(way[0]) * pace, float(way[1]) * pace))

    def run() -> None:
        for _ in range(steps):
            if driven:
                aim()
            simulator.do_step()

    aim()
    shown = f"pyrvo, {'goals from Python' if driven else 'bare'}, {count}"
    told(benchmark, shown, count * steps / fastest(run), run)


# ---- threads and metrics ----------------------------------------------------------------------------


def circles(count: int) -> list[nav.World]:
    """Return circle crossings."""
    law = nav.OptimalReciprocalCollisionAvoidance()
    return [scenarios.circle_crossing(case, law=law) for case in range(count)]


@pytest.mark.benchmark(group="worlds")
def test_two_threads(benchmark: Any) -> None:
    # Wall time: needs two cores that are free.
    model, step, steps = MODELS["Moussaid, 5 m"]
    given = [replace(world(1000, model, step, steps), seed=seed) for seed in range(8)]
    one, two = (fastest(lambda n=threads: simulated(given, threads=n), time.perf_counter) for threads in (1, 2))
    benchmark.pedantic(lambda: None, rounds=1)
    print(f"two threads: {one / two:.2f} times as fast as one")


@pytest.mark.parametrize("kind", ["circle crossings", "corridors"])
@pytest.mark.benchmark(group="worlds")
def test_metrics(benchmark: Any, kind: str) -> None:
    robot = nav.Robot(start=(0.0, -5.0), goal=(9.0, -5.0), law=nav.OptimalReciprocalCollisionAvoidance())
    given = (
        circles(500)
        if kind == "circle crossings"
        else [scenarios.corridor(60, model=nav.crowd.Moussaid(), robots=[robot], seed=seed) for seed in range(4)]
    )
    runs = simulated(given, threads=1)
    episodes = [each for run in runs for each in nav.crowd.episodes_of(run)]
    elapsed = fastest(lambda: simulated(given, threads=1))
    scored = fastest(lambda: nav.metrics.evaluate_many(episodes, threads=1))
    benchmark.pedantic(lambda: None, rounds=1)
    print(f"metrics, {kind}: {100.0 * scored / elapsed:.0f} % of the time of the runs")
