"""Worlds with maps, sensors and things that move by themselves, under every verb."""

from __future__ import annotations

import itertools
import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import InvalidParameterError, sweep
from hrsafety import navigation as nav
from hrsafety.plausibility import unsafe_doubts

FIELD = nav.VirtualForceField()
ROOM = nav.StaticMap.from_polylines([[(-1, -2), (9, -2), (9, 2), (-1, 2), (-1, -2)]])
DOOR = nav.StaticMap(walls=[([(4.0, -2.0), (4.0, -0.7)], 0.1), ([(4.0, 0.7), (4.0, 2.0)], 0.1)])
CELLS = nav.StaticMap.from_grid(
    np.array([[1, 1, 0], [1, 0, 0], [0, 0, 1]], dtype=bool), resolution=0.5, origin=(3.0, -0.5)
)
WALKER = nav.Person(start=(8, 0.3), route=[(0, 0.3)], desired_speed=1.2)
ROBOT = nav.Robot(start=(0, 0), goal=(8, 0))


def codes(result: object) -> set[str]:
    return {each.code for each in unsafe_doubts(result.warnings)}  # type: ignore[attr-defined]


# ---- maps as walls --------------------------------------------------------------------------


@pytest.mark.parametrize("walls", [ROOM, ROOM + DOOR, ROOM + CELLS, nav.StaticMap(discs=[(4.0, 0.0, 0.5)]) + ROOM])
def test_people_do_not_pass_the_walls_of_a_map(walls: nav.StaticMap) -> None:
    people = [
        nav.Person(start=(0.5, y), route=[(20.0, -y)], desired_speed=1.4, model=model)
        for y, model in (
            (-1.2, nav.crowd.Moussaid()),
            (0.2, nav.crowd.SocialForce1995()),
            (1.2, nav.crowd.CollisionFreeSpeed()),
        )
    ]
    run = nav.simulate(nav.World(people=people, walls=walls, time_limit=12.0))
    places = run.obstacle_position.reshape(-1, 2)
    # A tenth of the radius is kept from the contour; a thick wall ends in corners, not round.
    assert float(np.min(walls.clearance(places))) > 0.02
    assert places[:, 0].max() < 9.0


def test_people_find_their_way_around_the_walls_of_a_map() -> None:
    wall = nav.StaticMap.from_polylines([[(4, -2), (4, 1)]]) + ROOM
    person = nav.Person(start=(1, -1), route=[(7, -1)], desired_speed=1.3)
    there = nav.simulate(nav.World(people=[person], walls=wall, time_limit=20.0))
    assert math.isfinite(there.person_arrival_time[0])
    assert there.scenario.people[0].route[-1] == (7.0, -1.0)
    world = there.scenario
    assert replace(world, seed=5).people == world.people
    straight = nav.simulate(nav.World(people=[person], walls=[[(4, -2), (4, 1)]], time_limit=20.0))
    assert math.isnan(straight.person_arrival_time[0])
    # Doors, lines, sources and those who start again.
    line = replace(person, route=[((6.5, -1.5), (6.5, -0.5)), (7, -1)], at_end="repeat")
    comes = nav.Source(low=(0, -1.5), high=(1, -0.5), rate=0.5, route=[(7, -1)])
    busy = nav.World(people=[line], sources=[comes], walls=wall, time_limit=30.0)
    assert len(busy.people[0].route) > 2
    assert len(busy.sources[0].route) > 1
    run = nav.simulate(busy)
    assert np.isfinite(run.person_arrival_time[1:]).sum() >= 5
    assert "route_blocked" not in codes(busy)
    closed = nav.StaticMap.from_polylines([[(4, -2), (4, 2)]]) + ROOM
    assert codes(nav.simulate(nav.World(people=[person], walls=closed, time_limit=1.0))) == {"route_blocked"}


@given(st.lists(st.tuples(st.floats(1.5, 6.5), st.floats(-1.4, 1.4), st.floats(0.15, 0.5)), max_size=3))
@settings(max_examples=15, deadline=None)
def test_detours_keep_off_the_walls(pillars: list[tuple[float, float, float]]) -> None:
    walls = nav.StaticMap(discs=pillars) + ROOM if pillars else ROOM
    person = nav.Person(start=(0, 0), route=[(8, 0)])
    world = nav.World(people=[person], walls=walls, time_limit=1.0)
    way = [(0.0, 0.0), *world.people[0].route]
    if len(way) > 2:
        for here, there in itertools.pairwise(way):
            assert walls.segment_clearance(here, there) >= person.radius - 1e-6


def test_a_law_that_does_not_know_a_wall_drives_into_it_and_is_told_of() -> None:
    wall = nav.StaticMap.from_polylines([[(4, -3), (4, 3)]])
    world = nav.World(robots=[ROBOT], walls=wall, time_limit=20.0)
    blind = nav.simulate(world, FIELD)
    assert (blind.outcome, blind.wall_contacts, blind.contacts_at_fault) == ("collided", 1, 1)
    assert codes(blind) == {"unknown_wall"}
    half = nav.StaticMap.from_polylines([[(4, -3), (4, 0)]])
    assert codes(nav.simulate(world, nav.SafeNavigation(FIELD, map=half))) == {"unknown_wall"}
    guided = nav.simulate(world, nav.SafeNavigation(FIELD, map=wall, guide=nav.Guide()))
    assert codes(guided) == set()
    assert guided.wall_contacts == 0
    assert guided.map_clearance > 0.0
    told = nav.simulate(replace(world, walls=[[(4, -3), (4, 3)]]), FIELD)
    assert "unknown_wall" not in codes(told)
    table = nav.simulate_many(world, {"blind": FIELD})
    assert table.wall_contacts.tolist() == [1]
    assert codes(table) == {"unknown_wall"}


def test_walls_of_a_scenario_are_touched_scored_and_told_of() -> None:
    wall = nav.StaticMap.from_polylines([[(4, -3), (4, 3)]])
    scene = nav.Scenario(start=(0, 0), goal=(8, 0), walls=wall, time_limit=20.0)
    run = nav.simulate(scene, FIELD)
    assert (run.outcome, run.wall_contacts) == ("collided", 1)
    assert codes(run) == {"unknown_wall"}
    assert nav.metrics.evaluate(run).wall_contacts == 1
    table = nav.simulate_many([scene, replace(scene, walls=None)], FIELD)
    assert table.outcome.tolist() == ["collided", "arrived"]
    assert codes(table) == {"unknown_wall"}
    assert nav.simulate(scene, FIELD, built=nav.robots.AsBuilt()).outcome == "collided"
    guided = nav.simulate(scene, nav.SafeNavigation(FIELD, map=wall, guide=nav.Guide()))
    assert (guided.wall_contacts, codes(guided)) == (0, set())
    assert pickle.loads(pickle.dumps(scene)) == scene


def test_metrics_take_a_map_as_walls() -> None:
    path = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]
    rules = {"step": 1.0, "goal": (2.0, 0.0), "robot_radius": 0.3}
    for walls, gap in ((nav.StaticMap(polygons=[[(0.5, 0.5), (1.5, 0.5), (1.0, 2.0)]]), 0.2), (DOOR, math.inf)):
        found = nav.metrics.evaluate(path, walls=walls, **rules)
        assert found.wall_clearance == pytest.approx(min(gap, 2.0 - 0.1 - 0.3 if walls is DOOR else gap), abs=0.3)


@pytest.mark.parametrize("place", [(4.0, 0.0), (4.4, 0.0)])
def test_a_robot_does_not_start_in_a_filled_wall(place: tuple[float, float]) -> None:
    block = nav.StaticMap(polygons=[[(2, -2), (6, -2), (6, 2), (2, 2)]])
    with pytest.raises(InvalidParameterError, match=r"robots\[0\].start must not be in contact with the walls"):
        nav.World(robots=[replace(ROBOT, start=place)], walls=block)
    with pytest.raises(InvalidParameterError, match="start must not be in contact with the walls"):
        nav.Scenario(start=place, goal=(9, 0), walls=block)


# ---- what moves by itself -------------------------------------------------------------------


@given(
    speed=st.floats(-1.5, 1.5),
    across=st.floats(-1.5, 1.5),
    stops=st.booleans(),
    radius=st.floats(0.1, 0.6),
)
@settings(max_examples=25, deadline=None)
def test_obstacles_of_a_world_move_as_in_a_scenario(speed: float, across: float, stops: bool, radius: float) -> None:
    way = (speed, across)
    stop = (1.0 + 2.0 * speed, 4.0 + 2.0 * across) if stops and math.hypot(*way) > 0.01 else None
    human = nav.Human(start=(1.0, 4.0), velocity=way, stop=stop, radius=radius)
    disc = nav.MovingDisc(center=(1.0, -4.0), radius=radius, velocity=way)
    world = nav.World(robots=[replace(ROBOT, law=nav.Khatib())], obstacles=[human, disc], time_limit=3.0)
    run = nav.simulate(world)
    scene = nav.Scenario(start=(50, 50), goal=(60, 50), obstacles=[human, disc], time_limit=3.0, control_period=0.05)
    alone = nav.simulate(scene, nav.Khatib())
    rows = np.searchsorted(alone.time, run.time - 1e-9)
    np.testing.assert_allclose(run.obstacle_position, alone.obstacle_position[rows], atol=1e-9)
    assert run.obstacle_radius.tolist() == [radius, radius]


def test_people_react_to_what_moves_by_itself_and_standing_obstacles_are_walls() -> None:
    cart = nav.MovingDisc(center=(4.0, 0.25), radius=0.5, velocity=(0.0, 0.0))
    free, met = (nav.simulate(nav.World(people=[WALKER], obstacles=each, time_limit=10.0)) for each in ([], [cart]))
    assert (
        np.abs(met.obstacle_position[:, 0, 1] - 0.3).max() > np.abs(free.obstacle_position[:, 0, 1] - 0.3).max() + 0.2
    )
    world = nav.World(robots=[ROBOT], obstacles=[nav.Disc(center=(4, 0.0), radius=0.4)], walls=ROOM)
    assert len(world.wall_shapes) == 2
    assert replace(world, seed=4).people == world.people
    with pytest.raises(InvalidParameterError, match=r"obstacles\[0\] must be"):
        nav.World(obstacles=[ROOM])  # type: ignore[list-item]


# ---- sensors and wheels ---------------------------------------------------------------------


def test_a_robot_with_ideal_wheels_and_no_sensors_is_the_plain_one() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance()
    world = nav.World(people=[WALKER], robots=[replace(ROBOT, law=law)], step=0.01, time_limit=20.0)
    plain = nav.simulate(world)
    built = nav.simulate(replace(world, robots=[replace(world.robots[0], built=nav.robots.AsBuilt())]))
    np.testing.assert_array_equal(plain.position, built.position)
    assert plain.energy == pytest.approx(built.energy)


def test_what_no_sensor_shows_is_not_known() -> None:
    law = nav.Khatib()
    lidar = nav.Lidar(range_max=6.0, influence=0.8)
    short = replace(lidar, sees_obstacles=False)
    stands = nav.Person(start=(4.0, 0.1), radius=0.3)
    world = nav.World(people=[stands], robots=[ROBOT], time_limit=30.0)
    seen, missed = (
        nav.simulate(replace(world, robots=[replace(ROBOT, sensors=[each])]), law) for each in (lidar, short)
    )
    assert seen.min_clearance[0] > 0.0
    assert missed.outcome == "collided"
    assert "blind_nearby" not in codes(seen)


def test_a_lidar_sees_the_walls_of_its_world() -> None:
    wall = nav.StaticMap.from_polylines([[(4, -3), (4, 3)]])
    robot = replace(ROBOT, sensors=[nav.Lidar(influence=0.6)])
    run = nav.simulate(nav.World(robots=[robot], walls=wall, time_limit=20.0), nav.Khatib())
    assert run.wall_contacts == 0
    assert "unknown_wall" not in codes(run)


def test_two_wheels_cameras_and_noise_drive_among_people_with_the_same_bits() -> None:
    built = nav.robots.AsBuilt(wheels=nav.robots.DIFFERENTIAL_WHEELS, obstacle_vision=nav.sensing.Vision())
    robot = nav.Robot(nav.DifferentialDriveRobot(), start=(0, 0), goal=(6, 0), built=built, control_period=0.1)
    world = nav.World(people=[WALKER], robots=[robot], time_limit=40.0, seed=3)
    laws = {"field": FIELD, "Masoud": nav.Masoud()}
    table = nav.simulate_many([world], laws, seeds=2)
    again = nav.simulate_many([world], laws, seeds=2, threads=1)
    assert table.outcome.tolist() == again.outcome.tolist()
    np.testing.assert_array_equal(table.energy, again.energy)
    assert (table.energy > 0.0).all()
    run = nav.simulate(replace(world, seed=0), FIELD)
    assert run.energy == table.energy[0]
    assert math.isfinite(run.arrival_time)


# ---- scores, searches, adversaries ----------------------------------------------------------


def test_the_score_of_a_robot_without_people_is_that_of_a_scenario() -> None:
    robot = replace(ROBOT, control_period=0.05)
    world = nav.World(robots=[robot], step=0.01, time_limit=30.0)
    found = nav.evaluate(world, FIELD)
    assert found.total == pytest.approx(1.0, abs=0.02)
    assert found.trajectory.energy == pytest.approx(found.nominal.energy, rel=0.02)
    among = nav.evaluate(replace(world, people=[WALKER]), FIELD)
    assert 0.0 < among.total < found.total
    assert among.avoidance < 1.0
    with pytest.raises(InvalidParameterError, match="be one to be scored"):
        nav.evaluate(nav.World(), FIELD)


def test_gains_are_searched_in_worlds() -> None:
    world = nav.World(people=[WALKER], robots=[replace(ROBOT, control_period=0.05)], time_limit=30.0)
    worlds = [world, replace(world, people=[replace(WALKER, desired_speed=0.8)])]
    search = nav.optimize_gains(worlds, grid=(3, 2, 2, 2), refinements=0, survivors=4, local_starts=1)
    assert search.feasible
    assert search.episodes == 2 * search.evaluations
    single = [nav.evaluate(each, search.best) for each in worlds]
    assert search.best_performance == pytest.approx([each.total for each in single])
    capped = [(min(each.arrival_time, 1.0) + each.avoidance + min(each.energy_saving, 1.0)) / 3.0 for each in single]
    assert search.best_value == pytest.approx(np.mean(capped))
    again = nav.optimize_gains(worlds, grid=(3, 2, 2, 2), refinements=0, survivors=4, local_starts=1, threads=1)
    assert again.best == search.best
    own = nav.optimize_gains(
        worlds,
        objective=lambda table: table.min_clearance.reshape(-1, 2).min(axis=1),
        constraints=[nav.gains.GainConstraint(metric="arrival_time", at_most=25.0)],
        grid=(3, 2, 2, 2),
        refinements=0,
        survivors=4,
        local_starts=0,
        seeds=2,
    )
    assert own.best_value > 0.0
    front = nav.gains.pareto_front(
        worlds, objectives=("arrival_time", "min_clearance"), grid=(3, 2, 2, 2), refinements=0
    )
    assert len(front.values) >= 1
    table = nav.gain_sensitivity(worlds, search.best, changes=(-10.0, 10.0))
    assert table.reference_performance == pytest.approx([each.total for each in single])
    assert table.min_distance.shape == (4, 2, 2, 0)
    assert len(table.columns()["gain"]) == 8
    with pytest.raises(InvalidParameterError, match=r"scenarios\[0\].robots must hold a robot"):
        nav.optimize_gains([nav.World()])


def test_laws_are_falsified_among_people() -> None:
    world = nav.World(people=[WALKER], robots=[ROBOT], walls=ROOM, time_limit=20.0)
    blind = nav.falsify(world, nav.SafeNavigation(nav.Khatib(repulsive_gain=0.0), map=ROOM), episodes=12)
    assert blind.broken
    assert blind.episodes == len(blind.margin) == 12
    assert blind.worst.contacts_toward > 0
    shield = nav.Shield(person_speed=1.6, wall_margin=0.05)
    kept = nav.falsify(world, nav.SafeNavigation(FIELD, map=ROOM, shield=shield), episodes=12, threads=2)
    assert not kept.broken, kept.worst
    assert np.array_equal(
        kept.margin, nav.falsify(world, nav.SafeNavigation(FIELD, map=ROOM, shield=shield), episodes=12).margin
    )
    assert nav.falsify(world, FIELD, "speed", episodes=2, most=0.01).broken
    # The person keeps off walls, too.
    places = blind.worst.person_position
    inside = (places > (-1.0, -2.0)).all(axis=1) & (places < (9.0, 2.0)).all(axis=1)
    assert inside.all() or not inside.any()
    with pytest.raises(InvalidParameterError, match="method must be"):
        nav.falsify(world, FIELD, method="cma_es")


def test_worlds_are_swept() -> None:
    plain = nav.World(people=[WALKER], robots=[ROBOT], time_limit=30.0)
    worlds = {"plain": plain, "slow": replace(plain, people=[replace(WALKER, desired_speed=0.7)])}
    study = sweep.NavigationStudy(scenarios=worlds, law=FIELD)
    axes = [sweep.Axis(name="seed", values=[0, 1]), sweep.Axis(name="detour_gain", values=[0.0, 17.0])]
    found = sweep.run(sweep.Grid(axes), study)
    assert found["scenario"].tolist()[:2] == ["plain", "slow"]
    assert len(found["outcome"]) == 8
    law = FIELD.replaced(detour_gain=17.0)
    for row in np.flatnonzero((found["detour_gain"] == 17.0) & (found["seed"] == 1)).tolist():
        single = nav.evaluate(replace(worlds[found["scenario"][row]], seed=1), law)
        assert found["performance_total"][row] == single.total
        assert found["energy"][row] == single.trajectory.energy
        assert found["arrival_time"][row] == single.trajectory.arrival_time
    noisy = sweep.NavigationStudy(scenarios=plain, law=FIELD)
    scale = sweep.Axis(name="measurement_scale", values=[0.0, 0.05])
    speed = sweep.Axis(name="robot_max_speed", values=[0.4, 0.7])
    slow = sweep.run(sweep.Grid([scale, speed]), noisy)
    assert (slow["end_time"] > 0.0).all()
    assert slow["arrival_time"][0] > slow["arrival_time"][1]
    for axis, message in (("rest_time", "rest_time"), ("obstacle_speed", "obstacle_speed")):
        with pytest.raises(InvalidParameterError, match=message):
            sweep.run(sweep.Grid([sweep.Axis(name=axis, values=[1.0])]), noisy)
    with pytest.raises(InvalidParameterError, match=r"scenarios\[0\].robots must be one"):
        sweep.NavigationStudy(scenarios=nav.World())
    with pytest.raises(InvalidParameterError, match="step must be left out for worlds"):
        sweep.NavigationStudy(scenarios=plain, step=0.02)


@pytest.mark.parametrize("footprint", [None, [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)]])
def test_walls_that_only_the_law_knows_are_doubted_where_the_robot_passes_them(
    footprint: list[tuple[float, float]] | None,
) -> None:
    body = nav.HolonomicRobot() if footprint is None else nav.HolonomicRobot(footprint=footprint)
    wall = nav.StaticMap.from_polylines([[(4.0, -1.0), (4.0, 1.0)]])
    law = nav.SafeNavigation(lambda situation: (4.0 * (8.0 - situation.position[0]), 0.0), map=wall)
    found = {}
    for name, walls in {
        "none": (),
        "elsewhere": [[(-9.0, 9.0), (9.0, 9.0)]],
        "the same": wall,
        "alike": [[(4.0, -1.0), (4.0, 1.0)]],
    }.items():
        world = nav.World(robots=[nav.Robot(body, start=(0.0, 0.0), goal=(8.0, 0.0))], walls=walls, time_limit=40.0)
        run, table = nav.simulate(world, law), nav.simulate_many(world, law)
        assert run.outcome == table.outcome[0]
        for each in (run, table):
            codes = [doubt.code for doubt in each.warnings]
            found[name, run.outcome, "walls_not_there" in codes] = codes.count("walls_not_there")
    assert set(found) == {
        ("none", "arrived", True),
        ("elsewhere", "arrived", True),
        ("the same", "collided", False),
        ("alike", "collided", False),
    }
