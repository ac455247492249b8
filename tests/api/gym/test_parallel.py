"""Many robots in one world: the checks of PettingZoo, and each robot against an environment of its own."""

from __future__ import annotations

import sys
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import gym, scenarios
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, MissingExtraError, ShapeError

pytest.importorskip("pettingzoo")

from pettingzoo.test import parallel_api_test, parallel_seed_test

ENDS = [((-5.0, -5.0), (5.0, 5.0)), ((-5.0, 5.0), (5.0, -5.0)), ((5.0, 0.0), (-5.0, 0.0))]
KINDS: list[dict[str, Any]] = [{}, {"action": "unicycle", "lidar": 8}, {"action": "acceleration", "frame": "goal"}]


def robot(index: int, law: Any = None, period: float = 0.25, body: Any = None) -> nav.Robot:
    start, goal = ENDS[index]
    body = nav.HolonomicRobot(radius=0.3, max_speed=0.9) if body is None else body
    return nav.Robot(body, start=start, goal=goal, law=law, control_period=period)


def world(*robots: nav.Robot, people: int = 6) -> nav.World:
    places = np.random.default_rng(0).normal(size=(people, 2)) * 3.0
    walkers = [nav.Person(start=tuple(place), route=[tuple(-place)]) for place in places]
    return nav.World(people=walkers, robots=robots, walls=[[(-7, -6), (7, -6)]], time_limit=15.0)


class Scripted:
    """A law that repeats the velocities of a list."""

    def __init__(self, velocities: Any) -> None:
        self.velocities = velocities

    def velocity(self, seen: nav.laws.Situation) -> Any:
        return self.velocities[round(seen.time / seen.control_period)]


@pytest.mark.parametrize("options", [*KINDS, {"observation": "dict", "people": 2}], ids=str)
def test_pettingzoo_passes_it_without_a_warning(options: dict[str, Any], capsys: pytest.CaptureFixture[str]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(gym.parallel_env(world(*map(robot, range(3))), **options), num_cycles=80)
    assert "Passed" in capsys.readouterr().out


def test_a_seed_is_an_episode() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_seed_test(lambda: gym.parallel_env(world(*map(robot, range(2)))), num_cycles=80)


def test_each_robot_sees_and_is_rewarded_as_in_an_environment_of_its_own() -> None:
    shares = np.random.default_rng(1).uniform(-0.7, 0.7, (60, 3, 2))
    env = gym.parallel_env(world(*map(robot, range(3))), lidar=12, progress=0.1)
    singles = {}
    for index in range(3):
        order = [index, *(other for other in range(3) if other != index)]
        robots = [robot(each, Scripted(shares[:, each] * 0.9) if each != index else None) for each in order]
        singles[f"robot_{index}"] = gym.CrowdEnv(world(*robots), lidar=12, progress=0.1)
    observations, _ = env.reset(seed=5)
    for name, single in singles.items():
        np.testing.assert_array_equal(single.reset(seed=5)[0], observations[name])
    for row in shares:
        actions = {name: row[int(name[-1])] for name in env.agents}
        found = env.step(actions)
        for name, action in actions.items():
            seen, reward, terminated, truncated, info = singles[name].step(action)
            np.testing.assert_array_equal(found[0][name], seen)
            assert (found[1][name], found[2][name], found[3][name]) == (reward, terminated, truncated)
            assert found[4][name].pop("robot_clearance") > -0.6
            np.testing.assert_equal(found[4][name], info)
        if len(env.agents) < 3:  # the others rest from here on, which the list does not say
            break
    else:
        assert env.agents == env.possible_agents


@pytest.mark.parametrize("body", [None, nav.DifferentialDriveRobot(radius=0.3, max_speed=0.9)], ids=["disc", "wheels"])
@pytest.mark.parametrize("options", KINDS, ids=str)
def test_the_worlds_of_all_robots_are_one(options: dict[str, Any], body: Any) -> None:
    env = gym.parallel_env(world(*(robot(index, body=body) for index in range(3))), **options)
    env.reset(seed=2)
    generator = np.random.default_rng(3)
    while env.agents:
        env.step({name: generator.uniform(-1.0, 1.0, 2) for name in env.agents})
        placed = []
        for name in env.agents:
            own, people, others = env._envs[name]._all.places(0)
            robots = [own, *others]
            index = int(name[-1])
            robots[0], robots[index] = robots[index], robots[0]
            placed.append((robots, people))
        assert all(each == placed[0] for each in placed)


def test_a_robot_that_has_arrived_or_touched_somebody_stands() -> None:
    near = nav.Robot(nav.HolonomicRobot(radius=0.3, max_speed=1.0), start=(0.0, 0.0), goal=(1.0, 0.0))
    far = nav.Robot(nav.HolonomicRobot(radius=0.3, max_speed=1.0), start=(0.0, 3.0), goal=(9.0, 3.0))
    env = gym.parallel_env(nav.World(robots=[near, far], step=0.25, time_limit=5.0))
    env.reset(seed=0)
    outcomes = {}
    while env.agents:
        _, _, _, _, infos = env.step({name: [1.0, 0.0] for name in env.agents})
        outcomes |= {name: info["outcome"] for name, info in infos.items()}
    assert outcomes == {"robot_0": "arrived", "robot_1": "timed_out"}
    place, _ = env._envs["robot_1"]._all.places(0)[2][0]
    assert 0.7 <= place[0] <= 1.3
    assert infos["robot_1"]["robot_clearance"] == pytest.approx(np.hypot(5.0 - place[0], 3.0) - 0.6)


def test_robots_with_a_law_follow_it() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance()
    env = gym.parallel_env(world(robot(0), robot(1, law), robot(2)))
    assert env.possible_agents == ["robot_0", "robot_2"]
    env.reset(seed=0)
    for _ in range(8):
        env.step({name: [0.0, 0.0] for name in env.agents})
    place, _ = env._envs["robot_2"]._all.places(0)[2][0]
    assert np.hypot(*(np.array(place) - ENDS[1][0])) > 1.0


def test_a_scenario_with_many_robots_is_shown_in_a_picture() -> None:
    env = gym.parallel_env(scenarios.antipodal(6, robots=2), render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render()
    assert picture is not None
    assert picture.shape[2] == 3
    env.close()


def test_bad_input_is_named() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance()
    with pytest.raises(InvalidParameterError, match="hold a robot without a law"):
        gym.parallel_env(world(robot(0, law)))
    with pytest.raises(InvalidParameterError, match=r"world.robots\[1\].control_period must share"):
        gym.parallel_env(world(robot(0), robot(1, period=0.5)))
    with pytest.raises(InvalidParameterError, match="world must be a World, Scenario or Task"):
        gym.parallel_env(robot(0))  # type: ignore[arg-type]  # wrong on purpose
    for options in ({"action": "velocty"}, {"max_turn_rate": 0.0}, {"max_acceleration": -1.0}, {"lidar": -1}):
        with pytest.raises(InvalidParameterError, match=f"{next(iter(options))} must"):
            gym.parallel_env(world(robot(0)), **options)
    env = gym.parallel_env(world(robot(0), robot(1)))
    with pytest.raises(InvalidParameterError, match=r"under way.*reset first"):
        env.step({"robot_0": [0.0, 0.0]})
    env.reset(seed=0)
    with pytest.raises(InvalidParameterError, match="actions must name each of"):
        env.step({"robot_0": [0.0, 0.0]})
    with pytest.raises(ShapeError, match=r"actions\['robot_1'\]"):
        env.step({"robot_0": [0.0, 0.0], "robot_1": [0.0]})
    with pytest.raises(InvalidParameterError, match=r"actions\['robot_0'\] must be finite"):
        env.step({"robot_0": [np.nan, 0.0], "robot_1": [0.0, 0.0]})


def test_without_pettingzoo_it_says_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None if name == "pettingzoo" else sys)
    with pytest.raises(MissingExtraError, match=r"pip install pettingzoo"):
        gym.parallel_env(world(robot(0)))


def test_a_refused_seed_leaves_the_episode_as_it_was() -> None:
    env, other = (gym.parallel_env(world(robot(0), robot(1)), action="unicycle") for _ in range(2))
    action = {"robot_0": [0.5, 0.8], "robot_1": [0.5, -0.3]}
    for each in (env, other):
        each.reset(seed=4)
        each.step(action)
    with pytest.raises(InvalidParameterError, match="seed must"):
        env.reset(seed=-1)
    found, expected = env.step(action), other.step(action)
    for name in env.agents:
        np.testing.assert_array_equal(found[0][name], expected[0][name])


def test_robots_whose_worlds_would_not_fit_into_memory_are_refused() -> None:
    ends = [((3.0 * k, 0.0), (3.0 * k, 9.0)) for k in range(220)]
    robots = [nav.Robot(start=start, goal=goal) for start, goal in ends]
    with pytest.raises(InvalidParameterError, match=r"world\.robots must be few: .* got 220 robots; 220 driven of 220"):
        gym.parallel_env(nav.World(robots=robots))
    # With laws of their own only what is driven has a world.
    law = nav.OptimalReciprocalCollisionAvoidance()
    mixed = [replace(each, law=law if k else None) for k, each in enumerate(robots[:30])]
    assert gym.parallel_env(nav.World(robots=mixed)).possible_agents == ["robot_0"]
