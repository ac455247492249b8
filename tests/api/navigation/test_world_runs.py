"""Worlds that are stepped from outside: the bits of `simulate`, commands to several robots, decisions, pictures."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import InvalidParameterError, SimulationError, plotting
from hrsafety import navigation as nav
from hrsafety.navigation.metrics import record_safety
from hrsafety.plausibility import unsafe_doubts

FIELD, ORCA = nav.VirtualForceField(), nav.OptimalReciprocalCollisionAvoidance()
ROOM = nav.StaticMap.from_polylines([[(-1, -2), (9, -2), (9, 2), (-1, 2), (-1, -2)]])
WALKER = nav.Person(start=(8, 0.3), route=[(0, 0.3)], desired_speed=1.2)
ROBOT = nav.Robot(start=(0, 0), goal=(8, 0))
OTHER = nav.Robot(start=(8, -1), goal=(0, -1), law=ORCA, control_period=0.1)
NOISE = nav.Measurement(of="both", latency=0.075)
SHIELDED = nav.SafeNavigation(
    FIELD, map=ROOM, shield=nav.Shield(person_speed=1.6, margin=0.03, wall_margin=0.03), yielding=nav.laws.Yielding()
)
COLUMNS = (
    *("time", "robot_position", "robot_velocity", "robot_heading", "robot_arrival_time", "robot_energy"),
    *("obstacle_position", "obstacle_velocity", "person_arrival_time", "desired_speed", "awareness"),
)


def built(**fields: object) -> nav.Robot:
    return nav.Robot(nav.DifferentialDriveRobot(), start=(0, 0), goal=(6, 0), control_period=0.1, **fields)


WORLDS = {
    "people and walls": nav.World(people=[WALKER], robots=[ROBOT], walls=ROOM, time_limit=15.0),
    "two robots, two periods": nav.World(people=[WALKER], robots=[ROBOT, OTHER], time_limit=25.0),
    "measured late": nav.World(people=[WALKER], robots=[replace(ROBOT, measurement=NOISE)], time_limit=15.0, seed=4),
    "wheels, lidar and camera": nav.World(
        people=[WALKER],
        robots=[
            built(
                sensors=[nav.Lidar()],
                built=nav.robots.AsBuilt(
                    wheels=nav.robots.DIFFERENTIAL_WHEELS, obstacle_vision=nav.sensing.Vision(drop_probability=0.2)
                ),
            )
        ],
        walls=ROOM,
        time_limit=12.0,
        seed=2,
    ),
    "source": nav.World(
        robots=[replace(ROBOT, measurement=NOISE)],
        sources=[nav.Source(low=(6, -1), high=(8, 1), rate=2.0, route=[(0, 0)])],
        time_limit=12.0,
        seed=7,
    ),
    "nobody": nav.World(people=[WALKER], time_limit=5.0),
    "small steps": nav.World(
        people=[replace(WALKER, model=nav.crowd.Moussaid())], robots=[ROBOT], step=0.1, time_limit=10.0
    ),
}


def assert_same_bits(one: nav.Trajectory, other: nav.Trajectory) -> None:
    for name in COLUMNS:
        first, second = getattr(one, name), getattr(other, name)
        assert first.shape == second.shape, name
        assert first.tobytes() == second.tobytes(), name
    assert one.outcomes == other.outcomes
    assert (one.wall_rescues, one.max_person_speed, one.diverged) == (
        other.wall_rescues,
        other.max_person_speed,
        other.diverged,
    )


def stepped(run: nav.Run) -> nav.Trajectory:
    while not run.finished:
        run.step()
    return run.trajectory


@pytest.mark.parametrize("law", [FIELD, ORCA, SHIELDED, lambda seen: seen.goal - seen.position - 2.0 * seen.velocity])
@pytest.mark.parametrize("name", WORLDS)
def test_stepping_a_world_has_the_bits_of_simulate(name: str, law: nav.laws.Law) -> None:
    world = WORLDS[name]
    run = nav.Run(world, law)
    assert_same_bits(stepped(run), nav.simulate(world, law))
    assert run.time == run.trajectory.time[-1]


def test_robots_have_their_own_laws_and_a_robot_without_one_stands() -> None:
    world = WORLDS["two robots, two periods"]
    run = nav.Run(world, seed=3)
    assert_same_bits(stepped(run), nav.simulate(replace(world, seed=3)))
    assert run.scenario.seed == 3
    assert np.all(run.trajectory.robot_position[:, 0] == 0.0)
    assert run.outcomes[1] == "arrived"


@given(st.lists(st.booleans(), min_size=40, max_size=40), st.sampled_from(list(WORLDS)))
@settings(max_examples=15, deadline=None)
def test_whoever_looks_disturbs_nothing(looks: list[bool], name: str) -> None:
    world = replace(WORLDS[name], time_limit=2.0)
    run = nav.Run(world, ORCA)
    for look in looks:
        for index in range(len(world.robots) if look else 0):
            first, again = run.observe(index), run.observe(index)
            assert first.obstacle_position.tobytes() == again.obstacle_position.tobytes()
            assert first.position.tobytes() == again.position.tobytes()
        if not run.finished:
            run.step()
    whole = nav.simulate(world, ORCA)
    rows = len(run.trajectory.time)
    assert run.trajectory.robot_position.tobytes() == whole.robot_position[:rows].tobytes()


def test_what_a_robot_sees() -> None:
    run = nav.Run(WORLDS["two robots, two periods"])
    mine, other = (run.observe(index) for index in range(2))
    assert mine.goal.tolist() == [8.0, 0.0]
    assert other.control_period == 0.1
    np.testing.assert_allclose(mine.obstacle_position, [[8.0, 0.3], [8.0, -1.0]])
    np.testing.assert_allclose(other.obstacle_position, [[8.0, 0.3], [0.0, 0.0]], atol=1e-15)
    noisy = nav.Run(WORLDS["measured late"], FIELD).observe()
    assert 1e-4 < np.abs(noisy.position).max() < 0.2
    with pytest.raises(InvalidParameterError, match="robot must be the index of a robot"):
        run.observe()
    with pytest.raises(InvalidParameterError, match="robot must be"):
        run.observe(2)
    blind = nav.Run(replace(WORLDS["people and walls"], robots=[replace(ROBOT, sensors=[nav.Lidar()])]))
    assert not blind.observe().obstacle_present[2:].all()


def test_a_law_in_steps_equals_the_commands_it_gives() -> None:
    def law(seen: nav.laws.Situation) -> np.ndarray:
        return 3.0 * (seen.goal - seen.position) - 4.0 * seen.velocity

    world = nav.World(people=[WALKER], robots=[replace(ROBOT, control_period=0.1)], time_limit=20.0)
    whole = nav.simulate(world, law)
    run = nav.Run(world)
    while not run.finished:
        asked = run.trajectory.arrival_time
        run.step(law(run.observe()) if math.isnan(asked) else None)
    assert run.trajectory.position.tobytes() == whole.position.tobytes()
    assert run.outcome == whole.outcome
    assert run.trajectory.commanded_periods == math.ceil(whole.arrival_time / 0.1 - 1e-9)


def test_several_robots_are_told_what_to_do() -> None:
    world = WORLDS["two robots, two periods"]
    run = nav.Run(world)
    seen = run.step(velocity={0: (0.3, 0.0), 1: (0.0, 0.2)})
    assert len(seen) == 2
    assert run.time == pytest.approx(0.05)
    with pytest.raises(InvalidParameterError, match=r"velocity\[1\] must be for robots that decide now"):
        run.step(velocity={1: (0.1, 0.0)})
    with pytest.raises(InvalidParameterError, match="velocity must be a mapping"):
        run.step(velocity=(0.1, 0.0))
    with pytest.raises(InvalidParameterError, match="velocity must be None where a force is given"):
        run.step({0: (1.0, 0.0)}, velocity={0: (0.1, 0.0)})
    for key in (2, -1, "0"):
        with pytest.raises(InvalidParameterError, match="a key of command must be"):
            run.step({key: (1.0, 0.0)})
    assert run.time == pytest.approx(0.05)
    assert run.outcomes == (None, None)
    with pytest.raises(AttributeError, match="take `outcomes`"):
        _ = run.outcome
    assert "outcomes=(None, None)" in repr(run)
    assert run.trajectory.outcomes == ("running", "running")
    stepped(run)
    with pytest.raises(SimulationError, match=r"has ended \(timed_out, arrived at t"):
        run.step()
    assert run.trajectory.robots[0].commanded_periods == 1
    copy = pickle.loads(pickle.dumps(run.trajectory))
    assert copy.robots[1].commanded_periods == 1


def test_options_of_scenarios_are_refused() -> None:
    world = WORLDS["nobody"]
    for options in ({"step": 0.02}, {"built": nav.robots.AsBuilt()}, {"stop_on_contact": True}):
        with pytest.raises(InvalidParameterError, match="be left out for worlds"):
            nav.Run(world, **options)  # type: ignore[arg-type]
    run = nav.Run(world)
    assert run.step() == ()
    assert run.time == pytest.approx(world.step)
    with pytest.raises(InvalidParameterError, match="scenario must be a Scenario or World"):
        nav.Run("world")  # type: ignore[arg-type]


def test_commands_past_a_shield_are_doubted() -> None:
    world = replace(WORLDS["people and walls"], robots=[replace(ROBOT, law=SHIELDED)])
    run = nav.Run(world)
    run.step(velocity=(0.1, 0.0))
    stepped(run)
    assert {each.subject for each in unsafe_doubts(run.trajectory.warnings)} == {"command"}
    assert run.trace is not None
    assert not unsafe_doubts(nav.simulate(world).warnings)


# ---- decisions ------------------------------------------------------------------------------


def test_decisions_of_a_scenario_and_of_the_same_world_agree() -> None:
    people = [nav.Human(start=(5.2, -2.6), velocity=(-0.5, 0.3)), nav.Human(start=(4.4, 3.2), velocity=(0.0, -0.5))]
    body = nav.HolonomicRobot(max_acceleration=0.8)
    scene = nav.Scenario(robot=body, start=(0, 0), goal=(5, 0.8), obstacles=people, time_limit=40.0)
    world = nav.World.of(scene)
    shield = nav.Shield(person_speed=0.9, latency=0.05, position_error=0.01)
    law = nav.SafeNavigation(ORCA, shield=shield, yielding=nav.laws.Yielding())
    one, other = record_safety(scene, law), record_safety(world, law)
    assert {each.status for each in one.decisions} >= {"kept", "changed"}
    assert len(one.decisions) == len(other.decisions)
    for first, second in zip(one.decisions, other.decisions, strict=True):
        assert (first.status, first.taken_over) == (second.status, second.taken_over)
        for name in ("time", "position", "velocity", "command", "margin", "plan_position", "obstacle_reach"):
            np.testing.assert_allclose(getattr(second, name), getattr(first, name), atol=1e-12, err_msg=name)
        np.testing.assert_allclose(second.obstacle_position, first.obstacle_position, atol=1e-12)
    np.testing.assert_array_equal(other.trajectory.position, nav.simulate(world, law).position)


def test_decisions_among_people_who_react() -> None:
    world = nav.World(
        people=[WALKER, replace(WALKER, start=(6, 1.0), route=[(6, -1.5)])],
        robots=[replace(ROBOT, law=SHIELDED, sensing_range=4.0), OTHER],
        sources=[nav.Source(low=(7, -1), high=(8, 1), rate=0.2, route=[(0, 0.5)])],
        walls=ROOM,
        time_limit=40.0,
        seed=1,
    )
    record = record_safety(world, robot=0)
    assert record.law is SHIELDED
    assert record.trajectory.position.tobytes() == nav.simulate(world).robots[0].position.tobytes()
    assert len(record.decisions) == math.ceil(record.trajectory.arrival_time / world.step - 1e-9)
    people = record.trajectory.obstacle_position.shape[1]
    assert people > 2
    rows = np.searchsorted(record.trajectory.time, [each.time - 1e-9 for each in record.decisions])
    for each, row in zip(record.decisions, rows.tolist(), strict=True):
        seen = np.isfinite(each.obstacle_position).all(axis=1)
        there = record.trajectory.obstacle_position[row]
        np.testing.assert_allclose(each.obstacle_position[seen], there[seen], atol=1e-12)
        near = np.linalg.norm(record.trajectory.obstacle_position[row] - each.position, axis=1) <= 4.0
        np.testing.assert_array_equal(seen, near)
        if each.status != "braking":
            assert each.margin > 0.0
        np.testing.assert_allclose(each.obstacle_reach[seen], 1.6 * each.plan_time[-1])
    replay = record._replay()
    assert replay.robots[0].decisions is not None
    assert replay.robots[0].decisions.reach.shape == (len(record.decisions), people)
    assert replay.robots[1].decisions is None
    figure = plotting.runs.safety_decision(record, 4.0)
    assert "margin" in figure.axes[0].texts[0].get_text()
    with pytest.raises(InvalidParameterError, match="law must be a SafeNavigation"):
        record_safety(world, robot=1)
    with pytest.raises(InvalidParameterError, match="robot must be the index of a robot"):
        record_safety(world)


def test_decisions_by_sensors_have_no_people() -> None:
    robot = replace(ROBOT, sensors=[nav.Lidar()], law=SHIELDED)
    world = nav.World(people=[WALKER], robots=[robot], walls=ROOM, time_limit=4.0)
    record = record_safety(world)
    assert all(np.isnan(each.obstacle_position).all() for each in record.decisions)
    assert record.decisions[0].obstacle_position.shape == (1, 2)
    assert plotting.runs.safety_decision(record, 3.0).axes
