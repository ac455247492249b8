"""A policy as a law is shown what the environment showed it, and drives as it did there."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, gym, scenarios
from hrsafety import navigation as nav

ROOM = [[(-6.0, -6.0), (6.0, -6.0), (6.0, 6.0), (-6.0, 6.0), (-6.0, -6.0)]]


def cautious(observation: np.ndarray) -> np.ndarray:
    """Return an action that depends on all that is seen."""
    people = observation[6:21].reshape(3, 5)
    away = -(people[:, :2] * np.exp(-people[:, 4:5])).sum(0)
    rays = observation[21:]
    angles = 2.0 * np.pi * np.arange(len(rays)) / max(len(rays), 1)
    walls = -(np.exp(-rays)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])).sum(0)
    goal = observation[:2] / max(1.0, float(np.linalg.norm(observation[:2])))
    return goal + 0.3 * away + 0.3 * walls + 0.05 * observation[2:4]


@pytest.mark.parametrize("frame", ["world", "goal"])
@pytest.mark.parametrize("lidar", [0, 5, 8])
def test_law_sees_and_does_what_the_policy_did_in_the_environment(frame: str, lidar: int) -> None:
    world: Any = scenarios.circle_crossing(4, visible=False)
    walls = nav.maps.StaticMap.from_polylines(ROOM) if lidar else None
    seen: list[np.ndarray] = []

    def kept(observation: np.ndarray) -> np.ndarray:
        seen.append(observation)
        return cautious(observation)

    law = gym.PolicyLaw(policy=kept, time_limit=world.time_limit, people=3, lidar=lidar, frame=frame, walls=walls)
    plan = [
        nav.Robot(each.body, start=each.start, goal=each.goal, control_period=each.control_period, law=law)
        for each in world.robots
    ]
    shapes = ROOM if lidar else ()
    free = nav.World(
        people=world.people, robots=plan, walls=shapes, time_limit=world.time_limit, seed=world.seed, step=world.step
    )
    nav.simulate(free)
    env = gym.CrowdEnv(free, people=3, lidar=lidar, frame=frame)
    observation, _ = env.reset(seed=free.seed)
    for step in range(min(len(seen), 60)):
        if np.hypot(observation[6::5][:3], observation[7::5][:3]).max() > 9.0:
            break  # a law is not told of people this far away
        np.testing.assert_allclose(seen[step], observation, atol=2e-4, err_msg=f"step {step}")
        observation, _, *ends, _ = env.step(cautious(observation))
        if any(ends):
            break
    assert step > 10


def test_a_policy_of_wheels_drives_as_in_the_environment() -> None:
    def swerving(observation: np.ndarray) -> np.ndarray:
        return np.array(
            [1.5 * np.cos(observation[5] * 9.0), 0.4 * np.sin(observation[5] * 20.0) + observation[9] / 90.0]
        )

    seen: list[np.ndarray] = []

    def kept(observation: np.ndarray) -> np.ndarray:
        seen.append(observation)
        return swerving(observation)

    law = gym.PolicyLaw(policy=kept, time_limit=8.0, people=1, action="unicycle", max_turn_rate=2.0)
    body = nav.DifferentialDriveRobot(reference_speed_share=1.0)
    robot = nav.Robot(body, start=(0.0, 0.0), goal=(6.0, 0.0), control_period=0.1, law=law)
    person = nav.Person(start=(3.0, -2.0), route=[(3.0, 4.0)])
    world = nav.World(people=[person], robots=[robot], time_limit=8.0, step=0.05)
    run = nav.simulate(world)
    assert not run.warnings
    env = gym.CrowdEnv(world, people=1, action="unicycle", max_turn_rate=2.0)
    observation, _ = env.reset(seed=world.seed)
    for index, shown in enumerate(seen):
        np.testing.assert_array_equal(shown, observation, err_msg=f"step {index}")
        observation, *_ = env.step(swerving(observation))
    assert len(seen) == 80
    slow = nav.DifferentialDriveRobot(reference_speed_share=1.0, max_turn_rate=1.0)
    assert doubts(law, time_limit=8.0, body=slow) == {("other_environment", "robots[0].law.max_turn_rate")}
    with pytest.raises(InvalidParameterError, match="two wheels"):
        nav.simulate(scenarios.circle_crossing(0, law=law))
    for wrong in ({"action": "unicycle"}, {"max_turn_rate": 2.0}):
        with pytest.raises(InvalidParameterError, match="max_turn_rate must be given with action"):
            gym.PolicyLaw(policy=to_goal, time_limit=8.0, **wrong)


def test_what_no_environment_shows_is_refused() -> None:
    law = gym.PolicyLaw(policy=lambda seen: seen[:2], time_limit=10.0)
    box = nav.Rectangle(center=(2.0, 0.0), length=1.0, width=0.5)
    with pytest.raises(InvalidParameterError, match="be discs for a policy"):
        nav.simulate(nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[box]), law)
    bad = gym.PolicyLaw(policy=lambda _: [np.nan, 0.0], time_limit=10.0)
    with pytest.raises(InvalidParameterError, match="action of the policy"):
        nav.simulate(scenarios.circle_crossing(0, law=bad))
    with pytest.raises(InvalidParameterError, match="policy must be callable"):
        gym.PolicyLaw(policy="best", time_limit=10.0)  # type: ignore[arg-type]  # on purpose


def to_goal(observation: np.ndarray) -> np.ndarray:
    return observation[:2]


def doubts(law: gym.PolicyLaw, *, walls: Any = (), time_limit: float = 25.0, **robot: Any) -> set[tuple[str, str]]:
    body = robot.pop("body", nav.HolonomicRobot())
    one = nav.Robot(body=body, start=(0.0, 0.0), goal=(4.0, 0.0), law=law, **robot)
    person = nav.Person(start=(3.0, 2.0), route=[(3.0, -2.0)])
    world = nav.World(people=[person], robots=[one], walls=walls, time_limit=time_limit)
    return {(each.code, each.subject) for each in world.warnings if each.code != "circle_around_footprint"}


def test_what_a_run_shows_otherwise_than_the_environment_is_doubted() -> None:
    room = nav.StaticMap.from_polylines(ROOM)
    elsewhere = nav.StaticMap.from_polylines(np.array(ROOM) + 50.0)
    policy: dict[str, Any] = {"policy": to_goal, "time_limit": 25.0}
    seeing = gym.PolicyLaw(**policy, lidar=24, walls=room)
    assert doubts(seeing, walls=room) == set()
    assert {code for code, _ in doubts(gym.PolicyLaw(**policy, lidar=24), walls=room)} == {"unknown_wall"}
    assert {code for code, _ in doubts(gym.PolicyLaw(**policy, lidar=24, walls=elsewhere), walls=room)} == {
        "unknown_wall"
    }
    assert {code for code, _ in doubts(gym.PolicyLaw(**policy, walls=room), walls=room)} == {"unknown_wall"}
    blind = doubts(seeing, walls=room, sensors=[nav.Lidar()])
    assert ("policy_sees_nobody", "robots[0].law.policy") in blind
    assert not {"unknown_wall", "region_below_safe"} & {code for code, _ in blind}
    assert {code for code, _ in doubts(seeing, walls=room, time_limit=30.0)} == {"other_environment"}
    assert {code for code, _ in doubts(seeing)} == {"walls_not_there"}
    assert doubts(seeing, walls=ROOM) == set()
    scene = nav.Scenario(start=(0.0, 0.0), goal=(1.0, 0.0), time_limit=25.0)
    told = [{each.code for each in nav.simulate(each, seeing).warnings} for each in (scene, replace(scene, walls=room))]
    assert told == [{"walls_not_there"}, set()]
    wheels = nav.DifferentialDriveRobot()
    assert {code for code, _ in doubts(seeing, walls=room, body=wheels)} == {"other_environment"}


def test_a_scenario_doubts_the_sensors_of_a_policy_and_shields_keep_the_doubt() -> None:
    law = gym.PolicyLaw(policy=to_goal, time_limit=60.0)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(1.0, 0.0), obstacles=[nav.Human(start=(0.5, 3.0), velocity=(0, 0))])
    built = nav.robots.AsBuilt(sensors=[nav.Lidar(map=nav.StaticMap.from_polylines(ROOM))])
    assert scene.time_limit == 60.0
    for driven in (law, nav.SafeNavigation(law, shield=nav.Shield())):
        assert "policy_sees_nobody" in {each.code for each in nav.simulate(scene, driven, built=built).warnings}
        assert "policy_sees_nobody" not in {each.code for each in nav.simulate(scene, driven).warnings}
