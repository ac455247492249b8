"""The suites whose scenes are drawn: discs that drift between start and goal, and crowds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._arguments import Array
from hrsafety.benchmarks.entries import Entry
from hrsafety.benchmarks.protocol import Case, rows_of
from hrsafety.benchmarks.results import Row

__all__ = ["DRAWN", "among", "crowd", "drifting", "first_of"]

DRAWN = 2000
"""Episodes of S4 and S5 that one draw gives."""
LAW_SPEED, ROBOT_SPEED = 1.0, 1.5
"""In S4 and S5: largest speed of the law, and of the robot to give way under shield or yielding, in m/s."""
CROWD = 12
"""People of a crowd."""

Draw = Callable[[Case, Sequence[int]], tuple[Sequence[nav.Scenario], nav.Law]]
"""Scenes of some episodes, and the law that is run in all of them."""


@lru_cache(maxsize=4)
def _discs(seed: int, count: int) -> tuple[Array, Array]:
    """Return places in m and velocities in m/s of the discs of all episodes."""
    generator, shape = np.random.default_rng(seed), (DRAWN, count)
    x, y = generator.uniform(2.0, 9.0, shape), generator.uniform(-3.0, 3.0, shape)
    speed, course = generator.uniform(0.0, 1.0, shape), generator.uniform(-np.pi, np.pi, shape)
    return np.stack([x, y], axis=-1), np.stack([speed * np.cos(course), speed * np.sin(course)], axis=-1)


def _protocol(each: Entry) -> Entry:
    """Return the entry as S4 and S5 have it: the reciprocal law with a horizon of 2 s and no margin."""
    if isinstance(each.law, nav.OptimalReciprocalCollisionAvoidance):
        return replace(each, law=each.law.replaced(horizon=2.0, margin=0.0))
    return each


def drifting(count: int) -> Draw:
    """Return what draws discs that drift across 10 m.

    Parameters
    ----------
    count : int
        How many discs.

    Returns
    -------
    callable
        What draws scenes and law.
    """

    def draw(case: Case, cases: Sequence[int]) -> tuple[Sequence[nav.Scenario], nav.Law]:
        gives_way = not {"shield", "yielding", "foresight"}.isdisjoint(case.entry.parts)
        place, velocity = (each[list(cases)] for each in _discs(case.seed, count))
        scenes = nav.Scenarios.from_arrays(
            start=np.zeros((len(cases), 2)),
            goal=(10.0, 0.0),
            obstacle_position=place,
            obstacle_velocity=velocity,
            obstacle_radius=0.3,
            person=False,
            robot=nav.HolonomicRobot(
                radius=0.3, max_speed=ROBOT_SPEED if gives_way else LAW_SPEED, max_acceleration=10.0
            ),
            control_period=0.1,
            time_limit=15.0,
            rest_time=15.0,
            arrival_tolerance=0.3,
        )
        law = replace(case, entry=_protocol(case.entry)).built(preferred_speed=LAW_SPEED)
        return _sensed(scenes, case), law

    return draw


def _sensed(scenes: nav.Scenarios, case: Case) -> Sequence[nav.Scenario]:
    """Return the scenes with the sensing of the case."""
    sensing = case.measurement
    return scenes if sensing is None else [replace(scene, measurement=sensing) for scene in scenes]


def crowd(case: Case, cases: Sequence[int]) -> tuple[Sequence[nav.Scenario], nav.Law]:
    """Return crowds that cross the way of the robot, and the law.

    Parameters
    ----------
    case : Case
        What is run.
    cases : sequence of int
        Numbers of the episodes.

    Returns
    -------
    tuple of scenes and Law
        Scenarios and law.
    """
    scenes = scenarios.random_traffic_batch([case.seed + index for index in cases], obstacles=CROWD)
    return _sensed(scenes, case), case.built()


def first_of(draw: Draw) -> Callable[[Case, int], tuple[nav.Scenario, nav.Law]]:
    """Return what draws one episode.

    Parameters
    ----------
    draw : callable
        What draws many.

    Returns
    -------
    callable
        Scenario and law of an episode.
    """

    def scene(case: Case, index: int) -> tuple[nav.Scenario, nav.Law]:
        scenes, law = draw(case, [index])
        return scenes[0], law

    return scene


def among(draw: Draw) -> Callable[[Case], Iterator[Row]]:
    """Return what runs drawn scenes, which end at the first contact, side by side.

    Parameters
    ----------
    draw : callable
        What draws them.

    Returns
    -------
    callable
        Rows of some episodes.
    """

    def run(case: Case) -> Iterator[Row]:
        scenes, law = draw(case, case.cases)
        yield from rows_of(nav.simulate_many(scenes, law, stop_on_contact=True, threads=case.threads), case.cases)

    return run
