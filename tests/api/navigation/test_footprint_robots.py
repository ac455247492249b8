"""Robots with a footprint: contacts, clearances, shield and guide of the polygon; shapely as another witness."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import shapely
from shapely import affinity

from hrsafety import io, scenarios
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError

Array = npt.NDArray[np.float64]
RECTANGLE = nav.robots.Footprint.rectangle(0.508, 0.430)
WEDGE = nav.robots.Footprint(((0.5, 0.0), (-0.2, 0.3), (-0.3, -0.25)))


def placed(footprint: nav.robots.Footprint, position: Array, heading: float) -> shapely.Polygon:
    turned = affinity.rotate(shapely.Polygon(footprint.corners), heading, origin=(0.0, 0.0), use_radians=True)
    return affinity.translate(turned, *position)


class Wandering:
    """Commands that turn and drive a robot about, whoever is there."""

    def velocity(self, situation: nav.laws.Situation) -> tuple[float, float]:
        angle = 2.5 * situation.time
        return 0.5 * math.cos(angle), 0.5 * math.sin(angle)


class Standing:
    """Commands to stay."""

    def velocity(self, _situation: nav.laws.Situation) -> tuple[float, float]:
        return 0.0, 0.0


class Ahead:
    """Commands to drive straight on."""

    def velocity(self, _situation: nav.laws.Situation) -> tuple[float, float]:
        return 0.5, 0.0


def scene(footprint: nav.robots.Footprint, obstacles: list[nav.Obstacle], *, two: bool = True) -> nav.Scenario:
    kind = nav.DifferentialDriveRobot if two else nav.HolonomicRobot
    return nav.Scenario(
        robot=kind(footprint=footprint), start=(0, 0), goal=(9, 0), obstacles=obstacles, heading=0.4, time_limit=4.0
    )


@pytest.mark.parametrize("footprint", [RECTANGLE, WEDGE])
@pytest.mark.parametrize("two", [True, False])
def test_distances_are_those_of_another_library(footprint: nav.robots.Footprint, two: bool) -> None:
    people = [nav.Human(start=(1.6, 1.4 - i), velocity=(-0.7, -0.3 + 0.3 * i), radius=0.3) for i in range(3)]
    table = nav.Rectangle(center=(0.3, -0.9), length=0.6, width=0.3, heading=0.5)
    run = nav.simulate(scene(footprint, [*people, table], two=two), Wandering())
    found = np.array(run.distance) - run.scenario.robot.radius - np.array([0.3, 0.3, 0.3, 0.0])
    box = affinity.rotate(shapely.box(0.0, -1.05, 0.6, -0.75), 0.5, origin=(0.3, -0.9), use_radians=True)
    touched = np.zeros(4, dtype=bool)
    for row in range(0, len(run.time), 7):
        body = placed(footprint, run.position[row], run.heading[row])
        for person in range(3):
            center = shapely.Point(run.obstacle_position[row, person])
            inside = body.contains(center)
            gap = (-body.exterior.distance(center) if inside else body.distance(center)) - 0.3
            assert found[row, person] == pytest.approx(gap, abs=1e-9)
            touched[person] |= gap < 0.0
        gap = body.distance(box)
        assert max(found[row, 3], 0.0) == pytest.approx(gap, abs=1e-9)
        touched[3] |= gap == 0.0
    assert (np.isfinite(run.contact_time) >= touched).all()
    # Contacts between rows are less deep than what moves in a step.
    assert (run.min_clearance <= found.min(axis=0) + 1e-9).all()


def test_what_passes_between_two_steps_is_touched() -> None:
    bullet = nav.MovingDisc(center=(0.24, 5.1), velocity=(0.0, -40.0), radius=0.02, max_speed=40.0)
    stands = replace(scene(RECTANGLE, [bullet]), heading=0.0, time_limit=0.3)
    run = nav.simulate(stands, Standing(), step=0.02)
    assert run.outcome == "collided"
    assert not run.contact_at_fault[0]
    assert run.contact_time[0] == pytest.approx((5.1 - 0.02 - 0.215) / 40.0, abs=1e-6)
    beside = replace(bullet, center=(0.28, 5.1))
    assert not np.isfinite(nav.simulate(replace(stands, obstacles=[beside]), Standing(), step=0.02).contact_time).any()


def test_a_corner_that_sweeps_into_a_person_is_at_fault_and_who_walks_into_a_side_is_not() -> None:
    robot = nav.DifferentialDriveRobot(footprint=RECTANGLE)
    beside = nav.Human(start=(-0.05, 0.56), velocity=(0.0, 0.0), radius=0.3)
    turning = nav.Scenario(robot=robot, start=(0, 0), goal=(0, 9), obstacles=[beside], time_limit=2.0)
    run = nav.simulate(turning, nav.OptimalReciprocalCollisionAvoidance())
    assert run.outcome == "collided"
    assert run.contact_toward[0]
    assert run.contact_at_fault[0]
    shielded = nav.simulate(turning, nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield()))
    assert not np.isfinite(shielded.contact_time).any()
    walks_in = nav.Human(start=(0.5, -1.5), velocity=(0.0, 1.4), radius=0.3)
    aside = replace(turning, goal=(9.0, 0.0), obstacles=[walks_in], time_limit=3.0)
    run = nav.simulate(aside, Ahead())
    assert run.outcome == "collided"
    assert not run.contact_at_fault[0]


def test_a_footprint_is_told_in_the_ways_of_others() -> None:
    text = "[[0.3, 0.2], [0.3, 0.0], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]"
    robot = nav.DifferentialDriveRobot(footprint=text)  # type: ignore[arg-type]  # text is one of its forms
    assert robot.footprint is not None
    assert robot.footprint.inner_radius == 0.2
    clockwise = nav.DifferentialDriveRobot(footprint=tuple(reversed(RECTANGLE.corners)))  # type: ignore[arg-type]
    assert clockwise.radius == RECTANGLE.outer_radius
    disc = nav.HolonomicRobot(footprint=0.35)  # type: ignore[arg-type]
    assert disc.footprint is None
    assert disc == nav.HolonomicRobot(radius=0.35)
    copied = replace(robot, mass=9.0)
    assert copied.footprint == robot.footprint
    assert copied.radius == robot.radius


@pytest.mark.parametrize(
    "given",
    [
        {"footprint": RECTANGLE, "radius": 0.3},
        {"footprint": 0.3, "radius": 0.25},
        {"footprint": "[[0.3, 0.2], [0.3, -0.2]]"},
        {"footprint": "0.3 0.2"},
        {"footprint": "[[0.3, nan], [0.3, -0.2], [-0.3, 0.0]]"},
        {"footprint": [(0.1, 0.1), (0.5, 0.1), (0.5, 0.5), (0.1, 0.5)]},
        {"footprint": [(0.3, 0.2), (0.05, 0.0), (0.3, -0.2), (-0.3, -0.2), (-0.3, 0.2)]},
        {"footprint": [(0.3, 0.2), (-0.3, -0.2), (-0.3, 0.2), (0.3, -0.2)]},
        {"footprint": object()},
        {"footprint": True},
        {"footprint": -0.3},
    ],
)
def test_footprints_that_are_none_are_refused(given: dict[str, object]) -> None:
    with pytest.raises(InvalidParameterError):
        nav.DifferentialDriveRobot(**given)  # type: ignore[arg-type]


def test_a_start_is_in_contact_by_the_polygon() -> None:
    beside = nav.Human(start=(0.0, 0.53), velocity=(0.0, 0.0), radius=0.3)
    robot = nav.HolonomicRobot(footprint=RECTANGLE)
    nav.Scenario(robot=robot, start=(0, 0), goal=(4, 0), obstacles=[beside])
    with pytest.raises(InvalidParameterError, match="overlaps it by"):
        nav.Scenario(robot=robot, start=(0, 0), goal=(4, 0), obstacles=[beside], heading=math.pi / 2.0)
    wall = nav.StaticMap.from_polylines([[(-1, 0.25), (1, 0.25)]])
    nav.Scenario(robot=robot, start=(0, 0), goal=(4, 0), walls=wall)
    with pytest.raises(InvalidParameterError, match="footprint"):
        nav.Scenario(robot=robot, start=(0, 0), goal=(4, 0), walls=wall, heading=math.pi / 2.0)


def test_a_rectangle_drives_through_a_gap_that_its_circle_does_not_fit() -> None:
    gap = nav.StaticMap.from_polylines(
        [[(2, 3), (2, 0.26), (3, 0.26), (3, 3)], [(2, -3), (2, -0.26), (3, -0.26), (3, -3)]]
    )
    law = nav.SafeNavigation(nav.VirtualForceField(), map=gap, guide=nav.Guide(), shield=nav.Shield())
    robot = nav.DifferentialDriveRobot(footprint=RECTANGLE, max_acceleration=2.0)
    place = nav.Scenario(robot=robot, start=(0, 0), goal=(5, 0), walls=gap, arrival_tolerance=0.3)
    run = nav.simulate(place, law)
    assert run.outcome == "arrived"
    assert run.map_clearance > 0.0
    assert not math.isfinite(run.map_contact_time)
    disc = replace(place, robot=nav.DifferentialDriveRobot(radius=RECTANGLE.outer_radius))
    with pytest.raises(InvalidParameterError):
        nav.simulate(replace(disc, start=(2.5, 0.0)), law)


def test_runs_of_a_robot_in_a_world_are_those_of_the_polygon() -> None:
    robot = nav.Robot(nav.DifferentialDriveRobot(footprint=RECTANGLE), start=(0, 0), goal=(6, 0), law=Wandering())
    walker = nav.Person.moving(nav.Human(start=(2.0, 0.8), velocity=(-0.6, -0.2), radius=0.3))
    world = nav.World(people=[walker], robots=[robot], step=0.02, time_limit=5.0)
    run = nav.simulate(world)
    gaps = []
    for row in range(len(run.time)):
        body, center = placed(RECTANGLE, run.position[row], run.heading[row]), run.obstacle_position[row, 0]
        point = shapely.Point(center)
        gaps.append((-body.exterior.distance(point) if body.contains(point) else body.distance(point)) - 0.3)
    shown = run.distance[:, 0] - run.scenario.robots[0].body.radius - 0.3
    assert shown == pytest.approx(np.array(gaps), abs=1e-9)
    assert run.min_clearance[0] == pytest.approx(min(gaps), abs=2e-3)
    touched = min(gaps) < 0.0
    assert np.isfinite(run.contact_time[0]) == touched
    assert (run.outcome == "collided") == touched
    scored = nav.metrics.evaluate(nav.metrics.Episode.from_trajectory(run))
    assert scored.min_clearance == pytest.approx(min(gaps), abs=2e-3)


def test_the_results_say_what_stands_for_the_footprint() -> None:
    person = nav.Person(start=(3.0, 0.5), route=[(-1.0, 0.5)])
    robot = nav.Robot(nav.HolonomicRobot(footprint=RECTANGLE), start=(0, 0), goal=(4, 0), law=nav.VirtualForceField())
    world = nav.World(people=[person], robots=[robot])
    told = {each.code: each.safe_side for each in nav.simulate(world).warnings}
    assert told["circle_around_footprint"] is True
    assert told["people_avoid_circle"] is False
    run = nav.simulate(replace(scene(RECTANGLE, []), time_limit=30.0), nav.VirtualForceField())
    assert [each.code for each in run.warnings] == ["circle_around_footprint"]
    with pytest.raises(InvalidParameterError, match="footprint"):
        nav.simulate(scene(RECTANGLE, [], two=False), nav.VirtualForceField(), integrator="rk4")


@pytest.mark.parametrize("two", [True, False])
def test_nobody_brings_a_rectangle_under_a_shield_to_fault(two: bool) -> None:
    place = replace(scene(RECTANGLE, [], two=two), goal=(6.0, 0.0), heading=0.0, time_limit=10.0)
    law = nav.OptimalReciprocalCollisionAvoidance(horizon=2.0, margin=0.0)
    guarded = nav.SafeNavigation(law, shield=nav.Shield())
    assert nav.falsify(place, guarded, episodes=80, seed=4).share.value == 0.0
    assert nav.falsify(place, law, episodes=60, seed=2).broken or not two
    body = nav.Robot(place.robot, start=(0, 0), goal=(6, 0), law=guarded, control_period=0.06)
    world = nav.World(robots=[body], step=0.02, time_limit=8.0)
    assert not nav.falsify(world, guarded, episodes=6, seed=3).broken


def test_a_record_of_decisions_refuses_a_footprint() -> None:
    robot = nav.HolonomicRobot(footprint=nav.robots.Footprint.rectangle(0.8, 0.4))
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield())
    with pytest.raises(InvalidParameterError, match=r"scenario\.robot\.footprint must be None"):
        nav.metrics.record_safety(nav.Scenario(robot=robot, start=(0, 0), goal=(2, 0)), law)


@pytest.mark.parametrize(
    ("written", "corners"),
    [
        ("[[0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2], [0.3, -0.2]]", 4),
        ('"[[0.36, 0.01], [-0.3, 0.2], [-0.3, -0.2]]"', 3),
        ("0.25", 0),
    ],
)
def test_a_scenario_file_has_a_footprint(written: str, corners: int, tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(f'start = [0, 0]\ngoal = [3, 0]\n[robot]\ntype = "differential_drive"\nfootprint = {written}\n')
    body = scenarios.load(file).scenario.robot
    assert (0 if body.footprint is None else len(body.footprint.corners)) == corners
    assert body.radius == pytest.approx(math.hypot(0.3, 0.2) if corners else 0.25, abs=1e-3)


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ("[[0.3, 0.2], [-0.3]]", "robot.footprint[1]"),
        ("[[0.3, 0.2], [0.5, 0.2], [0.4, -0.2]]", "footprint"),
        ("[[0.3, 0.0], [-0.3, 0.2], [-0.3, -0.2]]\nradius = 0.2", "radius"),
        ("true", "robot.footprint"),
    ],
)
def test_a_footprint_of_a_scenario_file_that_is_refused(written: str, words: str, tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(f"start = [0, 0]\ngoal = [3, 0]\n[robot]\nfootprint = {written}\n")
    with pytest.raises(InvalidParameterError, match=re.escape(words)):
        scenarios.load(file)


def test_a_robot_of_nav2_settings_has_the_padded_footprint(tmp_path: Path) -> None:
    file = tmp_path / "nav2_params.yaml"
    corners = "[[0.3, 0.2], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]"
    file.write_text(
        f'local_costmap: {{local_costmap: {{ros__parameters: {{footprint: "{corners}", footprint_padding: 0.05}}}}}}\n'
        "velocity_smoother: {ros__parameters: {max_velocity: [0.5, 0.0, 2.0], max_accel: [2.5, 0.0, 3.2]}}\n"
    )
    settings = io.read_nav2(file)
    body = settings.robot(mass=20.0)
    assert body.footprint is not None
    assert np.abs(np.array(body.footprint.corners)).max(axis=0) == pytest.approx([0.35, 0.25])
    assert body.radius == pytest.approx(settings.circumscribed_radius)
    disc = settings.robot(mass=20.0, radius=0.5)
    assert (disc.footprint, disc.radius) == (None, 0.5)


AHEAD = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), foresight=nav.Foresight())


@pytest.mark.parametrize("kind", [nav.DifferentialDriveRobot, nav.HolonomicRobot])
@pytest.mark.parametrize("footprint", [RECTANGLE, WEDGE])
def test_foresight_passes_crowds_with_a_footprint_and_is_never_at_fault(
    kind: type[nav.DifferentialDriveRobot], footprint: nav.robots.Footprint
) -> None:
    robot = kind(footprint=footprint)
    late = nav.Measurement(scale=0.025, latency=0.1, of="obstacles")
    shield = nav.Shield(latency=0.1, position_error=math.hypot(0.025, 0.025))
    for measurement, law in ((None, AHEAD), (late, AHEAD.replaced(shield=shield))):
        drawn = scenarios.random_traffic_batch(range(60_000, 60_006), obstacles=12)
        scenes = [replace(each, robot=robot, measurement=measurement) for each in drawn]
        table = nav.simulate_many(scenes, [law], stop_on_contact=True)
        assert (table.outcome == "arrived").sum() >= 5
        assert not table.contacts_at_fault.any()


def test_foresight_commands_what_the_shield_verifies_for_the_polygon() -> None:
    """Somebody beside a corner: the turn that the disc of half the width would take is refused."""
    beside = nav.Human(start=(-0.05, 0.56), velocity=(0.0, 0.0), radius=0.3)
    robot = nav.DifferentialDriveRobot(footprint=RECTANGLE)
    turning = nav.Scenario(robot=robot, start=(0, 0), goal=(0, 9), obstacles=[beside], time_limit=30.0)
    run = nav.simulate(turning, AHEAD)
    assert run.outcome == "arrived"
    assert run.min_clearance[0] > 0.0
    pursued = replace(turning, goal=(8.0, 0.0), obstacles=[], rest_time=30.0)
    for body in (robot, nav.HolonomicRobot(footprint=WEDGE)):
        found = nav.metrics.falsify(replace(pursued, robot=body, time_limit=8.0), AHEAD, episodes=60, seed=3)
        assert not found.broken


def test_foresight_drives_a_rectangle_through_a_gap_that_its_circle_does_not_fit() -> None:
    gap = nav.StaticMap.from_polylines([[(2, 3), (2, 0.3), (3, 0.3), (3, 3)], [(2, -3), (2, -0.3), (3, -0.3), (3, -3)]])
    robot = nav.DifferentialDriveRobot(footprint=RECTANGLE, max_acceleration=2.0)
    place = nav.Scenario(robot=robot, start=(0, 0), goal=(5, 0), walls=gap, arrival_tolerance=0.3, time_limit=60.0)
    run = nav.simulate(place, AHEAD.replaced(map=gap, guide=nav.Guide()))
    assert run.outcome == "arrived"
    assert run.map_clearance > 0.0
    bare = nav.simulate(place, AHEAD.replaced(map=gap, guide=nav.Guide(), shield=None, law=nav.Khatib()))
    assert not math.isfinite(bare.map_contact_time)


@pytest.mark.parametrize("depth", [0.1, 1.0])
@pytest.mark.parametrize("kind", [nav.DifferentialDriveRobot, nav.HolonomicRobot])
def test_foresight_lines_up_with_the_only_gap(kind: type[nav.DifferentialDriveRobot], depth: float) -> None:
    """From places and headings drawn in a room whose only way out is a gap of 0.56 m in a wall."""
    half = 0.28
    sides = [[(2, y), (2, edge), (2 + depth, edge), (2 + depth, y)] for y, edge in ((3, half), (-3, -half))]
    room = [(-2, -3), (5 + depth, -3), (5 + depth, 3), (-2, 3), (-2, -3)]
    walls = nav.StaticMap.from_polylines([*sides, room])
    body = kind(footprint=nav.robots.Footprint.rectangle(0.5, 0.43))
    scenes = []
    for seed in range(12):
        draws = np.random.default_rng([9, seed])
        start, heading = draws.uniform([-1.4, -2.4], [1.4, 2.4]), draws.uniform(-math.pi, math.pi)
        goal = (4.0 + depth, draws.uniform(-1.5, 1.5))
        turned = heading if kind is nav.DifferentialDriveRobot else 0.0
        place = nav.Scenario(robot=body, start=tuple(start), goal=goal, heading=turned, walls=walls, time_limit=60.0)
        scenes.append(place)
    table = nav.simulate_many(scenes, [AHEAD.replaced(map=walls, guide=nav.Guide())], stop_on_contact=True)
    assert (table.outcome == "arrived").sum() >= 11
    assert not (table.outcome == "collided").any()
