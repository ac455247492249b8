"""Outlines that are refused, and what does not depend on how they are given."""

from __future__ import annotations

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, ShapeError

SQUARE = ((0.3, 0.3), (-0.3, 0.3), (-0.3, -0.3), (0.3, -0.3))


@pytest.mark.parametrize(
    ("corners", "says"),
    [
        (SQUARE[:2], "3 to 64"),
        ((SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3]), "convex"),
        ((*SQUARE, (0.0, -0.3)), "convex"),
        (tuple((x + 1.0, y) for x, y in SQUARE), "origin"),
        ((*SQUARE[:3], (0.3, float("nan"))), "finite"),
        ((*SQUARE[:3], (0.3, float("inf"))), "finite"),
    ],
)
def test_outlines_that_are_none_are_refused(corners: tuple[tuple[float, float], ...], says: str) -> None:
    with pytest.raises(InvalidParameterError, match=says):
        nav.robots.Footprint(corners)


def test_the_order_of_corners_does_not_matter() -> None:
    places = np.random.default_rng(0).uniform(-1.0, 1.0, (50, 2))
    one, other = nav.robots.Footprint(SQUARE), nav.robots.Footprint(SQUARE[::-1])
    assert np.array_equal(one.distance(places), other.distance(places))


def test_a_robot_that_turns_in_place_moves_outward_at_its_corners_only() -> None:
    robot = nav.robots.Footprint.rectangle(0.6, 0.4)
    at_corner, at_rest = [(0.31, -0.1)], {"velocity": 0.0, "turn_rate": 0.0, "depth": 0.3}
    assert robot.room_ahead_distance(at_corner, velocity=0.0, turn_rate=1.0, depth=0.3)[0] == 0.0
    assert np.isinf(robot.room_ahead_distance(at_corner, **at_rest)[0])


def test_places_and_arcs_are_checked() -> None:
    robot = nav.robots.Footprint.rectangle(0.6, 0.4)
    with pytest.raises(ShapeError, match=r"\(n, 2\) or \(n, 4\)"):
        robot.swept_distance([(1.0, 2.0, 3.0)], distance=1.0, angle=0.0)
    with pytest.raises(InvalidParameterError, match="places must be finite"):
        robot.distance([(1.0, float("nan"))])
    with pytest.raises(InvalidParameterError, match="angle"):
        robot.swept_distance([(1.0, 2.0)], distance=1.0, angle=float("inf"))


def test_corners_beside_or_behind_have_no_distance() -> None:
    robot = {"robot_radius": 0.2, "deceleration": 2.0, "max_speed": 1.0}
    with pytest.raises(InvalidParameterError, match="leave distance out"):
        nav.laws.blind_corner_speed(0.6, 0.0, **robot)
    near = nav.laws.blind_corner_speed([0.5, 0.9], [1.0, 1.0], edge="near", **robot)
    far = nav.laws.blind_corner_speed([0.5, 0.9], [1.0, 1.0], edge="far", **robot)
    assert np.array_equal(nav.laws.blind_corner_speed([0.5, 0.9], 1.0, **robot), np.minimum(near, far))
    assert (nav.laws.blind_corner_speed([0.5, 0.9], **robot) <= far + 1e-12).all()
