"""Whole runs: symmetry of the paths, batch against single runs, lanes, threads and seeds."""

from __future__ import annotations

import dataclasses
import math
import random
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios

CONFIGURATIONS = ("c1", "c2", "c3", "c4")
EXTREME_GAINS = [
    (0.0, 0.0, 0.0, 0.0),
    (3.0, 20.0, 17.0, 0.0),
    (3.0, 0.0, 0.0, 0.25),
    (1e-3, 1e-3, 1e-3, 1e-3),
    (1e3, 1e3, 1e4, 5.0),
    (3.0, 20.0, 1e5, 0.25),
    (0.5, 1e4, 17.0, 2.0),
    (50.0, 0.1, 0.1, 0.01),
]
PATH = 1e-8
"""m. The coordinates of the two runs differ by roundings of 1e-15 m at every step, and a run in a
passage between obstacles spreads them by up to 1e6 on its way."""


def gain_sets(count: int) -> np.ndarray:
    """Return random gain sets, the two of the source and extreme ones."""
    generator = np.random.default_rng(31)
    lowest, highest = np.array([0.3, 1.0, 0.5, 0.02]), np.array([15.0, 120.0, 500.0, 1.0])
    spread = lowest * (highest / lowest) ** generator.random((count, 4))
    return np.vstack([[(3.0, 20.0, 17.0, 0.25), (4.3, 20.3, 240.7, 0.68)], EXTREME_GAINS, spread])


def law_of(gains: np.ndarray, **options: object) -> nav.VirtualForceField:
    named = dict(zip(nav.VirtualForceField.GAIN_NAMES, map(float, gains), strict=True))
    return nav.VirtualForceField(**named, **({"stabilizing": "off"} | options))  # type: ignore[arg-type]  # keywords of the class


def assert_same_bits(first: nav.RunTable, second: nav.RunTable) -> None:
    assert first.gain_names == second.gain_names
    for column in dataclasses.fields(nav.RunTable):
        if column.name == "gain_names":
            continue
        one, other = getattr(first, column.name), getattr(second, column.name)
        if not isinstance(one, np.ndarray):
            assert one == other, column.name  # what was run, for the warnings
            continue
        assert one.dtype == other.dtype, column.name
        assert one.tobytes() == other.tobytes(), column.name


OPTIONS = {
    "off": {},
    "capped": {"stabilizing": "capped"},
    "full": {"stabilizing": "full"},
    "side kept": {"side_hysteresis": 3.0},
    "no passage behind": {"pass_behind": False},
}


@pytest.mark.parametrize("option", OPTIONS)
def test_batch_rows_have_the_bits_of_single_runs(option: str) -> None:
    gains = gain_sets(6)
    chosen = [scenarios.configuration(name) for name in CONFIGURATIONS]
    table = nav.simulate_batch(chosen, law_of(gains[0], **OPTIONS[option]), gains, lanes=8)
    assert len(table) == len(gains) * len(chosen)
    for row in range(len(table)):
        scenario = chosen[table.scenario_index[row]]
        run = nav.simulate(scenario, law_of(gains[table.gain_index[row]], **OPTIONS[option]))
        assert run.outcome == table.outcome[row]
        for name in ("arrival_time", "energy", "path_length"):
            assert np.float64(getattr(run, name)).tobytes() == getattr(table, name)[row].tobytes(), (name, row)
        present = len(scenario.obstacles)
        assert run.min_distance.tobytes() == table.min_distance[row, :present].tobytes(), row
        assert np.isnan(table.min_distance[row, present:]).all()
        assert run.min_clearance.min() == table.min_clearance[row]


def test_batch_scores_have_the_bits_of_single_scores() -> None:
    gains = gain_sets(6)
    chosen = [scenarios.configuration(name) for name in CONFIGURATIONS]
    table = nav.simulate_batch(chosen, law_of(gains[0]), gains)
    for row in range(len(table)):
        single = nav.evaluate(chosen[table.scenario_index[row]], law_of(gains[table.gain_index[row]]))
        for name in ("total", "arrival_time", "avoidance", "energy_saving"):
            score = np.float64(getattr(single, name))
            assert score.tobytes() == getattr(table, f"performance_{name}")[row].tobytes(), (name, row)


@pytest.mark.parametrize("option", OPTIONS)
@pytest.mark.parametrize(("integrator", "hold"), [("semi_implicit_euler", True), ("rk4", False)])
def test_neither_lanes_nor_threads_change_a_bit(option: str, integrator: nav.simulation.Integrator, hold: bool) -> None:
    gains = gain_sets(27 if hold else 5)
    chosen = [scenarios.configuration(name) for name in CONFIGURATIONS]

    def table(lanes: int, threads: int) -> nav.RunTable:
        law = law_of(gains[0], **OPTIONS[option])
        return nav.simulate_batch(chosen, law, gains, integrator=integrator, hold=hold, lanes=lanes, threads=threads)

    first = table(1, 1)
    for lanes in (1, 4, 8, 16):
        for threads in (1, 2):
            assert_same_bits(first, table(lanes, threads))


def test_person_who_starts_on_the_goal_gives_no_nan_in_any_lane() -> None:
    scenario = scenarios.configuration("multiple_obstacles")
    assert any(isinstance(o, nav.Human) and o.start == scenario.goal for o in scenario.obstacles)
    gains = np.tile(gain_sets(6), (2, 1))
    for lanes in (1, 4, 8, 16):
        table = nav.simulate_batch([scenario], law_of(gains[0]), gains, lanes=lanes)
        arrived = table.outcome == "arrived"
        assert arrived[:2].all()
        assert np.isfinite(table.arrival_time[arrived]).all()
        for name in ("end_time", "energy", "path_length", "min_distance", "min_clearance", "performance_total"):
            assert np.isfinite(getattr(table, name)).all(), name
    run = nav.simulate(scenario, law_of(gains[0]))
    for name in ("position", "velocity", "force", "distance", "wheel_current"):
        assert np.isfinite(getattr(run, name)).all(), name


@pytest.mark.parametrize("of", ["obstacles", "robot", "both"])
@pytest.mark.parametrize("distribution", ["uniform", "gaussian"])
def test_seed_decides_the_noise_and_nothing_else(of: str, distribution: str) -> None:
    def path(seed: int) -> np.ndarray:
        noise = nav.Measurement(scale=0.01, distribution=distribution, of=of)  # type: ignore[arg-type]  # words
        scenario = dataclasses.replace(scenarios.configuration("c4"), measurement=noise, seed=seed)
        return nav.simulate(scenario, law_of(gain_sets(0)[0])).position

    assert path(7).tobytes() == path(7).tobytes()
    assert path(7).tobytes() != path(8).tobytes()


def test_noisy_batch_rows_have_the_bits_of_single_runs() -> None:
    noise = nav.Measurement(scale=0.01, of="both")
    chosen = [dataclasses.replace(scenarios.configuration("c4"), measurement=noise, seed=seed) for seed in range(5)]
    gains = gain_sets(3)
    tables = [nav.simulate_batch(chosen, law_of(gains[0]), gains, lanes=lanes, threads=2) for lanes in (1, 8)]
    assert_same_bits(*tables)
    for row in range(len(tables[0])):
        run = nav.simulate(chosen[tables[0].scenario_index[row]], law_of(gains[tables[0].gain_index[row]]))
        assert np.float64(run.energy).tobytes() == tables[0].energy[row].tobytes()
        assert run.min_distance.tobytes() == tables[0].min_distance[row].tobytes()


def random_scene(seed: int) -> tuple[nav.Scenario, nav.VirtualForceField]:
    """Return a robot that crosses among a disc, a person and sometimes a rectangle, none in line."""
    source = random.Random(seed)
    obstacles: list[nav.Obstacle] = [
        nav.Disc(center=(2.0, source.uniform(0.1, 0.5)), radius=0.1, active_radius=0.8, critical_radius=0.4),
        nav.Human(
            start=(source.uniform(-1.0, 1.0), -2.0), velocity=(source.uniform(0.1, 0.6), source.uniform(0.4, 1.0))
        ),
    ]
    if source.random() < 0.5:
        obstacles.append(nav.Rectangle(center=(2.2, -1.2), length=1.0, width=0.5, heading=source.uniform(-0.5, 0.5)))
    gains = random.Random(seed + 1).choice(gain_sets(0)[:2])
    return nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=obstacles), law_of(gains)


def turned_point(point: tuple[float, float], angle: float) -> tuple[float, float]:
    c, s = math.cos(angle), math.sin(angle)
    return (c * point[0] - s * point[1], s * point[0] + c * point[1])


def moved_scene(scene: nav.Scenario, angle: float, shift: tuple[float, float], hand: int) -> nav.Scenario:
    """Return the scene mirrored (hand -1), turned and shifted."""

    def free(v: tuple[float, float]) -> tuple[float, float]:
        return turned_point((v[0], hand * v[1]), angle)

    def point(p: tuple[float, float]) -> tuple[float, float]:
        turned = free(p)
        return (turned[0] + shift[0], turned[1] + shift[1])

    obstacles: list[nav.Obstacle] = []
    for body in scene.obstacles:
        if isinstance(body, nav.Human):
            obstacles.append(dataclasses.replace(body, start=point(body.start), velocity=free(body.velocity)))
        elif isinstance(body, nav.Rectangle):
            heading = hand * body.heading + angle
            obstacles.append(dataclasses.replace(body, center=point(body.center), heading=heading))
        elif isinstance(body, nav.MovingDisc):
            obstacles.append(dataclasses.replace(body, center=point(body.center), velocity=free(body.velocity)))
        elif isinstance(body, nav.Disc):
            obstacles.append(dataclasses.replace(body, center=point(body.center)))
    return dataclasses.replace(
        scene, start=point(scene.start), goal=point(scene.goal), obstacles=obstacles, heading=angle
    )


@pytest.mark.parametrize("hand", [1, -1], ids=["turned and shifted", "mirrored too"])
@pytest.mark.parametrize("seed", range(25))
def test_paths_without_stabilizing_force_move_with_the_world(seed: int, hand: int) -> None:
    scene, law = random_scene(seed)
    source = random.Random(seed + 100)
    angle, shift = source.uniform(-math.pi, math.pi), (source.uniform(-10.0, 10.0), source.uniform(-10.0, 10.0))
    here, there = nav.simulate(scene, law), nav.simulate(moved_scene(scene, angle, shift, hand), law)
    assert there.outcome == here.outcome
    assert there.position.shape == here.position.shape
    back = there.position - np.array(shift)
    c, s = math.cos(angle), math.sin(angle)
    back = np.column_stack([c * back[:, 0] + s * back[:, 1], hand * (c * back[:, 1] - s * back[:, 0])])
    assert np.abs(back - here.position).max() <= PATH
    assert np.abs(there.min_distance - here.min_distance).max() <= PATH
    if hand == 1:
        assert there.energy == pytest.approx(here.energy, rel=1e-6)


@pytest.mark.parametrize("hand", [1, -1], ids=["turned", "mirrored"])
@pytest.mark.parametrize("parts", [{"shield": nav.Shield()}, {"shield": nav.Shield(), "yielding": nav.Yielding()}])
def test_safe_navigation_moves_with_the_world(parts: dict[str, Any], hand: int) -> None:
    """The search of the shield took its directions from the x axis, and ended otherwise in half of the worlds."""
    law = nav.SafeNavigation(nav.VirtualForceField(stabilizing="off"), **parts)
    apart = []
    for seed in range(20):
        scene = scenarios.random_traffic(6, seed=seed)
        angle = random.Random(seed).uniform(-math.pi, math.pi)
        here = nav.simulate(scene, law)
        there = nav.simulate(moved_scene(scene, angle, (0.0, 0.0), hand), law)
        c, s = math.cos(angle), math.sin(angle)
        x, y = there.position[: len(here.position)].T
        back = np.column_stack([c * x + s * y, hand * (c * y - s * x)])
        apart.append(np.abs(back - here.position[: len(back)]).max())
    # Rounding may send a robot another way where two ways cost the same.
    assert np.median(apart) < 1e-6
    assert sum(each > 1e-3 for each in apart) <= 1, apart
