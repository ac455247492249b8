"""Scenarios and worlds as places, and pictures of runs that take those of worlds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import InvalidParameterError, plotting, scenarios
from hrsafety import navigation as nav

FIELD, ORCA = nav.VirtualForceField(), nav.OptimalReciprocalCollisionAvoidance()
ROOM = nav.StaticMap.from_polylines([[(-1, -2), (9, -2), (9, 2), (-1, 2), (-1, -2)]])
WALKER = nav.Person(start=(8, 0.3), route=[(0, 0.3)], desired_speed=1.2)
ROBOT = nav.Robot(start=(0, 0), goal=(8, 0))
OTHER = nav.Robot(start=(8, -1), goal=(0, -1), law=nav.Khatib(), control_period=0.1)
NOISE = nav.Measurement(of="both", latency=0.075)
AMONG = nav.World(people=[WALKER], robots=[ROBOT], walls=ROOM, time_limit=15.0)

# ---- pictures -------------------------------------------------------------------------------


def test_pictures_of_runs_take_the_run_of_a_robot_of_a_world() -> None:
    world = nav.World(people=[WALKER], robots=[ROBOT, OTHER], walls=ROOM, time_limit=20.0)
    run = nav.simulate(world, ORCA)
    figure = plotting.paths(run.robots[0])
    labels = {each.get_text() for each in figure.legends[0].get_texts()}
    assert {"person", "moving disc", "map"} <= labels
    lines = plotting.distances(run.robots[0]).axes[0].get_lines()
    drawn = [line for line in lines if str(line.get_label()).startswith("person")]
    np.testing.assert_array_equal(np.asarray(drawn[0].get_ydata()), run.robots[0].distance[:, 0])
    assert plotting.time_sequence(run.robots[0], instants=3).axes
    assert plotting.layout(AMONG).axes
    for draw in (plotting.energy, plotting.lyapunov):
        with pytest.raises(InvalidParameterError, match="be the run of a scenario"):
            draw(run.robots[0])
    with pytest.raises(InvalidParameterError, match=r"take run.robots\[i\]"):
        plotting.paths(run)
    with pytest.raises(InvalidParameterError, match=r"scenario.robots must be one"):
        plotting.layout(world)
    with pytest.raises(InvalidParameterError, match="does not repeat itself"):
        plotting.paths(nav.simulate(replace(AMONG, walls=(), period=(20.0, 0.0)), ORCA))


def test_a_person_who_never_comes_is_not_drawn_and_walls_that_no_law_knows_are() -> None:
    late = replace(WALKER, enters=100.0)
    run = nav.simulate(nav.World(people=[late, WALKER], robots=[ROBOT], walls=ROOM, time_limit=5.0), ORCA)
    assert len(plotting.paths(run).axes) == 1
    scene = replace(scenarios.configuration("c1"), walls=nav.StaticMap.from_polylines([[(-1, 2), (5, 2)]]))
    labels = {each.get_text() for each in plotting.paths(nav.simulate(scene, FIELD)).legends[0].get_texts()}
    assert "map" in labels


# ---- scenarios as worlds --------------------------------------------------------------------


def test_scenarios_and_worlds_are_places() -> None:
    scene = replace(scenarios.configuration("c3"), measurement=NOISE, seed=9, time_limit=30.0)
    world = nav.World.of(scene)
    assert isinstance(scene, nav.Place)
    assert isinstance(world, nav.Place)
    assert nav.World.of(world) is world
    (robot,) = world.robots
    assert (robot.start, robot.goal, robot.measurement) == (scene.start, scene.goal, NOISE)
    assert (world.seed, world.time_limit, robot.control_period) == (9, 30.0, scene.control_period)
    standing = sum(isinstance(each, nav.Disc | nav.Rectangle) for each in scene.obstacles)
    assert (len(world.wall_shapes), len(world.people)) == (standing, len(scene.obstacles) - standing)
    assert not any(each.reacts for each in world.people)
    walled = nav.World.of(replace(scene, walls=nav.StaticMap.from_polylines([[(-9, -9), (9, -9)]])))
    assert isinstance(walled.walls, nav.StaticMap)
    cart = nav.MovingRectangle(center=(3, 3), velocity=(0, -0.1), length=0.9, width=0.5)
    with pytest.raises(InvalidParameterError, match=r"obstacles\[0\] must be a"):
        nav.World.of(replace(scene, obstacles=[cart]))


@given(
    st.lists(st.tuples(st.floats(-3, 3), st.floats(1.0, 3.0), st.floats(-0.8, 0.8), st.floats(-0.8, 0.8)), max_size=4),
    st.floats(2.0, 5.0),
)
@settings(max_examples=15, deadline=None)
def test_a_robot_drives_in_the_world_of_a_scenario_as_in_the_scenario(
    walkers: list[tuple[float, float, float, float]], far: float
) -> None:
    people = [nav.Human(start=(x, y), velocity=(u, v), radius=0.3) for x, y, u, v in walkers]
    scene = nav.Scenario(start=(0, 0), goal=(far, 0), obstacles=people, time_limit=20.0, rest_time=60.0)
    alone, among = nav.simulate(scene, ORCA), nav.simulate(nav.World.of(scene), ORCA)
    rows = min(len(alone.time), len(among.time)) - 1
    np.testing.assert_allclose(among.position[:rows], alone.position[:rows], atol=1e-9)
    np.testing.assert_allclose(among.obstacle_position[:rows], alone.obstacle_position[:rows], atol=1e-9)
