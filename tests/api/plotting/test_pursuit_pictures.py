"""The picture of the worst episode of a search shows who touched whom, and where."""

from __future__ import annotations

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.errors import InvalidParameterError

pytest.importorskip("matplotlib")

ROOM = nav.StaticMap.from_polylines([[(-1, -2), (7, -2), (7, 2), (-1, 2), (-1, -2)]])
SCENE = nav.Scenario(start=(0, 0), goal=(6, 0), time_limit=12.0)
FIELD = nav.VirtualForceField()


def crosses(figure: object) -> list[np.ndarray]:
    """Where crosses stand on the floor."""
    (axes,) = figure.axes  # type: ignore[attr-defined]  # a Figure
    return [np.ravel(line.get_xydata()) for line in axes.lines if line.get_marker() == "X"]


def test_a_contact_with_the_person_is_crossed_where_the_surfaces_meet_first() -> None:
    found = nav.falsify(SCENE, FIELD, "clearance", episodes=50)
    worst = found.worst
    assert worst.min_clearance < 0.0
    (cross,) = crosses(plotting.runs.worst_pursuit(found, SCENE))
    overlaps = np.hypot(*(worst.position - worst.person_position).T) <= 0.2 + found.person_radius
    assert np.array_equal(cross, worst.position[int(np.argmax(overlaps))])


def test_a_wall_that_the_law_does_not_know_is_crossed_at_the_wall() -> None:
    scene = nav.Scenario(start=(0, 0), goal=(6, 0), time_limit=12.0, walls=ROOM)
    found = nav.falsify(scene, FIELD, episodes=50)
    assert found.worst.wall_contacts == 1
    cross = crosses(plotting.runs.worst_pursuit(found, scene))[-1]
    assert 0.0 <= ROOM.clearance(cross) <= 0.2


def test_nobody_touched_is_no_cross_and_worlds_are_drawn() -> None:
    law = nav.SafeNavigation(FIELD, map=ROOM, shield=nav.Shield())
    world = nav.World(robots=[nav.Robot(start=(0, 0), goal=(6, 0), law=law)], walls=ROOM, time_limit=12.0)
    found = nav.falsify(world, law, episodes=4)
    assert found.worst.contacts_toward == 0
    figure = plotting.runs.worst_pursuit(found, world, title="a walk")
    assert len(crosses(figure)) == min(1, found.worst.contacts_standing)
    with pytest.raises(InvalidParameterError, match="robots"):
        plotting.runs.worst_pursuit(found, nav.World())
