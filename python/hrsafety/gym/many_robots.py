"""Robots of one world that a learner drives side by side, with the interface of PettingZoo."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, get_args

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces
from pettingzoo import ParallelEnv

from hrsafety._arguments import Array, checked_seed, numbers, positive, word
from hrsafety._bounds import MOST_SIGHTINGS
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.gym.environments import ActionKind, Frame, turn_rate_of
from hrsafety.gym.single import RENDER_MODES, CrowdEnv
from hrsafety.gym.worlds import Task, task_of
from hrsafety.navigation.crowd.agents import Robot
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.metrics.between import wrapped
from hrsafety.navigation.place import Place
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot
from hrsafety.plausibility import ResultWarning

__all__ = ["CrowdParallelEnv"]

Action = npt.NDArray[np.float32]


class _Told:
    """Command of a robot in the worlds of the others: the action of its learner, rest once its episode has ended."""

    def __init__(self, robot: Robot, action: str, turn_rate: float, acceleration: float, period: float) -> None:
        self.fastest, self.force, self.turn_rate = robot.body.max_speed, robot.body.mass * acceleration, turn_rate
        wheels = action == "unicycle" and isinstance(robot.body, DifferentialDriveRobot)
        self.kind, self.period = "twist" if wheels else action, period
        self.ahead = math.atan2(robot.goal[1] - robot.start[1], robot.goal[0] - robot.start[0])
        self.reset()

    def reset(self) -> None:
        """Start an episode."""
        self.heading = self.ahead
        self.rest()

    def tell(self, action: Array) -> None:
        """Take an action in [-1, 1], as the environment does."""
        x, y = (min(max(float(share), -1.0), 1.0) for share in action)
        if self.kind == "twist":
            self.request = {"twist": (x * self.fastest, y * self.turn_rate)}
        elif self.kind == "unicycle":
            self.heading += y * self.turn_rate * self.period
            ahead = math.cos(self.heading), math.sin(self.heading)
            self.request = {"velocity": (ahead[0] * (x * self.fastest), ahead[1] * (x * self.fastest))}
        elif self.kind == "acceleration":
            self.request = {"force": (x * self.force, y * self.force)}
        else:
            length = math.sqrt(x * x + y * y)
            if length > 1.0:
                x, y = x / length, y / length
            self.request = {"velocity": (x * self.fastest, y * self.fastest)}

    def rest(self) -> None:
        """Come to rest and stay there."""
        self.request = {"velocity": (0.0, 0.0)}


def _driven(world: World) -> list[int]:
    """Return which robots a learner drives."""
    found = [index for index, robot in enumerate(world.robots) if robot.law is None]
    if not found:
        raise InvalidParameterError("world.robots", "hold a robot without a law, to drive", Shown("none"))
    periods = {index: world.robots[index].control_period or world.step for index in found}
    for index, period in periods.items():
        if not math.isclose(period, periods[found[0]], rel_tol=1e-9):
            rule = f"share the control period of robots[{found[0]}], {periods[found[0]]:g} s"
            raise InvalidParameterError(f"world.robots[{index}].control_period", rule, period)
    return found


def _check_size(world: World, driven: int) -> None:
    """Refuse robots whose worlds, one of each that is driven, would not fit into memory together."""
    robots, people = len(world.robots), len(world.people)
    pairs = driven * max(robots - 1, 0) * (robots + people)
    if pairs > MOST_SIGHTINGS:
        rule = f"be few: each driven one has a world in which all others see everybody, {MOST_SIGHTINGS} pairs at most"
        remedy = f"{driven} driven of {robots} robots among {people} people make {pairs} pairs"
        raise InvalidParameterError("world.robots", rule, Shown(f"{robots} robots"), remedy)


class CrowdParallelEnv(ParallelEnv[str, Any, Action]):  # type: ignore[misc]  # PettingZoo has no types
    """Robots that a learner drives side by side in one world; made by `parallel_env`.

    Parameters
    ----------
    world : World, Scenario or Task
        As of `parallel_env`.
    render_mode : {"rgb_array"} or None
        Whether pictures are asked for.
    **options
        As of `CrowdEnv`.

    Attributes
    ----------
    possible_agents, agents : list of str
        All robots that are driven, and those whose episode is under way.

    Raises
    ------
    InvalidParameterError
        As `parallel_env`.

    Examples
    --------
    >>> from hrsafety import gym, scenarios
    >>> env = gym.parallel_env(scenarios.antipodal(6, robots=2))
    >>> env.possible_agents
    ['robot_0', 'robot_1']
    """

    metadata: dict[str, Any] = {  # noqa: RUF012  # as PettingZoo has it
        "name": "hrsafety_crowd",
        "render_modes": list(RENDER_MODES),
        "render_fps": 4,
        "is_parallelizable": True,
    }

    def __init__(self, world: Place | Task, *, render_mode: str | None = None, **options: Any) -> None:
        """Make the environment."""
        task = task_of(world)
        driven = _driven(task.world)
        _check_size(task.world, len(driven))
        self.render_mode = render_mode
        self.possible_agents = [f"robot_{index}" for index in driven]
        self.agents: list[str] = []
        self._told = {name: self._listener(task.world, index, options) for name, index in self._numbered(driven)}
        self._envs = {
            name: CrowdEnv(self._seen_by(task, index), render_mode=render_mode, **options)
            for name, index in self._numbered(driven)
        }
        self._action_spaces = {name: env.action_space for name, env in self._envs.items()}
        self._observation_spaces = {name: env.observation_space for name, env in self._envs.items()}
        self._seeded, self._shown = False, self.possible_agents[0]
        self._doubts = task.world.warnings

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts about the world."""
        return self._doubts

    def _numbered(self, driven: list[int]) -> list[tuple[str, int]]:
        return list(zip(self.possible_agents, driven, strict=True))

    @staticmethod
    def _listener(world: World, index: int, options: Mapping[str, Any]) -> _Told:
        """Return what repeats the actions of a robot in the worlds of the others."""
        robot = world.robots[index]
        acceleration = options.get("max_acceleration")
        return _Told(
            robot,
            word("action", options.get("action", "velocity"), get_args(ActionKind)),
            turn_rate_of(robot.body, options.get("max_turn_rate")),
            robot.body.max_acceleration if acceleration is None else positive("max_acceleration", acceleration),
            robot.control_period or world.step,
        )

    def _seen_by(self, task: Task, index: int) -> Task:
        """Return the task with a robot in front of the others, which are told what to do."""
        robots = list(task.world.robots)
        robots[0], robots[index] = robots[index], robots[0]
        return replace(task, world=replace(task.world, robots=robots))

    def _tell(self, name: str) -> None:
        """Tell the others in the world of a robot what their learners want."""
        own = int(name.removeprefix("robot_"))
        for other, told in self._told.items():
            index = int(other.removeprefix("robot_"))
            if other != name:
                # The robot of the world stands in the place of the first one, and that one in its place.
                self._envs[name]._all.ask(0, own if index == 0 else index, told.request)

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """Return what a robot may see, always the same object.

        Parameters
        ----------
        agent : str
            Which robot.

        Returns
        -------
        gymnasium.spaces.Space
            As of `CrowdEnv`.

        Raises
        ------
        InvalidParameterError
            If there is no such robot.
        """
        return self._observation_spaces[word("agent", agent, self.possible_agents)]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """Return what a robot may be told, always the same object.

        Parameters
        ----------
        agent : str
            Which robot.

        Returns
        -------
        gymnasium.spaces.Space
            As of `CrowdEnv`.

        Raises
        ------
        InvalidParameterError
            If there is no such robot.
        """
        return self._action_spaces[word("agent", agent, self.possible_agents)]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
        """Start an episode of all robots: the first one of a seed, else the next one.

        Parameters
        ----------
        seed : int or None
            Seed of this episode and those that follow.
        options : dict or None
            Not used.

        Returns
        -------
        observations, infos : dict
            Of each robot.
        """
        if seed is None and not self._seeded:
            seed = int(np.random.default_rng().integers(2**62))  # the same for the worlds of all robots
        if seed is not None:
            checked_seed("seed", seed)  # before anything of the episode under way is forgotten
        self._seeded = True
        for told in self._told.values():
            told.reset()
        self.agents = list(self.possible_agents)
        self._shown = self.agents[0]
        found = {name: env.reset(seed=seed, options=options) for name, env in self._envs.items()}
        infos = {name: info | self._apart(name) for name, (_, info) in found.items()}
        return {name: seen for name, (seen, _) in found.items()}, infos

    def step(
        self, actions: Mapping[str, npt.ArrayLike]
    ) -> tuple[dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]:
        """Drive all robots whose episode is under way for one control period.

        Parameters
        ----------
        actions : mapping of str to array_like, shape (2,)
            Numbers from -1 to 1 for each of ``agents``.

        Returns
        -------
        observations, rewards, terminations, truncations, infos : dict
            Of each robot whose episode was under way.
        """
        given = self._checked(actions)
        for name, action in given.items():
            self._told[name].tell(action)
        for name in given:
            self._tell(name)
        found = {name: self._envs[name].step(action) for name, action in given.items()}
        for name, (_, _, terminated, truncated, _) in found.items():
            if terminated or truncated:
                self._told[name].rest()
        infos = {name: each[4] | self._apart(name) for name, each in found.items()}
        self.agents = [name for name, each in found.items() if not (each[2] or each[3])]
        # The world of a robot stands still when its episode has ended.
        self._shown = next(iter(self.agents or found), self._shown)
        seen = {name: each[0] for name, each in found.items()}
        ends = {name: each[2] for name, each in found.items()}, {name: each[3] for name, each in found.items()}
        return seen, {name: each[1] for name, each in found.items()}, *ends, infos

    def _checked(self, actions: Mapping[str, npt.ArrayLike]) -> dict[str, Array]:
        """Return an action for each robot under way, in their order."""
        if not isinstance(actions, Mapping) or set(actions) != set(self.agents):
            named = list(actions) if isinstance(actions, Mapping) else actions
            if not self.agents:
                remedy = "start an episode by reset first"
                raise InvalidParameterError("actions", "be for robots whose episode is under way", named, remedy)
            raise InvalidParameterError("actions", f"name each of {self.agents}", named)
        found = {name: numbers(f"actions[{name!r}]", actions[name]) for name in self.agents}
        for name, action in found.items():
            if action.shape != (2,):
                raise ShapeError(f"actions[{name!r}]", "(2,)", action.shape)
            if not np.isfinite(action).all():
                raise InvalidParameterError(f"actions[{name!r}]", "be finite", action.tolist())
        return found

    def _apart(self, name: str) -> dict[str, float]:
        """Return the gap to the nearest other robot in m; infinite without any."""
        env = self._envs[name]
        (place, radius), _, others = env._all.places(0)
        wrap = env._all.task.world.period
        gaps = [math.hypot(*wrapped(np.subtract(other, place), wrap)) - radius - room for other, room in others]
        return {"robot_clearance": min(gaps, default=math.inf)}

    def render(self) -> Frame | None:
        """Return a picture of the world, if pictures are asked for.

        Returns
        -------
        ndarray of uint8, shape (height, width, 3), or None
            The picture.
        """
        if self.render_mode is None:
            gymnasium.logger.warn('render() needs render_mode="rgb_array" when the environment is made')
            return None
        return self._envs[self._shown].render()
