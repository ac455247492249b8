"""Worlds on a fake bus, and commands that come back."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from api.ros.fake_bus import FakeBus, stamped, told
from hrsafety import navigation as nav
from hrsafety.ros import Bridge, BusRecord, Settings
from hrsafety.ros.drive import LawNode

ROBOT = nav.DifferentialDriveRobot(radius=0.25, max_speed=0.8, max_acceleration=2.0, max_turn_rate=1.5)
WALLS = [[(-2.0, -3.0), (10.0, -3.0)], [(-2.0, 3.0), (10.0, 3.0)]]


def hall(**given: Any) -> nav.World:
    """Return a hall in which two people come toward a robot with two wheels, and more of them later."""
    people = [
        nav.Person(start=(8.0, 0.6), route=[(0.0, 0.6)], desired_speed=1.2),
        nav.Person(start=(9.0, -0.8), route=[(-1.0, -0.8)], desired_speed=1.0),
    ]
    source = nav.Source(low=(8.5, -2.0), high=(9.5, 2.0), rate=0.5, route=[(-1.5, 0.0)])
    # The base turns as fast as it can within a control period, in which a plan changes evenly.
    shield = nav.Shield(person_speed=2.2, velocity_tracking=(0.1, 0.05))
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=shield, yielding=nav.Yielding())
    robot = nav.Robot(start=(0.0, 0.0), goal=(8.0, 0.0), body=ROBOT, law=law)
    beside = {"people": people, "sources": [source], "walls": WALLS, "time_limit": 10.0, "seed": 3}
    return nav.World(robots=[robot], **{**beside, **given})


def empty(**given: Any) -> nav.World:
    """Return a hall without people."""
    return hall(people=[], sources=[], **given)


def served(
    world: nav.World, answer: Callable[[FakeBus], None] | None, *, bus: FakeBus | None = None, **settings: Any
) -> tuple[BusRecord, FakeBus]:
    """Run a world in lock-step, unless told otherwise, with somebody who answers."""
    own = FakeBus() if bus is None else bus
    own.answer = answer
    return Bridge(world, own, Settings(**{"lockstep": True, **settings})).run(), own


def ahead(bus: FakeBus) -> None:
    """Answer with a command that depends on the clock."""
    if bus.sent["/clock"]:
        bus.say("cmd_vel", stamped(bus.now, 0.4, rate=0.3 * math.sin(bus.now)))


class Wire:
    """Hand over what a bridge publishes to a controller, and its commands back."""

    TOPICS = ("/tf_static", "/people", "/people_markers", "/tf", "/scan", "/odom")

    def __init__(self, world: nav.World, bus: FakeBus, **given: Any) -> None:
        self.bus = FakeBus(types=sorted(bus.types))
        self.drive = LawNode(world, self.bus, **given)
        self._passed = dict.fromkeys((*self.TOPICS, "cmd_vel"), 0)

    def __call__(self, bus: FakeBus) -> None:
        for topic in self.TOPICS:
            for message in bus.sent[topic][self._passed[topic] :]:
                self._passed[topic] += 1
                self.bus.say(topic, told(message))
        for message in self.bus.sent["cmd_vel"][self._passed["cmd_vel"] :]:
            self._passed["cmd_vel"] += 1
            bus.say("cmd_vel", told(message))
