"""Questions of the cards of the standard scenes, as metrics."""

from __future__ import annotations

from types import MappingProxyType
from typing import get_args

import numpy as np

from hrsafety._arguments import Array, instance, word
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import Task
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.scenarios.social_scenes import SOCIAL

__all__ = ["CARDS", "task_error"]

_ROOM = "min_clearance", "comfort_share", "discomfort_time"
_YIELDS = "min_time_to_collision", "stalled_time", "person_delay"
_UNBLOCKED = "frozen", "people_blocked"
_LEGIBLE = "path_irregularity", "heading_change"
_FLOW = "person_detour", "social_work"
_ZONES = "personal_share", "social_share"

_QUESTIONS = (
    (_ROOM, {0, 2, 3, 4, 5, 8, 10, *range(20, 25)}),
    (_YIELDS, {*range(5, 9), *range(10, 15)}),
    (_UNBLOCKED, {1, 9, 24}),
    (_LEGIBLE, {0, 3, 4}),
    (_FLOW, {*range(20, 24)}),
    (("group_intrusion_share",), {15, 16}),
    (_ZONES, {17, 18, 19}),
)

CARDS: MappingProxyType[str, tuple[str, ...]] = MappingProxyType(
    {
        name: tuple(metric for metrics, numbers in _QUESTIONS if number in numbers for metric in metrics)
        for number, name in enumerate(SOCIAL)
    }
)
"""Metrics that answer the questions of each scene's card, beside ``success``; tasks have `task_error`, too."""

BEHIND, AHEAD, BESIDE = 1.2, 1.5, 1.2
"""Where the robot is to be from the person's center, in m."""
SLOWEST = 0.05
"""Slower people keep their last direction, in m/s."""
SETTLED = 5.0
"""Time after which the error counts, in s."""


def task_error(run: Trajectory, task: Task | None = None) -> float:
    """Return how far the robot of a world was from its place beside the first person.

    Parameters
    ----------
    run : Trajectory
        Run of a world whose first robot has a task.
    task : {"behind", "ahead", "beside"} or None
        The task; that of the robot when ``None``.

    Returns
    -------
    float
        Mean distance in m from the moving goal, as it follows from where the person really is, from 5 s on until the
        person has arrived or the run ends; NaN for a shorter run.

    Raises
    ------
    InvalidParameterError
        If it is no run of a world, or there is no task.

    Examples
    --------
    >>> from hrsafety import arena, navigation as nav, scenarios
    >>> law = nav.OptimalReciprocalCollisionAvoidance(horizon=2.0, margin=0.05)
    >>> arena.task_error(nav.simulate(scenarios.social("following_human", 0, law=law))) < 0.75
    True
    """
    world = instance("run", run, Trajectory).scenario
    if not isinstance(world, World) or not world.robots or not world.people:
        raise InvalidParameterError("run", "be a run of a world with a robot and a person", run)
    velocities, arrivals = run.obstacle_velocity, run.person_arrival_time
    assert velocities is not None and arrivals is not None  # noqa: PT018  # runs of worlds have them
    kind = world.robots[0].task if task is None else task
    if kind is None:
        raise InvalidParameterError("task", "be given where the robot has none", None)
    word("task", kind, get_args(Task))
    person, robot = run.obstacle_position[:, 0], run.robot_position[:, 0]
    end = arrivals[0]
    counted = (run.time >= SETTLED) & ~(run.time > end) & ~np.isnan(person[:, 0])
    if not counted.any():
        return float("nan")
    along = _directions(velocities[:, 0])
    if kind == "beside":
        left = np.column_stack([-along[:, 1], along[:, 0]])
        side = np.copysign(BESIDE, np.sum(left * (robot - person), axis=1))
        goal = person + left * side[:, None]
    else:
        goal = person + along * (AHEAD if kind == "ahead" else -BEHIND)
    return float(np.hypot(*(robot - goal)[counted].T).mean())


def _directions(velocity: Array) -> Array:
    """Return the direction of each velocity, or the last one that was not too slow, at first along x."""
    speed = np.hypot(*velocity.T)
    moving = speed >= SLOWEST
    last = np.maximum.accumulate(np.where(moving, np.arange(len(speed)), -1))
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = velocity / speed[:, None]
    return np.where((last >= 0)[:, None], unit[last], (1.0, 0.0))
