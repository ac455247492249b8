"""Costs of decisions in a place known from scans and of foresight, and of distances from a swept rectangle.

On one core: processor time, the best of several rounds; decisions in an unknown place are timed one by one, as a robot
makes them: pose and scan in, twist out, with map, share of the guide, rollouts and verification. Nothing here asserts a
time.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
import shapely
import shapely.affinity

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks.hidden import PERSON, ROBOT
from hrsafety.benchmarks.hidden import PLACES as HIDING
from hrsafety.benchmarks.unknown import PERIOD, RolloutEntry, dead_end, episode, rollout_entry

PLACES, ROUNDS, POINTS, PARTS = 10, 5, 1000, 50


@pytest.mark.benchmark(group="decisions, one core")
@pytest.mark.parametrize("deceleration", [10, 1])
def test_decisions_in_a_place_known_from_scans(benchmark: Any, deceleration: int) -> None:
    entry = rollout_entry(f"rollouts(acceleration={deceleration},noise=0.03)")

    def episodes() -> Any:
        return np.concatenate([updates(entry, index) for index in range(PLACES)])

    spent = benchmark.pedantic(episodes, rounds=1) * 1e3
    half, most = np.quantile(spent, [0.5, 0.999])
    benchmark.extra_info |= {"median ms": half, "99.9 % ms": most, "decisions": len(spent)}
    print(f"{deceleration} m/s^2: {half:.2f} ms, 99.9 % {most:.2f} ms, of {len(spent)} decisions")


def updates(entry: RolloutEntry, index: int) -> Any:
    """Return the times of the updates of a controller until it arrives, on a robot that does what it is told."""
    scene, built = episode(entry, dead_end(index, 0), index, start=(0.0, 0.0), heading=0.0, goal=(10.0, 0.0))
    lidar, tolerance = built.sensors[0], scene.arrival_tolerance
    controller = nav.ScanController(entry.law, scene.robot, scene.goal, lidars=[lidar], arrival_tolerance=tolerance)
    pose, twist, spent, arrived = np.zeros(3), np.zeros(2), [], False
    while not arrived:
        scan = lidar.scan(pose[:2], pose[2], seed=len(spent))
        start = time.perf_counter()
        command = controller.update(len(spent) * PERIOD, pose[:2], pose[2], [scan])
        spent.append(time.perf_counter() - start)
        wanted = np.array([command.speed, command.turn_rate])
        for share in (np.arange(PARTS) + 0.5) / PARTS:
            speed, rate = (1.0 - share) * twist + share * wanted
            ahead = pose[2] + 0.5 * rate * PERIOD / PARTS
            pose += np.array([speed * np.cos(ahead), speed * np.sin(ahead), rate]) * PERIOD / PARTS
        twist, arrived = wanted, command.arrived
    return np.array(spent)


@pytest.mark.benchmark(group="decisions, one core")
@pytest.mark.parametrize("ahead", [None, nav.Foresight()], ids=["shield", "foresight"])
def test_decisions_among_twelve_people(benchmark: Any, ahead: nav.Foresight | None) -> None:
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), foresight=ahead)
    scenes = [scenarios.random_traffic(12, seed=seed) for seed in range(PLACES)]

    def runs() -> list[Any]:
        return [nav.simulate(scene, law) for scene in scenes]

    spent = []
    for _ in range(ROUNDS):
        start = time.process_time()
        found = runs()
        spent.append(time.process_time() - start)
    periods = sum(run.time[-1] / run.scenario.control_period for run in found)
    benchmark.extra_info["ms a decision, simulation included"] = min(spent) / periods * 1e3
    benchmark.pedantic(runs, rounds=1)
    print(f"{'foresight' if ahead else 'shield'}: {min(spent) / periods * 1e3:.3f} ms a decision, simulation included")


@pytest.mark.benchmark(group="decisions, one core")
@pytest.mark.parametrize("unseen", [None, nav.laws.Unseen(person_radius=PERSON)], ids=["seen", "unseen"])
def test_decisions_with_people_who_are_not_seen(benchmark: Any, unseen: nav.laws.Unseen | None) -> None:
    walls, start, goal = HIDING["rooms"](np.random.default_rng(0))
    law = nav.SafeNavigation(
        nav.VirtualForceField(), map=walls, guide=nav.maps.Guide(), shield=nav.Shield(unseen=unseen)
    )
    rules = {"control_period": 0.05, "rest_time": 60.0}
    spent = []
    for limit in (1.0, 11.0):  # the plan of the guide is made before the first decision
        scene = nav.Scenario(robot=ROBOT, start=start, goal=goal, time_limit=limit, **rules)
        best = float("inf")
        for _ in range(ROUNDS):
            begun = time.process_time()
            run = nav.simulate(scene, law)
            best = min(best, time.process_time() - begun)
        spent.append((best, run.time[-1] / scene.control_period))
    each = (spent[1][0] - spent[0][0]) / (spent[1][1] - spent[0][1]) * 1e3
    benchmark.extra_info["ms a decision, simulation included"] = each
    benchmark.pedantic(nav.simulate, args=(scene, law), rounds=1)
    print(f"{'people not seen' if unseen else 'seen people'}: {each:.3f} ms a decision, simulation included")


@pytest.mark.benchmark(group="swept rectangle, one core")
@pytest.mark.parametrize("peer", [False, True], ids=["hrsafety", "shapely, 65 poses"])
def test_distances_of_a_thousand_points_from_a_swept_rectangle(benchmark: Any, peer: bool) -> None:
    outline = nav.robots.Footprint.rectangle(0.508, 0.430)
    places = np.random.default_rng(1).uniform(-1.5, 1.5, (POINTS, 2))
    exact = outline.swept_distance(places, distance=0.8, angle=0.6)
    shares = np.linspace(0.0, 1.0, 65)
    turns, way = 0.6 * shares, 0.8 / 0.6
    body = [
        shapely.affinity.translate(
            shapely.affinity.rotate(shapely.Polygon(outline.corners), turn, origin=(0, 0), use_radians=True),
            way * np.sin(turn),
            way * (1.0 - np.cos(turn)),
        )
        for turn in turns
    ]
    points = shapely.points(places)

    def sampled() -> Any:
        return np.min([shapely.distance(each, points) for each in body], axis=0)

    found = sampled()
    benchmark.extra_info["largest difference from 65 poses, m"] = float(np.abs(found - exact).max())
    benchmark(sampled if peer else lambda: outline.swept_distance(places, distance=0.8, angle=0.6))
