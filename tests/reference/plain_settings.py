"""Configurations of chapters 6 and 7, written a second time from the specification's table."""

from __future__ import annotations

import math

from reference import plain_field as pf
from reference.plain_rollout import Moving, Setting, standing, walking

NEW = pf.Gains(3.0, 20.0, 17.0, 0.25)
NEW_STAR = pf.Gains(4.3, 20.3, 240.7, 0.68)
GAIN_SETS = {"New": NEW, "New*": NEW_STAR}


def disc(x: float, y: float, active_radius: float = 0.8) -> Moving:
    return standing(pf.Round((x, y), 0.4, active_radius, radius=0.1))


def chapter_6(name: str) -> Setting:
    human = walking((0.6, 0.6), (1.0, 0.0), 3.4, critical_radius=0.8, active_radius=2.1)
    box = standing(pf.Box((2.3, 0.0), 1.4, 0.6, 0.0, 0.4, 0.8))
    obstacles = {
        "c1": [disc(2.45, 0.595)],
        "c2": [human],
        "c3": [box, disc(2.45, 1.4)],
        "c4": [human, box, disc(2.45, 1.4)],
        "parallel_human": [walking((0.6, 1.2), (1.0, 0.0), 3.4, critical_radius=0.8, active_radius=2.1)],
    }
    return Setting((3.9, 0.6), (0.0, 0.6), obstacles[name])


def chapter_7(name: str) -> Setting:
    box = standing(pf.Box((2.3, 0.2), 1.4, 0.6, 0.0, 0.3, 0.55))
    far_human = walking((0.2, 0.6), (1.0, 0.0), 3.8, critical_radius=0.8, active_radius=2.5)
    near_human = walking((0.2, 0.6), (1.0, 0.0), 3.7, critical_radius=0.8, active_radius=2.5)
    obstacles = {
        "n1": [disc(2.16, 0.6, 0.65)],
        "n2": [far_human],
        "n3": [box, disc(2.16, 1.5, 0.65)],
        "n4": [near_human, box, disc(2.16, 1.5, 0.65)],
    }
    return Setting((3.99, 0.6), (0.0, 0.6), obstacles[name])


def unpredictable_human() -> Setting:
    """Return section 5.7: walks, brakes to rest, speeds up sideways, walks on sideways."""

    def at(time: float) -> pf.Round:
        if time < 1.0:
            place, velocity, acceleration = (0.6 + time, 0.0), (1.0, 0.0), (0.0, 0.0)
        elif time < 2.0:
            s = time - 1.0
            place, velocity, acceleration = (1.6 + s - s * s / 2.0, 0.0), (1.0 - s, 0.0), (-1.0, 0.0)
        elif time < 3.0:
            s = time - 2.0
            place, velocity, acceleration = (2.1, s * s / 2.0), (0.0, s), (0.0, 1.0)
        else:
            place, velocity, acceleration = (2.1, 0.5 + time - 3.0), (0.0, 1.0), (0.0, 0.0)
        return pf.Round(place, 0.8, 2.1, velocity, acceleration, 0.4)

    return Setting((4.0, 0.0), (0.0, 0.0), [at])


def setting(name: str) -> Setting:
    """Return a configuration by its name in the package."""
    if name == "unpredictable_human":
        return unpredictable_human()
    return chapter_7(name) if name.startswith("n") else chapter_6(name)


def avoidance(chosen: Setting, min_distance: list[float], robot_radius: float = 0.2) -> float:
    """Return H_D of item 16: mean of d_s / d_s*, each at most 1, NaN on contact."""
    shares = []
    for obstacle, d in zip(chosen.obstacles, min_distance, strict=True):
        body = obstacle(0.0)
        reach = robot_radius + (body.radius if isinstance(body, pf.Round) else 0.0)
        if d <= reach:
            return math.nan
        shares.append(min((d - reach) / (body.active_radius - reach), 1.0))
    return math.fsum(shares) / len(shares)
