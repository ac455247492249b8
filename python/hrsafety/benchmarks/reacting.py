"""Suites of worlds in which people react to each other and to the robot."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks.entries import MARGIN
from hrsafety.benchmarks.protocol import Case, Suite
from hrsafety.benchmarks.results import Row
from hrsafety.navigation.crowd.agents import FASTEST_DRAWN, Robot
from hrsafety.navigation.crowd.contacts import contacts_of
from hrsafety.navigation.crowd.episodes import outcome_of
from hrsafety.navigation.crowd.simulation import simulated
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.metrics.between import touched_between
from hrsafety.navigation.warnings.shields import Motion

__all__ = ["REACTING", "SCENES"]

LAWS = ("field", "field+shield", "orca", "orca+shield", "velocity_obstacle", "velocity_obstacle+shield")
GUIDED = tuple(f"{law}+guide{parts}" for law in ("field", "orca") for parts in ("", "+shield+yielding"))
STEP_ERROR = Motion(nav.HolonomicRobot(), 0.05, 0.05).execution_error
"""How far robots are off the motion that a shield plans, with motion steps of 0.05 s, in m: its margin here."""
CIRCLE_ERROR = Motion(nav.HolonomicRobot(radius=0.3, max_speed=1.0), 0.25, 0.25).execution_error
"""Execution error with the steps of 0.25 s of the circle crossing: no margin would leave the robot room."""
SCENE_ERROR = Motion(nav.HolonomicRobot(radius=0.25, max_speed=1.0, max_acceleration=3.0), 0.1, 0.05).execution_error
"""Execution error of the robot of the standard scenes, in m."""
CASES = 500
"""Cases of CrowdNav."""
MOST = 1_000_000


def _law(case: Case, margin: float = MARGIN) -> nav.Law:
    return case.built(margin=margin)


def _sensed(world: World, case: Case) -> World:
    """Return the world with robots that see people as the case says."""
    return replace(world, robots=[replace(robot, measurement=case.measurement) for robot in world.robots])


def _seen(case: Case, index: int) -> World:
    return _sensed(scenarios.circle_crossing(case.seed + index, law=_law(case), visible=True), case)


def _unseen(case: Case, index: int) -> World:
    return _sensed(scenarios.circle_crossing(case.seed + index, law=_law(case), visible=False), case)


def _antipodal(case: Case, index: int) -> World:
    return _sensed(scenarios.antipodal(20, law=_law(case, STEP_ERROR), robots=1, seed=case.seed + index), case)


def _driven(case: Case, start: tuple[float, float], goal: tuple[float, float]) -> Robot:
    return Robot(start=start, goal=goal, law=_law(case, STEP_ERROR), measurement=case.measurement)


def _free(world: World, robot: Robot) -> World:
    """Return the world with the robot, without people who would touch it at its start."""
    place = np.array(robot.start)
    room = robot.body.radius + 0.05
    people = [each for each in world.people if np.hypot(*(np.array(each.start) - place)) > each.radius + room]
    return replace(world, people=people, robots=[robot])


def _corridor(case: Case, index: int) -> World:
    world = scenarios.corridor(12, seed=case.seed + index)
    return _free(world, _driven(case, (0.0, 1.5), (9.0, 1.5)))


def _crossing(case: Case, index: int) -> World:
    world = scenarios.crossing(6, rate=0.5, seed=case.seed + index)
    return _free(world, _driven(case, (6.0, 0.0), (-6.0, 0.0)))


def _bottleneck(case: Case, index: int) -> World:
    world = scenarios.bottleneck(100, seed=case.seed + index, time_limit=120.0)
    return _free(world, _driven(case, (1.0, 4.0), (10.0, 4.0)))


def _standard(case: Case, index: int) -> World:
    """Return the standard scenes, seed after seed."""
    seed, number = divmod(index, len(scenarios.SOCIAL))
    world = scenarios.social(scenarios.SOCIAL[number], case.seed + seed)
    walls = [each for each in world.wall_shapes if isinstance(each, tuple)]
    law = case.built(margin=SCENE_ERROR, map=nav.StaticMap.from_polylines(walls))
    return _sensed(replace(world, robots=[replace(world.robots[0], law=law)]), case)


def _worlds(scene: Callable[[Case, int], World]) -> Callable[[Case], Iterator[Row]]:
    """Run worlds side by side, a row each."""

    def run(case: Case) -> Iterator[Row]:
        worlds = [scene(case, index) for index in case.cases]
        runs = simulated(worlds, threads=case.threads)
        episodes = [nav.crowd.episodes_of(each)[0] for each in runs]
        table = nav.metrics.evaluate_many(episodes, threads=case.threads)
        for row, (index, each) in enumerate(zip(case.cases, runs, strict=True)):
            arrival, walls = float(table.arrival_time[row]), int(table.wall_contacts[row])
            there = not np.isnan(each.robot_arrival_time[0])
            found = contacts_of(episodes[row], arrival)
            contacts = found.moving + found.standing + walls
            between = touched_between(episodes[row], arrival, float(table.min_time_to_collision[row]))
            yield Row(
                case=index,
                outcome=outcome_of(touched=contacts > 0, arrived=there, diverged=each.diverged is not None),
                arrival_time=arrival,
                end_time=float(each.time[-1]),
                contacts=contacts,
                # A wall stands: a robot that touches it has moved toward it.
                toward=found.toward + walls,
                away=found.away,
                at_fault=found.at_fault + walls,
                walls=walls,
                apart=found.apart,
                clearance=float(table.min_clearance[row]),
                between=between.people,
            )

    return run


SCENES: dict[str, Callable[[Case, int], World]] = {
    "circle_crossing": _seen,
    "circle_crossing_unseen": _unseen,
    "antipodal": _antipodal,
    "corridor": _corridor,
    "crossing": _crossing,
    "bottleneck": _bottleneck,
    "scenes": _standard,
}
"""Worlds of the episodes by the name of the suite."""


def _suite(
    name: str, summary: str, cases: int, fastest: float, error: float = 0.0, laws: tuple[str, ...] = LAWS
) -> Suite:
    return Suite(
        name=name,
        summary=summary,
        laws=laws,
        cases=cases,
        seed=0,
        most=MOST,
        execution_error=error,
        fastest=fastest,
        run=_worlds(SCENES[name]),
    )


REACTING = (
    _suite("circle_crossing", "5 people cross a circle and see the robot", CASES, 1.0, CIRCLE_ERROR),
    _suite("circle_crossing_unseen", "5 people cross a circle and do not see the robot", CASES, 1.0, CIRCLE_ERROR),
    _suite("antipodal", "19 people and the robot go to the opposite point of a circle", 100, 1.0),
    _suite("corridor", "12 people walk both ways in a corridor", 100, FASTEST_DRAWN),
    _suite("crossing", "two streams of people cross at right angles", 100, FASTEST_DRAWN),
    _suite("bottleneck", "100 people and the robot leave a room through a door of 1 m", 20, FASTEST_DRAWN),
    _suite("scenes", "25 standard scenes, seed after seed", 200, 1.8, SCENE_ERROR, GUIDED),
)
"""The suites of people that react."""
