"""Environments for learners: the checks of Gymnasium, one against many, episodes, rewards, pictures."""

from __future__ import annotations

import pickle
import warnings
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from api.trees import same
from hrsafety import gym, scenarios
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, ShapeError, SimulationError
from hrsafety.plausibility import HrsafetyWarning, ImplausibleWarning, ResultWarning, UnitWarning

CIRCLE = "hrsafety/CircleCrossing-v0"
OPTIONS: list[dict[str, Any]] = [
    {},
    {"observation": "dict", "lidar": 8, "frame": "goal"},
    {"action": "unicycle", "people": 2, "progress": 0.1},
    {"action": "acceleration", "metrics": False, "step_reward": -0.01},
]


def one_person(**options: Any) -> gym.CrowdEnv:
    """Return a robot that starts 2 m from its goal, and a person who stands aside."""
    person = nav.Person(start=(1.0, 1.0), radius=0.3, awareness=0.0, model=nav.crowd.ReciprocalAvoidance())
    robot = nav.Robot(
        start=(0.0, 0.0), goal=(2.0, 0.0), body=nav.HolonomicRobot(radius=0.3, max_speed=1.0), control_period=0.25
    )
    world = nav.World(people=[person], robots=[robot], step=0.25, time_limit=5.0)
    return gym.CrowdEnv(world, **options)


@pytest.mark.parametrize("name", gym.IDS)
def test_a_registered_environment_passes_the_checks_without_a_warning(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(name).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("options", OPTIONS[1:], ids=lambda options: ",".join(map(str, options)))
def test_options_pass_the_checks_without_a_warning(options: dict[str, Any]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(CIRCLE, **options).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("mode", list(AutoresetMode))
@pytest.mark.parametrize("options", OPTIONS[:3], ids=lambda options: ",".join(map(str, options)) or "default")
def test_many_environments_are_single_ones_side_by_side(mode: AutoresetMode, options: dict[str, Any]) -> None:
    count = 5
    many = gymnasium.make_vec(CIRCLE, num_envs=count, autoreset_mode=mode, threads=1, **options)
    single = [lambda: gymnasium.make(CIRCLE, **options) for _ in range(count)]
    each = SyncVectorEnv(single, autoreset_mode=mode)
    same(many.reset(seed=7), each.reset(seed=7))
    assert many.observation_space == each.observation_space
    generator = np.random.default_rng(1)
    ends = 0
    for _ in range(130):
        actions = generator.uniform(-1.0, 1.0, (count, 2)).astype(np.float32)
        found, expected = many.step(actions), each.step(actions)
        same(found, expected)
        ended = found[2] | found[3]
        ends += int(ended.sum())
        if mode is AutoresetMode.DISABLED and ended.any():
            same(many.reset(options={"reset_mask": ended}), each.reset(options={"reset_mask": ended}))
    assert ends >= count


def test_neither_their_number_nor_threads_change_a_bit() -> None:
    actions = np.random.default_rng(2).uniform(-1.0, 1.0, (40, 64, 2))
    runs = []
    for count, threads in ((64, 1), (64, 2), (64, 7), (16, 1)):
        envs = gymnasium.make_vec(CIRCLE, num_envs=count, threads=threads)
        rows = [envs.reset(seed=11)[0][:16]]
        rows += [envs.step(each[:count])[0][:16] for each in actions]
        runs.append(np.array(rows))
    for run in runs[1:]:
        np.testing.assert_array_equal(run, runs[0])


def test_episodes_differ_and_a_seed_starts_them_again() -> None:
    env = gymnasium.make(CIRCLE)
    first, _ = env.reset(seed=5)
    second, _ = env.reset()
    again, _ = env.reset(seed=5)
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, second)
    np.testing.assert_array_equal(env.reset()[0], second)


def test_an_observation_holds_what_it_says() -> None:
    env = one_person(people=2, lidar=4)
    observation, info = env.reset(seed=0)
    robot, people, lidar = observation[:6], observation[6:16].reshape(2, 5), observation[16:]
    np.testing.assert_allclose(robot, [2.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    np.testing.assert_allclose(people[0], [1.0, 1.0, 0.0, 0.0, np.sqrt(2.0) - 0.6], rtol=1e-6)
    np.testing.assert_array_equal(people[1], 0.0)
    np.testing.assert_array_equal(lidar, 10.0)
    assert info == {"outcome": "running", "clearance": np.inf, "wall_rescues": 0}
    observation, *_ = env.step([1.0, 0.0])
    np.testing.assert_allclose(observation[:6], [1.75, 0.0, 1.0, 0.0, 1.0, 0.05], atol=1e-6)
    np.testing.assert_allclose(observation[6:10], [0.75, 1.0, -1.0, 0.0], atol=1e-6)


def through_a_wall(**options: Any) -> nav.World:
    """Return somebody whose model leads through a wall, far from a robot."""
    walker = nav.Person(start=(0, 0), route=[(6, 0)], model=nav.crowd.Moussaid(), desired_speed=1.34)
    robot = nav.Robot(nav.HolonomicRobot(max_speed=1.0), start=(0, 40), goal=(9, 40))
    return nav.World(people=[walker], robots=[robot], walls=[[(3, -5), (3, 5)]], time_limit=8.0, **options)


def test_info_counts_who_was_set_back_at_a_wall() -> None:
    env, ended = gym.CrowdEnv(through_a_wall()), False
    _, info = env.reset(seed=0)
    counts = [info["wall_rescues"]]
    while not ended:
        *_, terminated, truncated, info = env.step([0.0, 0.0])
        counts.append(info["wall_rescues"])
        ended = terminated or truncated
    alone = replace(through_a_wall(), robots=[])
    assert counts[0] == 0
    assert counts == sorted(counts)
    assert counts[-1] == nav.simulate(alone).wall_rescues > 0
    assert env.reset()[1]["wall_rescues"] == 0


def test_many_environments_count_those_of_the_episode_that_has_ended() -> None:
    envs = gym.CrowdVectorEnv(through_a_wall(), num_envs=2, autoreset_mode="SameStep")
    _, infos = envs.reset(seed=0)
    while "final_info" not in infos:
        before = infos["wall_rescues"]
        *_, infos = envs.step(np.zeros((2, 2)))
    last = infos["final_info"]["wall_rescues"]
    assert (last >= before).all()
    assert (before > 0).all()
    assert (infos["wall_rescues"] == 0).all()
    assert infos["_wall_rescues"].all()


def test_axes_of_the_goal_turn_all_vectors() -> None:
    env = one_person(frame="goal", lidar=4)
    env.reset(seed=0)
    for _ in range(2):
        observation, *_ = env.step([0.0, 1.0])
    assert observation[1] == pytest.approx(0.0, abs=1e-6)
    assert observation[0] == pytest.approx(np.hypot(2.0, 0.5), rel=1e-6)
    x, y = observation[6:8]
    assert np.hypot(x, y) == pytest.approx(np.hypot(1.0, 0.5), rel=1e-6)
    assert observation[2] < 0.0 < observation[3]


def test_arrival_contact_and_time_are_rewarded_as_they_should_be() -> None:
    env = one_person(progress=0.1)
    env.reset(seed=0)
    rewards, ended = [], False
    while not ended:
        _, reward, terminated, truncated, info = env.step([1.0, 0.0])
        rewards.append(reward)
        ended = terminated or truncated
    assert info["outcome"] == "arrived"
    assert sum(rewards) == pytest.approx(1.0 + 0.1 * 1.75)
    assert info["metrics"]["success"] is True
    assert info["metrics"]["arrival_time"] == pytest.approx(1.75)
    env.reset(seed=0)
    for _ in range(6):
        _, reward, terminated, truncated, info = env.step([1.0, 1.0])
        if terminated:
            break
    assert info["outcome"] == "collided"
    assert reward == pytest.approx(-0.25, abs=0.05)
    assert info["clearance"] < 0.0
    env.reset(seed=0)
    for _ in range(20):
        _, reward, terminated, truncated, info = env.step([0.0, 0.0])
    assert (terminated, truncated, info["outcome"]) == (False, True, "timed_out")


def test_discomfort_costs_what_is_lacking_to_the_distance() -> None:
    env = one_person()
    env.reset(seed=0)
    for _ in range(3):
        _, reward, *_, info = env.step([0.4, 1.0])
    gap = info["clearance"]
    assert 0.0 < gap < 0.2
    assert reward == pytest.approx(-0.5 * (0.2 - gap) * 0.25)


def test_an_unseen_robot_is_run_over() -> None:
    outcomes = {}
    for visible in (True, False):
        envs = gymnasium.make_vec(CIRCLE, num_envs=32, visible=visible, autoreset_mode="Disabled")
        envs.reset(seed=0)
        for _ in range(40):
            *_, infos = envs.step(np.zeros((32, 2)))
            ended = np.isin(infos["outcome"].astype(str), ["collided", "timed_out"])
            if ended.any():
                outcomes.setdefault(visible, 0)
                outcomes[visible] += int((infos["outcome"] == "collided").sum())
                envs.reset(options={"reset_mask": ended})
    assert outcomes.get(True, 0) < outcomes[False]


def test_arrays_are_new_unless_they_are_to_be_shared() -> None:
    for copy in (True, False):
        envs = gymnasium.make_vec(CIRCLE, num_envs=3, copy=copy)
        first, _ = envs.reset(seed=0)
        second, *_ = envs.step(np.ones((3, 2)))
        assert (first is second) is not copy


def test_a_bad_action_is_named() -> None:
    envs = gymnasium.make_vec(CIRCLE, num_envs=3)
    envs.reset(seed=0)
    with pytest.raises(ShapeError, match=r"action .*\(3, 2\)"):
        envs.step(np.zeros((2, 2)))
    actions = np.zeros((3, 2))
    actions[1, 0] = np.nan
    with pytest.raises(InvalidParameterError, match=r"action\[1\] must be finite"):
        envs.step(actions)


def test_bad_options_are_named() -> None:
    for options, message in (
        ({"num_envs": 0}, "num_envs must"),
        ({"action": "velocty"}, "action must be"),
        ({"frame": "robot"}, "frame must be"),
        ({"observation": "dcit"}, "observation must be"),
        ({"lidar": -1}, "lidar must"),
        ({"max_turn_rate": 0.0}, "max_turn_rate must"),
        ({"progress": np.nan}, "progress must be finite"),
        ({"threads": 0}, "threads must"),
    ):
        with pytest.raises(InvalidParameterError, match=message):
            gym.CrowdVectorEnv(gym.circle_crossing(), **options)
    with pytest.raises(InvalidParameterError, match="hold a robot"):
        gym.CrowdEnv(nav.World())


def test_environments_that_would_not_fit_into_memory_are_refused() -> None:
    task = gym.bottleneck(people=20)
    with pytest.raises(InvalidParameterError, match="num_envs must make at most 10000000 people and robots together"):
        gym.CrowdVectorEnv(task, num_envs=2**20)
    law = nav.OptimalReciprocalCollisionAvoidance()
    ends = [((3.0 * k, 20.0), (3.0 * k, 30.0)) for k in range(60)]
    others = [nav.Robot(start=start, goal=goal, law=law) for start, goal in ends]
    crowded = replace(task, world=replace(task.world, robots=[*task.world.robots, *others]))
    with pytest.raises(InvalidParameterError, match="pairs of a robot under a law and somebody it may see together"):
        gym.CrowdVectorEnv(crowded, num_envs=2100)


def test_a_mask_is_needed_where_episodes_have_ended() -> None:
    envs = gym.CrowdVectorEnv(one_person().unwrapped._all.task, num_envs=2, autoreset_mode="Disabled")
    envs.reset(seed=0)
    for _ in range(20):
        envs.step(np.zeros((2, 2)))
    with pytest.raises(InvalidParameterError, match=r"environment\[0\] must be under way"):
        envs.step(np.zeros((2, 2)))
    for mask in (np.zeros(2, dtype=bool), np.ones(3, dtype=bool), [True, False]):
        with pytest.raises(InvalidParameterError, match="reset_mask must"):
            envs.reset(options={"reset_mask": mask})


@pytest.mark.parametrize("copied", [deepcopy, pickle.dumps])
def test_many_episodes_under_way_are_not_copied(copied: Callable[[object], object]) -> None:
    # A single one repeats its episode, see test_copies.py.
    with pytest.raises(SimulationError, match="cannot be copied or pickled"):
        copied(gym.CrowdVectorEnv(one_person()._all.task, num_envs=2))


@pytest.mark.parametrize("name", gym.IDS)
def test_a_picture_shows_the_world(name: str) -> None:
    env = gymnasium.make(name, render_mode="rgb_array")
    env.reset(seed=1)
    picture = env.render()
    assert isinstance(picture, np.ndarray)
    assert picture.dtype == np.uint8
    height, width, colors = picture.shape
    assert (height % 2, width % 2, colors) == (0, 0, 3)  # as videos want it
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 20
    env.step(np.array([1.0, 0.0], dtype=np.float32))
    later = env.render()
    assert isinstance(later, np.ndarray)
    assert later.shape == picture.shape
    assert not np.array_equal(later, picture)
    env.close()


@pytest.mark.parametrize("seed", [True, 1.5, np.timedelta64(1, "ns"), "abc"])
def test_a_seed_of_many_that_is_none_is_refused_by_name(seed: Any) -> None:
    envs = gymnasium.make_vec(CIRCLE, num_envs=3)
    with pytest.raises(InvalidParameterError, match="seed"):
        envs.reset(seed=seed)


def test_options_that_are_no_mapping_are_refused_by_name() -> None:
    for env in (one_person(), gymnasium.make_vec(CIRCLE, num_envs=3)):
        with pytest.raises(InvalidParameterError, match="options must be a mapping or None, got 3"):
            env.reset(options=3)  # type: ignore[arg-type, call-overload]  # what is tried


def test_a_learner_drives_the_robot_of_a_scenario() -> None:
    scene = nav.Scenario(start=(0, 0), goal=(3, 0), obstacles=[nav.Human(start=(1.5, 2.0), velocity=(0.0, -0.2))])
    env = gym.CrowdEnv(scene, people=1)
    seen, _ = env.reset(seed=0)
    assert seen[6:8].tolist() == pytest.approx([1.5, 2.0])
    ended, outcome = False, ""
    while not ended:
        _, _, terminated, truncated, info = env.step([1.0, 0.0])
        ended, outcome = terminated or truncated, info["outcome"]
    assert outcome == "arrived"


def blue(env: gym.CrowdEnv) -> npt.NDArray[np.bool_]:
    """Return where the picture of an environment has the color of its robot."""
    seen = env.render().astype(np.int64)
    near = np.abs(seen - [0, 114, 178]).sum(axis=2) < 30
    return near[: int(0.85 * len(near))]  # without the legend


def tilt(outline: npt.NDArray[np.bool_]) -> float:
    """Return the angle of the longer side of a rectangle in a picture in rad."""
    rows, columns = np.nonzero(outline)
    return float(np.arctan(np.polyfit(columns, -rows, 1)[0]))


@pytest.mark.parametrize("heading", [0.0, 0.9])
def test_a_picture_shows_the_footprint_of_a_robot_at_its_heading(heading: float) -> None:
    footprint = nav.robots.Footprint.rectangle(1.6, 0.4)

    def made(body: Any, **more: Any) -> gym.CrowdEnv:
        robot = nav.Robot(body, start=(0.0, 0.0), goal=(6.0, 0.0), heading=heading)
        env = gym.CrowdEnv(nav.World(robots=[robot], time_limit=20.0), render_mode="rgb_array", **more)
        env.reset(seed=0)
        return env

    radius = float(np.hypot(0.8, 0.2))
    outline = blue(made(nav.HolonomicRobot(footprint=footprint)))
    circle = blue(made(nav.HolonomicRobot(radius=radius)))
    share = 1.6 * 0.4 / (np.pi * radius**2)
    assert outline.sum() / circle.sum() == pytest.approx(share, rel=0.1)
    assert tilt(outline) == pytest.approx(heading, abs=0.1)
    # Two wheels turn the outline.
    wheels = made(nav.DifferentialDriveRobot(footprint=footprint), action="unicycle")
    assert tilt(blue(wheels)) == pytest.approx(heading, abs=0.1)
    for _ in range(4):
        wheels.step([0.0, -1.0])
    (turned,) = wheels._all.headings(0)
    assert turned < heading - 0.2
    assert tilt(blue(wheels)) == pytest.approx(turned, abs=0.1)


def test_two_wheels_take_up_the_speed_and_the_turn_rate_of_an_action() -> None:
    robot = nav.Robot(nav.DifferentialDriveRobot(max_speed=0.7), start=(0.0, 0.0), goal=(6.0, 0.0), heading=2.0)
    env = gym.CrowdEnv(nav.World(robots=[robot], step=0.1, time_limit=20.0), action="unicycle", max_turn_rate=2.0)
    env.reset(seed=0)
    for _ in range(5):  # it turns in place, away from the goal or toward it
        env.step([0.0, -0.5])
    (heading,) = env._all.headings(0)
    assert heading == pytest.approx(2.0 - 0.5 * 2.0 * 0.5, abs=1e-9)
    (place, _), *_ = env._all.places(0)
    assert place == pytest.approx((0.0, 0.0), abs=1e-9)
    env.step([-1.0, 0.0])
    env.step([-1.0, 0.0])
    (back, _), *_ = env._all.places(0)
    (heading,) = env._all.headings(0)
    assert np.dot(back, [np.cos(heading), np.sin(heading)]) < -0.05


def test_a_robot_with_a_law_is_driven_as_one_without() -> None:
    def driven(law: nav.Law | None, action: Any) -> list[float]:
        body = nav.DifferentialDriveRobot(max_speed=0.7)
        robot = nav.Robot(body, start=(0.0, 0.0), goal=(6.0, 0.0), heading=0.3, law=law)
        env = gym.CrowdEnv(nav.World(robots=[robot], step=0.1, time_limit=20.0), action=action)
        env.reset(seed=0)
        for _ in range(5):
            env.step([0.5, 0.3])
        return [*env._all.places(0)[0][0], *env._all.headings(0)]

    for action in ("velocity", "unicycle"):
        free, bound = (driven(law, action) for law in (None, nav.VirtualForceField()))
        assert free == bound
        assert free[0] > 0.1


def test_options_that_there_are_not_and_turn_rates_in_degrees_are_told() -> None:
    world = scenarios.circle_crossing(3)
    for make in (gym.CrowdEnv, gym.CrowdVectorEnv, gym.parallel_env):
        with pytest.raises(TypeError, match=r'did you mean "lidar"\?'):
            make(world, lidr=3)
    with pytest.warns(ImplausibleWarning, match="degrees given for radians"):
        gym.CrowdEnv(world, max_turn_rate=180.0)


def doubtful(generator: np.random.Generator | None = None, doubt: str = "gap_in_track") -> nav.World:
    start = (0.0, 0.0 if generator is None else float(generator.uniform(-1.0, 1.0)))
    robot = nav.Robot(nav.HolonomicRobot(), start=start, goal=(3.0, 0.0), heading=90.0)
    return nav.World(robots=[robot], doubts=(ResultWarning(doubt, "people", f"{doubt} of people"),))


@pytest.mark.parametrize("make", [gym.CrowdEnv, gym.CrowdVectorEnv, gym.parallel_env])
def test_doubts_about_a_world_are_told_and_carried(make: Any) -> None:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        env = make(doubtful())
    assert [each.code for each in env.warnings] == ["gap_in_track", "implausible"]
    assert [(each.category, each.filename) for each in told] == [(UnitWarning, __file__), (HrsafetyWarning, __file__)]


def test_doubts_about_worlds_that_are_drawn_are_told_once() -> None:
    drawn = iter(["gap_in_track", "gap_in_track", "wall_rescues", "gap_in_track"])
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        env = gym.CrowdEnv(lambda generator: doubtful(generator, next(drawn)))
        for _ in range(3):
            env.reset()
    assert [each.code for each in env.warnings] == ["gap_in_track", "implausible", "wall_rescues"]
    assert [str(each.message).split(" ")[0] for each in told] == ["robots[0]:", "gap_in_track", "wall_rescues"]
    assert {each.filename for each in told} == {__file__}
