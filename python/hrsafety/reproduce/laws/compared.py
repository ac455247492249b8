"""The laws that section 5.7 compares, and the person who cannot be predicted."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.plotting.comparisons.law_looks import LAW_COLORS

__all__ = ["COMPARED", "FORCES", "LIKE_SOURCE", "PLANNERS", "Compared", "printed_walk", "varied_walk"]


class Compared(NamedTuple):
    """One law of the comparison.

    Attributes
    ----------
    label : str
        Name as a reader knows it.
    law : Law
        The law with its default parameters.
    """

    label: str
    law: nav.Law

    @property
    def color(self) -> str:
        """Color of its lines, as in every picture of laws."""
        return LAW_COLORS[type(self.law)]


FORCES: Mapping[str, Compared] = {
    "new_vff": Compared("New VFF", nav.VirtualForceField()),
    "masoud": Compared("Masoud", nav.Masoud()),
    "ge_cui": Compared("Ge & Cui", nav.GeCui()),
    "khatib": Compared("Khatib", nav.Khatib()),
    "borenstein_koren": Compared("Borenstein & Koren", nav.BorensteinKoren()),
}
"""Laws of virtual forces: they know nothing but the present state."""
PLANNERS: Mapping[str, Compared] = {
    "velocity_obstacle": Compared("Velocity obstacle", nav.VelocityObstacle()),
    "reciprocal": Compared("ORCA", nav.OptimalReciprocalCollisionAvoidance()),
    "random_tree": Compared("RRT", nav.RapidlyExploringRandomTree()),
    "field_d_star": Compared("Field D*", nav.FieldDStar()),
}
"""Laws that plan: they take it that everything keeps its present velocity."""
COMPARED: Mapping[str, Compared] = {**FORCES, **PLANNERS}
"""All nine, with default parameters."""
LIKE_SOURCE: Mapping[str, Compared] = {
    "time_and_risk": Compared("Velocity obstacle, time and risk", nav.VelocityObstacle(selection="time_and_risk"))
}
"""Shown beside the nine: the selection rule that the source cites for velocity obstacles."""

_PERSON = {"critical_radius": 0.8, "active_radius": 2.1}
_START = 0.6
_ALONG, _ACROSS = 0.3, 0.2
_SPEEDS = (0.7, 1.0)
_TIMES = (0.5, 2.0)
_ACCELERATIONS = (0.5, 2.0)
_SIDE_SPEEDS = (0.5, 1.0)
_COURSE = math.radians(30.0)


def printed_walk() -> nav.Scenario:
    """Return the scenario of section 5.7 as printed."""
    return scenarios.configuration("unpredictable_human")


def varied_walk(seed: int) -> nav.Scenario:
    """Return the scenario of section 5.7 with another walk of the person.

    Everything about the walk is drawn uniformly: the start within 0.3 m along and 0.2 m across
    the way, the walking speed from 0.7 to 1.0 m/s (1 m/s is what the regions are sized for), the
    walking time from 0.5 to 2.0 s, the deceleration to rest and the acceleration afterwards from
    0.5 to 2.0 m/s^2, the speed reached from 0.5 to 1.0 m/s, and the course: left or right with
    equal chance, within 30 degrees of straight across. Nothing is drawn again or left out.
    """
    draw = np.random.Generator(np.random.PCG64(seed)).random(9).tolist()

    def uniform(index: int, low: float, high: float) -> float:
        return float(low + (high - low) * draw[index])

    start = (_START + uniform(0, -_ALONG, _ALONG), uniform(1, -_ACROSS, _ACROSS))
    speed, slowing, leaving = uniform(2, *_SPEEDS), uniform(4, *_ACCELERATIONS), uniform(5, *_ACCELERATIONS)
    reached, side = uniform(6, *_SIDE_SPEEDS), 1.0 if draw[8] < 0.5 else -1.0
    course = side * (math.pi / 2.0 + uniform(7, -_COURSE, _COURSE))
    away = (leaving * math.cos(course), leaving * math.sin(course))
    motion = [
        (uniform(3, *_TIMES), (speed, 0.0), (0.0, 0.0)),
        (speed / slowing, (speed, 0.0), (-slowing, 0.0)),
        (reached / leaving, (0.0, 0.0), away),
    ]
    person = nav.Human.from_segments(start, motion, **_PERSON)
    return nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=(person,), seed=seed)
