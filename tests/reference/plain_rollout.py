"""Runs of the plain field: force every T_s and held, semi-implicit Euler in between.

The robot is the holonomic one of the source; its wheels give the energy (item 18).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from reference import plain_field as pf

WHEEL_RADIUS = 0.10  # m
WINDING_RESISTANCE = 4.86  # ohm
WHEEL_DIRECTIONS = ((-math.sqrt(3.0) / 2.0, -0.5), (math.sqrt(3.0) / 2.0, -0.5), (0.0, 1.0))  # (D.1.3)
FEED_FORWARD = ((0.0073, 0.0019, 0.19), (0.0074, 0.0020, 0.22), (0.0065, 0.0024, 0.18))  # (D.3.2)
STANDING_WHEEL = 1e-9  # rad/s

Moving = Callable[[float], pf.Round | pf.Box]


class Setting(NamedTuple):
    start: pf.Vector
    goal: pf.Vector
    obstacles: Sequence[Moving]


class Run(NamedTuple):
    arrival_time: float
    energy: float
    min_distance: list[float]
    path: list[pf.Vector]
    force: list[pf.Vector]
    samples: int


def standing(obstacle: pf.Round | pf.Box) -> Moving:
    """Return an obstacle that stays where it is."""
    return lambda _time: obstacle


def walking(
    start: pf.Vector,
    velocity: pf.Vector,
    walking_time: float,
    *,
    critical_radius: float,
    active_radius: float,
    radius: float = 0.4,
) -> Moving:
    """Return somebody who walks for ``walking_time`` at constant velocity and then stands."""

    def at(time: float) -> pf.Round:
        walked = min(time, walking_time)
        now = velocity if time < walking_time else (0.0, 0.0)
        place = pf.plus(start, pf.times(walked, velocity))
        return pf.Round(place, critical_radius, active_radius, now, (0.0, 0.0), radius)

    return at


def power(old: pf.Vector, new: pf.Vector, dt: float) -> float:
    """Return the loss in the windings over one motion step, in W, at heading 0."""
    currents = 0.0
    for (x, y), (inertia, viscous, static) in zip(WHEEL_DIRECTIONS, FEED_FORWARD, strict=True):
        rate = (x * new[0] + y * new[1]) / WHEEL_RADIUS
        rate_before = (x * old[0] + y * old[1]) / WHEEL_RADIUS
        direction = 0.0 if abs(rate) < STANDING_WHEEL else math.copysign(1.0, rate)
        currents += (inertia * (rate - rate_before) / dt + viscous * rate + static * direction) ** 2
    return WINDING_RESISTANCE * currents


def shortened(vector: pf.Vector, longest: float) -> pf.Vector:
    length = math.hypot(*vector)
    return vector if length <= longest else pf.times(longest / length, vector)


def roll_out(
    law: pf.Law,
    setting: Setting,
    limits: pf.Limits = pf.ROBOT,
    *,
    dt: float = 0.01,
    hold: bool = True,
    tolerance: float = 0.12,
    time_limit: float = 60.0,
) -> Run:
    """Drive from rest at the start into the tolerance circle of the goal (items 11 to 13, 18)."""
    period = round(limits.control_period / dt) if hold else 1
    position, velocity, force = setting.start, (0.0, 0.0), (0.0, 0.0)
    latch = [0] * len(setting.obstacles)
    energy, path, forces, samples = 0.0, [position], [], 0
    least = [pf.distance_to(obstacle(0.0), position) for obstacle in setting.obstacles]
    for step in range(round(time_limit / dt)):
        if step % period == 0:
            now = [obstacle(step * dt) for obstacle in setting.obstacles]
            terms = pf.evaluate(law, limits, position, velocity, setting.goal, now, latch)
            force, latch, samples = terms.total, terms.side, samples + 1
        acceleration = shortened(pf.times(1.0 / limits.mass, force), limits.max_acceleration)
        old_velocity, old_position = velocity, position
        velocity = shortened(pf.plus(velocity, pf.times(dt, acceleration)), limits.max_speed)
        position = pf.plus(position, pf.times(dt, velocity))
        path.append(position)
        forces.append(force)
        for i, obstacle in enumerate(setting.obstacles):
            least[i] = min(least[i], pf.distance_to(obstacle((step + 1) * dt), position))
        before, after = math.dist(old_position, setting.goal), math.dist(position, setting.goal)
        share = (before - tolerance) / (before - after) if after <= tolerance else 1.0
        energy += power(old_velocity, velocity, dt) * dt * share
        if after <= tolerance:
            return Run((step + share) * dt, energy, least, path, forces, samples)
    return Run(math.nan, energy, least, path, forces, samples)
