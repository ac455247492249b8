"""A log is judged by the outline of the robot: against shapely, against the disc, and as a player shows it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import affinity
from shapely.geometry import LineString, Point, Polygon

from hrsafety import datasets
from hrsafety import navigation as nav

CORNERS = ((0.5, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.5, -0.2))
ROBOT = nav.DifferentialDriveRobot(footprint=CORNERS)
TIME = np.arange(81) / 10.0


def log_of(person: np.ndarray, *, turn: float = 0.3, heading: float = 0.0) -> Any:
    """Return a log of a robot that drives straight on while it turns, and of one person."""
    walk = datasets.Recording(time_s=TIME, person=[7] * len(TIME), position=person)
    place = np.stack([0.5 * TIME, 0.0 * TIME], axis=1)
    return SimpleNamespace(time=TIME, position=place, heading=heading + turn * TIME, people=walk)


def outline_at(found: nav.metrics.Judgement, row: int) -> Polygon:
    """Return the robot at an instant, by shapely."""
    turned = affinity.rotate(Polygon(CORNERS), found.heading[row], origin=(0.0, 0.0), use_radians=True)
    return affinity.translate(turned, *found.position[row])


@settings(max_examples=20, deadline=None)
@given(turn=st.floats(-0.6, 0.6), offset=st.floats(0.3, 1.2), speed=st.floats(-0.4, 0.4), heading=st.floats(-3.0, 3.0))
def test_clearances_are_those_of_the_polygon(turn: float, offset: float, speed: float, heading: float) -> None:
    person = np.stack([3.0 + speed * TIME, np.full_like(TIME, offset)], axis=1)
    found = nav.metrics.judge(log_of(person, turn=turn, heading=heading), robot=ROBOT, person_radius=0.2)
    for row in range(0, len(found.time), 7):
        away = outline_at(found, row).distance(Point(found.obstacle_position[row, 0])) - 0.2
        if away > -0.15:
            assert found.clearance[row, 0] == pytest.approx(away, abs=1e-9)
    people = found.obstacle_position[:, 0]
    near = min(outline_at(found, row).distance(Point(place)) for row, place in enumerate(people))
    assert bool(found.contacts) or near - 0.2 > -1e-6 or near == 0.0
    assert not found.contacts or near - 0.2 < 0.1


def test_a_person_beside_the_robot_within_the_circle_is_no_contact_and_a_corner_is_one() -> None:
    # The circle around the outline reaches 0.54 m, its sides 0.2 m.
    beside = np.stack([2.0 + 0.0 * TIME, np.full_like(TIME, 0.5)], axis=1)
    straight = log_of(beside, turn=0.0)
    by_outline = nav.metrics.judge(straight, robot=ROBOT, person_radius=0.2)
    by_disc = nav.metrics.judge(straight, robot=ROBOT, robot_radius=ROBOT.radius, person_radius=0.2)
    assert (by_outline.counts["contact"], by_disc.counts["contact"]) == (0, 1)
    assert by_outline.clearance[:, 0].min() == pytest.approx(0.1, abs=1e-3)
    assert by_outline.metrics.min_clearance == pytest.approx(0.1, abs=1e-3)
    assert [each.code for each in by_outline.warnings].count("circle_around_footprint") == 1
    turning = nav.metrics.judge(log_of(beside, turn=0.35), robot=ROBOT, person_radius=0.2)
    assert turning.counts["contact"] == 1
    assert turning.contacts[0].kind == "toward"


def test_walls_are_those_of_the_polygon_between_instants_too() -> None:
    far = np.stack([50.0 + 0.0 * TIME, np.full_like(TIME, 50.0)], axis=1)
    wall = nav.StaticMap.from_polylines([[(-1.0, 0.35), (6.0, 0.35)]])
    aligned = nav.metrics.judge(log_of(far, turn=0.0), robot=ROBOT, map=wall)
    assert aligned.counts["wall_contact"] == 0
    assert np.nanmin(aligned.wall_clearance) == pytest.approx(0.15, abs=1e-3)
    turning = nav.metrics.judge(log_of(far, turn=0.4), robot=ROBOT, map=wall)
    assert turning.counts["wall_contact"] == 1
    line = LineString([(-1.0, 0.35), (6.0, 0.35)])
    rows = range(0, len(turning.time), 5)
    for row in rows:
        away = outline_at(turning, row).distance(line)
        if away > 0.0:
            assert turning.wall_clearance[row] == pytest.approx(away, abs=1e-9)


def test_a_player_of_a_judged_log_shows_the_outline() -> None:
    person = np.stack([3.0 + 0.0 * TIME, np.full_like(TIME, 0.9)], axis=1)
    found = nav.metrics.judge(log_of(person), robot=ROBOT)
    assert found.footprint == ROBOT.footprint
    assert tuple(found._replay().robots[0].footprint) == CORNERS
    assert nav.metrics.judge(log_of(person), robot=ROBOT, robot_radius=0.4).footprint is None


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        ("nothing", False),
        ("backward", False),
        ("columns exchanged", True),
        ("degrees", True),
        ("columns exchanged, holonomic", False),
    ],
)
def test_two_wheels_that_move_sideways_are_doubted(spoil: str, told: bool) -> None:
    angle = 0.3 + 0.02 * TIME
    way = np.cumsum(np.stack([0.05 * np.cos(angle), 0.05 * np.sin(angle)], axis=1), axis=0)
    heading = {"backward": angle + np.pi, "degrees": np.degrees(angle)}.get(spoil, angle)
    place = way[:, ::-1] if "exchanged" in spoil else way
    walk = datasets.Recording(time_s=TIME, person=[7] * len(TIME), position=np.full((len(TIME), 2), 9.0))
    log = SimpleNamespace(time=TIME, position=place, heading=heading, people=walk)
    robot = nav.HolonomicRobot(footprint=CORNERS) if "holonomic" in spoil else ROBOT
    found = nav.metrics.judge(log, robot=robot, person_radius=0.2)
    assert ("sideways" in [each.code for each in found.warnings]) == told
