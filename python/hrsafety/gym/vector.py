"""Many environments with the vector interface of Gymnasium, stepped by one call of the core."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from hrsafety._arguments import checked_seed, sequence, word
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.gym.environments import OUTCOMES, RUNNING, TIMED_OUT, Environments, Frame
from hrsafety.gym.pictures import picture
from hrsafety.gym.single import RENDER_MODES
from hrsafety.gym.worlds import Task
from hrsafety.navigation.metrics.declared import METRICS
from hrsafety.navigation.place import Place
from hrsafety.plausibility import ResultWarning, telling

__all__ = ["CrowdVectorEnv"]

Flags = npt.NDArray[np.bool_]


class CrowdVectorEnv(gymnasium.vector.VectorEnv[Any, npt.NDArray[np.float32], npt.NDArray[Any]]):
    """Robots that a learner drives among people, each in a world of its own.

    Environment i of seed s behaves, bit for bit, as `CrowdEnv` of seed s + i, for any number of environments and
    threads.

    Parameters
    ----------
    world : World, Scenario or Task
        As of `CrowdEnv`.
    num_envs : int
        How many.
    autoreset_mode : AutoresetMode or str
        ``"NextStep"``: the step after an end starts the next episode. ``"SameStep"``: the step that ends an episode
        does, and its info has ``final_obs`` and ``final_info``. ``"Disabled"``: the caller does, by
        ``reset(options={"reset_mask": ...})``.
    threads : int or None
        Number of threads; all cores when ``None``.
    render_mode : {"rgb_array"} or None
        Whether pictures are asked for.
    copy : bool
        Whether arrays that are returned are new ones; else the next step overwrites them.
    **options
        As of `CrowdEnv`.

    Raises
    ------
    InvalidParameterError
        If a value is out of range or a word is unknown.

    Examples
    --------
    >>> import gymnasium, hrsafety.gym
    >>> envs = gymnasium.make_vec("hrsafety/CircleCrossing-v0", num_envs=64, threads=1)
    >>> observations, infos = envs.reset(seed=0)
    >>> observations, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
    >>> observations.shape, rewards.shape
    ((64, 31), (64,))
    """

    @telling(lambda env, *_, **__: env.warnings, every=True)
    def __init__(
        self,
        world: Place | Task,
        *,
        num_envs: int = 1,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = 1,
        render_mode: str | None = None,
        copy: bool = True,
        **options: Any,
    ) -> None:
        """Make the environments."""
        if render_mode is not None:
            word("render_mode", render_mode, RENDER_MODES)
        if not isinstance(autoreset_mode, AutoresetMode):
            word("autoreset_mode", autoreset_mode, [mode.value for mode in AutoresetMode])
        self._mode = AutoresetMode(autoreset_mode)
        self._all = Environments(
            world, num_envs=num_envs, autoreset_mode=self._mode.value, threads=threads, copy=copy, **options
        )
        self.num_envs = self._all.count
        self.render_mode = render_mode
        self.metadata = {"render_modes": list(RENDER_MODES), "render_fps": 4, "autoreset_mode": self._mode}
        self.single_action_space = self._all.action_space()
        self.single_observation_space = self._all.observation_space()
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self._seeded = False

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts about the world."""
        return self._all.warnings

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start episodes: the first ones of seeds, else the next ones.

        Parameters
        ----------
        seed : int, sequence of int, or None
            Environment i gets ``seed + i``, or the i-th of a sequence.
        options : dict or None
            ``reset_mask``: which environments start an episode, an array of bool.

        Returns
        -------
        observations : ndarray or dict
            What the robots see.
        infos : dict
            As of `step`.
        """
        mask = self._mask(options)
        super().reset(seed=seed if isinstance(seed, int) else None)
        if seed is None and not self._seeded:
            seed = int(self.np_random.integers(2**62))
        self._seeded = True
        self._all.reset(self._seeds(seed), mask)
        everybody = np.ones(self.num_envs, dtype=np.bool_) if mask is None else mask
        return self._observations(), self._infos(everybody)

    def _seeds(self, seed: int | Sequence[int | None] | None) -> list[int | None]:
        if seed is None:
            return []
        if isinstance(seed, (int, np.integer)):
            first = checked_seed("seed", seed)
            last = checked_seed("seed + num_envs - 1", first + self.num_envs - 1)
            return list(range(first, last + 1))
        given = sequence("seed", "be an integer, or one for each environment", seed)
        if len(given) != self.num_envs:
            raise ShapeError("seed", f"({self.num_envs},)", (len(given),))
        return [None if each is None else checked_seed(f"seed[{index}]", each) for index, each in enumerate(given)]

    def _mask(self, options: dict[str, Any] | None) -> Flags | None:
        if options is None:
            return None
        if not isinstance(options, Mapping):
            raise InvalidParameterError("options", "be a mapping or None", options)
        if "reset_mask" not in options:
            return None
        mask = options["reset_mask"]
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_ or mask.shape != (self.num_envs,):
            shown = Shown(f"{mask.dtype} of shape {mask.shape}") if isinstance(mask, np.ndarray) else mask
            raise InvalidParameterError("reset_mask", f"be an array of bool, shape ({self.num_envs},)", shown)
        if not mask.any():
            raise InvalidParameterError("reset_mask", "name an environment", Shown("none"))
        return np.ascontiguousarray(mask)

    def step(self, actions: npt.ArrayLike) -> tuple[Any, npt.NDArray[np.float64], Flags, Flags, dict[str, Any]]:
        """Drive all robots for one control period.

        Parameters
        ----------
        actions : array_like, shape (n, 2)
            Numbers from -1 to 1; larger ones count as these.

        Returns
        -------
        observations : ndarray or dict
            What the robots see.
        rewards : ndarray, shape (n,)
            The rewards.
        terminated, truncated : ndarray of bool, shape (n,)
            Whether a robot has arrived or touched a person; whether its time is over.
        infos : dict
            ``outcome``, ``clearance`` in m, ``wall_rescues`` of the episode, ``metrics`` of those that have ended.
        """
        self._all.step(actions)
        states = self._all.states
        ended, truncated = states != RUNNING, states == TIMED_OUT
        return self._observations(), self._all.rewards, ended ^ truncated, truncated, self._step_infos(ended)

    def _observations(self) -> Any:
        return self._all.shown(self._all.observations, self._all.seen[:, 0])

    def _infos(self, those: Flags) -> dict[str, Any]:
        """Return the information about those at the start of an episode."""
        outcomes = np.where(those, OUTCOMES[RUNNING], None)
        return {
            "outcome": outcomes,
            "_outcome": those,
            "clearance": np.where(those, self._all.clearances, 0.0),
            "_clearance": those.copy(),
            "wall_rescues": np.where(those, self._all.wall_rescues, 0),
            "_wall_rescues": those.copy(),
        }

    def _step_infos(self, ended: Flags) -> dict[str, Any]:
        everybody = np.ones(self.num_envs, dtype=np.bool_)
        infos: dict[str, Any] = {
            "outcome": OUTCOMES[self._all.states],
            "_outcome": everybody,
            "clearance": self._all.clearances.copy(),
            "_clearance": everybody.copy(),
            "wall_rescues": self._all.wall_rescues.copy(),
            "_wall_rescues": everybody.copy(),
        }
        if not ended.any():
            return infos
        metrics = {"metrics": self._scores(ended), "_metrics": ended.copy()} if self._all.metrics else {}
        if self._mode is not AutoresetMode.SAME_STEP:
            return infos | metrics
        final = {
            "outcome": np.where(ended, infos["outcome"], None),
            "_outcome": ended.copy(),
            "clearance": np.where(ended, infos["clearance"], 0.0),
            "_clearance": ended.copy(),
            "wall_rescues": np.where(ended, infos["wall_rescues"], 0),
            "_wall_rescues": ended.copy(),
        }
        infos["outcome"] = np.where(ended, OUTCOMES[RUNNING], infos["outcome"])
        infos["clearance"][ended], infos["wall_rescues"][ended] = np.inf, 0
        infos |= {"final_obs": self._final(ended), "_final_obs": ended.copy()}
        return infos | {"final_info": final | metrics, "_final_info": ended.copy()}

    def _scores(self, ended: Flags) -> dict[str, Any]:
        """Return a column of each metric, 0 for those whose episode is under way, and who has one."""
        kinds: dict[str, type] = {"number": np.float64, "count": np.int64, "flag": np.bool_}
        those = np.flatnonzero(ended)
        scores = self._all.scores[those].T
        found: dict[str, Any] = {}
        for metric, column in zip(METRICS.values(), scores, strict=True):
            values: npt.NDArray[Any] = np.zeros(self.num_envs, dtype=kinds[metric.kind])
            values[those] = column
            found[metric.name] = values
            found[f"_{metric.name}"] = ended.copy()
        return found

    def _final(self, ended: Flags) -> npt.NDArray[Any]:
        """Return the last observations of the episodes that have ended, each as one environment shows it."""
        last = self._all.shown(self._all.final.copy(), self._all.seen[:, 1])
        found = np.full(self.num_envs, None, dtype=object)
        for index in np.flatnonzero(ended):
            found[index] = {name: rows[index] for name, rows in last.items()} if isinstance(last, dict) else last[index]
        return found

    def render(self) -> tuple[Frame, ...] | None:
        """Return a picture of each world, if pictures are asked for.

        Returns
        -------
        tuple of ndarray of uint8, shape (height, width, 3), or None
            The pictures.
        """
        if self.render_mode is None:
            return None
        return tuple(picture(self._all, index) for index in range(self.num_envs))
