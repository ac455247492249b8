"""Record of a robot on a bus, leg by leg, and its score."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from hrsafety._arguments import Pair
from hrsafety.navigation.crowd.contacts import Contacts, contacts_of
from hrsafety.navigation.crowd.episodes import episodes_in
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.crowd.world_run import WorldRun
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.metrics.scores import EpisodeMetrics, evaluate
from hrsafety.navigation.trajectory import Divergence
from hrsafety.plausibility import ResultWarning
from hrsafety.ros.base import MovingBase
from hrsafety.ros.floor import Crowd

__all__ = ["BusRecord", "Leg"]

_SAME = 0.01
"""A goal that is as near as that to the one before is the same, in m."""
_MOVED = 0.05
"""A goal that comes before the robot has gone so far is that of the leg, in m."""


class Leg:
    """A part of a run with one goal, in which the robot was not carried.

    Parameters
    ----------
    world : World
        The world, whose robot has the goal of the leg; its step is the time between two instants.
    reason : str
        Why it began: ``"start"``, ``"initialpose"`` or ``"goal_pose"``.
    """

    def __init__(self, world: World, reason: str) -> None:
        self.world, self.step, self.reason = world, world.step, reason
        self.superseded = False
        self.diverged: Divergence | None = None
        self._time: list[float] = []
        self._robot: list[tuple[float, ...]] = []
        self._crowd: list[Crowd] = []
        self.standing_by, self.arrived = 0.0, False

    def __len__(self) -> int:
        """Return its number of instants."""
        return len(self._time)

    @property
    def begin(self) -> float:
        """When it began, in s."""
        return self._time[0]

    def note(self, time: float, base: MovingBase, crowd: Crowd, *, silent: bool) -> None:
        """Keep an instant."""
        self._time.append(time)
        self._robot.append((*base.pose, *base.velocity))
        self._crowd.append(crowd)
        self.standing_by += silent * self.step
        (robot,) = self.world.robots
        self.arrived |= math.dist(base.pose[:2], robot.goal) <= robot.arrival_tolerance

    def follow(self, other: Leg) -> None:
        """Begin where another leg ends."""
        self._time, self._robot, self._crowd = other._time[-1:], other._robot[-1:], other._crowd[-1:]

    @property
    def moved(self) -> float:
        """How far the robot has come from where it was at first, in m."""
        return math.dist(self._robot[0][:2], self._robot[-1][:2]) if self._robot else 0.0

    @cached_property
    def trajectory(self) -> WorldRun:
        """Robot and people at all instants, those who were there at any."""
        numbers = np.unique(np.concatenate([each.number for each in self._crowd]))
        shape = (len(self), len(numbers), 2)
        position, velocity, radius = np.full(shape, np.nan), np.full(shape, np.nan), np.full(len(numbers), np.nan)
        for row, crowd in enumerate(self._crowd):
            places = np.searchsorted(numbers, crowd.number)
            position[row, places], velocity[row, places] = crowd.position, crowd.velocity
            radius[places] = crowd.radius
        robot = np.array(self._robot)
        goal, tolerance = self.world.robots[0].goal, self.world.robots[0].arrival_tolerance
        there = np.flatnonzero(np.hypot(*(robot[:, :2] - goal).T) <= tolerance)
        time = self.step * np.arange(len(self), dtype=np.float64)
        speeds = np.hypot(velocity[..., 0], velocity[..., 1])
        nobody = np.full(len(numbers), np.nan)
        recorded: dict[str, Any] = dict(
            time=time,
            obstacle_position=position,
            obstacle_velocity=velocity,
            robot_position=robot[:, None, :2],
            robot_velocity=robot[:, None, 3:],
            robot_heading=robot[:, None, 2],
            obstacle_radius=radius,
            desired_speed=nobody,
            awareness=nobody,
            person_arrival_time=nobody,
            person_arrival_position=np.full((len(numbers), 2), np.nan),
            robot_arrival_time=np.array([time[there[0]] if len(there) else np.nan]),
            wall_rescues=0,
            max_person_speed=float(np.nanmax(speeds)) if np.isfinite(speeds).any() else 0.0,
            diverged=self.diverged and (self.diverged.time, self.diverged.kind, self.diverged.index),
        )
        return WorldRun(self.world, recorded)

    @cached_property
    def metrics(self) -> EpisodeMetrics:
        """The social metrics."""
        return evaluate(self._episode)

    @cached_property
    def _episode(self) -> Episode:
        run = self.trajectory
        places = run.robot_position, run.obstacle_position, run.obstacle_radius
        return episodes_in(self.world, *places, robot_heading=run.robot_heading)[0]

    @cached_property
    def contacts(self) -> Contacts:
        """People that the robot touched: also after it arrived, as it is still there."""
        return contacts_of(self._episode, math.nan)

    @property
    def outcome(self) -> str:
        """Outcome of the leg: ``"superseded"`` where another goal or place came before the robot arrived."""
        touched = sum((self.contacts.moving, self.contacts.standing, self.contacts.apart, self.metrics.wall_contacts))
        if touched:
            return "collided"
        if self.diverged is not None and not self.arrived:
            return "diverged"
        if math.isfinite(self.trajectory.robot_arrival_time[0]):
            return "arrived"
        return "superseded" if self.superseded else "timed_out"


class BusRecord:
    """Record of a robot on a bus.

    A leg ends where the robot is put elsewhere, or gets another goal; contacts count in all of them.

    Parameters
    ----------
    world : World
        The world; its step is the time between two instants.
    walls : StaticMap
        What stands.

    Attributes
    ----------
    legs : list of Leg
        The legs, in their order.
    counts : Counter
        What was counted on the bus, by name.
    touched : set of int
        Numbers of people that the robot touched at an instant so far, and ``touched_wall`` whether it touched a wall.
    nearest : float
        Least clearance at the instants so far, in m.
    late : float
        By how much the world fell behind the clock of the wall in all, in s.
    """

    def __init__(self, world: World, walls: StaticMap) -> None:
        self.world, self.step = world, world.step
        self._walls = walls
        self.legs = [Leg(world, "start")]
        self.counts: Counter[str] = Counter()
        self.touched: set[int] = set()
        self.touched_wall = False
        self.nearest = math.inf
        self.late, self.several = 0.0, False
        self.pace: float | None = None

    @property
    def goal(self) -> Pair:
        """The present goal in m."""
        return self.legs[-1].world.robots[0].goal

    def note(self, time: float, base: MovingBase, crowd: Crowd, *, silent: bool) -> None:
        """Keep an instant of the present leg."""
        self.legs[-1].note(time, base, crowd, silent=silent)
        radius, place = self.world.robots[0].body.radius, base.pose[:2]
        gaps = np.hypot(*(crowd.position - place).T) - crowd.radius - radius
        self.touched.update(crowd.number[gaps < 0.0].tolist())
        wall = float(self._walls.clearance(place)) - radius
        self.touched_wall |= wall < 0.0
        self.nearest = min([self.nearest, wall, *gaps.tolist()])

    def begin(self, reason: str) -> None:
        """Begin another leg, with the next instant that is noted."""
        last = self.legs[-1]
        last.superseded = True
        if len(last) < 2:
            self.legs.pop()  # nothing has happened in it
        self.legs.append(Leg(last.world, reason))

    def aim(self, goal: Pair) -> None:
        """Take another goal, with a leg of its own if the robot has gone somewhere."""
        if math.dist(goal, self.goal) <= _SAME:
            return
        last = self.legs[-1]
        if last.moved >= _MOVED:
            self.begin("goal_pose")
            self.legs[-1].follow(last)
        (robot,) = last.world.robots
        self.legs[-1].world = replace(last.world, robots=[replace(robot, goal=goal)])
        self.legs[-1].arrived = False

    def end(self, counts: Mapping[str, int], *, late: float, several: bool, pace: float | None) -> None:
        """Keep what was counted on the bus, and leave out a last leg in which nothing has happened."""
        self.counts = Counter(counts)
        self.late, self.several, self.pace = late, several, pace
        if len(self.legs[-1]) < 2 and len(self.legs) > 1:
            self.legs.pop()

    @property
    def clearance(self) -> float:
        """Least clearance to people and walls in all legs, also between instants, in m."""
        least = [each for leg in self.legs for each in (leg.metrics.min_clearance, leg.metrics.wall_clearance)]
        return float(min([self.nearest, *(each for each in least if math.isfinite(each))]))

    @property
    def arrived(self) -> bool:
        """Whether the robot has been at its present goal."""
        return self.legs[-1].arrived

    @property
    def contacts(self) -> Contacts:
        """People that the robot touched in all legs."""
        return Contacts(*(sum(each) for each in zip(*(leg.contacts for leg in self.legs), strict=True)))

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the score may not mean what it seems to."""
        found = [each for leg in self.legs for each in (*leg.metrics.warnings, *leg.trajectory.warnings)]
        return tuple(dict.fromkeys((*found, *self._of_bus())))

    def _of_bus(self) -> Iterator[ResultWarning]:
        """Yield what went wrong on the bus."""
        counts = self.counts
        if not counts["commands"]:
            yield ResultWarning("no_command", "cmd_vel", "no velocity command came: the robot stood where it was")
        if self.several:
            message = "several publishers sent velocity commands: the score is that of their mixture"
            yield ResultWarning("several_publishers", "cmd_vel", message)
        if self.pace is not None and self.pace < 1.0:
            message = f"the world ran at {self.pace:g} times real time: the robot had more time to decide than it has"
            yield ResultWarning("slow_clock", "speed", message)
        if counts["overrun"]:
            message = (
                f"the world fell {self.late:.2f} s behind the clock of the wall in all: for so long the robot had more "
                "time to decide than it would have; give a lower speed, fewer beams, or lock-step"
            )
            yield ResultWarning("overrun", "clock", message)
        if counts["lockstep_timeout"]:
            message = (
                f"in {counts['lockstep_timeout']} steps no velocity command came within a second of the wall: "
                "other runs may differ"
            )
            yield ResultWarning("lockstep_timeout", "clock", message)
        if counts["command_from_future"]:
            message = (
                f"{counts['command_from_future']} velocity commands had stamps later than the clock: how old they were "
                "is not known; run their node with use_sim_time"
            )
            yield ResultWarning("command_from_future", "cmd_vel", message)
