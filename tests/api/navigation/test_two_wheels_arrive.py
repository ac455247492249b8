"""A robot with two wheels arrives from any pose under guide and shield, if it stands where the guide has a plan."""

from __future__ import annotations

import math

import numpy as np

from hrsafety import navigation as nav
from hrsafety.navigation.laws import SafeNavigation, Shield
from hrsafety.navigation.maps import Guide, StaticMap

ROOM = [(-3, -3), (6, -3), (6, 3), (-3, 3), (-3, -3)]
WALLS = StaticMap.from_polylines([[(1, 1.5), (3, 1.5), (3, -1.5), (1, -1.5)], ROOM, [(4.5, 3), (4.5, 0.2)]])
GUIDE = Guide(box=((-3, -3), (6, 3)))
ROBOT = nav.DifferentialDriveRobot()
GOAL = (5.3, 2.0)
LEAST = ROBOT.radius + GUIDE.margin + GUIDE.spacing / math.sqrt(2.0)
"""Clearance of a start from which a plan is certain, in m: the condition."""


def poses(count: int, seed: int) -> list[nav.Scenario]:
    generator, found = np.random.default_rng(seed), []
    while len(found) < count:
        x, y = generator.uniform((-3.0, -3.0), (6.0, 3.0))
        heading = generator.uniform(-np.pi, np.pi)
        if WALLS.clearance((x, y)) > LEAST and math.dist((x, y), GOAL) > 0.2:
            found.append(
                nav.Scenario(robot=ROBOT, start=(x, y), goal=GOAL, heading=heading, time_limit=60.0, rest_time=60.0)
            )
    return found


def test_it_arrives_from_random_poses_and_touches_no_wall() -> None:
    law = SafeNavigation(nav.VirtualForceField(), map=WALLS, guide=GUIDE, shield=Shield())
    table = nav.simulate_many(poses(40, seed=7), [law])
    assert set(table.outcome) == {"arrived"}
    assert table.min_clearance.min() > 0.0


def test_it_arrives_from_close_to_a_wall_in_every_direction() -> None:
    law = SafeNavigation(nav.VirtualForceField(), map=WALLS, guide=GUIDE, shield=Shield())
    # In the trap, 1 cm and less from its end and from a corner.
    places = [(3.0 - LEAST, 0.0), (3.0 - LEAST, 1.5 - LEAST), (-3.0 + ROBOT.radius + 0.01, -2.0)]
    scenes = [
        nav.Scenario(robot=ROBOT, start=place, goal=GOAL, heading=heading, time_limit=60.0, rest_time=60.0)
        for place in places
        for heading in np.linspace(-np.pi, np.pi, 8, endpoint=False).tolist()
    ]
    table = nav.simulate_many(scenes, [law])
    assert set(table.outcome) == {"arrived"}
    assert table.min_clearance.min() > 0.0


def test_without_a_guide_it_stays_in_the_trap() -> None:
    law = SafeNavigation(nav.VirtualForceField(), map=WALLS, shield=Shield())
    start = nav.Scenario(robot=ROBOT, start=(2.0, 0.0), goal=GOAL, time_limit=20.0)
    assert nav.simulate(start, law).outcome != "arrived"
