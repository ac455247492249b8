"""The score of a robot among people who react: time, distance and energy against the robot alone."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from hrsafety._arguments import Array
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.obstacles.moving import MovingDisc
from hrsafety.navigation.regions import region_radii
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Trajectory

__all__ = ["Lone", "lone", "scores"]

STEP = 0.01
"""Longest motion step of the robot alone, in s."""


class Lone(NamedTuple):
    """A robot of a world without people, walls and errors of measurement.

    Attributes
    ----------
    scenario : Scenario
        Its way.
    built : AsBuilt or None
        How it is built.
    step : float
        Motion step of its run in s.
    """

    scenario: Scenario
    built: AsBuilt | None
    step: float


def lone(world: World, robot: int) -> Lone:
    """Return a robot of a world alone.

    Parameters
    ----------
    world : World
        The world.
    robot : int
        Which of its robots.

    Returns
    -------
    Lone
        What `simulate` takes for it.
    """
    own = world.robots[robot]
    period = world.step if own.control_period is None else own.control_period
    scene = Scenario(
        robot=own.body,
        start=own.start,
        goal=own.goal,
        control_period=period,
        time_limit=world.time_limit,
        arrival_tolerance=own.arrival_tolerance,
        heading=own.heading,
    )
    built = own.as_built()
    return Lone(scene, None if built is None else built.seeing_all(own.law), period / math.ceil(period / STEP - 1e-9))


def scores(run: Trajectory, nominal: Trajectory, weights: tuple[float, float, float]) -> dict[str, float]:
    """Return H of a robot of a world and its parts, as `evaluate` has them.

    Parameters
    ----------
    run : Trajectory
        The run of a world as its robot has it.
    nominal : Trajectory
        The robot alone, see `lone`.
    weights : tuple of float
        Weights of time, distance and energy.

    Returns
    -------
    dict of str to float
        ``total``, ``arrival_time``, ``avoidance`` and ``energy_saving``.
    """
    touched = run.contacts_moving + run.contacts_standing > 0
    avoidance = 0.0 if touched else _avoidance(run)
    if math.isnan(run.arrival_time) or math.isnan(nominal.arrival_time):
        return {"total": 0.0, "arrival_time": 0.0, "avoidance": avoidance, "energy_saving": 0.0}
    time = nominal.arrival_time / run.arrival_time if run.arrival_time > 0.0 else 1.0
    # A robot without motor losses saves all there is to save.
    saving = 1.0 if run.energy == 0.0 else nominal.energy / run.energy
    total = weights[0] * time + weights[1] * avoidance + weights[2] * saving
    return {
        "total": 0.0 if touched else total,
        "arrival_time": time,
        "avoidance": avoidance,
        "energy_saving": saving,
    }


def _avoidance(run: Trajectory) -> float:
    """Return the mean over the people of the least clearance by that of their active regions, at most 1."""
    if not len(run.min_clearance):
        return 1.0
    world: World = run.scenario
    own = world.robots[run.robot]
    period = world.step if own.control_period is None else own.control_period
    wanted: Array = np.empty(len(run.min_clearance))
    known: dict[tuple[float, float], float] = {}
    for index, kind in enumerate(zip(run.obstacle_radius.tolist(), run.desired_speed.tolist(), strict=True)):
        if kind not in known:
            radius, speed = kind
            person = MovingDisc(center=(0.0, 0.0), velocity=(0.0, 0.0), radius=radius, max_speed=speed)
            regions = region_radii(own.body, person, period, measurement=own.measurement)
            known[kind] = regions.active_radius - own.body.radius - radius
        wanted[index] = known[kind]
    return float(np.minimum(run.min_clearance / wanted, 1.0).mean())
