"""Rectangles that move: as far as brute force says, under every law, in files and pictures."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, plotting, scenarios
from hrsafety import navigation as nav
from hrsafety.navigation.laws import SafeNavigation, Shield, Yielding
from hrsafety.navigation.maps import Guide, StaticMap
from hrsafety.navigation.metrics import falsify

FIELD = nav.VirtualForceField()
ORCA = nav.OptimalReciprocalCollisionAvoidance(margin=0.05)
LAWS: dict[str, nav.Law] = {
    "field": FIELD,
    "stabilized": nav.VirtualForceField(stabilizing="capped", side_hysteresis=1.2),
    "khatib": nav.Khatib(),
    "ge and cui": nav.GeCui(),
    "masoud": nav.Masoud(),
    "borenstein": nav.BorensteinKoren(),
    "orca": ORCA,
    "velocity obstacle": nav.VelocityObstacle(margin=0.05),
    "tree": nav.RapidlyExploringRandomTree(),
    "field d*": nav.FieldDStar(),
    "safe field": SafeNavigation(FIELD, shield=Shield(person_speed=1.0), yielding=Yielding()),
    "safe orca": SafeNavigation(ORCA, shield=Shield(person_speed=1.0)),
}
SIZE: dict[str, float] = {"length": 1.2, "width": 0.6}
RECORDED = ([0.0, 1.0, 3.0, 5.0], [[2.5, -2.0], [2.5, -1.0], [3.0, 0.5], [1.0, 2.5]])
LEGS = [(1.5, (0.2, 0.8), (0.0, 0.0)), (1.0, (0.2, 0.8), (-0.4, 0.1)), (2.0, (0.0, -0.5), (0.0, 0.0))]
MOTIONS: dict[str, nav.MovingRectangle] = {
    "straight": nav.MovingRectangle(center=(2.5, -2.0), velocity=(0.1, 0.7), heading=0.4, **SIZE),
    "accelerating": nav.MovingRectangle(center=(2.5, -2.0), velocity=(0.0, 0.3), acceleration=(0.1, 0.1), **SIZE),
    "stopping": nav.MovingRectangle(center=(3.0, -2.0), velocity=(0.0, 0.5), stop=(3.0, -0.9), heading=1.0, **SIZE),
    "in segments": nav.MovingRectangle.from_segments((2.0, -2.0), LEGS, heading=-0.7, **SIZE),
    "recorded": nav.MovingRectangle.from_path(*RECORDED, heading=2.0, **SIZE),
}


def scene(*boxes: nav.Obstacle, **fields: Any) -> nav.Scenario:
    given = {"start": (0.0, 0.0), "goal": (5.0, 0.3), "time_limit": 20.0, **fields}
    return nav.Scenario(obstacles=boxes, **given)


def corners(box: nav.MovingRectangle, center: np.ndarray) -> np.ndarray:
    cos, sin = math.cos(box.heading), math.sin(box.heading)
    half = 0.5 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * [box.length, box.width]
    return center + half @ np.array([[cos, sin], [-sin, cos]])


def from_polygon(polygon: np.ndarray, point: np.ndarray) -> float:
    """Distance of a point from the sides, 0 inside: nothing of the frame of the rectangle is used."""
    after = np.roll(polygon, -1, axis=0)
    along, away = after - polygon, point - polygon
    if np.all(along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0] >= 0.0):
        return 0.0
    share = np.clip((away * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    return float(np.linalg.norm(polygon + share[:, None] * along - point, axis=1).min())


def place_at(box: nav.MovingRectangle, time: float) -> np.ndarray:
    """Where a rectangle is, by small steps of its segments or linear in its recording."""
    if box.path is not None:
        instants, places = (np.asarray(each) for each in box.path)
        outside = not instants[0] <= time <= instants[-1]
        return np.array([math.nan if outside else np.interp(time, instants, places[:, axis]) for axis in (0, 1)])
    start = np.asarray(box.center)
    if box.segments is None:
        velocity, gained = np.asarray(box.velocity), np.asarray(box.acceleration)
        if box.stop is not None:
            way = min(time * np.linalg.norm(velocity), math.dist(box.center, box.stop))
            return start + velocity / np.linalg.norm(velocity) * way
        return start + velocity * time + 0.5 * gained * time**2
    left = time
    for number, (duration, velocity, acceleration) in enumerate(box.segments):
        spent = min(left, duration)
        start = start + np.asarray(velocity) * spent + 0.5 * np.asarray(acceleration) * spent**2
        left -= spent
        if number + 1 == len(box.segments):
            start = start + (np.asarray(velocity) + np.asarray(acceleration) * duration) * left
    return start


@pytest.mark.parametrize("box", MOTIONS.values(), ids=MOTIONS.keys())
def test_distances_are_those_of_brute_force(box: nav.MovingRectangle) -> None:
    run = nav.simulate(scene(box), FIELD)
    for row in range(0, len(run.time), 7):
        center = place_at(box, float(run.time[row]))
        np.testing.assert_allclose(run.obstacle_position[row, 0], center, atol=1e-9)
        if np.isfinite(center).all():
            assert run.distance[row, 0] == pytest.approx(
                from_polygon(corners(box, center), run.position[row]), abs=1e-9
            )
    there = run.distance[np.isfinite(run.distance[:, 0]), 0]
    assert run.min_clearance[0] <= there.min() - 0.2 + 1e-12


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_every_law_meets_them_and_every_verb_gives_the_same_run(law: nav.Law) -> None:
    met = scene(MOTIONS["straight"], time_limit=12.0)
    run = nav.simulate(met, law)
    assert run.outcome in {"arrived", "collided", "timed_out", "stopped"}
    if isinstance(law, SafeNavigation):
        assert run.outcome == "arrived"
    table = nav.simulate_batch([met] * 3, law)
    assert list(table.outcome) == [run.outcome] * 3
    assert list(table.end_time) == [run.time[-1]] * 3
    np.testing.assert_array_equal(table.min_clearance, [run.min_clearance.min()] * 3)
    steps = nav.Run(met, law)
    while not steps.finished:
        steps.step()
    np.testing.assert_array_equal(steps.trajectory.position, run.position)


def turned(place: Any, change: np.ndarray, shift: np.ndarray) -> tuple[float, float]:
    x, y = change @ np.asarray(place) + shift
    return float(x), float(y)


CHANGES: dict[str, tuple[np.ndarray, np.ndarray, Callable[[float], float]]] = {
    "moved": (np.eye(2), np.array([3.0, -7.0]), lambda heading: heading),
    "turned": (np.array([[0.0, -1.0], [1.0, 0.0]]), np.zeros(2), lambda heading: heading + 0.5 * math.pi),
    "mirrored": (np.array([[1.0, 0.0], [0.0, -1.0]]), np.zeros(2), lambda heading: -heading),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
@pytest.mark.parametrize(
    "name", ["field", "stabilized", "khatib", "ge and cui", "borenstein", "velocity obstacle", "safe orca"]
)
def test_a_moved_turned_or_mirrored_scene_has_the_same_run(
    name: str, change: tuple[np.ndarray, np.ndarray, Callable[[float], float]]
) -> None:
    matrix, shift, heading = change
    box = MOTIONS["straight"]
    law = replace(ORCA, turn=0.0) if name == "safe orca" else LAWS[name]
    law = SafeNavigation(law, shield=Shield(person_speed=1.0)) if name == "safe orca" else law
    other = replace(
        box,
        center=turned(box.center, matrix, shift),
        velocity=turned(box.velocity, matrix, np.zeros(2)),
        heading=heading(box.heading),
    )
    first = scene(box, time_limit=6.0)
    second = replace(
        first,
        start=turned(first.start, matrix, shift),
        goal=turned(first.goal, matrix, shift),
        heading=heading(0.0),
        obstacles=[other],
    )
    one, two = (nav.simulate(each, law) for each in (first, second))
    rows = min(len(one.time), len(two.time), 200)
    expected = one.position[:rows] @ matrix.T + shift
    np.testing.assert_allclose(two.position[:rows], expected, atol=2e-6)


def test_regions_reckon_with_the_speed() -> None:
    robot = nav.HolonomicRobot()
    box, still = MOTIONS["straight"], nav.Rectangle(center=(2.5, -2.0), **SIZE)
    speed, period, stopping = math.hypot(0.1, 0.7), 0.06, robot.max_speed / robot.max_acceleration
    found, alike = nav.region_radii(robot, box), nav.region_radii(robot, still)
    assert found.critical_radius == pytest.approx(alike.critical_radius + speed * (stopping + period))
    more = (found.critical_radius - alike.critical_radius) / robot.max_speed
    waiting = alike.active_radius / robot.max_speed
    assert found.active_radius == pytest.approx((robot.max_speed + speed) * (waiting + more))
    assert nav.region_radii(robot, replace(box, velocity=(0.0, 0.0))) == alike
    assert nav.region_radii(robot, replace(box, max_speed=1.5)).critical_radius > found.critical_radius


def test_a_rectangle_that_has_no_velocity_is_one_that_stands() -> None:
    moving = nav.MovingRectangle(center=(2.5, 0.1), velocity=(0.0, 0.0), heading=0.3, **SIZE)
    standing = nav.Rectangle(center=(2.5, 0.1), heading=0.3, **SIZE)
    for law in LAWS.values():
        one, two = (nav.simulate(scene(box, time_limit=4.0), law) for box in (moving, standing))
        np.testing.assert_array_equal(one.position, two.position)


def test_a_robot_that_stands_is_walked_into_and_is_not_at_fault() -> None:
    box = nav.MovingRectangle(center=(3.0, 0.0), velocity=(-0.5, 0.0), **SIZE)
    alone = SafeNavigation(FIELD, shield=Shield(), preferred_speed=1e-6)
    run = nav.simulate(scene(box, time_limit=8.0), alone)
    assert run.contact_time[0] == pytest.approx((3.0 - 0.6 - 0.2) / 0.5, abs=0.03)
    table = nav.simulate_many(scene(box, time_limit=8.0), alone, seeds=1)
    assert (table.contacts_standing[0], table.contacts_at_fault[0]) == (1, 0)


def crossings(count: int, seed: int) -> list[nav.Scenario]:
    """Random rectangles that cross the way."""
    draws = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        boxes = []
        for _ in range(4):
            course, speed = draws.uniform(-math.pi, math.pi), draws.uniform(0.2, 1.0)
            velocity = (speed * math.cos(course), speed * math.sin(course))
            middle, when = draws.uniform([1.5, -1.0], [4.0, 1.0]), draws.uniform(1.0, 6.0)
            center = tuple((middle - np.array(velocity) * when).tolist())
            if math.hypot(*center) > 1.6:
                sides = {"length": draws.uniform(0.3, 1.5), "width": draws.uniform(0.2, 0.8)}
                heading = draws.uniform(-3.0, 3.0)
                boxes.append(nav.MovingRectangle(center=center, velocity=velocity, heading=heading, **sides))
        found.append(scene(*boxes))
    return found


BLIND = nav.Khatib(repulsive_gain=0.0)


@pytest.mark.parametrize(
    "law", [ORCA, nav.VelocityObstacle(margin=0.0), FIELD, BLIND], ids=["orca", "vo", "field", "blind"]
)
def test_a_shield_is_never_at_fault_among_rectangles(law: nav.Law) -> None:
    scenes = crossings(40, 1)
    table = nav.simulate_many(scenes, SafeNavigation(law, shield=Shield(person_speed=1.0)))
    assert table.contacts_at_fault.sum() == 0


@pytest.mark.parametrize("wheels", [True, False])
def test_a_shield_of_an_outline_is_never_at_fault_among_rectangles(wheels: bool) -> None:
    """With the disc around each rectangle in its place the robot was at fault in three of these scenes."""
    footprint = nav.robots.Footprint.rectangle(0.508, 0.430)
    kind = nav.DifferentialDriveRobot if wheels else nav.HolonomicRobot
    drawn = crossings(200, 8)
    scenes = [replace(drawn[index], robot=kind(footprint=footprint)) for index in (63, 133, 148, *range(25))]
    shield = Shield(person_speed=1.6)
    for law in (SafeNavigation(ORCA, shield=shield, yielding=Yielding()), SafeNavigation(BLIND, shield=shield)):
        assert nav.simulate_many(scenes, law).contacts_at_fault.sum() == 0


def test_a_shield_that_assumes_slower_rectangles_is_at_fault() -> None:
    """The check above can fail."""
    table = nav.simulate_many(crossings(40, 1), SafeNavigation(BLIND, shield=Shield(person_speed=0.0)))
    assert table.contacts_at_fault.sum() > 0


def test_a_pursuer_among_rectangles_finds_no_fault() -> None:
    place = scene(MOTIONS["straight"], time_limit=8.0)
    assert not falsify(place, SafeNavigation(ORCA, shield=Shield(person_speed=1.6)), episodes=60, seed=2).broken
    assert falsify(place, BLIND, episodes=20, seed=2).broken


def test_the_guide_plans_around_a_rectangle_that_has_stopped() -> None:
    walls = StaticMap.from_polylines([[(2.5, 0.6), (2.5, 4.0)], [(2.5, -0.6), (2.5, -1.2)]])
    gate = nav.MovingRectangle(center=(2.5, 2.2), velocity=(0.0, -1.0), stop=(2.5, 0.0), length=0.2, width=1.3)
    place = scene(gate, time_limit=40.0)
    law = SafeNavigation(FIELD, map=walls, guide=Guide(), shield=Shield(person_speed=1.0))
    run = nav.simulate(place, law)
    assert run.outcome == "arrived"
    assert run.position[:, 1].min() < -1.3, "the passage is closed: the way leads around the lower wall"
    assert run.min_clearance[0] > 0.0


def test_a_controller_and_a_law_in_python_are_told_of_them() -> None:
    seen: list[Any] = []

    def command(situation: nav.laws.Situation) -> tuple[float, float]:
        seen.append(situation)
        return (1.0, 0.0)

    nav.simulate(scene(MOTIONS["straight"], time_limit=0.5), command)
    np.testing.assert_allclose(seen[0].obstacle_size, [[1.2, 0.6]])
    np.testing.assert_allclose(seen[-1].obstacle_velocity, [[0.1, 0.7]])
    assert seen[0].obstacle_heading[0] == pytest.approx(0.4)


def test_files_hold_every_motion(tmp_path: Path) -> None:
    head = "start = [0, 0]\ngoal = [5, 0.3]\ntime_limit = 20\n"
    rows = {
        "straight": "center = [2.5, -2.0]\nvelocity = [0.1, 0.7]\nheading = 0.4\n",
        "accelerating": "center = [2.5, -2.0]\nvelocity = [0.0, 0.3]\nacceleration = [0.1, 0.1]\n",
        "stopping": "center = [3.0, -2.0]\nvelocity = [0.0, 0.5]\nstop = [3.0, -0.9]\nheading = 1.0\n",
        "recorded": "time = [0, 1, 3, 5]\nposition = [[2.5, -2], [2.5, -1], [3, 0.5], [1, 2.5]]\nheading = 2.0\n",
    }
    for name, row in rows.items():
        file = tmp_path / f"{name}.toml"
        file.write_text(f"{head}[[obstacles]]\ntype = 'moving_rectangle'\nlength = 1.2\nwidth = 0.6\n{row}")
        assert scenarios.load(file).scenario == scene(MOTIONS[name]), name
    file.write_text(f"{head}[[obstacles]]\ntype = 'moving_rectangle'\nlength = 1.2\n{rows['straight']}")
    with pytest.raises(InvalidParameterError, match=r"obstacles\[0\]\.width must be given"):
        scenarios.load(file)


def test_pictures_draw_them(tmp_path: Path) -> None:
    run = nav.simulate(scene(*MOTIONS.values()), FIELD)
    for figure in (plotting.layout(run.scenario), plotting.paths([run]), plotting.time_sequence(run)):
        assert figure.axes[0].patches
    assert plotting.animate(run, tmp_path / "run.gif", frames_per_second=2).stat().st_size > 1000
