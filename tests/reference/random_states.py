"""Random states of robot, goal and obstacles, robot in or near their active regions."""

from __future__ import annotations

import math
import random
from typing import NamedTuple

from reference import plain_field as pf
from reference.plain_settings import NEW, NEW_STAR

LEAST_GAP = 1e-3  # m: d - r3 and |r2 - d|, below it the terms are dominated by the rounding of d
LEAST_RADIUS = 0.23  # m: r3 of the smallest critical region, in which a robot of 0.2 m does not touch the body yet


class State(NamedTuple):
    position: pf.Vector
    velocity: pf.Vector
    goal: pf.Vector
    obstacles: list[pf.Round | pf.Box]


def direction(source: random.Random) -> pf.Vector:
    angle = source.uniform(-math.pi, math.pi)
    return (math.cos(angle), math.sin(angle))


def vector(source: random.Random, longest: float) -> pf.Vector:
    return pf.times(source.uniform(0.0, longest), direction(source))


def gap_and_radii(source: random.Random, least_gap: float) -> tuple[float, float, float]:
    """Return d, r3, r2: mostly inside the active region, sometimes close to r3, sometimes outside."""
    r3 = source.uniform(LEAST_RADIUS, 0.9)
    width = source.uniform(max(0.15, 1.5 * least_gap), 1.5)
    kind, deepest = source.random(), 1.000001 * least_gap
    if kind < 0.15:
        gap = width * source.uniform(1.0, 1.4) + LEAST_GAP
    elif kind < 0.35:
        gap = math.exp(source.uniform(math.log(deepest), math.log(width - LEAST_GAP)))
    else:
        gap = source.uniform(deepest, width - LEAST_GAP)
    return r3 + gap, r3, r3 + width


def random_disc(source: random.Random, position: pf.Vector, least_gap: float) -> pf.Round:
    """Return a disc at rest, in motion or accelerating."""
    d, r3, r2 = gap_and_radii(source, least_gap)
    center = pf.plus(position, pf.times(d, direction(source)))
    kind = source.choice(["rest", "slow", "moving", "moving", "accelerating", "accelerating"])
    speed = {"rest": 0.0, "slow": pf.MOVING}.get(kind, 1.5)
    velocity = vector(source, speed) if speed else (0.0, 0.0)
    acceleration = vector(source, 2.0) if kind == "accelerating" else (0.0, 0.0)
    return pf.Round(center, r3, r2, velocity, acceleration)


def random_box(source: random.Random, position: pf.Vector, least_gap: float) -> pf.Box:
    """Return a rectangle at any heading, the robot before a face or a corner."""
    d, r3, r2 = gap_and_radii(source, least_gap)
    length, width = source.uniform(0.2, 2.5), source.uniform(0.2, 2.5)
    heading = source.uniform(-math.pi, math.pi)
    if source.random() < 0.5:
        away = source.uniform(0.0, math.pi / 2.0)
        local = (length / 2.0 + d * math.cos(away), width / 2.0 + d * math.sin(away))
    elif source.random() < 0.5:
        local = (source.uniform(0.0, length / 2.0), width / 2.0 + d)
    else:
        local = (length / 2.0 + d, source.uniform(0.0, width / 2.0))
    local = (source.choice([-1.0, 1.0]) * local[0], source.choice([-1.0, 1.0]) * local[1])
    center = pf.minus(position, pf.turned(local, heading))
    return pf.Box(center, length, width, heading, r3, r2)


def reaches(obstacle: pf.Round | pf.Box, goal: pf.Vector) -> bool:
    """Say whether the goal lies in the active region of something that stands still."""
    if isinstance(obstacle, pf.Round) and obstacle.velocity != (0.0, 0.0):
        return False
    inside = isinstance(obstacle, pf.Box) and all(
        abs(x) <= half
        for x, half in zip(
            pf.turned(pf.minus(goal, obstacle.center), -obstacle.heading),
            (obstacle.length / 2.0, obstacle.width / 2.0),
            strict=True,
        )
    )
    return inside or pf.distance_to(obstacle, goal) <= 1.01 * obstacle.active_radius


def random_state(
    source: random.Random,
    *,
    most_obstacles: int = 4,
    boxes: bool = True,
    least_gap: float = LEAST_GAP,
    least_speed: float = 0.0,
) -> State:
    """Return a legal state, every d - r3 at least ``least_gap`` and every |r2 - d| at least `LEAST_GAP`."""
    position = (source.uniform(-3.0, 3.0), source.uniform(-3.0, 3.0))
    velocity = pf.times(source.uniform(least_speed, 0.7), direction(source))
    obstacles: list[pf.Round | pf.Box] = []
    for _ in range(source.randint(1, most_obstacles)):
        box = boxes and source.random() < 0.35
        obstacles.append((random_box if box else random_disc)(source, position, least_gap))
    while True:
        goal = pf.plus(position, vector(source, 7.0))
        if goal != position and not any(reaches(obstacle, goal) for obstacle in obstacles):
            return State(position, velocity, goal, obstacles)


def random_gains(source: random.Random) -> pf.Gains:
    """Return one of the two gain sets of the source, or others around them."""
    kind = source.random()
    if kind < 0.25:
        return NEW
    if kind < 0.5:
        return NEW_STAR
    return pf.Gains(
        source.uniform(0.5, 20.0),
        source.uniform(1.0, 100.0),
        source.uniform(1.0, 500.0),
        source.uniform(0.05, 1.0),
    )


def random_stabilizing(source: random.Random) -> pf.Stabilizing:
    return source.choice(
        [
            pf.Stabilizing("off"),
            pf.Stabilizing("full"),
            pf.Stabilizing("capped"),
            pf.Stabilizing("capped", force_cap=source.uniform(0.5, 50.0)),
            pf.Stabilizing("capped", momentum_cap=source.uniform(0.01, 1.0)),
        ]
    )
