"""Environments side by side as arrays: what both faces, the single one and the vector, are made of."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal, NoReturn

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from hrsafety import _hrsafety
from hrsafety._arguments import count, flag, number, numbers, positive, thread_count, word
from hrsafety._calls import suggesting
from hrsafety.errors import InvalidParameterError, ShapeError, SimulationError
from hrsafety.gym.worlds import Task, task_of
from hrsafety.navigation.metrics.declared import METRICS
from hrsafety.navigation.place import Place
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.plausibility import ResultWarning, warn_implausible

__all__ = ["Environments", "Frame"]

Frame = npt.NDArray[np.uint8]

_WORDS, _BOUND, _RANGE = _hrsafety.environment_words()
OUTCOMES = np.array(_WORDS, dtype=object)
RUNNING, TIMED_OUT = _WORDS.index("running"), _WORDS.index("timed_out")
_OWN, _PERSON = 6, 5
ELAPSED = _OWN - 1
"""Place of the share of the time limit in an observation."""
_MOST_SEEN = 10_000
_MOST_ENVIRONMENTS = 2**20

ActionKind = Literal["velocity", "acceleration", "unicycle"]


def turn_rate_of(robot: HolonomicRobot | DifferentialDriveRobot, given: float | None) -> float:
    """Return the greatest turn rate of actions in rad/s: at most what the robot has."""
    own = getattr(robot, "max_turn_rate", None)
    if given is None:
        return math.pi if own is None else min(math.pi, own)
    rate = positive("max_turn_rate", given)
    warn_implausible({"max_turn_rate": rate}, {"max_turn_rate": "robot_max_turn_rate"}, stacklevel=5)
    if own is not None and rate > own:
        remedy = "give the robot a larger max_turn_rate, or none here"
        raise InvalidParameterError("max_turn_rate", f"be at most that of the robot, {own:g} rad/s", given, remedy)
    return rate


class Environments:
    """A number of native environments with their arrays and spaces."""

    @suggesting  # both faces hand options on
    def __init__(
        self,
        task: Task | Place,
        *,
        num_envs: int,
        autoreset_mode: str,
        threads: int | None,
        action: str = "velocity",
        observation: str = "flat",
        frame: str = "world",
        people: int = 5,
        lidar: int = 0,
        progress: float = 0.0,
        step_reward: float = 0.0,
        max_acceleration: float | None = None,
        max_turn_rate: float | None = None,
        metrics: bool = True,
        copy: bool = True,
    ) -> None:
        self.task = task_of(task)
        self.count = count("num_envs", num_envs, most=_MOST_ENVIRONMENTS)
        self.is_dict = word("observation", observation, ("flat", "dict")) == "dict"
        self.people = count("people", people, least=0, most=_MOST_SEEN)
        self.lidar = count("lidar", lidar, least=0, most=_MOST_SEEN)
        self.frame = frame
        self.metrics, self.copy = flag("metrics", metrics), flag("copy", copy)
        self.size = _OWN + _PERSON * self.people + self.lidar
        world = self.task.world
        if not world.robots:
            raise InvalidParameterError("world.robots", "hold a robot to drive", 0)
        fastest = world.robots[0].body.max_acceleration if max_acceleration is None else max_acceleration
        self._native = _hrsafety.CrowdEnvironments(
            world._native,
            self.count,
            world.seed,
            thread_count(threads),
            circle=self.task.circle,
            area=self.task.area,
            action=action,
            frame=frame,
            people=self.people,
            lidar=self.lidar,
            progress=number("progress", progress),
            step_reward=number("step_reward", step_reward),
            max_acceleration=positive("max_acceleration", fastest),
            max_turn_rate=turn_rate_of(world.robots[0].body, max_turn_rate),
            autoreset_mode=autoreset_mode,
            metrics=self.metrics,
        )
        self.final = np.zeros((self.count, self.size), dtype=np.float32)
        self.scores = np.full((self.count, len(METRICS)), np.nan)
        self.seen = np.zeros((self.count, 2), dtype=np.int64)
        self._make_arrays()

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts about the world."""
        return self.task.world.warnings

    def __reduce__(self) -> NoReturn:
        """Refuse for those that hold these: episodes under way are not copied."""
        rule = "an environment cannot be copied or pickled; make another with the same arguments and reset it"
        raise SimulationError(rule)

    def _make_arrays(self) -> None:
        """Make the arrays that are returned; every start and step writes all observations."""
        self.observations = np.empty((self.count, self.size), dtype=np.float32)
        self.rewards = np.zeros(self.count)
        self.states = np.zeros(self.count, dtype=np.uint8)
        self.started = np.zeros(self.count, dtype=np.bool_)
        self.clearances = np.full(self.count, np.inf)
        self.wall_rescues = np.zeros(self.count, dtype=np.int64)

    def _arrays(self) -> dict[str, npt.NDArray[Any]]:
        if self.copy:
            self._make_arrays()
        return {
            "observations": self.observations,
            "final_observations": self.final,
            "seen": self.seen,
            "rewards": self.rewards,
            "states": self.states,
            "started": self.started,
            "clearances": self.clearances,
            "wall_rescues": self.wall_rescues,
            "metrics": self.scores,
        }

    def reset(self, seeds: list[int | None], mask: npt.NDArray[np.bool_] | None) -> None:
        """Start episodes, where the mask says so if there is one."""
        arrays = self._arrays()
        self.clearances[:] = np.inf
        self._native.reset(seeds, np.empty(0, dtype=np.bool_) if mask is None else mask, arrays)

    def step(self, actions: npt.ArrayLike) -> None:
        """Step all of them by actions, shape (n, 2)."""
        self._native.step(self._checked(actions), self._arrays())

    def _checked(self, actions: npt.ArrayLike) -> npt.NDArray[np.float64]:
        given = numbers("action", actions)
        if given.shape != (self.count, 2):
            raise ShapeError("action", f"({self.count}, 2)", given.shape)
        if not np.isfinite(given).all():
            index = int(np.flatnonzero(~np.isfinite(given).all(axis=1))[0])
            raise InvalidParameterError(f"action[{index}]", "be finite", given[index])
        return given

    def places(self, index: int) -> Any:
        """Return positions and radii of the robot, the people and the other robots of one environment."""
        return self._native.places(index)

    def ask(self, index: int, robot: int, request: Mapping[str, tuple[float, float]]) -> None:
        """Tell another robot of one environment a ``force``, ``velocity`` or ``twist``, which it keeps."""
        told = {name: request.get(name) for name in ("force", "velocity", "twist")}
        self._native.ask(index, robot, **told)

    def headings(self, index: int) -> list[float]:
        """Return the headings of the robots of one environment in rad."""
        return self._native.headings(index) or []

    # ---- spaces ---------------------------------------------------------------------------------

    def action_space(self) -> spaces.Box:
        """Return the space of one action."""
        return spaces.Box(-1.0, 1.0, (2,), np.float32)

    def observation_space(self) -> spaces.Space[Any]:
        """Return the space of one observation."""
        low = np.full(self.size, -_BOUND, dtype=np.float32)
        high = np.full(self.size, _BOUND, dtype=np.float32)
        low[ELAPSED], high[ELAPSED] = 0.0, 1.0
        if self.lidar:
            low[-self.lidar :], high[-self.lidar :] = 0.0, _RANGE
        if not self.is_dict:
            return spaces.Box(low, high, dtype=np.float32)
        parts = self._parts(low[None], high[None])
        found: dict[str, spaces.Space[Any]] = {
            name: spaces.Box(lows[0], highs[0], dtype=np.float32) for name, (lows, highs) in parts.items()
        }
        found["mask"] = spaces.Box(0.0, 1.0, (self.people,), np.float32)
        return spaces.Dict(found)

    def _parts(self, *flat: npt.NDArray[np.float32]) -> dict[str, tuple[npt.NDArray[np.float32], ...]]:
        """Return the parts of flat observations by name."""
        ends = _OWN + _PERSON * self.people
        found = {
            "robot": tuple(rows[:, :_OWN] for rows in flat),
            "people": tuple(rows[:, _OWN:ends].reshape(len(rows), self.people, _PERSON) for rows in flat),
        }
        if self.lidar:
            found["lidar"] = tuple(rows[:, ends:] for rows in flat)
        return found

    def shown(self, flat: npt.NDArray[np.float32], seen: npt.NDArray[np.int64]) -> Any:
        """Return observations, flat rows and how many people are there, as the space has them."""
        if not self.is_dict:
            return flat
        found = {name: np.ascontiguousarray(rows) for name, (rows,) in self._parts(flat).items()}
        found["mask"] = (np.arange(self.people) < seen[:, None]).astype(np.float32)
        return found
