"""Runs of the follower: whole, or advanced from outside, one control period at a time."""

from __future__ import annotations

from typing import Any

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import checked_seed, finite_pair, instance
from hrsafety.reactive.follower.impedance import VirtualImpedance
from hrsafety.reactive.follower.runs import Follower, FollowerRun
from hrsafety.reactive.follower.scenes import FollowerScene
from hrsafety.reactive.percept import Percept
from hrsafety.reactive.stepped import Stepped

__all__ = ["FollowerSteps", "follow"]


class FollowerSteps(Stepped[FollowerRun]):
    """A run of the follower that is advanced from outside, one control period at a time.

    Stepped to its end without forces, a run has the same bits as `follow`.

    Parameters
    ----------
    scene : FollowerScene
        Leader, obstacles and length.
    law : VirtualImpedance or None
        Repulsion; `VirtualImpedance` when ``None``.
    follower : Follower or None
        The robot; `Follower` when ``None``.
    seed : int
        Seed of the scatter of bursts and readings.

    Raises
    ------
    InvalidParameterError
        If an argument is of the wrong kind or out of range.

    Notes
    -----
    Runs are independent of each other and may be stepped in turn, or each in a thread of its own.
    A run that is under way cannot be copied or pickled.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> scene = reactive.FollowerScene(
    ...     leader=reactive.SoundLeader(start=(1.2, 0.0), end=(3.0, 0.0)),
    ...     obstacles=[reactive.Box(center=(1.5, 1.2), size=(0.5, 0.5))], duration=10.0,
    ... )
    >>> run = reactive.FollowerSteps(scene)
    >>> while not run.finished:
    ...     seen = run.step()
    >>> run.record.collided, len(run.record)
    (False, 401)

    A force in place of that of the law drives the virtual mass for one control period:

    >>> run = reactive.FollowerSteps(scene)
    >>> while run.time < 1.0:
    ...     seen = run.step(force=(0.0, 2.0))
    >>> bool(seen.position[1] > 0.05)
    True
    """

    __slots__ = ("_follower", "_scene")
    _native: _hrsafety.FollowerSteps

    def __init__(
        self,
        scene: FollowerScene,
        law: VirtualImpedance | None = None,
        follower: Follower | None = None,
        *,
        seed: int = 0,
    ) -> None:
        self._scene = instance("scene", scene, FollowerScene)
        law = VirtualImpedance() if law is None else instance("law", law, VirtualImpedance)
        self._follower = Follower() if follower is None else instance("follower", follower, Follower)
        leader = scene.leader
        self._native = _hrsafety.FollowerSteps(
            self._follower._native,
            law._native,
            [each._native for each in scene.movers],
            seed=checked_seed("seed", seed),
            leader_start=leader.start,
            leader_end=leader.start if leader.end is None else leader.end,
            leader_speed=leader.speed,
            leader_size=leader.size,
            duration=scene.duration,
        )

    @property
    def scene(self) -> FollowerScene:
        """Surroundings of the robot."""
        return self._scene

    @property
    def record(self) -> FollowerRun:
        """The run so far: a row for each control period, and one for the end once it has come.

        In periods with a force from outside, attraction and repulsion are what the law would have
        asked for.
        """
        found: dict[str, Any] = self._native.recorded()
        for name in ("end_time", "least_clearance"):
            del found[name]
        return FollowerRun(**found, scene=self._scene, follower=self._follower)

    def step(self, force: npt.ArrayLike | None = None) -> Percept:
        """Advance by one control period, or to the end of the run.

        Parameters
        ----------
        force : array_like of shape (2,) or None
            Force on the virtual mass in N until the next sample; ``None``: that of the law.

        Returns
        -------
        Percept
            What the law decides by then.

        Raises
        ------
        InvalidParameterError
            If the force is not finite.
        ShapeError
            If it has another shape than (2,).
        SimulationError
            If the run has ended, the state became non-finite, or another thread is stepping it.
        """
        self._check_under_way()
        self._native.step(force=None if force is None else finite_pair("force", force))
        return self.observe()

    def __repr__(self) -> str:
        """Return time and whether it has ended."""
        return f"FollowerSteps(follower={self._follower!r}, time={self.time:.6g}, finished={self.finished})"


def follow(
    scene: FollowerScene, *, law: VirtualImpedance | None = None, follower: Follower | None = None, seed: int = 0
) -> FollowerRun:
    """Run the follower through a scene until its end or the first touch, and record everything.

    Parameters
    ----------
    scene : FollowerScene
        Leader, obstacles and length; `FollowerLayouts.scene` draws those of the experiments.
    law : VirtualImpedance or None
        Repulsion; `VirtualImpedance` when ``None``.
    follower : Follower or None
        The robot; `Follower` when ``None``.
    seed : int
        Seed of the scatter of bursts and readings.

    Returns
    -------
    FollowerRun
        The run.

    Raises
    ------
    InvalidParameterError
        If an argument is of the wrong kind or out of range.
    SimulationError
        If the state becomes non-finite.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> scene = reactive.FollowerScene(
    ...     leader=reactive.SoundLeader(start=(1.2, 0.0), end=(3.0, 0.0)),
    ...     obstacles=[reactive.Box(center=(1.5, 1.2), size=(0.5, 0.5))], duration=10.0,
    ... )
    >>> run = reactive.follow(scene)
    >>> run.collided, len(run)
    (False, 401)
    """
    return FollowerSteps(scene, law, follower, seed=seed).finish()
