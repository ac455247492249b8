"""One environment with the interface of Gymnasium."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from hrsafety._arguments import checked_seed, numbers, word
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.gym.environments import OUTCOMES, RUNNING, TIMED_OUT, Environments, Frame
from hrsafety.gym.pictures import picture
from hrsafety.gym.worlds import Task
from hrsafety.navigation.metrics.declared import METRICS
from hrsafety.navigation.place import Place
from hrsafety.plausibility import ResultWarning, kind_of, telling

__all__ = ["CrowdEnv"]

RENDER_MODES = ("rgb_array",)

Draw = Callable[[np.random.Generator], Place | Task]
"""Returns the world of an episode."""


class CrowdEnv(gymnasium.Env[Any, npt.NDArray[np.float32]]):
    """A robot that a learner drives among people.

    Parameters
    ----------
    world : World, Scenario, Task or callable
        Any world with a robot, or the task of a registered environment. The first robot is driven; the others
        follow their laws. A function ``draw(generator)`` returns one of them for each episode, from a
        `numpy.random.Generator` of its own: random starts, goals, people, walls.
    render_mode : {"rgb_array"} or None
        Whether pictures are asked for.
    action : {"velocity", "acceleration", "unicycle"}
        What an action in [-1, 1] x [-1, 1] means: a velocity as a share of the greatest speed, shortened to it; an
        acceleration; or a speed, backward below 0, and a turn rate.
    observation : {"flat", "dict"}
        One array, or ``robot``, ``people``, ``mask`` and ``lidar``.
    frame : {"world", "goal"}
        Axes of all vectors that are shown; ``"goal"``: the x axis points from the robot to its goal. Actions are along
        the axes of the world.
    people : int
        How many of the nearest people are seen.
    lidar : int
        Number of rays of up to 10 m, counterclockwise from the x axis.
    progress, step_reward : float
        Reward for each meter that the goal comes nearer, and for each step.
    max_acceleration : float or None
        In m/s^2; that of the robot when ``None``.
    max_turn_rate : float or None
        Of the action "unicycle", in rad/s. ``None``: that of the robot, at most pi; a larger one than the robot has is
        refused.
    metrics : bool
        Whether ``info["metrics"]`` has the social metrics of an episode at its end.
    copy : bool
        Whether observations are new arrays; else the next step overwrites them.

    Raises
    ------
    InvalidParameterError
        If a value is out of range or a word is unknown.
    MissingExtraError
        If a picture is asked for without matplotlib.

    Notes
    -----
    An environment can be copied and pickled at any step: the copy makes the world anew and repeats the actions of its
    episode, with the same bits from then on.

    An observation holds, of the robot: position of the goal from it, velocity, greatest speed, share of the time
    limit; of each person: position and velocity relative to the robot, distance of the surfaces; zeros where
    there is no person. Vectors are clipped to 100.

    The reward is that of CrowdNav: 1 for arrival, -0.25 for a contact, else -0.5 times what the least distance to
    the people within the step lacks to 0.2 m, times the step.

    Examples
    --------
    >>> import gymnasium, hrsafety.gym
    >>> env = gymnasium.make("hrsafety/CircleCrossing-v0", lidar=16)
    >>> observation, info = env.reset(seed=3)
    >>> observation.shape, info["outcome"]
    ((47,), 'running')
    """

    metadata: dict[str, Any] = {"render_modes": list(RENDER_MODES), "render_fps": 4}  # noqa: RUF012  # as Gymnasium has it

    def _not_told(self, *_: object, **__: object) -> tuple[ResultWarning, ...]:
        """Return the doubts that have come since they were asked for."""
        found = self.warnings[self._told :]
        self._told += len(found)
        return found

    @telling(_not_told, every=True)
    def __init__(self, world: Place | Task | Draw, *, render_mode: str | None = None, **options: Any) -> None:
        """Make the environment."""
        if render_mode is not None:
            word("render_mode", render_mode, RENDER_MODES)
        self._made = world, options
        # What an episode is repeated from: first seed, episodes since, and actions.
        self._seed: int | None = None
        self._episodes = 0
        self._actions: list[npt.NDArray[np.float64]] = []
        self._doubts: dict[tuple[str, str], ResultWarning] = {}
        self._told = 0
        self._all = self._environments(np.random.default_rng(0))
        self.render_mode = render_mode
        self.action_space: spaces.Space[Any] = self._all.action_space()
        self.observation_space = self._all.observation_space()
        self._seeded = False

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts about the world; of worlds that are drawn, the first of each kind so far."""
        return tuple(self._doubts.values())

    @telling(_not_told, every=True)
    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Start an episode: the first one of a seed, else the next one.

        Parameters
        ----------
        seed : int or None
            Seed of this episode and those that follow.
        options : mapping or None
            Not used.

        Returns
        -------
        observation : ndarray or dict
            What the robot sees.
        info : dict
            As of `step`.
        """
        if options is not None and not isinstance(options, Mapping):
            raise InvalidParameterError("options", "be a mapping or None", options)
        super().reset(seed=seed, options=None if options is None else dict(options))
        if seed is None and not self._seeded:
            seed = int(self.np_random.integers(2**63))
        self._seeded = True
        if seed is not None:
            self._seed, self._episodes = checked_seed("seed", seed), 0
        self._start(seed)
        return self._observation(), self._info()

    def _environments(self, generator: np.random.Generator) -> Environments:
        """Return the native environment, of a world that is drawn if worlds are."""
        world, options = self._made
        drawn = world if isinstance(world, (Place, Task)) or not callable(world) else world(generator)
        made = Environments(drawn, num_envs=1, autoreset_mode="Disabled", threads=1, **options)
        for doubt in made.warnings:
            self._doubts.setdefault(kind_of(doubt), doubt)
        return made

    def _start(self, seed: int | None) -> None:
        """Start the next episode."""
        world, _ = self._made
        self._actions = []
        self._episodes += 1
        if not isinstance(world, (Place, Task)):
            episode = np.random.SeedSequence([self._seed or 0, self._episodes])
            first, other = episode.spawn(2)
            self._all = self._environments(np.random.default_rng(first))
            if self._all.observation_space() != self.observation_space:
                raise InvalidParameterError("world", "have one observation space in all episodes", self._episodes)
            seed = int(other.generate_state(1, np.uint64)[0])
        self._all.reset([seed], None)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle by what the episode is repeated from."""
        world, options = self._made
        state = self._seed, self._episodes, self._seeded, self._actions, self._np_random, self._np_random_seed
        return _repeated, (type(self), world, self.render_mode, options, self.spec, state)

    def _repeat(self, state: tuple[Any, ...]) -> None:
        self._seed, episodes, self._seeded, actions, self._np_random, self._np_random_seed = state
        world, _ = self._made
        if episodes and isinstance(world, (Place, Task)):
            for episode in range(episodes):
                self._start(self._seed if episode == 0 else None)
        elif episodes:
            self._episodes = episodes - 1
            self._start(None)
        for action in actions:
            self._all.step(action[None])
        self._actions = list(actions)

    def step(self, action: npt.ArrayLike) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Drive the robot for one control period.

        Parameters
        ----------
        action : array_like, shape (2,)
            Numbers from -1 to 1; larger ones count as these.

        Returns
        -------
        observation : ndarray or dict
            What the robot sees.
        reward : float
            The reward.
        terminated, truncated : bool
            Whether the robot has arrived or touched a person; whether the time is over.
        info : dict
            ``outcome``, ``clearance`` in m, ``wall_rescues``: how often in the episode people were set back at a wall
            that their model would have led them through, and ``metrics`` at the end.
        """
        given = numbers("action", action)
        if given.shape != (2,):
            raise ShapeError("action", "(2,)", given.shape)
        self._all.step(given[None])
        self._actions.append(given.copy())
        state = int(self._all.states[0])
        ended = state != RUNNING
        info = self._info()
        if ended and self._all.metrics:
            info["metrics"] = scores(self._all.scores[0])
        reward = float(self._all.rewards[0])
        return self._observation(), reward, ended and state != TIMED_OUT, state == TIMED_OUT, info

    def _observation(self) -> Any:
        found = self._all.shown(self._all.observations, self._all.seen[:, 0])
        return {name: rows[0] for name, rows in found.items()} if isinstance(found, dict) else found[0]

    def _info(self) -> dict[str, Any]:
        return {
            "outcome": str(OUTCOMES[self._all.states[0]]),
            "clearance": float(self._all.clearances[0]),
            "wall_rescues": int(self._all.wall_rescues[0]),
        }

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
        return picture(self._all, 0)


def _repeated(
    kind: type[CrowdEnv],
    world: Place | Task | Draw,
    render_mode: str | None,
    options: dict[str, Any],
    spec: Any,
    state: tuple[Any, ...],
) -> CrowdEnv:
    """Return a copy of an environment in the midst of its episode."""
    made = kind(world, render_mode=render_mode, **options)
    made.spec = spec
    made._repeat(state)
    return made


def scores(row: npt.NDArray[np.float64]) -> dict[str, float | int | bool]:
    """Return a row of metrics by name, flags and counts as such."""
    kinds = {"number": float, "count": int, "flag": bool}
    return {metric.name: kinds[metric.kind](value) for metric, value in zip(METRICS.values(), row, strict=True)}
