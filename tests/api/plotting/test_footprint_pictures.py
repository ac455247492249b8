"""Pictures and players show the outline of a robot where and as it is, and the scans that it has."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.plotting import shapes

OUTLINE = nav.robots.Footprint(((0.6, 0.2), (-0.3, 0.3), (-0.3, -0.3), (0.6, -0.2)))
WALLS = nav.StaticMap.from_polylines([[(-2.0, 2.0), (5.0, 2.0)], [(-2.0, -1.0), (5.0, -1.0)]])


def run_of(body: nav.HolonomicRobot | nav.DifferentialDriveRobot, **more: Any) -> nav.Trajectory:
    """Return a short run past a person."""
    person = nav.Human(start=(2.0, 1.2), velocity=(-0.2, 0.0), max_speed=0.5)
    scene = nav.Scenario(robot=body, start=(0.0, 0.0), goal=(3.0, 0.5), obstacles=[person], time_limit=4.0, **more)
    return nav.simulate(scene, nav.VirtualForceField())


@pytest.fixture(scope="module")
def run() -> nav.Trajectory:
    """Return a run of a robot with a footprint that turns."""
    return run_of(nav.DifferentialDriveRobot(footprint=OUTLINE), heading=0.7, walls=WALLS)


def corners(run: nav.Trajectory, row: int) -> np.ndarray:
    """Return where the corners of the robot are at a row, by complex numbers."""
    own = np.array(OUTLINE.corners) @ [1.0, 1.0j]
    placed = complex(*run.position[row]) + own * np.exp(1j * run.heading[row])
    return np.stack([placed.real, placed.imag], axis=1)


@pytest.mark.parametrize("row", [0, 150, -1])
def test_a_picture_draws_the_polygon_at_its_heading(run: nav.Trajectory, row: int) -> None:
    figure = plotting.time_sequence(run, instants=[float(run.time[row])])
    outlines = [np.asarray(patch.get_xy()) for patch in figure.axes[0].patches if hasattr(patch, "get_xy")]
    expected = corners(run, row)
    assert any(len(found) == 5 and np.allclose(found[:4], expected, atol=1e-9) for found in outlines)


def test_an_animation_moves_and_turns_it(run: nav.Trajectory) -> None:
    from hrsafety.plotting.runs import animation

    figure, axes = animation._background(run, regions=False, title=None)
    stage = animation._Stage(axes, run, ["1"], regions=False)
    stage.show(200)
    placed = stage.robot.get_transform().transform(stage.robot.get_path().vertices[:4])
    assert np.allclose(axes.transData.inverted().transform(placed), corners(run, 200), atol=1e-9)
    assert figure is axes.figure


def test_a_disc_that_stands_points_nowhere(run: nav.Trajectory) -> None:
    disc = run_of(nav.HolonomicRobot())
    assert np.isnan(shapes.look_angle(disc, 0))
    row = int(np.argmax(np.hypot(*disc.velocity.T)))
    assert shapes.look_angle(disc, row) == pytest.approx(np.arctan2(*disc.velocity[row][::-1]))
    assert shapes.look_angle(run, 100) == run.heading[100]


def test_a_player_holds_outline_heading_and_clearance_of_the_outline(run: nav.Trajectory) -> None:
    replay = run._replay()
    (robot,) = replay.robots
    assert [tuple(corner) for corner in robot.footprint] == list(OUTLINE.corners)
    assert robot.heading is run.heading
    wall = OUTLINE.clearance(WALLS, run.position, run.heading)
    person = run.distance[:, 0] - OUTLINE.outer_radius - run.scenario.obstacles[0].radius
    assert np.allclose(robot.clearance, np.minimum(wall, person), atol=1e-12)
    fixed = run_of(nav.HolonomicRobot(footprint=OUTLINE), heading=0.7)._replay().robots[0]
    assert np.allclose(fixed.heading, 0.7)


def test_a_player_holds_the_scans_of_a_run() -> None:
    lidar = nav.sensing.Lidar(map=WALLS, beams=90, range_max=5.0)
    person = nav.Human(start=(3.5, 0.5), velocity=(-0.2, 0.0), max_speed=0.5)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(1.0, 0.0), obstacles=[person], time_limit=2.0)
    run = nav.simulate(scene, nav.VirtualForceField(), built=nav.AsBuilt(sensors=[lidar]))
    page = str(plotting.player(run))
    head = json.loads(re.search(r'id="head"[^>]*>(.*?)</script>', page, re.DOTALL)[1])
    angles = np.array(head["robots"][0]["beams"])
    assert len(angles) == 90
    assert 'id="block-scan0"' in page
    exact = np.asarray(run._replay().robots[0].scan.ranges(0))
    # Straight to the left stands a wall at 2 m, to the right one at 1 m.
    for angle, away in ((np.pi / 2.0, 2.0), (-np.pi / 2.0, 1.0)):
        near = int(np.abs(angles - angle).argmin())
        assert exact[near] == pytest.approx(away / abs(np.sin(angles[near])), abs=1e-6)
    figure = plotting.time_sequence(run, instants=[0.0])
    (points,) = [line for line in figure.axes[0].get_lines() if line.get_color() == shapes.SCAN["color"]]
    places = np.stack(points.get_data(), axis=1)
    on_wall = np.isclose(places[:, 1], 2.0, atol=1e-6) | np.isclose(places[:, 1], -1.0, atol=1e-6)
    on_person = np.isclose(np.hypot(*(places - person.start).T), person.radius, atol=1e-6)
    assert (on_wall | on_person).all()
    assert len(places) == np.count_nonzero((exact > 0.0) & (exact < 5.0))
