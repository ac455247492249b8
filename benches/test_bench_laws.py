"""Control steps per second of every law on one core, past three moving obstacles over 10 m.

Every law runs in turn with the new field in the same rounds: processor time, least of several
rounds, so that a busy machine hurts both alike. ``cost_over_the_new_field`` is how much more a
control step costs. Nothing here asserts a time.
"""

from __future__ import annotations

import functools
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios

SETS = 512
ROUNDS = 5
SCENE = scenarios.random_traffic(3, seed=1)
EPISODES = [scenarios.random_traffic(3, seed=seed) for seed in range(SETS)]
NEW = nav.VirtualForceField()
VIRTUAL_FORCES: dict[str, nav.Law] = {
    "new field": NEW,
    "new field, without stabilizing": nav.VirtualForceField(stabilizing="off"),
    "new field, without detour": nav.VirtualForceField(detour_gain=0.0),
    "Khatib": nav.Khatib(),
    "Borenstein and Koren": nav.BorensteinKoren(),
    "Masoud": nav.Masoud(),
    "Ge and Cui": nav.GeCui(),
}
FAST_PLANNERS: dict[str, nav.Law] = {
    "velocity obstacle": nav.VelocityObstacle(),
    "ORCA": nav.OptimalReciprocalCollisionAvoidance(),
}
GRAPH_PLANNERS: dict[str, nav.Law] = {
    "extended RRT": nav.RapidlyExploringRandomTree(),
    "Field D*": nav.FieldDStar(),
}
Work = Callable[[], nav.RunTable]


def gain_sets(law: nav.Law) -> npt.NDArray[np.float64]:
    """Return gain sets within a fifth of the law's own, neighbours side by side as in a search."""
    generator = np.random.default_rng(11)
    spread = np.array(law.gains) * generator.uniform(0.8, 1.2, (SETS, len(law.gains)))
    return spread[np.argsort(spread[:, 0])]


def over_gains(law: nav.Law) -> Work:
    """Return one scene with many gain sets as work."""
    return functools.partial(nav.simulate_batch, [SCENE], law, gain_sets(law), threads=1)


def over_episodes(law: nav.Law, episodes: list[nav.Scenario], step: float = 0.01) -> Work:
    """Return many scenes with the law's own gains as work."""
    return functools.partial(nav.simulate_batch, episodes, law, threads=1, step=step)


def rates(*contestants: Work) -> list[float]:
    """Return control steps per second of processor time, least time of rounds in turn."""
    best = [(math.inf, 0)] * len(contestants)
    for _ in range(ROUNDS):
        for index, work in enumerate(contestants):
            begin = time.process_time()
            steps = int(work().force_evaluations.sum())
            best[index] = min(best[index], (time.process_time() - begin, steps))
    return [steps / seconds for seconds, steps in best]


def measure(benchmark: Any, work: Work, new_field: Work) -> None:
    """Time the work and note its rate, also beside the new field."""
    table = benchmark.pedantic(work, rounds=ROUNDS, iterations=1)
    own, of_the_new_field = rates(work, new_field)
    assert len(table) > 0
    assert (table.force_evaluations > 0).all()
    benchmark.extra_info["control_steps"] = int(table.force_evaluations.sum())
    benchmark.extra_info["arrived"] = float((table.outcome == "arrived").mean())
    benchmark.extra_info["million_control_steps_per_s"] = round(own / 1e6, 3)
    benchmark.extra_info["cost_over_the_new_field"] = round(of_the_new_field / own, 2)


@pytest.mark.benchmark(group="three moving obstacles over 10 m, 512 gain sets, one core")
@pytest.mark.parametrize("name", VIRTUAL_FORCES)
def test_virtual_forces_over_gain_sets(benchmark: Any, name: str) -> None:
    measure(benchmark, over_gains(VIRTUAL_FORCES[name]), over_gains(NEW))


@pytest.mark.benchmark(group="three moving obstacles over 10 m, 512 episodes, one core")
@pytest.mark.parametrize("name", VIRTUAL_FORCES | FAST_PLANNERS)
def test_laws_over_episodes(benchmark: Any, name: str) -> None:
    law = (VIRTUAL_FORCES | FAST_PLANNERS)[name]
    measure(benchmark, over_episodes(law, EPISODES), over_episodes(NEW, EPISODES))


@pytest.mark.benchmark(group="three moving obstacles over 10 m, 512 episodes, motion steps of 0.06 s, one core")
@pytest.mark.parametrize("name", ["new field", *FAST_PLANNERS])
def test_laws_over_episodes_with_coarse_steps(benchmark: Any, name: str) -> None:
    law = (VIRTUAL_FORCES | FAST_PLANNERS)[name]
    measure(benchmark, over_episodes(law, EPISODES, 0.06), over_episodes(NEW, EPISODES, 0.06))


@pytest.mark.benchmark(group="three moving obstacles over 10 m, 8 episodes, one core")
@pytest.mark.parametrize("name", GRAPH_PLANNERS)
def test_planners_on_graphs(benchmark: Any, name: str) -> None:
    measure(benchmark, over_episodes(GRAPH_PLANNERS[name], EPISODES[:8]), over_episodes(NEW, EPISODES[:8]))
